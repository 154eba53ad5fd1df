//! What a run with fixed steps leaves behind at a node, so that another goes on to the bits of one run.
//!
//! The one idea: a run that goes on is planned from the scene at which the first one began, to the same units, origin and
//! times of nodes. So all that has to be kept is that beginning and, at the node, the numbers that the integrator holds
//! there: each with its compensation, and what a method keeps of the past.

use super::Scene;
use super::plan::Plan;
use super::request::Request;
use super::unit::{Prepared, Turned, Unit};
use crate::error::Result;
use crate::memory;
use crate::numerics::real::Real;
use crate::ode::Method;
use crate::ode::fixed::{Place, place};
use crate::parallel::Ticker;
use crate::registry;

/// What the numbers mean; another number as soon as they mean something else.
pub const FORM: i64 = 1;

/// More numbers than these are not kept: 256 MiB.
const MOST: usize = 1 << 25;

/// Blocks of a state: coordinates and velocities, each with what they leave out.
const STATE_BLOCKS: usize = 4;

/// What a scene keeps of the run that ended in it.
#[derive(Clone, Debug)]
pub struct Continuation {
    /// What the numbers mean: [`FORM`], or they are not read.
    pub form: i64,
    /// The method.
    pub method: String,
    /// Its signed step.
    pub dt: f64,
    /// The time at which the first run began.
    pub t0: f64,
    /// The positions there, as those of the scene.
    pub position: Vec<[f64; 3]>,
    /// The velocities there.
    pub velocity: Vec<[f64; 3]>,
    /// The orientations of rigid bodies there, and their angular velocities.
    pub turned: Vec<Turned>,
    /// The node that has been reached.
    pub node: u64,
    /// What is held there, of each copy.
    pub held: Held,
}

/// Numbers of bodies, copy after copy, in blocks of points.
#[derive(Clone, Debug, Default)]
pub struct Held {
    /// Blocks of each copy.
    pub blocks: usize,
    /// Points in a block: of each particle, then of the massive ones as they are integrated beside massless ones, where
    /// these are apart, or two for each rigid body that is turned.
    pub slots: usize,
    /// The points, three numbers each.
    pub numbers: Vec<f64>,
}

/// What a unit holds at a node: block after block, the bodies of the unit in each.
#[derive(Clone, Debug)]
pub struct UnitHeld {
    /// The node.
    pub node: u64,
    /// The points.
    pub points: Vec<[f64; 3]>,
}

/// Blocks that a method holds, those of the state among them.
pub fn blocks(method: &Method) -> usize {
    STATE_BLOCKS + method.held()
}

/// Massive bodies that have places of their own beside massless ones.
fn beside(plan: &Plan) -> usize {
    if plan.passive_apart() { plan.active.len() } else { 0 }
}

/// Points in a block of a copy.
fn slots(plan: &Plan, particles: usize) -> usize {
    let turned = if plan.turning.steps() { plan.rigid } else { 0 };
    particles + beside(plan) + 2 * turned
}

/// The places of the bodies of a unit in a block of its copy.
struct Places<'a> {
    unit: &'a Unit,
    particles: usize,
    /// How many of them have places beside massless ones.
    beside: usize,
    /// The places among the rigid ones of those that are turned.
    turned: Vec<usize>,
}

impl<'a> Places<'a> {
    fn new(plan: &Plan, particles: usize, unit: &'a Unit) -> Self {
        let beside = if unit.bodies.len() > unit.active { beside(plan) } else { 0 };
        let rigid = |&body: &usize| plan.rigid_place(body).filter(|_| plan.turning.steps());
        Self { unit, particles, beside, turned: unit.bodies.iter().filter_map(rigid).collect() }
    }

    /// How many there are.
    fn count(&self) -> usize {
        self.unit.bodies.len() + 2 * self.turned.len()
    }

    fn of(&self, slot: usize) -> usize {
        match slot.checked_sub(self.unit.bodies.len()) {
            // Bodies that are turned have no massless ones apart.
            Some(half) => self.particles + 2 * self.turned[half / 2] + half % 2,
            None if slot < self.beside => self.particles + slot,
            None => self.unit.bodies[slot],
        }
    }
}

impl Held {
    /// What one copy holds.
    pub fn of_copy(&self, copy: usize) -> Self {
        let numbers = self.numbers[self.at(copy, 0, 0)..self.at(copy + 1, 0, 0)].to_vec();
        Self { numbers, ..*self }
    }

    /// The same of one copy whose bodies are these: each in the place where it was.
    pub fn of_bodies(&self, places: &[usize]) -> Self {
        let point = |block, &place: &usize| &self.numbers[self.at(0, block, place)..][..3];
        let numbers =
            (0..self.blocks).flat_map(|block| places.iter().flat_map(move |place| point(block, place)));
        Self { numbers: numbers.copied().collect(), slots: places.len(), ..*self }
    }

    /// Room for what copies of a scene hold that run by these plans; `None` if it would be too much.
    ///
    /// # Errors
    /// As [`memory::check`].
    pub fn room<'p>(
        scene: &Scene,
        method: &Method,
        plans: impl Iterator<Item = &'p Plan>,
    ) -> Result<Option<Self>> {
        let slots = plans.map(|plan| slots(plan, scene.particles)).max().unwrap_or(scene.particles);
        let blocks = blocks(method);
        let len = [scene.copies, slots, blocks].into_iter().try_fold(3_usize, usize::checked_mul);
        let Some(len) = len.filter(|&len| len <= MOST) else { return Ok(None) };
        let [mut numbers] =
            memory::reserved("t", "what a run leaves behind for another to go on", Some(len))?;
        numbers.resize(len, 0.0);
        Ok(Some(Self { blocks, slots, numbers }))
    }

    /// Where a point of a block begins.
    fn at(&self, copy: usize, block: usize, place: usize) -> usize {
        ((copy * self.blocks + block) * self.slots + place) * 3
    }

    /// Takes in what a unit of a copy holds.
    pub fn put(&mut self, plan: &Plan, particles: usize, (copy, unit): (usize, &Unit), held: &UnitHeld) {
        let places = Places::new(plan, particles, unit);
        for (block, points) in held.points.chunks(places.count().max(1)).enumerate() {
            for (slot, point) in points.iter().enumerate() {
                let at = self.at(copy, block, places.of(slot));
                self.numbers[at..at + 3].copy_from_slice(point);
            }
        }
    }
}

impl Continuation {
    /// The scene from which to plan, if the run goes on with the steps that led to this scene.
    pub fn start(scene: &Scene, request: &Request) -> Option<Scene> {
        let from = scene.continuation.as_ref()?;
        let mut methods = registry::methods_for(scene.rigid.is_some());
        let (method, dt) = (methods.find(|method| method.name == request.method)?, request.dt?);
        if request.time_transformation.is_some() {
            return None;
        }
        let end = request.times.last().copied()?;
        let points = scene.copies * scene.particles;
        let fits = from.form == FORM
            && from.method == method.name
            && from.dt.abs() == dt.abs()
            && (end - scene.t0) * from.dt >= 0.0
            && from.held.blocks == blocks(method)
            && from.held.slots >= scene.particles
            && from.held.numbers.len() == from.held.at(scene.copies, 0, 0)
            && [&from.position, &from.velocity, &scene.position, &scene.velocity]
                .iter()
                .all(|of| of.len() == points)
            && from.turned.len() == scene.rigid.as_ref().map_or(0, |bodies| bodies.orientation.len())
            && from.place(scene.t0) == Place { node: from.node, past: None };
        fits.then(|| Scene {
            copies: scene.copies,
            particles: scene.particles,
            mass: scene.mass.clone(),
            position: from.position.clone(),
            velocity: from.velocity.clone(),
            radius: scene.radius.clone(),
            rigid: scene.rigid.clone().map(|bodies| bodies.at(&from.turned)),
            forces: scene.forces.clone(),
            own_forces: scene.own_forces.clone(),
            t0: from.t0,
            t0_rest: 0.0,
            continuation: None,
        })
    }

    fn place(&self, t: f64) -> Place {
        place(t - self.t0, self.dt, Real::max(t.abs(), self.t0.abs()))
    }

    /// A point of a block that a unit of a copy holds.
    pub fn point(
        &self,
        plan: &Plan,
        particles: usize,
        (copy, unit): (usize, &Unit),
        block: usize,
        slot: usize,
    ) -> [f64; 3] {
        let at = self.held.at(copy, block, Places::new(plan, particles, unit).of(slot));
        core::array::from_fn(|c| self.held.numbers[at + c])
    }

    /// Whether what is held is the state of the scene, to the bit: `start` and `plan` are of the copies `members` of it. Of no
    /// use to a caller who asks to stop.
    pub fn agrees(
        &self,
        scene: &Scene,
        (start, plan): (&Scene, &Plan),
        members: Option<&[usize]>,
        ticker: &mut Ticker<'_>,
    ) -> bool {
        let elapsed = scene.t0 - self.t0;
        let fits = self.held.slots >= slots(plan, scene.particles);
        fits && plan.unit_list().into_iter().filter(|unit| !unit.recorded.is_empty()).all(|unit| {
            let copy = members.map_or(unit.copy, |members| members[unit.copy]);
            let Ok(unit) = Prepared::new(plan, start, unit, ticker) else { return false };
            let point = |block, slot| self.point(plan, scene.particles, (copy, &unit.unit), block, slot);
            let turned = |half: usize, place: usize| {
                let first = unit.unit.bodies.len() + 2 * place;
                let ([x, y, z], [w, ..]) = (point(half, first), point(half, first + 1));
                [x, y, z, w]
            };
            unit.turns_agree(scene, copy, |place| [turned(0, place), turned(2, place)])
                && unit.unit.recorded.clone().all(|slot| {
                    let [q, q_rest, v, v_rest] = core::array::from_fn(|block| point(block, slot));
                    let entry = unit.entry([q, q_rest], [v, v_rest], elapsed);
                    let body = unit.unit.bodies[slot];
                    // The velocity of a body that is held follows from its turning.
                    entry.position == scene.positions(copy)[body]
                        && (entry.velocity == scene.velocities(copy)[body] || unit.is_held(plan, scene, body))
                })
        })
    }
}
