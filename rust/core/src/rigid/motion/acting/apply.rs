//! The pass over loads: what each adds to accelerations of centers and to torques about them, in the tier's registers.

use super::{Acting, LaneEnd, Seen};
use crate::numerics::element::{Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::rigid::motion::bodies::{Arrangement, LaneBody};
use crate::rigid::motion::vectors::{cross, dot, minus, times, times_plus, turned, turned_back};

/// All that acts, but for functions of the caller.
pub(super) struct Apply<'a, 'b> {
    pub(super) loads: &'a [Acting],
    pub(super) seen: &'a Seen<'b>,
    pub(super) a: &'a mut [Lanes],
    pub(super) torque: &'a mut [Lanes],
}

/// Coordinates, as the tier has them.
struct Sight<'a, V> {
    rows: usize,
    points: usize,
    q: &'a [V],
    v: &'a [V],
}

impl<V: Real> Sight<'_, V> {
    #[inline(always)]
    fn place(&self, row: usize) -> [V; 3] {
        [self.q[row], self.q[self.rows + row], self.q[2 * self.rows + row]]
    }
    #[inline(always)]
    fn velocity(&self, row: usize) -> [V; 3] {
        [self.v[row], self.v[self.rows + row], self.v[2 * self.rows + row]]
    }
    #[inline(always)]
    fn orientation(&self, body: usize) -> [V; 4] {
        let at = self.points + 4 * body;
        [self.q[at], self.q[at + 1], self.q[at + 2], self.q[at + 3]]
    }
    #[inline(always)]
    fn momentum(&self, body: usize) -> [V; 3] {
        let at = self.points + 4 * body;
        [self.v[at], self.v[at + 1], self.v[at + 2]]
    }
    /// In space.
    #[inline(always)]
    fn angular_velocity(&self, body: usize, inverse: &[Lanes; 3]) -> [V; 3]
    where
        V: View<Lanes>,
    {
        let q = self.orientation(body);
        let momentum = turned_back(q, self.momentum(body));
        let mut rate = momentum;
        for c in 0..3 {
            rate[c] = V::load(inverse[c]) * momentum[c];
        }
        turned(q, rate)
    }
}

/// Where an end is, how it moves, and from where on its body it pulls.
#[inline(always)]
fn end<V: View<Lanes>>(end: &LaneEnd, sight: &Sight<'_, V>, bodies: &[LaneBody], moves: bool) -> [[V; 3]; 3] {
    let nothing = [V::zero(); 3];
    match end {
        LaneEnd::Anchor(point) => [load(point), nothing, nothing],
        LaneEnd::Point(row, _) => [sight.place(*row), sight.velocity(*row), nothing],
        LaneEnd::Body(body, point) => {
            let of = &bodies[*body];
            let arm = turned(sight.orientation(*body), load::<V>(point));
            let place = sight.place(of.row);
            let at = [place[0] + arm[0], place[1] + arm[1], place[2] + arm[2]];
            if !moves {
                return [at, nothing, arm];
            }
            let turning = cross(sight.angular_velocity(*body, &of.inverse), arm);
            let velocity = sight.velocity(of.row);
            let velocity = [velocity[0] + turning[0], velocity[1] + turning[1], velocity[2] + turning[2]];
            [at, velocity, arm]
        }
    }
}

#[inline(always)]
fn load<V: View<Lanes>>(vector: &[Lanes; 3]) -> [V; 3] {
    [V::load(vector[0]), V::load(vector[1]), V::load(vector[2])]
}

/// Adds to the components of a point, or of a body's torque.
#[inline(always)]
fn add<V: Real>(into: &mut [V], stride: usize, at: usize, what: [V; 3]) {
    for c in 0..3 {
        into[c * stride + at] += what[c];
    }
}

/// Adds a force at an end.
#[inline(always)]
fn pull<V: View<Lanes>>(
    end: &LaneEnd,
    (force, arm): ([V; 3], [V; 3]),
    bodies: &[LaneBody],
    (a, rows): (&mut [V], usize),
    torque: &mut [V],
) {
    match end {
        LaneEnd::Anchor(_) => {}
        LaneEnd::Point(row, inverse) => add(a, rows, *row, times(force, V::load(*inverse))),
        LaneEnd::Body(body, _) => {
            let of = &bodies[*body];
            let mass = V::load(of.mass);
            add(a, rows, of.row, [force[0] / mass, force[1] / mass, force[2] / mass]);
            add(torque, 1, 3 * body, cross(arm, force));
        }
    }
}

impl Pass<Lanes> for Apply<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Arrangement { rows, bodies, .. } = self.seen.arrangement;
        let sight = Sight { rows: *rows, points: 3 * rows, q: V::view(self.seen.q), v: V::view(self.seen.v) };
        let (a, torque) = (V::view_mut(self.a), V::view_mut(self.torque));
        for acting in self.loads {
            match acting {
                Acting::InSpace(body, of) => add(torque, 1, 3 * body, load(of)),
                Acting::InBody(body, of) => {
                    add(torque, 1, 3 * body, turned(sight.orientation(*body), load(of)));
                }
                Acting::Drag(body, coefficient) => {
                    let spin = sight.angular_velocity(*body, &bodies[*body].inverse);
                    add(torque, 1, 3 * body, times(spin, -V::load(*coefficient)));
                }
                Acting::Spring { ends, stiffness, length, damping } => {
                    let moves = damping.is_some();
                    let one = end(&ends[0], &sight, bodies, moves);
                    let other = end(&ends[1], &sight, bodies, moves);
                    let apart = minus(one[0], other[0]);
                    let square = dot(apart, apart);
                    let (length, zero) = (V::load(*length), V::zero());
                    // Without a length it has no direction at none, and needs none.
                    let part = V::select(length.less_equal(zero), zero, length / square.sqrt());
                    let mut factor = V::load(*stiffness) * (V::one() - part);
                    if let Some(damping) = damping {
                        let rate = dot(apart, minus(one[1], other[1])) / square;
                        let rate = V::select(zero.less(square), rate, zero);
                        factor += V::load(*damping) * rate;
                    }
                    let force = times(apart, -factor);
                    pull(&ends[0], (force, one[2]), bodies, (&mut *a, *rows), torque);
                    pull(&ends[1], (times(apart, factor), other[2]), bodies, (&mut *a, *rows), torque);
                }
                Acting::Shape { body, row, pull, constant, tensor, back } => {
                    let of = &bodies[*body];
                    let q = sight.orientation(*body);
                    let apart = minus(sight.place(*row), sight.place(of.row));
                    let along = turned_back(q, apart);
                    let mut inner = along;
                    for c in 0..3 {
                        inner[c] = dot(load::<V>(&tensor[c]), along);
                    }
                    let trace = V::load(tensor[0][0]) + (V::load(tensor[1][1]) + V::load(tensor[2][2]));
                    let second = dot(along, inner);
                    let square = dot(apart, apart);
                    let fifth = V::one() / (square * square * square.sqrt());
                    let inner = turned(q, inner);
                    // Toward the body, by what is there of unit mass.
                    let three = V::splat(3.0);
                    let radial = V::splat(7.5) * (second / square) - V::splat(1.5) * trace;
                    let field = times(times_plus(apart, radial, times(inner, -three)), fifth);
                    add(a, *rows, *row, times(field, V::load(*constant)));
                    add(a, *rows, of.row, times(field, -V::load(*back)));
                    let twist = times(cross(apart, inner), three * fifth * V::load(*pull));
                    add(torque, 1, 3 * body, twist);
                }
            }
        }
    }
}
