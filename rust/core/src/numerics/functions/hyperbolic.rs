//! Hyperbolic functions. Measured: 0.8 units in the last place.

use super::{Functions, fast_sum, fused};
use crate::numerics::double_double::two_sum;
use crate::numerics::elementary::{EXPONENTIAL, nearest_integer};

const LN2_HIGH: f64 = 0.693_147_180_559_890_3;
const LN2_LOW: f64 = 5.497_923_018_708_371e-14;
/// Below this series are taken.
const SMALL: f64 = 0.5;
/// Beyond this all are infinite, or 1.
const FAR: f64 = 711.0;

/// 1/(2k + 3)!.
const SINH: [f64; 7] = [
    1.0 / 6.0,
    1.0 / 120.0,
    1.0 / 5_040.0,
    1.0 / 362_880.0,
    1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    1.0 / 1_307_674_368_000.0,
];
/// The series of tanh after x.
const TANH: [f64; 21] = [
    -0.333_333_333_333_333_3,
    0.133_333_333_333_333_33,
    -0.053_968_253_968_253_97,
    0.021_869_488_536_155_203,
    -0.008_863_235_529_902_197,
    0.003_592_128_036_572_481,
    -0.001_455_834_387_051_318_3,
    0.000_590_027_440_945_586,
    -0.000_239_129_114_243_552_48,
    9.691_537_956_929_451e-5,
    -3.927_832_388_331_683e-5,
    1.591_890_506_932_896_4e-5,
    -6.451_689_215_655_431e-6,
    2.614_771_151_290_754_6e-6,
    -1.059_726_832_010_465_4e-6,
    4.294_911_078_273_806e-7,
    -1.740_661_896_357_164_8e-7,
    7.054_636_946_400_968e-8,
    -2.859_136_662_305_254e-8,
    1.158_764_443_279_885_3e-8,
    -4.696_295_398_230_901_6e-9,
];

/// eˣ·2^−n in two parts, and n, of |x| ≤ 1423.
#[inline(always)]
fn exponential<S: Functions>(x: S) -> (S, S, S) {
    let n = nearest_integer(x * S::splat(core::f64::consts::LOG2_E));
    let high = x - n * S::splat(LN2_HIGH);
    let low = n * S::splat(LN2_LOW);
    let r = high - low;
    let rest = (high - r) - low;
    let series = (r * r).multiply_add(fused(r, &EXPONENTIAL), rest.multiply_add(r, rest));
    let (one, low) = two_sum(S::one(), r);
    let (value, low) = fast_sum(one, low + series);
    (value, low, n)
}

/// A number times 2ⁿ, in two steps.
#[inline(always)]
fn scaled<S: Functions>(value: S, n: S) -> S {
    let half = nearest_integer(n * S::splat(0.5));
    value * half.power_of_two() * (n - half).power_of_two()
}

/// (sinh x, cosh x).
#[inline(always)]
pub fn sinh_cosh<S: Functions>(x: S) -> (S, S) {
    let size = x.abs().min(S::splat(FAR));
    let (grown, grown_low, n) = exponential(size);
    let (fallen, fallen_low, _) = exponential(-size);
    // e⁻ˣ in the units of eˣ: 2^−2n smaller.
    let less = S::splat(-2.0) * n;
    let less = less.max(S::splat(-1000.0)).power_of_two();
    let (fallen, fallen_low) = (fallen * less, fallen_low * less);
    let (sum, sum_low) = fast_sum(grown, fallen);
    let (difference, difference_low) = fast_sum(grown, -fallen);
    let half = n - S::one();
    let cosh = scaled(sum + (sum_low + (grown_low + fallen_low)), half);
    let sinh = scaled(difference + (difference_low + (grown_low - fallen_low)), half);
    let z = size * size;
    let series = (size * z).multiply_add(fused(z, &SINH), size);
    let sinh = S::select(size.less(S::splat(SMALL)), series, sinh);
    let signed = S::select(x.less(S::zero()), -sinh, sinh);
    // The sign of zero, and NaN, are the argument's.
    let tiny = size.less(S::splat(1e-9));
    let number = x.less_equal(x);
    (S::select(tiny, x, S::select(number, signed, x)), S::select(number, cosh, x))
}

/// 1/cosh² x, which is 1 − tanh² x without its cancellation.
#[inline(always)]
pub fn sech_squared<S: Functions>(x: S) -> S {
    let size = x.abs().min(S::splat(FAR));
    let (e, e_low, n) = exponential(-(size + size));
    // Below 2⁻¹⁰⁰⁰ it adds nothing to one.
    let scale = n.max(S::splat(-1000.0)).power_of_two();
    // 4 e⁻²ˣ/(1 + e⁻²ˣ)²
    let (one, low) = two_sum(S::one(), e * scale);
    let (one, low) = fast_sum(one, low + e_low * scale);
    let below = one * one;
    let below_low = one.multiply_add(one, -below) + S::splat(2.0) * (one * low);
    let four = S::splat(4.0);
    let (q, q_low) = super::quotient((four * e, four * e_low), (below, below_low));
    // Below 2⁻¹¹⁰⁰ it is zero.
    S::select(x.less_equal(x), scaled(q + q_low, n.max(S::splat(-1100.0))), x)
}

/// tanh x.
#[inline(always)]
pub fn tanh<S: Functions>(x: S) -> S {
    let size = x.abs().min(S::splat(20.0));
    let (e, e_low, n) = exponential(size + size);
    let grown = n.power_of_two();
    // 1 − 2/(e²ˣ + 1)
    let (below, below_low) = two_sum(e * grown, S::one());
    let (q, q_low) = super::quotient((S::splat(2.0), S::zero()), (below, below_low + e_low * grown));
    let (head, rest) = fast_sum(S::one(), -q);
    let large = head + (rest - q_low);
    let z = size * size;
    let series = (size * z).multiply_add(fused(z, &TANH), size);
    let value = S::select(size.less(S::splat(SMALL)), series, large);
    let signed = S::select(x.less(S::zero()), -value, value);
    let tiny = size.less(S::splat(1e-9));
    S::select(tiny, x, S::select(x.less_equal(x), signed, x))
}
