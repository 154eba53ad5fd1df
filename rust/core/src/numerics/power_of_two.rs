//! Moves by powers of two: exact, and free of overflow on the way.

/// `2^exponent`, saturating at the ends of the normal range.
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// The exponent of the power of two below `value`; 0 for 0.
pub fn exponent(value: f64) -> i32 {
    let value = value.abs();
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    if value < f64::MIN_POSITIVE {
        return exponent(value * power_of_two(600)) - 600;
    }
    (value.to_bits() >> 52) as i32 - 1023
}

/// `value · 2^exponent` without an intermediate overflow.
pub fn scale(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    value * power_of_two(half) * power_of_two(exponent - half)
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
    }

    #[test]
    fn exponents_bracket_the_value() {
        for value in [1.0, 3.9, 1e-310, 7e300, 2.0_f64.powi(-1022)] {
            let e = exponent(value);
            assert!(scale(value, -e) >= 1.0 && scale(value, -e) < 2.0, "{value:e}: {e}");
        }
    }
}
