//! Kepler's problem against 150 digits (tests/reference/kepler.json, written by tools/kepler_reference.py).

use nalgebra::Vector3;
use serde_json::Value;
use std::collections::BTreeMap;
use visviva_core::nbody::anomalies::{hyperbolic_anomaly, mean_from_hyperbolic};
use visviva_core::nbody::kepler::KeplerOrbit;

/// Measured 5.8 units of 2^-53 (|Δv|/|v|, repulsive, head-on at the turning point); e ≤ 1 stays below 5.
const ULPS: f64 = 7.0;
/// What 106 bits leave of the conditioning: measured 0.2 units of 2^-106 (e = 1 − 1e-15 after 10^9 periods).
const DOUBLE_DOUBLE: f64 = 0.4 * 0.5 * f64::EPSILON;

fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|i, _| value[i].as_f64().unwrap())
}

/// |found − expected| / |expected| in units of 2^-53, the expected value being high + low.
fn error_in_half_ulps(found: &Vector3<f64>, expected: &Value) -> f64 {
    let high = Vector3::from_fn(|i, _| expected[i][0].as_f64().unwrap());
    let low = Vector3::from_fn(|i, _| expected[i][1].as_f64().unwrap());
    let scale = high.amax();
    ((found - high) / scale - low / scale).norm() / (high / scale).norm() / (0.5 * f64::EPSILON)
}

#[test]
fn states_agree_with_150_digits() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/kepler.json");
    let document: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut worst: BTreeMap<String, [f64; 4]> = BTreeMap::new();
    let mut count = 0;
    for case in document["cases"].as_array().unwrap() {
        let time = case["time"].as_f64().unwrap();
        let orbit = KeplerOrbit::new(
            case["mu"].as_f64().unwrap(),
            vector(&case["position"]),
            vector(&case["velocity"]),
        )
        .unwrap();
        let (position, velocity) = orbit.state(time);
        let errors = [
            error_in_half_ulps(&position, &case["expected_position"]),
            error_in_half_ulps(&velocity, &case["expected_velocity"]),
        ];
        let row = worst.entry(case["class"].as_str().unwrap().to_owned()).or_insert([0.0; 4]);
        for k in 0..2 {
            let condition = case["condition"][k].as_f64().unwrap().max(1.0);
            assert!(errors[k].is_finite(), "{case}");
            row[k] = row[k].max(errors[k]);
            row[2 + k] = row[2 + k].max(errors[k] / condition);
            let allowed = ULPS + DOUBLE_DOUBLE * condition;
            assert!(errors[k] <= allowed, "error {} > {allowed}: {case}", errors[k]);
        }
        count += 1;
    }
    println!("| class | |Δr|/|r| | |Δv|/|v| | over condition: r | v | (units of 2^-53)");
    for (class, row) in &worst {
        println!("| {class} | {:.2} | {:.2} | {:.2} | {:.2} |", row[0], row[1], row[2], row[3]);
    }
    assert!(count > 400, "the reference file holds only {count} cases");
}

/// Hyperbolic anomalies against 420 digits (tests/reference/hyperbolic.json, written by tools/hyperbolic_reference.py):
/// mean anomalies from 1e-300 to 1e300, where e sinh H or its square would overflow, and e from 1 + 1e-15 to 1e10.
#[test]
fn hyperbolic_anomalies_agree_with_420_digits() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/hyperbolic.json");
    let document: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let cases = document["cases"].as_array().unwrap();
    assert!(cases.len() > 100);
    let mut worst = 0.0_f64;
    for case in cases {
        let number = |name: &str| case[name].as_f64().unwrap();
        let repulsive = case["repulsive"].as_bool().unwrap();
        let (mean, expected) = (number("mean"), number("hyperbolic"));
        let found = hyperbolic_anomaly(mean, number("eccentricity"), repulsive).unwrap();
        worst = worst.max((found - expected).abs() / expected / f64::EPSILON);
        // A few roundings, or that of a subnormal number.
        assert!((found - expected).abs() <= 3.0 * f64::EPSILON * expected + 5e-324, "{found:e}: {case}");
        assert_eq!(hyperbolic_anomaly(-mean, number("eccentricity"), repulsive).unwrap(), -found);
        // And back: M is as well known as H, times dM/dH · H/M, which is at most 1 + H; a subnormal H has fewer digits.
        if expected < f64::MIN_POSITIVE {
            continue;
        }
        let back = mean_from_hyperbolic(found, number("eccentricity"), repulsive);
        assert!((back / mean - 1.0).abs() <= 4.0 * f64::EPSILON * (3.0 + expected), "{back:e}: {case}");
    }
    println!("worst hyperbolic anomaly: {worst:.2} ε");
}
