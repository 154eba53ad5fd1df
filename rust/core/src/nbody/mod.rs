//! Bodies that attract or repel each other by an inverse square: closed forms of two bodies.

mod conic;
pub mod kepler;
mod kepler_equation;
