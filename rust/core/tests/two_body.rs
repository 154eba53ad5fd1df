//! Two bodies against a reference in double-double: mass ratios to 1e-15 and a center of mass far away.

use nalgebra::Vector3;
use proptest::prelude::*;
use visviva_core::nbody::kepler::KeplerOrbit;
use visviva_core::nbody::two_body::{PositionVelocity, TwoBody};
use visviva_core::numerics::double_double::DoubleDouble;

fn exact(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

/// m₁/M and m₂/M, and the center of mass as Σmx/M: the textbook's formulas, with 31 digits for their cancellations.
fn reference(masses: [f64; 2], states: [PositionVelocity; 2], t: f64) -> [[DoubleDouble; 3]; 2] {
    let total = DoubleDouble::sum(masses[0], masses[1]);
    let relative =
        KeplerOrbit::new(total.to_f64(), states[1].0 - states[0].0, states[1].1 - states[0].1).unwrap();
    let (r, _) = relative.state(t);
    [0, 1].map(|body| {
        core::array::from_fn(|c| {
            let weighted = |pick: fn(&PositionVelocity) -> Vector3<f64>| {
                (exact(masses[0]) * exact(pick(&states[0])[c])
                    + exact(masses[1]) * exact(pick(&states[1])[c]))
                    / total
            };
            let center = weighted(|state| state.0) + weighted(|state| state.1) * exact(t);
            let part = exact(masses[1 - body]) / total * exact(r[c]);
            if body == 0 { center - part } else { center + part }
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn each_body_is_rounded_once(
        ratio in -15.0..0.0f64, swap in any::<bool>(), far in prop_oneof![Just(0.0), Just(1e3), Just(1e9)],
        r in [-2.0..2.0f64, 0.1..2.0f64, -2.0..2.0f64], v in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
        drift in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64], t in -20.0..20.0f64,
    ) {
        let light = 10f64.powf(ratio);
        let masses = if swap { [light, 1.0] } else { [1.0, light] };
        let at = Vector3::new(far, -0.3 * far, 0.7);
        let states = [(at, Vector3::from(drift)), (at + Vector3::from(r), Vector3::from(drift) + Vector3::from(v))];
        let found = TwoBody::new(1.0, masses, states).unwrap().states(t);
        let expected = reference(masses, states, t);
        for body in 0..2 {
            for c in 0..3 {
                let error = (exact(found[body].0[c]) - expected[body][c]).to_f64().abs();
                // Half an ulp, which is at most ε/2 of the number; the reference itself is good to 2^-104 of its terms.
                let size = expected[body][c].to_f64().abs();
                prop_assert!(error <= 0.5 * f64::EPSILON * size + 1e-31 * (far + 50.0), "{error:e} of {size:e}");
            }
        }
    }
}

/// Bits of one body do not depend on how the masses are written.
#[test]
fn the_unit_of_mass_changes_no_bit() {
    let states = [(Vector3::new(1.0, 0.3, 0.0), Vector3::y()), (Vector3::new(-0.7, 0.1, 0.2), -Vector3::z())];
    let plain = TwoBody::new(1.0, [1.5, 0.3], states).unwrap().states(3.7);
    for k in [-900, -60, 60, 1022] {
        let unit = 2f64.powi(k);
        let scaled = TwoBody::new(1.0 / unit, [1.5 * unit, 0.3 * unit], states).unwrap().states(3.7);
        assert_eq!(plain, scaled);
    }
}

#[test]
fn the_epoch_gives_the_given_bits_and_a_massless_body_disturbs_nothing() {
    let states =
        [(Vector3::new(1.0, 0.3, 0.1), Vector3::y() * 0.1), (Vector3::new(-0.7, 0.1, 0.2), -Vector3::z())];
    assert_eq!(TwoBody::new(1.0, [0.1, 0.7], states).unwrap().states(0.0), states);
    // Also where the companion is so far off that 106 bits do not hold both places.
    let far = |k: f64| [states[0], (states[1].0 * k, states[1].1 * k)];
    for (heavy, states) in [(0, states), (1, states), (0, far(1e40)), (1, [far(1e40)[1], states[0]])] {
        let mut masses = [0.0; 2];
        masses[heavy] = 1.0;
        let found = TwoBody::new(1.0, masses, states).unwrap().states(-2.5);
        for c in 0..3 {
            // The straight line, rounded once.
            let line = exact(states[heavy].0[c]) + DoubleDouble::product(states[heavy].1[c], -2.5);
            assert_eq!(found[heavy].0[c], line.to_f64());
        }
        assert_eq!(found[heavy].1, states[heavy].1);
    }
}

/// Without a force a heavy body at rest stays there, whatever its light companion's place: the centre of mass is
/// counted from the heavy body, as 106 bits of 1e20 would leave 1e-12 of it.
#[test]
fn a_far_light_companion_moves_nothing() {
    let near = (Vector3::zeros(), Vector3::zeros());
    let far = (Vector3::new(-0.7, 0.1, 0.2) * 1e20, Vector3::zeros());
    for (masses, states, heavy) in [([0.7, 0.3e-10], [near, far], 0), ([0.3e-10, 0.7], [far, near], 1)] {
        let (r, _) = TwoBody::new(0.0, masses, states).unwrap().states(2.5)[heavy];
        // 106 bits of the 4e9 by which the centre of mass is off: 5e-23.
        assert!(r.norm() < 1e-22, "{:e}", r.norm());
    }
}

/// Units from end to end of f64 give the same digits; what overflows is infinite and never 0 · ∞.
#[test]
fn any_unit_of_length_and_time() {
    let states = [
        (Vector3::new(1.0, 0.25, 0.0), Vector3::new(0.0, 0.5, 0.125)),
        (Vector3::new(-0.75, 0.0, 0.5), Vector3::new(0.0, -0.5, 0.0)),
    ];
    let plain = TwoBody::new(1.0, [1.5, 0.5], states).unwrap().states(3.0);
    // G carries length³/time².
    for (length, time) in [(1000, 1000), (-900, -900), (1010, 980), (-600, 300), (300, -600)] {
        let (l, s) = (2f64.powi(length), 2f64.powi(length - time));
        let scaled = states.map(|(r, v)| (r * l, v * s));
        let Some(g) = Some(l * s * s).filter(|g| g.is_normal()) else { continue };
        let found = TwoBody::new(g, [1.5, 0.5], scaled).unwrap().states(3.0 * 2f64.powi(time));
        assert_eq!(found, plain.map(|(r, v)| (r * l, v * s)), "{length} {time}");
    }
    // A line that leaves the range, and one that does not though its parts would.
    let apart = [(Vector3::x(), Vector3::x() * 1e200), (-Vector3::x(), Vector3::x() * 1e200)];
    let gone = TwoBody::new(1.0, [1.0, 1.0], apart).unwrap().states(1e200);
    assert!(gone.iter().all(|(r, _)| r.x == f64::INFINITY && !r.y.is_nan()));
    let slow = apart.map(|(r, _)| (r, Vector3::y() * 1e-300));
    let moved = TwoBody::new(0.0, [1.0, 1.0], slow).unwrap().states(1e302);
    assert_eq!(moved[0].0, Vector3::new(1.0, 1e-300 * 1e302, 0.0));
}

#[test]
fn refusals_name_the_argument() {
    let states = [(Vector3::x(), Vector3::y()), (Vector3::z(), Vector3::zeros())];
    for (masses, states, name) in [
        ([-1.0, 1.0], states, "mass"),
        ([1.0, f64::INFINITY], states, "mass"),
        ([0.0, 0.0], states, "mass"),
        ([1.0, 1.0], [states[0], states[0]], "position"),
        (
            [1.0, 1.0],
            [(Vector3::x(), Vector3::x() * 1e308), (Vector3::y(), Vector3::x() * -1e308)],
            "velocity: expected two",
        ),
        ([1e308, 1e308], states, "mass"),
    ] {
        assert!(TwoBody::new(1.0, masses, states).unwrap_err().to_string().starts_with(name));
    }
}
