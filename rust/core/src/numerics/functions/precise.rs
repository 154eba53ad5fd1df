//! The same functions of double-doubles, to about thirty digits: where the difference of near values decides.
//!
//! The one idea: there is one exponential, one logarithm, and one sine with its cosine; the others follow by forms in which
//! nothing cancels, and inverse ones by a step of Newton from the digits of a float64. Outside the range of a function, or of
//! its numbers, they are no numbers or not finite.

use crate::numerics::angles;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::logarithm;
use crate::numerics::power::{Power, Powers};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;

/// π/2 in three parts: 159 bits.
const HALF_PI: [f64; 3] =
    [core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];
/// Quarter turns at most: beyond, too few of their bits are left.
const QUARTERS: f64 = (1_u32 << 26) as f64;
/// Terms of the series of sine and cosine: (π/4)³⁰/30! < 1e-35.
const TERMS: u32 = 15;
/// Below this, series; above, exponentials.
const SMALL: f64 = 0.5;
/// Beyond this tanh is one, to all digits.
const FAR: f64 = 40.0;

fn one() -> DoubleDouble {
    DoubleDouble::one()
}
fn ln_1p(x: DoubleDouble) -> DoubleDouble {
    logarithm::ln_1p(Scaled::new(x, 0)).to_double_double()
}
fn exp(x: DoubleDouble) -> DoubleDouble {
    Exponential::exp(x)
}
/// The function of the size, with the sign of the argument.
fn odd(x: DoubleDouble, of_size: impl Fn(DoubleDouble) -> DoubleDouble) -> DoubleDouble {
    if x.high() < 0.0 { -of_size(-x) } else { of_size(x) }
}

/// Σ (±z)ᵏ/(2k + first)!·first!: what is left of a sine after x (`first` = 1), or the cosine (0).
fn series(z: DoubleDouble, first: u32) -> DoubleDouble {
    let mut sum = one();
    for k in (1..=TERMS).rev() {
        let below = (2 * k + first) * (2 * k + first - 1);
        sum = one() + sum * z / DoubleDouble::from(f64::from(below));
    }
    sum
}

/// (sin x, cos x).
pub fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let quarters = (x.high() * core::f64::consts::FRAC_2_PI).round();
    if quarters.is_nan() || quarters.abs() > QUARTERS {
        let none = DoubleDouble::from(f64::NAN);
        return (none, none);
    }
    let rest = HALF_PI.iter().fold(x, |rest, part| rest - DoubleDouble::product(quarters, *part));
    let z = -(rest * rest);
    let (sine, cosine) = (rest * series(z, 1), series(z, 0));
    match (quarters as i64).rem_euclid(4) {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// ln x of x > 0.
pub fn ln(x: DoubleDouble) -> DoubleDouble {
    if !(x.high() > 0.0 && x.high() < f64::INFINITY) {
        DoubleDouble::from(f64::NAN)
    } else if (x.high() - 1.0).abs() < SMALL {
        ln_1p(x - one())
    } else {
        logarithm::ln(Scaled::new(x, 0)).to_double_double()
    }
}

/// (sinh x, cosh x).
pub fn sinh_cosh(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let grown = exp(x);
    let fallen = one() / grown;
    let sinh = if x.high().abs() < SMALL { x * series(x * x, 1) } else { (grown - fallen).scale(0.5) };
    (sinh, (grown + fallen).scale(0.5))
}

/// tanh x.
pub fn tanh(x: DoubleDouble) -> DoubleDouble {
    if x.high().abs() < SMALL {
        let (sinh, cosh) = sinh_cosh(x);
        return sinh / cosh;
    }
    odd(x, |x| {
        let fallen = exp(-x.min(DoubleDouble::from(FAR)).scale(2.0));
        (one() - fallen) / (one() + fallen)
    })
}

/// 1/cosh² x.
pub fn sech_squared(x: DoubleDouble) -> DoubleDouble {
    let fallen = exp(-x.abs().scale(2.0));
    let grown = one() + fallen;
    fallen.scale(4.0) / (grown * grown)
}

/// The angle of the point (x, y) from the positive x-axis.
pub fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let near = DoubleDouble::from(angles::atan2(y.high(), x.high()));
    let (sine, cosine) = sin_cos(near);
    // The tangent of what is left, about 1e-16.
    near + (y * cosine - x * sine) / (x * cosine + y * sine)
}

/// asin x, and acos x.
pub fn asin_acos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let leg = ((one() - x) * (one() + x)).sqrt();
    (atan2(x, leg), atan2(leg, x))
}

/// asinh x.
pub fn asinh(x: DoubleDouble) -> DoubleDouble {
    odd(x, |x| {
        let square = x * x;
        ln_1p(x + square / (one() + (one() + square).sqrt()))
    })
}

/// acosh x of x ≥ 1.
pub fn acosh(x: DoubleDouble) -> DoubleDouble {
    let above = x - one();
    ln_1p(above + (above * (above + DoubleDouble::from(2.0))).sqrt())
}

/// atanh x of |x| < 1.
pub fn atanh(x: DoubleDouble) -> DoubleDouble {
    odd(x, |x| ln_1p(x.scale(2.0) / (one() - x)).scale(0.5))
}

/// A constant power of x > 0.
pub fn power(x: DoubleDouble, exponent: f64) -> DoubleDouble {
    x.power(&Power::new(exponent))
}
