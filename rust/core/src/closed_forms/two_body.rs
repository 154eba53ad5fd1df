//! Two bodies, at least one of them massive, that attract each other.

use super::{ClosedForm, ExactState, Member, Motion};
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::nbody::two_body::TwoBody;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use nalgebra::Vector3;

/// Kepler's two-body problem.
pub static FORM: ClosedForm = ClosedForm {
    name: "Kepler's two-body problem",
    reason: "two bodies and unsoftened inverse-square forces between them",
    applies: |member| member.mass.len() == 2 && constant(member).is_some(),
    motion: |member, _, _| {
        let (Some(constant), &[one, other]) = (constant(member), member.mass) else {
            return Err(Error::Internal("two bodies that are not".to_owned()));
        };
        let states = [0, 1].map(|i| (Vector3::from(member.position[i]), Vector3::from(member.velocity[i])));
        Ok(Box::new(TwoBody::new(constant, [one, other], states)?))
    },
};

/// The gravitational constant of gravity, of Coulomb's law or of both between two bodies: −k qᵢqⱼ/(mᵢmⱼ) for charges, rounded
/// once.
fn constant(member: &Member<'_>) -> Option<f64> {
    let newton = |force: &dyn ForceTerm| match force.as_newtonian() {
        Some((constant, 0.0)) => Some(constant),
        _ => None,
    };
    let coulomb = |force: &dyn ForceTerm| match force.as_coulomb([0, 1]) {
        Some((k, 0.0)) => {
            let [one, other] = [member.mass[0], member.mass[1]].map(Scaled::from);
            Some(k.negative().over(one).over(other))
        }
        _ => None,
    };
    let sum = match member.forces[..] {
        [force] => newton(force).or_else(|| coulomb(force).map(Scaled::to_f64)),
        [one, other] => {
            let (gravity, charges) = match (newton(one), newton(other)) {
                (Some(gravity), None) => (gravity, coulomb(other)?),
                (None, Some(gravity)) => (gravity, coulomb(one)?),
                _ => return None,
            };
            Some(charges.plus(Scaled::from(gravity)).to_f64())
        }
        _ => None,
    };
    sum.filter(|constant| constant.is_normal())
}

impl Motion for TwoBody {
    fn states(
        &self,
        elapsed: &[DoubleDouble],
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        states.clear();
        for &elapsed in elapsed {
            ticker.tick()?;
            states.extend(self.unrounded(elapsed));
        }
        Ok(())
    }
}
