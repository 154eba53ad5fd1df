//! The cubic that a function is taken for in a part of a step, and how far it may be from it.
//!
//! The one idea: values and rates at both ends give it, in Bernstein's basis; a value and a rate inside tell how far off it is.

use super::search::Point;

/// The most by which a function of the fifth degree, odd about the middle, leaves a cubic of which its rate there differs by
/// one.
const OF_SLANT: f64 = 0.15;

/// The cubic through values and rates at two points, in Bernstein's basis: it lies between its coefficients.
pub(super) struct Cubic {
    from: f64,
    length: f64,
    terms: [f64; 4],
}

impl Cubic {
    pub(super) fn through(a: Point, b: Point) -> Self {
        let length = b.theta - a.theta;
        let third = |point: Point| point.rate.unwrap_or(f64::NAN) * length / 3.0;
        let terms = [a.value, a.value + third(a), b.value - third(b), b.value];
        Self { from: a.theta, length, terms }
    }

    fn bounds(&self) -> (f64, f64) {
        let least = self.terms.iter().fold(f64::INFINITY, |least, &x| if x < least { x } else { least });
        let most = self.terms.iter().fold(f64::NEG_INFINITY, |most, &x| if x > most { x } else { most });
        (least, most)
    }

    /// The largest of its coefficients.
    pub(super) fn size(&self) -> f64 {
        let (least, most) = self.bounds();
        if -least > most { -least } else { most }
    }

    /// How far its coefficients are apart.
    pub(super) fn range(&self) -> f64 {
        let (least, most) = self.bounds();
        most - least
    }

    /// How far from zero it stays, told from its values where it turns and at its ends; 0 if it has a zero.
    pub(super) fn clearance(&self) -> f64 {
        let [first, .., last] = self.terms;
        let sign = first.signum();
        let turns = self.turns().map(|s| self.at(s).0 * sign);
        turns
            .chain([first * sign, last * sign])
            .fold(f64::INFINITY, |least, x| if x < least { x } else { least })
    }

    /// Value and slope, in the length of the part.
    fn at(&self, s: f64) -> (f64, f64) {
        let between = |from: f64, to: f64| from + s * (to - from);
        let [a, b, c, d] = self.terms;
        let [ab, bc, cd] = [between(a, b), between(b, c), between(c, d)];
        let [abc, bcd] = [between(ab, bc), between(bc, cd)];
        (between(abc, bcd), 3.0 * (bcd - abc))
    }

    /// How far the function may be from it anywhere, told from a point about the middle.
    pub(super) fn off(&self, inside: Point) -> f64 {
        let (value, slope) = self.at((inside.theta - self.from) / self.length);
        let slant = inside.rate.unwrap_or(f64::NAN) * self.length - slope;
        (inside.value - value).abs() + OF_SLANT * slant.abs() + 4.0 * f64::EPSILON * self.size()
    }

    /// Where it turns, as fractions of the part.
    pub(super) fn turns(&self) -> impl Iterator<Item = f64> {
        let [a, b, c, d] = self.terms;
        // Its slope is a parabola with these terms in Bernstein's basis: p + 2 (q - p) s + (p - 2q + r) s².
        let (p, q, r) = (b - a, c - b, d - c);
        let root = (q * q - p * r).sqrt();
        let w = if q > p { p - q - root } else { p - q + root };
        let found = [w / (p - 2.0 * q + r), p / w];
        found.into_iter().filter(|&s| 0.0 < s && s < 1.0)
    }
}
