//! What a segment of a discrete path is made of: polynomials between its ends, and a quadrature along them.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::WIDTH;

/// Control points, of which the first is 0 and the last 1, and the points and weights of a quadrature on 0 … 1.
#[derive(Debug)]
pub(super) struct Rule {
    control: &'static [f64],
    points: &'static [f64],
    weights: &'static [f64],
}

/// A straight line, looked at in its middle.
pub(super) static MIDPOINT: Rule = Rule { control: &[0.0, 1.0], points: &[0.5], weights: &[1.0] };

/// A straight line, looked at at its ends.
pub(super) static TRAPEZOIDAL: Rule = lobatto(&[0.0, 1.0], &[0.5, 0.5]);

/// A parabola, by Simpson's rule.
pub(super) static LOBATTO4: Rule = lobatto(&[0.0, 0.5, 1.0], &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]);

/// A cubic; the inner points are 1/2 ∓ 1/√20.
pub(super) static LOBATTO6: Rule = lobatto(
    &[0.0, 0.276_393_202_250_021, 0.723_606_797_749_979, 1.0],
    &[1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0],
);

/// A quartic; the inner points are 1/2 and 1/2 ∓ √(3/28).
pub(super) static LOBATTO8: Rule = lobatto(
    &[0.0, 0.172_673_164_646_011_42, 0.5, 0.827_326_835_353_988_6, 1.0],
    &[0.05, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 0.05],
);

/// Control points that are the points of the quadrature.
const fn lobatto(points: &'static [f64], weights: &'static [f64]) -> Rule {
    Rule { control: points, points, weights }
}

/// A rule at work: the basis polynomials of the control points, and their slopes, at the points of the quadrature.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// The degree of the polynomials; control points are 0 … `degree`.
    pub(super) degree: usize,
    /// Where the control points are.
    pub(super) control: Vec<f64>,
    /// How many points the quadrature has.
    pub(super) count: usize,
    /// Its points; lanes without one repeat the last.
    pub(super) points: [f64; WIDTH],
    /// Its weights; 0 in lanes without a point.
    pub(super) weights: [f64; WIDTH],
    /// The basis polynomials.
    pub(super) values: Vec<[f64; WIDTH]>,
    /// Their slopes.
    pub(super) slopes: Vec<[f64; WIDTH]>,
    /// What the slopes of the first one leave out.
    pub(super) first_rest: [f64; WIDTH],
    /// What the weighted slopes of each but the last add to, less what they would without rounding: −1 of the first, 0.
    pub(super) defects: Vec<f64>,
    /// Their slopes at the end.
    pub(super) last_slopes: Vec<f64>,
}

impl Table {
    pub(super) fn new(rule: &Rule) -> Self {
        let (count, degree) = (rule.points.len(), rule.control.len() - 1);
        let points = core::array::from_fn(|lane| rule.points[lane.min(count - 1)]);
        let weights: [f64; WIDTH] =
            core::array::from_fn(|lane| if lane < count { rule.weights[lane] } else { 0.0 });
        let basis = 0..=degree;
        let values = basis.clone().map(|j| points.map(|x| polynomial(rule.control, j, x, None))).collect();
        let mut slopes: Vec<[f64; WIDTH]> =
            basis.clone().map(|j| points.map(|x| slope(rule.control, j, x))).collect();
        // The slopes of all add to nothing, to twice the digits: a place that all control points share moves nothing.
        let exact = DoubleDouble::from;
        let sum = |lane: usize| slopes[1..].iter().fold(exact(0.0), |sum, row| sum - exact(row[lane]));
        let first: [DoubleDouble; WIDTH] = core::array::from_fn(sum);
        slopes[0] = first.map(DoubleDouble::to_f64);
        let first_rest = core::array::from_fn(|lane| (first[lane] - exact(slopes[0][lane])).to_f64());
        let defect = |j: usize| {
            let of = |lane: usize| if j == 0 { first[lane] } else { exact(slopes[j][lane]) };
            let start = if j == 0 { 1.0 } else { 0.0 };
            (0..count).fold(exact(start), |sum, lane| sum + exact(weights[lane]) * of(lane)).to_f64()
        };
        let defects = (0..degree).map(defect).collect();
        let last_slopes = basis.map(|j| slope(rule.control, j, 1.0)).collect();
        let control = rule.control.to_vec();
        Self { degree, control, count, points, weights, values, slopes, first_rest, defects, last_slopes }
    }
}

/// The basis polynomial that is 1 at the control point `j`, without the factor of another one.
fn polynomial(control: &[f64], j: usize, x: f64, without: Option<usize>) -> f64 {
    let others = (0..control.len()).filter(|&m| m != j && Some(m) != without);
    others.map(|m| (x - control[m]) / (control[j] - control[m])).product()
}

/// Its slope.
fn slope(control: &[f64], j: usize, x: f64) -> f64 {
    let others = (0..control.len()).filter(|&k| k != j);
    others.map(|k| polynomial(control, j, x, Some(k)) / (control[j] - control[k])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials of the segment's degree are what they are, and so are their slopes and integrals: of the degree that the
    /// quadrature takes.
    #[test]
    fn segments_hold_their_polynomials() {
        let rules = [(&MIDPOINT, 1), (&TRAPEZOIDAL, 1), (&LOBATTO4, 3), (&LOBATTO6, 5), (&LOBATTO8, 7)];
        for (rule, exact) in rules {
            let table = Table::new(rule);
            for power in 0..=table.degree as i32 {
                for lane in 0..table.count {
                    let x = table.points[lane];
                    let held = |of: &[[f64; WIDTH]]| -> f64 {
                        of.iter().zip(&table.control).map(|(row, c)| row[lane] * c.powi(power)).sum()
                    };
                    assert!((held(&table.values) - x.powi(power)).abs() < 1e-15);
                    let slope = if power == 0 { 0.0 } else { f64::from(power) * x.powi(power - 1) };
                    assert!((held(&table.slopes) - slope).abs() < 1e-14);
                }
            }
            for power in 0..=exact {
                let sum: f64 = table.weights.iter().zip(&table.points).map(|(w, x)| w * x.powi(power)).sum();
                assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-16 * 4.0);
            }
            // The next power is not exact: no rule is better than it says.
            let sum: f64 = table.weights.iter().zip(&table.points).map(|(w, x)| w * x.powi(exact + 1)).sum();
            assert!((sum - 1.0 / f64::from(exact + 2)).abs() > 1e-6);
        }
    }
}
