//! A splitting method at work: kicks by the forces, drifts by the velocities.
//!
//! The kick at the end of a step and the one at the start of the next act at the same place and time, so their
//! acceleration is evaluated once and kept.

use super::Splitting;
use super::passes::updates::{Advance, KickDrift};
use super::state::State;
use super::stepper::{Nodes, Stepper, per_call};
use super::system::System;
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Scaled};
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// The kicks and drifts of a step.
#[derive(Debug)]
pub(super) struct Moves<S> {
    pub(super) table: &'static Splitting,
    /// `kick[i]`, then `drift[i]`, and the time of the kick after the start of the step.
    pub(super) pairs: Vec<(Scaled<S>, Scaled<S>, S)>,
    pub(super) last_kick: Scaled<S>,
    pub(super) h: S,
}

impl<S: Element> Moves<S> {
    pub(super) fn new(table: &'static Splitting, h: f64) -> Self {
        let nothing = (S::zero(), S::zero());
        let pairs = vec![(nothing, nothing, S::zero()); table.drifts.len()];
        let mut moves = Self { table, pairs, last_kick: nothing, h: S::zero() };
        moves.set(h);
        moves
    }

    pub(super) fn set(&mut self, h: f64) {
        let h = S::splat(h);
        let mut drifted = DoubleDouble::zero();
        let coefficients = self.table.kicks.iter().zip(self.table.drifts);
        for (pair, (&kick, &drift)) in self.pairs.iter_mut().zip(coefficients) {
            *pair = (h.scaled_by(kick), h.scaled_by(drift), h * S::from_double_double(drifted));
            drifted += drift;
        }
        self.last_kick = h.scaled_by(self.table.kicks[self.pairs.len()]);
        self.h = h;
    }
}

/// The last acceleration, and when none is needed.
#[derive(Debug)]
struct Force<S> {
    /// Whether a kick of a pair is nothing (a method that starts with a drift).
    idle: Vec<bool>,
    last_idle: bool,
    acceleration: Vec<S>,
    /// Whether `acceleration` belongs to the present coordinates and time.
    fresh: bool,
}

/// What was kept of the acceleration at a node.
#[derive(Debug)]
struct AtNode<S> {
    node: u64,
    acceleration: Vec<S>,
    fresh: bool,
}

impl<S: Element> Force<S> {
    #[inline(always)]
    fn advance(
        &mut self,
        moves: &Moves<S>,
        (nodes, node): (&Nodes, u64),
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.up_to_last_kick(moves, (nodes, node), state, system, ticker)?;
        if !self.last_idle {
            nodes.acceleration((node, &moves.h), state, &mut self.acceleration, system, ticker)?;
            self.fresh = true;
            self.last_kick(moves, state);
        }
        Ok(())
    }

    /// All of a step that moves the coordinates.
    #[inline(always)]
    fn up_to_last_kick(
        &mut self,
        moves: &Moves<S>,
        (nodes, node): (&Nodes, u64),
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        for (index, (kick, drift, time)) in moves.pairs.iter().enumerate() {
            if self.idle[index] {
                let (q, (v, _)) = state.halves_mut();
                S::pass(Advance { y: q, k: v, step: drift });
            } else {
                if !self.fresh {
                    nodes.acceleration((node, time), state, &mut self.acceleration, system, ticker)?;
                }
                let (q, v) = state.halves_mut();
                S::pass(KickDrift { q, v, a: &self.acceleration, kick, drift });
            }
            self.fresh = false;
        }
        Ok(())
    }

    /// Kicks by the acceleration that was evaluated last.
    #[inline(always)]
    fn last_kick(&self, moves: &Moves<S>, state: &mut State<S>) {
        let (_, v) = state.halves_mut();
        S::pass(Advance { y: v, k: &self.acceleration, step: &moves.last_kick });
    }
}

/// A splitting method with its step.
#[derive(Debug)]
pub struct SplittingStep<S> {
    moves: Moves<S>,
    force: Force<S>,
    nodes: Nodes,
    /// What takes steps to times between nodes, from the first of them on, and the acceleration at the present node.
    between: Option<(Moves<S>, Vec<S>)>,
    /// Of the node before the present one, for who looks back.
    before: Option<AtNode<S>>,
}

impl<S: Element> SplittingStep<S> {
    /// The method `table` with step `h`, for a system of the second order.
    pub fn new(table: &'static Splitting, h: f64, system: &dyn System<S>) -> Self {
        let zero = |kick: &DoubleDouble| kick.to_f64() == 0.0;
        let stages = table.drifts.len();
        let force = Force {
            idle: table.kicks[..stages].iter().map(zero).collect(),
            last_idle: zero(&table.kicks[stages]),
            acceleration: vec![S::zero(); system.form().evaluated()],
            fresh: false,
        };
        Self { moves: Moves::new(table, h), force, nodes: Nodes::new(h, system), between: None, before: None }
    }

    /// Takes a shorter step from a node; what is evaluated on it leaves no trace.
    #[inline(always)]
    fn aside(
        &mut self,
        node: u64,
        past: f64,
        step: impl FnOnce(&mut Force<S>, &Moves<S>, &Nodes) -> Result<()>,
    ) -> Result<()> {
        let Self { moves, force, nodes, between, before } = self;
        let (shorter, at_node) =
            between.get_or_insert_with(|| (Moves::new(moves.table, past), force.acceleration.clone()));
        shorter.set(past);
        at_node.copy_from_slice(&force.acceleration);
        let fresh = force.fresh;
        if let Some(before) = before.as_ref().filter(|before| before.node == node) {
            force.acceleration.copy_from_slice(&before.acceleration);
            force.fresh = before.fresh;
        }
        let outcome = step(force, shorter, nodes);
        core::mem::swap(&mut force.acceleration, at_node);
        force.fresh = fresh;
        outcome
    }
}

impl<S: Element> Stepper<S> for SplittingStep<S> {
    fn restart(&mut self) {
        self.force.fresh = false;
        if let Some(before) = &mut self.before {
            before.node = u64::MAX;
        }
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
        if let Some(before) = &mut self.before {
            // At the start, too, it is evaluated once for all that begins there.
            let force = &mut self.force;
            if !force.fresh && !force.idle[0] {
                let time = &self.moves.pairs[0].2;
                self.nodes.acceleration((node, time), state, &mut force.acceleration, system, ticker)?;
                force.fresh = true;
            }
            before.node = node;
            before.acceleration.copy_from_slice(&force.acceleration);
            before.fresh = force.fresh;
        }
        for step in 0..steps {
            self.force.advance(&self.moves, (&self.nodes, node + step), state, system, ticker)?;
        }
        Ok(steps)
    }

    fn steps(
        &mut self,
        node: u64,
        count: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
        each: &mut dyn FnMut(&State<S>),
    ) -> Result<()> {
        for step in 0..count {
            self.force.advance(&self.moves, (&self.nodes, node + step), state, system, ticker)?;
            each(state);
        }
        Ok(())
    }

    fn memory(&mut self, _: u64, each: &mut dyn FnMut(&mut [S])) {
        self.force.fresh = !self.force.last_idle;
        if self.force.fresh {
            each(&mut self.force.acceleration);
        }
    }

    fn look_back(&mut self) {
        let acceleration = self.force.acceleration.clone();
        self.before = Some(AtNode { node: u64::MAX, acceleration, fresh: false });
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.aside(node, past, |force, shorter, nodes| {
            force.advance(shorter, (nodes, node), state, system, ticker)
        })
    }

    fn positions_between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.aside(node, past, |force, shorter, nodes| {
            force.up_to_last_kick(shorter, (nodes, node), state, system, ticker)?;
            if !force.last_idle {
                force.last_kick(shorter, state);
            }
            Ok(())
        })
    }
}
