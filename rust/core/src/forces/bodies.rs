//! Masses, positions and velocities of one state with what their rounded values leave out, as arrays.
//!
//! For sums over bodies and pairs of them that lose nothing: energies, momenta. The one idea: values are brought near
//! one by powers of two first (which is exact), so that no square of them overflows or vanishes.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::{Mask, Real};
use crate::tiered;

/// The arrays: masses, then for each coordinate positions, their rests, velocities, their rests.
const ARRAYS: usize = 13;
/// Outside of this, 2^±120, values are brought near one. Products of six of them are then in range, errors and all.
const MOST: f64 = 1.329_227_995_784_916e36;
const LEAST: f64 = 1.0 / MOST;

/// A vector of numbers that are unevaluated sums.
pub type Vector = [DoubleDouble; 3];

/// Bodies of one state.
#[derive(Clone, Debug, Default)]
pub struct PreciseBodies {
    /// Array after array, each padded with zeros to whole rows and one row more.
    numbers: Vec<f64>,
    stride: usize,
    len: usize,
    /// PreciseBodies from here on are massless.
    massive: usize,
    /// The largest mass, as it was set.
    heaviest: f64,
    /// The exponents of the units of mass, length and speed in which the arrays are.
    pub units: Exponents,
}

/// Exponents of two of units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exponents {
    /// Of mass.
    pub mass: i32,
    /// Of length.
    pub length: i32,
    /// Of speed.
    pub speed: i32,
}

/// A kind of vector.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    /// Positions.
    Position,
    /// Velocities.
    Velocity,
}

impl PreciseBodies {
    /// Makes place for so many bodies, none of them set; to be [settled](Self::settle) once they are.
    pub fn clear(&mut self, len: usize) {
        let stride = len.next_multiple_of(WIDTH) + WIDTH;
        if len != self.len {
            // Otherwise the zeros are in their places, and all else will be set.
            self.numbers.clear();
            self.numbers.resize(ARRAYS * stride, 0.0);
        }
        (self.len, self.stride, self.massive, self.units) = (len, stride, 0, Exponents::default());
        self.heaviest = 0.0;
    }

    /// Sets a body.
    pub fn set(&mut self, index: usize, mass: f64, position: [[f64; 3]; 2], velocity: [[f64; 3]; 2]) {
        self.set_mass(index, mass);
        for c in 0..3 {
            for (kind, values) in [position[0], position[1], velocity[0], velocity[1]].into_iter().enumerate()
            {
                self.numbers[(1 + 4 * c + kind) * self.stride + index] = values[c];
            }
        }
    }

    /// Sets the mass of a body.
    #[inline]
    pub fn set_mass(&mut self, index: usize, mass: f64) {
        self.numbers[index] = mass;
        if mass != 0.0 {
            self.massive = self.massive.max(index + 1);
            self.heaviest = Real::max(self.heaviest, mass);
        }
    }

    /// The same bodies with other numbers in the place of their masses, as charges are.
    pub fn with_masses(&self, number: impl Fn(usize) -> f64) -> Self {
        let mut other = self.clone();
        let numbers: Vec<f64> = (0..self.len).map(number).collect();
        let largest = numbers.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let unit = if (LEAST..MOST).contains(&largest) { 0 } else { exponent(largest) };
        (other.massive, other.heaviest, other.units.mass) = (0, 0.0, unit);
        for (body, number) in numbers.into_iter().enumerate() {
            other.set_mass(body, scale(number, -unit));
        }
        other
    }

    /// The array of a coordinate; the next one is what it leaves out.
    #[inline(always)]
    fn first(of: Of, c: usize) -> usize {
        1 + 4 * c + if matches!(of, Of::Position) { 0 } else { 2 }
    }

    /// A coordinate of all bodies and what it leaves out, to be set.
    #[inline]
    pub fn coordinates_mut(&mut self, of: Of, c: usize) -> [&mut [f64]; 2] {
        let (len, stride) = (self.len, self.stride);
        let first = Self::first(of, c) * stride;
        let (values, rests) = self.numbers[first..first + 2 * stride].split_at_mut(stride);
        [&mut values[..len], &mut rests[..len]]
    }

    /// Whether the masses are those of so many bodies, as they were set: positions and velocities may then be set anew.
    #[inline]
    pub fn keeps_masses(&self, len: usize) -> bool {
        self.len == len && self.units == Exponents::default()
    }

    /// Sets positions and velocities of eight bodies from one on, whose place is that of a row, and what they leave out; zero
    /// after the last of them. Gives the largest of each kind, lane by lane, those from before among them.
    #[inline(always)]
    pub fn set_row<V: Vector8>(
        &mut self,
        body: usize,
        values: &[[FusedDouble<V>; 3]; 2],
        mut largest: [V; 2],
    ) -> [V; 2] {
        let there = Bits((0xff_u32 >> (WIDTH - (self.len - body).min(WIDTH))) as u8);
        // Indices, not an iterator: what is no loop by itself would be called, all vectors saved before.
        let (stride, numbers) = (self.stride, &mut self.numbers[..]);
        for c in 0..3 {
            for kind in 0..2 {
                let FusedDouble { high, low } = values[kind][c];
                let (high, low) = (V::select(there, high, V::zero()), V::select(there, low, V::zero()));
                largest[kind] = largest[kind].max(high.abs());
                let first =
                    Self::first(if kind == 0 { Of::Position } else { Of::Velocity }, c) * stride + body;
                set_eight(numbers, first, high);
                set_eight(numbers, first + stride, low);
            }
        }
        largest
    }

    /// Brings the values near one, once all are set.
    #[inline]
    pub fn settle(&mut self) {
        if !are_near(self) {
            self.settle_far();
        }
    }

    /// As [`settle`](Self::settle), the largest sizes of the positions and of the velocities being known lane by lane.
    #[inline(always)]
    pub fn settle_sized<V: Vector8>(&mut self, largest: [V; 2]) {
        let near = (LEAST..MOST).contains(&self.heaviest) && is_near(largest[0]) && is_near(largest[1]);
        if !near {
            self.settle_far();
        }
    }

    #[cold]
    fn settle_far(&mut self) {
        let largest = largest(self);
        let far = |size: f64| size != 0.0 && !(LEAST..MOST).contains(&size);
        if far(largest[0]) || far(largest[1]) || far(largest[2]) {
            self.bring_near(largest);
        }
    }

    #[cold]
    fn bring_near(&mut self, largest: [f64; 3]) {
        let [mass, length, speed] =
            largest.map(|size| if (LEAST..MOST).contains(&size) { 0 } else { exponent(size) });
        self.units = Exponents { mass, length, speed };
        for (index, array) in self.numbers.chunks_exact_mut(self.stride).enumerate() {
            let unit = match index {
                0 => mass,
                _ if (index - 1) % 4 < 2 => length,
                _ => speed,
            };
            array.iter_mut().for_each(|value| *value = scale(*value, -unit));
        }
    }

    #[inline(always)]
    fn array(&self, index: usize) -> &[f64] {
        &self.numbers[index * self.stride..(index + 1) * self.stride]
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Those with a mass are below this index.
    pub fn massive(&self) -> usize {
        self.massive
    }

    /// Masses, in these units; zeros after the last.
    #[inline(always)]
    pub fn mass(&self) -> &[f64] {
        self.array(0)
    }

    #[inline(always)]
    fn parts(&self, of: Of, c: usize) -> [&[f64]; 2] {
        let first = Self::first(of, c);
        [self.array(first), self.array(first + 1)]
    }

    /// A vector of a body, in these units.
    pub fn vector(&self, of: Of, body: usize) -> Vector {
        core::array::from_fn(|c| {
            let [values, rests] = self.parts(of, c);
            DoubleDouble::sum(values[body], rests[body])
        })
    }

    /// The masses of eight bodies from one on; zeros after the last.
    #[inline(always)]
    pub fn masses_from<V: Vector8>(&self, body: usize) -> V {
        eight(self.mass(), body)
    }

    /// A coordinate of eight bodies from one on.
    #[inline(always)]
    pub fn coordinates_from<V: Vector8>(&self, of: Of, c: usize, body: usize) -> FusedDouble<V> {
        let [values, rests] = self.parts(of, c);
        FusedDouble { high: eight(values, body), low: eight(rests, body) }
    }

    /// A coordinate of a body, in all lanes.
    #[inline(always)]
    pub fn coordinate<V: Vector8>(&self, of: Of, c: usize, body: usize) -> FusedDouble<V> {
        let [values, rests] = self.parts(of, c);
        FusedDouble { high: V::splat(values[body]), low: V::splat(rests[body]) }
    }
}

tiered! {
    /// Σ m q, or Σ q.
    pub fn vector_sum[][](bodies: &PreciseBodies, of: Of, weighted: bool) -> [FusedDouble<Lanes>; 3] = mass_times_vector;
    fn largest[][](bodies: &PreciseBodies) -> [f64; 3] = largest_sizes;
    fn are_near[][](bodies: &PreciseBodies) -> bool = sizes_are_near;
}

/// The largest finite mass, coordinate and component of a velocity.
#[inline(always)]
fn largest_sizes<V: Vector8>(bodies: &PreciseBodies) -> [f64; 3] {
    let largest = largest_in_lanes::<V>(bodies);
    let mut result = [0.0; 3];
    for kind in 0..3 {
        for size in largest[kind].store().0 {
            result[kind] = if size > result[kind] { size } else { result[kind] };
        }
    }
    result
}

/// Whether the largest of each kind are known to be near one, none of them zero.
#[inline(always)]
fn sizes_are_near<V: Vector8>(bodies: &PreciseBodies) -> bool {
    let largest = largest_in_lanes::<V>(bodies);
    let mut near = true;
    for kind in 0..3 {
        near &= is_near(largest[kind]);
    }
    near
}

/// Whether the largest of some sizes is known to be near one.
#[inline(always)]
fn is_near<V: Vector8>(largest: V) -> bool {
    largest.less(V::splat(MOST)).all() && V::splat(LEAST).less_equal(largest).any()
}

#[inline(always)]
fn largest_in_lanes<V: Vector8>(bodies: &PreciseBodies) -> [V; 3] {
    let mut largest = [V::zero(); 3];
    for body in (0..bodies.len).step_by(WIDTH) {
        larger(&mut largest[0], bodies.masses_from(body));
        for c in 0..3 {
            larger(&mut largest[1], bodies.coordinates_from(Of::Position, c, body).high);
            larger(&mut largest[2], bodies.coordinates_from(Of::Velocity, c, body).high);
        }
    }
    largest
}

#[inline(always)]
fn larger<V: Vector8>(largest: &mut V, value: V) {
    let size = value.abs();
    // Neither infinities nor what is not a number.
    let finite = V::select(size.less_equal(V::splat(f64::MAX)), size, V::zero());
    *largest = largest.max(finite);
}

#[inline(always)]
fn set_eight<V: Vector8>(values: &mut [f64], from: usize, numbers: V) {
    if let Some(eight) = values[from..].first_chunk_mut() {
        *eight = numbers.store().0;
    }
}

#[inline(always)]
fn eight<V: Vector8>(values: &[f64], from: usize) -> V {
    match values[from..].first_chunk() {
        Some(&numbers) => V::load(Lanes(numbers)),
        None => V::zero(),
    }
}

/// What the lanes of a running sum come to, in the order of the lanes.
#[inline]
pub fn joined(sum: FusedDouble<Lanes>) -> DoubleDouble {
    let mut total = FusedDouble::zero();
    for lane in 0..WIDTH {
        total.gather(FusedDouble { high: sum.high.0[lane], low: sum.low.0[lane] });
    }
    DoubleDouble::sum(total.high, total.low)
}

#[inline(always)]
fn mass_times_vector<V: Vector8>(bodies: &PreciseBodies, of: Of, weighted: bool) -> [FusedDouble<Lanes>; 3] {
    let mut sum = [FusedDouble::<V>::zero(); 3];
    for body in (0..if weighted { bodies.massive() } else { bodies.len() }).step_by(WIDTH) {
        let mass = mass::<V>(bodies, body);
        for c in 0..3 {
            let value = bodies.coordinates_from::<V>(of, c, body);
            sum[c].gather(if weighted { mass.times(value) } else { value });
        }
    }
    let [x, y, z] = sum;
    [stored(x), stored(y), stored(z)]
}

/// The masses of eight bodies from one on.
#[inline(always)]
pub fn mass<V: Vector8>(bodies: &PreciseBodies, body: usize) -> FusedDouble<V> {
    FusedDouble { high: bodies.masses_from(body), low: V::zero() }
}

/// A running sum, in memory.
#[inline(always)]
pub fn stored<V: Vector8>(sum: FusedDouble<V>) -> FusedDouble<Lanes> {
    FusedDouble { high: sum.high.store(), low: sum.low.store() }
}
