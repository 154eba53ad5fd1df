//! The probability of a channel: what hangs on where a projectile comes, times what hangs on its energy.

use crate::words::number;

/// Points of a table, at most.
const MOST: usize = 1 << 16;

/// A factor in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub enum Factor {
    /// The same everywhere.
    Constant(f64),
    /// At arguments that rise; linear between them, and beyond the ends as at the ends.
    Table(Vec<f64>, Vec<f64>),
}

/// The product of two factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Probability {
    /// Of the impact parameter.
    pub of_place: Factor,
    /// Of the projectile's energy in the laboratory: an excitation function.
    pub of_energy: Factor,
}

impl Factor {
    /// What is wrong with it, if anything, as one of those arguments.
    fn defect(&self, arguments: &str) -> Option<String> {
        let values = match self {
            Self::Constant(value) => core::slice::from_ref(value),
            Self::Table(places, values) => {
                if !(2..=MOST).contains(&places.len()) || places.len() != values.len() {
                    let (places, values) = (places.len(), values.len());
                    return Some(format!(
                        "expected 2 to {MOST} {arguments} and a probability for each, got {places} and {values}"
                    ));
                }
                let rises = places.windows(2).all(|pair| pair[0] < pair[1]);
                if !(rises && places.iter().all(|place| *place >= 0.0 && place.is_finite())) {
                    return Some(format!("expected {arguments} that are not negative and rise"));
                }
                values
            }
        };
        let wrong = values.iter().find(|value| !(0.0..=1.0).contains(*value))?;
        Some(format!("expected probabilities in [0, 1], got {}", number(*wrong)))
    }
    /// Where it bends.
    pub(super) fn bends(&self) -> &[f64] {
        match self {
            Self::Constant(_) => &[],
            Self::Table(places, _) => places,
        }
    }
    /// At an argument.
    pub(super) fn at(&self, place: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(places, values) => {
                let next = places.partition_point(|before| *before <= place);
                let last = values.len() - 1;
                if next == 0 || next > last {
                    return values[next.min(last)];
                }
                let part = (place - places[next - 1]) / (places[next] - places[next - 1]);
                values[next - 1] + (values[next] - values[next - 1]) * part
            }
        }
    }
}

impl Probability {
    /// The same for all events.
    pub fn constant(value: f64) -> Self {
        Self { of_place: Factor::Constant(value), of_energy: Factor::Constant(1.0) }
    }
    /// What is wrong with it, if anything.
    pub(super) fn defect(&self) -> Option<String> {
        self.of_place.defect("impact parameters").or_else(|| self.of_energy.defect("energies"))
    }
    /// At an impact parameter and an energy.
    pub(super) fn at(&self, b: f64, energy: f64) -> f64 {
        self.of_place.at(b) * self.of_energy.at(energy)
    }
    /// The same with the energy told.
    pub(super) fn at_energy(&self, energy: f64) -> Self {
        Self { of_energy: Factor::Constant(self.of_energy.at(energy)), ..self.clone() }
    }
    /// Whether no event of an energy between two goes that way.
    pub(super) fn vanishes(&self, from: f64, to: f64) -> bool {
        let between = self.of_energy.bends().iter().copied().filter(|energy| (from..=to).contains(energy));
        between.chain([from, to]).all(|energy| self.of_energy.at(energy) == 0.0)
    }
}
