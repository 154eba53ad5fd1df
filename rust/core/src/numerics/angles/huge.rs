//! What is left of a huge angle after its quarter turns: Payne & Hanek's reduction.
//!
//! The one idea: of x · 2/π only what is not a multiple of 4 counts, so of 2/π only a window of 256 bits, which is multiplied
//! with the 53 bits of x as whole numbers. M. H. Payne & R. N. Hanek, SIGNUM Newsletter 18 (1983) 19.

use crate::numerics::double_double::DoubleDouble;

/// 2/π, 64 bits each, after one word of zeros: bits before the point.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
];
const HALF_PI: DoubleDouble = DoubleDouble::new(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
const FRACTION: u64 = (1 << 52) - 1;

/// The quarter turns of an angle, modulo 4, and what is left of it, of finite x from 2^50 on.
pub(super) fn reduced(x: f64) -> (u8, DoubleDouble) {
    // x = m · 2^e
    let bits = x.to_bits();
    let e = ((bits >> 52) & 0x7ff) as i64 - 1075;
    let m = u128::from(bits & FRACTION | 1 << 52);
    // The window begins with the weight 2^(1 − e): what weighs more makes multiples of 4.
    let first = (e - 2 + 64) as usize;
    let (word, shift) = (first / 64, first % 64);
    let at = |index: usize| TWO_OVER_PI.get(index).copied().unwrap_or(0);
    let window: [u64; 4] = core::array::from_fn(|k| {
        let (high, low) = (at(word + k), at(word + k + 1));
        if shift == 0 { high } else { high << shift | low >> (64 - shift) }
    });
    let mut product = [0_u64; 4];
    let mut carry = 0_u128;
    for k in (0..4).rev() {
        let sum = u128::from(window[k]) * m + carry;
        product[k] = sum as u64;
        carry = sum >> 64;
    }
    // Two bits of quarters, then the fraction.
    let mut quarters = (product[0] >> 62) as u8;
    let mut fraction: [u64; 4] =
        core::array::from_fn(|k| product[k] << 2 | product.get(k + 1).map_or(0, |next| next >> 62));
    let beyond = fraction[0] >> 63 == 1;
    if beyond {
        quarters = (quarters + 1) % 4;
        // Less than a whole one, by the complement.
        fraction = fraction.map(|word| !word);
    }
    let mut sum = DoubleDouble::default();
    for (k, word) in fraction.into_iter().enumerate().rev() {
        for (half, place) in [(word & 0xffff_ffff, 2), (word >> 32, 1)] {
            let weight = -32.0 * (2 * k + place) as f64;
            sum += DoubleDouble::from(half as f64 * weight.exp2());
        }
    }
    let left = sum * HALF_PI;
    (quarters, if beyond { -left } else { left })
}
