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
