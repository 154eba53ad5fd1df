//! Massive bodies along one of their steps, and what massless ones feel there.
//!
//! The one idea: between its ends a step of the massive bodies is a polynomial of time, so a massless body can take
//! steps of its own through it, as often as it needs, and the massive ones are integrated once.

use super::super::super::plan::Plan;
use super::super::super::unit::{Prepared, uncoupled};
use crate::error::{Error, Result};
use crate::forces::following::{Following, Leaders, Massive};
use crate::forces::series::Series;
use crate::forces::{Force, Phase};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::Real;
use crate::ode::Scheme;
use crate::ode::series::Jet;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::parallel::Ticker;
use std::sync::Arc;

mod path;
mod series;
pub(super) use path::{Path, Paths};
use series::Shifted;

/// One of the forces on massless bodies.
enum Term {
    /// That of the massive ones.
    Following(Box<dyn Following>),
    /// Another, which does not couple them.
    Other(Box<dyn Force<Lanes>>, Option<Box<dyn Series<Lanes>>>),
}

/// The forces on a massless body in each lane, while massive ones move along their step.
pub(super) struct Guided {
    components: usize,
    path: Arc<Path>,
    /// The time at which the step of the massive bodies begins.
    base: Lanes,
    /// The lanes whose bodies move; in the others nothing matters.
    pub(super) running: Bits,
    /// In the scene's order, which is the order of summation.
    terms: Vec<Term>,
    needs: Needs,
    /// Where the massive bodies are at the time of an evaluation.
    places: Vec<Lanes>,
    /// Their series about that time.
    shifted: Shifted,
    evaluations: u64,
}

impl Guided {
    /// For the massless bodies `units`, all following massive ones like `guide`.
    ///
    /// # Errors
    /// Only errors of the library itself.
    pub(super) fn new(plan: &Plan, guide: &Prepared, units: &[&Prepared]) -> Result<Self> {
        let numbers = guide.unit.active * guide.shape.components;
        let leaders = Leaders {
            bodies: &guide.unit.bodies,
            components: guide.shape.components,
            units: plan.units,
            expands: matches!(plan.method.scheme, Scheme::Taylor(_)),
        };
        let mut terms = Vec::with_capacity(plan.forces.len());
        for (force, kernel) in plan.forces_of(guide.unit.copy).iter().zip(uncoupled(plan, units)) {
            terms.push(match kernel {
                Some((force, series)) => Term::Other(force, series),
                None => Term::Following(force.following(&leaders).ok_or_else(unled)?),
            });
        }
        let needs = terms.iter().fold(Needs { time: true, ..Needs::default() }, |needs, term| match term {
            Term::Following(force) => Needs { velocity: needs.velocity | force.needs_velocity(), ..needs },
            Term::Other(force, _) => needs.and(force.needs()),
        });
        Ok(Self {
            components: guide.shape.components,
            path: Arc::new(Path::at_rest(numbers)),
            base: Lanes::zero(),
            running: Bits(0xff),
            terms,
            needs,
            places: vec![Lanes::zero(); numbers],
            shifted: Shifted::default(),
            evaluations: 0,
        })
    }

    /// Whether a force looks at the velocities of massive bodies.
    pub(super) fn asks_for_velocities(&self) -> bool {
        self.terms.iter().any(|term| matches!(term, Term::Following(force) if force.needs_velocity()))
    }

    /// Takes over the masses of a guide, and what is its own of the forces, for its lanes.
    pub(super) fn attach(&mut self, plan: &Plan, guide: &Prepared, lanes: Bits) {
        for (term, force) in self.terms.iter_mut().zip(plan.forces_of(guide.unit.copy)) {
            if let Term::Following(leading) = term {
                leading.lead(&**force, plan.units, &guide.mass, lanes);
            }
        }
    }

    /// The massless bodies in the lanes are these now.
    pub(super) fn take_up(&mut self, plan: &Plan, units: &[&Prepared]) {
        let kernels = plan.forces.iter().zip(uncoupled(plan, units));
        for (term, (_, kernel)) in self.terms.iter_mut().zip(kernels) {
            if let (Term::Other(force, series), Some(own)) = (term, kernel) {
                (*force, *series) = own;
            }
        }
    }

    /// The massive bodies move along this path, from the time `base` on.
    pub(super) fn follow(&mut self, path: &Arc<Path>, base: Lanes) {
        (self.path, self.base) = (Arc::clone(path), base);
        self.places.resize(path.told(), Lanes::zero());
    }

    /// Where the massive bodies of a lane are at the time `t` since the start of their step.
    pub(super) fn places(&mut self, t: f64, lane: usize) -> Vec<[f64; 3]> {
        self.path.at(&Lanes::splat(t), Bits(0xff), &mut self.places);
        let massive = self.path.numbers / self.components;
        let mut places = vec![[0.0; 3]; massive];
        for (number, place) in self.places.iter().enumerate().take(self.path.numbers) {
            places[number % massive][number / massive] = place.0[lane];
        }
        places
    }
}

impl System<Lanes> for Guided {
    fn form(&self) -> Form {
        Form::SecondOrder(self.components)
    }

    fn needs(&self) -> Needs {
        self.needs
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn acceleration(
        &mut self,
        t: &Lanes,
        q: &[Lanes],
        v: &[Lanes],
        a: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.evaluations += 1;
        let places = match self.path.at_stage(t, self.running) {
            Some(places) => places,
            None => {
                self.path.at(t, self.running, &mut self.places);
                &self.places
            }
        };
        let (places, velocities) = places.split_at(self.path.numbers);
        for (index, term) in self.terms.iter_mut().enumerate() {
            match term {
                Term::Following(force) => force.apply(Massive { places, velocities }, (q, v), a, index == 0),
                Term::Other(force, _) => {
                    let phase = Phase { t: &(self.base + *t), q, v };
                    force.apply(&phase, a, index == 0, ticker)?;
                }
            }
        }
        Ok(())
    }

    fn expand(&mut self, jet: &mut Jet<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        self.expand_series(jet, ticker)
    }

    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let step = Taken { from: self.base + step.from, ..*step };
        let mut until: Option<Lanes> = None;
        for term in &mut self.terms {
            let Term::Other(force, _) = term else { continue };
            if let Some(seen) = force.seen_until(&step)? {
                until = Some(until.map_or(seen, |until| until.min(seen)));
            }
        }
        Ok(until)
    }
}

fn unled() -> Error {
    Error::Internal("a force that massless bodies do not follow".to_owned())
}
