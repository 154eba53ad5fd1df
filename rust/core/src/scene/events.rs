//! Events: functions of time and state whose zeros are looked for on the way of a run.
//!
//! The one idea: an event looks at some bodies, by how they move about the origin of their unit, so that no digit of a
//! difference is lost; it never steers. Where the zeros are sought is [`integrate`](super::integrate)'s `events`.
//!
//! Directions are those of increasing time, also in a run backwards: a pericenter stays one.

mod expression;
mod sight;

pub use expression::{Expression, Working};
pub(crate) use expression::{Formula, accelerations};
pub(crate) use sight::dot;
pub use sight::{Moving, Sight, apart};

use super::Scene;
use super::frame::{Moved, Origin, restored};
use super::plan::Groups;
use super::unit::Turned;
use crate::conservation::columns::{Snapshot, column};
use crate::error::{Error, Result};
use crate::forces::bodies::PreciseBodies;
use crate::parallel::Ticker;
use crate::words::{number, numbers};
use core::cell::RefCell;
use core::fmt;
use std::sync::Arc;

/// A function of time, positions and velocities, the numbers of one body after those of another, and of how the rigid bodies
/// are turned, if it looks at that.
pub type Call = dyn Fn(f64, &[f64], &[f64], &[Turned]) -> Result<f64> + Send + Sync;

/// Somebody else's function.
#[derive(Clone)]
pub struct Function {
    /// What is called.
    pub call: Arc<Call>,
    /// Whether it looks at how rigid bodies are turned.
    pub sees_turning: bool,
}

/// About what a body has its apsides.
#[derive(Clone, Debug)]
pub enum Focus {
    /// Another body.
    Body(usize),
    /// A point at rest.
    Point([f64; 3]),
}

/// What is looked at.
#[derive(Clone)]
pub enum What {
    /// Two bodies are so far apart.
    Distance {
        /// Which.
        bodies: (usize, usize),
        /// How far.
        length: f64,
    },
    /// A body is in a plane.
    Plane {
        /// Which.
        body: usize,
        /// A point of the plane.
        point: [f64; 3],
        /// Its normal, of length 1.
        normal: [f64; 3],
    },
    /// The distance is stationary: r·v = 0, from below at the pericenter.
    Apsis {
        /// Whose.
        body: usize,
        /// From what.
        about: Focus,
    },
    /// The energy of all bodies has this value.
    Energy(f64),
    /// Spheres come to touch, any two of them; these pairs are in contact at the start.
    Contact(Arc<[(usize, usize)]>),
    /// An expression is zero.
    Expression(Expression),
    /// Somebody else's function is zero.
    Function(Function),
}

impl fmt::Debug for What {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Distance { bodies, length } => write!(formatter, "Distance({bodies:?}, {length:?})"),
            Self::Plane { body, point, normal } => write!(formatter, "Plane({body}, {point:?}, {normal:?})"),
            Self::Apsis { body, about } => write!(formatter, "Apsis({body}, {about:?})"),
            Self::Energy(value) => write!(formatter, "Energy({value:?})"),
            Self::Contact(_) => write!(formatter, "Contact"),
            Self::Expression(expression) => write!(formatter, "Expression({:?})", expression.bodies),
            Self::Function(_) => write!(formatter, "Function"),
        }
    }
}

/// An event: what is looked at, and which of its zeros count.
#[derive(Clone, Debug)]
pub struct Event {
    /// What is looked at.
    pub what: What,
    /// Only zeros passed upwards in time (positive) or downwards (negative); 0 for both.
    pub direction: f64,
    /// The run ends with the zero of this number.
    pub last: Option<u64>,
}

/// How well the places and the velocities of bodies are known within a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// To this part of themselves.
    pub relative: f64,
    /// And to this, places and velocities.
    pub absolute: [f64; 2],
}

/// Bodies at one time.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Those that are looked at.
    pub bodies: &'a [Moving],
    /// The origin that they move about.
    pub origin: &'a Origin,
    /// Time since the start.
    pub elapsed: f64,
    /// How rigid bodies are turned, for those who look at that.
    pub turned: &'a [Turned],
}

impl View<'_> {
    /// Position and velocity about the origin of the scene, each with what it leaves out.
    fn state(&self, i: usize, Moved { position, velocity }: &Moved) -> [[(f64, f64); 3]; 2] {
        let body = &self.bodies[i];
        [
            core::array::from_fn(|c| restored(position[c], (body.position[c], body.position_rest[c]))),
            core::array::from_fn(|c| restored(velocity[c], (body.velocity[c], body.velocity_rest[c]))),
        ]
    }
}

/// What functions of whole states need beside the bodies that move.
pub struct Surroundings<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Which copy of it.
    pub copy: usize,
    /// Which bodies of the copy those of the view are.
    pub bodies: &'a [usize],
    /// Whether only some bodies of the copy are there, all those that have a mass among them.
    pub massive: bool,
    /// The registers of an expression, if they are kept.
    pub working: Option<&'a RefCell<Working>>,
}

impl Event {
    /// The bodies that it looks at; `None` is all of them.
    fn looks_at(&self) -> Option<Vec<usize>> {
        match &self.what {
            What::Distance { bodies: (i, j), .. } => Some(vec![*i, *j]),
            What::Plane { body, .. } | What::Apsis { body, about: Focus::Point(_) } => Some(vec![*body]),
            What::Apsis { body, about: Focus::Body(other) } => Some(vec![*body, *other]),
            What::Expression(Expression { bodies, .. }) if !bodies.is_empty() => Some(bodies.clone()),
            What::Energy(_) | What::Contact(_) | What::Expression(_) | What::Function(_) => None,
        }
    }

    /// The bodies that it looks at, `active` being those that others depend on.
    pub fn bodies(&self, groups: &Groups, particles: usize, active: &[usize]) -> Vec<usize> {
        self.looks_at().unwrap_or_else(|| match self.what {
            // Massless bodies have no energy.
            What::Energy(_) if *groups == Groups::All && !active.is_empty() => active.to_vec(),
            _ => (0..particles).collect(),
        })
    }

    /// Whether its value takes a call that only the caller's thread may make.
    pub fn calls(&self) -> bool {
        matches!(self.what, What::Function(_))
    }

    /// Whether it looks at how rigid bodies are turned.
    pub fn sees_turning(&self) -> bool {
        matches!(&self.what, What::Function(function) if function.sees_turning)
    }

    /// What it sees. The bodies that it looks at are at these places in the view.
    ///
    /// # Errors
    /// Those of a function; [`Error::Interrupted`].
    #[inline]
    pub fn sight(
        &self,
        view: &View<'_>,
        places: &[usize],
        around: &Surroundings<'_>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Sight> {
        let origin = if self.asks_where() { view.origin.at(view.elapsed) } else { Moved::NOWHERE };
        let mut sight = self.sight_of(view.bodies, places, &origin);
        match &self.what {
            What::Distance { .. } | What::Plane { .. } | What::Apsis { .. } | What::Contact(_) => {}
            What::Expression(expression) => sight.value = expression.value(view, places, &origin, around),
            What::Energy(level) => sight.value = energy(view, around, ticker)? - level,
            What::Function(function) => sight.value = call(function, view, around)?,
        }
        Ok(sight)
    }

    /// Below what its value is zero for all that its arithmetic can tell.
    pub fn rounding(&self, sight: &Sight) -> f64 {
        let size = |x: [f64; 3]| dot(x, x).sqrt();
        8.0 * f64::EPSILON
            * match &self.what {
                What::Distance { .. } => 1.0,
                What::Plane { point, .. } => size(*point) + size(sight.distance),
                What::Apsis { .. } => size(sight.distance) * size(sight.velocity),
                What::Energy(level) => level.abs(),
                What::Contact(_) | What::Expression(_) | What::Function(_) => 0.0,
            }
    }

    /// The same of a state that is told, in numbers: of bodies so far from the origin of the scene, and so fast.
    pub fn rounding_as_told(&self, sight: &Sight, [far, fast]: [f64; 2]) -> f64 {
        let size = |x: [f64; 3]| dot(x, x).sqrt();
        let of_places = match &self.what {
            What::Distance { length, .. } => far / length * size(sight.distance),
            What::Apsis { .. } => far * size(sight.velocity) + fast * size(sight.distance),
            _ => 0.0,
        };
        self.rounding(sight) + 8.0 * f64::EPSILON * of_places
    }

    /// How far its value must come from zero between two zeros for the second to be one of the motion, places and
    /// velocities being known so well. On a circle there are no apsides, but rounding and the errors of steps take the
    /// value from one sign to the other all the time. Of events of another kind any zero is one.
    pub fn least_swing(&self, sight: &Sight, known: &Known) -> Option<f64> {
        let What::Apsis { .. } = self.what else { return None };
        let size = |x: [f64; 3]| dot(x, x).sqrt();
        let (r, v) = (size(sight.distance), size(sight.velocity));
        let [of_place, of_velocity] = known.absolute;
        let known = (known.relative * r + of_place) * v + (known.relative * v + of_velocity) * r;
        Some(self.rounding(sight).max(known))
    }

    /// Refuses what cannot be looked at.
    fn check(&self, index: usize, scene: &Scene) -> Result<()> {
        let particles = scene.particles;
        let refused = |message: String| Err(Error::invalid("events", format!("events[{index}]: {message}")));
        for body in self.looks_at().unwrap_or_default() {
            if body >= particles {
                return refused(match particles {
                    0 => format!("expected bodies of the scene, got {body}, and the scene has none"),
                    _ => format!("expected bodies from 0 to {}, got {body}", particles - 1),
                });
            }
        }
        let is_of_two = !matches!(self.what, What::Expression(_));
        if let (true, Some([i, j])) = (is_of_two, self.looks_at().as_deref())
            && i == j
        {
            return refused(format!("expected two bodies, got {i} twice"));
        }
        let finite = |point: &[f64; 3]| point.iter().all(|x| x.is_finite());
        match &self.what {
            What::Distance { length, .. } if !(*length > 0.0 && length.is_finite()) => {
                refused(format!("expected a distance above 0, got {}", number(*length)))
            }
            What::Plane { point, normal, .. }
                if !(finite(point) && finite(normal) && dot(*normal, *normal) > 0.0) =>
            {
                refused(format!(
                    "expected a finite point and a finite normal other than 0, got {} and {}",
                    numbers(point),
                    numbers(normal)
                ))
            }
            What::Apsis { about: Focus::Point(point), .. } if !finite(point) => {
                refused(format!("expected a finite point, got {}", numbers(point)))
            }
            What::Energy(level) if !level.is_finite() => {
                refused(format!("expected a finite energy, got {}", number(*level)))
            }
            What::Function(function) if function.sees_turning && scene.rigid.is_none() => {
                let message = "expected a function f(t, position, velocity), got one that takes orientations too, and \
                               the scene has no rigid bodies";
                refused(message.to_owned())
            }
            _ if self.last == Some(0) => refused("expected terminal of at least 1, got 0".to_owned()),
            _ => Ok(()),
        }
    }
}

/// Refuses events that cannot be looked for.
///
/// # Errors
/// By name, with what was expected and what came.
pub fn check(events: &[Event], scene: &Scene) -> Result<()> {
    events.iter().enumerate().try_for_each(|(index, event)| event.check(index, scene))
}

fn call(function: &Function, view: &View<'_>, around: &Surroundings<'_>) -> Result<f64> {
    let particles = around.scene.particles;
    let (mut position, mut velocity) = (vec![0.0; 3 * particles], vec![0.0; 3 * particles]);
    let origin = view.origin.at(view.elapsed);
    for (place, &body) in around.bodies.iter().enumerate() {
        let [x, v] = view.state(place, &origin);
        for c in 0..3 {
            (position[3 * body + c], velocity[3 * body + c]) = (x[c].0, v[c].0);
        }
    }
    (function.call)(around.scene.t0 + view.elapsed, &position, &velocity, view.turned)
}

fn energy(view: &View<'_>, around: &Surroundings<'_>, ticker: &mut Ticker<'_>) -> Result<f64> {
    let mut bodies = PreciseBodies::default();
    let forces = around.scene.forces_of(around.copy);
    // What a force names must be in its place; bodies that are elsewhere have no mass and add nothing.
    let in_order = around.massive && !forces.iter().any(|force| force.names_bodies());
    bodies.clear(if in_order { view.bodies.len() } else { around.scene.particles });
    let masses = around.scene.masses(around.copy);
    let origin = view.origin.at(view.elapsed);
    for (place, &body) in around.bodies.iter().enumerate() {
        let [position, velocity] = view.state(place, &origin).map(|x| [x.map(|x| x.0), x.map(|x| x.1)]);
        bodies.set(if in_order { place } else { body }, masses[body], position, velocity);
    }
    bodies.settle();
    let mut state = Snapshot::new(forces, &bodies, [0.0; 3], 1, ticker);
    Ok(state.value(column("events", "energy")?)?[0])
}
