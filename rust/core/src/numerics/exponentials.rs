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
        Self { re: self.re.minus(other.re), im: self.im.minus(other.im) }
    }
    /// The product with a real number.
    pub fn along(self, factor: Scaled) -> Self {
        Self { re: self.re.by(factor), im: self.im.by(factor) }
    }
    /// The product with a number.
    pub fn times(self, factor: f64) -> Self {
        self.along(Scaled::from(factor))
    }
    /// The product.
    pub fn by(self, other: Self) -> Self {
        let re = self.re.by(other.re).minus(self.im.by(other.im));
        Self { re, im: self.re.by(other.im).plus(self.im.by(other.re)) }
    }
    /// The quotient.
    fn over(self, divisor: Self) -> Self {
        let square = divisor.re.by(divisor.re).plus(divisor.im.by(divisor.im));
        let numerator = self.by(divisor.conjugate());
        Self { re: numerator.re.over(square), im: numerator.im.over(square) }
    }
    /// The larger of its parts without their signs.
    fn size(self) -> f64 {
        let [re, im] = [self.re.to_f64().abs(), self.im.to_f64().abs()];
        if re > im { re } else { im }
    }
    /// The conjugate number.
    fn conjugate(self) -> Self {
        Self { re: self.re, im: self.im.negative() }
    }
    /// Its exponential.
    pub fn exp(self) -> Self {
        let turn = Rotation::new(self.im);
        if self.re.is_zero() {
            return Self { re: turn.cosine, im: turn.sine };
        }
        Self { re: turn.cosine, im: turn.sine }.along(exponential(self.re))
    }
}

/// A point, with the exponential there: found once for all differences that the point is in.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Where it is.
    pub at: Complex,
    /// The exponential of that.
    pub exponential: Complex,
}

impl Point {
    /// At a complex number.
    pub fn new(at: Complex) -> Self {
        Self { at, exponential: at.exp() }
    }
    /// Two roots times a time, of an equation with real coefficients: both real, or conjugate.
    pub fn pair([first, second]: [Complex; 2]) -> [Self; 2] {
        let first = Self::new(first);
        let other = if first.at.im.is_zero() {
            Self::new(second)
        } else {
            Self { at: second, exponential: first.exponential.conjugate() }
        };
        [first, other]
    }
}

/// Points within this of their middle take the series.
const NEAR: f64 = 1.0;
/// Terms of the series: h_n of points within the square of half-width 1 is below (n + 2)(n + 1)/2·2^{n/2}, so the last of
/// 32 is below 1e-29 of the first where all are at a corner, and far below where they are inside.
const TERMS: usize = 31;
/// Points that are nearer than this to each other leave nothing beyond the first power of their distances.
const LINEAR: f64 = 1e-100;

/// e[a, b] = (eᵃ − eᵇ)/(a − b).
pub fn second(a: &Point, b: &Point) -> Complex {
    let half = a.at.minus(b.at).times(0.5);
    if half.size() > NEAR {
        return a.exponential.minus(b.exponential).over(half.times(2.0));
    }
    // e^{(a+b)/2} sinh(h)/h, whose series is in h².
    let square = Near::new(half).squared();
    let mut sum = Near::default();
    for index in (0..TERMS / 2).rev() {
        sum = sum.by(square).beside(INVERSE_FACTORIALS[2 * index + 1]);
    }
    let ratio = sum.by(square).beside(DoubleDouble::one());
    a.at.plus(b.at).times(0.5).exp().by(ratio.into())
}

/// e[a, b, c].
pub fn third(a: &Point, b: &Point, c: &Point) -> Complex {
    let apart = [b.at.minus(c.at).size(), a.at.minus(c.at).size(), a.at.minus(b.at).size()];
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
        return second(a, b).minus(second(b, c)).over(a.at.minus(c.at));
    }
    // About one of them: e^a Σ h_n(0, y, z)/(n + 2)!, h_n = y h_{n−1} + zⁿ.
    let (y, z) = (b.at.minus(a.at), c.at.minus(a.at));
    if most < LINEAR {
        let [half, sixth] = [INVERSE_FACTORIALS[0], INVERSE_FACTORIALS[1]].map(|c| Scaled::new(c, 0));
        return a.exponential.by(Complex { re: half, im: Scaled::ZERO }.plus(y.plus(z).along(sixth)));
    }
    let (y, z) = (Near::new(y), Near::new(z));
    let (mut h, mut power, mut sum) = (Near::one(), Near::one(), Near::default());
    for &coefficient in &INVERSE_FACTORIALS[..TERMS] {
        sum = sum.plus(h.times(coefficient));
        power = power.by(z);
        h = h.by(y).plus(power);
    }
    a.exponential.by(sum.into())
}

/// A complex number of about one, or far less: its powers need no powers of two beside them.
#[derive(Clone, Copy, Default)]
struct Near {
    re: DoubleDouble,
    im: DoubleDouble,
}

impl Near {
    fn new(of: Complex) -> Self {
        Self { re: of.re.to_double_double(), im: of.im.to_double_double() }
    }
    fn one() -> Self {
        Self::default().beside(DoubleDouble::one())
    }
    /// The sum with a real number.
    fn beside(self, real: DoubleDouble) -> Self {
        Self { re: self.re + real, im: self.im }
    }
    fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
    fn times(self, factor: DoubleDouble) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
    fn by(self, other: Self) -> Self {
        let im = self.re * other.im + self.im * other.re;
        Self { re: self.re * other.re - self.im * other.im, im }
    }
    fn squared(self) -> Self {
        self.by(self)
    }
}

impl From<Near> for Complex {
    fn from(Near { re, im }: Near) -> Self {
        Self { re: Scaled::new(re, 0), im: Scaled::new(im, 0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(re: f64, im: f64) -> Point {
        Point::new(Complex::new(Scaled::from(re), Scaled::from(im)))
    }

    /// Across the border between the series and the differences: what both are far enough from coincidence to agree on.
    #[test]
    fn series_and_differences_meet() {
        for (a, b, c) in [
            (point(0.1, 0.9), point(-0.6, 0.2), point(0.3, 0.3)),
            (point(-0.5, 0.0), point(0.4, 0.0), point(0.0, 0.1)),
        ] {
            let near = third(&a, &b, &c);
            let far = second(&a, &b).minus(second(&b, &c)).over(a.at.minus(c.at));
            // Two roundings of 2^-104 over a difference of 1/2, and what is left out of the series.
            assert!(near.minus(far).size() < 1e-29, "{:e}", near.minus(far).size());
            let far = a.exponential.minus(b.exponential).over(a.at.minus(b.at));
            assert!(second(&a, &b).minus(far).size() < 1e-30);
        }
    }

    #[test]
    fn where_all_meet_they_are_derivatives() {
        let a = point(0.5, 2.0);
        assert!(second(&a, &a).minus(a.exponential).size() < 1e-31);
        assert!(third(&a, &a, &a).minus(a.exponential.times(0.5)).size() < 1e-31);
        let origin = point(0.0, 0.0);
        assert_eq!(third(&origin, &origin, &origin).re.to_f64(), 0.5);
    }

    #[test]
    fn what_is_next_to_nothing_is_not_lost() {
        for size in [1e-99, 1e-101, 1e-305] {
            // e[ix, 0, 0] is 1/2 + ix/6.
            let found = third(&point(0.0, size), &point(0.0, 0.0), &point(0.0, 0.0));
            assert_eq!(found.re.to_f64(), 0.5);
            assert!((found.im.to_f64() * 6.0 / size - 1.0).abs() < 1e-15, "{size}: {found:?}");
        }
    }

    #[test]
    fn the_order_of_the_points_does_not_matter() {
        let points = [point(0.0, 30.0), point(-2.0, 0.5), point(-2.0, 0.6)];
        let [a, b, c] = points;
        for other in [third(&b, &a, &c), third(&c, &b, &a), third(&a, &c, &b)] {
            assert!(third(&a, &b, &c).minus(other).size() < 1e-31);
        }
    }

    #[test]
    fn exponentials_at_a_pair_are_those_at_each() {
        for [re, im] in [[-0.3, 2.0], [0.0, 40.0], [1.5, -0.2]] {
            let at = [im, -im].map(|im| Complex::new(Scaled::from(re), Scaled::from(im)));
            for (pair, alone) in Point::pair(at).into_iter().zip(at.map(Point::new)) {
                assert!(pair.exponential.minus(alone.exponential).size() < 1e-31);
            }
        }
        let real = [-3.0, -0.5].map(|re| Complex::new(Scaled::from(re), Scaled::ZERO));
        let [fast, slow] = Point::pair(real);
        assert!(
            (fast.exponential.re.to_f64(), slow.exponential.re.to_f64())
                == ((-3.0_f64).exp(), (-0.5_f64).exp())
        );
    }
}
