//! What lies between the stages of a step: whether rates there are those that the polynomial through the stages has.
//!
//! The one idea: of smooth motions the polynomial errs between its stages by a small part of its last terms, of those that turn
//! within the step by as much as these. States between stages are those of the collocation polynomial, so a look at all eight
//! places costs no more than one iteration of the stages.

use super::Table;
use crate::numerics::lanes::{Lanes, WIDTH};

/// Rates between stages that are off by more than this part of the last terms show that these are none of a smooth motion: of
/// motions that turn it is a tenth and more, of others five thousandths and less.
pub(super) const SHOWN: f64 = 0.015;

/// Places between the stages of a method with so many as lanes, and after the last.
#[derive(Debug)]
pub(super) struct Between {
    /// Where they are, as fractions of the step.
    pub(super) places: Lanes,
    /// What each stage contributes to the rates there, …
    pub(super) rates: [Lanes; WIDTH],
    /// … to their integral since the beginning, …
    pub(super) way: [Lanes; WIDTH],
    /// … and to that of this one.
    pub(super) way_of_way: [Lanes; WIDTH],
}

impl Between {
    /// Of a method, if it has so many stages.
    pub(super) fn of(table: &Table) -> Option<Self> {
        let (c, b) = (&table.c.0, &table.b[0].0);
        let place = |k: usize| 0.5 * (c[k] + c.get(k + 1).copied().unwrap_or(1.0));
        let places = Lanes(core::array::from_fn(place));
        let mut rows = [[Lanes([0.0; WIDTH]); WIDTH]; 2];
        // By the quadrature of the method itself, which is exact for these polynomials.
        for i in 0..WIDTH {
            let inside = table.at(&places.map(|x| x * c[i]));
            for (k, inside) in inside.iter().enumerate() {
                for (lane, &x) in places.0.iter().enumerate() {
                    rows[0][k].0[lane] += x * b[i] * inside.0[lane];
                    rows[1][k].0[lane] += x * x * b[i] * (1.0 - c[i]) * inside.0[lane];
                }
            }
        }
        let [way, way_of_way] = rows;
        (table.stages == WIDTH).then(|| Self { places, rates: table.at(&places), way, way_of_way })
    }
}

/// Whether rates that miss the polynomial by so much show that its last terms, which are so large, are none of a smooth motion.
pub(super) fn shows(missed: f64, last: f64) -> bool {
    missed >= SHOWN * last
}

#[cfg(test)]
mod tests {
    use super::super::tables::{GAUSS8, GAUSS16};
    use super::*;

    #[test]
    fn polynomials_are_led_to_places_between() {
        let between = Between::of(&GAUSS16).unwrap();
        assert!(Between::of(&GAUSS8).is_none());
        for (lane, &x) in between.places.0.iter().enumerate() {
            let sum = |rows: &[Lanes; WIDTH], rate: fn(f64) -> f64| -> f64 {
                (0..WIDTH).map(|k| rows[k].0[lane] * rate(GAUSS16.c.0[k])).sum()
            };
            // Rates 5c⁴, so c⁵ is their integral and c⁶/6 that of this one; Lebesgue's constant times rounding.
            let found = [&between.rates, &between.way, &between.way_of_way];
            for (rows, exact) in found.into_iter().zip([5.0 * x.powi(4), x.powi(5), x.powi(6) / 6.0]) {
                let found = sum(rows, |c| 5.0 * c.powi(4));
                assert!((found - exact).abs() < 1e-13, "{found} for {exact}");
            }
        }
    }
}
