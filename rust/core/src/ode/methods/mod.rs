//! The methods, one file each: a table of coefficients, and what the method declares about itself.

pub mod bogacki_shampine32;
pub mod boris;
pub mod dop853;
pub mod dormand_prince54;
pub mod kahan_li8;
pub mod leapfrog;
pub mod rk4;
pub mod stormer13;
pub mod yoshida4;
