//! Matrices of double-doubles by columns, eight rows to a register: products, and series of exponentials.
//!
//! The one idea: sums wait for one addition a term. What is left out of it and of the products is added beside, and joined at
//! the end, to 1e-31 of the sum of all terms' sizes (T. Ogita, S. M. Rump & S. Oishi, SIAM J. Sci. Comput. 26 (2005) 1955).

use crate::numerics::double_double::{DoubleDouble, quick_two_sum, two_sum};
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::tiered;

/// Eight numbers and what they leave out.
type Eight = [Lanes; 2];

/// A matrix, or a vector, which has one column.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    rows: usize,
    /// Registers of a column.
    each: usize,
    numbers: Vec<Eight>,
}

impl Columns {
    /// Zeros.
    pub(super) fn new(rows: usize, columns: usize) -> Self {
        let each = rows.div_ceil(WIDTH);
        Self { rows, each, numbers: vec![[Lanes::zero(); 2]; each * columns] }
    }

    /// Of numbers, row by row.
    pub(super) fn of(numbers: &[DoubleDouble], rows: usize) -> Self {
        let columns = numbers.len() / rows;
        let mut matrix = Self::new(rows, columns);
        for (index, &number) in numbers.iter().enumerate() {
            matrix.set(index / columns, index % columns, number);
        }
        matrix
    }

    pub(super) fn set(&mut self, row: usize, column: usize, number: DoubleDouble) {
        let [high, low] = &mut self.numbers[column * self.each + row / WIDTH];
        (high.0[row % WIDTH], low.0[row % WIDTH]) = number.parts();
    }

    pub(super) fn get(&self, row: usize, column: usize) -> DoubleDouble {
        let [high, low] = &self.numbers[column * self.each + row / WIDTH];
        DoubleDouble::new(high.0[row % WIDTH], low.0[row % WIDTH])
    }

    /// The unit matrix.
    pub(super) fn one(rows: usize) -> Self {
        let mut one = Self::new(rows, rows);
        one.set_one();
        one
    }

    /// Becomes the unit matrix.
    pub(super) fn set_one(&mut self) {
        self.numbers.fill([Lanes::zero(); 2]);
        (0..self.rows).for_each(|row| self.set(row, row, DoubleDouble::one()));
    }

    /// Takes a matrix for a column of [such a one](Self::of_matrices).
    pub(super) fn set_matrix(&mut self, column: usize, matrix: &Self) {
        self.numbers[column * self.each..][..self.each].copy_from_slice(&matrix.numbers);
    }

    /// Matrices as the columns of one, each with its own columns one below the other.
    pub(super) fn of_matrices(matrices: &[Self]) -> Self {
        let numbers: Vec<Eight> = matrices.iter().flat_map(|matrix| &matrix.numbers).copied().collect();
        let each = numbers.len() / matrices.len();
        Self { rows: each * WIDTH, each, numbers }
    }

    /// The product with another.
    pub(super) fn times(&self, other: &Self) -> Self {
        let columns = other.numbers.len() / other.each;
        let mut product = Self::new(self.rows, columns);
        multiply(self, other, &mut product);
        product
    }

    /// The same into one that is there. What comes of a column of matrices ([`of_matrices`](Self::of_matrices)) is a matrix.
    pub(super) fn times_into(&self, other: &Self, product: &mut Self) {
        multiply(self, other, product);
    }

    /// Takes the numbers of another of the same size.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.numbers.copy_from_slice(&other.numbers);
    }

    /// The size of the largest number; infinite if there are none.
    pub(super) fn largest(&self) -> f64 {
        let size = |largest: f64, number: f64| if number.abs() <= largest { largest } else { number.abs() };
        let largest = self.numbers.iter().flat_map(|[high, _]| high.0).fold(0.0, size);
        if largest.is_nan() { f64::INFINITY } else { largest }
    }

    /// Takes each number times a factor.
    pub(super) fn scale(&mut self, factor: DoubleDouble) {
        scale(factor, &mut self.numbers);
    }

    /// Takes the powers of a number, from the zeroth on, for the first column.
    pub(super) fn set_powers(&mut self, x: DoubleDouble) {
        set_powers(x, &mut self.numbers[..self.each]);
    }

    /// Σ (A x)ᵏ y/k! of so many k, this being A; `inverses` are 1/k.
    pub(super) fn series(&self, x: DoubleDouble, y: &Self, inverses: &[DoubleDouble]) -> Self {
        let mut sum = y.clone();
        let room = &mut [y.clone(), y.clone()];
        sum_series(self, x, inverses, (&mut sum, room));
        sum
    }
}

/// A list of matrices that keeps its room.
#[derive(Clone, Debug, Default)]
pub(super) struct Matrices {
    pub(super) all: Vec<Columns>,
    pub(super) used: usize,
}

impl Matrices {
    /// The next of them, to be written, and those before it.
    pub(super) fn next(&mut self, n: usize) -> (&mut Columns, &[Columns]) {
        if self.used == self.all.len() {
            self.all.push(Columns::new(n, n));
        }
        self.used += 1;
        let (before, rest) = self.all.split_at_mut(self.used - 1);
        (&mut rest[0], before)
    }
}

/// a b, to twice the digits.
#[inline(always)]
fn product<V: Real>(a: [V; 2], b: [V; 2]) -> [V; 2] {
    let high = a[0] * b[0];
    let rest = a[0].multiply_add(b[0], -high);
    [high, a[0].multiply_add(b[1], a[1].multiply_add(b[0], rest))]
}

/// A column of a product.
#[inline(always)]
fn column<V: Vector8>(a: &Columns, b: &[Eight], into: &mut [Eight]) {
    for (block, into) in into.iter_mut().enumerate() {
        let (mut sum, mut low) = (V::zero(), V::zero());
        for j in 0..a.numbers.len() / a.each {
            let [high, rest] = &b[j / WIDTH];
            // Of what moves by itself most are nothing.
            if high.0[j % WIDTH] == 0.0 {
                continue;
            }
            let factor = [V::splat(high.0[j % WIDTH]), V::splat(rest.0[j % WIDTH])];
            let [of_high, of_low] = a.numbers[j * a.each + block];
            let [term, left] = product([V::load(of_high), V::load(of_low)], factor);
            let (next, lost) = two_sum(sum, term);
            sum = next;
            low += lost + left;
        }
        let (high, low) = quick_two_sum(sum, low);
        *into = [high.store(), low.store()];
    }
}

#[inline(always)]
fn multiply_body<V: Vector8>(a: &Columns, b: &Columns, into: &mut Columns) {
    for (b, into) in b.numbers.chunks_exact(b.each).zip(into.numbers.chunks_exact_mut(a.each)) {
        column::<V>(a, b, into);
    }
}

#[inline(always)]
fn normalized<V: Real>([high, low]: [V; 2]) -> [V; 2] {
    let (high, low) = quick_two_sum(high, low);
    [high, low]
}

#[inline(always)]
fn scale_body<V: Vector8>(factor: DoubleDouble, numbers: &mut [Eight]) {
    let (high, low) = factor.parts();
    let factor = [V::splat(high), V::splat(low)];
    for number in numbers {
        *number = normalized(product(number.map(V::load), factor)).map(V::store);
    }
}

#[inline(always)]
fn set_powers_body<V: Vector8>(x: DoubleDouble, into: &mut [Eight]) {
    let (high, low) = x.parts();
    let mut square = [V::splat(high), V::splat(low)];
    let mut powers = [V::splat(1.0), V::zero()];
    // By the binary digits of the exponents.
    for digit in 0..WIDTH.trailing_zeros() {
        let [of_high, of_low] = square.map(V::store);
        let (mut high, mut low) = (Lanes::splat(1.0), Lanes::zero());
        for lane in (0..WIDTH).filter(|lane| lane >> digit & 1 == 1) {
            (high.0[lane], low.0[lane]) = (of_high.0[lane], of_low.0[lane]);
        }
        powers = normalized(product(powers, [V::load(high), V::load(low)]));
        square = normalized(product(square, square));
    }
    for into in into {
        *into = powers.map(V::store);
        powers = normalized(product(powers, square));
    }
}

#[inline(always)]
fn series_body<V: Vector8>(
    a: &Columns,
    x: DoubleDouble,
    inverses: &[DoubleDouble],
    (sum, [term, next]): (&mut Columns, &mut [Columns; 2]),
) {
    for &inverse in inverses {
        let (high, low) = (x * inverse).parts();
        let factor = [V::splat(high), V::splat(low)];
        for at in (0..sum.numbers.len()).step_by(a.each) {
            column::<V>(a, &term.numbers[at..at + a.each], &mut next.numbers[at..at + a.each]);
        }
        for (at, sum) in sum.numbers.iter_mut().enumerate() {
            let [of_high, of_low] = next.numbers[at];
            let [term_high, term_low] = product([V::load(of_high), V::load(of_low)], factor);
            let (high, lost) = two_sum(V::load(sum[0]), term_high);
            let (high, low) = quick_two_sum(high, lost + (V::load(sum[1]) + term_low));
            *sum = [high.store(), low.store()];
            let (high, low) = quick_two_sum(term_high, term_low);
            term.numbers[at] = [high.store(), low.store()];
        }
    }
}

tiered! {
    fn scale[][](factor: DoubleDouble, numbers: &mut [Eight]) = scale_body;
    fn set_powers[][](x: DoubleDouble, into: &mut [Eight]) = set_powers_body;
    fn multiply[][](a: &Columns, b: &Columns, into: &mut Columns) = multiply_body;
    fn sum_series[][](a: &Columns, x: DoubleDouble, inverses: &[DoubleDouble], into: (&mut Columns, &mut [Columns; 2])) = series_body;
}
