//! The plan: a pure function from (scene, request) to what will be done and what will be skipped.

mod coupling;
mod events;
mod explain;
mod kinds;
mod own;
mod parts;
mod passage;
mod quiet;
mod refusals;
mod series;
mod solutions;
mod threads;
mod tolerances;
mod turn;
mod turning;
mod units;

pub use coupling::Groups;
pub use explain::Row;
pub use solutions::{Solutions, member};
pub use turn::TooLong;

pub(in crate::scene) use refusals::with_equal_steps;
pub use turning::{Turning, steps_bodies};
pub(in crate::scene) use turning::{are_series_poor, with_method};

use super::Scene;
use super::collisions::Collisions;
use super::events::{Event, What};
use super::frame::{Frame, Origin, Units};
use super::layout::Layout;
use super::request::{Checked, Request};
use super::unit::Unit;
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::following::Leaders;
use crate::forces::gravity::RING_MAX;
use crate::forces::gravity::closed::serves;
use crate::forces::term::Coupling;
use crate::forces::together::Energy;
use crate::ode::transformation::Transformation;
use crate::ode::{Method, Scheme};
use crate::parallel::Ticker;
use kinds::{Looks, kinds_of_forces};
use own::{Own, about, acting};
use quiet::Quiet;
use std::sync::Arc;

/// The relative tolerance at which what has a closed form is integrated for its events: the errors of thousands of turns are
/// then those of rounding.
const AS_KNOWN: f64 = 3e-14;
/// What part of a run a step is at most, where forces may change within any.
const LARGEST_PART: f64 = 1.0 / 128.0;
/// Massless bodies in one unit with the massive ones, where they cannot follow them.
const PASSIVE_PER_UNIT: usize = 64;

/// What will be done.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The method of an integration.
    pub method: &'static Method,
    /// The signed step of a fixed-step method, if it is the same in time.
    pub dt: Option<f64>,
    /// What is watched where steps are equal in another time, and the signed step at the start.
    pub transformed: Option<(Transformation, f64)>,
    /// +1 forward, -1 backward.
    pub direction: f64,
    /// How the motion of each ensemble member is found.
    pub solutions: Solutions,
    /// How it would be found if no events were looked for, where that is asked of steps alone.
    known: Option<Solutions>,
    /// The forces that do something, in order; those of the first copy, if copies have their own.
    pub forces: Vec<Arc<dyn ForceTerm>>,
    /// Those of each copy, if they differ.
    own: Option<Own>,
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
    /// About what bodies are integrated.
    pub frame: Frame,
    /// Forces that accelerate all alike, which the origin's motion takes out.
    pub alike: usize,
    /// The time that is planned for: from the start to the end, or a step if all are equal.
    pub span: f64,
    /// The longest step where none is asked for, if the method chooses its own and forces may change within any.
    longest_untold: Option<f64>,
    /// Whether the method moves the massive bodies relative to the first one.
    pub relative: bool,
    /// How units lie in lanes.
    pub layout: Layout,
    /// Whether massless bodies follow the steps of the massive ones, each with steps of its own.
    pub guided: bool,
    /// What spheres do that touch, if that is asked for.
    pub collisions: Option<Collisions>,
    /// Whether any body has a radius.
    pub spheres: bool,
    /// Whether spheres that touch are looked for, and all bodies therefore on the same steps.
    pub touching: bool,
    /// Whether what neighbors of the motion do is asked for, and all bodies therefore on the same steps.
    pub neighbors: bool,
    /// Threads over units, and inside one force evaluation.
    pub threads: (usize, usize),
    /// Output times between the start and the end.
    pub outputs_between: usize,
    /// What is looked for on the way.
    pub events: Arc<[Event]>,
    /// Columns to be computed.
    pub record: Vec<String>,
    /// What might serve a long run better than the method that was chosen for it.
    quiet: Option<Quiet>,
    /// Its step, if that tells nothing of an orbit on which a body is at the start.
    pub too_long: Option<TooLong>,
    /// What the energy of a copy does by itself.
    pub energy: Energy,
    /// The time of the scene.
    pub t0: f64,
    /// The node that the run goes on from; 0 is the scene.
    pub from: u64,
    /// Sets of forces that copies have of their own.
    pub sets_of_forces: usize,
    /// The kind of the forces of each copy, if copies have their own: each kind is planned by itself, and this plan is that
    /// of the first.
    pub kinds: Vec<usize>,
    /// Of each force that joins listed bodies, which these are, in order.
    joined: Vec<Option<Box<[usize]>>>,
    /// How rigid bodies turn.
    pub turning: Turning,
    /// What the steps of a part of the run may be off, where they are chosen for bodies that torques turn.
    pub tolerance: Option<f64>,
    /// What the steps that are chosen for them are held to, where nobody named the method.
    pub held_to: Option<f64>,
    /// How many rigid bodies each copy has.
    pub rigid: usize,
    /// Of what make each of them is.
    makes: Vec<usize>,
    copies: usize,
    particles: usize,
}

impl Plan {
    /// Plans a run.
    ///
    /// # Errors
    /// As [`Scene::validate`] and [`Request::check`]: bad input is refused here, before anything runs. When the caller asks
    /// to stop.
    pub fn new(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Self> {
        Self::of(scene, request, false, ticker)
    }

    /// Plans a run, or that of a scene beside its neighbors, in which all bodies are on the same steps.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(scene: &Scene, request: &Request, neighbors: bool, ticker: &mut Ticker<'_>) -> Result<Self> {
        scene.validate()?;
        ticker.tick()?;
        let with_step = with_method(scene, request);
        let in_parts = |with_step: &&Request| request.dt.is_none() && with_step.dt.is_some();
        let tolerance = with_step.as_ref().filter(in_parts).map(|request| request.rtol);
        let chooses_all = |with_step: &&Request| with_step.dt.is_none() && request.atol.is_none();
        let held_to = with_step.as_ref().filter(chooses_all).map(turning::held_to);
        let request = with_step.as_ref().unwrap_or(request);
        let Checked { method, automatic, direction, dt, transformed } = request.check(scene)?;
        let held_to = held_to.or_else(|| tolerances::of_itself(automatic, request));
        let massive = |i: &usize| (0..scene.copies).any(|copy| scene.masses(copy)[*i] > 0.0);
        let forces = acting(scene, &scene.forces);
        refusals::check_method(method, &forces)?;
        let turning = Turning::of(scene, method, &forces);
        if scene.rigid.is_some() && request.collisions.is_some() {
            let message = "expected None beside rigid bodies, of which no contact is known";
            return Err(Error::invalid("collisions", message));
        }
        if turning.steps() {
            turning::check(scene, request, method, &forces)?;
        }
        // Spheres may touch whichever they are: all of them are on one step.
        let touching = request.events.iter().any(|event| matches!(event.what, What::Contact(_)));
        let groups = if touching || neighbors { Groups::All } else { turning::groups(scene, &forces) };
        let (active, passive) = match &groups {
            Groups::All => (0..scene.particles).partition(massive),
            Groups::Listed(groups) => {
                let coupled = |i: &usize| groups.iter().any(|group| group.binary_search(i).is_ok());
                (0..scene.particles).partition(coupled)
            }
            Groups::Single => (Vec::new(), (0..scene.particles).collect()),
        };
        series::check(method, &forces, &active, &passive, &groups)?;
        let chosen = if automatic && !turning.steps() && !neighbors {
            series::first_choice(&forces, &active, &passive, (&groups, touching))
        } else {
            None
        };
        let method = chosen.unwrap_or(method);
        // Events are looked for on steps.
        let closed_forms = automatic && request.events.is_empty() && !turning.steps() && !neighbors;
        let solutions = match &request.events[..] {
            _ if closed_forms => Solutions::of(scene, ticker)?,
            [_] if automatic && touching => Solutions::of(scene, ticker)?.straight_lines(),
            _ => Solutions::integration(scene.copies),
        };
        // A contact ends a leg of a run, and the next begins anew.
        let known = if automatic && !closed_forms && !turning.steps() && !touching && !neighbors {
            Some(Solutions::of(scene, ticker)?)
        } else {
            None
        };
        let end = request.times[request.times.len() - 1];
        let integrated = solutions.integrates().then_some([scene.t0, end]);
        if let (Some(times), None) = (integrated, &scene.own_forces) {
            refusals::check_drives(&forces, times)?;
        }
        // Neighbors leave a plane.
        let planar = planar(scene, &forces) && !turning.steps() && !neighbors;
        let count = forces.len();
        // Points of bodies may be held in space, or tied to it.
        let moves = solutions.integrates() && !turning.steps();
        let (forces, frame) = about(forces, moves);
        let alike = count - forces.len();
        let own = Own::of(scene, method, integrated, moves)?;
        let relative = matches!(&forces[..], [force] if force.as_newtonian().is_some())
            && groups == Groups::All
            && !touching
            && !neighbors
            && !turning.steps()
            && serves(method, active.len());
        if let Some((by, _)) = transformed {
            refusals::check_transformation(by, scene, matches!(frame, Frame::Falling(_)))?;
        }
        // A copy gives the same alone as among others, so a kernel that has no packed form serves it alone, too.
        let batched = match groups {
            _ if turning.steps() => true,
            Groups::Single => true,
            Groups::All if touching => {
                scene.copies > 1 && scene.particles <= RING_MAX && transformed.is_none()
            }
            // Each massless body goes with the massive ones in a time of its own; they have no other bits for it.
            Groups::All if transformed.is_some() => active.len() <= RING_MAX,
            Groups::All => relative || (scene.copies > 1 && scene.particles <= RING_MAX),
            Groups::Listed(_) if matches!(method.scheme, Scheme::Taylor(_)) => {
                (scene.copies > 1 || groups.sizes(&forces).len() > 1)
                    && !series::links_abreast(&groups, &forces)
            }
            Groups::Listed(_) => scene.copies > 1 || groups.largest(scene.particles) <= RING_MAX,
        };
        let layout = if batched { Layout::Batched } else { Layout::Packed };
        let whole = (end - scene.t0).abs();
        // Equal steps go on from where they ended: their units must not depend on where that was.
        let span = dt.map_or(whole, f64::abs);
        let chooses = dt.is_none() && request.max_step.is_none() && !turning.steps();
        let longest_untold = Some(whole * LARGEST_PART)
            .filter(|step| chooses && *step > 0.0 && forces.iter().any(|force| force.may_change_anywhere()));
        let joined = forces.iter().map(|force| coupling::joined_by(&**force)).collect();
        let mut plan = Self {
            method,
            dt,
            transformed,
            direction,
            solutions,
            known,
            planar,
            alike,
            span,
            longest_untold,
            units: units(scene, 0, frame, &groups, span),
            forces,
            own,
            groups,
            active,
            passive,
            frame,
            relative,
            layout,
            guided: false,
            collisions: request.collisions,
            spheres: scene.radius.iter().any(|&radius| radius > 0.0),
            touching,
            neighbors,
            threads: (1, 1),
            outputs_between: request.outputs_between(scene.t0),
            events: request.events.clone().into(),
            record: request.record.clone(),
            quiet: None,
            too_long: None,
            // Members that run together have forces of one kind.
            energy: Energy::under(&scene.forces, &scene.bodies()),
            t0: scene.t0,
            from: 0,
            sets_of_forces: scene.own_forces.as_ref().map_or(1, |own| own.sets.len()),
            kinds: kinds_of_forces(
                scene,
                match method.scheme {
                    _ if transformed.is_some() => Looks::Transformation,
                    Scheme::Taylor(_) => Looks::Series,
                    _ => Looks::Nobody,
                },
            ),
            joined,
            turning,
            tolerance,
            held_to,
            rigid: scene.rigid.as_ref().map_or(0, |bodies| bodies.count),
            makes: turning::makes(scene),
            copies: scene.copies,
            particles: scene.particles,
        };
        plan.forces.iter().try_for_each(|force| force.check_units(plan.units))?;
        plan.guided = plan.method.adaptive() && plan.passive_apart() && plan.forces.iter().all(guides);
        plan.threads = plan.share_threads(request);
        if !plan.turning.steps() {
            plan.too_long = turn::too_long(scene, &plan.forces, method, (dt, whole), touching);
        }
        if automatic && chosen.is_none() && plan.solutions.integrates() {
            plan.quiet = quiet::quiet(scene, &plan.forces, direction * whole);
        }
        Ok(plan)
    }

    /// Whether the motion of a copy is integrated for its events alone: without any it would be known.
    pub fn knows(&self, copy: usize) -> bool {
        self.known.as_ref().is_some_and(|known| known.of_member(copy).is_some())
    }

    /// The units for a copy by itself.
    pub fn units_of(&self, scene: &Scene, copy: usize) -> Units {
        units(scene, copy, self.frame_of(copy), &self.groups, self.span)
    }

    /// Whether a force acts on some of these bodies: not if it joins others.
    pub fn acts_on(&self, force: usize, bodies: &[usize]) -> bool {
        let joined = self.joined.get(force).and_then(Option::as_ref);
        joined.is_none_or(|joined| !bodies.is_sorted() || coupling::meet(joined, bodies))
    }

    /// The forces that do something in a copy, in order.
    pub fn forces_of(&self, copy: usize) -> &[Arc<dyn ForceTerm>] {
        self.own.as_ref().map_or(&self.forces, |own| own.forces(copy))
    }

    /// About what the bodies of a copy are integrated.
    fn frame_of(&self, copy: usize) -> Frame {
        self.own.as_ref().map_or(self.frame, |own| own.frame(copy))
    }

    /// The origin for a unit: all that are coupled have one.
    pub fn origin_of(&self, scene: &Scene, unit: &Unit) -> Origin {
        let bodies = match self.groups {
            Groups::All if !self.active.is_empty() => &self.active,
            _ => &*unit.bodies,
        };
        self.frame_of(unit.copy).origin(scene, unit.copy, bodies.iter().copied())
    }

    /// Whether each unit takes its steps at times of its own.
    pub fn has_own_times(&self) -> bool {
        self.method.adaptive() || self.transformed.is_some()
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

/// The units for a copy, in a run over that span of time.
fn units(scene: &Scene, copy: usize, frame: Frame, groups: &Groups, span: f64) -> Units {
    // Bodies by themselves have no size about their own places.
    let frame =
        if matches!(frame, Frame::Falling(_)) && *groups != Groups::Single { frame } else { Frame::Given };
    Units::of(scene, copy, &frame.origin(scene, copy, 0..scene.particles), span)
}

/// Whether massless bodies feel the force along a path of the massive ones, or without them; listed pairs have mass.
fn guides(force: &Arc<dyn ForceTerm>) -> bool {
    let nobody = Leaders { bodies: &[], components: 3, units: Units::default(), expands: false };
    force.coupling() != Coupling::AllPairs || force.following(&nobody).is_some()
}

fn planar(scene: &Scene, forces: &[Arc<dyn ForceTerm>]) -> bool {
    scene.position.iter().chain(&scene.velocity).all(|x| x[2] == 0.0)
        && forces.iter().all(|force| force.keeps_plane())
}
