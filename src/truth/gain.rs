//! How much next-event estimation gains over waiting for hits, as the size of the light varies: on a sphere of one
//! albedo and one light, with cosine-distributed directions, where both variances are known. The ratios are the same
//! wherever on the sphere one looks.

/// A sphere of one albedo with a light on part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneLight {
    /// Share of the sphere's area that emits, in (0, 1].
    pub fraction: f64,
    /// Albedo of all of the sphere, in (0, 1).
    pub albedo: f64,
    /// Survival probability after every vertex, in (0, 1); above albedo², or both variances are infinite.
    pub q: f64,
}

impl OneLight {
    /// Variance of the implicit estimator over that of the explicit one.
    pub fn variance_ratio(&self) -> f64 {
        let OneLight { fraction, albedo, q } = *self;
        let square = albedo * albedo;
        let light = (1.0 - albedo) * (1.0 - albedo + 2.0 * fraction * albedo) / fraction;
        (light - (q - square)) / (square * (1.0 - q))
    }

    /// Efficiency, 1 / (variance x rays), of the explicit estimator over that of the implicit one: a shadow ray at each
    /// vertex doubles the rays.
    pub fn efficiency_ratio(&self) -> f64 {
        0.5 * self.variance_ratio()
    }
}

/// The share of the sphere up to which a light is worth a shadow ray at each vertex, in (0, 1]. It is 1 for albedo up to
/// 1/√2: explicit is then the more efficient one even where all of the sphere emits.
pub fn largest_light_worth_sampling(albedo: f64, q: f64) -> f64 {
    let square = albedo * albedo;
    if square <= 0.5 {
        return 1.0;
    }
    let dark = 1.0 - albedo;
    dark * dark / (q * (1.0 - 2.0 * square) + 3.0 * square - 2.0 * albedo)
}
