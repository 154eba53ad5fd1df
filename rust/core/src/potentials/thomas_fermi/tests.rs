use super::*;
use crate::numerics::double_double::DoubleDouble;

/// (x, φ, φ′), from tools/thomas_fermi.py with 100 digits.
const VALUES: [(f64, f64, f64); 14] = [
    (1e-06, 0.9999984132623101, -1.586071024198446),
    (0.001, 0.9984540729283805, -1.5248746774945325),
    (0.03125, 0.957639383624424, -1.242272318314591),
    (0.1, 0.8816970767504996, -0.9953546460915719),
    (0.25, 0.7552014653133313, -0.7223069849102349),
    (0.5, 0.6069863833559799, -0.4894116125745381),
    (1.0, 0.4240080520807056, -0.2739890515933063),
    (2.0, 0.24300850716111955, -0.11824319162548762),
    (5.0, 0.0788077792513699, -0.023560074954700513),
    (10.0, 0.024314292988680864, -0.004602881871269254),
    (50.0, 0.0006322547829849047, -3.2498902048258815e-05),
    (200.0, 1.4501803496945765e-05, -2.057532316475269e-07),
    (1000.0, 1.3512747735410578e-07, -3.988010708227991e-10),
    (1023.0, 1.2635534783877912e-07, -3.6463084082186937e-10),
];
/// −φ′(0), from Majorana's series; the first digits are those of E. Fermi and of every table since.
const SLOPE: f64 = 1.588_071_022_611_375_3;

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn the_function_against_a_hundred_digits() {
    let function = ThomasFermi::new();
    for (x, value, rate) in VALUES {
        let [found, slope, bend] = function.all(x);
        // Rounding of a polynomial of terms that fall, and of t.
        assert!(relative(found, value) < 1e-15, "phi({x})");
        assert!(relative(slope, -x * rate) < 4e-15, "phi'({x})");
        // The equation itself: x² φ″ = (x φ)^(3/2). The bend is a difference, near 0 of terms 1/√x as large.
        let equation = (x * value).powf(1.5);
        assert!(
            relative(bend, equation) < 2e-13 + 1e-15 / x.sqrt(),
            "phi''({x}): {}",
            relative(bend, equation)
        );
    }
}

#[test]
fn values_at_the_ends() {
    let function = ThomasFermi::new();
    assert_eq!(function.all(0.0_f64), [1.0, 0.0, 0.0]);
    // To first order φ = 1 − slope x + (4/3) x^(3/2).
    let x = 1e-8_f64;
    let slope = (1.0 - function.all(x)[0] + 4.0 / 3.0 * x.powf(1.5)) / x;
    assert!((slope - SLOPE).abs() < 1e-7, "{slope}");
    assert!(relative(function.all(DoubleDouble::from(1e-8))[1].to_f64() / 1e-8 + 2e-4, SLOPE) < 1e-8);
    // Far away 144/x³, from below as x^−λ.
    let far = 1e20_f64;
    assert!(relative(function.all(far)[0], 144e-60) < 1e-13);
    assert_eq!(function.all(1e300_f64)[0], 0.0);
}

#[test]
fn pieces_meet() {
    let function = ThomasFermi::new();
    let ends = PIECES.iter().skip(1).map(|piece| piece[0]).chain([END]);
    for y in ends {
        let x = y * y;
        let (before, after) = (function.all(x.next_down()), function.all(x.next_up()));
        for (at, tolerance) in [2e-15, 1e-14, 1e-11].into_iter().enumerate() {
            assert!(relative(before[at], after[at]) < tolerance, "{at} at {x}: {before:?} {after:?}");
        }
    }
}
