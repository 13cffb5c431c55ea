//! Averages over a pixel and a lens, the variance of sampling them, and what they add to the variance of
//! paths.

use crate::scene::camera::Lens;
use std::f64::consts::PI;

/// Probability that U + V <= `x`, with U and V independent and uniform on intervals of widths `a` and `b` >=
/// 0 around 0: a step smoothed by two boxes. Absolute error below 1e-15.
pub fn two_boxes(x: f64, a: f64, b: f64) -> f64 {
    let (wide, narrow) = (a.max(b), 0.5 * a.min(b));
    if x >= 0.5 * wide + narrow {
        return 1.0;
    }
    if x <= -0.5 * wide - narrow {
        return 0.0;
    }
    // max(u, 0) averaged over the narrow box; its difference over the wide one does not cancel for thin boxes
    let ramp = |u: f64| {
        if u >= narrow {
            u
        } else if u <= -narrow {
            0.0
        } else {
            (u + narrow) * (u + narrow) / (4.0 * narrow)
        }
    };
    (ramp(x + 0.5 * wide) - ramp(x - 0.5 * wide)) / wide
}

/// A straight edge across a square pixel around the origin: white where x cos φ + y sin φ <= d. Lengths in
/// pixel widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// cos φ.
    pub cos: f64,
    /// sin φ.
    pub sin: f64,
    /// Signed distance d from the pixel's centre to the edge.
    pub distance: f64,
}

impl Edge {
    /// The edge whose normal is at `angle` (rad) to the x axis.
    pub fn new(angle: f64, distance: f64) -> Self {
        Edge { cos: libm::cos(angle), sin: libm::sin(angle), distance }
    }

    /// White part of the pixel, in [0, 1]. Absolute error below 1e-15.
    pub fn coverage(&self) -> f64 {
        two_boxes(self.distance, self.cos.abs(), self.sin.abs())
    }

    /// Variance of the mean of `samples` independent uniform samples: p (1 - p) / N.
    pub fn random_variance(&self, samples: u32) -> f64 {
        let p = self.coverage();
        p * (1.0 - p) / f64::from(samples)
    }

    /// Variance of the mean of one uniform sample in each of `n` x `n` cells: Σ p_i (1 - p_i) / n⁴ over the
    /// cells' coverages. For an edge along a side, frac(n p) (1 - frac(n p)) / n³. [Mitchell 1996]
    pub fn stratified_variance(&self, n: u32) -> f64 {
        let cells = f64::from(n);
        let centre = |i: u32| (f64::from(i) + 0.5) / cells - 0.5;
        let cell = |(i, j): (u32, u32)| {
            let shift = self.cos * centre(i) + self.sin * centre(j);
            let p = Edge { distance: cells * (self.distance - shift), ..*self }.coverage();
            p * (1.0 - p)
        };
        (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(cell).sum::<f64>()
            / (cells * cells * cells * cells)
    }
}

/// Variance of the mean of `samples` uniform samples of a linear image with these gradients per pixel width.
pub fn ramp_random_variance(gradient: [f64; 2], samples: u32) -> f64 {
    (gradient[0] * gradient[0] + gradient[1] * gradient[1]) / (12.0 * f64::from(samples))
}

/// The same for one sample in each of `n` x `n` cells: each varies 1/n² as much, and there are n² of them.
pub fn ramp_stratified_variance(gradient: [f64; 2], n: u32) -> f64 {
    let cells = f64::from(n) * f64::from(n);
    (gradient[0] * gradient[0] + gradient[1] * gradient[1]) / (12.0 * cells * cells)
}

/// White part under a tent filter of total width 2 pixels, for an edge along a side at signed `distance` from
/// its centre.
pub fn tent_coverage(distance: f64) -> f64 {
    two_boxes(distance, 1.0, 1.0)
}

/// Radius, in an object plane at `distance` > 0, of the disc that one image point averages.
/// [Potmesil & Chakravarty 1981]
pub fn blur(lens: &Lens, distance: f64) -> f64 {
    lens.radius * (distance - lens.focus).abs() / lens.focus
}

/// White part of a disc of radius `blur` >= 0 of which everything up to `edge` from its centre is white: an
/// edge in an object plane seen through a lens. In focus, 1 where `edge` >= 0.
pub fn edge_through_lens(edge: f64, blur: f64) -> f64 {
    if edge.abs() >= blur {
        return if edge >= 0.0 { 1.0 } else { 0.0 };
    }
    let s = edge / blur;
    0.5 + (s * (1.0 - s * s).sqrt() + libm::asin(s)) / PI
}

/// The same for a white disc of `radius` > 0 with its centre at `offset`. Absolute error below 1e-13 times
/// the square of max(radius / blur, 1).
pub fn disc_through_lens(radius: f64, offset: f64, blur: f64) -> f64 {
    let offset = offset.abs();
    if offset >= radius + blur {
        return 0.0;
    }
    if offset <= (radius - blur).abs() {
        return if radius >= blur { 1.0 } else { radius * radius / (blur * blur) };
    }
    // each circle's segment beyond the common chord, which is `foot` from its centre
    let segment = |r: f64, foot: f64| {
        let s = (foot / r).clamp(-1.0, 1.0);
        r * r * (libm::acos(s) - s * (1.0 - s * s).sqrt())
    };
    let foot = (offset * offset + radius * radius - blur * blur) / (2.0 * offset);
    (segment(radius, foot) + segment(blur, offset - foot)) / (PI * blur * blur)
}

/// [`edge_through_lens`] averaged over a box pixel of `width` > 0 in the object plane.
pub fn edge_through_lens_and_pixel(edge: f64, blur: f64, width: f64) -> f64 {
    // the integral of `edge_through_lens` up to u
    let area = |u: f64| {
        if u.abs() >= blur {
            return u.max(0.0);
        }
        let s = u / blur;
        let root = (1.0 - s * s).sqrt();
        blur * (0.5 * s + (s * libm::asin(s) + root - root * root * root / 3.0) / PI)
    };
    (area(edge + 0.5 * width) - area(edge - 0.5 * width)) / width
}

/// Mean and variance of a path through one point of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Expected radiance.
    pub mean: f64,
    /// Variance of one path.
    pub variance: f64,
}

/// The two parts of the variance of one sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// By the paths: remains however the pixel is sampled.
    pub within: f64,
    /// By where in the pixel the path starts: goes where the pixel is stratified ever finer.
    pub between: f64,
}

impl Parts {
    /// Variance of one sample with a uniform position.
    pub fn total(self) -> f64 {
        self.within + self.between
    }
}

/// Law of total variance for a pixel that is covered to a part `p` by one side and else by the other. With a
/// black `outside` the sum is p (V + m²) - p² m².
pub fn joint_variance(p: f64, inside: Side, outside: Side) -> Parts {
    let step = inside.mean - outside.mean;
    Parts { within: p * inside.variance + (1.0 - p) * outside.variance, between: p * (1.0 - p) * step * step }
}
