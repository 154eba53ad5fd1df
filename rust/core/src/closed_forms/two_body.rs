//! Two bodies, at least one of them massive, that attract each other.

use super::{ClosedForm, ExactState, Motion};
use crate::error::{Error, Result};
use crate::nbody::two_body::TwoBody;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::Ticker;
use nalgebra::Vector3;

/// Kepler's two-body problem.
pub static FORM: ClosedForm = ClosedForm {
    name: "Kepler's two-body problem",
    reason: "two bodies and unsoftened gravity",
    applies: |member| {
        member.mass.len() == 2
            && matches!(&member.forces[..], [force] if matches!(force.as_newtonian(), Some((_, 0.0))))
    },
    motion: |member, _| {
        let constant = member.forces.iter().find_map(|force| force.as_newtonian());
        let (Some((constant, _)), &[one, other]) = (constant, member.mass) else {
            return Err(Error::Internal("two bodies that are not".to_owned()));
        };
        let states = [0, 1].map(|i| (Vector3::from(member.position[i]), Vector3::from(member.velocity[i])));
        Ok(Box::new(TwoBody::new(constant, [one, other], states)?))
    },
};

impl Motion for TwoBody {
    fn states(
        &self,
        elapsed: DoubleDouble,
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        states.clear();
        states.extend(self.unrounded(elapsed));
        ticker.tick()
    }
}
