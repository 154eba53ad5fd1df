//! One conic about a center, anchored at its pericenter (and apocenter), made in double-double.
//!
//! The one idea: counted from an apsis, Kepler's equation is a sum of terms of one sign, so `f64` loses nothing.
//! Everything that relates the given state to the apsis is found once, to about 31 digits, from the inputs taken
//! as exact numbers. Attraction, repulsion, every eccentricity and L = 0 are the same formulas.

use super::kepler_equation::{Reached, after_apocenter, after_pericenter};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::ln;
use crate::numerics::real::Real;
use crate::numerics::stumpff::UniversalFunctions;
use core::f64::consts::FRAC_PI_2;
use nalgebra::Vector3;

type Triple = [DoubleDouble; 3];

fn dot(a: &Triple, b: &Triple) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Each component to 106 bits of itself: the products are exact and the difference is accurate.
fn cross(a: &Triple, b: &Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn rounded(a: &Triple) -> Vector3<f64> {
    Vector3::new(a[0].to_f64(), a[1].to_f64(), a[2].to_f64())
}

/// The constants of one orbit with μ ≠ 0.
#[derive(Clone, Debug)]
pub(super) struct Conic {
    pub(super) mu: f64,
    /// 2μ/r − v², twice the binding energy per mass.
    pub(super) beta: DoubleDouble,
    /// |v×L − μr̂| = |μ| e.
    pub(super) zeta: DoubleDouble,
    pub(super) angular_momentum: DoubleDouble,
    /// The direction of L; zero if L = 0.
    pub(super) normal: Vector3<f64>,
    pub(super) pericenter: DoubleDouble,
    pub(super) apocenter: f64,
    /// Towards the pericenter.
    pub(super) towards: Vector3<f64>,
    /// Along the velocity there.
    pub(super) along: Vector3<f64>,
    /// The epoch's time since the pericenter, or since the apocenter of an ellipse if that is nearer in E.
    pub(super) since_apsis: DoubleDouble,
    pub(super) from_apocenter: bool,
    /// Period of an ellipse.
    pub(super) period: Option<DoubleDouble>,
    /// Time from the pericenter to eccentric anomaly π/2.
    quarter: f64,
    /// s and the true anomaly (cos, sin) of the epoch, s from the anchoring apsis.
    pub(super) epoch: DoubleDouble,
    pub(super) true_anomaly: (f64, f64),
}

impl Conic {
    /// From a state with r of order one, and max(v², |μ|/r) too.
    pub(super) fn new(mu: f64, position: &Vector3<f64>, velocity: &Vector3<f64>) -> Self {
        let zero = DoubleDouble::zero();
        let one = DoubleDouble::one();
        let r: Triple = [position.x.into(), position.y.into(), position.z.into()];
        let v: Triple = [velocity.x.into(), velocity.y.into(), velocity.z.into()];
        let strength = DoubleDouble::from(mu);
        let distance = dot(&r, &r).sqrt();
        let eta = dot(&r, &v);
        let normal = cross(&r, &v);
        let h2 = dot(&normal, &normal);
        let h = h2.sqrt();
        let beta = strength.scale(2.0) / distance - dot(&v, &v);
        // The Laplace–Runge–Lenz vector in the frame of r̂ and L̂×r̂: exactly in the plane, whatever e.
        let radial = h2 / distance - strength;
        let transverse = -(h * eta / distance);
        let mut zeta = (radial * radial + transverse * transverse).sqrt();
        let (mut cosine, mut sine) = (one, zero);
        if zeta.to_f64() > mu.abs() * 1e-27 {
            cosine = radial / zeta;
            sine = -(transverse / zeta);
        } else {
            zeta = zero; // a circle as far as 31 digits tell: any direction is the pericenter's
        }
        let out = r.map(|component| component / distance);
        let round = if h.to_f64() > 0.0 {
            cross(&normal, &r).map(|component| component / (h * distance))
        } else {
            [zero; 3]
        };
        let towards = [0, 1, 2].map(|i| cosine * out[i] - sine * round[i]);
        let along = [0, 1, 2].map(|i| sine * out[i] + cosine * round[i]);

        let pericenter = if mu > 0.0 { h2 / (strength + zeta) } else { (zeta - strength) / (-beta) };
        let bound = beta.to_f64() > 0.0;
        let apocenter = if bound { (strength + zeta) / beta } else { zero };
        let rate = beta.abs().sqrt();
        let period = bound.then(|| DoubleDouble::PI.scale(2.0) * strength / (beta * rate));

        // G₁ and G₀ of the epoch, counted from the pericenter: sin E and cos E.
        let (mut g1, mut g0) = if bound && zeta.to_f64() < 0.5 * mu {
            (distance * sine / h, (zeta + beta * distance * cosine) / strength)
        } else {
            (eta / zeta, (strength - beta * distance) / zeta)
        };
        let from_apocenter = bound && g0.to_f64() < 0.0;
        let (anchor_r, anchor_zeta) = if from_apocenter {
            g1 = -g1;
            g0 = -g0;
            (apocenter, -zeta)
        } else {
            (pericenter, zeta)
        };
        let (functions, s) = invert(beta, g1, g0);
        let since_apsis = anchor_r * s + anchor_zeta * functions.g3;

        let rate = rate.to_f64();
        let quarter =
            if bound { ((FRAC_PI_2 * mu - zeta.to_f64()) / beta.to_f64()) / rate } else { f64::INFINITY };
        Self {
            mu,
            beta,
            zeta,
            angular_momentum: h,
            normal: if h.to_f64() > 0.0 {
                rounded(&normal.map(|component| component / h))
            } else {
                Vector3::zeros()
            },
            pericenter,
            apocenter: apocenter.to_f64(),
            towards: rounded(&towards),
            along: rounded(&along),
            since_apsis,
            from_apocenter,
            period,
            quarter,
            epoch: s,
            true_anomaly: (cosine.to_f64(), sine.to_f64()),
        }
    }

    /// Position and velocity at a time since the epoch.
    pub(super) fn state(&self, time: f64) -> (Vector3<f64>, Vector3<f64>) {
        let mut since = self.since_apsis + DoubleDouble::from(time);
        let mut at_apocenter = false;
        if let Some(period) = self.period {
            // Each pass takes 52 bits off; the phase keeps its meaning up to 2^106 periods, its range always.
            for _ in 0..32 {
                let turns = (since.to_f64() / period.to_f64()).round();
                if turns == 0.0 {
                    break;
                }
                since -= period * DoubleDouble::from(turns);
            }
            let half = period.scale(0.5);
            let size = since.to_f64().abs();
            let limit = if self.from_apocenter { half.to_f64() - self.quarter } else { self.quarter };
            at_apocenter = self.from_apocenter;
            if size > limit {
                since = if since.to_f64() > 0.0 { since - half } else { since + half };
                at_apocenter = !at_apocenter;
            }
        }
        let backwards = since.to_f64() < 0.0;
        let (high, low) = since.abs().parts();
        let reached =
            if at_apocenter { self.after_apocenter(high, low) } else { self.after_pericenter(high, low) };
        self.place(&reached, at_apocenter, backwards)
    }

    fn place(&self, reached: &Reached, at_apocenter: bool, backwards: bool) -> (Vector3<f64>, Vector3<f64>) {
        let Reached { functions, r, .. } = reached;
        if *r == 0.0 {
            // The instant of a collision: the mean of the velocities just before and after.
            return (Vector3::zeros(), Vector3::zeros());
        }
        let (apsis, side) =
            if at_apocenter { (self.apocenter, -1.0) } else { (self.pericenter.to_f64(), 1.0) };
        let h = side * self.angular_momentum.to_f64();
        let g1 = if backwards { -functions.g1 } else { functions.g1 };
        let x = side * (apsis - self.mu * functions.g2);
        let y = h * g1;
        let v_x = -side * (self.mu * (g1 / r));
        let v_y = h * (functions.g0 / r);
        (self.towards * x + self.along * y, self.towards * v_x + self.along * v_y)
    }

    fn after_apocenter(&self, high: f64, low: f64) -> Reached {
        after_apocenter(self.apocenter, self.zeta.to_f64(), self.beta.to_f64(), (high, low))
    }

    fn after_pericenter(&self, high: f64, low: f64) -> Reached {
        let (r, zeta, beta) = (self.pericenter.to_f64(), self.zeta.to_f64(), self.beta.to_f64());
        after_pericenter(self.mu, r, zeta, beta, (high, low))
    }
}

/// The s with G₁(s) = g1 and G₀(s) = g0 ≥ 0, and the functions there.
fn invert(
    beta: DoubleDouble,
    g1: DoubleDouble,
    g0: DoubleDouble,
) -> (UniversalFunctions<DoubleDouble>, DoubleDouble) {
    let b = beta.to_f64();
    let (base, delta) = if g0.to_f64() <= 2.0 {
        // Half the angle: u = G₁/G₀ at σ = s/2. F(σ) = G₁ − u G₀ has F'' = −βF, so Newton's step is of third order.
        let u = g1 / (g0 + DoubleDouble::one());
        let tangent = u.to_f64();
        let mut sigma = tangent / (1.0 + 0.28 * b * tangent * tangent);
        for _ in 0..3 {
            let g = UniversalFunctions::<f64>::new(b, sigma);
            sigma -= (g.g1 - tangent * g.g0) / (g.g0 + b * tangent * g.g1);
        }
        let sigma = DoubleDouble::from(sigma);
        let g = UniversalFunctions::<DoubleDouble>::new(beta, sigma);
        let delta = -((g.g1 - u * g.g0) / (g.g0 + beta * u * g.g1));
        ((g.doubled(), sigma.scale(2.0)), delta.scale(2.0))
    } else {
        let rate = b.abs().sqrt();
        let sine = rate * g1.to_f64().abs();
        let s = (ln(sine + (sine * sine + 1.0).sqrt()) / rate).copysign(g1.to_f64());
        let s = DoubleDouble::from(s);
        let g = UniversalFunctions::<DoubleDouble>::new(beta, s);
        let residual = g.g1 - g1;
        let step = -(residual / g.g0);
        let delta = -(residual / (g.g0 - beta * g.g1 * step.scale(0.5)));
        ((g, s), delta)
    };
    let (g, s) = base;
    // Second order in a step of 1e-15: exact to 31 digits and more.
    let half = delta * delta.scale(0.5);
    let shifted = UniversalFunctions {
        g0: g.g0 - beta * (g.g1 * delta + g.g0 * half),
        g1: g.g1 + g.g0 * delta - beta * g.g1 * half,
        g2: g.g2 + g.g1 * delta + g.g0 * half,
        g3: g.g3 + g.g2 * delta + g.g1 * half,
    };
    (shifted, s + delta)
}
