//! Anomalies: true, eccentric, hyperbolic, parabolic, mean, and Kepler's equation between them.
//!
//! The one idea: E − e sin E is (1−e)E + e(E − sin E), the second term from its series, so that e → 1 loses nothing.
//! Angles use the library's own sine, cosine and arctangent: the same bits on every machine.
//! Source: Danby, *Fundamentals of Celestial Mechanics* (1988) §6.3–6.8.

use super::kepler_equation::{after_apocenter, after_pericenter};
use crate::error::{Error, Result};
use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::{Exponential, cbrt, ln};
use crate::numerics::stumpff::UniversalFunctions;
use crate::words::number;
use core::f64::consts::{FRAC_PI_2, LN_2, PI};

fn check(name: &str, value: f64, good: bool, expected: &str) -> Result<()> {
    if good {
        Ok(())
    } else {
        Err(Error::invalid(name, format!("expected {expected}, got {}", number(value))))
    }
}

/// M = E − e sin E.
pub fn mean_from_eccentric(eccentric: f64, eccentricity: f64) -> f64 {
    let g3 = UniversalFunctions::<f64>::new(1.0, eccentric).g3;
    (1.0 - eccentricity) * eccentric + eccentricity * g3
}

/// M = e sinh H − H; of the repulsive branch, e sinh H + H.
pub fn mean_from_hyperbolic(hyperbolic: f64, eccentricity: f64, repulsive: bool) -> f64 {
    if hyperbolic.abs() > 700.0 {
        // (e/2) eᴴ in two halves: eᴴ alone would overflow before M does.
        let half = Exponential::exp(0.5 * hyperbolic.abs());
        return ((0.5 * eccentricity * half) * half).copysign(hyperbolic);
    }
    let g3 = UniversalFunctions::<f64>::new(-1.0, hyperbolic).g3;
    let linear = if repulsive { eccentricity + 1.0 } else { eccentricity - 1.0 };
    linear * hyperbolic + eccentricity * g3
}

/// The E of M = E − e sin E, for 0 ≤ e ≤ 1; E is in the same turn as M.
///
/// # Errors
/// [`Error::InvalidInput`] for an e outside [0, 1] or an M that is not finite.
pub fn eccentric_anomaly(mean: f64, eccentricity: f64) -> Result<f64> {
    let e = eccentricity;
    check("eccentricity", e, (0.0..=1.0).contains(&e), "0 ≤ e ≤ 1")?;
    check("mean", mean, mean.abs() < 1e300, "an angle below 1e300 in size")?;
    let turn = DoubleDouble::PI.scale(2.0);
    let turns = (mean / (2.0 * PI)).round();
    let reduced = DoubleDouble::from(mean) - turn * DoubleDouble::from(turns);
    let backwards = reduced.to_f64() < 0.0;
    let size = if backwards { -reduced } else { reduced };
    let anomaly = if size.to_f64() <= FRAC_PI_2 - e {
        DoubleDouble::from(after_pericenter(1.0, 1.0 - e, e, 1.0, size.parts()).s)
    } else {
        let rest = DoubleDouble::PI - size;
        if rest.to_f64() > 0.0 {
            DoubleDouble::PI - DoubleDouble::from(after_apocenter(1.0 + e, e, 1.0, rest.parts()).s)
        } else {
            DoubleDouble::PI
        }
    };
    Ok((turn * DoubleDouble::from(turns) + if backwards { -anomaly } else { anomaly }).to_f64())
}

/// The H of M = e sinh H − H (e ≥ 1), or of M = e sinh H + H for the repulsive branch (e > 0).
///
/// # Errors
/// [`Error::InvalidInput`] for an e outside its range or an M that is not finite.
pub fn hyperbolic_anomaly(mean: f64, eccentricity: f64, repulsive: bool) -> Result<f64> {
    let e = eccentricity;
    let least = if repulsive { 0.0 } else { 1.0 };
    check("eccentricity", e, e.is_finite() && e >= least && e > 0.0, "a finite e ≥ 1 (repulsive: e > 0)")?;
    check("mean", mean, mean.is_finite(), "a finite number")?;
    let size = mean.abs();
    if size > 1e100 && size / e > 1e100 {
        // e sinh H alone: eᴴ/2 to a hundred digits, H itself to as many.
        let ratio = size / e;
        let logarithm = if ratio.is_finite() { ln(ratio) } else { ln(size) - ln(e) };
        return Ok((logarithm + LN_2).copysign(mean));
    }
    let (mu, r) = if repulsive { (-1.0, e + 1.0) } else { (1.0, e - 1.0) };
    Ok(after_pericenter(mu, r, e, -1.0, (size, 0.0)).s.copysign(mean))
}

/// The D = tan(ν/2) of Barker's equation D + D³/3 = M, with M = √(μ/(2q³)) t.
pub fn parabolic_anomaly(mean: f64) -> f64 {
    // D³ + 3D = 3M by Cardano, without the cancellation.
    let k = 1.5 * mean.abs();
    // Beyond 1e9 the one is nothing beside k², which might overflow.
    let w = if k > 1e9 { cbrt(2.0 * k) } else { cbrt(k + (k * k + 1.0).sqrt()) };
    let inverse = 1.0 / w;
    (2.0 * k / (w * w + 1.0 + inverse * inverse)).copysign(mean)
}

/// M = D + D³/3.
pub fn mean_from_parabolic(parabolic: f64) -> f64 {
    parabolic + parabolic * (parabolic * parabolic) / 3.0
}

/// ν = 2 arctan D.
pub fn true_from_parabolic(parabolic: f64) -> f64 {
    2.0 * atan2(parabolic, 1.0)
}

/// D = tan(ν/2), of |ν| < π.
pub fn parabolic_from_true(true_anomaly: f64) -> f64 {
    let (sine, cosine) = sin_cos(0.5 * true_anomaly);
    sine / cosine
}

/// The true anomaly ν of E, in the same half turns; tan(ν/2) = √((1+e)/(1−e)) tan(E/2).
pub fn true_from_eccentric(eccentric: f64, eccentricity: f64) -> f64 {
    let turns = (eccentric / (2.0 * PI)).round();
    let (sine, cosine) = sin_cos(0.5 * eccentric);
    let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
    let half = atan2(sign * (1.0 + eccentricity).sqrt() * sine, sign * (1.0 - eccentricity).sqrt() * cosine);
    2.0 * half + turns * (2.0 * PI)
}

/// The eccentric anomaly E of ν: the inverse of [`true_from_eccentric`].
pub fn eccentric_from_true(true_anomaly: f64, eccentricity: f64) -> f64 {
    true_from_eccentric(true_anomaly, -eccentricity)
}

/// The true anomaly of H: tan(ν/2) = √((e+1)/(e−1)) tanh(H/2), with e → −e for repulsion.
pub fn true_from_hyperbolic(hyperbolic: f64, eccentricity: f64, repulsive: bool) -> f64 {
    // tanh 40 is 1 to 34 digits; beyond, sinh and cosh would overflow.
    let g = UniversalFunctions::<f64>::new(-1.0, 0.5 * hyperbolic.clamp(-80.0, 80.0));
    let (above, below) = ((eccentricity + 1.0).sqrt(), (eccentricity - 1.0).sqrt());
    let (y, x) = if repulsive { (below, above) } else { (above, below) };
    2.0 * atan2(y * g.g1, x * g.g0)
}

/// The hyperbolic anomaly of ν: the inverse of [`true_from_hyperbolic`]; infinite beyond the asymptote.
pub fn hyperbolic_from_true(true_anomaly: f64, eccentricity: f64, repulsive: bool) -> f64 {
    let (sine, cosine) = sin_cos(0.5 * true_anomaly);
    let (above, below) = ((eccentricity + 1.0).sqrt(), (eccentricity - 1.0).sqrt());
    let (y, x) = if repulsive { (above * sine, below * cosine) } else { (below * sine, above * cosine) };
    if y.abs() >= x {
        return f64::INFINITY.copysign(true_anomaly);
    }
    // 2 artanh(y/x) = ln(1 + w).
    let w = 2.0 * y.abs() / (x - y.abs());
    let grown = 1.0 + w;
    // ln(1 + w) without losing what 1 + w rounds away (Kahan's quotient).
    let logarithm = if grown == 1.0 { w } else { ln(grown) * (w / (grown - 1.0)) };
    logarithm.copysign(true_anomaly)
}

/// A conversion between anomalies by its name, `to_from_from`, with its arguments checked.
///
/// # Errors
/// [`Error::InvalidInput`] for an unknown name, a number that is not finite, an eccentricity outside the range of the
/// conic, and a true anomaly on or beyond an asymptote.
pub fn convert(name: &str, anomaly: f64, eccentricity: f64, repulsive: bool) -> Result<f64> {
    let (to, from) = name.split_once("_from_").unwrap_or((name, ""));
    let (argument, conic) = (
        if from == "true" { "true_anomaly" } else { from },
        if from == "mean" || from == "true" { to } else { from },
    );
    let e = eccentricity;
    check(argument, anomaly, anomaly.abs() < 1e300, "a number below 1e300 in size")?;
    match conic {
        "eccentric" => check("eccentricity", e, (0.0..1.0).contains(&e), "0 ≤ e < 1, as ellipses have")?,
        "hyperbolic" => {
            check("eccentricity", e, e.is_finite() && e > 1.0, "a finite e > 1, as hyperbolas have")?
        }
        _ => {}
    }
    match name {
        "mean_from_eccentric" => Ok(mean_from_eccentric(anomaly, e)),
        "mean_from_hyperbolic" => Ok(mean_from_hyperbolic(anomaly, e, repulsive)),
        "mean_from_parabolic" => Ok(mean_from_parabolic(anomaly)),
        "eccentric_from_mean" => eccentric_anomaly(anomaly, e),
        "hyperbolic_from_mean" => hyperbolic_anomaly(anomaly, e, repulsive),
        "parabolic_from_mean" => Ok(parabolic_anomaly(anomaly)),
        "true_from_eccentric" => Ok(true_from_eccentric(anomaly, e)),
        "true_from_hyperbolic" => Ok(true_from_hyperbolic(anomaly, e, repulsive)),
        "true_from_parabolic" => Ok(true_from_parabolic(anomaly)),
        "eccentric_from_true" => Ok(eccentric_from_true(anomaly, e)),
        "hyperbolic_from_true" => {
            let hyperbolic = hyperbolic_from_true(anomaly, e, repulsive);
            check(
                argument,
                anomaly,
                anomaly.abs() < PI && hyperbolic.is_finite(),
                "an angle inside the asymptotes",
            )?;
            Ok(hyperbolic)
        }
        "parabolic_from_true" => {
            check(argument, anomaly, anomaly.abs() < PI, "an angle between −π and π")?;
            Ok(parabolic_from_true(anomaly))
        }
        _ => Err(Error::invalid(
            "name",
            format!("expected a conversion such as true_from_eccentric, got {name}"),
        )),
    }
}
