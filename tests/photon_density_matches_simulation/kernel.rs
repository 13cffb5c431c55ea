//! Kernels against integrals over the disc.

use crate::common::{KERNELS, close, over_disc, weight};
use furnace::truth::density::Kernel;
use std::f64::consts::PI;

const WHOLE: f64 = 1.0;

#[test]
fn normalization_makes_the_integral_one() {
    for kernel in KERNELS {
        let integral = over_disc(WHOLE, |x, y| kernel.profile(x.hypot(y)));
        close(kernel.share() * PI, integral, 1e-12);
        close(kernel.normalization(0.3), 0.09 * integral, 1e-12);
        for s in [0.0, 0.2, 0.9] {
            close(kernel.profile(s) / kernel.normalization(1.0), weight(kernel, s), 1e-12);
        }
        assert_eq!(kernel.profile(1.01), 0.0);
    }
}

#[test]
fn variance_is_the_integral_of_the_square() {
    for kernel in KERNELS {
        let square = over_disc(WHOLE, |x, y| weight(kernel, x.hypot(y)).powi(2));
        close(kernel.variance(), square * PI, 1e-12);
    }
    // the flattest kernel has the least variance
    close(Kernel::Cone { c: 1e9 }.variance(), 1.0, 1e-9);
}

#[test]
fn moments_and_bias_are_integrals() {
    for kernel in KERNELS {
        for n in 0..5 {
            let moment = over_disc(WHOLE, |x, y| weight(kernel, x.hypot(y)) * (x * x + y * y).powi(n));
            close(kernel.moment(n as u32), moment, 1e-12);
        }
        // a field of Laplacian 7 with linear and cubic terms
        let field = |x: f64, y: f64| 2.0 + x - 3.0 * y + 2.0 * x * x + 1.5 * y * y + x * y * y;
        let mean = over_disc(WHOLE, |x, y| weight(kernel, x.hypot(y)) * field(x, y));
        close(kernel.bias() * 7.0, mean - 2.0, 1e-12);
    }
}
