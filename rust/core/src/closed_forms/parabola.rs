//! Uniform acceleration of one particle, which may be none.

use super::{ExactState, Path, unrounded};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::exponent;
use crate::numerics::scaled::Scaled;

/// Powers of two within which no term x, v t or a t²/2 leaves the range, nor what it rounds away.
const MODERATE: i32 = 300;

/// x + v t + a t²/2.
pub(super) struct Parabola {
    position: [f64; 3],
    velocity: [f64; 3],
    acceleration: [Scaled; 3],
    /// The acceleration as it is, if all sizes are moderate.
    moderate: Option<[DoubleDouble; 3]>,
}

impl Parabola {
    pub(super) fn new(position: [f64; 3], velocity: [f64; 3], acceleration: [Scaled; 3]) -> Self {
        let numbers = position.iter().chain(&velocity).copied().chain(acceleration.map(Scaled::to_f64));
        let moderate = numbers.map(exponent).all(|size| size.abs() < MODERATE)
            && acceleration.iter().all(|a| a.to_f64().is_finite());
        let moderate = moderate.then(|| acceleration.map(Scaled::to_double_double));
        Self { position, velocity, acceleration, moderate }
    }

    pub(super) fn line(position: [f64; 3], velocity: [f64; 3]) -> Self {
        Self::new(position, velocity, [Scaled::ZERO; 3])
    }
}

impl Path for Parabola {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let near = self.moderate.as_ref().filter(|_| exponent(elapsed.to_f64()).abs() < MODERATE);
        let states: [_; 3] = if let Some(acceleration) = near {
            core::array::from_fn(|c| {
                let (x, v) = (DoubleDouble::from(self.position[c]), DoubleDouble::from(self.velocity[c]));
                let gained = acceleration[c] * elapsed;
                (x + elapsed * (v + gained.scale(0.5)), v + gained)
            })
        } else {
            let t = Scaled::new(elapsed, 0);
            core::array::from_fn(|c| {
                let (x, v) = (Scaled::from(self.position[c]), Scaled::from(self.velocity[c]));
                let a = self.acceleration[c];
                let mean = v.plus(a.by(t).times(0.5));
                (unrounded(x.plus(mean.by(t))), unrounded(v.plus(a.by(t))))
            })
        };
        (states.map(|state| state.0), states.map(|state| state.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(x: f64, v: f64, a: f64, t: f64) -> (f64, f64) {
        let motion = Parabola::new([x; 3], [v; 3], [Scaled::from(a); 3]);
        let (position, velocity) = motion.state(DoubleDouble::from(t));
        (position[0].to_f64(), velocity[0].to_f64())
    }

    #[test]
    fn what_is_a_number_comes_out_as_one_and_the_rest_as_infinite() {
        // Splitting a factor above 2^996 for an exact product overflows: these were NaN.
        assert_eq!(one(0.0, 1e-5, 0.0, 1e302), (1e-5 * 1e302, 1e-5));
        assert_eq!(one(1e308, -1e308, 0.0, 1.0), (0.0, -1e308));
        assert_eq!(one(0.0, 0.0, 2e-300, 1e302).1, 2e-300 * 1e302);
        assert_eq!(one(-1e308, 1e306, 0.0, 200.0), (1e308, 1e306));
        assert_eq!(one(0.0, 1e300, 0.0, -1e300), (f64::NEG_INFINITY, 1e300));
        assert_eq!(one(1.0, 1e300, -1e300, 1e300), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        // v t and a t²/2 are beyond the range, and their sum is zero.
        let [t, v, a] = [400, 800, 401].map(|exponent| 2.0_f64.powi(exponent));
        assert_eq!(one(3.0, v, -a, t), (3.0, -v));
        // The least numbers there are.
        assert_eq!(one(5e-324, 5e-324, 0.0, 3.0), (2e-323, 5e-324));
        assert_eq!(one(0.0, 5e-324, 0.0, 1e308), (5e-324 * 1e308, 5e-324));
    }
}
