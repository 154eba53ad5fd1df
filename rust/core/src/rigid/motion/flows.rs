//! The exact flows that steps of rigid bodies are made of: a drift, in which each turns freely, and a kick.
//!
//! Both change a state in place, eight systems side by side, compensated as those of points are (`ode::passes::updates`).

use super::bodies::{Arrangement, LaneBody, Symmetric};
use super::turn::{self, Inverses};
use super::vectors::{cross, dot, times_plus, turned, turned_back, turned_back_by_all};
use crate::numerics::element::{Element, PairMut, Pass, Scaled, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::passes::updates::add_compensated;
use crate::ode::state::State;
use crate::rigid::flow::moser_veselov::Order;

/// What turns freely moving bodies.
#[derive(Clone, Copy, Debug)]
pub enum Free {
    /// The exact solution.
    Exact,
    /// The discrete one of Moser and Veselov, where it can; else the exact one.
    Discrete(Order),
}

/// Room for series, and for where bodies turn too far for them.
#[derive(Debug)]
pub struct Room {
    series: Vec<Lanes>,
    far: Vec<Lanes>,
}

impl Default for Room {
    fn default() -> Self {
        Self { series: vec![Lanes::zero(); turn::ROOM], far: Vec::new() }
    }
}

/// A kick and the drift after it, of points and bodies, in one pass.
pub struct Move<'a> {
    /// Where bodies lie.
    pub arrangement: &'a Arrangement,
    /// The state.
    pub state: &'a mut State<Lanes>,
    /// Accelerations of points.
    pub a: &'a [Lanes],
    /// Torques about centers; empty for none.
    pub torque: &'a [Lanes],
    /// The kick's coefficient times the step, if there is one.
    pub kick: Option<&'a Scaled<Lanes>>,
    /// That of the drift.
    pub drift: Option<&'a Scaled<Lanes>>,
    /// Room for what it meets on the way.
    pub room: &'a mut Room,
}

/// Takes it.
pub fn take(step: Move<'_>) {
    let Move { arrangement, state, a, torque, kick, drift, room } = step;
    let Room { series, far } = room;
    far.resize(arrangement.bodies.len(), Lanes::zero());
    let (q, v) = state.halves_mut();
    let (q, v) = ((&mut *q.0, &mut *q.1), (&mut *v.0, &mut *v.1));
    if Lanes::pass(KickDrift { arrangement, q, v, a, torque, kick, drift, series, far })
        && let Some((h, _)) = drift
    {
        turn_far(arrangement, state, h, far);
    }
}

struct KickDrift<'a> {
    arrangement: &'a Arrangement,
    q: PairMut<'a, Lanes>,
    v: PairMut<'a, Lanes>,
    a: &'a [Lanes],
    torque: &'a [Lanes],
    kick: Option<&'a Scaled<Lanes>>,
    drift: Option<&'a Scaled<Lanes>>,
    series: &'a mut [Lanes],
    far: &'a mut [Lanes],
}

impl Pass<Lanes> for KickDrift<'_> {
    /// Whether some body turns too far for this; `far` is then 1 in the lanes where it does.
    type Output = bool;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> bool {
        let Arrangement { rows, bodies, free_points } = self.arrangement;
        let points = if *free_points { self.arrangement.points() } else { 0 };
        let (q, rest) = V::pair_mut(self.q);
        let (v, v_rest) = V::pair_mut(self.v);
        let (a, torque) = (V::view(self.a), V::view(self.torque));
        if let Some(kick) = self.kick {
            let kick = V::scaled(kick);
            for (body, of) in bodies.iter().enumerate() {
                let at = self.arrangement.at(body);
                let twist = twist::<V>(of, *rows, (q, a), torque, (body, at));
                for c in 0..3 {
                    let change = kick.0.multiply_add(twist[c], kick.1 * twist[c]);
                    (v[at + c], v_rest[at + c]) = add_compensated(v[at + c], v_rest[at + c], change);
                }
            }
            for at in 0..points {
                let change = kick.0.multiply_add(a[at], kick.1 * a[at]);
                (v[at], v_rest[at]) = add_compensated(v[at], v_rest[at], change);
            }
        }
        let Some(drift) = self.drift else { return false };
        let drift = V::scaled(drift);
        for at in 0..points {
            let change = drift.0.multiply_add(v[at], drift.1.multiply_add(v[at], drift.0 * v_rest[at]));
            (q[at], rest[at]) = add_compensated(q[at], rest[at], change);
        }
        let (far, series) = (V::view_mut(self.far), V::view_mut(self.series));
        let mut any_far = false;
        for (body, of) in bodies.iter().enumerate() {
            let at = self.arrangement.at(body);
            let (from, left) = (
                [q[at], q[at + 1], q[at + 2], q[at + 3]],
                [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]],
            );
            let momentum = turned_back_by_all(from, left, [v[at], v[at + 1], v[at + 2]]);
            let (turn, too_far) = turn_of::<V>(of, momentum, drift.0, series);
            let (mut to, mut left_now) = turn::oriented(from, left, turn);
            if too_far.any() {
                any_far = true;
                for c in 0..4 {
                    to[c] = V::select(too_far, from[c], to[c]);
                    left_now[c] = V::select(too_far, left[c], left_now[c]);
                }
            }
            far[body] = V::select(too_far, V::one(), V::zero());
            [q[at], q[at + 1], q[at + 2], q[at + 3]] = to;
            [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]] = left_now;
            if of.pivoted {
                place_center(of, *rows, to, (&mut *q, &mut *rest));
            }
        }
        any_far
    }
}

#[inline(always)]
fn loaded<V: View<Lanes>>(of: &[Lanes; 3]) -> [V; 3] {
    [V::load(of[0]), V::load(of[1]), V::load(of[2])]
}

/// How far a body turns freely, less the identity, and where it is too far for this.
#[inline(always)]
fn turn_of<V: View<Lanes>>(of: &LaneBody, momentum: [V; 3], h: V, series: &mut [V]) -> ([V; 4], V::Mask) {
    let LaneBody { inverse, exact, pair, symmetric, discrete, .. } = of;
    let inverse = loaded(inverse);
    let exact = Inverses {
        inverse: (loaded(&exact.inverse.0), loaded(&exact.inverse.1)),
        differences: (loaded(&exact.differences.0), loaded(&exact.differences.1)),
    };
    match (discrete, symmetric) {
        (Some(discrete), _) => {
            let (turn, found) = discrete.load::<V>().turn(&momentum, h);
            (turn, found.not())
        }
        (None, Symmetric::All) => {
            (turn::symmetric(inverse, V::load(*pair), momentum, h), V::zero().less(V::zero()))
        }
        (None, Symmetric::None) => turn::asymmetric(&exact, momentum, h, series),
        (None, Symmetric::Some(lanes)) => {
            let lanes = V::mask(*lanes);
            let (mut turn, far) = turn::asymmetric(&exact, momentum, h, series);
            let other = turn::symmetric(inverse, V::load(*pair), momentum, h);
            for c in 0..4 {
                turn[c] = V::select(lanes, other[c], turn[c]);
            }
            (turn, far.and(lanes.not()))
        }
    }
}

/// Puts the center of a held body where its orientation has it.
#[inline(always)]
fn place_center<V: View<Lanes>>(
    of: &LaneBody,
    rows: usize,
    orientation: [V; 4],
    (q, rest): (&mut [V], &mut [V]),
) {
    let LaneBody { row, center, pivot, .. } = of;
    let arm = turned(orientation, [V::load(center[0]), V::load(center[1]), V::load(center[2])]);
    for c in 0..3 {
        let at = c * rows + row;
        q[at] = V::load(pivot[c]) + arm[c];
        rest[at] = V::zero();
    }
}

/// Turns bodies by elliptic functions in the lanes in which they turn too far for a series.
#[cold]
#[inline(never)]
fn turn_far(arrangement: &Arrangement, state: &mut State<Lanes>, h: &Lanes, far: &[Lanes]) {
    let ((q, rest), (v, _)) = state.halves_mut();
    for (body, of) in arrangement.bodies.iter().enumerate() {
        let at = arrangement.at(body);
        for lane in (0..WIDTH).filter(|&lane| far[body].0[lane] > 0.0) {
            let pick = |of: &[Lanes; 3]| [0, 1, 2].map(|c| of[c].0[lane]);
            let from: [f64; 4] = core::array::from_fn(|c| q[at + c].0[lane]);
            let left: [f64; 4] = core::array::from_fn(|c| rest[at + c].0[lane]);
            let own = turned_back_by_all(from, left, [0, 1, 2].map(|c| v[at + c].0[lane]));
            let turn = turn::far(pick(&of.moments), pick(&of.inverse), own, h.0[lane]);
            let (to, left) = turn::oriented(from, left, turn);
            for c in 0..4 {
                q[at + c].0[lane] = to[c];
                rest[at + c].0[lane] = left[c];
            }
        }
    }
    hold(arrangement, state);
}

/// Puts the centers of all held bodies where their orientations have them.
pub fn hold(arrangement: &Arrangement, state: &mut State<Lanes>) {
    let (q, _) = state.halves_mut();
    Lanes::pass(Hold { arrangement, q: (&mut *q.0, &mut *q.1) });
}

struct Hold<'a> {
    arrangement: &'a Arrangement,
    q: PairMut<'a, Lanes>,
}

impl Pass<Lanes> for Hold<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let (q, rest) = V::pair_mut(self.q);
        for (body, of) in self.arrangement.bodies.iter().enumerate() {
            if of.pivoted {
                let at = self.arrangement.at(body);
                let orientation = [q[at], q[at + 1], q[at + 2], q[at + 3]];
                place_center(of, self.arrangement.rows, orientation, (&mut *q, &mut *rest));
            }
        }
    }
}

/// The torque on a body, about its center or about the point that is held; on a rod what is across it, as it does not turn
/// about its axis.
#[inline(always)]
pub(super) fn twist<V: View<Lanes>>(
    of: &LaneBody,
    rows: usize,
    (q, a): (&[V], &[V]),
    torque: &[V],
    (body, at): (usize, usize),
) -> [V; 3] {
    let mut twist = [V::zero(); 3];
    if !torque.is_empty() {
        twist = [torque[3 * body], torque[3 * body + 1], torque[3 * body + 2]];
    }
    if of.pivoted {
        let mut pull = twist;
        for c in 0..3 {
            pull[c] = V::load(of.mass) * a[c * rows + of.row];
        }
        // Not the difference of places, which has no digits where they are far from the origin.
        let arm = turned([q[at], q[at + 1], q[at + 2], q[at + 3]], loaded(&of.center));
        twist = times_plus(cross(arm, pull), V::one(), twist);
    }
    if of.rod {
        let mut axis = twist;
        for c in 0..3 {
            axis[c] = V::load(of.axis[c]);
        }
        let axis = turned([q[at], q[at + 1], q[at + 2], q[at + 3]], axis);
        twist = times_plus(axis, -dot(axis, twist), twist);
    }
    twist
}

/// Gives the centers of held bodies the velocities that their turning gives them.
pub fn settle_held(arrangement: &Arrangement, state: &mut State<Lanes>) {
    let (q, v) = state.halves_mut();
    for (body, of) in arrangement.bodies.iter().enumerate().filter(|(_, of)| of.pivoted) {
        let at = arrangement.at(body);
        let (points, momenta) = v.0.split_at_mut(arrangement.points());
        let own = 4 * body..4 * body + 3;
        let rests = &mut v.1[..arrangement.points()];
        Lanes::pass(Swing {
            of,
            rows: arrangement.rows,
            orientation: &q.0[at..at + 4],
            momentum: &momenta[own],
            v: (points, rests),
        });
    }
}

struct Swing<'a> {
    of: &'a LaneBody,
    rows: usize,
    orientation: &'a [Lanes],
    momentum: &'a [Lanes],
    v: PairMut<'a, Lanes>,
}

impl Pass<Lanes> for Swing<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let LaneBody { row, center, inverse, .. } = self.of;
        let (q, momentum) = (V::view(self.orientation), V::view(self.momentum));
        let q = [q[0], q[1], q[2], q[3]];
        let momentum = turned_back(q, [momentum[0], momentum[1], momentum[2]]);
        let mut rate = momentum;
        let mut arm = momentum;
        for c in 0..3 {
            rate[c] = V::load(inverse[c]) * momentum[c];
            arm[c] = V::load(center[c]);
        }
        let velocity = turned(q, cross(rate, arm));
        let (v, rest) = V::pair_mut(self.v);
        for c in 0..3 {
            v[c * self.rows + row] = velocity[c];
            rest[c * self.rows + row] = V::zero();
        }
    }
}
