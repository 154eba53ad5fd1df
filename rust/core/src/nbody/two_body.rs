//! Two bodies under mutual inverse-square attraction: center of mass and relative Kepler motion.
//!
//! The one idea: R = (m₁r₁ + m₂r₂)/M moves on a straight line, r = r₁ − r₂ is Kepler's problem with μ = G M, and
//! r₁ = R + (m₂/M) r, r₂ = R − (m₁/M) r. R, the shares and these sums are carried in double-double, so that neither
//! a mass ratio nor a far-off center of mass costs digits: what is left is the error of r, times each body's share.
//! Either mass may be zero (a test particle), not both.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.1.

use super::constants::scaled;
use super::kepler::KeplerOrbit;
use crate::error::{Error, Result};
use crate::numerics::double_double::{DoubleDouble, product, sum};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::{exponent, power_of_two, scale};
use crate::numerics::real::Real;
use crate::words::{number, numbers};
use nalgebra::Vector3;

/// Position and velocity.
pub type PositionVelocity = (Vector3<f64>, Vector3<f64>);

/// Position and velocity before they are rounded.
pub type ExactState = ([DoubleDouble; 3], [DoubleDouble; 3]);

/// Two bodies, ready to be asked for their states at any time.
#[derive(Clone, Debug)]
pub struct TwoBody {
    initial: [PositionVelocity; 2],
    /// R and its velocity.
    center: ExactState,
    /// The same if all sizes are moderate: the numbers of R and of its velocity, each with what it leaves out, and what
    /// they gain in a unit of time.
    moderate: Option<[[Lanes; 2]; 2]>,
    /// m₂/M and −m₁/M.
    shares: [DoubleDouble; 2],
    relative: KeplerOrbit,
}

/// Refuses a gravitational parameter beyond float64, naming both of its factors.
///
/// # Errors
/// By the name of the mass.
pub fn check_parameter(mu: f64, gravitational_constant: f64, mass: f64) -> Result<()> {
    if mu.is_finite() {
        return Ok(());
    }
    Err(Error::invalid(
        "mass",
        format!(
            "expected units in which G times the masses is within the range of float64, got G = {} and a mass of {}",
            number(gravitational_constant),
            number(mass)
        ),
    ))
}

impl TwoBody {
    /// From Newton's constant, two masses and two states at the epoch.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for negative, infinite or two zero masses, for numbers that are not finite or whose
    /// difference is not, and for two bodies at one place.
    pub fn new(gravitational_constant: f64, masses: [f64; 2], states: [PositionVelocity; 2]) -> Result<Self> {
        for mass in masses {
            if !(mass.is_finite() && mass >= 0.0) {
                return Err(Error::invalid(
                    "mass",
                    format!("expected a finite mass ≥ 0, got {}", number(mass)),
                ));
            }
        }
        if masses == [0.0, 0.0] {
            return Err(Error::invalid("mass", "expected at least one mass above 0, got 0.0 and 0.0"));
        }
        // In units of the greater mass, so that the sum cannot overflow.
        let unit = exponent(masses[0].max(masses[1]));
        let masses = masses.map(|mass| scale(mass, -unit));
        let total = DoubleDouble::sum(masses[0], masses[1]);
        let strong = exponent(gravitational_constant);
        let strength = DoubleDouble::from(scale(gravitational_constant, -strong)) * total;
        let mu = scale(strength.to_f64(), unit + strong);
        check_parameter(mu, gravitational_constant, scale(masses[0].max(masses[1]), unit))?;
        let [(r1, v1), (r2, v2)] = states;
        for (name, one, other) in [("position", r1, r2), ("velocity", v1, v2)] {
            let apart = one - other;
            let given = one.iter().chain(other.iter()).all(|component| component.is_finite());
            if given && !apart.iter().all(|component| component.is_finite()) {
                return Err(Error::invalid(
                    name,
                    format!(
                        "expected two bodies whose difference stays within the range of f64, got {} and {}",
                        numbers(one.as_slice()),
                        numbers(other.as_slice())
                    ),
                ));
            }
        }
        let relative = KeplerOrbit::new(mu, r1 - r2, v1 - v2)?;
        let shares = [DoubleDouble::from(masses[1]) / total, -(DoubleDouble::from(masses[0]) / total)];
        // From the heavier body, so that a massless companion leaves its straight line exact.
        let heavier = usize::from(masses[1] > masses[0]);
        let share = shares[heavier];
        let center = |values: [Vector3<f64>; 2]| {
            core::array::from_fn(|c| {
                // In a unit in which the products of a large way do not overflow.
                let unit = exponent(values[0][c]).max(exponent(values[1][c]));
                let [one, other] = [0, 1].map(|body: usize| scale(values[body][c], -unit));
                let from = if heavier == 0 { one } else { other };
                scaled(DoubleDouble::from(from) - share * DoubleDouble::sum(one, -other), unit)
            })
        };
        let center: ExactState = (center([r1, r2]), center([v1, v2]));
        let (r, v) = center;
        let moderate = r.iter().chain(&v).all(|x| is_moderate(x.to_f64()));
        let moderate = moderate.then(|| [in_lanes([r, v]), in_lanes([v, Default::default()])]);
        Ok(Self { initial: states, center, moderate, shares, relative })
    }

    /// The states of both bodies at the time `t` since the epoch; `t = 0` gives the input bits.
    pub fn states(&self, t: f64) -> [PositionVelocity; 2] {
        if t == 0.0 {
            return self.initial;
        }
        let rounded = |values: [DoubleDouble; 3]| Vector3::from(values.map(DoubleDouble::to_f64));
        self.unrounded(DoubleDouble::from(t))
            .map(|(position, velocity)| (rounded(position), rounded(velocity)))
    }

    /// The states of both bodies before rounding; `elapsed` is rounded only for the relative motion.
    pub fn unrounded(&self, elapsed: DoubleDouble) -> [ExactState; 2] {
        let (r, v) = self.relative.state(elapsed.to_f64());
        let (position, velocity) = &self.center;
        if let Some([center, rate]) = &self.moderate
            && is_moderate(elapsed.to_f64())
            && r.iter().chain(&v).all(|&x| is_moderate(x))
        {
            let relative = Lanes([r.x, r.y, r.z, v.x, v.y, v.z, 0.0, 0.0]);
            let bodies =
                Lanes::pass(Moved { center, rate, elapsed, shares: &self.shares, relative: &relative });
            return bodies.map(|[high, low]| {
                let number = |lane: usize| DoubleDouble::new(high.0[lane], low.0[lane]);
                ([0, 1, 2].map(number), [3, 4, 5].map(number))
            });
        }
        self.shares.map(|share| {
            (
                core::array::from_fn(|c| moved(position[c], velocity[c], elapsed, share, r[c])),
                core::array::from_fn(|c| moved(velocity[c], DoubleDouble::default(), elapsed, share, v[c])),
            )
        })
    }

    /// The relative motion r₁ − r₂.
    pub fn relative(&self) -> &KeplerOrbit {
        &self.relative
    }
}

/// Six numbers and what they leave out, in lanes.
fn in_lanes([a, b]: [[DoubleDouble; 3]; 2]) -> [Lanes; 2] {
    let part = |of: fn(DoubleDouble) -> f64| {
        let [[ax, ay, az], [bx, by, bz]] = [a, b].map(|numbers| numbers.map(of));
        Lanes([ax, ay, az, bx, by, bz, 0.0, 0.0])
    };
    [part(DoubleDouble::high), part(DoubleDouble::low)]
}

/// [`moved`] of all numbers of both bodies at once, where sizes are moderate.
struct Moved<'a> {
    center: &'a [Lanes; 2],
    rate: &'a [Lanes; 2],
    elapsed: DoubleDouble,
    shares: &'a [DoubleDouble; 2],
    relative: &'a Lanes,
}

impl Pass<Lanes> for Moved<'_> {
    type Output = [[Lanes; 2]; 2];
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> [[Lanes; 2]; 2] {
        let Self { center, rate, elapsed, shares, relative } = self;
        let elapsed = (V::splat(elapsed.high()), V::splat(elapsed.low()));
        let way = product((V::load(rate[0]), V::load(rate[1])), elapsed);
        let center = sum((V::load(center[0]), V::load(center[1])), way);
        let mut bodies = [[Lanes::zero(); 2]; 2];
        for body in 0..2 {
            let share = (V::splat(shares[body].high()), V::splat(shares[body].low()));
            let part = product(share, (V::load(*relative), V::zero()));
            let (high, low) = sum(center, part);
            bodies[body] = [high.store(), low.store()];
        }
        bodies
    }
}

/// p + v t + s r. Whatever the sizes, a sum that is a number comes out as one, and another as infinite.
fn moved(p: DoubleDouble, v: DoubleDouble, t: DoubleDouble, s: DoubleDouble, r: f64) -> DoubleDouble {
    let size = |x: f64| if x == 0.0 { LEAST } else { exponent(x) };
    let [p_size, v_size, t_size, r_size] = [p.to_f64(), v.to_f64(), t.to_f64(), r].map(size);
    if [p_size, v_size, t_size, r_size].iter().all(|size| (size.abs() < MODERATE) || *size == LEAST) {
        return (p + v * t) + s * DoubleDouble::from(r);
    }
    if !r.is_finite() && s.to_f64() != 0.0 {
        return DoubleDouble::from(r * s.to_f64());
    }
    let way_size = if v_size == LEAST || t_size == LEAST { LEAST } else { v_size + t_size };
    let r = if r.is_finite() { r } else { 0.0 };
    let unit = p_size.max(way_size).max(size(r)) + 2;
    let way = if way_size == LEAST {
        DoubleDouble::default()
    } else {
        scaled(scaled(v, -v_size) * scaled(t, -t_size), way_size - unit)
    };
    let sum = (scaled(p, -unit) + way) + s * DoubleDouble::from(scale(r, -unit));
    let high = scale(sum.high(), unit);
    DoubleDouble::new(high, if high.is_finite() { scale(sum.low(), unit) } else { 0.0 })
}

/// Whether it is 0 or within the moderate powers of two.
fn is_moderate(x: f64) -> bool {
    let size = x.abs();
    size == 0.0 || (size > power_of_two(-MODERATE) && size < power_of_two(MODERATE))
}

/// Powers of two within which no product of two numbers leaves the range, nor what it rounds away.
const MODERATE: i32 = 400;
/// The size of zero: below every other, and far enough from the end to be added to.
const LEAST: i32 = -100_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_numbers_at_once_have_the_bits_of_one_by_one() {
        let states = [
            (Vector3::new(1.0, -2.0, 0.0), Vector3::new(0.3, -0.0, 0.1)),
            (Vector3::new(-4.0, 0.5, 0.0), Vector3::new(0.0, -0.0, -0.7)),
        ];
        for masses in [[1.0, 3.0], [0.0, 2.0], [1e-3, 1.0]] {
            let moderate = TwoBody::new(1.0, masses, states).unwrap();
            assert!(moderate.moderate.is_some());
            let apart = TwoBody { moderate: None, ..moderate.clone() };
            for t in [-1e5, -3.0, 0.1, 7.7, 1e9] {
                let bits = |of: &TwoBody| {
                    let bits = |x: DoubleDouble| (x.high().to_bits(), x.low().to_bits());
                    of.unrounded(DoubleDouble::sum(t, 1e-20)).map(|(x, v)| [x, v].map(|x| x.map(bits)))
                };
                assert_eq!(bits(&moderate), bits(&apart), "{masses:?} at {t}");
            }
        }
    }
}
