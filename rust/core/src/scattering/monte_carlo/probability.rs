//! The probability of a channel: one for all events, or one that hangs on where a projectile comes.

use crate::words::number;

/// Points of a table, at most.
const MOST: usize = 1 << 16;

/// In [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub enum Probability {
    /// Of all events alike.
    Constant(f64),
    /// At impact parameters that rise; linear between them, and beyond the ends as at the ends.
    OfPlace(Vec<f64>, Vec<f64>),
}

impl Probability {
    /// What is wrong with it, if anything.
    pub(super) fn defect(&self) -> Option<String> {
        let values = match self {
            Self::Constant(value) => core::slice::from_ref(value),
            Self::OfPlace(places, values) => {
                if !(2..=MOST).contains(&places.len()) || places.len() != values.len() {
                    let (places, values) = (places.len(), values.len());
                    return Some(format!(
                        "expected 2 to {MOST} impact parameters and a probability for each, got {places} and {values}"
                    ));
                }
                let rises = places.windows(2).all(|pair| pair[0] < pair[1]);
                if !(rises && places.iter().all(|b| *b >= 0.0 && b.is_finite())) {
                    return Some("expected impact parameters that are not negative and rise".to_owned());
                }
                values
            }
        };
        let wrong = values.iter().find(|value| !(0.0..=1.0).contains(*value))?;
        Some(format!("expected probabilities in [0, 1], got {}", number(*wrong)))
    }
    /// The impact parameters at which it bends.
    pub(super) fn places(&self) -> &[f64] {
        match self {
            Self::Constant(_) => &[],
            Self::OfPlace(places, _) => places,
        }
    }
    /// At an impact parameter.
    pub(super) fn at(&self, b: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::OfPlace(places, values) => {
                let next = places.partition_point(|place| *place <= b);
                let last = values.len() - 1;
                if next == 0 || next > last {
                    return values[next.min(last)];
                }
                let part = (b - places[next - 1]) / (places[next] - places[next - 1]);
                values[next - 1] + (values[next] - values[next - 1]) * part
            }
        }
    }
}
