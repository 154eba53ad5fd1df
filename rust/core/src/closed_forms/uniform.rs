//! The same acceleration on everything: parabolas.

use super::parabola::Parabola;
use super::{ClosedForm, Paths, uniform_part};

/// Parabolas.
pub static FORM: ClosedForm = ClosedForm {
    name: "parabolas",
    reason: "the only force is a uniform field",
    applies: |member| {
        !member.forces.is_empty() && member.forces.iter().all(|force| force.as_uniform().is_some())
    },
    motion: |member, ticker| {
        let g = uniform_part(&member.forces);
        let path = |i: usize| Ok(Parabola::new(member.position[i], member.velocity[i], g));
        Paths::motion(member, ticker, path)
    },
};
