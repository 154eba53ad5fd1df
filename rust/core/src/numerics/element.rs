//! `Element`: what the arrays of an integrator's state are made of, and how loops over such arrays run.
//!
//! The one idea: a loop over the state is a value ([`Pass`]) whose body is written once, over the scalar. [`Element::pass`]
//! runs it: as it stands for one number, in the registers of the SIMD tier for lanes. A packed state (lanes are
//! particles) and a batch (lanes are trajectories) are both slices of [`Lanes`] and run through the same code.

use super::double_double::DoubleDouble;
use super::inverse_cube::InverseCube;
use super::lanes::{Lanes, Vector8};
use super::real::Real;

/// A coefficient times the step, as an unevaluated sum.
pub type Scaled<S> = (S, S);

/// Numbers and what they leave out.
pub type Pair<'a, S> = (&'a [S], &'a [S]);

/// Numbers and what they leave out, to be changed.
pub type PairMut<'a, S> = (&'a mut [S], &'a mut [S]);

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

/// What an `S` is while a loop runs: itself, or a register of a SIMD tier.
pub trait View<S>: InverseCube {
    /// From memory.
    fn load(value: S) -> Self;
    /// To memory.
    fn store(self) -> S;
    /// A slice in memory.
    fn view(values: &[S]) -> &[Self];
    /// A mutable slice in memory.
    fn view_mut(values: &mut [S]) -> &mut [Self];

    /// One in memory.
    #[inline(always)]
    fn view_one(value: &S) -> &Self {
        &Self::view(core::slice::from_ref(value))[0]
    }
    /// Two slices in memory.
    #[inline(always)]
    fn pair<'a>(values: Pair<'a, S>) -> Pair<'a, Self> {
        (Self::view(values.0), Self::view(values.1))
    }
    /// Two mutable slices in memory.
    #[inline(always)]
    fn pair_mut<'a>(values: PairMut<'a, S>) -> PairMut<'a, Self> {
        (Self::view_mut(values.0), Self::view_mut(values.1))
    }
    /// A coefficient in memory.
    #[inline(always)]
    fn scaled((high, low): &Scaled<S>) -> Scaled<Self>
    where
        S: Copy,
    {
        (Self::load(*high), Self::load(*low))
    }
    /// A mask of one is a mask of the other.
    fn mask(mask: S::Mask) -> Self::Mask
    where
        S: Real;
    /// And back.
    fn mask_in_memory(mask: Self::Mask) -> S::Mask
    where
        S: Real;
}

/// A loop over arrays of `S`, with its arguments: lanes by reference, since a copy is made with narrower instructions than it
/// is read with, and a processor then waits for it. `run` must be `#[inline(always)]`, as must all it calls, and have no
/// closures: else it is compiled without the tier's instructions.
pub trait Pass<S> {
    /// What it gives.
    type Output;
    /// Runs it, over `V` in place of `S`.
    fn run<V: View<S>>(self) -> Self::Output;
}

/// A scalar that an integrator's state can be made of.
pub trait Element: InverseCube {
    /// Runs a loop as fast as the machine can; with the same bits on every one.
    fn pass<P: Pass<Self>>(pass: P) -> P::Output;
}

macro_rules! own_view {
    ($($type:ty)+) => {$(
        impl View<$type> for $type {
            #[inline(always)]
            fn load(value: $type) -> Self {
                value
            }
            #[inline(always)]
            fn store(self) -> $type {
                self
            }
            #[inline(always)]
            fn view(values: &[$type]) -> &[Self] {
                values
            }
            #[inline(always)]
            fn view_mut(values: &mut [$type]) -> &mut [Self] {
                values
            }
            #[inline(always)]
            fn mask(mask: bool) -> bool {
                mask
            }
            #[inline(always)]
            fn mask_in_memory(mask: bool) -> bool {
                mask
            }
        }
    )+};
}
own_view!(f64 DoubleDouble);

impl<V: Vector8 + InverseCube> View<Lanes> for V {
    #[inline(always)]
    fn load(value: Lanes) -> Self {
        Vector8::load(value)
    }
    #[inline(always)]
    fn store(self) -> Lanes {
        Vector8::store(self)
    }
    #[inline(always)]
    fn view(values: &[Lanes]) -> &[Self] {
        Vector8::view(values)
    }
    #[inline(always)]
    fn view_mut(values: &mut [Lanes]) -> &mut [Self] {
        Vector8::view_mut(values)
    }
    #[inline(always)]
    fn mask(mask: super::lanes::Bits) -> Self::Mask {
        mask
    }
    #[inline(always)]
    fn mask_in_memory(mask: Self::Mask) -> super::lanes::Bits {
        mask
    }
}

#[inline(always)]
fn run<V: View<Lanes>, P: Pass<Lanes>>(pass: P) -> P::Output {
    pass.run::<V>()
}

/// One number has no lanes, but the tier's instructions serve it, too: a fused multiply-add is one, and several numbers of
/// a state go through it at a time.
#[expect(
    clippy::extra_unused_type_parameters,
    reason = "`tiered!` names a vector type to all that it compiles"
)]
#[inline(always)]
fn run_scalar<V: Vector8, P: Pass<f64>>(pass: P) -> P::Output {
    pass.run::<f64>()
}

crate::tiered! {
    fn run_tier[P: Pass<Lanes>][P](pass: P) -> P::Output = run;
    fn run_scalar_tier[P: Pass<f64>][P](pass: P) -> P::Output = run_scalar;
}

impl Element for Lanes {
    #[inline]
    fn pass<P: Pass<Self>>(pass: P) -> P::Output {
        run_tier(pass)
    }
}

impl Element for f64 {
    #[inline]
    fn pass<P: Pass<Self>>(pass: P) -> P::Output {
        run_scalar_tier(pass)
    }
}

impl Element for DoubleDouble {
    #[inline]
    fn pass<P: Pass<Self>>(pass: P) -> P::Output {
        pass.run::<Self>()
    }
}
