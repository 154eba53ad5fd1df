//! Deflections that are known in closed form: Coulomb, hard sphere, square well, and ±C/r², ±C/r⁴.
//!
//! Sources: Landau & Lifshitz, *Mechanics*, §§18–19; for C/r⁴ J. C. Maxwell, Phil. Trans. R. Soc. 157 (1867) 49, with
//! c = C/(E r₀⁴): ψ = π(1 − √(1 − c)/M(1, √(1 + c))), M the arithmetic-geometric mean.

use super::pairs::NEAR_ORBITING;
use super::{Deflection, Edge, Status};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::arithmetic_geometric_mean;
use crate::numerics::real::Real;
use crate::potentials::Potential;
use crate::scattering::rutherford;
use core::f64::consts::{PI, SQRT_2};

/// A potential with such a form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Closed {
    /// k/r.
    Coulomb(f64),
    /// C/r².
    InverseSquare(f64),
    /// C/r⁴: its angle only.
    InverseFourth(f64),
    HardSphere(f64),
    /// Depth and radius.
    SquareWell(f64, f64),
}

impl Closed {
    pub(super) fn of(potential: &dyn Potential) -> Option<Self> {
        let number = |at: usize| potential.parameters().get(at).map_or(f64::NAN, |value| value.number());
        match potential.declaration().name {
            "coulomb" => Some(Self::Coulomb(number(0))),
            "hard_sphere" => Some(Self::HardSphere(number(0))),
            "square_well" => Some(Self::SquareWell(number(0), number(1))),
            "power_law" if number(1) == 1.0 => Some(Self::Coulomb(number(0))),
            "power_law" if number(1) == 2.0 => Some(Self::InverseSquare(number(0))),
            "power_law" if number(1) == 4.0 => Some(Self::InverseFourth(number(0))),
            _ => None,
        }
    }
    /// Where it is not smooth.
    pub(super) fn edges(self, energy: f64) -> Vec<Edge> {
        let rim = |b: f64| Edge { impact_parameter: b, orbit: None, captures: false };
        match self {
            Self::InverseSquare(c) if c < 0.0 => {
                vec![Edge { impact_parameter: (-c / energy).sqrt(), orbit: Some(0.0), captures: true }]
            }
            Self::HardSphere(radius) => vec![rim(radius)],
            Self::SquareWell(depth, radius) => {
                let square = 1.0 + depth / energy;
                let total = (square > 0.0 && square < 1.0).then(|| rim(square.sqrt() * radius));
                total.into_iter().chain([rim(radius)]).collect()
            }
            _ => Vec::new(),
        }
    }
    /// Where |V| is the energy, or where V ends.
    pub(super) fn length(self, energy: f64) -> f64 {
        match self {
            Self::Coulomb(k) => rutherford::half_distance(k, energy).abs(),
            Self::InverseSquare(c) => (c / energy).abs().sqrt(),
            Self::InverseFourth(c) => (c / energy).abs().sqrt().sqrt(),
            Self::HardSphere(radius) | Self::SquareWell(_, radius) => radius,
        }
    }
    /// Beyond which there is no deflection.
    pub(super) fn range(self) -> f64 {
        match self {
            Self::HardSphere(radius) | Self::SquareWell(_, radius) => radius,
            _ => f64::INFINITY,
        }
    }
    /// C/E where it attracts as 1/r², so that without an end ever more turns lead to an angle: b² = C/E (1 + x)²/(x(2 + x)),
    /// x = |ψ|/π.
    pub(super) fn winds(self, energy: f64) -> Option<f64> {
        match self {
            Self::InverseSquare(c) if c < 0.0 => Some(-c / energy),
            _ => None,
        }
    }
    /// Whether nothing but the angle is known.
    pub(super) fn angle_only(self) -> bool {
        matches!(self, Self::InverseFourth(_))
    }
    /// The deflection of one pair.
    pub(super) fn deflection(self, energy: f64, b: f64) -> Deflection {
        let known = match self {
            Self::Coulomb(k) => coulomb(k, energy, b),
            Self::InverseSquare(c) => inverse_square(c / energy, b),
            Self::InverseFourth(c) => inverse_fourth(c / energy, b),
            Self::HardSphere(radius) => sphere(radius, b),
            Self::SquareWell(depth, radius) => square_well(depth / energy, radius, b),
        };
        // A few roundings each.
        Deflection { error: 4.0 * f64::EPSILON * known.angle.abs(), ..known }
    }
}

fn coulomb(k: f64, energy: f64, b: f64) -> Deflection {
    let half = rutherford::half_distance(k, energy);
    let angle = rutherford::deflection(half, b);
    if k == 0.0 {
        return free(b);
    }
    Deflection {
        angle,
        complement: 2.0 * atan2(b, half.abs()),
        closest_approach: rutherford::closest_approach(half, b),
        derivative: -2.0 / (half + b * (b / half)),
        // What repels is passed more slowly, all the way out.
        delay: if k > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY },
        error: 0.0,
        turning_points: 1,
        status: Status::Scattered,
    }
}

fn free(b: f64) -> Deflection {
    Deflection {
        angle: 0.0,
        complement: PI,
        closest_approach: b,
        derivative: 0.0,
        delay: 0.0,
        error: 0.0,
        turning_points: 1,
        status: Status::Scattered,
    }
}

fn inverse_square(c: f64, b: f64) -> Deflection {
    let square = b.mul_add(b, c);
    if c == 0.0 {
        return free(b);
    }
    if square <= 0.0 {
        return Deflection::captured();
    }
    let nearest = square.sqrt();
    let short = PI * (b / nearest);
    // Head-on, where V repels, it is π to the last digit.
    let angle = if c > 0.0 && short < 1.0 { PI - short } else { PI * (c / (nearest * (nearest + b))) };
    Deflection {
        angle,
        complement: if c > 0.0 { short } else { PI - angle.abs() },
        closest_approach: nearest,
        derivative: -PI * (c / (square * nearest)),
        delay: 0.0,
        error: 0.0,
        turning_points: 1,
        status: if c < 0.0 { beside((-c).sqrt(), b) } else { Status::Scattered },
    }
}

fn inverse_fourth(c: f64, b: f64) -> Deflection {
    if c == 0.0 {
        return free(b);
    }
    let of = DoubleDouble::from;
    // In the unit |C/E|^(1/4), in which the fourth power of b is 4 where orbits begin.
    let unit = c.abs().sqrt().sqrt();
    let square = of(b / unit) * of(b / unit);
    let sign = if c > 0.0 { 1.0 } else { -1.0 };
    let under = square * square + of(4.0 * sign);
    if under.high() < 0.0 || (b == 0.0 && c < 0.0) {
        return Deflection::captured();
    }
    let nearest = (square + under.sqrt()).scale(0.5);
    let c = of(sign) / (nearest * nearest);
    let mean = arithmetic_geometric_mean(of(1.0), (of(1.0) + c).sqrt());
    let ratio = (square / nearest).sqrt() / mean;
    let small = c.high().abs() < 1e-14;
    let angle = if small { 0.75 * PI * c.high() } else { (DoubleDouble::PI * (of(1.0) - ratio)).high() };
    let complement = if c.high() > 0.0 { (DoubleDouble::PI * ratio).high() } else { PI - angle.abs() };
    let closest_approach = unit * nearest.high().sqrt();
    Deflection {
        angle,
        complement,
        closest_approach,
        derivative: f64::NAN,
        delay: f64::NAN,
        error: 0.0,
        // What attracts has one on the other side of the barrier.
        turning_points: if sign < 0.0 { 2 } else { 1 },
        status: if sign < 0.0 { beside(SQRT_2 * unit, b) } else { Status::Scattered },
    }
}

/// Of what left, at an impact parameter beside the one at which it would stay.
fn beside(orbiting: f64, b: f64) -> Status {
    if (orbiting / b - 1.0).abs() < NEAR_ORBITING { Status::NearOrbiting } else { Status::Scattered }
}

fn sphere(radius: f64, b: f64) -> Deflection {
    if b >= radius {
        return free(b);
    }
    let across = ((radius - b) * (radius + b)).sqrt();
    Deflection {
        angle: 2.0 * atan2(across, b),
        complement: 2.0 * atan2(b, across),
        closest_approach: radius,
        derivative: -2.0 / across,
        delay: -2.0 * across,
        error: 0.0,
        turning_points: 1,
        status: Status::Scattered,
    }
}

/// Down to this share what is left of the speed across is the difference of squares, not of a sum.
const WEAK: f64 = -0.5;

/// `share` is depth over energy; the speed within is √(1 + share) times that without.
fn square_well(share: f64, radius: f64, b: f64) -> Deflection {
    let square = 1.0 + share;
    if b >= radius || share == 0.0 {
        // Behind its rim a well holds what could not leave it: from b/√square to the rim.
        let within = share > 0.0 && b < square.sqrt() * radius;
        return Deflection { turning_points: if within { 3 } else { 1 }, ..free(b) };
    }
    if square <= 0.0 || b >= square.sqrt() * radius {
        return sphere(radius, b);
    }
    let (s, speed) = (b / radius, square.sqrt());
    // cos of asin s, and speed times that of asin(s/speed): of differences that the rounding of s leaves alone, as at the
    // rim of a weak well both vanish.
    let along = ((radius - b) * (radius + b)).sqrt() / radius;
    let within =
        if share > WEAK { along.mul_add(along, share).sqrt() } else { ((speed - s) * (speed + s)).sqrt() };
    let sum = within + along;
    // asin s − asin(s/speed), by its sine and cosine times the speed.
    let angle = -2.0 * atan2(s * (share / sum), along.mul_add(within, s * s));
    Deflection {
        angle,
        complement: PI - angle.abs(),
        closest_approach: b / speed,
        derivative: -2.0 / radius * (share / (along * within * sum)),
        delay: 2.0 * radius * (share / square) * (1.0 / sum - along),
        error: 0.0,
        turning_points: 1,
        status: Status::Scattered,
    }
}
