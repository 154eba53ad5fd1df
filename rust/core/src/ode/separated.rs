//! A splitting method for Hamilton's equations whose energy is T(p) + V(q, t): kicks by −V′(q, t), drifts by T′(p).
//!
//! The one idea: either half of the rates looks at the other half of the state alone, so that the rates of a whole state
//! tell each where the other has just moved. Where T = p²/2 they are those of [`splitting`](super::splitting), which needs
//! half as many evaluations.
//! Source: E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration* (2nd ed.), § II.5 and VI.3.

use super::Splitting;
use super::passes::updates::Advance;
use super::splitting::Moves;
use super::state::State;
use super::stepper::{Nodes, Stepper, per_call};
use super::system::System;
use crate::error::Result;
use crate::numerics::element::{Element, PairMut, Scaled};
use crate::parallel::Ticker;

/// A splitting method with its step.
#[derive(Debug)]
pub struct SeparatedStep<S> {
    moves: Moves<S>,
    rates: Rates<S>,
    nodes: Nodes,
    /// What takes steps to times between nodes.
    between: Option<Moves<S>>,
}

/// The rates of a state.
#[derive(Debug)]
struct Rates<S> {
    /// Of coordinates, then of momenta.
    rates: Vec<S>,
    /// Whether those of momenta, and of coordinates, are of the present state.
    kicks_are_known: bool,
    drifts_are_known: bool,
}

/// What is moved.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Half {
    Coordinates,
    Momenta,
}

impl<S: Element> Rates<S> {
    fn forget(&mut self) {
        (self.kicks_are_known, self.drifts_are_known) = (false, false);
    }

    /// Moves one half by a part of the step, at a time after a node.
    fn advance(
        &mut self,
        (half, step): (Half, &Scaled<S>),
        (nodes, node, delay): (&Nodes, u64, &S),
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let known = if half == Half::Momenta { self.kicks_are_known } else { self.drifts_are_known };
        if !known {
            system.rate(&nodes.after(node, delay), state.all().0, &mut self.rates, ticker)?;
            (self.kicks_are_known, self.drifts_are_known) = (true, true);
        }
        let (y, rest): PairMut<'_, S> = state.all_mut();
        let n = self.rates.len() / 2;
        let ((q, p), (q_rest, p_rest)) = (y.split_at_mut(n), rest.split_at_mut(n));
        let (of_coordinates, of_momenta) = self.rates.split_at(n);
        match half {
            Half::Momenta => {
                S::pass(Advance { y: (p, p_rest), k: of_momenta, step });
                self.drifts_are_known = false;
            }
            Half::Coordinates => {
                S::pass(Advance { y: (q, q_rest), k: of_coordinates, step });
                self.kicks_are_known = false;
            }
        }
        Ok(())
    }

    fn step(
        &mut self,
        moves: &Moves<S>,
        (nodes, node): (&Nodes, u64),
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let table = moves.table;
        for (index, (kick, drift, time)) in moves.pairs.iter().enumerate() {
            if table.kicks[index].to_f64() != 0.0 {
                self.advance((Half::Momenta, kick), (nodes, node, time), state, system, ticker)?;
            }
            self.advance((Half::Coordinates, drift), (nodes, node, time), state, system, ticker)?;
        }
        if table.kicks[moves.pairs.len()].to_f64() != 0.0 {
            let last = (Half::Momenta, &moves.last_kick);
            self.advance(last, (nodes, node, &moves.h), state, system, ticker)?;
        }
        Ok(())
    }
}

impl<S: Element> SeparatedStep<S> {
    /// The method `table` with step `h`, for a system of the first order whose numbers are coordinates, then momenta.
    pub fn new(table: &'static Splitting, h: f64, system: &dyn System<S>) -> Self {
        let rates = vec![S::zero(); system.form().evaluated()];
        Self {
            moves: Moves::new(table, h),
            rates: Rates { rates, kicks_are_known: false, drifts_are_known: false },
            nodes: Nodes::new(h, system),
            between: None,
        }
    }
}

impl<S: Element> Stepper<S> for SeparatedStep<S> {
    fn restart(&mut self) {
        self.rates.forget();
    }

    fn step(
        &mut self,
        node: u64,
        at_most: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        let steps = per_call(state.q().len(), at_most);
        for step in 0..steps {
            self.rates.step(&self.moves, (&self.nodes, node + step), state, system, ticker)?;
        }
        Ok(steps)
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { moves, rates, nodes, between } = self;
        let shorter = between.get_or_insert_with(|| Moves::new(moves.table, past));
        shorter.set(past);
        rates.forget();
        let outcome = rates.step(shorter, (&*nodes, node), state, system, ticker);
        // What was looked at leaves no trace: the same state has the same rates again.
        rates.forget();
        outcome
    }
}
