//! Elliptic integrals in double-double, from square roots of arguments that may be as small as a number can be.
//!
//! The one idea: nothing is formed by subtraction, and every loop has an end. The arithmetic-geometric mean gives the
//! complete integral of the first kind, Carlson's duplication the incomplete one.
//! Source: Carlson, Numer. Algorithms 10 (1995) 13; DLMF 19.8, 19.36.

use super::double_double::DoubleDouble;
use super::real::Real;

/// Each step squares what is left; 2000 powers of two apart take 12 steps before that begins.
const MOST_STEPS: usize = 40;

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

/// The arithmetic-geometric mean of two numbers that are not negative.
pub fn arithmetic_geometric_mean(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    let (mut a, mut b) = (a, b);
    for _ in 0..MOST_STEPS {
        let apart = (a - b).abs();
        (a, b) = ((a + b).scale(0.5), (a * b).sqrt());
        // The next difference is apart²/8a.
        if apart.high() <= 1e-17 * a.high() {
            break;
        }
    }
    a
}

/// K of the modulus whose complement is k': π/2 over the mean of 1 and k'. Infinite where k' = 0.
pub fn complete_first_kind(complement: DoubleDouble) -> DoubleDouble {
    if complement.high() == 0.0 {
        return of(f64::INFINITY);
    }
    DoubleDouble::PI.scale(0.5) / arithmetic_geometric_mean(of(1.0), complement)
}

/// Carlson's R_F(x², y², z²) of the roots x, y, z, at most one of them zero.
pub fn symmetric_first_kind(roots: [DoubleDouble; 3]) -> DoubleDouble {
    let mut roots = roots;
    let mut squares = roots.map(|root| root * root);
    for _ in 0..MOST_STEPS {
        let [x, y, z] = roots;
        let step = x * y + y * z + z * x;
        squares = squares.map(|square| (square + step).scale(0.25));
        roots = squares.map(DoubleDouble::sqrt);
        let mean = (squares[0] + squares[1] + squares[2]).high() / 3.0;
        // The series below leaves out an eighth power.
        if squares.iter().all(|square| (square.high() - mean).abs() <= 4e-5 * mean) {
            break;
        }
    }
    let mean = (squares[0] + squares[1] + squares[2]) / of(3.0);
    let [x, y] = [squares[0], squares[1]].map(|square| (mean - square) / mean);
    let z = -(x + y);
    let (e2, e3) = (x * y - z * z, x * y * z);
    let series = of(1.0) - e2 / of(10.0) + e3 / of(14.0) + e2 * e2 / of(24.0)
        - (e2 * e3).scale(3.0) / of(44.0)
        - (e2 * e2 * e2) * of(5.0) / of(208.0)
        + (e3 * e3) * of(3.0) / of(104.0)
        + (e2 * e2 * e3).scale(0.0625);
    series / mean.sqrt()
}

/// F of the angle with this sine and cosine ≥ 0, where `delta` is √(1 − k² sin²) and not all of them may be zero.
pub fn incomplete_first_kind(sine: DoubleDouble, cosine: DoubleDouble, delta: DoubleDouble) -> DoubleDouble {
    sine * symmetric_first_kind([cosine, delta, of(1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complete_integrals() {
        // mpmath, 34 digits: K(k² = 1/2), and K(k' = 1e-100) = ln(4/k') to 1e-198.
        let k = complete_first_kind(of(0.5).sqrt());
        let known = DoubleDouble::new(1.854_074_677_301_371_9, 4.220_810_632_962_078_7e-17);
        assert!((k - known).to_f64().abs() < 1e-31, "{:?}", (k - known).parts());
        let far = complete_first_kind(of(1e-100)).to_f64();
        assert!((far - 231.644_803_660_524_46).abs() < 1e-13, "{far}");
        assert!(complete_first_kind(of(0.0)).to_f64().is_infinite());
        assert!(complete_first_kind(of(5e-324)).to_f64() > 745.0);
    }

    #[test]
    fn incomplete_integrals_reach_the_complete_one() {
        for complement in [0.9, 0.5, 1e-3, 1e-9, 1e-150, 1e-300] {
            let whole = incomplete_first_kind(of(1.0), of(0.0), of(complement));
            let mean = complete_first_kind(of(complement));
            let off = ((whole - mean) / mean).to_f64().abs();
            // Below 1e-150 the low parts of products run out of range.
            assert!(off < if complement < 1e-100 { 1e-16 } else { 1e-30 }, "{complement}: {off:e}");
        }
        // k = 0: the angle itself; k = 1: the inverse of the Gudermannian, asinh(tan) = ln 3 at tan = 4/3.
        let angle = incomplete_first_kind(of(0.5), of(0.75).sqrt(), of(1.0));
        assert!((angle - DoubleDouble::PI / of(6.0)).to_f64().abs() < 1e-31);
        let fifths = [of(4.0) / of(5.0), of(3.0) / of(5.0)];
        let ln3 = incomplete_first_kind(fifths[0], fifths[1], fifths[1]);
        let known = DoubleDouble::new(1.098_612_288_668_109_8, -9.071_297_235_001_53e-17);
        assert!((ln3 - known).to_f64().abs() < 1e-30, "{:?}", ln3.parts());
    }
}
