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
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
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
struct Order<'a> {
    n: usize,
    jet: &'a Jet<Lanes>,
    axes: usize,
}

impl Order<'_> {
    /// Of a row.
    fn row(&self, row: usize) -> [Lanes; 6] {
        let rows = self.jet.len / self.axes;
        let per_unit = Lanes::one() / self.jet.unit;
        let mut found = [Lanes::zero(); 6];
        for c in 0..self.axes {
            found[c] = self.jet.position(self.n)[c * rows + row];
            found[3 + c] = self.jet.velocity(self.n)[c * rows + row] * per_unit;
        }
        found
    }

    /// What the source gives to a row of bodies in the lanes of a mask; beside them the pair is one apart.
    fn pull(
        &self,
        pair: &mut Expansion<Lanes>,
        bodies: [Lanes; 6],
        source: [Lanes; 6],
        there: Bits,
    ) -> [Lanes; 3] {
        for (index, (body, own)) in bodies.into_iter().zip(source).enumerate() {
            let apart = if self.n == 0 && index == 0 { Lanes::one() } else { Lanes::zero() };
            pair.set(index, self.n, Lanes::select(there, body - own, apart));
        }
        pair.expand(self.n);
        let square = self.jet.unit * self.jet.unit;
        [0, 1, 2].map(|c| Lanes::select(there, pair.output(c, self.n) * square, Lanes::zero()))
    }
}

/// Eight numbers, in the order of all such sums.
fn sum_of_eight<T: Copy + core::ops::Add<Output = T>>(p: [T; WIDTH]) -> T {
    ((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7]))
}

impl<L: WrittenLaw> SourceSeries<L> {
    /// Bodies of one system in lanes.
    fn packed(&mut self, order: &Order<'_>, a: &mut [Lanes]) {
        let Self { kernel, pairs, axes } = self;
        let rows = kernel.shape.rows;
        for (source, pairs) in kernel.sources.iter().zip(pairs) {
            let (own, lane) = source.place;
            let place = order.row(own).map(|x| Lanes::splat(x.0[lane]));
            let mut sum = [Lanes::zero(); 3];
            for (row, pair) in pairs.iter_mut().enumerate() {
                let term = order.pull(pair, order.row(row), place, source.others[row]);
                for c in 0..*axes {
                    a[c * rows + row] += term[c];
                    if row < kernel.active.div_ceil(WIDTH) {
                        sum[c] += Lanes::splat(sum_of_eight((source.shares[row] * term[c]).0));
                    }
                }
            }
            for c in 0..*axes {
                a[c * rows + own] += Lanes::select(source.itself, sum[c], Lanes::zero());
            }
        }
    }

    /// Systems in lanes, a row for each body.
    fn batched(&mut self, order: &Order<'_>, a: &mut [Lanes]) {
        let Self { kernel, pairs, axes } = self;
        let Shape { rows, .. } = kernel.shape;
        let bodies = rows / kernel.blocks.max(1);
        for block in 0..kernel.blocks {
            for (source, pairs) in kernel.sources.iter().zip(&mut *pairs) {
                let own = block * bodies + source.place.0;
                let place = order.row(own);
                let mut sum = [Lanes::zero(); 3];
                for first in (0..bodies).step_by(WIDTH) {
                    let mut parts = [[Lanes::zero(); WIDTH]; 3];
                    for slot in
                        (first..bodies.min(first + WIDTH)).filter(|&slot| block * bodies + slot != own)
                    {
                        let at = block * bodies + slot;
                        let term = order.pull(&mut pairs[at], order.row(at), place, Bits(0xff));
                        for c in 0..*axes {
                            a[c * rows + at] += term[c];
                            if slot < kernel.active {
                                parts[c][slot - first] = source.shares[at] * term[c];
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
            self.packed(&order, a)
        } else {
            self.batched(&order, a)
        }
        Ok(())
    }
}
