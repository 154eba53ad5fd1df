//! The continuous extension of a step: the polynomial through the rates of its stages and of as many places more, at both ends and
//! between stages.
//!
//! The one idea: a step of twice as many stages errs by as little within as Gauss's method at its end, and it is nearly found: the
//! stages err by what their polynomial leaves out, which rates at the places more tell, and an iteration of all leaves about a
//! twentieth of h‖J‖ (of the second order of its square, a three-hundredth). It is found once for a step, in Legendre polynomials,
//! and whatever is read off it costs a sum of their integrals: a state is the same whatever else is read.

mod eight;
mod one;

use super::Table;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
pub(super) use eight::{ExtensionOfEight, find as find_eight, read as read_eight};
pub(super) use one::{ExtensionOfOne, find, read};

/// The most terms that a polynomial has.
pub(super) const TERMS: usize = 2 * WIDTH;
/// By what part of a change of rates those after them change, of the way in a step: a place moves by no more than about this.
const MOVED: f64 = 1.0 / 16.0;
/// What is still to come, as the last two changes tell, is nothing below this part of a size.
const ENOUGH: f64 = f64::EPSILON / 16.0;

/// Weights of the stages and of the places more, as a row for what each of them adds to the lanes.
type Rows = [[Lanes; WIDTH]; 2];

/// What follows from a table alone. Of pairs, the first belongs to the stages, and the second to the places more.
#[derive(Debug)]
pub(super) struct Extension {
    /// Where rates are found, as fractions of the step: both ends, and between stages, as many as these.
    places: [Lanes; 2],
    /// The polynomial through the stages at the places more.
    guess: [Lanes; WIDTH],
    /// What rates add to their integral up to stages and places, …
    way: [Rows; 2],
    /// … and to that of this one.
    way_of_way: [Rows; 2],
    /// What they add to the coefficients of the polynomial, eight of these and then the others.
    coefficients: [Rows; 2],
    /// How many coefficients there are.
    terms: usize,
}

impl Extension {
    /// Of a method.
    pub(super) fn of(table: &Table) -> Self {
        let (stages, terms) = (table.stages, 2 * table.stages);
        let node = |k: usize| DoubleDouble::sum(table.c.0[k], table.c_rest.0[k]);
        let between = |k: usize| 0.5 * (table.c.0[k] + table.c.0[k + 1]);
        // That in the middle is left out: both ends are there.
        let gaps = (0..stages - 1).filter(|k| 2 * k + 2 != stages).map(between);
        let mut more = Lanes([0.0; WIDTH]);
        for (place, x) in more.0.iter_mut().zip([0.0, 1.0].into_iter().chain(gaps)) {
            *place = x;
        }
        let places = [table.c, more];
        let nodes = (0..stages).map(node).chain(more.0[..stages].iter().map(|&x| DoubleDouble::from(x)));
        let inverse = inverse(nodes.map(|x| legendre(x)[..terms].to_vec()).collect());
        let of = |term: usize, rate: usize| inverse[term][rate].to_f64();
        let nothing = [[Lanes([0.0; WIDTH]); WIDTH]; 2];
        let (mut way, mut way_of_way, mut coefficients) = ([nothing; 2], [nothing; 2], [nothing; 2]);
        for (whose, k) in (0..2).flat_map(|whose| (0..stages).map(move |k| (whose, k))) {
            let rate = whose * stages + k;
            for term in 0..terms {
                coefficients[term / WIDTH][whose][k].0[term % WIDTH] = of(term, rate);
            }
            for (to, place) in (0..2).flat_map(|to| (0..stages).map(move |place| (to, place))) {
                let [once, twice] = integrals(places[to].0[place], terms);
                way[to][whose][k].0[place] = (0..terms).map(|term| once[term] * of(term, rate)).sum();
                way_of_way[to][whose][k].0[place] = (0..terms).map(|term| twice[term] * of(term, rate)).sum();
            }
        }
        Self { guess: table.at(&more), places, way, way_of_way, coefficients, terms }
    }
}

/// Legendre polynomials at `x` of 0 … 1, stretched to that.
fn legendre(x: DoubleDouble) -> [DoubleDouble; TERMS] {
    let number = |n: usize| DoubleDouble::from(n as f64);
    let x = x + x - DoubleDouble::one();
    let mut values = [DoubleDouble::one(); TERMS];
    values[1] = x;
    for n in 1..TERMS - 1 {
        values[n + 1] = (number(2 * n + 1) * x * values[n] - number(n) * values[n - 1]) / number(n + 1);
    }
    values
}

/// The inverse of a matrix by its rows, by elimination; each column has a pivot where it is largest.
fn inverse(mut rows: Vec<Vec<DoubleDouble>>) -> Vec<Vec<DoubleDouble>> {
    let count = rows.len();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend((0..count).map(|j| DoubleDouble::from(if i == j { 1.0 } else { 0.0 })));
    }
    for column in 0..count {
        let size = |row: &Vec<DoubleDouble>| row[column].to_f64().abs();
        let pivot =
            (column..count).max_by(|&i, &j| size(&rows[i]).total_cmp(&size(&rows[j]))).unwrap_or(column);
        rows.swap(column, pivot);
        let over = DoubleDouble::one() / rows[column][column];
        rows[column].iter_mut().for_each(|entry| *entry = *entry * over);
        let own = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != column) {
            let factor = row[column];
            for (entry, &own) in row.iter_mut().zip(&own) {
                *entry -= factor * own;
            }
        }
    }
    rows.into_iter().map(|mut row| row.split_off(count)).collect()
}

/// (n + 1)⁻¹ of each n.
const OVER: [f64; 2 * TERMS] = {
    let mut over = [1.0; 2 * TERMS];
    let mut n = 0;
    while n < 2 * TERMS {
        over[n] = 1.0 / (n + 1) as f64;
        n += 1;
    }
    over
};

/// Integrals of so many Legendre polynomials from the beginning of a step to a fraction of it, and integrals of these.
///
/// Of the nth that is −2θ(1 − θ) Pₙ′/(n(n + 1)), which loses no digits near the ends (NIST DLMF 18.9.9 and 18.9.16), and
/// between those of its neighbors for the integral of it.
#[inline(always)]
fn integrals<S: Real>(theta: S, terms: usize) -> [[S; TERMS]; 2] {
    let mut once = [S::zero(); TERMS + 1];
    let mut twice = [S::zero(); TERMS];
    let x = theta + theta - S::one();
    let both = S::splat(-2.0) * theta * (S::one() - theta);
    // Of n − 1 and n.
    let (mut before, mut value) = (S::one(), x);
    let (mut slope_before, mut slope) = (S::zero(), S::one());
    once[0] = theta;
    twice[0] = S::splat(0.5) * theta * theta;
    for n in 1..=terms {
        let number = n as f64;
        once[n] = both * slope * S::splat(OVER[n] * OVER[n - 1]);
        if n < terms {
            let odd = S::splat(2.0 * number + 1.0);
            let next = (odd * x * value - S::splat(number) * before) * S::splat(OVER[n]);
            let next_slope = odd.multiply_add(value, slope_before);
            (before, value, slope_before, slope) = (value, next, slope, next_slope);
        }
        if n > 1 {
            twice[n - 1] = (once[n] - once[n - 2]) * S::splat(0.5 * OVER[2 * n - 2]);
        }
    }
    let mut kept = [S::zero(); TERMS];
    kept.copy_from_slice(&once[..TERMS]);
    [kept, twice]
}

#[cfg(test)]
mod tests {
    use super::super::METHODS;
    use super::super::tables::GAUSS16;
    use super::*;

    /// Of rates (p + 1) cᵖ at all nodes: what the coefficients make of them at a fraction.
    fn read(tables: &Extension, table: &Table, p: i32, theta: f64) -> [f64; 2] {
        let rate = |x: f64| f64::from(p + 1) * x.powi(p);
        let [once, twice] = integrals(theta, tables.terms);
        let coefficient = |term: usize| -> f64 {
            let [by_stages, by_places] = &tables.coefficients[term / WIDTH];
            let of = |k: usize| {
                by_stages[k].0[term % WIDTH] * rate(table.c.0[k])
                    + by_places[k].0[term % WIDTH] * rate(tables.places[1].0[k])
            };
            (0..table.stages).map(of).sum()
        };
        [once, twice].map(|integrals| (0..tables.terms).map(|term| coefficient(term) * integrals[term]).sum())
    }

    #[test]
    fn powers_below_twice_the_stages_are_integrated_exactly() {
        for method in &METHODS {
            let (tables, table) = (method.extension(), method.table);
            for p in 0..2 * table.stages as i32 {
                for theta in [0.0, 1e-9, 0.013, 0.31, 0.5, 0.97, 1.0] {
                    let found = read(tables, table, p, theta);
                    let exact = [theta.powi(p + 1), theta.powi(p + 2) / f64::from(p + 2)];
                    for (found, exact) in found.into_iter().zip(exact) {
                        // Rates of up to p + 1 are rounded, and Lebesgue's constant is below 10.
                        assert!(
                            (found - exact).abs() < 1e-14,
                            "{} {p} {theta}: {found}, {exact}",
                            method.name
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn one_power_more_is_not() {
        let [found, _] = read(METHODS[2].extension(), &GAUSS16, 16, 0.3);
        assert!((found - 0.3_f64.powi(17)).abs() > 1e-12);
    }

    #[test]
    fn ways_lead_to_stages_and_places() {
        for method in &METHODS {
            let (tables, stages) = (method.extension(), method.table.stages);
            let p = 2 * stages as i32 - 1;
            let (n, m) = (f64::from(p + 1), f64::from(p + 2));
            for (to, place) in (0..2).flat_map(|to| (0..stages).map(move |place| (to, place))) {
                let x = tables.places[to].0[place];
                let sum = |rows: &Rows| -> f64 {
                    let of =
                        |whose: usize, k: usize| rows[whose][k].0[place] * tables.places[whose].0[k].powi(p);
                    (0..stages).map(|k| of(0, k) + of(1, k)).sum()
                };
                assert!((sum(&tables.way[to]) - x.powi(p + 1) / n).abs() < 1e-15, "{} {x}", method.name);
                let twice = sum(&tables.way_of_way[to]);
                assert!((twice - x.powi(p + 2) / n / m).abs() < 1e-15, "{} {x}", method.name);
            }
        }
    }

    /// Integrals of Legendre polynomials against sums of powers, near an end as well.
    #[test]
    fn integrals_keep_their_digits() {
        let x = 1e-8_f64;
        let [once, twice] = integrals(x, TERMS);
        // P₃(2θ − 1) = −1 + 12θ − 30θ² + 20θ³.
        let third = -x + 6.0 * x * x - 10.0 * x.powi(3) + 5.0 * x.powi(4);
        assert!((once[3] / third - 1.0).abs() < 1e-14, "{}", once[3]);
        // Between its neighbors twice loses digits as x², which is nothing beside what moves by x.
        assert!((twice[3] + 0.5 * x * x).abs() < 1e-16 * x * 10.0, "{}", twice[3]);
    }
}
