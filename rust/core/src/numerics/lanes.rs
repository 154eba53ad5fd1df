//! Eight `f64` side by side: the logical width of every kernel on every tier.
//!
//! [`Lanes`] is how lanes lie in memory and the portable arithmetic on them; `Avx2` and `Avx512`
//! have the same layout and the same results, so a slice of one can be viewed as a slice of another.
//! Those two stay within the crate: their instructions may run only where `tiered!` has seen that there are any.

use super::double_double::{DoubleDouble, two_product};
use super::real::{Mask, Real};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The logical width of every kernel.
pub const WIDTH: usize = 8;

/// Eight numbers, 64-byte aligned.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// Eight lanes, each of an expression of its index. Written out: a loop over them in every operation of every kernel would be
/// unrolled by the compiler, which takes it a good part of its time.
macro_rules! each_lane {
    (|$lane:ident| $value:expr) => {
        [
            each_lane!($lane = 0, $value),
            each_lane!($lane = 1, $value),
            each_lane!($lane = 2, $value),
            each_lane!($lane = 3, $value),
            each_lane!($lane = 4, $value),
            each_lane!($lane = 5, $value),
            each_lane!($lane = 6, $value),
            each_lane!($lane = 7, $value),
        ]
    };
    ($lane:ident = $index:literal, $value:expr) => {{
        let $lane = $index;
        $value
    }};
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
        Self(each_lane!(|lane| function(self.0[lane])))
    }
    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self(each_lane!(|lane| function(self.0[lane], other.0[lane])))
    }
    #[inline(always)]
    fn compare(self, other: Self, function: impl Fn(f64, f64) -> bool) -> Bits {
        let [a, b, c, d, e, f, g, h] =
            each_lane!(|lane| u8::from(function(self.0[lane], other.0[lane])) << lane);
        Bits(((a | b) | (c | d)) | ((e | f) | (g | h)))
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
operators!(Lanes:
    |a: Lanes, b: Lanes| a.zip(b, |x, y| x + y),
    |a: Lanes, b: Lanes| a.zip(b, |x, y| x - y),
    |a: Lanes, b: Lanes| a.zip(b, |x, y| x * y),
    |a: Lanes, b: Lanes| a.zip(b, |x, y| x / y),
    |a: Lanes| a.map(|x| -x));

/// `coefficient * value` as (high, low), lane by lane, without rounding the coefficient.
#[inline(always)]
pub(super) fn scaled_by<S: Real>(value: S, coefficient: DoubleDouble) -> (S, S) {
    let (high, error) = two_product(S::splat(coefficient.high()), value);
    (high, error + S::splat(coefficient.low()) * value)
}

/// `a * b + c`, rounded once. Where the build has no instruction for it, every lane is a call into the C library, and a
/// function of its own keeps eight of those out of every place in every kernel: half of all machine code.
#[cfg_attr(all(target_arch = "x86_64", not(target_feature = "fma")), inline(never))]
#[cfg_attr(not(all(target_arch = "x86_64", not(target_feature = "fma"))), inline(always))]
fn fused(a: Lanes, b: Lanes, c: Lanes) -> Lanes {
    Lanes(each_lane!(|lane| a.0[lane].mul_add(b.0[lane], c.0[lane])))
}

impl Real for Lanes {
    type Mask = Bits;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        Self::splat(value.to_f64())
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        fused(self, factor, term)
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        fused(-self, factor, term)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |x, y| if x < y { x } else { y })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        self.compare(other, |x, y| x < y)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        self.compare(other, |x, y| x <= y)
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        Self(each_lane!(|lane| if mask.lane(lane) { if_true.0[lane] } else { if_false.0[lane] }))
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
}

/// What nobody outside the room can say of a type.
mod sealed {
    pub trait Sealed {}
}

impl sealed::Sealed for Lanes {}

impl Vector8 for Lanes {
    const REGISTERS: usize = 4;
    #[inline(always)]
    fn load(lanes: Lanes) -> Self {
        lanes
    }
    #[inline(always)]
    fn store(self) -> Lanes {
        self
    }
    #[inline(always)]
    fn permute(self, index: &[i64; WIDTH]) -> Self {
        Self(each_lane!(|lane| self.0[(index[lane] & 7) as usize]))
    }
    #[inline(always)]
    fn interleave(x: Self, y: Self, z: Self) -> [Self; 3] {
        let points: [[f64; 3]; WIDTH] = core::array::from_fn(|lane| [x.0[lane], y.0[lane], z.0[lane]]);
        let numbers = points.as_flattened();
        core::array::from_fn(|third| Self(core::array::from_fn(|lane| numbers[WIDTH * third + lane])))
    }
    #[inline(always)]
    unsafe fn write_where(self, mask: Bits, to: *mut f64) {
        for lane in (0..WIDTH).filter(|&lane| mask.lane(lane)) {
            // SAFETY: the caller's promise.
            unsafe { to.wrapping_add(lane).write(self.0[lane]) };
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;

#[cfg(test)]
mod tests;
