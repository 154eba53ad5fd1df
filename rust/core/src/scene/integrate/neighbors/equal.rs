//! Neighbors in equal steps: all units of a group side by side.

use super::Group;
use crate::error::Result;
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::fixed::place;
use crate::ode::stepper::stepper;
use crate::parallel::Ticker;
use crate::scene::integrate::report::Ending;

/// Steps after which it is looked at whether differences are still numbers.
const STEPS: u64 = 16;

impl Group<'_> {
    /// Follows all to the end.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub(super) fn in_equal_steps(&mut self, ticker: &mut Ticker<'_>) -> Result<()> {
        let (job, plan) = (self.job, self.job.plan);
        let mut stepper = stepper(plan.method, job.step(), &self.variation, &self.state)?;
        stepper.restart();
        let dt = plan.dt.unwrap_or(plan.direction);
        let (mut node, mut first) = (0, 0);
        let mut between = self.state.clone();
        for (output, &t) in job.times.iter().enumerate() {
            let place = place(job.scene.elapsed(t), dt, Real::max(t.abs(), job.scene.t0.abs()));
            while node < place.node {
                ticker.tick()?;
                let at_most = (place.node - node).min(STEPS);
                node += stepper.step(node - first, at_most, &mut self.state, &mut self.variation, ticker)?;
                stepper.settle(&mut self.state);
                if self.set_back().any() {
                    first = node;
                    self.variation.begun = job.step() * node as f64;
                    stepper.restart();
                }
            }
            stepper.settle(&mut self.state);
            let other = if let Some(past) = place.past {
                between.copy_from(&self.state);
                let past = scale(past, -plan.units.time);
                stepper.between(node - first, past, &mut between, &mut self.variation, ticker)?;
                Some(&between)
            } else {
                None
            };
            let length = self.length(other.unwrap_or(&self.state));
            for lane in 0..self.units.len() {
                if self.running.lane(lane) && !length.0[lane].is_finite() {
                    self.end(lane, Ending::NotFinite);
                }
            }
            self.record(output, other, &length, self.running);
            if !self.running.any() {
                break;
            }
        }
        Ok(())
    }
}
