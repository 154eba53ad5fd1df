//! Collisions of two bodies in space, over arrays: flat arrays of one row, or of as many as there are results.

use super::broadcast::{Array, Rows, each};
use crate::arrays::moved;
use crate::gate::compute;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use visviva_core::scattering::contact;
use visviva_core::scattering::impact::{self, Geometry, Pair, Rule};
use visviva_core::{Error, Result};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
type Pairs<'py> = (Array<'py>, Array<'py>);

fn masses(pair: &Pairs<'_>) -> PyResult<Rows<2, 1>> {
    Rows::of([("mass1", &pair.0), ("mass2", &pair.1)])
}

fn mass_pair(masses: &Rows<2, 1>, index: usize) -> [f64; 2] {
    masses.at(index).map(|[mass]| mass)
}

/// Velocities of both after a collision, the impulse on the first and the energy lost: ten numbers a row.
///
/// `rule` is "restitution" with a coefficient or "released" with a Q-value; `geometry` "normal" or "direction".
#[pyfunction]
pub(crate) fn collided<'py>(
    py: Python<'py>,
    rule: (String, Array<'py>),
    geometry: (String, Array<'py>),
    mass: Pairs<'py>,
    velocity: Pairs<'py>,
) -> PyResult<Column<'py>> {
    let masses = masses(&mass)?;
    let numbers = Rows::<1, 1>::of([(&rule.0, &rule.1)])?;
    let vectors = Rows::<3, 3>::of([
        ("velocity1", &velocity.0),
        ("velocity2", &velocity.1),
        (&geometry.0, &geometry.1),
    ])?;
    let count = masses.count.max(numbers.count).max(vectors.count);
    let rule: fn(f64) -> Rule = if rule.0 == "coefficient" { Rule::Restitution } else { Rule::Released };
    let geometry: fn([f64; 3]) -> Geometry =
        if geometry.0 == "normal" { Geometry::Normal } else { Geometry::Direction };
    let found = compute(py, 0, None, |ticker| {
        each("velocity1", count, ticker, |index| {
            let ([[number]], [first, second, along]) = (numbers.at(index), vectors.at(index));
            let pair = Pair { masses: mass_pair(&masses, index), velocities: [first, second] };
            let after = pair.collide(rule(number), geometry(along))?;
            let mut row = [after.energy_loss; 10];
            let parts = after.velocities.into_iter().chain([after.impulse]).flatten();
            row.iter_mut().zip(parts).for_each(|(place, part)| *place = part);
            Ok(row)
        })
    })?
    .whole(py)?;
    moved(py, found.into_flattened(), &[count, 10])
}

/// The line of centres of spheres that meet, from the second to the first.
#[pyfunction]
pub(crate) fn line_of_centers<'py>(
    py: Python<'py>,
    velocity: Pairs<'py>,
    impact: Array<'py>,
    distance: Array<'py>,
) -> PyResult<Column<'py>> {
    let vectors =
        Rows::<3, 3>::of([("velocity1", &velocity.0), ("velocity2", &velocity.1), ("impact", &impact)])?;
    let distances = Rows::<1, 1>::of([("distance", &distance)])?;
    let count = vectors.count.max(distances.count);
    let found = compute(py, 0, None, |ticker| {
        each("impact", count, ticker, |index| {
            let ([first, second, impact], [[distance]]) = (vectors.at(index), distances.at(index));
            Pair { masses: [1.0; 2], velocities: [first, second] }.line_of_centers(impact, distance)
        })
    })?
    .whole(py)?;
    moved(py, found.into_flattened(), &[count, 3])
}

/// The time from now at which two spheres touch; infinite if never.
#[pyfunction]
pub(crate) fn contact_time<'py>(
    py: Python<'py>,
    position: Pairs<'py>,
    velocity: Pairs<'py>,
    distance: Array<'py>,
) -> PyResult<Column<'py>> {
    let vectors = Rows::<4, 3>::of([
        ("position1", &position.0),
        ("position2", &position.1),
        ("velocity1", &velocity.0),
        ("velocity2", &velocity.1),
    ])?;
    let distances = Rows::<1, 1>::of([("distance", &distance)])?;
    let count = vectors.count.max(distances.count);
    let found = compute(py, 0, None, |ticker| {
        each("position1", count, ticker, |index| {
            let ([r1, r2, v1, v2], [[distance]]) = (vectors.at(index), distances.at(index));
            contact::contact_time([r1, r2], [v1, v2], distance)
        })
    })?
    .whole(py)?;
    moved(py, found, &[count])
}

/// m₁m₂/(m₁+m₂).
#[pyfunction]
pub(crate) fn reduced_mass<'py>(py: Python<'py>, mass: Pairs<'py>) -> PyResult<Column<'py>> {
    let masses = masses(&mass)?;
    let one = |index| Ok(impact::reduced_mass(mass_pair(&masses, index)));
    let found = compute(py, 0, None, |ticker| each("mass1", masses.count, ticker, one))?.whole(py)?;
    moved(py, found, &[masses.count])
}

/// Two vectors of each pair, from two: "to_relative" gives the centre of mass and the first from the second, and
/// "from_relative" goes back.
#[pyfunction]
pub(crate) fn relative_split<'py>(
    py: Python<'py>,
    name: &str,
    mass: Pairs<'py>,
    vectors: Pairs<'py>,
) -> PyResult<Column<'py>> {
    let masses = masses(&mass)?;
    let vectors = Rows::<2, 3>::of([("vector1", &vectors.0), ("vector2", &vectors.1)])?;
    let count = masses.count.max(vectors.count);
    let split = |index: usize| -> Result<[[f64; 3]; 2]> {
        let (masses, [first, second]) = (mass_pair(&masses, index), vectors.at(index));
        match name {
            "to_relative" => Ok(impact::to_relative(masses, [first, second]).into()),
            "from_relative" => Ok(impact::from_relative(masses, first, second)),
            _ => Err(Error::Internal(format!("no function '{name}'"))),
        }
    };
    let found = compute(py, 0, None, |ticker| each("mass1", count, ticker, split))?.whole(py)?;
    moved(py, found.into_flattened().into_flattened(), &[count, 2, 3])
}
