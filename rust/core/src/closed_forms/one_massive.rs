//! One massive body, and massless ones that orbit it.

use super::fixed_center::Orbit;
use super::parabola::Parabola;
use super::{ClosedForm, ExactState, Path, Paths};
use crate::error::{Error, Result};
use crate::nbody::two_body::check_parameter;
use crate::numerics::double_double::DoubleDouble;

/// Kepler orbits about a body.
pub static FORM: ClosedForm = ClosedForm {
    name: "Kepler orbits",
    reason: "one massive body, unsoftened gravity, the rest massless",
    applies: |member| {
        matches!(&member.forces[..], [force] if matches!(force.as_newtonian(), Some((_, 0.0))))
            && member.mass.iter().filter(|&&mass| mass > 0.0).count() == 1
    },
    motion: |member, _, ticker| {
        let constant = member.forces.iter().find_map(|force| force.as_newtonian());
        let center = member.mass.iter().position(|&mass| mass > 0.0);
        let (Some((constant, _)), Some(center)) = (constant, center) else {
            return Err(Error::Internal("one massive body that is none".to_owned()));
        };
        let state = |i: usize| (member.position[i], member.velocity[i]);
        let mu = constant * member.mass[center];
        check_parameter(mu, constant, member.mass[center])?;
        Paths::motion(member, ticker, |i| -> Result<About> {
            let (position, velocity) = state(center);
            Ok(if i == center {
                About::Center(Parabola::line(position, velocity))
            } else {
                About::Orbit(Box::new(Orbit::new(mu, state(center), state(i))?))
            })
        })
    },
};

enum About {
    Center(Parabola),
    Orbit(Box<Orbit>),
}

impl Path for About {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        match self {
            Self::Center(line) => line.state(elapsed),
            Self::Orbit(orbit) => orbit.state(elapsed),
        }
    }
}
