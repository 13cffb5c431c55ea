//! Promise: the scripts for a cluster do what the command does, whatever its options and folders are called; a task is
//! started again if it can go on, and only then; and what is submitted is told.
//!
//! Slurm's commands are played by small scripts here; `tests/slurm/run.sh` takes a real cluster.
#![cfg(unix)]

use assert_cmd::cargo::cargo_bin;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const FILE: &str = r#"question = "Does a script carry it?"
samples = 4096
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
[[grid]]
scene = ["furnace"]
estimator = ["implicit", "explicit"]
roulette = [{ constant = { q = [0.5, 0.9] } }]
"#;

/// What a shell, or Slurm, could take for something else.
const NAME: &str = "it's a \"place\" $of %j; `work` #1";

struct Place {
    root: TempDir,
    /// Where commands are run.
    work: PathBuf,
}

impl Place {
    fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        let work = root.path().join(NAME);
        fs::create_dir_all(work.join("experiments")).unwrap();
        fs::create_dir(root.path().join("bin")).unwrap();
        fs::write(work.join("experiments/x y.toml"), FILE).unwrap();
        Place { root, work }
    }

    /// A command of Slurm's, which notes its arguments in `calls`, a line each, and then does this.
    fn plays(&self, name: &str, does: &str) -> PathBuf {
        let calls = self.root.path().join("calls");
        let path = self.root.path().join("bin").join(name);
        let text = format!("#!/bin/bash\nprintf '%s\\n' {name} \"$@\" >>'{}'\n{does}\n", calls.display());
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o755)).unwrap();
        path
    }

    fn calls(&self) -> String {
        fs::read_to_string(self.root.path().join("calls")).unwrap_or_default()
    }

    /// `program`, where Slurm's commands are those that are played.
    fn command(&self, program: &Path) -> Command {
        let path = format!("{}:{}", self.root.path().join("bin").display(), std::env::var("PATH").unwrap());
        let mut command = Command::new(program);
        command.current_dir(&self.work).env("PATH", path);
        command
    }

    fn experiment(&self, args: &[&str]) -> Output {
        self.command(cargo_bin!("experiment")).args(args).output().unwrap()
    }

    fn script(&self, name: &str) -> PathBuf {
        self.work.join("reports/x y.slurm").join(name)
    }

    /// A task's script, from another folder than that of the command.
    fn task(&self, number: u32, restarts: u32) -> Command {
        let mut command = self.command(Path::new("bash"));
        command.arg(self.script("shards.sbatch")).current_dir(self.root.path());
        let variables = [("ARRAY_JOB_ID", 12), ("ARRAY_TASK_ID", number), ("RESTART_COUNT", restarts)];
        command.envs(variables.map(|(name, value)| (format!("SLURM_{name}"), value.to_string())));
        command.env("SLURMD_NODENAME", "w1").stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn scripts_do_what_the_command_does() {
    let place = Place::new();
    let changes = [
        "x y",
        "--set",
        "question=\"Is it $HOME, or 'that'?\"",
        "--set=grid.0.scene=[{ furnace = { albedo = 0.6 } }]",
        "--filter=furnace implicit",
        "--seed=7",
        "--samples=5000",
    ];
    let whole = place.experiment(&[&changes[..], &["--quiet", "--out", "alone"]].concat());
    assert!(matches!(whole.status.code(), Some(0 | 1)), "{}", text(&whole));
    let told = ["--tasks", "3", "--save-baseline", "main"];
    let written = place.experiment(&[&["slurm"], &changes[..], &told].concat());
    assert!(written.status.success(), "{}", text(&written));
    for number in 1..=3 {
        let task = place.task(number, 0).output().unwrap();
        assert!(task.status.success(), "{}", text(&task));
        let merge = place.command(Path::new("bash")).arg(place.script("merge.sbatch")).output().unwrap();
        let status = if number < 3 { Some(75) } else { whole.status.code() };
        assert_eq!(merge.status.code(), status, "{}", text(&merge));
    }
    let results = |folder: &str| fs::read_to_string(place.work.join(folder).join("x y/results.csv")).unwrap();
    assert_eq!(results("reports"), results("alone"));
    assert!(!results("alone").contains("explicit") && results("alone").contains(",7"), "nothing is changed");
    assert!(place.work.join("reports/.baselines/main/x y.json").is_file(), "the baseline is not kept");
    assert_eq!(place.calls(), "", "Slurm is asked though all went well");
}

#[test]
fn journals_of_another_run_are_told_before_anything_is_submitted() {
    let place = Place::new();
    let run = place.experiment(&["x y", "--shard", "1/4", "--seed", "3"]);
    assert!(run.status.success(), "{}", text(&run));
    let slurm = |seed, tasks, samples| {
        place.experiment(&["slurm", "x y", "--seed", seed, "--tasks", tasks, "--samples", samples])
    };
    let fits = |seed, tasks, samples| slurm(seed, tasks, samples).status.success();
    // parts of one run go together, and what has ended is replaced by its task
    assert!(
        fits("3", "4", "4096") && fits("3", "8", "4096") && fits("3", "4", "4100") && fits("5", "4", "4096")
    );
    assert!(!fits("3", "8", "4100"), "the merge would find other numbers of samples");
    let refused = slurm("5", "8", "4096");
    assert_eq!(refused.status.code(), Some(2));
    for words in ["1-of-4.journal is of another run: the seed is 3 there", "--out"] {
        assert!(text(&refused).contains(words), "{words}: {}", text(&refused));
    }
    // as if it had been killed
    let journal = place.work.join("reports/x y.journal/1-of-4.journal");
    let mut lines = fs::read(&journal).unwrap();
    lines.pop();
    lines.truncate(lines.iter().rposition(|byte| *byte == b'\n').unwrap() + 1);
    fs::write(&journal, lines).unwrap();
    assert!(fits("3", "4", "4096") && !fits("5", "4", "4096"));
}

#[test]
fn scripts_say_what_slurm_must_know() {
    let place = Place::new();
    let options = "--tasks 6 --at-once 2 --cpus 4 --mem 2G --time 1-12 --partition long,short --account us \
                   --sbatch=--qos=low --sbatch=--constraint=avx512";
    let written =
        place.experiment(&[&["slurm", "x y"], &options.split_whitespace().collect::<Vec<_>>()[..]].concat());
    assert!(written.status.success(), "{}", text(&written));
    let folder = place.work.join("reports/x y.slurm").display().to_string();
    let folder = folder.replace('%', "%%").replace('"', "\\\"");
    let both = "--cpus-per-task=4 --mem=2G --time=1-12 --partition=long,short --account=us --qos=low --constraint=avx512";
    for (name, own) in [
        (
            "shards.sbatch",
            format!("--array=1-6%2\n--requeue\n--signal=B:TERM@60\n--output=\"{folder}/%a.log\""),
        ),
        ("merge.sbatch", format!("--output=\"{folder}/merge.log\"")),
    ] {
        let script = fs::read_to_string(place.script(name)).unwrap();
        for option in both.split(' ').chain(own.lines()) {
            assert!(
                script.lines().any(|line| line == format!("#SBATCH {option}")),
                "{name}: {option}\n{script}"
            );
        }
    }
    let script = fs::read_to_string(place.script("shards.sbatch")).unwrap();
    assert!(script.contains(" --jobs 4 "), "{script}");
}

/// How a task ends whose program does this, while Slurm says that its job is in this state; and whether it is to come back.
#[track_caller]
fn ends(does: &str, state: &str, restarts: u32, terminated: bool) -> (Option<i32>, bool) {
    let place = Place::new();
    assert!(place.experiment(&["slurm", "x y", "--tasks", "2"]).status.success());
    let program = place.plays("program", does);
    place.plays("squeue", &format!("echo {state}"));
    place.plays("scontrol", "");
    let script = fs::read_to_string(place.script("shards.sbatch")).unwrap();
    let real = cargo_bin!("experiment").display().to_string();
    assert!(script.contains(&real), "{script}");
    fs::write(place.script("shards.sbatch"), script.replace(&real, &program.display().to_string())).unwrap();
    let task = place.task(2, restarts).spawn().unwrap();
    if terminated {
        let start = Instant::now();
        while !place.calls().contains("program\n") && start.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(100));
        }
        Command::new("kill").arg(task.id().to_string()).status().unwrap();
    }
    let output = task.wait_with_output().unwrap();
    let calls = place.calls();
    let comes_back = calls.contains("scontrol\nrequeue\n12_2\n");
    assert_eq!(calls.contains("scontrol"), comes_back, "{calls}");
    (output.status.code(), comes_back)
}

#[test]
fn what_can_go_on_is_started_again() {
    let killed = "kill -KILL $$";
    for (does, state, restarts, status, again) in [
        ("exit 0", "RUNNING", 0, 0, false),
        ("exit 1", "RUNNING", 0, 1, false),
        ("exit 2", "RUNNING", 0, 2, false),
        ("exit 101", "RUNNING", 0, 101, false),
        (killed, "RUNNING", 0, 75, true),
        (killed, "RUNNING", 2, 75, true),
        (killed, "RUNNING", 3, 137, false),
        // cancelled, or brought back by Slurm
        (killed, "COMPLETING", 0, 137, false),
        (killed, "", 0, 137, false),
    ] {
        assert_eq!(ends(does, state, restarts, false), (Some(status), again), "{does} {state} {restarts}");
    }
}

#[test]
fn a_task_whose_time_is_over_writes_down_what_it_has_and_comes_back() {
    let stops = |status: u32| {
        format!("trap 'sleep 0.3; exit {status}' TERM; for i in {{1..100}}; do sleep 0.1; done")
    };
    for (does, state, restarts, status, again) in [
        (stops(143), "RUNNING", 9, 75, true),
        (stops(143), "COMPLETING", 0, 143, false),
        (stops(0), "RUNNING", 0, 0, false),
        (stops(2), "RUNNING", 0, 2, false),
    ] {
        assert_eq!(ends(&does, state, restarts, true), (Some(status), again), "{does} {state} {restarts}");
    }
}

#[test]
fn what_is_submitted_is_told() {
    let place = Place::new();
    place.plays("sbatch", "case $* in *merge*) echo 78;; *) echo '77;cluster';; esac");
    let submitted = place.experiment(&["slurm", "x y", "--tasks", "2", "--submit"]);
    assert!(submitted.status.success(), "{}", text(&submitted));
    let (shards, merge) = (place.script("shards.sbatch"), place.script("merge.sbatch"));
    let relative = |path: PathBuf| path.strip_prefix(&place.work).unwrap().display().to_string();
    let calls = format!(
        "sbatch\n--parsable\n{}\nsbatch\n--parsable\n--dependency=afterany:77\n{}\n",
        relative(shards),
        relative(merge)
    );
    assert_eq!(place.calls(), calls);
    for words in ["job array 77", "job 78", "experiment status", "squeue --jobs=77,78", "scancel 77 78"] {
        assert!(text(&submitted).contains(words), "{words}: {}", text(&submitted));
    }
}

#[test]
fn what_is_printed_submits_both() {
    let place = Place::new();
    place.plays("sbatch", "echo '77;cluster'");
    let written = place.experiment(&["slurm", "x y", "--tasks", "2"]);
    assert_eq!(place.calls(), "", "nobody has said --submit");
    let printed = text(&written);
    let lines: String =
        printed.lines().filter(|line| line.contains("sbatch ")).map(|line| format!("{line}\n")).collect();
    let output = place.command(Path::new("sh")).args(["-c", &lines]).output().unwrap();
    assert!(output.status.success(), "{printed}{}", text(&output));
    assert_eq!(place.calls().matches("\nreports/x y.slurm/").count(), 2, "{}", place.calls());
    assert!(place.calls().contains("--dependency=afterany:77\n"), "{}", place.calls());
}

#[test]
fn what_slurm_refuses_is_told() {
    let place = Place::new();
    place.plays("sbatch", "echo 'sbatch: error: invalid partition specified: moon' >&2; exit 1");
    let refused = place.experiment(&["slurm", "x y", "--tasks", "2", "--partition", "moon", "--submit"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        text(&refused).contains("sbatch: error: invalid partition specified: moon"),
        "{}",
        text(&refused)
    );
    place.plays("sbatch", "case $* in *merge*) echo 'error: full' >&2; exit 1;; *) echo 77;; esac");
    let half = place.experiment(&["slurm", "x y", "--tasks", "2", "--submit"]);
    assert_eq!(half.status.code(), Some(2));
    for words in ["job array 77 is submitted", "experiment merge", "error: full"] {
        assert!(text(&half).contains(words), "{words}: {}", text(&half));
    }
}
