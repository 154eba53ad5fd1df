//! Neighbors in steps that each unit chooses for itself: those of its motion, unless that rests.

use super::Group;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::norm::{Block, Norm};
use crate::ode::step_control::{Clock, Settled};
use crate::ode::system::Form;
use crate::ode::trial::{Trial, trial};
use crate::parallel::Ticker;
use crate::scene::integrate::adaptive::measure;
use crate::scene::integrate::report::Ending;
use crate::scene::layout::Layout;

/// Where the output times of the lanes stand.
struct Outputs {
    times: Vec<f64>,
    next: [usize; WIDTH],
}

impl Group<'_> {
    /// Follows all to the end.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub(super) fn choosing(&mut self, ticker: &mut Ticker<'_>) -> Result<()> {
        let (job, plan) = (self.job, self.job.plan);
        let elapsed = |&t: &f64| scale(job.scene.elapsed(t), -plan.units.time);
        let mut outputs = Outputs { times: job.times.iter().map(elapsed).collect(), next: [0; WIDTH] };
        self.record_start(&mut outputs);
        let end = outputs.times.last().copied().unwrap_or(0.0);
        if end == 0.0 {
            return Ok(());
        }
        let mut norm = self.norm();
        let mut clock = Clock::new(Lanes::splat(end));
        let max_step = Lanes::splat(scale(job.max_step, -plan.units.time));
        let mut trial = trial(plan.method, &self.variation, &self.state, max_step)?;
        self.allow(&mut norm);
        trial.start(self.running, &mut self.variation, &self.state, &mut clock, &norm, ticker)?;
        while self.running.any() {
            ticker.tick()?;
            self.allow(&mut norm);
            let Self { variation, state, running, .. } = self;
            let outcome = trial.attempt(*running, variation, state, &mut clock, &norm, ticker)?;
            self.read(&mut *trial, &outcome, &mut outputs, ticker)?;
            trial.keep(outcome.accepted, &mut self.state);
            let again = self.set_back().and(self.running);
            if again.any() {
                trial.start(again, &mut self.variation, &self.state, &mut clock, &norm, ticker)?;
            }
            for lane in 0..self.units.len() {
                if !self.running.lane(lane) {
                    continue;
                }
                if outcome.finished.lane(lane) {
                    self.end(lane, Ending::Finished);
                } else if outcome.stuck.lane(lane) {
                    self.end(lane, Ending::NoStep);
                }
            }
        }
        Ok(())
    }

    /// What errors are measured by: of the motion as if it were alone; and, less closely, of the difference, which tells alone
    /// how long steps may be where a motion rests.
    fn norm(&self) -> Norm<Lanes> {
        let shape = self.units[0].state_shape(1);
        let together = self.layout == Layout::Packed;
        let mut norm =
            Norm::new(shape, Form::SecondOrder(shape.len()), Lanes::splat(self.job.rtol), together);
        for (lane, unit) in self.units.iter().enumerate() {
            measure::set(&mut norm, self.job, unit, self.layout.mask(lane));
        }
        let half = self.variation.half();
        let of_difference = |block: &Block<Lanes>| Block {
            start: half,
            atol: vec![Lanes::zero()],
            reference: [Lanes::zero(); 4],
            drift: [Lanes::zero(); 4],
            ..block.clone()
        };
        let blocks: Vec<Block<Lanes>> = norm.blocks.iter().map(of_difference).collect();
        norm.blocks.extend(blocks);
        norm
    }

    /// Allows differences a part of what they are now.
    fn allow(&self, norm: &mut Norm<Lanes>) {
        let allowed = Lanes::splat(self.accuracy) * self.length(&self.state);
        for (block, size) in norm.blocks[2..].iter_mut().zip(self.variation.measures.sizes()) {
            block.atol[0] = allowed * size;
        }
    }

    /// Takes down what is asked for at the start.
    fn record_start(&mut self, outputs: &mut Outputs) {
        let length = self.length(&self.state);
        for lane in 0..self.units.len() {
            while outputs.times.get(outputs.next[lane]) == Some(&0.0) {
                self.record(outputs.next[lane], None, &length, Bits(1 << lane));
                outputs.next[lane] += 1;
            }
        }
    }

    /// Takes down what differences are at the output times that a step has passed, one of each lane at a time.
    fn read(
        &mut self,
        trial: &mut dyn Trial<Lanes>,
        outcome: &Settled<Lanes>,
        outputs: &mut Outputs,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let mut between = None;
        loop {
            let (mut due, mut theta) = (Bits(0), Lanes::one());
            for lane in (0..self.units.len()).filter(|&lane| outcome.accepted.lane(lane)) {
                let Some(&output) = outputs.times.get(outputs.next[lane]) else { continue };
                let fraction = (output - outcome.from.0[lane]) / outcome.h.0[lane];
                if fraction <= 1.0 || outcome.finished.lane(lane) {
                    due = due.or(Bits(1 << lane));
                    let inside = Lanes::splat(fraction.min(1.0));
                    theta = Lanes::select(self.layout.mask(lane), inside, theta);
                }
            }
            if !due.any() {
                return Ok(());
            }
            if between.is_none() {
                trial.dense(outcome, &mut self.variation, &self.state, ticker)?;
            }
            let between = between.get_or_insert_with(|| self.state.clone());
            trial.at(outcome, &mut self.variation, &self.state, theta, between, ticker)?;
            let length = self.length(between);
            for lane in (0..self.units.len()).filter(|&lane| due.lane(lane)) {
                self.record(outputs.next[lane], Some(between), &length, Bits(1 << lane));
                outputs.next[lane] += 1;
            }
        }
    }
}
