//! Densities that know their measure, so that one per area is never divided where one per solid angle is meant.

/// A probability density per solid angle [1/sr].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PdfW(pub f64);

/// A probability density per surface area [1/m²].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PdfA(pub f64);

impl PdfA {
    /// The density of the direction from `x` towards a point whose density per area is `self`:
    /// p_w = p_A d² / cos θ' [Veach 1997, eq. 8.2].
    ///
    /// `distance_squared` (m²) lies between `x` and the point; `cos_at_point` in (0, 1] is taken there.
    #[inline]
    pub fn per_solid_angle(self, distance_squared: f64, cos_at_point: f64) -> PdfW {
        PdfW(self.0 * distance_squared / cos_at_point)
    }
}

impl PdfW {
    /// The inverse of [`PdfA::per_solid_angle`].
    #[inline]
    pub fn per_area(self, distance_squared: f64, cos_at_point: f64) -> PdfA {
        PdfA(self.0 * cos_at_point / distance_squared)
    }
}
