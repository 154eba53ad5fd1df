//! Moves by powers of two: exact wherever the result is normal, rounded once where it is subnormal.

/// `2^exponent`, saturating at the ends of the normal range.
#[inline]
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// The k with 2^k ≤ |value| < 2^(k+1); 0 for 0, and for what is not finite.
#[inline]
pub fn exponent(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    let biased = ((value.to_bits() >> 52) & 0x7ff) as i32;
    if biased == 0 { exponent(value * power_of_two(64)) - 64 } else { biased - 1023 }
}

/// `value · 2^exponent`, for every exponent: no overflow on the way, and at most one rounding.
#[inline]
pub fn scale(value: f64, exponent: i32) -> f64 {
    if (-1022..=1023).contains(&exponent) {
        value * power_of_two(exponent)
    } else {
        scale_far(value, exponent)
    }
}

/// As [`scale`], by what is no number itself.
#[cold]
fn scale_far(value: f64, exponent: i32) -> f64 {
    // From the least number to the greatest is 2^2098. In halves: were the first of them to leave the
    // normal range, the second would leave that of all numbers.
    let exponent = exponent.clamp(-2200, 2200);
    let half = exponent / 2;
    scale(scale(value, half), exponent - half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn scaling_by_powers_of_two_is_exact(value in 1e-280..1e280f64, exponent in -40..40i32) {
            prop_assert_eq!(scale(scale(value, exponent), -exponent), value);
        }
        #[test]
        fn a_subnormal_result_is_rounded_once(value in 1.0..2.0f64, start in -1000..1000i32, end in -1074..-1022i32) {
            // Integers do the rounding: to even, of the 53 bits that are there to the bits that are left.
            let kept = end + 1075;
            let (bits, cut) = ((value.to_bits() & ((1 << 52) - 1)) | 1 << 52, 53 - kept);
            let (whole, rest, tie) = (bits >> cut, bits & ((1 << cut) - 1), 1_u64 << (cut - 1));
            let rounded = whole + u64::from(rest > tie || (rest == tie && whole & 1 == 1));
            prop_assert_eq!(scale(scale(value, start), end - start).to_bits(), rounded);
        }
    }

    #[test]
    fn exponents_bracket_the_value() {
        for value in [1.0, 3.9, 1e-310, 5e-324, 7e300, f64::MAX, 2.0_f64.powi(-1022)] {
            let e = exponent(value);
            assert!(scale(value, -e) >= 1.0 && scale(value, -e) < 2.0, "{value:e}: {e}");
            assert_eq!(exponent(-value), e);
            assert_eq!(scale(scale(value, -e), e), value);
        }
        assert_eq!((exponent(0.0), exponent(f64::INFINITY)), (0, 0));
    }

    #[test]
    fn scaling_reaches_from_end_to_end_of_the_range() {
        assert_eq!(scale(5e-324, 2097), power_of_two(1023));
        assert_eq!(scale(power_of_two(1023), -2097), 5e-324);
        assert_eq!((scale(1.0, i32::MIN), scale(-1.0, i32::MAX)), (0.0, f64::NEG_INFINITY));
    }
}
