//! The decision rules of other tools, from their formulas, to be compared with ours.
//!
//! Own code after the formulas in the files named below, at or near the commits named.
//! Single precision is replaced by double: the rules are meant to be seen at their
//! best. "Fires" means that the tool reports a defect.
//!
//! Of simulated images without a defect (64² pixels, 488 samples, coefficient of variation 1)
//! Mitsuba's rule fires in 0 of 3000; a uniform bias of 8.7 % it finds half of the time.
//! Eradiate's t tests at 5 % reject the truth in 95 % (independent) and 99.8 to 99.9 % (paired).

use super::{Moments, multiplicity, student};

/// Family level of [`mitsuba`], [`nori`] and [`WelchMap::fires`].
const ALPHA: f64 = 0.01;

/// Whether the render test of Mitsuba 3 fails (`src/render/tests/test_renders.py`, commit
/// b45b0a93): a z test of each pixel at a level by Šidák, of which 99.75 % must pass.
///
/// One `Moments` a pixel, one channel. `reference` is the true radiance and
/// `reference_variance` that of one sample of the *reference* renderer, used for the
/// tested one, too, and at least 1e-4 (radiance squared, whatever the scene's unit).
pub fn mitsuba(pixels: &[Moments], reference: f64, reference_variance: f64) -> bool {
    let variance = reference_variance.max(1e-4);
    let level = multiplicity::sidak(ALPHA, pixels.len());
    let passes = |pixel: &&Moments| {
        let z = (pixel.mean - reference).abs() * libm::sqrt(pixel.n as f64 / variance);
        // 2 (1 - Φ(z))
        libm::erfc(z / std::f64::consts::SQRT_2) > level
    };
    (pixels.iter().filter(passes).count() as f64) < 0.9975 * pixels.len() as f64
}

/// Whether the integrator test of pbrt-v4 fails (`src/pbrt/cpu/integrators_test.cpp`, commit
/// 5f7a6068): the mean of the image is off by more than 0.025, where the truth is 1; here
/// relative to `truth`, in the unit of `mean`.
pub fn pbrt(mean: f64, truth: f64) -> bool {
    let error = (mean / truth - 1.0).abs();
    error > 0.025 || error.is_nan()
}

/// Whether the t test of Nori rejects (`src/ttest.cpp`, commit 092f581b, with `hypothesis.h`,
/// commit 3acfea6c): one reference, two-sided at 1 %, and a variance of at least
/// 1e-5 (squared unit of the values). Nori draws 100 000 paths; here n is that of `moments`.
pub fn nori(moments: &Moments, truth: f64) -> bool {
    let Some(variance) = moments.variance() else { return false };
    let t = (moments.mean - truth).abs() * libm::sqrt(moments.n as f64 / variance.max(1e-5));
    student::two_sided_p(t, (moments.n - 1) as f64) < ALPHA
}

/// What the Welch tool shows of two images.
#[derive(Clone, Debug, PartialEq)]
pub struct WelchMap {
    /// Two-sided p-value of each tile; NaN where neither image varies or one is not finite.
    pub p: Vec<f64>,
    /// The smallest p-value; NaN if there is none.
    pub smallest: f64,
    /// Share of the p-values below 5 %, in 0..=1; 0 if there is none.
    pub below_5_percent: f64,
}

/// The map of the Rust port (detect-bias-welch, `src/lib.rs`, commit a876519c) of Jung,
/// Hanika & Dachsbacher (2020): Welch's t test of each tile, with its degrees of freedom
/// rounded to an integer. One channel.
///
/// # Panics
/// If the images have different numbers of tiles, as the tool does.
pub fn welch_map(ours: &[Moments], theirs: &[Moments]) -> WelchMap {
    assert_eq!(ours.len(), theirs.len(), "both images must have the same tiles");
    let p: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| welch(a, b)).collect();
    let valid = || p.iter().copied().filter(|p| !p.is_nan());
    let smallest = valid().fold(f64::NAN, f64::min);
    let below = valid().filter(|&p| p < 0.05).count();
    WelchMap { smallest, below_5_percent: below as f64 / valid().count().max(1) as f64, p }
}

impl WelchMap {
    /// A reading of the map as a test at 1 %. The tool leaves it to the eye; this one is ours:
    /// the smallest p-value lies below the level by Šidák for so many tiles.
    pub fn fires(&self) -> bool {
        let tiles = self.p.iter().filter(|p| !p.is_nan()).count();
        self.smallest < multiplicity::sidak(ALPHA, tiles)
    }
}

fn welch(a: &Moments, b: &Moments) -> f64 {
    let (Some(se_a), Some(se_b)) = (a.std_error(), b.std_error()) else { return f64::NAN };
    let variance = se_a * se_a + se_b * se_b;
    if variance == 0.0 || !variance.is_finite() {
        return f64::NAN;
    }
    let df = student::welch_df(se_a, (a.n - 1) as f64, se_b, (b.n - 1) as f64);
    student::two_sided_p((a.mean - b.mean) / libm::sqrt(variance), libm::round(df))
}

/// p-value of the independent t test of Eradiate (`src/eradiate/test_tools/regression.py`,
/// commit 25c35e43): means over k angles, each with the squared standard error of its
/// `Moments` as its variance. Its t is √k times too large, because a pooled variance *of the
/// mean* is divided by k once more. NaN below two angles.
pub fn eradiate_independent(ours: &[Moments], theirs: &[Moments]) -> f64 {
    let (a, b) = (ours.len() as f64, theirs.len() as f64);
    let pooled = ((a - 1.0) * variance_of_mean(ours) + (b - 1.0) * variance_of_mean(theirs)) / (a + b - 2.0);
    let t = (mean(ours) - mean(theirs)) / libm::sqrt(pooled * (1.0 / a + 1.0 / b));
    student::two_sided_p(t, a + b - 2.0)
}

/// p-value of the paired t test of Eradiate (same file), without covariance: it divides by the
/// *variance* of the mean difference over √k, so that it depends on the unit. NaN below
/// two angles.
///
/// # Panics
/// If the numbers of angles differ.
pub fn eradiate_paired(ours: &[Moments], theirs: &[Moments]) -> f64 {
    assert_eq!(ours.len(), theirs.len(), "both must have the same angles");
    let angles = ours.len() as f64;
    let variance = variance_of_mean(ours) + variance_of_mean(theirs);
    let t = (mean(ours) - mean(theirs)) / (variance / libm::sqrt(angles));
    student::two_sided_p(t, angles - 1.0)
}

fn mean(values: &[Moments]) -> f64 {
    values.iter().map(|m| m.mean).sum::<f64>() / values.len() as f64
}

/// Σ variance / k², the variance of a mean of k independent values.
fn variance_of_mean(values: &[Moments]) -> f64 {
    let variance = |m: &Moments| m.std_error().map_or(f64::NAN, |se| se * se);
    values.iter().map(variance).sum::<f64>() / (values.len() * values.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    /// What `n` samples look like that have exactly this mean and variance.
    fn exact(n: u64, mean: f64, variance: f64) -> Moments {
        Moments { n, mean, m2: variance * (n - 1) as f64, ..Moments::default() }
    }

    /// An image of means with standard deviation `sd` and exactly known variance.
    fn image(source: &mut Source, pixels: usize, n: u64, mean: f64, sd: f64) -> Vec<Moments> {
        let variance = sd * sd * n as f64;
        (0..pixels).map(|_| exact(n, mean + sd * source.normal(), variance)).collect()
    }

    /// The rate at which `rule` fires in `runs` tries.
    fn rate(runs: usize, mut rule: impl FnMut(&mut Source) -> bool) -> f64 {
        let mut source = Source(12);
        (0..runs).filter(|_| rule(&mut source)).count() as f64 / runs as f64
    }

    /// 64² pixels of 488 samples with a coefficient of variation of 1.
    fn mitsuba_fires(source: &mut Source, bias: f64) -> bool {
        let pixels = image(source, 4096, 488, 1.0 + bias, 1.0 / 488_f64.sqrt());
        mitsuba(&pixels, 1.0, 1.0)
    }

    #[test]
    fn mitsuba_finds_a_bias_of_nine_percent_half_of_the_time_and_never_errs() {
        assert_eq!(rate(300, |s| mitsuba_fires(s, 0.0)), 0.0);
        // the bias of power one half, by bisection
        let (mut low, mut high) = (0.0, 0.2);
        for _ in 0..8 {
            let bias = (low + high) / 2.0;
            if rate(100, |s| mitsuba_fires(s, bias)) < 0.5 { low = bias } else { high = bias }
        }
        // 8.6 % by the binomial distribution of the failing pixels
        assert!((high / 0.086 - 1.0).abs() < 0.1, "{high}");
    }

    #[test]
    fn mitsuba_tolerates_ten_broken_pixels_and_all_dark_ones() {
        let mut pixels = vec![exact(100, 1.0, 1.0); 4096];
        pixels[..10].fill(exact(100, 1e6, 1.0));
        assert!(!mitsuba(&pixels, 1.0, 1.0));
        pixels[10] = pixels[0];
        assert!(mitsuba(&pixels, 1.0, 1.0));
        pixels[0].mean = f64::NAN;
        assert!(mitsuba(&pixels, 1.0, 1.0));
        // twice the truth, 100 standard errors away, below the floor of the variance
        let dark = vec![exact(10_000, 2e-4, 1e-12); 4096];
        assert!(!mitsuba(&dark, 1e-4, 1e-12));
    }

    #[test]
    fn pbrt_and_nori() {
        assert!(!pbrt(1.02, 1.0) && pbrt(1.03, 1.0) && pbrt(-2.0, -1.9) && pbrt(f64::NAN, 1.0));
        let alarms = rate(2000, |s| {
            let mut m = Moments::default();
            (0..200).for_each(|_| m.push(s.normal()));
            nori(&m, 0.0)
        });
        assert!((0.004..0.018).contains(&alarms), "{alarms}");
        // t = 2.58 and 2.64 with 2.5760 needed
        assert!(!nori(&exact(100_000, 1.008, 1.0), 1.0) && nori(&exact(100_000, 1.0082, 1.0), 1.0));
        // in the dark the floor silences it: 3 % off, 31 standard errors
        assert!(!nori(&exact(100_000, 0.000021, 1e-10), 0.00002));
    }

    #[test]
    fn welch_by_hand_and_under_equality() {
        let map = welch_map(&[exact(5, 1.0, 4.0)], &[exact(9, 3.0, 1.0)]);
        // t = -2 / √(4/5 + 1/9), df = 5.13 rounded to 5
        let p = student::two_sided_p(2.0 / (0.8_f64 + 1.0 / 9.0).sqrt(), 5.0);
        assert!((map.p[0] / p - 1.0).abs() < 1e-12 && map.smallest == map.p[0]);
        let mut shares = Moments::default();
        let alarms = rate(500, |s| {
            let mut tile = |_| {
                let mut m = Moments::default();
                (0..30).for_each(|_| m.push(s.normal()));
                m
            };
            let (a, b): (Vec<_>, Vec<_>) = (0..64).map(|i| (tile(i), tile(i))).unzip();
            let map = welch_map(&a, &b);
            shares.push(map.below_5_percent);
            map.fires()
        });
        assert!((shares.mean - 0.05).abs() < 0.004 && alarms < 0.026, "{} {alarms}", shares.mean);
        let biased =
            |s: &mut Source| welch_map(&image(s, 64, 30, 1.0, 0.1), &image(s, 64, 30, 1.6, 0.1)).fires();
        assert_eq!(rate(50, biased), 1.0);
        let nothing = welch_map(&[exact(5, 1.0, 0.0)], &[exact(5, 2.0, 0.0)]);
        assert!(nothing.p[0].is_nan() && nothing.smallest.is_nan() && !nothing.fires());
    }

    #[test]
    fn eradiate_rejects_the_truth() {
        let both = |test: fn(&[Moments], &[Moments]) -> f64, sd: f64| {
            rate(1000, |s| test(&image(s, 1024, 9, 1.0, sd), &image(s, 1024, 9, 1.0, sd)) < 0.05)
        };
        // P(|Z| > 1.96 / √1024) = 95.1 %; 94.6 % were reported
        let independent = both(eradiate_independent, 1.0);
        assert!((independent - 0.951).abs() < 0.025, "{independent}");
        // P(|Z| > 1.96 √2 sd / 1024) = 99.8 % for sd = 1, and 99.9 % for 1/2; 99.9 % were reported
        let paired = both(eradiate_paired, 0.5);
        assert!(paired >= 0.995, "{paired}");
        // and in another unit it never fires
        assert_eq!(both(eradiate_paired, 1e4), 0.0);
    }
}
