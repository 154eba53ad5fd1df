//! What the errors of an adaptive step are measured against: the place, the drift and the size of a unit.

use super::super::{ForceSpec, distance};
use super::{Origin, Plan, Prepared, scale};

/// Above this many bodies the smallest separation is estimated from the mean density instead.
const ALL_PAIRS: usize = 8192;

impl Prepared {
    /// Finds the unit's reference and size.
    pub(super) fn measure(&mut self, plan: &Plan) {
        self.reference = self.find_reference(plan);
        if self.moves_as_a_polynomial(plan) {
            self.size = (f64::INFINITY, f64::INFINITY);
            return;
        }
        let mut extent = 0.0_f64;
        let mut speed = 0.0_f64;
        for (x, v) in self.position.iter().zip(&self.velocity) {
            extent = extent.max(distance(*x, self.reference.center));
            speed = speed.max(distance(*v, self.reference.drift));
        }
        let separation = self.smallest_separation(plan, extent);
        let length = if separation > 0.0 && separation.is_finite() { separation } else { 1.0 };
        // The speed of a circular orbit there: a system at rest has a velocity scale too.
        let total: f64 = self.strength.iter().map(|x| x.abs()).sum();
        let orbital = (total / extent.max(length)).sqrt();
        let velocity = speed.max(orbital);
        // A body at rest in a field gets its scale from the fall over that length.
        let velocity = if velocity > 0.0 { velocity } else { (length * self.field_strength(plan)).sqrt() };
        self.size = (length, if velocity > 0.0 { velocity } else { 1.0 });
    }

    /// Whether the unit is one massive body on which nothing acts, or a uniform field: every adaptive method moves it
    /// exactly, in steps of any length. Nothing about it would tell a size either, it being its own reference; one of
    /// the plan's units instead would make its steps depend on the other copies of an ensemble.
    fn moves_as_a_polynomial(&self, plan: &Plan) -> bool {
        let gentle = |force: &ForceSpec| !matches!(force, ForceSpec::CentralField { .. });
        self.unit.active == 1 && self.position.len() == 1 && plan.forces.iter().all(gentle)
    }

    /// A fixed centre if there is one, else the centre of mass.
    fn find_reference(&self, plan: &Plan) -> Origin {
        let mut reference = Origin::default();
        let center = plan.forces.iter().find_map(|force| match force {
            ForceSpec::CentralField { center, .. } => Some(*center),
            _ => None,
        });
        if let Some(center) = center {
            reference.center = center.map(|x| scale(x, -self.units.length));
            return reference;
        }
        let total: f64 = self.strength.iter().sum();
        for (i, strength) in self.strength.iter().enumerate() {
            for c in 0..3 {
                reference.center[c] += strength / total * self.position[i][c];
                reference.drift[c] += strength / total * self.velocity[i][c];
            }
        }
        reference
    }

    /// Of bodies that attract each other; of bodies that do not, their distance from the reference.
    fn smallest_separation(&self, plan: &Plan, extent: f64) -> f64 {
        let (active, bodies) = (self.unit.active, self.position.len());
        if active == 0 || bodies < 2 {
            return extent;
        }
        let mut separation = f64::INFINITY;
        if bodies > ALL_PAIRS {
            // Mean spacing; a cube root by Newton would be no better for an estimate.
            separation = extent / (bodies as f64).sqrt().sqrt();
        } else {
            for i in 0..active {
                for j in i + 1..bodies {
                    separation = separation.min(distance(self.position[i], self.position[j]));
                }
            }
        }
        separation.max(plan.gravity.map_or(0.0, |(_, softening)| scale(softening, -self.units.length)))
    }

    /// The largest acceleration that the central fields give to a body of the unit.
    fn field_strength(&self, plan: &Plan) -> f64 {
        let mut strongest = 0.0_f64;
        for force in &plan.forces {
            if let ForceSpec::CentralField { potential, center } = force {
                let potential = potential.scaled(self.units.length, self.units.energy());
                let center = center.map(|x| scale(x, -self.units.length));
                for (position, mass) in self.position.iter().zip(&self.mass) {
                    let [_, force, _] = potential.evaluate(&[distance(*position, center)]);
                    strongest = strongest.max(force[0].abs() / mass);
                }
            }
        }
        strongest
    }
}
