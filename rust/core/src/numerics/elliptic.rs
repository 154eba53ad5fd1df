//! Elliptic integrals in double-double, from square roots of arguments that may be as small as a number can be.
//!
//! The one idea: nothing is formed by subtraction, and every loop has an end. The arithmetic-geometric mean gives the
//! complete integral of the first kind, Carlson's duplication the incomplete ones.
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

/// Carlson's R_D(x², y², z²) of the roots x, y, z > 0, the last of which counts thrice.
pub fn symmetric_second_kind(roots: [DoubleDouble; 3]) -> DoubleDouble {
    let mut roots = roots;
    let mut squares = roots.map(|root| root * root);
    let (mut sum, mut quarter) = (of(0.0), 1.0);
    let fifth =
        |squares: [DoubleDouble; 3]| (squares[0] + squares[1] + squares[2].scale(2.0) + squares[2]) / of(5.0);
    for _ in 0..MOST_STEPS {
        let [x, y, z] = roots;
        let step = x * y + y * z + z * x;
        sum += of(quarter) / (z * (squares[2] + step));
        quarter *= 0.25;
        squares = squares.map(|square| (square + step).scale(0.25));
        roots = squares.map(DoubleDouble::sqrt);
        let mean = fifth(squares).high();
        // The series below leaves out an eighth power.
        if squares.iter().all(|square| (square.high() - mean).abs() <= 4e-5 * mean) {
            break;
        }
    }
    let mean = fifth(squares);
    let [x, y] = [squares[0], squares[1]].map(|square| (mean - square) / mean);
    let z = -(x + y) / of(3.0);
    let (xy, zz) = (x * y, z * z);
    let e2 = xy - zz * of(6.0);
    let e3 = (xy.scale(3.0) - zz.scale(8.0)) * z;
    let e4 = (xy - zz).scale(3.0) * zz;
    let e5 = xy * zz * z;
    let series = of(1.0) - e2.scale(3.0) / of(14.0) + e3 / of(6.0) + (e2 * e2) * of(9.0) / of(88.0)
        - e4.scale(3.0) / of(22.0)
        - (e2 * e3) * of(9.0) / of(52.0)
        + e5.scale(3.0) / of(26.0)
        - (e2 * e2 * e2).scale(0.0625)
        + (e3 * e3) * of(3.0) / of(40.0)
        + (e2 * e4) * of(3.0) / of(20.0)
        + (e2 * e2 * e3) * of(45.0) / of(272.0)
        - (e3 * e4 + e2 * e5) * of(9.0) / of(68.0);
    sum * of(3.0) + series.scale(quarter) / (mean * mean.sqrt())
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
    fn integrals_of_the_second_kind() {
        // mpmath, 45 digits; roots as far apart as the shells of ellipsoids have them.
        let known = [
            ([1.0, 2.0, 3.0], 0.078_150_349_414_635_49, 5.591_107_141_702_455e-18),
            ([1e-3, 1.0, 1.0], 2.353_198_020_488_493_5, -1.821_955_930_544_010_3e-16),
            ([1.0, 1.0, 1e-30], 3e30, -28_188_159_628_074.65),
            ([1e-60, 1.0, 0.5], 10.750_833_851_096_779, 5.403_224_451_727_672e-16),
        ];
        for (roots, high, low) in known {
            let off = symmetric_second_kind(roots.map(of)) / DoubleDouble::new(high, low) - of(1.0);
            assert!(off.to_f64().abs() < 1e-29, "{roots:?}: {:e}", off.to_f64());
        }
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
