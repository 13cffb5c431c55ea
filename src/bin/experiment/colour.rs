//! Whether there are colours, and those of errors.

use clap::ColorChoice;
use clap::builder::Styles;
use furnace::experiment::Error;

/// From now on, all that is printed has colours or none; by itself only what goes to a terminal has, unless NO_COLOR or
/// TERM=dumb says that it shall not.
pub fn choose(choice: ColorChoice) {
    let choice = match choice {
        ColorChoice::Auto => return,
        ColorChoice::Always => anstream::ColorChoice::Always,
        ColorChoice::Never => anstream::ColorChoice::Never,
    };
    choice.write_global();
}

/// An error as clap shows its own, carets included.
pub fn error(error: &Error) -> String {
    let style = Styles::styled().get_error().to_owned();
    let text = error.to_string();
    let text = match (error, text.rfind(|c| c != '^')) {
        (Error::Input(_), Some(last)) => {
            let (head, carets) = text.split_at(last + 1);
            format!("{head}{style}{carets}{style:#}")
        }
        _ => text,
    };
    format!("{style}error:{style:#} {text}")
}
