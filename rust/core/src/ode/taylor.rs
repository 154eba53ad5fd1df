//! A motion by its Taylor series, step by step: as long as the last coefficients allow, of an order that suits the
//! tolerance.
//!
//! The one idea: the coefficients that make the step also say how long it may be, before it is taken, so none is refused;
//! and they are the continuous extension. Orders and steps: Jorba & Zou, Experimental Mathematics 14 (2005) 99.

use super::Taylor;
use super::norm::{Change, Norm};
use super::passes::errors::{HUGE, PairTerm};
use super::passes::series::{
    Choice, Expanded, Judged, LargestRoot, Missed, NextUnit, OwnInverse, OwnMissed, Sum, nest,
};
use super::series::Jet;
use super::state::State;
use super::step_control::{Clock, Controlled, Rule, Settled};
use super::system::{Form, System, Taken, Visited};
use super::trial::{Cost, Trial};
use crate::error::Result;
use crate::numerics::angles::cos;
use crate::numerics::element::Element;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// Of a step that does not end well, so much is tried next.
const SHRINK: f64 = 1.0 / 256.0;
/// Of a step of so many units of time the last coefficients may be too small for all their digits, and for a step that other
/// units of the scene leave as it is: the motion is expanded once more, in a unit longer by this.
const FAR: f64 = 4_294_967_296.0; // 2^32
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
/// Rates that are the same but for rounding differ by less, relative to how far they move a number.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// So many tolerances the orders that a series leaves out may count in its second derivative, at the end of a step.
const NEXT_ORDERS: f64 = 300.0;
/// The first unit of numbers that are measured by themselves, as a part of the whole time.
const FIRST_UNIT: f64 = 1.0 / 1024.0;
/// Of so many places a step is asked what it went through.
const VISITED: usize = 13;
/// How far numbers go in a step is found from the step, and that from how far they go: each time with a seventh of the error.
/// The unit of time, within a factor of four of the step, so leaves 4 % of it.
const REFINEMENTS: usize = 1;

/// Taylor series at work on one state (of one or of eight trajectories).
pub struct TaylorStep<S: Element> {
    orders: Taylor,
    jet: Jet<S>,
    /// The unit of time of the next expansion, and the shortest there is.
    unit: S,
    least: S,
    /// The shortest unit that was too long for this step.
    too_long: S,
    /// The longest step after one that led astray.
    bound: S,
    /// The step tried last.
    h: S,
    rule: Rule<S>,
    /// What the step is multiplied with, for the margin.
    margin: f64,
    /// The squared scaled size of what rates at the end of a step may miss.
    most_missed: S,
    next: State<S>,
    /// The rates at its end.
    rates: Vec<S>,
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
        Self {
            orders,
            jet,
            unit,
            least: S::zero().power_below(),
            too_long: none,
            bound: none,
            h,
            rule,
            margin: 1.0,
            most_missed: none,
            next,
            rates,
        }
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

    /// One over the step that the coefficients of two orders allow, and where they vanish.
    fn inverse_step_of(
        &self,
        pair: [usize; 2],
        state: &State<S>,
        elapsed: &S,
        norm: &Norm<S>,
    ) -> (S, S::Mask) {
        if !norm.blocks.is_empty() {
            let squares = self.sizes(pair, state, elapsed, norm);
            return S::pass(LargestRoot { squares, orders: pair });
        }
        let Jet { q, len, .. } = &self.jet;
        let (tolerance, times) = (&norm.rtol, REFINEMENTS + 1);
        S::pass(OwnInverse { blocks: q, len: *len, orders: pair, tolerance, times })
    }

    /// The squared scaled sizes of the coefficients of two orders.
    fn sizes(&self, orders: [usize; 2], state: &State<S>, elapsed: &S, norm: &Norm<S>) -> [S; 2] {
        let Jet { q, v, len, per_unit, .. } = &self.jet;
        let term = |of: usize| {
            let weight = |order| if of == order { S::one() } else { S::zero() };
            PairTerm { stage: of, weights: [weight(orders[0]), weight(orders[1])] }
        };
        let terms = [term(orders[0]), term(orders[1])];
        let change = |k, factor| Change { k, stride: *len, terms: &terms, factor };
        norm.sizes(state, state, elapsed, &[change(q, S::one()), change(v, *per_unit)])
    }

    /// One over the longest step that the coefficients allow, in their unit of time.
    fn inverse_step(&self, running: S::Mask, state: &State<S>, elapsed: &S, norm: &Norm<S>) -> S {
        let mut highest = self.jet.order;
        let (mut inverse, mut untold) = self.inverse_step_of([highest, highest - 1], state, elapsed, norm);
        // Where two coefficients vanish, those before them tell; a motion that ends with its square is exact, and where
        // numbers are measured by how far they go, one that ends with half of all coefficients.
        let last = if norm.blocks.is_empty() { self.jet.order / 2 } else { 3 };
        while highest - 2 > last {
            highest -= 2;
            if !untold.and(running).any() {
                break;
            }
            let (found, still) = self.inverse_step_of([highest, highest - 1], state, elapsed, norm);
            inverse = S::select(untold, found, inverse);
            untold = untold.and(still);
        }
        inverse
    }

    /// Whether the rates at the end of a step are not those of the polynomial that led there: a force may begin on the way that
    /// no coefficient tells of, as of a steep wall after a long free way.
    fn leads_astray(
        &mut self,
        state: &State<S>,
        elapsed: &S,
        norm: &Norm<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<S::Mask> {
        let Self { jet: Jet { q, v, len, order, unit, .. }, next, rates, h, .. } = self;
        let (len, highest, t) = (*len, *order, *elapsed + *h);
        let second_order = matches!(next.form(), Form::SecondOrder(_));
        let blocks = if second_order {
            system.acceleration(&t, next.q(), next.v(), rates, ticker)?;
            &v[..]
        } else {
            system.rate(&t, next.all().0, rates, ticker)?;
            &q[..]
        };
        let (x, moved) = S::pass(Missed { rates, blocks, highest, h, unit, second_order });
        let size2 = if norm.blocks.is_empty() {
            S::pass(OwnMissed { missed: rates, blocks: q, highest, x: &x, tolerance: &norm.rtol })
        } else {
            let terms = [PairTerm { stage: 0, weights: [S::one(), S::zero()] }];
            let change = |factor| Change { k: rates, stride: len, terms: &terms, factor };
            norm.sizes(state, next, &t, &moved.map(change))[0]
        };
        Ok(size2.less_equal(self.most_missed).not())
    }

    /// What held attempts of the step short in these lanes holds the next one no more.
    fn forget_bounds(&mut self, lanes: S::Mask) {
        let none = S::splat(f64::INFINITY);
        if lanes.all() {
            (self.too_long, self.bound) = (none, none);
        } else {
            self.too_long = S::select(lanes, none, self.too_long);
            self.bound = S::select(lanes, none, self.bound);
        }
    }

    /// The state at the time `t` after the expansion.
    fn state_at(jet: &Jet<S>, state: &State<S>, t: &S, into: &mut State<S>) {
        let Jet { q, v, order, rests, unit, .. } = jet;
        if matches!(state.form(), Form::FirstOrder(_)) {
            let (y, blocks) = (state.all(), &q[..]);
            let (highest, into) = (*order, into.all_mut());
            return S::pass(Sum { y, blocks, rest: None, highest, t, unit, velocities: false, into });
        }
        let (of_q, of_v) = into.halves_mut();
        S::pass(Sum {
            y: state.position(),
            blocks: q,
            rest: Some(&rests[1]),
            highest: order + 1,
            t,
            unit,
            velocities: false,
            into: of_q,
        });
        let (y, highest) = (state.velocity(), *order);
        S::pass(Sum { y, blocks: v, rest: None, highest, t, unit, velocities: true, into: of_v });
    }

    /// The step as who asks what it has not seen is shown it.
    fn taken<'a>(
        &'a self,
        asked: S::Mask,
        state: &'a State<S>,
        from: S,
        visited: &'a dyn Fn(usize) -> Visited,
    ) -> Taken<'a, S> {
        let ends = [state.all().0, self.next.all().0];
        Taken { asked, from, h: self.h, ends, rates: None, nodes: &[], series: true, visited: Some(visited) }
    }

    /// The states that the step goes through in a lane.
    fn visited(&self, state: &State<S>, lane: usize) -> Visited {
        let Jet { q, v, len, order, unit, .. } = &self.jet;
        let (unit, h) = (unit.lane(lane), self.h.lane(lane));
        let sum = |blocks: &[S], highest: usize, index: usize, x: f64| {
            let coefficients = (0..=highest).rev().map(|n| blocks[n * len + index].lane(lane));
            coefficients.fold(0.0, |sum, coefficient| sum * x + coefficient)
        };
        let second_order = matches!(state.form(), Form::SecondOrder(_));
        let at = |k: usize| {
            // Where polynomials of a high degree swing least.
            let place = 0.5 - 0.5 * cos(core::f64::consts::PI * k as f64 / (VISITED - 1) as f64);
            let place = if k == 0 {
                0.0
            } else if k == VISITED - 1 {
                1.0
            } else {
                place
            };
            let x = place * h / unit;
            let highest = if second_order { order + 1 } else { *order };
            let places = (0..*len).map(|index| sum(q, highest, index, x));
            let moving =
                (0..if second_order { *len } else { 0 }).map(|index| sum(v, *order, index, x) / unit);
            (place, places.chain(moving).collect())
        };
        (0..VISITED).map(at).collect()
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
        // Rounding leads nobody astray: tolerances below it are as good as that.
        let most = norm.rtol.max(S::splat(ROUNDING)) / norm.rtol * S::splat(NEXT_ORDERS);
        self.most_missed = most * most;
        self.forget_bounds(fresh);
        if norm.blocks.is_empty() {
            let unit = (span * S::splat(FIRST_UNIT)).power_below();
            self.unit = S::select(fresh, unit, self.unit);
            return Ok(());
        }
        let mut a = vec![S::zero(); self.jet.len];
        system.acceleration(&clock.elapsed, state.q(), state.v(), &mut a, ticker)?;
        let terms = [PairTerm { stage: 0, weights: [S::one(), S::zero()] }];
        let change = |k| Change { k, stride: self.jet.len, terms: &terms, factor: S::one() };
        let slope2 = norm.sizes(state, state, &clock.elapsed, &[change(state.v()), change(&a)])[0];
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
        self.jet.begin(state, clock.elapsed, self.unit);
        system.expand(&mut self.jet, ticker)?;
        let inverse = self.inverse_step(running, state, &clock.elapsed, norm);
        let choice = |bound: &S| {
            S::pass(Choice {
                inverse: &inverse,
                units: [&self.unit, &self.least],
                margin: self.margin,
                longest: [&self.rule.max_step, bound],
                times: [&clock.elapsed, &clock.end],
                h: &clock.h,
                running,
            })
        };
        let mut chosen = choice(&self.bound);
        if let Some(smooth) = system.smooth_until(&self.jet, chosen[0]) {
            let smooth = if norm.together { -(-smooth).largest_lane() } else { smooth };
            if smooth.less(chosen[0]).and(running).any() {
                chosen = choice(&self.bound.min(smooth));
            }
        }
        let [step, h, size2] = chosen;
        clock.h = h;
        self.h = S::next_step(clock, running);
        let (unit, too_long, far) = (&self.unit, &self.too_long, FAR);
        let judged = S::pass(Expanded { size2: &size2, unit, too_long, step: &step, far, running });
        let Judged { too_long, mut size2, sound, again } = judged;
        self.too_long = too_long;
        Self::state_at(&self.jet, state, &self.h, &mut self.next);
        let looked_at = sound.and(again.not()).and(running);
        if looked_at.any() {
            let mut astray = looked_at.and(self.leads_astray(state, &clock.elapsed, norm, system, ticker)?);
            if astray.any() {
                self.bound = S::select(astray, self.h.abs() * S::splat(SHORTER), self.bound);
            }
            let looked_at = looked_at.and(astray.not());
            if looked_at.any() {
                let visited = |lane: usize| self.visited(state, lane);
                let seen = system.seen_until(&self.taken(looked_at, state, clock.elapsed, &visited))?;
                if let Some(seen) = seen {
                    let unseen = seen.less(S::one());
                    self.bound = S::select(unseen, self.h.abs() * seen, self.bound);
                    astray = astray.or(unseen);
                }
            }
            if astray.any() {
                size2 = S::select(astray, S::splat(HUGE), size2);
            }
        }
        let outcome = S::settle(clock, running, size2, &self.rule);
        self.forget_bounds(outcome.accepted);
        let (unit, steps) = (&self.unit, [&step, &clock.h]);
        self.unit = S::pass(NextUnit { unit, steps, far, sound, again, running }).power_below();
        Ok(outcome)
    }

    fn next(&self) -> &State<S> {
        &self.next
    }

    fn at(
        &mut self,
        outcome: &Settled<S>,
        _: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        Self::state_at(&self.jet, state, &(theta * outcome.h), into);
        Ok(())
    }

    fn extension(&self, _: &State<S>, h: S, into: &mut Vec<S>) {
        let (len, terms) = (self.jet.len, self.terms());
        let from = into.len();
        into.resize(from + len * terms, S::zero());
        for number in 0..len {
            let mut coefficients = self.monomials(&self.jet.q, (1, terms), number, h / self.jet.unit);
            nest(&mut coefficients);
            for (term, coefficient) in coefficients.into_iter().enumerate() {
                into[from + term * len + number] = coefficient;
            }
        }
    }

    fn polynomial(&self, coordinate: usize, into: &mut Vec<[S; 2]>) {
        let (terms, unit) = (self.terms(), S::one() / self.jet.unit);
        // A coordinate moves by its velocity besides, and both are in units of the step.
        let mut of_q = self.monomials(&self.jet.q, (2, terms), coordinate, unit * unit);
        let mut of_v = self.monomials(&self.jet.v, (1, terms - 1), coordinate, unit * unit);
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
