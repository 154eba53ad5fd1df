mod values;

use super::*;
use crate::numerics::lanes::{Vector8, WIDTH};
use proptest::prelude::*;
use values::{Exact, VALUES};

/// The distance from `value` to a reference, in units in the last place of the reference.
fn ulps(value: f64, reference: DoubleDouble) -> f64 {
    let magnitude = reference.high().abs().max(f64::MIN_POSITIVE);
    let ulp = f64::from_bits(magnitude.to_bits() + 1) - magnitude;
    ((DoubleDouble::from(value) - reference).to_f64() / ulp).abs()
}

#[inline(always)]
fn exp_body<V: Vector8 + Exponential>(x: Lanes) -> Lanes {
    V::load(x).exp().store()
}

crate::tiered! {
    fn exp_lanes[][](x: Lanes) -> Lanes = exp_body;
}

/// Measured over 3e6 arguments: 0.888 ulp.
const EXP_ULPS: f64 = 0.95;

/// `tiered` and portable lanes both give the bits of the scalar function.
fn same_bits(numbers: [f64; WIDTH], scalar: fn(f64) -> f64, lanes: [fn(Lanes) -> Lanes; 2]) {
    for function in lanes {
        let values = function(Lanes(numbers)).0;
        for lane in 0..WIDTH {
            assert_eq!(values[lane].to_bits(), scalar(numbers[lane]).to_bits(), "at {}", numbers[lane]);
        }
    }
}

#[test]
fn exp_at_the_ends_of_its_domain() {
    assert_eq!(Exponential::exp(0.0_f64), 1.0);
    assert_eq!(Exponential::exp(-0.0_f64), 1.0);
    assert_eq!(Exponential::exp(f64::INFINITY), f64::INFINITY);
    assert_eq!(Exponential::exp(f64::NEG_INFINITY), 0.0);
    assert!(Exponential::exp(f64::NAN).is_nan());
    assert_eq!(Exponential::exp(709.79), f64::INFINITY);
    assert_eq!(Exponential::exp(-745.14), 0.0);
    assert_eq!(Exponential::exp(-745.1), f64::from_bits(1)); // the smallest subnormal number
    assert_eq!(Exponential::exp(1e-300), 1.0);
}

#[inline(always)]
fn falling_body<V: Vector8 + Exponential>(x: Lanes) -> Lanes {
    let [one, other] = V::falling_exps([V::load(x), V::load(x) + V::one()]);
    (one + other).store()
}

crate::tiered! {
    fn falling_lanes[][](x: Lanes) -> Lanes = falling_body;
}

/// Measured over 6e4 arguments: 1.004 ulp.
const FALLING_ULPS: f64 = 1.1;

#[test]
fn falling_exponentials_are_within_a_unit() {
    let mut worst = 0.0_f64;
    for at in 0..200_000 {
        let x = 708.0 * (f64::from(at) / 2e5).powi(3);
        let [value] = f64::falling_exps([x]);
        worst = worst.max(ulps(value, (-DoubleDouble::from(x)).exp()));
        if at % 1000 == 0 {
            let sum = |x: f64| {
                let [one, other] = f64::falling_exps([x, x + 1.0]);
                one + other
            };
            same_bits([x; WIDTH], sum, [falling_lanes, falling_body::<Lanes>]);
        }
    }
    assert!(worst < FALLING_ULPS, "{worst}");
}

#[test]
fn falling_exponentials_at_the_ends() {
    let values = f64::falling_exps([0.0, -0.0, 708.0, 708.1, f64::MAX, f64::INFINITY, f64::NAN]);
    assert_eq!([values[0], values[1]], [1.0, 1.0]);
    assert!(ulps(values[2], (-DoubleDouble::from(708.0)).exp()) < FALLING_ULPS);
    assert_eq!(values[3..], [0.0; 4]);
}

/// (x, high and low part of eˣ), from mpmath with 60 digits.
const EXP: [(f64, f64, f64); 15] = [
    (-708.3, 2.450295530965988e-308, 0.0),
    (-300.25, 4.009422364622857e-131, -9.421845746665655e-148),
    (-37.5, 5.175555005801869e-17, -2.3609618230840602e-33),
    (-1.0, 0.36787944117144233, -1.2428753672788363e-17),
    (-0.34657359, 0.7071067813845181, -5.2443064620631435e-18),
    (-1e-05, 0.9999900000499998, 5.730256126450165e-18),
    (1e-09, 1.000000001, -8.224037093664211e-17),
    (0.1, 1.1051709180756477, -8.149523913327619e-17),
    (0.5, 1.6487212707001282, -4.731568479435833e-17),
    (1.0, core::f64::consts::E, 1.4456468917292502e-16),
    (2.0, 7.38905609893065, -1.7971139497839148e-16),
    (10.0, 22026.465794806718, -1.3780134700517372e-12),
    (88.72, 3.39317637416317e+38, 1.1152791330654838e+22),
    (400.125, 5.916700301691561e+173, -8.476509386000404e+156),
    (709.75, 1.7398368732641605e+308, 4.077104310933529e+291),
];

#[test]
fn exp_against_the_table() {
    for (x, high, low) in EXP {
        let reference = DoubleDouble::new(high, low);
        assert!(ulps(Exponential::exp(x), reference) < EXP_ULPS, "{x}");
        let relative = (DoubleDouble::from(x).exp() - reference).to_f64() / high;
        // 2^-104 amplified by |x|, the condition number of exp.
        assert!(relative.abs() < 1e-31 * (1.0 + x.abs()), "{x}: {relative:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    // Below -650 the low part of the reference itself would be subnormal.
    fn exp_is_within_one_ulp(x in -650.0..709.7f64) {
        let error = ulps(Exponential::exp(x), DoubleDouble::from(x).exp());
        prop_assert!(error < EXP_ULPS, "{} ulp at {}", error, x);
    }
    #[test]
    fn exp_is_within_one_ulp_near_zero(x in -1.0..1.0f64) {
        let error = ulps(Exponential::exp(x), DoubleDouble::from(x).exp());
        prop_assert!(error < EXP_ULPS, "{} ulp at {}", error, x);
    }
    #[test]
    fn exp_has_the_same_bits_in_every_lane_of_every_tier(x in prop::array::uniform8(-760.0..720.0f64)) {
        same_bits(x, Exponential::exp, [exp_lanes, exp_body::<Lanes>]);
    }
}

/// The distance from a number to (high, low) in units of ε|high|: half an ulp is between 1/4 and 1/2.
fn relative(found: f64, (high, low): Exact) -> f64 {
    ((found - high) - low).abs() / (high.abs() * f64::EPSILON)
}

#[test]
fn exponential_logarithm_and_cube_root_against_60_digits() {
    let mut worst = [0.0_f64; 3];
    for (x, power, logarithm, root) in VALUES {
        let found =
            [relative(Exponential::exp(x), power), relative(ln(x.abs()), logarithm), relative(cbrt(x), root)];
        worst = core::array::from_fn(|i| worst[i].max(found[i]));
    }
    // Measured 0.458, 0.427 and 0.478.
    assert!(worst[0] <= 0.47 && worst[1] <= 0.44 && worst[2] <= 0.49, "{worst:?}");
}

#[test]
fn logarithm_and_cube_root_at_the_ends_of_their_domains() {
    assert_eq!((ln(1.0), ln(0.0), ln(f64::INFINITY)), (0.0, f64::NEG_INFINITY, f64::INFINITY));
    assert!(ln(-1.0).is_nan() && ln(f64::NAN).is_nan() && cbrt(f64::NAN).is_nan());
    assert_eq!((cbrt(-27.0), cbrt(0.0), cbrt(f64::NEG_INFINITY)), (-3.0, 0.0, f64::NEG_INFINITY));
    // ln 2^-1074 and 2^(-1074/3), a subnormal number in.
    assert_eq!((ln(5e-324), cbrt(5e-324)), (-744.440_071_921_381_2, 1.703_183_936_003_260_3e-108));
    assert_eq!((ln(f64::MAX), cbrt(f64::MAX)), (709.782_712_893_384, 5.643_803_094_122_362e102));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    // ln is the inverse of a double-double exponential: y = ln x is off by 1 − x e^(−y).
    fn logarithm_is_within_one_ulp(m in 1.0..2.0f64, k in prop_oneof![-1022..1024i32, -2..2i32]) {
        let x = scale(m, k);
        let found = ln(x);
        let error = (DoubleDouble::from(x) * DoubleDouble::from(-found).exp() - DoubleDouble::one()).to_f64();
        prop_assume!(found != 0.0 && found.abs() < 650.0);
        prop_assert!(ulps_of(error, found) < 1.0, "{} ulp at {}", ulps_of(error, found), x);
    }
    #[test]
    // c³ = x (1 + 3 δ).
    fn cube_root_is_within_one_ulp(m in 1.0..2.0f64, k in -900..900i32) {
        let x = scale(m, k);
        let root = cbrt(x);
        let cube = DoubleDouble::product(root, root) * DoubleDouble::from(root);
        let error = ((cube - DoubleDouble::from(x)) / DoubleDouble::from(x)).to_f64() / 3.0 * root;
        prop_assert!(ulps_of(error, root) < 1.0, "{} ulp at {}", ulps_of(error, root), x);
    }
}

/// An error in units in the last place of `value`.
fn ulps_of(error: f64, value: f64) -> f64 {
    let size = value.abs();
    (error / (f64::from_bits(size.to_bits() + 1) - size)).abs()
}
