//! Boris's method and what is composed of it: kicks and drifts, with velocities turned in the middle of every kick.
//!
//! The one idea: what a magnetic field does to velocities is a rotation, and known exactly. So it is a part of the splitting
//! beside kicks and drifts, and no force is evaluated at a velocity that is not there. Boris (1970) turns by an angle that
//! is right to second order; here it is the exact one, so that a field alone is followed exactly, and the method keeps its
//! order (Hairer & Lubich, BIT 58 (2018) 969; Zenitani & Umeda, Phys. Plasmas 25 (2018) 112110).

use super::Splitting;
use super::passes::updates::Advance;
use super::state::State;
use super::stepper::{Nodes, Stepper};
use super::system::System;
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Scaled};
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// A kick and a drift.
#[derive(Clone, Copy, Debug)]
struct Move<S> {
    /// The time of the kick after the start of the step.
    time: S,
    /// Half of the kick.
    half_kick: Scaled<S>,
    /// The time by which velocities turn in its middle; 0 where there is no kick.
    turn: f64,
    drift: Scaled<S>,
}

/// Boris's method with its step.
#[derive(Debug)]
pub struct BorisStep<S> {
    table: &'static Splitting,
    h: f64,
    moves: Vec<Move<S>>,
    nodes: Nodes,
    acceleration: Vec<S>,
}

impl<S: Element> BorisStep<S> {
    /// The method `table` with step `h`, for a system of the second order.
    pub fn new(table: &'static Splitting, h: f64, system: &dyn System<S>) -> Self {
        let nothing = (S::zero(), S::zero());
        let still = Move { time: S::zero(), half_kick: nothing, turn: 0.0, drift: nothing };
        let mut step = Self {
            table,
            h,
            moves: vec![still; table.kicks.len()],
            nodes: Nodes::new(h, system),
            acceleration: vec![S::zero(); system.form().evaluated()],
        };
        step.set(h);
        step
    }

    fn set(&mut self, h: f64) {
        let mut drifted = DoubleDouble::zero();
        let step = S::splat(h);
        for (index, (kick, into)) in self.table.kicks.iter().zip(&mut self.moves).enumerate() {
            // The last kick has no drift after it.
            let drift = self.table.drifts.get(index).copied().unwrap_or(DoubleDouble::zero());
            *into = Move {
                time: step * S::from_double_double(drifted),
                half_kick: step.scaled_by(kick.scale(0.5)),
                turn: kick.to_f64() * h,
                drift: step.scaled_by(drift),
            };
            drifted += drift;
        }
    }

    fn advance(
        &mut self,
        node: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        for Move { time, half_kick, turn, drift } in &self.moves {
            if *turn != 0.0 {
                system.kick(&self.nodes.after(node, time), state.q(), &mut self.acceleration, ticker)?;
                let (_, (v, rest)) = state.halves_mut();
                S::pass(Advance { y: (&mut *v, &mut *rest), k: &self.acceleration, step: half_kick });
                system.rotate(*turn, (&mut *v, &mut *rest));
                S::pass(Advance { y: (v, rest), k: &self.acceleration, step: half_kick });
            }
            let (q, (v, _)) = state.halves_mut();
            S::pass(Advance { y: q, k: v, step: drift });
        }
        Ok(())
    }
}

impl<S: Element> Stepper<S> for BorisStep<S> {
    fn restart(&mut self) {}

    fn step(
        &mut self,
        node: u64,
        _: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        self.advance(node, state, system, ticker)?;
        Ok(1)
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.set(past);
        let outcome = self.advance(node, state, system, ticker);
        self.set(self.h);
        outcome
    }
}
