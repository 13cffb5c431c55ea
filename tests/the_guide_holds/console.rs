//! What stands after `$ ` is run, and must print what stands below. `…` stands for anything, and a line of it for any lines.

use crate::fences::{read, root};
use std::fs;
use std::path::Path;
use std::process::Command;

/// What a chapter's commands have left.
pub struct Session<'a> {
    /// Where they run.
    pub place: &'a Path,
    /// Files that patches would make.
    pub patched: String,
    /// The exit status of the last one.
    pub status: i32,
    /// What it printed.
    pub printed: String,
}

/// Runs one block.
pub fn run(session: &mut Session<'_>, text: &str) {
    assert!(text.starts_with("$ "), "a console begins with a command");
    let text = format!("\n{text}");
    let mut parts = text.split("\n$ ").skip(1).peekable();
    while let Some(part) = parts.next() {
        let (command, shown) = part.split_once('\n').unwrap_or((part, ""));
        let shown: Vec<&str> = shown.lines().collect();
        if command == "echo $?" {
            assert_eq!(shown, [session.status.to_string()], "the status");
        } else if let Some(arguments) = command.strip_prefix("experiment ") {
            let most = experiment(session, arguments);
            show(&shown, &session.printed);
            let is_told = parts.peek().is_some_and(|next| next.starts_with("echo $?"));
            assert!(is_told || session.status <= most, "`{command}` ends with {}", session.status);
        } else {
            known(session, command);
            assert!(shown.is_empty(), "nothing runs `{command}`, so what it prints cannot be shown");
        }
    }
}

/// Runs the program, with `--quick` where an experiment of the repository would be run as a whole; the highest exit status
/// that is none to wonder at: few samples decide little.
fn experiment(session: &mut Session<'_>, arguments: &str) -> i32 {
    let name = arguments.split(' ').next().unwrap();
    let is_ours = root().join(format!("experiments/{name}.toml")).exists();
    let is_short = ["--quick", "--samples"].iter().any(|option| arguments.contains(option));
    let more = if is_ours && !is_short { " --quick" } else { "" };
    let line = format!("'{}' {arguments}{more}", env!("CARGO_BIN_EXE_experiment"));
    let output = Command::new("sh").args(["-c", &line]).current_dir(session.place).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("it prints text");
    session.status = output.status.code().expect("it ends by itself");
    session.printed = text(output.stdout);
    if session.status > 1 {
        session.printed += &text(output.stderr);
    }
    i32::from(is_ours || is_short)
}

/// Holds that the lines are printed, in this order and without others between them.
fn show(shown: &[&str], printed: &str) {
    let mut lines = printed.lines();
    let mut skips = shown.is_empty();
    for pattern in shown {
        if *pattern == "…" {
            skips = true;
            continue;
        }
        let found = if skips {
            lines.any(|l| fits(pattern, l))
        } else {
            lines.next().is_some_and(|l| fits(pattern, l))
        };
        assert!(found, "not printed where it is shown: {pattern}\n{printed}");
        skips = false;
    }
    assert!(skips || lines.next().is_none(), "more is printed than is shown:\n{printed}");
}

/// Whether a line is as shown, but for the width of its spaces.
fn fits(pattern: &str, line: &str) -> bool {
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = plain(line);
    let pieces: Vec<String> = pattern.split('…').map(plain).collect();
    let [first, middle @ .., last] = pieces.as_slice() else { return line == pieces[0] };
    let Some(mut rest) = line.strip_prefix(first.as_str()) else { return false };
    for piece in middle {
        let Some(at) = rest.find(piece.as_str()) else { return false };
        rest = &rest[at + piece.len()..];
    }
    rest.ends_with(last.as_str())
}

/// What is not run here must at least exist.
fn known(session: &mut Session<'_>, command: &str) {
    let words: Vec<&str> = command.split(' ').collect();
    let exists =
        |path: &str| assert!(root().join(path).exists(), "`{command}` names {path}, which is not there");
    let value = |option: &str| words.iter().position(|w| *w == option).map(|at| words[at + 1]);
    match words[0] {
        "git" if words[1] == "apply" => {
            session.patched += &read(Path::new(words[2]));
            // whoever has followed the guide has these files
            let added = session.patched.lines().filter_map(|line| line.strip_prefix("+++ b/"));
            if added.filter(|file| file.contains("mine")).all(|file| root().join(file).exists()) {
                return;
            }
            let check = Command::new("git")
                .args(["apply", "--check", words[2]])
                .current_dir(root())
                .output()
                .unwrap();
            assert!(check.status.success(), "{}", String::from_utf8_lossy(&check.stderr));
        }
        "cargo" => {
            assert!(
                ["build", "run", "test", "bench", "fmt", "clippy", "doc", "deny"].contains(&words[1]),
                "{command}"
            );
            for (option, folder) in [("--example", "examples"), ("--bench", "benches")] {
                if let Some(name) = value(option) {
                    exists(&format!("{folder}/{name}.rs"));
                }
            }
            if let Some(name) = value("--test") {
                let file = if root().join(format!("tests/{name}.rs")).exists() { ".rs" } else { "/main.rs" };
                exists(&format!("tests/{name}{file}"));
            }
            if value("--bin").is_some() {
                let is_one = |word: &&str| {
                    let file = format!("experiments/{word}.toml");
                    session.patched.contains(&format!("+++ b/{file}")) || root().join(file).exists()
                };
                assert!(words.iter().any(is_one), "`{command}` names no experiment");
            }
        }
        "python3" | "bash" => script(words[1], &words[2..]),
        "mdbook" => exists(&format!("{}/book.toml", words[2])),
        file if file.contains('/') => script(file, &words[1..]),
        _ => panic!("no rule tells whether `{command}` works"),
    }
}

/// A script is there, and knows its options.
fn script(file: &str, arguments: &[&str]) {
    let text = fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
    for option in arguments.iter().filter(|word| word.starts_with("--")) {
        assert!(text.contains(option), "{file} has no option {option}");
    }
}
