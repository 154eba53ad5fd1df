//! Drag in proportion to the velocity, with a uniform field or without.
//!
//! With the rate 1/τ and u = t/τ: v = v₀ e⁻ᵘ + g t φ₁ and x = x₀ + v₀ t φ₁ + g t² φ₂, where φ₁ = (1 − e⁻ᵘ)/u and
//! φ₂ = (1 − φ₁)/u ([`Decay`]): parabolas as τ grows. For |u| > 1 the same about the terminal velocity w = gτ, so that
//! what approaches it does so without cancellation: v = w + (v₀ − w) e⁻ᵘ, x = x₀ + w t + (v₀ − w) τ (1 − e⁻ᵘ).
//! Source: Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 1.5.

use super::{ClosedForm, ExactState, Member, Motion, is_uniform, uniform_part, unrounded};
use crate::error::Result;
use crate::numerics::decay::Decay;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;

/// Exponential decay of velocities.
pub static FORM: ClosedForm = ClosedForm {
    name: "exponential decay",
    reason: "the only forces are linear drag and uniform fields",
    applies: |member| {
        member.forces.iter().all(|force| force.as_linear_drag().is_some() || is_uniform(*force))
            && member.forces.iter().any(|force| force.as_linear_drag().is_some())
    },
    motion: |member, _, _| Ok(Box::new(Drag::new(member))),
};

struct Drag {
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    tau: Scaled,
    /// g and g τ, of each particle.
    fields: Vec<[[Scaled; 3]; 2]>,
}

impl Drag {
    fn new(member: &Member<'_>) -> Self {
        let one = Scaled::from(1.0);
        let times: Vec<f64> = member.forces.iter().filter_map(|force| force.as_linear_drag()).collect();
        let tau = match times[..] {
            [only] => Scaled::from(only),
            _ => {
                one.over(times.iter().fold(Scaled::ZERO, |rate, &tau| rate.plus(one.over(Scaled::from(tau)))))
            }
        };
        let fields = (0..member.mass.len()).map(|particle| {
            let g = uniform_part(member, particle);
            [g, g.map(|g| g.by(tau))]
        });
        Self {
            position: member.position.to_vec(),
            velocity: member.velocity.to_vec(),
            tau,
            fields: fields.collect(),
        }
    }
}

impl Motion for Drag {
    fn states(
        &self,
        elapsed: &[DoubleDouble],
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        states.clear();
        elapsed.iter().try_for_each(|&elapsed| self.add_states(elapsed, states, ticker))
    }
}

impl Drag {
    /// Adds the states at a time.
    fn add_states(
        &self,
        elapsed: DoubleDouble,
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let t = Scaled::new(elapsed, 0);
        let u = t.over(self.tau);
        let Decay { factor, first, second } = Decay::new(u);
        // |u| ≤ 1
        let slow = u.to_f64().abs() <= 1.0;
        let (way, fall) = (t.by(first), t.by(t).by(second));
        for ((position, velocity), [g, terminal]) in
            self.position.iter().zip(&self.velocity).zip(&self.fields)
        {
            ticker.tick()?;
            let at = |c: usize| {
                let (x, v, w) = (Scaled::from(position[c]), Scaled::from(velocity[c]), terminal[c]);
                if slow {
                    let g = g[c];
                    return (x.plus(v.by(way).plus(g.by(fall))), v.by(factor).plus(g.by(way)));
                }
                let above = v.minus(w);
                // τ (1 − e⁻ᵘ) = t φ₁.
                (x.plus(w.by(t).plus(above.by(way))), w.plus(above.by(factor)))
            };
            let state: [_; 3] = core::array::from_fn(at);
            states.push((state.map(|state| unrounded(state.0)), state.map(|state| unrounded(state.1))));
        }
        Ok(())
    }
}
