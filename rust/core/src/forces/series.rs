//! What a force brings along so that motions under it can be expanded in Taylor series.

use super::{Dynamics, Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

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
    fn smooth_until(&self, jet: &Jet<S>, h: S) -> Option<S> {
        let _ = (jet, h);
        None
    }

    /// Expands the motion under this force alone.
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
    pub fn with_series(mut self, forces: Vec<Box<dyn Series<S>>>) -> Self {
        self.series = Some(AllSeries { forces, a: vec![S::zero(); self.shape.len()] });
        self
    }

    pub(super) fn expand_series(&mut self, jet: &mut Jet<S>, ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        let Some(AllSeries { forces, a }) = &mut self.series else {
            return Err(Error::Internal("forces without their series".to_owned()));
        };
        if let [only] = &mut forces[..] {
            return only.expand(jet, a, ticker);
        }
        a.fill(S::zero());
        for n in 0..jet.order {
            for (index, force) in forces.iter_mut().enumerate() {
                force.coefficient(n, jet, a, index == 0, ticker)?;
            }
            jet.raise(n, a);
        }
        Ok(())
    }

    /// The shortest of the steps that the forces allow, if any limits them.
    pub(super) fn series_smooth_until(&self, jet: &Jet<S>, h: S) -> Option<S> {
        let forces = self.series.iter().flat_map(|series| &series.forces);
        forces.fold(None, |until, force| force.smooth_until(jet, until.unwrap_or(h)).or(until))
    }
}

/// A force that is linear in coordinates and velocities but for a constant.
///
/// The one idea: what such a force makes of coefficients it makes of them as of coordinates and velocities, so its kernel
/// is its series.
pub(super) struct LinearSeries {
    /// The force, and what is linear in it, if anything is.
    force: Box<dyn Force<Lanes>>,
    linear: Option<Box<dyn Force<Lanes>>>,
    /// Room for velocities and accelerations in the units of the kernels.
    v: Vec<Lanes>,
    a: Vec<Lanes>,
}

impl LinearSeries {
    /// From the kernel of a force, and that of the same without its constant.
    pub(super) fn boxed(
        force: Box<dyn Force<Lanes>>,
        linear: Option<Box<dyn Force<Lanes>>>,
    ) -> Option<Box<dyn Series<Lanes>>> {
        Some(Box::new(Self { force, linear, v: Vec::new(), a: Vec::new() }))
    }
}

impl Series<Lanes> for LinearSeries {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let kernel = if n == 0 { Some(&mut self.force) } else { self.linear.as_mut() };
        let Some(kernel) = kernel else {
            if first {
                a.fill(Lanes::zero());
            }
            return Ok(());
        };
        self.v.resize(jet.len, Lanes::zero());
        self.a.resize(jet.len, Lanes::zero());
        let (per_unit, by_unit) = ([&jet.per_unit, &ONE], [&jet.unit, &jet.unit]);
        Lanes::pass(Scale { from: jet.velocity(n), factors: per_unit, into: &mut self.v, first: true });
        kernel.apply(&Phase { t: &jet.t, q: jet.position(n), v: &self.v }, &mut self.a, true, ticker)?;
        Lanes::pass(Scale { from: &self.a, factors: by_unit, into: a, first });
        Ok(())
    }
}

pub(super) const ONE: Lanes = Lanes([1.0; WIDTH]);

/// Numbers times the product of two factors, written if `first`, else added.
pub(super) struct Scale<'a> {
    pub(super) from: &'a [Lanes],
    pub(super) factors: [&'a Lanes; 2],
    pub(super) into: &'a mut [Lanes],
    pub(super) first: bool,
}

impl Pass<Lanes> for Scale<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let factor = V::load(*self.factors[0]) * V::load(*self.factors[1]);
        for (into, &from) in V::view_mut(self.into).iter_mut().zip(V::view(self.from)) {
            let term = from * factor;
            *into = if self.first { term } else { *into + term };
        }
    }
}
