//! Scripts for shells.

use crate::HELD;
use clap_complete::env::Shells;
use furnace::experiment::Error;
use std::io::stdout;
use std::path::Path;

/// The variable in which a shell asks.
const VARIABLE: &str = "COMPLETE";

/// Prints the script that registers completions with a shell; they are made by this program whenever they are asked for.
pub fn print(shell: &str) -> Result<u8, Error> {
    let unknown = || Error::Refused(format!("no completions for `{shell}`"));
    let shells = Shells::builtins();
    let shell = shells.completer(shell).ok_or_else(unknown)?;
    let here = std::env::current_exe().ok();
    let program = here.as_deref().and_then(Path::to_str).unwrap_or("experiment");
    shell
        .write_registration(VARIABLE, "experiment", "experiment", program, &mut stdout())
        .map_err(|e| Error::io("cannot write to", Path::new("standard output"), e))?;
    Ok(HELD)
}
