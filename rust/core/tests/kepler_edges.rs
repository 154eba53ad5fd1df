//! The edges of Kepler's problem: radial and parabolic elements, refusals, infinite times, extreme units.

use core::f64::consts::PI;
use nalgebra::Vector3;
use visviva_core::nbody::anomalies::*;
use visviva_core::nbody::constants::{ConicConstants, period, semi_major_axis};
use visviva_core::nbody::elements::{Elements, free_fall_time};
use visviva_core::nbody::kepler::KeplerOrbit;
use visviva_core::nbody::state::{Anomaly, Shape, state_from_elements};

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{found:?} ≠ {expected:?}");
}

#[test]
fn elements_of_a_radial_ellipse() {
    // At rest at r = 2, then at r = 1 on the way down and up: a = 1, E − sin E = M, cos E = 1 − r/a.
    let rest = Elements::from_state(1.0, Vector3::new(0.0, 2.0, 0.0), Vector3::zeros()).unwrap();
    assert_eq!(
        (rest.eccentricity, rest.pericenter, rest.semi_minor_axis, rest.areal_rate),
        (1.0, 0.0, 0.0, 0.0)
    );
    assert_eq!(
        (rest.semi_major_axis, rest.apocenter, rest.energy, rest.semi_latus_rectum),
        (1.0, 2.0, -0.5, 0.0)
    );
    close(rest.eccentric_anomaly.abs(), PI);
    close(rest.time_since_pericenter.abs(), PI);
    assert_eq!(rest.laplace_runge_lenz, Vector3::new(0.0, -1.0, 0.0));
    assert!(rest.inclination.is_nan() && rest.node.is_nan() && rest.argument_of_pericenter.is_nan());
    assert!(rest.hodograph_radius.is_infinite());
    for sign in [-1.0, 1.0] {
        let moving = Elements::from_state(1.0, Vector3::x(), Vector3::x() * sign).unwrap();
        assert_eq!((moving.eccentricity, moving.pericenter), (1.0, 0.0));
        close(moving.semi_major_axis, 1.0);
        close(moving.eccentric_anomaly, sign * PI / 2.0);
        close(moving.mean_anomaly, sign * (PI / 2.0 - 1.0));
        close(moving.time_since_pericenter, sign * (PI / 2.0 - 1.0));
    }
}

#[test]
fn elements_of_radial_escape_and_repulsion() {
    // v² = 2μ/r is the radial parabola: r³ = 9μt²/2.
    let escape = Elements::from_state(1.0, Vector3::new(0.0, 0.0, 2.0), Vector3::z()).unwrap();
    assert_eq!((escape.energy, escape.eccentricity, escape.pericenter), (0.0, 1.0, 0.0));
    assert!(escape.semi_major_axis.is_infinite() && escape.period.is_infinite());
    close(escape.time_since_pericenter, (16.0f64 / 9.0).sqrt());
    close(escape.turning_angle, PI);
    // Head-on against a repulsive center: turned back at |μ|/E, e = 1 as the limit of p → 0.
    let back = Elements::from_state(-1.0, Vector3::new(2.0, 0.0, 0.0), Vector3::zeros()).unwrap();
    assert_eq!((back.energy, back.eccentricity, back.pericenter), (0.5, 1.0, 2.0));
    assert_eq!(back.time_since_pericenter, 0.0);
    close(back.turning_angle, PI);
}

#[test]
fn elements_of_a_parabola() {
    // r = (2, 1, 2), |r| = 3, v² = 2μ/r exactly with μ = 1.5.
    for v in [Vector3::new(0.0, 0.0, 1.0), Vector3::new(-0.6, 0.0, -0.8), Vector3::new(0.0, 1.0, 0.0)] {
        let r = Vector3::new(2.0, 1.0, 2.0);
        let found = Elements::from_state(1.5 * v.norm_squared(), r, v).unwrap();
        let l2 = r.cross(&v).norm_squared();
        if found.energy == 0.0 {
            assert_eq!(found.eccentricity, 1.0);
            assert!(found.semi_major_axis.is_infinite() && found.semi_minor_axis.is_infinite());
            close(found.turning_angle, PI);
        }
        close(found.pericenter, l2 / (3.0 * v.norm_squared()));
        // r = q (1 + D²), D = tan(ν/2), r·v > 0 after the pericenter.
        let d = (3.0 / found.pericenter - 1.0).sqrt().copysign(r.dot(&v));
        assert!((found.true_anomaly - 2.0 * d.atan()).abs() < 1e-15);
        if found.energy == 0.0 {
            assert!((found.eccentric_anomaly - d).abs() <= 4.0 * f64::EPSILON * d.abs());
            close(found.mean_anomaly, mean_from_parabolic(d));
            let rate = (1.5 * v.norm_squared() / (2.0 * found.pericenter.powi(3))).sqrt();
            close(found.time_since_pericenter, found.mean_anomaly / rate);
        }
    }
}

#[test]
fn state_from_elements_refuses_by_name() {
    let good = [1.0, 1.0, 0.5, 0.1, 0.2, 0.3, 0.4];
    let call = |x: [f64; 7]| {
        let [mu, pericenter, eccentricity, inclination, node, argument_of_pericenter, nu] = x;
        let shape = Shape { pericenter, eccentricity, inclination, node, argument_of_pericenter };
        state_from_elements(mu, shape, Anomaly::True(nu))
    };
    let _ = call(good).unwrap();
    let hyperbola = [1.0, 1.0, 2.0, 0.1, 0.2, 0.3, 2.0];
    let _ = call(hyperbola).unwrap();
    for (base, place, value, name) in [
        (good, 0, 0.0, "mu"),
        (good, 0, f64::NAN, "mu"),
        (good, 0, -1.0, "eccentricity"),
        (good, 1, 0.0, "pericenter"),
        (good, 1, f64::INFINITY, "pericenter"),
        (good, 2, -0.1, "eccentricity"),
        (good, 2, f64::NAN, "eccentricity"),
        (good, 3, f64::NAN, "angles"),
        (good, 3, -0.1, "inclination"),
        (good, 3, PI.next_up(), "inclination"),
        (good, 5, f64::INFINITY, "angles"),
        (good, 6, f64::INFINITY, "true_anomaly"),
        (hyperbola, 6, 2.1, "true_anomaly"),
        (hyperbola, 6, PI, "true_anomaly"),
        (hyperbola, 0, -1.0, "true_anomaly"),
    ] {
        let mut bad = base;
        bad[place] = value;
        assert!(call(bad).unwrap_err().to_string().starts_with(name), "{name}");
    }
}

#[test]
fn an_infinite_time_is_no_state() {
    for (mu, v) in [(1.0, 1.0), (1.0, 2.0), (-1.0, 1.0), (0.0, 1.0)] {
        let orbit = KeplerOrbit::new(mu, Vector3::x(), Vector3::y() * v).unwrap();
        for t in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let (r, v) = orbit.state(t);
            assert!(r.iter().chain(v.iter()).all(|x| x.is_nan()));
        }
    }
}

#[test]
fn anomalies_at_the_ends_of_their_ranges() {
    close(parabolic_anomaly(1e210), 3e210f64.cbrt());
    close(parabolic_anomaly(-1e-200), -1e-200);
    assert_eq!(true_from_hyperbolic(3000.0, 2.0, false), true_from_hyperbolic(90.0, 2.0, false));
    close(true_from_hyperbolic(-3000.0, 2.0, false), -(-0.5f64).acos());
    for (name, anomaly, e, argument) in [
        ("eccentric_from_mean", 1.0, 1.0, "eccentricity"),
        ("true_from_eccentric", 1.0, f64::NAN, "eccentricity"),
        ("mean_from_hyperbolic", 1.0, 1.0, "eccentricity"),
        ("hyperbolic_from_true", 2.2, 2.0, "true_anomaly"),
        ("parabolic_from_true", PI, 1.0, "true_anomaly"),
        ("mean_from_parabolic", f64::NAN, 1.0, "parabolic"),
        ("true_from_mean", 1.0, 0.5, "name"),
    ] {
        assert!(convert(name, anomaly, e, false).unwrap_err().to_string().starts_with(argument), "{name}");
    }
}

#[test]
fn constants_agree_with_those_of_a_state_and_know_no_units() {
    for (mass, strength, r, v) in [(2.0, 3.0, 1.25, 0.875), (0.5, 1.0, 1.0, 3.0), (1.5, -2.0, 1.0, 0.5)] {
        let state =
            ConicConstants::from_state(mass, strength, Vector3::x() * r, Vector3::new(0.25, v, 0.0)).unwrap();
        let found =
            ConicConstants::from_constants(mass, strength, state.angular_momentum, state.energy).unwrap();
        let numbers = |c: &ConicConstants| {
            [c.eccentricity, c.semi_major_axis, c.semi_minor_axis, c.r_min, c.areal_rate]
        };
        for (a, b) in numbers(&found).into_iter().zip(numbers(&state)) {
            assert!((a - b).abs() <= 16.0 * f64::EPSILON * b, "{a} {b}");
        }
        // Lengths × 2^300, times × 2^-200, masses × 2^100: energy × 2^(100 + 1000) would overflow; here × 2^-100 first.
        let (length, speed, unit) = (2f64.powi(300), 2f64.powi(-350), 2f64.powi(100));
        let large = ConicConstants::from_constants(
            mass * unit,
            strength * unit * speed * speed * length,
            state.angular_momentum * unit * speed * length,
            state.energy * unit * speed * speed,
        )
        .unwrap();
        assert_eq!(large.semi_major_axis, found.semi_major_axis * length);
        assert_eq!(large.eccentricity, found.eccentricity);
        assert_eq!(large.r_min, found.r_min * length);
        assert_eq!(large.period, found.period * length / speed);
    }
    close(period(1e250, 1e-100).unwrap(), 2.0 * PI * 1e-275);
    close(free_fall_time(1e250, 1e-100, 0.0).unwrap(), PI * 0.125f64.sqrt() * 1e-275);
}

/// tan(ν/2) = √3 tanh(H/2) for e = 2, to second order at small ν; 1 + w alone keeps none of these digits.
#[test]
fn a_small_true_anomaly_keeps_its_digits() {
    for nu in [1e-8, 1e-10, 1e-15, 1e-300] {
        close(hyperbolic_from_true(nu, 2.0, false), nu / 3f64.sqrt());
        close(hyperbolic_from_true(-nu, 2.0, false), -nu / 3f64.sqrt());
    }
}

/// β = −2⁻⁸⁰: for 2^120 dynamical times the hyperbola is a parabola, r³ = 9μt²/2 up to terms of q/r.
#[test]
fn a_near_parabola_is_not_straight_before_its_time() {
    let v = Vector3::new(1.0, 1.0, 2f64.powi(-40));
    let orbit = KeplerOrbit::new(1.0, Vector3::x(), v).unwrap();
    for k in [61, 75, 90] {
        let t = 2f64.powi(k);
        let (position, velocity) = orbit.state(t);
        let distance = (4.5_f64 * t * t).cbrt();
        // Of relative order β r/μ ≤ 2^-20 and (q/r)^½ ≥ 2^-20.
        assert!((position.norm() / distance - 1.0).abs() < 1e-5, "{:e} {distance:e}", position.norm());
        assert!((velocity.norm() / (2.0 / distance).sqrt() - 1.0).abs() < 1e-5);
    }
}

/// Radial escape from a force of 2^-290 of what the speed asks for: a straight line to 87 digits. On the way Kepler's
/// equation holds the square of 10^207.
#[test]
fn a_weak_force_at_late_times_bends_nothing() {
    for (start, mu) in [(1.0, 2f64.powi(-290)), (1.0, -(2f64.powi(-290))), (2f64.powi(40), 2f64.powi(-250))] {
        let orbit = KeplerOrbit::new(mu, Vector3::x() * start, Vector3::x()).unwrap();
        for t in [1e100, 1e119, 1e200] {
            let (position, velocity) = orbit.state(t);
            close(position.x, t);
            close(velocity.x, 1.0);
        }
    }
}

/// Lengths, speeds and times from end to end of f64: what is a number comes out as one, what is not is infinite.
#[test]
fn open_motion_at_any_time_in_any_unit() {
    // Free, from 1e-300 at speed 1.
    let free = |r: f64, v: f64| KeplerOrbit::new(0.0, Vector3::x() * r, Vector3::y() * v).unwrap();
    assert_eq!(free(1e-300, 1.0).state(1e5).0, Vector3::new(1e-300, 1e5, 0.0));
    assert_eq!(free(1.0, 1e-5).state(1e302).0, Vector3::new(1.0, 1e-5 * 1e302, 0.0));
    assert_eq!(free(1.0, 1e300).state(1e300).0, Vector3::new(1.0, f64::INFINITY, 0.0));
    assert_eq!(free(1e308, 1e-308).state(1e308).0, Vector3::new(1e308, 1e-308 * 1e308, 0.0));
    // A hyperbola and a parabola whose dynamical time is 2^-1000.
    let unit = 2f64.powi(-1000);
    let hyperbola = |r: f64| KeplerOrbit::new(r, Vector3::x() * r, Vector3::y() * 2.0).unwrap();
    let (now, _) = hyperbola(unit).state(1e5);
    let speed = 2f64.sqrt(); // v∞² = v² − 2μ/r
    close(now.norm(), speed * 1e5);
    let parabola = |r: f64| KeplerOrbit::new(r, Vector3::x() * r, Vector3::new(1.0, 1.0, 0.0)).unwrap();
    for t in [1e-20_f64, 1.0, 1e10] {
        // r³ = 9μt²/2, the rest is (q/r)^½ < 2^-300 of it.
        let distance = (4.5_f64 * t * t).cbrt() * unit.cbrt();
        close(parabola(unit).state(t).0.norm(), distance);
        close(parabola(unit).state(t).1.norm(), (2.0 * unit / distance).sqrt());
    }
    // In the units of the rest: the same digits.
    let (far, _) = parabola(1.0).state(2f64.powi(1000));
    close(parabola(unit).state(1.0).0.norm(), far.norm() * unit);
}

/// Lengths that overflow are infinite or refused, and nothing is 0 · ∞.
#[test]
fn elements_that_overflow_are_infinite() {
    let far = Elements::from_state(1e308, Vector3::x() * 1e230, Vector3::y() * 1e79).unwrap();
    assert_eq!(far.angular_momentum, Vector3::new(0.0, 0.0, f64::INFINITY));
    assert!(!far.laplace_runge_lenz.iter().any(|component| component.is_nan()));
    let shape = |pericenter, eccentricity| Shape {
        pericenter,
        eccentricity,
        inclination: 0.0,
        node: 0.0,
        argument_of_pericenter: 0.0,
    };
    // The speed at 1e-100 of a mass of 1e300 is 1e200, though μ/r is not a number.
    let (_, velocity) = state_from_elements(1e300, shape(1e-100, 0.0), Anomaly::True(0.0)).unwrap();
    close(velocity.y, 1e200);
    assert!(
        state_from_elements(1.0, shape(1e305, 1.0), Anomaly::True(core::f64::consts::PI - 1e-4)).is_err()
    );
}

/// An angular momentum of 2^±900 times what energy and strength make: e = √(1 + 2El²/mγ²) and the rest, of which l²
/// would leave the range.
#[test]
fn constants_of_any_angular_momentum() {
    for k in [300, 480] {
        let l = 2f64.powi(k);
        for strength in [1.0, -1.0] {
            // m = 1, E = 1/2, γ = ±1: a = 1, b = l, e = √(1 + l²).
            let wide = ConicConstants::from_constants(1.0, strength, l, 0.5).unwrap();
            assert_eq!((wide.semi_minor_axis, wide.eccentricity, wide.r_min), (l, l, l), "{k} {strength}");
            assert_eq!(
                (wide.semi_latus_rectum, wide.areal_rate, wide.turning_angle),
                (l * l, 0.5 * l, 2.0 / l)
            );
            let narrow = ConicConstants::from_constants(1.0, strength, 1.0 / l, 0.5).unwrap();
            let r_min = if strength > 0.0 { 0.5 / l / l } else { 2.0 };
            assert_eq!((narrow.semi_minor_axis, narrow.eccentricity, narrow.r_min), (1.0 / l, 1.0, r_min));
            assert_eq!((narrow.semi_latus_rectum, narrow.areal_rate), (1.0 / l / l, 0.5 / l));
        }
        let fall = ConicConstants::from_constants(1.0, 1.0, 1.0 / l, -0.5).unwrap();
        assert_eq!((fall.r_min, fall.r_max, fall.eccentricity), (0.5 / l / l, 2.0, 1.0));
        assert!(
            ConicConstants::from_constants(1.0, 1.0, l, -0.5).unwrap_err().to_string().starts_with("energy")
        );
    }
}

#[test]
fn the_semi_major_axis_of_a_period_in_any_units() {
    // The period of what comes back is the one given: of relative errors, those of a count 3/2 in the period.
    for exponent in -280..280 {
        for mu in [1.0, 3.7e-100, 8.1e77, 5.3e140] {
            let time = 1.7 * 10.0_f64.powi(exponent / 2);
            let a = semi_major_axis(mu, time).unwrap();
            close(period(mu, a).unwrap(), time);
        }
    }
    close(semi_major_axis(1.0, 16.0 * PI).unwrap(), 4.0);
    close(semi_major_axis(1e250, 2.0 * PI * 1e-275).unwrap(), 1e-100);
    for (mu, time) in [(0.0, 1.0), (-1.0, 1.0), (1.0, 0.0), (1.0, f64::INFINITY), (f64::NAN, 1.0)] {
        assert!(semi_major_axis(mu, time).is_err());
    }
}
