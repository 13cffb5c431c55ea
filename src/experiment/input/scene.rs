//! What a scene is made of.

use super::{PerChannel, Sweep, check, swept};
use crate::scene::Rgb;
use crate::scene::many_spheres::COUNTS;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// Albedo: each channel in [0, 1].
pub fn albedo<'de, D: Deserializer<'de>>(d: D) -> Result<Rgb, D::Error> {
    let rgb = PerChannel::deserialize(d)?.0;
    let wanted = "an albedo lies in [0, 1]; more would create energy";
    rgb.to_array().iter().try_for_each(|&v| check((0.0..=1.0).contains(&v), v, wanted))?;
    Ok(rgb)
}

/// As [`albedo`], where the key may be absent.
pub fn optional_albedo<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Rgb>, D::Error> {
    albedo(d).map(Some)
}

/// A part of a refractive index: each channel finite and not negative.
pub fn index<'de, D: Deserializer<'de>>(d: D) -> Result<Rgb, D::Error> {
    let rgb = PerChannel::deserialize(d)?.0;
    let wanted = "a refractive index is finite and not negative";
    rgb.to_array().iter().try_for_each(|&v| check(v.is_finite() && v >= 0.0, v, wanted))?;
    Ok(rgb)
}

/// Radiance [W m^-2 sr^-1]: each channel finite and not negative.
pub fn radiance<'de, D: Deserializer<'de>>(d: D) -> Result<Rgb, D::Error> {
    let rgb = PerChannel::deserialize(d)?.0;
    let wanted = "emitted radiance is finite and not negative";
    rgb.to_array().iter().try_for_each(|&v| check(v.is_finite() && v >= 0.0, v, wanted))?;
    Ok(rgb)
}

/// Tiles of the Cornell box, to sweep over: 1 to 6.
pub fn tiles<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    swept(d, "a tile has a number from 1 to 6", |v| v.fract() == 0.0 && (1.0..=6.0).contains(&v))
}

/// Fractions of an area, to sweep over: inside (0, 1).
pub fn fractions<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    swept(d, "a fraction of the sphere's area lies inside (0, 1)", |v| v > 0.0 && v < 1.0)
}

/// A length: finite and positive.
pub fn length<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(v > 0.0 && v.is_finite(), v, "a length is finite and positive")?;
    Ok(v)
}

/// A refractive index relative to another: finite and positive.
pub fn relative_index<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(v > 0.0 && v.is_finite(), v, "a relative refractive index is finite and positive")?;
    Ok(v)
}

/// An exponent of a cosine.
pub fn exponent<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check((0.0..=1e6).contains(&v), v, "an exponent lies in 0 to 1000000")?;
    Ok(v)
}

/// Roughness of a surface: from what is all but polished to 1.
pub fn roughness<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(
        (0.001..=1.0).contains(&v),
        v,
        "a roughness lies in [0.001, 1]; a polished metal is a `conductor`",
    )?;
    Ok(v)
}

/// Pixels along an image's edge: 1 to 4096.
pub fn resolution<'de, D: Deserializer<'de>>(d: D) -> Result<u32, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=4096).contains(&v), v, "a resolution lies in 1 to 4096 pixels")?;
    Ok(v as u32)
}

/// A point or vector: three finite numbers.
pub fn vector<'de, D: Deserializer<'de>>(d: D) -> Result<glam::DVec3, D::Error> {
    let v = <[f64; 3]>::deserialize(d)?;
    v.iter().try_for_each(|&x| check(x.is_finite(), x, "coordinates are finite"))?;
    Ok(v.into())
}

/// A direction: three finite numbers, not all zero; normalized here.
pub fn direction<'de, D: Deserializer<'de>>(d: D) -> Result<glam::DVec3, D::Error> {
    let v = vector(d)?;
    v.try_normalize().ok_or_else(|| D::Error::custom("a direction must not be the zero vector"))
}

/// A field of view in degrees.
pub fn field_of_view<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    check(v > 0.0 && v < 180.0, v, "a field of view lies inside (0, 180) degrees")?;
    Ok(v)
}

/// Pixels along the shorter edge of an image that is 4 : 3: 1 to 3072.
pub fn wide_resolution<'de, D: Deserializer<'de>>(d: D) -> Result<u32, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=3072).contains(&v), v, "the resolution of a 4 : 3 image lies in 1 to 3072 rows of pixels")?;
    Ok(v as u32)
}

/// Half the edge of a small light, to sweep over.
pub fn half_edges<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    let wanted = "half the edge of the light lies in [0.0001, 0.3]; a point light is `point = true`";
    swept(d, wanted, |v| (1e-4..=0.3).contains(&v)).map(Some)
}

/// The radius of a lens, to sweep over.
pub fn apertures<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    swept(d, "the radius of the lens lies in (0, 0.5]", |v| v > 0.0 && v <= 0.5).map(Some)
}

/// How far something goes, to sweep over.
pub fn travels<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    swept(d, "the board goes between 0 and 1 to the right", |v| (0.0..=1.0).contains(&v)).map(Some)
}

/// Numbers of balls, to sweep over.
pub fn ball_counts<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    let (least, most) = (*COUNTS.start(), *COUNTS.end());
    let wanted = format!("a number of balls is a whole number from {least} to {most}");
    swept(d, &wanted, |v| v.fract() == 0.0 && (f64::from(least)..=f64::from(most)).contains(&v)).map(Some)
}
