//! What is constant of a state, and the effective potential.

use super::field::Field;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use nalgebra::Vector3;

/// What a state about the center says of the motion, in the caller's units.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    /// The distance.
    pub radius: f64,
    /// Its rate.
    pub radial_velocity: f64,
    /// l = m |r × v|.
    pub angular_momentum: f64,
    /// l²/2m to about thirty digits.
    pub centrifugal: DoubleDouble,
    /// m v²/2 + V, as that.
    pub energy: DoubleDouble,
    /// The direction to the body.
    pub outward: Vector3<f64>,
    /// The direction of the motion across it, in the plane of the orbit; of a radial motion any.
    pub across: Vector3<f64>,
}

impl Field {
    /// Of a body at a place, with a velocity; sums in double-double, as they may cancel.
    pub fn constants(&self, mass: f64, position: Vector3<f64>, velocity: Vector3<f64>) -> Constants {
        let (length, energy) = self.units();
        let speed = energy / 2;
        let r = position.map(|x| scale(x, -length));
        let v = velocity.map(|x| scale(x, -speed));
        let dot = |a: Vector3<f64>, b: Vector3<f64>| {
            (0..3).fold(DoubleDouble::default(), |sum, c| sum + DoubleDouble::product(a[c], b[c]))
        };
        let distance = Real::sqrt(dot(r, r));
        let difference =
            |a: usize, b: usize| DoubleDouble::product(r[a], v[b]) - DoubleDouble::product(r[b], v[a]);
        let exact = [difference(1, 2), difference(2, 0), difference(0, 1)];
        let square = exact.iter().fold(DoubleDouble::default(), |sum, x| sum + *x * *x);
        let momentum = Vector3::from(exact.map(DoubleDouble::high));
        let scaled = |x: DoubleDouble, by: i32| DoubleDouble::new(scale(x.high(), by), scale(x.low(), by));
        let all = dot(v, v).scale(0.5) * DoubleDouble::from(mass) + self.precise(distance).0;
        let outward = r / distance.high();
        let turning = momentum.norm();
        let across = if turning > 0.0 {
            (momentum / turning).cross(&outward)
        } else {
            let axis = outward.iamin();
            let other = Vector3::from_fn(|c, _| if c == axis { 1.0 } else { 0.0 });
            outward.cross(&other).normalize()
        };
        Constants {
            radius: scale(distance.high(), length),
            radial_velocity: scale((dot(r, v) / distance).high(), speed),
            angular_momentum: scale(mass * turning, length + speed),
            centrifugal: scaled(square * DoubleDouble::from(0.5 * mass), 2 * length + energy),
            energy: scaled(all, energy),
            outward,
            across,
        }
    }

    /// V + l²/2mr², in the caller's units.
    pub fn effective(&self, centrifugal: DoubleDouble, r: f64) -> f64 {
        let r = self.take_length(r);
        let turning = self.take_centrifugal(centrifugal).high();
        self.give_energy(self.value(r) + if turning == 0.0 { 0.0 } else { turning / r / r })
    }

    /// −u − m F/(l²u²), which the path equation says is d²u/dθ², of u = 1/r in the caller's units.
    pub fn path_curvature(&self, centrifugal: DoubleDouble, u: f64) -> f64 {
        let r = self.take_length(1.0 / u);
        let turning = self.take_centrifugal(centrifugal).high();
        -u - scale(self.at(r)[1] * r * r / (2.0 * turning), -self.units().0)
    }
}
