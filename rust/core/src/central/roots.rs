//! A zero between two places at which a function has different signs: found always, to the last bit.

use crate::numerics::double_double::DoubleDouble;

/// The last two neighboring numbers between which the sign changes; `f` is never asked for its size but to be quick.
///
/// `low` has the sign of `f(low)`, whether it can be evaluated there or not; both ends are at least zero.
pub fn bracket(f: impl Fn(f64) -> f64, low: f64, high: f64, rises: bool) -> (f64, f64) {
    let below = |y: f64| (y < 0.0) == rises;
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (f64::NAN, f64::NAN);
    // Secants when both values are known and finite, but never more than two in a row without a halving.
    let (mut secants, mut side) = (0, 0);
    while a.to_bits() + 1 < b.to_bits() {
        let (first, last) = (a.to_bits(), b.to_bits());
        let middle = f64::from_bits(first + (last - first) / 2);
        let line = a - fa * ((b - a) / (fb - fa));
        let x = if secants < 2 && line > a && line < b && b < 2.0 * a {
            secants += 1;
            line
        } else {
            secants = 0;
            middle
        };
        let y = f(x);
        if y == 0.0 {
            return (x, x);
        }
        // Illinois: an end that stays a second time weighs half.
        if below(y) {
            fb *= if side < 0 { 0.5 } else { 1.0 };
            (a, fa, side) = (x, y, -1);
        } else {
            fa *= if side > 0 { 0.5 } else { 1.0 };
            (b, fb, side) = (x, y, 1);
        }
    }
    (a, b)
}

/// The zero in `[low, high]` to about thirty digits, of a function with its slope that is monotone there.
///
/// Newton's steps, and halvings wherever one would leave the bracket or does not close it.
pub fn precise(
    f: impl Fn(DoubleDouble) -> (DoubleDouble, DoubleDouble),
    [low, high]: [f64; 2],
    guess: f64,
    rises: bool,
) -> DoubleDouble {
    let (mut a, mut b) = (DoubleDouble::from(low), DoubleDouble::from(high));
    let mut x = DoubleDouble::from(guess);
    let mut before = f64::INFINITY;
    for _ in 0..STEPS {
        let (y, slope) = f(x);
        if y.high() == 0.0 || !y.is_finite() {
            return x;
        }
        if (y.high() < 0.0) == rises {
            a = x;
        } else {
            b = x;
        }
        let step = y / slope;
        let next = x - step;
        let size = step.high().abs();
        if size <= LAST * x.high().abs() {
            return x;
        }
        let inside = next > a && next < b;
        if size >= 0.5 * before && size <= STANDS * x.high().abs() {
            // Steps as small as the rounding of y do not become smaller.
            return if inside { next } else { x };
        }
        let next = if inside && size < 0.5 * before { next } else { between(a, b) };
        let moved = (next - x).high().abs();
        before = moved;
        x = next;
        if moved <= LAST * x.high().abs() {
            return x;
        }
    }
    x
}

/// The middle of a bracket, in octaves where it has several.
fn between(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if a.high() > 0.0 && b.high() > 4.0 * a.high() {
        return DoubleDouble::from(a.high().sqrt() * b.high().sqrt());
    }
    (a + b).scale(0.5)
}

/// What moves less, and not by less than the step before, moves by rounding alone.
const STANDS: f64 = 1e-20;
/// Halvings of a double-double, and some.
const STEPS: usize = 220;
/// What moves less is there.
const LAST: f64 = 1e-31;
