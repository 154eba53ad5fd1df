//! What a force brings along so that motions under it can be expanded in Taylor series.

use super::Dynamics;
use crate::error::{Error, Result};
use crate::numerics::element::Element;
use crate::ode::series::Jet;

/// One force of a scene, as a recurrence of Taylor coefficients.
pub trait Series<S: Element>: Send {
    /// Writes the coefficient of order `n` of its accelerations (in the jet's unit of time) into `a` if `first`, else adds
    /// it. Those of lower orders were asked before, of the same jet.
    fn coefficient(&mut self, n: usize, jet: &Jet<S>, a: &mut [S], first: bool);

    /// Expands the motion under this force alone.
    fn expand(&mut self, jet: &mut Jet<S>, a: &mut [S]) {
        for n in 0..jet.order {
            self.coefficient(n, jet, a, true);
            jet.raise(n, a);
        }
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
    pub fn with_series(mut self, forces: Vec<Box<dyn Series<S>>>) -> Self {
        self.series = Some(AllSeries { forces, a: vec![S::zero(); self.shape.len()] });
        self
    }

    pub(super) fn expand_series(&mut self, jet: &mut Jet<S>) -> Result<()> {
        self.evaluations += 1;
        let Some(AllSeries { forces, a }) = &mut self.series else {
            return Err(Error::Internal("forces without their series".to_owned()));
        };
        if let [only] = &mut forces[..] {
            only.expand(jet, a);
            return Ok(());
        }
        a.fill(S::zero());
        for n in 0..jet.order {
            for (index, force) in forces.iter_mut().enumerate() {
                force.coefficient(n, jet, a, index == 0);
            }
            jet.raise(n, a);
        }
        Ok(())
    }
}
