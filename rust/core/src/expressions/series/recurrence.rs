//! The recurrences: the n-th coefficient of each operation from what came before.
//!
//! The one idea: but for the products with the two outermost coefficients, sums over lower orders hang on nothing that this
//! order finds, so they come first, in four chains, and the processor does those of one operation while another waits.

use super::super::code::word;
use super::super::execute::Scalar;
use super::super::function::Function;
use super::super::linear;
use crate::numerics::functions;
use crate::numerics::real::{Mask, Real};

/// Where a series begins, or a constant lies.
pub(super) type Place = usize;

/// An operation on series. `to` is where its result begins.
#[derive(Clone, Debug)]
pub enum Recurrence {
    /// A number.
    Constant { to: Place, value: f64 },
    /// c₀ + Σ c x + Σ c a b.
    Sum {
        /// Where it goes.
        to: Place,
        /// c₀.
        constant: f64,
        /// Factors and series, then factors and constants.
        terms: [Vec<(f64, Place)>; 2],
        /// Products of two series, of a constant and a series, and of two constants.
        products: [Vec<(f64, Place, Place)>; 3],
    },
    /// A product of two series.
    Product { to: Place, a: Place, b: Place },
    /// A constant times a series.
    Multiple { to: Place, constant: Place, of: Place },
    /// A quotient of two series.
    Quotient { to: Place, a: Place, b: Place },
    /// A constant over a series.
    Over { to: Place, constant: Place, b: Place },
    /// A series over a constant.
    Part { to: Place, a: Place, constant: Place },
    /// A number over a series.
    Reciprocal { to: Place, value: f64, b: Place },
    /// j times the j-th coefficient: a derivative, one order higher.
    Slopes { to: Place, of: Place },
    /// Sine and cosine; `slopes` are those of their argument.
    SineCosine { sine: Place, cosine: Place, of: Place, slopes: Place },
    /// A function, by its word, of a series with these slopes, whose derivative is `rate`.
    Integral { to: Place, word: u16, of: Place, slopes: Place, rate: Place },
    /// The angle of a point: its derivative has a part for y and takes away one for x, each the slopes of what varies and
    /// what they come with.
    Angle { to: Place, y: Place, x: Place, parts: [Option<(Place, Place)>; 2] },
    /// A square root.
    Root { to: Place, a: Place },
    /// A power; `slopes` are those of its base and its own.
    Power { to: Place, a: Place, exponent: f64, slopes: [Place; 2] },
    /// A symmetric linear system, its lower triangle row by row; `triangle` is where it is kept factored.
    Solve { matrix: Vec<Entry>, right: Vec<Entry>, to: Vec<Place>, triangle: usize, inner: usize },
    /// A function of constants, by the operation itself.
    Call { to: Place, word: u16, of: Place },
    /// Sine and cosine of a constant.
    Turn { sine: Place, cosine: Place, of: Place },
    /// A power of a constant.
    Raised { to: Place, a: Place, exponent: f64 },
    /// The angle of a constant point.
    Direction { to: Place, y: Place, x: Place },
    /// A quotient of constants.
    Divided { to: Place, a: Place, b: Place },
    /// A product of constants.
    Times { to: Place, a: Place, b: Place },
    /// A number over a constant.
    Inverse { to: Place, value: f64, constant: Place },
}

/// A number of a linear system, and whether it is a series.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub(super) place: Place,
    pub(super) varies: bool,
}

/// Σ x[i] y[last − i], in four chains.
#[inline(always)]
fn convolved<S: Real>(x: &[S], y: &[S]) -> S {
    let y = &y[..x.len()];
    let (mut first, mut second, mut third, mut fourth) = (S::zero(), S::zero(), S::zero(), S::zero());
    let (forward, backward) = (x.chunks_exact(4), y.rchunks_exact(4));
    let rest = (forward.remainder(), backward.remainder());
    for four in forward.zip(backward) {
        if let ([x0, x1, x2, x3], [y0, y1, y2, y3]) = four {
            first = x0.multiply_add(*y3, first);
            second = x1.multiply_add(*y2, second);
            third = x2.multiply_add(*y1, third);
            fourth = x3.multiply_add(*y0, fourth);
        }
    }
    match rest {
        ([x0], [y0]) => first = x0.multiply_add(*y0, first),
        ([x0, x1], [y0, y1]) => {
            first = x0.multiply_add(*y1, first);
            second = x1.multiply_add(*y0, second);
        }
        ([x0, x1, x2], [y0, y1, y2]) => {
            first = x0.multiply_add(*y2, first);
            second = x1.multiply_add(*y1, second);
            third = x2.multiply_add(*y0, third);
        }
        _ => {}
    }
    (first + second) + (third + fourth)
}

/// As [`convolved`] with two at once, in two chains each: what they share is read once.
#[inline(always)]
fn convolved_with_both<S: Real>(x: &[S], y: &[S], z: &[S]) -> (S, S) {
    let (y, z) = (&y[..x.len()], &z[..x.len()]);
    let (mut even, mut odd) = ((S::zero(), S::zero()), (S::zero(), S::zero()));
    let (forward, of_y, of_z) = (x.chunks_exact(2), y.rchunks_exact(2), z.rchunks_exact(2));
    let rest = (forward.remainder(), of_y.remainder(), of_z.remainder());
    for ((x, y), z) in forward.zip(of_y).zip(of_z) {
        if let ([x0, x1], [y0, y1], [z0, z1]) = (x, y, z) {
            even = (x0.multiply_add(*y1, even.0), x0.multiply_add(*z1, even.1));
            odd = (x1.multiply_add(*y0, odd.0), x1.multiply_add(*z0, odd.1));
        }
    }
    if let ([x], [y], [z]) = rest {
        even = (x.multiply_add(*y, even.0), x.multiply_add(*z, even.1));
    }
    (even.0 + odd.0, even.1 + odd.1)
}

/// Σ a_j b_{n−j} of 0 < j < n.
#[inline(always)]
fn inner<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> S {
    convolved(&numbers[a + 1..a + n], &numbers[b + 1..b + n])
}

/// The coefficient of order n > 0 of a product.
#[inline(always)]
fn product<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> S {
    if a != b {
        let inside = inner(numbers, a, b, n);
        return numbers[a].multiply_add(numbers[b + n], numbers[a + n].multiply_add(numbers[b], inside));
    }
    // Of a square each product comes twice but the one in the middle.
    let half = n.div_ceil(2);
    let pairs = convolved(&numbers[a + 1..a + half], &numbers[a + n + 1 - half..a + n]);
    let pairs = numbers[a].multiply_add(numbers[a + n], pairs);
    let twice = pairs + pairs;
    if n.is_multiple_of(2) { numbers[a + n / 2].multiply_add(numbers[a + n / 2], twice) } else { twice }
}

/// As a product, without the last coefficient of its second factor.
#[inline(always)]
fn known<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> S {
    numbers[a + n].multiply_add(numbers[b], inner(numbers, a, b, n))
}

/// Σ slopes_j rate_{n−j} of 0 < j ≤ n, over n: what the integral of a product has at the order n.
#[inline(always)]
fn integral<S: Real>(numbers: &[S], slopes: Place, rate: Place, n: usize) -> S {
    convolved(&numbers[slopes + 1..slopes + n + 1], &numbers[rate..rate + n])
}

/// Over n: 1/n as a sum of two, lest what it leaves out bias every step alike.
#[inline(always)]
fn over<S: Real>(value: S, inverse: (f64, f64)) -> S {
    value.multiply_add(S::splat(inverse.0), value * S::splat(inverse.1))
}

/// The coefficients of order n of all operations.
#[inline(always)]
pub(super) fn expand<S: Scalar>(of: &[Recurrence], n: usize, numbers: &mut [S], scratch: &mut [S]) {
    if n == 0 {
        for recurrence in of {
            first(recurrence, numbers, scratch);
        }
        return;
    }
    let high = 1.0 / n as f64;
    let inverse = (high, (-high).mul_add(n as f64, 1.0) * high);
    for recurrence in of {
        further(recurrence, (n, inverse), numbers, scratch);
    }
}

/// A sum, of values or of coefficients of an order.
#[inline(always)]
fn sum<S: Real>(
    numbers: &[S],
    constant: f64,
    terms: &[Vec<(f64, Place)>],
    products: &[Vec<(f64, Place, Place)>],
) -> S {
    let mut sum = S::splat(constant);
    for all in terms {
        for &(factor, x) in all {
            sum = S::splat(factor).multiply_add(numbers[x], sum);
        }
    }
    for all in products {
        for &(factor, a, b) in all {
            sum = (S::splat(factor) * numbers[a]).multiply_add(numbers[b], sum);
        }
    }
    sum
}

/// Values: the coefficients of order zero.
#[inline(always)]
fn first<S: Scalar>(recurrence: &Recurrence, numbers: &mut [S], scratch: &mut [S]) {
    match *recurrence {
        Recurrence::Constant { to, value } => numbers[to] = S::splat(value),
        Recurrence::Sum { to, constant, ref terms, ref products } => {
            numbers[to] = sum(numbers, constant, terms, products);
        }
        Recurrence::Product { to, a, b }
        | Recurrence::Times { to, a, b }
        | Recurrence::Multiple { to, constant: a, of: b } => numbers[to] = numbers[a] * numbers[b],
        Recurrence::Quotient { to, a, b }
        | Recurrence::Divided { to, a, b }
        | Recurrence::Over { to, constant: a, b }
        | Recurrence::Part { to, a, constant: b } => numbers[to] = numbers[a] / numbers[b],
        Recurrence::Reciprocal { to, value, b } | Recurrence::Inverse { to, value, constant: b } => {
            numbers[to] = S::splat(value) / numbers[b];
        }
        Recurrence::Slopes { .. } => {}
        Recurrence::SineCosine { sine, cosine, of, .. } | Recurrence::Turn { sine, cosine, of } => {
            (numbers[sine], numbers[cosine]) = functions::sin_cos(numbers[of]);
        }
        Recurrence::Integral { to, word, of, .. } | Recurrence::Call { to, word, of } => {
            numbers[to] = if word == ROOT { numbers[of].sqrt() } else { numbers[of].called(word) };
        }
        Recurrence::Angle { to, y, x, .. } | Recurrence::Direction { to, y, x } => {
            numbers[to] = numbers[y].angle(numbers[x]);
        }
        Recurrence::Root { to, a } => numbers[to] = numbers[a].sqrt(),
        Recurrence::Power { to, a, exponent, .. } | Recurrence::Raised { to, a, exponent } => {
            numbers[to] = numbers[a].raised(exponent);
        }
        Recurrence::Solve { ref matrix, ref right, ref to, triangle, inner } => {
            let (matrix_room, room) = scratch[triangle..].split_at_mut(matrix.len());
            let (right_room, row) = room.split_at_mut(right.len());
            for (into, entry) in matrix_room.iter_mut().zip(matrix) {
                *into = numbers[entry.place];
            }
            for (into, entry) in right_room.iter_mut().zip(right) {
                *into = numbers[entry.place];
            }
            let sound = linear::factor(matrix_room, &mut row[..right.len()], inner);
            row[0] = S::select(sound, S::one(), S::zero());
            if !sound.all() {
                for (into, entry) in matrix_room.iter_mut().zip(matrix) {
                    *into = S::select(sound, *into, numbers[entry.place]);
                }
                linear::invert(matrix_room, right.len(), sound);
            }
            linear::solve_either(matrix_room, right_room, row[0]);
            for (&to, &value) in to.iter().zip(right_room.iter()) {
                numbers[to] = value;
            }
        }
    }
}

/// The word of the square root.
const ROOT: u16 = word::CALL + Function::Sqrt as u16;

/// The coefficient of order n > 0.
#[inline(always)]
fn further<S: Scalar>(
    recurrence: &Recurrence,
    (n, inverse): (usize, (f64, f64)),
    numbers: &mut [S],
    scratch: &mut [S],
) {
    match *recurrence {
        Recurrence::Sum { to, ref terms, ref products, .. } => {
            let mut value = S::zero();
            for &(factor, a, b) in &products[0] {
                value = S::splat(factor).multiply_add(product(numbers, a, b, n), value);
            }
            for &(factor, constant, of) in &products[1] {
                value = (S::splat(factor) * numbers[constant]).multiply_add(numbers[of + n], value);
            }
            for &(factor, x) in &terms[0] {
                value = S::splat(factor).multiply_add(numbers[x + n], value);
            }
            numbers[to + n] = value;
        }
        Recurrence::Product { to, a, b } => numbers[to + n] = product(numbers, a, b, n),
        Recurrence::Multiple { to, constant, of } => numbers[to + n] = numbers[constant] * numbers[of + n],
        Recurrence::Quotient { to, a, b } => {
            let known = numbers[a + n] - inner(numbers, to, b, n);
            numbers[to + n] = numbers[to].multiply_subtract_from(numbers[b + n], known) / numbers[b];
        }
        Recurrence::Over { to, b, .. } | Recurrence::Reciprocal { to, b, .. } => {
            let known = numbers[to].multiply_add(numbers[b + n], inner(numbers, to, b, n));
            numbers[to + n] = -known / numbers[b];
        }
        Recurrence::Part { to, a, constant } => numbers[to + n] = numbers[a + n] / numbers[constant],
        Recurrence::Slopes { to, of } => numbers[to + n] = S::splat(n as f64) * numbers[of + n],
        Recurrence::SineCosine { sine, cosine, slopes, .. } => {
            let slopes = &numbers[slopes + 1..slopes + n + 1];
            let pair = (&numbers[cosine..cosine + n], &numbers[sine..sine + n]);
            let (of_sine, of_cosine) = convolved_with_both(slopes, pair.0, pair.1);
            numbers[sine + n] = over(of_sine, inverse);
            numbers[cosine + n] = -over(of_cosine, inverse);
        }
        Recurrence::Integral { to, slopes, rate, .. } => {
            numbers[to + n] = over(integral(numbers, slopes, rate, n), inverse);
        }
        Recurrence::Angle { to, parts: [of_y, of_x], .. } => {
            let mut both = S::zero();
            if let Some((slopes, rate)) = of_y {
                both += integral(numbers, slopes, rate, n);
            }
            if let Some((slopes, rate)) = of_x {
                both -= integral(numbers, slopes, rate, n);
            }
            numbers[to + n] = over(both, inverse);
        }
        Recurrence::Root { to, a } => {
            // What a square has but for the products with the value itself.
            numbers[to + n] = S::zero();
            let known = numbers[a + n] - product(numbers, to, to, n);
            numbers[to + n] = known / (numbers[to] + numbers[to]);
        }
        Recurrence::Power { to, a, exponent, slopes: [of_base, own] } => {
            let grows = integral(numbers, of_base, to, n);
            let held = inner(numbers, own, a, n);
            let known = S::splat(exponent).multiply_add(grows, -held);
            let value = over(known, inverse) / numbers[a];
            numbers[to + n] = value;
            numbers[own + n] = S::splat(n as f64) * value;
        }
        Recurrence::Solve { ref matrix, ref right, ref to, triangle, .. } => {
            let (factored, room) = scratch[triangle..].split_at_mut(matrix.len());
            let (right_room, row) = room.split_at_mut(right.len());
            for (into, entry) in right_room.iter_mut().zip(right) {
                *into = if entry.varies { numbers[entry.place + n] } else { S::zero() };
            }
            let mut index = 0;
            for i in 0..right.len() {
                for j in 0..=i {
                    let entry = matrix[index];
                    index += 1;
                    if !entry.varies {
                        continue;
                    }
                    if i == j {
                        right_room[i] -= known(numbers, entry.place, to[j], n);
                        continue;
                    }
                    let last = numbers[entry.place + n];
                    let inner = &numbers[entry.place + 1..entry.place + n];
                    let both = (&numbers[to[j] + 1..to[j] + n], &numbers[to[i] + 1..to[i] + n]);
                    let (of_i, of_j) = convolved_with_both(inner, both.0, both.1);
                    right_room[i] -= last.multiply_add(numbers[to[j]], of_i);
                    right_room[j] -= last.multiply_add(numbers[to[i]], of_j);
                }
            }
            linear::solve_either(factored, right_room, row[0]);
            for (&to, &value) in to.iter().zip(right_room.iter()) {
                numbers[to + n] = value;
            }
        }
        // What is constant has no further coefficients.
        Recurrence::Constant { .. }
        | Recurrence::Call { .. }
        | Recurrence::Turn { .. }
        | Recurrence::Raised { .. }
        | Recurrence::Direction { .. }
        | Recurrence::Divided { .. }
        | Recurrence::Times { .. }
        | Recurrence::Inverse { .. } => {}
    }
}
