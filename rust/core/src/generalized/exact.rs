//! Motions that are known at any time, without steps.
//!
//! The one idea: who knows the state after any time needs no step for it, so output times are read as they are, and events are
//! looked for part by part of what turns slowly enough.

use super::events::{Interval, Watch};
use super::run::{Request, Solution};
use crate::error::{Error, Result};
use crate::numerics::double_double::two_sum;
use crate::numerics::matrix_exponential::elapsed;
use crate::ode::run::Ending;
use crate::parallel::Ticker;
use core::fmt::Debug;

/// Equations of motion that are solved at once.
pub trait ExactMotion: Debug + Send + Sync {
    /// The motion from a start, with these parameters, over a span.
    ///
    /// # Errors
    /// A singular mass matrix.
    fn flow(&self, of: (&[f64], &[f64]), span: (f64, f64)) -> Result<Box<dyn Flow>>;
}

/// A motion that is known at any time.
pub trait Flow {
    /// The time from one look for events to the next.
    fn look(&self) -> f64;

    /// The state after a time that has elapsed, as an unevaluated sum; negative where the run goes backwards.
    fn after(&mut self, elapsed: (f64, f64)) -> Vec<f64>;
}

/// The states at the output times of a run, or at its end.
///
/// # Errors
/// Those of the motion, and of events.
pub fn solve(
    motion: &dyn ExactMotion,
    request: &Request,
    (y0, parameters): (&[f64], &[f64]),
    ticker: &mut Ticker<'_>,
) -> Result<Solution> {
    let (t0, end) = request.span;
    let mut flow = motion.flow((y0, parameters), request.span)?;
    let mut solution = Solution::at(t0, y0);
    let mut stop = None;
    if !request.events.is_empty() {
        let mut watch = Watch::new(&request.events, parameters);
        match look(&mut *flow, y0, request.span, &mut watch, ticker) {
            Ok(stopped) => stop = stopped,
            Err(Error::Interrupted) => solution.ending = Ending::Interrupted,
            Err(error) => return Err(error),
        }
        solution.found = watch.found;
        if solution.ending == Ending::Interrupted {
            return Ok(solution);
        }
    }
    let only_end = [end];
    let beyond = |t: f64| stop.is_some_and(|stop| if t0 <= end { t > stop } else { t < stop });
    for &t in request.outputs.as_deref().unwrap_or(&only_end) {
        if beyond(t) {
            break;
        }
        if ticker.tick().is_err() {
            return Ok(Solution { ending: Ending::Interrupted, ..solution });
        }
        let state = if t == t0 { y0.to_vec() } else { flow.after(elapsed(t, t0)) };
        if !state.iter().all(|number| number.is_finite()) {
            let ending = Ending::NotFinite;
            return Ok(Solution { ending, failure: ending.reason(), ..solution });
        }
        solution.t.push(t);
        solution.y.extend(&state);
        (solution.reached, solution.last_time) = (t, t);
        solution.last_state.copy_from_slice(&state);
    }
    if let Some(stop) = stop {
        (solution.ending, solution.reached) = (Ending::Stopped, stop);
    }
    Ok(solution)
}

/// Looks for events on the way; the time of the one that ends the run, if one does.
fn look(
    flow: &mut dyn Flow,
    start: &[f64],
    (t0, end): (f64, f64),
    watch: &mut Watch<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Option<f64>> {
    let h = flow.look();
    let (span, sign) = ((end - t0).abs(), if end < t0 { -1.0 } else { 1.0 });
    watch.start(t0, start)?;
    let (mut node, mut from) = (0.0, t0);
    loop {
        ticker.tick()?;
        // What never turns is looked at once.
        let elapsed = if node == 0.0 { 0.0 } else { node * h };
        let next = (node + 1.0) * h;
        let last = next >= span;
        let length = if last { span - elapsed } else { h };
        let to = if last { end } else { t0 + sign * next };
        let (elapsed, length) = (sign * elapsed, sign * length);
        let y = flow.after(two_sum(elapsed, length));
        if !y.iter().all(|number| number.is_finite()) {
            return Ok(None);
        }
        let mut part = Part { flow, elapsed, length, span: (from, to), end: y, inside: vec![] };
        let stop = watch.look(&mut part)?;
        if stop.is_some() || last {
            return Ok(stop);
        }
        (node, from) = (node + 1.0, to);
    }
}

/// A part of a motion that takes no steps.
struct Part<'a> {
    flow: &'a mut dyn Flow,
    /// Since the start of the run.
    elapsed: f64,
    length: f64,
    span: (f64, f64),
    end: Vec<f64>,
    inside: Vec<f64>,
}

impl Interval for Part<'_> {
    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn end(&self) -> &[f64] {
        &self.end
    }

    fn at(&mut self, theta: f64) -> Result<&[f64]> {
        if theta == 1.0 {
            return Ok(&self.end);
        }
        self.inside = self.flow.after(two_sum(self.elapsed, theta * self.length));
        Ok(&self.inside)
    }
}
