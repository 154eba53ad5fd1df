//! Laws of drag of one's own: a function or a table of F(R), as polynomials in pieces of the factor R F(R)/(6π).

use super::{AT_REST, DENSITY_PARAMETER, Law, ONE_WAY, RADIUS_PARAMETER, VISCOSITY_PARAMETER, spheres};
use crate::error::{Error, Result};
use crate::forces::term::ForceDeclaration;
use crate::potentials::Analytic;
use crate::potentials::fit::{Fit, Quantities, Sample, centered, fit};
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign};
use crate::potentials::piecewise_polynomial::{Polynomials, TERMS, check, polynomials};
use crate::potentials::tabulated::pieces;
use crate::words::number;
use core::f64::consts::PI;

/// How messages name what is sampled.
const QUANTITIES: Quantities = Quantities { argument: "R", size: "f + R |df/dR|, f = R F(R)/(6π)," };

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "sampled_drag",
    class_name: "SampledDrag",
    summary: "Drag of spheres in a fluid at rest by a law of one's own, as `visviva.drag.custom` and `tabulated` make it",
    formula: "F = −6π viscosity radius f(R) v with R = density radius |v| / viscosity, f = sum over k of \
              coefficients[14 i + k] t^k, with t from -1 to 1 between breaks[i] and breaks[i + 1]",
    notes: "f is drag over that of Stokes, R F(R)/(6π) if the force is F(R) density radius² v². Below the first of the breaks \
            f stays what it is there, so drag is linear; beyond the last there is no value: bodies as fast as that are \
            refused, and a run that comes there ends with `Status.OUTSIDE_DOMAIN`. It has no potential energy and conserves \
            nothing. A body that feels it must have mass.",
    source: "L. N. Trefethen, Approximation Theory and Approximation Practice (2013)",
    example: ">>> import math\n\
              >>> oseen = vv.drag.custom(lambda R: 6 * math.pi / R + 9 * math.pi / 4, R_min=1e-3, R_max=1.0, density=1.0, \
              viscosity=1.0, radius=1.0)\n\
              >>> type(oseen).__name__, oseen.error < 1e-12\n\
              ('SampledDrag', True)",
    at_rest: AT_REST,
    one_way: ONE_WAY,
    parameters: &[
        DENSITY_PARAMETER,
        VISCOSITY_PARAMETER,
        RADIUS_PARAMETER,
        Parameter::new(
            "breaks",
            Kind::Table(Sign::NotNegative),
            "Reynolds numbers, without dimension, where pieces meet, ascending",
        ),
        Parameter::new("coefficients", Kind::Table(Sign::Any), "Of f, 14 for each piece, without dimension"),
        Parameter::new(
            "error",
            Kind::Number(Sign::NotNegative),
            "The largest error that was found when it was made, relative to f + R |df/dR|",
        )
        .or(0.0),
    ],
    make: |values| match values {
        [density, viscosity, radius, breaks, coefficients, _] => {
            let breaks = breaks.table();
            check(breaks, coefficients.table())?;
            let law = Sampled { curve: polynomials(breaks, coefficients.table()) };
            law.refuse_driving(breaks)?;
            Ok(spheres(law, density.number(), viscosity.number(), radius.numbers()))
        }
        _ => Err(Error::Internal("SampledDrag takes six parameters".to_owned())),
    },
};

/// A law in pieces.
#[derive(Clone, Debug)]
struct Sampled {
    curve: Polynomials,
}

/// Points of every piece where drag must not drive.
const LOOKS: usize = 32;
/// Rows of a table at least: with fewer, a curvature would be a guess.
const LEAST: usize = 4;

impl Sampled {
    /// Refuses what would speed bodies up.
    fn refuse_driving(&self, breaks: &[f64]) -> Result<()> {
        for ends in breaks.windows(2) {
            for look in 0..=LOOKS {
                let share = look as f64 / LOOKS as f64;
                let reynolds = ends[0] * (1.0 - share) + ends[1] * share;
                let factor = self.factor(reynolds.min(ends[1]));
                if factor.is_nan() || factor < 0.0 {
                    let (factor, at) = (number(factor), number(reynolds));
                    let message =
                        format!("expected f of at least 0, as drag does not drive, got {factor} at R = {at}");
                    return Err(Error::invalid("coefficients", message));
                }
            }
        }
        Ok(())
    }
}

/// R F(R)/(6π), refused where drag would drive.
fn factor(argument: &str, reynolds: f64, law: f64) -> Result<f64> {
    if law < 0.0 {
        let (law, at) = (number(law), number(reynolds));
        let message = format!("expected F(R) of at least 0, as drag does not drive, got {law} at R = {at}");
        return Err(Error::invalid(argument, message));
    }
    Ok(reynolds * law / (6.0 * PI))
}

/// The pieces of a function F(R) between two Reynolds numbers, the first above 0.
///
/// # Errors
/// By name, as of [`fit`].
pub fn of_function(sample: &mut Sample<'_>, range: [f64; 2], tolerance: f64) -> Result<Fit> {
    let [low, _] = range;
    if low.is_nan() || low <= 0.0 {
        return Err(Error::invalid("R_min", format!("expected a number above 0, got {}", number(low))));
    }
    let mut factors = |reynolds: &[f64]| -> Result<Vec<f64>> {
        let values = sample(reynolds)?;
        reynolds.iter().zip(values).map(|(&reynolds, law)| factor("function", reynolds, law)).collect()
    };
    fit(&mut factors, range, tolerance, QUANTITIES)
}

/// The pieces of a table of F(R): where it and its factor rise, or fall, so do they.
///
/// # Errors
/// By name.
pub fn of_table(reynolds: &[f64], law: &[f64]) -> Result<Fit> {
    if reynolds.len() < LEAST {
        return Err(Error::invalid(
            "R",
            format!("expected at least {LEAST} numbers, got {}", reynolds.len()),
        ));
    }
    if law.len() != reynolds.len() {
        let message = format!("expected as many as in R, {}, got {}", reynolds.len(), law.len());
        return Err(Error::invalid("F", message));
    }
    let fine = |pair: &[f64]| pair[0] > 0.0 && pair[1] > pair[0] && (2.0 / (pair[1] - pair[0])).is_finite();
    if let Some(at) = reynolds.windows(2).position(|pair| !fine(pair)) {
        let (here, next) = (number(reynolds[at]), number(reynolds[at + 1]));
        let message = format!("expected ascending numbers above 0, got {here} and then {next}");
        return Err(Error::invalid("R", message));
    }
    let factors: Vec<f64> = reynolds
        .iter()
        .zip(law)
        .map(|(&reynolds, &law)| factor("F", reynolds, law))
        .collect::<Result<_>>()?;
    let rows = pieces(reynolds, &factors, false);
    let own = rows[..reynolds.len() - 1].iter().map(|row| {
        let [_, _, a, b, c, d, e, f] = *row;
        centered([0.0; TERMS], [a, b, c, d, e, f])
    });
    Ok(Fit { breaks: reynolds.to_vec(), coefficients: own.collect::<Vec<_>>().concat(), error: 0.0 })
}

impl Law for Sampled {
    const DECLARATION: &'static ForceDeclaration = &DECLARATION;

    fn last(&self) -> f64 {
        self.curve.domain().1
    }
    #[inline(always)]
    fn factor<S: Analytic>(&self, reynolds: S) -> S {
        let first = S::splat(self.curve.domain().0);
        self.curve.derivative(S::select(reynolds.less_equal(first), first, reynolds), 0)
    }
}
