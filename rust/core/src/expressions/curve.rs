//! A function of one number with its first two derivatives, as code that any scalar runs.
//!
//! The one idea: registers belong to the thread, so that a curve can be asked by all threads at once, and its loops are
//! compiled once for each tier.

use super::assembler::compile;
use super::code::{Code, word};
use super::execute::{self, Part, Scalar, room};
use super::graph::{Graph, Id, Node};
use super::precise::Precise;
use super::program::Output;
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
#[cfg(target_arch = "x86_64")]
use crate::numerics::lanes::{Avx2, Avx512};
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::tiered;
use std::cell::Cell;

thread_local! {
    static REGISTERS: Cell<Vec<Lanes>> = const { Cell::new(Vec::new()) };
}

/// A function of one number with its first two derivatives, as one code: in codes of their own the same numbers would be
/// found by other roundings, and differences of near values be lost.
#[derive(Clone, Debug)]
pub struct Curve {
    all: Code,
    /// To about thirty digits: the value, the derivative, all three.
    precise: [Precise; 3],
}

impl Curve {
    /// Of a node, as a function of the first variable.
    ///
    /// # Errors
    /// `InvalidInput` naming `nodes` for one that is of something else, or is too large.
    pub fn new(mut graph: Graph, root: Id) -> Result<Self> {
        let other = |node: &Node| matches!(node, Node::Time | Node::Parameter(_));
        if graph.any(&[root], other) {
            return Err(Error::invalid(
                "nodes",
                "expected a function of one number, got one of time or parameters",
            ));
        }
        let x = graph.variable(0);
        let slope = graph.gradient(root, &[x])[0];
        let second = graph.gradient(slope, &[x])[0];
        let roots = [root, slope, second];
        let precise = [&roots[..1], &roots[1..2], &roots].map(|roots| Precise::new(&graph, roots));
        Ok(Self { all: compile(&graph, (1, 0), &[], &roots.map(Output::Node))?, precise })
    }

    /// All three to about thirty digits, and by how much rounding may have them off.
    pub fn told(&self, x: DoubleDouble) -> [(DoubleDouble, f64); 3] {
        <[_; 3]>::try_from(self.precise[2].told(x)).unwrap_or([(DoubleDouble::from(f64::NAN), f64::NAN); 3])
    }

    /// One that is no number anywhere.
    pub fn nowhere() -> Self {
        let all = Code {
            variables: 1,
            parameters: 0,
            registers: 2,
            scratch: 0,
            constants: vec![f64::NAN],
            preamble: vec![word::END],
            body: vec![word::CONSTANT, 1, 0, word::END],
            outputs: vec![1; 3],
            operations: 1,
        };
        Self { all, precise: Default::default() }
    }
}

/// Scalars of which a curve is a function.
pub trait Argument: Copy {
    /// The value of a curve, its derivative and its second one.
    #[must_use]
    fn all_on(self, curve: &Curve) -> [Self; 3];
    /// The first of them.
    #[inline(always)]
    #[must_use]
    fn value_on(self, curve: &Curve) -> Self {
        self.all_on(curve)[0]
    }
    /// The second.
    #[inline(always)]
    #[must_use]
    fn slope_on(self, curve: &Curve) -> Self {
        self.all_on(curve)[1]
    }
}

/// Runs a code whose variable is the first register, and gives its results.
#[inline(always)]
fn results<V: Vector8 + Scalar>(code: &Code, x: Lanes) -> [Lanes; 3] {
    // Taken, not borrowed: what is done within a closure would not be compiled for the tier.
    let mut kept = REGISTERS.take();
    let wanted = room::<1>(code);
    if kept.len() < wanted {
        kept.resize(wanted, Lanes([0.0; WIDTH]));
    }
    let registers = V::view_mut(&mut kept);
    registers[0] = V::load(x);
    if code.preamble.first() != Some(&word::END) {
        execute::execute::<V, 1>(code, Part::Preamble, registers);
    }
    execute::execute::<V, 1>(code, Part::Body, registers);
    let mut found = [Lanes([0.0; WIDTH]); 3];
    for (found, &register) in found.iter_mut().zip(&code.outputs) {
        *found = registers[usize::from(register)].store();
    }
    REGISTERS.set(kept);
    found
}

tiered! {
    fn results_tier[][](code: &Code, x: Lanes) -> [Lanes; 3] = results;
}

macro_rules! by_lanes {
    ($($(#[$meta:meta])* $type:ty: $load:expr, $store:expr;)+) => {$(
        $(#[$meta])*
        impl Argument for $type {
            #[inline(always)]
            fn all_on(self, curve: &Curve) -> [Self; 3] {
                let [value, slope, second] = results_tier(&curve.all, $store(self));
                [$load(value), $load(slope), $load(second)]
            }
        }
    )+};
}
by_lanes! {
    f64: |lanes: Lanes| lanes.0[0], |x| Lanes([x; WIDTH]);
    Lanes: |lanes| lanes, |x| x;
    #[cfg(target_arch = "x86_64")]
    Avx2: Self::load, |x: Self| x.store();
    #[cfg(target_arch = "x86_64")]
    Avx512: Self::load, |x: Self| x.store();
}

/// Where a number on the way has no more digits, to the rounding of the curve itself; what the rounded argument leaves out
/// moves along its tangent.
impl Argument for DoubleDouble {
    fn all_on(self, curve: &Curve) -> [Self; 3] {
        told(&curve.precise[2], self).unwrap_or_else(|| along_tangents(curve, self))
    }
    fn value_on(self, curve: &Curve) -> Self {
        told(&curve.precise[0], self).map_or_else(|| along_tangents(curve, self)[0], |[value]| value)
    }
    fn slope_on(self, curve: &Curve) -> Self {
        told(&curve.precise[1], self).map_or_else(|| along_tangents(curve, self)[1], |[slope]| slope)
    }
}

fn told<const N: usize>(precise: &Precise, x: DoubleDouble) -> Option<[DoubleDouble; N]> {
    let found = <[DoubleDouble; N]>::try_from(precise.at(0.0, &[x], &[])).ok()?;
    found.iter().all(|number| number.is_finite()).then_some(found)
}

fn along_tangents(curve: &Curve, x: DoubleDouble) -> [DoubleDouble; 3] {
    let [value, slope, second] = x.high().all_on(curve);
    let rest = DoubleDouble::from(x.low());
    [
        DoubleDouble::from(value) + rest * DoubleDouble::from(slope),
        DoubleDouble::from(slope) + rest * DoubleDouble::from(second),
        DoubleDouble::from(second),
    ]
}
