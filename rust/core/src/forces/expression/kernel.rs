//! The kernel of an expression: eight bodies at once from the lanes to its coordinates, through its code, and back.

use super::unseen::Unseen;
use super::{ExpressionForce, Gives, VARIABLES};
use crate::error::Result;
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::forces::context::Context;
use crate::forces::{Adds, Force, Phase};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::system::{Needs, Taken};
use crate::parallel::Ticker;
use crate::tiered;

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
    way: Way,
    /// One for each block of systems, with their parameters.
    machines: Vec<Machine<Lanes>>,
    needs: Needs,
    unseen: Option<Unseen>,
}

impl Kernel {
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Self {
        let machine = |parameters: Vec<Lanes>| Machine::new(term.expressions.force.clone(), &parameters);
        Self {
            way: Way::new(term, context),
            machines: parameters(term, context).into_iter().map(machine).collect(),
            needs: term.expressions.needs,
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

#[inline(always)]
fn apply_body<V: Vector8 + Scalar>(
    kernel: &mut Kernel,
    phase: &Phase<'_, Lanes>,
    a: &mut [Lanes],
    first: bool,
) {
    let Kernel { way, machines, needs, .. } = kernel;
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
    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        self.unseen.as_mut().map_or(Ok(None), |unseen| unseen.seen_until(step))
    }
    fn calm(&mut self, step: &Taken<'_, Lanes>, times: f64) -> Bits {
        self.unseen.as_mut().map_or(Bits(0xff), |unseen| unseen.calm(step, times))
    }
}
