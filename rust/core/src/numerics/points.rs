//! Points in space, as arrays of three numbers.

/// The distance of two points, scaled so that it neither overflows nor vanishes for finite ones.
#[inline]
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [(a[0] - b[0]).abs(), (a[1] - b[1]).abs(), (a[2] - b[2]).abs()];
    let largest = 0.0_f64.max(x).max(y).max(z);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let [x, y, z] = [x / largest, y / largest, z / largest];
    largest * (x * x + y * y + z * z).sqrt()
}
