//! Where particles come from: an emitter picked by power, a point on it, a direction in which it shines.

use super::{Emitter, Lights, Pick};
use crate::sampling::warp::{Frame, cosine_hemisphere, disk, sphere_band};
use crate::scene::geometry::NOWHERE;
use crate::scene::{Ray, Rgb, Surface};
use std::f64::consts::PI;

/// A particle that has just left a light.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Its way.
    pub ray: Ray,
    /// The power that it stands for, if it stands for all light alone, in watts.
    pub power: Rgb,
}

impl Lights {
    /// A particle of the light that shines at `time`: `u` picks the emitter by power, `v` the point on it and `w` the
    /// direction, with density cos θ / (π area) for a surface, 1 / 4π for a point [Jensen 2001, sec. 5.1], and for the
    /// sky in proportion to its radiance, through the disk that the scene fills. `None` in the dark.
    #[inline]
    pub fn emit(
        &self,
        surfaces: &[Surface],
        time: f64,
        u: f64,
        v: (f64, f64),
        w: (f64, f64),
    ) -> Option<Emission> {
        let (light, pmf) = self.pick(Pick::Power, u)?;
        Some(match light.emitter {
            Emitter::Surface(id, pdf) => {
                let surface = &surfaces[id as usize];
                let (point, frame) = surface.sample_area(v);
                let d = frame.to_world(cosine_hemisphere(w));
                let ray = Ray { o: point + surface.velocity * time, d, from: id };
                Emission { ray, power: surface.material.le * (PI / (pdf.0 * pmf)) }
            }
            Emitter::Point(light) => {
                let ray = Ray { o: light.position, d: sphere_band(-1.0, 1.0, w), from: NOWHERE };
                Emission { ray, power: light.intensity * (4.0 * PI / pmf) }
            }
            Emitter::Sky(sky) => {
                let (wi, (x, y)) = (sky.sample(w), disk(v));
                let frame = Frame::around(-wi);
                let side = frame.to_world(glam::DVec3::new(x, y, 0.0));
                let ray = Ray { o: self.center + self.radius * (side + wi), d: -wi, from: NOWHERE };
                let area = PI * self.radius * self.radius;
                Emission { ray, power: sky.radiance(wi) * (area / (sky.pdf(wi).0 * pmf)) }
            }
        })
    }
}
