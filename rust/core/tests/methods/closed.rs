//! Two or three bodies under Störmer's method: a kernel of their own, relative to the first body.

use super::super::support::{Problem, advance, distance, exactly, fixed_stepper};
use visviva_core::forces::gravity::FewBodies;
use visviva_core::forces::gravity::closed::ClosedKernel;
use visviva_core::forces::{Dynamics, Force};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::element::Shape;
use visviva_core::numerics::lanes::{Lanes, WIDTH};
use visviva_core::ode::Method;
use visviva_core::ode::methods::stormer13;
use visviva_core::ode::state::State;
use visviva_core::ode::system::System;
use visviva_core::parallel::{Control, Ticker};

const METHOD: &Method = &stormer13::METHOD;
const STEP: f64 = 1.0 / 64.0;

/// A number of body `i`, of component `c`, of system `system`: bound, no symmetry, a moving centre of mass.
fn number(kind: usize, i: usize, c: usize, system: usize) -> f64 {
    let places = [[0.0, 1.0, -1.5], [0.0, 0.25, 0.5], [0.0, -0.125, 0.375]];
    let speeds = [[0.375, 0.5, 1.0], [-0.25, 0.75, -0.5], [0.0, 0.125, -0.25]];
    let value = if kind == 0 { places[c][i] } else { speeds[c][i] };
    value + 0.01 * (system * (i + 2 * c + 1)) as f64 + if kind == 0 { 0.3 } else { 0.7 }
}

/// `count` systems of bodies of these masses in one state.
fn systems<S: ClosedKernel>(
    masses: &[f64],
    count: usize,
    components: usize,
    softening: f64,
    general: bool,
) -> Problem<S>
where
    FewBodies<S>: Force<S>,
{
    let bodies = masses.len();
    let shape = Shape { rows: count * bodies, components };
    let numbers = |kind: usize| -> Vec<S> {
        (0..shape.len())
            .map(|k| (k % shape.rows, k / shape.rows))
            .map(|(row, c)| S::splat(number(kind, row % bodies, c, row / bodies)))
            .collect()
    };
    let strength = masses.iter().cycle().take(shape.rows).map(|&mass| S::splat(mass)).collect();
    let gravity = FewBodies::new(shape, strength, vec![S::splat(softening); count]);
    Problem {
        dynamics: if general {
            Dynamics::new(shape, vec![Box::new(gravity)])
        } else {
            Dynamics::closed(gravity)
        },
        state: State::new(&numbers(0), &numbers(1)),
        mass: masses.iter().copied().cycle().take(shape.len()).collect(),
    }
}

#[test]
fn relative_to_one_body_all_move_as_they_do_one_by_one() {
    // The last repel each other.
    for masses in [&[1.0, 0.5, 0.25][..], &[0.25, 1.0, 1e-9], &[1.0, 0.5], &[-0.3, -0.2, -0.1]] {
        for (components, softening, count) in [(3, 0.0, 1), (3, 0.25, 2), (2, 0.0, 2), (2, 0.25, 1)] {
            let mut reached = [false, true].map(|general| {
                let Problem { mut state, mut dynamics, .. } =
                    systems::<DoubleDouble>(masses, count, components, softening, general);
                advance(METHOD, STEP, 60, &mut state, &mut dynamics);
                // One at every node, and twelve for each of the twelve steps that start.
                assert_eq!(dynamics.evaluations(), 12 * 12 + 1 + 48);
                state
            });
            let [closed, general] = &mut reached;
            // Digits of double-double, with steps enough to see any term that is missing.
            let difference = distance(closed, general);
            assert!(difference < 2e-28, "{masses:?}, {components}, {softening}: {difference:e}");
        }
    }
}

#[test]
fn the_centre_of_mass_moves_uniformly_to_twice_the_digits() {
    let masses = [0.3, 0.7, 0.11];
    let Problem { mut state, mut dynamics, .. } = systems::<f64>(&masses, 1, 3, 0.0, false);
    let center = |values: &[DoubleDouble], c: usize| {
        let total = masses.iter().fold(DoubleDouble::default(), |sum, &mass| sum + DoubleDouble::from(mass));
        let moment = (0..3)
            .fold(DoubleDouble::default(), |sum, i| sum + DoubleDouble::from(masses[i]) * values[c * 3 + i]);
        moment / total
    };
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    // A step whose multiples are no doubles.
    let step = 0.0157;
    let mut stepper = fixed_stepper(METHOD, step, &dynamics, &state);
    let mut node = 0;
    let mut after = |steps: usize| {
        for _ in 0..steps {
            assert_eq!(stepper.step(node, 1, &mut state, &mut dynamics, &mut ticker), Ok(1));
            node += 1;
        }
        stepper.settle(&mut state);
        exactly(&state)
    };
    // The steps that start are as any others.
    let (start, end) = (after(12), after(1000));
    for c in 0..3 {
        let drift = center(start.v(), c);
        let expected = center(start.q(), c) + drift * (DoubleDouble::from(1000.0) * DoubleDouble::from(step));
        let off = [center(end.q(), c) - expected, center(end.v(), c) - drift].map(|off| off.to_f64().abs());
        // Some units in the last place of double-double; velocities are rounded once more.
        assert!(off[0] < 1e-29 && off[1] < 4e-16, "{off:?}");
    }
}

#[test]
fn lanes_have_the_bits_of_single_trajectories_and_none_disturbs_another() {
    // Two systems of eight lanes; the masses of one lane are zero.
    let (bodies, count) = (3, 2);
    let shape = Shape { rows: count * bodies, components: 3 };
    let mass = |system: usize, lane: usize, i: usize| {
        if (system, lane) == (1, 3) { 0.0 } else { [1.0, 0.5, 0.25][i] }
    };
    let copy = |system: usize, lane: usize| system * WIDTH + lane;
    let numbers = |kind: usize| -> Vec<Lanes> {
        (0..shape.len())
            .map(|k| (k % shape.rows, k / shape.rows))
            .map(|(row, c)| {
                let (system, i) = (row / bodies, row % bodies);
                Lanes(core::array::from_fn(|lane| number(kind, i, c, copy(system, lane))))
            })
            .collect()
    };
    let strength = (0..shape.rows)
        .map(|row| Lanes(core::array::from_fn(|lane| mass(row / bodies, lane, row % bodies))))
        .collect();
    let mut dynamics = Dynamics::closed(FewBodies::new(shape, strength, vec![Lanes([0.0; WIDTH]); count]));
    let mut state = State::new(&numbers(0), &numbers(1));
    advance(METHOD, STEP, 40, &mut state, &mut dynamics);
    for (system, lane) in (0..count).flat_map(|system| (0..WIDTH).map(move |lane| (system, lane))) {
        let alone = Shape { rows: bodies, components: 3 };
        let numbers = |kind: usize| -> Vec<f64> {
            (0..alone.len()).map(|k| number(kind, k % bodies, k / bodies, copy(system, lane))).collect()
        };
        let strength = (0..bodies).map(|i| mass(system, lane, i)).collect();
        let mut dynamics = Dynamics::closed(FewBodies::new(alone, strength, vec![0.0]));
        let mut single = State::new(&numbers(0), &numbers(1));
        advance(METHOD, STEP, 40, &mut single, &mut dynamics);
        for k in 0..alone.len() {
            let at = k / bodies * shape.rows + system * bodies + k % bodies;
            assert_eq!(state.q()[at].0[lane], single.q()[k], "system {system}, lane {lane}, number {k}");
            assert_eq!(state.v()[at].0[lane], single.v()[k], "system {system}, lane {lane}, number {k}");
            assert_eq!(state.q_compensation()[at].0[lane], single.q_compensation()[k]);
        }
    }
}
