//! Whether a step of a series leads astray: told by the rates at its end, which no coefficient knows of.

use super::TaylorStep;
use crate::error::Result;
use crate::numerics::real::Mask;
use crate::ode::norm::Norm;
use crate::ode::passes::series_errors::Astray;
use crate::ode::passes::step_by_series::{Missed, OwnMissed};
use crate::ode::series::Jet;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, System};
use crate::parallel::Ticker;

/// Rates that are the same but for rounding differ by less, relative to how far they move a number.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// So many times what a last digit of all numbers makes of a rate is rounding.
const ROUNDINGS: f64 = 8.0;
/// So many tolerances the orders that a series leaves out may count in its second derivative, at the end of a step.
const NEXT_ORDERS: f64 = 300.0;

impl<S: Controlled> TaylorStep<S> {
    /// Whether the rates at the end of a step are not those of the polynomial that led there: a force may begin on the way that
    /// no coefficient tells of, as of a steep wall after a long free way.
    pub(super) fn leads_astray(
        &mut self,
        norm: &Norm<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<S::Mask> {
        let Self { jet: Jet { q, v, order, unit, .. }, next, rates, h, reached: t, .. } = self;
        let second_order = matches!(next.form(), Form::SecondOrder(_));
        let blocks = if second_order {
            system.acceleration(t, next.q(), next.v(), rates, ticker)?;
            &v[..]
        } else {
            system.rate(t, next.all().0, rates, ticker)?;
            &q[..]
        };
        let (highest, times) = (*order, [&*h, &*unit]);
        // Rounding leads nobody astray.
        if norm.blocks.is_empty() {
            let astray = |rates: &mut [S], rounding: Option<&[S]>| {
                let missed = Missed { rates, blocks, highest, times, second_order };
                let (blocks, tolerance, least, most) = (&q[..], &norm.rtol, ROUNDING, NEXT_ORDERS);
                S::pass(OwnMissed { missed, blocks, rounding, tolerance, least, most })
            };
            let seems = astray(rates, None);
            if !seems.any() {
                return Ok(seems);
            }
            // Of a difference of places that hardly differ from where they were, it may be all.
            let nudged = |numbers: &[S]| -> Vec<S> {
                let digit = |number: usize| {
                    S::splat(if number.is_multiple_of(2) { f64::EPSILON } else { -f64::EPSILON })
                };
                numbers.iter().enumerate().map(|(number, &x)| digit(number).multiply_add(x, x)).collect()
            };
            let mut rounding = vec![S::zero(); rates.len()];
            if second_order {
                let (q, v) = (nudged(next.q()), nudged(next.v()));
                system.acceleration(t, &q, &v, &mut rounding, ticker)?;
            } else {
                system.rate(t, &nudged(next.all().0), &mut rounding, ticker)?;
            }
            for (rounding, rate) in rounding.iter_mut().zip(rates.iter()) {
                *rounding = S::splat(ROUNDINGS) * (*rounding - *rate).abs();
            }
            return Ok(astray(rates, Some(&rounding)));
        }
        let astray = S::pass(Astray {
            missed: Missed { rates, blocks, highest, times, second_order },
            blocks: &norm.blocks,
            inverse_tolerances: &self.inverse_tolerances,
            tolerance: &norm.rtol,
            least: ROUNDING,
            most: NEXT_ORDERS,
        });
        Ok(if norm.together { S::Mask::splat(astray.any()) } else { astray })
    }
}
