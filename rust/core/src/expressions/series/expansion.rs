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
use super::convolution::{begun, both_begun, convolved};
use super::numbers::Numbers;
use super::recurrence::{Entry, Place, Recurrence, Recurrences};
use crate::numerics::functions;
use crate::numerics::real::{Mask, Real};

/// What an even order has left for the odd one after it.
#[inline(always)]
fn left<S: Real>(of: &[S; ORDERS], n: usize) -> S {
    if n > 1 { of[n] } else { S::zero() }
}

/// Σ a_j b_{n−j} of 0 < j < n, and of an even n of what is known of the next order; an odd one was found before.
#[inline(always)]
fn known<S: Real, const EVEN: bool>(of: &[S; ORDERS], b: &[S; ORDERS], n: usize) -> (S, S) {
    if EVEN { begun(of, b, n) } else { (left(of, n), S::zero()) }
}

/// Σ a_j a_{n−j} of 0 < j < n: each product comes twice but the one in the middle.
#[inline(always)]
fn inner_square<S: Real>(a: &[S; ORDERS], n: usize) -> S {
    let half = n.div_ceil(2);
    let pairs = convolved(&a[1..half], &a[n + 1 - half..n]);
    let twice = pairs + pairs;
    if n.is_multiple_of(2) { a[n / 2].multiply_add(a[n / 2], twice) } else { twice }
}

/// Over n: 1/n as a sum of two, lest what it leaves out bias every step alike.
#[inline(always)]
fn over<S: Real>(value: S, inverse: (f64, f64)) -> S {
    value.multiply_add(S::splat(inverse.0), value * S::splat(inverse.1))
}

/// The highest order: an even one leaves something for the next.
pub(super) const HIGHEST: usize = ORDERS - 2;

/// 1/n, and what that leaves out.
pub(super) fn inverse(n: usize) -> (f64, f64) {
    let n = n.max(1) as f64;
    let high = 1.0 / n;
    (high, (-high).mul_add(n, 1.0) * high)
}

/// The coefficients of order n of all operations, with 1/n.
#[inline(always)]
pub(super) fn expand<S: Scalar>(
    of: &Recurrences,
    (n, inverse): (usize, (f64, f64)),
    numbers: &mut [S],
    scratch: &mut [S],
) {
    if n == 0 {
        return values(of, numbers, scratch);
    }
    expand_further(of, (n, inverse), &mut Numbers::new(numbers, of.numbers), scratch);
}

/// Those of order zero.
#[inline(always)]
pub(super) fn values<S: Scalar>(of: &Recurrences, numbers: &mut [S], scratch: &mut [S]) {
    for recurrence in &of.all {
        first(recurrence, numbers, scratch);
    }
}

/// Those of an order n > 0, of the numbers of the series that these are of.
#[inline(always)]
pub(super) fn expand_further<S: Scalar>(
    of: &Recurrences,
    (n, inverse): (usize, (f64, f64)),
    numbers: &mut Numbers<'_, S>,
    scratch: &mut [S],
) {
    // No method has an order beyond; known here, it is not asked for at every coefficient.
    assert!(of.vary && n <= HIGHEST, "no room for the order {n}");
    if n.is_multiple_of(2) {
        for recurrence in &of.all {
            further::<S, true>(recurrence, (n, inverse), numbers, scratch);
        }
    } else {
        for recurrence in &of.all {
            further::<S, false>(recurrence, (n, inverse), numbers, scratch);
        }
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
fn further<S: Scalar, const EVEN: bool>(
    recurrence: &Recurrence,
    (n, inverse): (usize, (f64, f64)),
    numbers: &mut Numbers<'_, S>,
    scratch: &mut [S],
) {
    match *recurrence {
        Recurrence::Sum { to, ref terms, ref products, ref inner, .. } => {
            let (mut value, mut later) = (S::zero(), S::zero());
            if EVEN {
                for &(factor, a, b) in inner {
                    let (factor, (own, next)) = (S::splat(factor), numbers.between(a, b, n));
                    value = factor.multiply_add(own, value);
                    later = factor.multiply_add(next, later);
                }
            } else {
                value = left(numbers.series(to), n);
            }
            for &(factor, a, b) in &products[0] {
                value = S::splat(factor).multiply_add(numbers.ends(a, b, n), value);
            }
            for &(factor, constant, of) in &products[1] {
                let of = numbers.series(of)[n];
                value = (S::splat(factor) * numbers.value(constant)).multiply_add(of, value);
            }
            for &(factor, x) in &terms[0] {
                value = S::splat(factor).multiply_add(numbers.series(x)[n], value);
            }
            numbers.put::<EVEN>(to, n, value, later);
        }
        Recurrence::Product { to, a, b } => {
            let (own, later) =
                if EVEN { numbers.between(a, b, n) } else { (left(numbers.series(to), n), S::zero()) };
            let value = own + numbers.ends(a, b, n);
            numbers.put::<EVEN>(to, n, value, later);
        }
        Recurrence::Multiple { to, constant, of } => {
            let value = numbers.value(constant) * numbers.series(of)[n];
            numbers.series_mut(to)[n] = value;
        }
        Recurrence::Quotient { to, a, b } => {
            let (ratio, below) = (numbers.series(to), numbers.series(b));
            let (own, later) = known::<S, EVEN>(ratio, below, n);
            let known = ratio[0].multiply_subtract_from(below[n], numbers.series(a)[n] - own);
            let value = known / below[0];
            let later = value.multiply_add(below[1], later);
            numbers.put::<EVEN>(to, n, value, later);
        }
        Recurrence::Over { to, b, .. } | Recurrence::Reciprocal { to, b, .. } => {
            let (ratio, below) = (numbers.series(to), numbers.series(b));
            let (own, later) = known::<S, EVEN>(ratio, below, n);
            let value = -ratio[0].multiply_add(below[n], own) / below[0];
            let later = value.multiply_add(below[1], later);
            numbers.put::<EVEN>(to, n, value, later);
        }
        Recurrence::Part { to, a, constant } => {
            let value = numbers.series(a)[n] / numbers.value(constant);
            numbers.series_mut(to)[n] = value;
        }
        Recurrence::Slopes { to, of } => {
            let value = S::splat(n as f64) * numbers.series(of)[n];
            numbers.series_mut(to)[n] = value;
        }
        Recurrence::SineCosine { sine, cosine, slopes, .. } => {
            let (sines, cosines) = (numbers.series(sine), numbers.series(cosine));
            let slopes = numbers.series(slopes);
            let (of_sine, of_cosine) = if EVEN {
                both_begun([cosines, sines], slopes, n)
            } else {
                ((left(sines, n), S::zero()), (left(cosines, n), S::zero()))
            };
            let (first, last) = (slopes[1], slopes[n]);
            let value = over(last.multiply_add(cosines[0], of_sine.0), inverse);
            let other = -over(last.multiply_add(sines[0], of_cosine.0), inverse);
            numbers.put::<EVEN>(sine, n, value, first.multiply_add(other, of_sine.1));
            numbers.put::<EVEN>(cosine, n, other, first.multiply_add(value, of_cosine.1));
        }
        Recurrence::Integral { to, slopes, rate, .. } => {
            let (slopes, rates) = (numbers.series(slopes), numbers.series(rate));
            let (mut own, later) =
                if EVEN { begun(rates, slopes, n) } else { (left(numbers.series(to), n), S::zero()) };
            // The rate of the order before may have come after this.
            if !EVEN && n > 1 {
                own = rates[n - 1].multiply_add(slopes[1], own);
            }
            let value = over(rates[0].multiply_add(slopes[n], own), inverse);
            numbers.put::<EVEN>(to, n, value, later);
        }
        Recurrence::Angle { to, parts: [of_y, of_x], .. } => {
            let mut both = S::zero();
            if let Some((slopes, rate)) = of_y {
                both += numbers.integral(slopes, rate, n);
            }
            if let Some((slopes, rate)) = of_x {
                both -= numbers.integral(slopes, rate, n);
            }
            numbers.series_mut(to)[n] = over(both, inverse);
        }
        Recurrence::Root { to, a } => {
            // What a square has but for the products with the value itself.
            let root = numbers.series(to);
            let known = numbers.series(a)[n] - inner_square(root, n);
            let value = known / (root[0] + root[0]);
            numbers.series_mut(to)[n] = value;
        }
        Recurrence::Power { to, a, exponent, slopes: [of_base, own] } => {
            let grows = numbers.integral(of_base, to, n);
            let held = convolved(&numbers.series(own)[1..n], &numbers.series(a)[1..n]);
            let known = S::splat(exponent).multiply_add(grows, -held);
            let value = over(known, inverse) / numbers.value(a);
            numbers.series_mut(to)[n] = value;
            numbers.series_mut(own)[n] = S::splat(n as f64) * value;
        }
        Recurrence::Solve { ref matrix, ref right, ref to, triangle, .. } => {
            let (factored, room) = scratch[triangle..].split_at_mut(matrix.len());
            let (right_room, row) = room.split_at_mut(right.len());
            for ((into, entry), &to) in right_room.iter_mut().zip(right).zip(to) {
                let known = if entry.varies { numbers.series(entry.place)[n] } else { S::zero() };
                *into = if EVEN { known } else { known - left(numbers.series(to), n) };
                if EVEN {
                    numbers.series_mut(to)[n + 1] = S::zero();
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
                    let (mut of_i, mut of_j) = (S::zero(), S::zero());
                    let of_matrix = numbers.series(place);
                    let last = of_matrix[n];
                    if EVEN && i == j {
                        let later;
                        (of_i, later) = begun(numbers.series(to[j]), of_matrix, n);
                        numbers.series_mut(to[i])[n + 1] += later;
                    } else if EVEN {
                        let unknowns = [numbers.series(to[j]), numbers.series(to[i])];
                        let both = both_begun(unknowns, of_matrix, n);
                        (of_i, of_j) = (both.0.0, both.1.0);
                        numbers.series_mut(to[i])[n + 1] += both.0.1;
                        numbers.series_mut(to[j])[n + 1] += both.1.1;
                    }
                    right_room[i] -= last.multiply_add(numbers.value(to[j]), of_i);
                    if i != j {
                        right_room[j] -= last.multiply_add(numbers.value(to[i]), of_j);
                    }
                }
            }
            linear::solve_either(factored, right_room, row[0]);
            for (&to, &value) in to.iter().zip(right_room.iter()) {
                numbers.series_mut(to)[n] = value;
            }
            if !EVEN {
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
                    let slope = numbers.series(place)[1];
                    let of_i = &mut numbers.series_mut(to[i])[n + 1];
                    *of_i = slope.multiply_add(right_room[j], *of_i);
                    if i != j {
                        let of_j = &mut numbers.series_mut(to[j])[n + 1];
                        *of_j = slope.multiply_add(right_room[i], *of_j);
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
