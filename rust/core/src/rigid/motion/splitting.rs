//! Splitting methods for rigid bodies and points together: kicks by forces and torques, drifts in which bodies turn freely.
//!
//! The one idea: the kinetic energy is a quadratic form of the momenta, of points as of bodies, and the forces depend on places
//! and orientations. So every table of `ode::methods` keeps its order, those for q'' = a(q) alone among them.
//! Sources: McLachlan, SIAM J. Sci. Comput. 16 (1995) 151; Touma & Wisdom, Astron. J. 107 (1994) 1189; Celledoni et al., SIAM
//! J. Sci. Comput. 30 (2008) 2084.

use super::acting::{Loads, Seen};
use super::bodies::Arrangement;
use super::flows::{self, Move, Room, settle_held};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Scaled;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::Splitting;
use crate::ode::state::State;
use crate::ode::stepper::{Nodes, Stepper};
use crate::ode::system::System;
use crate::parallel::Ticker;

/// Accelerations of points and torques on bodies.
pub(super) struct Pulls {
    pub(super) arrangement: Arrangement,
    pub(super) loads: Loads,
    pub(super) a: Vec<Lanes>,
    /// Empty where there are none.
    pub(super) torque: Vec<Lanes>,
    /// The time at which that of nodes begins.
    since: Lanes,
}

impl Pulls {
    pub(super) fn new(arrangement: Arrangement, loads: Loads, since: f64) -> Self {
        let torques = if loads.is_empty() { 0 } else { 3 * arrangement.bodies.len() };
        let a = vec![Lanes::zero(); arrangement.points()];
        let torque = vec![Lanes::zero(); torques];
        Self { a, torque, arrangement, loads, since: Lanes::splat(since) }
    }

    /// Evaluates them at a time.
    pub(super) fn evaluate(
        &mut self,
        time: &Lanes,
        state: &State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let (time, points) = (&(self.since + *time), self.arrangement.points());
        system.acceleration(time, &state.q()[..points], &state.v()[..points], &mut self.a, ticker)?;
        if !self.loads.is_empty() {
            self.torque.fill(Lanes::zero());
            let seen = Seen { arrangement: &self.arrangement, q: state.q(), v: state.v() };
            self.loads.apply(time, &seen, &mut self.a, &mut self.torque);
        }
        Ok(())
    }
}

/// A kick and the drift after it.
#[derive(Clone, Copy, Debug)]
struct Stage {
    /// The time of the kick after the start of the step.
    time: Lanes,
    /// `None` where it is nothing.
    kick: Option<Scaled<Lanes>>,
    drift: Option<Scaled<Lanes>>,
}

/// A splitting method with its step.
pub struct BodySplitting {
    table: &'static Splitting,
    h: f64,
    moves: Vec<Stage>,
    nodes: Nodes,
    pulls: Pulls,
    /// Whether the pulls are those at the present place and time.
    fresh: bool,
    room: Room,
}

impl BodySplitting {
    /// The method `table` with step `h`.
    pub(super) fn new(table: &'static Splitting, h: f64, pulls: Pulls) -> Self {
        let mut step = Self {
            table,
            h,
            moves: Vec::new(),
            nodes: Nodes::always(h),
            pulls,
            fresh: false,
            room: Room::default(),
        };
        step.set(h);
        step
    }

    fn set(&mut self, h: f64) {
        let mut drifted = DoubleDouble::zero();
        let step = Lanes::splat(h);
        let scaled = |by: &DoubleDouble| (by.to_f64() != 0.0).then(|| step.scaled_by(*by));
        self.moves.clear();
        for (index, kick) in self.table.kicks.iter().enumerate() {
            let drift = self.table.drifts.get(index).copied().unwrap_or(DoubleDouble::zero());
            let time = step * Lanes::from_double_double(drifted);
            self.moves.push(Stage { time, kick: scaled(kick), drift: scaled(&drift) });
            drifted += drift;
        }
    }

    fn advance(
        &mut self,
        node: u64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { moves, nodes, pulls, fresh, room, .. } = self;
        for Stage { time, kick, drift } in moves.iter() {
            if kick.is_some() && !*fresh {
                pulls.evaluate(&nodes.after(node, time), state, system, ticker)?;
            }
            let Pulls { arrangement, a, torque, .. } = &*pulls;
            let (kick, drift) = (kick.as_ref(), drift.as_ref());
            flows::take(Move { arrangement, state, a, torque, kick, drift, room });
            // The pulls of a kick at the end are those of the next step's first.
            *fresh = drift.is_none() && (*fresh || kick.is_some());
        }
        Ok(())
    }
}

impl Stepper<Lanes> for BodySplitting {
    fn restart(&mut self) {
        self.fresh = false;
    }

    fn step(
        &mut self,
        node: u64,
        _: u64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        self.advance(node, state, system, ticker)?;
        Ok(1)
    }

    fn memory(&mut self, _: u64, each: &mut dyn FnMut(&mut [Lanes])) {
        self.fresh = self.moves.last().is_some_and(|last| last.kick.is_some() && last.drift.is_none());
        if !self.fresh {
            return;
        }
        // Torques where a block has the numbers of bodies, if there are any.
        let Pulls { arrangement, a, torque, .. } = &mut self.pulls;
        let mut block = a.clone();
        block.resize(arrangement.at(arrangement.bodies.len()), Lanes::zero());
        let bodies = block.len() - a.len();
        for (to, from) in block[a.len()..].chunks_mut(4).zip(torque.chunks(3)) {
            to[..3].copy_from_slice(from);
        }
        each(&mut block);
        let (points, turning) = block.split_at(block.len() - bodies);
        a.copy_from_slice(points);
        for (from, to) in turning.chunks(4).zip(torque.chunks_mut(3)) {
            to.copy_from_slice(&from[..3]);
        }
    }

    fn settle(&mut self, state: &mut State<Lanes>) {
        settle_held(&self.pulls.arrangement, state);
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        // What is there of the present node may not be that of this one.
        self.fresh = false;
        self.set(past);
        let outcome = self.advance(node, state, system, ticker);
        self.set(self.h);
        self.fresh = false;
        settle_held(&self.pulls.arrangement, state);
        outcome
    }
}
