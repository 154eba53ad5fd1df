use super::*;
use crate::numerics::lanes::{Vector8, WIDTH};
use proptest::prelude::*;

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
