//! The plan: a pure function from (scene, request) to what will be done and what will be skipped.

mod explain;

pub use explain::Row;

use super::frame::{Origin, Units};
use super::layout::Layout;
use super::request::{Checked, Request};
use super::unit::Unit;
use super::{ForceSpec, Scene};
use crate::error::Result;
use crate::forces::gravity::RING_MAX;
use crate::forces::gravity::closed::serves;
use crate::ode::Method;
use core::ops::Range;
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
    pub forces: Vec<ForceSpec>,
    /// Gravity among them: (constant, softening).
    pub gravity: Option<(f64, f64)>,
    /// Bodies that attract.
    pub active: Vec<usize>,
    /// Bodies that do not.
    pub passive: Vec<usize>,
    /// Whether everything stays in the plane z = 0.
    pub planar: bool,
    /// Units of the integration.
    pub units: Units,
    /// Its origin, for each copy.
    pub origins: Vec<Origin>,
    /// Whether the method moves the massive bodies relative to the first one.
    pub relative: bool,
    /// How units lie in lanes.
    pub layout: Layout,
    /// Threads over units, and inside one force evaluation.
    pub threads: (usize, usize),
    /// Output times between the start and the end.
    pub outputs_between: usize,
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
        let gravity = forces.iter().find_map(|force| match force {
            ForceSpec::Gravity { constant, softening } => Some((*constant, *softening)),
            _ => None,
        });
        let (active, passive) = match gravity {
            Some(_) => (0..scene.particles).partition(massive),
            None => (Vec::new(), (0..scene.particles).collect()),
        };
        let solution = if automatic { closed_form(scene, &forces, &active) } else { Solution::Integration };
        let closed =
            !forces.is_empty() && forces.iter().all(|force| matches!(force, ForceSpec::Gravity { .. }));
        let origins: Vec<Origin> = (0..scene.copies).map(|copy| Origin::of(scene, copy, closed)).collect();
        let relative = closed && forces.len() == 1 && serves(method, active.len());
        // A copy gives the same alone as among others, so a kernel that has no packed form serves it alone, too.
        let batched = gravity.is_none() || relative || (scene.copies > 1 && scene.particles <= RING_MAX);
        let layout = if batched { Layout::Batched } else { Layout::Packed };
        let mut plan = Self {
            method,
            dt,
            direction,
            solution,
            planar: planar(scene, &forces),
            units: Units::of(scene, &origins),
            forces,
            gravity,
            active,
            passive,
            origins,
            relative,
            layout,
            threads: (1, 1),
            outputs_between: outputs_between(scene, request),
            record: request.record.clone(),
            copies: scene.copies,
            particles: scene.particles,
        };
        plan.threads = plan.share_threads(request.threads);
        Ok(plan)
    }

    fn share_threads(&self, threads: usize) -> (usize, usize) {
        if self.solution != Solution::Integration {
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
        (self.method.adaptive() || self.relative) && !self.active.is_empty() && !self.passive.is_empty()
    }

    /// The units of the integration, in the order in which they are begun.
    pub fn unit_list(&self) -> Vec<Unit> {
        let active = self.active.len();
        // What each copy is made of: bodies, how many of them attract, which are recorded.
        let kinds: Vec<(Arc<[usize]>, usize, Range<usize>)> = if self.gravity.is_none() {
            self.passive.iter().map(|&i| (Arc::from([i]), 0, 0..1)).collect()
        } else if self.passive_apart() {
            let with_active = |run: &[usize]| {
                let bodies: Arc<[usize]> = self.active.iter().chain(run).copied().collect();
                let recorded = active..bodies.len();
                (bodies, active, recorded)
            };
            let massive = (Arc::from(&self.active[..]), active, 0..active);
            core::iter::once(massive).chain(self.passive.chunks(PASSIVE_PER_UNIT).map(with_active)).collect()
        } else {
            let bodies: Arc<[usize]> = self.active.iter().chain(&self.passive).copied().collect();
            let recorded = 0..bodies.len();
            vec![(bodies, active, recorded)]
        };
        (0..self.copies)
            .flat_map(|copy| kinds.iter().map(move |kind| (copy, kind)))
            .map(|(copy, (bodies, active, recorded))| Unit {
                copy,
                bodies: Arc::clone(bodies),
                active: *active,
                recorded: recorded.clone(),
            })
            .collect()
    }

    /// Pairs that one force evaluation of one copy forms.
    pub fn pairs_per_evaluation(&self) -> u64 {
        let (active, passive) = (self.active.len() as u64, self.passive.len() as u64);
        if self.gravity.is_some() { active * active.saturating_sub(1) / 2 + active * passive } else { 0 }
    }
}

/// The forces that do anything in this scene.
fn effective_forces(scene: &Scene) -> Vec<ForceSpec> {
    let attracts = scene.particles > 1 && scene.mass.iter().any(|&mass| mass > 0.0);
    let does_something = |force: &&ForceSpec| match force {
        ForceSpec::Gravity { constant, .. } => *constant != 0.0 && attracts,
        ForceSpec::UniformField { g } => g.iter().any(|&g| g != 0.0),
        ForceSpec::CentralField { potential, .. } => potential.inverse_distance_strength() != Some(0.0),
    };
    scene.forces.iter().filter(does_something).cloned().collect()
}

fn outputs_between(scene: &Scene, request: &Request) -> usize {
    let end = request.times[request.times.len() - 1];
    request.times.iter().filter(|&&t| (t != scene.t0) & (t != end)).count()
}

fn planar(scene: &Scene, forces: &[ForceSpec]) -> bool {
    scene.position.iter().chain(&scene.velocity).all(|x| x[2] == 0.0)
        && forces.iter().all(|force| match force {
            ForceSpec::Gravity { .. } => true,
            ForceSpec::UniformField { g } => g[2] == 0.0,
            ForceSpec::CentralField { center, .. } => center[2] == 0.0,
        })
}

fn closed_form(scene: &Scene, forces: &[ForceSpec], active: &[usize]) -> Solution {
    if forces.is_empty() {
        return Solution::Free;
    }
    let mut g = [0.0; 3];
    let mut uniform = true;
    for force in forces {
        match force {
            ForceSpec::UniformField { g: term } => {
                for c in 0..3 {
                    g[c] += term[c];
                }
            }
            _ => uniform = false,
        }
    }
    if uniform {
        return Solution::Uniform(g);
    }
    match forces {
        [ForceSpec::Gravity { softening, .. }] if *softening == 0.0 && scene.particles == 2 => {
            Solution::TwoBody
        }
        [ForceSpec::Gravity { softening, .. }] if *softening == 0.0 && active.len() == 1 => {
            Solution::OneMassive(active[0])
        }
        [ForceSpec::CentralField { potential, center }] => match potential.inverse_distance_strength() {
            Some(k) => Solution::FixedCenter { k, center: *center },
            None => Solution::Integration,
        },
        _ => Solution::Integration,
    }
}
