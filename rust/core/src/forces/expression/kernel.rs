//! The kernel of an expression: eight bodies at once from the lanes to its coordinates, through its code, and back.

use super::unseen::Unseen;
use super::{ExpressionForce, Gives, VARIABLES};
use crate::error::Result;
use crate::expressions::execute::{self, Part, Scalar};
use crate::expressions::{Code, Machine};
use crate::forces::context::Context;
use crate::forces::derivative::{Along, Derivative};
use crate::forces::{Adds, Force, Phase};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::system::{Needs, Taken};
use crate::parallel::Ticker;
use crate::tiered;
use std::sync::Arc;

/// The way from the units and axes of the integration to those of the expressions, and back.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub(super) shape: Shape,
    /// Axes, unless they are those of the scene.
    pub(super) axes: Option<[[f64; 3]; 3]>,
    /// What places, velocities and times are multiplied with.
    pub(super) place: f64,
    pub(super) velocity: f64,
    pub(super) time: f64,
    /// What is taken away from places and added to times, then.
    pub(super) origin: [f64; 3],
    pub(super) t0: f64,
    /// The unit of acceleration, or that of force over the mass of each body; none where there is no body, or none that is
    /// acted on.
    pub(super) force: Vec<Lanes>,
}

impl Way {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Self {
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
    at_work: AtWork,
    unseen: Option<Unseen>,
}

/// Codes beside bodies in lanes.
struct AtWork {
    way: Way,
    /// One for each block of systems, with their parameters.
    machines: Vec<Machine<Lanes>>,
    needs: Needs,
}

impl AtWork {
    fn new(term: &ExpressionForce, code: &Arc<Code>, context: &Context<'_>) -> Self {
        let machine = |parameters: Vec<Lanes>| Machine::new(code.clone(), &parameters);
        Self {
            way: Way::new(term, context),
            machines: parameters(term, context).into_iter().map(machine).collect(),
            needs: term.expressions.needs,
        }
    }
}

impl Kernel {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Self {
        Self {
            at_work: AtWork::new(term, &term.expressions.force, context),
            unseen: Unseen::new(term, context),
        }
    }
}

/// The parameters of each block of systems, of every system in its lane.
pub(super) fn parameters(term: &ExpressionForce, context: &Context<'_>) -> Vec<Vec<Lanes>> {
    let of =
        |index: usize| context.per_system(|system| context.own(term, system).expressions.parameters[index]);
    let each: Vec<Vec<Lanes>> = (0..term.expressions.parameters.len()).map(of).collect();
    (0..context.blocks()).map(|block| each.iter().map(|values| values[block]).collect()).collect()
}

/// Three components along the axes.
#[inline(always)]
pub(super) fn turned<V: Real>(axes: &Option<[[f64; 3]; 3]>, x: [V; 3], back: bool) -> [V; 3] {
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

/// Lays a place, or a velocity, of a row of bodies into registers.
#[inline(always)]
fn lay<V: Vector8>(
    way: &Way,
    (numbers, row): (&[V], usize),
    (unit, origin): (f64, [f64; 3]),
    registers: &mut [V],
) {
    let mut own = [V::zero(); 3];
    for c in 0..way.shape.components {
        own[c] = V::splat(unit).multiply_add(numbers[c * way.shape.rows + row], V::splat(-origin[c]));
    }
    registers.copy_from_slice(&turned(&way.axes, own, false));
}

/// Runs the code of each row of bodies; beside places and velocities those of a direction, if there is one.
#[inline(always)]
fn run<V: Vector8 + Scalar>(
    at_work: &mut AtWork,
    phase: &Phase<'_, Lanes>,
    along: Option<Along<'_, Lanes>>,
    a: &mut [Lanes],
    first: bool,
) {
    let AtWork { way, machines, needs } = at_work;
    let rows = way.shape.rows;
    let of_block = rows / machines.len();
    let (q, v, a) = (V::view(phase.q), V::view(phase.v), V::view_mut(a));
    let t = V::splat(way.time).multiply_add(V::load(*phase.t), V::splat(way.t0));
    for row in 0..rows {
        let (code, registers) = machines[row / of_block].parts();
        let outputs = code.output_registers();
        let registers = V::view_mut(registers);
        lay(way, (q, row), (way.place, way.origin), &mut registers[..3]);
        if needs.velocity {
            lay(way, (v, row), (way.velocity, [0.0; 3]), &mut registers[3..VARIABLES]);
        }
        let mut inputs = VARIABLES;
        if let Some(along) = along {
            let (of_places, of_velocities) = (V::view(along.q), V::view(along.v));
            lay(way, (of_places, row), (way.place, [0.0; 3]), &mut registers[inputs..inputs + 3]);
            if needs.velocity {
                let own = &mut registers[inputs + 3..inputs + VARIABLES];
                lay(way, (of_velocities, row), (way.velocity, [0.0; 3]), own);
            }
            inputs += VARIABLES;
        }
        registers[inputs] = t;
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
    fn run_tier[][](at_work: &mut AtWork, phase: &Phase<'_, Lanes>, along: Option<Along<'_, Lanes>>, a: &mut [Lanes], first: bool) = run;
}

/// How an expression changes along a direction.
pub(super) struct Change(AtWork);

impl Change {
    /// By the code of that.
    pub(super) fn new(term: &ExpressionForce, code: &Arc<Code>, context: &Context<'_>) -> Self {
        Self(AtWork::new(term, code, context))
    }
}

impl Derivative<Lanes> for Change {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        run_tier(&mut self.0, phase, Some(along), change, true);
        Ok(())
    }
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        run_tier(&mut self.at_work, phase, None, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        self.at_work.needs
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        self.unseen.as_mut().map_or(Ok(None), |unseen| unseen.seen_until(step))
    }
    fn calm(&mut self, step: &Taken<'_, Lanes>, times: f64) -> Bits {
        self.unseen.as_mut().map_or(Bits(0xff), |unseen| unseen.calm(step, times))
    }
}
