//! What a force brings along so that motions under it can be expanded in Taylor series.

pub(super) mod apart;
pub(super) mod beside;
mod linear;
pub(super) mod pairs;

use super::Dynamics;
use crate::error::{Error, Result};
use crate::numerics::element::Element;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
pub(super) use linear::{LinearSeries, ONE, Scale};

/// One force of a scene, as a recurrence of Taylor coefficients.
pub trait Series<S: Element>: Send {
    /// Writes the coefficient of order `n` of its accelerations (in the jet's unit of time) into `a` if `first`, else adds
    /// it. Those of lower orders were asked before, of the same jet.
    ///
    /// # Errors
    /// As [`Force::apply`].
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<S>,
        a: &mut [S],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// As [`System::smooth_until`](crate::ode::system::System::smooth_until), of this force.
    fn smooth_until(&self, jet: &Jet<S>, h: &S) -> Option<S> {
        let _ = (jet, h);
        None
    }

    /// Whether it is linear in the place and the velocity of each body, but for a constant.
    fn is_linear(&self) -> bool {
        false
    }

    /// Writes the accelerations of what is linear in it by a place, or a velocity, of one along an axis, of each body; there
    /// are so many rows.
    ///
    /// # Errors
    /// As [`Force::apply`]; [`Error::Internal`] of one that is not linear.
    fn column(
        &mut self,
        axis: usize,
        velocity: bool,
        a: &mut [S],
        of: (usize, &mut Ticker<'_>),
    ) -> Result<()> {
        let _ = (axis, velocity, a, of);
        Err(Error::Internal("columns of what is not linear".to_owned()))
    }

    /// Whether it expands motions under others that are linear, too.
    fn takes_linear(&self) -> bool {
        false
    }

    /// Takes others, which are linear, to [expand](Self::expand) motions under all.
    fn take_linear(&mut self, linear: Vec<Box<dyn Series<S>>>) {
        let _ = linear;
    }

    /// Expands the motion under this force alone, and what it has taken.
    ///
    /// # Errors
    /// As [`Force::apply`].
    fn expand(&mut self, jet: &mut Jet<S>, a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        for n in 0..jet.order {
            self.coefficient(n, jet, a, true, ticker)?;
            jet.raise(n, a);
        }
        Ok(())
    }
}

/// The series of all forces, in the order of summation, and room for a coefficient.
pub(super) struct AllSeries<S> {
    forces: Vec<Box<dyn Series<S>>>,
    a: Vec<S>,
}

impl<S: Element> Dynamics<S> {
    /// With the series of its forces, in their order.
    #[must_use]
    pub fn with_series(mut self, mut forces: Vec<Box<dyn Series<S>>>) -> Self {
        let place = forces.iter().position(|force| force.takes_linear());
        let others = |place| forces.iter().enumerate().filter(move |(other, _)| *other != place);
        if let Some(place) = place.filter(|&place| others(place).all(|(_, force)| force.is_linear())) {
            let mut whole = forces.remove(place);
            whole.take_linear(core::mem::take(&mut forces));
            forces.push(whole);
        }
        self.series = Some(AllSeries { forces, a: vec![S::zero(); self.shape.len()] });
        self
    }

    pub(super) fn expand_series(&mut self, jet: &mut Jet<S>, ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        let AllSeries { forces, a } = self.series.as_mut().ok_or_else(without_series)?;
        if let [only] = &mut forces[..] {
            return only.expand(jet, a, ticker);
        }
        for n in 0..jet.order {
            sum(forces, n, jet, a, ticker)?;
            jet.raise(n, a);
        }
        Ok(())
    }

    pub(super) fn coefficient_of_series(
        &mut self,
        n: usize,
        jet: &Jet<S>,
        a: &mut [S],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.evaluations += u64::from(n == 0);
        let AllSeries { forces, .. } = self.series.as_mut().ok_or_else(without_series)?;
        sum(forces, n, jet, a, ticker)
    }

    /// The shortest of the steps that the forces allow, if any limits them.
    pub(super) fn series_smooth_until(&self, jet: &Jet<S>, h: &S) -> Option<S> {
        let mut until = None;
        for force in self.series.iter().flat_map(|series| &series.forces) {
            if let Some(smooth) = force.smooth_until(jet, until.as_ref().unwrap_or(h)) {
                until = Some(smooth);
            }
        }
        until
    }
}

fn without_series() -> Error {
    Error::Internal("forces without their series".to_owned())
}

/// The coefficient of order `n` of the accelerations by all forces.
fn sum<S: Element>(
    forces: &mut [Box<dyn Series<S>>],
    n: usize,
    jet: &Jet<S>,
    a: &mut [S],
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    if forces.is_empty() {
        a.fill(S::zero());
    }
    for (index, force) in forces.iter_mut().enumerate() {
        force.coefficient(n, jet, a, index == 0, ticker)?;
    }
    Ok(())
}
