//! Promise: what theory says of direct light agrees with quadrature, ray counting and simulation that share no code with
//! it.

mod common;
mod direct_variance;
mod form_factor;
mod point_light;
mod tile;
mod visibility;
