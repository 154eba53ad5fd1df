//! Classical mechanics: integrators, N-body, closed forms, scattering Monte Carlo. No Python anywhere.
//!
//! A room knows the rooms below it and never those above:
//! numerics ← potentials ← forces ← nbody, scattering ← closed_forms ← scene.

pub mod central;
pub mod closed_forms;
pub mod conservation;
pub mod error;
pub mod expressions;
pub mod forces;
pub mod generalized;
pub mod memory;
pub mod narrow;
pub mod nbody;
pub mod numerics;
pub mod ode;
pub mod parallel;
pub mod potentials;
pub mod registry;
pub mod rigid;
pub mod scattering;
pub mod scene;
pub mod units;
pub mod words;

pub use error::{Error, Result};

#[cfg(test)]
extern crate self as visviva_core;
#[cfg(test)]
#[path = "../tests/mod.rs"]
mod laws;

pub(crate) use numerics::simd::tiered;
