//! Scattering: two-body kinematics, Rutherford's closed forms, and the Monte Carlo.

pub mod cross_sections;
pub mod deflection;
pub mod histogram;
pub mod kinematics;
pub mod monte_carlo;
mod reach;
pub mod rutherford;
