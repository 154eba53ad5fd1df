//! No force: straight lines.

use super::parabola::Parabola;
use super::{ClosedForm, Paths};

/// Straight lines.
pub static FORM: ClosedForm = ClosedForm {
    name: "straight lines",
    reason: "no force acts",
    applies: |member| member.forces.is_empty(),
    motion: |member, _, ticker| {
        let line = |i: usize| Ok(Parabola::line(member.position[i], member.velocity[i]));
        Paths::motion(member, ticker, line)
    },
};
