//! Colour spaces in which differences are seen: all from linear sRGB, whose white is (1, 1, 1) in XYZ here.

use crate::scene::Rgb;
use glam::{DMat3, DVec3, Vec3Swizzles};

/// Linear sRGB to XYZ relative to white, and what follows from it.
pub struct Colours {
    to_xyz: DMat3,
    to_opponent: DMat3,
    from_opponent: DMat3,
}

impl Colours {
    /// From the chromaticities of IEC 61966-2-1, with one digit more of its white, D65, as FLIP has them.
    pub fn new() -> Self {
        let xyz = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
        let white = xyz(0.31271, 0.32902);
        let primaries = DMat3::from_cols(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
        let amounts = primaries.inverse() * white;
        let to_xyz = DMat3::from_diagonal(1.0 / white) * primaries * DMat3::from_diagonal(amounts);
        // CIELAB without its roots: brightness, red less green, yellow less blue; its constant 16 cancels out here
        let opponent = DMat3::from_cols(
            DVec3::new(0.0, 500.0, 0.0),
            DVec3::new(116.0, -500.0, 200.0),
            DVec3::new(0.0, 0.0, -200.0),
        );
        let to_opponent = opponent * to_xyz;
        Colours { to_xyz, to_opponent, from_opponent: to_opponent.inverse() }
    }

    /// Brightness and two colour differences, linear in the colour: the space Y Cx Cz, plus 16 in Y.
    pub fn opponent(&self, colour: Rgb) -> DVec3 {
        self.to_opponent * colour
    }

    /// Back again.
    pub fn of_opponent(&self, opponent: DVec3) -> Rgb {
        self.from_opponent * opponent
    }

    /// CIELAB with the colour differences lessened in the dark, as Hunt found: a and b are scaled by L / 100.
    pub fn hunt_lab(&self, colour: Rgb) -> DVec3 {
        const KNEE: f64 = 6.0 / 29.0;
        let root = |t: f64| {
            if t > KNEE * KNEE * KNEE { libm::cbrt(t) } else { t / (3.0 * KNEE * KNEE) + 4.0 / 29.0 }
        };
        let [x, y, z] = (self.to_xyz * colour).to_array().map(root);
        let lightness = 116.0 * y - 16.0;
        DVec3::new(lightness, 5.0 * lightness * (x - y), 2.0 * lightness * (y - z))
    }
}

/// The distance HyAB (Abasi, Tehran and Fairchild 2020): that of lightness and that of colour, added.
pub fn hyab(a: DVec3, b: DVec3) -> f64 {
    let difference = a - b;
    difference.x.abs() + difference.yz().length()
}
