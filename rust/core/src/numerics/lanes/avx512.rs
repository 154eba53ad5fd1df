//! The AVX-512 form of eight lanes.
//!
//! Every method here is `#[inline(always)]` and only ever reached from a function that `tiered!`
//! compiled with the instructions in question; that is the safety argument of the `unsafe` blocks.

use super::{Bits, Lanes, Vector8, WIDTH, scaled_by};
use crate::numerics::binary::{
    BIASED_SHIFT, Binary, COUNTING, EXPONENT_OF_ONE, INVERSE_ROOT_LINE, LEADING_BITS, SIGNIFICAND_BITS,
};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Eight lanes in one 512-bit register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Avx512(__m512d);

// SAFETY (all blocks of this file): see the module header.
operators!(Avx512:
    |a: Avx512, b: Avx512| Avx512(unsafe { _mm512_add_pd(a.0, b.0) }),
    |a: Avx512, b: Avx512| Avx512(unsafe { _mm512_sub_pd(a.0, b.0) }),
    |a: Avx512, b: Avx512| Avx512(unsafe { _mm512_mul_pd(a.0, b.0) }),
    |a: Avx512, b: Avx512| Avx512(unsafe { _mm512_div_pd(a.0, b.0) }),
    |a: Avx512| Avx512(unsafe { _mm512_xor_pd(a.0, _mm512_set1_pd(-0.0)) }));

impl Real for Avx512 {
    type Mask = Bits;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        Self::splat(value.to_f64())
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        Self(unsafe { _mm512_fmadd_pd(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        Self(unsafe { _mm512_fnmadd_pd(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_andnot_pd(_mm512_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        Bits(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        Bits(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask.0, if_false.0, if_true.0) })
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
}

impl super::sealed::Sealed for Avx512 {}

impl Vector8 for Avx512 {
    const REGISTERS: usize = 32;
    type Words = super::words::Avx512Words;
    #[inline(always)]
    fn load(lanes: Lanes) -> Self {
        Self(unsafe { _mm512_load_pd(lanes.0.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes([0.0; WIDTH]);
        unsafe { _mm512_store_pd(lanes.0.as_mut_ptr(), self.0) };
        lanes
    }
    #[inline(always)]
    fn permute(self, index: &[i64; WIDTH]) -> Self {
        Self(unsafe { _mm512_permutexvar_pd(_mm512_loadu_si512(index.as_ptr().cast()), self.0) })
    }
    /// Of x and y side by side.
    #[inline(always)]
    fn sums_in_lanes(mask: Bits, [x, y, z]: [Self; 3], others: [Self; 3]) -> [Self; 3] {
        unsafe {
            let xy = _mm512_add_pd(_mm512_unpacklo_pd(x.0, y.0), _mm512_unpackhi_pd(x.0, y.0));
            let xy = _mm512_add_pd(xy, _mm512_permutex_pd::<0b01_00_11_10>(xy));
            let xy = _mm512_add_pd(xy, _mm512_shuffle_f64x2::<0b01_00_11_10>(xy, xy));
            let [x, y, others_z] = others;
            [
                Self(_mm512_mask_movedup_pd(x.0, mask.0, xy)),
                Self(_mm512_mask_permute_pd::<0b1111_1111>(y.0, mask.0, xy)),
                Self::select(mask, z.sum_in_every_lane(), others_z),
            ]
        }
    }
    #[inline(always)]
    fn interleave(x: Self, y: Self, z: Self) -> [Self; 3] {
        // First x and y, numbered 0–7 and 8–15; then z joins in the places of the mask.
        unsafe {
            let xy0 = _mm512_permutex2var_pd(x.0, _mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10), y.0);
            let xy1 = _mm512_permutex2var_pd(x.0, _mm512_setr_epi64(0, 3, 11, 0, 4, 12, 0, 5), y.0);
            let xy2 = _mm512_permutex2var_pd(x.0, _mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0), y.0);
            let z0 = _mm512_setr_epi64(0, 0, 0, 0, 0, 1, 0, 0);
            let z1 = _mm512_setr_epi64(2, 0, 0, 3, 0, 0, 4, 0);
            let z2 = _mm512_setr_epi64(0, 5, 0, 0, 6, 0, 0, 7);
            [
                Self(_mm512_mask_permutexvar_pd(xy0, 0b0010_0100, z0, z.0)),
                Self(_mm512_mask_permutexvar_pd(xy1, 0b0100_1001, z1, z.0)),
                Self(_mm512_mask_permutexvar_pd(xy2, 0b1001_0010, z2, z.0)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn write_where(self, mask: Bits, to: *mut f64) {
        unsafe { _mm512_mask_storeu_pd(to, mask.0, self.0) };
    }
}

impl Binary for Avx512 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        let shifted = self + Self::splat(BIASED_SHIFT);
        Self(unsafe { _mm512_castsi512_pd(_mm512_slli_epi64::<52>(_mm512_castpd_si512(shifted.0))) })
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        unsafe {
            let half = _mm512_srli_epi64::<1>(_mm512_castpd_si512(self.0));
            Self(_mm512_castsi512_pd(_mm512_sub_epi64(_mm512_set1_epi64(INVERSE_ROOT_LINE), half)))
        }
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        Self(unsafe { _mm512_and_pd(self.0, _mm512_castsi512_pd(_mm512_set1_epi64(LEADING_BITS))) })
    }
    #[inline(always)]
    fn exponent_part(self) -> Self {
        Self(unsafe { _mm512_and_pd(self.0, _mm512_set1_pd(f64::INFINITY)) })
    }
    #[inline(always)]
    fn significand(self) -> Self {
        unsafe {
            let bits = _mm512_and_si512(_mm512_castpd_si512(self.0), _mm512_set1_epi64(SIGNIFICAND_BITS));
            Self(_mm512_castsi512_pd(_mm512_or_si512(bits, _mm512_set1_epi64(EXPONENT_OF_ONE))))
        }
    }
    #[inline(always)]
    fn binary_exponent(self) -> Self {
        unsafe {
            let bits = _mm512_srli_epi64::<52>(_mm512_castpd_si512(self.0));
            let counted = _mm512_or_si512(bits, _mm512_set1_epi64(COUNTING));
            Self(_mm512_castsi512_pd(counted)) - Self::splat(BIASED_SHIFT)
        }
    }
}
