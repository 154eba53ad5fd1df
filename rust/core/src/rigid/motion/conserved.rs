//! What rigid bodies add to the conserved quantities of a scene, whose points are counted by `conservation`.

use super::acting::{about_center, is_sphere};
use super::bodies::RigidBodies;
use super::loads::{End, Load};
use super::vectors::{cross, dot, minus, turned, turned_back};
use crate::rigid::quaternion::{Quaternion, rotated};

/// The bodies of one copy at one time: masses and places of all, orientations and angular velocities of the rigid ones.
#[derive(Clone, Copy, Debug)]
pub struct Scenery<'a> {
    /// The rigid bodies of the batch.
    pub bodies: &'a RigidBodies,
    /// Which copy it is.
    pub copy: usize,
    /// Masses of all.
    pub mass: &'a [f64],
    /// Places of all.
    pub place: &'a [[f64; 3]],
    /// From the caller's axes to space.
    pub orientation: &'a [Quaternion],
    /// Along the caller's axes.
    pub angular_velocity: &'a [[f64; 3]],
    /// The constant of gravity, 0 without.
    pub constant: f64,
}

impl Scenery<'_> {
    /// What is added to a column.
    pub fn share(&self, column: &str) -> [f64; 3] {
        match column {
            "energy" => [self.kinetic_energy() + self.potential_energy(), 0.0, 0.0],
            "kinetic_energy" => [self.kinetic_energy(), 0.0, 0.0],
            "potential_energy" => [self.potential_energy(), 0.0, 0.0],
            "angular_momentum" => self.spin(),
            _ => [0.0; 3],
        }
    }

    /// The number of a body in the batch, the orientation of its principal axes, and its angular velocity along them.
    fn principal(&self, body: usize) -> (usize, Quaternion, [f64; 3]) {
        let at = self.copy * self.bodies.count + body;
        let state = RigidBodies::to_principal(
            self.bodies.axes[at],
            self.orientation[body],
            self.angular_velocity[body],
        );
        (at, state.0, state.1)
    }

    /// The mass of a rigid body.
    fn mass_of(&self, body: usize) -> f64 {
        self.mass[self.mass.len() - self.bodies.count + body]
    }

    /// ½ ω·I ω about the centers: points have the rest.
    fn kinetic_energy(&self) -> f64 {
        let of = |body| {
            let (at, _, spin) = self.principal(body);
            let moments = self.bodies.moments[at];
            let whole = (0..3).map(|c| moments[c] * spin[c] * spin[c]).sum::<f64>();
            let swing = cross(spin, self.bodies.center[at]);
            0.5 * (whole - self.mass_of(body) * dot(swing, swing))
        };
        (0..self.bodies.count).map(of).sum()
    }

    /// Angular momenta about the centers, in space.
    fn spin(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for body in 0..self.bodies.count {
            let (at, orientation, spin) = self.principal(body);
            let (moments, center) = (self.bodies.moments[at], self.bodies.center[at]);
            let orbital = cross(center, cross(spin, center));
            let own = [0, 1, 2].map(|c| moments[c] * spin[c] - self.mass_of(body) * orbital[c]);
            let own = turned(orientation, own);
            for c in 0..3 {
                sum[c] += own[c];
            }
        }
        sum
    }

    /// The energy of springs and of shapes in the pull of masses.
    fn potential_energy(&self) -> f64 {
        let Self { bodies, mass, place, constant, .. } = *self;
        let particles = mass.len();
        let rigid = particles - bodies.count;
        let mut sum = 0.0;
        for load in bodies.loads_of(self.copy) {
            let Load::Spring { ends, stiffness, length, .. } = load else { continue };
            let [one, other] = ends.map(|end| match end {
                End::Anchor(point) => point,
                End::Particle(index) => place[index],
                End::Body(body, point) => {
                    let arm = rotated(self.orientation[body], point);
                    let center = place[rigid + body];
                    [center[0] + arm[0], center[1] + arm[1], center[2] + arm[2]]
                }
            });
            let apart = minus(one, other);
            let stretched = dot(apart, apart).sqrt() - length;
            sum += 0.5 * stiffness * stretched * stretched;
        }
        if constant == 0.0 {
            return sum;
        }
        for body in 0..bodies.count {
            let (at, orientation, _) = self.principal(body);
            if is_sphere(bodies, at) {
                continue;
            }
            let tensor = about_center(bodies, at, mass[rigid + body]);
            let trace = tensor[0][0] + tensor[1][1] + tensor[2][2];
            for other in (0..particles).filter(|&other| other != rigid + body && mass[other] > 0.0) {
                let apart = minus(place[other], place[rigid + body]);
                let along = turned_back(orientation, apart);
                let second = dot(along, tensor.map(|row| dot(row, along)));
                let square = dot(apart, apart);
                let cube = square * square.sqrt();
                sum -= 0.5 * constant * mass[other] * (trace / cube - 3.0 * second / (cube * square));
            }
        }
        sum
    }
}
