//! A motion by its Taylor series, step by step: as long as the last coefficients allow, of an order that suits the
//! tolerance.
//!
//! The one idea: the coefficients that make the step also say how long it may be, before it is taken, so none is refused;
//! and they are the continuous extension. Orders and steps: Jorba & Zou, Experimental Mathematics 14 (2005) 99.

mod astray;
mod visited;

use super::Taylor;
use super::norm::{Change, Norm};
use super::passes::errors::{HUGE, PairTerm};
use super::passes::series::{Both, Nested, Numbers, Sum, Sums, nest};
use super::passes::series_errors::Vectors;
use super::passes::step_by_series::{Allowed, Choice, Chosen, FAR, Shorter, Step};
use super::series::Jet;
use super::state::State;
use super::step_control::{Clock, Controlled, Rule, Settled};
use super::system::{Form, System};
use super::trial::{Cost, Trial};
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// Of a step that does not end well, so much is tried next.
const SHRINK: f64 = 1.0 / 256.0;
/// Of the whole time, the shortest unit with which a run begins: a body that hardly moves would ask for less.
const BRIEFEST: f64 = 1.0 / (FAR * FAR * FAR * FAR);
/// A tolerance ε asks for the order `-ln(ε)/2 + 1` (Jorba & Zou); so much for the 1, as what a step costs besides its
/// coefficients makes longer ones pay: measured on Kepler's orbits and three bodies.
const FIRST_ORDER: usize = 6;
/// The last coefficients are held to this share of the tolerance: errors are then those of dop853, or less, where orbits
/// magnify them a thousand times.
const MARGIN: f64 = 0.01;
/// Looser tolerances leave the series without its convergence.
const LOOSEST: f64 = 1e-3;
/// Of a step that led astray, so much is tried next.
const SHORTER: f64 = 1.0 / 8.0;
/// The first unit of numbers that are measured by themselves, as a part of the whole time.
const FIRST_UNIT: f64 = 1.0 / 1024.0;
/// How far numbers go in a step is found from the step, and that from how far they go: each time with a seventh of the error.
/// The unit of time, within a factor of four of the step, so leaves 4 % of it.
const REFINEMENTS: usize = 1;

/// Taylor series at work on one state (of one or of eight trajectories).
pub struct TaylorStep<S: Element> {
    orders: Taylor,
    jet: Jet<S>,
    /// The unit of time of the next expansion.
    unit: S,
    /// The shortest unit that was too long for this step.
    too_long: S,
    /// The longest step after one that led astray.
    bound: S,
    /// One over the step that its coefficients allow, in their unit of time.
    inverse: S,
    /// The step tried last, as long as it was chosen, and the time at its end.
    h: S,
    chosen: S,
    reached: S,
    rule: Rule<S>,
    /// What the step is multiplied with, for the margin.
    margin: f64,
    next: State<S>,
    /// The rates at its end.
    rates: Vec<S>,
    /// One over what each vector may be off in it.
    inverse_tolerances: Vec<S>,
}

impl<S: Controlled> TaylorStep<S> {
    /// For a system and states like `state`, with steps of at most `max_step`.
    pub fn new(orders: Taylor, system: &dyn System<S>, state: &State<S>, max_step: S) -> Self {
        let len = system.form().evaluated();
        let mut rule = Rule::new(1, max_step);
        // The step is chosen before it is taken; what settles it leaves it alone.
        rule.limits = (SHRINK, 1.0);
        let jet = Jet::new(len, orders.highest);
        let none = S::splat(f64::INFINITY);
        let (unit, h, next, rates) = (S::one(), S::zero(), state.clone(), vec![S::zero(); len]);
        let (chosen, reached, inverse) = (h, h, h);
        Self {
            orders,
            jet,
            unit,
            too_long: none,
            bound: none,
            inverse,
            h,
            chosen,
            reached,
            rule,
            margin: 1.0,
            next,
            rates,
            inverse_tolerances: Vec::new(),
        }
    }

    /// Whether the equations are of the first order.
    fn first_order(&self) -> bool {
        matches!(self.next.form(), Form::FirstOrder(_))
    }

    /// The order for a tolerance.
    fn order(&self, rtol: f64) -> usize {
        // Products: the platform's logarithm is not the same everywhere.
        let (mut order, mut left) = (FIRST_ORDER, rtol);
        while left < 1.0 && order < self.orders.highest {
            (order, left) = (order + 1, left * (core::f64::consts::E * core::f64::consts::E));
        }
        order.max(self.orders.lowest)
    }

    /// Chooses the step, and finds where it leads; once more if it is to be no longer than what is told.
    fn step(
        &mut self,
        running: S::Mask,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        smooth: Option<&S>,
    ) -> Chosen<S::Mask> {
        let first_order = self.first_order();
        let Self { jet, unit, margin, rule, bound, too_long, inverse, chosen, h, reached, next, .. } = self;
        let (jet, none) = (&*jet, S::splat(f64::INFINITY));
        let longest = [smooth.unwrap_or(&none), &*bound, &rule.max_step];
        let into = [chosen, h, reached, unit];
        let choice = Choice { unit: &jet.unit, margin: *margin, longest, clock, running, too_long, into };
        let sums = Self::sums(jet, state, next);
        // Where two coefficients vanish, those before them tell; a motion that ends with half of all coefficients is exact.
        let Jet { q, v, len, order, per_unit, .. } = jet;
        if smooth.is_some() {
            return S::pass(Shorter { per_unit, inverse, choice, sums });
        }
        let (allowed, last) = if norm.blocks.is_empty() {
            let (tolerance, times) = (&norm.rtol, REFINEMENTS + 1);
            (Allowed::Numbers(Numbers { blocks: q, len: *len, tolerance, times }), order / 2)
        } else {
            let (blocks, inverse_tolerances) = (&norm.blocks[..], &self.inverse_tolerances[..]);
            // Of a system of the first order all numbers lie in one half.
            let coefficients = if first_order { [&q[..]; 2] } else { [&q[..], &v[..]] };
            let (in_units, together) = (!first_order, norm.together);
            let vectors = Vectors { blocks, inverse_tolerances, coefficients, len: *len, in_units, together };
            (Allowed::Vectors(vectors), (order / 2).max(3))
        };
        S::pass(Step { allowed, orders: (*order, last), per_unit, inverse, choice, sums })
    }

    /// The sums that lead from a state of an expansion to those after it.
    fn sums<'a>(jet: &'a Jet<S>, state: &'a State<S>, into: &'a mut State<S>) -> Both<'a, S> {
        let Jet { q, v, order, rests, .. } = jet;
        let order = *order;
        if matches!(state.form(), Form::FirstOrder(_)) {
            let all = Sum { y: state.all(), blocks: q, rest: None, highest: order, into: into.all_mut() };
            return Both(all, None);
        }
        let (of_q, of_v) = into.halves_mut();
        let (y, rest, highest) = (state.position(), Some(&rests[1][..]), order + 1);
        let places = Sum { y, blocks: q, rest, highest, into: of_q };
        Both(places, Some(Sum { y: state.velocity(), blocks: v, rest: None, highest: order, into: of_v }))
    }

    /// The state at the time `x` after the expansion.
    fn state_at(jet: &Jet<S>, state: &State<S>, x: S, into: &mut State<S>) {
        S::pass(Sums { of: Self::sums(jet, state, into), times: [&x, &jet.per_unit] });
    }

    /// The coefficients of one number of a block, of the orders from one on, in powers of the fraction of the step, times
    /// `factor`.
    fn monomials(&self, blocks: &[S], (from, to): (usize, usize), number: usize, factor: S) -> Vec<S> {
        let ratio = self.h / self.jet.unit;
        let mut power = factor;
        (from..=to)
            .map(|order| {
                let coefficient = blocks[order * self.jet.len + number] * power;
                power = power * ratio;
                coefficient
            })
            .collect()
    }
}

impl<S: Controlled> Trial<S> for TaylorStep<S> {
    /// The unit of time is that in which the state changes by its own size.
    fn start(
        &mut self,
        fresh: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let rtol = norm.rtol.first_lane();
        self.jet.order = self.order(rtol);
        let share = MARGIN * Real::min(1.0, LOOSEST / rtol);
        self.margin = share.rough_power(1.0 / self.jet.order as f64);
        let span = (clock.end - clock.elapsed).abs().min(self.rule.max_step);
        self.too_long = S::select(fresh, S::splat(f64::INFINITY), self.too_long);
        self.bound = S::select(fresh, S::splat(f64::INFINITY), self.bound);
        if norm.blocks.is_empty() {
            let unit = (span * S::splat(FIRST_UNIT)).power_below();
            self.unit = S::select(fresh, unit, self.unit);
            return Ok(());
        }
        let mut rates = vec![S::zero(); self.jet.len];
        let moving = if matches!(state.form(), Form::FirstOrder(_)) {
            system.rate(&clock.elapsed, state.all().0, &mut rates, ticker)?;
            &rates[..]
        } else {
            system.acceleration(&clock.elapsed, state.q(), state.v(), &mut rates, ticker)?;
            state.v()
        };
        let terms = [PairTerm { stage: 0, weights: [S::one(), S::zero()] }];
        let change = |k| Change { k, stride: self.jet.len, terms: &terms, factor: S::one() };
        let slope2 = norm.sizes(state, state, &clock.elapsed, &[change(moving), change(&rates)])[0];
        let time = S::one() / (norm.rtol * slope2.sqrt());
        let time = S::select(time.less(span), time, span).max(span * S::splat(BRIEFEST));
        self.unit = S::select(fresh, time.power_below(), self.unit);
        Ok(())
    }

    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>> {
        self.jet.begin(state, [&clock.elapsed, &clock.end], &self.unit);
        norm.inverse_tolerances(state, &clock.elapsed, &mut self.inverse_tolerances);
        system.expand(&mut self.jet, ticker)?;
        let mut told = self.step(running, state, clock, norm, None);
        if let Some(smooth) = system.smooth_until(&self.jet, &self.chosen) {
            let smooth = if norm.together { -(-smooth).largest_lane() } else { smooth };
            if smooth.less(self.chosen).and(running).any() {
                told = self.step(running, state, clock, norm, Some(&smooth));
            }
        }
        let Chosen { sound, again } = told;
        let taken = sound.and(again.not());
        system.settle(&mut self.next);
        let looked_at = taken.and(running);
        let astray = if looked_at.any() {
            looked_at.and(self.leads_astray(norm, system, ticker)?)
        } else {
            S::Mask::splat(false)
        };
        if astray.any() {
            self.bound = S::select(astray, self.h.abs() * S::splat(SHORTER), self.bound);
        }
        let mut good = taken.and(astray.not());
        let looked_at = looked_at.and(good);
        if looked_at.any() {
            let visited = |lane: usize| self.visited(state, lane);
            let seen = system.seen_until(&self.taken(looked_at, state, clock.elapsed, &visited))?;
            if let Some(seen) = seen {
                let unseen = seen.less(S::one());
                self.bound = S::select(unseen, self.h.abs() * seen, self.bound);
                good = good.and(unseen.not());
            }
        }
        let size2 = if good.all() { S::zero() } else { S::select(good, S::zero(), S::splat(HUGE)) };
        let outcome = S::settle(clock, running, size2, &self.rule);
        let none = S::splat(f64::INFINITY);
        if outcome.accepted.all() {
            (self.too_long, self.bound) = (none, none);
        } else {
            self.too_long = S::select(outcome.accepted, none, self.too_long);
            self.bound = S::select(outcome.accepted, none, self.bound);
        }
        if !taken.all() {
            let otherwise = S::select(sound, self.chosen, clock.h);
            let next = S::select(again, S::splat(FAR) * self.jet.unit, otherwise).power_below();
            self.unit = S::select(running, next, self.unit);
        }
        Ok(outcome)
    }

    fn next(&self) -> &State<S> {
        &self.next
    }

    fn at(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        Self::state_at(&self.jet, state, theta * outcome.h, into);
        system.settle(into);
        Ok(())
    }

    fn extension(&self, _: &State<S>, h: S, into: &mut Vec<S>) {
        let (len, terms) = (self.jet.len, self.terms());
        let from = into.len();
        into.resize(from + len * terms, S::zero());
        let into = &mut into[from..];
        S::pass(Nested { blocks: &self.jet.q, times: [&self.h, &h, &self.jet.unit], len, into });
    }

    fn polynomial(&self, coordinate: usize, _: S, into: &mut Vec<[S; 2]>) {
        let (terms, unit) = (self.terms(), S::one() / self.jet.unit);
        // A coordinate moves by its velocity besides, and both are in units of the step.
        let mut of_q = self.monomials(&self.jet.q, (2, terms), coordinate, unit * unit);
        let mut of_v = if self.first_order() {
            let velocity = coordinate + self.jet.len / 2;
            self.monomials(&self.jet.q, (1, terms - 1), velocity, unit)
        } else {
            self.monomials(&self.jet.v, (1, terms - 1), coordinate, unit * unit)
        };
        of_q.insert(0, S::zero());
        of_v.push(S::zero());
        nest(&mut of_q);
        nest(&mut of_v);
        into.extend(of_q.into_iter().zip(of_v).map(|(q, v)| [q, v]));
    }

    fn series(&self) -> Option<&Jet<S>> {
        Some(&self.jet)
    }

    fn terms(&self) -> usize {
        self.jet.order + 1
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        if accepted.all() {
            core::mem::swap(state, &mut self.next);
        } else {
            state.take_over(&self.next, accepted);
        }
    }

    fn cost(&self) -> Cost {
        // An expansion, and the look at its end with it.
        Cost { start: 1, tried: 1, kept: 0, dense: 0, read: 0 }
    }
}
