//! Loads as expressions, for series: the same sums as those of the pass ([`apply`](super::apply)).

use super::{Acting, LaneEnd, Loads};
use crate::expressions::Id;
use crate::numerics::lanes::Lanes;
use crate::rigid::motion::bodies::LaneBody;
use crate::rigid::motion::series::equations::{Acted, Sight};
use crate::rigid::motion::series::writer::{Vector, Writer};

/// Where an end is, how it moves, and from where on its body it pulls.
fn end(writer: &mut Writer, end: &LaneEnd, sight: &Sight, bodies: &[LaneBody]) -> [Vector; 3] {
    let nothing = writer.nothing();
    match end {
        LaneEnd::Anchor(point) => [writer.vector(point), nothing, nothing],
        LaneEnd::Point(row, _) => [sight.place[*row], sight.velocity[*row], nothing],
        LaneEnd::Body(body, point) => {
            let (of, row) = (&sight.bodies[*body], bodies[*body].row);
            let point = writer.vector(point);
            let arm = of.rotation.turned(writer, point);
            let turning = writer.cross(of.spin, point);
            let turning = of.rotation.turned(writer, turning);
            let place = writer.plus(sight.place[row], 1.0, arm);
            [place, writer.plus(sight.velocity[row], 1.0, turning), arm]
        }
    }
}

impl Acted {
    /// Adds a torque on a body.
    fn turn(&mut self, writer: &mut Writer, body: usize, torque: Vector) {
        self.torque[body] = writer.plus(self.torque[body], 1.0, torque);
    }

    /// Adds an acceleration of a row, times a sign.
    fn move_by(&mut self, writer: &mut Writer, row: usize, sign: f64, acceleration: Vector) {
        self.acceleration[row] = writer.plus(self.acceleration[row], sign, acceleration);
    }

    /// Adds a force at an end, times a sign.
    fn pull(
        &mut self,
        writer: &mut Writer,
        end: &LaneEnd,
        (sign, force, arm): (f64, Vector, Vector),
        bodies: &[LaneBody],
    ) {
        match end {
            LaneEnd::Anchor(_) => {}
            LaneEnd::Point(row, inverse) => {
                let inverse = writer.number(inverse);
                let acceleration = writer.times(force, inverse);
                self.move_by(writer, *row, sign, acceleration);
            }
            LaneEnd::Body(body, _) => {
                let mass = writer.number(&bodies[*body].mass);
                let acceleration = force.map(|part| writer.graph.divide(part, mass));
                self.move_by(writer, bodies[*body].row, sign, acceleration);
                let torque = writer.cross(arm, force);
                self.torque[*body] = writer.plus(self.torque[*body], sign, torque);
            }
        }
    }
}

/// The force of a spring by its length, and of its damper: minus what the vector between its ends is multiplied with.
fn stretched(
    writer: &mut Writer,
    [one, other]: [[Vector; 3]; 2],
    (stiffness, length, damping): (&Lanes, &Lanes, Option<&Lanes>),
) -> (Vector, Id) {
    let apart = writer.plus(one[0], -1.0, other[0]);
    let square = writer.dot(apart, apart);
    let stiffness = writer.number(stiffness);
    let mut factor = stiffness;
    // Without a length, which copies in lanes have all or none, it has no direction where its ends meet, and needs none.
    if length.0.iter().any(|&length| length != 0.0) {
        let length = writer.number(length);
        let distance = writer.graph.power(square, 0.5);
        let part = writer.graph.divide(length, distance);
        let stretched = writer.graph.sum(1.0, &[(-1.0, part)]);
        factor = writer.graph.multiply(stiffness, stretched);
    }
    if let Some(damping) = damping {
        let moving = writer.plus(one[1], -1.0, other[1]);
        let rate = writer.dot(apart, moving);
        let rate = writer.graph.divide(rate, square);
        let damping = writer.number(damping);
        let slowing = writer.graph.multiply(damping, rate);
        factor = writer.graph.add(factor, slowing);
    }
    (apart, factor)
}

impl Loads {
    /// Whether all of them can be written: functions of the caller cannot, and formulas are not.
    pub(in crate::rigid::motion) fn are_written(&self) -> bool {
        self.functions.is_empty() && self.formulas.is_empty()
    }

    /// Adds what acts on bodies, but for functions of the caller.
    pub(in crate::rigid::motion) fn write(
        &self,
        writer: &mut Writer,
        bodies: &[LaneBody],
        sight: &Sight,
        acted: &mut Acted,
    ) {
        for acting in &self.acting {
            match acting {
                Acting::InSpace(body, of) => {
                    let torque = writer.vector(of);
                    acted.turn(writer, *body, torque);
                }
                Acting::InBody(body, of) => {
                    let torque = writer.vector(of);
                    let torque = sight.bodies[*body].rotation.turned(writer, torque);
                    acted.turn(writer, *body, torque);
                }
                Acting::Drag(body, coefficient) => {
                    let of = &sight.bodies[*body];
                    let spin = of.rotation.turned(writer, of.spin);
                    let coefficient = writer.number(coefficient);
                    let torque = writer.times(spin, coefficient);
                    acted.torque[*body] = writer.plus(acted.torque[*body], -1.0, torque);
                }
                Acting::Spring { ends, stiffness, length, damping } => {
                    let seen = ends.each_ref().map(|at| end(writer, at, sight, bodies));
                    let (apart, factor) = stretched(writer, seen, (stiffness, length, damping.as_ref()));
                    let force = writer.times(apart, factor);
                    acted.pull(writer, &ends[0], (-1.0, force, seen[0][2]), bodies);
                    acted.pull(writer, &ends[1], (1.0, force, seen[1][2]), bodies);
                }
                Acting::Shape { .. } => shape(writer, acting, (bodies, sight), acted),
            }
        }
    }
}

/// The pull on a body that is no sphere, as that of the pass.
fn shape(writer: &mut Writer, acting: &Acting, (bodies, sight): (&[LaneBody], &Sight), acted: &mut Acted) {
    let Acting::Shape { body, row, pull, constant, tensor, back } = acting else { return };
    let center = bodies[*body].row;
    let rotation = &sight.bodies[*body].rotation;
    let apart = writer.plus(sight.place[*row], -1.0, sight.place[center]);
    let along = rotation.turned_back(writer, apart);
    let inner = tensor.each_ref().map(|of| {
        let of = writer.vector(of);
        writer.dot(of, along)
    });
    let [xx, yy, zz] = [0, 1, 2].map(|c| writer.number(&tensor[c][c]));
    let trace = writer.graph.sum(0.0, &[(1.0, xx), (1.0, yy), (1.0, zz)]);
    let second = writer.dot(along, inner);
    let square = writer.dot(apart, apart);
    let fifth = writer.graph.power(square, -2.5);
    let inner = rotation.turned(writer, inner);
    let ratio = writer.graph.divide(second, square);
    let radial = writer.graph.sum(0.0, &[(7.5, ratio), (-1.5, trace)]);
    let straight = writer.times(apart, radial);
    let field = writer.plus(straight, -3.0, inner);
    let field = writer.times(field, fifth);
    for (row, factor, sign) in [(*row, constant, 1.0), (center, back, -1.0)] {
        let factor = writer.number(factor);
        let acceleration = writer.times(field, factor);
        acted.move_by(writer, row, sign, acceleration);
    }
    let across = writer.cross(apart, inner);
    let twist = writer.times(across, fifth);
    let pull = writer.number(pull);
    let torque = writer.times(twist, pull);
    acted.torque[*body] = writer.plus(acted.torque[*body], 3.0, torque);
}
