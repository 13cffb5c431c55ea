//! Pseudo-random data of known laws, for the tests of this module and for [`super::nulls`]: fixed seeds, and the same
//! bits on every platform.

/// SplitMix64 (Steele, Lea & Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct Source(pub(crate) u64);

impl Source {
    /// One of many under a seed. States that differ by a multiple of the step would run through the same numbers; hashed
    /// ones do so by accident only.
    pub(crate) fn keyed(seed: u64, key: u64) -> Self {
        Source(Source(Source(seed).bits().wrapping_add(key)).bits())
    }

    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In (0, 1), never an end.
    pub(crate) fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Mean 1, variance 1, skewness 2.
    pub(crate) fn exponential(&mut self) -> f64 {
        -libm::log(self.uniform())
    }

    /// Mean 0, variance 1 (Box & Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(2.0 * self.exponential());
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// 1/p with probability p, else 0: mean 1.
    pub(crate) fn rare(&mut self, p: f64) -> f64 {
        if self.uniform() < p { 1.0 / p } else { 0.0 }
    }

    /// K >= 1 with P(K > k) = q^k.
    #[cfg(test)]
    pub(crate) fn geometric(&mut self, q: f64) -> u64 {
        1 + libm::floor(libm::log(self.uniform()) / libm::log(q)) as u64
    }

    /// A walk of constant survival probability `q` in a furnace of albedo 1/2
    /// and emission 1: mean 2, tail index ln(1/q) / ln(1/(2q)), variance finite
    /// if and only if q > 1/4.
    #[cfg(test)]
    pub(crate) fn furnace(&mut self, q: f64) -> f64 {
        let (k, ratio) = (self.geometric(q) as f64, 0.5 / q);
        if ratio == 1.0 { k } else { (libm::pow(ratio, k) - 1.0) / (ratio - 1.0) }
    }
}
