//! Handing the scripts to Slurm, or saying how.

use super::{Job, quoted};
use anstream::println;
use furnace::experiment::Error;
use std::path::Path;
use std::process::Command;

/// Submits the job array, and what waits for its end.
pub fn submit(job: &Job) -> Result<(), Error> {
    let array = sbatch(&job.shards(), None)?;
    let journal = quoted(&job.journal)?;
    let merge = sbatch(&job.merge(), Some(after(&array))).map_err(|error| {
        let by_hand = format!("`experiment merge {journal}` joins them in the end");
        Error::Refused(format!(
            "job array {array} is submitted, but not what joins its parts: {error}\n{by_hand}"
        ))
    })?;
    println!("job array {array} runs them, job {merge} joins their parts into {}", job.report.display());
    println!("\nsee how far they are:    experiment status {journal}");
    println!("what they print:         {}", job.folder.display());
    println!("what Slurm says:         squeue --jobs={array},{merge}");
    println!("stop them:               scancel {array} {merge}");
    Ok(())
}

/// Tells what to type.
pub fn explain(job: &Job) -> Result<(), Error> {
    println!("\nsubmit them, and what joins their parts:");
    println!("  array=$(sbatch --parsable {})", quoted(&job.shards())?);
    println!("  sbatch {} {}", after("${array%%;*}"), quoted(&job.merge())?);
    println!("see how far they are:\n  experiment status {}", quoted(&job.journal)?);
    Ok(())
}

/// Not `afterok`, for which a task that failed once has failed for good, although it may have come back since.
fn after(array: &str) -> String {
    format!("--dependency=afterany:{array}")
}

/// The number of the job that a script has become.
fn sbatch(script: &Path, dependency: Option<String>) -> Result<String, Error> {
    let mut command = Command::new("sbatch");
    command.arg("--parsable").args(dependency).arg(script);
    let output = command.output().map_err(|e| {
        let written = format!("{} is written", script.display());
        Error::Refused(format!("cannot run sbatch: {e}; {written}, and --submit works where Slurm is"))
    })?;
    let said = String::from_utf8_lossy(if output.status.success() { &output.stdout } else { &output.stderr });
    if !output.status.success() {
        return Err(Error::Refused(format!("sbatch refuses {}: {}", script.display(), said.trim())));
    }
    // NUMBER;CLUSTER, where there are several
    Ok(said.trim().split(';').next().unwrap_or_default().to_owned())
}
