//! The forces of sources as Taylor series.
//!
//! The one idea: a law that is written as an expression of where a body is and how it moves, relative to a source, has
//! recurrences, and each pair its own coefficients. They are added up as the forces are (see [`sources`](super)).

use super::{Kernel, Law, NUMBERS};
use crate::error::Result;
use crate::expressions::graph::{Graph, Id};
use crate::expressions::program::Output;
use crate::expressions::series::{Expansion, Series as Recurrences};
use crate::forces::context::Context;
use crate::forces::series::Series;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
use crate::tiered;
use std::sync::Arc;

/// What the recurrences of a law are of: three coordinates, then three velocities.
const VARIABLES: u32 = 6;

/// A place and a velocity relative to a source, as nodes of an expression.
pub(in super::super) struct Written {
    pub(in super::super) d: [Id; 3],
    pub(in super::super) velocity: [Id; 3],
    pub(in super::super) strength: Id,
    /// Those of the source.
    pub(in super::super) numbers: [Id; NUMBERS],
}

/// A law that can be written as an expression.
pub(in super::super) trait WrittenLaw: Law {
    /// What [`pull`](Law::pull) gives.
    fn written(&self, source: usize, of: &Written, graph: &mut Graph) -> [Id; 3];
}

/// The recurrences of what a source does, what it is being its parameters; nothing if the expression is too large.
pub(super) fn recurrences<L: WrittenLaw>(law: &L, source: usize) -> Option<Arc<Recurrences>> {
    let mut graph = Graph::default();
    let mut variables = (0..VARIABLES).map(|index| graph.variable(index));
    let of = Written {
        d: [variables.next()?, variables.next()?, variables.next()?],
        velocity: [variables.next()?, variables.next()?, variables.next()?],
        strength: graph.parameter(0),
        numbers: core::array::from_fn(|number| graph.parameter(1 + number as u32)),
    };
    let outputs = law.written(source, &of, &mut graph).map(Output::Node);
    Recurrences::new(&graph, (VARIABLES as usize, 1 + NUMBERS), &[], &outputs).ok().map(Arc::new)
}

impl<L: WrittenLaw> Kernel<L> {
    /// The same as series; nothing if the expression is too large.
    pub(in super::super) fn series(self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let mut pairs = Vec::new();
        for source in &self.sources {
            let series = recurrences(&self.law, source.index)?;
            let of_block = self.shape.rows / self.blocks.max(1);
            pairs.push(
                (0..self.shape.rows)
                    .map(|row| Expansion::new(series.clone(), &source.of[row / of_block]))
                    .collect(),
            );
        }
        let axes = if context.shape.components == 2 { 2 } else { 3 };
        Some(Box::new(SourceSeries { kernel: self, pairs, axes }))
    }
}

/// The coefficients of each body beside each source.
struct SourceSeries<L> {
    kernel: Kernel<L>,
    /// Source by source, of the bodies in each row.
    pairs: Vec<Vec<Expansion<Lanes>>>,
    axes: usize,
}

/// A coefficient of the places and velocities of bodies.
#[derive(Clone, Copy)]
struct Order<'a> {
    n: usize,
    jet: &'a Jet<Lanes>,
    axes: usize,
}

impl Order<'_> {
    /// Of a row.
    #[inline(always)]
    fn row<V: Vector8>(&self, row: usize) -> [V; 6] {
        let rows = self.jet.len / self.axes;
        let per_unit = V::load(self.jet.per_unit);
        let (q, v) = (V::view(self.jet.position(self.n)), V::view(self.jet.velocity(self.n)));
        let mut found = [V::zero(); 6];
        for c in 0..self.axes {
            found[c] = q[c * rows + row];
            found[3 + c] = v[c * rows + row] * per_unit;
        }
        found
    }

    /// What the source gives to a row of bodies in the lanes of a mask; beside them the pair is one apart.
    #[inline(always)]
    fn pull<V: Vector8>(
        &self,
        pair: &mut Expansion<Lanes>,
        bodies: [V; 6],
        source: [V; 6],
        there: Bits,
    ) -> [V; 3] {
        for index in 0..6 {
            let apart = if self.n == 0 && index == 0 { V::one() } else { V::zero() };
            let between = V::select(there, bodies[index] - source[index], apart);
            pair.set(index, self.n, between.store());
        }
        pair.expand(self.n);
        let unit = V::load(self.jet.unit);
        let mut pull = [V::zero(); 3];
        for c in 0..3 {
            let own = V::load(pair.output(c, self.n)) * (unit * unit);
            pull[c] = V::select(there, own, V::zero());
        }
        pull
    }
}

/// Eight numbers, in the order of all such sums.
#[inline(always)]
fn sum_of_eight<T: Copy + core::ops::Add<Output = T>>(p: [T; WIDTH]) -> T {
    ((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7]))
}

/// Bodies of one system in lanes.
#[inline(always)]
fn packed<V: Vector8, L: WrittenLaw>(series: &mut SourceSeries<L>, order: Order<'_>, a: &mut [Lanes]) {
    let SourceSeries { kernel, pairs, axes } = series;
    let (rows, a) = (kernel.shape.rows, V::view_mut(a));
    for (source, pairs) in kernel.sources.iter().zip(pairs) {
        let (own, lane) = source.place;
        let mut place = order.row::<V>(own);
        for number in &mut place {
            *number = V::splat(number.store().0[lane]);
        }
        let mut sum = [V::zero(); 3];
        for (row, pair) in pairs.iter_mut().enumerate() {
            let term = order.pull(pair, order.row::<V>(row), place, source.others[row]);
            for c in 0..*axes {
                a[c * rows + row] += term[c];
                if row < kernel.active.div_ceil(WIDTH) {
                    sum[c] += V::splat(sum_of_eight((V::load(source.shares[row]) * term[c]).store().0));
                }
            }
        }
        for c in 0..*axes {
            a[c * rows + own] += V::select(source.itself, sum[c], V::zero());
        }
    }
}

/// Systems in lanes, a row for each body.
#[inline(always)]
fn batched<V: Vector8, L: WrittenLaw>(series: &mut SourceSeries<L>, order: Order<'_>, a: &mut [Lanes]) {
    let SourceSeries { kernel, pairs, axes } = series;
    let (Shape { rows, .. }, a) = (kernel.shape, V::view_mut(a));
    let bodies = rows / kernel.blocks.max(1);
    for block in 0..kernel.blocks {
        for (source, pairs) in kernel.sources.iter().zip(&mut *pairs) {
            let own = block * bodies + source.place.0;
            let place = order.row::<V>(own);
            let mut sum = [V::zero(); 3];
            for first in (0..bodies).step_by(WIDTH) {
                let mut parts = [[V::zero(); WIDTH]; 3];
                for slot in (first..bodies.min(first + WIDTH)).filter(|&slot| block * bodies + slot != own) {
                    let at = block * bodies + slot;
                    let term = order.pull(&mut pairs[at], order.row::<V>(at), place, Bits(0xff));
                    for c in 0..*axes {
                        a[c * rows + at] += term[c];
                        if slot < kernel.active {
                            parts[c][slot - first] = V::load(source.shares[at]) * term[c];
                        }
                    }
                }
                if first < kernel.active {
                    for c in 0..*axes {
                        sum[c] += sum_of_eight(parts[c]);
                    }
                }
            }
            for c in 0..*axes {
                a[c * rows + own] += sum[c];
            }
        }
    }
}

tiered! {
    fn packed_tier[L: WrittenLaw][L](series: &mut SourceSeries<L>, order: Order<'_>, a: &mut [Lanes]) = packed;
    fn batched_tier[L: WrittenLaw][L](series: &mut SourceSeries<L>, order: Order<'_>, a: &mut [Lanes]) = batched;
}

impl<L: WrittenLaw> Series<Lanes> for SourceSeries<L> {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        if first {
            a.fill(Lanes::zero());
        }
        let order = Order { n, jet, axes: self.axes };
        if self.kernel.packed {
            packed_tier(self, order, a)
        } else {
            batched_tier(self, order, a)
        }
        Ok(())
    }
}
