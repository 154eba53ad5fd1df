//! Loads over lanes: the forces and torques that they give to up to eight systems side by side.
//!
//! The one idea: a load adds to the accelerations of centers and to the torques about them, whatever holds a body; what a
//! held point makes of both is the step's business (`splitting`, `runge_kutta`).
//! Source of the pull on a body that is no sphere: MacCullagh's formula (Goldstein, *Classical Mechanics*, 5.8):
//! V = −G m M/r − G m/(2 r³) (tr I − 3 n·I n), for each body with each mass beside it.

mod apply;
mod expressed;
pub(super) mod unseen;
mod written;

use super::bodies::{Arrangement, LaneBody, RigidBodies, Start};
use super::loads::{End, Load, TorqueFunction};
use super::vectors::turned_back;
use crate::numerics::element::Element;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::rigid::quaternion::{IDENTITY, conjugate, rotated};
use crate::units::Units;
use apply::Apply;
use expressed::Expressed;

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
#[derive(Clone, Default)]
pub struct Loads {
    acting: Vec<Acting>,
    functions: Vec<Function>,
    formulas: Vec<Expressed>,
}

/// A torque that the caller computes of a body, in each of so many lanes.
#[derive(Clone)]
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
    /// The constant of gravity of each system, 0 without.
    pub constants: Vec<f64>,
    /// The units of the integration.
    pub units: Units,
    /// The time at which the run begins.
    pub t0: f64,
}

impl Loads {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.acting.is_empty() && self.are_written()
    }

    /// What they come to on the only body, if all are torques along its axes.
    pub(super) fn along_own_axes(&self) -> Option<[Lanes; 3]> {
        let mut sum = [Lanes::zero(); 3];
        for acting in &self.acting {
            let Acting::InBody(_, torque) = acting else { return None };
            (0..3).for_each(|c| sum[c] += torque[c]);
        }
        self.are_written().then_some(sum)
    }

    /// Adds those on the systems of one row of lanes.
    pub fn add(&mut self, systems: &Systems<'_>, lanes: &[LaneBody]) {
        let Systems { bodies, starts, members, particles, units, .. } = *systems;
        let rigid = particles - bodies.count;
        // Numbers of the scene's rigid bodies that these systems have, in their order.
        let own: Vec<usize> =
            members.iter().filter(|&&member| member >= rigid).map(|&member| member - rigid).collect();
        // What copies have of their own differs in nothing but numbers.
        let of_system = |of: &[Start], index: usize| {
            let copy = of.first().map_or(0, |start| start.at / bodies.count);
            &bodies.loads_of(copy)[index]
        };
        for (index, load) in bodies.loads.iter().enumerate() {
            let number = |value: &dyn Fn(&Load) -> f64, dimension: [i32; 3]| {
                let own = |system: usize| value(of_system(&starts[system], index));
                lane_by_lane(starts.len(), |system| units.take(own(system), dimension))
            };
            for (place, &member) in own.iter().enumerate() {
                if !load.acts_on(member) {
                    continue;
                }
                let body = systems.first + place;
                match load {
                    Load::Torque { in_body, .. } => {
                        let torque = vector(starts, |of| {
                            let Load::Torque { torque, .. } = of_system(of, index) else { return [0.0; 3] };
                            let torque = torque.map(|part| units.take(part, [2, 1, -2]));
                            if *in_body { along(bodies, &of[place], torque) } else { torque }
                        });
                        self.acting.push(if *in_body {
                            Acting::InBody(body, torque)
                        } else {
                            Acting::InSpace(body, torque)
                        });
                    }
                    Load::Drag { .. } => {
                        self.acting.push(Acting::Drag(body, number(&Load::coefficient, [2, 1, -1])));
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
                    Load::Formula { formula, in_body, .. } => {
                        self.formulas.push(Expressed::new((formula, *in_body), (systems, place), |of| {
                            of_system(of, index)
                        }))
                    }
                    Load::Spring { ends, .. } => {
                        // Once, by its first end that is a body of these.
                        let first = ends.iter().find_map(|end| match end {
                            End::Body(body, _) => Some(*body),
                            _ => None,
                        });
                        if first != Some(member) {
                            continue;
                        }
                        let point = |of: &[Start], which: usize| match of_system(of, index) {
                            Load::Spring { ends, .. } => {
                                ends[which].point().map(|part| units.take(part, [1, 0, 0]))
                            }
                            _ => [0.0; 3],
                        };
                        let ends = [0, 1].map(|which| match ends[which] {
                            End::Body(number, _) => {
                                let place = own.iter().position(|&own| own == number).unwrap_or(0);
                                let along = |of: &[Start]| along(bodies, &of[place], point(of, which));
                                LaneEnd::Body(systems.first + place, vector(starts, along))
                            }
                            End::Particle(index) => {
                                let slot = members.iter().position(|&member| member == index).unwrap_or(0);
                                let inverse = lane_by_lane(systems.mass.len(), |system| {
                                    1.0 / systems.mass[system][slot]
                                });
                                LaneEnd::Point(systems.row + slot, inverse)
                            }
                            End::Anchor(_) => LaneEnd::Anchor(vector(starts, |of| point(of, which))),
                        });
                        let damping = number(&Load::damping, [0, 1, -1]);
                        self.acting.push(Acting::Spring {
                            ends,
                            stiffness: number(&Load::stiffness, [0, 1, -2]),
                            length: number(&Load::length, [1, 0, 0]),
                            damping: damping.0.iter().any(|of| *of != 0.0).then_some(damping),
                        });
                    }
                }
            }
        }
        if systems.constants.iter().all(|&constant| constant == 0.0) {
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
                let constant = lane_by_lane(systems.constants.len(), |system| {
                    units.take(systems.constants[system], [3, -1, -2])
                });
                let mass = lane_by_lane(systems.mass.len(), |system| systems.mass[system][slot]);
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
    pub fn apply(&mut self, time: &Lanes, seen: &Seen<'_>, a: &mut [Lanes], torque: &mut [Lanes]) {
        if !self.acting.is_empty() {
            Lanes::pass(Apply { loads: &self.acting, seen, a, torque: &mut *torque });
        }
        for function in &self.functions {
            function.apply(time, seen, torque);
        }
        for formula in &mut self.formulas {
            formula.apply(time, seen, torque);
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
