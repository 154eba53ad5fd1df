//! Two bodies against a reference in double-double: mass ratios to 1e-15 and a centre of mass far away.
#![allow(clippy::unwrap_used, missing_docs)]

use nalgebra::Vector3;
use proptest::prelude::*;
use visviva_core::nbody::kepler::KeplerOrbit;
use visviva_core::nbody::two_body::{State, TwoBody};
use visviva_core::numerics::double_double::DoubleDouble;

fn exact(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

/// m₁/M and m₂/M, and the centre of mass as Σmx/M: the textbook's formulas, with 31 digits for their cancellations.
fn reference(masses: [f64; 2], states: [State; 2], t: f64) -> [[DoubleDouble; 3]; 2] {
    let total = DoubleDouble::sum(masses[0], masses[1]);
    let relative =
        KeplerOrbit::new(total.to_f64(), states[1].0 - states[0].0, states[1].1 - states[0].1).unwrap();
    let (r, _) = relative.state(t);
    [0, 1].map(|body| {
        core::array::from_fn(|c| {
            let weighted = |pick: fn(&State) -> Vector3<f64>| {
                (exact(masses[0]) * exact(pick(&states[0])[c])
                    + exact(masses[1]) * exact(pick(&states[1])[c]))
                    / total
            };
            let centre = weighted(|state| state.0) + weighted(|state| state.1) * exact(t);
            let part = exact(masses[1 - body]) / total * exact(r[c]);
            if body == 0 { centre - part } else { centre + part }
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
    for heavy in 0..2 {
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

#[test]
fn refusals_name_the_argument() {
    let states = [(Vector3::x(), Vector3::y()), (Vector3::z(), Vector3::zeros())];
    for (masses, states, name) in [
        ([-1.0, 1.0], states, "mass"),
        ([1.0, f64::INFINITY], states, "mass"),
        ([0.0, 0.0], states, "mass"),
        ([1.0, 1.0], [states[0], states[0]], "position"),
    ] {
        assert!(TwoBody::new(1.0, masses, states).unwrap_err().to_string().starts_with(name));
    }
}
