//! Expressions among events in lanes: of eight units side by side, or along eight steps of one.
//!
//! The one idea: values and rates at both ends of a step come from one program, whatever lies in the lanes.

use super::super::super::events::{Event, Expression, Formula, Moving, What, accelerations};
use super::Bodies;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};
use super::spheres::eight;
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::scene::frame::{Moved, restored};
use crate::tiered;
use std::sync::Arc;

/// What an event is of its bodies, if it is an expression that is told from the ends of a step.
fn told_by_ends(event: &Event) -> Option<&Arc<Formula>> {
    let What::Expression(expression) = &event.what else { return None };
    let Expression { formula, .. } = expression;
    expression.is_told_abreast().then_some(formula)
}

/// An expression of eight units, one in each lane.
pub(super) struct ExpressionAbreast {
    machine: Machine<Lanes>,
    /// Of each coordinate its place in the expression, and where it lies in a state. Axes on which nothing moves are not there.
    rows: Vec<(usize, usize)>,
    looks_at_velocities: bool,
    /// Coordinates, velocities and accelerations at the last node, and at this one.
    ends: [Vec<Lanes>; 2],
}

impl ExpressionAbreast {
    /// Of an event whose bodies lie in these places, if it is an expression that is told from the ends of a step.
    pub(super) fn of(event: &Event, places: &[usize], bodies: &Bodies) -> Option<Self> {
        let formula = told_by_ends(event)?;
        let coordinates = formula.coordinates.iter().enumerate().filter(|(_, of)| of.1 < bodies.components);
        let row = |(index, &(body, c)): (usize, &(usize, usize))| {
            (index, bodies.row(places[body]) + c * (bodies.stride / WIDTH))
        };
        Some(Self {
            machine: Machine::new(formula.code.clone(), &[]),
            rows: coordinates.map(row).collect(),
            looks_at_velocities: formula.looks_at_velocities,
            ends: [0, 1].map(|_| vec![Lanes::zero(); 3 * formula.coordinates.len()]),
        })
    }

    /// The units in whose step `h` it may be zero, of those that take it.
    pub(super) fn suspects(&mut self, lanes: Bits, h: &Lanes, bodies: &Bodies, state: &State<Lanes>) -> Bits {
        near_of_eight(self, lanes, h, bodies, state)
    }
}

tiered! {
    fn near_of_eight[][](abreast: &mut ExpressionAbreast, lanes: Bits, h: &Lanes, bodies: &Bodies, state: &State<Lanes>) -> Bits = eight_units;
}

#[inline(always)]
fn eight_units<V: Vector8 + Scalar>(
    abreast: &mut ExpressionAbreast,
    lanes: Bits,
    h: &Lanes,
    bodies: &Bodies,
    state: &State<Lanes>,
) -> Bits {
    let ExpressionAbreast { machine, rows, looks_at_velocities, ends: [before, after] } = abreast;
    let h = V::load(*h);
    let n = before.len() / 3;
    let [length, speed] = [V::splat(bodies.factors[0]), V::splat(bodies.factors[1])];
    let (q, v) = (state.position().0, state.velocity().0);
    for &(index, row) in &*rows {
        let (x, velocity) = (V::load(q[row]) * length, V::load(v[row]) * speed);
        if *looks_at_velocities {
            let ends = [V::load(before[index]), x];
            let at_ends = accelerations(ends, [V::load(before[n + index]), velocity], h);
            before[2 * n + index] = at_ends[0].store();
            after[2 * n + index] = at_ends[1].store();
        }
        (after[index], after[n + index]) = (x.store(), velocity.store());
    }
    let start = run::<V>(machine, before);
    let end = run::<V>(machine, after);
    for (before, after) in before.iter_mut().zip(&*after) {
        *before = V::select(lanes, V::load(*after), V::load(*before)).store();
    }
    keeps_clear(cubic([start[0], end[0]], [start[1], end[1]], h)).not()
}

/// Value and rate.
#[inline(always)]
fn run<V: Vector8 + Scalar>(machine: &mut Machine<Lanes>, state: &[Lanes]) -> [V; 2] {
    let (code, registers) = machine.parts();
    registers[..state.len()].copy_from_slice(state);
    let registers = V::view_mut(registers);
    execute::execute::<V, 1>(code, Part::Body, registers);
    let outputs = code.output_registers();
    [registers[usize::from(outputs[0])], registers[usize::from(outputs[1])]]
}

/// An expression along eight steps of one unit, which lie in the lanes.
pub(super) struct ExpressionAlong {
    formula: Arc<Formula>,
    machine: Machine<Lanes>,
    /// Its bodies, among those that are looked at.
    bodies: Vec<usize>,
    here: Vec<Moving>,
    /// Whether it looks at where a body is in the scene.
    pub(super) asks_where: bool,
    /// Coordinates and velocities, node after node.
    nodes: Vec<[f64; WIDTH + 1]>,
    /// The same, and accelerations, at both ends of each step.
    ends: [Vec<Lanes>; 2],
}

impl ExpressionAlong {
    /// Of an event of these bodies, if it is an expression that is told from the ends of a step.
    pub(super) fn of(event: &Event, bodies: &[usize]) -> Option<Self> {
        let formula = told_by_ends(event)?.clone();
        let n = formula.coordinates.len();
        Some(Self {
            machine: Machine::new(formula.code.clone(), &[]),
            formula,
            bodies: bodies.to_vec(),
            here: vec![Moving::default(); bodies.len()],
            asks_where: event.asks_where(),
            nodes: vec![[0.0; WIDTH + 1]; 2 * n],
            ends: [0, 1].map(|_| vec![Lanes::zero(); 3 * n]),
        })
    }

    /// Takes note in one of nine places of how its bodies move at a node.
    pub(super) fn note(&mut self, place: usize, origin: &Moved, bodies: &Bodies, state: &State<Lanes>) {
        for (here, &body) in self.here.iter_mut().zip(&self.bodies) {
            *here = bodies.one(body, state);
        }
        let n = self.formula.coordinates.len();
        for (index, &(body, c)) in self.formula.coordinates.iter().enumerate() {
            let body = &self.here[body];
            let x = restored(origin.position[c], (body.position[c], body.position_rest[c]));
            let v = restored(origin.velocity[c], (body.velocity[c], body.velocity_rest[c]));
            (self.nodes[index][place], self.nodes[n + index][place]) = (x.0, v.0);
        }
    }

    /// Those of so many steps `h` in which it may be zero.
    pub(super) fn suspects(&mut self, steps: usize, h: f64) -> Bits {
        let mut cubics = [Lanes::zero(); 4];
        let near = near(self, h, &mut cubics);
        let mut suspects = Bits(0);
        for step in (0..steps).filter(|&step| near.lane(step)) {
            if !keeps_clear_after_all(cubics.map(|lanes| lanes.0[step])) {
                suspects = suspects.or(Bits(1 << step));
            }
        }
        suspects
    }
}

tiered! {
    fn near[][](along: &mut ExpressionAlong, h: f64, cubics: &mut [Lanes; 4]) -> Bits = eight_steps;
}

#[inline(always)]
fn eight_steps<V: Vector8 + Scalar>(along: &mut ExpressionAlong, h: f64, cubics: &mut [Lanes; 4]) -> Bits {
    let ExpressionAlong { formula, machine, nodes, ends: [before, after], .. } = along;
    let (n, h) = (formula.coordinates.len(), V::splat(h));
    for (index, numbers) in nodes.iter().enumerate() {
        before[index] = eight::<V>(numbers, 0).store();
        after[index] = eight::<V>(numbers, 1).store();
    }
    if formula.looks_at_velocities {
        for index in 0..n {
            let x = [V::load(before[index]), V::load(after[index])];
            let v = [V::load(before[n + index]), V::load(after[n + index])];
            let at_ends = accelerations(x, v, h);
            (before[2 * n + index], after[2 * n + index]) = (at_ends[0].store(), at_ends[1].store());
        }
    }
    let [start, end] = [run::<V>(machine, before), run::<V>(machine, after)];
    let coefficients = cubic([start[0], end[0]], [start[1], end[1]], h);
    for (into, lanes) in cubics.iter_mut().zip(coefficients) {
        *into = lanes.store();
    }
    keeps_clear(coefficients).not()
}
