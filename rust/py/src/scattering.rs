//! Scattering: the Monte Carlo, and the closed forms over arrays.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use visviva_core::parallel::thread_count;
use visviva_core::scattering::kinematics::{Collision, HalfAngle, solid_angle};
use visviva_core::scattering::monte_carlo::{Beam, Quantity, monte_carlo as simulate};
use visviva_core::scattering::rutherford;
use visviva_core::{Error, Result};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Name, edges, counts, underflow, overflow, how much of each bin is reachable, and the values covered.
type Tally<'py> = (String, Column<'py>, Bound<'py, PyArrayDyn<u64>>, u64, u64, Column<'py>, (f64, f64));
/// How many events, whether Ctrl-C ended them, the smallest deflection, and the tallies.
type Counted<'py> = (u64, bool, f64, Vec<Tally<'py>>);

/// The bins of one tally: how many, or their edges.
#[derive(FromPyObject)]
pub(crate) enum Bins<'py> {
    Count(usize),
    Edges(PyReadonlyArrayDyn<'py, f64>),
}

/// Scatters `n_events` projectiles, or as many as come before Ctrl-C.
#[pyfunction]
#[pyo3(signature = (*, k, beam_energy, masses, b_max, n_events, seed, first_event, tallies, threads, progress))]
pub(crate) fn monte_carlo<'py>(
    py: Python<'py>,
    k: f64,
    beam_energy: f64,
    masses: (f64, f64),
    b_max: f64,
    n_events: u64,
    seed: u64,
    first_event: u64,
    tallies: Vec<(String, Bins<'py>)>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Counted<'py>> {
    let refused = |error| raised(py, error);
    let threads = thread_count(threads).map_err(refused)?;
    let beam = Beam::new(k, beam_energy, masses, b_max).map_err(refused)?;
    let mut asked = Vec::with_capacity(tallies.len());
    for (name, bins) in &tallies {
        let quantity = Quantity::named(name).map_err(refused)?;
        let edges = match bins {
            Bins::Count(bins) => beam.uniform_edges(quantity, *bins),
            Bins::Edges(edges) => beam.edges(quantity, copied(name, edges, [None])?.0),
        };
        asked.push((quantity, edges.map_err(refused)?));
    }
    let (counted, interrupted) = compute(py, n_events, progress.as_ref(), |ticker| {
        simulate(&beam, &asked, seed, first_event, n_events, threads, ticker)
    })?
    .partial(py)?;
    let mut results = Vec::with_capacity(asked.len());
    for (((name, _), (quantity, edges)), counts) in tallies.into_iter().zip(asked).zip(counted.counts) {
        let (bins, covered) = (edges.bins(), beam.covered(quantity));
        let reachable = moved(py, beam.reachable(quantity, edges.values()), &[bins])?;
        let edges = moved(py, edges.values().to_vec(), &[bins + 1])?;
        let counts = (moved(py, counts.bins, &[bins])?, counts.underflow, counts.overflow);
        results.push((name, edges, counts.0, counts.1, counts.2, reachable, covered));
    }
    Ok((counted.events, interrupted, beam.smallest_angle(), results))
}

/// κ = k/2E.
#[pyfunction]
pub(crate) fn rutherford_half_distance(k: f64, energy: f64) -> f64 {
    rutherford::half_distance(k, energy)
}

/// A function of one array, by name, with up to two fixed numbers: see `visviva.scattering`.
///
/// `half_distance` is κ = k/2E for Rutherford's formulas, else unused; `mass_ratio` is m₁/m₂.
#[pyfunction]
pub(crate) fn scattering_function<'py>(
    py: Python<'py>,
    name: &str,
    half_distance: f64,
    mass_ratio: f64,
    values: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Column<'py>> {
    let (values, shape) = copied("values", &values, [None])?;
    let result = compute(py, 0, None, |_| evaluate(name, half_distance, mass_ratio, &values))?.whole(py)?;
    moved(py, result, &shape)
}

fn evaluate(name: &str, half_distance: f64, mass_ratio: f64, values: &[f64]) -> Result<Vec<f64>> {
    let collision = Collision::new(mass_ratio, 1.0)?;
    let branch = |branch: Option<(f64, f64)>| branch.map_or(f64::NAN, |(angle, _)| angle);
    let function: &dyn Fn(f64) -> f64 = match name {
        "lab_angle" => &|angle| collision.lab_angle(HalfAngle::of(angle)),
        "recoil_angle" => &|angle| HalfAngle::of(angle).recoil_angle(),
        "energy_transfer" => &|angle| collision.transferred(HalfAngle::of(angle)),
        "cm_angle" => &|angle| {
            let [first, _] = collision.branches(angle);
            branch(first)
        },
        "second_cm_angle" => &|angle| {
            let [_, second] = collision.branches(angle);
            branch(second)
        },
        "rutherford_deflection" => &|b| rutherford::deflection(half_distance, b),
        "rutherford_closest_approach" => &|b| rutherford::closest_approach(half_distance, b),
        "rutherford_impact_parameter" => &|angle| rutherford::impact_parameter(half_distance, angle),
        "rutherford_cm" => &|angle| rutherford::cross_section(half_distance, angle),
        "rutherford_lab" => &|angle| rutherford::lab_cross_section(half_distance, collision, angle),
        "rutherford_recoil" => &|angle| rutherford::recoil_cross_section(half_distance, angle),
        _ => return Err(Error::Internal(format!("no function '{name}'"))),
    };
    Ok(values.iter().map(|value| function(*value)).collect())
}

/// The solid angle between each two neighbouring angles from an axis.
#[pyfunction]
pub(crate) fn solid_angles<'py>(
    py: Python<'py>,
    edges: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Column<'py>> {
    let (edges, _) = copied("edges", &edges, [None])?;
    let pairs = edges.iter().zip(edges.iter().skip(1));
    let rings = pairs.map(|(&from, &to)| solid_angle(from, to));
    let rings: Vec<f64> = compute(py, 0, None, |_| Ok(rings.collect()))?.whole(py)?;
    let length = rings.len();
    moved(py, rings, &[length])
}
