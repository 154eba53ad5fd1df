//! Events of an adaptive run: looked for on each step that is about to be kept, on its continuous extension.

use super::super::events::{Interpolant, Span};
use super::{Result, Run, Slot};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::ode::step_control::Settled;
use crate::ode::system::System;
use crate::ode::trial::Trial;
use crate::parallel::Ticker;

/// The polynomials of coordinates that were asked for in a step, in room that is kept from step to step.
#[derive(Default)]
pub(super) struct Polynomials {
    of: Vec<(usize, Vec<[Lanes; 2]>)>,
    known: usize,
}

impl Polynomials {
    /// Comes to another step.
    fn forget(&mut self) {
        self.known = 0;
    }

    /// That of a coordinate, made if it is not known yet.
    fn of(&mut self, coordinate: usize, make: impl FnOnce(&mut Vec<[Lanes; 2]>)) -> &[[Lanes; 2]] {
        let known = self.of[..self.known].iter().position(|(other, _)| *other == coordinate);
        let index = known.unwrap_or(self.known);
        if known.is_none() {
            if index == self.of.len() {
                self.of.push((coordinate, Vec::new()));
            }
            let (of, terms) = &mut self.of[index];
            *of = coordinate;
            terms.clear();
            make(terms);
            self.known += 1;
        }
        &self.of[index].1
    }
}

/// A step of all lanes; what one lane asks for is there for the others.
struct Inside<'r> {
    trial: &'r mut dyn Trial<Lanes>,
    system: &'r mut dyn System<Lanes>,
    state: &'r State<Lanes>,
    between: &'r mut State<Lanes>,
    polynomials: &'r mut Polynomials,
    outcome: &'r Settled<Lanes>,
    ready: bool,
    /// The fraction of the step that a state was asked for last.
    last: Option<f64>,
    /// How often one was.
    reads: u64,
}

impl Inside<'_> {
    fn ready(&mut self, ticker: &mut Ticker<'_>) -> Result<()> {
        if !self.ready {
            self.trial.dense(self.outcome, self.system, self.state, ticker)?;
            self.ready = true;
        }
        Ok(())
    }
}

impl Interpolant for Inside<'_> {
    fn at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        if self.last == Some(theta) {
            return Ok(self.between);
        }
        self.last = None;
        self.ready(ticker)?;
        self.trial.at(self.outcome, self.system, self.state, Lanes::splat(theta), self.between, ticker)?;
        (self.last, self.reads) = (Some(theta), self.reads + 1);
        Ok(self.between)
    }

    fn polynomial(
        &mut self,
        coordinate: usize,
        lane: usize,
        into: &mut Vec<[f64; 2]>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.ready(ticker)?;
        let Self { polynomials, trial, outcome, .. } = self;
        let terms = polynomials.of(coordinate, |terms| trial.polynomial(coordinate, outcome.h, terms));
        into.extend(terms.iter().map(|term| term.map(|sum| sum.0[lane])));
        Ok(())
    }
}

impl Run<'_> {
    /// Looks for the events of the units that are about to move. The continuous extension is ready if `dense` has lanes,
    /// which have paid for it.
    ///
    /// # Errors
    /// Those of the functions and of an evaluation.
    pub(super) fn watch(
        &mut self,
        outcome: &Settled<Lanes>,
        dense: Bits,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if !outcome.accepted.any() {
            return Ok(());
        }
        let Self { job, trial, forces, state, between, slots, clock, abreast, after, polynomials, .. } = self;
        let span = |lane: usize| Span { from: outcome.from.0[lane], to: clock.elapsed.0[lane] };
        let [looked_at, in_step] = match abreast {
            Some(abreast) => {
                let length = |lane| scale(span(lane).to - span(lane).from, job.plan.units.time);
                abreast.step(outcome.accepted, &Lanes(core::array::from_fn(length)), trial.next())
            }
            None => [outcome.accepted, Bits(0xff)],
        };
        let mut suspects = Bits(0);
        for (lane, slot) in slots.iter_mut().enumerate().filter(|&(lane, _)| looked_at.lane(lane)) {
            let Some(Slot { unit, watch: Some(watch), .. }) = slot else { continue };
            if !in_step.lane(lane) {
                watch.turn_to(unit, span(lane).from, state, ticker)?;
            }
            if watch.step(unit, span(lane), trial.next(), ticker)? {
                suspects = suspects.or(Bits(1 << lane));
            }
        }
        if !suspects.any() {
            return Ok(());
        }
        // The end of the step is read while its inside is asked for.
        after.copy_from(trial.next());
        polynomials.forget();
        let mut inside = Inside {
            trial: &mut **trial,
            system: forces.system(),
            state,
            between,
            polynomials,
            outcome,
            ready: dense.any(),
            last: None,
            reads: 0,
        };
        let read = self.cost.read;
        for (lane, slot) in slots.iter_mut().enumerate().filter(|&(lane, _)| suspects.lane(lane)) {
            let Some(Slot { unit, watch: Some(watch), counts, .. }) = slot else { continue };
            // Each pays for what it reads itself.
            (inside.last, inside.reads) = (None, 0);
            watch.look(unit, span(lane), (after, lane), &mut inside, ticker)?;
            counts.evaluations += read * inside.reads;
        }
        self.charge(suspects.and(dense.not()), self.cost.dense);
        Ok(())
    }
}
