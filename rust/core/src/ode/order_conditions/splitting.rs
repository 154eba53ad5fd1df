//! Order conditions of a splitting: the free associative algebra on a drift and a kick.
//!
//! With letters A (drift) and B (kick) that satisfy no relation but associativity, a splitting has order
//! `p` when the product of the exponentials of its pieces agrees with `exp(A + B)` in the coefficient of
//! every word of at most `p` letters: `1/n!` for a word of `n`. Reading the product from the left or the
//! right reverses all words, which `exp(A + B)` does not notice.
//! Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, III.5.

use super::super::Splitting;
use super::{Family, Kind};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// A table that a test may change.
#[derive(Clone)]
pub(super) struct Table {
    pub(super) kicks: Vec<DoubleDouble>,
    pub(super) drifts: Vec<DoubleDouble>,
}

impl From<&Splitting> for Table {
    fn from(splitting: &Splitting) -> Self {
        Self { kicks: splitting.kicks.to_vec(), drifts: splitting.drifts.to_vec() }
    }
}

impl Table {
    /// Every coefficient, to be changed.
    pub(super) fn coefficients(&mut self) -> Vec<&mut DoubleDouble> {
        self.kicks.iter_mut().chain(&mut self.drifts).collect()
    }

    /// Whether the pieces read the same in both directions, to the last bit.
    pub(super) fn is_palindrome(&self) -> bool {
        let same = |list: &[DoubleDouble]| list.iter().eq(list.iter().rev());
        same(&self.kicks) && same(&self.drifts)
    }

    /// Force evaluations per step when the last kick's force is kept for the next step's first.
    pub(super) fn evaluations(&self) -> usize {
        let kicked = |kick: Option<&DoubleDouble>| kick.is_some_and(|kick| kick.to_f64() != 0.0);
        let count = self.kicks.iter().filter(|&kick| kicked(Some(kick))).count();
        count - usize::from(kicked(self.kicks.first()) && kicked(self.kicks.last()))
    }

    /// The worst miss over the words of at most `order` letters.
    pub(super) fn misses(&self, order: usize) -> Vec<Family> {
        // A word is its letters as binary digits after a leading 1; the empty word is 1.
        let words = 2 << order;
        let mut series = vec![(DoubleDouble::zero(), 0.0); words];
        series[1] = (DoubleDouble::one(), 1.0);
        for piece in 0..self.drifts.len() {
            times_exponential(&mut series, 0, self.kicks[piece]);
            times_exponential(&mut series, 1, self.drifts[piece]);
        }
        if let Some(&last) = self.kicks.last() {
            times_exponential(&mut series, 0, last);
        }
        let mut family = Family::new(Kind::Step);
        for word in 2..words {
            let factorial: f64 = (1..=word.ilog2()).map(f64::from).product();
            let exact = DoubleDouble::one() / DoubleDouble::from(factorial);
            family.note(series[word].0, exact, series[word].1);
        }
        vec![family]
    }
}

/// Multiplies a series, and beside it the sum of the magnitudes of its terms, by `exp(length · letter)`.
fn times_exponential(series: &mut [(DoubleDouble, f64)], letter: usize, length: DoubleDouble) {
    // From the longest word down: every word reads only its own beginnings, which are not yet changed.
    for word in (2..series.len()).rev() {
        let mut factor = (DoubleDouble::one(), 1.0);
        let mut rest = word;
        let mut sum = series[word];
        for power in 1.. {
            if rest == 1 || rest & 1 != letter {
                break;
            }
            rest >>= 1;
            factor.0 = factor.0 * length / DoubleDouble::from(f64::from(power));
            factor.1 *= length.to_f64().abs() / f64::from(power);
            sum.0 += series[rest].0 * factor.0;
            sum.1 += series[rest].1 * factor.1;
        }
        series[word] = sum;
    }
}
