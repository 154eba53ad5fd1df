//! Branches, rainbows, glories, orbits and cross sections of a potential at an energy.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::parallel::{for_chunks, thread_count};
use visviva_core::scattering::cross_sections::{CollisionIntegrals, OF_ANGLES_IN_MEAN, Structure, transport};
use visviva_core::scattering::deflection::{Deflector, TOLERANCE};
use visviva_core::scattering::kinematics::Collision;

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Rainbows (b, ψ) and glories (b, ψ, dψ/db).
type Marks = (Vec<(f64, f64)>, Vec<(f64, f64, f64)>);
/// Of each energy the orbits: b, r, and whether it captures.
type Orbits = Vec<Vec<(f64, f64, bool)>>;

/// What marks the deflection function at an energy.
#[pyfunction]
pub(crate) fn scattering_structure(
    py: Python<'_>,
    description: &Bound<'_, PyDict>,
    energy: f64,
) -> PyResult<Marks> {
    let potential = described_potential(description)?;
    compute(py, 0, None, |ticker| {
        let deflector = Deflector::at_energy(&potential, TOLERANCE, energy)?;
        let structure = Structure::new(&deflector, energy, ticker)?;
        let rainbows = structure.rainbows().iter().map(|mark| (mark.impact_parameter, mark.angle)).collect();
        let glories = structure.glories(ticker)?;
        let glories =
            glories.iter().map(|mark| (mark.impact_parameter, mark.angle, mark.derivative)).collect();
        Ok((rainbows, glories))
    })?
    .whole(py)
}

/// The orbits that can be approached at each energy.
#[pyfunction]
pub(crate) fn scattering_orbits<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Orbits> {
    let potential = described_potential(description)?;
    let (energy, _) = copied("energy", &energy, [None])?;
    compute(py, 0, None, |ticker| {
        let deflector = Deflector::new(&potential, TOLERANCE)?;
        let mut all = Vec::with_capacity(energy.len());
        for energy in &energy {
            ticker.tick()?;
            let edges = deflector.edges(*energy).into_iter();
            all.push(
                edges
                    .filter_map(|edge| edge.orbit.map(|r| (edge.impact_parameter, r, edge.captures)))
                    .collect(),
            );
        }
        Ok(all)
    })?
    .whole(py)
}

/// Of each angle the branches: how many, and b, ψ, dψ/db and dσ/dΩ of all, one angle after another.
#[pyfunction]
pub(crate) fn scattering_branches<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: f64,
    angle: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<(Vec<usize>, Vec<Column<'py>>)> {
    let potential = described_potential(description)?;
    let (angle, _) = copied("angle", &angle, [None])?;
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let (counts, columns) = compute(py, 0, None, |ticker| {
        let deflector = Deflector::at_energy(&potential, TOLERANCE, energy)?;
        let structure = Structure::new(&deflector, energy, ticker)?;
        let mut counts = Vec::with_capacity(angle.len());
        let mut columns: [Vec<f64>; 4] = Default::default();
        let found = for_chunks(threads, angle.len(), ticker, |at, ticker| {
            structure.branches(number_at(&angle, at), ticker)
        })?;
        for (at, branches) in found.iter().enumerate() {
            counts.push(branches.len());
            for branch in branches {
                let part = branch.cross_section(number_at(&angle, at));
                let numbers = [branch.impact_parameter, branch.angle, branch.derivative, part];
                for (column, number) in columns.iter_mut().zip(numbers) {
                    column.push(number);
                }
            }
        }
        Ok((counts, columns))
    })?
    .whole(py)?;
    let moved = |column: Vec<f64>| {
        let length = column.len();
        moved(py, column, &[length])
    };
    Ok((counts, columns.into_iter().map(moved).collect::<PyResult<_>>()?))
}

/// A number of some; places are those that there are.
fn number_at(numbers: &[f64], place: usize) -> f64 {
    numbers.get(place).copied().unwrap_or(f64::NAN)
}

/// dσ/dΩ at each angle in a frame: "cm", "lab" or "recoil"; `mass_ratio` is m₁/m₂.
#[pyfunction]
pub(crate) fn differential_cross_section<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: f64,
    angle: PyReadonlyArrayDyn<'py, f64>,
    frame: &str,
    mass_ratio: f64,
) -> PyResult<Column<'py>> {
    let potential = described_potential(description)?;
    let (angle, shape) = copied("angle", &angle, [None])?;
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let found = compute(py, 0, None, |ticker| {
        let deflector = Deflector::at_energy(&potential, TOLERANCE, energy)?;
        let structure = Structure::new(&deflector, energy, ticker)?;
        let collision = Collision::new(mass_ratio, 1.0)?;
        for_chunks(threads, angle.len(), ticker, |at, ticker| match frame {
            "lab" => structure.lab_cross_section(collision, number_at(&angle, at), ticker),
            "recoil" => structure.recoil_cross_section(number_at(&angle, at), ticker),
            _ => structure.cross_section(number_at(&angle, at), ticker),
        })
    })?
    .whole(py)?;
    moved(py, found, &shape)
}

/// The area of all impact parameters that lead to at least each angle.
#[pyfunction]
pub(crate) fn beyond_angle<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: f64,
    angle: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Column<'py>> {
    let potential = described_potential(description)?;
    let (angle, shape) = copied("angle", &angle, [None])?;
    let areas = compute(py, 0, None, |ticker| {
        let deflector = Deflector::at_energy(&potential, TOLERANCE, energy)?;
        let structure = Structure::new(&deflector, energy, ticker)?;
        angle.iter().map(|angle| structure.beyond(*angle, ticker)).collect::<visviva_core::Result<Vec<f64>>>()
    })?
    .whole(py)?;
    moved(py, areas, &shape)
}

/// Beyond which there is no deflection; infinite for most.
#[pyfunction]
pub(crate) fn scattering_range(py: Python<'_>, description: &Bound<'_, PyDict>) -> PyResult<f64> {
    let potential = described_potential(description)?;
    compute(py, 0, None, |_| Ok(Deflector::new(&potential, TOLERANCE)?.range()))?.whole(py)
}

/// Q^(l) at each energy.
#[pyfunction]
pub(crate) fn transport_cross_sections<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: PyReadonlyArrayDyn<'py, f64>,
    order: u32,
    threads: Option<i64>,
) -> PyResult<Column<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let potential = described_potential(description)?;
    let (energy, shape) = copied("energy", &energy, [None])?;
    let found = compute(py, 0, None, |ticker| {
        let deflector = Deflector::new(&potential, TOLERANCE)?;
        energy
            .iter()
            .map(|energy| transport(&deflector, *energy, order, threads, ticker))
            .collect::<visviva_core::Result<Vec<f64>>>()
    })?
    .whole(py)?;
    moved(py, found, &shape)
}

/// Ω^(l,s)* at each temperature.
#[pyfunction]
pub(crate) fn collision_integrals<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    temperature: PyReadonlyArrayDyn<'py, f64>,
    orders: (u32, u32),
    diameter: f64,
    threads: Option<i64>,
) -> PyResult<Column<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let potential = described_potential(description)?;
    let (temperature, shape) = copied("temperature", &temperature, [None])?;
    let found = compute(py, 0, None, |ticker| {
        let deflector = Deflector::new(&potential, OF_ANGLES_IN_MEAN)?;
        let mut integrals = CollisionIntegrals::new(&deflector, orders, threads);
        let one = |kt: &f64| integrals.at(*kt, diameter, ticker);
        temperature.iter().map(one).collect::<visviva_core::Result<Vec<f64>>>()
    })?
    .whole(py)?;
    moved(py, found, &shape)
}
