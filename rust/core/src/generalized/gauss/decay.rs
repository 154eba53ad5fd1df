//! By how much a step errs, as the polynomial through its stages tells.
//!
//! The one idea: of rates that are analytic about a step, the coefficients in Legendre polynomials fall by the same factor from
//! one to the next (L. N. Trefethen, *Approximation Theory and Approximation Practice*, theorem 8.1), which is what makes a step
//! twice as good as its stages show: it errs by coefficients that are as many orders on. Where a root turns within it, as a speed
//! that nearly vanishes, they fall as a power of the order: the last are hardly less than those before, and it errs by these.

use super::Table;
use crate::numerics::lanes::{Lanes, WIDTH};

/// Of what turns, the last two coefficients are at least this part of the two before.
pub(super) const FLAT: f64 = 0.25;
/// The last takes the noise of the stages by the sum of its weights, which is no more than this.
pub(super) const OF_NOISE: f64 = 15.0;

/// What each stage contributes to the coefficients of the polynomial, in the lanes, of a method with so many stages as lanes.
pub(super) fn coefficients(table: &Table) -> Option<[Lanes; WIDTH]> {
    let of_stage = |k: usize| {
        let x = 2.0 * table.c.0[k] - 1.0;
        let mut legendre = [1.0, x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for j in 1..WIDTH - 1 {
            let (n, before) = (j as f64, legendre[j - 1]);
            legendre[j + 1] = ((2.0 * n + 1.0) * x * legendre[j] - n * before) / (n + 1.0);
        }
        Lanes(core::array::from_fn(|j| (2 * j + 1) as f64 * table.b[0].0[k] * legendre[j]))
    };
    (table.stages == WIDTH).then(|| core::array::from_fn(of_stage))
}

/// By how much the mean of rates errs, and how large the last coefficients are, of which noise explains nothing.
pub(super) fn error_of_mean(coefficients: [f64; WIDTH], noise: f64) -> (f64, f64) {
    let [.., a, b, c, d] = coefficients.map(f64::abs);
    let (before, last) = (if a > b { a } else { b }, if c > d { c } else { d });
    let last = last - OF_NOISE * noise;
    if last <= 0.0 {
        return (0.0, 0.0);
    }
    // They fall twice from these to the last, and nine times from there to those that are left out; four times as much as they
    // fall is allowed for.
    let fall = last / (FLAT * before);
    let square = fall * fall;
    (if fall < 1.0 { last * (square * square * fall) } else { last }, last)
}

#[cfg(test)]
mod tests {
    use super::super::tables::{GAUSS8, GAUSS16};
    use super::*;

    fn of(rate: impl Fn(f64) -> f64) -> [f64; WIDTH] {
        let rows = coefficients(&GAUSS16).unwrap();
        core::array::from_fn(|j| (0..WIDTH).map(|k| rows[k].0[j] * rate(GAUSS16.c.0[k])).sum())
    }

    #[test]
    fn coefficients_are_those_of_the_polynomial() {
        // x³ = (3 P₁ + 2 P₃)/5.
        let found = of(|c| (2.0 * c - 1.0).powi(3));
        for (found, expected) in found.iter().zip([0.0, 0.6, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0]) {
            // Every stage is rounded, and the weights of the last coefficient come to 2·8 − 1.
            assert!((found - expected).abs() < 15.0 * f64::EPSILON, "{found} for {expected}");
        }
        assert!(coefficients(&GAUSS8).is_none());
    }

    /// Of the square root of (c − at)² + width², over the step.
    fn turn(at: f64, width: f64) -> (f64, f64) {
        let root = |x: f64| x.hypot(width);
        let integral = |x: f64| 0.5 * (x * root(x) + width * width * (x / width).asinh());
        let exact = integral(1.0 - at) - integral(-at);
        let mean: f64 = (0..WIDTH).map(|k| GAUSS16.b[0].0[k] * root(GAUSS16.c.0[k] - at)).sum();
        ((mean - exact).abs(), error_of_mean(of(|c| root(c - at)), 0.0).0)
    }

    #[test]
    fn what_turns_errs_by_as_much_as_is_told() {
        for width in [1e-3, 1e-2, 0.05, 0.1, 0.2, 0.5, 1.0] {
            let found: Vec<(f64, f64)> = (0..20).map(|k| turn(0.05 * f64::from(k), width)).collect();
            let largest = found.iter().fold(0.0, |most, of| f64::max(of.0, most));
            for (error, told) in found {
                // One in many places within a step may seem to fall.
                assert!(error < 1e-15 + f64::max(10.0 * told, 0.4 * largest), "{error} for {told}, {width}");
            }
        }
    }

    #[test]
    fn what_is_smooth_or_noise_is_told_to_err_by_nothing() {
        // A step turns by less than a radian, or is far from a pole beside its length.
        for coefficients in [of(|c| (0.5 * c).sin()), of(|c| 1.0 / (3.0 + c))] {
            let (told, _) = error_of_mean(coefficients, 0.0);
            assert!(told < 1e-13, "{told}");
        }
        assert_eq!(error_of_mean(of(|c| (c - 0.4).hypot(1e-3)), 1.0), (0.0, 0.0));
    }
}
