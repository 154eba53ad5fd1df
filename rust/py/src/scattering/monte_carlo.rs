//! The scattering Monte Carlo: beams and bins in, counts out; or events.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::Result;
use visviva_core::memory::{check, collected};
use visviva_core::parallel::{Ticker, thread_count};
use visviva_core::scattering::bins::{Bins, Spacing};
use visviva_core::scattering::monte_carlo::{
    Beam, Channel, Event, Factor, Mixture, Probability, Profile, Quantity, Spread, Strata, Tally, events,
    expected, monte_carlo as simulate,
};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
type Integers<'py> = Bound<'py, PyArrayDyn<u64>>;
/// Names, edges, counts with what is below and above, captured, of a single one how much of each bin is reachable, and
/// with strata the counts of each, captured ones at the end.
type Counts<'py> = (
    Vec<String>,
    Vec<Column<'py>>,
    Integers<'py>,
    u64,
    Option<(Column<'py>, (f64, f64))>,
    Option<Integers<'py>>,
);
/// Of each table: hash, bytes, error, and the part of the disc that is not resolved.
type Tables = Vec<(u64, usize, f64, f64)>;
/// How many events, whether Ctrl-C ended them, the smallest deflection, the tables, and the tallies.
type Counted<'py> = (u64, bool, f64, Tables, Vec<Counts<'py>>);

/// The bins of one tally: how many, their edges, or by name: spacing, how many, from and to.
#[derive(FromPyObject)]
pub(crate) enum AskedBins<'py> {
    Count(usize),
    Spaced((String, usize, Option<f64>, Option<f64>)),
    Edges(PyReadonlyArrayDyn<'py, f64>),
}

impl AskedBins<'_> {
    pub(super) fn taken(self, py: Python<'_>, name: &str) -> PyResult<Bins> {
        Ok(match self {
            Self::Count(bins) => Bins::Count(bins),
            Self::Spaced((spacing, bins, low, high)) => {
                Bins::Spaced(Spacing::named(&spacing).map_err(|error| raised(py, error))?, bins, low, high)
            }
            Self::Edges(edges) => Bins::Edges(copied(name, &edges, [None])?.0),
        })
    }
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
    energy_spread: Option<(String, f64)>,
    divergence: Option<(String, f64)>,
    spot: Option<f64>,
    importance: Option<(Vec<f64>, Vec<f64>)>,
    channels: Vec<AskedChannel>,
}

/// The probability of a channel, what it is multiplied by at each energy, its Q, and the masses of the products.
type AskedChannel = (AskedFactor, AskedFactor, f64, Option<(f64, f64)>);

/// A number, or arguments and the factor at each.
#[derive(FromPyObject)]
enum AskedFactor {
    Constant(f64),
    Table((Vec<f64>, Vec<f64>)),
}

impl From<AskedFactor> for Factor {
    fn from(asked: AskedFactor) -> Self {
        match asked {
            AskedFactor::Constant(value) => Self::Constant(value),
            AskedFactor::Table((arguments, values)) => Self::Table(arguments, values),
        }
    }
}

/// What the work is given of one.
struct Taken {
    potential: std::sync::Arc<dyn visviva_core::potentials::Potential>,
    energies: Vec<f64>,
    weights: Vec<f64>,
    masses: (f64, f64),
    b_max: f64,
    profile: Profile,
    strata: Option<Strata>,
    channels: Vec<Channel>,
}

impl Described<'_> {
    fn taken(self, py: Python<'_>) -> PyResult<Taken> {
        let potential = described_potential(&self.potential)?;
        let spread = |argument: &str, told: Option<(String, f64)>| {
            told.map(|(name, size)| Spread::named(argument, &name, size))
                .transpose()
                .map_err(|error| raised(py, error))
        };
        let Self {
            energies,
            weights,
            masses,
            b_max,
            energy_spread,
            divergence,
            spot,
            importance,
            channels,
            ..
        } = self;
        let energy_spread = spread("energy_spread", energy_spread)?;
        let profile = Profile { energy_spread, divergence: spread("divergence", divergence)?, spot };
        let strata = importance.map(|(edges, fractions)| Strata::new(&edges, &fractions)).transpose();
        let strata = strata.map_err(|error| raised(py, error))?;
        let channel = |(place, energy, q_value, products): AskedChannel| {
            let probability = Probability { of_place: place.into(), of_energy: energy.into() };
            Channel { probability, q_value, products }
        };
        let channels: Vec<Channel> = channels.into_iter().map(channel).collect();
        Ok(Taken { potential, energies, weights, masses, b_max, profile, strata, channels })
    }
}

impl Taken {
    fn mixture(&self, threads: usize, ticker: &mut Ticker<'_>) -> Result<Mixture> {
        let mixture = Mixture::of_energies(
            &self.potential,
            (&self.energies, &self.weights),
            self.masses,
            self.b_max,
            self.profile,
            &self.channels,
            threads,
            ticker,
        )?;
        self.strata.iter().try_fold(mixture, |mixture, strata| mixture.stratified(strata.clone()))
    }
}

/// Names and bins, of each tally.
type Axes<B> = Vec<Vec<(String, B)>>;

fn taken(py: Python<'_>, tallies: Axes<AskedBins<'_>>) -> PyResult<Axes<Bins>> {
    let of_axis = |(name, bins): (String, AskedBins<'_>)| {
        let bins = bins.taken(py, &name)?;
        Ok((name, bins))
    };
    tallies.into_iter().map(|axes| axes.into_iter().map(of_axis).collect()).collect()
}

fn binned(mixture: &Mixture, asked: Axes<Bins>) -> Result<Vec<Tally>> {
    let axis = |(name, bins): (String, Bins)| {
        let quantity = Quantity::named(&name)?;
        Ok((quantity, mixture.edges(quantity, &bins)?))
    };
    let tally = |axes: Vec<_>| Tally::new(axes.into_iter().map(axis).collect::<Result<_>>()?);
    asked.into_iter().map(tally).collect()
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
    tallies: Axes<AskedBins<'py>>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Counted<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let beam = beam.taken(py)?;
    let asked = taken(py, tallies)?;
    let ((mixture, tallies, counted), interrupted) = compute(py, n_events, progress.as_ref(), |ticker| {
        // What is tabulated on the way is no part of what is to be done.
        ticker.control().count_whole(n_events);
        let mixture = beam.mixture(threads, ticker)?;
        let tallies = binned(&mixture, asked)?;
        let counted = simulate(&mixture, &tallies, seed, first_event, n_events, threads, ticker)?;
        Ok((mixture, tallies, counted))
    })?
    .partial(py)?;
    let mut results = Vec::with_capacity(tallies.len());
    for (tally, counts) in tallies.iter().zip(counted.counts) {
        let mut slots = vec![0; tally.slots()];
        for histogram in counts.chunks(tally.slots()) {
            slots.iter_mut().zip(histogram).for_each(|(slot, count)| *slot += count);
        }
        let by_stratum = mixture.strata().map(|strata| moved(py, counts, &[strata.count(), tally.slots()]));
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
        results.push((names, edges, moved(py, slots, &shape)?, captured, single, by_stratum.transpose()?));
    }
    let tables = mixture.beams().flat_map(Beam::tables);
    let tables =
        tables.map(|table| (table.hash(), table.bytes(), table.error(), table.unresolved())).collect();
    Ok((counted.events, interrupted, mixture.smallest_angle(), tables, results))
}

/// What part of all events each slot of each tally has on the average: captured ones at the end.
#[pyfunction]
#[pyo3(signature = (*, beam, tallies))]
pub(crate) fn monte_carlo_expected<'py>(
    py: Python<'py>,
    beam: Described<'py>,
    tallies: Axes<AskedBins<'py>>,
) -> PyResult<Vec<Column<'py>>> {
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let (beam, asked) = (beam.taken(py)?, taken(py, tallies)?);
    let parts = compute(py, 0, None, |ticker| {
        let mixture = beam.mixture(threads, ticker)?;
        expected(&mixture, &binned(&mixture, asked)?, threads, ticker)
    })?
    .whole(py)?;
    parts
        .into_iter()
        .map(|slots| {
            let count = slots.len();
            moved(py, slots, &[count])
        })
        .collect()
}

/// What an event of each stratum stands for: edges of impact parameters and fractions of the events.
#[pyfunction]
pub(crate) fn strata_weights(py: Python<'_>, edges: Vec<f64>, fractions: Vec<f64>) -> PyResult<Vec<f64>> {
    compute(py, 0, None, |_| Strata::new(&edges, &fractions).map(|strata| strata.weights()))?.whole(py)
}

/// Impact parameters from one to another in equal ratios, the ends exactly as given.
#[pyfunction]
pub(crate) fn strata_edges(py: Python<'_>, strata: usize, smallest: f64, b_max: f64) -> PyResult<Vec<f64>> {
    compute(py, 0, None, |_| {
        let edges = Spacing::Logarithmic.edges("smallest", false, strata, smallest, b_max)?;
        Ok(edges.values().to_vec())
    })?
    .whole(py)
}

/// The events of a range: their components and channels; weight, energy before, direction, ψ, and all quantities, event after event.
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
) -> PyResult<((Integers<'py>, Integers<'py>), Column<'py>)> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    // A list of events that grows is twice as long for a moment, and their columns come beside it.
    let each = 2 * size_of::<Event>() + (6 + Quantity::ALL.len()) * size_of::<f64>();
    let bytes = usize::try_from(n_events).ok().and_then(|count| count.checked_mul(each));
    let cure = "ask for fewer at a time, or write them to a file by to=";
    check("n_events", &format!("{n_events} events"), bytes, cure).map_err(|error| raised(py, error))?;
    let beam = beam.taken(py)?;
    let ((components, channels), values) = compute(py, n_events, progress.as_ref(), |ticker| {
        ticker.control().count_whole(n_events);
        let mixture = beam.mixture(threads, ticker)?;
        let found = events(&mixture, seed, first_event, n_events, ticker)?;
        let columns = "their values";
        let component = found.iter().map(|event| event.component);
        let channel = found.iter().map(|event| event.channel);
        Ok((
            (collected("n_events", columns, component)?, collected("n_events", columns, channel)?),
            found
                .iter()
                .flat_map(|event| {
                    let before = [event.weight, event.beam_energy, event.incidence, event.deflection];
                    before.into_iter().chain(event.values)
                })
                .collect::<Vec<f64>>(),
        ))
    })?
    .whole(py)?;
    let count = components.len();
    let which = (moved(py, components, &[count])?, moved(py, channels, &[count])?);
    Ok((which, moved(py, values, &[count, 4 + Quantity::ALL.len()])?))
}
