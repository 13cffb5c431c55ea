//! Direct light in closed form: what a point sees of a light, past what stands between, and how its estimators scatter.

pub mod convex;
pub mod cornell_direct;
pub mod direct_variance;
pub mod form_factor;
pub mod point_light;
pub mod tile;
pub mod visibility;
