//! Quadratic drag along a line, with linear drag and a uniform field along it, or without: rise, fall and coasting.
//!
//! In the direction of the motion v′ = G − b v − c v². With v = u′/(c u) that is linear, u″ + b u′ − c G u = 0, and
//! u = 1 + c (V S + G Q), s = ln u/c, v = (V S′ + G S)/u, with the responses S and Q of [`oscillation`](super::oscillation):
//! vacuum as c vanishes, linear drag as the speed does, tangents for a rise and hyperbolic ones for a fall. A body that
//! stops turns there and goes on from rest. Backward in time a speed grows without bound within a finite time.
//! Source: Landau & Lifshitz, *Mechanics*, 3rd ed., section 25, for the linear equation; Riccati's substitution.

use super::oscillation::{responses, roots};
use super::{ClosedForm, ExactState, Member, Path, Paths, is_uniform, uniform_part, unrounded};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::exponentials::{Complex, third};
use crate::numerics::logarithm::{ln, ln_1p};
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;

/// Drag along a line.
pub static FORM: ClosedForm = ClosedForm {
    name: "drag along a line",
    reason: "the only forces are drag, and uniform fields along the motion",
    applies: |member| {
        member.forces.iter().any(|force| force.as_quadratic_drag(0).is_some())
            && member.forces.iter().all(|force| {
                force.as_quadratic_drag(0).is_some() || force.as_linear_drag().is_some() || is_uniform(*force)
            })
            && (0..member.mass.len()).all(|particle| is_along(member, particle))
    },
    motion: |member, ticker| Paths::motion(member, ticker, |i| Ok(Line::new(member, i))),
};

fn zero(x: Scaled) -> bool {
    x.value().to_f64() == 0.0
}

fn less(a: Scaled, b: Scaled) -> bool {
    a.plus(b.times(-1.0)).value().to_f64() < 0.0
}

/// The sum of the coefficients of quadratic drag.
fn coefficient(member: &Member<'_>, particle: usize) -> Scaled {
    let each = member.forces.iter().filter_map(|force| force.as_quadratic_drag(particle));
    each.fold(Scaled::ZERO, |sum, c| sum.plus(Scaled::from(c)))
}

/// Whether a particle moves along the field on it, or feels no quadratic drag.
fn is_along(member: &Member<'_>, particle: usize) -> bool {
    let (g, v) = (uniform_part(member, particle), member.velocity[particle].map(Scaled::from));
    let across = |c: usize| {
        let (d, e) = ((c + 1) % 3, (c + 2) % 3);
        v[d].by(g[e]).plus(v[e].by(g[d]).times(-1.0))
    };
    zero(coefficient(member, particle)) || (0..3).all(|c| zero(across(c)))
}

struct Line {
    position: [Scaled; 3],
    velocity: [Scaled; 3],
    field: [Scaled; 3],
    /// The rate of linear drag, and the coefficient of quadratic drag over the mass.
    rate: Scaled,
    drag: Scaled,
    /// Where to, and the speed and the field along there.
    direction: [Scaled; 3],
    speed: Scaled,
    along: Scaled,
}

fn dot(a: &[Scaled; 3], b: &[Scaled; 3]) -> Scaled {
    a[0].by(b[0]).plus(a[1].by(b[1])).plus(a[2].by(b[2]))
}

impl Line {
    fn new(member: &Member<'_>, particle: usize) -> Self {
        let field = uniform_part(member, particle);
        let velocity = member.velocity[particle].map(Scaled::from);
        let still = velocity.iter().all(|&v| zero(v));
        let along = if still { field } else { velocity };
        let size = dot(&along, &along).sqrt();
        let direction = along.map(|x| if zero(size) { Scaled::ZERO } else { x.over(size) });
        let drag = coefficient(member, particle);
        let one = Scaled::from(1.0);
        let times = member.forces.iter().filter_map(|force| force.as_linear_drag());
        Self {
            position: member.position[particle].map(Scaled::from),
            velocity,
            field,
            rate: times.fold(Scaled::ZERO, |rate, tau| rate.plus(one.over(Scaled::from(tau)))),
            drag: if zero(drag) { drag } else { drag.over(Scaled::from(member.mass[particle])) },
            direction,
            speed: if still { Scaled::ZERO } else { size },
            along: dot(&field, &direction),
        }
    }

    /// The way and the speed after a time from a start with that speed V ≥ 0, the field along it being G.
    fn way(&self, start: Scaled, field: Scaled, t: Scaled) -> (Scaled, Scaled) {
        let leg = Leg::new(self, start, field);
        let turn = leg.turn();
        let beyond = |turn: &Scaled| {
            if less(*turn, Scaled::ZERO) { less(t, *turn) } else { less(*turn, t) }
        };
        match turn.filter(|_| !zero(start)).filter(beyond) {
            None => leg.at(t),
            Some(turn) => {
                let (there, _) = leg.at(turn);
                let (way, speed) = self.after_rest(field, t.plus(turn.times(-1.0)));
                (there.plus(way), speed)
            }
        }
    }

    /// The same from rest: with the field forward in time, and against it backward.
    fn after_rest(&self, field: Scaled, t: Scaled) -> (Scaled, Scaled) {
        if zero(field) {
            return (Scaled::ZERO, Scaled::ZERO);
        }
        let forward = less(Scaled::ZERO, field) == less(Scaled::ZERO, t);
        let sign = if forward { 1.0 } else { -1.0 };
        let (way, speed) = Leg::new(self, Scaled::ZERO, field.times(sign)).at(t);
        (way.times(sign), speed.times(sign))
    }
}

/// Motion in one direction.
struct Leg {
    /// c, V, G and b/2.
    drag: Scaled,
    start: Scaled,
    field: Scaled,
    half_rate: Scaled,
    roots: [Complex; 2],
}

impl Leg {
    fn new(line: &Line, start: Scaled, field: Scaled) -> Self {
        let half_rate = line.rate.times(0.5);
        let roots = roots(half_rate, line.drag.by(field).times(-1.0));
        Self { drag: line.drag, start, field, half_rate, roots }
    }

    /// The time nearest to 0 at which δ coth δt = κ; none if there is none.
    fn time_of(&self, kappa: Scaled) -> Option<Scaled> {
        let [one, other] = self.roots;
        let turning = one.im;
        if zero(turning) {
            let spread = other.re.plus(one.re.times(-1.0)).times(0.5);
            if zero(spread) {
                return (!zero(kappa)).then(|| Scaled::from(1.0).over(kappa));
            }
            // artanh(δ/κ)/δ.
            let size = if less(kappa, Scaled::ZERO) { kappa.times(-1.0) } else { kappa };
            let past = size.plus(spread.times(-1.0));
            let time = |past: Scaled| ln_1p(spread.times(2.0).over(past)).over(spread.times(2.0));
            return less(spread, size)
                .then(|| if less(kappa, Scaled::ZERO) { time(past).times(-1.0) } else { time(past) });
        }
        // δ cot δt = κ: an angle, made more exact by a step of Newton.
        let size = turning.by(turning).plus(kappa.by(kappa)).sqrt();
        let (y, x) = (turning.over(size), kappa.over(size));
        let near = Scaled::from(atan2(y.to_f64(), x.to_f64()));
        let Rotation { cosine, sine, .. } = Rotation::new(near);
        let error = y.by(cosine).plus(x.by(sine).times(-1.0));
        Some(near.plus(error).over(turning))
    }

    /// When it stops: before the start, if it began to move then.
    fn turn(&self) -> Option<Scaled> {
        (!zero(self.start))
            .then(|| self.half_rate.plus(self.field.over(self.start).times(-1.0)))
            .and_then(|kappa| self.time_of(kappa))
            .filter(|&turn| !less(turn, Scaled::ZERO) || less(Scaled::ZERO, self.field))
    }

    /// How long before the start the speed was infinite.
    fn pole(&self) -> Option<Scaled> {
        let kappa = self.half_rate.plus(self.drag.by(self.start));
        self.time_of(kappa).filter(|&time| less(Scaled::ZERO, time))
    }

    /// The way and the speed.
    fn at(&self, t: Scaled) -> (Scaled, Scaled) {
        if self.pole().is_some_and(|before| !less(before.times(-1.0), t)) {
            return (Scaled::from(f64::NEG_INFINITY), Scaled::from(f64::INFINITY));
        }
        // What grows is taken out of all exponentials: ln u = m + ln (u e^{−m}).
        let growth = self.roots[1].re.by(t);
        let far = growth.to_f64() > 1.0;
        let shift = if far { growth } else { Scaled::ZERO };
        let ([fast, slow], _, _) = responses(&self.roots, t);
        let shifted = |z: Complex| Complex::new(z.re.plus(shift.times(-1.0)), z.im);
        let (fast, slow, none) = (shifted(fast), shifted(slow), shifted(Complex::default()));
        let blow = crate::numerics::exponentials::second(fast, slow);
        let root = self.roots[1];
        let rate = fast.exp().plus(Complex::new(root.re.by(t), root.im.by(t)).by(blow)).re;
        let (blow, integral) = (blow.re.by(t), third(none, fast, slow).re.by(t).by(t));
        let gained = self.drag.by(self.start.by(blow).plus(self.field.by(integral)));
        let speed = self.start.by(rate).plus(self.field.by(blow));
        if far {
            let u = none.exp().re.plus(gained);
            return (shift.plus(ln(u)).over(self.drag), speed.over(u));
        }
        (ln_1p(gained).over(self.drag), speed.over(Scaled::from(1.0).plus(gained)))
    }
}

impl Path for Line {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let t = Scaled::new(elapsed, 0);
        if zero(self.drag) {
            let roots = roots(self.rate.times(0.5), Scaled::ZERO);
            let ([fast, slow], blow, rate) = responses(&roots, t);
            let integral = third(Complex::default(), fast, slow).re.by(t).by(t);
            let along = |c: usize, v: Scaled, g: Scaled| self.velocity[c].by(v).plus(self.field[c].by(g));
            return (
                core::array::from_fn(|c| unrounded(self.position[c].plus(along(c, blow, integral)))),
                core::array::from_fn(|c| unrounded(along(c, rate, blow))),
            );
        }
        let (way, speed) = if zero(self.speed) {
            self.after_rest(self.along, t)
        } else {
            self.way(self.speed, self.along, t)
        };
        let along = |c: usize, size: Scaled| {
            if zero(self.direction[c]) { Scaled::ZERO } else { self.direction[c].by(size) }
        };
        (
            core::array::from_fn(|c| unrounded(self.position[c].plus(along(c, way)))),
            core::array::from_fn(|c| unrounded(along(c, speed))),
        )
    }
}
