//! Statistics of the bench; nothing here knows what light is.
//!
//! [`Moments`] condenses samples, [`student`] and [`multiplicity`] hold the
//! distribution theory, and [`judge()`] turns measurements into verdicts. All
//! error rates promised are those of the whole family of questions.

pub mod bets;
#[cfg(test)]
mod bets_hold;
mod evidence;
pub mod judge;
#[cfg(test)]
mod judge_rates;
pub mod moments;
pub mod multiplicity;
pub mod power;
mod question;
mod sides;
pub mod student;

pub use bets::{Bets, Stake, Table};
pub use judge::{Answer, Engine, Question, Verdict, decide, judge};
pub use moments::Moments;
