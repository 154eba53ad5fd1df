//! The theta series of a free rotation.
//!
//! With the angular momentum along z, the rotation from the body is α = w + iz, β = x + iy (Cayley and Klein), and
//! each of the two is one theta function over a common one, which the length of the quaternion makes needless:
//! α ∝ ϑ₄(ζ + iη | 2τ), β ∝ ϑ₁(ζ + iη | 2τ), times a phase that grows with time. (Jacobi 1850; here as the double
//! cover of the formulas of van Zon & Schofield, J. Comput. Phys. 225 (2007) 145, derived anew.) Beyond a nome of
//! 0.15, Jacobi's imaginary transformation makes them ϑ₂ and ϑ₁ of hyperbolic arguments, whose nome is small where the
//! separatrix is near, and zero on it.

use crate::numerics::elementary::Exponential;

/// A complex number.
pub(super) type Complex = [f64; 2];
/// sn, cn and dn.
pub(super) type Jacobi = [f64; 3];

/// For nomes up to 0.15: terms left out are below 1e-20.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Trigonometric {
    /// Of sn: sin(2n + 1)ζ; of cn: cos(2n + 1)ζ; with what makes them 1 at a quarter and at zero.
    pub(super) odd: [f64; 4],
    /// qⁿ², n = 1 … 4, twice.
    pub(super) squares: [f64; 4],
    /// What makes sn, cn, dn what they are.
    pub(super) scale: Jacobi,
    /// Real and imaginary parts of ϑ₄: of cos 2nζ and sin 2nζ, n = 1 … 3.
    pub(super) even_terms: [Complex; 3],
    /// Of ϑ₁: of cos(2n + 1)ζ and sin(2n + 1)ζ, n = 0 … 3.
    pub(super) odd_terms: [Complex; 4],
}

impl Trigonometric {
    /// sn, cn, dn and the two theta functions at the angle ζ with this sine and cosine.
    #[inline]
    pub(super) fn at(&self, sine: f64, cosine: f64) -> (Jacobi, Complex, Complex) {
        let double = [1.0 - 2.0 * sine * sine, 2.0 * sine * cosine];
        // e^{i(2n + 1)ζ} and e^{2inζ}.
        let mut odd = [cosine, sine];
        let mut even = double;
        let (mut t1, mut t2) = (0.0, 0.0);
        let mut first = [0.0; 2];
        for n in 0..4 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            t1 += sign * self.odd[n] * odd[1];
            t2 += self.odd[n] * odd[0];
            first[0] += self.odd_terms[n][0] * odd[0];
            first[1] += self.odd_terms[n][1] * odd[1];
            odd = times(odd, double);
        }
        let (mut t3, mut t4) = (1.0, 1.0);
        let mut fourth = [1.0, 0.0];
        for n in 0..4 {
            let sign = if n % 2 == 0 { -1.0 } else { 1.0 };
            t3 += self.squares[n] * even[0];
            t4 += sign * self.squares[n] * even[0];
            if n < 3 {
                fourth[0] += self.even_terms[n][0] * even[0];
                fourth[1] += self.even_terms[n][1] * even[1];
            }
            even = times(even, double);
        }
        let [sn, cn, dn] = self.scale;
        ([sn * (t1 / t4), cn * (t2 / t4), dn * (t3 / t4)], fourth, first)
    }
}

#[inline]
pub(super) fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// For complementary nomes s² up to 0.006: terms left out are below 1e-18.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hyperbolic {
    /// sⁿ, n = 0 … 3, to the powers of the series.
    pub(super) squares: [f64; 4],
    pub(super) products: [f64; 4],
    /// cos and sin of (2n + 1)η.
    pub(super) angles: [Complex; 4],
    /// s^{2n²} and s^{2n(n+1)}.
    pub(super) double_squares: [f64; 4],
    pub(super) double_products: [f64; 4],
    /// s^{2n(n−1)}.
    pub(super) before: [f64; 4],
    /// What makes sn, cn, dn what they are.
    pub(super) scale: Jacobi,
    /// Of ϑ₁.
    pub(super) ratio: f64,
}

impl Hyperbolic {
    /// sn, cn, dn and the two theta functions, where `past` is the hyperbolic angle from the middle and `ahead` that to
    /// the end of the half period, both times −2, both ≤ 0.
    #[inline]
    pub(super) fn at(&self, past: f64, ahead: f64) -> (Jacobi, Complex, Complex) {
        // By name: a method of f64 with this name would be the platform's.
        let (x, y) = (Exponential::exp(past), Exponential::exp(ahead));
        let (mut second, mut first) = ([0.0; 2], [0.0; 2]);
        let (mut rising, mut falling) = (1.0, x);
        for n in 0..4 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let (up, down) = (self.squares[n] * rising, self.products[n] * falling);
            let [cosine, sine] = self.angles[n];
            second[0] += cosine * (up + down);
            second[1] += sine * (up - down);
            first[0] += sign * (sine * (up + down));
            first[1] -= sign * (cosine * (up - down));
            rising *= y;
            falling *= x;
        }
        (self.jacobi(x, y), second, first.map(|part| self.ratio * part))
    }

    #[inline]
    fn jacobi(&self, x: f64, y: f64) -> Jacobi {
        let (xx, yy) = (x * x, y * y);
        let (mut t1, mut t2, mut t3, mut t4) = (0.0, 0.0, 1.0, 1.0);
        let (mut rising, mut falling) = (1.0, 1.0);
        for n in 0..4 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let (up, down) = (self.double_squares[n] * rising, self.double_products[n] * (falling * xx));
            t1 += sign * (up - down);
            t2 += up + down;
            if n > 0 {
                let both = self.before[n] * rising + self.double_squares[n] * falling;
                t3 += both;
                t4 += sign * both;
            }
            rising *= yy;
            falling *= xx;
        }
        let [sn, cn, dn] = self.scale;
        [sn * (t1 / t2), cn * (x * t4 / t2), dn * (x * t3 / t2)]
    }
}
