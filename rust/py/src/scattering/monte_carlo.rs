//! The scattering Monte Carlo: beams and bins in, counts out.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use visviva_core::parallel::thread_count;
use visviva_core::scattering::monte_carlo::{Beam, Quantity, monte_carlo as simulate};

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
