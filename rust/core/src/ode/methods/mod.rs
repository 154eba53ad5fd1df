//! The methods, one file each: a table of coefficients, and what the method declares about itself.

pub mod dop853;
pub mod kahan_li8;
pub mod leapfrog;
pub mod rk4;
pub mod stormer13;
pub mod yoshida4;
