//! Scattering: two-body kinematics, Rutherford's closed forms, and the Monte Carlo.

pub mod deflection;
pub mod event_table;
pub mod histogram;
pub mod kinematics;
pub mod monte_carlo;
mod reach;
pub mod rutherford;
