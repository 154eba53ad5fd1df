//! An expression as Taylor series, eight bodies at once.
//!
//! The one idea: beside other forces each order is asked for. Where nothing else acts but what is linear in the place and the
//! velocity of each body, the whole series of a body is one walk through all orders, in the units and along the axes of the
//! expressions, and is taken back to those of the integration when it is done.

use super::ExpressionForce;
use super::alone::Alone;
use super::kernel::{Way, parameters, turned};
use crate::error::Result;
use crate::expressions::execute::Scalar;
use crate::expressions::series::{Beside, Coefficients, Equations, Expansion, Seen};
use crate::forces::context::Context;
use crate::forces::series::Series;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;

/// An expression as Taylor series, one for each row of bodies.
pub(super) struct Expanded {
    way: Way,
    rows: Vec<Expansion<Lanes>>,
    /// Of the only body that there is, in the first lane.
    alone: Option<Alone>,
    needs: Needs,
    /// What else acts on each body, linear in where it is and how it moves.
    linear: Vec<Box<dyn Series<Lanes>>>,
    /// The accelerations by that, of each row, for a unit of time of 1; none before they were asked for.
    besides: Vec<Beside<Lanes>>,
    /// What velocities and accelerations of each row are multiplied with, as the expressions see them.
    of_velocities: Lanes,
    of_rates: Vec<Lanes>,
    /// Coefficients of a row, component after component, in the units of the expressions.
    places: Vec<Lanes>,
    velocities: Vec<Lanes>,
}

/// Coordinates of a body, of which there may be two in a plane.
pub(super) const SPACE: usize = 3;

impl Expanded {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Option<Self> {
        let series = term.expressions.series.as_ref()?;
        let way = Way::new(term, context);
        let blocks = parameters(term, context);
        let of_block = way.shape.rows / blocks.len();
        let row = |parameters: &Vec<Lanes>| vec![Expansion::new(series.clone(), parameters); of_block];
        let rows = blocks.iter().flat_map(row).collect();
        let only = context.systems.len() == 1 && context.first().bodies.len() == 1;
        let alone = blocks.first().filter(|_| only).map(|parameters| Alone::new(series, parameters));
        Some(Self {
            rows,
            alone,
            needs: term.expressions.needs,
            linear: Vec::new(),
            besides: Vec::new(),
            of_velocities: Lanes::splat(way.velocity / way.place),
            of_rates: way.force.iter().map(|&force| force * Lanes::splat(way.place)).collect(),
            places: Vec::new(),
            velocities: Vec::new(),
            way,
        })
    }

    /// The accelerations of each row by what is linear, for the unit of time of a jet.
    fn beside(&mut self, jet: &Jet<Lanes>, a: &mut [Lanes], ticker: &mut Ticker<'_>) -> Result<()> {
        let Self { linear, besides, way, .. } = self;
        let (rows, components) = (way.shape.rows, way.shape.components);
        if besides.is_empty() {
            let nothing = [[Lanes::zero(); SPACE]; SPACE];
            let none = Beside { first: nothing[0], of_places: nothing, of_velocities: nothing };
            besides.resize(rows, none);
            for force in linear.iter_mut() {
                for (axis, velocity) in (0..components).flat_map(|axis| [(axis, false), (axis, true)]) {
                    force.column(axis, velocity, a, (rows, &mut *ticker))?;
                    for (row, beside) in besides.iter_mut().enumerate() {
                        let of = if velocity { &mut beside.of_velocities } else { &mut beside.of_places };
                        (0..components).for_each(|c| of[c][axis] += a[c * rows + row]);
                    }
                }
            }
        }
        for (index, force) in linear.iter_mut().enumerate() {
            force.coefficient(0, jet, a, index == 0, ticker)?;
        }
        Ok(())
    }
}

#[inline(always)]
fn coefficient_body<V: Vector8 + Scalar>(
    force: &mut Expanded,
    n: usize,
    jet: &Jet<Lanes>,
    a: &mut [Lanes],
    first: bool,
) {
    let Expanded { way, rows, needs, .. } = force;
    let count = way.shape.rows;
    let unit = V::load(jet.unit);
    let (per_unit, square) = (V::splat(way.velocity) / unit, unit * unit);
    let time = match n {
        0 => V::splat(way.time).multiply_add(V::load(jet.t), V::splat(way.t0)),
        1 => V::splat(way.time) * unit,
        _ => V::zero(),
    };
    let (q, v, a) = (V::view(jet.position(n)), V::view(jet.velocity(n)), V::view_mut(a));
    for (row, expansion) in rows.iter_mut().enumerate() {
        let (mut place, mut speed) = ([V::zero(); 3], [V::zero(); 3]);
        for c in 0..way.shape.components {
            let origin = V::splat(if n == 0 { -way.origin[c] } else { 0.0 });
            place[c] = V::splat(way.place).multiply_add(q[c * count + row], origin);
            if needs.velocity {
                speed[c] = per_unit * v[c * count + row];
            }
        }
        let (place, speed) = (turned(&way.axes, place, false), turned(&way.axes, speed, false));
        for c in 0..3 {
            expansion.set(c, n, place[c].store());
            expansion.set(3 + c, n, speed[c].store());
        }
        expansion.set(expansion.time(), n, time.store());
        expansion.expand(n);
        let mut force = [V::zero(); 3];
        for c in 0..3 {
            force[c] = V::load(expansion.output(c, n));
        }
        let force = turned(&way.axes, force, true);
        let factor = V::load(way.force[row]);
        let none = factor.less_equal(V::zero());
        for c in 0..way.shape.components {
            let term = V::select(none, V::zero(), force[c] * factor * square);
            let a = &mut a[c * count + row];
            *a = if first { term } else { *a + term };
        }
    }
}

/// The place and the velocity of the bodies of a row, as the expressions see them; what else acts on them, for this unit of
/// time; the time.
#[inline(always)]
fn begin_body<V: Vector8>(
    force: &mut Expanded,
    row: usize,
    jet: &Jet<Lanes>,
    a: &[Lanes],
    seen: (&mut Lanes, &mut Option<Beside<Lanes>>),
) {
    let Expanded { way, places, velocities, besides, .. } = force;
    let (rows, components) = (way.shape.rows, way.shape.components);
    let (q, v, unit) = (V::view(jet.position(0)), V::view(jet.velocity(0)), V::load(jet.unit));
    let (mut place, mut velocity) = ([V::zero(); SPACE], [V::zero(); SPACE]);
    let scale = V::splat(way.place);
    for c in 0..components {
        place[c] = scale.multiply_add(q[c * rows + row], V::splat(-way.origin[c]));
        velocity[c] = scale * v[c * rows + row];
    }
    let (place, velocity) = (turned(&way.axes, place, false), turned(&way.axes, velocity, false));
    let (places, velocities) = (V::view_mut(places), V::view_mut(velocities));
    places[..SPACE].copy_from_slice(&place);
    places[SPACE..2 * SPACE].copy_from_slice(&velocity);
    velocities[..SPACE].copy_from_slice(&velocity);
    let (time, beside) = seen;
    *time = V::splat(way.time).multiply_add(V::load(jet.t), V::splat(way.t0)).store();
    let Some(of) = besides.get(row) else { return };
    let mut scaled = *of;
    for i in 0..SPACE {
        let first = if i < components { scale * V::load(a[i * rows + row]) } else { V::zero() };
        scaled.first[i] = first.store();
        for j in 0..SPACE {
            scaled.of_places[i][j] = (V::load(of.of_places[i][j]) * unit * unit).store();
            scaled.of_velocities[i][j] = (V::load(of.of_velocities[i][j]) * unit).store();
        }
    }
    *beside = Some(scaled);
}

/// Takes the coefficients of a row, from the first that was found on, back to the units and axes of the integration.
#[inline(always)]
fn end_body<V: Vector8>(force: &Expanded, row: usize, jet: &mut Jet<Lanes>) {
    let Expanded { way, places, velocities, .. } = force;
    let (rows, components, len) = (way.shape.rows, way.shape.components, jet.len);
    let back = V::splat(1.0 / way.place);
    let (places, velocities) = (V::view(places), V::view(velocities));
    let (q, v) = (V::view_mut(&mut jet.q), V::view_mut(&mut jet.v));
    for n in 0..jet.order {
        let of_places = &places[(n + 2) * SPACE..][..SPACE];
        let of_velocities = &velocities[(n + 1) * SPACE..][..SPACE];
        let place = turned(&way.axes, [of_places[0], of_places[1], of_places[2]], true);
        let velocity = turned(&way.axes, [of_velocities[0], of_velocities[1], of_velocities[2]], true);
        for c in 0..components {
            q[(n + 2) * len + c * rows + row] = place[c] * back;
            v[(n + 1) * len + c * rows + row] = velocity[c] * back;
        }
    }
}

tiered! {
    fn begin_tier[][](force: &mut Expanded, row: usize, jet: &Jet<Lanes>, a: &[Lanes], seen: (&mut Lanes, &mut Option<Beside<Lanes>>)) = begin_body;
    fn end_tier[][](force: &Expanded, row: usize, jet: &mut Jet<Lanes>) = end_body;
    fn coefficient_tier[][](force: &mut Expanded, n: usize, jet: &Jet<Lanes>, a: &mut [Lanes], first: bool) = coefficient_body;
}

impl Series<Lanes> for Expanded {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        // Beside others the rows are what is asked.
        self.alone = None;
        coefficient_tier(self, n, jet, a, first);
        self.linear.iter_mut().try_for_each(|force| force.coefficient(n, jet, a, false, ticker))
    }

    fn takes_linear(&self) -> bool {
        self.way.axes.is_none()
    }

    fn take_linear(&mut self, linear: Vec<Box<dyn Series<Lanes>>>) {
        self.linear = linear;
    }

    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], ticker: &mut Ticker<'_>) -> Result<()> {
        if !self.linear.is_empty() {
            self.beside(jet, a, ticker)?;
        }
        self.places.resize((jet.order + 2) * SPACE, Lanes::zero());
        self.velocities.resize((jet.order + 1) * SPACE, Lanes::zero());
        let (mut t, mut beside) = (Lanes::zero(), None);
        for row in 0..self.rows.len() {
            begin_tier(self, row, jet, a, (&mut t, &mut beside));
            let time = &Lanes::splat(self.way.time);
            let (velocity, rate) = (&self.of_velocities, &self.of_rates[row]);
            let seen = Some(Seen { time, velocity, rate, beside: beside.as_ref() });
            let (velocity, inverse) = (self.needs.velocity, &jet.inverse[..]);
            let equations = Equations { second_order: true, velocity, t, unit: jet.unit, inverse, seen };
            if let Some(alone) = &mut self.alone {
                let (places, velocities) = (&self.places[..], &self.velocities[..]);
                alone.expand(&equations, (places, velocities), jet.order);
                alone.end(&self.way, jet);
                continue;
            }
            let (q, v) = (&mut self.places[..], &mut self.velocities[..]);
            self.rows[row].motion(&equations, Coefficients { order: jet.order, len: SPACE, q, v });
            end_tier(self, row, jet);
        }
        Ok(())
    }

    fn smooth_until(&self, jet: &Jet<Lanes>, h: &Lanes) -> Option<Lanes> {
        let may = self.rows.first().is_some_and(Expansion::may_turn_sharply);
        may.then(|| {
            let h = *h / jet.unit;
            if let Some(alone) = &self.alone {
                return Lanes::splat(alone.smooth_until(jet.order, h.0[0])) * jet.unit;
            }
            self.rows.iter().fold(h, |h, row| row.smooth_until(jet.order, h)) * jet.unit
        })
    }
}
