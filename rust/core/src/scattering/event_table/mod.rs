//! The deflections of one energy over a disc of impact parameters, as a table that was checked where it was not made.
//!
//! The one idea: the *ratio* of ψ to the deflection 2 atan(κ/b) of a Coulomb center with the same slope head-on is
//! smooth and tends to a constant at both ends, so a few dozen polynomials in b hold ten digits of it. Where it is not
//! smooth (orbiting, edges of V, the end of capture) intervals of b are halved until what is left is below 2⁻²⁶ of the
//! disc's radius. ψ is kept as it is, signed and not folded: rainbows, glories and whole turns need nothing more.
//!
//! Built from [`Deflector`], whose bits depend on nothing but potential, energy and impact parameter; evaluated by
//! arithmetic that is the same everywhere. So are a table's bits and its [`hash`](EventTable::hash).
//! Source: W. Press et al., *Numerical Recipes*, §5.8 (Chebyshev series, Clenshaw's recurrence).

mod abreast;
mod build;
mod energies;

use crate::numerics::angles::atan2;
use build::Built;

pub use abreast::{BINS, EnergiesAbreast, TableAbreast};
pub use build::{MOST_ERROR, TOLERANCE};
pub use energies::Energies;

/// Coefficients of a piece. Beside a logarithm, where ψ orbits, an interval as long as its distance takes twelve for 1e-9.
const DEGREE: usize = 12;

/// What is known of one interval of b.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    /// Chebyshev coefficients of the ratio.
    Series([f64; DEGREE]),
    /// Whoever comes here is captured.
    Captured,
}

/// The deflections of one energy, b from 0 to b_max.
#[derive(Clone, Debug, PartialEq)]
pub struct EventTable {
    b_max: f64,
    /// κ/b_max of the Coulomb center that it is compared with.
    scale: f64,
    /// Where pieces begin, and the end, as parts of b_max.
    starts: Vec<f64>,
    pieces: Vec<Piece>,
    error: f64,
    unresolved: f64,
}

impl EventTable {
    /// ψ where b is this part of b_max, signed and not folded; `None` if captured.
    pub fn angle(&self, part: f64) -> Option<f64> {
        let piece = self.starts.partition_point(|start| *start <= part).clamp(1, self.pieces.len()) - 1;
        let (from, to) = (self.starts[piece], self.starts[piece + 1]);
        match &self.pieces[piece] {
            Piece::Captured => None,
            Piece::Series(series) => {
                let x = (2.0 * (part - from) / (to - from) - 1.0).clamp(-1.0, 1.0);
                Some(clenshaw(series, x) * reference(self.scale, part))
            }
        }
    }
    /// Where its pieces begin, and the end: parts of b_max, increasing.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }
    /// The largest difference of sin²(ψ/2) from direct quadrature, of all points that were tried.
    pub fn error(&self) -> f64 {
        self.error
    }
    /// The part of the disc's area that lies so near to orbiting or an edge that ψ is not resolved there.
    pub fn unresolved(&self) -> f64 {
        self.unresolved
    }
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        self.starts.len() * size_of::<f64>() + self.pieces.len() * size_of::<Piece>()
    }
    /// A number that tables of other content do not share but by chance: FNV-1a of all their numbers.
    pub fn hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut take = |number: f64| {
            for byte in number.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        take(self.b_max);
        take(self.scale);
        self.starts.iter().copied().for_each(&mut take);
        for piece in &self.pieces {
            match piece {
                Piece::Captured => take(f64::NAN),
                Piece::Series(series) => series.iter().copied().for_each(&mut take),
            }
        }
        hash
    }
}

/// The deflection that ratios are to.
fn reference(scale: f64, part: f64) -> f64 {
    2.0 * atan2(scale, part)
}

/// A Chebyshev series at −1 ≤ x ≤ 1.
fn clenshaw(series: &[f64; DEGREE], x: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in series[1..].iter().rev() {
        (next, after) = (2.0 * x * next - after + coefficient, next);
    }
    x * next - after + series[0]
}

impl From<Built> for EventTable {
    fn from(built: Built) -> Self {
        let Built { b_max, scale, starts, pieces, error, unresolved } = built;
        Self { b_max, scale, starts, pieces, error, unresolved }
    }
}

#[cfg(test)]
mod tests;
