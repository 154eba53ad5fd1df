//! ϑ₁ and ϑ₂ of r + iη for |r| ≤ π/4: with them half a period before and after is one of the two again.
//!
//! Of nomes up to e^{−π}; beyond, Jacobi's imaginary transformation makes them ϑ₁ and ϑ₄ of x − iy with x = η K/K',
//! y = r K/K' and the complementary nome, which is zero on the separatrix. Either way what grows with η or y stands
//! before the series, and no sum is a small difference.

use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;

/// Terms left out are below 1e-19.
const TERMS: usize = 4;

/// Real and imaginary part.
type Complex = [f64; 2];

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

/// 1 − e⁻ᵛ of v ≥ 0.
fn one_less_exp(v: DoubleDouble) -> DoubleDouble {
    if v.high() < 1e-18 { v } else { of(1.0) - (-v).exp() }
}

fn power(base: DoubleDouble, exponent: usize) -> DoubleDouble {
    (0..exponent).fold(of(1.0), |product, _| product * base)
}

fn sign(n: usize) -> f64 {
    if n.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The periods: K and K' (K is infinite on the separatrix), and which nome is the small one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    pub(super) quarter: DoubleDouble,
    pub(super) other: DoubleDouble,
}

impl Lattice {
    /// Whether the nome itself is the small one.
    pub(super) fn trigonometric(&self) -> bool {
        self.other >= self.quarter
    }

    /// The smaller nome.
    pub(super) fn nome(&self) -> DoubleDouble {
        let (one, other) =
            if self.trigonometric() { (self.other, self.quarter) } else { (self.quarter, self.other) };
        if one.is_finite() { (-(DoubleDouble::PI * one / other)).exp() } else { of(0.0) }
    }

    /// y per argument, or r.
    pub(super) fn per_argument(&self) -> DoubleDouble {
        let by = if self.trigonometric() { self.quarter } else { self.other };
        DoubleDouble::PI.scale(0.5) / by
    }
}

/// One of the two functions at r: its value, and its derivative by r or y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    value: Complex,
    slope: Complex,
}

impl Value {
    /// Its absolute value, and the derivative of that; where it is zero, the derivative after.
    pub(super) fn size(&self) -> (f64, f64) {
        let ([a, b], [c, d]) = (self.value, self.slope);
        let size = (a * a + b * b).sqrt();
        if size == 0.0 { (0.0, (c * c + d * d).sqrt()) } else { (size, a / size * c + b / size * d) }
    }

    /// Its argument; of zero, the one after.
    pub(super) fn argument(&self) -> f64 {
        let [a, b] = self.value;
        // Not that of −0.
        if a == 0.0 && b == 0.0 { 0.0 } else { atan2(b, a) }
    }
}

/// The functions of one η.
#[derive(Clone, Copy, Debug)]
pub(super) struct Theta {
    trigonometric: bool,
    /// Of the real and of the imaginary part of each term, but for what goes with r.
    odd: [Complex; TERMS],
    even: [Complex; TERMS],
    /// |ϑ₂(iη)|.
    pub(super) middle: f64,
    /// How fast the argument falls at r = 0 of ϑ₂, per unit of time if the argument grows by `rate`.
    pub(super) falling: DoubleDouble,
    /// What the argument falls by per r beside the series: 2x/π.
    pub(super) linear: f64,
}

impl Theta {
    /// Of the pole at iη (an argument, not an angle; and `rest` is K' − η), where the argument grows by `rate`.
    pub(super) fn new(lattice: &Lattice, pole: DoubleDouble, rest: DoubleDouble, rate: DoubleDouble) -> Self {
        let nome = lattice.nome();
        let per_argument = lattice.per_argument();
        let (mut odd, mut even) = ([[0.0; 2]; TERMS], [[0.0; 2]; TERMS]);
        if lattice.trigonometric() {
            let twice = (pole * per_argument).scale(2.0);
            // q e^{2η}.
            let g = (-(rest * per_argument).scale(2.0)).exp();
            let (mut value, mut slope) = (of(0.0), of(0.0));
            for n in 0..TERMS {
                let m = of((2 * n + 1) as f64);
                let size = power(nome, n * n) * power(g, n);
                let less = one_less_exp(twice * m);
                let (both, apart) = (size * (of(2.0) - less), size * less);
                value += both;
                slope += apart * m;
                odd[n] = [both.scale(sign(n)).to_f64(), apart.scale(sign(n)).to_f64()];
                even[n] = [both.to_f64(), -apart.to_f64()];
            }
            let falling = rate * per_argument * slope / value;
            return Self { trigonometric: true, odd, even, middle: value.to_f64(), falling, linear: 0.0 };
        }
        let x = pole * per_argument;
        let turned = |times: f64| {
            let turn = Rotation::new(Scaled::new(x * of(times), 0));
            (turn.sine.to_double_double(), turn.cosine.to_double_double())
        };
        let (mut value, mut slope) = (of(1.0), of(0.0));
        for n in 0..TERMS {
            let (sine, cosine) = turned((2 * n + 1) as f64);
            let size = power(nome, n * n).scale(sign(n));
            odd[n] = [(size * cosine).to_f64(), (size * sine).to_f64()];
            let m = n + 1;
            let (sine, cosine) = turned((2 * m) as f64);
            let size = power(nome, m * m - m).scale(sign(m));
            even[n] = [(size * cosine).to_f64(), (size * sine).to_f64()];
            let size = power(nome, m * m).scale(2.0 * sign(m));
            value += size * cosine;
            slope -= size * sine * of((2 * m) as f64);
        }
        let mut falling = rate * per_argument * slope / value;
        if lattice.quarter.is_finite() {
            falling += x * rate / lattice.quarter;
        }
        let linear = 2.0 * (x / DoubleDouble::PI).to_f64();
        Self { trigonometric: false, odd, even, middle: value.to_f64(), falling, linear }
    }

    /// Whether the nome itself is the small one.
    pub(super) fn is_trigonometric(&self) -> bool {
        self.trigonometric
    }

    /// ϑ₁ and ϑ₂, but for common factors.
    pub(super) fn at(&self, place: &Place) -> [Value; 2] {
        if self.trigonometric { self.trigonometric(place) } else { self.hyperbolic(place) }
    }

    fn trigonometric(&self, place: &Place) -> [Value; 2] {
        let [mut odd, mut even] = [Value { value: [0.0; 2], slope: [0.0; 2] }; 2];
        for n in (0..TERMS).rev() {
            let m = (2 * n + 1) as f64;
            let (sine, cosine) = sin_cos(m * place.angle);
            let [a, b] = self.odd[n];
            odd.add([a * sine, b * cosine], [a * m * cosine, -b * m * sine]);
            let [a, b] = self.even[n];
            even.add([a * cosine, b * sine], [-a * m * sine, b * m * cosine]);
        }
        [odd, even]
    }

    fn hyperbolic(&self, place: &Place) -> [Value; 2] {
        let Place { fall, less, ahead, back, .. } = *place;
        let mut odd = Value { value: [0.0; 2], slope: [0.0; 2] };
        let mut even = Value { value: [1.0, 0.0], slope: [0.0; 2] };
        // 1 − e^{−2jy} = (1 − e^{−2(j−1)y}) + e^{−2(j−1)y} (1 − e^{−2y}), a sum of positive terms.
        let (mut gap, mut left, mut high) = (less, fall, 1.0);
        for n in 0..TERMS {
            let m = (2 * n + 1) as f64;
            let [a, b] = self.odd[n].map(|part| part * high);
            let (apart, both) = (back * gap, 1.0 + left);
            odd.add([a * apart, b * both], [a * m * both, b * m * apart]);
            (gap, left) = (gap + left * less, left * fall);
            high *= ahead;
            let twice = m + 1.0;
            let [a, b] = self.even[n].map(|part| part * high);
            let (apart, both) = (back * gap, 1.0 + left);
            even.add([a * both, b * apart], [a * twice * apart, b * twice * both]);
            (gap, left) = (gap + left * less, left * fall);
        }
        [odd, even]
    }
}

impl Value {
    fn add(&mut self, value: Complex, slope: Complex) {
        for at in 0..2 {
            self.value[at] += value[at];
            self.slope[at] += slope[at];
        }
    }
}

/// Where r is, for both functions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) angle: f64,
    /// e^{−2|y|}, one less that, and q' e^{2|y|}.
    pub(super) fall: f64,
    less: f64,
    pub(super) ahead: f64,
    /// −1 where y is negative.
    back: f64,
}

impl Place {
    /// Of r, and y, where −ln q' is `whole`.
    pub(super) fn new(angle: f64, y: f64, whole: f64) -> Self {
        let twice = 2.0 * y.abs();
        let less =
            if twice < 0.5 { one_less_exp(of(twice)).to_f64() } else { 1.0 - Exponential::exp(-twice) };
        Self {
            angle,
            fall: Exponential::exp(-twice),
            less,
            ahead: Exponential::exp(twice - whole),
            back: if y < 0.0 { -1.0 } else { 1.0 },
        }
    }
}
