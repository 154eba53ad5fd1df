//! A rigid body that nothing turns: angular velocity and orientation at any time, without a step.
//!
//! The one idea: of the body's angular momentum, the component along the axis that it keeps going round is `dn`, the
//! other two are `cn` and `sn`, and the orientation is two theta functions (see `theta.rs`). Amplitudes, rates and
//! periods are found once, in double-double and beside powers of two, from sums of terms of one sign: the one
//! difference there is, q Lz² − p Lx², tells on which side of the separatrix the motion is, and is the complementary
//! modulus itself. So nothing is lost near the separatrix, on it, or where moments agree.
//! Sources: Landau & Lifshitz, *Mechanics* § 37; Jacobi, J. reine angew. Math. 39 (1850) 293; van Zon & Schofield,
//! J. Comput. Phys. 225 (2007) 145; Celledoni et al., SIAM J. Sci. Comput. 30 (2008) 2084, whose signs are not used.

mod constants;
mod theta;

use super::moments::{Frame, check};
use super::quaternion::{Quaternion, conjugate, from_matrix, product, unit};
use crate::error::{Error, Result};
use crate::numerics::angles::sin_cos;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::scale;
use crate::words::number;
use core::f64::consts::PI;
use theta::{Complex, Hyperbolic, Jacobi, Trigonometric};

/// What kind of motion it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The angular velocity stays what it is.
    Steady,
    /// It goes round the axis of a symmetric body.
    Symmetric,
    /// It goes round the axis of the smallest moment.
    AboutSmallest,
    /// It goes round the axis of the largest moment.
    AboutLargest,
    /// It comes ever nearer to the axis between.
    Separatrix,
}

impl Kind {
    /// Its name, as Python has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steady => "steady",
            Self::Symmetric => "symmetric",
            Self::AboutSmallest => "about_smallest",
            Self::AboutLargest => "about_largest",
            Self::Separatrix => "separatrix",
        }
    }
}

/// The series in force.
#[derive(Clone, Copy, Debug)]
enum Series {
    Steady,
    /// The angle of a whole half period is π.
    Trigonometric(Trigonometric),
    /// And here the hyperbolic one.
    Hyperbolic {
        series: Hyperbolic,
        half_period: f64,
    },
    /// There is no period: the angle itself grows.
    Separatrix(Hyperbolic),
}

/// The motion of one body.
#[derive(Clone, Copy, Debug)]
pub struct FreeRotation {
    kind: Kind,
    frame: Frame,
    series: Series,
    /// Largest angular velocities and momenta along the axes of `frame`.
    angular_velocity: [f64; 3],
    angular_momentum: [f64; 3],
    /// The angular velocity that stays, if it does.
    steady: [f64; 3],
    /// Times are multiplied by this power of two.
    time_exponent: i32,
    /// Half periods per unit of time (on the separatrix the argument itself), and at the start.
    half_periods: DoubleDouble,
    start: DoubleDouble,
    /// Turns of the common phase per unit of time, and per half period.
    turns: DoubleDouble,
    turns_per_half_period: DoubleDouble,
    /// 1 about the axis of the largest moment, −1 about that of the smallest.
    sense: f64,
    before: Quaternion,
    after: Quaternion,
    /// See [`Polhode`].
    polhode: Polhode,
}

/// What can be said of the motion as a whole; rates and times in the units of the angular velocity given.
#[derive(Clone, Copy, Debug)]
pub struct Polhode {
    /// The axis that the angular momentum goes round, and the one between (of a steady motion, all in the order given).
    pub axes: [usize; 3],
    /// Rate of the argument of the elliptic functions.
    pub rate: f64,
    /// Their modulus k, and k'.
    pub modulus: f64,
    /// √(1 − k²), to its last digits.
    pub complement: f64,
    /// The time after which the angular velocity is the same again.
    pub period: f64,
    /// The mean rate at which the body's axis goes round the angular momentum.
    pub precession: f64,
    /// Largest angular momentum along each axis of the body, signed where it never changes sign.
    pub largest: [f64; 3],
}

/// The angular velocity in the body and the orientation, from the body to space.
#[derive(Clone, Copy, Debug)]
pub struct State {
    /// Along the body's axes.
    pub angular_velocity: [f64; 3],
    /// Along the body's axes.
    pub angular_momentum: [f64; 3],
    /// (x, y, z, w).
    pub orientation: Quaternion,
}

impl FreeRotation {
    /// Of a body with these principal moments, from an angular velocity in the body and an orientation at time zero.
    ///
    /// # Errors
    /// `InvalidInput` for moments of no body, a quaternion of no rotation, or a spin that no moment goes with.
    pub fn new(moments: [f64; 3], angular_velocity: [f64; 3], orientation: Quaternion) -> Result<Self> {
        check("moments", moments)?;
        Self::of_any_moments(moments, angular_velocity, unit("orientation", orientation)?)
    }

    /// As `new`, of moments that need not be those of a body.
    fn of_any_moments(
        moments: [f64; 3],
        angular_velocity: [f64; 3],
        orientation: Quaternion,
    ) -> Result<Self> {
        if let Some(at) = (0..3).find(|at| !angular_velocity[*at].is_finite()) {
            let message = format!("expected finite numbers, got {}", number(angular_velocity[at]));
            return Err(Error::invalid("angular_velocity", message));
        }
        if let Some(at) = (0..3).find(|at| moments[*at] == 0.0 && angular_velocity[*at] != 0.0) {
            let message = format!(
                "expected no spin about the axis of a rod, whose moment is 0, but angular_velocity[{at}] is {}",
                number(angular_velocity[at])
            );
            return Err(Error::invalid("angular_velocity", message));
        }
        let mut made = constants::found(moments, angular_velocity);
        if made.angular_momentum.iter().any(|part| !part.is_finite()) {
            let message = "expected an angular momentum within the range of float64; choose other units";
            return Err(Error::invalid("angular_velocity", message));
        }
        if !matches!(made.series, Series::Steady) {
            made.after = from_matrix("frame", made.frame.matrix())?;
            let (_, along) = made.evaluated(0.0);
            made.before = product(orientation, product(conjugate(made.after), conjugate(along)));
        } else {
            made.before = orientation;
        }
        Ok(made)
    }

    /// What kind of motion it is.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// What can be said of the motion as a whole.
    pub fn polhode(&self) -> Polhode {
        self.polhode
    }

    /// Checks that the phase at a time is a number, as it then is at any nearer to the start.
    ///
    /// # Errors
    /// `InvalidInput` where the body turns more often than can be counted.
    pub fn check_time(&self, time: f64) -> Result<()> {
        let scaled = DoubleDouble::from(scale(time, self.time_exponent));
        let halves = self.half_periods * scaled + self.start;
        if halves.is_finite() && (self.turns * scaled + self.turns_per_half_period * halves).is_finite() {
            return Ok(());
        }
        let message = format!("expected a time until which the turns can be counted, got {}", number(time));
        Err(Error::invalid("t", message))
    }

    /// The state at a time, before the start or after.
    pub fn state(&self, time: f64) -> State {
        let (jacobi, along) = self.evaluated(time);
        let Some([sn, cn, dn]) = jacobi else {
            return State {
                angular_velocity: self.steady,
                angular_momentum: self.angular_momentum,
                orientation: product(self.before, along),
            };
        };
        let parts = |most: [f64; 3]| self.frame.in_body([most[0] * cn, most[1] * sn, most[2] * dn]);
        State {
            angular_velocity: parts(self.angular_velocity),
            angular_momentum: parts(self.angular_momentum),
            orientation: product(self.before, product(along, self.after)),
        }
    }

    /// The elliptic functions, and the rotation from the axes of `frame` to those about the angular momentum.
    #[inline]
    fn evaluated(&self, time: f64) -> (Option<Jacobi>, Quaternion) {
        let time = DoubleDouble::from(scale(time, self.time_exponent));
        let argument = self.half_periods * time + self.start;
        let (jacobi, second, first, halves) = match &self.series {
            Series::Steady => {
                let turn = argument - argument.round();
                let (sine, cosine) = sin_cos(PI * turn.high());
                let odd = is_odd(argument.round());
                let (sine, cosine) = if odd { (-sine, -cosine) } else { (sine, cosine) };
                let [x, y, z] = self.steady_axis();
                return (None, [sine * x, sine * y, sine * z, cosine]);
            }
            Series::Trigonometric(series) => {
                let halves = argument.round();
                let part = (argument - halves).high();
                let (sine, cosine) = sin_cos(PI * part);
                let (jacobi, second, first) = series.at(sine, cosine);
                (jacobi, second, first, halves)
            }
            Series::Hyperbolic { series, half_period } => {
                let halves = argument.round();
                let part = (argument - halves).high();
                let twice = 2.0 * part.abs();
                let found = series.at(-half_period * twice, -half_period * (1.0 - twice));
                let (jacobi, second, first) = mirrored(part < 0.0, found);
                (jacobi, second, first, halves)
            }
            Series::Separatrix(series) => {
                let part = argument.high();
                let found = series.at(-part.abs(), f64::NEG_INFINITY);
                let (jacobi, second, first) = mirrored(part < 0.0, found);
                (jacobi, second, first, DoubleDouble::default())
            }
        };
        let [sn, cn, dn] = jacobi;
        let odd = if is_odd(halves) { -1.0 } else { 1.0 };
        let turns = self.turns * time + self.turns_per_half_period * halves;
        let turn = (turns - turns.round()).high();
        let (sine, cosine) = sin_cos(2.0 * PI * turn);
        // About the axis of the largest moment the two theta functions are conjugates of these; β has a factor −i.
        let along = theta::times([cosine, sine], [second[0], -self.sense * second[1]]);
        let across = theta::times([cosine, sine], [-self.sense * first[1] * odd, -first[0] * odd]);
        let square =
            along[0] * along[0] + along[1] * along[1] + across[0] * across[0] + across[1] * across[1];
        let per = 1.0 / square.sqrt();
        (Some([odd * sn, odd * cn, dn]), [across[0] * per, across[1] * per, along[1] * per, along[0] * per])
    }

    fn steady_axis(&self) -> [f64; 3] {
        constants::direction(self.steady)
    }
}

/// sn and the imaginary parts change sign with the argument.
#[inline]
fn mirrored(back: bool, ([sn, cn, dn], a, b): (Jacobi, Complex, Complex)) -> (Jacobi, Complex, Complex) {
    if back { ([-sn, cn, dn], [a[0], -a[1]], [b[0], -b[1]]) } else { ([sn, cn, dn], a, b) }
}

/// Whether an integer is odd.
#[inline]
fn is_odd(n: DoubleDouble) -> bool {
    (n.high() * 0.5).fract() != 0.0 || (n.low() * 0.5).fract() != 0.0
}

#[cfg(test)]
mod tests;
