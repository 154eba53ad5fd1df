//! Forces that are linear in coordinates and velocities but for a constant.
//!
//! The one idea: what such a force makes of coefficients it makes of them as of coordinates and velocities, so its kernel
//! is its series.

use super::Series;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// A force that is linear in coordinates and velocities but for a constant.
pub(in crate::forces) struct LinearSeries {
    /// The force, and what is linear in it, if anything is.
    force: Box<dyn Force<Lanes>>,
    linear: Option<Box<dyn Force<Lanes>>>,
    /// Whether it acts on each body by itself.
    of_each: bool,
    /// Room for velocities and accelerations in the units of the kernels.
    v: Vec<Lanes>,
    a: Vec<Lanes>,
}

impl LinearSeries {
    /// From the kernel of a force on each body by itself, and that of the same without its constant.
    pub(in crate::forces) fn boxed(
        force: Box<dyn Force<Lanes>>,
        linear: Option<Box<dyn Force<Lanes>>>,
    ) -> Option<Box<dyn Series<Lanes>>> {
        Some(Box::new(Self { force, linear, of_each: true, v: Vec::new(), a: Vec::new() }))
    }

    /// The same of a force between bodies.
    pub(in crate::forces) fn between_bodies(
        force: Box<dyn Force<Lanes>>,
        linear: Option<Box<dyn Force<Lanes>>>,
    ) -> Option<Box<dyn Series<Lanes>>> {
        Some(Box::new(Self { force, linear, of_each: false, v: Vec::new(), a: Vec::new() }))
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

    fn is_linear(&self) -> bool {
        self.of_each
    }

    fn column(
        &mut self,
        axis: usize,
        velocity: bool,
        a: &mut [Lanes],
        (rows, ticker): (usize, &mut Ticker<'_>),
    ) -> Result<()> {
        let Some(linear) = &mut self.linear else {
            a.fill(Lanes::zero());
            return Ok(());
        };
        let nothing = vec![Lanes::zero(); a.len()];
        let mut one = nothing.clone();
        one[axis * rows..(axis + 1) * rows].fill(ONE);
        let (q, v) = if velocity { (&nothing, &one) } else { (&one, &nothing) };
        linear.apply(&Phase { t: &Lanes::zero(), q, v }, a, true, ticker)
    }
}

pub(in crate::forces) const ONE: Lanes = Lanes([1.0; WIDTH]);

/// Numbers times the product of two factors, written if `first`, else added.
pub(in crate::forces) struct Scale<'a> {
    pub(in crate::forces) from: &'a [Lanes],
    pub(in crate::forces) factors: [&'a Lanes; 2],
    pub(in crate::forces) into: &'a mut [Lanes],
    pub(in crate::forces) first: bool,
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
