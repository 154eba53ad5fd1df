mod values;

use super::*;
use crate::numerics::stumpff::UniversalFunctions;
use values::{ANGLES, SINES};

fn ulps(found: f64, (high, low): (f64, f64)) -> f64 {
    ((found - high) - low).abs() / (high.abs() * f64::EPSILON)
}

#[test]
fn sine_cosine_and_angle_stay_within_an_ulp() {
    let mut worst = [0.0_f64; 3];
    for (x, sine, cosine) in SINES {
        let found = sin_cos(x);
        worst[0] = worst[0].max(ulps(found.0, sine));
        worst[1] = worst[1].max(ulps(found.1, cosine));
    }
    for (y, x, angle) in ANGLES {
        worst[2] = worst[2].max(ulps(atan2(y, x), angle));
    }
    // Measured 0.428, 0.382 and, with the rounding of y/x on top, 0.694.
    assert!(worst[0] <= 0.44 && worst[1] <= 0.39 && worst[2] <= 0.7, "{worst:?}");
}

/// Stumpff's functions in double-double are sine and cosine for β = 1, from other series.
fn reference(x: f64) -> (DoubleDouble, DoubleDouble) {
    let g = UniversalFunctions::<DoubleDouble>::new(DoubleDouble::from(1.0), DoubleDouble::from(x));
    (g.g1, g.g0)
}

fn in_last_place(error: DoubleDouble, of: f64) -> f64 {
    let size = of.abs();
    (error.to_f64() / (f64::from_bits(size.to_bits() + 1) - size)).abs()
}

#[test]
fn many_arguments_against_double_double() {
    let mut worst = [0.0_f64; 3];
    for i in 1..=40_000 {
        // All of the first quadrant, where the series is used, and some turns.
        for x in [f64::from(i) * 1.963_495e-5, f64::from(i) * 1.000_7e-4] {
            let ((sine, cosine), exact) = (sin_cos(x), reference(x));
            worst[0] = worst[0].max(in_last_place(DoubleDouble::from(sine) - exact.0, exact.0.to_f64()));
            worst[1] = worst[1].max(in_last_place(DoubleDouble::from(cosine) - exact.1, exact.1.to_f64()));
        }
        // The angle θ of (1, y) is off by (y cos θ − sin θ)/√(1 + y²).
        let y = f64::from(i) * 2.5e-5;
        let angle = atan2(y, 1.0);
        let (sine, cosine) = reference(angle);
        let off = (DoubleDouble::from(y) * cosine - sine) * cosine;
        worst[2] = worst[2].max(in_last_place(off, angle));
    }
    // Measured 0.763, 0.738 and, with the rounding of y/x on top, 1.381.
    assert!(worst[0] <= 0.77 && worst[1] <= 0.75 && worst[2] <= 1.4, "{worst:?}");
}

/// Integers next to a multiple of π/2 (its convergents): what is left needs every digit of π/2 that there is.
#[test]
fn the_reduction_carries_enough_of_pi() {
    for (x, odd, (high, low)) in [
        (52174.0, true, (5.507508792203807e-06, 6.700262426283885e-23)),
        (42781604.0, true, (1.1713814126465351e-08, -3.048243324632517e-25)),
        (17969367914.0, true, (7.311376521248978e-11, -4.227202464858061e-27)),
        (65398140378926.0, true, (1.4593422453065666e-14, 6.76530200472833e-31)),
        (6134899525417045.0, false, (9.495905770584396e-17, -3.873995565755314e-33)),
    ] {
        let (sine, cosine) = sin_cos(x);
        let found = if odd { cosine } else { sine };
        // Half an ulp, and the rounding of n times the second part of π/2: measured up to 2.6e-33 x.
        let error = (found - high) - low;
        let allowed = 0.5 * f64::EPSILON * f64::abs(high) + x * 3e-33;
        assert!(error.abs() <= allowed, "{x}: {found:e}");
    }
}

#[test]
fn quadrants_and_zeros_follow_ieee() {
    assert_eq!(atan2(0.0, -1.0), PI);
    assert_eq!(atan2(-0.0, -1.0), -PI);
    assert_eq!(atan2(1.0, 0.0), FRAC_PI_2);
    assert_eq!(atan2(-0.0, 1.0).to_bits(), (-0.0f64).to_bits());
    assert_eq!(atan2(f64::INFINITY, f64::NEG_INFINITY), 0.75 * PI);
    assert_eq!(sin_cos(0.0), (0.0, 1.0));
    assert!(sin(f64::INFINITY).is_nan());
}
