//! Motion in central potentials; every function takes flat arrays of one length, `visviva.orbits` gives them their axes.

pub(crate) mod orbit;

use crate::arrays::{copied, moved};
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use visviva_core::central::circles::Circle;
use visviva_core::central::field::Field;
use visviva_core::central::landscape::Landscape;
use visviva_core::central::motion::Motion;
use visviva_core::central::range::{Range, centrifugal};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::parallel::{for_chunks, thread_count};
use visviva_core::potentials::Potential;
use visviva_core::words::number;
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

fn described(potentials: &[Bound<'_, PyDict>]) -> PyResult<Vec<Arc<dyn Potential>>> {
    potentials.iter().map(described_potential).collect()
}

fn flat(name: &str, array: &Array<'_>) -> PyResult<Vec<f64>> {
    Ok(copied(name, array, [None])?.0)
}

/// V + l²/2mr².
#[pyfunction]
pub(crate) fn central_effective<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    r: Array<'py>,
    angular_momentum: Array<'py>,
    mass: Array<'py>,
    path: bool,
) -> PyResult<Column<'py>> {
    let field = Field::new(&described(&potentials)?);
    let (r, l, m) = (flat("r", &r)?, flat("angular_momentum", &angular_momentum)?, flat("mass", &mass)?);
    let all = compute(py, 0, None, |_| {
        let of = |((r, l), m): ((&f64, &f64), &f64)| {
            let turning = centrifugal(*l, *m);
            if path { field.path_curvature(turning, *r) } else { field.effective(turning, *r) }
        };
        Ok(r.iter().zip(&l).zip(&m).map(of).collect::<Vec<f64>>())
    })?
    .whole(py)?;
    let length = all.len();
    moved(py, all, &[length])
}

/// A number of a circle, by name.
type Named = (&'static str, fn(&Circle) -> f64);

const CIRCLES: &[Named] = &[
    ("radius", |found| found.radius),
    ("energy", |found| found.energy),
    ("angular_momentum", |found| found.angular_momentum),
    ("angular_velocity", |found| found.angular_velocity),
    ("radial_rate", |found| found.radial_rate),
    ("apsidal_angle", |found| found.apsidal_angle),
];

/// The circles of these radii.
#[pyfunction]
pub(crate) fn central_circles<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    radius: Array<'py>,
    mass: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let potentials = described(&potentials)?;
    let (radius, mass) = (flat("radius", &radius)?, flat("mass", &mass)?);
    let found = compute(py, 0, None, |_| {
        let landscape = Landscape::of(&potentials);
        let of = |(r, m): (&f64, &f64)| {
            landscape.circle(*r, *m).ok_or_else(|| {
                let message = format!("expected one at which the force attracts, got {}", number(*r));
                Error::invalid("radius", message)
            })
        };
        radius.iter().zip(&mass).map(of).collect::<Result<Vec<Circle>>>()
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    for (name, of) in CIRCLES {
        dict.set_item(name, moved(py, found.iter().map(of).collect(), &[found.len()])?)?;
    }
    Ok(dict)
}

/// The radii of circles of an angular momentum.
#[pyfunction]
pub(crate) fn central_circular_radii(
    py: Python<'_>,
    potentials: Vec<Bound<'_, PyDict>>,
    angular_momentum: f64,
    mass: f64,
) -> PyResult<Vec<f64>> {
    let potentials = described(&potentials)?;
    compute(py, 0, None, |_| {
        let momentum = centrifugal(angular_momentum, mass).scale(2.0);
        Ok(Landscape::of(&potentials).circular_radii(momentum))
    })?
    .whole(py)
}

/// Every range of motion: its ends and what becomes of a body in it.
#[pyfunction]
pub(crate) fn central_ranges(
    py: Python<'_>,
    potentials: Vec<Bound<'_, PyDict>>,
    energy: f64,
    angular_momentum: f64,
    mass: f64,
) -> PyResult<Vec<(f64, f64, &'static str)>> {
    let potentials = described(&potentials)?;
    let found = compute(py, 0, None, |_| {
        Ok(Landscape::of(&potentials).ranges(DoubleDouble::from(energy), centrifugal(angular_momentum, mass)))
    })?
    .whole(py)?;
    Ok(found.iter().map(|range| (range.inner.radius(), range.outer.radius(), range.kind())).collect())
}

/// Numbers of each radial motion, in this order.
const NUMBERS: [&str; 6] =
    ["r_min", "r_max", "radial_period", "apsidal_angle", "period_error", "angle_error"];

/// How far beyond the end of its range a distance may be, relatively: what the rounding of E may take from a round orbit.
const HELD: f64 = 1e-7;

/// The range of one motion, nothing if there is none.
fn range_of(found: &[Range], near: f64) -> Result<Option<Range>> {
    let chosen = if near.is_nan() {
        if found.len() > 1 {
            let ranges: Vec<String> = found
                .iter()
                .map(|range| format!("{} to {}", number(range.inner.radius()), number(range.outer.radius())))
                .collect();
            let message =
                format!("expected a distance in one of the ranges of motion: {}", ranges.join(", "));
            return Err(Error::invalid("near", message));
        }
        found.first()
    } else {
        found.iter().find(|range| range.holds(near, HELD))
    };
    Ok(chosen.copied())
}

/// Energy, l²/2m, mass, and a distance in the range.
type Asked = (DoubleDouble, DoubleDouble, f64, f64);

fn numbers_of(landscape: &Landscape, (energy, turning, m, near): Asked) -> Result<([f64; 6], &'static str)> {
    let Some(range) = range_of(&landscape.ranges(energy, turning), near)? else {
        return Ok(([f64::NAN; 6], "no_motion"));
    };
    let (low, high, kind) = (range.inner.radius(), range.outer.radius(), range.kind());
    let [period, angle, time_error, angle_error] = match kind {
        "circular" => {
            let circle = landscape.circle(0.5 * (low + high), m);
            let rate = circle.map_or(f64::NAN, |circle| circle.radial_rate);
            let period = if rate < 0.0 { f64::NAN } else { core::f64::consts::TAU / rate };
            [period, circle.map_or(f64::NAN, |circle| circle.apsidal_angle), 0.0, 0.0]
        }
        "bound" => {
            let motion = Motion::new(landscape, range, energy, m, turning);
            let half = motion.half_period()?;
            [2.0 * half.time, half.angle, 2.0 * half.time_error, half.angle_error]
        }
        "escapes" | "reaches_the_center" => {
            let motion = Motion::new(landscape, range, energy, m, turning);
            let half = motion.to_the_end()?;
            // Through a center without a singularity it goes on: half a turn for each passage.
            let angle = match (kind, turning.high() == 0.0, landscape.field().singular()) {
                ("reaches_the_center", true, false) => core::f64::consts::FRAC_PI_2,
                ("reaches_the_center", true, true) => f64::NAN,
                _ => half.angle,
            };
            [2.0 * half.time, angle, 2.0 * half.time_error, half.angle_error]
        }
        _ => [f64::NAN; 4],
    };
    Ok(([low, high, period, angle, time_error, angle_error], kind))
}

/// Period and angle of radial motions, and words for what becomes of them.
#[pyfunction]
pub(crate) fn central_motion<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    energy: Array<'py>,
    angular_momentum: Array<'py>,
    mass: Array<'py>,
    near: Array<'py>,
) -> PyResult<(Bound<'py, PyDict>, Vec<&'static str>)> {
    let potentials = described(&potentials)?;
    let (energy, l) = (flat("energy", &energy)?, flat("angular_momentum", &angular_momentum)?);
    let (m, near) = (flat("mass", &mass)?, flat("near", &near)?);
    let asked: Vec<Asked> = energy
        .iter()
        .zip(&l)
        .zip(&m)
        .zip(&near)
        .map(|(((e, l), m), near)| (DoubleDouble::from(*e), centrifugal(*l, *m), *m, *near))
        .collect();
    let found = compute(py, asked.len() as u64, None, |ticker| {
        let landscape = Landscape::of(&potentials);
        for_chunks(thread_count(None)?, asked.len(), ticker, |at, ticker| {
            ticker.advance(1);
            ticker.tick()?;
            asked.get(at).map_or_else(
                || Err(Error::Internal("no motion".to_owned())),
                |asked| numbers_of(&landscape, *asked),
            )
        })
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    for (at, name) in NUMBERS.iter().enumerate() {
        let column = found.iter().map(|(numbers, _)| numbers.get(at).copied().unwrap_or(f64::NAN)).collect();
        dict.set_item(name, moved(py, column, &[found.len()])?)?;
    }
    Ok((dict, found.iter().map(|(_, kind)| *kind).collect()))
}

/// Times and angles between two distances.
#[pyfunction]
pub(crate) fn central_passage<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    start: Array<'py>,
    end: Array<'py>,
    energy: Array<'py>,
    angular_momentum: Array<'py>,
    mass: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>)> {
    let potentials = described(&potentials)?;
    let (from, to) = (flat("start", &start)?, flat("end", &end)?);
    let (energy, l, m) =
        (flat("energy", &energy)?, flat("angular_momentum", &angular_momentum)?, flat("mass", &mass)?);
    let asked: Vec<[f64; 5]> = from
        .iter()
        .zip(&to)
        .zip(&energy)
        .zip(&l)
        .zip(&m)
        .map(|((((a, b), e), l), m)| [*a, *b, *e, *l, *m])
        .collect();
    let found = compute(py, asked.len() as u64, None, |ticker| {
        let landscape = Landscape::of(&potentials);
        for_chunks(thread_count(None)?, asked.len(), ticker, |at, ticker| {
            ticker.tick()?;
            let Some(&[from, to, energy, l, m]) = asked.get(at) else {
                return Err(Error::Internal("no passage".to_owned()));
            };
            let turning = centrifugal(l, m);
            let energy = DoubleDouble::from(energy);
            let ranges = landscape.ranges(energy, turning);
            let Some(range) = ranges.iter().find(|range| range.holds(from, 0.0) && range.holds(to, 0.0))
            else {
                let words: Vec<String> = ranges
                    .iter()
                    .map(|range| {
                        format!("{} to {}", number(range.inner.radius()), number(range.outer.radius()))
                    })
                    .collect();
                let words = if words.is_empty() { "nowhere".to_owned() } else { words.join(", ") };
                let message = format!(
                    "expected both distances in one range of motion, which is {words}, got {} and {}",
                    number(from),
                    number(to)
                );
                return Err(Error::invalid("end", message));
            };
            Motion::new(&landscape, *range, energy, m, turning).between(from, to)
        })
    })?
    .whole(py)?;
    let count = [found.len()];
    Ok((
        moved(py, found.iter().map(|passage| passage.time).collect(), &count)?,
        moved(py, found.iter().map(|passage| passage.angle).collect(), &count)?,
    ))
}
