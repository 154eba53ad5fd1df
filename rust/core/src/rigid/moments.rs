//! What three moments of inertia must be.

use super::quaternion::Matrix;
use crate::error::{Error, Result};
use crate::words::number;

/// What rounding may take from the triangle inequality, relative to the largest moment.
const ROUNDING: f64 = 1e-12;

/// Checks that these are moments of a body: not negative, not all zero, none larger than the other two together.
///
/// # Errors
/// `InvalidInput` that says which, and by how much.
pub fn check(argument: &str, moments: [f64; 3]) -> Result<()> {
    for (at, moment) in moments.iter().enumerate() {
        if !(*moment >= 0.0 && moment.is_finite()) {
            let message =
                format!("expected three moments of at least 0, but {argument}[{at}] is {}", number(*moment));
            return Err(Error::invalid(argument, message));
        }
    }
    let largest = (0..3).fold(0, |most, at| if moments[at] > moments[most] { at } else { most });
    let most = moments[largest];
    if most == 0.0 {
        return Err(Error::invalid(
            argument,
            "expected moments of a body, got zeros: a point has no orientation",
        ));
    }
    let [a, b] = [moments[(largest + 1) % 3], moments[(largest + 2) % 3]];
    let excess = (most - a.max(b)) - a.min(b);
    if excess > ROUNDING * most {
        let message = format!(
            "expected moments of which none is larger than the other two together, as those of any body, but \
             {argument}[{largest}] = {} is larger by {}",
            number(most),
            number(excess)
        );
        return Err(Error::invalid(argument, message));
    }
    Ok(())
}

/// The axes of a motion among those of the body: which, and with which sign.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The body's axis that each axis is along.
    pub axes: [usize; 3],
    /// 1 or −1.
    pub signs: [f64; 3],
}

impl Frame {
    /// Right-handed, with the signs of the first and the last axis as given.
    pub fn new(axes: [usize; 3], first: f64, last: f64) -> Self {
        let even = (axes[1] + 3 - axes[0]) % 3 == 1;
        let parity = if even { 1.0 } else { -1.0 };
        Self { axes, signs: [first, parity * first * last, last] }
    }
    /// The rotation that takes the body's vectors to these axes.
    pub fn matrix(self) -> Matrix {
        let mut rows = [[0.0; 3]; 3];
        for at in 0..3 {
            rows[at][self.axes[at]] = self.signs[at];
        }
        rows
    }
    /// A vector along these axes, as the body has it.
    #[inline]
    pub fn in_body(self, v: [f64; 3]) -> [f64; 3] {
        let mut result = [0.0; 3];
        for at in 0..3 {
            result[self.axes[at]] = self.signs[at] * v[at];
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::quaternion::{cross, dot};

    #[test]
    fn what_is_no_body_is_refused() {
        for good in [[1.0, 2.0, 3.0], [0.1, 0.2, 0.3], [0.0, 2.0, 2.0], [1e-300, 1e-300, 1e-300], [1e300; 3]]
        {
            assert!(check("moments", good).is_ok(), "{good:?}");
        }
        for bad in [[1.0, 1.0, 2.1], [0.0; 3], [-1.0, 1.0, 1.0], [f64::NAN, 1.0, 1.0], [0.0, 1.0, 2.0]] {
            assert!(check("moments", bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn frames_are_right_handed() {
        for axes in [[0, 1, 2], [1, 2, 0], [2, 1, 0], [1, 0, 2], [0, 2, 1], [2, 0, 1]] {
            for (first, last) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                let rows = Frame::new(axes, first, last).matrix();
                assert_eq!(dot(rows[0], cross(rows[1], rows[2])), 1.0);
            }
        }
    }
}
