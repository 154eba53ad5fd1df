//! What the package offers, one line each: methods and potentials.

use crate::ode::Method;
use crate::ode::methods::{dop853, kahan_li8, leapfrog, rk4, stormer13, yoshida4};
use crate::potentials::{Declaration, coulomb, lennard_jones, yukawa};

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
pub static POTENTIALS: &[&Declaration] =
    &[&coulomb::DECLARATION, &yukawa::DECLARATION, &lennard_jones::DECLARATION];

/// The potential of a name.
pub fn potential(name: &str) -> Option<&'static Declaration> {
    POTENTIALS.iter().copied().find(|declaration| declaration.name == name)
}
