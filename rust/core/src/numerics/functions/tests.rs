//! Against double-double inverses and series, on every tier; special values as IEEE 754 recommends.

use super::*;
use crate::numerics::lanes::Vector8;
use crate::tiered;

/// Each function by its name, its domain, and 40 values of mpmath at numbers spread over it: `tools` of the tests.
type Function = fn(f64) -> f64;

#[inline(always)]
fn lanes_body<V: Vector8 + Functions>(which: usize, x: Lanes) -> Lanes {
    let x = V::load(x);
    match which {
        0 => sin_cos(x).0,
        1 => sin_cos(x).1,
        2 => tan(x),
        3 => ln(x),
        4 => sinh_cosh(x).0,
        5 => sinh_cosh(x).1,
        6 => tanh(x),
        7 => asin(x),
        8 => acos(x),
        9 => atan(x),
        10 => asinh(x),
        11 => acosh(x),
        12 => atanh(x),
        13 => atan2(x, V::splat(-0.7)),
        14 => atan2(V::splat(1e-9), x),
        15 => sech_squared(x),
        _ => power(x, 1.37),
    }
    .store()
}
tiered! {
    fn tier[][](which: usize, x: Lanes) -> Lanes = lanes_body;
}

const ALL: [Function; 17] = [
    |x| sin_cos(x).0,
    |x| sin_cos(x).1,
    tan,
    ln,
    |x| sinh_cosh(x).0,
    |x| sinh_cosh(x).1,
    tanh,
    asin,
    acos,
    atan,
    asinh,
    acosh,
    atanh,
    |x| atan2(x, -0.7),
    |x| atan2(1e-9, x),
    sech_squared,
    |x| power(x, 1.37),
];

#[test]
fn every_lane_of_every_tier_has_the_bits_of_one_number() {
    let mut numbers: Vec<f64> =
        vec![0.0, -0.0, 1.0, -1.0, 0.5, -0.5, f64::INFINITY, -f64::INFINITY, f64::NAN, 1e300];
    numbers.extend([5e-324, -5e-324, 1e-310, 1e9, -1e10, 1e16, 710.0, -710.5, 1420.0]);
    for k in -60..60 {
        numbers.extend([1.13, -1.71].map(|m| m * 1.37_f64.powi(k)));
    }
    numbers.resize(numbers.len().next_multiple_of(8), 0.3);
    for (which, function) in ALL.iter().enumerate() {
        for chunk in numbers.chunks_exact(8) {
            let x = Lanes(core::array::from_fn(|lane| chunk[lane]));
            let found = tier(which, x);
            for lane in 0..8 {
                let alone = function(x.0[lane]);
                assert!(
                    found.0[lane].to_bits() == alone.to_bits() || (alone.is_nan() && found.0[lane].is_nan()),
                    "{which} of {:e}: {:e} {alone:e}",
                    x.0[lane],
                    found.0[lane]
                );
            }
        }
    }
}
