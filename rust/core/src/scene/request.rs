//! What is asked of a scene: times, method, tolerances, columns; checked before anything runs.

use super::Scene;
use crate::error::{Error, Result};
use crate::integrators::Method;
use crate::registry;

/// The smallest relative tolerance that double precision can honour (a hundred units in the last place).
pub const RTOL_MIN: f64 = 2.3e-14;

/// What may be recorded.
pub const COLUMNS: [&str; 6] =
    ["position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass"];

/// What is asked of a scene.
#[derive(Clone, Debug)]
pub struct Request {
    /// Output times, from `t0` on in one direction.
    pub times: Vec<f64>,
    /// A method's name, or `auto`.
    pub method: String,
    /// The step of a fixed-step method.
    pub dt: Option<f64>,
    /// Relative tolerance of an adaptive method.
    pub rtol: f64,
    /// Absolute tolerance; `None` is scale-free.
    pub atol: Option<f64>,
    /// The longest step of an adaptive method.
    pub max_step: Option<f64>,
    /// The most steps, accepted or not, of a trajectory.
    pub max_steps: Option<i64>,
    /// Names from [`COLUMNS`].
    pub record: Vec<String>,
    /// Threads.
    pub threads: usize,
}

/// The nearest of the names, if it is near at all.
pub fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |a: &str, b: &str| {
        let b: Vec<char> = b.chars().collect();
        let mut row: Vec<usize> = (0..=b.len()).collect();
        for (i, x) in a.chars().enumerate() {
            let mut diagonal = row[0];
            row[0] = i + 1;
            for (j, &y) in b.iter().enumerate() {
                let substitute = diagonal + usize::from(x != y);
                diagonal = row[j + 1];
                row[j + 1] = substitute.min(row[j] + 1).min(row[j + 1] + 1);
            }
        }
        row[b.len()]
    };
    names
        .map(|name| (distance(word, name), name))
        .min()
        .filter(|(distance, name)| *distance <= name.len().max(word.len()) / 2)
        .map(|(_, name)| name)
}

/// "expected one of …, got 'x'; did you mean 'y'?"
pub fn unknown<'a>(argument: &str, word: &str, names: impl Iterator<Item = &'a str> + Clone) -> Error {
    let list: Vec<&str> = names.clone().collect();
    let hint = nearest(word, names).map(|name| format!("; did you mean '{name}'?")).unwrap_or_default();
    Error::invalid(argument, format!("expected one of {}, got '{word}'{hint}", list.join(", ")))
}

/// A checked request.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The method to integrate with (also where a closed form will do).
    pub method: &'static Method,
    /// Whether a closed form may be chosen.
    pub automatic: bool,
    /// +1 forward, -1 backward.
    pub direction: f64,
    /// The signed step.
    pub dt: Option<f64>,
}

impl Request {
    /// Whether a column is asked for.
    pub fn records(&self, column: &str) -> bool {
        self.record.iter().any(|name| name == column)
    }

    /// Refuses what cannot be done.
    ///
    /// # Errors
    /// By name, with what was expected and what came.
    pub fn check(&self, scene: &Scene) -> Result<Checked> {
        let automatic = self.method == "auto";
        let name = if automatic { "dop853" } else { &self.method };
        let names = core::iter::once("auto").chain(registry::METHODS.iter().map(|method| method.name));
        let method = registry::method(name).ok_or_else(|| unknown("method", name, names))?;
        for column in &self.record {
            if !COLUMNS.contains(&column.as_str()) {
                return Err(unknown("record", column, COLUMNS.into_iter()));
            }
        }
        let direction = self.direction(scene)?;
        if !(self.rtol >= RTOL_MIN && self.rtol <= 1.0) {
            return Err(Error::invalid(
                "rtol",
                format!(
                    "expected {RTOL_MIN:e} (what double precision can honour) to 1, got {:e}; a smaller error \
                     needs a fixed-step method such as kahan_li8",
                    self.rtol
                ),
            ));
        }
        match self.atol {
            Some(atol) if !(atol >= 0.0 && atol.is_finite()) => {
                return Err(Error::invalid(
                    "atol",
                    format!("expected a number of at least 0 or None, got {atol}"),
                ));
            }
            _ => {}
        }
        match self.max_step {
            Some(step) if step.is_nan() || step <= 0.0 => {
                return Err(Error::invalid(
                    "max_step",
                    format!("expected a positive time or None, got {step}"),
                ));
            }
            _ => {}
        }
        match self.max_steps {
            Some(steps) if steps < 1 => {
                return Err(Error::invalid("max_steps", format!("expected at least 1 or None, got {steps}")));
            }
            _ => {}
        }
        let dt = self.checked_step(method, automatic, direction)?;
        Ok(Checked { method, automatic, direction, dt })
    }

    fn direction(&self, scene: &Scene) -> Result<f64> {
        let times = &self.times;
        if times.is_empty() {
            return Err(Error::invalid("t", "expected an end time or at least one output time, got none"));
        }
        if let Some(index) = times.iter().position(|t| !t.is_finite()) {
            return Err(Error::invalid(
                "t",
                format!("expected finite times, got t[{index}] = {}", times[index]),
            ));
        }
        let end = times[times.len() - 1];
        let direction = if end < scene.t0 { -1.0 } else { 1.0 };
        let mut before = scene.t0;
        for (index, &t) in times.iter().enumerate() {
            if (t - before) * direction < 0.0 {
                return Err(Error::invalid(
                    "t",
                    format!(
                        "expected times in order from t0 = {} towards {end}, got t[{index}] = {t} after {before}; \
                         sort them, and run the two directions from t0 separately",
                        scene.t0
                    ),
                ));
            }
            before = t;
        }
        Ok(direction)
    }

    fn checked_step(&self, method: &Method, automatic: bool, direction: f64) -> Result<Option<f64>> {
        match self.dt {
            None if method.adaptive() => Ok(None),
            None => Err(Error::invalid(
                "dt",
                format!("{} has a fixed step: expected dt, the time of one step, got None", method.name),
            )),
            Some(dt) if !dt.is_finite() || dt == 0.0 => {
                Err(Error::invalid("dt", format!("expected a finite time other than 0, got {dt}")))
            }
            Some(_) if method.adaptive() => Err(Error::invalid(
                "dt",
                format!(
                    "{} chooses its own steps: leave dt out, or give max_step{}",
                    method.name,
                    if automatic { ", or name a fixed-step method" } else { "" }
                ),
            )),
            Some(dt) if dt < 0.0 && direction > 0.0 => Err(Error::invalid(
                "dt",
                format!("expected a positive step for a run forward in time, got {dt}"),
            )),
            Some(dt) => Ok(Some(dt.abs() * direction)),
        }
    }
}
