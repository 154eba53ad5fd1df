//! How long the steps of a collocation method are.
//!
//! The one idea: δ, how far the polynomial of a step leads astray in the next one, goes with the ninth power of the step (of
//! order 16) while the error goes with the seventeenth, so a δ far above the tolerance means a step as good as exact. Where
//! energy is conserved, the step that the first few agree on is held, since equal steps are what keeps energies; it is given
//! up where δ leaves a wide band. One trajectory alone and each of eight side by side have a pace of their own.

use super::super::ahead_of_forces::{FREE, LONGEST_FREE};
use super::Table;
use super::ending::Ending;
use crate::numerics::elementary::{self, Exponential};
use crate::numerics::lanes::WIDTH;
use crate::numerics::real::Real;
use crate::ode::system::Form;

/// A step of order 16, as good as exact, is taken again when δ is this many times what it should be, …
const BAND: f64 = 30.0;
/// … one of a lower order, where it is what belongs to the tolerance, …
const BAND_OF_FEW: f64 = 4.0;
/// … or this: as much as that is only what stages have not followed.
const NOT_FOLLOWED: f64 = 0.2;
/// What δ is to be at most.
const FOLLOWED: f64 = 0.1;
/// What is left of a δ a step later.
const LATELY: f64 = 0.8;
/// A step that is longer than what resolves the fastest motion by no more than this is taken.
const HARDLY_RESOLVING: f64 = 0.9;
/// Steps get much shorter by a δ so many times as large as it should be.
const MUCH_SHORTER: f64 = 4.0;
/// A step may err by so many tolerances, as its polynomial tells, which is far more than it does where motions are smooth.
const ERRING: f64 = 10.0;
/// Steps change where they would change by more than from here …
const SHORTER: f64 = 0.85;
/// … to here.
const LONGER: f64 = 1.2;
/// The most that a step is multiplied with, while steps grow at the start.
const FAST: f64 = 4.0;
/// Steps after which one is held, where energy is conserved.
const STEPS_BEFORE_HOLDING: u64 = 10;
/// The first step, as a fraction of the time in which numbers change by as much as they are.
const FIRST: f64 = 0.05;

/// What is left of a size a step later: a motion that stops at its turning points is no slow one.
pub(super) const FADING: f64 = 0.95;

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// All alike.
    Equal(f64),
    /// So that δ is about this; held after the first ones, or not.
    Chosen {
        /// The relative tolerance.
        tolerance: f64,
        /// What δ is to be.
        delta: f64,
        /// And how many times as much at most.
        band: f64,
        /// Whether a step is held.
        held: bool,
    },
}

/// Where the steps of a trajectory stand.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// Steps that were kept.
    pub(super) kept: u64,
    /// δ of the step that was tried; infinite where its stages did not converge.
    pub(super) delta: f64,
    /// Whether they did.
    pub(super) converged: bool,
    /// By how much the rates at its end are not what the stages lead to.
    pub(super) missed: f64,
    /// By how much it errs, as its polynomial tells.
    pub(super) error: f64,
    /// By how much it changed velocities, as a part of them.
    pub(super) felt: f64,
    /// The longest step that feels nothing.
    pub(super) longest_free: f64,
    /// Whether noise of rates was found in a step that was in trouble.
    pub(super) noisy: bool,
    /// The part of the step that resolves the fastest motion of all, if nothing but that tells.
    pub(super) resolving: Option<f64>,
    /// δ of the steps before it that were kept, the older the less.
    lately: f64,
    /// Whether steps have come to a length that the motion tells, and whether that has been held.
    grown: bool,
    held: bool,
    /// Whether steps are held.
    holding: bool,
}

impl Steps {
    /// The part of a step that resolves the fastest motion of all, of which so much was left of a change of stages, if that is to
    /// tell; what is left where one is resolved hangs on the tolerance.
    pub(super) fn resolving(self, left: Option<f64>, of: impl Fn(f64) -> (f64, Form)) -> Option<f64> {
        let Self::Chosen { tolerance, .. } = self else { return None };
        let left = left.filter(|left| *left > 0.0)?;
        let (resolving, form) = of(tolerance);
        let part = resolving / left;
        // Of the second order it goes with the square of the step.
        Some(if matches!(form, Form::SecondOrder(_)) { part.sqrt() } else { part })
    }
}

impl Pace {
    /// At the beginning of a span.
    pub(super) fn over(span: f64) -> Self {
        Self { longest_free: LONGEST_FREE * span.abs(), ..Self::default() }
    }

    /// Whether the step that was tried is taken again.
    pub(super) fn refuses(&self, steps: Steps, ending: &Ending) -> bool {
        match steps {
            Steps::Equal(_) => !self.converged,
            Steps::Chosen { tolerance, delta, band, .. } => {
                // It passes through zero at times.
                let astray = Real::max(self.delta, Real::max(self.lately, delta / BAND));
                let strays = self.unresolved().is_some() || self.strays(delta, band);
                let errs = self.errs(steps);
                !self.converged || strays || errs || ending.met(self.missed, astray, tolerance)
            }
        }
    }

    /// The part of the step that resolves the fastest motion, if all of it does not.
    fn unresolved(&self) -> Option<f64> {
        self.resolving.filter(|part| *part < HARDLY_RESOLVING)
    }

    /// Whether it is to be asked how much a step misses: of one that δ does not refuse.
    pub(super) fn missable(&self, steps: Steps) -> bool {
        matches!(steps, Steps::Chosen { delta, band, .. } if self.converged && !self.strays(delta, band))
    }

    /// Whether it is to be asked what the polynomial of a step tells: if it leads to other rates at the end.
    pub(super) fn may_err(&self, steps: Steps) -> bool {
        let misses = matches!(steps, Steps::Chosen { tolerance, .. } if self.missed > ERRING * tolerance);
        misses && self.missable(steps)
    }

    /// Whether the step errs by what is not allowed.
    pub(super) fn errs(&self, steps: Steps) -> bool {
        matches!(steps, Steps::Chosen { tolerance, .. } if self.error > ERRING * tolerance)
    }

    /// Whether δ is out of the band.
    fn strays(&self, target: f64, band: f64) -> bool {
        self.delta > Real::min(band * target, NOT_FOLLOWED)
    }

    /// Whether steps after this one are to be much shorter, or it is taken again: more than `most` of δ is no noise.
    pub(super) fn may_be_noise(&self, steps: Steps, most: impl FnOnce() -> f64) -> bool {
        matches!(steps, Steps::Chosen { delta, .. } if self.delta > MUCH_SHORTER * delta && self.delta < most())
    }

    /// Takes δ anew, beside noise, and remembers whether that was most of it.
    pub(super) fn takes_beside_noise(&mut self, delta: f64) {
        self.noisy = delta < 0.5 * self.delta;
        self.delta = delta;
    }

    /// What is left of the sizes of numbers in a step of length `h` after a kept one of length `last`.
    ///
    /// Steps grow where the motion slows down, as behind a pole of the coordinates, passed closely, where velocities go as the
    /// inverse square of the time since: what is measured by those there has no digits left a few steps later.
    pub(super) fn fading(&self, last: f64, h: f64) -> f64 {
        let grown = (last / h).abs();
        if self.kept > 0 && grown < 1.0 { FADING * grown * grown * grown } else { FADING }
    }

    /// What the next step is multiplied with to bring δ to what it should be.
    fn factor(&self, target: f64, table: &Table) -> f64 {
        if self.delta <= 0.0 {
            return f64::INFINITY;
        }
        let order = (table.stages + 1) as f64;
        Exponential::exp(elementary::ln(target / self.delta) / order)
    }

    /// The next step after one of length `h` that is kept.
    pub(super) fn after(&mut self, h: f64, (steps, longest): (Steps, f64), table: &Table) -> f64 {
        let Steps::Chosen { delta: target, band, held, .. } = steps else { return h };
        self.lately = Real::max(self.delta, LATELY * self.lately);
        self.holding &= !self.strays(target, band);
        if self.holding {
            return h;
        }
        let factor = self.factor(target, table);
        let fast = if self.kept < 4 || !self.grown { FAST } else { 1.5 };
        let next = if (SHORTER..=LONGER).contains(&factor) {
            h
        } else {
            h * Real::min(Real::max(factor, 0.3), fast)
        };
        let longest = self.resolving.map_or(longest, |part| Real::min(longest, (h * part).abs()));
        let longest = if self.felt < FREE { Real::min(longest, self.longest_free) } else { longest };
        // A number that is next to nothing makes first steps that are nothing beside the motion, and none that is held.
        self.grown |= factor <= LONGER || next.abs() > longest;
        if self.grown && !self.held && self.kept >= STEPS_BEFORE_HOLDING {
            self.held = true;
            self.holding = held;
        }
        if next.abs() > longest { longest.copysign(next) } else { next }
    }

    /// The step to be tried in the place of one of length `h` that has seen no more than this part of its way.
    pub(super) fn after_unseen(&mut self, h: f64, seen: f64) -> f64 {
        self.holding = false;
        h * seen
    }

    /// The step to be tried in the place of one of length `h` that is not kept.
    pub(super) fn instead_of(&mut self, h: f64, steps: Steps, table: &Table) -> f64 {
        self.holding = false;
        match steps {
            Steps::Chosen { delta, band, .. } if self.converged && self.strays(delta, band) => {
                h * Real::max(self.factor(delta, table), 0.2)
            }
            Steps::Chosen { .. } if self.converged => {
                h * self.unresolved().map_or(0.4, |part| Real::max(part, 0.2))
            }
            _ => h * 0.4,
        }
    }
}

/// The first step over a span, of a state and its rates (its accelerations, of the second order).
pub(super) fn first_step(
    form: Form,
    (y, rate): (impl Fn(usize) -> f64, impl Fn(usize) -> f64),
    (span, longest): (f64, f64),
) -> f64 {
    let evaluated = form.evaluated();
    let mut least = f64::INFINITY;
    for i in 0..evaluated {
        let rate = rate(i).abs();
        let time = match form {
            Form::FirstOrder(_) => y(i).abs() / rate,
            // Of a motion from rest and of one under way.
            Form::SecondOrder(_) => {
                let (rest, way) = ((y(i).abs() / rate).sqrt(), y(evaluated + i).abs() / rate);
                if rest > way { rest } else { way }
            }
        };
        if time > 0.0 && time < least {
            least = time;
        }
    }
    let first = Real::min(Real::min(FIRST * least, LONGEST_FREE * span.abs()), longest);
    (if first > 0.0 { first } else { Real::min(1e-3, span.abs()) }).copysign(span)
}

fn factorial(n: usize) -> f64 {
    (1..=n).fold(1.0, |product, k| product * k as f64)
}

impl Table {
    /// What δ is to be for a relative tolerance of a step, and how many times as much it may be.
    ///
    /// Of order 16 it goes with the root of the tolerance, and steps are as good as exact long before. Of the others a unit
    /// oscillation tells: a turn by x errs by C x²ˢ⁺¹, the error of the diagonal Padé approximation of the exponential function
    /// (E. Hairer & G. Wanner, *Solving Ordinary Differential Equations II*, theorem IV.3.11), and leads D xˢ⁺¹ astray.
    pub(super) fn delta(&self, rtol: f64) -> (f64, f64) {
        if self.stages == WIDTH {
            return ((100.0 * rtol.sqrt()).clamp(1e-5, 3e-2), BAND);
        }
        let s = self.stages as f64;
        let (once, error) = (factorial(self.stages), self.error_of_a_turn());
        let farthest = 1.0 + self.c.0[self.stages - 1];
        let astray = self.c.0[..self.stages].iter().fold(1.0 / once, |product, c| product * (farthest - c));
        let turn = Exponential::exp(elementary::ln(rtol / error) * ((s + 1.0) / (2.0 * s + 1.0)));
        // By more than a radian no step is to turn.
        let most = Real::min(if turn < 1.0 { astray * turn } else { astray }, FOLLOWED);
        (most / BAND_OF_FEW, BAND_OF_FEW)
    }

    /// C, as above.
    pub(super) fn error_of_a_turn(&self) -> f64 {
        let once = factorial(self.stages);
        once * once / (factorial(2 * self.stages) * factorial(2 * self.stages + 1))
    }

    /// The leading term of the polynomial through the stages, at the farthest stage of a next step.
    pub(super) fn leading(&self, rates: impl Fn(usize) -> f64) -> f64 {
        let leading: f64 = (0..self.stages).map(|k| self.weights.0[k] * rates(k)).sum();
        let farthest = 1.0 + self.c.0[self.stages - 1];
        let product: f64 = (0..self.stages - 1).map(|k| farthest - self.c.0[k]).product();
        (leading * product).abs()
    }
}
