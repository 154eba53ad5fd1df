//! What is asked of a scene: times, method, tolerances, columns; checked before anything runs.

use super::Scene;
use super::collisions::Collisions;
use super::events::{self, Event};
use super::plan::with_equal_steps;
use crate::conservation::columns::{COLUMNS, Column};
use crate::error::{Error, Result};
use crate::ode::transformation::Transformation;
use crate::ode::{Method, Scheme};
use crate::registry;
use crate::words::{number, unknown};

/// The smallest relative tolerance that double precision can honour (a hundred units in the last place).
pub const RTOL_MIN: f64 = 2.3e-14;

/// The most steps that a run can count: 2^53, the largest number to which every whole number is one of float64.
const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// What `auto` steps with where it knows nothing better: at one tolerance its errors are a tenth to a twentieth of those of
/// DOP853 on orbits, and half of them elsewhere, in 0.8 to 1.4 times the time (ten scenes, from one body under drag to a
/// hundred that attract each other; tolerances of 1e-6 to 1e-12).
const STEPPED_BY: &str = "verner98";

/// What may be recorded: states, and what is derived from them.
pub fn columns() -> impl Iterator<Item = &'static str> + Clone {
    ["position", "velocity"].into_iter().chain(COLUMNS.iter().map(|column| column.name))
}

/// What may be recorded of rigid bodies besides.
pub const TURNING: [&str; 2] = ["orientation", "angular_velocity"];

/// Absolute tolerances in the scene's units, of places and of velocities: one number, or one for each body; a kind without one
/// is scale-free.
#[derive(Clone, Debug)]
pub struct AbsoluteTolerances {
    /// Of places.
    pub position: Option<Vec<f64>>,
    /// Of velocities.
    pub velocity: Option<Vec<f64>>,
}

impl AbsoluteTolerances {
    /// Those of both kinds.
    pub fn kinds(&self) -> [Option<&[f64]>; 2] {
        [self.position.as_deref(), self.velocity.as_deref()]
    }

    /// How it is told: the number, if there is one for all.
    fn told(&self) -> String {
        match self.kinds() {
            [Some([one]), Some([other])] if one == other => number(*one),
            _ => "several".to_owned(),
        }
    }

    /// Refuses what is no tolerance, and numbers for other bodies than those there are.
    fn check(&self, particles: usize, collisions: bool) -> Result<()> {
        let refused = |message: String| Err(Error::invalid("atol", message));
        for kind in self.kinds().into_iter().flatten() {
            if kind.len() != 1 && kind.len() != particles {
                let expected = format!("expected one number, or one for each of {particles} bodies");
                return refused(format!("{expected}, got {}", kind.len()));
            }
            if kind.len() > 1 && collisions {
                return refused(
                    "expected one number for all bodies beside collisions, got several".to_owned(),
                );
            }
            if let Some(atol) = kind.iter().find(|atol| !(**atol >= 0.0 && atol.is_finite())) {
                return refused(format!("expected a number of at least 0 or None, got {}", number(*atol)));
            }
        }
        Ok(())
    }
}

/// What is asked of a scene.
#[derive(Clone, Debug)]
pub struct Request {
    /// Output times, from `t0` on in one direction.
    pub times: Vec<f64>,
    /// A method's name, or `auto`.
    pub method: String,
    /// The step of a fixed-step method.
    pub dt: Option<f64>,
    /// What is watched for its steps to be equal in another time than time itself, by name.
    pub time_transformation: Option<String>,
    /// Relative tolerance of an adaptive method.
    pub rtol: f64,
    /// Whether somebody has asked for that.
    pub rtol_given: bool,
    /// Absolute tolerances; `None` is scale-free.
    pub atol: Option<AbsoluteTolerances>,
    /// The longest step of an adaptive method.
    pub max_step: Option<f64>,
    /// The longest first step of an adaptive method.
    pub first_step: Option<f64>,
    /// The most steps, accepted or not, of a trajectory.
    pub max_steps: Option<i64>,
    /// Names from [`columns`].
    pub record: Vec<String>,
    /// What is looked for on the way.
    pub events: Vec<Event>,
    /// What spheres do that touch; `None` lets them pass through each other.
    pub collisions: Option<Collisions>,
    /// Threads.
    pub threads: usize,
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
    /// The signed step, if it is the same in time.
    pub dt: Option<f64>,
    /// What is watched where it is the same in another time, and the signed step at the start.
    pub transformed: Option<(Transformation, f64)>,
}

impl Request {
    /// Output times between the start and the end.
    pub fn outputs_between(&self, t0: f64) -> usize {
        let end = self.times.last().copied().unwrap_or(t0);
        self.times.iter().filter(|&&t| (t != t0) & (t != end)).count()
    }

    /// Whether a column is asked for.
    pub fn records(&self, column: &str) -> bool {
        self.record.iter().any(|name| name == column)
    }

    /// Whether it is asked how rigid bodies turn.
    pub fn records_turning(&self) -> bool {
        TURNING.iter().any(|column| self.records(column))
    }

    /// The derived columns that are asked for, in that order, each once.
    pub fn derived(&self) -> Vec<&'static Column> {
        let mut derived: Vec<&'static Column> = Vec::new();
        for name in &self.record {
            let wanted = COLUMNS.iter().find(|column| column.name == name);
            derived.extend(wanted.filter(|column| derived.iter().all(|other| other.name != column.name)));
        }
        derived
    }

    /// Refuses what cannot be done.
    ///
    /// # Errors
    /// By name, with what was expected and what came.
    pub fn check(&self, scene: &Scene) -> Result<Checked> {
        let automatic = self.method == "auto";
        let name = if automatic { STEPPED_BY } else { &self.method };
        let all = registry::methods_for(scene.rigid.is_some());
        let names = core::iter::once("auto").chain(all.clone().map(|method| method.name));
        let method = all.clone().find(|method| method.name == name);
        let method = method.ok_or_else(|| unknown("method", name, names))?;
        let turning = scene.rigid.iter().flat_map(|_| TURNING);
        let known = || columns().chain(turning.clone());
        for column in &self.record {
            if !known().any(|name| name == column) {
                return Err(unknown("record", column, known()));
            }
        }
        events::check(&self.events, scene)?;
        let direction = self.direction(scene)?;
        self.check_tolerances(method, scene)?;
        if let Some(step) = self.max_step {
            self.refuse_lost("max_step", step, scene.t0)?;
        }
        match self.max_steps {
            Some(steps) if steps < 1 => {
                return Err(Error::invalid("max_steps", format!("expected at least 1 or None, got {steps}")));
            }
            _ => {}
        }
        let by = self.transformation(method, automatic)?;
        let dt = self.checked_step(scene, method, automatic, direction)?;
        let transformed = by.zip(dt);
        Ok(Checked { method, automatic, direction, dt: dt.filter(|_| by.is_none()), transformed })
    }

    /// In what time the steps are to be equal.
    fn transformation(&self, method: &Method, automatic: bool) -> Result<Option<Transformation>> {
        let Some(name) = &self.time_transformation else { return Ok(None) };
        let names = Transformation::ALL.iter().map(|by| by.name());
        let by = Transformation::ALL.iter().find(|by| by.name() == name);
        let by = *by.ok_or_else(|| unknown("time_transformation", name, names))?;
        if self.collisions.is_some() {
            // What goes on from a contact begins anew, with the step of a distance that is then the smallest.
            let message = "expected None beside collisions, after which the step would no longer be that of the start; use \
                           an adaptive method such as verner98";
            return Err(Error::invalid("time_transformation", message));
        }
        if method.transforms() && !automatic {
            return Ok(Some(by));
        }
        let why = if automatic || method.adaptive() {
            "chooses its steps by an error estimate"
        } else {
            match method.scheme {
                Scheme::NystromSplitting(_) => {
                    "has its order only where drifts are linear in the velocities, which they are not in another time"
                }
                Scheme::Splitting(_) => "is not symmetric, and not reversible in any time",
                Scheme::Boris(_) => "turns velocities, which has no such form",
                _ => "is not made of kicks and drifts",
            }
        };
        let others = registry::METHODS.iter().filter(|method| method.transforms()).map(|method| method.name);
        Err(Error::invalid(
            "time_transformation",
            format!(
                "{} {why}: a time transformation needs a method that is composed of leapfrogs or like them; expected one of {}, \
                 with dt, or no time_transformation",
                self.method,
                others.collect::<Vec<_>>().join(", ")
            ),
        ))
    }

    /// What steers an adaptive method. `rtol` always has a value, so that a method without tolerances ignores it.
    fn check_tolerances(&self, method: &Method, scene: &Scene) -> Result<()> {
        if !(self.rtol >= RTOL_MIN && self.rtol <= 1.0) {
            let advice = if self.rtol > 0.0 && self.rtol < RTOL_MIN {
                format!("; a smaller error needs a fixed-step method such as {}", with_equal_steps(scene))
            } else {
                String::new()
            };
            return Err(Error::invalid(
                "rtol",
                format!(
                    "expected {} (what double precision can honour) to 1, got {}{advice}",
                    number(RTOL_MIN),
                    number(self.rtol)
                ),
            ));
        }
        let refused = |argument: &str, expected: &str, came: f64| {
            Err(Error::invalid(argument, format!("expected {expected} or None, got {}", number(came))))
        };
        if let Some(atol) = &self.atol {
            atol.check(scene.particles, self.collisions.is_some())?;
        }
        match self.max_step {
            Some(step) if step.is_nan() || step <= 0.0 => {
                return refused("max_step", "a positive time", step);
            }
            _ => {}
        }
        let atol = self.atol.as_ref().map(AbsoluteTolerances::told);
        for (argument, given) in [("atol", atol), ("max_step", self.max_step.map(number))] {
            match given {
                Some(given) if !method.adaptive() => {
                    // Those that torques turn take no time transformation.
                    let transforms = if method.symplectic && scene.rigid.is_none() {
                        "; a symplectic method whose steps are chosen from one to the next is no symplectic map, and \
                         its energy drifts: what keeps it where steps must change is time_transformation="
                    } else {
                        ""
                    };
                    let message = format!(
                        "{} has a fixed step, dt, which nothing else changes: expected None, got {}; leave {argument} \
                         out and choose dt, or name an adaptive method such as verner98{transforms}",
                        method.name, given
                    );
                    return Err(Error::invalid(argument, message));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn direction(&self, scene: &Scene) -> Result<f64> {
        let (Some(&first), Some(&end)) = (self.times.first(), self.times.last()) else {
            return Err(Error::invalid("t", "expected an end time or at least one output time, got none"));
        };
        let direction = if end < scene.t0 { -1.0 } else { 1.0 };
        // Without a branch for each: a run of cheap steps with many outputs would feel it.
        let follows = |before: f64, t: f64| t.is_finite() & ((t - before) * direction >= 0.0);
        let all = |good, pair: &[f64]| good & follows(pair[0], pair[1]);
        if !self.times.windows(2).fold(follows(scene.t0, first), all) {
            return Err(self.disorder(scene.t0, direction));
        }
        if (end - scene.t0).is_finite() {
            return Ok(direction);
        }
        Err(Error::invalid(
            "t",
            format!(
                "expected times within the range of float64 from t0 = {}, got {}, which is farther than that",
                number(scene.t0),
                number(end)
            ),
        ))
    }

    /// What is wrong with times that do not follow each other.
    fn disorder(&self, t0: f64, direction: f64) -> Error {
        let times = &self.times;
        if let Some(index) = times.iter().position(|t| !t.is_finite()) {
            return Error::invalid(
                "t",
                format!("expected finite times, got t[{index}] = {}", number(times[index])),
            );
        }
        let before = |index: usize| if index == 0 { t0 } else { times[index - 1] };
        // The first that leads away tells where to; the last may be the one that is out of order.
        let direction = times.iter().find(|&&t| t != t0).map_or(direction, |t| (t - t0).signum());
        let back = |&index: &usize| (times[index] - before(index)) * direction < 0.0;
        let index = (0..times.len()).find(back).unwrap_or(0);
        Error::invalid(
            "t",
            format!(
                "expected times that lead away from t0 = {} in order, got t[{index}] = {} after {}; sort \
                 them, and run the two directions from t0 separately",
                number(t0),
                number(times[index]),
                number(before(index))
            ),
        )
    }

    /// The step with the sign of the direction. It is given by its length; a sign is taken if it agrees with the
    /// direction of time.
    fn checked_step(
        &self,
        scene: &Scene,
        method: &Method,
        automatic: bool,
        direction: f64,
    ) -> Result<Option<f64>> {
        let end = self.times.last().copied().unwrap_or(scene.t0);
        match self.dt {
            None if method.adaptive() => Ok(None),
            None => Err(Error::invalid(
                "dt",
                format!("{} has a fixed step: expected dt, the time of one step, got None", method.name),
            )),
            Some(dt) if !dt.is_finite() || dt == 0.0 => {
                Err(Error::invalid("dt", format!("expected a finite time other than 0, got {}", number(dt))))
            }
            Some(_) if method.adaptive() => Err(Error::invalid(
                "dt",
                format!(
                    "{} chooses its own steps: leave dt out, or give max_step{}",
                    if automatic { "auto" } else { method.name },
                    if automatic { ", or name a fixed-step method" } else { "" }
                ),
            )),
            Some(dt) if dt < 0.0 && end > scene.t0 => Err(Error::invalid(
                "dt",
                format!(
                    "expected a positive step for a run forward in time, from t0 = {} to {}, got {}",
                    number(scene.t0),
                    number(end),
                    number(dt)
                ),
            )),
            Some(dt) => {
                self.refuse_lost("dt", dt.abs(), scene.t0)?;
                Ok(Some(dt.abs() * direction))
            }
        }
    }

    /// Refuses a step so short that adding it does not change the time, or that there are more of them than can be counted.
    fn refuse_lost(&self, argument: &str, step: f64, t0: f64) -> Result<()> {
        let end = self.times.last().copied().unwrap_or(t0);
        let latest = t0.abs().max(end.abs());
        let steps = (end - t0).abs() / step;
        if latest + step != latest && steps < MOST_STEPS {
            return Ok(());
        }
        Err(Error::invalid(
            argument,
            format!(
                "expected a step that changes the time at {}, at most {} times, got {}: the run would take {:.1e} steps; \
                 give a longer one",
                number(latest),
                number(MOST_STEPS),
                number(step),
                steps
            ),
        ))
    }
}
