//! When and where a run takes place.

use crate::args::Options;
use crate::files::Source;
use furnace::experiment::Plan;
use furnace::report::run::{Machine, Run};
use std::process::Command;
use std::time::SystemTime;

/// A run that begins now.
pub fn begin(source: &Source, plan: &Plan, options: &Options) -> Run {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    Run {
        experiment: source.name.clone(),
        spec: source.text.clone(),
        seed: plan.spec.seed,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: commit(),
        started: since.map_or(0, |since| since.as_secs()),
        threads: options.threads(),
        machine: Machine {
            architecture: std::env::consts::ARCH.to_owned(),
            system: std::env::consts::OS.to_owned(),
            processor: processor(),
            cores,
        },
        seconds: Vec::new(),
    }
}

fn commit() -> Option<String> {
    let git = |args: &[&str]| {
        let output = Command::new("git").args(args).output().ok().filter(|out| out.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let head = git(&["rev-parse", "HEAD"])?;
    // reports are what is about to change
    let changed = git(&["status", "--porcelain", "--untracked-files=no", "--", ":!reports"]);
    Some(if changed.is_some_and(|files| !files.is_empty()) { format!("{head}-dirty") } else { head })
}

/// As Linux tells it.
fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
