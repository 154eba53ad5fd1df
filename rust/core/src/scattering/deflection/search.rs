//! Where functions of one distance turn or conditions on it cease, once both are bracketed.

/// Where a condition that holds at `low` and not at `high` ceases to, to the last digit.
pub(super) fn bisected(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
}

/// Two distances whose ratio is no more are near each other.
const NEAR: f64 = 1.0 + 1.0 / 1024.0;

/// The same, to the bit, of a condition that ceases but once, between positive distances that may be a thousand octaves apart:
/// first it is found about where, by octaves.
pub(super) fn bisected_far(low: f64, high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut before, mut after) = (low, high);
    while before > 0.0 && after > NEAR * before {
        let middle = before.sqrt() * after.sqrt();
        if holds(middle) { before = middle } else { after = middle }
    }
    bisected(low, high, |r| r <= before || (r < after && holds(r)))
}

/// The highest place of a function with one maximum between two distances, to half the digits, as it has no more.
pub(super) fn highest(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.618_033_988_749_894_9;
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    // Or of a bracket that is narrower than those of a grid.
    let width = 16.0 * (high - low);
    while high - low > (1e-8 * high.min(width)).max(4.0 * f64::EPSILON * high) {
        if at_left >= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    0.5 * (low + high)
}
