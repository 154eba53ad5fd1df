//! What is too narrow for a step to see: smooth walls, bumps and pulses that lie between the places where a method looks.
//!
//! The one idea: what is algebraic and falls slowly tells of itself from afar, and a step control sees it; exp and what is written
//! with it (tanh, 1/cosh), and 1/(1 + u⁸), may be nothing at two neighboring places and all that matters in between. But their
//! arguments are seen everywhere: an argument that moves by more than a little between two places is followed on the way
//! ([`search`]), and where the function at what it goes through changes the rates by what matters, the step is taken again, and
//! ends before that.
//!
//! Of most steps the arguments at the ends and how fast they move there tell that nothing is to be followed.

mod ends;
mod features;
mod search;
mod way;
mod weak;

use crate::error::{Error, Result};
use crate::expressions::machine::Width;
use crate::numerics::real::Mask;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken};
use ends::Ends;
pub use features::{Equations, Features};
use search::{Criteria, Search};
use std::sync::Arc;
use way::Way;
use weak::Weak;

/// What ends a run with equal steps.
pub const UNSEEN: &str = "a step went over a wall, a bump, a pulse or an oscillation that is narrower than the step, and felt nothing of it; \
    take a shorter dt, or leave dt out with a method that chooses its steps";

/// The most that an argument may move between two places where a method looks: a bump that is e⁻³ there is felt.
pub const REACH: f64 = 3.0;
/// The same of equal steps, which are as coarse as they were asked for.
const REACH_OF_EQUAL: f64 = 4.0;
/// The same of waves in equal steps, by what they turn: more than two looks in a turn tell it from none.
const REACH_OF_EQUAL_WAVES: f64 = 2.5;
/// The same of a series, which knows e²⁰ times what it begins with by its last coefficients.
const REACH_OF_SERIES: f64 = 20.0;
/// What may be unseen in equal steps, as a part of a number.
const UNSEEN_BY_EQUAL: f64 = 1e-3;
/// The least part of the reach by which arguments at the ends show that nothing is to be followed.
const SHARE: f64 = 0.5;

/// How a run is stepped.
#[derive(Clone, Copy, Debug)]
pub struct Stepped {
    /// The time at its start.
    pub t0: f64,
    /// What may be unseen, as a part of a number; none of equal steps, which are as coarse as they were asked for.
    pub tolerance: Option<f64>,
    /// The most that an argument may move between two places where a method looks.
    pub reach: f64,
}

/// Features under watch, of one trajectory or of eight.
#[derive(Debug)]
pub struct Narrow<S> {
    of: Arc<Features>,
    form: Form,
    ends: Ends<S>,
    parameters: Vec<S>,
    /// The time at the start of the run.
    t0: f64,
    /// What may be unseen, as a part of a number.
    tolerance: f64,
    /// Whether steps are equal, and cannot be shorter.
    equal: bool,
    reach: f64,
    weak: Option<Weak>,
    search: Option<Search>,
    /// How fast arguments move at most, if all of them do so steadily.
    fastest: S,
}

impl<S: Width + Controlled> Narrow<S> {
    /// Of a run with these parameters.
    pub fn new(
        of: &Arc<Features>,
        form: Form,
        Stepped { t0, tolerance, reach }: Stepped,
        parameters: &[S],
    ) -> Self {
        let mut narrow = Self {
            of: of.clone(),
            form,
            ends: Ends::new(form, &of.ends, parameters),
            parameters: parameters.to_vec(),
            t0,
            tolerance: tolerance.unwrap_or(UNSEEN_BY_EQUAL),
            equal: tolerance.is_none(),
            reach,
            weak: None,
            search: None,
            fastest: S::zero(),
        };
        narrow.set_parameters(parameters);
        narrow
    }

    /// With other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[S]) {
        self.parameters.copy_from_slice(parameters);
        self.ends.set_parameters(parameters);
        if self.of.steady {
            self.fastest = self.ends.fastest();
        }
    }

    /// How far an argument may move between two places where a step looks.
    fn reach(&self, step: &Taken<'_, S>) -> f64 {
        match (self.equal, step.series) {
            (true, _) => REACH_OF_EQUAL,
            (_, true) => REACH_OF_SERIES,
            _ => self.reach,
        }
    }

    /// [`System::seen_until`](crate::ode::system::System::seen_until).
    ///
    /// # Errors
    /// [`Error::Convergence`] of one trajectory with equal steps.
    pub fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        if !self.of.steady {
            return self.followed(step);
        }
        let gap = step.looks.longest_gap();
        let reach = if self.equal { REACH_OF_EQUAL_WAVES } else { self.reach(step) };
        let moves_little = (self.fastest * step.h.abs()).less_equal(S::splat(reach / gap));
        let asked = step.asked.and(moves_little.not());
        if asked.any() { self.followed(&Taken { asked, ..*step }) } else { Ok(None) }
    }

    /// [`System::calm`](crate::ode::system::System::calm).
    pub fn calm(&mut self, step: &Taken<'_, S>, times: f64) -> S::Mask {
        let (h, reach, gap) = (step.h * S::splat(times), SHARE * self.reach(step), step.looks.longest_gap());
        if self.of.steady {
            return (self.fastest * h.abs()).less_equal(S::splat(reach / gap));
        }
        self.ends.calm(&h, (reach, gap), &self.of.at_ends)
    }

    /// The same, of arguments that may move by much.
    fn followed(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        let little = (SHARE * self.reach(step), step.looks.longest_gap());
        let criteria = Criteria { reach: self.reach(step), equal: self.equal, tolerance: self.tolerance };
        let Some(told) = self.ends.tell(step, self.t0, little, &self.of.at_ends) else { return Ok(None) };
        let (told, mut seen) = (S::select(step.asked, told, S::one()), S::one());
        for lane in (0..S::LANES).filter(|&lane| told.lane(lane) == 0.0) {
            let parameters: Vec<f64> = self.parameters.iter().map(|value| value.lane(lane)).collect();
            let of = &self.of;
            let weak = self.weak.get_or_insert_with(|| Weak::new(of));
            if weak.holds(
                &parameters,
                (step, lane, self.t0),
                &self.ends.hulls(step, lane, little, &self.of.at_ends),
                self.tolerance,
            ) {
                continue;
            }
            let way = Way::of(self.form, step, lane, self.t0);
            let search = self.search.get_or_insert_with(|| Search::new(of));
            let part = search.seen_until(&parameters, way, criteria);
            seen = seen.with_lane(lane, part);
        }
        if !seen.less(S::one()).any() {
            return Ok(None);
        }
        if self.equal && S::LANES == 1 {
            return Err(Error::Convergence { message: UNSEEN.to_owned(), time: self.t0 + step.from.lane(0) });
        }
        Ok(Some(seen))
    }
}
