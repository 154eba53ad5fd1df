//! One leg of a run with collisions: the bodies that are left, as a scene, and what is asked of it.

use super::super::{Impact, contact};
use crate::error::Result;
use crate::forces::remaining::Remaining;
use crate::scene::Scene;
use crate::scene::events::{Call, Event, Focus, Function, What};
use std::sync::Arc;

impl Remaining {
    /// The scene at this time, with what that leaves out.
    pub(super) fn scene(
        &self,
        whole: &Scene,
        copy: usize,
        impact: &Impact,
        (t0, t0_rest): (f64, f64),
    ) -> Result<Scene> {
        let pick = |of: &[[f64; 3]]| self.bodies.iter().map(|&body| of[body]).collect();
        Ok(Scene {
            copies: 1,
            particles: self.bodies.len(),
            mass: self.bodies.iter().map(|&body| impact.mass[body]).collect(),
            position: pick(&impact.position),
            velocity: pick(&impact.velocity),
            forces: self.forces(whole.forces_of(copy))?,
            own_forces: None,
            radius: self.bodies.iter().map(|&body| impact.radius[body]).collect(),
            rigid: None,
            t0,
            t0_rest,
            continuation: None,
        })
    }

    /// The events that are still to be looked for, and which of those that were asked for they are; that of a contact
    /// follows.
    pub(super) fn events(
        &self,
        asked: &[Event],
        found: &[u64],
        scene: &Scene,
        touching: &[(usize, usize)],
    ) -> (Vec<Event>, Vec<usize>) {
        let (mut events, mut names) = (Vec::new(), Vec::new());
        for (index, event) in asked.iter().enumerate() {
            if let Some(what) = self.what(&event.what) {
                let last = event.last.map(|last| last.saturating_sub(found[index]));
                events.push(Event { what, direction: event.direction, last });
                names.push(index);
            }
        }
        if super::may_touch(scene, 0) {
            let touching = touching.iter().map(|&(i, j)| (self.places[i], self.places[j])).collect();
            events.push(contact(touching));
        }
        (events, names)
    }

    /// What is looked at, of the bodies that are there; none of two that have become one.
    pub(super) fn what(&self, what: &What) -> Option<What> {
        let place = |body: &usize| self.places[*body];
        Some(match what {
            What::Distance { bodies: (i, j), length } => {
                let bodies = (place(i), place(j));
                if bodies.0 == bodies.1 {
                    return None;
                }
                What::Distance { bodies, length: *length }
            }
            What::Plane { body, point, normal } => {
                What::Plane { body: place(body), point: *point, normal: *normal }
            }
            What::Apsis { body, about: Focus::Body(other) } => {
                if place(body) == place(other) {
                    return None;
                }
                What::Apsis { body: place(body), about: Focus::Body(place(other)) }
            }
            What::Apsis { body, about } => What::Apsis { body: place(body), about: about.clone() },
            What::Expression(expression) => What::Expression(expression.of(place)),
            What::Function(function) if self.some_have_gone() => What::Function(self.with_all(function)),
            What::Energy(_) | What::Contact(_) | What::Function(_) => what.clone(),
        })
    }

    /// A function that is called with the bodies that are parts of others, too.
    fn with_all(&self, function: &Function) -> Function {
        let (places, inner) = (self.places.clone(), Arc::clone(&function.call));
        let call: Arc<Call> = Arc::new(move |t, position, velocity, turned| {
            let all = |of: &[f64]| -> Vec<f64> {
                places.iter().flat_map(|&place| of[3 * place..3 * place + 3].iter().copied()).collect()
            };
            inner(t, &all(position), &all(velocity), turned)
        });
        Function { call, ..*function }
    }
}
