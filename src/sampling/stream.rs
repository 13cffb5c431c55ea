//! Keyed random streams: a stream's address is its content, so a result does not depend on threads, order or neighbours.
//!
//! Generator: PCG64 MCG [O'Neill 2014]. Its states 2k and 2k+1 are one and the same generator, so small counters
//! are never passed raw: a state is a 128-bit mix of (key, realization, pixel). Narrow streams, which run side by side in
//! the lanes of `fast`, come from xoshiro128++ [Blackman & Vigna 2021], whose state is that mix, too.

use rand::Rng;
use rand_pcg::Pcg64Mcg;
use sha2::{Digest, Sha256};

/// Where a family of streams lives: a hash of everything that defines what is sampled (seed, scene, estimator, purpose).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    key: [u64; 2],
}

impl Address {
    /// The address of the given parts. Parts are length-prefixed: `["ab", "c"]` and `["a", "bc"]` differ.
    pub fn of(parts: &[&str]) -> Self {
        let mut hash = Sha256::new();
        for part in parts {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part.as_bytes());
        }
        let digest = hash.finalize();
        let word =
            |at: usize| (0..8).fold(0u64, |word, byte| word | (u64::from(digest[at + byte]) << (8 * byte)));
        Address { key: [word(0), word(8)] }
    }

    /// The address of the `n`-th repetition of what lives here.
    pub fn repetition(&self, n: u64) -> Self {
        let [a, b] = self.key.map(|word| word.to_string());
        Address::of(&[&a, &b, "repetition", &n.to_string()])
    }

    /// The stream of one pixel in one realization (`pixel` = 0 for a probe).
    ///
    /// (realization, pixel) -> state is injective up to the lowest bit, which the generator ignores.
    #[inline]
    pub fn stream(&self, realization: u64, pixel: u64) -> Stream {
        let (high, low) = self.state(realization, pixel);
        Stream { generator: Generator::Wide(Pcg64Mcg::new((u128::from(high) << 64) | u128::from(low))) }
    }

    /// The narrow stream of one pixel in one realization: multiples of 2^-24, which single precision holds.
    ///
    /// All bits of the state count. One state in 2^128, all zeros, would stay at zero.
    #[inline]
    pub fn narrow_stream(&self, realization: u64, pixel: u64) -> Stream {
        let (high, low) = self.state(realization, pixel);
        let halves = |word: u64| [word as u32, (word >> 32) as u32];
        let ([a, b], [c, d]) = (halves(low), halves(high));
        Stream { generator: Generator::Narrow([a, b, c, d]) }
    }

    #[inline]
    fn state(&self, realization: u64, pixel: u64) -> (u64, u64) {
        let a = mix(self.key[0].wrapping_add(realization.wrapping_mul(GOLDEN)));
        let low = mix((self.key[1] ^ a).wrapping_add(pixel.wrapping_mul(GOLDEN)));
        (mix(a ^ low), low)
    }
}

/// 2^64 / golden ratio, odd: the Weyl increment of SplitMix64 [Steele, Lea & Flood 2014].
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finalizer of SplitMix64 (Stafford's variant 13): a bijection of 64-bit words.
#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A sequence of independent uniform numbers in [0, 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Stream {
    generator: Generator,
}

#[derive(Clone, Debug, PartialEq)]
enum Generator {
    Wide(Pcg64Mcg),
    Narrow([u32; 4]),
}

impl Stream {
    /// A multiple of 2^-53 in [0, 1), of a narrow stream one of 2^-24; 1 is never returned.
    #[inline]
    pub fn u1(&mut self) -> f64 {
        const WIDE: f64 = 1.0 / (1u64 << 53) as f64;
        const NARROW: f64 = 1.0 / (1u64 << 24) as f64;
        match &mut self.generator {
            Generator::Wide(rng) => (rng.next_u64() >> 11) as f64 * WIDE,
            Generator::Narrow(state) => f64::from(next_narrow(state) >> 8) * NARROW,
        }
    }

    /// A point of the unit square.
    #[inline]
    pub fn u2(&mut self) -> (f64, f64) {
        (self.u1(), self.u1())
    }

    /// An address that is drawn from this stream: 106 random bits of a wide one, or 48.
    pub fn branch(&mut self) -> Address {
        let mut word = || mix(self.u1().to_bits());
        Address { key: [word(), word()] }
    }

    /// Where a narrow stream has got to; `None` for a wide one.
    #[inline]
    pub fn narrow_state(&self) -> Option<[u32; 4]> {
        match self.generator {
            Generator::Wide(_) => None,
            Generator::Narrow(state) => Some(state),
        }
    }
}

/// xoshiro128++ [Blackman & Vigna 2021].
#[inline]
fn next_narrow([a, b, c, d]: &mut [u32; 4]) -> u32 {
    let number = a.wrapping_add(*d).rotate_left(7).wrapping_add(*a);
    let shifted = *b << 9;
    *c ^= *a;
    *d ^= *b;
    *b ^= *c;
    *a ^= *d;
    *c ^= shifted;
    *d = d.rotate_left(11);
    number
}
