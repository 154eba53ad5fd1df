//! How far a free rigid body turns in a time, to the last digits, from its angular momentum alone.
//!
//! The one idea: what is wanted is a quaternion less the identity, so that a small turn added to an orientation loses
//! nothing. A symmetric body turns about its momentum and about its axis, each by an exact rotation. For any other, momentum
//! and quaternion are expanded in Taylor series (Euler's equations are quadratic) over parts of the time that are short
//! enough for them to converge, up to the order from which nothing is added: no branch by the kind of motion, and nothing
//! special near a separatrix or where moments agree. Each lane has parts and orders of its own, so none depends on its
//! neighbours. What turns too far in the time for that is left to the elliptic functions ([`FreeRotation`]).
//! Sources: Landau & Lifshitz, *Mechanics* § 36; for the series Hairer, Nørsett & Wanner, *Solving ODE I*, I.8.

use super::super::free::FreeRotation;
use super::super::quaternion::IDENTITY;
use super::vectors::{by_exactly, cross, dot, joined, largest, product, times};
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::real::{Mask, Real};

/// The highest order of a series.
pub const ORDER: usize = 30;
/// Numbers of a series: of momentum, half angular velocity and quaternion.
pub const ROOM: usize = 10 * (ORDER + 1);
/// The largest turn about an axis in a part of the time, in radians. Series would converge to about 1.
const PART: f64 = 0.3;
/// A turn by more in the whole time is left to the elliptic functions.
pub const FAR: f64 = 16.0;
/// What is smaller than this part of the first term adds nothing.
const NOTHING: f64 = 6.9e-18; // 2^-57

/// (−1)ᵏ/(2k + 1)!: sin x/x in powers of x².
const SINE: [f64; 10] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
];
/// −(−1)ᵏ/(2k + 2)!: (cos x − 1)/x² in powers of x².
const COSINE: [f64; 10] = [
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
    1.0 / 2_432_902_008_176_640_000.0,
];

#[inline(always)]
fn polynomial<S: Real>(z: S, coefficients: &[f64; 10]) -> S {
    let square = z * z;
    // Two chains have half the latency of one.
    let (mut even, mut odd) = (S::splat(coefficients[8]), S::splat(coefficients[9]));
    for half in 0..4 {
        even = even.multiply_add(square, S::splat(coefficients[6 - 2 * half]));
        odd = odd.multiply_add(square, S::splat(coefficients[7 - 2 * half]));
    }
    odd.multiply_add(z, even)
}

/// The quaternion of a rotation less the identity, from half its rotation vector.
#[inline(always)]
pub fn rotation<S: Real>(half: [S; 3]) -> [S; 4] {
    let one = S::one();
    let mut z = dot(half, half);
    let mut axis = half;
    let mut doublings = S::zero();
    let mut large = one.less(z);
    // An angle that no series takes is halved, and the rotation then doubled; infinite ones never become small.
    let mut tries = 0;
    while large.any() && tries < 64 {
        z = S::select(large, z * S::splat(0.25), z);
        let halved = times(axis, S::splat(0.5));
        for c in 0..3 {
            axis[c] = S::select(large, halved[c], axis[c]);
        }
        doublings = S::select(large, doublings + one, doublings);
        large = one.less(z);
        tries += 1;
    }
    let sine = polynomial(z, &SINE);
    let [x, y, w] = [axis[0] * sine, axis[1] * sine, z * polynomial(z, &COSINE)];
    let mut turn = [x, y, axis[2] * sine, w];
    let two = S::splat(2.0);
    let mut left = S::zero().less(doublings);
    while left.any() {
        let twice = two * (one + turn[3]);
        let sine_squared = dot([turn[0], turn[1], turn[2]], [turn[0], turn[1], turn[2]]);
        // cos 2a − 1 from the smaller of sine and cosine: either alone makes an error of the length four times as large
        // where it is the larger, both together never more than twice.
        let by_sine = S::zero() - two * sine_squared;
        let by_cosine = two * turn[3] * (two + turn[3]);
        let doubled = [
            turn[0] * twice,
            turn[1] * twice,
            turn[2] * twice,
            S::select(sine_squared.less(S::splat(0.5)), by_sine, by_cosine),
        ];
        for c in 0..4 {
            turn[c] = S::select(left, doubled[c], turn[c]);
        }
        doublings -= one;
        left = S::zero().less(doublings);
    }
    turn
}

/// The turn of a body of which two moments agree, with the inverse of these two: about the momentum, and about its axis.
#[inline(always)]
pub fn symmetric<S: Real>(inverse: [S; 3], pair: S, momentum: [S; 3], h: S) -> [S; 4] {
    let half = h * S::splat(0.5);
    let about_momentum = rotation(times(momentum, half * pair));
    let mut spin = momentum;
    for c in 0..3 {
        spin[c] = half * ((inverse[c] - pair) * momentum[c]);
    }
    joined(about_momentum, rotation(spin))
}

/// Numbers about three axes, and what they leave out.
pub type Rounded<S> = ([S; 3], [S; 3]);

/// What Euler's equations multiply. Inverses and differences go together to the digits of both parts: what is rounded alike in
/// every step would move the energy by as much in each.
#[derive(Clone, Copy, Debug)]
pub struct Inverses<S> {
    /// 1/I, and zero about the axis of a rod, about which nothing spins.
    pub inverse: Rounded<S>,
    /// 1/I₃ − 1/I₂, 1/I₁ − 1/I₃, 1/I₂ − 1/I₁, from the moments: a difference of rounded inverses would lose what turns a
    /// needle about itself.
    pub differences: Rounded<S>,
}

impl Inverses<f64> {
    /// Of a body with these moments.
    pub fn of(moments: [f64; 3]) -> Self {
        let zero = DoubleDouble::from(0.0);
        let exact = moments.map(DoubleDouble::from);
        let one_over = |i: usize| if moments[i] == 0.0 { zero } else { DoubleDouble::from(1.0) / exact[i] };
        let differences = [[2, 1], [0, 2], [1, 0]].map(|[one, other]| {
            if moments[one] == 0.0 || moments[other] == 0.0 {
                one_over(one) - one_over(other)
            } else {
                (exact[other] - exact[one]) / exact[one] / exact[other]
            }
        });
        let parts = |of: [DoubleDouble; 3]| (of.map(DoubleDouble::high), of.map(DoubleDouble::low));
        Self { inverse: parts([0, 1, 2].map(one_over)), differences: parts(differences) }
    }
}

/// 1/n, and what that leaves out.
const RECIPROCALS: [(f64, f64); ORDER + 1] = {
    let mut table = [(0.0, 0.0); ORDER + 1];
    let mut n = 1;
    while n <= ORDER {
        let (whole, high) = (n as f64, 1.0 / n as f64);
        // Halves of its digits have exact products with so small a number.
        let shifted = 134_217_729.0 * high;
        let upper = shifted - (shifted - high);
        table[n] = (high, ((1.0 - upper * whole) - (high - upper) * whole) / whole);
        n += 1;
    }
    table
};

/// A number times a rounded one.
#[inline(always)]
fn by<S: Real>(x: S, (high, low): (S, S)) -> S {
    x.multiply_add(high, x * low)
}

/// The turn of any body, and where it is too far for series; `room` holds [`ROOM`] numbers.
#[inline(always)]
pub fn asymmetric<S: Real>(body: &Inverses<S>, momentum: [S; 3], h: S, room: &mut [S]) -> ([S; 4], S::Mask) {
    let mut momentum = momentum;
    let mut rates = momentum;
    for c in 0..3 {
        rates[c] = body.inverse.0[c] * momentum[c] * h;
    }
    let mut angle = largest(rates);
    let far = S::splat(FAR).less(angle);
    let (mut parts, mut part) = (S::one(), h);
    let mut count = 1_u32;
    let mut large = S::splat(PART).less(angle);
    while large.any() && count < 256 {
        angle = S::select(large, angle * S::splat(0.5), angle);
        part = S::select(large, part * S::splat(0.5), part);
        parts = S::select(large, parts + parts, parts);
        large = S::splat(PART).less(angle);
        count *= 2;
    }
    let mut turn = short(body, &mut momentum, part, room);
    let mut done = S::one();
    let mut on = done.less(parts);
    while on.any() && !on.not().or(far).all() {
        let next = short(body, &mut momentum, part, room);
        let both = joined(turn, next);
        for c in 0..4 {
            turn[c] = S::select(on, both[c], turn[c]);
        }
        done += S::one();
        on = done.less(parts);
    }
    (turn, far)
}

/// Rounded factors times a number, with what this leaves out.
#[inline(always)]
fn timed<S: Real>((high, low): Rounded<S>, x: S) -> Rounded<S> {
    let (mut whole, mut left) = (high, low);
    for c in 0..3 {
        (whole[c], left[c]) = by_exactly(x, (high[c], low[c]));
    }
    (whole, left)
}

/// Half the angular velocity of a momentum, times the time.
#[inline(always)]
fn half_rates<S: Real>((factor, rest): Rounded<S>, momentum: [S; 3]) -> Rounded<S> {
    let (mut rates, mut left) = (momentum, momentum);
    for c in 0..3 {
        (rates[c], left[c]) = by_exactly(momentum[c], (factor[c], rest[c]));
    }
    (rates, left)
}

/// The turn in a part of the time that is short, and the momentum after it.
#[inline(always)]
fn short<S: Real>(body: &Inverses<S>, momentum: &mut [S; 3], h: S, room: &mut [S]) -> [S; 4] {
    let Inverses { inverse, differences } = *body;
    let half = h * S::splat(0.5);
    let rows = room.as_chunks_mut::<{ ORDER + 1 }>().0;
    let [m0, m1, m2, r0, r1, r2, q0, q1, q2, q3] = rows else { return [S::splat(f64::NAN); 4] };
    let (turns, rest) = timed(differences, h);
    let factors = timed(inverse, half);
    [m0[0], m1[0], m2[0]] = *momentum;
    // What is left out of the first terms: of two of the turn, and one of the momentum.
    let (first, mut left) = half_rates(factors, *momentum);
    let mut momentum_left = first;
    [r0[0], r1[0], r2[0]] = first;
    [q0[0], q1[0], q2[0], q3[0]] = [S::zero(), S::zero(), S::zero(), S::one()];
    let least = largest(first) * S::splat(NOTHING);
    let mut ended = S::zero().less(S::zero());
    let mut small = ended;
    let mut order = 0;
    while order < ORDER {
        let mut products = [S::zero(); 3];
        let mut turning = [S::zero(); 4];
        for i in 0..order + 1 {
            let j = order - i;
            let [x, y, z] = [m0[i], m1[i], m2[i]];
            products[0] = y.multiply_add(m2[j], products[0]);
            products[1] = z.multiply_add(m0[j], products[1]);
            products[2] = x.multiply_add(m1[j], products[2]);
            let [a, b, c] = [r0[j], r1[j], r2[j]];
            let [x, y, z, w] = [q0[i], q1[i], q2[i], q3[i]];
            turning[0] = w.multiply_add(a, y.multiply_add(c, z.multiply_subtract_from(b, turning[0])));
            turning[1] = w.multiply_add(b, z.multiply_add(a, x.multiply_subtract_from(c, turning[1])));
            turning[2] = w.multiply_add(c, x.multiply_add(b, y.multiply_subtract_from(a, turning[2])));
            turning[3] = x.multiply_subtract_from(
                a,
                y.multiply_subtract_from(b, z.multiply_subtract_from(c, turning[3])),
            );
        }
        order += 1;
        let per = (S::splat(RECIPROCALS[order].0), S::splat(RECIPROCALS[order].1));
        let mut size = S::zero();
        let mut products_left = products;
        for c in 0..3 {
            let (product, left) = by_exactly(products[c], (turns[c], rest[c]));
            products[c] = S::select(ended, S::zero(), by(product + left, per));
            products_left[c] = (product - products[c]) + left;
        }
        for c in 0..4 {
            turning[c] = S::select(ended, S::zero(), by(turning[c], per));
            size = size.max(turning[c].abs());
        }
        let (rates, rates_left) = half_rates(factors, products);
        if order == 1 {
            momentum_left = products_left;
            for c in 0..3 {
                left[c] += S::splat(0.5) * products_left[c].multiply_add(factors.0[c], rates_left[c]);
            }
        }
        size = size.max(largest(rates));
        [m0[order], m1[order], m2[order]] = products;
        [r0[order], r1[order], r2[order]] = rates;
        [q0[order], q1[order], q2[order], q3[order]] = turning;
        // Two in a row: every other term may be nothing by symmetry.
        let now = size.less_equal(least);
        ended = ended.or(now.and(small));
        small = now;
        if ended.all() {
            break;
        }
    }
    // From the smallest on.
    let mut turn = [S::zero(); 4];
    let mut after = [S::zero(); 3];
    while order > 1 {
        turn = [turn[0] + q0[order], turn[1] + q1[order], turn[2] + q2[order], turn[3] + q3[order]];
        after = [after[0] + m0[order], after[1] + m1[order], after[2] + m2[order]];
        order -= 1;
    }
    for c in 0..3 {
        momentum[c] += [m0[1], m1[1], m2[1]][c] + (momentum_left[c] + after[c]);
        turn[c] = first[c] + (left[c] + turn[c]);
    }
    turn[3] += q3[1];
    turn
}

/// The turn of a body that turns far, by elliptic functions.
pub fn far(moments: [f64; 3], inverse: [f64; 3], momentum: [f64; 3], h: f64) -> [f64; 4] {
    let rate = [0, 1, 2].map(|c| inverse[c] * momentum[c]);
    match FreeRotation::new(moments, rate, IDENTITY) {
        Ok(motion) if motion.check_time(h).is_ok() => {
            let [x, y, z, w] = motion.state(h).orientation;
            [x, y, z, w - 1.0]
        }
        _ => [f64::NAN; 4],
    }
}

/// An orientation after a turn, `q + q∘turn` with what it leaves out, drawn to length 1. The momentum is in space, and does not
/// depend on it.
#[inline(always)]
pub fn oriented<S: Real>(q: [S; 4], rest: [S; 4], turn: [S; 4]) -> ([S; 4], [S; 4]) {
    let (change, small) = (product(q, turn), product(rest, turn));
    let (mut to, mut left) = (q, rest);
    for c in 0..4 {
        // A component near zero is smaller than what it is changed by.
        let (increment, low) = two_sum(change[c], small[c] + rest[c]);
        let rounded;
        (to[c], rounded) = two_sum(q[c], increment);
        left[c] = rounded + low;
    }
    (to, drawn(to, left))
}

/// A quaternion at length 1, with what it leaves out.
#[inline(always)]
pub fn of_length_one<S: Real>(q: [S; 4], rest: [S; 4]) -> ([S; 4], [S; 4]) {
    let square = q[0].multiply_add(q[0], q[1] * q[1]) + q[2].multiply_add(q[2], q[3] * q[3]);
    let inverse = S::one() / square.sqrt();
    let (mut to, mut left) = (q, rest);
    for c in 0..4 {
        to[c] = q[c] * inverse;
        left[c] = rest[c] * inverse;
    }
    (to, drawn(to, left))
}

/// What a nearly unit quaternion leaves out, so that both have length 1.
#[inline(always)]
fn drawn<S: Real>(to: [S; 4], mut left: [S; 4]) -> [S; 4] {
    let missing = S::splat(0.5) * short_of_one(to, left);
    for c in 0..4 {
        left[c] = to[c].multiply_add(missing, left[c]);
    }
    left
}

/// 1 − |q + rest|² of nearly unit quaternions, to the digits of the rest: what is left of a rounded sum of squares would be as
/// large as what is looked for, and always to one side.
#[inline(always)]
fn short_of_one<S: Real>(q: [S; 4], rest: [S; 4]) -> S {
    // `map` would be compiled without the tier's instructions.
    let squares = [q[0] * q[0], q[1] * q[1], q[2] * q[2], q[3] * q[3]];
    let (first, first_lost) = two_sum(squares[0], squares[1]);
    let (last, last_lost) = two_sum(squares[2], squares[3]);
    let (sum, lost) = two_sum(first, last);
    let mut low = lost + (first_lost + last_lost);
    for c in 0..4 {
        low += q[c].multiply_add(q[c], -squares[c]) + (rest[c] + rest[c]) * q[c];
    }
    (S::one() - sum) - low
}

/// dexp⁻¹ of a rotation vector, up to the terms that a method of order four sees: ω − u × ω/2 + u × (u × ω)/12.
#[inline(always)]
pub fn inverse_differential<S: Real>(u: [S; 3], omega: [S; 3]) -> [S; 3] {
    let once = cross(u, omega);
    let twice = cross(u, once);
    let mut result = omega;
    for c in 0..3 {
        result[c] = omega[c] + (twice[c] * S::splat(1.0 / 12.0) - S::splat(0.5) * once[c]);
    }
    result
}

#[cfg(test)]
mod tests;
