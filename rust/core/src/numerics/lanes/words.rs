//! Eight 64-bit words side by side: the integers of the cipher that makes random numbers.
//!
//! The one idea: a product takes the low half of each word and gives a whole one, which is one instruction of a vector
//! register. Left to find that, the compiler shuffled words to and fro instead, six times as long on AVX2.
//!
//! Every method here is `#[inline(always)]` and only ever reached from a function that `tiered!`
//! compiled with the instructions in question; that is the safety argument of the `unsafe` blocks.

use super::WIDTH;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::ops::BitXor;

/// A tier's eight words.
pub trait Words: Copy + BitXor<Output = Self> {
    /// From memory.
    fn load(words: [u64; WIDTH]) -> Self;
    /// The product of the low halves and a number of 32 bits.
    fn product(self, factor: u32) -> Self;
    /// Every bit so many places lower.
    fn shifted_down<const PLACES: u32>(self) -> Self;
    /// The low half, below the low half of another.
    fn below(self, high: Self) -> Self;
    /// Words of this and another in turn.
    fn interleave(self, other: Self, to: &mut [u64; 2 * WIDTH]);
    /// The same in every lane.
    #[inline(always)]
    fn splat(word: u64) -> Self {
        Self::load([word; WIDTH])
    }
}

/// What only the low half of a word is.
const LOW: u64 = u32::MAX as u64;

/// As they lie in memory.
#[derive(Clone, Copy, Debug)]
pub struct Portable([u64; WIDTH]);

impl BitXor for Portable {
    type Output = Self;
    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        Self(core::array::from_fn(|lane| self.0[lane] ^ other.0[lane]))
    }
}

impl Words for Portable {
    #[inline(always)]
    fn load(words: [u64; WIDTH]) -> Self {
        Self(words)
    }
    #[inline(always)]
    fn product(self, factor: u32) -> Self {
        Self(self.0.map(|word| (word & LOW) * u64::from(factor)))
    }
    #[inline(always)]
    fn shifted_down<const PLACES: u32>(self) -> Self {
        Self(self.0.map(|word| word >> PLACES))
    }
    #[inline(always)]
    fn below(self, high: Self) -> Self {
        Self(core::array::from_fn(|lane| high.0[lane] << 32 | self.0[lane] & LOW))
    }
    #[inline(always)]
    fn interleave(self, other: Self, to: &mut [u64; 2 * WIDTH]) {
        for (lane, pair) in to.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            *pair = [self.0[lane], other.0[lane]];
        }
    }
}

/// In two registers of four.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Words(__m256i, __m256i);

#[cfg(target_arch = "x86_64")]
impl Avx2Words {
    #[inline(always)]
    fn each(self, function: impl Fn(__m256i) -> __m256i) -> Self {
        Self(function(self.0), function(self.1))
    }
}

#[cfg(target_arch = "x86_64")]
impl BitXor for Avx2Words {
    type Output = Self;
    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        unsafe { Self(_mm256_xor_si256(self.0, other.0), _mm256_xor_si256(self.1, other.1)) }
    }
}

#[cfg(target_arch = "x86_64")]
impl Words for Avx2Words {
    #[inline(always)]
    fn load(words: [u64; WIDTH]) -> Self {
        let from = words.as_ptr().cast::<__m256i>();
        unsafe { Self(_mm256_loadu_si256(from), _mm256_loadu_si256(from.add(1))) }
    }
    #[inline(always)]
    fn product(self, factor: u32) -> Self {
        self.each(|words| unsafe { _mm256_mul_epu32(words, _mm256_set1_epi64x(i64::from(factor))) })
    }
    #[inline(always)]
    fn shifted_down<const PLACES: u32>(self) -> Self {
        self.each(|words| unsafe { _mm256_srlv_epi64(words, _mm256_set1_epi64x(i64::from(PLACES))) })
    }
    #[inline(always)]
    fn below(self, high: Self) -> Self {
        let one =
            |low, high| unsafe { _mm256_blend_epi32::<0b1010_1010>(low, _mm256_slli_epi64::<32>(high)) };
        Self(one(self.0, high.0), one(self.1, high.1))
    }
    #[inline(always)]
    fn interleave(self, other: Self, to: &mut [u64; 2 * WIDTH]) {
        let to = to.as_mut_ptr().cast::<__m256i>();
        for (half, (a, b)) in [(self.0, other.0), (self.1, other.1)].into_iter().enumerate() {
            unsafe {
                let (even, odd) = (_mm256_unpacklo_epi64(a, b), _mm256_unpackhi_epi64(a, b));
                _mm256_storeu_si256(to.add(2 * half), _mm256_permute2x128_si256::<0x20>(even, odd));
                _mm256_storeu_si256(to.add(2 * half + 1), _mm256_permute2x128_si256::<0x31>(even, odd));
            }
        }
    }
}

/// In one register.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Words(__m512i);

#[cfg(target_arch = "x86_64")]
impl BitXor for Avx512Words {
    type Output = Self;
    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        Self(unsafe { _mm512_xor_si512(self.0, other.0) })
    }
}

#[cfg(target_arch = "x86_64")]
impl Words for Avx512Words {
    #[inline(always)]
    fn load(words: [u64; WIDTH]) -> Self {
        Self(unsafe { _mm512_loadu_si512(words.as_ptr().cast()) })
    }
    #[inline(always)]
    fn product(self, factor: u32) -> Self {
        Self(unsafe { _mm512_mul_epu32(self.0, _mm512_set1_epi64(i64::from(factor))) })
    }
    #[inline(always)]
    fn shifted_down<const PLACES: u32>(self) -> Self {
        Self(unsafe { _mm512_srlv_epi64(self.0, _mm512_set1_epi64(i64::from(PLACES))) })
    }
    #[inline(always)]
    fn below(self, high: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_epi32(0xaaaa, self.0, _mm512_slli_epi64::<32>(high.0)) })
    }
    #[inline(always)]
    fn interleave(self, other: Self, to: &mut [u64; 2 * WIDTH]) {
        let to = to.as_mut_ptr();
        unsafe {
            let first = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
            let last = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
            _mm512_storeu_si512(to.cast(), _mm512_permutex2var_epi64(self.0, first, other.0));
            _mm512_storeu_si512(to.add(WIDTH).cast(), _mm512_permutex2var_epi64(self.0, last, other.0));
        }
    }
}
