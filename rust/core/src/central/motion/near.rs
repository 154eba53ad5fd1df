//! The way between two near distances, in the distance itself.
//!
//! The one idea: the variable of a range spreads what happens at its ends; far from these the difference of two of its values
//! has lost the digits that the distances still have.

use super::super::quadrature::{Integral, between};
use super::{Form, Motion, TOLERANCE};
use crate::numerics::double_double::DoubleDouble;

/// Distances this part of the way to a turning point apart are near: beyond, their variables differ by a digit less at most.
const NEAR: f64 = 0.1;

impl Motion<'_> {
    /// Whether two distances are so near each other, beside the turning points, that the difference of their variables has
    /// lost digits.
    pub(super) fn are_near(&self, low: f64, high: f64) -> bool {
        let above = |a: DoubleDouble| (DoubleDouble::from(low) - a).high();
        let below = |b: DoubleDouble| (b - DoubleDouble::from(high)).high();
        let room = match self.form {
            Form::Between(a, b, _) => above(a).min(below(b)),
            Form::Beyond(a) => above(a),
            Form::Within(b) => below(b),
            Form::Open(_) => low,
        };
        high - low < NEAR * room.min(low)
    }

    /// From one of two near distances to the other, in the distance itself.
    pub(super) fn near_integral(&self, low: f64, high: f64) -> Option<Integral> {
        let rates = |past: f64| {
            let r = DoubleDouble::from(low) + DoubleDouble::from(past);
            let time = 1.0 / self.radial.kinetic(r).0.high().sqrt();
            [time, self.turning * time / r.high() / r.high()]
        };
        let mut places = vec![0.0, high - low];
        places.extend(
            self.radial.field.breaks().into_iter().filter(|r| low < *r && *r < high).map(|r| r - low),
        );
        places.sort_by(f64::total_cmp);
        between(&rates, &places, TOLERANCE)
    }
}
