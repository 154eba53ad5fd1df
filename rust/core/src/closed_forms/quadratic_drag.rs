//! Quadratic drag along a line, with linear drag and a uniform field along it, or without: rise, fall and coasting.
//!
//! In the direction of the motion v′ = G − b v − c v². With v = u′/(c u) that is linear, u″ + b u′ − c G u = 0, and
//! u = 1 + c (V S + G Q), s = ln u/c, v = (V S′ + G S)/u, with the responses S and Q of [`oscillation`](super::oscillation):
//! vacuum as c vanishes, linear drag as the speed does, tangents for a rise and hyperbolic ones for a fall. A body that
//! stops turns there and goes on from rest. Backward in time a speed grows without bound within a finite time.
//! Source: Landau & Lifshitz, *Mechanics*, 3rd ed., section 25, for the linear equation; Riccati's substitution.

use super::oscillation::{Responses, roots};
use super::{ClosedForm, ExactState, Member, Path, Paths, is_uniform, uniform_part, unrounded};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::exponentials::{Complex, Point, second, third};
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
    motion: |member, _, ticker| Paths::motion(member, ticker, |i| Ok(Line::new(member, i))),
};

fn less(a: Scaled, b: Scaled) -> bool {
    a.minus(b).value().to_f64() < 0.0
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
        v[d].by(g[e]).minus(v[e].by(g[d]))
    };
    coefficient(member, particle).is_zero() || (0..3).all(|c| across(c).is_zero())
}

struct Line {
    position: [Scaled; 3],
    velocity: [Scaled; 3],
    field: [Scaled; 3],
    /// The rate of linear drag.
    rate: Scaled,
    /// Where to.
    direction: [Scaled; 3],
    /// Its ways along there, if there is quadratic drag.
    ways: Option<Ways>,
}

/// From the start, if it moves there, and from rest, if there is a field: with it, and against it.
struct Ways {
    first: Option<Leg>,
    from_rest: Option<[Leg; 2]>,
}

fn dot(a: &[Scaled; 3], b: &[Scaled; 3]) -> Scaled {
    a[0].by(b[0]).plus(a[1].by(b[1])).plus(a[2].by(b[2]))
}

impl Line {
    fn new(member: &Member<'_>, particle: usize) -> Self {
        let field = uniform_part(member, particle);
        let velocity = member.velocity[particle].map(Scaled::from);
        let still = velocity.iter().all(|&v| v.is_zero());
        let along = if still { field } else { velocity };
        let size = dot(&along, &along).sqrt();
        let direction = along.map(|x| if size.is_zero() { Scaled::ZERO } else { x.over(size) });
        let drag = coefficient(member, particle);
        let one = Scaled::from(1.0);
        let times = member.forces.iter().filter_map(|force| force.as_linear_drag());
        let rate = times.fold(Scaled::ZERO, |rate, tau| rate.plus(one.over(Scaled::from(tau))));
        let ways = (!drag.is_zero()).then(|| {
            let drag = drag.over(Scaled::from(member.mass[particle]));
            let speed = if still { Scaled::ZERO } else { size };
            Ways::new((drag, rate), speed, dot(&field, &direction))
        });
        let position = member.position[particle].map(Scaled::from);
        Self { position, velocity, field, rate, direction, ways }
    }
}

impl Ways {
    /// With the coefficient of quadratic drag over the mass and the rate of linear drag, from a speed V ≥ 0, the field along it
    /// being G.
    fn new(drags: (Scaled, Scaled), speed: Scaled, field: Scaled) -> Self {
        let leg = |start: Scaled, field: Scaled| Leg::new(drags, start, field);
        Self {
            first: (!speed.is_zero()).then(|| leg(speed, field)),
            from_rest: (!field.is_zero())
                .then(|| [field, field.negative()].map(|field| leg(Scaled::ZERO, field))),
        }
    }

    /// The way and the speed after a time.
    fn at(&self, t: Scaled) -> (Scaled, Scaled) {
        let Some(leg) = &self.first else { return self.after_rest(t) };
        let beyond = |turn: &Scaled| {
            if less(*turn, Scaled::ZERO) { less(t, *turn) } else { less(*turn, t) }
        };
        match leg.turn.filter(beyond) {
            None => leg.at(t),
            Some(turn) => {
                let (there, _) = leg.at(turn);
                let (way, speed) = self.after_rest(t.minus(turn));
                (there.plus(way), speed)
            }
        }
    }

    /// The same from rest: with the field forward in time, and against it backward.
    fn after_rest(&self, t: Scaled) -> (Scaled, Scaled) {
        let Some([with, against]) = &self.from_rest else { return (Scaled::ZERO, Scaled::ZERO) };
        let forward = less(Scaled::ZERO, with.field) == less(Scaled::ZERO, t);
        let (way, speed) = if forward { with } else { against }.at(t);
        if forward { (way, speed) } else { (way.negative(), speed.negative()) }
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
    /// When it stops: before the start, if it began to move then.
    turn: Option<Scaled>,
    /// How long before the start the speed was infinite.
    pole: Option<Scaled>,
}

impl Leg {
    fn new((drag, rate): (Scaled, Scaled), start: Scaled, field: Scaled) -> Self {
        let half_rate = rate.times(0.5);
        let roots = roots(half_rate, drag.by(field).negative());
        let mut leg = Self { drag, start, field, half_rate, roots, turn: None, pole: None };
        (leg.turn, leg.pole) = (leg.turn(), leg.pole());
        leg
    }

    /// The time nearest to 0 at which δ coth δt = κ; none if there is none.
    fn time_of(&self, kappa: Scaled) -> Option<Scaled> {
        let [one, other] = self.roots;
        let turning = one.im;
        if turning.is_zero() {
            let spread = other.re.minus(one.re).times(0.5);
            if spread.is_zero() {
                return (!kappa.is_zero()).then(|| Scaled::from(1.0).over(kappa));
            }
            // artanh(δ/κ)/δ.
            let size = if less(kappa, Scaled::ZERO) { kappa.negative() } else { kappa };
            let past = size.minus(spread);
            let time = |past: Scaled| ln_1p(spread.times(2.0).over(past)).over(spread.times(2.0));
            return less(spread, size)
                .then(|| if less(kappa, Scaled::ZERO) { time(past).negative() } else { time(past) });
        }
        // δ cot δt = κ: an angle, made more exact by a step of Newton.
        let size = turning.by(turning).plus(kappa.by(kappa)).sqrt();
        let (y, x) = (turning.over(size), kappa.over(size));
        let near = Scaled::from(atan2(y.to_f64(), x.to_f64()));
        let Rotation { cosine, sine, .. } = Rotation::new(near);
        let error = y.by(cosine).minus(x.by(sine));
        Some(near.plus(error).over(turning))
    }

    fn turn(&self) -> Option<Scaled> {
        (!self.start.is_zero())
            .then(|| self.half_rate.minus(self.field.over(self.start)))
            .and_then(|kappa| self.time_of(kappa))
            .filter(|&turn| !less(turn, Scaled::ZERO) || less(Scaled::ZERO, self.field))
    }

    fn pole(&self) -> Option<Scaled> {
        let kappa = self.half_rate.plus(self.drag.by(self.start));
        self.time_of(kappa).filter(|&time| less(Scaled::ZERO, time))
    }

    /// The way and the speed.
    fn at(&self, t: Scaled) -> (Scaled, Scaled) {
        if self.pole.is_some_and(|before| !less(before.negative(), t)) {
            return (Scaled::from(f64::NEG_INFINITY), Scaled::from(f64::INFINITY));
        }
        // What grows is taken out of all exponentials: ln u = m + ln (u e^{−m}).
        let growth = self.roots[1].re.by(t);
        let far = growth.to_f64() > 1.0;
        let shift = if far { growth } else { Scaled::ZERO };
        let shifted = |z: Complex| Complex::new(z.re.minus(shift), z.im);
        let points = self.roots.map(|root| root.along(t));
        let [fast, slow] = Point::pair(points.map(shifted));
        let none = Point::new(shifted(Complex::default()));
        let blow = second(&fast, &slow);
        let rate = fast.exponential.plus(points[1].by(blow)).re;
        let (blow, integral) = (blow.re.by(t), third(&none, &fast, &slow).re.by(t).by(t));
        let gained = self.drag.by(self.start.by(blow).plus(self.field.by(integral)));
        let speed = self.start.by(rate).plus(self.field.by(blow));
        if far {
            let u = none.exponential.re.plus(gained);
            return (shift.plus(ln(u)).over(self.drag), speed.over(u));
        }
        (ln_1p(gained).over(self.drag), speed.over(Scaled::from(1.0).plus(gained)))
    }
}

impl Path for Line {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let t = Scaled::new(elapsed, 0);
        let Some(ways) = &self.ways else {
            let roots = roots(self.rate.times(0.5), Scaled::ZERO);
            let Responses { points: [fast, slow], blow, rate, .. } = Responses::new(&roots, t);
            let integral = third(&Point::new(Complex::default()), &fast, &slow).re.by(t).by(t);
            let along = |c: usize, v: Scaled, g: Scaled| self.velocity[c].by(v).plus(self.field[c].by(g));
            return (
                core::array::from_fn(|c| unrounded(self.position[c].plus(along(c, blow, integral)))),
                core::array::from_fn(|c| unrounded(along(c, rate, blow))),
            );
        };
        let (way, speed) = ways.at(t);
        let along = |c: usize, size: Scaled| {
            if self.direction[c].is_zero() { Scaled::ZERO } else { self.direction[c].by(size) }
        };
        (
            core::array::from_fn(|c| unrounded(self.position[c].plus(along(c, way)))),
            core::array::from_fn(|c| unrounded(along(c, speed))),
        )
    }
}
