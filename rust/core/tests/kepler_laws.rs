//! Laws of Kepler's problem over random orbits, and the golden cases of tests/reference.

use nalgebra::Vector3;
use proptest::prelude::*;
use visviva_core::nbody::anomalies::*;
use visviva_core::nbody::elements::{Elements, free_fall_time};
use visviva_core::nbody::kepler::{KeplerOrbit, propagate};
use visviva_core::nbody::state::{Anomaly, Shape, state_from_elements};
use visviva_core::nbody::two_body::TwoBody;

const EPSILON: f64 = f64::EPSILON;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-size..size, -size..size, -size..size].prop_map(|[x, y, z]| Vector3::new(x, y, z))
}

fn close(found: f64, expected: f64, ulps: f64) {
    assert!((found - expected).abs() <= ulps * EPSILON * expected.abs(), "{found:?} ≠ {expected:?}");
}

fn tilted(pericenter: f64, eccentricity: f64) -> Shape {
    Shape { pericenter, eccentricity, inclination: 0.4, node: 1.0, argument_of_pericenter: -2.0 }
}

/// |L|, |A| and energy, with the sizes of the terms they are made of.
fn invariants(mu: f64, r: &Vector3<f64>, v: &Vector3<f64>) -> (f64, Vector3<f64>, Vector3<f64>) {
    let l = r.cross(v);
    (0.5 * v.norm_squared() - mu / r.norm(), l, v.cross(&l) - r * (mu / r.norm()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn energy_angular_momentum_and_lenz_vector_stay(
        mu in -2.0..2.0f64, r in vector(2.0), v in vector(1.5), t in -1e4..1e4f64,
    ) {
        prop_assume!(r.norm() > 1e-3);
        let (r1, v1) = KeplerOrbit::new(mu, r, v).unwrap().state(t);
        let (e0, l0, a0) = invariants(mu, &r, &v);
        let (e1, l1, a1) = invariants(mu, &r1, &v1);
        // The state carries a few ulps; each invariant feels them by the size of its terms.
        let terms = |r: &Vector3<f64>, v: &Vector3<f64>| v.norm_squared() + mu.abs() / r.norm();
        let scale = terms(&r, &v).max(terms(&r1, &v1));
        prop_assert!((e1 - e0).abs() <= 8.0 * EPSILON * scale, "energy {}", (e1 - e0).abs() / scale / EPSILON);
        let reach = (r.norm() * v.norm()).max(r1.norm() * v1.norm());
        prop_assert!((l1 - l0).norm() <= 8.0 * EPSILON * reach, "L {}", (l1 - l0).norm() / reach / EPSILON);
        let size = mu.abs() + (r.norm() * v.norm_squared()).max(r1.norm() * v1.norm_squared());
        prop_assert!((a1 - a0).norm() <= 16.0 * EPSILON * size, "A {}", (a1 - a0).norm() / size / EPSILON);
    }

    #[test]
    fn powers_of_two_change_no_bit(
        mu in -2.0..2.0f64, r in vector(2.0), v in vector(1.5), t in -1e3..1e3f64, k in -150i32..150, m in -150i32..150,
    ) {
        prop_assume!(r.norm() > 1e-3);
        let (length, speed) = (2f64.powi(k), 2f64.powi(m));
        let (r1, v1) = KeplerOrbit::new(mu, r, v).unwrap().state(t);
        let (r2, v2) = KeplerOrbit::new(mu * length * speed * speed, r * length, v * speed).unwrap()
            .state(t * length / speed);
        prop_assert_eq!(r2, r1 * length);
        prop_assert_eq!(v2, v1 * speed);
    }

    #[test]
    fn reversed_velocity_retraces(mu in -2.0..2.0f64, r in vector(2.0), v in vector(1.5), t in -1e3..1e3f64) {
        prop_assume!(r.norm() > 1e-3);
        let (r1, v1) = KeplerOrbit::new(mu, r, v).unwrap().state(t);
        let (r2, v2) = KeplerOrbit::new(mu, r, -v).unwrap().state(-t);
        prop_assert!((r2 - r1).norm() <= 8.0 * EPSILON * r1.norm());
        prop_assert!((v2 + v1).norm() <= 8.0 * EPSILON * v1.norm());
    }

    #[test]
    fn two_steps_are_one(mu in 0.5..2.0f64, q in 0.2..2.0f64, e in 0.0..3.0f64, a in -2.0..2.0f64, b in -2.0..2.0f64) {
        let (r, v) = state_from_elements(mu, tilted(q, e), Anomaly::True(0.3)).unwrap();
        let first = KeplerOrbit::new(mu, r, v).unwrap();
        let (r1, v1) = first.state(a);
        let (r2, v2) = KeplerOrbit::new(mu, r1, v1).unwrap().state(b);
        let (r3, v3) = first.state(a + b);
        // The rounding of the middle state grows with t times the tidal rate, at most about 1 + 3 μ t²/q³.
        let growth = 1.0 + 3.0 * mu * b * b / (q * q * q);
        prop_assert!((r2 - r3).norm() <= 40.0 * growth * EPSILON * r3.norm().max(r1.norm()));
        prop_assert!((v2 - v3).norm() <= 40.0 * growth * EPSILON * (2.0 * mu / q + v.norm_squared()).sqrt());
    }

    #[test]
    fn the_map_keeps_areas(mu in -2.0..2.0f64, r in vector(2.0), v in vector(1.5), t in -20.0..20.0f64) {
        // f ġ − ḟ g = |r₁×v₁|/|r₀×v₀| with the signs of L: here as (r₁×v₁)·L = L².
        prop_assume!(r.norm() > 1e-2);
        let l = r.cross(&v);
        prop_assume!(l.norm() > 1e-2 * r.norm() * v.norm());
        let (r1, v1) = KeplerOrbit::new(mu, r, v).unwrap().state(t);
        let (f, g) = (r1.cross(&v).dot(&l), r.cross(&r1).dot(&l));
        let (f_rate, g_rate) = (v1.cross(&v).dot(&l), r.cross(&v1).dot(&l));
        let determinant = (f * g_rate - f_rate * g) / l.norm_squared().powi(2);
        let size = ((f * g_rate).abs() + (f_rate * g).abs()) / l.norm_squared().powi(2)
            + r1.norm() * v1.norm() * r.norm() * v.norm() / l.norm_squared();
        prop_assert!((determinant - 1.0).abs() <= 16.0 * EPSILON * size.max(1.0));
    }

    #[test]
    fn never_a_nan(
        mu in -1e3..1e3f64, r in vector(2.0), v in vector(1.5), unit in -330i32..330, digits in -2.0..2.0f64, power in -1000i32..1000,
        still in any::<bool>(), radial in any::<bool>(),
    ) {
        let v = if still { v * 0.0 } else if radial { r * v.x } else { v };
        let scale = 2f64.powi(unit);
        for time in [digits * 2f64.powi(power), digits, digits * scale] {
            let orbit = KeplerOrbit::new(mu, r * scale, v);
            prop_assume!(orbit.is_ok());
            let (r1, v1) = orbit.unwrap().state(time);
            prop_assert!(!r1.iter().chain(v1.iter()).any(|x| x.is_nan()), "{r1:?} {v1:?} at {time:e}");
        }
    }

    #[test]
    fn mean_anomaly_returns(e in 0.0..1.0f64, mean in -3.1..3.1f64, turns in -1000i32..1000) {
        let anomaly = eccentric_anomaly(mean, e).unwrap();
        // M(E): dM/dE ≤ 1 + e, so E's rounding gives at most (1 + e)|E| ulps/2 in M.
        prop_assert!((mean_from_eccentric(anomaly, e) - mean).abs() <= 4.0 * EPSILON * anomaly.abs());
        let whole = f64::from(turns) * 2.0 * core::f64::consts::PI;
        let far = eccentric_anomaly(mean + whole, e).unwrap();
        prop_assert!((mean_from_eccentric(far, e) - (mean + whole)).abs() <= 4.0 * EPSILON * far.abs());
    }

    #[test]
    fn hyperbolic_mean_anomaly_returns(e in 1.0..10.0f64, mean in -1e6..1e6f64, repulsive in any::<bool>()) {
        let h = hyperbolic_anomaly(mean, e, repulsive).unwrap();
        let slope = e * h.cosh() + if repulsive { 1.0 } else { -1.0 };
        let back = mean_from_hyperbolic(h, e, repulsive);
        prop_assert!((back - mean).abs() <= 4.0 * EPSILON * (mean.abs() + slope * h.abs()), "{back} {mean} {e}");
        let nu = true_from_hyperbolic(h.clamp(-3.0, 3.0), e, repulsive);
        let again = hyperbolic_from_true(nu, e, repulsive);
        if e > 1.1 {
            // dH/dν ≤ cosh²(H/2)·√(e+1)/√(e−1) ≤ 26 at |H| = 3.
            prop_assert!((again - h.clamp(-3.0, 3.0)).abs() <= 150.0 * EPSILON);
        }
    }

    #[test]
    fn elements_give_the_state_back(
        mu in 0.5..2.0f64, q in 0.1..3.0f64, e in 0.01..4.0f64, i in 0.1..3.0f64, node in -3.1..3.1f64,
        w in -3.1..3.1f64, part in -0.9..0.9f64, repulsive in any::<bool>(),
    ) {
        let mu = if repulsive && e > 1.2 { -mu } else { mu };
        let asymptote = if mu < 0.0 { (1.0 / e).acos() } else if e > 1.0 { (-1.0 / e).acos() } else { 3.1 };
        let shape = Shape { pericenter: q, eccentricity: e, inclination: i, node, argument_of_pericenter: w };
        let (r, v) = state_from_elements(mu, shape, Anomaly::True(part * asymptote)).unwrap();
        let found = Elements::from_state(mu, r, v).unwrap();
        // e and ω feel the state's rounding by about 1/e and by 1/|1 − e cos …| near the asymptote.
        let grown = 400.0 * EPSILON * (1.0 + 1.0 / e) * (1.0 + e) / (1.0 - part.abs());
        prop_assert!((found.eccentricity - e).abs() <= grown);
        prop_assert!((found.pericenter - q).abs() <= grown * q);
        prop_assert!((found.inclination - i).abs() <= 60.0 * EPSILON);
        prop_assert!((found.node - node).abs() <= 60.0 * EPSILON / i.sin());
        prop_assert!((found.argument_of_pericenter - w).abs() <= grown / i.sin());
        prop_assert!((found.true_anomaly - part * asymptote).abs() <= grown);
        let (r0, _) = KeplerOrbit::new(mu, r, v).unwrap().state(-found.time_since_pericenter);
        prop_assert!((r0.norm() - q).abs() <= grown * q);
    }

    #[test]
    fn every_anomaly_gives_the_same_state(
        mu in 0.5..2.0f64, q in 0.1..3.0f64, kind in 0..4usize, apart in 0.01..3.0f64, x in -2.5..2.5f64,
    ) {
        // E or H or D is x; its true and mean anomaly are the conversions', tested above against each other.
        let (mu, e) = match kind {
            0 => (mu, 1.0 / (1.0 + apart)),
            1 => (mu, 1.0),
            2 => (mu, 1.0 + apart),
            _ => (-mu, 1.0 + apart),
        };
        let (nu, mean) = match kind {
            0 => (true_from_eccentric(x, e), mean_from_eccentric(x, e)),
            1 => (true_from_parabolic(x), mean_from_parabolic(x)),
            _ => (true_from_hyperbolic(x, e, kind == 3), mean_from_hyperbolic(x, e, kind == 3)),
        };
        let at = |anomaly| state_from_elements(mu, tilted(q, e), anomaly).unwrap();
        let (r, v) = at(Anomaly::Eccentric(x));
        for (r1, v1) in [at(Anomaly::True(nu)), at(Anomaly::Mean(mean))] {
            // Near an asymptote or e = 1 the place feels a rounding of ν by r/p, and E one of M by dE/dM < 1/(1 − e).
            let growth = 1.0 + 1.0 / (e - 1.0).abs().max(if kind == 1 { 1.0 } else { 0.0 }) + r.norm() / q;
            prop_assert!((r1 - r).norm() <= 20.0 * growth * EPSILON * r.norm());
            prop_assert!((v1 - v).norm() <= 20.0 * growth * EPSILON * v.norm().max((mu.abs() / q).sqrt()));
        }
        // And the state of a mean anomaly is the pericenter's state, moved on by the time that belongs to it.
        let (r0, v0) = at(Anomaly::Mean(0.0));
        let rate = if kind == 1 {
            (0.5 * mu / q).sqrt() / q
        } else {
            let a = q / if kind == 3 { e + 1.0 } else { (e - 1.0).abs() };
            (mu.abs() / a).sqrt() / a
        };
        let (r2, _) = KeplerOrbit::new(mu, r0, v0).unwrap().state(mean / rate);
        // The period of a given state near e = 1 is known to ε/|1 − e| only.
        let doubt = 60.0 * (1.0 + 1.0 / (e - 1.0).abs().max(if kind == 1 { 1.0 } else { 0.0 }));
        prop_assert!((r2 - r).norm() <= doubt * EPSILON * r.norm().max(q), "{} {}", (r2 - r).norm(), r.norm());
    }
}

#[test]
fn time_zero_gives_the_input_bits_and_tiny_times_move_by_v_t() {
    let (r, v) = (Vector3::new(0.1, -0.7, 1e-300), Vector3::new(0.3, 1e-3, -0.2));
    let orbit = KeplerOrbit::new(1.0, r, v).unwrap();
    assert_eq!(orbit.state(0.0), (r, v));
    assert_eq!(orbit.state(1e-20), (r + v * 1e-20, v));
}

#[test]
fn refusals_name_the_argument() {
    let (r, v) = (Vector3::x(), Vector3::y());
    for (bad, name) in [
        (propagate(f64::NAN, r, v, &[1.0]), "mu"),
        (propagate(1.0, r * 0.0, v, &[1.0]), "position"),
        (propagate(1.0, r, v * f64::INFINITY, &[1.0]), "velocity"),
        (propagate(1.0, r, v, &[f64::NAN]), "times"),
    ] {
        assert!(bad.unwrap_err().to_string().starts_with(name));
    }
}

#[test]
fn golden_conics() {
    let ellipse =
        Elements::from_state(1.5, Vector3::new(1.25, 0.0, 0.0), Vector3::new(0.25, 0.875, 0.0)).unwrap();
    close(2.0 * ellipse.angular_momentum.z, 2.1875, 4.0);
    close(2.0 * ellipse.energy, -1.571875, 4.0);
    close(ellipse.eccentricity, 0.40528899422116754, 4.0);
    close(ellipse.semi_major_axis, 0.9542743538767395, 4.0);
    close(ellipse.semi_minor_axis, 0.8723867537459129, 4.0);
    close(ellipse.semi_latus_rectum, 0.7975260416666666, 4.0);
    close(ellipse.pericenter, 0.5675174607829813, 4.0);
    close(ellipse.apocenter, 1.341031246970498, 4.0);
    close(ellipse.period, 4.782380394644103, 4.0);
    close(ellipse.argument_of_pericenter, -2.6750714892799112, 4.0);
    close(ellipse.areal_rate, 0.546875, 4.0);
    let hyperbola =
        Elements::from_state(1.0, Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.25, 1.75, 0.0)).unwrap();
    close(hyperbola.eccentricity, 2.108390974179125, 4.0);
    close(hyperbola.semi_major_axis, 0.8888888888888888, 4.0);
    close(hyperbola.semi_minor_axis, 1.6499158227686108, 4.0);
    close(hyperbola.turning_angle, 0.988326868348944, 4.0);
    // Repulsion from far away: L = 0.96, energy 0.72 (G7.25), here at the pericenter.
    let q = 1.7538089173336164;
    let repulsive =
        Elements::from_state(-1.0, Vector3::new(q, 0.0, 0.0), Vector3::new(0.0, 0.96 / q, 0.0)).unwrap();
    close(repulsive.energy, 0.72, 8.0);
    close(repulsive.eccentricity, 1.5254848409604076, 8.0);
    close(repulsive.turning_angle, 1.4297666016479786, 8.0);
    close(free_fall_time(1.0, 2.0, 0.0).unwrap(), core::f64::consts::PI, 2.0);
    close(free_fall_time(1.0, 2.0, 1.0).unwrap(), 2.5707963267948966, 2.0);
}

#[test]
fn golden_kepler_equations() {
    for (e, mean, anomaly, nu) in [
        (0.6, 1.0, 1.5997485482275293, 2.2372603507869133),
        (0.99, 0.01, 0.3422703164917751, 2.3631049522858083),
        (0.0, 1.0, 1.0, 1.0),
    ] {
        let found = eccentric_anomaly(mean, e).unwrap();
        // The rounding of e and M: dE = (dM + sin E de)/(1 − e cos E), 6 ulps at e = 0.99.
        close(found, anomaly, 6.0);
        close(true_from_eccentric(found, e), nu, 6.0);
        close(eccentric_from_true(nu, e), anomaly, 6.0);
    }
    let d = parabolic_anomaly(2.0);
    close(2.0 * d.atan(), 1.821159599328913, 2.0);
    // √(μ/(2q³)) t of G7.20-kepler-parabola: q = 1/2, t = 1.
    close(d + d * d * d / 3.0, 2.0, 2.0);
}

#[test]
fn golden_two_bodies_and_test_particles() {
    let states = [
        (Vector3::new(0.75, 0.0, 0.0), Vector3::new(0.0, 1.25, 0.5)),
        (Vector3::new(-0.25, 0.0, 0.0), Vector3::new(0.0, -0.25, 0.0)),
    ];
    let two = TwoBody::new(1.0, [1.0, 3.0], states).unwrap();
    let [(r1, v1), (r2, v2)] = two.states(2.0);
    let expected = [
        (r1, [0.7460180081182325, 0.30785794521630566, 0.26928598173876855]),
        (r2, [-0.24867266937274418, 0.23071401826123145, 0.24357133942041048]),
        (v1, [-0.154595653228204, 1.2440150962582925, 0.4980050320860975]),
        (v2, [0.05153188440940133, -0.2480050320860975, 0.0006649893046341696]),
    ];
    for (found, numbers) in expected {
        assert!((found - Vector3::from(numbers)).norm() < 4.0 * EPSILON, "{found} {numbers:?}");
    }
    close(two.relative().period(), 1.948479430524704, 2.0);
    let light = TwoBody::new(1.0, [1.0, 0.0], states).unwrap();
    assert_eq!(light.states(3.0)[0], (states[0].0 + states[0].1 * 3.0, states[0].1));
    assert!(TwoBody::new(1.0, [0.0, 0.0], states).is_err());
    let _ = TwoBody::new(1.0, [0.0, 2.0], states).unwrap();
}

/// Not a test of correctness: `cargo test --release --test kepler_laws -- --ignored --nocapture`.
#[test]
#[ignore = "measures time"]
fn nanoseconds_per_state() {
    for (name, mu, e) in [
        ("e = 0.1", 1.0, 0.1),
        ("e = 0.9", 1.0, 0.9),
        ("e = 0.9999", 1.0, 0.9999),
        ("e = 1", 1.0, 1.0),
        ("e = 3", 1.0, 3.0),
        ("repulsive", -1.0, 3.0),
    ] {
        let (r, v) = state_from_elements(mu, tilted(1.0, e), Anomaly::True(0.3)).unwrap();
        let orbit = KeplerOrbit::new(mu, r, v).unwrap();
        let (mut best, mut made) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..10 {
            let start = std::time::Instant::now();
            for i in 0..20_000 {
                let _ = std::hint::black_box(orbit.state(std::hint::black_box(f64::from(i) * 0.37)));
            }
            best = best.min(start.elapsed().as_nanos() as f64 / 20_000.0);
            let start = std::time::Instant::now();
            for _ in 0..1000 {
                let _ = std::hint::black_box(KeplerOrbit::new(std::hint::black_box(mu), r, v));
            }
            made = made.min(start.elapsed().as_nanos() as f64 / 1000.0);
        }
        println!("{name}: {best:.0} ns per state, {made:.0} ns to prepare");
    }
}

#[test]
fn a_parabola_far_away_keeps_its_power_law() {
    // r → (9 μ t²/2)^(1/3), from a radial parabola exactly: μ = 1, r = 2, v = 1.
    let orbit = KeplerOrbit::new(1.0, Vector3::new(2.0, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0)).unwrap();
    let (r, v) = orbit.state(1e150);
    close(r.x, 4.5f64.cbrt() * 1e100, 8.0);
    close(v.x, (2.0 / r.x).sqrt(), 8.0);
}
