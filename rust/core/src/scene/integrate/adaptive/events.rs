//! Events of an adaptive run: looked for on each step that is about to be kept, on its continuous extension.

use super::super::events::{Interpolant, Span};
use super::{Result, Run};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::ode::step_control::Outcome;
use crate::ode::system::System;
use crate::ode::trial::Trial;
use crate::parallel::Ticker;

/// A step of all lanes; what one lane asks for is there for the others.
struct Inside<'r> {
    trial: &'r mut dyn Trial<Lanes>,
    system: &'r mut dyn System<Lanes>,
    state: &'r State<Lanes>,
    between: &'r mut State<Lanes>,
    /// The polynomials of coordinates that were asked for.
    terms: Vec<(usize, Vec<[Lanes; 2]>)>,
    outcome: &'r Outcome<Lanes>,
    ready: bool,
    /// Whether the lane at hand has looked inside.
    used: bool,
}

impl Inside<'_> {
    fn ready(&mut self, ticker: &mut Ticker<'_>) -> Result<()> {
        self.used = true;
        if !self.ready {
            self.trial.dense(self.outcome, self.system, self.state, ticker)?;
            self.ready = true;
        }
        Ok(())
    }
}

impl Interpolant for Inside<'_> {
    fn at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        self.ready(ticker)?;
        self.trial.at(self.state, self.outcome.h, Lanes::splat(theta), self.between);
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
        let known = self.terms.iter().position(|(other, _)| *other == coordinate);
        let index = known.unwrap_or_else(|| {
            let mut terms = Vec::new();
            self.trial.polynomial(coordinate, &mut terms);
            self.terms.push((coordinate, terms));
            self.terms.len() - 1
        });
        into.extend(self.terms[index].1.iter().map(|term| term.map(|sum| sum.0[lane])));
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
        outcome: &Outcome<Lanes>,
        dense: Bits,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { trial, forces, state, between, slots, clock, .. } = self;
        // The end of the step is read while its inside is asked for.
        let after = trial.next().clone();
        let mut inside = Inside {
            trial: &mut **trial,
            system: forces.system(),
            state,
            between,
            terms: Vec::new(),
            outcome,
            ready: dense.any(),
            used: false,
        };
        let mut charged = Bits(0);
        for (lane, slot) in slots.iter_mut().enumerate().take(WIDTH) {
            let Some(slot) = slot else { continue };
            let Some(watch) = slot.watch.as_mut().filter(|_| outcome.accepted.lane(lane)) else { continue };
            inside.used = false;
            let span = Span { from: outcome.from.0[lane], to: clock.elapsed.0[lane] };
            watch.look(&slot.unit, span, (&after, lane), &mut inside, ticker)?;
            if inside.used && !dense.lane(lane) {
                charged = charged.or(Bits(1 << lane));
            }
        }
        self.charge(charged);
        Ok(())
    }
}
