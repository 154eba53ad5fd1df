//! Scattering: two-body kinematics, Rutherford's closed forms, and the Monte Carlo.

pub mod histogram;
pub mod kinematics;
pub mod monte_carlo;
pub mod rutherford;
