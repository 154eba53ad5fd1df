//! The arithmetic of [`Lanes`] themselves, with what every processor of the target has.
//!
//! The one idea: where the build has no fused multiply-add, each is a call into the C library and nothing here is fast, so
//! every operation is a function of its own. Written into each place of every kernel they were half of all machine code, and
//! of the time that a build takes. Elsewhere (aarch64, builds for one processor) they are inlined, and this is a tier like
//! the others.

use super::{Bits, Lanes, Vector8, WIDTH, scaled_by};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

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

macro_rules! operations {
    ($(fn $name:ident($($argument:ident: $type:ty),*) -> $result:ty { $body:expr })+) => {$(
        #[cfg_attr(all(target_arch = "x86_64", not(target_feature = "fma")), inline(never))]
        #[cfg_attr(not(all(target_arch = "x86_64", not(target_feature = "fma"))), inline(always))]
        fn $name($($argument: $type),*) -> $result {
            $body
        }
    )+};
}

operations! {
    fn sum(a: &Lanes, b: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane] + b.0[lane])) }
    fn difference(a: &Lanes, b: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane] - b.0[lane])) }
    fn product(a: &Lanes, b: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane] * b.0[lane])) }
    fn quotient(a: &Lanes, b: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane] / b.0[lane])) }
    fn negative(a: &Lanes) -> Lanes { Lanes(each_lane!(|lane| -a.0[lane])) }
    fn fused(a: &Lanes, b: &Lanes, c: &Lanes) -> Lanes {
        Lanes(each_lane!(|lane| a.0[lane].mul_add(b.0[lane], c.0[lane])))
    }
    fn fused_difference(a: &Lanes, b: &Lanes, c: &Lanes) -> Lanes {
        Lanes(each_lane!(|lane| (-a.0[lane]).mul_add(b.0[lane], c.0[lane])))
    }
    fn root(a: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane].sqrt())) }
    fn magnitude(a: &Lanes) -> Lanes { Lanes(each_lane!(|lane| a.0[lane].abs())) }
    fn larger(a: &Lanes, b: &Lanes) -> Lanes {
        Lanes(each_lane!(|lane| if a.0[lane] > b.0[lane] { a.0[lane] } else { b.0[lane] }))
    }
    fn smaller(a: &Lanes, b: &Lanes) -> Lanes {
        Lanes(each_lane!(|lane| if a.0[lane] < b.0[lane] { a.0[lane] } else { b.0[lane] }))
    }
    fn less(a: &Lanes, b: &Lanes) -> Bits { bits(each_lane!(|lane| a.0[lane] < b.0[lane])) }
    fn less_equal(a: &Lanes, b: &Lanes) -> Bits { bits(each_lane!(|lane| a.0[lane] <= b.0[lane])) }
    fn select(mask: Bits, a: &Lanes, b: &Lanes) -> Lanes {
        Lanes(each_lane!(|lane| if mask.lane(lane) { a.0[lane] } else { b.0[lane] }))
    }
}

#[inline(always)]
fn bits(lanes: [bool; WIDTH]) -> Bits {
    let [a, b, c, d, e, f, g, h] = each_lane!(|lane| u8::from(lanes[lane]) << lane);
    Bits(((a | b) | (c | d)) | ((e | f) | (g | h)))
}

operators!(
    Lanes: |a, b| sum(&a, &b), |a, b| difference(&a, &b), |a, b| product(&a, &b), |a, b| quotient(&a, &b), |a| negative(&a)
);

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
        fused(&self, &factor, &term)
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        fused_difference(&self, &factor, &term)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        root(&self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        magnitude(&self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        larger(&self, &other)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        smaller(&self, &other)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        less(&self, &other)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        less_equal(&self, &other)
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        select(mask, &if_true, &if_false)
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
    #[inline(always)]
    fn unevaluated(coefficient: DoubleDouble) -> (Self, Self) {
        (Self::splat(coefficient.high()), Self::splat(coefficient.low()))
    }
}

impl Vector8 for Lanes {
    const REGISTERS: usize = 4;
    const APART: bool = cfg!(all(target_arch = "x86_64", not(target_feature = "fma")));
    type Words = super::words::Portable;
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
        // Of other tiers, too.
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
