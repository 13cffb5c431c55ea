//! What is asked of a cluster.

use super::complete;
use clap::Args;
use clap_complete::ArgValueCompleter;

#[derive(Args)]
pub struct Slurm {
    /// The experiment: its name in experiments/, or the path of its .toml file
    #[arg(add = ArgValueCompleter::new(complete::experiments))]
    pub name: String,
    /// Into how many tasks it is divided
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub tasks: u64,
    /// Hand both scripts to sbatch
    #[arg(long)]
    pub submit: bool,
    /// Where to run [default: the cluster's default partition]
    #[arg(long, value_name = "NAME", value_parser = word)]
    pub partition: Option<String>,
    /// Who pays
    #[arg(long, value_name = "NAME", value_parser = word)]
    pub account: Option<String>,
    /// A task's time limit as Slurm writes it: MINUTES, H:M:S, D-H. A minute before it, what is finished is written down, and
    /// the task goes on in another turn
    #[arg(long, value_name = "LIMIT", value_parser = limit)]
    pub time: Option<String>,
    /// A task's memory: 2G
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    pub mem: Option<String>,
    /// A task's threads
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub cpus: u16,
    /// How many tasks may run at once
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub at_once: Option<u32>,
    /// Another option of sbatch, for both scripts: --sbatch=--qos=long; may be repeated
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true, value_parser = directive)]
    pub sbatch: Vec<String>,
}

/// What stands in a line of a script as it is.
fn word(text: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_alphanumeric() || "_-.,@+:/".contains(c);
    let is_word = !text.is_empty() && !text.starts_with('-') && text.chars().all(is_plain);
    if is_word { Ok(text.to_owned()) } else { Err("letters, digits and _-.,@+:/ make a name".to_owned()) }
}

fn memory(text: &str) -> Result<String, String> {
    let digits = text.strip_suffix(['K', 'M', 'G', 'T']).unwrap_or(text);
    let is_size = digits.parse::<u32>().is_ok_and(|size| size > 0);
    if is_size {
        Ok(text.to_owned())
    } else {
        Err("a number of megabytes, or with K, M, G or T: 2G".to_owned())
    }
}

/// The least time that leaves something between a task's start and the minute that it is told before its end.
const LEAST_SECONDS: u64 = 120;

fn limit(text: &str) -> Result<String, String> {
    match seconds(text) {
        None => Err("MINUTES, M:S, H:M:S, D-H, D-H:M or D-H:M:S are times".to_owned()),
        Some(seconds) if seconds < LEAST_SECONDS => {
            Err("it must be two minutes at least: a task is stopped one minute before its end".to_owned())
        }
        Some(_) => Ok(text.to_owned()),
    }
}

/// A time of Slurm's in seconds.
fn seconds(text: &str) -> Option<u64> {
    let (days, rest) = match text.split_once('-') {
        Some((days, rest)) => (Some(days), rest),
        None => (None, text),
    };
    let parts = rest.split(':').map(|part| part.parse::<u32>().ok()).collect::<Option<Vec<_>>>()?;
    let units: &[u64] = match (days, parts.len()) {
        (None, 1) => &[60],
        (None, 2) => &[60, 1],
        (None, 3) | (Some(_), 1..=3) => &[3600, 60, 1],
        _ => return None,
    };
    let days = days.map_or(Some(0), |days| days.parse::<u32>().ok())?;
    let rest: u64 = parts.iter().zip(units).map(|(&part, unit)| u64::from(part) * unit).sum();
    Some(u64::from(days) * 86_400 + rest)
}

/// What would make another array than the one that is written.
const OWN: [&str; 6] = ["--array", "-a", "--dependency", "-d", "--wrap", "--parsable"];

fn directive(text: &str) -> Result<String, String> {
    if !text.starts_with('-') || text.contains(char::is_control) {
        return Err("an option of sbatch begins with -, and is one line: --sbatch=--qos=long".to_owned());
    }
    let name = text.split(['=', ' ']).next().unwrap_or(text);
    // a value can follow a letter at once: -a1-8
    let is = |own: &&&str| if own.starts_with("--") { name == **own } else { name.starts_with(**own) };
    match OWN.iter().find(is) {
        Some(own) => Err(format!("{own} is said here already")),
        None => Ok(text.to_owned()),
    }
}
