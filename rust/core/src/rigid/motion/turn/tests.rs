//! Turns against elliptic functions, against each other, and back.

use super::*;
use crate::rigid::motion::vectors::{turned_back, turned_back_by_all};
use crate::rigid::quaternion::{IDENTITY, Quaternion};
use proptest::prelude::*;

fn free(moments: [f64; 3], rate: [f64; 3], h: f64) -> Quaternion {
    FreeRotation::new(moments, rate, IDENTITY).unwrap().state(h).orientation
}

/// Of the series, whatever the moments.
fn by_series(moments: [f64; 3], rate: [f64; 3], h: f64) -> ([f64; 4], bool) {
    let momentum = [0, 1, 2].map(|c| moments[c] * rate[c]);
    asymmetric(&Inverses::of(moments), momentum, h, &mut [0.0; ROOM])
}

/// Quaternions of the same rotation differ by a sign.
fn apart(turn: [f64; 4], q: Quaternion) -> f64 {
    let own = [turn[0], turn[1], turn[2], turn[3] + 1.0];
    let off = |sign: f64| (0..4).map(|c| (own[c] - sign * q[c]).abs()).fold(0.0, f64::max);
    off(1.0).min(off(-1.0))
}

#[test]
fn a_body_turns_as_the_elliptic_functions_have_it() {
    // Hairer & Vilmart's body, a book that flips, moments 1e-15 apart, a rod of 1e6 : 1 and one near its separatrix.
    let bodies = [
        ([0.6, 0.8, 1.0], [3.0, 0.5, -0.9]),
        ([3.0, 5.0, 7.0], [1e-9, 0.4, 1e-9]),
        ([1.0, 1.0 + 1e-15, 1.5], [0.3, 0.2, 0.9]),
        ([1.0, 1.0 + 1e-6, 1e-6], [0.3, 0.2, 0.9]),
        ([1.0, 2.0, 3.0], [1e-8, 1.0, 1e-8]),
    ];
    for (moments, rate) in bodies {
        for h in [1e-6, 1e-3, 0.02, 0.1, 0.5, 1.0, -0.3, 4.0] {
            let (turn, far) = by_series(moments, rate, h);
            let largest = rate.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
            assert!(!far);
            // A unit in the last place for each radian, and that of the reference.
            let bound = 4e-16 * (1.0 + largest * h.abs()) + 4e-15;
            let off = apart(turn, free(moments, rate, h));
            assert!(off <= bound, "{moments:?} {h}: {off:e}");
        }
    }
}

proptest! {
    /// Whether two moments agree is no matter: both ways are one turn.
    #[test]
    fn a_symmetric_body_turns_as_any_other(
        a in 0.6..2.0f64, c in 0.01..1.1f64, rate in prop::array::uniform3(-2.0..2.0f64), h in -1.0..1.0f64
    ) {
        let moments = [a, a, c];
        let momentum = [0, 1, 2].map(|i| moments[i] * rate[i]);
        let inverse = moments.map(|moment| 1.0 / moment);
        let one = symmetric(inverse, inverse[0], momentum, h);
        let (other, _) = by_series(moments, rate, h);
        for i in 0..4 {
            prop_assert!((one[i] - other[i]).abs() <= 2e-15, "{one:?} {other:?}");
        }
    }

    /// The momentum in space stays, whatever the turn: |m| in the body is its, and so is the energy.
    #[test]
    fn turns_keep_the_energy(
        b in 0.5..1.5f64, c in 0.6..1.4f64, rate in prop::array::uniform3(-3.0..3.0f64), h in -1.0..1.0f64
    ) {
        let moments = [1.0, b, c.min(0.99 * (1.0 + b)).max((1.0 - b).abs() + 0.01)];
        let momentum = [0, 1, 2].map(|i| moments[i] * rate[i]);
        let (turn, _) = by_series(moments, rate, h);
        let (q, _) = oriented(IDENTITY, [0.0; 4], turn);
        let after = turned_back(q, momentum);
        let energy = |m: [f64; 3]| (0..3).map(|i| m[i] * m[i] / moments[i]).sum::<f64>();
        let before = energy(momentum);
        prop_assert!((energy(after) - before).abs() <= 2e-15 * before.max(1e-3));
    }

    /// However far turns are, and however many: the length stays 1, to the rounding of four numbers and of their squares.
    #[test]
    fn lengths_do_not_grow(half in prop::array::uniform3(-3.0..3.0f64), size in 0.0..7.0f64) {
        let half = half.map(|part| part * size.exp2());
        let (mut q, mut rest) = (IDENTITY, [0.0; 4]);
        for _ in 0..200 {
            // As seen from the body: what is turned back by a quaternion off length 1 is off as much.
            let turn = rotation(half);
            let [x, y, z] = turned_back(q, [turn[0], turn[1], turn[2]]);
            (q, rest) = oriented(q, rest, [x, y, z, turn[3]]);
        }
        let square = q.iter().map(|part| part * part).sum::<f64>();
        prop_assert!((square - 1.0).abs() <= 4.0 * f64::EPSILON, "{square}");
    }

    /// Back is the inverse.
    #[test]
    fn a_turn_back_undoes_a_turn(rate in prop::array::uniform3(-3.0..3.0f64), h in 0.0..1.0f64) {
        let moments = [0.6, 0.8, 1.0];
        let (turn, _) = by_series(moments, rate, h);
        let (q, _) = oriented(IDENTITY, [0.0; 4], turn);
        let momentum = turned_back(q, [0, 1, 2].map(|c| moments[c] * rate[c]));
        let (back, _) = by_series(moments, [0, 1, 2].map(|c| momentum[c] / moments[c]), -h);
        let whole = joined(turn, back);
        prop_assert!(whole.iter().all(|part| part.abs() <= 3e-15), "{whole:?}");
    }

    /// exp of a rotation vector of any size, against sine and cosine: 1.1 units in the last place for each radian in two million draws.
    #[test]
    fn rotations_are_those_of_their_vectors(direction in prop::array::uniform3(-1.0..1.0f64), size in -20.0..9.0f64) {
        let norm = dot(direction, direction).sqrt();
        prop_assume!(norm > 0.1);
        let angle = size.exp2();
        let half = direction.map(|part| part / norm * angle);
        let found = rotation(half);
        let angle = dot(half, half).sqrt();
        let expected = [0, 1, 2].map(|c| half[c] / angle * crate::numerics::angles::sin(angle));
        for c in 0..3 {
            prop_assert!((found[c] - expected[c]).abs() <= 2.0 * f64::EPSILON * (1.0 + 2.0 * angle) * angle.min(1.0));
        }
        let cosine = crate::numerics::angles::cos(angle) - 1.0;
        prop_assert!((found[3] - cosine).abs() <= 2.0 * f64::EPSILON * (1.0 + 2.0 * angle));
    }
}

/// What is rounded alike in every step moves energies by as much in each: the low parts are there, and right.
#[test]
fn constants_have_both_their_parts() {
    for (n, &(high, low)) in RECIPROCALS.iter().enumerate().skip(1) {
        let exact = DoubleDouble::from(1.0) / DoubleDouble::from(n as f64);
        assert_eq!(high, exact.high());
        // The low part itself is rounded.
        assert!((low - exact.low()).abs() <= f64::EPSILON * f64::EPSILON * high, "1/{n}");
    }
    for moments in [[0.6, 0.8, 1.0], [1.0, 1.0 + 1e-15, 1.5], [1e-6, 1.0, 1.0 + 1e-7], [3.0, 5.0, 7.0]] {
        let Inverses { inverse, differences } = Inverses::of(moments);
        let whole = |(high, low): Rounded<f64>, c: usize| DoubleDouble::new(high[c], low[c]);
        for (c, [one, other]) in [[2, 1], [0, 2], [1, 0]].into_iter().enumerate() {
            let unit = whole(inverse, c) * DoubleDouble::from(moments[c]) - DoubleDouble::from(1.0);
            assert!(unit.to_f64().abs() <= 1e-31);
            let off = whole(inverse, one) - whole(inverse, other) - whole(differences, c);
            let largest = inverse.0[one].abs().max(inverse.0[other].abs());
            assert!(off.to_f64().abs() <= 1e-31 * largest, "{moments:?} {c}");
        }
    }
}

#[test]
fn what_turns_far_is_told_and_found() {
    let moments = [0.6, 0.8, 1.0];
    let rate = [3e4, 0.5e4, -0.9e4];
    let (_, is_far) = by_series(moments, rate, 1.0);
    assert!(is_far);
    let momentum = [0, 1, 2].map(|c| moments[c] * rate[c]);
    let turn = far(moments, moments.map(|moment| 1.0 / moment), momentum, 1.0);
    assert!(apart(turn, free(moments, rate, 1.0)) <= 1e-11);
}

/// Nothing is rounded to one side: the energy walks at random, and does not drift. Momenta of round numbers and of any others,
/// steps of one part and of two.
#[test]
fn roundings_cancel_each_other() {
    const STEPS: u32 = 200_000;
    let moments = [0.6, 0.8, 1.0];
    let body = Inverses::of(moments);
    let inverse = [0, 1, 2].map(|c| DoubleDouble::new(body.inverse.0[c], body.inverse.1[c]));
    let exact = |q: [f64; 4], rest: [f64; 4], v: [f64; 3]| {
        let [x, y, z, w] = [0, 1, 2, 3].map(|c| DoubleDouble::from(q[c]) + DoubleDouble::from(rest[c]));
        let length = x * x + y * y + z * z + w * w;
        assert!(
            (length.to_f64() - 1.0).abs() == 0.0 && (length - DoubleDouble::from(1.0)).to_f64().abs() < 1e-30
        );
        let momentum = turned_back([x, y, z, w], v.map(DoubleDouble::from));
        (0..3).fold(DoubleDouble::from(0.0), |sum, c| sum + momentum[c] * momentum[c] * inverse[c])
    };
    let mut room = [0.0; ROOM];
    for momentum in [
        [1.8, 0.4, -0.9],
        [2.1, 0.4, -0.9],
        [1.7531622376021023, 0.4758697909214809, -1.0431639389190777],
        [2.0204750383394714, 0.37063233398471845, -0.7736538900720801],
    ] {
        let (mut q, mut rest) = (IDENTITY, [0.0; 4]);
        let before = exact(q, rest, momentum);
        for _ in 0..STEPS {
            let own = turned_back_by_all(q, rest, momentum);
            (q, rest) = oriented(q, rest, asymmetric(&body, own, 0.1, &mut room).0);
        }
        let drift = (exact(q, rest, momentum) / before - DoubleDouble::from(1.0)).to_f64() / f64::from(STEPS);
        // Five times what a random walk of 1.3e-18 a step leaves; a bias of a hundredth of a rounding is twice as much.
        assert!(drift.abs() <= 1.5e-20, "{momentum:?}: {drift:e}");
    }
}
