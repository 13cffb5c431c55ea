//! Promise: a stream is a pure function of its address, the same on every machine and in every version, and streams of
//! neighbouring addresses have nothing to do with each other.
//!
//! The statistical tests share one false alarm probability of 1e-9, were the key drawn anew; it is fixed, so a test
//! that passes passes always. Each of the ALARMS statistics is held to its share, one part in ALARMS.

use furnace::sampling::{Address, Stream};
use rand::{Rng, SeedableRng};
use rand_pcg::{Pcg32, Pcg64Mcg};
use rand_xoshiro::Xoshiro128PlusPlus;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Statistics tested here: for wide and narrow streams each 2 moments, 53 bits or 24, 4 correlations and as many tables of
/// pairs, rounded up.
const ALARMS: f64 = 128.0;
/// Two-sided bound of a normal variable for a false alarm probability of 1e-9 / 128.
const SIGMAS: f64 = 6.77;
const N: u64 = 1 << 18;

fn address() -> Address {
    Address::of(&["streams_are_reproducible"])
}

/// A stream of either kind.
type Draw = fn(&Address, u64, u64) -> Stream;
const KINDS: [(Draw, usize); 2] = [(Address::stream, 53), (Address::narrow_stream, 24)];

/// First numbers of consecutive streams and of the streams next to them in each coordinate.
fn neighbours(draw: Draw) -> [(&'static str, Vec<(f64, f64)>); 4] {
    let pairs = |f: &dyn Fn(u64) -> (Stream, Stream)| {
        let first = |k| {
            let (mut a, mut b) = f(k);
            (a.u1(), b.u1())
        };
        (0..N).map(first).collect::<Vec<_>>()
    };
    let other = Address::of(&["streams_are_reproducible", ""]);
    let at = |k, pixel| draw(&address(), k, pixel);
    [
        ("realization", pairs(&|k| (at(k, 0), at(k + 1, 0)))),
        ("pixel", pairs(&|k| (at(7, k), at(7, k + 1)))),
        ("swapped", pairs(&|k| (at(k, k + 1), at(k + 1, k)))),
        ("key", pairs(&|k| (at(k, 3), draw(&other, k, 3)))),
    ]
}

/// The reference outputs of PCG's C library for the same seeds: the dependency is the generator that it says it is.
#[test]
fn the_generator_is_pcg() {
    let mut pcg32 = Pcg32::new(42, 54);
    let golden = [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e];
    assert_eq!(golden.map(|_| pcg32.next_u32()), golden);
    let mut mcg = Pcg64Mcg::new(42);
    let golden = [0x63b4_a3a8_13ce_700a, 0x3829_5420_0617_ab24, 0xa7fd_85ae_3fe9_50ce];
    assert_eq!(golden.map(|_| mcg.next_u64()), golden);
}

/// Narrow streams are xoshiro128++ as its authors' generator gives it, started from the address, 24 bits of each number.
#[test]
fn narrow_streams_are_xoshiro() {
    for (realization, pixel) in [(0, 0), (1, 0), (0, 1), (u64::MAX, 7)] {
        let mut narrow = address().narrow_stream(realization, pixel);
        let words = narrow.narrow_state().unwrap();
        let seed: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let mut published = Xoshiro128PlusPlus::from_seed(seed.try_into().unwrap());
        for _ in 0..1000 {
            let number = narrow.u1() * f64::from(1 << 24);
            assert_eq!(number, f64::from(published.next_u32() >> 8));
        }
    }
    assert_eq!(address().stream(0, 0).narrow_state(), None);
}

/// 2^53 u1 of the first draws, computed by an independent program (Python: hashlib and integers of any size).
#[test]
fn first_outputs_are_pinned() {
    let draws = |parts: &[&str], realization, pixel| {
        let mut s = Address::of(parts).stream(realization, pixel);
        [s.u1(), s.u1(), s.u1()].map(|u| (u * (1u64 << 53) as f64) as u64)
    };
    let golden = [0x1009a9_6b6c0623, 0x1bfc1e_057cef74, 0x0bf4ec_86c2d771];
    assert_eq!(draws(&["furnace"], 0, 0), golden);
    assert_eq!(draws(&["furnace"], 1, 0), [0x1519fe_cd02a3a5, 0x18c410_2fefae79, 0x9d747_52b67ad5]);
    assert_eq!(draws(&["furnace"], 0, 1), [0x135c4e_913633b0, 0xd459a_f134e39a, 0x129698_f8dac16a]);
    let probe = draws(&["1", "cornell_box", "explicit"], 123_456_789, 1023);
    assert_eq!(probe, [0x133e73_a5f363b7, 0xbfb89_861c534f, 0x1d1351_592c5182]);
    let last = draws(&["ab", "c"], u64::MAX, u64::MAX);
    assert_eq!(last, [0x14443f_552aaff8, 0x5bc31_f440b4a0, 0x1323a3_6fef1b83]);
}

#[test]
fn parts_are_prefixed_by_their_length() {
    let keys =
        [&["ab", "c"][..], &["a", "bc"], &["abc"], &["abc", ""], &["", "abc"], &["c", "ab"], &[], &[""]];
    for (i, a) in keys.iter().enumerate() {
        for b in &keys[..i] {
            assert_ne!(Address::of(a), Address::of(b), "{a:?} {b:?}");
        }
    }
}

#[test]
fn the_order_of_use_does_not_matter() {
    let (mut a, mut b) = (address().stream(5, 6), address().stream(6, 6));
    let mixed: Vec<f64> = (0..20).map(|i| if i % 2 == 0 { a.u1() } else { b.u1() }).collect();
    let (mut a, mut b) = (address().stream(5, 6), address().stream(6, 6));
    let (b, a): (Vec<f64>, Vec<f64>) = ((0..10).map(|_| b.u1()).collect(), (0..10).map(|_| a.u1()).collect());
    assert!((0..10).all(|i| mixed[2 * i] == a[i] && mixed[2 * i + 1] == b[i]));
    let mut points = address().stream(5, 6);
    assert_eq!((points.u2(), points.u2()), ((a[0], a[1]), (a[2], a[3])));
}

/// 2^20 streams cover 2^106 first pairs of numbers: two alike have a probability of 2^-67. The generator's states 2k
/// and 2k+1 are one generator, so counters that reached it unmixed would show here.
#[test]
fn no_two_streams_begin_alike() {
    for (realizations, pixels, start) in
        [(1u64 << 20, 1u64, 0u64), (1 << 10, 1 << 10, 0), (2, 1 << 19, u64::MAX - 1)]
    {
        let addresses = (0..realizations * pixels).map(|i| (start.wrapping_add(i / pixels), i % pixels));
        let bits = |mut s: Stream| (s.u1().to_bits(), s.u1().to_bits());
        let mut first: Vec<_> = addresses.map(|(k, pixel)| bits(address().stream(k, pixel))).collect();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len() as u64, realizations * pixels);
    }
}

/// Every number is a multiple of 2^-53 below 1, or of 2^-24, and each of its bits is set half of the time in the first numbers of
/// consecutive streams, whose mean and variance are 1/2 and 1/12. Sees a mean off by 0.004, a bit by 0.007.
#[test]
fn first_numbers_are_uniform() {
    let n = N as f64;
    for (draw, bits) in KINDS {
        let (mut sum, mut squares, mut set) = (0.0, 0.0, vec![0u32; bits]);
        for k in 0..N {
            let u = draw(&address(), k, 0).u1();
            let scaled = u * (1u64 << bits) as f64;
            assert!((0.0..1.0).contains(&u) && scaled.fract() == 0.0, "{u}");
            sum += u - 0.5;
            squares += (u - 0.5).powi(2) - 1.0 / 12.0;
            (0..bits).for_each(|bit| set[bit] += (scaled as u64 >> bit & 1) as u32);
        }
        // variances of u - 1/2 and of its square: 1/12 and 1/80 - 1/144 = 1/180
        let (mean, variance) = (sum / (n / 12.0).sqrt(), squares / (n / 180.0).sqrt());
        assert!(mean.abs() < SIGMAS && variance.abs() < SIGMAS, "{mean} {variance}");
        for (bit, set) in set.into_iter().enumerate() {
            let z = (2.0 * f64::from(set) - n) / n.sqrt();
            assert!(z.abs() < SIGMAS, "bit {bit} of {bits}: {z}");
        }
    }
}

/// Correlation 0, and pairs uniform over 32 x 32 cells. Sees a correlation of 0.013 and any pattern on that grid.
#[test]
fn neighbouring_streams_are_independent() {
    const CELLS: usize = 32;
    let n = N as f64;
    for (name, pairs) in KINDS.into_iter().flat_map(|(draw, _)| neighbours(draw)) {
        let correlation = pairs.iter().map(|(a, b)| 12.0 * (a - 0.5) * (b - 0.5)).sum::<f64>() / n;
        assert!(correlation.abs() * n.sqrt() < SIGMAS, "{name}: correlation {correlation}");
        let mut counts = [0u32; CELLS * CELLS];
        let cell = |u: f64| (u * CELLS as f64) as usize;
        pairs.iter().for_each(|&(a, b)| counts[cell(a) * CELLS + cell(b)] += 1);
        let expected = n / counts.len() as f64;
        let chi2 = counts.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum::<f64>();
        let p = ChiSquared::new(counts.len() as f64 - 1.0).unwrap().sf(chi2);
        assert!(p > 1e-9 / ALARMS, "{name}: chi-square {chi2}, p = {p}");
    }
}
