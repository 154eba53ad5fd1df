//! Eight `f64` side by side: the logical width of every kernel on every tier.
//!
//! [`Lanes`] is how lanes lie in memory, with the portable arithmetic on them; `Avx2` and `Avx512`
//! have the same layout and the same results, so a slice of one can be viewed as a slice of another.
//! Those two stay within the crate: their instructions may run only where `tiered!` has seen that there are any.

pub use words::Words;

use super::double_double::{DoubleDouble, two_product};
use super::real::{Mask, Real};

/// The logical width of every kernel.
pub const WIDTH: usize = 8;

/// Eight numbers, 64-byte aligned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f64; WIDTH]);

/// Eight truth values, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits(pub u8);

impl Mask for Bits {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self(if value { 0xff } else { 0 })
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0 == 0xff
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Bits {
    /// Whether lane `lane` is true.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }
}

/// A tier's eight lanes. Same size, alignment and meaning as [`Lanes`], which only the types of this room promise.
pub trait Vector8: Real<Mask = Bits> + sealed::Sealed {
    /// How many of them a processor's registers hold.
    const REGISTERS: usize;
    /// Whether every operation is a call. Kernels are then not written out for each number of bodies, nor for the plane, which
    /// would save little time and be a good part of all code.
    const APART: bool = false;
    /// Eight integers of the tier.
    type Words: Words;
    /// A slice of lanes seen as this tier's.
    #[inline(always)]
    fn view(lanes: &[Lanes]) -> &[Self] {
        const { assert!(size_of::<Self>() == 64 && align_of::<Self>() <= 64) }
        // SAFETY: it has the size of `Lanes` and no stricter alignment (checked above); any bits are valid for
        // both types.
        unsafe { core::slice::from_raw_parts(lanes.as_ptr().cast(), lanes.len()) }
    }
    /// A mutable slice of lanes seen as this tier's.
    #[inline(always)]
    fn view_mut(lanes: &mut [Lanes]) -> &mut [Self] {
        const { assert!(size_of::<Self>() == 64 && align_of::<Self>() <= 64) }
        // SAFETY: as in `view`.
        unsafe { core::slice::from_raw_parts_mut(lanes.as_mut_ptr().cast(), lanes.len()) }
    }
    /// From memory.
    fn load(lanes: Lanes) -> Self;
    /// To memory.
    fn store(self) -> Lanes;
    /// Lane `i` of the result is lane `index[i]` of `self` (`index[i] < 8`).
    fn permute(self, index: &[i64; WIDTH]) -> Self;
    /// The sum of the lanes, in every lane: of neighbors, of pairs of those, of the halves. The order is the same in each.
    #[inline(always)]
    fn sum_in_every_lane(self) -> Self {
        const TURNS: [[i64; WIDTH]; 3] =
            [[1, 0, 3, 2, 5, 4, 7, 6], [2, 3, 0, 1, 6, 7, 4, 5], [4, 5, 6, 7, 0, 1, 2, 3]];
        let mut sum = self;
        for turn in &TURNS {
            sum += sum.permute(turn);
        }
        sum
    }
    /// Of each of three, in the lanes of the mask the sum of all lanes, in the order of
    /// [`sum_in_every_lane`](Self::sum_in_every_lane); what is given instead in the others.
    #[inline(always)]
    fn sums_in_lanes(mask: Bits, of: [Self; 3], others: [Self; 3]) -> [Self; 3] {
        let mut all = others;
        for c in 0..3 {
            all[c] = Self::select(mask, of[c].sum_in_every_lane(), others[c]);
        }
        all
    }
    /// `x0 y0 z0 x1 y1 z1 …`: eight points, coordinate after coordinate.
    fn interleave(x: Self, y: Self, z: Self) -> [Self; 3];
    /// Writes the lanes of the mask, lane `i` to the `i`-th number from `to` on.
    ///
    /// # Safety
    /// Those numbers may be written; the others are left alone and need not be there.
    unsafe fn write_where(self, mask: Bits, to: *mut f64);
}

/// `Lanes` as numbers, eight to each.
#[inline(always)]
pub fn as_numbers(lanes: &[Lanes]) -> &[f64] {
    // SAFETY: `Lanes` is eight `f64` without padding.
    unsafe { core::slice::from_raw_parts(lanes.as_ptr().cast(), lanes.len() * WIDTH) }
}

/// `Lanes` as mutable numbers, eight to each.
#[inline(always)]
pub fn as_numbers_mut(lanes: &mut [Lanes]) -> &mut [f64] {
    // SAFETY: `Lanes` is eight `f64` without padding.
    unsafe { core::slice::from_raw_parts_mut(lanes.as_mut_ptr().cast(), lanes.len() * WIDTH) }
}

impl Lanes {
    /// The sum of the lanes in the canonical order ((0+4)+(2+6))+((1+5)+(3+7)).
    #[inline(always)]
    pub fn horizontal_sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
    /// Lane by lane.
    #[inline(always)]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self(core::array::from_fn(|lane| function(self.0[lane])))
    }
}

/// The operators and the provided `Real` methods that every tier writes in the same way.
macro_rules! operators {
    ($type:ident: $add:expr, $sub:expr, $mul:expr, $div:expr, $neg:expr) => {
        impl Add for $type {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                $add(self, other)
            }
        }
        impl Sub for $type {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                $sub(self, other)
            }
        }
        impl Mul for $type {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                $mul(self, other)
            }
        }
        impl Div for $type {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                $div(self, other)
            }
        }
        impl Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $neg(self)
            }
        }
        impl AddAssign for $type {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl SubAssign for $type {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
    };
}
/// `coefficient * value` as (high, low), lane by lane, without rounding the coefficient.
#[inline(always)]
pub(super) fn scaled_by<S: Real>(value: S, coefficient: DoubleDouble) -> (S, S) {
    let (high, error) = two_product(S::splat(coefficient.high()), value);
    (high, error + S::splat(coefficient.low()) * value)
}

/// What nobody outside the room can say of a type.
mod sealed {
    pub trait Sealed {}
}

impl sealed::Sealed for Lanes {}

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;
mod words;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;

#[cfg(test)]
mod tests;
