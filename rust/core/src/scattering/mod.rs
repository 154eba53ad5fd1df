//! Scattering: two-body kinematics and collisions in space, Rutherford's closed forms, and the Monte Carlo.

pub mod bins;
pub mod contact;
pub mod cross_sections;
pub mod deflection;
pub mod event_table;
pub mod foil;
pub mod histogram;
pub mod impact;
pub mod kinematics;
mod kronrod;
pub mod moderation;
pub mod monte_carlo;
mod reach;
pub mod rutherford;
