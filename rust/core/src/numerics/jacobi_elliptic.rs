//! Jacobi's elliptic functions sn, cn and dn.
//!
//! The one idea: an arithmetic-geometric mean that begins with the complement of the modulus leads to a sine and a cosine, and its
//! numbers lead back from their ratio (R. Bulirsch, Numer. Math. 7 (1965) 78): nothing is formed by subtraction, so cn and dn keep
//! their relative precision where they are small, however near the modulus is to 1.

use super::angles::sin_cos;
use super::functions::{sinh_cosh, tanh};

/// Squared apart by less, the mean is as good as exact: what is left of a difference is its square.
const NEAR: f64 = 1e-8;
/// Of less than this the square is nothing beside 1.
const SMALL: f64 = 1e-8;
/// Means of numbers however far apart take no more steps.
const MOST_STEPS: usize = 16;

/// sn, cn and dn of `u` for the complementary parameter `complement` = 1 − k², from 0 to 1.
pub fn jacobi(u: f64, complement: f64) -> [f64; 3] {
    if u.abs() < SMALL {
        return [u, 1.0, 1.0];
    }
    if complement <= 0.0 {
        let sech = 1.0 / sinh_cosh(u).1;
        return [tanh(u), sech, sech];
    }
    let (mut mean, mut geometric) = (1.0, complement.sqrt());
    let mut passed = [(1.0, 0.0); MOST_STEPS];
    let mut steps = 0;
    for (step, passed) in passed.iter_mut().enumerate() {
        *passed = (mean, geometric);
        steps = step + 1;
        let next = 0.5 * (mean + geometric);
        if (mean - geometric).abs() <= NEAR * mean {
            mean = next;
            break;
        }
        (mean, geometric) = (next, (mean * geometric).sqrt());
    }
    let (sine, cosine) = sin_cos(mean * u);
    let mut ratio = cosine / sine;
    let mut scaled = mean * ratio;
    let mut dn = 1.0;
    for &(arithmetic, geometric) in passed[..steps].iter().rev() {
        ratio *= scaled;
        scaled *= dn;
        dn = (geometric + ratio) / (arithmetic + ratio);
        ratio = scaled / arithmetic;
    }
    let size = 1.0 / scaled.mul_add(scaled, 1.0).sqrt();
    let sn = size.copysign(sine);
    [sn, scaled * sn, dn]
}

#[cfg(test)]
mod tests {
    use super::super::double_double::DoubleDouble;
    use super::super::elliptic::complete_first_kind;
    use super::super::real::Real;
    use super::*;

    /// Arguments, complementary parameters, and values of mpmath with 60 digits.
    const CASES: [(f64, f64, [f64; 3]); 5] = [
        (0.7, 0.5, [0.6243400909662173, 0.7811526424536344, 0.8972734953213249]),
        (2.3, 0.01, [0.9822566365117366, 0.18754172876629405, 0.2117077727159863]),
        (-5.0, 1e-06, [-0.999909453841007, 0.013456749956024895, 0.013493848164806681]),
        (31.0, 0.25, [-0.6827403045338853, -0.7306611229324971, 0.8064733457614909]),
        (14.0, 1e-10, [0.9999999999106283, -1.336949610816331e-05, 1.6695610985175704e-05]),
    ];

    #[test]
    fn values_are_those_of_sixty_digits() {
        for (u, complement, expected) in CASES {
            for (found, expected) in jacobi(u, complement).into_iter().zip(expected) {
                // Units in the last place, and what rounding makes of the phase.
                let bound = 4e-16 * (3.0 + f64::abs(u)) * f64::abs(expected);
                assert!((found - expected).abs() <= bound, "{u} {complement}: {found}, {expected}");
            }
        }
    }

    #[test]
    fn squares_add_up_and_quarters_are_passed() {
        for complement in [1.0, 0.3, 1e-4, 1e-12] {
            let quarter = complete_first_kind(DoubleDouble::from(complement).sqrt()).to_f64();
            for part in [0.1, 0.9, 1.7, -2.3, 3.9] {
                let [sn, cn, dn] = jacobi(part * quarter, complement);
                assert!((sn * sn + cn * cn - 1.0).abs() < 1e-15);
                // dn² = k'² + k² cn², none of which is formed by subtraction.
                let square = complement + (1.0 - complement) * cn * cn;
                assert!((dn * dn / square - 1.0).abs() < 1e-14, "{complement} {part}");
                let [next, ..] = jacobi((part + 1.0) * quarter, complement);
                // sn(u + K) = cn/dn, off by what the rounding of K turns the phase.
                assert!((next - cn / dn).abs() < 1e-13, "{complement} {part}: {next}, {}", cn / dn);
            }
        }
    }

    #[test]
    fn ends_of_moduli_are_elementary() {
        assert_eq!(jacobi(0.0, 0.5), [0.0, 1.0, 1.0]);
        assert_eq!(jacobi(1e-300, 0.5), [1e-300, 1.0, 1.0]);
        let [sn, cn, dn] = jacobi(2.5, 1.0);
        let (sine, cosine) = sin_cos(2.5);
        // Four units in the last place.
        assert!((sn - sine).abs() < 5e-16 && (cn - cosine).abs() < 5e-16 && dn == 1.0, "{sn} {cn} {dn}");
        let ([sn, cn, dn], [near, ..]) = (jacobi(2.5, 0.0), jacobi(2.5, 1e-300));
        assert!(sn == tanh(2.5) && cn == dn && (near - sn).abs() < 1e-15);
    }
}
