//! Two-body kinematics over arrays.

use super::broadcast::{Array, Rows, each};
use crate::arrays::moved;
use crate::gate::compute;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use visviva_core::scattering::kinematics::{Circle, Collision, Encounter, HalfAngle, Reaction};
use visviva_core::scattering::moderation::Moderation;
use visviva_core::{Error, Result};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A function of an encounter and an angle, by name.
type Function = fn(&Encounter, f64) -> Result<f64>;
/// A function of a reaction, by name.
type ReactionFunction = fn(&Reaction) -> f64;

/// Of the two scattering angles that lead to a laboratory angle; NaN where there is none.
fn branch<const WHICH: usize>(circle: Circle, lab_angle: f64) -> f64 {
    let [first, second] = circle.branches(lab_angle);
    [first, second].get(WHICH).copied().flatten().map_or(f64::NAN, |(angle, _)| angle)
}

/// The same of a target's angle: it goes the other way.
fn recoil_branch<const WHICH: usize>(circle: Circle, lab_angle: f64) -> f64 {
    circle.complements(lab_angle).get(WHICH).copied().flatten().unwrap_or(f64::NAN)
}

/// What a projectile has of the beam energy at a laboratory angle.
fn kept_at<const WHICH: usize>(encounter: &Encounter, lab_angle: f64) -> Result<f64> {
    let parts = encounter.projectile().energies(lab_angle)?;
    parts.get(WHICH).copied().flatten().ok_or_else(|| {
        Error::invalid(
            "branch",
            "expected 'fast': only one energy leads to a laboratory angle here, got 'slow'",
        )
    })
}

const FUNCTIONS: &[(&str, Function)] = &[
    ("lab_angle", |of, angle| Ok(of.projectile().circle().lab_angle(HalfAngle::of(angle)))),
    ("recoil_angle", |of, angle| Ok(of.target().circle().lab_angle(HalfAngle::of(angle).mirrored()))),
    ("opening_angle", |of, angle| Ok(of.opening_angle(HalfAngle::of(angle)))),
    ("energy_kept", |of, angle| Ok(of.projectile().energy(HalfAngle::of(angle)))),
    ("energy_transfer", |of, angle| Ok(of.target().energy(HalfAngle::of(angle).mirrored()))),
    ("lab_jacobian", |of, angle| Ok(of.projectile().circle().jacobian(HalfAngle::of(angle)))),
    ("recoil_jacobian", |of, angle| Ok(of.target().circle().jacobian(HalfAngle::of(angle).mirrored()))),
    ("cm_angle", |of, angle| Ok(branch::<0>(of.projectile().circle(), angle))),
    ("second_cm_angle", |of, angle| Ok(branch::<1>(of.projectile().circle(), angle))),
    ("recoil_cm_angle", |of, angle| Ok(recoil_branch::<0>(of.target().circle(), angle))),
    ("second_recoil_cm_angle", |of, angle| Ok(recoil_branch::<1>(of.target().circle(), angle))),
    ("fast", kept_at::<0>),
    ("slow", kept_at::<1>),
    ("greatest_lab_angle", |of, _| Ok(of.projectile().circle().greatest_angle())),
    ("greatest_recoil_angle", |of, _| Ok(of.target().circle().greatest_angle())),
];

const REACTION_FUNCTIONS: &[(&str, ReactionFunction)] = &[
    ("threshold_energy", |of| of.threshold()),
    ("turning_energy", |of| of.turning_energy().unwrap_or(f64::NAN)),
];

fn named<T: Copy>(functions: &[(&str, T)], name: &str) -> Result<T> {
    let found = functions.iter().find(|(known, _)| *known == name).map(|(_, function)| *function);
    found.ok_or_else(|| Error::Internal(format!("no function '{name}'")))
}

/// Masses in units of the target's; what they become, NaN for the same; Q.
fn reaction(ratio: f64, products: [f64; 2], q_value: f64) -> Result<Reaction> {
    let [third, fourth] = if products[0].is_nan() { [ratio, 1.0] } else { products };
    Reaction::new((ratio, 1.0), (third, fourth), q_value)
}

/// A function of an angle, or of none that matters, by name: see `visviva.scattering`.
///
/// Every argument is a flat array of one number, or of one for each result. Masses are in units of the target's; the
/// energy is NaN where no Q-value needs one, the products where they are what goes in.
#[pyfunction]
pub(crate) fn kinematics<'py>(
    py: Python<'py>,
    name: &str,
    angle: Array<'py>,
    mass_ratio: Array<'py>,
    q_value: Array<'py>,
    beam_energy: Array<'py>,
    products: (Array<'py>, Array<'py>),
) -> PyResult<Column<'py>> {
    let angles = Rows::<1, 1>::of([("angle", &angle)])?;
    let bodies = Rows::<5, 1>::of([
        ("mass_ratio", &mass_ratio),
        ("q_value", &q_value),
        ("beam_energy", &beam_energy),
        ("products", &products.0),
        ("products", &products.1),
    ])?;
    let count = angles.count.max(bodies.count);
    let found = compute(py, 0, None, |ticker| {
        let function = named(FUNCTIONS, name)?;
        let encounter = |index: usize| {
            let [[ratio], [q_value], [energy], [third], [fourth]] = bodies.at(index);
            if energy.is_nan() && q_value == 0.0 && third.is_nan() {
                return Ok(Encounter::elastic(Collision::new(ratio, 1.0)?));
            }
            reaction(ratio, [third, fourth], q_value)?.at(energy)
        };
        let one = if bodies.is_one() { Some(encounter(0)?) } else { None };
        each("angle", count, ticker, |index| {
            let [[angle]] = angles.at(index);
            match &one {
                Some(encounter) => function(encounter, angle),
                None => function(&encounter(index)?, angle),
            }
        })
    })?
    .whole(py)?;
    moved(py, found, &[count])
}

/// A beam energy that is special, by name; as [`kinematics`].
#[pyfunction]
pub(crate) fn special_energy<'py>(
    py: Python<'py>,
    name: &str,
    mass_ratio: Array<'py>,
    q_value: Array<'py>,
    products: (Array<'py>, Array<'py>),
) -> PyResult<Column<'py>> {
    let bodies = Rows::<4, 1>::of([
        ("mass_ratio", &mass_ratio),
        ("q_value", &q_value),
        ("products", &products.0),
        ("products", &products.1),
    ])?;
    let found = compute(py, 0, None, |ticker| {
        let function = named(REACTION_FUNCTIONS, name)?;
        each("mass_ratio", bodies.count, ticker, |index| {
            let [[ratio], [q_value], [third], [fourth]] = bodies.at(index);
            Ok(function(&reaction(ratio, [third, fourth], q_value)?))
        })
    })?
    .whole(py)?;
    moved(py, found, &[bodies.count])
}

/// Averages over an isotropic collision: greatest and mean part transferred, least kept, logarithmic decrement, cosine.
#[pyfunction]
pub(crate) fn moderation<'py>(py: Python<'py>, mass_ratio: Array<'py>) -> PyResult<Column<'py>> {
    let ratios = Rows::<1, 1>::of([("mass_ratio", &mass_ratio)])?;
    let found = compute(py, 0, None, |ticker| {
        each("mass_ratio", ratios.count, ticker, |index| {
            let [[ratio]] = ratios.at(index);
            let of = Moderation::of(Collision::new(ratio, 1.0)?);
            Ok([
                of.greatest_transfer,
                of.mean_transfer,
                of.least_kept,
                of.mean_logarithmic_decrement,
                of.mean_cosine,
            ])
        })
    })?
    .whole(py)?;
    moved(py, found.into_flattened(), &[ratios.count, 5])
}
