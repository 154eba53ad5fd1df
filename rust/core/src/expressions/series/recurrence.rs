//! The recurrences: the n-th coefficient of each operation from what came before.
//!
//! The one idea: but for the products with the two outermost coefficients, sums over lower orders hang on nothing that this
//! order finds, so they come first, and the processor does those of one operation while another waits. Even orders find them
//! for the odd ones, too ([`convolution`](super::convolution)), and leave them where the coefficient will be.

use super::super::code::word;
use super::super::execute::Scalar;
use super::super::function::Function;
use super::super::linear;
use super::ORDERS;
use super::convolution::{begun, both_begun, convolved, inside, inside_square};
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
        /// What the products of two series come to but for their outermost coefficients: those alike in one.
        inner: Vec<(f64, Place, Place)>,
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

/// A series: the one look at where it lies serves all its coefficients.
#[inline(always)]
fn series<S>(numbers: &[S], place: Place) -> &[S] {
    &numbers[place..place + ORDERS]
}

/// A coefficient, and of an even order what it leaves for the next.
#[inline(always)]
fn put<S: Real>(numbers: &mut [S], place: Place, n: usize, value: S, later: S) {
    let into = &mut numbers[place..place + ORDERS];
    into[n] = value;
    if n.is_multiple_of(2) {
        into[n + 1] = later;
    }
}

/// What an even order has left for the odd one after it.
#[inline(always)]
fn left<S: Real>(of: &[S], n: usize) -> S {
    if n > 1 { of[n] } else { S::zero() }
}

/// Σ a_j b_{n−j} of 0 < j < n, and of an even n of what is known of the next order; an odd one was found before.
#[inline(always)]
fn known<S: Real>(of: &[S], b: &[S], n: usize) -> (S, S) {
    if n.is_multiple_of(2) { begun(of, b, n) } else { (left(of, n), S::zero()) }
}

/// As [`convolution::inside`](super::convolution::inside), of any two series.
#[inline(always)]
fn between<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> (S, S) {
    let of_a = series(numbers, a);
    if a == b { inside_square(of_a, n) } else { inside(of_a, series(numbers, b), n) }
}

/// a_0 b_n + a_n b_0.
#[inline(always)]
fn ends<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> S {
    let (of_a, of_b) = (series(numbers, a), series(numbers, b));
    let first = of_a[0] * of_b[n];
    if a == b { first + first } else { of_a[n].multiply_add(of_b[0], first) }
}

/// Σ a_j b_{n−j} of 0 < j < n.
#[inline(always)]
fn inner<S: Real>(numbers: &[S], a: Place, b: Place, n: usize) -> S {
    convolved(&series(numbers, a)[1..n], &series(numbers, b)[1..n])
}

/// Σ a_j a_{n−j} of 0 < j < n: each product comes twice but the one in the middle.
#[inline(always)]
fn inner_square<S: Real>(a: &[S], n: usize) -> S {
    let half = n.div_ceil(2);
    let pairs = convolved(&a[1..half], &a[n + 1 - half..n]);
    let twice = pairs + pairs;
    if n.is_multiple_of(2) { a[n / 2].multiply_add(a[n / 2], twice) } else { twice }
}

/// Σ slopes_j rate_{n−j} of 0 < j ≤ n: n times what the integral of a product has at the order n.
#[inline(always)]
fn integral<S: Real>(numbers: &[S], slopes: Place, rate: Place, n: usize) -> S {
    convolved(&series(numbers, slopes)[1..n + 1], &series(numbers, rate)[..n])
}

/// Over n: 1/n as a sum of two, lest what it leaves out bias every step alike.
#[inline(always)]
fn over<S: Real>(value: S, inverse: (f64, f64)) -> S {
    value.multiply_add(S::splat(inverse.0), value * S::splat(inverse.1))
}

/// The highest order: an even one leaves something for the next.
const HIGHEST: usize = ORDERS - 2;

/// 1/n, and what that leaves out.
pub(super) fn inverse(n: usize) -> (f64, f64) {
    let n = n.max(1) as f64;
    let high = 1.0 / n;
    (high, (-high).mul_add(n, 1.0) * high)
}

/// The coefficients of order n of all operations, with 1/n.
#[inline(always)]
pub(super) fn expand<S: Scalar>(
    of: &[Recurrence],
    (n, inverse): (usize, (f64, f64)),
    numbers: &mut [S],
    scratch: &mut [S],
) {
    // No method has an order beyond; known here, it is not asked for at every coefficient.
    assert!(n <= HIGHEST, "no room for the order {n}");
    if n == 0 {
        for recurrence in of {
            first(recurrence, numbers, scratch);
        }
        return;
    }
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
        Recurrence::Sum { to, constant, ref terms, ref products, .. } => {
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
    let even = n.is_multiple_of(2);
    match *recurrence {
        Recurrence::Sum { to, ref terms, ref products, ref inner, .. } => {
            let (mut value, mut later) = (S::zero(), S::zero());
            if even {
                for &(factor, a, b) in inner {
                    let (factor, (own, next)) = (S::splat(factor), between(numbers, a, b, n));
                    value = factor.multiply_add(own, value);
                    later = factor.multiply_add(next, later);
                }
            } else {
                value = left(series(numbers, to), n);
            }
            for &(factor, a, b) in &products[0] {
                value = S::splat(factor).multiply_add(ends(numbers, a, b, n), value);
            }
            for &(factor, constant, of) in &products[1] {
                let of = series(numbers, of)[n];
                value = (S::splat(factor) * numbers[constant]).multiply_add(of, value);
            }
            for &(factor, x) in &terms[0] {
                value = S::splat(factor).multiply_add(series(numbers, x)[n], value);
            }
            put(numbers, to, n, value, later);
        }
        Recurrence::Product { to, a, b } => {
            let (own, later) =
                if even { between(numbers, a, b, n) } else { (left(series(numbers, to), n), S::zero()) };
            let value = own + ends(numbers, a, b, n);
            put(numbers, to, n, value, later);
        }
        Recurrence::Multiple { to, constant, of } => numbers[to + n] = numbers[constant] * numbers[of + n],
        Recurrence::Quotient { to, a, b } => {
            let (ratio, below) = (series(numbers, to), series(numbers, b));
            let (own, later) = known(ratio, below, n);
            let known = ratio[0].multiply_subtract_from(below[n], numbers[a + n] - own);
            let value = known / below[0];
            let later = value.multiply_add(below[1], later);
            put(numbers, to, n, value, later);
        }
        Recurrence::Over { to, b, .. } | Recurrence::Reciprocal { to, b, .. } => {
            let (ratio, below) = (series(numbers, to), series(numbers, b));
            let (own, later) = known(ratio, below, n);
            let value = -ratio[0].multiply_add(below[n], own) / below[0];
            let later = value.multiply_add(below[1], later);
            put(numbers, to, n, value, later);
        }
        Recurrence::Part { to, a, constant } => numbers[to + n] = numbers[a + n] / numbers[constant],
        Recurrence::Slopes { to, of } => numbers[to + n] = S::splat(n as f64) * numbers[of + n],
        Recurrence::SineCosine { sine, cosine, slopes, .. } => {
            let (sines, cosines) = (series(numbers, sine), series(numbers, cosine));
            let slopes = series(numbers, slopes);
            let (of_sine, of_cosine) = if even {
                both_begun([cosines, sines], slopes, n)
            } else {
                ((left(sines, n), S::zero()), (left(cosines, n), S::zero()))
            };
            let (first, last) = (slopes[1], slopes[n]);
            let value = over(last.multiply_add(cosines[0], of_sine.0), inverse);
            let other = -over(last.multiply_add(sines[0], of_cosine.0), inverse);
            put(numbers, sine, n, value, first.multiply_add(other, of_sine.1));
            put(numbers, cosine, n, other, first.multiply_add(value, of_cosine.1));
        }
        Recurrence::Integral { to, slopes, rate, .. } => {
            let (slopes, rates) = (series(numbers, slopes), series(numbers, rate));
            let (mut own, later) =
                if even { begun(rates, slopes, n) } else { (left(series(numbers, to), n), S::zero()) };
            // The rate of the order before may have come after this.
            if !even && n > 1 {
                own = rates[n - 1].multiply_add(slopes[1], own);
            }
            let value = over(rates[0].multiply_add(slopes[n], own), inverse);
            put(numbers, to, n, value, later);
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
            let known = numbers[a + n] - inner_square(series(numbers, to), n);
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
            for ((into, entry), &to) in right_room.iter_mut().zip(right).zip(to) {
                let known = if entry.varies { numbers[entry.place + n] } else { S::zero() };
                *into = if even { known } else { known - left(series(numbers, to), n) };
                if even {
                    numbers[to + n + 1] = S::zero();
                }
            }
            let mut index = 0;
            for i in 0..right.len() {
                for j in 0..=i {
                    let Entry { place, varies } = matrix[index];
                    index += 1;
                    if !varies {
                        continue;
                    }
                    let (last, mut of_i, mut of_j) = (numbers[place + n], S::zero(), S::zero());
                    if even && i == j {
                        let later;
                        (of_i, later) = begun(series(numbers, to[j]), series(numbers, place), n);
                        numbers[to[i] + n + 1] += later;
                    } else if even {
                        let unknowns = [series(numbers, to[j]), series(numbers, to[i])];
                        let both = both_begun(unknowns, series(numbers, place), n);
                        (of_i, of_j) = (both.0.0, both.1.0);
                        numbers[to[i] + n + 1] += both.0.1;
                        numbers[to[j] + n + 1] += both.1.1;
                    }
                    right_room[i] -= last.multiply_add(numbers[to[j]], of_i);
                    if i != j {
                        right_room[j] -= last.multiply_add(numbers[to[i]], of_j);
                    }
                }
            }
            linear::solve_either(factored, right_room, row[0]);
            for (&to, &value) in to.iter().zip(right_room.iter()) {
                numbers[to + n] = value;
            }
            if !even {
                return;
            }
            // The products of these with the slopes of the matrix belong to the next order.
            index = 0;
            for i in 0..right.len() {
                for j in 0..=i {
                    let Entry { place, varies } = matrix[index];
                    index += 1;
                    if !varies {
                        continue;
                    }
                    let (slope, later) = (numbers[place + 1], numbers[to[i] + n + 1]);
                    numbers[to[i] + n + 1] = slope.multiply_add(right_room[j], later);
                    if i != j {
                        let later = numbers[to[j] + n + 1];
                        numbers[to[j] + n + 1] = slope.multiply_add(right_room[i], later);
                    }
                }
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
