//! Loads over lanes: the forces and torques that they give to up to eight systems side by side.
//!
//! The one idea: a load adds to the accelerations of centers and to the torques about them, whatever holds a body; what a
//! held point makes of both is the step's business (`splitting`, `runge_kutta`).
//! Source of the pull on a body that is no sphere: MacCullagh's formula (Goldstein, *Classical Mechanics*, 5.8):
//! V = −G m M/r − G m/(2 r³) (tr I − 3 n·I n), for each body with each mass beside it.

use super::bodies::{Arrangement, LaneBody, RigidBodies, Start};
use super::loads::{End, Load, TorqueFunction};
use super::vectors::{cross, dot, minus, times, times_plus, turned, turned_back};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::rigid::quaternion::{IDENTITY, conjugate, rotated};
use crate::units::Units;

/// An end of a spring.
#[derive(Clone, Copy, Debug)]
enum LaneEnd {
    /// A point of a body, along its principal axes.
    Body(usize, [Lanes; 3]),
    /// A point with the row, and the inverse of its mass.
    Point(usize, Lanes),
    Anchor([Lanes; 3]),
}

/// A load.
#[derive(Clone)]
enum Acting {
    /// A torque in space.
    InSpace(usize, [Lanes; 3]),
    /// A torque along principal axes.
    InBody(usize, [Lanes; 3]),
    Drag(usize, Lanes),
    Spring {
        ends: [LaneEnd; 2],
        stiffness: Lanes,
        length: Lanes,
        damping: Option<Lanes>,
    },
    /// Of a body and a row: G m of what is there, G, and the tensor about the center.
    Shape {
        body: usize,
        row: usize,
        pull: Lanes,
        constant: Lanes,
        tensor: [[Lanes; 3]; 3],
        /// G over the body's mass, times the mass that is there.
        back: Lanes,
    },
}

/// All loads on some systems.
#[derive(Default)]
pub struct Loads {
    acting: Vec<Acting>,
    functions: Vec<Function>,
}

/// A torque that the caller computes of a body, in each of so many lanes.
struct Function {
    body: usize,
    lanes: usize,
    function: TorqueFunction,
    units: Units,
    /// What takes the orientation of principal axes to the caller's, lane by lane.
    axes: [[f64; 4]; WIDTH],
    t0: f64,
}

/// What loads look at.
pub struct Seen<'a> {
    /// Where the bodies lie.
    pub arrangement: &'a Arrangement,
    /// Coordinates: points, then quaternions.
    pub q: &'a [Lanes],
    /// Velocities of the points, then momenta.
    pub v: &'a [Lanes],
}

/// The systems of one row of lanes, for loads to be made of.
pub struct Systems<'a> {
    /// The rigid bodies of the batch.
    pub bodies: &'a RigidBodies,
    /// The rigid bodies of each system, at the start.
    pub starts: &'a [Vec<Start>],
    /// The masses of all bodies of each system, in the integration's units.
    pub mass: Vec<&'a [f64]>,
    /// Which bodies of the scene they are.
    pub members: &'a [usize],
    /// Bodies of the scene.
    pub particles: usize,
    /// The row of the first.
    pub row: usize,
    /// The number of the first rigid body.
    pub first: usize,
    /// The constant of gravity, 0 without.
    pub constant: f64,
    /// The units of the integration.
    pub units: Units,
    /// The time at which the run begins.
    pub t0: f64,
}

impl Loads {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.acting.is_empty() && self.functions.is_empty()
    }

    /// Adds those on the systems of one row of lanes.
    pub fn add(&mut self, systems: &Systems<'_>, lanes: &[LaneBody]) {
        let Systems { bodies, starts, members, particles, units, .. } = *systems;
        let rigid = particles - bodies.count;
        // Numbers of the scene's rigid bodies that these systems have, in their order.
        let own: Vec<usize> =
            members.iter().filter(|&&member| member >= rigid).map(|&member| member - rigid).collect();
        let unit = |dimension| move |value: f64| units.take(value, dimension);
        for load in &bodies.loads {
            for (place, &number) in own.iter().enumerate() {
                if !load.acts_on(number) {
                    continue;
                }
                let body = systems.first + place;
                let principal = |v: [f64; 3]| vector(starts, |of| along(bodies, &of[place], v));
                match load {
                    Load::Torque { torque, in_body, .. } => {
                        let torque = torque.map(unit([2, 1, -2]));
                        self.acting.push(if *in_body {
                            Acting::InBody(body, principal(torque))
                        } else {
                            Acting::InSpace(body, torque.map(Lanes::splat))
                        });
                    }
                    Load::Drag { coefficient, .. } => {
                        let coefficient = units.take(*coefficient, [2, 1, -1]);
                        self.acting.push(Acting::Drag(body, Lanes::splat(coefficient)));
                    }
                    Load::Function { function, .. } => self.functions.push(Function {
                        body,
                        lanes: starts.len(),
                        function: TorqueFunction::clone(function),
                        units,
                        axes: core::array::from_fn(|lane| {
                            let start = &starts[lane.min(starts.len() - 1)][place];
                            conjugate(bodies.axes[start.at])
                        }),
                        t0: systems.t0,
                    }),
                    Load::Spring { ends, stiffness, length, damping } => {
                        // Once, by its first end that is a body of these.
                        let first = ends.iter().find_map(|end| match end {
                            End::Body(body, _) => Some(*body),
                            _ => None,
                        });
                        if first != Some(number) {
                            continue;
                        }
                        let ends = ends.map(|end| match end {
                            End::Body(number, point) => {
                                let place = own.iter().position(|&own| own == number).unwrap_or(0);
                                let point = point.map(unit([1, 0, 0]));
                                let point = vector(starts, |of| along(bodies, &of[place], point));
                                LaneEnd::Body(systems.first + place, point)
                            }
                            End::Particle(index) => {
                                let slot = members.iter().position(|&member| member == index).unwrap_or(0);
                                let inverse = lane_by_lane(systems.mass.len(), |system| {
                                    1.0 / systems.mass[system][slot]
                                });
                                LaneEnd::Point(systems.row + slot, inverse)
                            }
                            End::Anchor(point) => {
                                LaneEnd::Anchor(point.map(|x| Lanes::splat(units.take(x, [1, 0, 0]))))
                            }
                        });
                        self.acting.push(Acting::Spring {
                            ends,
                            stiffness: Lanes::splat(units.take(*stiffness, [0, 1, -2])),
                            length: Lanes::splat(units.take(*length, [1, 0, 0])),
                            damping: (*damping != 0.0)
                                .then(|| Lanes::splat(units.take(*damping, [0, 1, -1]))),
                        });
                    }
                }
            }
        }
        if systems.constant == 0.0 {
            return;
        }
        for (place, &number) in own.iter().enumerate() {
            if starts.iter().all(|of| is_sphere(bodies, of[place].at)) {
                continue;
            }
            let tensor = tensor(bodies, starts, place, units);
            for (slot, &member) in members.iter().enumerate() {
                if member == rigid + number {
                    continue;
                }
                let constant = units.take(systems.constant, [3, -1, -2]);
                let mass = lane_by_lane(systems.mass.len(), |system| systems.mass[system][slot]);
                let constant = Lanes::splat(constant);
                let pull = constant * mass;
                self.acting.push(Acting::Shape {
                    body: systems.first + place,
                    row: systems.row + slot,
                    pull,
                    constant,
                    tensor,
                    back: pull / lanes[place].mass,
                });
            }
        }
    }

    /// Adds accelerations of centers and of points, and torques about centers, at a time since the start in the units of
    /// the integration.
    pub fn apply(&self, time: &Lanes, seen: &Seen<'_>, a: &mut [Lanes], torque: &mut [Lanes]) {
        if !self.acting.is_empty() {
            Lanes::pass(Apply { loads: &self.acting, seen, a, torque: &mut *torque });
        }
        for function in &self.functions {
            function.apply(time, seen, torque);
        }
    }
}

/// A number for each lane; those without a system repeat the last.
fn lane_by_lane(systems: usize, of: impl Fn(usize) -> f64) -> Lanes {
    Lanes(core::array::from_fn(|lane| of(lane.min(systems - 1))))
}

fn vector(starts: &[Vec<Start>], of: impl Fn(&[Start]) -> [f64; 3]) -> [Lanes; 3] {
    [0, 1, 2].map(|c| lane_by_lane(starts.len(), |system| of(&starts[system])[c]))
}

/// A vector along the caller's axes, along the principal ones.
fn along(bodies: &RigidBodies, start: &Start, v: [f64; 3]) -> [f64; 3] {
    let axes = bodies.axes[start.at];
    if axes == IDENTITY { v } else { rotated(conjugate(axes), v) }
}

/// The tensor about the center along the principal axes of a body: of one that is held, those are of another point.
pub(super) fn about_center(bodies: &RigidBodies, at: usize, mass: f64) -> [[f64; 3]; 3] {
    let (moments, c) = (bodies.moments[at], bodies.center[at]);
    let square = c.iter().map(|x| x * x).sum::<f64>();
    let mut tensor = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let shift = if i == j { square - c[i] * c[j] } else { -c[i] * c[j] };
            tensor[i][j] = if i == j { moments[i] } else { 0.0 } - mass * shift;
        }
    }
    tensor
}

/// Whether gravity cannot turn the body.
pub(super) fn is_sphere(bodies: &RigidBodies, at: usize) -> bool {
    let [a, b, c] = bodies.moments[at];
    a == b && b == c && !bodies.pivoted[at]
}

fn tensor(bodies: &RigidBodies, starts: &[Vec<Start>], place: usize, units: Units) -> [[Lanes; 3]; 3] {
    let each: Vec<[[f64; 3]; 3]> = starts
        .iter()
        .map(|of| about_center(bodies, of[place].at, scale(of[place].mass(), units.mass)))
        .collect();
    let part =
        |i: usize, j: usize| lane_by_lane(each.len(), |system| units.take(each[system][i][j], [2, 1, 0]));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| part(i, j)))
}

struct Apply<'a, 'b> {
    loads: &'a [Acting],
    seen: &'a Seen<'b>,
    a: &'a mut [Lanes],
    torque: &'a mut [Lanes],
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

impl Function {
    fn apply(&self, time: &Lanes, seen: &Seen<'_>, torque: &mut [Lanes]) {
        let at = seen.arrangement.at(self.body);
        let body = &seen.arrangement.bodies[self.body];
        let units = self.units;
        for lane in 0..self.lanes {
            let q = core::array::from_fn(|c| seen.q[at + c].0[lane]);
            let momentum = turned_back(q, [0, 1, 2].map(|c| seen.v[at + c].0[lane]));
            let spin = [0, 1, 2].map(|c| scale(body.inverse[c].0[lane] * momentum[c], -units.time));
            let axes = self.axes[lane];
            let orientation = crate::rigid::quaternion::product(q, axes);
            let spin = rotated(conjugate(axes), spin);
            let t = self.t0 + scale(time.0[lane], units.time);
            let given = (self.function)(t, &orientation, &spin);
            for c in 0..3 {
                torque[3 * self.body + c].0[lane] += units.take(given[c], [2, 1, -2]);
            }
        }
    }
}
