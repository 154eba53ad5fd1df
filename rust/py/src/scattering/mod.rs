//! Scattering: kinematics, collisions and closed forms over arrays, and the Monte Carlo.

mod broadcast;
pub(crate) mod closed_forms;
pub(crate) mod collisions;
pub(crate) mod cross_sections;
pub(crate) mod deflection;
pub(crate) mod foil;
pub(crate) mod kinematics;
pub(crate) mod monte_carlo;
