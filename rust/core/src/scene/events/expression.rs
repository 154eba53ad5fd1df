//! Expressions among events: functions of the time and of coordinates and velocities of bodies, compiled.
//!
//! The one idea: what a user writes is a graph of the coordinates that it looks at, so its rate along the motion is derived, and
//! what it does in a step follows from bounds of those coordinates, or from its rates where it is no more than a parabola of
//! them.

use super::{Moving, Surroundings, View};
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::graph::{Graph, Id, Node, number};
use crate::expressions::intervals::Intervals;
use crate::expressions::program::Output;
use crate::expressions::shape::Shape;
use crate::expressions::table::{self, Parameters, Variables};
use crate::expressions::{Code, Machine};
use crate::numerics::real::Real;
use crate::scene::frame::{Moved, restored};
use core::cell::RefCell;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Up to this degree the cubic through values and rates tells a function, as it does a square of a distance.
const SQUARE: u32 = 2;

/// An expression.
#[derive(Clone, Debug)]
pub struct Expression {
    /// The bodies that it looks at.
    pub bodies: Vec<usize>,
    pub(crate) formula: Arc<Formula>,
}

/// What it is of these bodies.
#[derive(Debug)]
pub(crate) struct Formula {
    /// Its value and its rate: of its coordinates, as many velocities, and as many accelerations.
    pub(crate) code: Arc<Code>,
    /// The coordinates, each by the place of its body among those, and its axis.
    pub(crate) coordinates: Vec<(usize, usize)>,
    pub(crate) looks_at_velocities: bool,
    pub(crate) looks_at_time: bool,
    /// Whether it is the same about any origin, however that moves.
    pub(crate) is_relative: bool,
    /// Its bounds, unless the cubic through its values and rates at the ends of a step tells it.
    pub(crate) bounds: Option<Arc<Intervals>>,
}

impl Expression {
    /// From a table of nodes whose variables are these coordinates of bodies, and their velocities after them.
    ///
    /// # Errors
    /// What is no such table, or too large.
    pub fn read(nodes: &[f64], coordinates: &[(usize, usize)]) -> Result<Self> {
        let n = coordinates.len();
        if coordinates.iter().any(|&(_, axis)| axis > 2) {
            return Err(Error::invalid(
                "events",
                "expected axes from 0 to 2 in the coordinates of an expression",
            ));
        }
        let mut bodies: Vec<usize> = Vec::new();
        let of_bodies = coordinates.iter().map(|&(body, axis)| {
            let known = bodies.iter().position(|other| *other == body);
            let place = known.unwrap_or_else(|| {
                bodies.push(body);
                bodies.len() - 1
            });
            (place, axis)
        });
        let coordinates: Vec<(usize, usize)> = of_bodies.collect();
        let (mut graph, roots) =
            table::read(nodes, 1, Variables { count: 2 * n, unit: 1.0 }, Parameters::Told(&[]))?;
        let bounds = degree(&graph, roots[0])
            .is_none_or(|degree| degree > SQUARE)
            .then(|| Arc::new(Intervals::new(graph.clone(), roots.clone())));
        let looks_at_velocities =
            graph.any(&roots, |node| matches!(node, Node::Variable(index) if *index as usize >= n));
        let looks_at_time = graph.any(&roots, |node| matches!(node, Node::Time));
        let is_relative = is_relative(&mut graph, roots[0], &coordinates);
        let (time, one) = (graph.time(), graph.constant(1.0));
        let mut motion: FxHashMap<Id, Id> = FxHashMap::from_iter([(time, one)]);
        for index in 0..2 * n as u32 {
            let _ = motion.insert(graph.variable(index), graph.variable(index + n as u32));
        }
        let rate = graph.tangent(&roots, &motion);
        let outputs: Vec<Output> = roots.iter().chain(&rate).copied().map(Output::Node).collect();
        let code = Arc::new(compile(&graph, (3 * n, 0), &[], &outputs)?);
        let formula = Formula { code, coordinates, looks_at_velocities, looks_at_time, is_relative, bounds };
        Ok(Self { bodies, formula: Arc::new(formula) })
    }

    /// The same of other bodies.
    #[must_use]
    pub fn of(&self, place: impl Fn(&usize) -> usize) -> Self {
        Self { bodies: self.bodies.iter().map(place).collect(), formula: self.formula.clone() }
    }

    /// Whether it looks at where a body is in the scene, and not by another body.
    pub(crate) fn asks_where(&self) -> bool {
        !self.formula.is_relative
    }

    /// Whether it is told from the ends of a step, and of units side by side at once: these have times of their own.
    pub(crate) fn is_told_abreast(&self) -> bool {
        self.formula.bounds.is_none() && !self.formula.looks_at_time
    }

    /// Its value, of all bodies of a scene.
    pub(crate) fn value_of(&self, t: f64, position: &[[f64; 3]], velocity: &[[f64; 3]]) -> f64 {
        let of = |&body: &usize| Moving {
            position: position[body],
            velocity: velocity[body],
            ..Moving::default()
        };
        let bodies: Vec<Moving> = self.bodies.iter().map(of).collect();
        let places: Vec<usize> = (0..bodies.len()).collect();
        let mut working = Working::new(self);
        working.take(0, (&bodies, &places), &Moved::NOWHERE);
        working.run(0, t)[0]
    }

    /// Its value, of the bodies that are looked at.
    pub(super) fn value(
        &self,
        view: &View<'_>,
        places: &[usize],
        origin: &Moved,
        around: &Surroundings<'_>,
    ) -> f64 {
        let own;
        let working = match around.working {
            Some(working) => working,
            None => {
                own = RefCell::new(Working::new(self));
                &own
            }
        };
        let mut working = working.borrow_mut();
        working.take(0, (view.bodies, places), origin);
        working.run(0, around.scene.t0 + view.elapsed)[0]
    }
}

/// The degree of a polynomial of the time and the state; none of anything else.
fn degree(graph: &Graph, root: Id) -> Option<u32> {
    let mut degrees: FxHashMap<Id, u32> = FxHashMap::default();
    for id in graph.reachable(&[root]) {
        let of = |id: &Id| degrees.get(id).copied();
        let degree = match graph.node(id) {
            Node::Constant(_) | Node::Parameter(_) => 0,
            Node::Variable(_) | Node::Time => 1,
            Node::Sum(_, terms) => terms.iter().try_fold(0, |most: u32, (_, id)| Some(most.max(of(id)?)))?,
            Node::Product(a, b) => of(a)?.saturating_add(of(b)?),
            Node::Quotient(a, b) if of(b) == Some(0) => of(a)?,
            Node::Power(a, exponent) if of(a) == Some(0) && number(*exponent).is_finite() => 0,
            Node::Call(_, a) if of(a) == Some(0) => 0,
            _ => return None,
        };
        let _ = degrees.insert(id, degree);
    }
    degrees.get(&root).copied()
}

/// Whether nothing changes where all places, or all velocities, change by the same: its rate is nothing then.
fn is_relative(graph: &mut Graph, root: Id, coordinates: &[(usize, usize)]) -> bool {
    let (n, one) = (coordinates.len(), graph.constant(1.0));
    for axis in 0..3 {
        for first in [0, n] {
            let along = (0..n).filter(|&index| coordinates[index].1 == axis);
            let all: FxHashMap<Id, Id> =
                along.map(|index| (graph.variable((first + index) as u32), one)).collect();
            let rate = graph.tangent(&[root], &all);
            if !rate.iter().all(|&rate| graph.is_zero(rate)) {
                return false;
            }
        }
    }
    true
}

/// The accelerations at both ends of a step `h`, of the cubic through places and velocities there.
#[inline(always)]
pub(crate) fn accelerations<S: Real>([x0, x1]: [S; 2], [v0, v1]: [S; 2], h: S) -> [S; 2] {
    let per_h = S::one() / h;
    let (two, four) = (S::splat(2.0), S::splat(4.0));
    let mean = S::splat(6.0) * (x1 - x0) * per_h;
    [(mean - four * v0 - two * v1) * per_h, (two * v0 + four * v1 - mean) * per_h]
}

/// An expression at work.
#[derive(Clone, Debug)]
pub struct Working {
    formula: Arc<Formula>,
    machine: Machine<f64>,
    /// Coordinates, velocities and accelerations, at both ends of a step.
    pub(crate) ends: [Vec<f64>; 2],
    /// Its rates there, if they tell what it does between.
    pub(crate) rates: Option<[f64; 2]>,
    /// Its bounds, if there are any.
    pub(crate) shape: Option<Shape>,
}

impl Working {
    /// Of an expression.
    pub(crate) fn new(expression: &Expression) -> Self {
        let formula = expression.formula.clone();
        let ends = [0, 1].map(|_| vec![0.0; 3 * formula.coordinates.len()]);
        let shape = formula.bounds.as_ref().map(|bounds| Shape::new(bounds, &[]));
        Self { machine: Machine::new(formula.code.clone(), &[]), formula, ends, rates: None, shape }
    }

    /// Takes the coordinates of bodies in these places, about an origin, for those at an end of a step.
    #[inline]
    pub(crate) fn take(&mut self, end: usize, (bodies, places): (&[Moving], &[usize]), origin: &Moved) {
        let coordinates = &self.formula.coordinates;
        let (x, v) = self.ends[end].split_at_mut(coordinates.len());
        for (index, &(body, c)) in coordinates.iter().enumerate() {
            let body = &bodies[places[body]];
            x[index] = restored(origin.position[c], (body.position[c], body.position_rest[c])).0;
            v[index] = restored(origin.velocity[c], (body.velocity[c], body.velocity_rest[c])).0;
        }
    }

    /// The accelerations of the cubics through both ends of a step `h`.
    pub(crate) fn accelerate(&mut self, h: f64) {
        let n = self.formula.coordinates.len();
        let [before, after] = &mut self.ends;
        for index in 0..n {
            let (x, v) = ([before[index], after[index]], [before[n + index], after[n + index]]);
            [before[2 * n + index], after[2 * n + index]] = accelerations(x, v, h);
        }
    }

    /// Value and rate at an end.
    #[inline]
    pub(crate) fn run(&mut self, end: usize, t: f64) -> [f64; 2] {
        self.machine.state().copy_from_slice(&self.ends[end]);
        self.machine.run(t);
        [0, 1].map(|index| self.machine.output(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a function of places and velocities of two bodies: its degree, and whether it is relative.
    fn told(make: impl Fn(&mut Graph, [Id; 2], [Id; 2]) -> Id) -> (Option<u32>, bool) {
        let mut graph = Graph::default();
        let [a, b, u, v] = [0, 1, 2, 3].map(|index| graph.variable(index));
        let root = make(&mut graph, [a, b], [u, v]);
        (degree(&graph, root), is_relative(&mut graph, root, &[(0, 0), (1, 0)]))
    }

    #[test]
    fn what_the_ends_of_a_step_tell_and_what_no_origin_changes() {
        assert_eq!(told(|graph, [a, b], _| graph.subtract(a, b)), (Some(1), true));
        assert_eq!(told(|graph, [a, b], _| graph.add(a, b)), (Some(1), false));
        let square = |graph: &mut Graph, [a, b]: [Id; 2]| {
            let apart = graph.subtract(a, b);
            graph.multiply(apart, apart)
        };
        assert_eq!(told(|graph, x, _| square(graph, x)), (Some(2), true));
        assert_eq!(
            told(|graph, x, v| {
                let (x, v) = (graph.subtract(x[0], x[1]), graph.subtract(v[0], v[1]));
                graph.multiply(x, v)
            }),
            (Some(2), true)
        );
        assert_eq!(told(|graph, _, [u, _]| graph.multiply(u, u)), (Some(2), false));
        assert_eq!(
            told(|graph, x, _| {
                let square = square(graph, x);
                graph.multiply(square, square)
            }),
            (Some(4), true)
        );
        assert_eq!(told(|graph, [a, b], _| graph.divide(a, b)).0, None);
    }
}
