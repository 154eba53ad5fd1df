//! The plan: a pure function from (scene, request) to what will be done and what will be skipped.

mod coupling;
mod events;
mod explain;

pub use coupling::Groups;
pub use explain::Row;

use super::Scene;
use super::events::Event;
use super::frame::{Origin, Units, closed};
use super::layout::Layout;
use super::request::{Checked, Request};
use super::unit::Unit;
use crate::error::Result;
use crate::forces::ForceTerm;
use crate::forces::gravity::RING_MAX;
use crate::forces::gravity::closed::serves;
use crate::forces::term::Coupling;
use crate::ode::Method;
use std::sync::Arc;

/// From this many pairs per evaluation on, one force evaluation is shared out over threads.
const PAIRS_FOR_THREADS: u64 = 60_000;
/// From this many units times pairs on, units are shared out over threads: fewer are done before a thread wakes.
const WORK_FOR_THREADS: u64 = 64;
/// Massless bodies that share the steps of one adaptive unit.
const PASSIVE_PER_UNIT: usize = 64;

/// How the motion is found.
#[derive(Clone, Debug, PartialEq)]
pub enum Solution {
    /// No force acts: straight lines.
    Free,
    /// The same acceleration on everything: parabolas.
    Uniform([f64; 3]),
    /// Two bodies, at least one of them massive.
    TwoBody,
    /// One massive body, and massless ones that orbit it.
    OneMassive(usize),
    /// An inverse-distance potential `k/r` of a fixed centre.
    FixedCenter {
        /// Its strength.
        k: f64,
        /// Its place.
        center: [f64; 3],
    },
    /// Step by step.
    Integration,
}

/// What will be done.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The method of an integration.
    pub method: &'static Method,
    /// The signed step of a fixed-step method.
    pub dt: Option<f64>,
    /// +1 forward, -1 backward.
    pub direction: f64,
    /// How the motion is found.
    pub solution: Solution,
    /// The forces that do something, in order.
    pub forces: Vec<Arc<dyn ForceTerm>>,
    /// What they make depend on each other.
    pub groups: Groups,
    /// Bodies on which others depend.
    pub active: Vec<usize>,
    /// Bodies on which none does.
    pub passive: Vec<usize>,
    /// Whether everything stays in the plane z = 0.
    pub planar: bool,
    /// Units of the integration.
    pub units: Units,
    /// Its origin, for each copy.
    pub origins: Vec<Origin>,
    /// Forces that accelerate all alike, which the origin's motion takes out.
    pub alike: usize,
    /// The time from the start to the end.
    pub span: f64,
    /// Whether the method moves the massive bodies relative to the first one.
    pub relative: bool,
    /// How units lie in lanes.
    pub layout: Layout,
    /// Threads over units, and inside one force evaluation.
    pub threads: (usize, usize),
    /// Output times between the start and the end.
    pub outputs_between: usize,
    /// What is looked for on the way.
    pub events: Arc<[Event]>,
    /// Columns to be computed.
    pub record: Vec<String>,
    copies: usize,
    particles: usize,
}

impl Plan {
    /// Plans a run.
    ///
    /// # Errors
    /// As [`Scene::validate`] and [`Request::check`]: bad input is refused here, before anything runs.
    pub fn new(scene: &Scene, request: &Request) -> Result<Self> {
        scene.validate()?;
        let Checked { method, automatic, direction, dt } = request.check(scene)?;
        let massive = |i: &usize| (0..scene.copies).any(|copy| scene.masses(copy)[*i] > 0.0);
        let forces = effective_forces(scene);
        let groups = Groups::of(scene.particles, &forces);
        let (active, passive) = match &groups {
            Groups::All => (0..scene.particles).partition(massive),
            Groups::Listed(groups) => {
                let coupled = |i: &usize| groups.iter().any(|group| group.binary_search(i).is_ok());
                (0..scene.particles).partition(coupled)
            }
            Groups::Single => (Vec::new(), (0..scene.particles).collect()),
        };
        let solution = if automatic && request.events.is_empty() {
            closed_form(scene, &forces, &active)
        } else {
            Solution::Integration
        };
        let planar = planar(scene, &forces);
        let closed = solution == Solution::Integration && closed(&forces);
        let origin = |copy| if closed { Origin::of(scene, copy, &forces) } else { Origin::default() };
        let origins: Vec<Origin> = (0..scene.copies).map(origin).collect();
        // What accelerates all alike moves the origin, and nothing relative to it.
        let alike =
            if closed { forces.iter().filter(|force| force.as_uniform().is_some()).count() } else { 0 };
        let forces: Vec<_> =
            forces.into_iter().filter(|force| !closed || force.as_uniform().is_none()).collect();
        let relative = matches!(&forces[..], [force] if force.as_newtonian().is_some())
            && groups == Groups::All
            && serves(method, active.len());
        // A copy gives the same alone as among others, so a kernel that has no packed form serves it alone, too.
        let batched = match groups {
            Groups::Single => true,
            Groups::All => relative || (scene.copies > 1 && scene.particles <= RING_MAX),
            Groups::Listed(_) => scene.copies > 1 || groups.largest(scene.particles) <= RING_MAX,
        };
        let layout = if batched { Layout::Batched } else { Layout::Packed };
        let mut plan = Self {
            method,
            dt,
            direction,
            solution,
            planar,
            alike,
            span: (request.times[request.times.len() - 1] - scene.t0).abs(),
            units: Units::of(scene, 0, &origins[0]),
            forces,
            groups,
            active,
            passive,
            origins,
            relative,
            layout,
            threads: (1, 1),
            outputs_between: outputs_between(scene, request),
            events: request.events.clone().into(),
            record: request.record.clone(),
            copies: scene.copies,
            particles: scene.particles,
        };
        plan.threads = plan.share_threads(request.threads);
        Ok(plan)
    }

    fn share_threads(&self, threads: usize) -> (usize, usize) {
        let calls = self.events.iter().any(Event::calls);
        if calls || self.solution != Solution::Integration {
            return (1, 1);
        }
        let units = self.unit_list().len();
        let groups = units.div_ceil(self.layout.units());
        let pairs = self.pairs_per_evaluation();
        if groups == 1 && pairs >= PAIRS_FOR_THREADS {
            (1, threads)
        } else if (units as u64) * (1 + pairs) < WORK_FOR_THREADS {
            (1, 1)
        } else {
            (threads.min(groups), 1)
        }
    }

    /// Whether the massless bodies are integrated apart, so that they stay out of the massive ones' steps.
    pub fn passive_apart(&self) -> bool {
        self.groups == Groups::All
            && (self.method.adaptive() || self.relative)
            && !self.active.is_empty()
            && !self.passive.is_empty()
    }

    /// The units of the integration, in the order in which they are begun.
    pub fn unit_list(&self) -> Vec<Unit> {
        let mut kinds = self.kinds();
        self.watch(&mut kinds);
        let kinds = &kinds;
        (0..self.copies)
            .flat_map(|copy| kinds.iter().map(move |kind| Unit { copy, ..kind.clone() }))
            .collect()
    }

    /// What each copy is made of: a unit for each group of bodies.
    fn kinds(&self) -> Vec<Unit> {
        let none: Arc<[usize]> = Arc::from([]);
        let kind = |bodies: Arc<[usize]>, active, recorded, make_up| Unit {
            copy: 0,
            bodies,
            active,
            recorded,
            make_up,
            events: Arc::clone(&none),
        };
        let active = self.active.len();
        // Bodies by themselves are all of one make-up, whichever they are.
        let alone = |&body: &usize| kind(Arc::from([body]), 0, 0..1, 0);
        match &self.groups {
            Groups::Single => self.passive.iter().map(alone).collect(),
            Groups::Listed(groups) => {
                let group = |(index, bodies): (usize, &Arc<[usize]>)| {
                    kind(Arc::clone(bodies), bodies.len(), 0..bodies.len(), 1 + index)
                };
                groups.iter().enumerate().map(group).chain(self.passive.iter().map(alone)).collect()
            }
            Groups::All if self.passive_apart() => {
                let with_active = |run: &[usize]| {
                    let bodies: Arc<[usize]> = self.active.iter().chain(run).copied().collect();
                    let recorded = active..bodies.len();
                    kind(bodies, active, recorded, run.len())
                };
                let massive = kind(Arc::from(&self.active[..]), active, 0..active, 0);
                let massless = self.passive.chunks(PASSIVE_PER_UNIT).map(with_active);
                core::iter::once(massive).chain(massless).collect()
            }
            Groups::All => {
                let bodies: Arc<[usize]> = self.active.iter().chain(&self.passive).copied().collect();
                let recorded = 0..bodies.len();
                vec![kind(bodies, active, recorded, 0)]
            }
        }
    }

    /// Pairs that one force evaluation of one copy forms.
    pub fn pairs_per_evaluation(&self) -> u64 {
        let (active, passive) = (self.active.len() as u64, self.passive.len() as u64);
        let of = |force: &Arc<dyn ForceTerm>| match force.coupling() {
            Coupling::None => 0,
            Coupling::AllPairs => active * active.saturating_sub(1) / 2 + active * passive,
            Coupling::Listed(pairs) => pairs.len() as u64,
        };
        self.forces.iter().map(of).sum()
    }
}

/// The forces that do anything in this scene.
fn effective_forces(scene: &Scene) -> Vec<Arc<dyn ForceTerm>> {
    let bodies = scene.bodies();
    scene.forces.iter().filter(|force| force.acts(&bodies)).cloned().collect()
}

fn outputs_between(scene: &Scene, request: &Request) -> usize {
    let end = request.times[request.times.len() - 1];
    request.times.iter().filter(|&&t| (t != scene.t0) & (t != end)).count()
}

fn planar(scene: &Scene, forces: &[Arc<dyn ForceTerm>]) -> bool {
    scene.position.iter().chain(&scene.velocity).all(|x| x[2] == 0.0)
        && forces.iter().all(|force| force.keeps_plane())
}

fn closed_form(scene: &Scene, forces: &[Arc<dyn ForceTerm>], active: &[usize]) -> Solution {
    if forces.is_empty() {
        return Solution::Free;
    }
    let fields: Option<Vec<[f64; 3]>> = forces.iter().map(|force| force.as_uniform()).collect();
    if let Some(fields) = fields {
        let add = |sum: [f64; 3], g: [f64; 3]| core::array::from_fn(|c| sum[c] + g[c]);
        return Solution::Uniform(fields.into_iter().fold([0.0; 3], add));
    }
    let [force] = forces else { return Solution::Integration };
    match (force.as_newtonian(), force.as_inverse_distance_center()) {
        (Some((_, 0.0)), _) if scene.particles == 2 => Solution::TwoBody,
        (Some((_, 0.0)), _) if active.len() == 1 => Solution::OneMassive(active[0]),
        (_, Some((k, center))) => Solution::FixedCenter { k, center },
        _ => Solution::Integration,
    }
}
