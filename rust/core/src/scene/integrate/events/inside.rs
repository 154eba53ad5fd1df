//! The bodies that events look at, inside a step: on the polynomials of an adaptive method, on cubics through both ends, or in
//! the state of a shadow step.

use super::super::super::events::Sight;
use super::search::Search;
use super::{Interpolant, Span, Watch};
use crate::error::Result;
use crate::numerics::double_double::two_sum;
use crate::numerics::lanes::WIDTH;
use crate::numerics::power_of_two::scale;
use crate::parallel::Ticker;

impl Watch<'_> {
    /// Asks for the polynomials of the bodies that are looked at.
    pub(super) fn ask(&mut self, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<()> {
        self.terms.clear();
        for at in self.bodies.coordinates() {
            step.polynomial(at / WIDTH, at % WIDTH, &mut self.terms, ticker)?;
        }
        let exponent = -self.job.plan.units.acceleration();
        self.terms.iter_mut().flatten().for_each(|term| *term = scale(*term, exponent));
        Ok(())
    }

    /// Places the bodies of an event inside the step: on the polynomial, or on the cubics through both ends if there is none.
    pub(super) fn place(&mut self, event: usize, components: usize, span: Span, theta: f64) {
        let h = scale(span.to - span.from, self.job.plan.units.time);
        let rest = 1.0 - theta;
        let count = self.terms.len() / (self.before.len() * components).max(1);
        for index in 0..self.event(event).1.len() {
            let body = self.event(event).1[index];
            let (before, after) = (&self.before[body], &self.after[body]);
            let mut moving = *before;
            for c in 0..components {
                let (start, end) = (before.velocity[c], after.velocity[c]);
                let (moved, faster) = if count == 0 {
                    let way = after.position[c] - before.position[c];
                    let bend = rest * (h * start - way) - theta * (h * end - way);
                    let slope = 6.0 * theta * rest * (way / h - start);
                    (theta * (way + rest * bend), slope + theta * (3.0 * theta - 2.0) * (end - start))
                } else {
                    let terms = &self.terms[(body * components + c) * count..][..count];
                    let mut sums = [0.0; 2];
                    for (index, term) in terms.iter().enumerate().rev() {
                        let factor = if index % 2 == 0 { theta } else { rest };
                        sums = [factor * (term[0] + sums[0]), factor * (term[1] + sums[1])];
                    }
                    (h * (theta * (start + before.velocity_rest[c]) + h * sums[0]), h * sums[1])
                };
                let (x, left) = two_sum(before.position[c], moved);
                (moving.position[c], moving.position_rest[c]) = (x, left + before.position_rest[c]);
                let (v, left) = two_sum(start, faster);
                (moving.velocity[c], moving.velocity_rest[c]) = (v, left + before.velocity_rest[c]);
            }
            self.inside[body] = moving;
        }
    }
}

impl Search<'_, '_> {
    /// As [`value_at`](Self::value_at), and what is known of the ends.
    pub(super) fn value_on_solution(
        &mut self,
        theta: f64,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        match theta {
            0.0 => Ok(self.ends[0]),
            1.0 => Ok(self.ends[1]),
            theta => self.value_at(theta, step, ticker),
        }
    }

    /// On the polynomial, or on the solution where there is none.
    pub(super) fn value_at(
        &mut self,
        theta: f64,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        Ok(self.sight_at(theta, step, ticker)?.value)
    }

    /// Of what follows from positions, the velocities are about those.
    pub(super) fn sight_at(
        &mut self,
        theta: f64,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Sight> {
        self.sight_of_state(theta, !self.is_of_positions(), step, ticker)
    }

    /// On the polynomial, or where there is none on the solution, with the velocities there if they are wanted.
    pub(super) fn sight_of_state(
        &mut self,
        theta: f64,
        velocities: bool,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Sight> {
        if self.watch.terms.is_empty() || self.watch.settles || self.sees_turning() {
            let state = if velocities { step.at(theta, ticker)? } else { step.positions_at(theta, ticker)? };
            self.watch.bodies.read(state, &mut self.watch.inside);
            self.watch.turn(self.unit, state, self.span.at(theta));
            self.sight_inside(theta, ticker)
        } else {
            self.sight_between(theta, ticker)
        }
    }

    /// Whether the event looks at how rigid bodies are turned, of which no polynomial tells.
    fn sees_turning(&self) -> bool {
        self.watch.event(self.event).0.sees_turning()
    }

    /// Where a step is looked through: on the polynomial, or on the cubics where there is none; for who looks at how rigid
    /// bodies are turned, on the solution.
    pub(super) fn sight_on_the_way(
        &mut self,
        theta: f64,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Sight> {
        if self.sees_turning() {
            self.sight_at(theta, step, ticker)
        } else {
            self.sight_between(theta, ticker)
        }
    }

    /// On the polynomial, or on the cubics where there is none.
    pub(super) fn sight_between(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<Sight> {
        self.watch.place(self.event, self.unit.shape.components, self.span, theta);
        self.sight_inside(theta, ticker)
    }

    pub(super) fn sight_inside(&self, theta: f64, ticker: &mut Ticker<'_>) -> Result<Sight> {
        let bodies = (&self.watch.inside[..], self.span.at(theta));
        let mut sight = self.watch.sight(self.unit, self.event, bodies, ticker)?;
        sight.value += self.shift;
        Ok(sight)
    }
}
