//! Variational integrators: the action of a discrete path made stationary, instead of equations of motion solved.
//!
//! The one idea: the action of a segment between two places, L_d(q₀, q₁) ≈ ∫ L dt, is that of a polynomial through them, summed
//! by a quadrature ([`table`]); its inner points make the sum stationary. p₀ = −∂L_d/∂q₀ and p₁ = ∂L_d/∂q₁ are then a step from
//! (q₀, p₀) to (q₁, p₁) ([`step`]), symplectic for any Lagrangian whatever the polynomial and the quadrature are, and with the
//! momentum of every symmetry of L that the quadrature shares. Further forces enter by their virtual work along the same
//! polynomials, and holonomic constraints by multipliers at both ends, which is RATTLE.
//! J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, sections 1.5, 2.2, 3.2 and 3.5; E. Hairer, C. Lubich & G. Wanner,
//! *Geometric Numerical Integration* (2006), VI.6 and VII.1.
//!
//! Polynomials of degree s with the s points of Gauss's quadrature are Gauss's collocation of Hamilton's equations (VI.6, there),
//! which [`gauss`](super::gauss) does on the Hamiltonian; beyond the midpoint, which is that of degree 1, they are not here.

mod balance;
mod equations;
mod newton;
mod node;
pub mod path;
mod step;
mod table;
mod trial;
mod velocities;

use crate::ode::methods::{kahan_li6, kahan_li8, yoshida4};
use crate::ode::{self, Scheme};
pub use equations::Equations;
use table::Rule;
pub(super) use trial::DiscreteStep;

/// A method of this family.
#[derive(Debug)]
pub struct Method {
    /// Its name in the Python interface.
    pub name: &'static str,
    /// Its order.
    pub order: u32,
    /// Whether it is for holonomic constraints; the others are for none.
    pub constrained: bool,
    rule: &'static Rule,
    /// The composition whose drifts a step is made of, if it is more than one.
    composition: Option<&'static ode::Method>,
}

/// A method without constraints and composition.
const fn variational(name: &'static str, order: u32, rule: &'static Rule) -> Method {
    Method { name, order, constrained: false, rule, composition: None }
}

/// RATTLE, or a composition of it.
const fn rattle(name: &'static str, order: u32, composition: Option<&'static ode::Method>) -> Method {
    Method { name, order, constrained: true, rule: &table::TRAPEZOIDAL, composition }
}

/// The methods of this family.
pub static METHODS: [Method; 9] = [
    variational("variational_midpoint", 2, &table::MIDPOINT),
    variational("variational_trapezoidal", 2, &table::TRAPEZOIDAL),
    variational("variational_lobatto4", 4, &table::LOBATTO4),
    variational("variational_lobatto6", 6, &table::LOBATTO6),
    variational("variational_lobatto8", 8, &table::LOBATTO8),
    rattle("rattle", 2, None),
    rattle("rattle4", 4, Some(&yoshida4::METHOD)),
    rattle("rattle6", 6, Some(&kahan_li6::METHOD)),
    rattle("rattle8", 8, Some(&kahan_li8::METHOD)),
];

/// The method of that name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

impl Method {
    /// The lengths of the parts of a step, in units of it.
    fn parts(&self) -> Vec<f64> {
        match self.composition.map(|method| &method.scheme) {
            Some(Scheme::Splitting(table)) => table.drifts.iter().map(|drift| drift.to_f64()).collect(),
            _ => vec![1.0],
        }
    }
}
