//! Kicks and drifts at equal steps of another time, as trials that are never refused: each lane has a time of its own.
//!
//! The one idea: both flows are known. A drift lasts the time d·ds/W, with W fixed by what does not change in it; a kick is as
//! long as k·ds/Ω, with Ω at the coordinates, which do not. So a table of kicks and drifts needs no change
//! ([`transformation`](super::transformation)).
//!
//! A time inside a step (an output, an event, the end) is met by a shadow step: to about there in the other time, and for what is
//! then left of the time a step of the same method in time itself, which is tiny.

use super::Splitting;
use super::looks::Looks;
use super::norm::Norm;
use super::passes::transformed::{Carry, Drift, Lasting, Shares};
use super::passes::updates::{Advance, Finite, Product};
use super::state::State;
use super::step_control::{Clock, Controlled, Passing, Settled};
use super::system::{System, Taken};
use super::transformation::{Monitor, Transformation};
use super::trial::{Cost, Trial};
use crate::error::{Error, Result};
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::element::Scaled;
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// Steps in the other time by which a time inside a step is met; each finds it to about the square of how far the one before it
/// was off.
const SHADOWS: u64 = 3;

/// What belongs to a state beside it.
#[derive(Clone, Debug)]
struct Beside<S> {
    /// W as kicks carry it along, and what it leaves out; or the binding energy.
    weight: (S, S),
    /// Whether the rest is that of the present coordinates.
    fresh: bool,
    omega: S,
    acceleration: Vec<S>,
    /// Of Ω, if W is carried along.
    gradient: Vec<S>,
}

impl<S: Controlled> Beside<S> {
    fn copy_from(&mut self, other: &Self) {
        (self.weight, self.fresh, self.omega) = (other.weight, other.fresh, other.omega);
        self.acceleration.copy_from_slice(&other.acceleration);
        self.gradient.copy_from_slice(&other.gradient);
    }
}

/// In which time a step is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Time {
    Transformed,
    Itself,
}

/// Coefficients of a table differ by less than this where they are meant to be the same.
const SAME: f64 = 1e-28;

/// The kicks of a table, each with the drift that follows it. What is composed of leapfrogs is composed of those that drift
/// first, which keep two bodies on their conic: seen from the middle of a kick they are not on it.
fn kicks_and_drifts(Splitting { kicks, drifts }: &Splitting) -> Vec<(DoubleDouble, DoubleDouble)> {
    let zero = DoubleDouble::zero();
    // A composition of kick-drift-kick has the means of neighboring drifts for kicks; with the two exchanged it drifts first.
    let padded: Vec<DoubleDouble> = [&[zero][..], drifts, &[zero]].concat();
    let means = padded.windows(2).map(|pair| (pair[0] + pair[1]).scale(0.5));
    let leaps = means.clone().zip(*kicks).all(|(mean, &kick)| (mean - kick).to_f64().abs() < SAME);
    if leaps {
        return [zero].iter().chain(*drifts).copied().zip(means).collect();
    }
    kicks.iter().copied().zip(drifts.iter().copied().chain([zero])).collect()
}

/// The kicks and drifts of a method, and what they watch.
#[derive(Debug)]
struct Moves {
    /// The kicks, each with the drift that follows it.
    pairs: Vec<(DoubleDouble, DoubleDouble)>,
    by: Transformation,
    /// Whether the lanes are parts of one trajectory.
    together: bool,
}

impl Moves {
    /// What a drift lasts by: W is the sum of the last two and, of the energies, the kinetic one before them.
    fn kinetic<S: Controlled>(&self, state: &State<S>, system: &mut dyn System<S>) -> Result<S> {
        Ok(match self.by {
            Transformation::PotentialEnergy => monitor(system)?.kinetic_energy(state.v()),
            Transformation::Distance => S::zero(),
        })
    }

    /// W, by which a drift lasts.
    fn weight<S: Controlled>(
        &self,
        state: &State<S>,
        beside: &Beside<S>,
        system: &mut dyn System<S>,
    ) -> Result<S> {
        let (weight, rest) = beside.weight;
        Ok(self.kinetic(state, system)? + (weight + rest))
    }

    /// What a kick needs at those coordinates.
    fn look<S: Controlled>(
        &self,
        elapsed: S,
        time: Time,
        state: &State<S>,
        beside: &mut Beside<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        system.acceleration(&elapsed, state.q(), state.v(), &mut beside.acceleration, ticker)?;
        if time == Time::Transformed {
            beside.omega = monitor(system)?.at(state.q(), &mut beside.gradient);
        }
        beside.fresh = true;
        Ok(())
    }

    fn along<S: Controlled>(&self, v: &[S], beside: &Beside<S>) -> S {
        let product = S::pass(Product { a: v, b: &beside.gradient });
        if self.together { product.sum_of_lanes() } else { product }
    }

    fn kick<S: Controlled>(
        &self,
        share: &Scaled<S>,
        time: Time,
        state: &mut State<S>,
        beside: &mut Beside<S>,
    ) {
        let carried = time == Time::Transformed && self.by == Transformation::Distance;
        let before = if carried { self.along(state.v(), beside) } else { S::zero() };
        let (_, v) = state.halves_mut();
        if time == Time::Itself {
            return S::pass(Advance { y: v, k: &beside.acceleration, step: share });
        }
        let nothing = S::zero();
        let step = S::pass(Lasting { share, over: [&beside.omega, &nothing, &nothing] });
        S::pass(Advance { y: v, k: &beside.acceleration, step: &(step, nothing) });
        if carried {
            let after = self.along(state.v(), beside);
            S::pass(Carry { step: &step, rates: [&before, &after], weight: &mut beside.weight });
        }
    }

    /// Takes a step of the length `h` from the elapsed time on; gives the time it takes.
    fn advance<S: Controlled>(
        &self,
        (h, time): (S, Time),
        elapsed: S,
        (state, beside, shares): (&mut State<S>, &mut Beside<S>, &mut Shares<S>),
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<(S, S)> {
        let mut taken = (S::zero(), S::zero());
        shares.find(&h, &self.pairs);
        for ((kick, drift), (own_kick, own_drift)) in shares.pairs.iter().zip(&self.pairs) {
            if own_kick.to_f64() != 0.0 {
                if !beside.fresh {
                    self.look(elapsed + taken.0, time, state, beside, system, ticker)?;
                }
                self.kick(kick, time, state, beside);
            }
            if own_drift.to_f64() == 0.0 {
                continue;
            }
            if time == Time::Itself {
                let (q, (v, _)) = state.halves_mut();
                S::pass(Advance { y: q, k: v, step: drift });
                taken = two_sum(taken.0, taken.1 + drift.0);
            } else {
                let kinetic = self.kinetic(state, system)?;
                let lasting = Lasting { share: drift, over: [&kinetic, &beside.weight.0, &beside.weight.1] };
                let (q, (v, _)) = state.halves_mut();
                S::pass(Drift { lasting, q, v, taken: &mut taken });
            }
            beside.fresh = false;
        }
        Ok(taken)
    }
}

fn monitor<S: Controlled>(system: &mut dyn System<S>) -> Result<&mut dyn Monitor<S>> {
    system.monitor().ok_or_else(|| Error::Internal("the system has no monitor".to_owned()))
}

/// A splitting method at equal steps of another time, on a system of the second order.
#[derive(Debug)]
pub struct Transformed<S> {
    moves: Moves,
    /// The step in time with which it starts.
    dt: S,
    /// The step in the other time.
    step: S,
    /// The shares of kicks and drifts in it, and in a part of it.
    shares: [Shares<S>; 2],
    /// Of the state, of the next one and of one in between.
    beside: Beside<S>,
    next: (State<S>, Beside<S>),
    between: (State<S>, Beside<S>),
    /// How long the last step is, also where the end comes before its own, and W at both of its ends.
    length: S,
    weights: [S; 2],
    /// Where a step looks.
    looks: Looks,
    /// The parts of the step up to which nothing lies unseen in it, if something does.
    seen: Option<S>,
    /// Evaluations of a step, and whether its first is the last of the one before it.
    evaluations: u64,
    shared: bool,
}

impl<S: Controlled> Transformed<S> {
    /// The method `table` with steps that are at first `dt` long, for lanes that go `together` or not.
    pub fn new(
        table: &Splitting,
        by: Transformation,
        dt: S,
        system: &dyn System<S>,
        state: &State<S>,
        together: bool,
    ) -> Self {
        let zeros = vec![S::zero(); system.form().evaluated()];
        let gradient = if by == Transformation::Distance { zeros.clone() } else { Vec::new() };
        let zero = S::zero();
        let beside =
            Beside { weight: (zero, zero), fresh: false, omega: zero, acceleration: zeros, gradient };
        let pairs = kicks_and_drifts(table);
        let shares = Shares::new(pairs.len());
        let acts = |(kick, _): &(DoubleDouble, DoubleDouble)| kick.to_f64() != 0.0;
        let ends = pairs.last().is_some_and(|pair| acts(pair) && pair.1.to_f64() == 0.0);
        let shared = ends && pairs.first().is_some_and(acts);
        let kicks = pairs.iter().filter(|pair| acts(pair)).count() as u64;
        Self {
            moves: Moves { pairs, by, together },
            dt,
            step: zero,
            shares: [shares.clone(), shares],
            next: (state.clone(), beside.clone()),
            between: (state.clone(), beside.clone()),
            beside,
            length: zero,
            weights: [zero; 2],
            looks: table.looks().and_ends(),
            seen: None,
            evaluations: kicks - u64::from(shared),
            shared,
        }
    }

    /// Brings `between` to the time `past` after the start of the step, which lasts `length`.
    fn meet(
        &mut self,
        past: S,
        elapsed: S,
        state: &State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { moves, step, beside, between: (into, into_beside), length, weights, .. } = self;
        let [_, shares] = &mut self.shares;
        let one = S::one();
        // The share of the step in the other time as a cubic of that in time, by the rates at both ends.
        let theta = past / *length;
        let [first, last] = weights.map(|weight| weight * *length / *step - one);
        let mut share = theta + theta * (one - theta) * (first * (one - theta) - last * theta);
        let mut left = S::zero();
        for _ in 0..SHADOWS {
            share = share.max(S::zero()).min(one);
            into.copy_from(state);
            into_beside.copy_from(beside);
            let h = (share * *step, Time::Transformed);
            let now = (&mut *into, &mut *into_beside, &mut *shares);
            let (taken, rest) = moves.advance(h, elapsed, now, system, ticker)?;
            left = (past - taken) - rest;
            share += left * moves.weight(into, into_beside, system)? / *step;
        }
        let from = elapsed + (past - left);
        let _left = moves.advance((left, Time::Itself), from, (into, into_beside, shares), system, ticker)?;
        Ok(())
    }
}

impl<S: Controlled> Trial<S> for Transformed<S> {
    fn start(
        &mut self,
        fresh: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { moves, dt, step, beside, .. } = self;
        let (omega, kinetic) = {
            let monitor = monitor(system)?;
            (monitor.at(state.q(), &mut beside.gradient), monitor.kinetic_energy(state.v()))
        };
        let weight = match moves.by {
            Transformation::PotentialEnergy => omega - kinetic,
            Transformation::Distance => omega,
        };
        beside.weight.0 = S::select(fresh, weight, beside.weight.0);
        beside.weight.1 = S::select(fresh, S::zero(), beside.weight.1);
        *step = S::select(fresh, *dt * omega, *step);
        clock.h = S::select(fresh, *dt, clock.h);
        beside.fresh = false;
        if self.shared {
            // In lanes that are on their way it is what it was.
            self.moves.look(clock.elapsed, Time::Transformed, state, &mut self.beside, system, ticker)?;
        }
        Ok(())
    }

    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>> {
        let from = clock.elapsed;
        let Self { moves, step, beside, next: (next, next_beside), .. } = self;
        next.copy_from(state);
        next_beside.copy_from(beside);
        let first = moves.weight(state, beside, system)?;
        let h = S::select(running, *step, S::zero());
        let now = (&mut *next, &mut *next_beside, &mut self.shares[0]);
        let taken = moves.advance((h, Time::Transformed), from, now, system, ticker)?;
        self.weights = [first, moves.weight(next, next_beside, system)?];
        self.length = taken.0 + taken.1;
        let before = *clock;
        let outcome = S::pass(Passing { clock, running, taken: &taken, forward: &self.dt });
        if outcome.finished.any() {
            self.meet(outcome.h, from, state, system, ticker)?;
            self.next.0.take_over(&self.between.0, outcome.finished);
        }
        // What is not finite is where steps have come to their end.
        let (y, _) = self.next.0.all();
        let mut finite = S::pass(Finite { y }).less_equal(S::zero());
        if self.moves.together {
            finite = S::Mask::splat(finite.all());
        }
        let ends = [state.all().0, self.next.0.all().0];
        let whole = Taken::from_end_to_end(outcome.accepted.and(finite), (from, outcome.h), ends);
        // Parts of the step in the other time are about as long in time.
        self.seen = system.seen_until(&Taken { looks: &self.looks, ..whole })?;
        finite = finite.and(self.passed_over().not());
        let lost = outcome.accepted.and(finite.not());
        clock.elapsed = S::select(lost, before.elapsed, clock.elapsed);
        let (accepted, finished) = (outcome.accepted.and(finite), outcome.finished.and(finite));
        Ok(Settled { accepted, finished, stuck: outcome.stuck.or(lost), ..outcome })
    }

    fn next(&self) -> &State<S> {
        &self.next.0
    }

    fn at(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.meet(theta * outcome.h, outcome.from, state, system, ticker)?;
        into.copy_from(&self.between.0);
        Ok(())
    }

    fn passed_over(&self) -> S::Mask {
        self.seen.map_or(S::Mask::splat(false), |seen| seen.less(S::one()))
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        let (next, beside) = &self.next;
        state.take_over(next, accepted);
        let weight = self.beside.weight;
        self.beside.copy_from(beside);
        // What else there is belongs to the states that were tried: lanes that are not accepted leave.
        self.beside.weight.0 = S::select(accepted, beside.weight.0, weight.0);
        self.beside.weight.1 = S::select(accepted, beside.weight.1, weight.1);
    }

    fn cost(&self) -> Cost {
        let tried = self.evaluations;
        Cost { start: u64::from(self.shared), tried, kept: 0, dense: 0, read: (SHADOWS + 1) * tried }
    }
}

#[cfg(test)]
mod tests;
