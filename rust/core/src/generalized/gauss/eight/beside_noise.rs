//! Steps of eight trajectories whose rates are noisy.
//!
//! The one idea: lanes in trouble are asked for their noise, and go on beside it, under a mask, as [`noise`] has it for one.

use super::super::columns::{Settled, Work, found};
use super::super::columns_end::advance;
use super::super::noise::{self, HELD_UP};
use super::GaussEight;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;

/// Finds the stages of steps from where they began, and those that noise, where it is not known, holds up again beside that;
/// where it is known then.
pub(super) fn found_beside_noise(work: &mut Work<'_>, known: Bits) -> (Settled, Bits) {
    let (mut all, running) = (found(work), work.running);
    let open = running.and(all.converged.not()).and(known.not());
    let held_up = open.and(all.change.less_equal(Lanes::splat(HELD_UP)));
    if !held_up.any() {
        return (all, known);
    }
    let Work { machine, state, columns, t, .. } = &mut *work;
    noise::of_eight(machine, (*t, false), state.all().0, held_up, &mut columns.noise);
    for (rates, guess) in columns.rates.iter_mut().zip(&columns.guess) {
        for (rates, &guess) in rates.iter_mut().zip(guess) {
            *rates = Lanes::select(held_up, guess, *rates);
        }
    }
    work.running = held_up;
    let beside = found(work);
    work.running = running;
    all.converged = all.converged.or(beside.converged);
    for lane in (0..WIDTH).filter(|&lane| held_up.lane(lane)) {
        all.evaluations[lane] += 1 + beside.evaluations[lane];
        (all.change.0[lane], all.left.0[lane]) = (beside.change.0[lane], beside.left.0[lane]);
    }
    (all, known.or(held_up))
}

impl GaussEight {
    /// Iterates the stages, beside noise where that is known or holds them up; the lanes in which it is known then.
    pub(super) fn iterated(
        &mut self,
        (t, h): (Lanes, Lanes),
        state: &State<Lanes>,
        running: Bits,
    ) -> (Settled, Bits) {
        let noisy = self.lanes(|_, pace| pace.noisy).and(running);
        self.columns.noise.fill(Lanes::zero());
        self.look_for_noise((t, false), state, noisy);
        let fading =
            Lanes(core::array::from_fn(|lane| self.paces[lane].fading(self.length.0[lane], h.0[lane])));
        let Self { table, form, velocity, machine, columns, next, .. } = self;
        let (table, form, velocity) = (*table, *form, *velocity);
        let mut work = Work { table, form, velocity, machine, state, columns, t, h, fading, running };
        let (iterated, known) = found_beside_noise(&mut work, noisy);
        advance(&work, next);
        for (lane, pace) in self.paces.iter_mut().enumerate() {
            pace.noisy |= known.and(iterated.converged).lane(lane);
        }
        (iterated, known)
    }

    /// Measures the noise of rates in these lanes, by the rounding of times as well or not.
    pub(super) fn look_for_noise(&mut self, t: (Lanes, bool), state: &State<Lanes>, lanes: Bits) {
        if !lanes.any() {
            return;
        }
        noise::of_eight(&mut self.machine, t, state.all().0, lanes, &mut self.columns.noise);
        for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
            self.taken[lane] += 1;
        }
    }

    /// The most that noise leads a step astray in a lane, as a part of a size.
    pub(super) fn most_noise(&self, lane: usize, state: &State<Lanes>, h: Lanes) -> f64 {
        let largest = state.all().0.iter().fold(0.0, |most, y| Real::max(y.0[lane].abs(), most));
        let scales = self.columns.scales.iter();
        let scale = scales.fold(0.0, |most, scale| Real::max(scale.0[lane], most));
        let length = h.0[lane];
        noise::most(largest, (self.form, length)) * self.amplified(lane, h) * length.abs() * scale
    }
}
