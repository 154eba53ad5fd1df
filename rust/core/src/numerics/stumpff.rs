//! The functions of Kepler's universal variable: G₀ … G₃ of (β, s).
//!
//! G_n(β, s) = sⁿ c_n(βs²) with Stumpff's c_n(z) = Σ (−z)^k/(n + 2k)!. For β > 0 they are cosine, sine and
//! their integrals in √β·s, for β < 0 the hyperbolic ones, for β = 0 powers: one set for every conic.
//! dG_{n+1}/ds = G_n. Source: Stumpff, *Himmelsmechanik* I (1959) §41; Stiefel & Scheifele, *Linear and Regular
//! Celestial Mechanics* (1971) §11; the halving rules are the double-angle formulas.

use super::angles::sin_cos;
use super::double_double::DoubleDouble;
use super::elementary::Exponential;
use super::real::Real;

/// 1/n! for n = 2 … 33.
pub(super) const INVERSE_FACTORIALS: [DoubleDouble; 32] = [
    DoubleDouble::new(0.5, 0.0),                                        // 1/2!
    DoubleDouble::new(0.16666666666666666, 9.25185853854297e-18),       // 1/3!
    DoubleDouble::new(0.041666666666666664, 2.3129646346357427e-18),    // 1/4!
    DoubleDouble::new(0.008333333333333333, 1.1564823173178714e-19),    // 1/5!
    DoubleDouble::new(0.001388888888888889, -5.300543954373577e-20),    // 1/6!
    DoubleDouble::new(0.0001984126984126984, 1.7209558293420705e-22),   // 1/7!
    DoubleDouble::new(2.48015873015873e-05, 2.1511947866775882e-23),    // 1/8!
    DoubleDouble::new(2.7557319223985893e-06, -1.858393274046472e-22),  // 1/9!
    DoubleDouble::new(2.755731922398589e-07, 2.3767714622250297e-23),   // 1/10!
    DoubleDouble::new(2.505210838544172e-08, -1.448814070935912e-24),   // 1/11!
    DoubleDouble::new(2.08767569878681e-09, -1.20734505911326e-25),     // 1/12!
    DoubleDouble::new(1.6059043836821613e-10, 1.2585294588752098e-26),  // 1/13!
    DoubleDouble::new(1.1470745597729725e-11, 2.0655512752830745e-28),  // 1/14!
    DoubleDouble::new(7.647163731819816e-13, 7.03872877733453e-30),     // 1/15!
    DoubleDouble::new(4.779477332387385e-14, 4.399205485834081e-31),    // 1/16!
    DoubleDouble::new(2.8114572543455206e-15, 1.6508842730861433e-31),  // 1/17!
    DoubleDouble::new(1.5619206968586225e-16, 1.1910679660273754e-32),  // 1/18!
    DoubleDouble::new(8.22063524662433e-18, 2.2141894119604265e-34),    // 1/19!
    DoubleDouble::new(4.110317623312165e-19, 1.4412973378659527e-36),   // 1/20!
    DoubleDouble::new(1.9572941063391263e-20, -1.3643503830087908e-36), // 1/21!
    DoubleDouble::new(8.896791392450574e-22, -7.911402614872376e-38),   // 1/22!
    DoubleDouble::new(3.868170170630684e-23, -8.843177655482344e-40),   // 1/23!
    DoubleDouble::new(1.6117375710961184e-24, -3.6846573564509766e-41), // 1/24!
    DoubleDouble::new(6.446950284384474e-26, -1.9330404233703465e-42),  // 1/25!
    DoubleDouble::new(2.4795962632247976e-27, -1.2953730964765229e-43), // 1/26!
    DoubleDouble::new(9.183689863795546e-29, 1.4303150396787322e-45),   // 1/27!
    DoubleDouble::new(3.279889237069838e-30, 1.5117542744029879e-46),   // 1/28!
    DoubleDouble::new(1.1309962886447716e-31, 1.0498015412959506e-47),  // 1/29!
    DoubleDouble::new(3.7699876288159054e-33, 2.5870347832750324e-49),  // 1/30!
    DoubleDouble::new(1.216125041553518e-34, 5.586290567888806e-51),    // 1/31!
    DoubleDouble::new(3.8003907548547434e-36, 1.7457158024652518e-52),  // 1/32!
    DoubleDouble::new(1.151633562077195e-37, -6.09957445788454e-54),    // 1/33!
];

/// G₀, G₁, G₂, G₃ at one s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniversalFunctions<S> {
    /// cos-like: 1 − βG₂.
    pub g0: S,
    /// sin-like: s − βG₃.
    pub g1: S,
    /// (1 − G₀)/β, without the cancellation.
    pub g2: S,
    /// (s − G₁)/β, without the cancellation.
    pub g3: S,
}

impl<S: Real> UniversalFunctions<S> {
    fn from_stumpff(beta: S, s: S, c2: S, c3: S) -> Self {
        let s2 = s * s;
        let g2 = s2 * c2;
        let g3 = s * (s2 * c3);
        Self { g0: S::one() - beta * g2, g1: s * (S::one() - (beta * s2) * c3), g2, g3 }
    }

    /// At 2s from s. Every term has one sign when β ≤ 0.
    pub fn doubled(self) -> Self {
        let two = S::splat(2.0);
        let g1_squared = self.g1 * self.g1;
        Self {
            g0: two * self.g0 * self.g0 - S::one(),
            g1: two * self.g0 * self.g1,
            g2: two * g1_squared,
            g3: two * (self.g3 + self.g1 * self.g2),
        }
    }
}

impl UniversalFunctions<f64> {
    /// At (β, s), each to a few ulps of itself where βs² ≤ 2.6 (there G₀ to a few ulps of 1).
    pub fn new(beta: f64, s: f64) -> Self {
        let z = beta * s * s;
        if z.abs() <= 2.6 {
            let (c2, c3) = stumpff_series(z);
            return Self::from_stumpff(beta, s, c2, c3);
        }
        if z < 0.0 && z > -10.4 {
            let (c2, c3) = stumpff_series(0.25 * z);
            let half = Self::from_stumpff(beta, 0.5 * s, c2, c3);
            // cosh from 1 + |β|G₂: no subtraction.
            let whole = half.doubled();
            return Self { g0: 1.0 - beta * whole.g2, ..whole };
        }
        let rate = beta.abs().sqrt();
        let angle = rate * s;
        if z < 0.0 {
            let grown = Exponential::exp(angle.abs());
            let sine = (0.5 * (grown - 1.0 / grown)).copysign(s);
            let cosine = 0.5 * (grown + 1.0 / grown);
            return Self {
                g0: cosine,
                g1: sine / rate,
                g2: (cosine - 1.0) / -beta,
                g3: (sine - angle) / (-beta * rate),
            };
        }
        let (sine, cosine) = sin_cos(angle);
        Self { g0: cosine, g1: sine / rate, g2: (1.0 - cosine) / beta, g3: (angle - sine) / (beta * rate) }
    }

    /// At s + δ, for √|β|·|δ| ≤ 2⁻¹⁵: the addition theorem to δ³ (what is left out is below 1e-19).
    pub fn shifted(self, beta: f64, delta: f64) -> Self {
        let half = 0.5 * delta * delta;
        let sixth = half * delta / 3.0;
        let g2_step = self.g1 * delta + (self.g0 * half - beta * self.g1 * sixth);
        let g1_step = self.g0 * delta - beta * (self.g1 * half + self.g0 * sixth);
        Self {
            g0: self.g0 - beta * g2_step,
            g1: self.g1 + g1_step,
            g2: self.g2 + g2_step,
            g3: self.g3 + (self.g2 * delta + (self.g1 * half + self.g0 * sixth)),
        }
    }
}

impl UniversalFunctions<DoubleDouble> {
    /// At (β, s) in double-double; an elliptic √β·s beyond π loses a bit for each further doubling.
    pub fn new(beta: DoubleDouble, s: DoubleDouble) -> Self {
        let mut z = beta * s * s;
        let mut halvings = 0;
        let mut part = s;
        while z.to_f64().abs() > 0.7 && halvings < 40 {
            z = z.scale(0.25);
            part = part.scale(0.5);
            halvings += 1;
        }
        // |z| ≤ 0.7: z^15/33! is below 1e-39.
        let mut c2 = INVERSE_FACTORIALS[30];
        let mut c3 = INVERSE_FACTORIALS[31];
        for k in (0..15).rev() {
            c2 = INVERSE_FACTORIALS[2 * k] - z * c2;
            c3 = INVERSE_FACTORIALS[2 * k + 1] - z * c3;
        }
        let mut functions = Self::from_stumpff(beta, part, c2, c3);
        for _ in 0..halvings {
            functions = functions.doubled();
        }
        functions
    }
}

/// (c₂, c₃) of |z| ≤ 2.6 by their series, even and odd powers apart so that the two chains overlap.
#[inline]
fn stumpff_series(z: f64) -> (f64, f64) {
    const fn term(n: usize) -> f64 {
        INVERSE_FACTORIALS[n - 2].to_f64()
    }
    let w = z * z;
    let even2 = term(2) + w * (term(6) + w * (term(10) + w * (term(14) + w * (term(18) + w * term(22)))));
    let odd2 = term(4) + w * (term(8) + w * (term(12) + w * (term(16) + w * term(20))));
    let even3 = term(3) + w * (term(7) + w * (term(11) + w * (term(15) + w * term(19))));
    let odd3 = term(5) + w * (term(9) + w * (term(13) + w * (term(17) + w * term(21))));
    (even2 - z * odd2, even3 - z * odd3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elementary::Exponential;

    fn functions(beta: f64, s: f64) -> UniversalFunctions<DoubleDouble> {
        UniversalFunctions::<DoubleDouble>::new(DoubleDouble::from(beta), DoubleDouble::from(s))
    }

    /// The two series are made of different coefficients, all of which this identity needs to 31 digits.
    #[test]
    fn squares_of_the_cosine_and_the_sine_sum_to_one() {
        let mut worst = 0.0_f64;
        for z in [0.7, 0.55, 0.3, 0.05, -0.05, -0.3, -0.55, -0.7] {
            for s in [0.75_f64, 1.0, 1.5] {
                let beta = z / (s * s);
                let g = functions(beta, s);
                let one = g.g0 * g.g0 + DoubleDouble::from(beta) * g.g1 * g.g1;
                worst = worst.max((one - DoubleDouble::one()).to_f64().abs());
            }
        }
        // Measured 4.3e-32: four roundings of 2^-106 each.
        assert!(worst <= 6e-32, "{worst:e}");
    }

    #[test]
    fn hyperbolic_functions_against_the_exponential() {
        let mut worst = 0.0_f64;
        for s in [0.125, 0.5, 0.8, 1.0, 3.0, 10.0] {
            let (grown, x) = (DoubleDouble::from(s).exp(), DoubleDouble::from(s));
            let sine = (grown - DoubleDouble::one() / grown).scale(0.5);
            let g = functions(-1.0, s);
            // sinh s − s, whose cancellation costs the reference 6/s² of its digits.
            for (found, expected, loss) in
                [(g.g1, sine, 1.0), (g.g0, grown - sine, 1.0), (g.g3, sine - x, 1.0 + 6.0 / (s * s))]
            {
                worst = worst.max(((found - expected) / expected).to_f64().abs() / loss / (1.0 + s));
            }
        }
        // Measured 8.0e-33.
        assert!(worst <= 1.2e-32, "{worst:e}");
    }
}
