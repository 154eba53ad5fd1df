//! Time transformations: what a symplectic method watches so that its steps in time may change, and how.
//!
//! The one idea: steps that are chosen from one to the next are no map of phase space, and a symplectic method whose steps are
//! chosen so drifts like any other. Steps that are equal in a fictitious time s, with dt = ds/Ω, are such a map: kicks and drifts
//! stay explicit where the drift's rate is told by velocities (or by a number that kicks carry along) and the kick's by coordinates.
//!
//! - `potential_energy`, Ω = −V: the logarithmic Hamiltonian Γ = ln(T + B) − ln(−V) with the binding energy B = −(T + V) at the
//!   start (Mikkola & Tanikawa, Mon. Not. R. Astron. Soc. 310 (1999) 745; Preto & Tremaine, Astron. J. 118 (1999) 2532). It is
//!   separable, so that every composition of kicks and drifts is symplectic in (q, t; p, B); two bodies stay on their conic
//!   and err in the time alone.
//! - `distance`, Ω = Σ 1/r: time-transformed leapfrog (Mikkola & Aarseth, Celest. Mech. Dyn. Astron. 84 (2002) 343). Drifts are
//!   at the rate 1/W, and kicks change W by ∂Ω/∂q·v, so that W follows Ω; reversible whatever the forces are.

use super::{Method, Scheme};

/// What is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transformation {
    /// The potential energy.
    PotentialEnergy,
    /// The distances.
    Distance,
}

impl Transformation {
    /// All there are.
    pub const ALL: [Self; 2] = [Self::PotentialEnergy, Self::Distance];

    /// Its name in the Python interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PotentialEnergy => "potential_energy",
            Self::Distance => "distance",
        }
    }
}

/// What tells how fast time goes.
pub trait Monitor<S>: Send {
    /// Ω at those coordinates; writes ∂Ω/∂q, if there is room for it.
    fn at(&mut self, q: &[S], gradient: &mut [S]) -> S;

    /// The kinetic energy.
    fn kinetic_energy(&self, v: &[S]) -> S;
}

impl Method {
    /// Whether its steps may be equal in another time: kicks and drifts whose order holds for any two flows, and in symmetric
    /// turns, as all that is composed of leapfrogs. The rate of a drift is no longer linear in the momenta, so that Nyström
    /// splittings lose their order; what is not symmetric is not reversible in any time.
    pub const fn transforms(&self) -> bool {
        matches!(self.scheme, Scheme::Splitting(_)) && self.reversible
    }
}
