//! Charges in a uniform magnetic field, with uniform accelerations or without: gyration and drift.
//!
//! With b = (charge/mass) B, its direction n, and θ = |b| t, what is parallel to n falls freely, and what is across
//! it rotates: v = v∥ + cos θ v⊥ + sin θ v×n + t (g∥ + S₁ g⊥ + C₁ g×n) and
//! x = x₀ + t (v∥ + S₁ v⊥ + C₁ v×n) + t² (g∥/2 + C₂ g⊥ + S₂ g×n), with the functions of [`Rotation`], which do not
//! cancel at small angles: parabolas as b vanishes. The last term is the drift g×b/b².
//! Source: Jackson, *Classical Electrodynamics*, 3rd ed., sections 12.2 and 12.3.

use super::{ClosedForm, ExactState, Member, Path, Paths, is_uniform, uniform_part, unrounded};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::exponent;
use crate::numerics::real::Real;
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;

/// Gyration and drift.
pub static FORM: ClosedForm = ClosedForm {
    name: "gyration and drift",
    reason: "the only forces are uniform magnetic fields and uniform accelerations",
    applies: |member| {
        member.forces.iter().all(|force| force.as_magnetic().is_some() || is_uniform(*force))
            && member.forces.iter().any(|force| force.as_magnetic().is_some())
    },
    motion: |member, _, ticker| {
        Paths::motion(member, ticker, |i| Ok(Helix::new(member, i, Vector::new(uniform_part(member, i)))))
    },
};

/// A vector whose greatest component is about one, and a power of two.
#[derive(Clone, Copy)]
pub(super) struct Vector {
    pub(super) value: [DoubleDouble; 3],
    pub(super) exponent: i32,
}

impl Vector {
    pub(super) fn new(components: [Scaled; 3]) -> Self {
        let size = |x: &Scaled| match x.value().to_f64() {
            0.0 => i32::MIN,
            high => exponent(high) + x.exponent(),
        };
        let greatest = components.iter().map(size).max().filter(|&size| size > i32::MIN).unwrap_or(0);
        // What lies out of sight of the greatest is kept as far as the range goes.
        let value = components.map(|x| Scaled::new(x.value(), x.exponent() - greatest).to_double_double());
        Self { value, exponent: greatest }
    }

    pub(super) fn component(&self, c: usize) -> Scaled {
        Scaled::new(self.value[c], self.exponent)
    }

    /// Along a direction, across it, and the cross product with it.
    pub(super) fn about(self, n: [DoubleDouble; 3]) -> [Self; 3] {
        let v = self.value;
        let along = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
        let parallel: [_; 3] = core::array::from_fn(|c| along * n[c]);
        let across = core::array::from_fn(|c| v[c] - parallel[c]);
        let cross = core::array::from_fn(|c| {
            let (d, e) = ((c + 1) % 3, (c + 2) % 3);
            v[d] * n[e] - v[e] * n[d]
        });
        [parallel, across, cross].map(|value| Self { value, exponent: self.exponent })
    }
}

struct Helix {
    position: [f64; 3],
    /// |b|.
    frequency: Scaled,
    velocity: [Vector; 3],
    g: [Vector; 3],
}

impl Helix {
    fn new(member: &Member<'_>, particle: usize, g: Vector) -> Self {
        let mut b = [Scaled::ZERO; 3];
        for magnetic in member.forces.iter().filter_map(|force| force.as_magnetic()) {
            let charge = magnetic.charge_of(particle);
            if charge == 0.0 {
                continue; // A body without mass may be there, if it has no charge.
            }
            for (b, field) in b.iter_mut().zip(magnetic.field) {
                let force = Scaled::from(charge).times(field);
                *b = b.plus(force.over(Scaled::from(member.mass[particle])));
            }
        }
        let b = Vector::new(b);
        let [x, y, z] = b.value;
        let size = (x * x + y * y + z * z).sqrt();
        let n = if size.to_f64() == 0.0 { b.value } else { b.value.map(|b| b / size) };
        let velocity = Vector::new(member.velocity[particle].map(Scaled::from));
        Self {
            position: member.position[particle],
            frequency: Scaled::new(size, b.exponent),
            velocity: velocity.about(n),
            g: g.about(n),
        }
    }
}

impl Path for Helix {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let t = Scaled::new(elapsed, 0);
        let Rotation { cosine, sine, s1, c1, c2, s2 } = Rotation::new(self.frequency.by(t));
        let half = Scaled::from(0.5);
        let sum = |of: &[Vector; 3], c: usize, first: Option<Scaled>, second: Scaled, third: Scaled| {
            let [parallel, across, cross] = of.each_ref().map(|vector| vector.component(c));
            let parallel = first.map_or(parallel, |first| parallel.by(first));
            parallel.plus(across.by(second).plus(cross.by(third)))
        };
        let at = |c: usize| {
            let speed = sum(&self.velocity, c, None, s1, c1);
            let fall = sum(&self.g, c, Some(half), c2, s2).by(t);
            let x = Scaled::from(self.position[c]).plus(speed.plus(fall).by(t));
            let turned = sum(&self.velocity, c, None, cosine, sine);
            let gained = sum(&self.g, c, None, s1, c1).by(t);
            (unrounded(x), unrounded(turned.plus(gained)))
        };
        let states: [_; 3] = core::array::from_fn(at);
        (states.map(|state| state.0), states.map(|state| state.1))
    }
}
