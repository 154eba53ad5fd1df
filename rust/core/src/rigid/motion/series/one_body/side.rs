//! Eight numbers of a body side by side: in one register, or in a register each with those of seven other bodies.

use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::rigid::motion::vectors::{turned_back, turned_back_by_all};

/// The quaternion, then the momentum along the body's axes: which of them are the left factors of the products.
pub(super) const LEFT: [[i64; WIDTH]; 3] =
    [[3, 2, 1, 0, 5, 6, 4, 2], [2, 3, 0, 1, 0, 1, 2, 0], [1, 0, 3, 2, 1, 2, 0, 1]];
/// The right ones, but for the first four, which are a part of the angular velocity, one for each register.
pub(super) const RIGHT: [[i64; WIDTH]; 3] =
    [[0, 0, 0, 0, 6, 4, 5, 3], [0, 0, 0, 0, 0, 1, 2, 1], [0, 0, 0, 0, 2, 0, 3, 3]];
/// Where the momentum begins.
pub(super) const MOMENTUM: usize = 4;

/// The momentum along the axes. What a rounded quaternion lacks of length 1 would lengthen it, in many steps to one side.
#[inline(always)]
fn along_axes<S: Real>(of: &[S]) -> [S; 3] {
    let (q, rest) = ([of[0], of[1], of[2], of[3]], [of[7], of[8], of[9], of[10]]);
    let mut own = turned_back_by_all(q, rest, [of[4], of[5], of[6]]);
    let left = turned_back(q, [of[11], of[12], of[13]]);
    for c in 0..3 {
        own[c] += left[c];
    }
    own
}

/// Eight numbers of a body.
pub(super) trait Side<V: Vector8>: Copy {
    /// Registers of them.
    const EACH: usize;
    /// Registers of the factors of an order.
    const FACTORS: usize;
    /// A number of the body eight times.
    fn each(number: V) -> Self;
    /// The quaternion and the momentum along the axes, of the quaternion and the momentum in space and what they leave out.
    fn begin(start: &[V]) -> Self;
    fn load(memory: &[V], row: usize) -> Self;
    fn store(self, memory: &mut [V], row: usize);
    /// Keeps what the products are made of, and the angular velocity, of an order.
    fn keep(self, angular_velocity: Self, factors: &mut [V], order: usize);
    fn left(factors: &[V], which: usize, order: usize) -> Self;
    fn right(factors: &[V], which: usize, order: usize) -> Self;
    fn multiply_add(self, factor: Self, term: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn plus(self, other: Self) -> Self;
    /// The numbers in another order.
    fn arranged(self, index: &[i64; WIDTH]) -> Self;
    /// The first four of these, the last four of those.
    fn joined(self, last: Self) -> Self;
}

/// In one register.
#[derive(Clone, Copy)]
pub(super) struct Alone<V>(V);

/// A register each.
#[derive(Clone, Copy)]
pub(super) struct Abreast<V>([V; WIDTH]);

impl<V: Vector8> Side<V> for Alone<V> {
    const EACH: usize = 1;
    const FACTORS: usize = 6;
    #[inline(always)]
    fn each(number: V) -> Self {
        Self(number)
    }
    #[inline(always)]
    fn begin(start: &[V]) -> Self {
        let mut of = [0.0; 14];
        for number in 0..14 {
            of[number] = start[number].store().0[0];
        }
        let [a, b, c] = along_axes(&of);
        Self(V::load(Lanes([of[0], of[1], of[2], of[3], a, b, c, 0.0])))
    }
    #[inline(always)]
    fn load(memory: &[V], row: usize) -> Self {
        Self(memory[row])
    }
    #[inline(always)]
    fn store(self, memory: &mut [V], row: usize) {
        memory[row] = self.0;
    }
    #[inline(always)]
    fn keep(self, angular_velocity: Self, factors: &mut [V], order: usize) {
        let into = &mut factors[order * Self::FACTORS..][..Self::FACTORS];
        for which in 0..3 {
            let part = angular_velocity.arranged(&[(MOMENTUM + which) as i64; WIDTH]);
            into[2 * which] = self.arranged(&LEFT[which]).0;
            into[2 * which + 1] = part.joined(self.arranged(&RIGHT[which])).0;
        }
    }
    #[inline(always)]
    fn left(factors: &[V], which: usize, order: usize) -> Self {
        Self(factors[order * Self::FACTORS + 2 * which])
    }
    #[inline(always)]
    fn right(factors: &[V], which: usize, order: usize) -> Self {
        Self(factors[order * Self::FACTORS + 2 * which + 1])
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.multiply_add(factor.0, term.0))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    #[inline(always)]
    fn arranged(self, index: &[i64; WIDTH]) -> Self {
        Self(self.0.permute(index))
    }
    #[inline(always)]
    fn joined(self, last: Self) -> Self {
        Self(V::select(Bits(0b0000_1111), self.0, last.0))
    }
}

impl<V: Vector8> Side<V> for Abreast<V> {
    const EACH: usize = WIDTH;
    const FACTORS: usize = 2 * WIDTH;
    #[inline(always)]
    fn each(number: V) -> Self {
        Self([number; WIDTH])
    }
    #[inline(always)]
    fn begin(start: &[V]) -> Self {
        let [a, b, c] = along_axes(start);
        Self([start[0], start[1], start[2], start[3], a, b, c, V::zero()])
    }
    #[inline(always)]
    fn load(memory: &[V], row: usize) -> Self {
        let mut of = [V::zero(); WIDTH];
        of.copy_from_slice(&memory[row * WIDTH..][..WIDTH]);
        Self(of)
    }
    #[inline(always)]
    fn store(self, memory: &mut [V], row: usize) {
        memory[row * WIDTH..][..WIDTH].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn keep(self, angular_velocity: Self, factors: &mut [V], order: usize) {
        self.store(factors, 2 * order);
        angular_velocity.store(factors, 2 * order + 1);
    }
    #[inline(always)]
    fn left(factors: &[V], which: usize, order: usize) -> Self {
        Self::load(factors, 2 * order).arranged(&LEFT[which])
    }
    #[inline(always)]
    fn right(factors: &[V], which: usize, order: usize) -> Self {
        let part = Self::each(factors[(2 * order + 1) * WIDTH + MOMENTUM + which]);
        part.joined(Self::load(factors, 2 * order).arranged(&RIGHT[which]))
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        let mut sums = self.0;
        for number in 0..WIDTH {
            sums[number] = self.0[number].multiply_add(factor.0[number], term.0[number]);
        }
        Self(sums)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let mut products = self.0;
        for number in 0..WIDTH {
            products[number] = self.0[number] * other.0[number];
        }
        Self(products)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let mut sums = self.0;
        for number in 0..WIDTH {
            sums[number] = self.0[number] + other.0[number];
        }
        Self(sums)
    }
    #[inline(always)]
    fn arranged(self, index: &[i64; WIDTH]) -> Self {
        let mut numbers = self.0;
        for number in 0..WIDTH {
            numbers[number] = self.0[(index[number] & 7) as usize];
        }
        Self(numbers)
    }
    #[inline(always)]
    fn joined(self, last: Self) -> Self {
        let mut numbers = last.0;
        numbers[..WIDTH / 2].copy_from_slice(&self.0[..WIDTH / 2]);
        Self(numbers)
    }
}
