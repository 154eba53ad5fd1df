use super::*;
use crate::numerics::lanes::{Vector8, WIDTH};
use proptest::prelude::*;

/// (x, n, high and low part of xⁿ), from mpmath with 60 digits.
const VALUES: [(f64, f64, f64, f64); 39] = [
    (10.0, -1.5, 0.03162277660168379, 1.977898889116388e-18),
    (1.0000000000000002, 1000000000000000.0, 1.2486270715390861, 8.299474124907946e-18),
    (0.9999999999999999, -3000000000000000.0, 1.3952406472536143, -4.2873879475819455e-17),
    (1.5, 700.25, 2.0319085310875348e+123, 1.4114903627871861e+107),
    (3e-310, 0.3, 1.390389170315919e-93, 6.929984976436395e-110),
    (7e+200, -1.25, 8.782687899303777e-252, -8.913759144296237e-268),
    (core::f64::consts::SQRT_2, 2.5, 2.3784142300054425, 4.201070940368827e-17),
    (1.4142135623730954, -2.5, 0.42044820762685703, 5.653902516122758e-18),
    (0.7, 100.7, 2.519838049216826e-16, -8.285925169481091e-33),
    (123.456, 12.0, 1.2535637344887709e+25, -365132801.9941235),
    (0.3, -6.0, 1371.7421124828536, -7.124920985468216e-14),
    (5e-324, 0.9, 1.0578064022210135e-291, 7.419377253154443e-309),
    (1.7976931348623157e+308, 0.999, 8.840174632999172e+307, 3.4160742786670294e+291),
    (0.1, 2.3, 0.0050118723362727255, 4.768201100163989e-20),
    (1e-05, 64.1, 3.16e-321, 0.0),
    (8.98070836021461e-08, -5.55778777510327, 1.4588285005405403e+39, -9.598249574081366e+22),
    (8.539981798625331e-19, -5.151360390930567, 1.1955755225138186e+93, -5.098581477505855e+76),
    (2.0890892341140406e-18, -0.5730644352656891, 13545775152.316212, 2.2599472162616437e-07),
    (0.0022173147524405614, -3.4072488517719988, 1105163990.9510915, 9.411206901209484e-08),
    (110.12607267523185, -11.58458713917493, 2.2158767950566397e-24, -2.455141122305958e-41),
    (8.95526508602953e-16, -8.847231524457733, 1.3565816875471223e+133, -3.735865982194721e+116),
    (2088.7005371011865, -8.100586133214106, 1.279549422483289e-27, 1.9011802158912758e-44),
    (7.365784117297644e-05, -0.6998283946177001, 780.256692288914, -3.653526130972115e-14),
    (218141533558448.44, 5.89698965782194, 3.5924590520866664e+84, 1.0544706615821455e+68),
    (42.406792117662576, 7.865589014328736, 6320306958632.688, -0.00041873371390696123),
    (19059337.05680271, -8.163322283091405, 3.7164975507254426e-60, -2.5526297202086032e-76),
    (360195.8933460841, 1.4091565351265305, 67613419.74207956, 1.0738040230222327e-09),
    (305091866.48989904, -8.685183824771077, 2.047200275236459e-74, 2.811769095947321e-92),
    (0.7187532219976774, 10.892341410982258, 0.027404271771267922, -1.3142908551659091e-18),
    (0.04207989365461783, 5.0940738654267, 9.793423836826715e-08, -5.048488918628784e-24),
    (8.650941880284763e-11, -9.80097235052752, 4.2321732471495355e+98, -2.809137748980129e+82),
    (5.8057780471258704e-11, 7.376491228169747, 3.113194419976225e-76, 1.3126152850154424e-92),
    (1012744335916281.2, 4.066731820218101, 1.0552214438582599e+61, 1.7362593680536716e+44),
    (1.6106230114801095e+19, -7.19146298753331, 7.475052866462944e-139, -6.183631585825593e-155),
    (3.9672004609416906e-14, 2.170184258514041, 8.245960552453405e-30, -1.8383361565219097e-47),
    (0.3618462023964613, -13.470166213598931, 884616.1075139354, -1.7562296642390382e-11),
    (1.272973278308436e-17, 4.794706952567177, 9.830137024688864e-82, -1.0903885168044649e-98),
    (1.0165658327361632e-06, 8.139538099740767, 1.6628426189582881e-49, -6.698479204515011e-66),
    (0.01770978350132362, -13.228301276755728, 1.4899197408567364e+23, -5492201.890842895),
];

#[inline(always)]
fn power_body<V: Vector8 + Powers>(x: Lanes, by: &Power) -> Lanes {
    V::load(x).power(by).store()
}

crate::tiered! {
    fn power_lanes[][](x: Lanes, by: &Power) -> Lanes = power_body;
}

/// Off a reference by so many units in its last place.
fn ulps(found: f64, reference: DoubleDouble) -> f64 {
    let size = reference.high().abs().max(f64::MIN_POSITIVE);
    ((DoubleDouble::from(found) - reference).to_f64() / (size.next_up() - size)).abs()
}

/// That of the exponential (0.95) and the rounding of the exponent; each product of a whole power rounds by up to one.
fn allowed(n: f64) -> f64 {
    if Power::new(n).whole() { n.abs() + 1.0 } else { 1.05 }
}

#[test]
fn powers_against_60_digits() {
    for (x, n, high, low) in VALUES {
        let reference = DoubleDouble::new(high, low);
        let error = ulps(x.power(&Power::new(n)), reference);
        assert!(error <= allowed(n), "{x}^{n}: {error} ulp");
        let precise = DoubleDouble::from(x).power(&Power::new(n)) - reference;
        // The logarithm is known to 2^-104 of one, or of itself if that is more.
        let relative = (precise.to_f64() / high).abs();
        assert!(relative < 1e-31 * (1.0 + n.abs() * (1.0 + x.ln().abs())), "{x}^{n}: {relative:e}");
    }
}

#[test]
fn powers_at_the_ends() {
    for n in [0.5, 2.0, 700.5, 1e300] {
        for (x, up, down) in [(0.0, 0.0, f64::INFINITY), (f64::INFINITY, f64::INFINITY, 0.0), (1.0, 1.0, 1.0)]
        {
            assert_eq!(f64::power(x, &Power::new(n)), up, "{x}^{n}");
            assert_eq!(f64::power(x, &Power::new(-n)), down, "{x}^-{n}");
        }
        assert!(f64::NAN.power(&Power::new(n)).is_nan());
    }
    assert_eq!((1e-300.power(&Power::new(2.5)), 1e300.power(&Power::new(2.5))), (0.0, f64::INFINITY));
    assert_eq!(3.0.power(&Power::new(0.0)), 1.0);
    // Out of the range and back.
    let far = Power::new(-7.0).scaled(500, 3500);
    assert_eq!(2.0.power(&far), power_of_two::power_of_two(-7));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    fn powers_are_within_one_ulp(m in 1.0..2.0f64, k in -60..60i32, n in -16.0..16.0f64) {
        let x = power_of_two::scale(m, k);
        let error = ulps(x.power(&Power::new(n)), DoubleDouble::from(x).power(&Power::new(n)));
        prop_assert!(error <= allowed(n), "{}^{}: {} ulp", x, n, error);
    }
    #[test]
    fn whole_powers_are_as_near_as_products(m in 1.0..2.0f64, k in -60..60i32, n in -12..=12i32) {
        let (x, by) = (power_of_two::scale(m, k), Power::new(f64::from(n)));
        let error = ulps(x.power(&by), DoubleDouble::from(x).power(&by));
        prop_assert!(error <= allowed(f64::from(n)), "{}^{}: {} ulp", x, n, error);
    }
    #[test]
    fn powers_of_two_in_front_change_no_bit(m in 1.0..2.0f64, k in -400..400i32, n in -8.0..8.0f64, from in -400..400i32, to in -400..400i32) {
        let x = power_of_two::scale(m, k);
        let plain = x.power(&Power::new(n));
        let moved = power_of_two::scale(x, -from).power(&Power::new(n).scaled(from, to));
        let (normal, also) = (1e-300..1e300).contains(&plain).then_some((plain, moved)).unzip();
        prop_assert_eq!(normal.map(|x| power_of_two::scale(x, to)), also);
    }
    #[test]
    fn powers_have_the_same_bits_in_every_lane_of_every_tier(m in prop::array::uniform8(1.0..2.0f64), k in -1074..1024i32, n in -9.0..9.0f64, whole in any::<bool>()) {
        let by = Power::new(if whole { n.round() } else { n });
        let x: [f64; WIDTH] = m.map(|m| power_of_two::scale(m, k));
        for found in [power_lanes(Lanes(x), &by), power_body::<Lanes>(Lanes(x), &by)] {
            for lane in 0..WIDTH {
                prop_assert_eq!(found.0[lane].to_bits(), x[lane].power(&by).to_bits());
            }
        }
    }
}
