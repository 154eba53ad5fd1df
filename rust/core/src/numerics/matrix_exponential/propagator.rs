//! exp(A t) at some times, at each of which it moves many vectors.
//!
//! The one idea: what is the same for all vectors is done once. The powers of A are there, so that the series for the rest of a
//! time is a sum of matrices; the product for its whole units begins with what it has in common with the time before it. What
//! grows with time is none of that: of products of large numbers that cancel nothing is left, and a vector goes through the
//! powers one after another.

use super::columns::{Columns, Matrices};
use super::{MatrixExponential, TERMS};
use crate::numerics::double_double::DoubleDouble;

/// Products of matrices with larger numbers than this are not made.
const LARGE: f64 = 8.0;

/// A linear flow y′ = A y, from the start to some times.
#[derive(Clone, Debug)]
pub struct Propagator {
    flow: MatrixExponential,
    /// (A u)ᵏ/k!, one matrix to a column.
    terms: Columns,
    /// The times that vectors are moved to, and what moves them.
    times: Vec<DoubleDouble>,
    moves: Vec<Move>,
    /// exp(A u x) for the rests x of the times, in order.
    rests: Matrices,
    /// exp(A u w) for whole units w, each for the times that have it.
    wholes: Matrices,
    /// Of the whole units of the last time, the binary digits that are one, from the highest on, and the products of the powers
    /// for them as far.
    digits: Vec<Digit>,
    products: Matrices,
    /// Room for a vector on its way, and for powers of a number.
    vectors: [Columns; 2],
    powers: Columns,
}

/// A binary digit of the whole units that is one, and whether the product as far has large numbers.
#[derive(Clone, Copy, Debug)]
struct Digit {
    place: u32,
    is_large: bool,
}

/// How a vector comes to a time: by the rest of a unit, if the time is not so long that no digit would be left, and by whole ones.
#[derive(Clone, Copy, Debug)]
struct Move {
    rest: Option<usize>,
    whole: Whole,
}

/// Whole units of time.
#[derive(Clone, Copy, Debug)]
enum Whole {
    /// None of them.
    None,
    /// By the matrix at a place.
    Matrix(usize),
    /// By powers, one after another.
    Powers(u64),
}

impl Propagator {
    /// Of a matrix of `n` rows, with numbers of like size in a time of about `longest`.
    pub fn new(matrix: Vec<DoubleDouble>, n: usize, longest: f64) -> Self {
        let mut new = Self {
            terms: Columns::of_matrices(&vec![Columns::one(n); TERMS + 1]),
            flow: MatrixExponential::new(matrix, n, longest),
            times: Vec::new(),
            moves: Vec::new(),
            rests: Matrices::default(),
            wholes: Matrices::default(),
            digits: Vec::new(),
            products: Matrices::default(),
            vectors: core::array::from_fn(|_| Columns::new(n, 1)),
            powers: Columns::new(TERMS + 1, 1),
        };
        new.set_terms();
        new
    }

    /// Takes another matrix, of as many rows, and keeps the room.
    pub fn take(&mut self, matrix: Vec<DoubleDouble>, longest: f64) {
        self.flow.take(matrix, longest);
        self.times.clear();
        self.moves.clear();
        self.digits.clear();
        self.products.used = 0;
        self.set_terms();
    }

    /// Finds (A u)ᵏ/k!, of which the zeroth is there.
    fn set_terms(&mut self) {
        let Self { flow, terms, rests, .. } = self;
        rests.used = 0;
        rests.next(flow.n).0.set_one();
        for (k, inverse) in flow.inverses.iter().enumerate() {
            let (next, before) = rests.next(flow.n);
            if let Some(last) = before.last() {
                flow.step.times_into(last, next);
            }
            next.scale(*inverse);
            terms.set_matrix(k + 1, next);
        }
    }

    /// Takes the times t ≥ 0 that vectors are moved to.
    pub fn set_times(&mut self, times: &[DoubleDouble]) {
        if self.times == times {
            return;
        }
        self.times.clear();
        self.times.extend(times);
        self.moves.clear();
        (self.rests.used, self.wholes.used) = (0, 0);
        let mut last = (0, Whole::None);
        for &time in times {
            let Some((whole, rest)) = self.flow.counted((time.high(), time.low())) else {
                self.moves.push(Move { rest: None, whole: Whole::None });
                continue;
            };
            self.powers.set_powers(rest);
            self.terms.times_into(&self.powers, self.rests.next(self.flow.n).0);
            if last.0 != whole {
                last = (whole, self.of_whole(whole));
            }
            self.moves.push(Move { rest: Some(self.rests.used - 1), whole: last.1 });
        }
    }

    /// How a vector goes through so many units.
    fn of_whole(&mut self, whole: u64) -> Whole {
        let Self { flow, digits, products, wholes, .. } = self;
        let n = flow.n;
        let wanted = || (0..u64::BITS).rev().filter(|place| whole >> place & 1 == 1);
        let known = digits.iter().zip(wanted()).take_while(|(digit, place)| digit.place == *place).count();
        digits.truncate(known);
        products.used = known;
        for place in wanted().skip(known) {
            let power = flow.power(place);
            let was_large = digits.last().is_some_and(|digit| digit.is_large);
            let product = match products.next(n) {
                (product, [.., before]) => {
                    if !was_large {
                        power.times_into(before, product);
                    }
                    product
                }
                (product, []) => {
                    product.copy_from(power);
                    product
                }
            };
            digits.push(Digit { place, is_large: was_large || product.largest() > LARGE });
        }
        match digits.last() {
            None => Whole::None,
            Some(digit) if digit.is_large => Whole::Powers(whole),
            Some(_) => {
                wholes.next(n).0.copy_from(&products.all[products.used - 1]);
                Whole::Matrix(wholes.used - 1)
            }
        }
    }

    /// A vector at one of the times; no numbers if that is so long that no digit would be left.
    pub fn moved<const N: usize>(&mut self, time: usize, y: &[f64; N]) -> [DoubleDouble; N] {
        let Self { flow, moves, rests, wholes, vectors: [vector, next], .. } = self;
        let Move { rest: Some(rest), whole } = moves[time] else {
            return [DoubleDouble::from(f64::NAN); N];
        };
        for (row, (&y, unit)) in y.iter().zip(&flow.units).enumerate() {
            next.set(row, 0, DoubleDouble::from(y / unit));
        }
        rests.all[rest].times_into(next, vector);
        match whole {
            Whole::None => {}
            Whole::Matrix(place) => {
                wholes.all[place].times_into(vector, next);
                core::mem::swap(vector, next);
            }
            Whole::Powers(whole) => {
                for place in (0..u64::BITS).filter(|place| whole >> place & 1 == 1) {
                    flow.power(place).times_into(vector, next);
                    core::mem::swap(vector, next);
                }
            }
        }
        core::array::from_fn(|row| vector.get(row, 0).scale(flow.units[row]))
    }
}
