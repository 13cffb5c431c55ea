//! Accessibility: axe-core 4.14.1 (Deque Systems, MPL-2.0, in the folder `axe`), run inside a page.

use super::Page;

const AXE: &str = include_str!("axe/axe.min.js");

/// A rule that a page breaks, and where.
#[derive(Debug, PartialEq)]
pub struct Finding {
    /// The rule's name.
    pub rule: String,
    /// "serious" or "critical".
    pub impact: String,
    /// What the rule asks.
    pub help: String,
    /// Each element that breaks it, with what is wrong there.
    pub places: Vec<String>,
}

impl Page {
    /// What hinders readers seriously or worse, in the page as it is shown now.
    pub fn axe(&self) -> Vec<Finding> {
        self.js(&format!("{AXE}\n;0"));
        let found =
            self.js("const { violations } = await axe.run(document, { resultTypes: ['violations'] });
             violations.map(({ id, impact, help, nodes }) => ({ id, impact, help,
               places: nodes.map((node) => `${node.html.slice(0, 120)}: ${node.failureSummary}`) }))");
        let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
        let finding = |found: &serde_json::Value| Finding {
            rule: text(&found["id"]),
            impact: text(&found["impact"]),
            help: text(&found["help"]),
            places: found["places"].as_array().unwrap().iter().map(text).collect(),
        };
        let all = found.as_array().unwrap().iter().map(finding);
        all.filter(|finding| finding.impact == "serious" || finding.impact == "critical").collect()
    }
}
