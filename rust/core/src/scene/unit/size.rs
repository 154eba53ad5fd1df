//! What the errors of an adaptive step are measured against: the place, the drift and the size of a unit.

use super::super::distance;
use super::super::frame;
use super::{Origin, Plan, Prepared};
use crate::error::Result;
use crate::forces::term::ForceTerm;
use crate::parallel::Ticker;
use std::sync::Arc;

/// Above this many bodies the smallest separation is estimated from the mean density instead.
const ALL_PAIRS: usize = 8192;

/// What is more than so many times as far along one axis is farther away, whatever rounding makes of a distance.
const FARTHER: f64 = 1.0 + 1.0 / (1_u64 << 40) as f64;

/// Some last digits of a number, as a part of it: enough to be told from the rounding of what is made of it.
const DIGITS: f64 = 1.0 / (1_u64 << 44) as f64;

/// So many roundings of a place an error of a step is not told from.
const ROUNDINGS: f64 = 2.0;

impl Prepared {
    /// Finds the unit's reference and size.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn measure(&mut self, plan: &Plan, ticker: &mut Ticker<'_>) -> Result<()> {
        self.reference = self.find_reference(plan);
        let mut extent = 0.0_f64;
        let mut speed = 0.0_f64;
        for (x, v) in self.position.iter().zip(&self.velocity) {
            extent = extent.max(distance(*x, self.reference.center));
            speed = speed.max(distance(*v, self.reference.drift));
        }
        let separation = self.smallest_separation(plan, extent, ticker)?;
        let field = self.field_strength(plan, ticker)?;
        let length = if separation > 0.0 && separation.is_finite() {
            separation
        } else {
            self.path(plan, speed, field)
        };
        // The speed of a circular orbit there: a system at rest has a velocity scale too.
        let total: f64 = if self.is_lone() { 0.0 } else { self.strength.iter().map(|x| x.abs()).sum() };
        let orbital = (total / extent.max(length)).sqrt();
        let velocity = speed.max(orbital);
        // A body at rest in a field gets its scale from the fall over that length; one that nothing moves, from the run.
        let velocity = if velocity > 0.0 { velocity } else { (length * field).sqrt() };
        let span = self.units.take(plan.span, [0, 0, 1]);
        let slow = if span > 0.0 { length / span } else { 1.0 };
        self.size = (length, if velocity > 0.0 { velocity } else { slow });
        let of_points = self.rounding_of_places(plan, length, ticker)?;
        let of_formulas = self.rounding_of_formulas(plan, length, ticker)?;
        self.rounding = (of_points.0.max(of_formulas.0), of_points.1.max(of_formulas.1));
        Ok(())
    }

    /// What rounding of places does to places and velocities, where forces are those of a point: how far bodies are from one
    /// that is far from the origin is known to so much in every evaluation, however short the step.
    fn rounding_of_places(&self, plan: &Plan, length: f64, ticker: &mut Ticker<'_>) -> Result<(f64, f64)> {
        let forces = plan.forces_of(self.unit.copy);
        let points = forces.iter().filter_map(|force| force.fixed_point());
        let far = points.flatten().fold(0.0, |far: f64, x| far.max(x.abs()));
        if far == 0.0 {
            return Ok((0.0, 0.0));
        }
        let far = self.units.take(far, [1, 0, 0]);
        let here = || forces.iter().filter(|force| force.fixed_point().is_some());
        let bodies = self.bodies();
        let rate = here().map(|force| force.rate(&bodies, self.units)).fold(0.0, f64::max);
        let rate = rate.max((self.strongest(here(), plan, ticker)? / length).sqrt());
        let place = ROUNDINGS * f64::EPSILON * far;
        Ok((place, place * rate))
    }

    /// The same of forces of which nothing tells where they are from: what a few last digits of places and of the time change
    /// in them, far from the origin or long after the time zero.
    fn rounding_of_formulas(&self, plan: &Plan, length: f64, ticker: &mut Ticker<'_>) -> Result<(f64, f64)> {
        let forces = plan.forces_of(self.unit.copy).iter().filter(|force| force.is_formula());
        let bodies = self.bodies();
        let beside: Vec<_> = bodies
            .iter()
            .map(|&(body, mass, position)| (body, mass, position.map(|x| x * (1.0 + DIGITS))))
            .collect();
        let (mut strongest, mut change) = (0.0_f64, 0.0_f64);
        for force in forces {
            for share in [0.0, 0.5, 1.0] {
                let t = plan.t0 + share * plan.direction * plan.span;
                let mut at = |bodies: &[_], t: f64| force.strongest(bodies, self.units, [t; 3], ticker);
                let here = at(&bodies, t)?;
                let off = (at(&beside, t)? - here).abs() + (at(&bodies, t * (1.0 + DIGITS))? - here).abs();
                strongest = strongest.max(here);
                change = change.max(off * (f64::EPSILON / DIGITS));
            }
        }
        let rate = (strongest / length).sqrt();
        if !(rate > 0.0 && change.is_finite()) {
            return Ok((0.0, 0.0));
        }
        let velocity = ROUNDINGS * change / rate;
        Ok((velocity / rate, velocity))
    }

    /// A length for a body that is where distances are measured from: what it passes and falls before the forces on it
    /// change, in the time of the run at most. By nothing but the body and the run, lest its steps depend on others.
    fn path(&self, plan: &Plan, speed: f64, field: f64) -> f64 {
        let span = self.units.take(plan.span, [0, 0, 1]);
        let bodies = self.bodies();
        let rate = plan
            .forces_of(self.unit.copy)
            .iter()
            .map(|force| force.rate(&bodies, self.units))
            .fold(0.0, f64::max);
        let time = if rate * span > 1.0 { 1.0 / rate } else { span };
        let length = time * (speed + 0.5 * field * time);
        // Where nothing ever moves any length will do.
        if length > 0.0 && length.is_finite() { length } else { 1.0 }
    }

    /// Whether it is one body: what it does to others that are massless is no measure of its own motion.
    fn is_lone(&self) -> bool {
        self.position.len() == 1
    }

    /// A fixed center if there is one, else the centre of mass of several bodies, unless most of them are far from it; of a
    /// body alone the point that forces tell its place from, lest its size be how far the scene is from the origin.
    fn find_reference(&self, plan: &Plan) -> Origin {
        let mut reference = Origin::default();
        let center = plan.forces_of(self.unit.copy).iter().find_map(|force| force.center());
        if let Some(center) = center {
            reference.center = self.units.take_vector(center, [1, 0, 0]);
            return reference;
        }
        if self.is_lone() {
            let fixed = plan
                .forces_of(self.unit.copy)
                .iter()
                .find_map(|force| force.fixed_point())
                .unwrap_or_default();
            reference.center = self.units.take_vector(fixed, [1, 0, 0]);
            return reference;
        }
        let total: f64 = self.strength.iter().sum();
        // Other forces than gravity, or two that cancel, leave the masses.
        let weights = if total == 0.0 { &self.mass[..self.unit.active] } else { &self.strength };
        let total: f64 = weights.iter().sum();
        for (i, weight) in weights.iter().enumerate() {
            for c in 0..3 {
                reference.center[c] += weight / total * self.position[i][c];
                reference.drift[c] += weight / total * self.velocity[i][c];
            }
        }
        let massive = 0..weights.len();
        reference.center = frame::center(reference.center, massive.clone().map(|i| self.position[i]));
        reference.drift = frame::drift(reference.drift, massive.map(|i| self.velocity[i]));
        reference
    }

    /// Of bodies that attract each other; of bodies that do not, their distance from the reference.
    fn smallest_separation(&self, plan: &Plan, extent: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        let (active, bodies) = (self.unit.active, self.position.len());
        if active == 0 || bodies < 2 {
            return Ok(extent);
        }
        let mut separation = f64::INFINITY;
        if bodies > ALL_PAIRS {
            // Mean spacing; a cube root by Newton would be no better for an estimate.
            separation = extent / (bodies as f64).sqrt().sqrt();
        } else {
            // Along the axis on which they are spread most, none that is farther away there than the closest pair is closer.
            let order = self.along_the_longest_axis();
            for (place, &(x, i)) in order.iter().enumerate() {
                for &(beyond, j) in &order[place + 1..] {
                    if beyond - x > separation * FARTHER {
                        break;
                    }
                    if i < active || j < active {
                        separation = separation.min(distance(self.position[i], self.position[j]));
                    }
                }
                ticker.tick()?;
            }
        }
        let length = plan.forces_of(self.unit.copy).iter().map(|force| force.length()).fold(0.0, f64::max);
        Ok(separation.max(self.units.take(length, [1, 0, 0])))
    }

    /// The bodies in the order of the coordinate in which they are spread most, each after that.
    fn along_the_longest_axis(&self) -> Vec<(f64, usize)> {
        let spread = |c: usize| {
            let all = || self.position.iter().map(|x| x[c]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        let axis = (1..3).fold(0, |best, c| if spread(c) > spread(best) { c } else { best });
        let mut order: Vec<(f64, usize)> =
            self.position.iter().enumerate().map(|(body, x)| (x[axis], body)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        order
    }

    /// The largest acceleration that a force gives to a body of the unit, at rest where it is, in the course of the run.
    fn field_strength(&self, plan: &Plan, ticker: &mut Ticker<'_>) -> Result<f64> {
        self.strongest(plan.forces_of(self.unit.copy).iter(), plan, ticker)
    }

    fn strongest<'a>(
        &self,
        mut forces: impl Iterator<Item = &'a Arc<dyn ForceTerm>>,
        plan: &Plan,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let bodies = self.bodies();
        // A force may begin, or vanish, where the run does.
        let times = [0.0, 0.5, 1.0].map(|share| plan.t0 + share * plan.direction * plan.span);
        forces.try_fold(0.0, |most: f64, force| {
            Ok(most.max(force.strongest(&bodies, self.units, times, ticker)?))
        })
    }

    /// Place in the scene, mass and position of each body.
    fn bodies(&self) -> Vec<(usize, f64, [f64; 3])> {
        let bodies = self.unit.bodies.iter().zip(&self.mass).zip(&self.position);
        bodies.map(|((&body, &mass), &position)| (body, mass, position)).collect()
    }
}
