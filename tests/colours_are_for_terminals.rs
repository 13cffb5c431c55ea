//! Promise: colours and the bar go to terminals and nowhere else, and not there either if NO_COLOR or TERM=dumb says so;
//! finished cells stand above the bar with their verdicts.
#![cfg(unix)]

use assert_cmd::cargo::cargo_bin;
use nix::pty::{Winsize, openpty};
use std::fs::{self, File};
use std::io::Read;
use std::process::{Command, Stdio};
use tempfile::TempDir;

const FILE: &str = r#"question = "Is it green?"
samples = 20_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.7, 0.8] } }]
"#;

const GREEN_PASS: &str = "\x1b[32mPASS\x1b[0m";
const ESCAPE: char = '\x1b';

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), FILE).unwrap();
    place
}

fn experiment(place: &TempDir, args: &str, variables: &[(&str, &str)]) -> Command {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(args.split(' ')).current_dir(place.path());
    for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "CI"] {
        command.env_remove(name);
    }
    command.env("TERM", "xterm").envs(variables.iter().copied());
    command
}

/// All that a command shows on a terminal.
fn on_a_terminal(place: &TempDir, args: &str, variables: &[(&str, &str)]) -> String {
    let size = Winsize { ws_row: 50, ws_col: 200, ws_xpixel: 0, ws_ypixel: 0 };
    let terminal = openpty(&size, None).unwrap();
    let mut command = experiment(place, args, variables);
    let (stdout, stderr) = (terminal.slave.try_clone().unwrap(), terminal.slave);
    command.stdin(Stdio::null()).stdout(stdout).stderr(stderr);
    let mut child = command.spawn().unwrap();
    drop(command); // and with it our ends of the terminal
    let mut shown = Vec::new();
    let mut master = File::from(terminal.master);
    let mut buffer = [0; 4096];
    // reading fails once nobody writes any more
    while let Ok(n @ 1..) = master.read(&mut buffer) {
        shown.extend_from_slice(&buffer[..n]);
    }
    child.wait().unwrap();
    String::from_utf8(shown).unwrap()
}

/// What it writes into pipes: standard output and error.
fn into_pipes(place: &TempDir, args: &str, variables: &[(&str, &str)]) -> (String, String) {
    let output = experiment(place, args, variables).output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn verdicts_are_coloured_on_terminals_only() {
    let place = place();
    assert!(on_a_terminal(&place, "x --quiet", &[]).contains(GREEN_PASS));
    assert!(
        on_a_terminal(&place, "x --quiet", &[("NO_COLOR", "")]).contains(GREEN_PASS),
        "empty says nothing"
    );
    let plain = [
        on_a_terminal(&place, "x --quiet", &[("NO_COLOR", "1")]),
        on_a_terminal(&place, "x --quiet", &[("TERM", "dumb")]),
        on_a_terminal(&place, "x --quiet --color never", &[]),
        into_pipes(&place, "x --quiet", &[]).0,
    ];
    for text in plain {
        assert!(text.contains("PASS") && !text.contains(ESCAPE), "{text:?}");
    }
    for (args, variables) in
        [("x --quiet --color always", &[][..]), ("x --quiet", &[("CLICOLOR_FORCE", "1")])]
    {
        assert!(into_pipes(&place, args, variables).0.contains(GREEN_PASS), "{args} {variables:?}");
    }
    // colours change nothing else
    let coloured = into_pipes(&place, "x --quiet --color always", &[]).0;
    let stripped = coloured.replace("\x1b[32m", "").replace("\x1b[0m", "");
    assert_eq!(stripped, into_pipes(&place, "x --quiet", &[]).0);
}

#[test]
fn errors_are_coloured_on_terminals_only() {
    let place = place();
    for args in ["y", "x --set seed=-1", "x --frob"] {
        let shown = on_a_terminal(&place, args, &[]);
        assert!(shown.contains("\x1b[31m") && shown.contains("error:"), "{args}: {shown:?}");
        assert!(!on_a_terminal(&place, args, &[("NO_COLOR", "1")]).contains(ESCAPE), "{args}");
        assert!(!into_pipes(&place, args, &[]).1.contains(ESCAPE), "{args}");
    }
}

#[test]
fn finished_cells_stand_above_the_bar() {
    let place = place();
    let shown = on_a_terminal(&place, "x", &[]);
    for q in ["q=0.7", "q=0.8"] {
        let line = shown.lines().find(|line| line.contains(q) && line.contains("so far"));
        assert!(line.is_some_and(|line| line.contains(GREEN_PASS)), "{q}: {shown:?}");
    }
    assert!(shown.contains(" left  furnace implicit") && shown.contains("rays/s"), "{shown:?}");
    // where nobody watches, a line a cell
    let (stdout, stderr) = into_pipes(&place, "x --fresh", &[]);
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), 2, "{stderr}");
    assert!(lines[0].starts_with("[1/2] furnace implicit constant q=0.7: "), "{stderr}");
    assert!(lines.iter().all(|line| line.ends_with(" s, PASS so far")), "{stderr}");
    assert!(!stdout.contains("so far"));
    for args in ["x --quiet", "x --format json"] {
        assert_eq!(into_pipes(&place, args, &[]).1, "", "{args}");
        assert!(!on_a_terminal(&place, args, &[]).contains("so far"), "{args}");
    }
}

#[test]
fn who_stops_reading_ends_no_run_with_a_panic() {
    let place = place();
    let program = cargo_bin!("experiment").display().to_string();
    let line =
        format!("'{program}' x --quiet | true; '{program}' list | head -c 1; '{program}' schema | head -c 1");
    let output = Command::new("sh").args(["-c", &line]).current_dir(place.path()).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(stderr, "", "{stderr}");
}
