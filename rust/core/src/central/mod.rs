//! Motion in a central potential: where it turns, in what time, and through what angle.
//!
//! The one idea: on circles the energy is U(r) = V + r V′/2, a function of the distance alone; where r²(E − V) is
//! stationary, U = E. So what a potential can do is found once ([`landscape`]), and every question after that is a
//! root between two places, of which there is one or none.

pub mod circles;
pub mod field;
pub mod inverse_cube;
pub mod landscape;
pub mod motion;
mod quadrature;
pub mod range;
pub mod roots;
pub mod state;
