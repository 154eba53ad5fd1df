//! `Element`: what the arrays of an integrator's state are made of, and the loops over such arrays.
//!
//! The one idea: every pass over the state that an integrator needs is one function, written once over [`Real`]
//! (`loops`) and compiled for every SIMD tier (`batch`). A packed state (lanes are particles) and a batch
//! (lanes are trajectories) are both slices of [`Lanes`](super::lanes::Lanes) and run through the same code.
//!
//! Updates are compensated (Kahan, Comm. ACM 8 (1965) 40): `y + e` carries the state
//! with about twice the digits, so that round-off grows like a random walk of the *increments*.

pub(crate) mod batch;
mod loops;
pub(crate) mod multistep;
mod relative;

use super::double_double::DoubleDouble;
use super::inverse_cube::InverseCube;

/// A coefficient times the step, as an unevaluated sum.
pub type Scaled<S> = (S, S);

/// One term of a weighted sum of stages.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Term<S> {
    /// Which stage.
    pub stage: usize,
    /// Its weight.
    pub weight: S,
}

/// One term of two weighted sums of stages.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PairTerm<S> {
    /// Which stage.
    pub stage: usize,
    /// Its weights.
    pub weights: [S; 2],
}

/// What stages add to a state: the step, their weights, and their accelerations one after another.
#[derive(Clone, Copy, Debug)]
pub struct Weighted<'a, S> {
    /// The step.
    pub h: &'a S,
    /// The weights.
    pub terms: &'a [Term<S>],
    /// The accelerations.
    pub a: &'a [S],
}

/// The accelerations of nodes gone by, as their backward differences; blocks like that of an acceleration.
///
/// Differences because they are small: `Σ weight·∇²a` rounds what is some thousandths of `a`, where weights of the
/// accelerations themselves, up to a hundred, would round hundredfold. And the first of them are exact.
#[derive(Debug)]
pub struct Differences<'a, S> {
    /// The accelerations at the node before; after a step, here.
    pub last: &'a mut [S],
    /// Their first differences there, too.
    pub first: &'a mut [S],
    /// Second differences, a block for each node, in a ring.
    pub second: &'a mut [S],
    /// The place of the present node in the ring.
    pub newest: usize,
}

/// What a multistep method holds at its present node.
#[derive(Debug)]
pub struct Nodes<'a, S> {
    /// The coordinates, and what they leave out.
    pub q: (&'a mut [S], &'a mut [S]),
    /// Their difference from the node before, and what it leaves out.
    pub d: (&'a mut [S], &'a mut [S]),
    /// The nodes gone by.
    pub past: Differences<'a, S>,
    /// The accelerations at the present node.
    pub a: &'a mut [S],
    /// The step, squared.
    pub h2: &'a S,
    /// h² times the weights of the second differences, the oldest first.
    pub weights: &'a [S],
}

/// A state relative to the first body of each system, with the centre of mass of each. Pairs are numbers and what they
/// leave out.
#[derive(Debug)]
pub struct Relative<'a, S> {
    /// How the coordinates of all bodies lie, system after system in the rows.
    pub shape: Shape,
    /// How many systems.
    pub systems: usize,
    /// Coordinates of each body but the first of each system, one after another, its components together.
    pub q: (&'a [S], &'a [S]),
    /// Velocities, likewise.
    pub v: &'a [S],
    /// The share of each such body in the mass of its system.
    pub shares: (&'a [S], &'a [S]),
    /// Where the centre of each system was at node 0, its components together.
    pub center: (&'a [S], &'a [S]),
    /// How it moves.
    pub drift: (&'a [S], &'a [S]),
    /// The step.
    pub h: S,
    /// The present node.
    pub node: S,
}

/// A scalar that an integrator's state can be made of.
pub trait Element: InverseCube {
    /// `v += kick·a`, then `q += drift·v`, both compensated.
    fn kick_drift(
        q: (&mut [Self], &mut [Self]),
        v: (&mut [Self], &mut [Self]),
        a: &[Self],
        kick: &Scaled<Self>,
        drift: &Scaled<Self>,
    );
    /// `y += step·k`, compensated.
    fn advance(y: (&mut [Self], &mut [Self]), k: &[Self], step: &Scaled<Self>);
    /// `out = q + (e + h·slope.1·slope.0 + h² Σ weight·a)`: coordinates within a step, `slope` being the
    /// velocities at its start and a fraction of it.
    fn combine(out: &mut [Self], q: (&[Self], &[Self]), slope: (&[Self], &Self), stages: Weighted<'_, Self>);
    /// As [`combine`](Self::combine), compensated, into `(out, out_e)`.
    fn combine_compensated(
        out: (&mut [Self], &mut [Self]),
        q: (&[Self], &[Self]),
        slope: (&[Self], &Self),
        stages: Weighted<'_, Self>,
    );
    /// `out = v + (e + h Σ weight·a)`: velocities within a step.
    fn combine_velocity(out: &mut [Self], v: (&[Self], &[Self]), stages: Weighted<'_, Self>);
    /// As [`combine_velocity`](Self::combine_velocity), compensated, into `(out, out_e)`.
    fn combine_velocity_compensated(
        out: (&mut [Self], &mut [Self]),
        v: (&[Self], &[Self]),
        stages: Weighted<'_, Self>,
    );
    /// The largest of the squared scaled errors `|h Σ weight·k|² / (atol + rtol·|y - reference|)²` of the
    /// rows, for two sets of weights at once; each row is a vector of `shape.components` components, one to four.
    /// The derivatives `k` come with the numbers from one stage to the next.
    fn largest_errors(
        shape: Shape,
        y: &[Self],
        reference: &[Self; 4],
        tolerance: (&Self, &Self),
        h: &Self,
        terms: &[PairTerm<Self>],
        k: (&[Self], usize),
    ) -> [Self; 2];
    /// `d += h²·a + Σ weight·∇²a`, the oldest first, then `q += d`, both compensated: a step of a multistep method.
    /// The present accelerations join the past.
    fn multistep(nodes: Nodes<'_, Self>);
    /// `v = d/h + h (weight·a + weight·∇a + weight·∇²a + Σ weight·∇²a)`, in the sum the oldest first: the
    /// velocities at a node of a multistep method. The step comes with its reciprocal, as divisions take long.
    fn backward_velocity(
        v: &mut [Self],
        d: &[Self],
        past: Differences<'_, Self>,
        a: &[Self],
        h: (&Self, &Scaled<Self>),
        weights: &[Self],
    );
    /// The coordinates, compensated, and the velocities of all bodies.
    fn absolute(q: (&mut [Self], &mut [Self]), v: &mut [Self], from: &Relative<'_, Self>);
    /// `if mask { from } else { into }`, element by element.
    fn replace(into: &mut [Self], from: &[Self], mask: Self::Mask);
}

/// How a block of coordinates lies: component after component, each of `rows` elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Elements per component.
    pub rows: usize,
    /// Components per particle: 3, or 2 in a plane.
    pub components: usize,
}

impl Shape {
    /// Elements in the block.
    pub const fn len(self) -> usize {
        self.rows * self.components
    }
    /// Whether there is nothing in it.
    pub const fn is_empty(self) -> bool {
        self.len() == 0
    }
}

macro_rules! plain_element {
    ($type:ty) => {
        impl Element for $type {
            fn kick_drift(
                q: (&mut [Self], &mut [Self]),
                v: (&mut [Self], &mut [Self]),
                a: &[Self],
                kick: &Scaled<Self>,
                drift: &Scaled<Self>,
            ) {
                loops::kick_drift(q, v, a, kick, drift);
            }
            fn advance(y: (&mut [Self], &mut [Self]), k: &[Self], step: &Scaled<Self>) {
                loops::advance(y, k, step);
            }
            fn combine(
                out: &mut [Self],
                q: (&[Self], &[Self]),
                slope: (&[Self], &Self),
                stages: Weighted<'_, Self>,
            ) {
                loops::combine(out, q, slope, stages);
            }
            fn combine_compensated(
                out: (&mut [Self], &mut [Self]),
                q: (&[Self], &[Self]),
                slope: (&[Self], &Self),
                stages: Weighted<'_, Self>,
            ) {
                loops::combine_compensated(out, q, slope, stages);
            }
            fn combine_velocity(out: &mut [Self], v: (&[Self], &[Self]), stages: Weighted<'_, Self>) {
                loops::combine_velocity(out, v, stages);
            }
            fn combine_velocity_compensated(
                out: (&mut [Self], &mut [Self]),
                v: (&[Self], &[Self]),
                stages: Weighted<'_, Self>,
            ) {
                loops::combine_velocity_compensated(out, v, stages);
            }
            fn largest_errors(
                shape: Shape,
                y: &[Self],
                reference: &[Self; 4],
                tolerance: (&Self, &Self),
                h: &Self,
                terms: &[PairTerm<Self>],
                k: (&[Self], usize),
            ) -> [Self; 2] {
                loops::largest_errors(shape, y, reference, (*tolerance.0, *tolerance.1), *h, terms, k)
            }
            fn multistep(nodes: Nodes<'_, Self>) {
                multistep::step(nodes);
            }
            fn backward_velocity(
                v: &mut [Self],
                d: &[Self],
                past: Differences<'_, Self>,
                a: &[Self],
                h: (&Self, &Scaled<Self>),
                weights: &[Self],
            ) {
                multistep::backward_velocity(v, d, past, a, (*h.0, *h.1), weights);
            }
            fn absolute(q: (&mut [Self], &mut [Self]), v: &mut [Self], from: &Relative<'_, Self>) {
                relative::absolute(q, v, from);
            }
            fn replace(into: &mut [Self], from: &[Self], mask: Self::Mask) {
                loops::replace(into, from, mask);
            }
        }
    };
}
plain_element!(f64);
plain_element!(DoubleDouble);
