//! A motion and a small difference of it as one system: `q'' = a(q, v)`, `δ'' = (∂a/∂q) δ + (∂a/∂v) δ'`.
//!
//! The one idea: each force says how its accelerations change along the difference, or is [compared](super::slopes) with
//! itself at neighboring states. The equations of the difference are linear: its length matters to nobody.

use super::measures::{Measures, Size};
use super::slopes::{Accumulate, Slopes};
use crate::error::Result;
use crate::forces::derivative::{Along, Derivative};
use crate::forces::{Dynamics, Phase};
use crate::numerics::element::Element;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::parallel::Ticker;
use crate::scene::plan::Plan;
use crate::scene::unit::{Prepared, derivatives, dynamics};

/// Units beside small differences of them. States hold coordinates of the motion, then as many of the difference; velocities
/// likewise.
pub(super) struct Variation {
    dynamics: Dynamics<Lanes>,
    pub(super) measures: Measures,
    /// Of the forces that have them.
    derivatives: Vec<Box<dyn Derivative<Lanes>>>,
    /// The others, if there are any.
    slopes: Option<Slopes>,
    /// What the time was when it began to be counted.
    pub begun: f64,
    /// Room for the change by one force.
    change: Vec<Lanes>,
}

impl Variation {
    /// Of units in the lanes.
    pub(super) fn new(plan: &Plan, units: &[Prepared], sizes: &[Size], threads: usize) -> Self {
        let views: Vec<&Prepared> = units.iter().collect();
        let (dynamics, layout) = (dynamics(plan, &views, threads), plan.layout);
        let measures = Measures::new(layout, sizes);
        let (derivatives, others) = derivatives(plan, &views, threads);
        let slopes = others.map(|others| Slopes::new(others, (layout, units), (measures, sizes)));
        let change = vec![Lanes::zero(); dynamics.shape.len()];
        Self { dynamics, measures, derivatives, slopes, begun: 0.0, change }
    }

    /// Numbers of a place, and of its difference.
    pub(super) const fn half(&self) -> usize {
        self.dynamics.shape.len()
    }

    /// Whether all forces tell by formulas how they change.
    pub(super) const fn is_exact(&self) -> bool {
        self.slopes.is_none()
    }
}

impl System<Lanes> for Variation {
    fn form(&self) -> Form {
        Form::SecondOrder(2 * self.half())
    }

    fn needs(&self) -> Needs {
        let Needs { time, velocity, rotation } = self.dynamics.needs();
        Needs { time, velocity: velocity || rotation, rotation: false }
    }

    fn evaluations(&self) -> u64 {
        self.dynamics.evaluations()
    }

    fn stops_midway(&self) -> bool {
        self.dynamics.stops_midway() || self.derivatives.iter().any(|derivative| derivative.stops_midway())
    }

    fn acceleration(
        &mut self,
        t: &Lanes,
        q: &[Lanes],
        v: &[Lanes],
        a: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let half = self.half();
        let t = *t + Lanes::splat(self.begun);
        let (q, apart) = q.split_at(half);
        // Where nobody looks at velocities they may not be there.
        let (v, parting) = v.split_at(half.min(v.len()));
        let along = Along { q: apart, v: parting };
        let (a, change) = a.split_at_mut(half);
        self.dynamics.acceleration(&t, q, v, a, ticker)?;
        match &mut self.slopes {
            Some(slopes) => slopes.along((&t, q, v), along, a, change, ticker)?,
            None if self.derivatives.is_empty() => change.fill(Lanes::zero()),
            None => {}
        }
        let phase = Phase { t: &t, q, v };
        for (index, derivative) in self.derivatives.iter_mut().enumerate() {
            if index == 0 && self.slopes.is_none() {
                derivative.apply(&phase, along, change, ticker)?;
            } else {
                derivative.apply(&phase, along, &mut self.change, ticker)?;
                Lanes::pass(Accumulate { values: &self.change, weight: &Lanes::one(), to: change });
            }
        }
        Ok(())
    }

    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let from = step.from + Lanes::splat(self.begun);
        Taken { from, ..*step }.ask_first_of_halves(self.half(), &mut self.dynamics)
    }

    fn longest_step(&self, (q, v): (&[Lanes], &[Lanes]), a: &[Lanes]) -> Option<Lanes> {
        let half = self.half();
        self.dynamics.longest_step((&q[..half], &v[..half]), &a[..half])
    }
}
