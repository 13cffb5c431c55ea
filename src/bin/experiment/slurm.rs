//! An experiment as a job array of a Slurm cluster: one script for its parts, one that joins them.

mod submit;

use crate::args::{Options, Slurm};
use crate::files::Source;
use crate::{HELD, baseline};
use anstream::println;
use furnace::experiment::journal::{self, Header, Shard};
use furnace::experiment::plan::RAYS_PER_SECOND;
use furnace::experiment::{Error, Plan};
use std::fs;
use std::path::{Path, PathBuf};

/// The scripts of an experiment, and what they write.
struct Job {
    /// The folder of the scripts and of what tasks print.
    folder: PathBuf,
    /// The folder of journals.
    journal: PathBuf,
    /// The folder of the report.
    report: PathBuf,
}

impl Job {
    fn shards(&self) -> PathBuf {
        self.folder.join("shards.sbatch")
    }

    fn merge(&self) -> PathBuf {
        self.folder.join("merge.sbatch")
    }
}

/// Writes the scripts, and submits them or says how.
pub fn slurm(args: &Slurm, options: &Options) -> Result<u8, Error> {
    if options.jobs != 0 {
        return Err(Error::Refused("a task's threads are --cpus".to_owned()));
    }
    let source = Source::read(&args.name, options)?;
    let plan = source.plan(options)?;
    baseline::wanted(&source, &plan, options)?;
    divisible(&plan, args.tasks)?;
    let reports = source.reports(options);
    let of = |ending: &str| reports.join(format!("{}.{ending}", source.name));
    let job = Job { folder: of("slurm"), journal: of("journal"), report: reports.join(&source.name) };
    unmixed(&job, &source.header(&plan, options, Shard::WHOLE), args.tasks)?;
    let (shards, merge) = scripts(&source, &job, args, options)?;
    fs::create_dir_all(&job.folder).map_err(|e| Error::io("cannot create", &job.folder, e))?;
    for (path, text) in [(job.shards(), shards), (job.merge(), merge)] {
        fs::write(&path, text).map_err(|e| Error::io("cannot write", &path, e))?;
    }
    let rays: f64 = plan.cells.iter().map(|cell| cell.total_rays()).sum();
    let seconds = rays / RAYS_PER_SECOND / args.tasks as f64;
    println!("{}: {} tasks of at most about {seconds:.0} core-seconds", source.name, args.tasks);
    if args.submit {
        submit::submit(&job)?
    } else {
        submit::explain(&job)?
    }
    Ok(HELD)
}

/// Refuses what cannot be divided among so many tasks.
fn divisible(plan: &Plan, tasks: u64) -> Result<(), Error> {
    if plan.spec.seeds.is_some() {
        let why = "is a study, whose runs are not kept in journals: it cannot be divided";
        return Err(Error::Refused(format!("{} {why}", plan.name)));
    }
    // blocks of images are kept together
    let parts: u64 = plan.cells.iter().map(|cell| cell.blocks().div_ceil(cell.unit())).sum();
    if tasks > parts {
        let why = format!("{} can be divided into {parts} parts at most", plan.name);
        return Err(Error::Refused(format!("--tasks {tasks}: {why}")));
    }
    Ok(())
}

/// Refuses a folder with journals of another run, which tasks or the merge would refuse in the end.
fn unmixed(job: &Job, ours: &Header, tasks: u64) -> Result<(), Error> {
    let Ok(paths) = journal::all(&job.journal) else { return Ok(()) }; // there are none yet
    for path in paths {
        let scan = journal::scan(&path)?;
        let (theirs, is_task) = (&scan.header, scan.header.shard.count == tasks);
        if is_task && scan.ended {
            continue; // the task replaces it, if it is of another run
        }
        let samples = |header: &Header| header.cells.iter().map(|cell| cell.samples).collect::<Vec<_>>();
        let differ = !is_task && samples(theirs) != samples(ours);
        let difference =
            ours.difference(theirs).or_else(|| differ.then(|| "it has other numbers of samples".to_owned()));
        if let Some(difference) = difference {
            let what = "remove it, or take another folder with --out";
            let path = path.display();
            return Err(Error::Refused(format!("{path} is of another run: {difference}; {what}")));
        }
    }
    Ok(())
}

/// The job array and what joins its parts.
fn scripts(source: &Source, job: &Job, args: &Slurm, options: &Options) -> Result<(String, String), Error> {
    let here = std::env::current_dir().map_err(|e| Error::io("cannot find", Path::new("."), e))?;
    let program =
        std::env::current_exe().map_err(|e| Error::io("cannot find", Path::new("experiment"), e))?;
    let out = absolute(&source.reports(options))?;
    let is_plain = |c: char| c.is_alphanumeric() || c == '-' || c == '.';
    let name: String = source.name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    let (run, report) = carried(options)?;
    let (tasks, cpus, directives) = (args.tasks, args.cpus, directives(args));
    let shards = format!(
        include_str!("slurm/shards.sbatch"),
        job = name,
        tasks = tasks,
        at_once = args.at_once.map_or_else(String::new, |n| format!("%{n}")),
        cpus = cpus,
        log = pattern(&job.folder, "%a.log")?,
        directives = directives,
        here = quoted(&here)?,
        program = quoted(&program)?,
        file = quoted(&absolute(&source.file)?)?,
        out = quoted(&out)?,
        options = run,
    );
    let merge = format!(
        include_str!("slurm/merge.sbatch"),
        job = name,
        cpus = cpus,
        log = pattern(&job.folder, "merge.log")?,
        directives = directives,
        here = quoted(&here)?,
        program = quoted(&program)?,
        journal = quoted(&absolute(&job.journal)?)?,
        out = quoted(&out)?,
        options = report,
    );
    Ok((shards, merge))
}

/// Lines for Slurm; those of `--sbatch` come last, so that they win.
fn directives(args: &Slurm) -> String {
    let named = [
        ("partition", &args.partition),
        ("account", &args.account),
        ("time", &args.time),
        ("mem", &args.mem),
    ];
    let named = named.into_iter().filter_map(|(name, value)| Some(format!("--{name}={}", value.as_ref()?)));
    named.chain(args.sbatch.iter().cloned()).map(|option| format!("#SBATCH {option}\n")).collect()
}

/// What changes the run, and what its report is to be compared with, as they are to be typed.
fn carried(options: &Options) -> Result<(String, String), Error> {
    // all of them are named, so that a new one is thought of; the last ones change no run, or are said elsewhere
    let Options {
        seed,
        samples,
        core,
        filter,
        only,
        set,
        walk_seconds,
        quick,
        force,
        allow_outside,
        baselines,
        out: _,
        jobs: _,
        format: _,
        color: _,
        quiet: _,
        all: _,
        claims: _,
        resume: _,
        fresh: _,
        shard: _,
        block: _,
    } = options;
    let run = [
        ("seed", seed.map(|seed| seed.to_string())),
        ("samples", samples.map(|samples| samples.to_string())),
        ("core", core.map(|core| core.name().to_owned())),
        ("filter", filter.clone()),
        ("only", only.clone()),
        ("walk-seconds", walk_seconds.map(|seconds| seconds.to_string())),
    ];
    let run = run.into_iter().chain(set.iter().map(|change| ("set", Some(change.clone()))));
    let report =
        [("baseline", baselines.baseline.clone()), ("save-baseline", baselines.save_baseline.clone())];
    let flags = [("--quick", quick), ("--force", force), ("--allow-outside", allow_outside)]
        .into_iter()
        .filter(|(_, is_set)| **is_set);
    let flags: String = flags.map(|(flag, _)| format!(" {flag}")).collect();
    Ok((words(run)? + &flags, words(report)?))
}

/// Options with a value, each a word of its own behind a space.
fn words(options: impl IntoIterator<Item = (&'static str, Option<String>)>) -> Result<String, Error> {
    let written = options.into_iter().filter_map(|(name, value)| Some(format!("--{name}={}", value?)));
    written.map(|word| Ok(format!(" {}", quote(&word)?))).collect()
}

/// A path as it is to be typed, wherever that is.
fn quoted(path: &Path) -> Result<String, Error> {
    let unicode = || Error::Refused(format!("{} must be a name in Unicode", path.display()));
    quote(path.to_str().ok_or_else(unicode)?)
}

/// A file in a folder, as a line for Slurm names it: there % and \ mean something, and quotes can be set.
fn pattern(folder: &Path, name: &str) -> Result<String, Error> {
    let folder = absolute(folder)?;
    let written = folder.to_str().filter(|folder| !folder.contains(|c: char| c == '\\' || c.is_control()));
    let refuse = || {
        let why = "Slurm takes no \\ and no control characters in names of files";
        Error::Refused(format!("{}: {why}; choose another folder with --out", folder.display()))
    };
    let written = written.ok_or_else(refuse)?.replace('%', "%%").replace('"', "\\\"");
    Ok(format!("\"{written}/{name}\""))
}

/// A word for the shell.
fn quote(text: &str) -> Result<String, Error> {
    let refuse = |e| Error::Refused(format!("`{}` cannot be written in a script: {e}", text.escape_debug()));
    shlex::try_quote(text).map(Into::into).map_err(refuse)
}

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    std::path::absolute(path).map_err(|e| Error::io("cannot find", path, e))
}
