//! When two spheres in straight motion come to touch.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::words::number;
use crate::{Error, Result};

/// By how much (d/R)² - 1 of spheres in contact may be below 0: roundings of the places where they came to touch.
const TOUCH: f64 = 1.0 / (1_u64 << 46) as f64;

/// The time from now at which |r + vt| first is `distance`, or infinity if they miss or part.
///
/// In double-double, so that it is known to the last digits where they nearly miss.
///
/// # Errors
/// `InvalidInput` naming `position1` where the spheres overlap.
pub fn contact_time(positions: [[f64; 3]; 2], velocities: [[f64; 3]; 2], distance: f64) -> Result<f64> {
    let largest = |vectors: &[[f64; 3]; 2]| {
        vectors.as_flattened().iter().fold(0.0_f64, |most, part| most.max(part.abs()))
    };
    // Of order one, so that nothing leaves the range on the way.
    let (far, quick) = (exponent(largest(&positions).max(distance)), exponent(largest(&velocities)));
    let difference = |[a, b]: [[f64; 3]; 2], unit: i32| -> [DoubleDouble; 3] {
        core::array::from_fn(|c| DoubleDouble::sum(scale(a[c], -unit), -scale(b[c], -unit)))
    };
    let dot = |a: [DoubleDouble; 3], b: [DoubleDouble; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (apart, along) = (difference(positions, far), difference(velocities, quick));
    let reach = scale(distance, -far);
    let (squared, gap) = (dot(along, along), dot(apart, apart) - DoubleDouble::product(reach, reach));
    if gap.high() < -TOUCH * reach * reach {
        return Err(Error::invalid(
            "position1",
            format!(
                "expected spheres that do not overlap, but their centers are {} apart and their radii {} together",
                number(scale(dot(apart, apart).sqrt().to_f64(), far)),
                number(distance)
            ),
        ));
    }
    let approach = -dot(apart, along);
    let root = approach * approach - squared * gap;
    if approach.high() <= 0.0 || root.high() < 0.0 {
        return Ok(f64::INFINITY);
    }
    let time = (gap / (approach + root.sqrt())).to_f64().max(0.0);
    Ok(scale(time, far - quick))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(x: f64, b: f64, distance: f64) -> f64 {
        contact_time([[x, b, 0.0], [0.0; 3]], [[-2.0, 0.0, 0.0], [0.0; 3]], distance).unwrap()
    }

    #[test]
    fn spheres_touch_or_miss() {
        assert_eq!((time(5.0, 0.0, 1.0), time(5.0, 3.0, 5.0)), (2.0, 0.5));
        assert_eq!((time(5.0, 1.0, 1.0), time(5.0, 1.000_000_000_000_001, 1.0)), (2.5, f64::INFINITY));
        assert_eq!((time(-5.0, 0.0, 1.0), time(1.0, 0.0, 1.0)), (f64::INFINITY, 0.0));
        assert!(contact_time([[0.5, 0.0, 0.0], [0.0; 3]], [[0.0; 3]; 2], 1.0).is_err());
        assert_eq!(
            contact_time([[5.0, 0.0, 0.0], [0.0; 3]], [[1e-200, 0.0, 0.0]; 2], 1.0),
            Ok(f64::INFINITY)
        );
    }
}
