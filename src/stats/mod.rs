//! Statistics of the bench; nothing here knows what light is.
//!
//! [`Moments`] condenses samples, [`student`] and [`multiplicity`] hold the
//! distribution theory, and [`judge()`] turns measurements into verdicts. All
//! error rates promised are those of the whole family of questions.

pub mod binomial;
mod evidence;
pub mod judge;
#[cfg(test)]
mod judge_rates;
pub mod law;
pub mod moments;
pub mod multiplicity;
mod question;
pub mod rate;
pub mod replicates;
pub mod rivals;
pub mod skewed;
#[cfg(test)]
mod source;
pub mod student;
pub mod tails;

pub use judge::{Answer, Question, Verdict, judge};
pub use moments::Moments;
