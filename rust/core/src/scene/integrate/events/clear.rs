//! Which steps may hold zeros: told from what is known at their ends, so that the others cost no more than that.

use crate::numerics::real::{Mask, Real};

/// How far a function may differ from the cubic in the middle of a step, as a part of the range of the cubic. Towards the ends
/// it is less, as the values there are the same, and the rates.
pub(super) const CLEARANCE: f64 = 0.5;

/// How far the rates may be off, as a part of that range in the time of a step.
const SLANT: f64 = 0.125;

/// What ends nearer to zero than this part of that range may be zero for all that is known of the state.
const ENDS: f64 = 1.0 / 256.0;

/// How often a step is halved, and its halves, to see whether the function keeps clear on all of them.
const HALVINGS: usize = 4;

/// The cubic through the values and the rates at both ends of a step `h`, in Bernstein's basis: it lies between its
/// coefficients.
#[inline(always)]
pub(super) fn cubic<S: Real>([start, end]: [S; 2], rates: [S; 2], h: S) -> [S; 4] {
    let third = h * S::splat(1.0 / 3.0);
    [start, start + third * rates[0], end - third * rates[1], end]
}

/// Value and slope of a cubic at a fraction of the step.
pub(super) fn cubic_at([a, b, c, d]: [f64; 4], theta: f64) -> [f64; 2] {
    let between = |from: f64, to: f64| from + theta * (to - from);
    let [ab, bc, cd] = [between(a, b), between(b, c), between(c, d)];
    let [abc, bcd] = [between(ab, bc), between(bc, cd)];
    [between(abc, bcd), 3.0 * (bcd - abc)]
}

/// Whether a cubic rises or falls all along its step, and nowhere by less than half as fast as on the whole.
pub(super) fn is_straight([a, b, c, d]: [f64; 4]) -> bool {
    let (way, part) = (d - a, 1.0 / 6.0);
    [b - a, c - b, d - c].into_iter().all(|third| third / way >= part)
}

/// Whether the coefficients tell that the function keeps clear of zero, however it may differ from the cubic.
#[inline(always)]
pub(super) fn keeps_clear<S: Real>([a, b, c, d]: [S; 4]) -> S::Mask {
    let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let clearance = S::splat(CLEARANCE) * (high - low);
    clearance.less(low).or(high.less(-clearance))
}

/// The same at a closer look: whether the cubic keeps clear of zero by what the function may differ from it there.
pub(super) fn keeps_clear_after_all(cubic: [f64; 4]) -> bool {
    let [a, b, c, d] = if cubic[0] < 0.0 { cubic.map(|x| -x) } else { cubic };
    let range = a.max(b).max(c.max(d)) - a.min(b).min(c.min(d));
    if d <= ENDS * range {
        return false;
    }
    // 16θ²(1-θ)² of the clearance and θ(1-θ) of the slant, in the basis of the fourth degree.
    let (clearance, slant) = (CLEARANCE * range, SLANT * range);
    let middle = 0.5 * (b + c) - (8.0 * clearance + slant) / 3.0;
    let sides = [0.25 * (a + 3.0 * b - slant), 0.25 * (3.0 * c + d - slant)];
    is_positive([a, sides[0], middle, sides[1], d], HALVINGS)
}

/// Whether a polynomial is: its coefficients are, or those of its halves.
fn is_positive(whole: [f64; 5], halvings: usize) -> bool {
    if whole.iter().all(|&x| x > 0.0) {
        return true;
    }
    if halvings == 0 || !(whole[0] > 0.0 && whole[4] > 0.0) {
        return false;
    }
    // De Casteljau's scheme.
    let (mut left, mut right) = (whole, whole);
    for level in 1..5 {
        for i in 0..5 - level {
            right[i] = 0.5 * (right[i] + right[i + 1]);
        }
        left[level] = right[0];
    }
    is_positive(left, halvings - 1) && is_positive(right, halvings - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_may_reach_zero_does_not_keep_clear(
            ends in [0.0..2.0f64, 0.0..2.0], rates in [-6.0..6.0f64, -6.0..6.0], part in -1.0..1.0f64, sign in proptest::bool::ANY,
        ) {
            let sign = if sign { 1.0 } else { -1.0 };
            let cubic = cubic(ends.map(|x| sign * x), rates.map(|x| sign * x), 1.0);
            let (low, high) = cubic.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
            // Any function that differs from the cubic by less than the clearance, as such functions do.
            let least = (0..=1000).map(|i| {
                let (t, s) = (f64::from(i) / 1000.0, 1.0 - f64::from(i) / 1000.0);
                let [a, b, c, d] = cubic;
                let value = s * s * s * a + 3.0 * t * s * (s * b + t * c) + t * t * t * d;
                sign * value + part * 16.0 * t * t * s * s * CLEARANCE * (high - low)
            });
            if least.fold(f64::MAX, f64::min) < 0.0 {
                prop_assert!(!keeps_clear(cubic));
                prop_assert!(!keeps_clear_after_all(cubic));
            }
        }
    }

    proptest! {
        #[test]
        fn what_is_straight_never_turns(
            start in -2.0..-0.01f64, end in 0.01..2.0f64, rates in [-6.0..6.0f64, -6.0..6.0], sign in proptest::bool::ANY,
        ) {
            let sign = if sign { 1.0 } else { -1.0 };
            let cubic = cubic([sign * start, sign * end], rates.map(|x| sign * x), 1.0);
            let slopes = (0..=1000).map(|i| sign * cubic_at(cubic, f64::from(i) / 1000.0)[1]);
            let least = slopes.fold(f64::MAX, f64::min);
            // Half of the slope of the straight line, but for rounding.
            prop_assert!(!is_straight(cubic) || least >= 0.5 * (end - start) * (1.0 - 1e-12));
        }
    }

    #[test]
    fn a_line_is_straight_and_what_turns_on_the_way_is_not() {
        assert!(is_straight(cubic([-0.3, 0.7], [1.0, 1.0], 1.0)));
        assert!(is_straight(cubic([0.3, -0.7], [-1.0, -1.0], 1.0)));
        // Three zeros, and a slow end.
        assert!(!is_straight(cubic([-0.1, 0.1], [3.0, 3.0], 1.0)));
        assert!(!is_straight(cubic([-0.3, 0.7], [1.5, 0.4], 1.0)));
        assert_eq!(
            cubic_at(cubic([-0.3, 0.7], [1.0, 1.0], 1.0), 0.5).map(|x| (x * 1e12).round() / 1e12),
            [0.2, 1.0]
        );
    }

    #[test]
    fn a_step_beside_a_zero_is_not_looked_into() {
        // A line that starts at a tenth of its rise.
        let line = cubic([0.1, 1.1], [1.0, 1.0], 1.0);
        assert!(!keeps_clear(line));
        assert!(keeps_clear_after_all(line));
        assert!(keeps_clear_after_all(line.map(|x| -x)));
        assert!(!keeps_clear_after_all(cubic([-0.1, 0.9], [1.0, 1.0], 1.0)));
    }
}
