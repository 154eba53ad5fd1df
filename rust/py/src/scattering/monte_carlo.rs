//! The scattering Monte Carlo: beams and bins in, counts out; or events.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::memory::collected;
use visviva_core::parallel::{Ticker, thread_count};
use visviva_core::scattering::histogram::Edges;
use visviva_core::scattering::monte_carlo::{
    Beam, Mixture, Quantity, Tally, events, monte_carlo as simulate,
};
use visviva_core::{Error, Result};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Names, edges, counts with what is below and above, captured, and of a single one how much of each bin is reachable.
type Counts<'py> =
    (Vec<String>, Vec<Column<'py>>, Bound<'py, PyArrayDyn<u64>>, u64, Option<(Column<'py>, (f64, f64))>);
/// Of each table: hash, bytes, error, and the part of the disc that is not resolved.
type Tables = Vec<(u64, usize, f64, f64)>;
/// How many events, whether Ctrl-C ended them, the smallest deflection, the tables, and the tallies.
type Counted<'py> = (u64, bool, f64, Tables, Vec<Counts<'py>>);

/// The bins of one tally: how many, or their edges.
#[derive(FromPyObject)]
pub(crate) enum Bins<'py> {
    Count(usize),
    Edges(PyReadonlyArrayDyn<'py, f64>),
}

/// The same, taken from Python.
enum Asked {
    Count(usize),
    Edges(Vec<f64>),
}

/// A beam as it is described.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Described<'py> {
    potential: Bound<'py, PyDict>,
    energies: Vec<f64>,
    weights: Vec<f64>,
    masses: (f64, f64),
    b_max: f64,
}

/// What the work is given of one.
struct Taken {
    potential: std::sync::Arc<dyn visviva_core::potentials::Potential>,
    energies: Vec<f64>,
    weights: Vec<f64>,
    masses: (f64, f64),
    b_max: f64,
}

impl Described<'_> {
    fn taken(self) -> PyResult<Taken> {
        let potential = described_potential(&self.potential)?;
        let Self { energies, weights, masses, b_max, .. } = self;
        Ok(Taken { potential, energies, weights, masses, b_max })
    }
}

impl Taken {
    fn mixture(&self, threads: usize, ticker: &mut Ticker<'_>) -> Result<Mixture> {
        Mixture::of_energies(
            &self.potential,
            (&self.energies, &self.weights),
            self.masses,
            self.b_max,
            threads,
            ticker,
        )
    }
}

/// Scatters `n_events` projectiles, or as many as come before Ctrl-C.
#[pyfunction]
#[pyo3(signature = (*, beam, n_events, seed, first_event, tallies, threads, progress))]
pub(crate) fn monte_carlo<'py>(
    py: Python<'py>,
    beam: Described<'py>,
    n_events: u64,
    seed: u64,
    first_event: u64,
    tallies: Vec<Vec<(String, Bins<'py>)>>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Counted<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let beam = beam.taken()?;
    let mut asked = Vec::with_capacity(tallies.len());
    for axes in tallies {
        let mut taken = Vec::with_capacity(axes.len());
        for (name, bins) in axes {
            let bins = match bins {
                Bins::Count(bins) => Asked::Count(bins),
                Bins::Edges(edges) => Asked::Edges(copied(&name, &edges, [None])?.0),
            };
            taken.push((name, bins));
        }
        asked.push(taken);
    }
    let ((mixture, tallies, counted), interrupted) = compute(py, n_events, progress.as_ref(), |ticker| {
        // What is tabulated on the way is no part of what is to be done.
        ticker.control().count_whole(n_events);
        let mixture = beam.mixture(threads, ticker)?;
        let fastest = mixture.fastest().ok_or_else(|| Error::Internal("a mixture of nothing".to_owned()))?;
        let axis = |(name, bins): (String, Asked)| -> Result<(Quantity, Edges)> {
            let quantity = Quantity::named(&name)?;
            let edges = match bins {
                Asked::Count(bins) => fastest.uniform_edges(quantity, bins)?,
                Asked::Edges(edges) => fastest.edges(quantity, edges)?,
            };
            Ok((quantity, edges))
        };
        let tally = |axes: Vec<_>| Tally::new(axes.into_iter().map(axis).collect::<Result<_>>()?);
        let tallies: Vec<Tally> = asked.into_iter().map(tally).collect::<Result<_>>()?;
        let counted = simulate(&mixture, &tallies, seed, first_event, n_events, threads, ticker)?;
        Ok((mixture, tallies, counted))
    })?
    .partial(py)?;
    let mut results = Vec::with_capacity(tallies.len());
    for (tally, mut slots) in tallies.iter().zip(counted.counts) {
        let names = tally.axes().iter().map(|(quantity, _)| quantity.name().to_owned()).collect();
        let shape: Vec<usize> = tally.axes().iter().map(|(_, edges)| edges.bins() + 2).collect();
        let captured = slots.pop().unwrap_or(0);
        let edges = tally
            .axes()
            .iter()
            .map(|(_, edges)| moved(py, edges.values().to_vec(), &[edges.bins() + 1]))
            .collect::<PyResult<_>>()?;
        let single = match tally.axes() {
            [(quantity, edges)] => {
                let (reachable, covered) = mixture.reachable(*quantity, edges.values());
                Some((moved(py, reachable, &[edges.bins()])?, covered))
            }
            _ => None,
        };
        results.push((names, edges, moved(py, slots, &shape)?, captured, single));
    }
    let tables = mixture.beams().filter_map(Beam::table);
    let tables =
        tables.map(|table| (table.hash(), table.bytes(), table.error(), table.unresolved())).collect();
    Ok((counted.events, interrupted, mixture.smallest_angle(), tables, results))
}

/// The events of a range: their components, ψ, and all quantities, event after event.
#[pyfunction]
#[pyo3(signature = (*, beam, n_events, seed, first_event, threads, progress))]
pub(crate) fn scattering_events<'py>(
    py: Python<'py>,
    beam: Described<'py>,
    n_events: u64,
    seed: u64,
    first_event: u64,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyArrayDyn<u64>>, Column<'py>, Column<'py>)> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let beam = beam.taken()?;
    let (components, deflections, values) = compute(py, n_events, progress.as_ref(), |ticker| {
        ticker.control().count_whole(n_events);
        let mixture = beam.mixture(threads, ticker)?;
        let found = events(&mixture, seed, first_event, n_events, ticker)?;
        let columns = "their values";
        Ok((
            collected("n_events", columns, found.iter().map(|event| event.component))?,
            collected("n_events", columns, found.iter().map(|event| event.deflection))?,
            found.iter().flat_map(|event| event.values).collect::<Vec<f64>>(),
        ))
    })?
    .whole(py)?;
    let count = components.len();
    Ok((
        moved(py, components, &[count])?,
        moved(py, deflections, &[count])?,
        moved(py, values, &[count, Quantity::ALL.len()])?,
    ))
}
