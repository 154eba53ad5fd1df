//! V(r) of a table: monotone where the table is, twice continuously differentiable.

use super::hermite::{bends, quintic};
use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::piecewise::Piecewise;
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};
use crate::error::{Error, Result};
use crate::numerics::power_of_two::{exponent, scale};
use crate::units::Units;
use crate::words::number;

/// Points of a table at least: with fewer, a curvature would be a guess.
const LEAST: usize = 4;

/// Where V falls over an interval to less than this part of itself, its second half is told from its end.
const FALLS: f64 = 1.0 / 64.0;

/// A table and its curve.
#[derive(Clone, Debug)]
pub struct Tabulated {
    curve: Piecewise<8>,
    /// The distances of the table, where its pieces meet.
    places: Vec<f64>,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "tabulated",
    class_name: "Tabulated",
    summary: "The potential energy of a table",
    formula: "V(r) = a quintic in each interval, through V[i] at r[i], with continuous force and curvature",
    notes: "Where the table rises, or falls, over four points in a row, so does V(r) between the middle two, but for \
            rounding; beside an extremum of the table it may turn once between two points, no farther beyond the two \
            values than half of what neighbors differ by. The force is the derivative of V(r). Where the table is \
            smooth the error falls as the fourth power of the spacing or faster. Beyond the table there is no value: \
            asking for one is refused, and a run that leaves it ends with `Status.OUTSIDE_DOMAIN`.",
    source: "R. L. Dougherty, A. Edelman, J. M. Hyman, Math. Comp. 52 (1989) 471",
    example: ">>> import numpy as np\n\
              >>> r = np.linspace(0.9, 3.0, 400)\n\
              >>> table = vv.potentials.Tabulated(r, vv.potentials.LennardJones(1.0, 1.0).value(r))\n\
              >>> bool(abs(table.force(1.5) - vv.potentials.LennardJones(1.0, 1.0).force(1.5)) < 1e-6)\n\
              True",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("r", Kind::Table(Sign::NotNegative), "Distances, ascending, at least four")
            .of([1, 0, 0]),
        Parameter::new("V", Kind::Table(Sign::Any), "Potential energies there").of([2, 1, -2]),
    ],
    make: |values| {
        check(values[0].table(), values[1].table())?;
        held::<Tabulated>(values)
    },
};

fn check(r: &[f64], v: &[f64]) -> Result<()> {
    if r.len() < LEAST {
        return Err(Error::invalid("r", format!("expected at least {LEAST} distances, got {}", r.len())));
    }
    if v.len() != r.len() {
        return Err(Error::invalid("V", format!("expected as many as in r, {}, got {}", r.len(), v.len())));
    }
    let fine = |pair: &[f64]| pair[1] > pair[0] && (1.0 / (pair[1] - pair[0])).is_finite();
    if let Some(at) = r.windows(2).position(|pair| !fine(pair)) {
        let (here, next) = (number(r[at]), number(r[at + 1]));
        let message =
            format!("expected ascending distances, got r[{at}] = {here} and then r[{}] = {next}", at + 1);
        return Err(Error::invalid("r", message));
    }
    let pieces = pieces(r, v, false);
    match pieces.iter().position(|row| row.iter().any(|x| !x.is_finite())) {
        None => Ok(()),
        Some(at) => Err(Error::invalid(
            "V",
            format!(
                "expected values between which slopes are within float64, got {} at V[{at}]",
                number(v[at])
            ),
        )),
    }
}

/// The curve through a table. What is left of V where it falls to next to nothing would be lost to the rounding of what it
/// falls from: the second half of such an interval is the same quintic, told from its end.
fn curve(r: &[f64], v: &[f64]) -> Piecewise<8> {
    let last = r.last().copied().unwrap_or_default();
    let from_beginning = pieces(r, v, false);
    let falls = |i: usize| v.get(i + 1).is_some_and(|next| next.abs() < FALLS * v[i].abs());
    if !(0..r.len()).any(falls) {
        return Piecewise::new(r.to_vec(), last, from_beginning);
    }
    let from_end = pieces(r, v, true);
    let (mut starts, mut rows) = (Vec::new(), Vec::new());
    for i in 0..r.len() {
        starts.push(r[i]);
        rows.push(from_beginning[i]);
        if falls(i) {
            let middle = r[i] + 0.5 * (r[i + 1] - r[i]);
            if r[i] < middle && middle < r[i + 1] {
                starts.push(middle);
                rows.push(from_end[i]);
            }
        }
    }
    Piecewise::new(starts, last, rows)
}

/// Origin, inverse of the length and coefficients of each interval, and of the last point; each from its beginning, or from
/// its end backwards.
pub(crate) fn pieces(r: &[f64], v: &[f64], from_end: bool) -> Vec<[f64; 8]> {
    // In units near one, as fifth powers and differences of fourth order are taken.
    let largest = |values: &[f64]| exponent(values.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    let (length, energy) = (largest(r), largest(v));
    let near = |values: &[f64], unit: i32| -> Vec<f64> { values.iter().map(|x| scale(*x, -unit)).collect() };
    let (places, v) = (near(r, length), near(v, energy));
    let bends = bends(&places, &v);
    let last = r.len() - 1;
    let row = |i: usize| {
        // From the last point on there is nothing, but the point has its own value.
        let h = if i < last { places[i + 1] - places[i] } else { places[i] - places[i - 1] };
        let (origin, h, c) = if i == last {
            (r[i], h, [v[i], h * bends[i][0], 0.5 * h * h * bends[i][1], 0.0, 0.0, 0.0])
        } else if from_end {
            (r[i + 1], -h, quintic(-h, [v[i + 1], v[i]], bends[i + 1], bends[i]))
        } else {
            (r[i], h, quintic(h, [v[i], v[i + 1]], bends[i], bends[i + 1]))
        };
        let [a, b, c, d, e, f] = c.map(|c| scale(c, energy));
        [origin, scale(1.0 / h, -length), a, b, c, d, e, f]
    };
    (0..=last).map(row).collect()
}

impl Formula for Tabulated {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    fn new(values: &[Value]) -> Self {
        let (r, v) = (values[0].table(), values[1].table());
        Self { curve: curve(r, v), places: r.to_vec() }
    }
    /// The same curve: its pieces are taken in units near one, whatever the units of the table are.
    fn scaled(&self, values: &[Value], units: Units) -> Self {
        let energy = units.exponent([2, 1, -2]);
        Self { curve: self.curve.scaled(units.length, energy), places: values[0].table().to_vec() }
    }
    fn domain(&self) -> Option<(f64, f64)> {
        Some(self.curve.domain())
    }
    fn breaks(&self) -> Vec<f64> {
        self.places.clone()
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
