//! Natural logarithms in double-double, of numbers of any size.
//!
//! ln(1 + q) = 2 artanh(q/(2 + q)) for small q; else one step of Newton on the exponential from the logarithm of `f64`.
//! Errors: 1e-31, for small q relative to the result.

use super::double_double::DoubleDouble;
use super::elementary::{self, Exponential};
use super::real::Real;
use super::scaled::Scaled;
use core::array;
use std::sync::LazyLock;

const LN2: DoubleDouble = DoubleDouble::new(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
/// 1/(2k + 1), those of the series of artanh: (1/3)^{2·35} < 1e-33.
static ODD_INVERSES: LazyLock<[DoubleDouble; 35]> =
    LazyLock::new(|| array::from_fn(|k| DoubleDouble::one() / DoubleDouble::from((2 * k + 1) as f64)));

/// ln x of x > 0.
pub fn ln(x: Scaled) -> Scaled {
    let exponent = super::power_of_two::exponent(x.value().to_f64());
    let value = Scaled::new(x.value(), -exponent).to_double_double();
    let near = DoubleDouble::from(elementary::ln(value.to_f64()));
    let rest = value * Exponential::exp(-near) - DoubleDouble::one();
    // ln(1 + r) of r ≈ 1e-16.
    let value = near + (rest - (rest * rest).scale(0.5));
    Scaled::new(value + LN2 * DoubleDouble::from(f64::from(exponent + x.exponent())), 0)
}

/// ln(1 + q) of q > −1.
pub fn ln_1p(q: Scaled) -> Scaled {
    if q.to_f64().abs() > 0.5 {
        return ln(Scaled::from(1.0).plus(q));
    }
    let ratio = q.over(Scaled::from(2.0).plus(q));
    let w = ratio.to_double_double();
    let square = w * w;
    let mut sum = DoubleDouble::default();
    for &inverse in ODD_INVERSES.iter().rev() {
        sum = sum * square + inverse;
    }
    ratio.by(Scaled::new(sum, 0)).times(2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_inverts_the_exponential() {
        for x in [1e-3, 0.4, 0.5, -0.4, 3.0, -30.0, 600.0, 1e-12, -0.499] {
            let y = Exponential::exp(DoubleDouble::from(x));
            let back = ln(Scaled::new(y, 0)).plus(Scaled::from(-x)).to_f64();
            // The exponential has 30 digits relative to 1 + |x|.
            assert!(back.abs() < 2e-30 * (1.0 + f64::abs(x)), "{x}: {back:e}");
            // What the sum with −1 rounds away is more than that far below.
            if x < -1.0 {
                continue;
            }
            let back = ln_1p(Scaled::new(y, 0).plus(Scaled::from(-1.0))).plus(Scaled::from(-x)).to_f64();
            assert!(back.abs() < 2e-30 * (1.0 + f64::abs(x)), "{x}: {back:e}");
        }
    }

    #[test]
    fn it_goes_beyond_the_range() {
        let far = ln(Scaled::new(DoubleDouble::from(1.5), 5000)).to_f64();
        assert!((far - (5000.0 * core::f64::consts::LN_2 + 1.5_f64.ln())).abs() < 1e-12);
        // The series keeps what is small: q − q²/2.
        let small = Scaled::from(1e-300);
        assert_eq!(ln_1p(small).to_f64(), 1e-300);
        assert_eq!(ln_1p(Scaled::ZERO).to_f64(), 0.0);
    }
}
