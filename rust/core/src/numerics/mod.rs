//! The numerical ground: scalars and SIMD lanes, double-double, elementary functions, random numbers.

pub mod double_double;
pub mod element;
pub mod lanes;
pub mod real;
pub mod simd;
