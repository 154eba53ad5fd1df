//! What the package offers, one line each: methods, potentials and forces.

use crate::forces::gravity::newton;
use crate::forces::{ForceDeclaration, central_field, uniform_field};
use crate::ode::Method;
use crate::ode::methods::{dop853, kahan_li8, leapfrog, rk4, stormer13, yoshida4};
use crate::potentials::{PotentialDeclaration, coulomb, lennard_jones, yukawa};

/// Every integration method, in the order of the documentation.
pub static METHODS: &[&Method] = &[
    &rk4::METHOD,
    &dop853::METHOD,
    &leapfrog::METHOD,
    &yoshida4::METHOD,
    &kahan_li8::METHOD,
    &stormer13::METHOD,
];

/// The method of a name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().copied().find(|method| method.name == name)
}

/// Every potential, in the order of the documentation.
pub static POTENTIALS: &[&PotentialDeclaration] =
    &[&coulomb::DECLARATION, &yukawa::DECLARATION, &lennard_jones::DECLARATION];

/// The potential of a name.
pub fn potential(name: &str) -> Option<&'static PotentialDeclaration> {
    POTENTIALS.iter().copied().find(|declaration| declaration.name == name)
}

/// Every force, in the order of the documentation.
pub static FORCES: &[&ForceDeclaration] =
    &[&newton::DECLARATION, &uniform_field::DECLARATION, &central_field::DECLARATION];

/// The force of a name.
pub fn force(name: &str) -> Option<&'static ForceDeclaration> {
    FORCES.iter().copied().find(|declaration| declaration.name == name)
}
