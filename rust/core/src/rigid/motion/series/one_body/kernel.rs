//! All coefficients of the motion of one body, order by order.
//!
//! With M the momentum along the axes, ω = M/I and R the rotation matrix: q′ = q ω/2, M′ = M × ω + c × RᵀF + τ, and in space
//! L′ = Rc × F + Rτ, with F the weight, c the center from the point that is held and τ the torque along the axes.

use super::side::{Abreast, Alone, MOMENTUM, Side};
use crate::numerics::element::Scaled;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::rigid::motion::bodies::LaneBody;
use crate::tiered;

/// What the products xx, yy, zz, xy, yz, zx, xw, yw, zw add to half the rotation matrix, by row and column.
const ENTRIES: [[(usize, usize, f64); 2]; 9] = [
    [(1, 1, -1.0), (2, 2, -1.0)],
    [(0, 0, -1.0), (2, 2, -1.0)],
    [(0, 0, -1.0), (1, 1, -1.0)],
    [(0, 1, 1.0), (1, 0, 1.0)],
    [(1, 2, 1.0), (2, 1, 1.0)],
    [(0, 2, 1.0), (2, 0, 1.0)],
    [(1, 2, -1.0), (2, 1, 1.0)],
    [(0, 2, 1.0), (2, 0, -1.0)],
    [(0, 1, -1.0), (1, 0, 1.0)],
];
/// Where they are: the register of products, and the place in it.
const WHERE: [(usize, i64); 9] = [(1, 4), (1, 5), (1, 6), (1, 7), (2, 4), (2, 5), (2, 6), (2, 7), (0, 7)];
/// The signs of the parts of q ω, for each part of ω.
const SIGNS: [[f64; 4]; 3] = [[1.0, 1.0, -1.0, -1.0], [-1.0, 1.0, 1.0, -1.0], [1.0, -1.0, 1.0, -1.0]];

/// What constants there are, each of eight numbers.
mod row {
    pub(super) const INVERSE: usize = 0;
    pub(super) const INVERSE_REST: usize = 1;
    /// What the three registers of products give to the rates, and what the first leaves out.
    pub(super) const RATES: usize = 2;
    pub(super) const RATES_REST: usize = 5;
    /// What products of the matrix, and 1, give to the weight along the axes.
    pub(super) const WEIGHT: usize = 6;
    /// The same of the torque in space and the arm.
    pub(super) const OUTSIDE: usize = 16;
    /// c in the two orders of a vector product, and F.
    pub(super) const CENTER: usize = 26;
    pub(super) const FORCE: usize = 28;
    pub(super) const TORQUE: usize = 30;
    /// 0 about the axis of a rod.
    pub(super) const ACROSS: usize = 31;
    pub(super) const COUNT: usize = 32;
}

/// The constants of a body, or of eight.
pub(super) fn constants(of: &LaneBody, weight: [Lanes; 3], torque: [Lanes; 3], alone: bool) -> Vec<Lanes> {
    let mut rows = [[Lanes::zero(); WIDTH]; row::COUNT];
    let across = of.axis.map(|axis| Lanes::one() - axis);
    let torque = [0, 1, 2].map(|c| across[c] * torque[c]);
    for (which, signs) in SIGNS.iter().enumerate() {
        for (number, sign) in signs.iter().enumerate() {
            rows[row::RATES + which][number] = Lanes::splat(0.5 * sign);
        }
    }
    for c in 0..3 {
        let (next, last, at) = ((c + 1) % 3, (c + 2) % 3, MOMENTUM + c);
        rows[row::INVERSE][at] = of.exact.inverse.0[c];
        rows[row::INVERSE_REST][at] = of.exact.inverse.1[c];
        rows[row::RATES][at] = of.exact.differences.0[c];
        rows[row::RATES_REST][at] = of.exact.differences.1[c];
        rows[row::CENTER][at] = of.center[next];
        rows[row::CENTER + 1][at] = of.center[last];
        rows[row::FORCE][c] = weight[last];
        rows[row::FORCE + 1][c] = weight[next];
        rows[row::TORQUE][at] = torque[c];
        rows[row::ACROSS][at] = across[c];
        // The products that make up the matrix, less the identity; and that.
        rows[row::WEIGHT + ENTRIES.len()][at] = weight[c];
        rows[row::OUTSIDE + ENTRIES.len()][at] = of.center[c];
        rows[row::OUTSIDE + ENTRIES.len()][c] = torque[c];
    }
    for (product, entries) in ENTRIES.iter().enumerate() {
        for &(row, column, factor) in entries {
            let factor = Lanes::splat(2.0 * factor);
            rows[row::WEIGHT + product][MOMENTUM + column] += factor * weight[row];
            rows[row::OUTSIDE + product][MOMENTUM + row] += factor * of.center[column];
            rows[row::OUTSIDE + product][row] += factor * torque[column];
        }
    }
    if alone {
        let first = |row: &[Lanes; WIDTH]| Lanes(row.each_ref().map(|number| number.0[0]));
        return rows.iter().map(first).collect();
    }
    rows.as_flattened().to_vec()
}

/// A motion to be expanded.
pub(super) struct Motion<'a> {
    pub(super) constants: &'a [Lanes],
    /// The quaternion and the momentum in space, and what they leave out.
    pub(super) start: &'a [Lanes],
    pub(super) order: usize,
    pub(super) unit: &'a Lanes,
    /// 1/n.
    pub(super) inverse: &'a [Scaled<Lanes>],
    pub(super) factors: &'a mut Vec<Lanes>,
    /// Of each order two rows: the quaternion and the momentum along the axes; the momentum in space of the next order, and the
    /// arm.
    pub(super) numbers: &'a mut Vec<Lanes>,
}

/// Σ left[j] right[n − j], the outermost last: they are known last.
#[inline(always)]
fn products<V: Vector8, S: Side<V>>(factors: &[V], which: usize, n: usize) -> S {
    let first = S::left(factors, which, 0);
    if n == 0 {
        return first.times(S::right(factors, which, 0));
    }
    let (mut one, mut other) = (S::each(V::zero()), S::each(V::zero()));
    let mut j = 1;
    while j + 1 < n {
        one = S::left(factors, which, j).multiply_add(S::right(factors, which, n - j), one);
        other = S::left(factors, which, j + 1).multiply_add(S::right(factors, which, n - j - 1), other);
        j += 2;
    }
    if j < n {
        one = S::left(factors, which, j).multiply_add(S::right(factors, which, n - j), one);
    }
    one = first.multiply_add(S::right(factors, which, n), one);
    other = S::left(factors, which, n).multiply_add(S::right(factors, which, 0), other);
    one.plus(other)
}

/// What products of the matrix give, by rows of constants from one on; of the order 0 with what 1 gives.
#[inline(always)]
fn of_matrix<V: Vector8, S: Side<V>>(constants: &[V], from: usize, of: &[S; 9], zeroth: bool) -> S {
    let mut sums = [S::each(V::zero()); 3];
    if zeroth {
        sums[0] = S::load(constants, from + ENTRIES.len());
    }
    for product in 0..ENTRIES.len() {
        let chain = product % 3;
        sums[chain] = of[product].multiply_add(S::load(constants, from + product), sums[chain]);
    }
    sums[0].plus(sums[1]).plus(sums[2])
}

/// a₁ b₁ − a₂ b₂.
#[inline(always)]
fn difference<V: Vector8, S: Side<V>>(a: [S; 2], b: [S; 2]) -> S {
    let minus = S::each(V::splat(-1.0)).times(a[1]);
    a[0].multiply_add(b[0], minus.times(b[1]))
}

#[inline(always)]
fn expand<V: Vector8, S: Side<V>>(motion: Motion<'_>) {
    let Motion { constants, start, order, unit, inverse, factors, numbers } = motion;
    factors.resize((order + 1) * S::FACTORS, Lanes::zero());
    numbers.resize(2 * (order + 1) * S::EACH, Lanes::zero());
    let (constants, start, unit) = (V::view(constants), V::view(start), V::load(*unit));
    let (factors, numbers) = (V::view_mut(factors), V::view_mut(numbers));
    let mut now = S::begin(start);
    for n in 0..=order {
        now.store(numbers, 2 * n);
        let rest = now.times(S::load(constants, row::INVERSE_REST));
        now.keep(now.multiply_add(S::load(constants, row::INVERSE), rest), factors, n);
        let of = [products::<V, S>(factors, 0, n), products(factors, 1, n), products(factors, 2, n)];
        let mut entries = [of[0]; 9];
        for product in 0..ENTRIES.len() {
            let (register, place) = WHERE[product];
            entries[product] = of[register].arranged(&[place; WIDTH]);
        }
        let outside = of_matrix::<V, S>(constants, row::OUTSIDE, &entries, n == 0);
        if n == order {
            outside.store(numbers, 2 * n + 1);
            return;
        }
        // Of this order over n + 1, in the unit of time, those of the next.
        let (high, low) = (V::load(inverse[n + 1].0), V::load(inverse[n + 1].1));
        let (unit, high, low) = (S::each(unit), S::each(high), S::each(low));

        let arms = [outside.arranged(&[5, 6, 4, 7, 4, 5, 6, 7]), outside.arranged(&[6, 4, 5, 7, 4, 5, 6, 7])];
        let turning =
            difference::<V, S>([S::load(constants, row::FORCE), S::load(constants, row::FORCE + 1)], arms);
        let rate = outside.plus(turning).times(unit);
        let momentum = rate.multiply_add(high, rate.times(low));
        momentum.joined(outside).store(numbers, 2 * n + 1);

        let weight = of_matrix::<V, S>(constants, row::WEIGHT, &entries, n == 0);
        let across = [weight.arranged(&[0, 1, 2, 3, 6, 4, 5, 7]), weight.arranged(&[0, 1, 2, 3, 5, 6, 4, 7])];
        let mut torque = difference::<V, S>(
            [S::load(constants, row::CENTER), S::load(constants, row::CENTER + 1)],
            across,
        );
        if n == 0 {
            torque = torque.plus(S::load(constants, row::TORQUE));
        }
        let mut rate = torque.times(S::load(constants, row::ACROSS));
        rate = of[0].multiply_add(S::load(constants, row::RATES_REST), rate);
        rate = of[0].multiply_add(S::load(constants, row::RATES), rate);
        rate = of[1].multiply_add(S::load(constants, row::RATES + 1), rate);
        rate = of[2].multiply_add(S::load(constants, row::RATES + 2), rate).times(unit);
        now = rate.multiply_add(high, rate.times(low));
    }
}

#[inline(always)]
fn alone_body<V: Vector8>(motion: Motion<'_>) {
    expand::<V, Alone<V>>(motion);
}

#[inline(always)]
fn abreast_body<V: Vector8>(motion: Motion<'_>) {
    expand::<V, Abreast<V>>(motion);
}

tiered! {
    pub(super) fn alone[][](motion: Motion<'_>) = alone_body;
    pub(super) fn abreast[][](motion: Motion<'_>) = abreast_body;
}
