//! A step of a series as it is shown to who asks what no coefficient has told: the states that it goes through.

use super::TaylorStep;
use crate::numerics::angles::cos;
use crate::ode::looks::Looks;
use crate::ode::series::Jet;
use crate::ode::state::State;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken, Visited};

/// Of so many places a step is asked what it went through.
const VISITED: usize = 13;

impl<S: Controlled> TaylorStep<S> {
    /// The step as who asks what it has not seen is shown it.
    pub(super) fn taken<'a>(
        &'a self,
        asked: S::Mask,
        state: &'a State<S>,
        from: S,
        visited: &'a dyn Fn(usize) -> Visited,
    ) -> Taken<'a, S> {
        let ends = [state.all().0, self.next.all().0];
        Taken {
            asked,
            from,
            h: self.h,
            ends,
            rates: None,
            looks: &Looks::AT_ENDS,
            series: true,
            visited: Some(visited),
        }
    }

    /// The states that the step goes through in a lane.
    pub(super) fn visited(&self, state: &State<S>, lane: usize) -> Visited {
        let Jet { q, v, len, order, unit, .. } = &self.jet;
        let (unit, h) = (unit.lane(lane), self.h.lane(lane));
        let sum = |blocks: &[S], highest: usize, index: usize, x: f64| {
            let coefficients = (0..=highest).rev().map(|n| blocks[n * len + index].lane(lane));
            coefficients.fold(0.0, |sum, coefficient| sum * x + coefficient)
        };
        let second_order = matches!(state.form(), Form::SecondOrder(_));
        let at = |k: usize| {
            // Where polynomials of a high degree swing least.
            let place = 0.5 - 0.5 * cos(core::f64::consts::PI * k as f64 / (VISITED - 1) as f64);
            let place = if k == 0 {
                0.0
            } else if k == VISITED - 1 {
                1.0
            } else {
                place
            };
            let x = place * h / unit;
            let highest = if second_order { order + 1 } else { *order };
            let places = (0..*len).map(|index| sum(q, highest, index, x));
            let moving =
                (0..if second_order { *len } else { 0 }).map(|index| sum(v, *order, index, x) / unit);
            (place, places.chain(moving).collect())
        };
        (0..VISITED).map(at).collect()
    }
}
