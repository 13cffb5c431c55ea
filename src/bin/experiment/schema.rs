//! Schemas.

use crate::HELD;
use crate::args::Kind;
use anstream::print;
use furnace::experiment::spec;
use furnace::report::json;

/// Prints a JSON schema.
pub fn print(of: Kind) -> u8 {
    let schema = match of {
        Kind::Experiment => spec::schema(),
        Kind::Result => json::schema(),
    };
    print!("{schema}");
    HELD
}
