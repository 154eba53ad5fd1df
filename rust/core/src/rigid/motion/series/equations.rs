//! The equations of motion of rigid bodies and points as expressions of the numbers of a state, in their order.
//!
//! The one idea: what no lane has alike is a parameter, so that the expressions are those of any bodies that lie so.

use super::super::acting::Loads;
use super::super::bodies::{Arrangement, LaneBody};
use super::writer::{Rotation, Vector, Writer};
use crate::error::Result;
use crate::expressions::program::Output;
use crate::expressions::{Id, Series};
use crate::numerics::lanes::Lanes;

/// How a rigid body is turned and turns.
pub(in crate::rigid::motion) struct Body {
    quaternion: [Id; 4],
    pub(in crate::rigid::motion) rotation: Rotation,
    /// Along its principal axes.
    pub(in crate::rigid::motion) spin: Vector,
    /// From the point that is held to the center.
    arm: Vector,
}

/// Where everything is and how it moves.
pub(in crate::rigid::motion) struct Sight {
    /// Of each row of points.
    pub(in crate::rigid::motion) place: Vec<Vector>,
    pub(in crate::rigid::motion) velocity: Vec<Vector>,
    pub(in crate::rigid::motion) bodies: Vec<Body>,
}

/// What acts, as expressions.
pub(in crate::rigid::motion) struct Acted {
    /// On each row of points.
    pub(in crate::rigid::motion) acceleration: Vec<Vector>,
    /// On each body, about its center.
    pub(in crate::rigid::motion) torque: Vec<Vector>,
}

/// Expressions as series, and the numbers that their parameters begin with.
pub(super) type Written = (Series, Vec<Lanes>);

impl Sight {
    fn new(writer: &mut Writer, arrangement: &Arrangement) -> Self {
        let Arrangement { rows, bodies, .. } = arrangement;
        let half = arrangement.half();
        let at = |row: usize| [0, 1, 2].map(|c| c * rows + row);
        let mut place: Vec<Vector> = (0..*rows).map(|row| writer.variables(at(row))).collect();
        let mut velocity: Vec<Vector> =
            (0..*rows).map(|row| writer.variables(at(row).map(|at| half + at))).collect();
        let mut turning = Vec::with_capacity(bodies.len());
        for (body, of) in bodies.iter().enumerate() {
            let first = arrangement.at(body);
            let quaternion = writer.variables([first, first + 1, first + 2, first + 3]);
            let momentum = writer.variables([half + first, half + first + 1, half + first + 2]);
            let rotation = Rotation::of(writer, quaternion);
            let own = rotation.turned_back(writer, momentum);
            let inverse = writer.vector(&of.inverse);
            let spin = writer.each_times(own, inverse);
            let mut arm = writer.nothing();
            if of.pivoted {
                let center = writer.vector(&of.center);
                arm = rotation.turned(writer, center);
                let pivot = writer.vector(&of.pivot);
                place[of.row] = writer.plus(arm, 1.0, pivot);
                let moving = writer.cross(spin, center);
                velocity[of.row] = rotation.turned(writer, moving);
            }
            turning.push(Body { quaternion, rotation, spin, arm });
        }
        Self { place, velocity, bodies: turning }
    }
}

impl Body {
    /// The rate of the quaternion: its product with half the spin.
    fn turning(&self, writer: &mut Writer) -> [Id; 4] {
        let [x, y, z, w] = self.quaternion;
        let mut half = |terms: [(f64, usize, usize); 3]| {
            let of = [x, y, z, w];
            let terms = terms
                .map(|(sign, part, axis)| (0.5 * sign, writer.graph.multiply(of[part], self.spin[axis])));
            writer.graph.sum(0.0, &terms)
        };
        [
            half([(1.0, 3, 0), (1.0, 1, 2), (-1.0, 2, 1)]),
            half([(1.0, 3, 1), (1.0, 2, 0), (-1.0, 0, 2)]),
            half([(1.0, 3, 2), (1.0, 0, 1), (-1.0, 1, 0)]),
            half([(-1.0, 0, 0), (-1.0, 1, 1), (-1.0, 2, 2)]),
        ]
    }

    /// The torque about the center, or about the point that is held; of a rod what is across it.
    fn twist(&self, writer: &mut Writer, of: &LaneBody, torque: Vector, acceleration: Vector) -> Vector {
        let mut twist = torque;
        if of.pivoted {
            let mass = writer.number(&of.mass);
            let pull = writer.times(acceleration, mass);
            let turning = writer.cross(self.arm, pull);
            twist = writer.plus(turning, 1.0, twist);
        }
        if of.rod {
            let axis = writer.vector(&of.axis);
            let axis = self.rotation.turned(writer, axis);
            let along = writer.dot(axis, twist);
            let about_itself = writer.times(axis, along);
            twist = writer.plus(twist, -1.0, about_itself);
        }
        twist
    }
}

/// The rates of all numbers of a state, then where the centers of held bodies are from their points. The accelerations by forces
/// are the first parameters if they are `alike` everywhere, else variables behind the state's.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn rates(arrangement: &Arrangement, loads: &Loads, alike: bool) -> Result<Written> {
    let (rows, points, half) = (arrangement.rows, arrangement.points(), arrangement.half());
    let mut writer = Writer::new(if alike { points } else { 0 });
    let sight = Sight::new(&mut writer, arrangement);
    let pull = |writer: &mut Writer, row: usize| {
        [0, 1, 2].map(|c| c * rows + row).map(|at| {
            if alike {
                writer.graph.parameter(at as u32)
            } else {
                writer.graph.variable((2 * half + at) as u32)
            }
        })
    };
    let acceleration = (0..rows).map(|row| pull(&mut writer, row)).collect();
    let torque = vec![writer.nothing(); arrangement.bodies.len()];
    let mut acted = Acted { acceleration, torque };
    loads.write(&mut writer, &arrangement.bodies, &sight, &mut acted);

    let zero = writer.graph.constant(0.0);
    let mut outputs = vec![zero; 2 * half];
    for row in (0..rows).filter(|&row| arrangement.held().all(|held| held != row)) {
        for c in 0..3 {
            let at = c * rows + row;
            (outputs[at], outputs[half + at]) = (sight.velocity[row][c], acted.acceleration[row][c]);
        }
    }
    let mut arms = Vec::new();
    for (index, (body, of)) in sight.bodies.iter().zip(&*arrangement.bodies).enumerate() {
        let at = arrangement.at(index);
        outputs[at..at + 4].copy_from_slice(&body.turning(&mut writer));
        let twist = body.twist(&mut writer, of, acted.torque[index], acted.acceleration[of.row]);
        outputs[half + at..half + at + 3].copy_from_slice(&twist);
        if of.pivoted {
            arms.extend(body.arm);
        }
    }
    outputs.extend(arms);
    finish(writer, 2 * half + if alike { 0 } else { points }, &outputs)
}

/// Where the centers of held bodies are from their points, and how they move.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn centers(arrangement: &Arrangement) -> Result<Written> {
    let mut writer = Writer::new(0);
    let sight = Sight::new(&mut writer, arrangement);
    let held = sight.bodies.iter().zip(&*arrangement.bodies).filter(|(_, of)| of.pivoted);
    let outputs: Vec<_> =
        held.flat_map(|(body, of)| body.arm.into_iter().chain(sight.velocity[of.row])).collect();
    finish(writer, 2 * arrangement.half(), &outputs)
}

fn finish(writer: Writer, variables: usize, outputs: &[Id]) -> Result<Written> {
    let Writer { graph, parameters } = writer;
    let outputs: Vec<Output> = outputs.iter().map(|&id| Output::Node(id)).collect();
    Ok((Series::new(&graph, (variables, parameters.len()), &[], &outputs)?, parameters))
}
