//! Bins by name: equal in width, in ratio, or in solid angle.
//!
//! The one idea: edges are made here, of arithmetic that is the same everywhere, so that a name gives the same bins, and
//! so the same counts, on every machine.

use super::histogram::{Edges, MOST_BINS};
use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::elementary::{Exponential, ln};
use crate::words::{number, unknown};
use crate::{Error, Result};

/// What neighbouring bins have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Their width.
    Linear,
    /// The ratio of their ends.
    Logarithmic,
    /// Their solid angle.
    SolidAngle,
}

/// The bins of one quantity, as they are asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Bins {
    /// So many equal ones, over all values that the quantity can have.
    Count(usize),
    /// Between these.
    Edges(Vec<f64>),
    /// So many, from the first number to the second; where one is left out, from 0 or to the greatest value.
    Spaced(Spacing, usize, Option<f64>, Option<f64>),
}

impl Spacing {
    const ALL: [(&'static str, Self); 3] =
        [("linear", Self::Linear), ("logarithmic", Self::Logarithmic), ("solid_angle", Self::SolidAngle)];
    /// By name.
    ///
    /// # Errors
    /// `InvalidInput` naming `bins`.
    pub fn named(name: &str) -> Result<Self> {
        let found = Self::ALL.iter().find(|(known, _)| *known == name);
        found
            .map(|(_, spacing)| *spacing)
            .ok_or_else(|| unknown("bins", name, Self::ALL.iter().map(|(known, _)| *known)))
    }
    /// Edges of an angle or another quantity, the first and the last exactly as given.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity.
    pub fn edges(self, quantity: &str, angle: bool, bins: usize, low: f64, high: f64) -> Result<Edges> {
        let refused = |message: String| Err(Error::invalid(quantity, message));
        if !(1..=MOST_BINS).contains(&bins) {
            return refused(format!("expected 1 to {MOST_BINS} bins, got {bins}"));
        }
        if low >= high || !low.is_finite() || !high.is_finite() {
            let (low, high) = (number(low), number(high));
            return refused(format!(
                "expected bins from a number to a greater one, got bins from {low} to {high}"
            ));
        }
        if self == Self::Logarithmic && low <= 0.0 {
            let low = number(low);
            return refused(format!(
                "expected logarithmic bins that begin above 0, got {low}; give low=, what is below is the underflow"
            ));
        }
        if self == Self::SolidAngle && !angle {
            return refused(
                "expected linear or logarithmic bins, got solid_angle, which is of angles".to_owned(),
            );
        }
        let of = |share: f64| match self {
            Self::Linear => low + (high - low) * share,
            // From the nearer end: no power is beyond all numbers.
            Self::Logarithmic if share < 0.5 => low * Exponential::exp((ln(high) - ln(low)) * share),
            Self::Logarithmic => high * Exponential::exp((ln(low) - ln(high)) * (1.0 - share)),
            Self::SolidAngle => {
                // The solid angle is 4π sin²(θ/2); 4π cos²(θ/2) is what is left, without a difference.
                let [(sine, cosine), (last_sine, last_cosine)] =
                    [low, high].map(|angle| sin_cos(0.5 * angle));
                let between = |first: f64, last: f64| first * first * (1.0 - share) + last * last * share;
                2.0 * atan2(between(sine, last_sine).sqrt(), between(cosine, last_cosine).sqrt())
            }
        };
        let mut edges: Vec<f64> = (0..bins).map(|bin| of(bin as f64 / bins as f64)).collect();
        edges[0] = low;
        edges.push(high);
        Edges::new(quantity, edges)
    }
}

impl Bins {
    /// Edges of a quantity with that greatest value.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity, or `bins` where only their number is wrong.
    pub fn edges(&self, quantity: &str, angle: bool, greatest: f64) -> Result<Edges> {
        match self {
            Self::Count(bins) => Edges::uniform(*bins, 0.0, greatest),
            Self::Edges(edges) => Edges::new(quantity, edges.clone()),
            Self::Spaced(spacing, bins, low, high) => {
                spacing.edges(quantity, angle, *bins, low.unwrap_or(0.0), high.unwrap_or(greatest))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::kinematics::solid_angle;
    use core::f64::consts::PI;

    #[test]
    fn bins_have_in_common_what_they_are_named_for() {
        let edges = |spacing: Spacing, low, high| {
            spacing.edges("lab_angle", true, 700, low, high).unwrap().values().to_vec()
        };
        let measured: [fn(f64, f64) -> f64; 3] = [|a, b| b - a, |a, b| b / a, solid_angle];
        for ((_, spacing), measure) in Spacing::ALL.into_iter().zip(measured) {
            for (low, high) in [(1e-3, PI), (0.5, 0.6), (1e-12, 1e-3)] {
                let edges = edges(spacing, low, high);
                assert_eq!((edges[0], edges[700]), (low, high));
                let first = measure(edges[0], edges[1]);
                for pair in edges.windows(2) {
                    let part = measure(pair[0], pair[1]) / first;
                    // Two edges, rounded, of a width that is at least a 4000th of them: 700 · 6 / 5 of both ends.
                    assert!((part - 1.0).abs() < 1e-11, "{spacing:?} {pair:?} {part}");
                }
            }
        }
    }

    #[test]
    fn ends_of_all_numbers_do_not_overflow() {
        let edges = Spacing::Logarithmic.edges("energy", false, 10, 1e-300, 1e300).unwrap();
        assert!((edges.values()[5] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_are_no_bins_is_refused() {
        for (spacing, bins, low, high) in [
            (Spacing::Linear, 0, 0.0, 1.0),
            (Spacing::Linear, 5, 1.0, 1.0),
            (Spacing::Linear, 5, f64::NAN, 1.0),
            (Spacing::Logarithmic, 5, 0.0, 1.0),
            (Spacing::SolidAngle, 5, 0.0, 1.0),
        ] {
            let refused = spacing.edges("energy", false, bins, low, high);
            assert!(matches!(refused, Err(Error::InvalidInput { argument, .. }) if argument == "energy"));
        }
        assert!(Spacing::named("log").is_err());
    }
}
