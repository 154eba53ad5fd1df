//! Bodies at a time, to about twice double precision: what energies and virials are summed from.

use crate::numerics::double_double::DoubleDouble;

/// A body at a time: values and what they leave out.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Mass.
    pub mass: f64,
    /// Position.
    pub position: [DoubleDouble; 3],
    /// Velocity.
    pub velocity: [DoubleDouble; 3],
}

/// a · b.
pub fn dot(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a − b.
pub fn minus(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    core::array::from_fn(|c| a[c] - b[c])
}

/// The numbers as double-double.
pub fn exact(x: [f64; 3]) -> [DoubleDouble; 3] {
    x.map(DoubleDouble::from)
}

/// The distance of two points, scaled so that it neither overflows nor vanishes for finite ones.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d: [f64; 3] = core::array::from_fn(|c| (a[c] - b[c]).abs());
    let largest = d.into_iter().fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let sum: f64 = d.into_iter().map(|x| (x / largest) * (x / largest)).sum();
    largest * sum.sqrt()
}
