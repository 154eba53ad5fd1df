//! Bodies that attract or repel each other by an inverse square: closed forms of two bodies.

pub mod anomalies;
mod conic;
pub mod constants;
pub mod elements;
pub mod kepler;
mod kepler_equation;
pub mod state;
pub mod state_again;
pub mod two_body;
