//! What a body does in the laboratory whose speed in the centre-of-mass frame is given.
//!
//! The one idea: its velocities after the collision are a sphere around the velocity V of the frame, of which a
//! plane through the beam cuts a circle of radius w. V + w and V - w are its ends along the beam. V - w alone would
//! cancel, and is brought along by whoever makes the circle; all else follows without a difference of near numbers.

use super::HalfAngle;
use crate::numerics::angles::{atan2, sin_cos};
use core::f64::consts::{FRAC_PI_2, PI};

/// The velocities of a body after the collision, in any unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// V: the speed of the centre-of-mass frame, along the beam.
    pub frame: f64,
    /// w: the body's speed in that frame.
    pub own: f64,
    /// V - w, to full precision: what is left of it where it goes back.
    pub slow: f64,
    /// V + w.
    pub fast: f64,
}

/// The laboratory speeds in one direction, in units of w.
struct Speeds {
    sine: f64,
    cosine: f64,
    /// γ sin θ, γ = V/w.
    reach: f64,
    /// S = √(1 - γ² sin² θ).
    root: f64,
    /// γ cos θ + S.
    fast: f64,
    /// γ cos θ - S = (γ² - 1)/fast.
    slow: f64,
}

impl Circle {
    /// The velocity in the laboratory, along the beam and across it, of a half angle of which sine² + cosine² is 1.
    ///
    /// Without a trigonometric function: for the loops over events.
    #[inline]
    pub fn velocity(self, half: HalfAngle) -> (f64, f64) {
        let (square, complement) = half.squares();
        // (V + w cos ψ) = (V + w) c² + (V - w) s².
        (self.fast * complement + self.slow * square, 2.0 * self.own * (half.sine * half.cosine))
    }
    /// The laboratory angle, in [0, π].
    pub fn lab_angle(self, half: HalfAngle) -> f64 {
        if self.slow == 0.0 {
            return atan2(half.sine, half.cosine); // ψ/2, where the general form is 0/0 head-on
        }
        let (along, across) = self.velocity(half);
        atan2(across, along)
    }
    /// The greatest laboratory angle: asin(w/V), or π where the frame is slower than the body in it.
    pub fn greatest_angle(self) -> f64 {
        if self.slow > 0.0 {
            atan2(self.own, self.fast.sqrt() * self.slow.sqrt())
        } else if self.slow == 0.0 {
            FRAC_PI_2
        } else {
            PI
        }
    }
    /// The jacobian |dΩ/dΩ_lab| of a scattering angle: v³/(w²|w + V cos ψ|), infinite at the greatest angle.
    pub fn jacobian(self, half: HalfAngle) -> f64 {
        if self.own == 0.0 {
            return f64::INFINITY;
        }
        let (fast, slow) = (self.frame / self.own + 1.0, self.slow / self.own);
        let size = half.sine.hypot(half.cosine);
        let (sine, cosine) = (half.sine / size, half.cosine / size);
        if slow == 0.0 {
            return fast * fast * cosine; // 8 c³/2c², which is 0/0 head-on
        }
        let (ahead, back) = (fast * cosine, slow * sine);
        let speed = ahead.hypot(back);
        speed * speed * (speed / (ahead * cosine - back * sine).abs())
    }
    /// The scattering angles that lead to a laboratory angle in [0, π], each with the jacobian |dΩ/dΩ_lab|; the
    /// second exists for V > w only. Both jacobians are infinite at the greatest angle; no branch beyond it.
    pub fn branches(self, lab_angle: f64) -> [Option<(f64, f64)>; 2] {
        let angle = |(along, across, jacobian): (f64, f64, f64)| (atan2(across, along), jacobian);
        self.directions(lab_angle).map(|direction| direction.map(angle))
    }
    /// What the scattering angles of [`branches`](Self::branches) lack of π, with all digits where that is little.
    pub fn complements(self, lab_angle: f64) -> [Option<f64>; 2] {
        let lacks = |(along, across, _): (f64, f64, f64)| {
            if along > 0.0 { PI - atan2(across, along) } else { atan2(across, -along) }
        };
        self.directions(lab_angle).map(|direction| direction.map(lacks))
    }

    /// Along the beam and across it in the centre-of-mass frame, and the jacobian, of each branch.
    fn directions(self, lab_angle: f64) -> [Option<(f64, f64, f64)>; 2] {
        if self.own == 0.0 {
            let ahead = |along| (lab_angle == 0.0).then_some((along, 0.0, f64::INFINITY));
            return [ahead(1.0), ahead(-1.0)];
        }
        let Some(at) = self.speeds(lab_angle) else { return [None, None] };
        // The direction in the centre-of-mass frame has components (λ cos θ - γ, λ sin θ), where λ = γ cos θ ± S is
        // the laboratory speed in units of the frame's own.
        let direction = |speed: f64, along: f64| (along, speed * at.sine, speed * speed / at.root);
        let first = (at.fast >= 0.0 && !(self.slow == 0.0 && at.cosine < 0.0))
            .then(|| direction(at.fast, at.cosine * at.root - at.reach * at.sine));
        let second = (self.slow > 0.0).then(|| direction(at.slow, -at.cosine * at.root - at.reach * at.sine));
        [first, second]
    }
    /// (v/(V + w))² of a laboratory angle up to the greatest, of the faster branch and of the slower, if there is one.
    pub(super) fn squared_speeds(self, lab_angle: f64) -> [Option<f64>; 2] {
        let sum = self.frame / self.own + 1.0;
        let (fast, slow) = match self.speeds(lab_angle) {
            _ if self.own == 0.0 => (1.0, 1.0),
            Some(at) => (at.fast / sum, at.slow / sum),
            // At the greatest angle, which is rounded, both are √(γ² - 1).
            None => ((self.slow / self.fast).max(0.0).sqrt(), (self.slow / self.fast).max(0.0).sqrt()),
        };
        [Some(fast.max(0.0) * fast.max(0.0)), (self.slow > 0.0).then_some(slow * slow)]
    }

    /// None beyond the greatest angle.
    fn speeds(self, lab_angle: f64) -> Option<Speeds> {
        let (sine, cosine) = sin_cos(lab_angle);
        let ratio = self.frame / self.own;
        let (reach, along) = (ratio * sine, ratio * cosine);
        if reach > 1.0 || (self.slow > 0.0 && cosine < 0.0) {
            return None;
        }
        // γ² - 1 = (γ - 1)(γ + 1) = (γ cos θ)² - S².
        let (difference, sum) = (self.slow / self.own, ratio + 1.0);
        // S by the form whose terms cancel least.
        let root = if self.slow == 0.0 {
            cosine.abs()
        } else if along.abs() < 1.0 {
            (along * along - difference * sum).max(0.0).sqrt()
        } else {
            ((1.0 - reach) * (1.0 + reach)).sqrt()
        };
        // λ₊λ₋ = γ² - 1: the one that would cancel comes from the other.
        let fast = if along < 0.0 { -difference * (sum / (root - along)) } else { along + root };
        Some(Speeds { sine, cosine, reach, root, fast, slow: difference * (sum / fast) })
    }
}
