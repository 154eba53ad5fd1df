//! The same acceleration on everything: parabolas.

use super::parabola::Parabola;
use super::{ClosedForm, Paths, is_uniform, uniform_part};

/// Parabolas.
pub static FORM: ClosedForm = ClosedForm {
    name: "parabolas",
    reason: "the only force is a uniform field",
    applies: |member| !member.forces.is_empty() && member.forces.iter().all(|force| is_uniform(*force)),
    motion: |member, _, ticker| {
        let path =
            |i: usize| Ok(Parabola::new(member.position[i], member.velocity[i], uniform_part(member, i)));
        Paths::motion(member, ticker, path)
    },
};
