//! `Element`: what the arrays of an integrator's state are made of, and the loops over such arrays.
//!
//! The one idea: every pass over the state that an integrator needs is one function, written once over [`Real`]
//! (`loops`) and compiled for every SIMD tier (`batch`). A packed state (lanes are particles) and a batch
//! (lanes are trajectories) are both slices of [`Lanes`](super::lanes::Lanes) and run through the same code.
//!
//! Updates are compensated (Kahan, Comm. ACM 8 (1965) 40): `y + e` carries the state
//! with about twice the digits, so that round-off grows like a random walk of the *increments*.

mod batch;
mod loops;

use super::double_double::DoubleDouble;
use super::real::Real;

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

/// A scalar that an integrator's state can be made of.
pub trait Element: Real {
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
    /// `out = y + (e + h Σ weight·k[stage])`; `k` holds the stages one after another.
    fn combine(out: &mut [Self], y: (&[Self], &[Self]), h: Self, terms: &[Term<Self>], k: &[Self]);
    /// `y += h Σ weight·k[stage]`, compensated, into a new state `(out, out_e)`.
    fn combine_compensated(
        out: (&mut [Self], &mut [Self]),
        y: (&[Self], &[Self]),
        h: Self,
        terms: &[Term<Self>],
        k: &[Self],
    );
    /// The largest of the squared scaled errors `|h Σ weight·k|² / (atol + rtol·|y - reference|)²` of the
    /// rows (particles), for two sets of weights at once; each row is a vector of `shape.components` components.
    fn largest_errors(
        shape: Shape,
        y: &[Self],
        reference: &[Self],
        tolerance: (Self, Self),
        h: Self,
        terms: [&[Term<Self>]; 2],
        k: &[Self],
        stride: usize,
    ) -> [Self; 2];
    /// The square root of the square root of …, `times` times.
    fn repeated_sqrt(self, times: u32) -> Self;
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
            fn combine(out: &mut [Self], y: (&[Self], &[Self]), h: Self, terms: &[Term<Self>], k: &[Self]) {
                loops::combine(out, y, h, terms, k);
            }
            fn combine_compensated(
                out: (&mut [Self], &mut [Self]),
                y: (&[Self], &[Self]),
                h: Self,
                terms: &[Term<Self>],
                k: &[Self],
            ) {
                loops::combine_compensated(out, y, h, terms, k);
            }
            fn largest_errors(
                shape: Shape,
                y: &[Self],
                reference: &[Self],
                tolerance: (Self, Self),
                h: Self,
                terms: [&[Term<Self>]; 2],
                k: &[Self],
                stride: usize,
            ) -> [Self; 2] {
                loops::largest_errors(shape, y, reference, tolerance, h, terms, k, stride)
            }
            fn repeated_sqrt(self, times: u32) -> Self {
                loops::repeated_sqrt(self, times)
            }
            fn replace(into: &mut [Self], from: &[Self], mask: Self::Mask) {
                loops::replace(into, from, mask);
            }
        }
    };
}
plain_element!(f64);
plain_element!(DoubleDouble);
