//! The inside of a fixed step, for events.

use super::Result;
use super::events::Interpolant;
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::system::System;
use crate::parallel::Ticker;

/// The inside of a step, by shadow steps from the node at which it begins: as outputs are, so that both tell the same.
pub(super) struct Shadow<'r> {
    pub(super) stepper: &'r mut dyn Stepper<Lanes>,
    pub(super) system: &'r mut dyn System<Lanes>,
    pub(super) node: u64,
    pub(super) before: &'r State<Lanes>,
    pub(super) between: &'r mut State<Lanes>,
    /// The fraction of the step that it was taken to last, and whether its velocities are of there, too.
    pub(super) last: Option<(f64, bool)>,
    pub(super) step: f64,
}

impl Shadow<'_> {
    /// Takes the step to last that fraction, unless it was; its velocities are those there if they are wanted.
    fn taken(&mut self, theta: f64, velocities: bool, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        if self.last.is_none_or(|(last, exact)| last != theta || (velocities && !exact)) {
            self.last = None;
            self.between.copy_from(self.before);
            let (node, past) = (self.node, theta * self.step);
            if velocities {
                self.stepper.between(node, past, self.between, self.system, ticker)?;
            } else {
                self.stepper.positions_between(node, past, self.between, self.system, ticker)?;
            }
            self.last = Some((theta, velocities));
        }
        Ok(self.between)
    }
}

impl Interpolant for Shadow<'_> {
    fn at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        self.taken(theta, true, ticker)
    }

    fn positions_at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        self.taken(theta, false, ticker)
    }

    /// Has none: what a method of fixed steps says between nodes is a shadow step.
    fn polynomial(&mut self, _: usize, _: usize, _: &mut Vec<[f64; 2]>, _: &mut Ticker<'_>) -> Result<()> {
        Ok(())
    }
}
