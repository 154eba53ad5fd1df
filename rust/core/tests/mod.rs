//! The laws that the whole of the crate is held to, written as its users would: by its public names.
//!
//! They are a room of the unit tests and no programs of their own, so that one program is built and not nine.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, missing_docs)]

mod allocation;
mod gravity;
mod kepler_edges;
mod kepler_laws;
mod kepler_reference;
mod methods;
mod support;
mod two_body;
