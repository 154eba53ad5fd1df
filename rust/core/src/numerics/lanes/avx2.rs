//! The AVX2 form of eight lanes: two halves of four.
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

/// Four lanes in one 256-bit register; masks use the four low bits.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
struct Avx2Half(__m256d);

// SAFETY (all blocks of this file): see the module header.
operators!(Avx2Half:
    |a: Avx2Half, b: Avx2Half| Avx2Half(unsafe { _mm256_add_pd(a.0, b.0) }),
    |a: Avx2Half, b: Avx2Half| Avx2Half(unsafe { _mm256_sub_pd(a.0, b.0) }),
    |a: Avx2Half, b: Avx2Half| Avx2Half(unsafe { _mm256_mul_pd(a.0, b.0) }),
    |a: Avx2Half, b: Avx2Half| Avx2Half(unsafe { _mm256_div_pd(a.0, b.0) }),
    |a: Avx2Half| Avx2Half(unsafe { _mm256_xor_pd(a.0, _mm256_set1_pd(-0.0)) }));

/// All bits of a lane for its bit in the mask.
#[inline(always)]
fn spread(mask: Bits) -> __m256i {
    unsafe {
        let lane = _mm256_setr_epi64x(1, 2, 4, 8);
        _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(i64::from(mask.0)), lane), lane)
    }
}

impl Real for Avx2Half {
    type Mask = Bits;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        Self::splat(value.to_f64())
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        Self(unsafe { _mm256_fmadd_pd(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        Self(unsafe { _mm256_fnmadd_pd(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm256_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm256_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        Bits(unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)) } as u8)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        Bits(unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)) } as u8)
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        Self(unsafe { _mm256_blendv_pd(if_false.0, if_true.0, _mm256_castsi256_pd(spread(mask))) })
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
}

impl Binary for Avx2Half {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        let shifted = self + Self::splat(BIASED_SHIFT);
        Self(unsafe { _mm256_castsi256_pd(_mm256_slli_epi64::<52>(_mm256_castpd_si256(shifted.0))) })
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        unsafe {
            let half = _mm256_srli_epi64::<1>(_mm256_castpd_si256(self.0));
            Self(_mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(INVERSE_ROOT_LINE), half)))
        }
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        Self(unsafe { _mm256_and_pd(self.0, _mm256_castsi256_pd(_mm256_set1_epi64x(LEADING_BITS))) })
    }
    #[inline(always)]
    fn exponent_part(self) -> Self {
        Self(unsafe { _mm256_and_pd(self.0, _mm256_set1_pd(f64::INFINITY)) })
    }
    #[inline(always)]
    fn significand(self) -> Self {
        unsafe {
            let bits = _mm256_and_si256(_mm256_castpd_si256(self.0), _mm256_set1_epi64x(SIGNIFICAND_BITS));
            Self(_mm256_castsi256_pd(_mm256_or_si256(bits, _mm256_set1_epi64x(EXPONENT_OF_ONE))))
        }
    }
    #[inline(always)]
    fn binary_exponent(self) -> Self {
        unsafe {
            let bits = _mm256_srli_epi64::<52>(_mm256_castpd_si256(self.0));
            let counted = _mm256_or_si256(bits, _mm256_set1_epi64x(COUNTING));
            Self(_mm256_castsi256_pd(counted)) - Self::splat(BIASED_SHIFT)
        }
    }
}

/// Eight lanes in two 256-bit registers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Avx2(Avx2Half, Avx2Half);

operators!(Avx2:
    |a: Avx2, b: Avx2| Avx2(a.0 + b.0, a.1 + b.1),
    |a: Avx2, b: Avx2| Avx2(a.0 - b.0, a.1 - b.1),
    |a: Avx2, b: Avx2| Avx2(a.0 * b.0, a.1 * b.1),
    |a: Avx2, b: Avx2| Avx2(a.0 / b.0, a.1 / b.1),
    |a: Avx2| Avx2(-a.0, -a.1));

/// The mask of both halves.
#[inline(always)]
fn join(low: Bits, high: Bits) -> Bits {
    Bits(low.0 | high.0 << 4)
}

impl Real for Avx2 {
    type Mask = Bits;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(Avx2Half::splat(value), Avx2Half::splat(value))
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        Self::splat(value.to_f64())
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.multiply_add(factor.0, term.0), self.1.multiply_add(factor.1, term.1))
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        Self(self.0.multiply_subtract_from(factor.0, term.0), self.1.multiply_subtract_from(factor.1, term.1))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        join(self.0.less(other.0), self.1.less(other.1))
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Bits {
        join(self.0.less_equal(other.0), self.1.less_equal(other.1))
    }
    #[inline(always)]
    fn select(mask: Bits, if_true: Self, if_false: Self) -> Self {
        Self(
            Avx2Half::select(mask, if_true.0, if_false.0),
            Avx2Half::select(Bits(mask.0 >> 4), if_true.1, if_false.1),
        )
    }
    #[inline(always)]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        scaled_by(self, coefficient)
    }
}

impl super::sealed::Sealed for Avx2 {}

impl Vector8 for Avx2 {
    const REGISTERS: usize = 8;
    type Words = super::words::Avx2Words;
    #[inline(always)]
    fn load(lanes: Lanes) -> Self {
        let from = lanes.0.as_ptr();
        unsafe { Self(Avx2Half(_mm256_load_pd(from)), Avx2Half(_mm256_load_pd(from.add(4)))) }
    }
    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes([0.0; WIDTH]);
        unsafe {
            _mm256_store_pd(lanes.0.as_mut_ptr(), self.0.0);
            _mm256_store_pd(lanes.0.as_mut_ptr().add(4), self.1.0);
        }
        lanes
    }
    #[inline(always)]
    fn permute(self, index: &[i64; WIDTH]) -> Self {
        let (low, high) = index.split_at(WIDTH / 2);
        Self(chosen(self, low), chosen(self, high))
    }
    #[inline(always)]
    fn sum_in_every_lane(self) -> Self {
        let (low, high) = (sum_of_half(self.0), sum_of_half(self.1));
        Self(low + high, low + high)
    }
    #[inline(always)]
    fn interleave(x: Self, y: Self, z: Self) -> [Self; 3] {
        let [a, b, c] = interleave_half(x.0, y.0, z.0);
        let [d, e, f] = interleave_half(x.1, y.1, z.1);
        [Self(a, b), Self(c, d), Self(e, f)]
    }
    #[inline(always)]
    unsafe fn write_where(self, mask: Bits, to: *mut f64) {
        unsafe {
            write_half_where(self.0, mask, to);
            write_half_where(self.1, Bits(mask.0 >> 4), to.wrapping_add(WIDTH / 2));
        }
    }
}

/// Four lanes of the eight: of each half those that the last two bits say, and of these the half that the third says.
/// Through memory it would be eight loads that wait for a store.
#[inline(always)]
fn chosen(from: Avx2, index: &[i64]) -> Avx2Half {
    debug_assert!(index.len() == WIDTH / 2);
    unsafe {
        let index = _mm256_loadu_si256(index.as_ptr().cast());
        // Lane i is the pair of 32-bit words 2i and 2i + 1.
        let pair = _mm256_shuffle_epi32::<0b10_10_00_00>(_mm256_slli_epi64::<1>(index));
        let words = _mm256_add_epi32(pair, _mm256_setr_epi32(0, 1, 0, 1, 0, 1, 0, 1));
        let of = |half: Avx2Half| _mm256_permutevar8x32_ps(_mm256_castpd_ps(half.0), words);
        let in_high = _mm256_castsi256_pd(_mm256_slli_epi64::<61>(index));
        let (low, high) = (_mm256_castps_pd(of(from.0)), _mm256_castps_pd(of(from.1)));
        Avx2Half(_mm256_blendv_pd(low, high, in_high))
    }
}

/// As [`Vector8::sum_in_every_lane`], of a half: it is moved about in registers.
#[inline(always)]
fn sum_of_half(half: Avx2Half) -> Avx2Half {
    let pairs = half + Avx2Half(unsafe { _mm256_permute_pd::<0b0101>(half.0) });
    pairs + Avx2Half(unsafe { _mm256_permute2f128_pd::<1>(pairs.0, pairs.0) })
}

/// As [`Vector8::write_where`], of a half.
#[inline(always)]
unsafe fn write_half_where(half: Avx2Half, mask: Bits, to: *mut f64) {
    unsafe {
        // Most are whole, and some processors are slow at the other instruction.
        match mask.0 & 0xf {
            0xf => _mm256_storeu_pd(to, half.0),
            0 => {}
            _ => _mm256_maskstore_pd(to, spread(mask), half.0),
        }
    }
}

/// Four points, coordinate after coordinate.
#[inline(always)]
fn interleave_half(x: Avx2Half, y: Avx2Half, z: Avx2Half) -> [Avx2Half; 3] {
    unsafe {
        let xy = _mm256_unpacklo_pd(x.0, y.0); // x0 y0 x2 y2
        let yz = _mm256_unpackhi_pd(y.0, z.0); // y1 z1 y3 z3
        let zx = _mm256_shuffle_pd::<0b1010>(z.0, x.0); // z0 x1 z2 x3
        [
            Avx2Half(_mm256_permute2f128_pd::<0x20>(xy, zx)),
            Avx2Half(_mm256_blend_pd::<0b1100>(yz, xy)),
            Avx2Half(_mm256_permute2f128_pd::<0x31>(zx, yz)),
        ]
    }
}

impl Binary for Avx2 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self(self.0.power_of_two(), self.1.power_of_two())
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        Self(self.0.inverse_root_guess(), self.1.inverse_root_guess())
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        Self(self.0.leading_bits(), self.1.leading_bits())
    }
    #[inline(always)]
    fn exponent_part(self) -> Self {
        Self(self.0.exponent_part(), self.1.exponent_part())
    }
    #[inline(always)]
    fn significand(self) -> Self {
        Self(self.0.significand(), self.1.significand())
    }
    #[inline(always)]
    fn binary_exponent(self) -> Self {
        Self(self.0.binary_exponent(), self.1.binary_exponent())
    }
}
