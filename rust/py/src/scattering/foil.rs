//! Ions through matter: a foil and what comes to it in, counts out; or one ion's collisions.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::Result;
use visviva_core::parallel::thread_count;
use visviva_core::scattering::bins::Bins;
use visviva_core::scattering::foil::{
    Beam, Element, Fate, Foil, Model, Projectile, Quantity, Run, Slot, Stopping, Weights, number_densities,
};

use super::monte_carlo::AskedBins;

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
type Whole<'py> = Bound<'py, PyArrayDyn<u64>>;
/// Name, edges, and of each slot the count, the weight and its square.
type Tallied<'py> = (String, Column<'py>, Whole<'py>);
/// How many events, whether Ctrl-C ended them, the units of weights and of squares, what the tables are, fates, tallies.
type Counted<'py> = (u64, bool, (f64, f64), (f64, f64, usize), Whole<'py>, Vec<Tallied<'py>>);
/// Of each collision seven numbers, its directions, with which element; and what became of the ion.
type History<'py> = (Column<'py>, Column<'py>, Whole<'py>, (String, f64, f64, f64, f64));

/// What electrons take: the name of a model, or energies with losses.
#[derive(FromPyObject)]
enum Told {
    Name(String),
    Table(Vec<[f64; 2]>),
}

/// One element of a foil.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct DescribedElement<'py> {
    atomic_number: f64,
    mass: f64,
    fraction: f64,
    excitation: f64,
    potential: Bound<'py, PyDict>,
}

/// A foil as it is described.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Described<'py> {
    elements: Vec<DescribedElement<'py>>,
    density: f64,
    thickness: f64,
    stopping: Told,
    minimum_angle: f64,
}

/// What comes to it, as it is described.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct DescribedRun {
    ion: (f64, f64),
    beam_energy: f64,
    lowest_energy: f64,
    incidence: f64,
    single: bool,
    forced_angle: Option<f64>,
}

impl Described<'_> {
    fn taken(self, py: Python<'_>) -> PyResult<Foil> {
        let column = |of: fn(&DescribedElement<'_>) -> f64| self.elements.iter().map(of).collect::<Vec<_>>();
        let densities = number_densities(self.density, &column(|one| one.mass), &column(|one| one.fraction));
        let mut elements = Vec::new();
        for (one, density) in self.elements.iter().zip(densities) {
            elements.push(Element {
                atomic_number: one.atomic_number,
                mass: one.mass,
                density,
                excitation: one.excitation,
                potential: described_potential(&one.potential)?,
            });
        }
        let stopping = match self.stopping {
            Told::Name(name) => Stopping::Formula(Model::named(&name).map_err(|error| raised(py, error))?),
            Told::Table(rows) => Stopping::Table(rows),
        };
        let foil = Foil { elements, thickness: self.thickness, stopping, minimum_angle: self.minimum_angle };
        foil.check().map_err(|error| raised(py, error))?;
        Ok(foil)
    }
}

impl DescribedRun {
    fn taken(self) -> Run {
        Run {
            ion: Projectile { atomic_number: self.ion.0, mass: self.ion.1 },
            energy: self.beam_energy,
            lowest: self.lowest_energy,
            incidence: self.incidence,
            single: self.single,
            forced_angle: self.forced_angle,
        }
    }
}

/// Refuses what is no foil.
#[pyfunction]
pub(crate) fn check_foil(py: Python<'_>, foil: Described<'_>) -> PyResult<()> {
    foil.taken(py).map(drop)
}

/// Sends `n_events` ions, or as many as come before Ctrl-C.
#[pyfunction]
#[pyo3(signature = (*, foil, run, n_events, seed, first_event, tallies, threads, progress))]
pub(crate) fn foil_run<'py>(
    py: Python<'py>,
    foil: Described<'py>,
    run: DescribedRun,
    n_events: u64,
    seed: u64,
    first_event: u64,
    tallies: Vec<(String, AskedBins<'py>)>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Counted<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let (foil, run) = (foil.taken(py)?, run.taken());
    let mut asked = Vec::with_capacity(tallies.len());
    for (name, bins) in tallies {
        let bins = bins.taken(py, &name)?;
        asked.push((name, bins));
    }
    let ((weights, told, tallies, counted), interrupted) =
        compute(py, n_events, progress.as_ref(), |ticker| {
            // What is tabulated on the way is no part of what is to be done.
            ticker.control().count_whole(n_events);
            let beam = Beam::new(&foil, &run, threads, ticker)?;
            let tally = |(name, bins): (String, Bins)| -> Result<_> {
                let quantity = Quantity::named(&name)?;
                Ok((quantity, beam.edges(quantity, &bins)?))
            };
            let tallies = asked.into_iter().map(tally).collect::<Result<Vec<_>>>()?;
            let counted = beam.run(&tallies, seed, (first_event, n_events), threads, ticker)?;
            Ok((beam.weights(), beam.told(), tallies, counted))
        })?
        .partial(py)?;
    let mut results = Vec::with_capacity(tallies.len());
    for ((quantity, edges), slots) in tallies.iter().zip(&counted.counts.tallies) {
        let edges = moved(py, edges.values().to_vec(), &[edges.bins() + 1])?;
        results.push((quantity.name().to_owned(), edges, columns(py, slots)?));
    }
    let fates = columns(py, &counted.counts.fates)?;
    Ok((counted.events, interrupted, Weights::units(weights), told, fates, results))
}

/// Counts, weights and squares, one row for each slot.
fn columns<'py>(py: Python<'py>, slots: &[Slot]) -> PyResult<Whole<'py>> {
    let all = slots.iter().flat_map(|slot| [slot.count, slot.weight, slot.square]).collect();
    moved(py, all, &[slots.len(), 3])
}

/// The collisions of one event.
#[pyfunction]
#[pyo3(signature = (*, foil, run, seed, event))]
pub(crate) fn foil_history<'py>(
    py: Python<'py>,
    foil: Described<'py>,
    run: DescribedRun,
    seed: u64,
    event: u64,
) -> PyResult<History<'py>> {
    let (foil, run) = (foil.taken(py)?, run.taken());
    let (all, ended) =
        compute(py, 1, None, |ticker| Beam::new(&foil, &run, 1, ticker)?.history(seed, event, ticker))?
            .whole(py)?;
    let numbers = all.iter().flat_map(|met| {
        [met.depth, met.path, met.impact_parameter, met.cm_angle(), met.energy[0], met.energy[1]]
    });
    let numbers = moved(py, numbers.collect(), &[all.len(), 6])?;
    let directions: Vec<f64> = all.iter().flat_map(|met| met.direction).flatten().collect();
    let directions = moved(py, directions, &[all.len(), 2, 3])?;
    let elements = moved(py, all.iter().map(|met| met.element as u64).collect(), &[all.len()])?;
    let fate = match ended.fate {
        Fate::Transmitted => "transmitted",
        Fate::Reflected => "reflected",
        Fate::Stopped => "stopped",
        Fate::Missed => "missed",
    };
    Ok((
        numbers,
        directions,
        elements,
        (fate.to_owned(), ended.angle, ended.energy, ended.depth, ended.weight),
    ))
}

/// What electrons take, in eV/Å, at energies in eV; or, down to a lowest energy, how far an ion goes in Å.
#[pyfunction]
#[pyo3(signature = (*, foil, ion, energy, lowest))]
pub(crate) fn foil_stopping<'py>(
    py: Python<'py>,
    foil: Described<'py>,
    ion: (f64, f64),
    energy: PyReadonlyArrayDyn<'py, f64>,
    lowest: Option<f64>,
) -> PyResult<Column<'py>> {
    let foil = foil.taken(py)?;
    let ion = Projectile { atomic_number: ion.0, mass: ion.1 };
    let (energy, shape) = copied("energy", &energy, [None])?;
    let found = compute(py, energy.len() as u64, None, |_| match lowest {
        None => foil.losses(ion, &energy),
        Some(lowest) => foil.ranges(ion, &energy, lowest),
    })?
    .whole(py)?;
    moved(py, found, &shape)
}
