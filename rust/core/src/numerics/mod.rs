//! The numerical ground: scalars and SIMD lanes, double-double, elementary functions, random numbers.

pub mod angles;
pub mod binary;
pub mod cosine;
pub mod decay;
pub mod double_double;
pub mod element;
pub mod elementary;
pub mod elliptic;
pub mod exponentials;
pub mod functions;
pub mod fused_double;
pub(crate) mod integrals;
pub mod inverse_cube;
pub mod lanes;
pub mod logarithm;
pub mod matrix_exponential;
pub mod philox;
pub mod points;
pub mod power;
pub mod power_of_two;
pub mod real;
pub mod rotation;
mod rough_power;
pub mod rows;
pub mod scaled;
pub mod simd;
pub mod stumpff;
