//! V(r) of polynomials in pieces: what `Custom` makes of a function.

use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::piecewise::Piecewise;
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};
use crate::error::{Error, Result};
use crate::words::number;

/// Coefficients of each piece.
pub(crate) const TERMS: usize = 14;

/// Polynomials between breaks, in a variable that goes from −1 to 1 in each piece.
pub(crate) type Polynomials = Piecewise<{ TERMS + 2 }>;

/// Polynomials in pieces.
#[derive(Clone, Debug)]
pub struct PiecewisePolynomial {
    curve: Polynomials,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "piecewise_polynomial",
    class_name: "PiecewisePolynomial",
    summary: "Polynomials in pieces, as Custom makes them of a function",
    formula: "V(r) = sum over k of coefficients[14 i + k] t^k, with t from -1 to 1 between breaks[i] and breaks[i + 1]",
    notes: "What Custom makes has continuous first and second derivatives; of pieces of your own see to it. Beyond the \
            breaks there is no value: asking for one is refused, and a run that comes there ends with \
            `Status.OUTSIDE_DOMAIN`.",
    source: "L. N. Trefethen, Approximation Theory and Approximation Practice (2013)",
    example: ">>> import numpy as np\n\
              >>> well = vv.potentials.Custom(lambda r: (r - 2.0) ** 2, r_min=1.0, r_max=3.0)\n\
              >>> type(well).__name__, round(float(well.value(2.5)), 12), round(float(well.force(2.5)), 12)\n\
              ('PiecewisePolynomial', 0.25, -1.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("breaks", Kind::Table(Sign::NotNegative), "Distances where pieces meet, ascending")
            .of([1, 0, 0]),
        Parameter::new("coefficients", Kind::Table(Sign::Any), "Energies, 14 for each piece").of([2, 1, -2]),
        Parameter::new(
            "error",
            Kind::Number(Sign::NotNegative),
            "The largest error that was found when it was made, relative to |V| + r |dV/dr|",
        )
        .or(0.0),
    ],
    make: |values| {
        check(values[0].table(), values[1].table())?;
        held::<PiecewisePolynomial>(values)
    },
};

/// Refuses what are no pieces.
///
/// # Errors
/// By name.
pub(crate) fn check(breaks: &[f64], coefficients: &[f64]) -> Result<()> {
    if breaks.len() < 2 {
        return Err(Error::invalid("breaks", format!("expected at least 2, got {}", breaks.len())));
    }
    let fine = |pair: &[f64]| pair[1] > pair[0] && (2.0 / (pair[1] - pair[0])).is_finite();
    if let Some(at) = breaks.windows(2).position(|pair| !fine(pair)) {
        let (here, next) = (number(breaks[at]), number(breaks[at + 1]));
        let message = format!("expected ascending numbers, got {here} and then {next}");
        return Err(Error::invalid("breaks", message));
    }
    let expected = TERMS * (breaks.len() - 1);
    if coefficients.len() != expected {
        let message = format!("expected {TERMS} for each piece, {expected}, got {}", coefficients.len());
        return Err(Error::invalid("coefficients", message));
    }
    Ok(())
}

/// From what was checked.
pub(crate) fn polynomials(breaks: &[f64], coefficients: &[f64]) -> Polynomials {
    let row = |(ends, own): (&[f64], &[f64])| {
        let mut row = [0.0; TERMS + 2];
        (row[0], row[1]) = (0.5 * (ends[0] + ends[1]), 2.0 / (ends[1] - ends[0]));
        row[2..].copy_from_slice(own);
        row
    };
    let rows: Vec<_> = breaks.windows(2).zip(coefficients.chunks_exact(TERMS)).map(row).collect();
    let (last, starts) = breaks.split_last().map_or((0.0, &[][..]), |(last, starts)| (*last, starts));
    Piecewise::new(starts.to_vec(), last, rows)
}

impl Formula for PiecewisePolynomial {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    fn new(values: &[Value]) -> Self {
        Self { curve: polynomials(values[0].table(), values[1].table()) }
    }
    fn domain(&self) -> Option<(f64, f64)> {
        Some(self.curve.domain())
    }
    fn breaks(&self) -> Vec<f64> {
        [self.curve.starts(), &[self.curve.domain().1]].concat()
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, _: &Numbers<S>, r: S) -> S {
        self.curve.derivative(r, 0)
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, _: &Numbers<S>, r: S) -> S {
        -self.curve.derivative(r, 1)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, _: &Numbers<S>, r: S) -> S {
        self.curve.derivative(r, 2)
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, _: &Numbers<S>, r: S) -> [S; 3] {
        let [value, slope, bend] = self.curve.derivatives(r);
        [value, -slope, bend]
    }
}
