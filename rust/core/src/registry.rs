//! What the package offers, one line each: methods, potentials, forces and closed forms.

use crate::closed_forms::{self, ClosedForm};
use crate::error::{Error, Result};
use crate::forces::gravity::newton;
use crate::forces::{
    ForceDeclaration, central_field, coulomb as charges, damper, drag, driven_force, expression, harmonic,
    linear_drag, oblate, pair_potential, post_newtonian, quadratic_drag, rotating_frame, spring,
    uniform_electric_field, uniform_field, uniform_magnetic_field,
};
use crate::ode::Method;
use crate::ode::methods::{
    blanes_moan_rkn4, blanes_moan_rkn6_11, blanes_moan_rkn6_14, blanes_moan_s6, blanes_moan_s10,
    bogacki_shampine32, boris, boris4, dop853, dormand_prince54, euler, heun, kahan_li6, kahan_li8, leapfrog,
    leapfrog_dkd, mclachlan4, midpoint, pefrl4, rk4, ruth3, sofroniou_spaletta6, sofroniou_spaletta8,
    sofroniou_spaletta10, stormer13, symplectic_euler, taylor, tsitouras54, verner98, yoshida4, yoshida6,
    yoshida8,
};
use crate::ode::system::{Form, Needs};
use crate::potentials::{
    PotentialDeclaration, buckingham, coulomb, expressed, hard_sphere, lennard_jones, mie, morse,
    piecewise_polynomial, plummer, power_law, screened_coulomb, soft_sphere, square_well, tabulated, yukawa,
};
use crate::words::unknown;

/// Every integration method, in the order of the documentation.
pub static METHODS: &[&Method] = &[
    &euler::METHOD,
    &midpoint::METHOD,
    &heun::METHOD,
    &rk4::METHOD,
    &bogacki_shampine32::METHOD,
    &dormand_prince54::METHOD,
    &tsitouras54::METHOD,
    &dop853::METHOD,
    &verner98::METHOD,
    &taylor::METHOD,
    &symplectic_euler::METHOD,
    &leapfrog::METHOD,
    &leapfrog_dkd::METHOD,
    &ruth3::METHOD,
    &yoshida4::METHOD,
    &mclachlan4::METHOD,
    &pefrl4::METHOD,
    &blanes_moan_s6::METHOD,
    &blanes_moan_rkn4::METHOD,
    &yoshida6::METHOD,
    &kahan_li6::METHOD,
    &sofroniou_spaletta6::METHOD,
    &blanes_moan_s10::METHOD,
    &blanes_moan_rkn6_11::METHOD,
    &blanes_moan_rkn6_14::METHOD,
    &yoshida8::METHOD,
    &kahan_li8::METHOD,
    &sofroniou_spaletta8::METHOD,
    &sofroniou_spaletta10::METHOD,
    &boris::METHOD,
    &boris4::METHOD,
    &stormer13::METHOD,
];

/// The method of a name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().copied().find(|method| method.name == name)
}

/// Those for rigid bodies alone, with the order of the discrete motion that is their drift.
pub use crate::rigid::motion::methods::METHODS as BODY_METHODS;

/// The methods for scenes, those with rigid bodies among them or without.
pub fn methods_for(rigid: bool) -> impl Iterator<Item = &'static Method> + Clone {
    let bodies = if rigid { &BODY_METHODS[..] } else { &[] };
    METHODS.iter().copied().chain(bodies.iter().map(|(method, _)| *method))
}

/// Names of SciPy's `solve_ivp`, and ours.
static SCIPY: [(&str, &str); 3] =
    [("RK23", "bogacki_shampine32"), ("RK45", "dormand_prince54"), ("DOP853", "dop853")];
/// Those of its methods that solve equations in every step.
static IMPLICIT: [&str; 3] = ["Radau", "BDF", "LSODA"];

/// The method of a name, ours or SciPy's, for equations `y' = f(t, y)`.
///
/// # Errors
/// A name that is none, or of a method that does not take such equations; the message lists those that do.
pub fn solver(name: &str) -> Result<&'static Method> {
    let serves = |method: &&Method| {
        method.serves(Form::FirstOrder(1), Needs { time: true, velocity: true, rotation: false })
    };
    let ours = METHODS.iter().copied().filter(serves).map(|method| method.name);
    let names = SCIPY.iter().map(|(scipy, _)| *scipy).chain(ours);
    let refused = |why: &str| {
        let names = names.clone().collect::<Vec<_>>().join(", ");
        Err(Error::invalid("method", format!("{name} {why}; use one of {names}")))
    };
    if IMPLICIT.contains(&name) {
        return refused(
            "is implicit, which scipy.integrate.solve_ivp has for stiff equations and visviva has not",
        );
    }
    let own = SCIPY.iter().find(|(scipy, _)| *scipy == name).map_or(name, |(_, own)| own);
    match method(own) {
        None => Err(unknown("method", name, names)),
        Some(method) if serves(&method) => Ok(method),
        Some(_) => refused("takes equations q'' = a(q) alone, and this is y' = f(t, y)"),
    }
}

/// Every potential, in the order of the documentation.
pub static POTENTIALS: &[&PotentialDeclaration] = &[
    &coulomb::DECLARATION,
    &power_law::DECLARATION,
    &yukawa::DECLARATION,
    &lennard_jones::DECLARATION,
    &mie::DECLARATION,
    &morse::DECLARATION,
    &buckingham::DECLARATION,
    &plummer::DECLARATION,
    &soft_sphere::DECLARATION,
    &square_well::DECLARATION,
    &hard_sphere::DECLARATION,
    &screened_coulomb::DECLARATION,
    &tabulated::DECLARATION,
    &piecewise_polynomial::DECLARATION,
    &expressed::DECLARATION,
];

/// The potential of a name.
pub fn potential(name: &str) -> Option<&'static PotentialDeclaration> {
    POTENTIALS.iter().copied().find(|declaration| declaration.name == name)
}

/// Every force, in the order of the documentation.
pub static FORCES: &[&ForceDeclaration] = &[
    &newton::DECLARATION,
    &charges::DECLARATION,
    &oblate::DECLARATION,
    &post_newtonian::DECLARATION,
    &uniform_field::DECLARATION,
    &central_field::DECLARATION,
    &harmonic::DECLARATION,
    &linear_drag::DECLARATION,
    &quadratic_drag::DECLARATION,
    &drag::named::DECLARATION,
    &drag::sampled::DECLARATION,
    &uniform_electric_field::DECLARATION,
    &uniform_magnetic_field::DECLARATION,
    &driven_force::DECLARATION,
    &rotating_frame::DECLARATION,
    &spring::DECLARATION,
    &damper::DECLARATION,
    &pair_potential::DECLARATION,
    &expression::DECLARATION,
];

/// The force of a name.
pub fn force(name: &str) -> Option<&'static ForceDeclaration> {
    FORCES.iter().copied().find(|declaration| declaration.name == name)
}

/// Every closed form; of those that apply to an ensemble member, the first is taken.
pub static CLOSED_FORMS: &[&ClosedForm] = &[
    &closed_forms::free::FORM,
    &closed_forms::uniform::FORM,
    &closed_forms::two_body::FORM,
    &closed_forms::one_massive::FORM,
    &closed_forms::fixed_center::FORM,
    &closed_forms::linear_drag::FORM,
    &closed_forms::crossed_fields::FORM,
    &closed_forms::rotating_frame::FORM,
    &closed_forms::oscillation::FORM,
    &closed_forms::quadratic_drag::FORM,
    &closed_forms::linear_forces::FORM,
];
