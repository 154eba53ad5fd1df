use super::propagator::Propagator;
use super::*;

fn flow(rows: &[&[f64]], longest: f64) -> MatrixExponential {
    let matrix = rows.iter().flat_map(|row| row.iter().map(|&entry| DoubleDouble::from(entry))).collect();
    MatrixExponential::new(matrix, rows.len(), longest)
}

/// Oscillators of any frequency turn exactly: to the last digits of sine and cosine after many turns.
#[test]
fn oscillators_turn() {
    for exponent in [-300, -40, -3, 0, 7, 90, 300] {
        let frequency = power(exponent);
        for phase in [0.3, 7.0, 1e5, 3e9] {
            let mut flow = flow(&[&[0.0, 1.0], &[-frequency * frequency, 0.0]], phase / frequency);
            let found = flow.apply((phase / frequency, 0.0), &[1.0, 0.0]);
            let sine = crate::numerics::angles::sin(phase);
            assert!((found[1] / frequency + sine).abs() <= 4.0 * f64::EPSILON, "{exponent} {phase}");
            assert!((found[0] - crate::numerics::angles::cos(phase)).abs() <= 4.0 * f64::EPSILON);
        }
    }
}

/// What falls is driven and drives nothing: polynomials, whatever the units.
#[test]
fn what_falls_falls() {
    for g in [1e-60, 1.0, 9.81, 1e60] {
        for t in [1e-20, 1.0, 1e20] {
            let mut flow = flow(&[&[0.0, 1.0, 0.0], &[0.0, 0.0, -g], &[0.0, 0.0, 0.0]], t);
            let found = flow.apply((t, 0.0), &[1.0, 2.0, 1.0]);
            let place = 1.0 + (2.0 * t - 0.5 * g * t * t);
            assert!((found[0] - place).abs() <= 2.0 * f64::EPSILON * (1.0 + 2.0 * t + 0.5 * g * t * t));
            assert!((found[1] - (2.0 - g * t)).abs() <= 2.0 * f64::EPSILON * (2.0 + g * t));
        }
    }
}

/// Decay at rates far apart, and at rates that agree (a Jordan block): relative digits are kept.
#[test]
fn what_decays_keeps_its_digits() {
    let mut apart = flow(&[&[-1e3, 0.0], &[0.0, -1e-3]], 0.5);
    let found = apart.apply((0.5, 0.0), &[1.0, 1.0]);
    // exp(−500) and exp(−0.0005), from mpmath.
    assert!((found[0] / 7.124_576_406_741_286e-218 - 1.0).abs() <= 4.0 * f64::EPSILON, "{:e}", found[0]);
    assert!((found[1] / 0.999_500_124_979_169_3 - 1.0).abs() <= 2.0 * f64::EPSILON);
    let mut block = flow(&[&[-1.0, 1.0], &[0.0, -1.0]], 30.0);
    let found = block.apply((30.0, 0.0), &[0.0, 1.0]);
    assert!((found[0] / found[1] - 30.0).abs() <= 30.0 * 2.0 * f64::EPSILON);
}

/// exp(A (s + t)) = exp(A s) exp(A t), for times with any bits.
#[test]
fn times_add() {
    let rows: [&[f64]; 3] = [&[0.1, -2.0, 0.3], &[1.5, -0.2, 0.7], &[-0.4, 0.25, -0.1]];
    let mut whole = flow(&rows, 10.0);
    let y = [1.0, -0.5, 2.0];
    for (s, t) in [(1.0, 2.0), (0.1, 3.7), (1e-9, 9.9), (4.999, 5.001)] {
        let at_once = whole.apply(elapsed(s + t, 0.0), &y);
        let first = whole.apply((s, 0.0), &y);
        let then = whole.apply((t, 0.0), &first);
        for (a, b) in at_once.iter().zip(&then) {
            assert!((a - b).abs() <= 1e-14, "{s} {t}: {a} {b}");
        }
    }
}

#[test]
fn times_that_leave_no_digit_give_no_numbers() {
    let mut turning = flow(&[&[0.0, 1.0], &[-1.0, 0.0]], 1.0);
    assert!(turning.apply((1e30, 0.0), &[1.0, 0.0])[0].is_nan());
}

/// A frame that turns with ω = 0.6 about an axis, in which things fall along it.
fn frame() -> Vec<DoubleDouble> {
    let mut rates = vec![DoubleDouble::zero(); 49];
    let mut set = |row: usize, column: usize, rate: f64| rates[row * 7 + column] = DoubleDouble::from(rate);
    let of_axes =
        [(3, 0, 0.36), (4, 1, 0.36), (3, 4, 1.2), (4, 3, -1.2), (5, 6, -0.9), (3, 6, -0.18), (4, 6, 0.36)];
    for (row, column, rate) in [(0, 3, 1.0), (1, 4, 1.0), (2, 5, 1.0)].into_iter().chain(of_axes) {
        set(row, column, rate);
    }
    rates
}

/// A propagator moves vectors as the flow of one does. Numbers that grow with time are sums of such that grow with its square,
/// whose rounding grows with time once more.
#[test]
fn many_vectors_move_as_one() {
    let y = [1.0, 0.2, 0.3, 0.1, -0.5, 0.2, 1.0];
    let times = [0.0, 1e-9, 0.37, 25.3, 1e3, 1e3 + 0.37, 1e6, 1e6 + 0.37];
    let (mut one, mut many) = (MatrixExponential::new(frame(), 7, 1.0), Propagator::new(frame(), 7, 1.0));
    many.set_times(&times.map(DoubleDouble::from));
    for (index, t) in times.into_iter().enumerate() {
        let wanted = one.unrounded((t, 0.0), &y);
        for (found, wanted) in many.moved(index, &y).into_iter().zip(wanted) {
            let off = (found - wanted).to_f64().abs();
            assert!(off <= 1e-31 * (1.0 + t).powi(3), "{t}: {off:e}");
        }
    }
}
