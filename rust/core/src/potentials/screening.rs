//! Screening functions φ(x) of x = r/length: what of a nucleus' charge is left at a distance.
//!
//! Each gives three numbers at once, φ, −x φ′ and x² φ″, which are finite at x = 0, where φ″ of some is not.
//!
//! - ZBL: J. F. Ziegler, J. P. Biersack, U. Littmark, *The Stopping and Range of Ions in Solids* (1985). Of the roundings
//!   in print the one whose amplitudes have the sum 1.
//! - Molière: Z. Naturforsch. A 2 (1947) 133.
//! - Kr–C: W. D. Wilson, L. G. Haggmark, J. P. Biersack, Phys. Rev. B 15 (1977) 2458.
//! - Lenz–Jensen: W. Lenz, Z. Phys. 77 (1932) 713, H. Jensen, Z. Phys. 77 (1932) 722: e^−y (1 + y + 0.3344 y² +
//!   0.0485 y³ + 0.002647 y⁴), y = √(9.67 x). The sum of three exponentials that goes by this name is a fit of it, whose
//!   amplitudes sum to 1.00008 and whose slope at 0 is half as steep.
//! - Thomas–Fermi: φ″ = φ^(3/2)/√x, by [`thomas_fermi`](super::thomas_fermi).

use super::Analytic;
use super::thomas_fermi::ThomasFermi;
use crate::error::Result;
use crate::numerics::elementary::cbrt;
use crate::numerics::power::{Power, Powers};
use crate::numerics::real::Mask;
use crate::words::unknown;

/// Amplitudes and rates of a sum of exponentials.
type Terms<const N: usize> = [[f64; 2]; N];

static ZBL: Terms<4> = [[0.18175, 3.1998], [0.50986, 0.94229], [0.28022, 0.40290], [0.02817, 0.20162]];
static MOLIERE: Terms<3> = [[0.35, 0.3], [0.55, 1.2], [0.10, 6.0]];
static KR_C: Terms<3> = [[0.190945, 0.278544], [0.473674, 0.637174], [0.335381, 1.919249]];
/// The factor of x and the coefficients of y², y³, y⁴.
const LENZ_JENSEN: [f64; 4] = [9.67, 0.3344, 0.0485, 0.002647];

/// The words for them; the first is the default.
pub(super) static NAMES: [&str; 5] = ["zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi"];

/// Beyond this nothing is left, and no power of it leaves the range.
const FAR: f64 = 1e40;

/// From these x on the first two terms of the universal function are less than 1e-18 of
/// the others, derivatives too.
const FADED: [f64; 2] = [17.0, 68.0];

/// A screening function.
#[derive(Clone, Debug)]
pub(super) enum Screening {
    Four(&'static Terms<4>),
    Three(&'static Terms<3>),
    LenzJensen,
    ThomasFermi(Box<ThomasFermi>),
}

/// The screening length between two nuclei, in Bohr radii: (9π²/128)^(1/3) over Z₁^0.23 + Z₂^0.23 for ZBL (where 0.8854 is
/// printed for the front), over (√Z₁ + √Z₂)^(2/3) for the others (O. B. Firsov, Sov. Phys. JETP 6 (1958) 534).
///
/// # Errors
/// An unknown name.
pub fn screening_length(name: &str, numbers: [f64; 2]) -> Result<f64> {
    if !NAMES.contains(&name) {
        return Err(unknown("screening", name, NAMES.iter().copied()));
    }
    let sum = |exponent: f64| numbers.iter().map(|z| z.power(&Power::new(exponent))).sum::<f64>();
    let front = cbrt(9.0 * core::f64::consts::PI * core::f64::consts::PI / 128.0);
    Ok(front / if name == "zbl" { sum(0.23) } else { sum(0.5).power(&Power::new(2.0 / 3.0)) })
}

impl Screening {
    pub(super) fn of(name: &str) -> Self {
        match name {
            "moliere" => Self::Three(&MOLIERE),
            "kr_c" => Self::Three(&KR_C),
            "lenz_jensen" => Self::LenzJensen,
            "thomas_fermi" => Self::ThomasFermi(Box::new(ThomasFermi::new())),
            _ => Self::Four(&ZBL),
        }
    }

    /// φ, φ − x φ′ and 2φ − 2x φ′ + x² φ″, with the bits of each by itself.
    #[inline(always)]
    pub(super) fn all<S: Analytic>(&self, x: S) -> [S; 3] {
        let [value, slope, bend] = match self {
            Self::Four(terms) => return fading(terms, x, [0, 1, 2]),
            Self::Three(terms) => return exponentials(terms, x, [0, 1, 2]),
            Self::LenzJensen => lenz_jensen(x),
            Self::ThomasFermi(function) => function.all(x),
        };
        [value, value + slope, S::splat(2.0) * (value + slope) + bend]
    }
    /// φ.
    #[inline(always)]
    pub(super) fn value<S: Analytic>(&self, x: S) -> S {
        match self {
            Self::Four(terms) => fading(terms, x, [0])[0],
            Self::Three(terms) => exponentials(terms, x, [0])[0],
            Self::LenzJensen => lenz_jensen(x)[0],
            Self::ThomasFermi(function) => function.all(x)[0],
        }
    }
    /// φ − x φ′.
    #[inline(always)]
    pub(super) fn with_slope<S: Analytic>(&self, x: S) -> S {
        match self {
            Self::Four(terms) => fading(terms, x, [1])[0],
            Self::Three(terms) => exponentials(terms, x, [1])[0],
            Self::LenzJensen => {
                let [value, slope, _] = lenz_jensen(x);
                value + slope
            }
            Self::ThomasFermi(function) => {
                let [value, slope, _] = function.all(x);
                value + slope
            }
        }
    }
    /// 2φ − 2x φ′ + x² φ″.
    #[inline(always)]
    pub(super) fn with_bend<S: Analytic>(&self, x: S) -> S {
        let two = S::splat(2.0);
        match self {
            Self::Four(terms) => fading(terms, x, [2])[0],
            Self::Three(terms) => exponentials(terms, x, [2])[0],
            Self::LenzJensen => {
                let [value, slope, bend] = lenz_jensen(x);
                two * (value + slope) + bend
            }
            Self::ThomasFermi(function) => {
                let [value, slope, bend] = function.all(x);
                two * (value + slope) + bend
            }
        }
    }
}

/// Σ aᵢ e^−u wᵢ, u = x times the rate, of φ and of what its first and second derivative make: w = 1, 1 + u, 2 + 2u + u².
#[inline(always)]
fn exponentials<S: Analytic, const N: usize, const M: usize>(
    terms: &Terms<N>,
    x: S,
    orders: [usize; M],
) -> [S; M] {
    let x = S::select(x.less_equal(S::splat(FAR)), x, S::splat(FAR));
    sums(terms, x, orders, [f64::INFINITY; N])
}

/// As [`exponentials`], of four of which the first two fade before the others.
#[inline(always)]
fn fading<S: Analytic, const M: usize>(terms: &Terms<4>, x: S, orders: [usize; M]) -> [S; M] {
    let x = S::select(x.less_equal(S::splat(FAR)), x, S::splat(FAR));
    let [_, b, c, d] = *terms;
    let [first, second] = FADED;
    // A lane's bits do not depend on the others: what has faded is nothing in either way.
    if x.less_equal(S::splat(first)).any() {
        sums(terms, x, orders, [first, second, f64::INFINITY, f64::INFINITY])
    } else if x.less_equal(S::splat(second)).any() {
        sums(&[b, c, d], x, orders, [second, f64::INFINITY, f64::INFINITY])
    } else {
        sums(&[c, d], x, orders, [f64::INFINITY; 2])
    }
}

/// Of terms up to their last x.
#[inline(always)]
fn sums<S: Analytic, const N: usize, const M: usize>(
    terms: &Terms<N>,
    x: S,
    orders: [usize; M],
    last: [f64; N],
) -> [S; M] {
    let mut u = [x; N];
    for i in 0..N {
        u[i] = x * S::splat(terms[i][1]);
    }
    let falling = S::falling_exps(u);
    let mut sums = [S::zero(); M];
    for i in 0..N {
        let mut decay = falling[i];
        if last[i] < f64::INFINITY {
            decay = S::select(x.less_equal(S::splat(last[i])), decay, S::zero());
        }
        for m in 0..M {
            sums[m] = decay.multiply_add(weight(u[i], terms[i][0], orders[m]), sums[m]);
        }
    }
    sums
}

#[inline(always)]
fn weight<S: Analytic>(u: S, amplitude: f64, order: usize) -> S {
    let amplitude = S::splat(amplitude);
    match order {
        0 => amplitude,
        1 => u.multiply_add(amplitude, amplitude),
        _ => amplitude * u.multiply_add(u + S::splat(2.0), S::splat(2.0)),
    }
}

/// φ, −x φ′ and x² φ″ of Lenz and Jensen. With φ = e^−y P: dφ/dx = (9.67/2) e^−y Q, Q = (P′ − P)/y.
#[inline(always)]
fn lenz_jensen<S: Analytic>(x: S) -> [S; 3] {
    let [factor, b, c, d] = LENZ_JENSEN;
    let y = (x * S::splat(factor)).min(S::splat(FAR)).sqrt();
    let decay = (-y).exp();
    let p = S::one() + y * (S::one() + y * (S::splat(b) + y * (S::splat(c) + y * S::splat(d))));
    let q = [2.0 * b - 1.0, 3.0 * c - b, 4.0 * d - c, -d];
    let whole = S::splat(q[0]) + y * (S::splat(q[1]) + y * (S::splat(q[2]) + y * S::splat(q[3])));
    let rate = S::splat(q[1]) + y * (S::splat(2.0 * q[2]) + y * S::splat(3.0 * q[3]));
    let square = y * y;
    [decay * p, S::splat(-0.5) * square * decay * whole, S::splat(0.25) * square * y * decay * (rate - whole)]
}
