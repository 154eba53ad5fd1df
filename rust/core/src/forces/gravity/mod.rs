//! Newtonian gravity, summed directly.
//!
//! Every kernel computes a pair as `d = x_j - x_i`, `r² = ((dx² [+ ε²]) + dy²) + dz²`, `w = r⁻³`, products
//! fused with the sums they go into; [`inverse_cube`](crate::numerics::inverse_cube) says how w is computed.
//! The order in which a body's terms are added is canonical:
//!
//! - up to eight massive bodies ([`few`]): partners `i+1, i-1, i+2, i-2, …` around the ring of indices,
//!   whether the lanes are bodies ([`ring`]) or trajectories ([`few`]): the same bits alone and in a batch;
//! - up to sixteen ([`two_rows`]): two such rings, and each body of the second with the eight of the first;
//! - more ([`tiles`]): by third-law tiles in fixed shards, the same on any number of threads;
//! - a massless body adds the massive ones in order of index ([`passive`]).
//!
//! A massless body exerts nothing, so pairs of them are never formed.

pub(super) mod beside;
pub mod closed;
pub mod derivative;
pub mod energy;
pub mod few;
mod many;
pub mod newton;
mod pair;
pub mod passive;
mod relative;
pub mod ring;
pub mod series;
pub mod tiles;
pub mod two_rows;

pub use few::FewBodies;
pub(super) use many::ManyBodies;
pub use ring::Ring;
pub use tiles::Tiles;
pub use two_rows::TwoRows;

/// The most massive bodies that the ring order serves.
pub const RING_MAX: usize = 8;

/// The most bodies whose coordinates stay in registers over a step of a multistep method.
pub const CLOSED_MAX: usize = 3;
