//! Text that stays text in LaTeX.

use std::fmt::Write;

/// Letters that pdfTeX does not know by themselves, in mathematics.
const SYMBOLS: [(char, &str); 28] = [
    ('α', "\\alpha"),
    ('β', "\\beta"),
    ('γ', "\\gamma"),
    ('δ', "\\delta"),
    ('ε', "\\varepsilon"),
    ('θ', "\\theta"),
    ('λ', "\\lambda"),
    ('μ', "\\mu"),
    ('π', "\\pi"),
    ('ρ', "\\rho"),
    ('σ', "\\sigma"),
    ('τ', "\\tau"),
    ('φ', "\\varphi"),
    ('χ', "\\chi"),
    ('ω', "\\omega"),
    ('Ω', "\\Omega"),
    ('⁻', "{}^{-}"),
    ('⁰', "{}^{0}"),
    ('⁴', "{}^{4}"),
    ('−', "-"),
    ('≈', "\\approx"),
    ('≠', "\\neq"),
    ('≤', "\\le"),
    ('≥', "\\ge"),
    ('∞', "\\infty"),
    ('→', "\\to"),
    ('√', "\\surd"),
    ('∝', "\\propto"),
];

/// Letters of Latin-1 and Latin Extended-A that the standard font of LaTeX lacks.
const LACKING: &str = "«»ÐÞðþĄąĐđĘęĦħĮįĸĿŀŉŊŋŦŧŲųſ";

/// The text with nothing in it that LaTeX would take for a command; what pdfTeX cannot set is named by its number.
pub(super) fn text(plain: &str) -> String {
    let mut out = String::new();
    let mut before = ' ';
    for letter in plain.chars() {
        // these would become one other sign
        if matches!((before, letter), ('-', '-') | ('\'', '\'') | (',', ',') | ('`' | '?' | '!', '`')) {
            out.push_str("{}");
        }
        before = letter;
        let _ = match letter {
            '\\' => write!(out, "\\textbackslash{{}}"),
            '^' => write!(out, "\\textasciicircum{{}}"),
            '~' => write!(out, "\\textasciitilde{{}}"),
            '<' => write!(out, "\\textless{{}}"),
            '>' => write!(out, "\\textgreater{{}}"),
            '|' => write!(out, "\\textbar{{}}"),
            '{' | '}' | '$' | '&' | '#' | '_' | '%' => write!(out, "\\{letter}"),
            // German packages give it a meaning
            '"' => write!(out, "\\char34{{}}"),
            ' '..='~' => write!(out, "{letter}"),
            '\u{a1}'..='\u{17f}' | '–' | '—' | '‘' | '’' | '“' | '”' | '…' if !LACKING.contains(letter) =>
            {
                write!(out, "{letter}")
            }
            letter if letter.is_control() || letter.is_whitespace() => write!(out, " "),
            letter => match SYMBOLS.iter().find(|(known, _)| *known == letter) {
                Some((_, command)) => write!(out, "\\ensuremath{{{command}}}"),
                None => write!(out, "[U+{:04X}]", u32::from(letter)),
            },
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_text() {
        assert_eq!(text("\\input{x}"), "\\textbackslash{}input\\{x\\}");
        assert_eq!(text("50% & #1_$"), "50\\% \\& \\#1\\_\\$");
        assert_eq!(
            text("a^b~c\n<d>|e"),
            "a\\textasciicircum{}b\\textasciitilde{}c \\textless{}d\\textgreater{}\\textbar{}e"
        );
        assert_eq!(text("a--b-c ?`\" ''"), "a-{}-b-c ?{}`\\char34{} '{}'");
        assert_eq!(text("q ≥ 10⁻² é 中\u{7f}"), "q \\ensuremath{\\ge} 10\\ensuremath{{}^{-}}² é [U+4E2D] ");
    }

    /// Every letter that LaTeX gives a meaning stands behind a backslash, or in a command of ours.
    #[test]
    fn no_letter_keeps_its_meaning() {
        let commands =
            ["\\textbackslash{}", "\\textasciicircum{}", "\\textasciitilde{}", "\\textless{}", "\\char34{}"];
        for letter in (0..0x250).filter_map(char::from_u32) {
            let mut rest = text(&format!("x{letter}x"));
            for command in commands.into_iter().chain(["\\textgreater{}", "\\textbar{}", "{}"]) {
                rest = rest.replace(command, "");
            }
            for special in "{}$&#_%".chars() {
                rest = rest.replace(&format!("\\{special}"), "");
            }
            assert!(
                !rest.contains(['\\', '{', '}', '$', '&', '#', '^', '_', '%', '~', '\n']),
                "{letter:?}: {rest}"
            );
        }
    }
}
