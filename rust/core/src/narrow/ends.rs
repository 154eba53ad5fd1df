//! What arguments at the ends of a step tell: that of most steps nothing is to be followed.
//!
//! The one idea: a cubic stays within the hull of its four control points, which values and slopes at the ends give; where the
//! arguments move smoothly between those by less than the reach, so they do between any two places where the method looks. What
//! falls as a power of an argument does so where that changes by no large factor.

use super::SHARE;
use super::features::{AtEnds, BELOW, BEYOND, Fades, REACH_OF_POWERS};
use crate::expressions::machine::Width;
use crate::expressions::{Code, Machine};
use crate::numerics::element::{Pass, View};
use crate::numerics::elementary::Exponential;
use crate::numerics::real::{Mask, Real};
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken};
use std::sync::Arc;

/// A step begins where the last one ended if the times are no farther apart, in steps.
const NO_TIME: f64 = 1e-9;

/// Arguments at the ends of steps, of one trajectory or of eight.
#[derive(Debug)]
pub(super) struct Ends<S> {
    form: Form,
    machine: Machine<S>,
    /// Arguments at either end of a step and how fast they move there, and those at the end of the last one that was asked of.
    before: Vec<S>,
    after: Vec<S>,
    kept: Vec<S>,
    /// The state there, and when that was.
    state: Vec<S>,
    time: S,
}

impl<S: Width + Controlled> Ends<S> {
    pub(super) fn new(form: Form, code: &Arc<Code>, parameters: &[S]) -> Self {
        let none = vec![S::zero(); code.outputs()];
        Self {
            form,
            machine: Machine::new(code.clone(), parameters),
            before: none.clone(),
            after: none.clone(),
            kept: none,
            state: vec![S::splat(f64::NAN); code.variables() / 2],
            time: S::splat(f64::NAN),
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[S]) {
        self.machine.set_parameters(parameters);
    }

    /// How fast arguments move at most, if they all do so steadily.
    pub(super) fn fastest(&mut self) -> S {
        self.machine.run(S::zero());
        let rates = self.before.len() / 2..self.before.len();
        rates.fold(S::zero(), |most, index| most.max(self.machine.output(index).abs()))
    }

    /// Where nothing is to be followed, as arguments move by less than `little` between two places that are no farther apart than
    /// `gap`, or where functions have faded: 1, and 0 elsewhere; nothing if that is all. What is not asked of leaves no trace: a lane knows what a trajectory alone does.
    pub(super) fn tell(
        &mut self,
        step: &Taken<'_, S>,
        t0: f64,
        (little, gap): (f64, f64),
        at_ends: &[AtEnds],
    ) -> Option<S> {
        let (of, time) = (step.ends[0], &self.time);
        let (known, all) = S::pass(Known { of, state: &self.state, times: [&step.from, time], h: &step.h });
        self.before.copy_from_slice(&self.kept);
        if !all {
            self.run(step, 0, step.from, t0);
            let known = S::one().less_equal(known);
            for (index, value) in self.before.iter_mut().enumerate() {
                *value = S::select(known, *value, self.machine.output(index));
            }
        }
        let end = step.from + step.h;
        self.run(step, 1, end, t0);
        for (index, value) in self.after.iter_mut().enumerate() {
            *value = self.machine.output(index);
        }
        if step.asked.all() {
            self.kept.copy_from_slice(&self.after);
            self.state.copy_from_slice(step.ends[1]);
            self.time = end;
        } else {
            let of_numbers = self.state.iter_mut().zip(step.ends[1]);
            for (kept, &new) in self.kept.iter_mut().zip(&self.after).chain(of_numbers) {
                *kept = S::select(step.asked, new, *kept);
            }
            self.time = S::select(step.asked, end, self.time);
        }
        let (told, all) =
            S::pass(Little { before: &self.before, after: &self.after, at_ends, h: &step.h, little, gap });
        (!all).then_some(told)
    }

    /// Where nothing would have been to be followed in a step as long as this, if rates were what they are at the ends of the last.
    pub(super) fn calm(&self, h: &S, (little, gap): (f64, f64), at_ends: &[AtEnds]) -> S::Mask {
        let (told, _) = S::pass(Little { before: &self.before, after: &self.after, at_ends, h, little, gap });
        S::one().less_equal(told)
    }

    /// Between what values arguments stay in a lane of the step that was told of, and whether they move little.
    pub(super) fn hulls(
        &self,
        step: &Taken<'_, S>,
        lane: usize,
        (little, gap): (f64, f64),
        at_ends: &[AtEnds],
    ) -> Vec<Hull> {
        let (h, arguments) = (step.h.lane(lane), self.before.len() / 2);
        let of = |values: &[S], index: usize| values[index].lane(lane);
        let hull = |index: usize| {
            let ends = [of(&self.before, index), of(&self.after, index)];
            let slopes = [of(&self.before, arguments + index), of(&self.after, arguments + index)];
            let (least, most, fastest) = hull(ends, slopes, h * (1.0 / 3.0));
            let moves_little = match at_ends[index] {
                AtEnds::Fades(_) => most - least <= little || fastest * gap <= little,
                AtEnds::Power(power) => grows_little((least, most), fastest * gap, factor(power)),
                AtEnds::Side { is_smooth } => stays_aside((least, most), fastest, is_smooth),
            };
            Hull { ends, least, most, moves_little }
        };
        (0..arguments).map(hull).collect()
    }

    /// Runs the code at an end of a step.
    fn run(&mut self, step: &Taken<'_, S>, end: usize, t: S, t0: f64) {
        let y = step.ends[end];
        let (numbers, rates) = self.machine.state().split_at_mut(y.len());
        numbers.copy_from_slice(y);
        let n = y.len() / 2;
        let moving = if matches!(self.form, Form::SecondOrder(_)) { n } else { 0 };
        rates[..moving].copy_from_slice(&y[y.len() - moving..]);
        if let Some(known) = &step.rates {
            let known = known[end];
            rates[moving..].copy_from_slice(&known[known.len() + moving - y.len()..]);
        } else {
            let per_time = S::one() / step.h;
            for (index, rate) in rates.iter_mut().enumerate().skip(moving) {
                *rate = (step.ends[1][index] - step.ends[0][index]) * per_time;
            }
        }
        self.machine.run(S::splat(t0) + t);
    }
}

/// What an argument does in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull {
    /// Its values at the ends.
    pub(super) ends: [f64; 2],
    /// Between these it stays.
    pub(super) least: f64,
    pub(super) most: f64,
    pub(super) moves_little: bool,
}

/// The least and the greatest of the control points of a cubic, and the most that it moves by in a step at any of its rates.
#[inline(always)]
fn hull<V: Real>([u, v]: [V; 2], [du, dv]: [V; 2], third: V) -> (V, V, V) {
    let (first, second) = (du.multiply_add(third, u), v - dv * third);
    let least = u.min(v).min(first.min(second));
    let most = u.max(v).max(first.max(second));
    let fastest = (first - u).abs().max((second - first).abs()).max((v - second).abs());
    (least, most, fastest * V::splat(3.0))
}

/// By what part of itself an argument may change of whose inverse something goes with a power.
fn factor(power: f64) -> f64 {
    Exponential::exp(SHARE * REACH_OF_POWERS / power) - 1.0
}

/// Whether an argument changes by no more than that part of itself, on either side of zero.
#[inline(always)]
fn grows_little<V: Real>((least, most): (V, V), between: V, part: V) -> V::Mask {
    let on_one_side = V::zero().less(least).or(most.less(V::zero()));
    let smaller = part * least.abs().min(most.abs());
    on_one_side.and((most - least).less_equal(smaller).or(between.less_equal(smaller)))
}

/// Whether an argument stays on one side of zero: one that is not smooth, if none of its rates leads there.
#[inline(always)]
fn stays_aside<V: Real>((least, most): (V, V), fastest: V, is_smooth: bool) -> V::Mask {
    let on_one_side = V::zero().less(least).or(most.less(V::zero()));
    // As a velocity across a plane that nothing leaves.
    let stays = most.less_equal(least);
    stays.or(if is_smooth {
        on_one_side
    } else {
        on_one_side.and(fastest.less_equal(least.abs().min(most.abs())))
    })
}

/// Where a state is that at the end of the last step.
struct Known<'a, S> {
    of: &'a [S],
    state: &'a [S],
    times: [&'a S; 2],
    h: &'a S,
}

impl<S: Controlled> Pass<S> for Known<'_, S> {
    type Output = (S, bool);
    #[inline(always)]
    fn run<V: View<S>>(self) -> (S, bool) {
        let [now, then] = [V::load(*self.times[0]), V::load(*self.times[1])];
        // The first step of a run is another's.
        let begun = V::zero().less(now.abs());
        let mut same = begun.and((now - then).abs().less_equal(V::load(*self.h).abs() * V::splat(NO_TIME)));
        for (&a, &b) in V::view(self.of).iter().zip(V::view(self.state)) {
            same = same.and((a - b).abs().less_equal(V::zero()));
        }
        (V::select(same, V::one(), V::zero()).store(), same.all())
    }
}

/// Where arguments move little, or functions of them have faded.
struct Little<'a, S> {
    before: &'a [S],
    after: &'a [S],
    at_ends: &'a [AtEnds],
    h: &'a S,
    little: f64,
    gap: f64,
}

impl<S: Controlled> Pass<S> for Little<'_, S> {
    type Output = (S, bool);
    #[inline(always)]
    fn run<V: View<S>>(self) -> (S, bool) {
        let (before, after) = (V::view(self.before), V::view(self.after));
        let third = V::load(*self.h) * V::splat(1.0 / 3.0);
        let (arguments, little, gap) = (self.at_ends.len(), V::splat(self.little), V::splat(self.gap));
        let (below, under, beyond) = (V::splat(BELOW), V::splat(-BEYOND), V::splat(BEYOND));
        let mut all = V::zero().less_equal(V::zero());
        for (index, at_ends) in self.at_ends.iter().enumerate() {
            let slopes = [before[arguments + index], after[arguments + index]];
            let (least, most, fastest) = hull([before[index], after[index]], slopes, third);
            let faded = match at_ends {
                AtEnds::Fades(Fades::Below) => most.less(below),
                AtEnds::Fades(Fades::Beyond) => most.less(under).or(beyond.less(least)),
                AtEnds::Fades(Fades::Nowhere) => most.less(least),
                AtEnds::Side { is_smooth } => {
                    all = all.and(stays_aside((least, most), fastest, *is_smooth));
                    continue;
                }
                AtEnds::Power(power) => {
                    let part = factor(*power);
                    all = all.and(grows_little((least, most), fastest * gap, V::splat(part)));
                    continue;
                }
            };
            let slow = (most - least).less_equal(little).or((fastest * gap).less_equal(little));
            all = all.and(slow.or(faded));
        }
        (V::select(all, V::one(), V::zero()).store(), all.all())
    }
}
