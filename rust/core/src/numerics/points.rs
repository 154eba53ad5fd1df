//! Points in space, as arrays of three numbers.

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
