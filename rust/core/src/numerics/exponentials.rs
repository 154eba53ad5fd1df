//! Divided differences of the exponential at complex points: the solutions of linear equations of motion, in one form for
//! all their regimes.
//!
//! y″ + 2Γy′ + ω²y = e^{iΩt} with y = y′ = 0 at the start is y = t² e[iΩt, μ₁t, μ₂t], μ₁ and μ₂ being the roots of
//! μ² + 2Γμ + ω²; the response to a blow is t e[μ₁t, μ₂t]. Written as divided differences nothing is singular: neither
//! critical damping (μ₁ = μ₂) nor resonance (Ω = −iμ) nor a free particle (μ = 0). Points near each other take the Taylor
//! series about their middle, so that nothing cancels. Errors: 1e-30 of the largest exponential, times 1 + |z|.
//! Source: McCurdy, Ng & Parlett, Math. Comp. 43 (1984) 501.

use super::decay::exponential;
use super::double_double::DoubleDouble;
use super::real::Real;
use super::rotation::Rotation;
use super::scaled::Scaled;
use super::stumpff::INVERSE_FACTORIALS;

/// A complex number.
#[derive(Clone, Copy, Debug, Default)]
pub struct Complex {
    /// Its real part.
    pub re: Scaled,
    /// Its imaginary part.
    pub im: Scaled,
}

impl Complex {
    /// From its parts.
    pub fn new(re: Scaled, im: Scaled) -> Self {
        Self { re, im }
    }
    /// The sum.
    pub fn plus(self, other: Self) -> Self {
        Self { re: self.re.plus(other.re), im: self.im.plus(other.im) }
    }
    /// The difference.
    pub fn minus(self, other: Self) -> Self {
        self.plus(other.times(-1.0))
    }
    /// The product with a number.
    pub fn times(self, factor: f64) -> Self {
        Self { re: self.re.times(factor), im: self.im.times(factor) }
    }
    /// The product.
    pub fn by(self, other: Self) -> Self {
        let re = self.re.by(other.re).plus(self.im.by(other.im).times(-1.0));
        Self { re, im: self.re.by(other.im).plus(self.im.by(other.re)) }
    }
    /// The quotient.
    fn over(self, divisor: Self) -> Self {
        let square = divisor.re.by(divisor.re).plus(divisor.im.by(divisor.im));
        let numerator = self.by(Self { re: divisor.re, im: divisor.im.times(-1.0) });
        Self { re: numerator.re.over(square), im: numerator.im.over(square) }
    }
    /// The larger of its parts without their signs.
    fn size(self) -> f64 {
        let [re, im] = [self.re.to_f64().abs(), self.im.to_f64().abs()];
        if re > im { re } else { im }
    }
    /// Its exponential.
    pub fn exp(self) -> Self {
        let size = exponential(self.re);
        let turn = Rotation::new(self.im);
        Self { re: size.by(turn.cosine), im: size.by(turn.sine) }
    }
}

/// Points within this of their middle take the series.
const NEAR: f64 = 1.0;
/// Terms of the series: h_n of points within the square of half-width 1 is below (n + 2)(n + 1)/2·2^{n/2}, so the last of
/// 32 is below 1e-29 of the first where all are at a corner, and far below where they are inside.
const TERMS: usize = 31;

/// e[a, b] = (eᵃ − eᵇ)/(a − b).
pub fn second(a: Complex, b: Complex) -> Complex {
    let half = a.minus(b).times(0.5);
    if half.size() > NEAR {
        return a.exp().minus(b.exp()).over(half.times(2.0));
    }
    // e^{(a+b)/2} sinh(h)/h, whose series is in h².
    let square = half.by(half);
    let mut sum = Complex::default();
    for index in (0..TERMS / 2).rev() {
        sum = sum.by(square).plus(real(INVERSE_FACTORIALS[2 * index + 1]));
    }
    let ratio = sum.by(square).plus(real(DoubleDouble::one()));
    a.plus(b).times(0.5).exp().by(ratio)
}

/// e[a, b, c].
pub fn third(a: Complex, b: Complex, c: Complex) -> Complex {
    let apart = [b.minus(c).size(), a.minus(c).size(), a.minus(b).size()];
    let most = apart.iter().copied().fold(0.0, f64::max);
    if most > NEAR {
        // Over the largest difference.
        let (a, b, c) = if apart[0] == most {
            (b, a, c)
        } else if apart[1] == most {
            (a, b, c)
        } else {
            (a, c, b)
        };
        return second(a, b).minus(second(b, c)).over(a.minus(c));
    }
    // About one of them: e^a Σ h_n(0, y, z)/(n + 2)!, h_n = y h_{n−1} + zⁿ.
    let (y, z) = (b.minus(a), c.minus(a));
    let (mut h, mut power) = (real(DoubleDouble::one()), real(DoubleDouble::one()));
    let mut sum = Complex::default();
    for &coefficient in &INVERSE_FACTORIALS[..TERMS] {
        sum = sum.plus(Complex {
            re: h.re.by(Scaled::new(coefficient, 0)),
            im: h.im.by(Scaled::new(coefficient, 0)),
        });
        power = power.by(z);
        h = h.by(y).plus(power);
    }
    a.exp().by(sum)
}

fn real(value: DoubleDouble) -> Complex {
    Complex { re: Scaled::new(value, 0), im: Scaled::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(re: f64, im: f64) -> Complex {
        Complex::new(Scaled::from(re), Scaled::from(im))
    }

    /// Across the border between the series and the differences: what both are far enough from coincidence to agree on.
    #[test]
    fn series_and_differences_meet() {
        for (a, b, c) in [
            (point(0.1, 0.9), point(-0.6, 0.2), point(0.3, 0.3)),
            (point(-0.5, 0.0), point(0.4, 0.0), point(0.0, 0.1)),
        ] {
            let near = third(a, b, c);
            let far = second(a, b).minus(second(b, c)).over(a.minus(c));
            // Two roundings of 2^-104 over a difference of 1/2, and what is left out of the series.
            assert!(near.minus(far).size() < 1e-29, "{:e}", near.minus(far).size());
            let far = a.exp().minus(b.exp()).over(a.minus(b));
            assert!(second(a, b).minus(far).size() < 1e-30);
        }
    }

    #[test]
    fn where_all_meet_they_are_derivatives() {
        let a = point(0.5, 2.0);
        assert!(second(a, a).minus(a.exp()).size() < 1e-31);
        assert!(third(a, a, a).minus(a.exp().times(0.5)).size() < 1e-31);
        assert_eq!(third(Complex::default(), Complex::default(), Complex::default()).re.to_f64(), 0.5);
    }

    #[test]
    fn the_order_of_the_points_does_not_matter() {
        let points = [point(0.0, 30.0), point(-2.0, 0.5), point(-2.0, 0.6)];
        let [a, b, c] = points;
        for other in [third(b, a, c), third(c, b, a), third(a, c, b)] {
            assert!(third(a, b, c).minus(other).size() < 1e-31);
        }
    }
}
