//! Runs with a fixed step: their nodes, their limit, their round-off.

use super::super::support::{
    Keep, Problem, advance, distance, exactly, fixed_stepper, harmonic, three_bodies,
};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::ode::Method;
use visviva_core::ode::fixed::{Ended, Place, place, run};
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

#[test]
fn times_find_their_place_among_the_nodes() {
    let on = |node| Place { node, past: None };
    assert_eq!(place(0.0, 0.1, 0.0), on(0));
    // 0.3 is not 3·0.1, but cannot be told from it; nor is -0.3 with a step of -0.1.
    assert_eq!(place(0.3, 0.1, 0.3), on(3));
    assert_eq!(place(-0.3, -0.1, 0.3), on(3));
    assert_eq!(place(0.25, 0.1, 0.25), Place { node: 2, past: Some(0.25 - 2.0 * 0.1) });
    assert_eq!(place(0.28, 0.1, 0.28), Place { node: 2, past: Some(0.28 - 2.0 * 0.1) });
    assert_eq!(place(-0.28, -0.1, 0.28), Place { node: 2, past: Some(-0.28 + 2.0 * 0.1) });
    // Four units in the last place off is off; one is not.
    let off = 0.3 + 4.0 * (0.3_f64).next_up() - 4.0 * 0.3;
    assert!(place(off, 0.1, 0.3).past.is_some());
    assert_eq!(place(0.3_f64.next_up(), 0.1, 0.3), on(3));
    // Far from zero the time itself is coarser.
    assert_eq!(place(0.3 + 1e-10, 0.1, 1e6), on(3));
    // Where times are an eighth of a step apart each is meant; where they are a quarter, too.
    for spacing in [0.125, 0.25] {
        let place = place(spacing, 1.0, spacing * 8e15);
        assert_eq!(place, Place { node: 0, past: Some(spacing) });
    }
    // Beyond 2^51 steps.
    assert_eq!(place(3e15, 1.0, 3e15), on(3_000_000_000_000_000));
}

#[test]
fn a_run_stops_at_its_step_limit_and_records_nodes_to_the_bit() {
    for method in METHODS.iter().filter(|method| !method.adaptive()) {
        let control = Control::default();
        let mut ticker = Ticker::quiet(&control);
        let h = 1.0 / 32.0;
        let Problem { mut state, mut dynamics, .. } = three_bodies::<f64>();
        let mut seen = Keep(Vec::new());
        let places = [(0, None), (3, Some(0.01)), (3, Some(0.02)), (17, None), (25, None)]
            .map(|(node, past)| Place { node, past });
        let mut stepper = fixed_stepper(method, h, &dynamics, &state);
        let Ended { steps, outcome, .. } =
            run(&mut *stepper, 0, 20, &mut state, &mut dynamics, places.into_iter(), &mut ticker, &mut seen);
        outcome.unwrap();
        let seen = seen.0;
        assert_eq!((steps, seen.len()), (20, 4), "{}", method.name);
        // Nodes have the bits of plain steps, whatever was looked at on the way; 17 and 20 lie behind the start of a
        // multistep method.
        for (steps, state) in [(17, &seen[3].1), (20, &state)] {
            let Problem { state: mut plain, mut dynamics, .. } = three_bodies::<f64>();
            advance(method, h, steps, &mut plain, &mut dynamics);
            assert_eq!(state.all(), plain.all(), "{}", method.name);
        }
    }
}

/// How far 1e5 steps in `f64` end from the same steps in double-double: round-off alone.
///
/// The steps are small, so that what each loses of the state weighs more than what its force evaluations lose.
fn round_off(method: &'static Method, compensated: bool) -> f64 {
    let (h, steps) = (1.0 / 8192.0, 100_000);
    let Problem { mut state, mut dynamics, .. } = harmonic::<DoubleDouble>();
    advance(method, h, steps, &mut state, &mut dynamics);
    let exact = state;
    let Problem { mut state, mut dynamics, .. } = harmonic::<f64>();
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut stepper = fixed_stepper(method, h, &dynamics, &state);
    for node in 0..steps as u64 {
        assert_eq!(stepper.step(node, 1, &mut state, &mut dynamics, &mut ticker), Ok(1));
        if !compensated {
            state.all_mut().1.fill(0.0);
        }
    }
    stepper.settle(&mut state);
    distance(&exactly(&state), &exact)
}

#[test]
fn round_off_of_a_hundred_thousand_steps_stays_small_and_compensation_does_it() {
    for method in METHODS.iter().filter(|method| method.has_table()) {
        let (with, without) = (round_off(method, true), round_off(method, false));
        println!("{}: round-off {with:.1e}, without compensation {without:.1e}", method.name);
        assert!(with < 1e-15, "{}: {with:e}", method.name);
        assert!(without > 2e-15, "{}: {without:e} without compensation", method.name);
    }
}
