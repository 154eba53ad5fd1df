//! Steps of a length that nobody has given: each part of a run is stepped twice as finely until that changes nothing.
//!
//! The one idea: a part of the run is done in 2ᵏ steps and in 2ᵏ⁺¹, and the latter count where both tell the same; their own
//! error is then less by the order of the method. Each lane has a k of its own, from its own state, so none depends on its
//! neighbours: they go on beside it, and it keeps what it had. A lane that comes to no agreement has no state any more.

use super::acting::Loads;
use super::bodies::{Arrangement, LaneBody};
use super::uncontrolled;
use super::vectors::turned_back;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::Method;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::system::System;
use crate::parallel::Ticker;

/// Into so many steps at most a part is cut, as a power of two.
const FINEST: u32 = 18;
/// How far a body turns in the coarsest steps, in radians, by the spin that it has before them.
const COARSEST: f64 = 4.0;

/// A method whose steps follow a tolerance.
pub struct Controlled {
    method: &'static Method,
    /// The length of a part.
    part: f64,
    rtol: f64,
    arrangement: Arrangement,
    loads: Loads,
    /// The method with ever smaller steps, as far as they have been asked for.
    levels: Vec<Option<Box<dyn Stepper<Lanes>>>>,
    /// What came of a part in these steps, and in steps twice as long.
    found: [State<Lanes>; 2],
}

impl Controlled {
    /// The method in parts of that length, for states like that one.
    pub fn new(
        method: &'static Method,
        (part, rtol): (f64, f64),
        (arrangement, loads): (Arrangement, Loads),
        state: &State<Lanes>,
    ) -> Self {
        let found = [state.clone(), state.clone()];
        Self { method, part, rtol, arrangement, loads, levels: Vec::new(), found }
    }

    /// Takes a state at a node so far on, in 2ᵏ steps.
    fn take(
        &mut self,
        level: u32,
        (node, past): (u64, f64),
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { method, part, arrangement, loads, levels, found: [state, _], .. } = self;
        let steps = 1_u64 << level;
        let stepper = |since| {
            let assembly = (arrangement.clone(), loads.clone());
            uncontrolled(method, (past / steps as f64, since), assembly, state)
        };
        let mut shorter = None;
        let (stepper, first) = if past == *part {
            match &mut levels[level as usize] {
                Some(stepper) => (stepper, node << level),
                none => (none.insert(stepper(0.0)?), node << level),
            }
        } else {
            (shorter.insert(stepper(*part * node as f64)?), 0)
        };
        stepper.restart();
        for taken in 0..steps {
            ticker.tick()?;
            let _one = stepper.step(first + taken, 1, state, system, ticker)?;
        }
        stepper.settle(state);
        Ok(())
    }

    /// Advances a state at a node by a part or less.
    fn advance(
        &mut self,
        (node, past): (u64, f64),
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let starts: [u32; WIDTH] = core::array::from_fn(|lane| self.coarsest(state, past, lane));
        // None for lanes without a state, nor for those that even the finest steps would turn too far.
        let lanes = |which: &dyn Fn(u32) -> bool| {
            Bits((0..WIDTH).map(|lane| u8::from(which(starts[lane])) << lane).sum())
        };
        let mut done = lanes(&|start| start == u32::MAX);
        let hopeless = lanes(&|start| start == FINEST);
        let mut level = starts.iter().copied().min().unwrap_or(FINEST);
        let mut result = state.clone();
        let first = level;
        while !done.or(hopeless).all() && level <= FINEST {
            while self.levels.len() <= level as usize {
                self.levels.push(None);
            }
            self.found.swap(0, 1);
            self.found[0].copy_from(state);
            self.take(level, (node, past), system, ticker)?;
            if level > first {
                let agree = (0..WIDTH).filter(|&lane| level > starts[lane] && self.agrees(state, past, lane));
                let now = Bits(agree.map(|lane| 1_u8 << lane).sum::<u8>()).and(done.not());
                result.take_over(&self.found[0], now);
                done = done.or(now);
            }
            level += 1;
        }
        // What came to nothing is no number, so that the run of this lane ends here.
        for lane in (0..WIDTH).filter(|&lane| !done.lane(lane)) {
            let ((q, _), (v, _)) = result.halves_mut();
            q.iter_mut().chain(v).for_each(|number| number.0[lane] = f64::NAN);
        }
        state.copy_from(&result);
        Ok(())
    }

    /// The steps with which a lane begins; none if it has no state.
    fn coarsest(&self, state: &State<Lanes>, past: f64, lane: usize) -> u32 {
        if !is_finite(state, lane) {
            return u32::MAX;
        }
        let turn = self.turn(state, past, lane);
        ((turn / COARSEST).log2().ceil().max(0.0) as u32).min(FINEST)
    }

    /// How far the bodies of a lane turn in a time by their spins, at most.
    fn turn(&self, state: &State<Lanes>, past: f64, lane: usize) -> f64 {
        let of = |(body, of): (usize, &LaneBody)| {
            let at = self.arrangement.at(body);
            let q = core::array::from_fn(|c| state.q()[at + c].0[lane]);
            let momentum = turned_back(q, [0, 1, 2].map(|c| state.v()[at + c].0[lane]));
            length([0, 1, 2].map(|c| of.inverse[c].0[lane] * momentum[c] * past))
        };
        self.arrangement.bodies.iter().enumerate().map(of).fold(0.0, Real::max)
    }

    /// Whether steps of both lengths tell the same of a lane, to the tolerance or to what rounding leaves.
    fn agrees(&self, before: &State<Lanes>, past: f64, lane: usize) -> bool {
        let [fine, coarse] = &self.found;
        let Arrangement { rows, bodies, .. } = &self.arrangement;
        let rounding = 8.0 * f64::EPSILON * (1.0 + self.turn(fine, past, lane));
        let tolerance = Real::max(self.rtol, rounding);
        if [fine, coarse].iter().any(|state| !is_finite(state, lane)) {
            return false;
        }
        let turned = bodies.iter().enumerate().all(|(body, of)| {
            let at = self.arrangement.at(body);
            let four =
                |state: &State<Lanes>| -> [f64; 4] { core::array::from_fn(|c| state.q()[at + c].0[lane]) };
            let momentum = |state: &State<Lanes>| [0, 1, 2].map(|c| state.v()[at + c].0[lane]);
            let apart = four(fine).iter().zip(four(coarse)).map(|(a, b)| (a - b).abs()).fold(0.0, Real::max);
            // A momentum that turns the body by a radian in this time is none to be small against.
            let moment = of.moments.iter().map(|moment| moment.0[lane]).fold(0.0, Real::max);
            let size = length(momentum(before)).max(length(momentum(fine))).max(moment / past.abs());
            apart <= tolerance && distance(momentum(fine), momentum(coarse)) <= tolerance * size
        });
        turned
            && (0..*rows).all(|row| {
                let rigid = bodies.iter().find(|of| of.row == row);
                if rigid.is_some_and(|of| of.pivoted) {
                    return true;
                }
                let point = |half: &[Lanes]| [0, 1, 2].map(|c| half[c * rows + row].0[lane]);
                let (x, v) = (point(fine.q()), point(fine.v()));
                // How large the body is, as far as its moments tell.
                let own = rigid.map_or(0.0, |of| {
                    let moment = of.moments.iter().map(|moment| moment.0[lane]).fold(0.0, Real::max);
                    (moment / of.mass.0[lane]).sqrt()
                });
                let way = length(v).max(length(point(before.v()))) * past.abs();
                let size = length(x).max(length(point(before.q()))).max(own).max(way);
                let tolerance = tolerance.max(8.0 * f64::EPSILON * (1.0 + way / size));
                distance(x, point(coarse.q())) <= tolerance * size
                    && distance(v, point(coarse.v())) * past.abs() <= tolerance * size
            })
    }
}

fn is_finite(state: &State<Lanes>, lane: usize) -> bool {
    state.q().iter().chain(state.v()).all(|number| number.0[lane].is_finite())
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    x.abs().max(y.abs()).max(z.abs())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

impl Stepper<Lanes> for Controlled {
    fn restart(&mut self) {}

    fn step(
        &mut self,
        node: u64,
        _: u64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        self.advance((node, self.part), state, system, ticker)?;
        Ok(1)
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.advance((node, past), state, system, ticker)
    }
}
