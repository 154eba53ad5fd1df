//! Vectors and quaternions (x, y, z, w) over any scalar, for what runs in lanes.

use crate::numerics::double_double::two_sum;
use crate::numerics::real::Real;

/// A product with a rounded factor, and what its rounding leaves out. Times and moments are round numbers more often than not,
/// and the errors of such products no noise about zero: in every step the same, they would move the energy.
#[inline(always)]
pub fn by_exactly<S: Real>(x: S, (high, low): (S, S)) -> (S, S) {
    let whole = x * high;
    (whole, x.multiply_add(high, -whole) + x * low)
}

/// The vector product.
#[inline(always)]
pub fn cross<S: Real>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [
        a[1].multiply_add(b[2], -(a[2] * b[1])),
        a[2].multiply_add(b[0], -(a[0] * b[2])),
        a[0].multiply_add(b[1], -(a[1] * b[0])),
    ]
}

/// The scalar product.
#[inline(always)]
pub fn dot<S: Real>(a: [S; 3], b: [S; 3]) -> S {
    a[0].multiply_add(b[0], a[1].multiply_add(b[1], a[2] * b[2]))
}

/// `a·factor`.
#[inline(always)]
pub fn times<S: Real>(a: [S; 3], factor: S) -> [S; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

/// `a·factor + b`.
#[inline(always)]
pub fn times_plus<S: Real>(a: [S; 3], factor: S, b: [S; 3]) -> [S; 3] {
    [a[0].multiply_add(factor, b[0]), a[1].multiply_add(factor, b[1]), a[2].multiply_add(factor, b[2])]
}

/// `a − b`.
#[inline(always)]
pub fn minus<S: Real>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The vector turned by a quaternion `[x, y, z, w]`.
#[inline(always)]
pub fn turned<S: Real>(q: [S; 4], v: [S; 3]) -> [S; 3] {
    by_axis([q[0], q[1], q[2]], q[3], v)
}

/// The vector turned back.
#[inline(always)]
pub fn turned_back<S: Real>(q: [S; 4], v: [S; 3]) -> [S; 3] {
    by_axis([q[0], q[1], q[2]], -q[3], v)
}

/// The vector turned back by a quaternion and what it leaves out, with the errors of products with the vector, which may be
/// the same round numbers in every step. A rounded quaternion is not of length 1, and would add to each vector some of the
/// one that it comes from.
#[inline(always)]
pub fn turned_back_by_all<S: Real>(q: [S; 4], rest: [S; 4], v: [S; 3]) -> [S; 3] {
    let (u, of_rest) = ([q[0], q[1], q[2]], [rest[0], rest[1], rest[2]]);
    let mut inner = v;
    let mut inner_rest = times_plus(v, -rest[3], cross(of_rest, v));
    for c in 0..3 {
        let (next, last) = ((c + 1) % 3, (c + 2) % 3);
        let terms = [u[next] * v[last], -(u[last] * v[next]), -(q[3] * v[c])];
        let lost = u[next].multiply_add(v[last], -terms[0])
            - (u[last].multiply_add(v[next], terms[1]) + q[3].multiply_add(v[c], terms[2]));
        let (first, first_lost) = two_sum(terms[0], terms[1]);
        let (sum, sum_lost) = two_sum(first, terms[2]);
        inner[c] = sum;
        inner_rest[c] += (first_lost + sum_lost) + lost;
    }
    let (turn, by_inner, by_rest) = (cross(u, inner), cross(u, inner_rest), cross(of_rest, inner));
    let mut all = v;
    for c in 0..3 {
        // Of two rounded numbers many sums are halfway between two others, and go to one side where v is always the same.
        let (sum, lost) = two_sum(v[c], turn[c] + turn[c]);
        let rest = by_inner[c] + by_rest[c];
        all[c] = sum + (lost + (rest + rest));
    }
    all
}

/// v + 2u × (u × v + w v).
#[inline(always)]
fn by_axis<S: Real>(u: [S; 3], w: S, v: [S; 3]) -> [S; 3] {
    let inner = times_plus(v, w, cross(u, v));
    let turn = cross(u, inner);
    let two = S::splat(2.0);
    times_plus(turn, two, v)
}

/// The product of quaternions, the second one's rotation first.
#[inline(always)]
pub fn product<S: Real>(a: [S; 4], b: [S; 4]) -> [S; 4] {
    let [ax, ay, az, aw] = a;
    let [bx, by, bz, bw] = b;
    [
        aw.multiply_add(bx, ax.multiply_add(bw, ay.multiply_add(bz, -(az * by)))),
        aw.multiply_add(by, ay.multiply_add(bw, az.multiply_add(bx, -(ax * bz)))),
        aw.multiply_add(bz, az.multiply_add(bw, ax.multiply_add(by, -(ay * bx)))),
        aw.multiply_add(bw, -(ax.multiply_add(bx, ay.multiply_add(by, az * bz)))),
    ]
}

/// What two turns make together, each and the whole less the identity: (1 + a)(1 + b) − 1.
#[inline(always)]
pub fn joined<S: Real>(a: [S; 4], b: [S; 4]) -> [S; 4] {
    let both = product(a, b);
    [(a[0] + b[0]) + both[0], (a[1] + b[1]) + both[1], (a[2] + b[2]) + both[2], (a[3] + b[3]) + both[3]]
}

/// The largest of three absolute values.
#[inline(always)]
pub fn largest<S: Real>(a: [S; 3]) -> S {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}
