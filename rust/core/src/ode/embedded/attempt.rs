//! A step that is tried, of a system of the first order held to a root mean square, in one kernel.
//!
//! The one idea: of few numbers the way from the last stage to the next step costs as much as the stages, so the clock is
//! read, the step taken, measured and settled, and the derivative at its end evaluated, without leaving the kernel.

use super::EmbeddedStep;
use crate::error::Result;
use crate::numerics::element::{Pass, View};
use crate::numerics::real::Mask;
use crate::ode::norm::RootMeanSquare;
use crate::ode::passes::errors::HUGE;
use crate::ode::passes::rates::RateErrors;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Settled};
use crate::ode::system::{System, Taken};
use crate::parallel::Ticker;

/// [`Trial::attempt`](crate::ode::trial::Trial::attempt), its arguments, and the method at work.
pub(super) struct Attempt<'a, 'b, S: Controlled> {
    pub(super) method: &'a mut EmbeddedStep<S>,
    pub(super) running: S::Mask,
    pub(super) system: &'a mut dyn System<S>,
    pub(super) state: &'a State<S>,
    pub(super) clock: &'a mut Clock<S>,
    pub(super) mean: &'a RootMeanSquare<S>,
    pub(super) ticker: &'a mut Ticker<'b>,
}

impl<S: Controlled> Pass<S> for Attempt<'_, '_, S> {
    type Output = Result<Settled<S>>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Result<Settled<S>> {
        let Self { method, running, system, state, clock, mean, ticker } = self;
        let (from, h) = (clock.elapsed, S::next_step(clock, running));
        method.seen = None;
        let end_stage = method.end_stage();
        let EmbeddedStep { stages, errors: [_, terms], end_in_estimate, next, .. } = &mut *method;
        let errors = RateErrors { terms, end: *end_in_estimate, atol: &mean.atol, rtol: &mean.rtol };
        let step = stages.rate_pass((&from, &h), (state, next), Some(errors), &mut *system, &mut *ticker);
        let sizes = step.run::<V>()?;
        let size2 = method.combined(sizes);
        let before = *clock;
        let outcome = S::settle(clock, running, size2, &method.rule);
        if outcome.accepted.any() && !method.end_in_estimate {
            method.stages.evaluate(end_stage, &clock.elapsed, &method.next, system, ticker)?;
        }
        if !outcome.accepted.any() {
            return Ok(outcome);
        }
        let back = Back { running, state, clock, before, step: (from, h), size2 };
        method.seen_or_taken_back(outcome, back, system)
    }
}

/// What a step that was accepted is taken back with.
pub(super) struct Back<'a, S: Controlled> {
    pub(super) running: S::Mask,
    /// The state before it.
    pub(super) state: &'a State<S>,
    pub(super) clock: &'a mut Clock<S>,
    pub(super) before: Clock<S>,
    /// Where it began, and its length.
    pub(super) step: (S, S),
    pub(super) size2: S,
}

impl<S: Controlled> EmbeddedStep<S> {
    /// Asks the system what lies unseen in a step that was accepted, and settles it once more, to end before that.
    #[inline(always)]
    pub(super) fn seen_or_taken_back(
        &mut self,
        outcome: Settled<S>,
        Back { running, state, clock, before, step: (from, h), size2 }: Back<'_, S>,
        system: &mut dyn System<S>,
    ) -> Result<Settled<S>> {
        let end_stage = self.end_stage();
        let Self { stages, next, looks, .. } = &*self;
        let len = stages.len();
        self.seen = system.seen_until(&Taken {
            asked: outcome.accepted,
            from,
            h,
            ends: [state.all().0, next.all().0],
            rates: Some([&stages.k[..len], &stages.k[end_stage * len..][..len]]),
            looks,
            series: false,
            visited: None,
        })?;
        let Some(seen) = self.seen else { return Ok(outcome) };
        let unseen = seen.less(S::one());
        *clock = before;
        let outcome = S::settle(clock, running, S::select(unseen, S::splat(HUGE), size2), &self.rule);
        clock.h = S::select(unseen, h * seen, clock.h);
        Ok(outcome)
    }
}
