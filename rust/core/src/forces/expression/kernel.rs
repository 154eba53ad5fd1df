//! The kernel of an expression: eight bodies at once from the lanes to its coordinates, through its code, and back.

use super::{ExpressionForce, Gives, VARIABLES};
use crate::error::Result;
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::expressions::series::Expansion;
use crate::forces::context::Context;
use crate::forces::series::Series;
use crate::forces::{Adds, Force, Phase};
use crate::numerics::element::Shape;
use crate::numerics::integrals::raise;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;

/// The way from the units and axes of the integration to those of the expressions, and back.
#[derive(Clone, Debug)]
struct Way {
    shape: Shape,
    /// Axes, unless they are those of the scene.
    axes: Option<[[f64; 3]; 3]>,
    /// What places, velocities and times are multiplied with.
    place: f64,
    velocity: f64,
    time: f64,
    /// What is taken away from places and added to times, then.
    origin: [f64; 3],
    t0: f64,
    /// The unit of acceleration, or that of force over the mass of each body; none where there is no body, or none that is
    /// acted on.
    force: Vec<Lanes>,
}

impl Way {
    fn new(term: &ExpressionForce, context: &Context<'_>) -> Self {
        let place = &term.place;
        let [length, _, time] = place.scales;
        let units = context.units;
        let unit = units.take(place.unit(term.gives), term.gives.dimension());
        Self {
            shape: context.shape,
            axes: (place.axes != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).then_some(place.axes),
            place: scale(1.0 / length, units.length),
            velocity: scale(time / length, units.length - units.time),
            time: scale(1.0 / time, units.time),
            origin: place.origin.map(|x| x / length),
            t0: context.t0 / time,
            force: context.per_body(|system, slot| match term.gives {
                _ if !term.acts_on(system.bodies[slot]) => 0.0,
                Gives::Acceleration => unit,
                _ => unit / system.mass[slot],
            }),
        }
    }
}

/// An expression at work.
pub(super) struct Kernel {
    way: Way,
    /// One for each block of systems, with their parameters.
    machines: Vec<Machine<Lanes>>,
    needs: Needs,
}

impl Kernel {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Self {
        let machine = |parameters: Vec<Lanes>| Machine::new(term.expressions.force.clone(), &parameters);
        Self {
            way: Way::new(term, context),
            machines: parameters(term, context).into_iter().map(machine).collect(),
            needs: term.expressions.needs,
        }
    }
}

/// The parameters of each block of systems, of every system in its lane.
fn parameters(term: &ExpressionForce, context: &Context<'_>) -> Vec<Vec<Lanes>> {
    let of =
        |index: usize| context.per_system(|system| context.own(term, system).expressions.parameters[index]);
    let each: Vec<Vec<Lanes>> = (0..term.expressions.parameters.len()).map(of).collect();
    (0..context.blocks()).map(|block| each.iter().map(|values| values[block]).collect()).collect()
}

/// Three components along the axes.
#[inline(always)]
fn turned<V: Real>(axes: &Option<[[f64; 3]; 3]>, x: [V; 3], back: bool) -> [V; 3] {
    let Some(axes) = axes else { return x };
    let mut found = [V::zero(); 3];
    for to in 0..3 {
        for from in 0..3 {
            let along = if back { axes[from][to] } else { axes[to][from] };
            found[to] = V::splat(along).multiply_add(x[from], found[to]);
        }
    }
    found
}

#[inline(always)]
fn apply_body<V: Vector8 + Scalar>(
    kernel: &mut Kernel,
    phase: &Phase<'_, Lanes>,
    a: &mut [Lanes],
    first: bool,
) {
    let Kernel { way, machines, needs } = kernel;
    let rows = way.shape.rows;
    let of_block = rows / machines.len();
    let (q, v, a) = (V::view(phase.q), V::view(phase.v), V::view_mut(a));
    let t = V::splat(way.time).multiply_add(V::load(*phase.t), V::splat(way.t0));
    for row in 0..rows {
        let (code, registers) = machines[row / of_block].parts();
        let outputs = code.output_registers();
        let registers = V::view_mut(registers);
        let mut place = [V::zero(); 3];
        for c in 0..way.shape.components {
            let origin = V::splat(-way.origin[c]);
            place[c] = V::splat(way.place).multiply_add(q[c * rows + row], origin);
        }
        registers[..3].copy_from_slice(&turned(&way.axes, place, false));
        if needs.velocity {
            let mut speed = [V::zero(); 3];
            for c in 0..way.shape.components {
                speed[c] = V::splat(way.velocity) * v[c * rows + row];
            }
            registers[3..VARIABLES].copy_from_slice(&turned(&way.axes, speed, false));
        }
        registers[VARIABLES] = t;
        execute::execute::<V, 1>(code, Part::Body, registers);
        let mut force = [V::zero(); 3];
        for c in 0..3 {
            force[c] = registers[usize::from(outputs[c])];
        }
        let force = turned(&way.axes, force, true);
        let factor = V::load(way.force[row]);
        // Where there is no body the expression may be anything.
        let none = factor.less_equal(V::zero());
        for c in 0..way.shape.components {
            let term = V::select(none, V::zero(), force[c] * factor);
            let a = &mut a[c * rows + row];
            *a = if first { term } else { *a + term };
        }
    }
}

tiered! {
    fn apply_tier[][](kernel: &mut Kernel, phase: &Phase<'_, Lanes>, a: &mut [Lanes], first: bool) = apply_body;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        apply_tier(self, phase, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        self.needs
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}

/// An expression as Taylor series, one for each row of bodies.
pub(super) struct Expanded {
    way: Way,
    rows: Vec<Expansion<Lanes>>,
    needs: Needs,
}

impl Expanded {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Option<Self> {
        let series = term.expressions.series.as_ref()?;
        let way = Way::new(term, context);
        let blocks = parameters(term, context);
        let of_block = way.shape.rows / blocks.len();
        let row = |parameters: &Vec<Lanes>| vec![Expansion::new(series.clone(), parameters); of_block];
        let rows = blocks.iter().flat_map(row).collect();
        Some(Self { rows, way, needs: term.expressions.needs })
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
    let Expanded { way, rows, needs } = force;
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

/// All coefficients of motions under nothing else.
#[inline(always)]
fn whole_body<V: Vector8 + Scalar>(force: &mut Expanded, jet: &mut Jet<Lanes>, a: &mut [Lanes]) {
    let len = jet.len;
    for n in 0..jet.order {
        coefficient_body::<V>(force, n, jet, a, true);
        let [of_v, of_q] = [&jet.inverse[n + 1], &jet.inverse[n + 2]];
        let (of_v, of_q) = ((V::load(of_v.0), V::load(of_v.1)), (V::load(of_q.0), V::load(of_q.1)));
        let (v, q) = (&mut jet.v[(n + 1) * len..][..len], &mut jet.q[(n + 2) * len..][..len]);
        raise(V::view(a), of_v, of_q, V::view_mut(v), V::view_mut(q));
    }
}

tiered! {
    fn whole_tier[][](force: &mut Expanded, jet: &mut Jet<Lanes>, a: &mut [Lanes]) = whole_body;
    fn coefficient_tier[][](force: &mut Expanded, n: usize, jet: &Jet<Lanes>, a: &mut [Lanes], first: bool) = coefficient_body;
}

impl Series<Lanes> for Expanded {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        coefficient_tier(self, n, jet, a, first);
        Ok(())
    }

    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], _: &mut Ticker<'_>) -> Result<()> {
        whole_tier(self, jet, a);
        Ok(())
    }

    fn smooth_until(&self, jet: &Jet<Lanes>, h: Lanes) -> Option<Lanes> {
        let may = self.rows.first().is_some_and(Expansion::may_turn_sharply);
        may.then(|| {
            let h = h / jet.unit;
            self.rows.iter().fold(h, |h, row| row.smooth_until(jet.order, h)) * jet.unit
        })
    }
}
