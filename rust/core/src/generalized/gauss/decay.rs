//! Whether what a step sees of the motion is smooth: how the polynomial through its stages is made up.
//!
//! The one idea: of rates that are analytic about a step, the coefficients in Legendre polynomials fall by the same factor from
//! one to the next (L. N. Trefethen, *Approximation Theory and Approximation Practice*, theorem 8.1), which is what makes a step
//! twice as good as its stages show. Where a root turns within it, as a speed that nearly vanishes, they fall as a power of the
//! order: the last are hardly less than those before, and the step errs by what they are.

use super::Table;
use crate::numerics::lanes::{Lanes, WIDTH};

/// The last two coefficients are at least this part of the two before where motions are not smooth; where they are, and a step is
/// kept, it is a thirtieth and less.
const FLAT: f64 = 0.25;

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

/// How large the last coefficients are beyond the noise of rates, where they do not fall; zero where they do.
pub(super) fn unfallen(coefficients: [f64; WIDTH], noise: f64) -> f64 {
    let [.., a, b, c, d] = coefficients.map(f64::abs);
    let (before, last) = (if a > b { a } else { b }, if c > d { c } else { d });
    // The last takes the noise of the stages by the sum of its weights, which is less.
    let beyond = last - (2 * WIDTH - 1) as f64 * noise;
    if beyond > FLAT * before { beyond } else { 0.0 }
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
            assert!((found - expected).abs() < 4.0 * f64::EPSILON, "{found} for {expected}");
        }
        assert!(coefficients(&GAUSS8).is_none());
    }

    #[test]
    fn what_is_analytic_falls_and_what_turns_does_not() {
        assert_eq!(unfallen(of(|c| (2.0 * c).sin()), 0.0), 0.0);
        assert_eq!(unfallen(of(|c| 1.0 / (1.0 + c)), 0.0), 0.0);
        let turns = of(|c| 1.0 + c + 1e-6 * ((c - 0.4).powi(2) + 1e-8).sqrt());
        let found = unfallen(turns, 0.0);
        assert!(found > 1e-9 && found < 1e-6, "{found}");
        // Of as much noise nothing is told.
        assert_eq!(unfallen(turns, 1e-7), 0.0);
    }
}
