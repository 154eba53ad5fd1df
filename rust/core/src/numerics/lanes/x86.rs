//! The AVX2 and AVX-512 forms of eight lanes.
//!
//! Every method here is `#[inline(always)]` and only ever reached from a function that `tiered!`
//! compiled with the instructions in question; that is the safety argument of the `unsafe` blocks.

use super::{Bits, Lanes, Vector8, WIDTH, scaled_by};
use crate::numerics::binary::{BIASED_SHIFT, Binary, INVERSE_ROOT_LINE, LEADING_BITS};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Eight lanes in one 512-bit register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx512(__m512d);

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

impl Vector8 for Avx512 {
    const ONE_REGISTER: bool = true;

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
}

/// Eight lanes in two 256-bit registers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Avx2(__m256d, __m256d);

operators!(Avx2:
|a: Avx2, b: Avx2| unsafe { Avx2(_mm256_add_pd(a.0, b.0), _mm256_add_pd(a.1, b.1)) },
|a: Avx2, b: Avx2| unsafe { Avx2(_mm256_sub_pd(a.0, b.0), _mm256_sub_pd(a.1, b.1)) },
|a: Avx2, b: Avx2| unsafe { Avx2(_mm256_mul_pd(a.0, b.0), _mm256_mul_pd(a.1, b.1)) },
|a: Avx2, b: Avx2| unsafe { Avx2(_mm256_div_pd(a.0, b.0), _mm256_div_pd(a.1, b.1)) },
|a: Avx2| unsafe {
    let sign = _mm256_set1_pd(-0.0);
    Avx2(_mm256_xor_pd(a.0, sign), _mm256_xor_pd(a.1, sign))
});

impl Avx2 {
    /// All bits of a lane set where its bit in `mask` is.
    #[inline(always)]
    fn spread(mask: Bits) -> (__m256d, __m256d) {
        unsafe {
            let bits = _mm256_set1_epi64x(i64::from(mask.0));
            let low = _mm256_setr_epi64x(1, 2, 4, 8);
            let high = _mm256_setr_epi64x(16, 32, 64, 128);
            (
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, low), low)),
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, high), high)),
            )
        }
    }
    #[inline(always)]
    fn gather(low: __m256d, high: __m256d) -> Bits {
        Bits(unsafe { (_mm256_movemask_pd(low) | _mm256_movemask_pd(high) << 4) as u8 })
    }
}

impl Real for Avx2 {
    type Mask = Bits;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        let half = unsafe { _mm256_set1_pd(value) };
        Self(half, half)
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        Self::splat(value.to_f64())
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        unsafe { Self(_mm256_fmadd_pd(self.0, factor.0, term.0), _mm256_fmadd_pd(self.1, factor.1, term.1)) }
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        unsafe {
            Self(_mm256_fnmadd_pd(self.0, factor.0, term.0), _mm256_fnmadd_pd(self.1, factor.1, term.1))
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_andnot_pd(sign, self.0), _mm256_andnot_pd(sign, self.1))
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        unsafe { Self(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        unsafe { Self(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        unsafe {
            Self::gather(
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        unsafe {
            Self::gather(
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        let (low, high) = Self::spread(mask);
        unsafe {
            Self(_mm256_blendv_pd(if_false.0, if_true.0, low), _mm256_blendv_pd(if_false.1, if_true.1, high))
        }
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
}

impl Vector8 for Avx2 {
    const ONE_REGISTER: bool = false;

    #[inline(always)]
    fn load(lanes: Lanes) -> Self {
        unsafe { Self(_mm256_load_pd(lanes.0.as_ptr()), _mm256_load_pd(lanes.0.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes([0.0; WIDTH]);
        unsafe {
            _mm256_store_pd(lanes.0.as_mut_ptr(), self.0);
            _mm256_store_pd(lanes.0.as_mut_ptr().add(4), self.1);
        }
        lanes
    }
    #[inline(always)]
    fn permute(self, index: &[i64; WIDTH]) -> Self {
        Self::load(self.store().permute(index))
    }
}

impl Binary for Avx2 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        let shifted = self + Self::splat(BIASED_SHIFT);
        let shift = |half| unsafe { _mm256_castsi256_pd(_mm256_slli_epi64::<52>(_mm256_castpd_si256(half))) };
        Self(shift(shifted.0), shift(shifted.1))
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        unsafe {
            let line = _mm256_set1_epi64x(INVERSE_ROOT_LINE);
            let (low, high) = (_mm256_castpd_si256(self.0), _mm256_castpd_si256(self.1));
            Self(
                _mm256_castsi256_pd(_mm256_sub_epi64(line, _mm256_srli_epi64::<1>(low))),
                _mm256_castsi256_pd(_mm256_sub_epi64(line, _mm256_srli_epi64::<1>(high))),
            )
        }
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        unsafe {
            let mask = _mm256_castsi256_pd(_mm256_set1_epi64x(LEADING_BITS));
            Self(_mm256_and_pd(self.0, mask), _mm256_and_pd(self.1, mask))
        }
    }
}
