//! The 24 conventions of Euler angles.
//!
//! The one idea: half the sum and half the difference of the outer angles are arguments of two complex numbers of a
//! quaternion, so that nothing is divided by the sine that vanishes at the poles. Letters are written as SciPy does:
//! `ZXZ` about axes that move with the body, `zxz` about axes that stay.
//! Source: Bernardes & Viollet, PLoS ONE 17 (2022) e0276302.

use super::quaternion::{Matrix, Quaternion, cross, dot, product};
use crate::error::{Error, Result};
use crate::numerics::angles::{atan2_parts, sin_cos};
use crate::numerics::double_double::DoubleDouble;

/// About which axes the three angles turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// As about axes that stay: the first turn, the second, the third.
    axes: [usize; 3],
    /// Whether the angles come in the opposite order.
    moving: bool,
}

fn axis(index: usize) -> [f64; 3] {
    let mut unit = [0.0; 3];
    unit[index] = 1.0;
    unit
}

/// A vector turned about an axis.
fn turned(v: [f64; 3], about: usize, angle: f64) -> [f64; 3] {
    let (sine, cosine) = sin_cos(angle);
    let (j, k) = ((about + 1) % 3, (about + 2) % 3);
    let mut result = v;
    result[j] = cosine * v[j] - sine * v[k];
    result[k] = sine * v[j] + cosine * v[k];
    result
}

fn within_a_turn(angle: DoubleDouble) -> f64 {
    let turn = DoubleDouble::PI.scale(2.0);
    if angle > DoubleDouble::PI {
        (angle - turn).to_f64()
    } else if angle <= -DoubleDouble::PI {
        (angle + turn).to_f64()
    } else {
        angle.to_f64()
    }
}

/// The angle of a vector, to more digits than a number has.
fn angle(y: f64, x: f64) -> DoubleDouble {
    let (high, low) = atan2_parts(y, x);
    DoubleDouble::sum(high, low)
}

impl Convention {
    /// From three letters.
    ///
    /// # Errors
    /// `InvalidInput` for what is none.
    pub fn new(name: &str) -> Result<Self> {
        let refused = || {
            let message = format!(
                "expected three of X, Y, Z (axes that move with the body) or of x, y, z (axes that stay), no two \
                 neighbours alike, got '{name}'"
            );
            Error::invalid("convention", message)
        };
        let letters = <[u8; 3]>::try_from(name.as_bytes()).map_err(|_| refused())?;
        let moving = letters[0].is_ascii_uppercase();
        let first = if moving { b'X' } else { b'x' };
        let mut axes = letters.map(|letter| usize::from(letter.wrapping_sub(first)));
        if axes.iter().any(|axis| *axis > 2) || axes[0] == axes[1] || axes[1] == axes[2] {
            return Err(refused());
        }
        if moving {
            axes.reverse();
        }
        Ok(Self { axes, moving })
    }

    fn in_order(self, mut angles: [f64; 3]) -> [f64; 3] {
        if self.moving {
            angles.reverse();
        }
        angles
    }

    /// The rotation of three angles.
    pub fn quaternion(self, angles: [f64; 3]) -> Quaternion {
        let angles = self.in_order(angles);
        let mut turns = [[0.0; 4]; 3];
        for at in 0..3 {
            let (sine, cosine) = sin_cos(0.5 * angles[at]);
            turns[at][self.axes[at]] = sine;
            turns[at][3] = cosine;
        }
        product(turns[2], product(turns[1], turns[0]))
    }

    /// The angles of a rotation: the outer ones in (−π, π], the middle one in [0, π] or, with three axes, in
    /// [−π/2, π/2]. At a pole, where only the sum or the difference of the outer ones means something, the last is 0.
    pub fn angles(self, q: Quaternion) -> [f64; 3] {
        let [i, j, last] = self.axes;
        let two_axes = i == last;
        let k = 3 - i - j;
        let even = (j + 3 - i) % 3 == 1;
        let sign = if even { 1.0 } else { -1.0 };
        let (x, y, z, w) = (q[i], q[j], sign * q[k], q[3]);
        let [a, b, c, d] = if two_axes { [w, x, y, z] } else { [w - y, x + z, y + w, z - x] };
        let (low, high) = ((c * c + d * d).sqrt(), (a * a + b * b).sqrt());
        let (half_sum, half_difference) = (angle(b, a), angle(d, c));
        // The outer angles are half_sum ∓ half_difference.
        let zero = DoubleDouble::default();
        let (first, third) = match (low == 0.0, high == 0.0, self.moving) {
            (true, _, false) => (half_sum.scale(2.0), zero),
            (true, _, true) => (zero, half_sum.scale(2.0)),
            (_, true, false) => (half_difference.scale(-2.0), zero),
            (_, true, true) => (zero, half_difference.scale(2.0)),
            _ => (half_sum - half_difference, half_sum + half_difference),
        };
        let middle = angle(low, high).scale(2.0);
        if two_axes {
            return self.in_order([within_a_turn(first), middle.to_f64(), within_a_turn(third)]);
        }
        let middle = (middle - DoubleDouble::PI.scale(0.5)).to_f64();
        self.in_order([within_a_turn(first), middle, within_a_turn(third.scale(sign))])
    }

    /// The axes about which the three turns go, in order, as columns seen in the body or in space.
    fn turning_axes(self, angles: [f64; 3], in_body: bool) -> Matrix {
        let [i, j, k] = self.axes;
        let [first, middle, third] = angles;
        if in_body {
            let second = turned(axis(j), i, -first);
            return [axis(i), second, turned(turned(axis(k), j, -middle), i, -first)];
        }
        [turned(turned(axis(i), j, middle), k, third), turned(axis(j), k, third), axis(k)]
    }

    /// The angular velocity of angles that change at such rates, seen in the body or in space.
    pub fn angular_velocity(self, angles: [f64; 3], rates: [f64; 3], in_body: bool) -> [f64; 3] {
        let axes = self.turning_axes(self.in_order(angles), in_body);
        let rates = self.in_order(rates);
        core::array::from_fn(|at| rates[0] * axes[0][at] + rates[1] * axes[1][at] + rates[2] * axes[2][at])
    }

    /// The rates at which the angles change under an angular velocity.
    ///
    /// # Errors
    /// `InvalidInput` at a pole, where the axes of the outer angles are one.
    pub fn rates(self, angles: [f64; 3], angular_velocity: [f64; 3], in_body: bool) -> Result<[f64; 3]> {
        let angles = self.in_order(angles);
        let [i, j, k] = self.axes;
        // How much of each outer axis is beside the other: the sine, or the cosine, of the middle angle.
        let beside = dot(turned(axis(i), j, angles[1]), cross(axis(j), axis(k)));
        if beside == 0.0 {
            let message = "expected angles off the pole: there the axes of the first and the last angle are one, and \
                           their rates cannot be told apart";
            return Err(Error::invalid("angles", message));
        }
        let [first, middle, third] = self.turning_axes(angles, in_body);
        let rates = [
            dot(angular_velocity, cross(middle, third)) / beside,
            dot(angular_velocity, middle),
            dot(angular_velocity, cross(first, middle)) / beside,
        ];
        Ok(self.in_order(rates))
    }
}

#[cfg(test)]
mod tests {
    use super::super::quaternion::{conjugate, matrix, rotated};
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};

    fn all() -> Vec<String> {
        let mut names = Vec::new();
        for letters in [*b"XYZ", *b"xyz"] {
            for i in 0..3 {
                for j in (0..3).filter(|j| *j != i) {
                    for k in (0..3).filter(|k| *k != j) {
                        names.push([i, j, k].map(|at: usize| char::from(letters[at])).iter().collect());
                    }
                }
            }
        }
        names
    }

    fn apart(a: Quaternion, b: Quaternion) -> f64 {
        let [x, y, z, _] = product(conjugate(a), b);
        2.0 * dot([x, y, z], [x, y, z]).sqrt()
    }

    #[test]
    fn every_convention_there_and_back_at_poles_and_beside_them() -> Result<()> {
        assert_eq!(all().len(), 24);
        for name in all() {
            let convention = Convention::new(&name)?;
            for first in [0.0, 0.3, -2.9, PI, 1.5] {
                for middle in
                    [0.0, 1e-300, 1e-17, 1e-9, 0.7, FRAC_PI_2, -FRAC_PI_2, 3.1, PI, FRAC_PI_2 - 1e-8]
                {
                    for third in [0.0, -0.4, 2.8, -PI, 1e-12] {
                        let q = convention.quaternion([first, middle, third]);
                        let angles = convention.angles(q);
                        let back = convention.quaternion(angles);
                        assert!(apart(q, back) <= 4.0 * f64::EPSILON, "{name}: {:e}", apart(q, back));
                        let least = if name.as_bytes()[0] == name.as_bytes()[2] { 0.0 } else { -FRAC_PI_2 };
                        assert!((least..=least + PI).contains(&angles[1]), "{name}: {angles:?}");
                        assert!(angles[0].abs() <= PI && angles[2].abs() <= PI);
                    }
                }
            }
        }
        Ok(())
    }

    #[test]
    fn moving_axes_are_fixed_ones_in_the_opposite_order() -> Result<()> {
        let angles = [0.3, 1.1, -0.8];
        for name in all().iter().filter(|name| name.as_bytes()[0].is_ascii_uppercase()) {
            let reversed: String = name.to_lowercase().chars().rev().collect();
            let (a, b) = (Convention::new(name)?, Convention::new(&reversed)?);
            assert_eq!(a.quaternion(angles), b.quaternion([-0.8, 1.1, 0.3]));
            // The first turn of fixed axes is about the first letter, by its own matrix.
            let single = Convention::new(&name.to_lowercase())?.quaternion([0.5, 0.0, 0.0]);
            let about = usize::from(name.as_bytes()[0] - b'X');
            let column = rotated(single, axis((about + 1) % 3));
            assert!((column[(about + 2) % 3] - 0.5_f64.sin()).abs() < 1e-15);
            assert!((matrix(single)[about][about] - 1.0).abs() < 1e-15);
        }
        Ok(())
    }

    #[test]
    fn rates_are_those_of_differences() -> Result<()> {
        let (angles, rates, h) = ([0.4, 0.9, -1.3], [0.7, -0.2, 1.1], 1e-5);
        for name in all() {
            let convention = Convention::new(&name)?;
            let at = |s: f64| convention.quaternion(core::array::from_fn(|n| angles[n] + s * rates[n]));
            let (before, after) = (at(-h), at(h));
            // q̇ = ½ ω q of ω in space, ½ q ω in the body: 2 q̇ q* over 2h, to h² ≈ 1e-10.
            let [x, y, z, _] = product(after, conjugate(before));
            let space = convention.angular_velocity(angles, rates, false);
            let [bx, by, bz, _] = product(conjugate(before), after);
            let body = convention.angular_velocity(angles, rates, true);
            for (found, wanted) in [(space, [x, y, z]), (body, [bx, by, bz])] {
                for n in 0..3 {
                    assert!((found[n] - wanted[n] / h).abs() < 1e-9, "{name}: {found:?} {wanted:?}");
                }
            }
            for (omega, in_body) in [(space, false), (body, true)] {
                let back = convention.rates(angles, omega, in_body)?;
                for n in 0..3 {
                    assert!((back[n] - rates[n]).abs() < 1e-14, "{name}: {back:?}");
                }
            }
        }
        assert!(Convention::new("ZXZ")?.rates([0.1, 0.0, 0.2], [1.0; 3], true).is_err());
        for wrong in ["", "ZX", "ZZX", "ZXx", "zxzz", "abc", "ZXX", "éz"] {
            assert!(Convention::new(wrong).is_err(), "{wrong}");
        }
        Ok(())
    }
}
