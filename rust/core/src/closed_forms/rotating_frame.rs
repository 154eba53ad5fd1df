//! Nothing but a rotating frame: straight lines, seen from it.
//!
//! With d from the axis and w = v₀ + ω × d₀, which is the velocity seen from outside: d = R (d₀ + w t) and
//! v = R w − ω × d, R being the rotation by −ω t.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., sections 4.9 and 4.10.

use super::crossed_fields::Vector;
use super::{ClosedForm, ExactState, Member, Path, Paths, unrounded};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;

/// Straight lines, seen from a frame that turns.
pub static FORM: ClosedForm = ClosedForm {
    name: "straight lines seen from a rotating frame",
    reason: "no force acts but those of the frame",
    applies: |member| matches!(&member.forces[..], [force] if force.as_rotating().is_some()),
    motion: |member, _, ticker| Paths::motion(member, ticker, |i| Ok(Turning::new(member, i))),
};

struct Turning {
    center: [f64; 3],
    /// |ω| and the direction of ω.
    frequency: Scaled,
    omega: [Scaled; 3],
    /// d₀ and w: along the axis, across it, and their cross products with it.
    place: [Vector; 3],
    speed: [Vector; 3],
}

fn cross(a: [Scaled; 3], b: [Scaled; 3]) -> [Scaled; 3] {
    core::array::from_fn(|c| {
        let (d, e) = ((c + 1) % 3, (c + 2) % 3);
        a[d].by(b[e]).minus(a[e].by(b[d]))
    })
}

impl Turning {
    fn new(member: &Member<'_>, particle: usize) -> Self {
        let rotating = member.forces.iter().find_map(|force| force.as_rotating());
        let (omega, center) = rotating.unwrap_or_default();
        let axis = Vector::new(omega.map(Scaled::from));
        let [x, y, z] = axis.value;
        let size = Real::sqrt(x * x + y * y + z * z);
        let n = axis.value.map(|x| x / size);
        let difference = |c: usize| Scaled::from(member.position[particle][c]).plus(Scaled::from(-center[c]));
        let d: [Scaled; 3] = core::array::from_fn(difference);
        let turned = cross(omega.map(Scaled::from), d);
        let w = core::array::from_fn(|c| Scaled::from(member.velocity[particle][c]).plus(turned[c]));
        Self {
            center,
            frequency: Scaled::new(size, axis.exponent),
            omega: omega.map(Scaled::from),
            place: Vector::new(d).about(n),
            speed: Vector::new(w).about(n),
        }
    }
}

impl Path for Turning {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let t = Scaled::new(elapsed, 0);
        let Rotation { cosine, sine, .. } = Rotation::new(self.frequency.by(t));
        let turned = |[along, across, around]: &[Vector; 3]| -> [Scaled; 3] {
            core::array::from_fn(|c| {
                let (across, around) = (across.component(c).by(cosine), around.component(c).by(sine));
                along.component(c).plus(across.plus(around))
            })
        };
        let (place, speed) = (turned(&self.place), turned(&self.speed));
        let d: [Scaled; 3] = core::array::from_fn(|c| place[c].plus(speed[c].by(t)));
        let around = cross(d, self.omega);
        let x = core::array::from_fn(|c| unrounded(Scaled::from(self.center[c]).plus(d[c])));
        (x, core::array::from_fn(|c| unrounded(speed[c].plus(around[c]))))
    }
}
