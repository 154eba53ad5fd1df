//! Explicit Runge–Kutta methods on the group of rotations, for torques and forces that look at velocities.
//!
//! The one idea (Munthe-Kaas, BIT 38 (1998) 92): stages are rotation vectors u, u' = dexp⁻¹(u) ω, from the orientation at the
//! node, which is then turned by exp(u): no stage leaves the rotations, and the tableau keeps its order.

use super::bodies::{Arrangement, LaneBody};
use super::flows::{hold, settle_held, twist};
use super::splitting::Pulls;
use super::turn::{inverse_differential, oriented, rotation};
use super::vectors::{times, turned, turned_back};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, PairMut, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::Tableau;
use crate::ode::state::State;
use crate::ode::stepper::{Nodes, Stepper};
use crate::ode::system::System;
use crate::parallel::Ticker;

/// A method with its step.
pub struct BodyRungeKutta {
    tableau: &'static Tableau,
    h: f64,
    nodes: Nodes,
    pulls: Pulls,
    /// Of each stage: rates of coordinates (of bodies, of rotation vectors) and of velocities and momenta.
    rates: Vec<[Vec<Lanes>; 2]>,
    /// The state of a stage.
    at: State<Lanes>,
    /// Sums of rates.
    sums: [Vec<Lanes>; 2],
}

impl BodyRungeKutta {
    /// The method `tableau` with step `h`, for states like that one.
    pub(super) fn new(tableau: &'static Tableau, h: f64, pulls: Pulls, state: &State<Lanes>) -> Self {
        let half = || vec![Lanes::zero(); state.q().len()];
        Self {
            tableau,
            h,
            nodes: Nodes::always(h),
            pulls,
            rates: tableau.b.iter().map(|_| [half(), half()]).collect(),
            at: state.clone(),
            sums: [half(), half()],
        }
    }

    fn advance(
        &mut self,
        node: u64,
        h: f64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let step = Lanes::splat(h);
        for (stage, row) in self.tableau.a.iter().enumerate() {
            let Self { pulls, rates, at, sums, .. } = self;
            at.copy_from(state);
            if stage > 0 {
                sum(row, &rates[..stage], sums);
                Lanes::pass(Apply { arrangement: &pulls.arrangement, sums, h: step, state: at });
                hold(&pulls.arrangement, at);
                settle_held(&pulls.arrangement, at);
            }
            let time = step * Lanes::from_double_double(self.tableau.c[stage]);
            let time = self.nodes.after(node, &time);
            pulls.evaluate(&time, at, system, ticker)?;
            let Pulls { arrangement, a, torque, .. } = &*pulls;
            let turned_so_far = if stage > 0 { Some(&sums[0][..]) } else { None };
            let (q, v) = (at.q(), at.v());
            let into = &mut rates[stage];
            Lanes::pass(Rates { arrangement, q, v, a, torque, turned_so_far, h: step, into });
        }
        let Self { pulls, rates, sums, .. } = self;
        sum(self.tableau.b, rates, sums);
        Lanes::pass(Apply { arrangement: &pulls.arrangement, sums, h: step, state });
        hold(&pulls.arrangement, state);
        settle_held(&pulls.arrangement, state);
        Ok(())
    }
}

/// Σ weight·rate.
fn sum(weights: &[DoubleDouble], rates: &[[Vec<Lanes>; 2]], sums: &mut [Vec<Lanes>; 2]) {
    for (half, sum) in sums.iter_mut().enumerate() {
        // Not `fill`, nor iterators zipped: they are calls, which sums of a few numbers pay for.
        for number in sum.iter_mut() {
            *number = Lanes::zero();
        }
        for (index, rate) in rates.iter().enumerate().take(weights.len()) {
            let weight = weights[index];
            if weight.to_f64() != 0.0 {
                let factor = Lanes::from_double_double(weight);
                Lanes::pass(AddTimes { into: sum, what: &rate[half], factor });
            }
        }
    }
}

struct AddTimes<'a> {
    into: &'a mut [Lanes],
    what: &'a [Lanes],
    factor: Lanes,
}

impl Pass<Lanes> for AddTimes<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let (into, what, factor) = (V::view_mut(self.into), V::view(self.what), V::load(self.factor));
        for at in 0..into.len().min(what.len()) {
            into[at] = what[at].multiply_add(factor, into[at]);
        }
    }
}

/// The rates at a stage.
struct Rates<'a> {
    arrangement: &'a Arrangement,
    q: &'a [Lanes],
    v: &'a [Lanes],
    a: &'a [Lanes],
    torque: &'a [Lanes],
    /// Rotation vectors from the node to here, before the step multiplies them.
    turned_so_far: Option<&'a [Lanes]>,
    h: Lanes,
    into: &'a mut [Vec<Lanes>; 2],
}

impl Pass<Lanes> for Rates<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Arrangement { rows, bodies, .. } = self.arrangement;
        let points = self.arrangement.points();
        let (q, v, a, torque) = (V::view(self.q), V::view(self.v), V::view(self.a), V::view(self.torque));
        let [of_q, of_v] = self.into;
        let (of_q, of_v) = (V::view_mut(of_q), V::view_mut(of_v));
        let h = V::load(self.h);
        of_q[..points].copy_from_slice(&v[..points]);
        of_v[..points].copy_from_slice(&a[..points]);
        for (body, of) in bodies.iter().enumerate() {
            let at = self.arrangement.at(body);
            let LaneBody { inverse, .. } = of;
            let to = [q[at], q[at + 1], q[at + 2], q[at + 3]];
            let momentum = turned_back(to, [v[at], v[at + 1], v[at + 2]]);
            let mut rate = momentum;
            for c in 0..3 {
                rate[c] = V::load(inverse[c]) * momentum[c];
            }
            let mut omega = turned(to, rate);
            if let Some(sums) = self.turned_so_far {
                let sums = V::view(sums);
                omega = inverse_differential(times([sums[at], sums[at + 1], sums[at + 2]], h), omega);
            }
            let twist = twist::<V>(of, *rows, (q, a), torque, (body, at));
            [of_q[at], of_q[at + 1], of_q[at + 2]] = omega;
            [of_v[at], of_v[at + 1], of_v[at + 2]] = twist;
        }
    }
}

/// Adds sums of rates to a state: bodies are turned in space.
struct Apply<'a> {
    arrangement: &'a Arrangement,
    sums: &'a [Vec<Lanes>; 2],
    h: Lanes,
    state: &'a mut State<Lanes>,
}

impl Pass<Lanes> for Apply<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [of_q, of_v] = self.sums;
        let h = V::load(self.h);
        let (q, v) = self.state.halves_mut();
        let points = self.arrangement.points();
        let all = of_v.len();
        let half = V::splat(0.5) * h;
        advance::<V>(v, of_v, h, 0..all);
        advance::<V>((&mut *q.0, &mut *q.1), of_q, h, 0..points);
        let (sums, (q, rest)) = (V::view(of_q), V::pair_mut(q));
        for body in 0..self.arrangement.bodies.len() {
            let at = self.arrangement.at(body);
            let (from, left) = (
                [q[at], q[at + 1], q[at + 2], q[at + 3]],
                [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]],
            );
            let turn = rotation(times([sums[at], sums[at + 1], sums[at + 2]], half));
            // Seen from the body, as all turns that are added to an orientation.
            let own = turned_back(from, [turn[0], turn[1], turn[2]]);
            let (to, left) = oriented(from, left, [own[0], own[1], own[2], turn[3]]);
            [q[at], q[at + 1], q[at + 2], q[at + 3]] = to;
            [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]] = left;
        }
    }
}

impl Stepper<Lanes> for BodyRungeKutta {
    fn restart(&mut self) {}

    fn step(
        &mut self,
        node: u64,
        _: u64,
        state: &mut State<Lanes>,
        system: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        self.advance(node, self.h, state, system, ticker)?;
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
        self.advance(node, past, state, system, ticker)
    }
}

#[inline(always)]
fn advance<V: View<Lanes>>(y: PairMut<'_, Lanes>, rates: &[Lanes], h: V, which: core::ops::Range<usize>) {
    let (y, rest) = V::pair_mut(y);
    let rates = V::view(rates);
    for at in which {
        let change = h.multiply_add(rates[at], rest[at]);
        let sum = y[at] + change;
        rest[at] = change - (sum - y[at]);
        y[at] = sum;
    }
}
