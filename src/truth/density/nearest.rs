//! The k nearest of n photons, uniform and independent on an area A: the disc up to the k-th has an area whose share u of A
//! is Beta(k, n - k + 1)-distributed, so that E 1/u = n / (k - 1) and E 1/u² = n (n - 1) / ((k - 1)(k - 2)). On a sphere with
//! chord distance this holds exactly, on other surfaces as long as the disc does not leave A.
//!
//! Two forms: all k photons over the disc, k / (π r_k²), and all but the outermost, (k - 1) / (π r_k²). For k = 1 the former
//! has no mean and the latter is 0; for k = 2 both have infinite variance.

use super::Photons;
use crate::truth::Counted;
use crate::truth::moments::power;

/// Factor of k / (π r_k²): k / (k - 1), infinite for k = 1.
pub fn factor_of_all(k: u64) -> f64 {
    assert!(k >= 1);
    k as f64 / (k as f64 - 1.0)
}

/// Factor of (k - 1) / (π r_k²): 1, and 0 for k = 1.
pub fn factor_without_last(k: u64) -> f64 {
    assert!(k >= 1);
    if k == 1 { 0.0 } else { 1.0 }
}

/// Variance of (k - 1) / (π r_k²) over the squared truth, k from 2 to `n`: (n - k + 1) / (n (k - 2)).
pub fn variance_without_last(k: u64, n: u64) -> f64 {
    assert!((2..=n).contains(&k), "{k} nearest of {n}");
    (n - k + 1) as f64 / (n as f64 * (k as f64 - 2.0))
}

/// The same for many photons: 1 / (k - 2), k from 2.
pub fn limit_without_last(k: u64) -> f64 {
    assert!(k >= 2);
    1.0 / (k as f64 - 2.0)
}

/// Variance of k / (π r_k²) over the squared truth (not its mean), k from 2 to `n`.
pub fn variance_of_all(k: u64, n: u64) -> f64 {
    let factor = factor_of_all(k);
    factor * factor * variance_without_last(k, n)
}

/// The same for many photons.
pub fn limit_of_all(k: u64) -> f64 {
    let factor = factor_of_all(k);
    factor * factor * limit_without_last(k)
}

/// Photons on the inside of a sphere of one albedo, all of whose hits are stored, with their weights albedo / q per
/// reflection: the sphere of [`Photons`], the number of stored hits being random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Albedo, in (0, 1).
    pub albedo: f64,
    /// Probability that a photon survives a hit, in (0, 1).
    pub q: f64,
    /// Photons sent out, at least k: then there always are k hits.
    pub photons: u64,
    /// How many hits are looked up.
    pub k: u64,
}

impl Stored {
    /// Variance over the squared truth if the weights of all but the outermost hit are summed; without bias for k from 2.
    /// `counted` selects whose weights are summed, while all are looked up.
    ///
    /// Given the weights, whose order by distance is random, the variance is Σw² (n - k + 1)/(k - 2), and the mean Σw.
    pub fn variance_without_last(&self, counted: Counted) -> f64 {
        let sums = self.sums(counted);
        let k = self.k as f64;
        let given = (sums.counted_squares - (k - 1.0) * sums.squares) / (k - 2.0);
        self.relative(counted, sums.variance + given, sums.mean)
    }

    /// Variance over the squared truth (not the mean) if the weights of all k are summed; the factor is [`factor_of_all`].
    ///
    /// Given the weights, the mean square is (Σw)² k/(k - 2) + Σw² k (n - k) / ((k - 1)(k - 2)).
    pub fn variance_of_all(&self, counted: Counted) -> f64 {
        let sums = self.sums(counted);
        let k = self.k as f64;
        let factor = factor_of_all(self.k);
        let square = sums.variance + sums.mean * sums.mean;
        let spread = sums.counted_squares - k * sums.squares;
        let second = k / (k - 2.0) * (square + spread / (k - 1.0));
        self.relative(counted, second - factor * factor * sums.mean * sums.mean, sums.mean)
    }

    fn relative(&self, counted: Counted, variance: f64, mean: f64) -> f64 {
        let grows = self.albedo * self.albedo >= self.q && !matches!(counted, Counted::Only(_));
        if self.k == 2 || grows { f64::INFINITY } else { variance / (mean * mean) }
    }

    fn sums(&self, counted: Counted) -> Sums {
        assert!(self.k >= 2 && self.photons >= self.k, "{} nearest of {}", self.k, self.photons);
        assert!(self.q > 0.0 && self.q < 1.0, "photons survive with probability {}", self.q);
        let one = Photons::uniform(self.albedo, self.q);
        let (photons, mean, hits) = (self.photons as f64, one.mean(counted), 1.0 / (1.0 - self.q));
        let (squares, own) = self.squares(counted);
        Sums {
            mean: photons * mean,
            variance: photons * (one.second(1.0, counted) - mean * mean),
            squares: photons * squares,
            // a photon's squares times its own hits, and times those of all others
            counted_squares: photons * own + photons * (photons - 1.0) * hits * squares,
        }
    }

    /// E Σw² of one photon's counted hits, and E (Σw²) (its number of hits): hit j exists with probability q^j, and is then
    /// followed by q/(1 - q) more.
    fn squares(&self, counted: Counted) -> (f64, f64) {
        let u = self.albedo * self.albedo / self.q;
        let hits = |j: u32| f64::from(j) + 1.0 / (1.0 - self.q);
        let from = |j: u32| {
            let rest = power(u, j) / (1.0 - u);
            (rest, rest * (hits(j) + u / (1.0 - u)))
        };
        match counted {
            Counted::All => from(0),
            Counted::Only(j) => (power(u, j), power(u, j) * hits(j)),
            Counted::From(j) => from(j),
        }
    }
}

/// Moments over random sets of n weighted hits.
struct Sums {
    /// E Σw
    mean: f64,
    /// Var Σw
    variance: f64,
    /// E Σw²
    squares: f64,
    /// E n Σw²
    counted_squares: f64,
}
