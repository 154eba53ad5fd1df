//! Two bodies that collide in space: what impulse they exchange, by a line of centres or by the direction in which
//! they part.
//!
//! The one idea: only the relative velocity u = v₁ - v₂ changes, by Δ; the impulse on the first is μΔ, and each body
//! takes the other's share of the mass of Δ. So momentum is conserved by construction.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* (3rd ed.), §3.11; Landau & Lifshitz, *Mechanics*, §16–17.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::words::number;
use crate::{Error, Result};

type Vector = [f64; 3];

/// How much of the energy there is a Q-value may take beyond it: roundings of whoever computed it to leave nothing.
const FORGIVEN: f64 = 16.0 * f64::EPSILON;

/// What happens between the two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Along the line of centres they part with this part of the speed with which they met.
    Restitution(f64),
    /// This energy is released, or taken up if it is negative.
    Released(f64),
}

/// Along what the relative velocity changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// The line of centres, of any length and either sense: smooth bodies push each other along it alone.
    Normal(Vector),
    /// The direction of the relative velocity afterwards, of any length.
    Direction(Vector),
}

/// Before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Positive and finite.
    pub masses: [f64; 2],
    /// Of each.
    pub velocities: [Vector; 2],
}

/// After.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Of each.
    pub velocities: [Vector; 2],
    /// What the first has received; the second has received as much the other way.
    pub impulse: Vector,
    /// Kinetic energy that is gone; negative where some was released.
    pub energy_loss: f64,
}

/// A speed, by its square in units of 2^(2 unit).
#[derive(Clone, Copy)]
struct Speed {
    squared: DoubleDouble,
    unit: i32,
}

impl Speed {
    fn value(self) -> f64 {
        scale(self.squared.sqrt().to_f64(), self.unit)
    }
}

fn scaled(value: DoubleDouble, exponent: i32) -> DoubleDouble {
    let (high, low) = value.parts();
    DoubleDouble::new(scale(high, exponent), scale(low, exponent))
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector of length 1 and the length, or None for no direction.
fn normalized(vector: Vector) -> Option<(Vector, f64)> {
    let unit = exponent(vector.iter().fold(0.0_f64, |most, part| most.max(part.abs())));
    let scaled = vector.map(|part| scale(part, -unit));
    let length = dot(scaled, scaled).sqrt();
    (length > 0.0).then(|| (scaled.map(|part| part / length), scale(length, unit)))
}

/// μ = m₁m₂/(m₁+m₂), never above the smaller.
pub fn reduced_mass(masses: [f64; 2]) -> f64 {
    let (small, large) = (masses[0].min(masses[1]), masses[0].max(masses[1]));
    small / (1.0 + small / large)
}

/// m₁/(m₁+m₂) and m₂/(m₁+m₂).
fn shares(masses: [f64; 2]) -> [f64; 2] {
    let [first, second] = masses;
    [1.0 / (1.0 + second / first), 1.0 / (1.0 + first / second)]
}

/// The centre of mass and the first from the second, of two positions or two velocities.
pub fn to_relative(masses: [f64; 2], vectors: [Vector; 2]) -> (Vector, Vector) {
    let relative: Vector = core::array::from_fn(|c| vectors[0][c] - vectors[1][c]);
    // From the heavier one, next to which the centre is.
    let [first, second] = shares(masses);
    let (from, share) = if masses[0] >= masses[1] { (vectors[0], -second) } else { (vectors[1], first) };
    (core::array::from_fn(|c| from[c] + share * relative[c]), relative)
}

/// Both from the centre of mass and the first from the second.
pub fn from_relative(masses: [f64; 2], center: Vector, relative: Vector) -> [Vector; 2] {
    let [first, second] = shares(masses);
    [
        core::array::from_fn(|c| center[c] + second * relative[c]),
        core::array::from_fn(|c| center[c] - first * relative[c]),
    ]
}

impl Pair {
    fn relative(&self) -> Vector {
        core::array::from_fn(|c| self.velocities[0][c] - self.velocities[1][c])
    }
    /// What becomes of them.
    ///
    /// # Errors
    /// `InvalidInput` naming what gives no direction, a coefficient that is none, or a Q-value below the threshold.
    pub fn collide(&self, rule: Rule, geometry: Geometry) -> Result<Outcome> {
        let relative = self.relative();
        let no_direction = |name: &str| Error::invalid(name, "expected a vector with a direction, got zero");
        let (change, energy_loss) = match geometry {
            Geometry::Normal(given) => {
                let (normal, _) = normalized(given).ok_or_else(|| no_direction("normal"))?;
                let (speed, sign) = self.speed(Some(normal));
                let (after, loss) = self.parting(rule, speed)?;
                if sign == 0.0 && after > 0.0 {
                    return Err(Error::invalid(
                        "normal",
                        "expected bodies that approach along it, but they do not move along it at all: which way \
                         they part is not known",
                    ));
                }
                // They part the other way: a sum, whatever is lost.
                (normal.map(|part| -(speed.value() + after).copysign(sign) * part), loss)
            }
            Geometry::Direction(direction) => {
                let (direction, _) = normalized(direction).ok_or_else(|| no_direction("direction"))?;
                let (after, loss) = self.parting(rule, self.speed(None).0)?;
                (core::array::from_fn(|c| after * direction[c] - relative[c]), loss)
            }
        };
        let [first, second] = shares(self.masses);
        let reduced = reduced_mass(self.masses);
        let outcome = Outcome {
            velocities: [
                core::array::from_fn(|c| self.velocities[0][c] + second * change[c]),
                core::array::from_fn(|c| self.velocities[1][c] - first * change[c]),
            ],
            impulse: change.map(|part| reduced * part + 0.0), // -0 is 0
            energy_loss,
        };
        let numbers = outcome.velocities.as_flattened().iter().chain(&outcome.impulse);
        if numbers.chain([&outcome.energy_loss]).all(|value| value.is_finite()) {
            return Ok(outcome);
        }
        Err(Error::invalid(
            "velocity1",
            "expected numbers whose results are within float64; choose other units",
        ))
    }
    /// The relative speed, or that along a vector of length 1 and the sense of it.
    ///
    /// The square in double-double, of a vector whose length is not trusted either: what a Q-value leaves of it at the
    /// threshold is a difference.
    fn speed(&self, normal: Option<Vector>) -> (Speed, f64) {
        let velocities = self.velocities.as_flattened();
        let unit = exponent(velocities.iter().fold(0.0_f64, |most, part| most.max(part.abs())));
        let [first, second] = self.velocities;
        let relative: [DoubleDouble; 3] =
            core::array::from_fn(|c| DoubleDouble::sum(scale(first[c], -unit), -scale(second[c], -unit)));
        let product = |a: [DoubleDouble; 3], b: [DoubleDouble; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let Some(normal) = normal.map(|normal| normal.map(DoubleDouble::from)) else {
            return (Speed { squared: product(relative, relative), unit }, 1.0);
        };
        let along = product(relative, normal);
        (Speed { squared: along * along / product(normal, normal), unit }, along.high())
    }
    /// The speed with which they part and the energy that is lost, of the speed with which they meet.
    fn parting(&self, rule: Rule, speed: Speed) -> Result<(f64, f64)> {
        let (small, large) = (self.masses[0].min(self.masses[1]), self.masses[0].max(self.masses[1]));
        let (light, heavy) = (exponent(small), exponent(large));
        let [lighter, heavier] = [scale(small, -light), scale(large, -heavy)].map(DoubleDouble::from);
        let one = DoubleDouble::from(1.0);
        let reduced = lighter / (one + scaled(lighter / heavier, light - heavy));
        // ½μu², in units of 2^unit.
        let (half, unit) = ((reduced * speed.squared).scale(0.5), light + 2 * speed.unit);
        let there = scale(half.to_f64(), unit);
        match rule {
            Rule::Restitution(part) if (0.0..=1.0).contains(&part) => {
                Ok((part * speed.value(), there * ((1.0 - part) * (1.0 + part))))
            }
            Rule::Restitution(part) => Err(Error::invalid(
                "coefficient",
                format!("expected a number from 0 to 1, got {}", number(part)),
            )),
            Rule::Released(released) if half.high() == 0.0 && released >= 0.0 => {
                Ok(((2.0 * released / reduced_mass(self.masses)).sqrt(), 0.0 - released))
            }
            Rule::Released(released) => {
                let taken = exponent(released);
                let part = scaled(DoubleDouble::from(scale(released, -taken)) / half, taken - unit);
                let left = (one + part).to_f64();
                if half.high() == 0.0 || left < -FORGIVEN {
                    return Err(Error::invalid(
                        "q_value",
                        format!(
                            "expected at least the threshold, {}, minus the energy of their relative motion, got {}",
                            number(0.0 - there),
                            number(released)
                        ),
                    ));
                }
                Ok((speed.value() * left.max(0.0).sqrt(), 0.0 - released))
            }
        }
    }
    /// The line of centres, from the second to the first, of spheres that touch at a distance of their centres and
    /// would miss each other by `impact`, of which the part along the relative velocity does not count.
    ///
    /// # Errors
    /// `InvalidInput` naming `impact` where they miss, `velocity1` where they do not move against each other.
    pub fn line_of_centers(&self, impact: Vector, distance: f64) -> Result<Vector> {
        let (ahead, _) = normalized(self.relative()).ok_or_else(|| {
            Error::invalid("velocity1", "expected another velocity than velocity2: they do not meet")
        })?;
        let unit = exponent(distance);
        let impact = impact.map(|part| scale(part, -unit));
        let (distance, along) = (scale(distance, -unit), dot(impact, ahead));
        let across: Vector = core::array::from_fn(|c| impact[c] - along * ahead[c]);
        let miss = dot(across, across).sqrt();
        if miss > distance {
            return Err(Error::invalid(
                "impact",
                format!(
                    "expected an impact parameter up to the distance of the centers at contact, {}, got {}: they miss",
                    number(scale(distance, unit)),
                    number(scale(miss, unit))
                ),
            ));
        }
        let back = ((distance - miss) * (distance + miss)).sqrt();
        Ok(core::array::from_fn(|c| (across[c] - back * ahead[c]) / distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector> {
        [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]
    }
    fn pairs() -> impl Strategy<Value = Pair> {
        (-150.0..150.0f64, -12.0..12.0f64, vector(), vector()).prop_map(|(unit, ratio, v1, v2)| {
            let mass = 10.0_f64.powf(unit);
            Pair { masses: [mass, mass * 10.0_f64.powf(ratio)], velocities: [v1, v2] }
        })
    }

    proptest! {
        #[test]
        fn momentum_and_energy_are_accounted_for(pair in pairs(), n in vector(), rule in 0..3, part in 0.0..1.0f64) {
            prop_assume!(dot(n, n) > 1e-6 && dot(pair.relative(), n).abs() > 1e-3);
            let along = dot(pair.relative(), n) / dot(n, n).sqrt();
            let q = -0.5 * reduced_mass(pair.masses) * along * along * part;
            let (rule, geometry) = match rule {
                0 => (Rule::Restitution(part), Geometry::Normal(n)),
                1 => (Rule::Released(q), Geometry::Normal(n)),
                _ => (Rule::Released(-q), Geometry::Direction(n)),
            };
            let after = pair.collide(rule, geometry).unwrap();
            let [m1, m2] = pair.masses;
            for c in 0..3 {
                let (first, second) = (
                    m1 * (after.velocities[0][c] - pair.velocities[0][c]),
                    m2 * (after.velocities[1][c] - pair.velocities[1][c]),
                );
                // A velocity of order one is rounded by 2e-16, of which the heavier makes the most.
                prop_assert!((first - after.impulse[c]).abs() < 1e-15 * m1.max(after.impulse[c].abs() * 8.0));
                prop_assert!((second + after.impulse[c]).abs() < 1e-15 * m2.max(after.impulse[c].abs() * 8.0));
            }
            // In the frame of the centre of mass, ½μu²: what is lost of it is what is said to be.
            let u = Pair { velocities: after.velocities, ..pair }.relative();
            let kept = 0.5 * reduced_mass(pair.masses) * dot(u, u);
            let before = 0.5 * reduced_mass(pair.masses) * dot(pair.relative(), pair.relative());
            prop_assert!((before - kept - after.energy_loss).abs() < 1e-14 * before.max(kept));
        }
        #[test]
        fn there_and_back(pair in pairs()) {
            let (center, relative) = to_relative(pair.masses, pair.velocities);
            let back = from_relative(pair.masses, center, relative);
            for (one, other) in back.as_flattened().iter().zip(pair.velocities.as_flattened()) {
                prop_assert!((one - other).abs() < 8e-16);
            }
            prop_assert!(reduced_mass(pair.masses) <= pair.masses[0].min(pair.masses[1]));
        }
        #[test]
        fn spheres_touch_where_they_come_to(pair in pairs(), b in vector()) {
            prop_assume!(dot(pair.relative(), pair.relative()) > 1e-3);
            let normal = pair.line_of_centers(b, 2.0).unwrap();
            let (ahead, _) = normalized(pair.relative()).unwrap();
            prop_assert!((dot(normal, normal) - 1.0).abs() < 1e-15 && dot(normal, ahead) <= 0.0);
            let across: Vector = core::array::from_fn(|c| b[c] - dot(b, ahead) * ahead[c]);
            prop_assert!((dot(normal, across) * 2.0 - dot(across, across)).abs() < 1e-14);
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let pair = Pair { masses: [1.0, 3.0], velocities: [[1.0, 0.0, 0.0], [0.0; 3]] };
        let name = |rule, geometry| match pair.collide(rule, geometry) {
            Err(Error::InvalidInput { argument, .. }) => argument,
            other => format!("{other:?}"),
        };
        let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        assert_eq!(name(Rule::Restitution(1.5), Geometry::Normal(x)), "coefficient");
        assert_eq!(name(Rule::Restitution(0.5), Geometry::Normal([0.0; 3])), "normal");
        assert_eq!(name(Rule::Released(0.1), Geometry::Normal(y)), "normal");
        assert_eq!(name(Rule::Released(-0.376), Geometry::Normal(x)), "q_value");
        assert_eq!(name(Rule::Released(-0.1), Geometry::Normal(y)), "q_value");
        assert!(pair.line_of_centers([0.0, 1.1, 0.0], 1.0).is_err());
        // All of it: they stick.
        let stuck = pair.collide(Rule::Released(-0.375), Geometry::Direction(y)).unwrap();
        assert_eq!(stuck.velocities, [[0.25, 0.0, 0.0]; 2]);
    }
}
