//! Potential energies `V(r)`: one file each, used by central fields, pair forces and scattering alike.
//!
//! To add one, write a file with a type that implements [`Formula`] and add its line to
//! [`registry::POTENTIALS`](crate::registry::POTENTIALS). Its Python class, parameter checks,
//! documentation and property tests follow from what [`Formula::DECLARATION`] says.

pub mod buckingham;
pub mod coulomb;
pub mod expressed;
pub mod features;
pub mod fit;
pub mod hard_sphere;
mod hermite;
pub mod kernels;
pub mod lennard_jones;
pub mod mie;
pub mod morse;
pub mod parameters;
mod piecewise;
pub mod piecewise_polynomial;
pub mod plummer;
pub mod power_law;
pub mod prepared;
pub mod screened_coulomb;
pub mod screening;
pub mod soft_sphere;
pub mod square_well;
pub mod tabulated;
mod thomas_fermi;
mod thomas_fermi_table;
pub mod yukawa;

use crate::error::Result;
use crate::expressions::curve::Argument;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::Lanes;
use crate::numerics::power::Powers;
use crate::numerics::power_of_two::exponent;
use crate::numerics::real::Mask;
use crate::numerics::rows::Lookup;
use crate::units::Units;
use core::fmt::Debug;
use features::Hidden;
use kernels::{Around, Pairs, around_tier, between_few_tier, between_rows_tier, between_systems_tier};
use kernels::{all_rows_tier, force_and_curvature_tier, force_rows_tier, value_rows_tier};
use parameters::{Declaration, Value};
use std::sync::Arc;

/// A strength of more than 2^FAR or less than 2^-FAR is [brought near one](Potential::near_one): its products with what
/// is near one are far from the ends of the range then, errors and all.
const FAR: i32 = 300;

/// What a potential declares about itself.
pub type PotentialDeclaration = Declaration<dyn Potential>;

/// The scalars of formulas: those with an exponential and powers, that can be looked up in a table and run code.
pub trait Analytic: Exponential + Powers + Lookup + Argument {}

impl<S: Exponential + Powers + Lookup + Argument> Analytic for S {}

/// The numbers of a formula: of one potential, or lane by lane those of several.
pub type Numbers<S> = [S; 5];

/// A potential energy as written by its author: formulas generic over the scalar.
pub trait Formula: Debug + Send + Sync + Sized + 'static {
    /// What it declares about itself.
    const DECLARATION: &'static PotentialDeclaration;
    /// Whether it diverges at r = 0.
    const SINGULAR: bool;
    /// Whether it jumps, so that there is no finite force.
    const JUMPS: bool = false;

    /// From the values of its parameters, which are what the declaration says.
    fn new(values: &[Value]) -> Self;
    /// The same in other units, in which the values of its parameters are those.
    fn scaled(&self, values: &[Value], _: Units) -> Self {
        Self::new(values)
    }
    /// The numbers that it takes as `own`, in which ensemble members that share lanes may differ; zeros fill up.
    fn numbers(&self) -> Numbers<f64> {
        [0.0; 5]
    }
    /// What else it is made of, which they must have alike, as numbers; `None`: they must have the very same potential.
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        None
    }
    /// Whether it diverges at r = 0; told of each where a kind does not say.
    fn singular(&self) -> bool {
        Self::SINGULAR
    }
    /// Where something may happen, ascending, if its parameters do not tell.
    fn lengths(&self) -> Option<Vec<f64>> {
        None
    }
    /// What an energy of one among its parameters makes of V where something happens.
    fn size(&self) -> f64 {
        1.0
    }
    /// V(r).
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S;
    /// −dV/dr.
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S;
    /// d²V/dr².
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S;
    /// All three with the same bits, by fewer operations where they share some.
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        [self.value(own, r), self.force(own, r), self.curvature(own, r)]
    }
    /// −dV/dr / r as a function of r²: what a pair needs, which may be less than a root and two divisions.
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, own: &Numbers<S>, r2: S) -> S {
        let r = r2.sqrt();
        if Self::SINGULAR {
            return self.force(own, r) / r;
        }
        // Its limit in the middle, where 0/0 would be undefined.
        let (middle, pull) = (r2.less_equal(S::zero()), self.force(own, r) / r);
        if middle.any() { S::select(middle, -self.curvature(own, r), pull) } else { pull }
    }
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64> {
        None
    }
    /// The distances between which it is, if not at all.
    fn domain(&self) -> Option<(f64, f64)> {
        None
    }
    /// The distances at which it is not smooth.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
    /// What samples of it may not show, if it is not known to show all.
    fn hidden(&self) -> Option<Hidden> {
        None
    }
    /// V(r), −dV/dr and d²V/dr² to about thirty digits, and by how much rounding may have each of them off, if that may be
    /// all of it.
    fn told(&self, _r: f64) -> Option<[(DoubleDouble, f64); 3]> {
        None
    }
}

/// A potential energy as the rest of the core holds it.
pub trait Potential: Debug + Send + Sync {
    /// What it declares about itself.
    fn declaration(&self) -> &'static PotentialDeclaration;
    /// Whether it diverges at r = 0.
    fn singular(&self) -> bool;
    /// Whether it jumps, so that there is no finite force.
    fn jumps(&self) -> bool;
    /// V(r), −dV/dr and d²V/dr² at each distance.
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3];
    /// The values of its parameters, in the order of the declaration.
    fn parameters(&self) -> &[Value];
    /// V(r) of rows of distances.
    fn value_rows(&self, r: &[Lanes], value: &mut [Lanes]);
    /// −dV/dr of rows of distances.
    fn force_rows(&self, r: &[Lanes], force: &mut [Lanes]);
    /// V(r), −dV/dr and d²V/dr² of rows of distances; of the last, only as many as there is room for.
    fn all_rows(&self, r: &[Lanes], value: &mut [Lanes], force: &mut [Lanes], curvature: &mut [Lanes]);
    /// −dV/dr and d²V/dr² of rows of distances, of the potentials in the lanes that have these numbers.
    fn force_and_curvature(
        &self,
        numbers: &Numbers<Lanes>,
        r: &[Lanes],
        force: &mut [Lanes],
        curvature: &mut [Lanes],
    );
    /// As [`evaluate`](Self::evaluate), at one distance.
    fn at(&self, r: f64) -> [f64; 3];
    /// A length of its own, if it has one: the first of its parameters that is one, or where something happens.
    fn own_length(&self) -> Option<f64>;
    /// The lengths that it declares, and inverses of inverse lengths: where something may happen, in order.
    fn lengths(&self) -> Vec<f64>;
    /// V(r) and −dV/dr to about thirty digits.
    fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble);
    /// The first of them.
    fn precise_value(&self, r: DoubleDouble) -> DoubleDouble;
    /// The same potential in other units.
    fn scaled(&self, units: Units) -> Arc<dyn Potential>;
    /// The same potential in that unit of length and one of energy in which its strength is near one, and the exponent of
    /// that unit of energy; nothing if the units of the scene will do.
    fn near_one(&self, length: i32) -> Option<(Arc<dyn Potential>, i32)>;
    /// What it has of its own in lanes with other potentials of its kind.
    fn numbers(&self) -> Numbers<f64>;
    /// Its kind and what such potentials have alike, as numbers; `None`: only the very same one shares lanes.
    fn in_every_lane(&self) -> Option<Vec<u64>>;
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64>;
    /// The distances between which it is, if not at all. Beyond them it is NaN.
    fn domain(&self) -> Option<(f64, f64)>;
    /// The distances at which it is not smooth, ascending.
    fn breaks(&self) -> Vec<f64>;
    /// What samples of it may not show, if it is not known to show all.
    fn hidden(&self) -> Option<Hidden>;
    /// V(r), −dV/dr and d²V/dr² to about thirty digits, and by how much rounding may have each of them off, if that may be
    /// all of it: a formula says what it says also where nothing is left of it.
    fn told(&self, r: f64) -> Option<[(DoubleDouble, f64); 3]>;
    /// Writes the accelerations of bodies around a fixed point, or adds them.
    fn around(&self, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool);
    /// Adds the forces between the bodies of each lane's system, partners in order of index.
    fn between_systems(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]);
    /// As [`between_systems`](Self::between_systems), of up to eight bodies in one row.
    fn between_few(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]);
    /// Adds the forces between the bodies of a row and those after them, to forces that begin at another row.
    fn between_rows(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes], place: (usize, usize));
}

/// The potential for precise sums at distances in units of 2^length, and the exponent of the unit of their energies.
pub fn near_one(potential: &Arc<dyn Potential>, length: i32) -> (Arc<dyn Potential>, i32) {
    potential.near_one(length).unwrap_or_else(|| (Arc::clone(potential), 0))
}

/// A formula and the values it was made from.
#[derive(Debug)]
struct Held<P> {
    formula: P,
    values: Vec<Value>,
}

/// The potential of a formula; what its declaration makes.
///
/// # Errors
/// None.
pub fn held<P: Formula>(values: &[Value]) -> Result<Arc<dyn Potential>> {
    Ok(hold(P::new(values), values))
}

/// The potential of a formula that was made of those values.
fn hold<P: Formula>(formula: P, values: &[Value]) -> Arc<dyn Potential> {
    Arc::new(Held { formula, values: values.to_vec() })
}

impl<P: Formula> Potential for Held<P> {
    fn declaration(&self) -> &'static PotentialDeclaration {
        P::DECLARATION
    }
    fn singular(&self) -> bool {
        self.formula.singular()
    }
    fn jumps(&self) -> bool {
        P::JUMPS
    }
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3] {
        let own = &self.formula.numbers();
        [
            r.iter().map(|&r| self.formula.value(own, r)).collect(),
            r.iter().map(|&r| self.formula.force(own, r)).collect(),
            r.iter().map(|&r| self.formula.curvature(own, r)).collect(),
        ]
    }
    fn parameters(&self) -> &[Value] {
        &self.values
    }
    fn value_rows(&self, r: &[Lanes], value: &mut [Lanes]) {
        value_rows_tier(&self.formula, r, value);
    }
    fn force_rows(&self, r: &[Lanes], force: &mut [Lanes]) {
        force_rows_tier(&self.formula, r, force);
    }
    fn all_rows(&self, r: &[Lanes], value: &mut [Lanes], force: &mut [Lanes], curvature: &mut [Lanes]) {
        all_rows_tier(&self.formula, r, value, force, curvature);
    }
    fn force_and_curvature(
        &self,
        numbers: &Numbers<Lanes>,
        r: &[Lanes],
        force: &mut [Lanes],
        curvature: &mut [Lanes],
    ) {
        force_and_curvature_tier(&self.formula, numbers, r, [force, curvature]);
    }
    fn at(&self, r: f64) -> [f64; 3] {
        self.formula.all(&self.formula.numbers(), r)
    }
    fn own_length(&self) -> Option<f64> {
        if let Some(lengths) = self.formula.lengths() {
            return lengths.first().copied();
        }
        let mut all = self.values.iter().zip(P::DECLARATION.exponents(&self.values));
        all.find(|(_, dimension)| *dimension == [1.0, 0.0, 0.0]).map(|(length, _)| length.size())
    }
    fn lengths(&self) -> Vec<f64> {
        if let Some(lengths) = self.formula.lengths() {
            return lengths;
        }
        let dimensions = P::DECLARATION.exponents(&self.values);
        let mut lengths = Vec::new();
        for (value, dimension) in self.values.iter().zip(dimensions) {
            match (value, dimension) {
                (Value::Number(length), [1.0, 0.0, 0.0]) => lengths.push(*length),
                (Value::Number(inverse), [-1.0, 0.0, 0.0]) => lengths.push(1.0 / inverse),
                (Value::Table(table), [1.0, 0.0, 0.0]) => lengths.extend_from_slice(table),
                _ => {}
            }
        }
        lengths.retain(|length| *length > 0.0 && length.is_finite());
        lengths.sort_by(f64::total_cmp);
        lengths
    }
    fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        let own = &self.formula.numbers().map(DoubleDouble::from);
        (self.formula.value(own, r), self.formula.force(own, r))
    }
    fn precise_value(&self, r: DoubleDouble) -> DoubleDouble {
        self.formula.value(&self.formula.numbers().map(DoubleDouble::from), r)
    }
    fn scaled(&self, units: Units) -> Arc<dyn Potential> {
        let values = P::DECLARATION.scaled(&self.values, units);
        Arc::new(Self { formula: self.formula.scaled(&values, units), values })
    }
    fn near_one(&self, length: i32) -> Option<(Arc<dyn Potential>, i32)> {
        let dimensions = P::DECLARATION.exponents(&self.values);
        // The exponent of the unit of mass in which a strength is near one, while that of time stays.
        let near = |(value, [l, m, _]): (&Value, [f64; 3])| match value.size() * self.formula.size() {
            strength if m != 0.0 && strength != 0.0 && strength.is_finite() => {
                Some(((f64::from(exponent(strength)) - l * f64::from(length)) / m).round() as i32)
            }
            _ => None,
        };
        let mass = self.values.iter().zip(dimensions).find_map(near).unwrap_or(0);
        if length == 0 && mass.abs() < FAR {
            return None;
        }
        Some((self.scaled(Units { length, mass, time: 0 }), mass + 2 * length))
    }
    fn numbers(&self) -> Numbers<f64> {
        self.formula.numbers()
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        let kind = core::ptr::from_ref(P::DECLARATION).addr() as u64;
        self.formula.in_every_lane().map(|alike| [vec![kind], alike].concat())
    }
    fn inverse_distance_strength(&self) -> Option<f64> {
        self.formula.inverse_distance_strength()
    }
    fn domain(&self) -> Option<(f64, f64)> {
        self.formula.domain()
    }
    fn breaks(&self) -> Vec<f64> {
        self.formula.breaks()
    }
    fn hidden(&self) -> Option<Hidden> {
        self.formula.hidden()
    }
    fn told(&self, r: f64) -> Option<[(DoubleDouble, f64); 3]> {
        self.formula.told(r)
    }
    fn around(&self, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool) {
        around_tier(&self.formula, field, q, a, first);
    }
    fn between_systems(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]) {
        between_systems_tier(&self.formula, pairs, q, force);
    }
    fn between_few(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]) {
        between_few_tier(&self.formula, pairs, q, force);
    }
    fn between_rows(&self, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes], place: (usize, usize)) {
        between_rows_tier(&self.formula, pairs, q, force, place);
    }
}

#[cfg(test)]
mod tests;
