//! Oscillators, damped and driven, and what else is linear: harmonic pulls, linear drag, uniform fields and periodic forces.
//!
//! Each coordinate obeys x″ + 2Γx′ + ω²(x − c) = g + Σ A cos(Ωt + φ), whose parts are divided differences of exponentials
//! ([`exponentials`](crate::numerics::exponentials)), one form for under-, over- and critical damping, for a free particle
//! and for a drive in resonance: with the roots μ of μ² + 2Γμ + ω², S = t e[μ₁t, μ₂t] the response to a blow,
//! Q = t² e[0, μ₁t, μ₂t] its integral and P = t² e[iΩt, μ₁t, μ₂t] that to e^{iΩt},
//! x = x₀ + S v₀ + Q a₀ + Σ Re A e^{iφ} P and v = S′ v₀ + S a₀ + Σ Re A e^{iφ} (S + iΩ P), a₀ being the acceleration at
//! the start without the drives. From ωt = 1 on the same about the equilibrium, which what decays reaches without
//! cancellation: x = e + C (x₀ − e) + S v₀, C = S′ + 2Γ S.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 6.5.

use super::{ClosedForm, ExactState, Member, Path, Paths, is_uniform, uniform_part, unrounded};
use crate::forces::ForceTerm;
use crate::numerics::decay::FAR;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::exponentials::{Complex, Point, second, third};
use crate::numerics::scaled::Scaled;

/// Oscillation.
pub static FORM: ClosedForm = ClosedForm {
    name: "oscillation",
    reason: "the only forces are harmonic, linear drag, uniform and periodic ones",
    applies: |member| {
        member.forces.iter().any(|force| oscillates(*force))
            && member
                .forces
                .iter()
                .all(|force| oscillates(*force) || force.as_linear_drag().is_some() || is_uniform(*force))
    },
    motion: |member, _, ticker| Paths::motion(member, ticker, |i| Ok(Oscillator::new(member, i))),
};

/// Whether a force is what other linear forms do not have.
fn oscillates(force: &dyn ForceTerm) -> bool {
    force.as_harmonic().is_some() || force.as_driven().is_some()
}

/// A periodic acceleration.
struct Driving {
    frequency: f64,
    /// e^{iφ} at the start.
    phase: Complex,
    amplitude: [Scaled; 3],
}

struct Oscillator {
    position: [Scaled; 3],
    velocity: [Scaled; 3],
    /// ω.
    frequency: Scaled,
    /// The fast and the slow root, or the two conjugate ones.
    roots: [Complex; 2],
    /// a₀.
    start: [Scaled; 3],
    /// Where nothing pulls, if there is such a place.
    equilibrium: Option<[Scaled; 3]>,
    drives: Vec<Driving>,
}

/// The roots of μ² + 2Γμ + ω².
pub(super) fn roots(half_rate: Scaled, square: Scaled) -> [Complex; 2] {
    let discriminant = half_rate.by(half_rate).minus(square);
    let real = |re: Scaled| Complex::new(re, Scaled::ZERO);
    if discriminant.value().to_f64() < 0.0 {
        let (re, im) = (half_rate.negative(), discriminant.negative().sqrt());
        return [Complex::new(re, im), Complex::new(re, im.negative())];
    }
    // The other by their product, without the cancellation.
    let fast = half_rate.plus(discriminant.sqrt());
    let slow = if fast.is_zero() { Scaled::ZERO } else { square.over(fast) };
    [real(fast.negative()), real(slow.negative())]
}

impl Oscillator {
    fn new(member: &Member<'_>, particle: usize) -> Self {
        let mass = Scaled::from(member.mass[particle]);
        let over_mass = |force: Scaled| force.over(mass);
        let (position, velocity) = (member.position[particle], member.velocity[particle]);
        let uniform = uniform_part(member, particle);
        let (mut rate, mut stiffness) = (Scaled::ZERO, Scaled::ZERO);
        // Σ k c, and the pull at the start.
        let (mut moment, mut pull) = ([Scaled::ZERO; 3], [Scaled::ZERO; 3]);
        let mut drives = Vec::new();
        for force in &member.forces {
            if let Some(tau) = force.as_linear_drag() {
                rate = rate.plus(Scaled::from(1.0).over(Scaled::from(tau)));
            }
            if let Some((k, center)) = force.as_harmonic() {
                stiffness = stiffness.plus(Scaled::from(k));
                for c in 0..3 {
                    let away = Scaled::from(center[c]).plus(Scaled::from(-position[c]));
                    (moment[c], pull[c]) =
                        (moment[c].plus(Scaled::from(center[c]).times(k)), pull[c].plus(away.times(k)));
                }
            }
            if let Some(drive) = force.as_driven() {
                let turned = Scaled::from(drive.frequency).times(member.t0).plus(Scaled::from(drive.phase));
                let phase = Complex::new(Scaled::ZERO, turned).exp();
                let amplitude = drive.amplitude.map(|force| over_mass(Scaled::from(force)));
                drives.push(Driving { frequency: drive.frequency, phase, amplitude });
            }
        }
        let bound = stiffness.value().to_f64() > 0.0;
        // Without a pull there may be no mass to divide by.
        let square = if bound { over_mass(stiffness) } else { Scaled::ZERO };
        let start =
            core::array::from_fn(|c| if bound { uniform[c].plus(over_mass(pull[c])) } else { uniform[c] });
        let rest = |c: usize| moment[c].plus(uniform[c].by(mass)).over(stiffness);
        Self {
            position: position.map(Scaled::from),
            velocity: velocity.map(Scaled::from),
            frequency: square.sqrt(),
            roots: roots(rate.times(0.5), square),
            start,
            equilibrium: bound.then(|| core::array::from_fn(rest)),
            drives,
        }
    }
}

/// What answers a blow.
pub(super) struct Responses {
    /// μ₁t and μ₂t.
    pub(super) points: [Point; 2],
    /// e[μ₁t, μ₂t].
    difference: Complex,
    /// S and S′.
    pub(super) blow: Scaled,
    pub(super) rate: Scaled,
}

impl Responses {
    /// Of an equation with these roots, after a time.
    pub(super) fn new(roots: &[Complex; 2], t: Scaled) -> Self {
        let points = Point::pair(roots.map(|root| root.along(t)));
        let [fast, slow] = &points;
        let difference = second(fast, slow);
        // S′ = e^{fast} + slow S.
        let rate = fast.exponential.plus(slow.at.by(difference)).re;
        Self { points, difference, blow: difference.re.by(t), rate }
    }
}

/// The product, zero whatever the other is if one is: backward, what decays grows beyond measure.
fn share(of: Scaled, factor: Scaled) -> Scaled {
    if of.is_zero() { Scaled::ZERO } else { of.by(factor) }
}

impl Path for Oscillator {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let t = Scaled::new(elapsed, 0);
        let grown = self.roots[0].re.by(t).to_f64() > FAR;
        let infinite = Scaled::from(f64::INFINITY);
        let Responses { points: [fast, slow], difference, mut blow, mut rate } =
            Responses::new(&self.roots, t);
        let settled = self.equilibrium.filter(|_| self.frequency.by(t).to_f64().abs() >= 1.0);
        // C or Q: what multiplies the distance from the equilibrium, or the acceleration at the start.
        let mut other = if settled.is_some() {
            rate.minus(fast.at.re.plus(slow.at.re).by(difference.re))
        } else {
            third(&Point::new(Complex::default()), &fast, &slow).re.by(t).by(t)
        };
        if grown {
            (blow, rate, other) = (infinite, infinite, infinite);
        }
        let mut x: [Scaled; 3] = core::array::from_fn(|c| match settled {
            Some(rest) => {
                let away = self.position[c].minus(rest[c]);
                rest[c].plus(share(away, other)).plus(share(self.velocity[c], blow))
            }
            None => {
                let way = share(self.velocity[c], blow).plus(share(self.start[c], other));
                self.position[c].plus(way)
            }
        });
        let mut v: [Scaled; 3] =
            core::array::from_fn(|c| share(self.velocity[c], rate).plus(share(self.start[c], blow)));
        for drive in &self.drives {
            let frequency = Scaled::from(drive.frequency);
            let point = Point::new(Complex::new(Scaled::ZERO, frequency.by(t)));
            let response = third(&point, &fast, &slow).along(t).along(t);
            // S + iΩ P.
            let speed = Complex::new(blow.minus(response.im.by(frequency)), response.re.by(frequency));
            let (way, speed) = (drive.phase.by(response).re, drive.phase.by(speed).re);
            let (way, speed) = if grown { (infinite, infinite) } else { (way, speed) };
            for c in 0..3 {
                x[c] = x[c].plus(share(drive.amplitude[c], way));
                v[c] = v[c].plus(share(drive.amplitude[c], speed));
            }
        }
        (x.map(unrounded), v.map(unrounded))
    }
}
