//! Constraints that follow from each other at a state, and whether they agree there.
//!
//! The one idea: gradients are made orthogonal one after another, and each knows of which rows it is made. A row of which
//! nothing is left is a sum of those before it; where residuals are not the same sum, no small change makes all of them hold.

/// Below this part of its length, what is left of a row is round-off.
const DEPENDENT: f64 = 1e-12;
/// Shares of a row below this are round-off.
const SHARE: f64 = 1e-9;
/// Below this part of what it is made of, or of what a change of the state by as much makes, a residual is round-off.
const DISAGREEMENT: f64 = 1e-10;

/// A constraint that others determine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dependence {
    /// Which constraint.
    pub one: usize,
    /// The independent ones before it that make up its gradient; none, if it has no gradient.
    pub others: Vec<usize>,
    /// Whether no small change of the state makes all of them hold.
    pub disagree: bool,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A direction of gradients, and the rows it is made of.
struct Direction {
    unit: Vec<f64>,
    of: Vec<f64>,
}

/// The first of the rows, one number for each coordinate, that follows from those before it. `places` are the residuals of
/// holonomic constraints, which are the first ones; `rates` those of all rates.
pub fn dependence(rows: &[f64], state: &[f64], places: &[f64], rates: &[f64]) -> Option<Dependence> {
    let n = state.len() / 2;
    let count = rows.len() / n;
    let large = state.iter().fold(1.0, |large: f64, x| large.max(x.abs()));
    let mut directions: Vec<Direction> = Vec::new();
    for (one, row) in rows.chunks(n).enumerate() {
        let length = dot(row, row).sqrt();
        let (mut rest, mut made_of) = (row.to_vec(), vec![0.0; count]);
        // Twice is enough.
        for _ in 0..2 {
            for direction in &directions {
                let along = dot(&rest, &direction.unit);
                rest.iter_mut().zip(&direction.unit).for_each(|(rest, unit)| *rest -= along * unit);
                made_of.iter_mut().zip(&direction.of).for_each(|(share, of)| *share += along * of);
            }
        }
        let left = dot(&rest, &rest).sqrt();
        if left > DEPENDENT * length {
            made_of.iter_mut().for_each(|share| *share /= -left);
            made_of[one] = 1.0 / left;
            let unit = rest.iter().map(|rest| rest / left).collect();
            directions.push(Direction { unit, of: made_of });
            continue;
        }
        let size = |index: usize| {
            let row = &rows[index * n..(index + 1) * n];
            made_of[index].abs() * dot(row, row).sqrt()
        };
        let others: Vec<usize> = (0..one).filter(|&index| size(index) > SHARE * length).collect();
        let disagree = |residuals: &[f64]| {
            let of_others = |take: fn(f64) -> f64| -> f64 {
                others.iter().map(|&index| take(made_of[index] * residuals[index])).sum()
            };
            let scale = residuals[one].abs() + of_others(f64::abs);
            (residuals[one] - of_others(|share| share)).abs() > DISAGREEMENT * scale.max(length * large)
        };
        let disagree = disagree(rates) || (one < places.len() && disagree(places));
        return Some(Dependence { one, others, disagree });
    }
    None
}
