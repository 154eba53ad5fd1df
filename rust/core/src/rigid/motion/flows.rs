//! The exact flows that steps of rigid bodies are made of: a drift, in which each turns freely, and a kick.
//!
//! Both change a state in place, eight systems side by side, compensated as those of points are (`ode::passes::updates`).

use super::bodies::{Arrangement, LaneBody, Symmetric};
use super::turn;
use super::vectors::{cross, times_plus, turned, turned_back};
use crate::numerics::element::{Element, PairMut, Pass, Scaled, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
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

/// Room for series.
#[derive(Debug)]
pub struct Room(Vec<Lanes>);

impl Default for Room {
    fn default() -> Self {
        Self(vec![Lanes::zero(); turn::ROOM])
    }
}

/// Turns all bodies, for a time of so much; centers of held bodies go with them.
pub fn turn_bodies(arrangement: &Arrangement, state: &mut State<Lanes>, h: &Lanes, room: &mut Room) {
    let (q, v) = state.halves_mut();
    for (body, of) in arrangement.bodies.iter().enumerate() {
        let at = arrangement.at(body);
        let momentum = &v.0[at..at + 3];
        let (points, turning) = q.0.split_at_mut(arrangement.points());
        let (points_rest, turning_rest) = q.1.split_at_mut(arrangement.points());
        let own = 4 * body..4 * body + 4;
        let orientation = (&mut turning[own.clone()], &mut turning_rest[own]);
        let far = Lanes::pass(TurnBody { of, momentum, orientation, h, room: &mut room.0 });
        if let Some(far) = far {
            turn_far(of, momentum, (&mut turning[4 * body..], &mut turning_rest[4 * body..]), h, &far);
        }
        if of.pivoted {
            let orientation = &turning[4 * body..4 * body + 4];
            Lanes::pass(Hold { of, rows: arrangement.rows, orientation, q: (points, points_rest) });
        }
    }
}

/// Puts the centers of all held bodies where their orientations have them.
pub fn hold(arrangement: &Arrangement, state: &mut State<Lanes>) {
    let (q, _) = state.halves_mut();
    let (points, turning) = q.0.split_at_mut(arrangement.points());
    let rest = &mut q.1[..arrangement.points()];
    for (body, of) in arrangement.bodies.iter().enumerate().filter(|(_, of)| of.pivoted) {
        let orientation = &turning[4 * body..4 * body + 4];
        Lanes::pass(Hold { of, rows: arrangement.rows, orientation, q: (&mut *points, &mut *rest) });
    }
}

struct TurnBody<'a> {
    of: &'a LaneBody,
    momentum: &'a [Lanes],
    orientation: PairMut<'a, Lanes>,
    h: &'a Lanes,
    room: &'a mut [Lanes],
}

impl Pass<Lanes> for TurnBody<'_> {
    /// 1 where the body turns too far for this, if it does in some lane.
    type Output = Option<Lanes>;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> Self::Output {
        let LaneBody { inverse, pair, symmetric, discrete, .. } = self.of;
        let (q, rest) = V::pair_mut(self.orientation);
        let momentum = V::view(self.momentum);
        let (q, rest, momentum) = (&mut q[..4], &mut rest[..4], &momentum[..3]);
        let (from, left) = ([q[0], q[1], q[2], q[3]], [rest[0], rest[1], rest[2], rest[3]]);
        let inverse = [V::load(inverse[0]), V::load(inverse[1]), V::load(inverse[2])];
        let momentum = turned_back(from, [momentum[0], momentum[1], momentum[2]]);
        let h = V::load(*self.h);
        let room = V::view_mut(self.room);
        let (turn, far) = match (discrete, symmetric) {
            (Some(discrete), _) => {
                let (turn, found) = discrete.load::<V>().turn(&momentum, h);
                (turn, found.not())
            }
            (None, Symmetric::All) => {
                (turn::symmetric(inverse, V::load(*pair), momentum, h), V::zero().less(V::zero()))
            }
            (None, Symmetric::None) => turn::asymmetric(inverse, momentum, h, room),
            (None, Symmetric::Some(lanes)) => {
                let lanes = V::mask(*lanes);
                let (mut turn, far) = turn::asymmetric(inverse, momentum, h, room);
                let other = turn::symmetric(inverse, V::load(*pair), momentum, h);
                for c in 0..4 {
                    turn[c] = V::select(lanes, other[c], turn[c]);
                }
                (turn, far.and(lanes.not()))
            }
        };
        let (to, left_now) = turn::oriented(from, left, turn);
        for c in 0..4 {
            q[c] = V::select(far, q[c], to[c]);
            rest[c] = V::select(far, rest[c], left_now[c]);
        }
        if far.any() { Some(V::select(far, V::one(), V::zero()).store()) } else { None }
    }
}

/// The lanes in which a body turns too far for a series, by elliptic functions.
#[cold]
#[inline(never)]
fn turn_far(of: &LaneBody, momentum: &[Lanes], (q, rest): PairMut<'_, Lanes>, h: &Lanes, far: &Lanes) {
    for lane in (0..WIDTH).filter(|&lane| far.0[lane] > 0.0) {
        let pick = |of: &[Lanes; 3]| [0, 1, 2].map(|c| of[c].0[lane]);
        let from: [f64; 4] = core::array::from_fn(|c| q[c].0[lane]);
        let left: [f64; 4] = core::array::from_fn(|c| rest[c].0[lane]);
        let own = turned_back(from, [0, 1, 2].map(|c| momentum[c].0[lane]));
        let turn = turn::far(pick(&of.moments), pick(&of.inverse), own, h.0[lane]);
        let (to, left) = turn::oriented(from, left, turn);
        for c in 0..4 {
            q[c].0[lane] = to[c];
            rest[c].0[lane] = left[c];
        }
    }
}

/// Puts the center of a held body where its orientation has it.
struct Hold<'a> {
    of: &'a LaneBody,
    rows: usize,
    orientation: &'a [Lanes],
    q: PairMut<'a, Lanes>,
}

impl Pass<Lanes> for Hold<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let LaneBody { row, center, pivot, .. } = self.of;
        let orientation = V::view(self.orientation);
        let orientation = [orientation[0], orientation[1], orientation[2], orientation[3]];
        let arm = turned(orientation, [V::load(center[0]), V::load(center[1]), V::load(center[2])]);
        let (q, rest) = V::pair_mut(self.q);
        for c in 0..3 {
            let at = c * self.rows + row;
            q[at] = V::load(pivot[c]) + arm[c];
            rest[at] = V::zero();
        }
    }
}

/// What a kick does to momenta: torques about centers and, of held bodies, the pull on the center about the point that is held.
pub struct Twist<'a> {
    /// Where bodies lie.
    pub arrangement: &'a Arrangement,
    /// Coordinates.
    pub q: &'a [Lanes],
    /// Velocities and momenta.
    pub v: PairMut<'a, Lanes>,
    /// Accelerations of points.
    pub a: &'a [Lanes],
    /// Torques about centers; empty for none.
    pub torque: &'a [Lanes],
    /// The coefficient times the step.
    pub kick: &'a Scaled<Lanes>,
}

impl Pass<Lanes> for Twist<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let rows = self.arrangement.rows;
        let kick = V::scaled(self.kick);
        let (a, torque, q) = (V::view(self.a), V::view(self.torque), V::view(self.q));
        let (v, rest) = V::pair_mut(self.v);
        for (body, of) in self.arrangement.bodies.iter().enumerate() {
            let at = self.arrangement.at(body);
            let twist = twist::<V>(of, rows, (q, a), torque, body);
            for c in 0..3 {
                let change = kick.0.multiply_add(twist[c], kick.1.multiply_add(twist[c], rest[at + c]));
                let sum = v[at + c] + change;
                rest[at + c] = change - (sum - v[at + c]);
                v[at + c] = sum;
            }
        }
    }
}

/// The torque on a body, about its center or about the point that is held.
#[inline(always)]
pub(super) fn twist<V: View<Lanes>>(
    of: &LaneBody,
    rows: usize,
    (q, a): (&[V], &[V]),
    torque: &[V],
    body: usize,
) -> [V; 3] {
    let mut twist = [V::zero(); 3];
    if !torque.is_empty() {
        twist = [torque[3 * body], torque[3 * body + 1], torque[3 * body + 2]];
    }
    if of.pivoted {
        let (mut arm, mut pull) = (twist, twist);
        for c in 0..3 {
            arm[c] = q[c * rows + of.row] - V::load(of.pivot[c]);
            pull[c] = V::load(of.mass) * a[c * rows + of.row];
        }
        twist = times_plus(cross(arm, pull), V::one(), twist);
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
