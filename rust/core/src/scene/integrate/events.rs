//! Events on the steps of a unit: which steps may hold zeros, where they are, and what the state is there.
//!
//! The one idea: a step is looked into only where the cubic through the values and rates at its ends does not keep clear of
//! zero. Then the function is sampled along the step, and where it changes its sign, or comes near zero and turns, the zero
//! is located on the solution itself: the continuous extension of an adaptive method, a shadow step of one with fixed
//! steps. Both are read and leave no trace, so events change no bit of a run.

mod abreast;
mod along;
mod beyond;
mod bodies;
mod clear;
mod contacts;
mod expressions;
mod expressions_in_lanes;
mod halves;
mod inside;
mod nearest;
mod search;
mod spheres;
mod spheres_abreast;
mod step;
mod touching;
mod turning;
mod turns;

use super::super::events::{Event, Known, Moving, Sight, Surroundings, View, What, Working};
use super::super::unit::{Prepared, Turned};
use super::Job;
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;
use crate::parallel::Ticker;
pub(super) use abreast::Abreast;
pub(super) use along::Along;
use bodies::Bodies;
use clear::{cubic, keeps_clear, keeps_clear_after_all};
use contacts::{Contacts, Pair};
use core::cell::RefCell;
pub(super) use step::{Interpolant, Span};
use turning::Turns;

/// A zero that was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Of which event.
    pub which: usize,
    /// When, …
    pub t: f64,
    /// … and what that leaves out.
    pub t_rest: f64,
    /// Positions and velocities of the bodies of the unit.
    pub states: Vec<[[f64; 3]; 2]>,
    /// How its rigid bodies are turned and turn, if torques turn them.
    pub turned: Vec<Turned>,
    /// The spheres that touch, if it is that.
    pub spheres: Option<(usize, usize)>,
}

/// The events of one unit under watch.
pub(super) struct Watch<'a> {
    job: &'a Job<'a>,
    /// Their places among all events, and those of their bodies among the ones that are looked at.
    events: Vec<(usize, Vec<usize>)>,
    /// Of each that is an expression what it works with.
    working: Vec<Option<RefCell<Working>>>,
    bodies: Bodies,
    /// The spheres that may touch, and the pairs that may do so in the step at hand, which follow the events.
    contacts: Option<Contacts>,
    pairs: Vec<Pair>,
    massive: bool,
    /// Whether the forces leave energy as it is: what changes of it are errors of steps, told from node to node.
    keeps_energy: bool,
    /// Bodies and what the events see of them at the last node, and room for those at the next one and inside a step.
    before: Vec<Moving>,
    after: Vec<Moving>,
    inside: Vec<Moving>,
    sights: Vec<Sight>,
    next: Vec<Sight>,
    /// How rigid bodies are turned, for who looks at that.
    turns: Option<Turns>,
    /// The events that may have zeros in the step at hand.
    suspects: Vec<usize>,
    /// The terms of each coordinate of each body on that step.
    terms: Vec<[f64; 2]>,
    /// Whether states within a step are settled, so that bodies are not quite where the polynomials have them.
    settles: bool,
    /// How well the inside of a step is known.
    known: Known,
    /// When each event was zero last, or nearly so at the start; before all time if it never was.
    last: Vec<f64>,
    /// Of events that are zero at the start, what is nothing beside the numbers that they are made of.
    nothing: Vec<f64>,
    /// Zeros of each event so far.
    counts: Vec<u64>,
    found: Vec<Found>,
    /// Whether the last one found has ended the run.
    pub(super) stopped: bool,
}

impl<'a> Watch<'a> {
    /// Of a unit at its start, if it has events.
    ///
    /// # Errors
    /// Those of the functions.
    pub(super) fn begin(
        job: &'a Job<'a>,
        unit: &Prepared,
        (state, lane): (&State<Lanes>, usize),
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Box<Self>>> {
        if unit.unit.events.is_empty() {
            return Ok(None);
        }
        let (plan, scene) = (job.plan, job.scene);
        let mut slots: Vec<usize> = Vec::new();
        // Where each body of the scene is in the unit, and each of those among the ones that are looked at.
        let nowhere = usize::MAX;
        let (mut slot_of, mut place_of) =
            (vec![nowhere; scene.particles], vec![nowhere; unit.unit.bodies.len()]);
        for (slot, &body) in unit.unit.bodies.iter().enumerate() {
            slot_of[body] = slot;
        }
        let mut events = Vec::with_capacity(unit.unit.events.len());
        let mut spheres = None;
        for &index in &*unit.unit.events {
            let looked_at = plan.events[index].bodies(&plan.groups, scene.particles, &plan.active);
            let places = looked_at.iter().filter_map(|body| {
                let slot = slot_of.get(*body).copied().filter(|&slot| slot != nowhere)?;
                if place_of[slot] == nowhere {
                    place_of[slot] = slots.len();
                    slots.push(slot);
                }
                Some(place_of[slot])
            });
            let places: Vec<usize> = places.collect();
            match &plan.events[index].what {
                What::Contact(touching) => spheres = Some((index, touching)),
                _ => events.push((index, places)),
            }
        }
        let working = events.iter().map(|(index, _)| match &plan.events[*index].what {
            What::Expression(expression) => Some(RefCell::new(Working::new(expression))),
            _ => None,
        });
        let working = working.collect();
        let at_rest = vec![Moving::default(); slots.len()];
        let mut watch = Self {
            job,
            working,
            bodies: Bodies::new(job, unit, &slots, (state, lane)),
            contacts: None,
            pairs: Vec::new(),
            massive: unit.unit.bodies.len() < scene.particles,
            keeps_energy: scene.rigid.is_none()
                && plan.forces_of(unit.unit.copy).iter().all(|force| force.conserves().energy),
            before: at_rest.clone(),
            after: at_rest.clone(),
            inside: at_rest,
            sights: vec![Sight::default(); events.len()],
            turns: Turns::new(job, unit, lane)?,
            next: vec![Sight::default(); events.len()],
            suspects: Vec::new(),
            terms: Vec::new(),
            settles: plan.turning.steps(),
            known: job.known(),
            last: vec![-plan.direction * f64::INFINITY; events.len()],
            nothing: vec![0.0; events.len()],
            counts: vec![0; events.len()],
            found: Vec::new(),
            stopped: false,
            events,
        };
        watch.bodies.read(state, &mut watch.before);
        watch.turn(unit, state, job.begun());
        let copy = unit.unit.copy;
        watch.contacts = spheres.map(|(index, touching)| {
            let spheres = (scene.radii(copy), &**touching);
            Contacts::new(index, spheres, &watch.bodies.indices, &watch.before)
        });
        let told = |body: usize| [scene.positions(copy)[body], scene.velocities(copy)[body]];
        for event in 0..watch.events.len() {
            let mut sight = watch.sight(unit, event, (&watch.before, job.begun()), ticker)?;
            let least = watch.event(event).0.least_swing(&sight, &watch.known);
            if least.is_some_and(|least| sight.value.abs() <= least) {
                watch.last[event] = job.begun();
            }
            // What starts at zero has not come there.
            let seen = (&sight, &watch.before[..], job.begun());
            if sight.value.abs() <= watch.rounding_as_told(unit, event, seen, &told, ticker)? {
                watch.nothing[event] = watch.rounding_of_any(unit, event, seen, &told, ticker)?;
                sight.value = 0.0;
            }
            watch.sights[event] = sight;
        }
        Ok(Some(Box::new(watch)))
    }

    #[inline]
    fn event(&self, event: usize) -> (&Event, &[usize]) {
        match self.events.get(event) {
            Some((index, places)) => (&self.job.plan.events[*index], places),
            None => {
                let pair = &self.pairs[event - self.events.len()];
                (&pair.event, &pair.places)
            }
        }
    }

    /// Whether the value of an event is what the motion keeps.
    fn is_kept(&self, event: usize) -> bool {
        self.keeps_energy && matches!(self.event(event).0.what, What::Energy(_))
    }

    /// What is added to the value of an event.
    fn shift(&self, event: usize) -> f64 {
        event.checked_sub(self.events.len()).map_or(0.0, |pair| self.pairs[pair].shift)
    }

    /// One of those that were asked for.
    fn own_event(&self, event: usize) -> (&'a Event, &[usize]) {
        let (index, places) = &self.events[event];
        (&self.job.plan.events[*index], places)
    }

    /// Reads how rigid bodies are turned in a state, so long after the start, if anybody looks at that.
    fn turn(&mut self, unit: &Prepared, state: &State<Lanes>, elapsed: f64) {
        if let Some(turns) = &mut self.turns {
            turns.read(self.job, unit, state, elapsed);
        }
    }

    /// What an event sees of these bodies after this time.
    #[inline]
    fn sight(
        &self,
        unit: &Prepared,
        event: usize,
        (bodies, elapsed): (&[Moving], f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<Sight> {
        let elapsed = scale(elapsed, self.job.plan.units.time);
        let turned = self.turns.as_ref().map_or(&[][..], |turns| &turns.now);
        let view = View { bodies, origin: &unit.origin, elapsed, turned };
        let around = Surroundings {
            scene: self.job.scene,
            copy: unit.unit.copy,
            bodies: &self.bodies.indices,
            massive: self.massive,
            working: self.working.get(event).and_then(Option::as_ref),
        };
        let (event, places) = self.event(event);
        event.sight(&view, places, &around, ticker)
    }

    /// Comes to the end of a step; whether there may be zeros in it, and it must be looked into before the next.
    ///
    /// # Errors
    /// Those of the functions.
    pub(super) fn step(
        &mut self,
        unit: &Prepared,
        span: Span,
        state: &State<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        self.bodies.read(state, &mut self.after);
        self.turn(unit, state, span.to);
        let h = scale(span.to - span.from, self.job.plan.units.time);
        self.suspects.clear();
        for event in 0..self.events.len() {
            let sight = self.sight(unit, event, (&self.after, span.to), ticker)?;
            let ends = [&self.sights[event], &sight];
            let rates = if self.is_kept(event) { Some([0.0; 2]) } else { self.event(event).0.rates(ends, h) };
            let values = ends.map(|end| end.value);
            let expressed = self.expression_keeps_clear(unit, (event, values), span, h);
            let clear = expressed.unwrap_or_else(|| {
                rates.is_some_and(|rates| {
                    let cubic = cubic(values, rates, h);
                    keeps_clear(cubic) || keeps_clear_after_all(cubic)
                })
            });
            if !clear {
                self.suspects.push(event);
            }
            self.next[event] = sight;
        }
        self.suspect_spheres(h);
        let suspected = !self.suspects.is_empty();
        if !suspected {
            self.go_on();
        }
        Ok(suspected)
    }

    /// Turns to the beginning of a step, if the last that was come to the end of is not the one before it.
    ///
    /// # Errors
    /// Those of the functions.
    pub(super) fn turn_to(
        &mut self,
        unit: &Prepared,
        elapsed: f64,
        state: &State<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.bodies.read(state, &mut self.before);
        self.turn(unit, state, elapsed);
        if let Some(contacts) = &mut self.contacts {
            contacts.go_on(&self.before);
        }
        for event in 0..self.events.len() {
            self.sights[event] = self.sight(unit, event, (&self.before, elapsed), ticker)?;
        }
        Ok(())
    }

    fn go_on(&mut self) {
        core::mem::swap(&mut self.before, &mut self.after);
        core::mem::swap(&mut self.sights, &mut self.next);
    }

    /// Looks into the step that was come to the end of, which leads to the state in a lane.
    ///
    /// # Errors
    /// Those of the functions and of the evaluations that the inside of the step takes.
    pub(super) fn look(
        &mut self,
        unit: &Prepared,
        span: Span,
        (after, lane): (&State<Lanes>, usize),
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.ask(step, ticker)?;
        let zeros = self.zeros_in_step(unit, span, step, ticker)?;
        for (place, &((theta, _), event)) in zeros.iter().enumerate() {
            // Of the state nothing is lost to the rounding of the time.
            let elapsed = scale(span.at(theta), self.job.plan.units.time);
            let (t, t_rest) = self.job.scene.time_after(elapsed);
            let state = if theta == 1.0 { after } else { step.at(theta, ticker)? };
            let states = (0..unit.unit.bodies.len()).map(|slot| {
                let entry = unit.read(slot, state, lane, elapsed);
                [entry.position, entry.velocity]
            });
            let states: Vec<[[f64; 3]; 2]> = states.collect();
            // Where another body has ceased to be a number there is no state to stop in: the run ends by that.
            if states.iter().flatten().flatten().any(|x| !x.is_finite()) {
                break;
            }
            let turned = unit.turned(self.job.scene, state, lane);
            let mut found = Found { which: usize::MAX, t, t_rest, states, turned, spheres: None };
            let Some(&(which, _)) = self.events.get(event) else {
                found.spheres = match self.event(event).0.what {
                    What::Distance { bodies, .. } => Some(bodies),
                    _ => None,
                };
                found.which = self.contacts.as_ref().map_or(usize::MAX, |contacts| contacts.which);
                self.found.push(found);
                self.stopped = true;
                break;
            };
            found.which = which;
            self.counts[event] += 1;
            if self.event(event).0.last.is_some_and(|last| self.counts[event] >= last) {
                self.bodies.read(state, &mut self.inside);
                self.turn(unit, state, span.at(theta));
                self.tell_what_is_over(unit, &zeros[place + 1..], (&found, span.at(theta)), ticker)?;
                self.found.push(found);
                self.stopped = true;
                break;
            }
            self.found.push(found);
        }
        if let (Some(contacts), false) = (&mut self.contacts, self.pairs.is_empty()) {
            contacts.go_on(&self.after);
            self.pairs.clear();
            self.sights.truncate(self.events.len());
            self.next.truncate(self.events.len());
        }
        self.go_on();
        Ok(())
    }
}
