//! Statistics of the bench; nothing here knows what light is.
//!
//! [`Moments`] condenses samples, [`student`] and [`multiplicity`] hold the
//! distribution theory, and [`judge()`] turns measurements into verdicts. All
//! error rates promised are those of the whole family of questions.
//!
//! Whether a mean may be judged at all: [`tails`], [`tally`], [`replicates`], [`skewed`].
//! Questions that no mean answers: [`change`], [`decay`], [`law`], [`rate`], [`trend`]. How good the verdicts
//! are, and those of others: [`binomial`], [`rivals`], and on samples whose mean is known
//! exactly [`nulls`], [`calibrate`].

pub mod bets;
#[cfg(test)]
mod bets_hold;
pub mod binomial;
pub mod calibrate;
pub mod change;
pub mod decay;
mod evidence;
pub mod judge;
#[cfg(test)]
mod judge_rates;
pub mod law;
pub mod moments;
pub mod multiplicity;
pub mod nulls;
pub mod power;
mod question;
pub mod rate;
pub mod replicates;
pub mod rivals;
mod sides;
pub mod skewed;
mod source;
pub mod student;
pub mod tails;
pub mod tally;
#[cfg(test)]
mod tally_rates;
pub mod trend;

pub use bets::{Bets, Stake, Table};
pub use judge::{Answer, Engine, Question, Verdict, decide, judge};
pub use moments::Moments;
