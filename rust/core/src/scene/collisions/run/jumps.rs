//! Events in a collision: what depends on velocities has another sign after it, and no zero in between.

use super::member::Member;
use crate::error::{Error, Result};
use crate::forces::bodies::PreciseBodies;
use crate::forces::remaining::Remaining;
use crate::parallel::Ticker;
use crate::scene::events::{Event, Focus, What, dot};
use crate::scene::integrate::Ending;
use crate::scene::run::resolved::energy_of;
use crate::scene::{Scene, request::Request};

impl Member {
    /// Settles a contact, and takes in the events whose sign that has changed; whether the run goes on.
    pub(super) fn collide_and_look(
        &mut self,
        whole: &Scene,
        request: &Request,
        pair: (usize, usize),
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        let before = self.values(whole, request, ticker);
        let goes_on = self.collide(Some(pair));
        match before.and_then(|before| Ok([before, self.values(whole, request, ticker)?])) {
            Ok([before, after]) if !self.jump(request, &before, &after) && goes_on => {
                self.outcome.ending = Ending::Stopped;
                Ok(false)
            }
            Ok(_) => Ok(goes_on),
            // Nothing of what was run is lost for a function that fails.
            Err(Error::Interrupted) => {
                self.outcome.ending = Ending::Interrupted;
                Ok(false)
            }
            Err(other) => Err(other),
        }
    }

    /// The values of those events that a collision may change at once; none of the others.
    fn values(&self, whole: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Vec<Option<f64>>> {
        if request.events.is_empty() {
            return Ok(Vec::new());
        }
        let leg = Remaining::of(&self.bodies.host);
        let scene = leg.scene(whole, self.copy, &self.bodies, self.time())?;
        let value =
            |event: &Event| leg.what(&event.what).map_or(Ok(None), |what| value(&what, &scene, ticker));
        request.events.iter().map(value).collect()
    }

    /// Takes in the events whose sign a collision has changed; whether the run goes on.
    fn jump(&mut self, request: &Request, before: &[Option<f64>], after: &[Option<f64>]) -> bool {
        let mut goes_on = true;
        for (which, event) in request.events.iter().enumerate() {
            let (Some(Some(before)), Some(Some(after))) = (before.get(which), after.get(which)) else {
                continue;
            };
            // Upwards along a run backwards is downwards in time.
            let counts = event.direction * self.bodies.direction * after.signum() >= 0.0;
            let changes = (before < &0.0 && after > &0.0) || (before > &0.0 && after < &0.0);
            if !(changes && counts) {
                continue;
            }
            let states = self.bodies.position.iter().zip(&self.bodies.velocity);
            self.events.put(self.copy, which, self.outcome.time, states.map(|(&r, &v)| [r, v]));
            self.found[which] += 1;
            goes_on &= event.last.is_none_or(|last| self.found[which] < last);
        }
        goes_on
    }
}

fn value(what: &What, scene: &Scene, ticker: &mut Ticker<'_>) -> Result<Option<f64>> {
    let (position, velocity) = (&scene.position, &scene.velocity);
    let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { core::array::from_fn(|c| a[c] - b[c]) };
    Ok(match what {
        What::Apsis { body, about } => {
            let (place, speed) = match about {
                Focus::Body(other) => (position[*other], velocity[*other]),
                Focus::Point(point) => (*point, [0.0; 3]),
            };
            Some(dot(minus(position[*body], place), minus(velocity[*body], speed)))
        }
        What::Energy(level) => {
            let state = (&position[..], &velocity[..]);
            let (kinetic, potential) = energy_of(scene, 0, state, &mut PreciseBodies::default(), ticker)?;
            Some(kinetic.plus(potential).to_f64() - level)
        }
        What::Expression(expression) => Some(expression.value_of(scene.t0, position, velocity)),
        What::Function(function) => {
            // Spheres that collide are no rigid bodies.
            Some((function.call)(scene.t0, position.as_flattened(), velocity.as_flattened(), &[])?)
        }
        What::Distance { .. } | What::Plane { .. } | What::Contact(_) => None,
    })
}
