//! The command line: `experiment rr_sweep`.

#![forbid(unsafe_code)]

mod args;
mod baseline;
mod claims;
mod colour;
mod completions;
mod export;
mod figure;
mod files;
mod merge;
mod new;
mod plans;
mod progress;
mod provenance;
mod reference;
mod render;
mod run;
mod schema;
mod set;
mod shards;
mod signals;
mod slurm;
mod status;
mod study;
mod subject;

use anstream::eprintln;
use args::{Cli, Command, Format};
use clap::{CommandFactory, Parser};
use clap_complete::CompleteEnv;
use furnace::experiment::Error;
use signals::Signals;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

/// All claims held.
const HELD: u8 = 0;
/// A claim failed or stayed inconclusive.
const NOT_HELD: u8 = 1;
/// The input or the machine refused.
const REFUSED: u8 = 2;
/// Blocks are missing: try again when they are there.
const INCOMPLETE: u8 = 75;
/// Stopped by a signal, with everything finished so far kept; it ends with the signal's own status.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    CompleteEnv::with_factory(Cli::command).complete();
    let cli = Cli::parse();
    colour::choose(cli.options.color);
    let signals = Signals::default();
    if let Err(error) = signals.watch() {
        eprintln!("warning: Ctrl-C will lose what is finished: {error}");
    }
    match dispatch(&cli, &signals.stop) {
        Ok(INTERRUPTED) => ExitCode::from(signals.status()),
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("{}", colour::error(&error));
            ExitCode::from(REFUSED)
        }
    }
}

fn dispatch(cli: &Cli, stop: &AtomicBool) -> Result<u8, Error> {
    let exports = matches!(cli.command, Some(Command::Export(_)));
    if cli.options.format == Format::Mitsuba && !exports {
        return Err(Error::Refused("only `export` writes --format mitsuba".to_owned()));
    }
    let has_objects = matches!(
        cli.command,
        None | Some(
            Command::List
                | Command::Plan { .. }
                | Command::Report { .. }
                | Command::Merge(_)
                | Command::Figure(_)
        )
    );
    if cli.options.format == Format::Json && !has_objects && !exports {
        return Err(Error::Refused(
            "--format json is for runs, `list`, `plan`, `report`, `merge` and `figure`".to_owned(),
        ));
    }
    match &cli.command {
        None => run::all(&cli.names, &cli.options, stop),
        Some(Command::List) => plans::list(&cli.options),
        Some(Command::Plan { names, margin }) => plans::plans(names, *margin, &cli.options),
        Some(Command::Report { names }) => run::reports(names, &cli.options),
        Some(Command::Merge(folders)) => merge::merge(folders, &cli.options),
        Some(Command::Status { folders }) => status::status(folders),
        Some(Command::Figure(figure)) => figure::figure(figure, &cli.options),
        Some(Command::New(new)) => new::write(new),
        Some(Command::Schema { of }) => Ok(schema::print(*of)),
        Some(Command::Completions { shell }) => completions::print(shell),
        Some(Command::Slurm(slurm)) => slurm::slurm(slurm, &cli.options),
        Some(Command::Export(export)) => export::export(export, &cli.options),
        Some(Command::Render(render)) => render::render(render, &cli.options, stop),
        Some(Command::Reference(reference)) => reference::reference(reference, &cli.options, stop),
    }
}
