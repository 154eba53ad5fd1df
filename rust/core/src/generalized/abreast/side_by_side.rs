//! Methods that take steps of eight trajectories, and what they tell of each.

use crate::Result;
use crate::generalized::fixed::FixedSteps;
use crate::generalized::motion::Motion;
use crate::generalized::run::Request;
use crate::narrow::UNSEEN;
use crate::numerics::lanes::Lanes;
use crate::ode::embedded::EmbeddedStep;
use crate::ode::state::State;
use crate::ode::step_control::Rule;
use crate::ode::taylor::TaylorStep;
use crate::ode::trial::Trial;
use crate::ode::{Method, Scheme};

/// Trials of eight trajectories, and what some of them tell of each.
pub trait SideBySide: Trial<Lanes> {
    /// With other parameters from now on, where it has its own.
    fn set_parameters(&mut self, _: &[Lanes]) {}

    /// Evaluations of a lane since this was last asked, beyond those of the system and of [`cost`](Trial::cost).
    fn taken(&mut self, _: usize) -> u64 {
        0
    }

    /// Why a lane cannot go on, told once.
    fn lost(&mut self, _: usize) -> Option<String> {
        None
    }
}

impl SideBySide for EmbeddedStep<Lanes> {
    fn taken(&mut self, lane: usize) -> u64 {
        self.hidden(lane)
    }
}
impl SideBySide for TaylorStep<Lanes> {}
impl SideBySide for FixedSteps<Lanes> {
    fn lost(&mut self, lane: usize) -> Option<String> {
        self.seen.is_some_and(|seen| seen.0[lane] < 1.0).then(|| UNSEEN.to_owned())
    }
}

/// The method for eight trajectories.
pub(super) fn trial(
    method: &'static Method,
    request: &Request,
    system: &mut Motion<Lanes>,
    state: &State<Lanes>,
    max_step: Lanes,
) -> Result<Box<dyn SideBySide>> {
    Ok(match &method.scheme {
        Scheme::Embedded(tableau) => {
            let rule = Rule::new(tableau.error_exponent, max_step);
            Box::new(EmbeddedStep::with_rule(tableau, system, state, rule))
        }
        Scheme::Taylor(orders) => Box::new(TaylorStep::new(*orders, system, state, max_step)),
        _ => Box::new(FixedSteps::new(method, request.fixed_step(method.name)?, system, state)?),
    })
}
