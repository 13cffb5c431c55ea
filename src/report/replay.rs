//! The command that runs one cell again.

use crate::experiment::Plan;

/// One line for a shell, which gives a cell the same samples, bit for bit; it writes into a folder of its own, so that
/// the report at hand stays.
pub fn command(plan: &Plan, cell: usize) -> String {
    let cell = &plan.cells[cell];
    let (name, label) = (quoted(&plan.name), quoted(&plan.label(cell)));
    let (seed, samples) = (plan.spec.seed, plan.asking_for(cell));
    format!(
        "cargo run --bin experiment -- {name} --only {label} --seed {seed} --samples {samples} --out reports/replay"
    )
}

/// One line for a shell, which makes one block of a cell again, on one thread and without a guard.
pub fn block(plan: &Plan, cell: usize, block: u64) -> String {
    format!("{} --block {block}", command(plan, cell))
}

/// A word as a shell wants it: bare if it is plain, else in quotes, in which control characters are escaped.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._/=-".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    if !word.chars().any(char::is_control) {
        return format!("'{}'", word.replace('\'', "'\\''"));
    }
    let escaped = |c: char| match c {
        '\'' | '\\' => format!("\\{c}"),
        c if c.is_control() => {
            let mut bytes = [0; 4];
            c.encode_utf8(&mut bytes).bytes().map(|byte| format!("\\x{byte:02x}")).collect()
        }
        c => c.to_string(),
    };
    format!("$'{}'", word.chars().map(escaped).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::quoted;
    use std::process::Command;

    #[test]
    fn a_shell_reads_back_every_word() {
        let words = [
            "furnace",
            "",
            "furnace implicit constant q=0.5",
            "explicit (both, power) $HOME `id` \"x\" \\ !",
            "it's",
            "two\nlines it's \\n",
            "\u{85}\u{1F600}\t*",
            "-o",
        ];
        for word in words {
            let line = format!("printf %s {}", quoted(word));
            assert_eq!(line.lines().count(), 1, "{word:?}");
            let output = Command::new("bash").args(["-c", &line]).output().unwrap();
            assert_eq!(String::from_utf8(output.stdout).unwrap(), word, "{word:?}");
        }
    }
}
