//! Bets with mistakes.

use super::students::brighter;
use super::{Case, RIGHT, SKEWED, all_noticed, times};
use furnace::stats::bets::Bets;
use furnace::stats::{Stake, Table};

/// A guess of the mean that is ten percent too small, which costs a little power and no validity.
const STAKE: Stake = Stake { scale: 0.9, bound: None };

/// Whether what was won after any 16 samples makes `enough` true.
fn ever(samples: &[f64], enough: impl Fn(&Bets) -> bool) -> bool {
    let mut bets = Bets::new(STAKE);
    samples.chunks(16).any(|chunk| {
        let mut table = Table::new(STAKE);
        chunk.iter().for_each(|&x| table.push(x));
        bets.merge(&table.close(chunk.len() as u64));
        enough(&bets)
    })
}

fn bets() -> Vec<Case> {
    let case = Case {
        mistake: "",
        law: SKEWED,
        samples: 1024,
        runs: 2000,
        level: 0.01,
        wrong: times!(1.4),
        sound: |x, level| ever(x, |bets| bets.log_above(RIGHT) >= -level.ln()),
        broken: brighter,
    };
    vec![
        Case {
            mistake: "bets against the guess in place of the right mean",
            broken: |x, level| ever(x, |bets| bets.log_above(STAKE.scale) >= -level.ln()),
            ..case
        },
        Case {
            mistake: "the level in place of its inverse",
            broken: |x, level| ever(x, |bets| bets.log_above(RIGHT) >= level.ln()),
            ..case
        },
        Case {
            mistake: "bets that are made once the sample is seen",
            broken: |x, level| {
                let seen: Vec<f64> = x.iter().copied().filter(|x| *x > 0.9 * RIGHT).collect();
                ever(&seen, |bets| bets.log_above(RIGHT) >= -level.ln())
            },
            ..case
        },
        Case {
            mistake: "the best of sixteen shares, chosen afterwards",
            samples: 2048,
            level: 0.05,
            broken: |x, level| best_share(x) >= -level.ln(),
            ..case
        },
    ]
}

/// Logarithm of the largest fortune over time and over the shares 1/2, 1/4, ..., each of which is honest by itself.
fn best_share(samples: &[f64]) -> f64 {
    let mut logs = [0.0_f64; 16];
    let mut best = 0.0_f64;
    for x in samples {
        let mut share = 1.0;
        for log in &mut logs {
            share *= 0.5;
            *log += (share * (x - RIGHT)).ln_1p();
            best = best.max(*log);
        }
    }
    best
}

#[test]
fn wrong_bets_are_noticed() {
    all_noticed(&bets());
}
