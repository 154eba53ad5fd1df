//! The discrete Moser–Veselov turn of a free body: energy and angular momentum kept, the attitude of any even order to 10.
//!
//! The one idea: a step turns the body by the quaternion (e, w) of h M/2 = w J e + e × J e, which keeps the energy and |M|
//! whatever the three numbers J are, as long as they depend on nothing else that changes. With the body's moments it is of
//! order two (RATTLE on the group of rotations, Veselov's discrete top); with moments modified by a series in h² it stays
//! on the true path and is late by a high power of h only. The unknown is p = J e, so that nothing is divided by a small
//! moment, and the cross product is one of differences of moments: a body that is almost a ball, or a needle, costs no
//! digits. Newton's method solves for p from a guess that is right to third order.
//! Sources: Moser & Veselov, Commun. Math. Phys. 139 (1991) 217; McLachlan & Zanna, Found. Comput. Math. 5 (2005) 87;
//! Hairer & Vilmart, J. Phys. A 39 (2006) 13225. The series are our own, by `tools/moser_veselov.py`.

mod coefficients;

use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::element::View;
use crate::numerics::real::{Mask, Real};
use crate::rigid::motion::vectors::{by_exactly, cross, dot};
use coefficients::{OFFSETS, SLOPES, Term};

/// Powers of h² in the series of order 10.
const POWERS: usize = 4;
/// Products of powers of two variables, of degrees from 1 to `POWERS`.
const PRODUCTS: usize = SLOPES.len();
/// The square of the largest |ω| h: beyond, the turn found may be that of another root.
const REACH: f64 = 1.25 * 1.25;
/// From within, Newton's method takes four steps at most, but where the turn of order two nears a quarter.
const ITERATIONS: usize = 12;

/// The power of the step with which the error of a motion shrinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The moments are the body's.
    Two,
    /// One power of h² modifies them.
    Four,
    /// Two do.
    Six,
    /// Three do.
    Eight,
    /// Four do.
    Ten,
}

impl Order {
    /// All there are.
    pub const ALL: [Self; 5] = [Self::Two, Self::Four, Self::Six, Self::Eight, Self::Ten];

    /// As a number.
    pub const fn number(self) -> usize {
        2 * self.powers() + 2
    }
    /// Powers of h² in its series.
    const fn powers(self) -> usize {
        match self {
            Self::Two => 0,
            Self::Four => 1,
            Self::Six => 2,
            Self::Eight => 3,
            Self::Ten => 4,
        }
    }
}

/// What the steps of a body (of eight, in lanes) need of its moments, in units of the largest of them.
#[derive(Clone, Copy, Debug)]
pub struct MoserVeselov<S> {
    /// One over the largest moment, and what that leaves out.
    inverse: [S; 2],
    /// The largest moment over each, and what that leaves out.
    ratios: [S; 3],
    ratios_low: [S; 3],
    /// Those less one.
    excesses: [S; 3],
    /// Of the next axis' excess, less that of the one after, and what that leaves out.
    differences: [S; 3],
    differences_low: [S; 3],
    /// Of each product of powers of C and g, by degree and then by the power of g; 0 beyond the order.
    slopes: [S; PRODUCTS],
    offsets: [S; PRODUCTS],
}

/// A product, and what its rounding leaves out.
#[inline(always)]
fn exact_product<S: Real>(a: S, b: S) -> (S, S) {
    by_exactly(a, (b, S::zero()))
}

#[inline(always)]
fn loaded<S: Copy, V: View<S>, const N: usize>(numbers: &[S; N]) -> [V; N] {
    let mut result = [V::zero(); N];
    for at in 0..N {
        result[at] = V::load(numbers[at]);
    }
    result
}

/// Polynomials of b + c and b c, of which the first `count` are wanted.
#[inline(always)]
fn polynomials<S: Real>(table: &[&[Term]; PRODUCTS], count: usize, variables: [S; 2]) -> [S; PRODUCTS] {
    let mut result = [S::zero(); PRODUCTS];
    for at in 0..count {
        for (numerator, denominator, first, second) in table[at] {
            let fraction =
                DoubleDouble::from(f64::from(*numerator)) / DoubleDouble::from(f64::from(*denominator));
            let mut term = S::from_double_double(fraction);
            for _ in 0..*first {
                term = term * variables[0];
            }
            for _ in 0..*second {
                term = term * variables[1];
            }
            result[at] += term;
        }
    }
    result
}

/// The sum of all products of powers of C and g, each with its coefficient.
#[inline(always)]
fn sum<S: Real>(coefficients: &[S; PRODUCTS], square: S, excess: S) -> S {
    let mut sum = S::zero();
    for power in (0..=POWERS).rev() {
        let mut row = S::zero();
        for degree in (power.max(1)..=POWERS).rev() {
            row = row.multiply_add(square, coefficients[degree * (degree + 1) / 2 - 1 + power]);
        }
        let row = if power == 0 { row * square } else { row };
        sum = sum.multiply_add(excess, row);
    }
    sum
}

/// The square of the relative change after which Newton's next one would be below rounding.
#[inline(always)]
fn square_of_tolerance<S: Real>() -> S {
    let beyond_double = S::from_double_double(DoubleDouble::new(1.0, f64::EPSILON / 256.0)) - S::one();
    let double = f64::EPSILON / 4.0;
    S::select(S::zero().less(beyond_double), S::splat(double * double), S::splat(double))
}

impl<S: Real> MoserVeselov<S> {
    /// Of a body with these principal moments, none of which is zero.
    #[inline(always)]
    pub fn new(order: Order, moments: &[S; 3]) -> Self {
        let one = S::one();
        let largest = moments[0].max(moments[1]).max(moments[2]);
        let inverse = one / largest;
        let (mut ratios, mut ratios_low) = ([one; 3], [one; 3]);
        let (mut excesses, mut differences, mut differences_low) = ([one; 3], [one; 3], [one; 3]);
        for at in 0..3 {
            ratios[at] = largest / moments[at];
            ratios_low[at] = ratios[at].multiply_subtract_from(moments[at], largest) / moments[at];
            excesses[at] = (largest - moments[at]) / moments[at];
        }
        for at in 0..3 {
            let (next, last) = ((at + 1) % 3, (at + 2) % 3);
            let (apart, apart_low) = two_sum(moments[last], -moments[next]);
            differences[at] = ratios[next] * (apart / moments[last]);
            // Of largest · apart = differences · moments[next] · moments[last].
            let (both, both_low) = exact_product(moments[next], moments[last]);
            let (wanted, wanted_low) = exact_product(largest, apart);
            let (found, found_low) = exact_product(differences[at], both);
            let low = (wanted_low - found_low) + (largest * apart_low - differences[at] * both_low);
            differences_low[at] = ((wanted - found) + low) / both;
        }
        let total = (excesses[0] + excesses[1]) + excesses[2];
        let product = dot(excesses, [excesses[1], excesses[2], excesses[0]]);
        let count = order.powers() * (order.powers() + 3) / 2;
        Self {
            inverse: [inverse, inverse.multiply_subtract_from(largest, one) * inverse],
            ratios,
            ratios_low,
            excesses,
            differences,
            differences_low,
            slopes: polynomials(&SLOPES, count, [total, product]),
            offsets: polynomials(&OFFSETS, count, [total, product]),
        }
    }

    /// The same as a tier has it.
    #[inline(always)]
    pub fn load<V: View<S>>(&self) -> MoserVeselov<V> {
        MoserVeselov {
            inverse: loaded(&self.inverse),
            ratios: loaded(&self.ratios),
            ratios_low: loaded(&self.ratios_low),
            excesses: loaded(&self.excesses),
            differences: loaded(&self.differences),
            differences_low: loaded(&self.differences_low),
            slopes: loaded(&self.slopes),
            offsets: loaded(&self.offsets),
        }
    }

    /// The turn in the time `h` from the angular momentum `momentum`, both in the body's principal frame: (x, y, z, w − 1),
    /// so that q + q∘turn is the new orientation with nothing lost, and whether there is one. Where there is not (|ω| h is
    /// above 1.25, the turn would be of more than a quarter, which those of order two soon are, or numbers overflow), what
    /// is returned means nothing.
    #[inline(always)]
    pub fn turn(&self, momentum: &[S; 3], h: S) -> ([S; 4], S::Mask) {
        let (one, half) = (S::one(), S::splat(0.5));
        // With what is left out: products with round numbers are not rounded at random, and the energy would drift.
        let factor = by_exactly(h, (self.inverse[0], self.inverse[1]));
        let (mut u, mut u_low) = ([S::zero(); 3], [S::zero(); 3]);
        for at in 0..3 {
            (u[at], u_low[at]) = by_exactly(momentum[at], factor);
        }
        let square = dot(u, u);
        let excess = dot(self.excesses, [u[0] * u[0], u[1] * u[1], u[2] * u[2]]);
        let slope = sum(&self.slopes, square, excess);
        let offset = sum(&self.offsets, square, excess);
        // 1/J as the body's and a change, which is small: the body's are not rounded to a modified number.
        let mut change = [S::zero(); 3];
        let mut inverse = [S::zero(); 3];
        let (mut across, mut across_low) = ([S::zero(); 3], [S::zero(); 3]);
        let mut v = [S::zero(); 3];
        let mut angle = [S::zero(); 3];
        for at in 0..3 {
            change[at] = slope.multiply_add(self.excesses[at], offset + self.ratios_low[at]);
            inverse[at] = self.ratios[at] + change[at];
            let more = slope * self.differences[at];
            across[at] = self.differences[at] + more;
            across_low[at] = (self.differences[at] - across[at]) + more + self.differences_low[at];
            v[at] = u[at] * half;
            angle[at] = self.ratios[at] * u[at];
        }

        let (mut p, mut p_low) = (guess(&inverse, &across, &v), [S::zero(); 3]);
        let mut done = S::Mask::splat(false);
        for _ in 0..ITERATIONS {
            let mut e = [S::zero(); 3];
            for at in 0..3 {
                e[at] = self.ratios[at].multiply_add(p[at], change[at] * p[at]);
            }
            let size = dot(e, e);
            let w = (one - size).sqrt();
            let less = size / (one + w);
            let per_w = one / w;
            let [x, y, z] = p;
            let products = [y * z, z * x, x * y];
            let mut rest = [S::zero(); 3];
            let mut back = [S::zero(); 3];
            for at in 0..3 {
                let near = less.multiply_add(p[at], v[at] - p[at]);
                let near = across_low[at].multiply_subtract_from(products[at], near);
                rest[at] = across[at].multiply_subtract_from(products[at], near);
                back[at] = (inverse[at] * e[at]) * per_w;
            }
            // The columns of the derivative.
            let [a, b, c] = across;
            let first = [
                x.multiply_subtract_from(back[0], w),
                y.multiply_subtract_from(back[0], b * z),
                z.multiply_subtract_from(back[0], c * y),
            ];
            let second = [
                x.multiply_subtract_from(back[1], a * z),
                y.multiply_subtract_from(back[1], w),
                z.multiply_subtract_from(back[1], c * x),
            ];
            let third = [
                x.multiply_subtract_from(back[2], a * y),
                y.multiply_subtract_from(back[2], b * x),
                z.multiply_subtract_from(back[2], w),
            ];
            let normal = cross(second, third);
            let per = one / dot(first, normal);
            let aside = cross(rest, first);
            let step = [dot(rest, normal) * per, -(dot(third, aside) * per), dot(second, aside) * per];
            let mut moved = [S::zero(); 3];
            for at in 0..3 {
                let (to, low) = two_sum(p[at], step[at]);
                p_low[at] = S::select(done, p_low[at], low);
                p[at] = S::select(done, p[at], to);
                moved[at] = inverse[at] * step[at];
            }
            done = done.or(dot(moved, moved).less_equal(square_of_tolerance::<S>() * size));
            if done.all() {
                break;
            }
        }
        let mut e = [S::zero(); 3];
        for at in 0..3 {
            let p_low = half.multiply_add(u_low[at], p_low[at]);
            let low = change[at].multiply_add(p[at], self.ratios[at] * p_low);
            e[at] = self.ratios[at].multiply_add(p[at], low);
        }
        let size = dot(e, e);
        let w = (one - size).sqrt();
        let less = size / (one + w);
        let near = dot(angle, angle).less_equal(S::splat(REACH));
        ([e[0], e[1], e[2], -less], done.and(near).and(size.less_equal(half)))
    }
}

/// p to third order in the angle, from v = h M/2.
#[inline(always)]
fn guess<S: Real>(inverse: &[S; 3], across: &[S; 3], v: &[S; 3]) -> [S; 3] {
    let mut first = [S::zero(); 3];
    let mut e = [S::zero(); 3];
    for at in 0..3 {
        first[at] = across[at].multiply_subtract_from(v[(at + 1) % 3] * v[(at + 2) % 3], v[at]);
        e[at] = inverse[at] * v[at];
    }
    let half_square = dot(e, e) * S::splat(0.5);
    let mut p = [S::zero(); 3];
    for at in 0..3 {
        let longer = half_square.multiply_add(v[at], v[at]);
        p[at] = across[at].multiply_subtract_from(first[(at + 1) % 3] * first[(at + 2) % 3], longer);
    }
    p
}

#[cfg(test)]
mod tests;
