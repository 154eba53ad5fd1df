//! Scattering: closed forms over arrays, and the Monte Carlo.

pub(crate) mod closed_forms;
pub(crate) mod cross_sections;
pub(crate) mod deflection;
pub(crate) mod monte_carlo;
