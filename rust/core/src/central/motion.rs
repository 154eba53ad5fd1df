//! The motion in one range: its period, its angle, and where it is at any time.
//!
//! The logarithm of r is taken for the variable, in which powers are entire, and the roots of the radial kinetic energy K
//! are divided out of it in double-double: between two turning points x₁, x₂ by x = x₁ + (x₂ − x₁) sin²(φ/2), beyond or
//! within one by x = x₁ ± y². What is left to integrate is smooth at the ends.

use super::landscape::{Landscape, Radial};
use super::quadrature::{Integral, Pair, between, periodic};
use super::range::{End, Range};
use crate::error::{Error, Result};
use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::{self, Exponential};
use crate::numerics::logarithm::ln_1p;
use crate::numerics::power_of_two::scale;
use crate::numerics::scaled::Scaled;
use core::f64::consts::PI;

mod near;
mod places;

pub use places::Place;
use places::{cosines, sines};

/// The variable of a range.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// φ, between two turning points; the width of ln r.
    Between(DoubleDouble, DoubleDouble, DoubleDouble),
    /// y, beyond one …
    Beyond(DoubleDouble),
    /// … or within one.
    Within(DoubleDouble),
    /// ln(r/r₁) where it turns nowhere.
    Open(f64),
}

/// The motion in one range.
#[derive(Debug)]
pub struct Motion<'a> {
    radial: Radial<'a>,
    form: Form,
    range: Range,
    mass: f64,
    length: i32,
    speed: i32,
    /// The nearest place to the center at which V is a number.
    nearest: f64,
    /// √(l²/2m).
    turning: f64,
    /// Cosine series of the rates, where they converge.
    series: Option<[Vec<f64>; 2]>,
    whole: Option<Integral>,
}

/// Times, angles and the errors that are estimated for them.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// Time.
    pub time: f64,
    /// Angle about the center.
    pub angle: f64,
    /// The error of the time that is left.
    pub time_error: f64,
    /// The error of the angle that is left.
    pub angle_error: f64,
}

/// Samples of a period at most before panels take over.
const SAMPLES: usize = 2048;
/// Relative errors of integrals, if they can be had.
const TOLERANCE: f64 = 1e-13;
/// The rest of a logarithmic variable that is looked at.
const FAR: f64 = 200.0;

impl<'a> Motion<'a> {
    /// In a range of the landscape at that energy.
    pub fn new(
        landscape: &'a Landscape,
        range: Range,
        energy: DoubleDouble,
        mass: f64,
        centrifugal: DoubleDouble,
    ) -> Self {
        let field = landscape.field();
        let (length, unit) = field.units();
        let radial = landscape.radial(energy, centrifugal);
        let take = |r: DoubleDouble| DoubleDouble::new(scale(r.high(), -length), scale(r.low(), -length));
        let form = match (range.inner.smooth().map(take), range.outer.smooth().map(take)) {
            (Some(a), Some(b)) => {
                let share = (b - a) / a;
                Form::Between(a, b, ln_1p(Scaled::new(share, 0)).to_double_double())
            }
            (Some(a), None) => Form::Beyond(a),
            (None, Some(b)) => Form::Within(b),
            (None, None) => {
                let start = match (range.inner, range.outer) {
                    (End::Turn(_) | End::Edge(_), _) => range.inner.radius(),
                    (_, End::Turn(_) | End::Edge(_)) => range.outer.radius(),
                    _ => field.give_length(1.0),
                };
                Form::Open(field.take_length(start))
            }
        };
        let turning = radial.centrifugal.high().sqrt();
        let mut motion = Self {
            radial,
            form,
            range,
            mass,
            length,
            speed: unit / 2,
            nearest: landscape.nearest(),
            turning,
            series: None,
            whole: None,
        };
        if matches!(form, Form::Between(..)) && !range.circle {
            motion.survey();
        }
        motion
    }

    /// A period's samples and its whole.
    fn survey(&mut self) {
        if self.breaks(0.0, PI).is_empty()
            && let Some((whole, samples)) = periodic(&|p| self.rates(p), TOLERANCE, SAMPLES)
        {
            self.whole = Some(whole);
            self.series = Some([cosines(&samples, 0), cosines(&samples, 1)]);
            return;
        }
        self.whole = self.integral(0.0, PI);
    }

    /// The distance at a value of the variable, to about thirty digits.
    fn radius(&self, p: f64) -> DoubleDouble {
        let grown = |from: DoubleDouble, by: DoubleDouble| from * Exponential::exp(by);
        match self.form {
            Form::Between(a, b, width) => {
                let (sine, cosine) = sin_cos(0.5 * p);
                if sine.abs() < cosine.abs() {
                    grown(a, width * DoubleDouble::from(sine * sine))
                } else {
                    grown(b, -width * DoubleDouble::from(cosine * cosine))
                }
            }
            Form::Beyond(a) => grown(a, DoubleDouble::product(p, p)),
            Form::Within(b) => grown(b, -DoubleDouble::product(p, p)),
            Form::Open(start) => grown(DoubleDouble::from(start), DoubleDouble::from(p)),
        }
    }

    /// K over what goes to zero at the turning points, at a distance.
    fn smooth(&self, p: f64, r: DoubleDouble) -> f64 {
        let (kinetic, slope) = self.radial.kinetic(r);
        let inner = |r: DoubleDouble| (slope * r).high();
        match self.form {
            Form::Between(a, b, width) => {
                let (sine, cosine) = sin_cos(0.5 * p);
                let width = width.high();
                // There the sine or the cosine is rounding, and so is the distance from the end.
                if sine.abs() < AT_THE_END {
                    inner(a) / width
                } else if cosine.abs() < AT_THE_END {
                    -inner(b) / width
                } else {
                    let within = width * sine * cosine;
                    kinetic.high() / (within * within)
                }
            }
            Form::Beyond(a) if p == 0.0 => inner(a),
            Form::Within(b) if p == 0.0 => -inner(b),
            Form::Beyond(_) | Form::Within(_) => kinetic.high() / (p * p),
            Form::Open(_) => kinetic.high(),
        }
    }

    /// What time and angle change by with the variable, in the field's units and without √(m/2).
    fn rates(&self, p: f64) -> Pair {
        let r = self.radius(p);
        let root = self.smooth(p, r).sqrt();
        let jacobian = if matches!(self.form, Form::Beyond(_) | Form::Within(_)) { 2.0 } else { 1.0 };
        let time = jacobian * r.high() / root;
        [time, if self.turning == 0.0 { 0.0 } else { self.turning * time / r.high() / r.high() }]
    }

    /// The variable, above zero, at a distance.
    fn variable(&self, r: f64) -> f64 {
        let logarithm = |from: DoubleDouble| {
            let share = (DoubleDouble::from(r) - from) / from;
            let near = share.high().abs() < 0.5;
            if near {
                ln_1p(Scaled::new(share, 0)).to_f64()
            } else {
                elementary::ln(r / from.high()).clamp(-FAR, FAR)
            }
        };
        match self.form {
            Form::Between(a, b, width) => {
                let (low, high) = (logarithm(a).max(0.0), (-logarithm(b)).max(0.0));
                let width = width.high();
                2.0 * atan2((low / width).sqrt(), (high / width).sqrt())
            }
            Form::Beyond(a) => logarithm(a).max(0.0).sqrt(),
            Form::Within(b) => (-logarithm(b)).max(0.0).sqrt(),
            Form::Open(start) => elementary::ln(r / start).clamp(-FAR, FAR),
        }
    }

    /// Where derivatives of V jump between two values of the variable.
    fn breaks(&self, from: f64, to: f64) -> Vec<f64> {
        let mut places: Vec<f64> = self.radial.field.breaks().into_iter().map(|r| self.variable(r)).collect();
        places.retain(|p| *p > from && *p < to);
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    fn integral(&self, from: f64, to: f64) -> Option<Integral> {
        let inside = self.breaks(from, to);
        let places: Vec<f64> = [from].into_iter().chain(inside).chain([to]).collect();
        between(&|p| self.rates(p), &places, TOLERANCE)
    }

    fn passage(&self, integral: Integral) -> Passage {
        let unit = |x: f64| scale((0.5 * self.mass).sqrt() * x, self.length - self.speed);
        Passage {
            time: unit(integral.value[0]),
            angle: integral.value[1],
            time_error: unit(integral.error[0]),
            angle_error: integral.error[1],
        }
    }

    /// Whether its variable counts from a pericenter.
    pub fn counts_from_pericenter(&self) -> bool {
        matches!(self.form, Form::Between(..) | Form::Beyond(_))
    }
    /// From the pericenter to the apocenter, where V jumps at neither.
    ///
    /// # Errors
    /// Where no estimate of the error comes below the tolerance.
    pub fn half_period(&self) -> Result<Passage> {
        if !matches!(self.form, Form::Between(..)) {
            return self.to_the_end();
        }
        self.whole.map(|whole| self.passage(whole)).ok_or_else(refused)
    }

    /// Between two distances in the range, without a turn between.
    ///
    /// # Errors
    /// As [`half_period`](Self::half_period).
    pub fn between(&self, from: f64, to: f64) -> Result<Passage> {
        let [from, to] = [from, to].map(|r| scale(r, -self.length));
        if from == to {
            return Ok(self.passage(Integral::default()));
        }
        let integral = if self.are_near(from.min(to), from.max(to)) {
            self.near_integral(from.min(to), from.max(to))
        } else {
            let (a, b) = (self.variable(from), self.variable(to));
            self.integral(a.min(b), a.max(b))
        };
        integral.map(|integral| self.passage(integral)).ok_or_else(refused)
    }

    /// The variable at both ends of the range, as far as numbers go.
    fn reach(&self) -> (f64, f64) {
        let place = |r: f64| self.variable(scale(r, -self.length));
        let inner = match self.range.inner {
            End::Center => self.variable(self.nearest),
            end => place(end.radius()),
        };
        let outer = match (self.range.outer, self.form) {
            (End::Infinity, Form::Open(_)) => FAR,
            (End::Infinity, _) => FAR.sqrt(),
            (end, _) => place(end.radius()),
        };
        match self.form {
            Form::Between(..) => (0.0, PI),
            Form::Beyond(_) => (0.0, outer),
            Form::Within(_) => (0.0, inner),
            Form::Open(_) => (inner, outer),
        }
    }

    /// From one end of the range to the other; what has no end is infinite.
    ///
    /// # Errors
    /// As [`half_period`](Self::half_period).
    pub fn to_the_end(&self) -> Result<Passage> {
        let (from, to) = self.reach();
        let integral = self.integral(from, to).ok_or_else(refused)?;
        let mut passage = self.passage(integral);
        // Of a range that ends, both ends are places.
        let open = [self.range.inner, self.range.outer].map(|end| matches!(end, End::Center | End::Infinity));
        if !open[0] && !open[1] {
            return Ok(passage);
        }
        // What does not come to an end before the last place has none.
        let last = self.rates(if matches!(self.form, Form::Open(_)) && open[0] { from } else { to });
        let ends = |at: usize| last[at] <= TOLERANCE * integral.value[at];
        if !ends(0) {
            (passage.time, passage.time_error) = (f64::INFINITY, 0.0);
        }
        if !ends(1) {
            (passage.angle, passage.angle_error) = (f64::INFINITY, 0.0);
        }
        Ok(passage)
    }

    /// The signed variable of a state: r, and dr/dt in the caller's units.
    pub fn start(&self, r: f64, radial_velocity: f64) -> f64 {
        let p = self.variable(scale(r, -self.length));
        let speed = scale(radial_velocity, -self.speed) * (0.5 * self.mass).sqrt();
        let root = self.smooth(p, self.radius(p)).sqrt();
        match self.form {
            Form::Between(_, _, width) => {
                // Near a turning point the velocity says where, elsewhere the distance does.
                let (sine, cosine) = sin_cos(p);
                let by_velocity = 2.0 * speed / (width.high() * root);
                if cosine.abs() > 0.7 {
                    atan2(by_velocity, cosine)
                } else {
                    atan2(sine.copysign(speed), cosine)
                }
            }
            Form::Beyond(_) if p < 0.5 => speed / root,
            Form::Within(_) if p < 0.5 => -speed / root,
            Form::Beyond(_) => p.copysign(speed),
            Form::Within(_) => p.copysign(-speed),
            Form::Open(_) => p,
        }
    }

    /// Time and angle from the turning point to a value of the variable, of its sign, within a period.
    fn since(&self, p: f64) -> Result<Pair> {
        if let Some([time, angle]) = &self.series {
            return Ok([sines(time, p), sines(angle, p)]);
        }
        let size = p.abs();
        let (turns, rest) = match self.form {
            Form::Between(..) => ((size / PI).floor(), size.rem_euclid(PI)),
            _ => (0.0, size),
        };
        let mut sum = [0.0; 2];
        if turns > 0.0 {
            let whole = self.whole.ok_or_else(refused)?;
            sum = whole.value.map(|x| turns * x);
        }
        if rest > 0.0 {
            let odd = turns % 2.0 != 0.0;
            let (from, to) = if odd { (PI - rest, PI) } else { (0.0, rest) };
            let part = self.integral(from, to).ok_or_else(refused)?;
            sum = [sum[0] + part.value[0], sum[1] + part.value[1]];
        }
        Ok(sum.map(|x| x.copysign(p)))
    }

    /// Time and angle since the turning point from which the variable counts.
    ///
    /// # Errors
    /// As [`half_period`](Self::half_period).
    pub fn since_turn(&self, start: f64) -> Result<(f64, f64)> {
        let [time, angle] = self.since(start)?;
        Ok((scale((0.5 * self.mass).sqrt() * time, self.length - self.speed), angle))
    }
}

/// A sine that is zero but for rounding.
const AT_THE_END: f64 = 1e-12;

fn refused() -> Error {
    Error::Convergence {
        message: "the integral over the radial motion does not come to 1e-12: the motion is too near to a barrier's top, or \
                  the potential is not smooth enough"
            .to_owned(),
        time: 0.0,
    }
}
