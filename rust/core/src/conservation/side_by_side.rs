//! Energies of eight states of a few bodies under gravity, a state in each lane, rounded as the exact ones would be.
//!
//! The one idea: what is recorded is the number nearest to a sum, and seventy digits of two tell which that is but for
//! one sum in some hundreds. So the sums here come with a bound of their error; where both of its ends are rounded to
//! the same number, that is the number of [`kinetic_energy`](super::kinetic_energy) and of the potential energy to
//! thirty digits, bit by bit, and elsewhere the caller takes those (Ziv, ACM TOMS 17 (1991) 410).
//!
//! What makes it cheap: coordinates are cut at 2^-23 of the largest, so that differences of their leading parts, the
//! squares of these and the sum of the squares are exact; and 1/r begins with 17 bits, whose square and whose product
//! with the leading bits of a mass are exact. All else is small, and rounded as numbers are: 2^-16.8 of 1/r, and 2^-20 L/r
//! of it, L being the largest coordinate of all; of v² 2^-20 |v| V, V being the largest component of all. The bounds are
//! sums of these roundings, and leave room for what is exact but to thirty digits.

use crate::numerics::double_double::{quick_two_sum, two_sum};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::numerics::power_of_two::power_of_two;
use crate::numerics::real::{Mask, each};
use crate::tiered;

/// More bodies do not gain by it.
pub const MOST_BODIES: usize = 32;
/// The numbers from which energies are formed, and the powers of two beside them, have sizes of 2^-this to 2^this.
const RANGE: i32 = 200;
/// Energies above 2^-this, in which nothing has vanished.
const LEAST: i32 = 400;
/// The largest coordinate, the origin's among them, is less than 2^this of a distance.
const APART: f64 = 1_048_576.0; // 2^20
/// A number of this size beside it cuts another one at 2^-22 to 2^-24 of its own.
const CUT: f64 = 1_073_741_824.0; // 2^30

/// The coefficient of e² in (1 - e)^(-1/2), with what stands best for e⁴: it is off by 2^-67.8 where |e| < 1.7e-5.
const QUADRATIC: f64 = 0.375 + 6.55e-11;

/// The bodies: what is the same in all states.
#[derive(Clone, Debug)]
pub struct SideBySide {
    bodies: Vec<Body>,
    softening: f64,
    /// What takes Σ m m/r and Σ m v² to energies.
    factors: [f64; 2],
    /// The velocity of the origin.
    drift: [f64; 3],
    /// The coordinates, cut.
    cut: Vec<Lanes>,
}

#[derive(Clone, Copy, Debug)]
struct Body {
    mass: f64,
    /// Its leading 36 bits, and the others and all in parts of these.
    leading: f64,
    rest: f64,
    whole: f64,
    /// The masses of those after it.
    after: f64,
}

/// Σ m v² and Σ m m/r of eight states: value, what it leaves out, and how far off both may be.
#[derive(Clone, Copy, Debug)]
pub struct Sums {
    kinetic: [Lanes; 3],
    potential: [Lanes; 3],
    /// The states of which that is known.
    fine: Bits,
}

/// Coordinates or velocities and what they leave out, one body after another for each component.
pub type Numbers<'a> = (&'a [Lanes], &'a [Lanes]);

impl SideBySide {
    /// Of these masses, whose gravity has that constant and softening, about an origin that moves at that velocity; the
    /// energies are to be 2^`exponents[0]` times the kinetic and 2^`exponents[1]` times the potential one. `None` if the
    /// sizes of the numbers are out of the common.
    pub fn new(
        masses: &[f64],
        (constant, softening): (f64, f64),
        drift: [f64; 3],
        exponents: [i32; 2],
    ) -> Option<Self> {
        let sizes = power_of_two(-RANGE)..power_of_two(RANGE);
        let fine = (2..=MOST_BODIES).contains(&masses.len())
            && masses.iter().all(|mass| sizes.contains(mass))
            && sizes.contains(&constant.abs())
            && (softening == 0.0 || sizes.contains(&softening))
            && drift.iter().all(|v| v.abs() < sizes.end)
            && exponents.iter().all(|exponent| exponent.abs() < RANGE);
        if !fine {
            return None;
        }
        let body = |(index, &mass): (usize, &f64)| {
            let leading = f64::from_bits(mass.to_bits() & !((1 << 17) - 1));
            let rest = (mass - leading) / leading;
            Body { mass, leading, rest, whole: 1.0 + rest, after: masses[index + 1..].iter().sum() }
        };
        Some(Self {
            bodies: masses.iter().enumerate().map(body).collect(),
            softening,
            factors: [-constant * power_of_two(exponents[1]), 0.5 * power_of_two(exponents[0])],
            drift,
            cut: vec![Lanes::default(); 6 * masses.len()],
        })
    }

    /// How many bodies there are.
    pub fn count(&self) -> usize {
        self.bodies.len()
    }

    /// The sums of states with two components or three, the origin of which is so far away.
    pub fn sums(
        &mut self,
        components: usize,
        position: Numbers<'_>,
        velocity: Numbers<'_>,
        away: Lanes,
    ) -> Sums {
        if components == 2 {
            sums::<2>(self, position, velocity, away)
        } else {
            sums::<3>(self, position, velocity, away)
        }
    }

    /// The kinetic energies, the potential ones, or the sums of both, and which of them are known to be the nearest
    /// numbers.
    pub fn energies(&self, sums: &Sums, of: [bool; 2]) -> (Lanes, Bits) {
        nearest(self, sums, of)
    }
}

tiered! {
    fn sums[const COMPONENTS: usize][COMPONENTS](few: &mut SideBySide, position: Numbers<'_>, velocity: Numbers<'_>, away: Lanes) -> Sums = sums_of_eight;
    fn nearest[][](few: &SideBySide, sums: &Sums, of: [bool; 2]) -> (Lanes, Bits) = nearest_of_eight;
}

#[inline(always)]
fn sums_of_eight<V: Vector8 + InverseCube, const COMPONENTS: usize>(
    few: &mut SideBySide,
    position: Numbers<'_>,
    velocity: Numbers<'_>,
    away: Lanes,
) -> Sums {
    let SideBySide { bodies, softening, drift, cut, .. } = few;
    let kinetic = mass_times_square::<V, COMPONENTS>(bodies, velocity, drift);
    let (potential, fine) =
        pairs::<V, COMPONENTS>(bodies, position, V::view_mut(cut), *softening, V::load(away));
    let mut sums = Sums { kinetic: [Lanes::default(); 3], potential: [Lanes::default(); 3], fine };
    for part in 0..3 {
        sums.kinetic[part] = kinetic[part].store();
        sums.potential[part] = potential[part].store();
    }
    sums
}

/// A number cut by a large one: its leading part, and the rest with what it leaves out.
#[inline(always)]
fn cut_by<V: Vector8>(large: V, value: V, left_out: V) -> [V; 2] {
    let leading = (value + large) - large;
    [leading, (value - leading) + left_out]
}

/// Σ m v².
#[inline(always)]
fn mass_times_square<V: Vector8, const COMPONENTS: usize>(
    bodies: &[Body],
    (values, rests): Numbers<'_>,
    drift: &[f64; 3],
) -> [V; 3] {
    let (values, rests) = (V::view(values), V::view(rests));
    let (count, zero, two) = (bodies.len(), V::zero(), V::splat(2.0));
    let moves = V::splat(drift[0].abs().max(drift[1].abs()).max(drift[2].abs()));
    let fastest = largest::<V, COMPONENTS>(values, count, moves);
    let large = fastest * V::splat(CUT);
    let mut own = [[zero; 2]; 3];
    for c in 0..3 {
        own[c] = cut_by(large, V::splat(drift[c]), zero);
    }
    let all = V::splat(bodies[0].mass + bodies[0].after) * (fastest * fastest);
    let start = all * V::splat(16.0);
    let (mut sum, mut low, mut sizes) = (start, zero, zero);
    for (index, body) in bodies.iter().enumerate() {
        let (mut square, mut small, mut size) = (zero, zero, zero);
        for c in 0..3 {
            let [mut leading, mut rest] = own[c];
            if c < COMPONENTS {
                let at = c * count + index;
                let cut = cut_by(large, values[at], rests[at]);
                leading += cut[0];
                rest += cut[1];
            }
            square = leading.multiply_add(leading, square);
            small = rest.multiply_add(two.multiply_add(leading, rest), small);
            size += leading.abs();
        }
        let mass = V::splat(body.mass);
        let term = mass * square;
        let excess = mass.multiply_subtract_from(square, term);
        let joined = quick_two_sum(sum, term);
        sum = joined.0;
        low += mass.multiply_add(small, joined.1 - excess);
        sizes = mass.multiply_add(size, sizes);
    }
    let near = V::splat((4 + count) as f64 * power_of_two(-71)) * fastest;
    let error = all.multiply_add(V::splat(power_of_two(-86)), sizes * near);
    let (high, low) = two_sum(sum - start, low);
    [high, low, error]
}

/// The largest size of a number, or `least` if that is larger.
#[inline(always)]
fn largest<V: Vector8, const COMPONENTS: usize>(values: &[V], count: usize, least: V) -> V {
    // One for each component, lest each wait for the one before.
    let mut found = [least; COMPONENTS];
    for body in 0..count {
        for c in 0..COMPONENTS {
            found[c] = found[c].max(values[c * count + body].abs());
        }
    }
    let mut largest = found[0];
    for c in 1..COMPONENTS {
        largest = largest.max(found[c]);
    }
    largest
}

/// What a body has summed over those after it.
struct Row<S> {
    /// Σ m/r, beside a number above all of its terms, and what it leaves out.
    sum: S,
    left_out: S,
    /// Σ m/r².
    near: S,
    /// What 1/r may be at most, and where it is less.
    most: S,
    fine: Bits,
}

/// Σ m m/r, and where the bound of its error holds.
#[inline(always)]
fn pairs<V: Vector8 + InverseCube, const COMPONENTS: usize>(
    bodies: &[Body],
    (values, rests): Numbers<'_>,
    cut: &mut [V],
    softening: f64,
    away: V,
) -> ([V; 3], Bits) {
    let (values, rests) = (V::view(values), V::view(rests));
    let count = bodies.len();
    let zero = V::zero();
    let extent = largest::<V, COMPONENTS>(values, count, V::splat(softening));
    let large = extent * V::splat(CUT);
    for body in 0..count {
        for c in 0..COMPONENTS {
            let [leading, rest] = cut_by(large, values[c * count + body], rests[c * count + body]);
            cut[(2 * c) * count + body] = leading;
            cut[(2 * c + 1) * count + body] = rest;
        }
    }
    // The softening is one more component.
    let [leading, rest] = cut_by(large, V::splat(softening), zero);
    let soft = [leading * leading, rest * V::splat(2.0).multiply_add(leading, rest)];
    let most = V::splat(APART) / extent;
    let (mut high, mut low, mut near) = (zero, zero, zero);
    let sized = V::splat(power_of_two(-RANGE)).less(extent).and(extent.less(V::splat(power_of_two(RANGE))));
    let mut fine = sized.and(away.less(V::splat(APART) * extent));
    for (index, body) in bodies.iter().enumerate() {
        let start = V::splat(4.0 * body.after) * most;
        let mut row = Row { sum: start, left_out: zero, near: zero, most, fine };
        let mut other = index + 1;
        while other + 2 <= count {
            row.add::<COMPONENTS, 2>(bodies, cut, (index, other), soft);
            other += 2;
        }
        if other < count {
            row.add::<COMPONENTS, 1>(bodies, cut, (index, other), soft);
        }
        let (mass, sum) = (V::splat(body.mass), row.sum - start);
        let term = mass * sum;
        let left_out = mass.multiply_subtract_from(sum, term);
        let joined = two_sum(high, term);
        high = joined.0;
        low += mass.multiply_add(row.left_out, joined.1 - left_out);
        near = mass.multiply_add(row.near, near);
        fine = row.fine;
    }
    let (high, low) = quick_two_sum(high, low);
    let close = (extent * near) * V::splat(power_of_two(-69));
    let error = high.multiply_add(V::splat((2 + count) as f64 * power_of_two(-67)), close);
    ([high, low, error], fine)
}

impl<S: Vector8 + InverseCube> Row<S> {
    /// Adds some bodies that follow each other.
    #[inline(always)]
    fn add<const COMPONENTS: usize, const N: usize>(
        &mut self,
        bodies: &[Body],
        cut: &[S],
        (from, to): (usize, usize),
        soft: [S; 2],
    ) {
        let (count, two) = (bodies.len(), S::splat(2.0));
        let (mut square, mut small) = ([soft[0]; N], [soft[1]; N]);
        for c in 0..COMPONENTS {
            let (leading, rest) = (&cut[2 * c * count..][..count], &cut[(2 * c + 1) * count..][..count]);
            let d = each!(i < N => leading[to + i] - leading[from]);
            let d_rest = each!(i < N => rest[to + i] - rest[from]);
            square = each!(i < N => d[i].multiply_add(d[i], square[i]));
            let twice = each!(i < N => two.multiply_add(d[i], d_rest[i]));
            small = each!(i < N => d_rest[i].multiply_add(twice[i], small[i]));
        }
        let root = each!(i < N => (square[i] + small[i]).rough_inverse_root());
        let inverse_square = each!(i < N => root[i] * root[i]);
        // How far that is off, and what 1/r is beside the rough one, in parts of that.
        let off = each!(i < N => square[i].multiply_subtract_from(inverse_square[i], S::one()));
        let off = each!(i < N => small[i].multiply_subtract_from(inverse_square[i], off[i]));
        let series = each!(i < N => off[i].multiply_add(S::splat(0.3125), S::splat(QUADRATIC)));
        let series = each!(i < N => off[i].multiply_add(series[i], S::splat(0.5)));
        let part = each!(i < N => off[i] * series[i]);
        let other = each!(i < N => S::splat(bodies[to + i].rest));
        let part = each!(i < N => part[i].multiply_add(S::splat(bodies[to + i].whole), other[i]));
        let term = each!(i < N => S::splat(bodies[to + i].leading) * root[i]);
        for i in 0..N {
            let (sum, left_out) = quick_two_sum(self.sum, term[i]);
            self.sum = sum;
            self.left_out += term[i].multiply_add(part[i], left_out);
            self.near = term[i].multiply_add(root[i], self.near);
            self.fine = self.fine.and(root[i].less(self.most));
        }
    }
}

#[inline(always)]
fn nearest_of_eight<V: Vector8>(
    few: &SideBySide,
    sums: &Sums,
    [kinetic, potential]: [bool; 2],
) -> (Lanes, Bits) {
    let [constant, half] = few.factors;
    let load = |[high, low, error]: [Lanes; 3]| [V::load(high), V::load(low), V::load(error)];
    let zero = [V::zero(); 3];
    let [mut high, mut low, mut error] = zero;
    if kinetic {
        let factor = V::splat(half);
        [high, low, error] = load(sums.kinetic);
        (high, low, error) = (high * factor, low * factor, error * factor);
    }
    if potential {
        let [sum, rest, off] = load(sums.potential);
        let factor = V::splat(constant);
        let term = factor * sum;
        let left_out = factor.multiply_subtract_from(sum, term);
        let joined = two_sum(high, term);
        low += factor.multiply_add(rest, joined.1 - left_out);
        high = joined.0;
        error += off * factor.abs();
    }
    let (high, low) = two_sum(high, low);
    let (most, least) = (high + (low + error), high + (low - error));
    let size = most.abs();
    let sized = V::splat(power_of_two(-LEAST)).less(size).and(size.less(V::splat(power_of_two(2 * LEAST))));
    (most.store(), sums.fine.and(sized).and(most.less_equal(least)))
}

#[cfg(test)]
mod tests;
