//! Rows of numbers, one for each piece of a range: which row is that of an argument, in every lane.
//!
//! The one idea: a guess by equal bins, then comparisons with the places themselves, so that what is found does not
//! depend on how the bins were rounded; lanes are looked up one by one, with the bits of one alone.

use super::double_double::DoubleDouble;
use super::lanes::{Lanes, Vector8, WIDTH};
use super::real::Real;

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};

/// A row from each place on, to the next.
#[derive(Clone, Debug)]
pub struct Rows<const N: usize> {
    starts: Vec<f64>,
    rows: Vec<[f64; N]>,
    /// For each bin, how many places are in bins before it.
    before: Vec<u32>,
    per_length: f64,
}

impl<const N: usize> Rows<N> {
    /// From rows and the places where they begin, which ascend.
    pub fn new(starts: Vec<f64>, rows: Vec<[f64; N]>) -> Self {
        Self::with_bins(starts, rows, 2)
    }
    /// The same with so many bins to each row: of arguments that nothing foretells, the more there are the fewer fall into one
    /// with a place in it, where a comparison goes either way.
    pub fn with_bins(starts: Vec<f64>, rows: Vec<[f64; N]>, to_each: usize) -> Self {
        let count = (to_each * starts.len()).max(1);
        let range = starts.last().zip(starts.first()).map_or(1.0, |(last, first)| last - first);
        let mut made = Self { starts, rows, before: vec![0; count + 1], per_length: count as f64 / range };
        for index in 0..made.starts.len() {
            let bin = made.bin(made.starts[index]);
            made.before[bin + 1] += 1;
        }
        for bin in 0..count {
            made.before[bin + 1] += made.before[bin];
        }
        made
    }
    /// Where the rows begin.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }
    /// All rows.
    pub fn rows(&self) -> &[[f64; N]] {
        &self.rows
    }
    /// The bin of an argument, which never falls as the argument rises; the first of what is no number.
    #[inline(always)]
    fn bin(&self, x: f64) -> usize {
        // A conversion to an integer stops at the ends.
        (((x - self.starts[0]) * self.per_length) as usize).min(self.before.len() - 2)
    }
    /// The row of an argument: the last that begins at or before it, the first for arguments before all.
    #[inline(always)]
    pub fn at(&self, x: f64) -> &[f64; N] {
        let bin = self.bin(x);
        let mut low = self.before[bin].saturating_sub(1) as usize;
        let mut high = self.before[bin + 1].saturating_sub(1) as usize;
        while low < high {
            let middle = (low + high).div_ceil(2);
            if self.starts[middle] <= x {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        &self.rows[low]
    }
}

/// Scalars that can be looked up.
pub trait Lookup: Real {
    /// The row of each lane, as columns.
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N];
}

impl Lookup for f64 {
    #[inline(always)]
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N] {
        *rows.at(self)
    }
}

impl Lookup for DoubleDouble {
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N] {
        rows.at(self.high()).map(Self::from)
    }
}

#[inline(always)]
fn columns<V: Vector8, const N: usize>(x: V, rows: &Rows<N>) -> [V; N] {
    let places = x.store().0;
    let mut columns = [Lanes([0.0; WIDTH]); N];
    for lane in 0..WIDTH {
        let row = rows.at(places[lane]);
        for n in 0..N {
            columns[n].0[lane] = row[n];
        }
    }
    let mut loaded = [V::zero(); N];
    for n in 0..N {
        loaded[n] = V::load(columns[n]);
    }
    loaded
}

impl Lookup for Lanes {
    #[inline(always)]
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N] {
        columns(self, rows)
    }
}
#[cfg(target_arch = "x86_64")]
impl Lookup for Avx2 {
    #[inline(always)]
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N] {
        columns(self, rows)
    }
}
#[cfg(target_arch = "x86_64")]
impl Lookup for Avx512 {
    #[inline(always)]
    fn columns<const N: usize>(self, rows: &Rows<N>) -> [Self; N] {
        columns(self, rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// As a search from end to end finds it.
    fn plainly(starts: &[f64], x: f64) -> f64 {
        starts.iter().rposition(|start| *start <= x).unwrap_or(0) as f64
    }

    proptest! {
        #[test]
        fn the_row_is_that_of_the_place(gaps in prop::collection::vec(-300.0..0.0f64, 1..60), x in 0.0..1.2f64) {
            // Places crowd by hundreds of powers of ten, as bins do not.
            let mut starts: Vec<f64> = gaps.iter().map(|gap| 10.0_f64.powf(*gap)).collect();
            starts.sort_by(f64::total_cmp);
            starts.dedup();
            let rows = Rows::new(starts.clone(), (0..starts.len()).map(|at| [at as f64]).collect());
            let mut places: Vec<f64> = starts.iter().flat_map(|s| [*s, s.next_up(), s.next_down()]).collect();
            places.extend([x, x * starts[0], -x, f64::INFINITY]);
            for place in places {
                prop_assert_eq!(rows.at(place)[0], plainly(&starts, place));
                prop_assert_eq!(Lanes::splat(place).columns(&rows)[0].0[3], plainly(&starts, place));
            }
            prop_assert_eq!(rows.at(f64::NAN)[0], 0.0);
        }
    }
}
