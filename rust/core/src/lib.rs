//! Classical mechanics: integrators, N-body, closed forms, scattering Monte Carlo. No Python anywhere.
//!
//! A room knows the rooms below it and never those above:
//! numerics ← potentials ← forces ← nbody, scattering ← scene.

pub mod error;
pub mod nbody;
pub mod numerics;

pub use error::{Error, Result};
