//! Kepler's problem r̈ = −μ r/|r|³ in closed form: every conic, both signs of μ, any time.
//!
//! The one idea: an orbit is prepared once, in double-double, from inputs taken as exact numbers; a time then costs
//! one reduction modulo the period (106 bits) and one solution of Kepler's equation in `f64`. Errors stay at a
//! few ulps of |r| and |v| however far away the time is; the digits that the *rounding of the inputs* cost
//! (relative phase 1.5·2π·N·ulp after N periods, and dx/dt·ulp(t)) are the caller's, none are added here.
//! Where |v| is much smaller than at the epoch (a turning point of radial motion just after it), its error is a few
//! ulps of the velocity at the epoch instead.
//!
//! Radial motion (r×v = 0): the orbit is the limit e → 1 of the conic, so an attracted body falls to the center
//! and returns on the side it came from. At the very instant of the collision the state is r = 0 and v = 0, the
//! mean of the opposite infinite velocities before and after. μ = 0, or |μ| below 2⁻³⁰⁰ r v², is a straight line.

use super::conic::Conic;
use super::kepler_equation::{Anchor, solve};
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, power_of_two, scale};
use crate::words::{number, numbers};
use nalgebra::Vector3;

/// Beyond this many dynamical times a hyperbola is its asymptote.
const FAR: f64 = 2.582_249_878_086_908_6e120; // 2^400
/// Beyond this many, what is not there yet is beyond `f64` in these units.
const FARTHEST: i32 = 900;

/// An orbit about a fixed center, ready to be asked for its state at any time.
///
/// ```
/// use nalgebra::Vector3;
/// use visviva_core::nbody::kepler::KeplerOrbit;
/// let orbit = KeplerOrbit::new(1.0, Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0))?;
/// let (position, _) = orbit.state(core::f64::consts::FRAC_PI_2);
/// assert!((position - Vector3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
/// # Ok::<(), visviva_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct KeplerOrbit {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    /// Exponents of the internal units of length and velocity.
    pub(super) length: i32,
    pub(super) speed: i32,
    scaled: Scaled,
    pub(super) conic: Option<Conic>,
}

/// The epoch in internal units, and how far from it the series about the epoch is used.
#[derive(Clone, Debug)]
struct Scaled {
    mu: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    beta: f64,
    anchor: Anchor,
    near: f64,
}

impl KeplerOrbit {
    /// The orbit with the given state at the epoch.
    ///
    /// `mu` is positive for attraction (G·M), negative for repulsion, zero for none.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] if an argument is not finite, or `position` is zero.
    pub fn new(mu: f64, position: Vector3<f64>, velocity: Vector3<f64>) -> Result<Self> {
        if !mu.is_finite() {
            return Err(Error::invalid("mu", format!("expected a finite number, got {}", number(mu))));
        }
        for (name, vector) in [("position", &position), ("velocity", &velocity)] {
            if !vector.iter().all(|component| component.is_finite()) {
                return Err(Error::invalid(
                    name,
                    format!("expected three finite numbers, got {}", numbers(vector.as_slice())),
                ));
            }
        }
        let size = position.amax();
        if size == 0.0 {
            return Err(Error::invalid(
                "position",
                "expected a point away from the center of force, got the center itself, where the force has no value",
            ));
        }
        let length = exponent(size);
        let field = exponent(mu) - length;
        let speed = match (velocity.amax() > 0.0, mu != 0.0) {
            (true, true) => exponent(velocity.amax()).max(field.div_euclid(2)),
            (true, false) => exponent(velocity.amax()),
            (false, true) => field.div_euclid(2),
            (false, false) => 0,
        };
        let mu_scaled = scale(mu, -length - 2 * speed);
        let r = position.map(|component| scale(component, -length));
        let v = velocity.map(|component| scale(component, -speed));
        let conic = (mu_scaled.abs() > power_of_two(-300)).then(|| Conic::new(mu_scaled, &r, &v));
        let distance = r.norm();
        let beta = conic.as_ref().map_or(0.0, |conic| conic.beta.to_f64());
        // |μ|/r³ + v²/r² bounds how fast anything changes near the epoch.
        let rate = ((mu_scaled.abs() / distance + v.norm_squared()) / (distance * distance)).sqrt();
        let scaled = Scaled {
            mu: mu_scaled,
            position: r,
            velocity: v,
            beta,
            anchor: Anchor { r: distance, eta: r.dot(&v), zeta: mu_scaled - beta * distance },
            near: 1.0 / (256.0 * rate),
        };
        Ok(Self { position, velocity, length, speed, scaled, conic })
    }

    /// Position and velocity at the time `t` since the epoch, to a few ulps of |r| and |v|.
    ///
    /// `t = 0` gives the input bits. A result beyond the range of `f64` is infinite; an infinite or NaN `t` gives NaN.
    pub fn state(&self, t: f64) -> (Vector3<f64>, Vector3<f64>) {
        if t == 0.0 {
            return (self.position, self.velocity);
        }
        if !t.is_finite() {
            return (Vector3::repeat(f64::NAN), Vector3::repeat(f64::NAN));
        }
        let Some(conic) = &self.conic else {
            return (straight(&self.position, &self.velocity, t), self.velocity);
        };
        let beyond = exponent(t) + self.speed - self.length - FARTHEST;
        if beyond > 0 && conic.period.is_none() {
            return self.far_off(conic, t, beyond);
        }
        // An ellipse's phase has lost its meaning long before 2^960 dynamical times.
        let limit = power_of_two(960);
        let time = scale(t, self.speed - self.length).clamp(-limit, limit);
        let (position, velocity) = if time.abs() <= self.scaled.near {
            self.scaled.near_epoch(time)
        } else if conic.beta.to_f64() < 0.0 && time.abs() > FAR {
            let (position, velocity) = conic.state(FAR.copysign(time));
            (position + velocity * (time - FAR.copysign(time)), velocity)
        } else {
            conic.state(time)
        };
        self.in_users_units(position, velocity, 0, 0)
    }

    /// Times 2^length and 2^speed, and those of the orbit.
    fn in_users_units(
        &self,
        position: Vector3<f64>,
        velocity: Vector3<f64>,
        length: i32,
        speed: i32,
    ) -> (Vector3<f64>, Vector3<f64>) {
        (
            position.map(|component| scale(component, self.length + length)),
            velocity.map(|component| scale(component, self.speed + speed)),
        )
    }

    /// An open orbit at the time `t`, of more than 2^(900 + `beyond`) dynamical times.
    fn far_off(&self, conic: &Conic, t: f64, beyond: i32) -> (Vector3<f64>, Vector3<f64>) {
        // Thrice a whole number of powers of two below the limit.
        let third = (beyond + 2) / 3;
        let time = scale(scale(t, -exponent(t)), exponent(t) + self.speed - self.length - 3 * third);
        if conic.beta.to_f64() < 0.0 {
            // Where it was at the epoch is nothing beside v t.
            let (_, velocity) = conic.state(FAR.copysign(t));
            return self.in_users_units(velocity * time, velocity, 3 * third, 0);
        }
        // Late on a parabola all is similar: eight times as late is four times as far and half as fast.
        let (position, velocity) = conic.state(time);
        self.in_users_units(position, velocity, 2 * third, -third)
    }

    /// The period; infinite for an unbound orbit.
    pub fn period(&self) -> f64 {
        match self.conic.as_ref().and_then(|conic| conic.period) {
            Some(period) => scale(period.to_f64(), self.length - self.speed),
            None => f64::INFINITY,
        }
    }
}

impl Scaled {
    /// r = r₀ + (f − 1) r₀ + g v₀ and its derivative: what is added is below 1/256 of what is there.
    fn near_epoch(&self, time: f64) -> (Vector3<f64>, Vector3<f64>) {
        let Anchor { r, eta, zeta } = self.anchor;
        let size = time.abs();
        let anchor = Anchor { r, eta: if time < 0.0 { -eta } else { eta }, zeta };
        let first = size / r;
        let guess = first * (1.0 - 0.5 * anchor.eta * first / r);
        let reached = solve(anchor, self.beta, (size, 0.0), guess, 2.0 * first);
        let functions = reached.functions;
        let g1 = functions.g1.copysign(time);
        let f_less_one = -self.mu * functions.g2 / r;
        let g = time - self.mu * functions.g3.copysign(time);
        let f_rate = -self.mu * g1 / (r * reached.r);
        let g_rate_less_one = -self.mu * functions.g2 / reached.r;
        (
            self.position + (self.position * f_less_one + self.velocity * g),
            self.velocity + (self.position * f_rate + self.velocity * g_rate_less_one),
        )
    }
}

/// r + v t with one rounding of each component, in powers of two in which nothing overflows that the sum does not.
fn straight(position: &Vector3<f64>, velocity: &Vector3<f64>, time: f64) -> Vector3<f64> {
    position.zip_map(velocity, |r, v| {
        if v == 0.0 {
            return r;
        }
        let (fast, long) = (exponent(v), exponent(time));
        let moved = DoubleDouble::product(scale(v, -fast), scale(time, -long));
        let unit = if r == 0.0 { fast + long } else { exponent(r).max(fast + long) };
        let part = |x: f64| scale(x, fast + long - unit);
        let sum =
            DoubleDouble::new(part(moved.high()), part(moved.low())) + DoubleDouble::from(scale(r, -unit));
        scale(sum.to_f64(), unit)
    })
}

/// Position and velocity at each of `times` since the epoch.
///
/// # Errors
/// [`Error::InvalidInput`] if an argument is not finite, or `position` is zero.
pub fn propagate(
    mu: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    times: &[f64],
) -> Result<Vec<(Vector3<f64>, Vector3<f64>)>> {
    let orbit = KeplerOrbit::new(mu, position, velocity)?;
    if let Some(bad) = times.iter().find(|time| !time.is_finite()) {
        return Err(Error::invalid("times", format!("expected finite numbers, got {}", number(*bad))));
    }
    Ok(times.iter().map(|&time| orbit.state(time)).collect())
}
