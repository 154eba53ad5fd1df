//! Recurrences: what operations on series are, and where what they read and write lies.
//!
//! The one idea: that all places are there is seen once, when the recurrences are made, so what [expands](super::expansion) them
//! need not look again.

use super::ORDERS;

/// Where a series begins, or a constant lies.
pub(super) type Place = usize;

/// An operation on series. `to` is where its result begins.
#[derive(Clone, Debug)]
pub(super) enum Recurrence {
    /// A number.
    Constant { to: Place, value: f64 },
    /// c₀ + Σ c x + Σ c a b.
    Sum {
        /// Where it goes.
        to: Place,
        /// c₀.
        constant: f64,
        /// Factors and series, then factors and constants.
        terms: [Vec<(f64, Place)>; 2],
        /// Products of two series, of a constant and a series, and of two constants.
        products: [Vec<(f64, Place, Place)>; 3],
        /// What the products of two series come to but for their outermost coefficients: those alike in one.
        inner: Vec<(f64, Place, Place)>,
    },
    /// A product of two series.
    Product { to: Place, a: Place, b: Place },
    /// A constant times a series.
    Multiple { to: Place, constant: Place, of: Place },
    /// A quotient of two series.
    Quotient { to: Place, a: Place, b: Place },
    /// A constant over a series.
    Over { to: Place, constant: Place, b: Place },
    /// A series over a constant.
    Part { to: Place, a: Place, constant: Place },
    /// A number over a series.
    Reciprocal { to: Place, value: f64, b: Place },
    /// j times the j-th coefficient: a derivative, one order higher.
    Slopes { to: Place, of: Place },
    /// Sine and cosine; `slopes` are those of their argument.
    SineCosine { sine: Place, cosine: Place, of: Place, slopes: Place },
    /// A function, by its word, of a series with these slopes, whose derivative is `rate`.
    Integral { to: Place, word: u16, of: Place, slopes: Place, rate: Place },
    /// The angle of a point: its derivative has a part for y and takes away one for x, each the slopes of what varies and
    /// what they come with.
    Angle { to: Place, y: Place, x: Place, parts: [Option<(Place, Place)>; 2] },
    /// A square root.
    Root { to: Place, a: Place },
    /// A power; `slopes` are those of its base and its own.
    Power { to: Place, a: Place, exponent: f64, slopes: [Place; 2] },
    /// A symmetric linear system, its lower triangle row by row; `triangle` is where it is kept factored.
    Solve { matrix: Vec<Entry>, right: Vec<Entry>, to: Vec<Place>, triangle: usize, inner: usize },
    /// A function of constants, by the operation itself.
    Call { to: Place, word: u16, of: Place },
    /// Sine and cosine of a constant.
    Turn { sine: Place, cosine: Place, of: Place },
    /// A power of a constant.
    Raised { to: Place, a: Place, exponent: f64 },
    /// The angle of a constant point.
    Direction { to: Place, y: Place, x: Place },
    /// A quotient of constants.
    Divided { to: Place, a: Place, b: Place },
    /// A product of constants.
    Times { to: Place, a: Place, b: Place },
    /// A number over a constant.
    Inverse { to: Place, value: f64, constant: Place },
}

/// A number of a linear system, and whether it is a series.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) place: Place,
    pub(super) varies: bool,
}

/// Recurrences whose places were seen to be among so many numbers.
#[derive(Clone, Debug)]
pub struct Recurrences {
    pub(super) all: Vec<Recurrence>,
    pub(super) numbers: usize,
    /// Whether what they make are series, and not constants.
    pub(super) vary: bool,
}

impl Recurrences {
    /// Of so many numbers.
    ///
    /// # Panics
    /// If one lies beyond them.
    pub(super) fn new(all: Vec<Recurrence>, numbers: usize, vary: bool) -> Self {
        assert!(
            all.iter().all(|recurrence| recurrence.is_within(numbers, vary)),
            "a place beyond all numbers"
        );
        Self { all, numbers, vary }
    }
}

impl Recurrence {
    /// Whether all that it reads and writes lies among so many numbers.
    fn is_within(&self, numbers: usize, vary: bool) -> bool {
        let series = |places: &[Place]| places.iter().all(|place| place + ORDERS <= numbers);
        let constants = |places: &[Place]| places.iter().all(|&place| place < numbers);
        let made = |places: &[Place]| if vary { series(places) } else { constants(places) };
        let entry = |entry: &Entry| entry.place + if entry.varies { ORDERS } else { 1 } <= numbers;
        match *self {
            Self::Constant { to, .. } => constants(&[to]),
            Self::Sum { to, terms: [ref of_series, ref of_constants], ref products, ref inner, .. } => {
                let [of_both, mixed, of_neither] = products;
                made(&[to])
                    && of_series.iter().all(|&(_, x)| series(&[x]))
                    && of_constants.iter().all(|&(_, x)| constants(&[x]))
                    && of_both.iter().chain(inner).all(|&(_, a, b)| series(&[a, b]))
                    && mixed.iter().all(|&(_, a, b)| constants(&[a]) && series(&[b]))
                    && of_neither.iter().all(|&(_, a, b)| constants(&[a, b]))
            }
            Self::Product { to, a, b } | Self::Quotient { to, a, b } => series(&[to, a, b]),
            Self::Multiple { to, constant, of: b }
            | Self::Over { to, constant, b }
            | Self::Part { to, a: b, constant } => series(&[to, b]) && constants(&[constant]),
            Self::Reciprocal { to, b, .. } | Self::Slopes { to, of: b } | Self::Root { to, a: b } => {
                series(&[to, b])
            }
            Self::SineCosine { sine, cosine, of, slopes } => series(&[sine, cosine, of, slopes]),
            Self::Integral { to, of, slopes, rate, .. } => series(&[to, of, slopes, rate]),
            Self::Angle { to, y, x, parts: [of_y, of_x] } => {
                let part =
                    |part: Option<(Place, Place)>| part.is_none_or(|(slopes, rate)| series(&[slopes, rate]));
                series(&[to]) && constants(&[y, x]) && part(of_y) && part(of_x)
            }
            Self::Power { to, a, slopes: [of_base, own], .. } => series(&[to, a, of_base, own]),
            Self::Solve { ref matrix, ref right, ref to, .. } => {
                matrix.iter().chain(right).all(entry) && made(to)
            }
            Self::Call { to, of, .. } => constants(&[to, of]),
            Self::Turn { sine, cosine, of } => constants(&[sine, cosine, of]),
            Self::Raised { to, a, .. } | Self::Inverse { to, constant: a, .. } => constants(&[to, a]),
            Self::Direction { to, y: a, x: b } | Self::Divided { to, a, b } | Self::Times { to, a, b } => {
                constants(&[to, a, b])
            }
        }
    }
}
