//! The ranges of distance in which a motion may be.

use super::landscape::{Landscape, Radial, Turn, TurningPoint};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};

/// How a range ends.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// The motion turns there.
    Turn(TurningPoint),
    /// It reaches the center.
    Center,
    /// It goes on without end.
    Infinity,
    /// The potential is not known beyond.
    Edge(f64),
}

impl End {
    /// Its distance.
    pub fn radius(self) -> f64 {
        match self {
            Self::Turn(point) => point.radius.to_f64(),
            Self::Center => 0.0,
            Self::Infinity => f64::INFINITY,
            Self::Edge(radius) => radius,
        }
    }
    /// A turning point at which the radial velocity goes through zero.
    pub(super) fn smooth(self) -> Option<DoubleDouble> {
        match self {
            Self::Turn(point) if !point.jump => Some(point.radius),
            _ => None,
        }
    }
}

/// A range, and whether it is a circle.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Its near end.
    pub inner: End,
    /// Its far end.
    pub outer: End,
    /// Whether it is no wider than energy and angular momentum are known, or every distance in it is one of a circle.
    pub circle: bool,
}

impl Range {
    /// What becomes of a body in it, in one word.
    pub fn kind(&self) -> &'static str {
        match (self.inner, self.outer) {
            _ if self.circle => "circular",
            (End::Edge(_), _) | (_, End::Edge(_)) => "leaves_the_table",
            (End::Turn(_), End::Turn(_)) => "bound",
            (End::Turn(_), _) => "escapes",
            (_, End::Turn(_)) => "reaches_the_center",
            _ => "reaches_the_center_or_escapes",
        }
    }
    /// Whether a distance is in it, or beyond it by no more than such a part, and rounding.
    pub fn holds(&self, r: f64, beyond: f64) -> bool {
        let (low, high, near) = (self.inner.radius(), self.outer.radius(), beyond.max(NEAR));
        r >= low - near * low && r <= high + near * high
    }
}

/// l²/2m to about thirty digits.
pub fn centrifugal(angular_momentum: f64, mass: f64) -> DoubleDouble {
    let (of_l, of_m) = (exponent(angular_momentum), exponent(mass));
    let (l, m) = (scale(angular_momentum, -of_l), scale(mass, -of_m));
    let all = DoubleDouble::product(l, l) / DoubleDouble::from(2.0 * m);
    let by = 2 * of_l - of_m;
    DoubleDouble::new(scale(all.high(), by), scale(all.low(), by))
}

impl Landscape {
    /// Every range in which the motion may be, from the center outward.
    pub fn ranges(&self, energy: DoubleDouble, centrifugal: DoubleDouble) -> Vec<Range> {
        let critical = self.critical_radii(energy.high());
        let motion = self.radial(energy, centrifugal);
        let points = self.turns(&critical, motion);
        let (to_center, outward) = self.open_ends(motion);
        let domain =
            self.field().domain().map(|(a, b)| (self.field().give_length(a), self.field().give_length(b)));
        if self.every_circle(motion) {
            let (low, high) = domain.unwrap_or((0.0, f64::INFINITY));
            let inner = if low > 0.0 { End::Edge(low) } else { End::Center };
            let outer = if high.is_finite() { End::Edge(high) } else { End::Infinity };
            return vec![Range { inner, outer, circle: true }];
        }
        let mut inner = match domain {
            _ if !to_center => None,
            Some((low, _)) if low > 0.0 => Some(End::Edge(low)),
            _ => Some(End::Center),
        };
        let mut found = Vec::new();
        for point in points {
            match point.turn {
                Turn::Pericenter => inner = Some(End::Turn(point)),
                Turn::Apocenter => {
                    let inner = inner.take().unwrap_or(End::Turn(point));
                    let outer = End::Turn(point);
                    let circle = inner.smooth().zip(outer.smooth()).is_some_and(|(a, b)| {
                        let width = (b - a).high();
                        width <= CIRCLE * b.high()
                    });
                    found.push(Range { inner, outer, circle });
                }
            }
        }
        if let (Some(inner), true) = (inner, outward) {
            let outer = domain.map_or(End::Infinity, |(_, high)| End::Edge(high));
            found.push(Range { inner, outer, circle: false });
        }
        // A stable circle that rounding of the energy alone has made impossible.
        for r in critical {
            if found.iter().any(|range| range.holds(r, 0.0)) || !self.is_circle(r, motion) {
                continue;
            }
            let at = |turn| End::Turn(TurningPoint { radius: DoubleDouble::from(r), turn, jump: false });
            let (inner, outer) = (at(Turn::Pericenter), at(Turn::Apocenter));
            found.push(Range { inner, outer, circle: true });
        }
        found.sort_by(|a, b| a.inner.radius().total_cmp(&b.inner.radius()));
        found
    }

    /// Whether a circle there lacks no more energy than rounding takes.
    fn is_circle(&self, r: f64, motion: Radial<'_>) -> bool {
        let field = self.field();
        let r = field.take_length(r);
        let (value, turning) = (field.value(r), motion.centrifugal.high() / r / r);
        let size = motion.energy.high().abs() + value.abs() + turning;
        field.slope(r) > 0.0 && motion.kinetic(DoubleDouble::from(r)).0.high().abs() <= ROUNDED * size
    }
}

/// A place that far beyond an end is at it.
const NEAR: f64 = 1e-14;
/// A range that is narrower is taken for a circle: what differs is of the second order.
pub(super) const CIRCLE: f64 = 3e-9;
/// How much of the energies rounding takes.
const ROUNDED: f64 = 4.0 * f64::EPSILON;
