//! V(r) of an expression, run as bytecode: what `Custom` makes of a formula.
//!
//! The one idea: parameters are constants by the time it is compiled, so what runs is the least that this V needs. Where
//! something happens in it (a zero of its force or its curvature, the range of a decay) no declaration says, so it is looked
//! for; and it is compiled in a unit of length in which that is near one, lest a power of a derivative leave the range.

use super::features::Hidden;
use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, hold};
use crate::error::{Error, Result};
use crate::expressions::curve::{Argument, Curve};
use crate::expressions::intervals::Intervals;
use crate::expressions::table::{Parameters, Variables, read};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::scale;
use crate::units::Units;
use core::f64::consts::SQRT_2;
use std::sync::{Arc, OnceLock};

/// V(r) = energy · v(r/length).
#[derive(Clone, Debug)]
pub struct Expressed {
    /// v of lengths in its own unit.
    curve: Arc<Curve>,
    /// v of lengths in `length`, where that unit is another.
    plain: Option<Arc<Curve>>,
    /// Its bounds; nothing of what is no number.
    intervals: Option<Arc<Intervals>>,
    /// That unit, a power of two, as a part of `length`.
    unit: f64,
    /// What v is made of, as numbers.
    made_from: Arc<[u64]>,
    length: f64,
    energy: f64,
    singular: bool,
    /// Where something happens in v, in its own unit.
    features: Arc<OnceLock<Vec<f64>>>,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "expressed",
    class_name: "Expressed",
    summary: "The potential energy of an expression, as Custom makes it",
    formula: "V(r) = energy * v(r / length), of an expression v",
    notes: "Without a range: it is taken as it stands at every distance. Its derivatives are exact, those of the expression.",
    source: "A. Griewank & A. Walther, Evaluating Derivatives (2008), for the derivatives",
    example: ">>> import numpy as np\n\
              >>> well = vv.potentials.Custom(lambda r, k: k * (r - 2.0) ** 2, parameters={\"k\": 3.0})\n\
              >>> type(well).__name__, float(well.value(2.5)), float(well.force(2.5))\n\
              ('Expressed', 0.75, -3.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("nodes", Kind::Table(Sign::Any), "The expression, as Custom writes it"),
        Parameter::new(
            "values",
            Kind::Table(Sign::Any),
            "Of the parameters in it, in the units `length` and `energy`",
        ),
        Parameter::positive("length", [1, 0, 0], "The unit of r in it").or(1.0),
        Parameter::positive("energy", [2, 1, -2], "The unit of its values").or(1.0),
    ],
    make: |values| Ok(hold(Expressed::read(values)?, values)),
};

/// Distances that are looked at to each octave, and how many octaves to either side of one.
const PER_OCTAVE: i32 = 16;
const OCTAVES: i32 = 400;
/// Where features are looked for: farther out powers within derivatives leave the range, as (1 + r²)⁴, and change signs.
const NEARBY: i32 = 64;
/// Features on either side, the nearest and the farthest, that are taken; of an oscillation there is no end.
const MOST: usize = 3;
/// Derivatives beyond that, or beneath its inverse, have not all their digits.
const LARGE: f64 = 1e280;

/// What is off by less than this part of it needs no other unit of length.
const ENOUGH: f64 = 1e-6;
/// Beneath this part of the derivative before it, times r, a derivative may be rounding.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// The power of two near the least distance at which a curve is no power of it any more, octave by octave, or, if it is one
/// everywhere, where it is one; its values alone are asked, whose range is wider than that of derivatives.
fn first_bend(curve: &Curve) -> i32 {
    let mut before: Option<f64> = None;
    let mut power: Option<f64> = None;
    let mut one = 0;
    for k in -OCTAVES..=OCTAVES {
        let [value, ..] = scale(1.0, k).all_on(curve);
        if !(LARGE.recip()..LARGE).contains(&value.abs()) {
            (before, power) = (None, None);
            continue;
        }
        if let Some(before) = before {
            let ratio = value / before;
            let first = *power.get_or_insert(ratio);
            // By half a power, or through zero.
            if !(first / SQRT_2..first * SQRT_2).contains(&ratio) {
                return k;
            }
            if (before.abs() < 1.0) != (value.abs() < 1.0) {
                one = k;
            }
        }
        before = Some(value);
    }
    one
}

impl Expressed {
    /// What a curve of lengths in such a unit tells of V and its derivatives.
    fn told_by(&self, curve: &Curve, unit: f64, r: f64) -> [(DoubleDouble, f64); 3] {
        let per_length = DoubleDouble::from(1.0) / DoubleDouble::from(self.length).scale(unit);
        let energy = DoubleDouble::from(self.energy);
        let mut told = curve.told(DoubleDouble::from(r) * per_length);
        let factors = [energy, -(energy * per_length), energy * per_length * per_length];
        for ((value, off), factor) in told.iter_mut().zip(factors) {
            (*value, *off) = (*value * factor, *off * factor.high().abs());
        }
        told
    }

    fn read(values: &[Value]) -> Result<Self> {
        let [nodes, parameters, length, energy] = values else {
            return Err(Error::Internal("Expressed takes four parameters".to_owned()));
        };
        let (nodes, parameters) = (nodes.table(), parameters.table());
        let curve = |unit: f64| {
            let variables = Variables { count: 1, unit };
            let (graph, roots) = read(nodes, 1, variables, Parameters::Told(parameters))?;
            let missing = || Error::Internal("an expression without a node".to_owned());
            let root = *roots.first().ok_or_else(missing)?;
            Ok((Curve::new(graph.clone(), root)?, Intervals::new(graph, vec![root])))
        };
        let plain = curve(1.0)?;
        let exponent = first_bend(&plain.0);
        let unit = scale(1.0, exponent);
        let (kept, (curve, intervals)) =
            if exponent == 0 { (None, plain) } else { (Some(Arc::new(plain.0)), curve(unit)?) };
        let made_from = nodes.iter().chain(parameters).map(|x| x.to_bits()).collect();
        let made = Self::of(curve, unit, made_from, [length.number(), energy.number()]);
        Ok(Self { plain: kept, intervals: Some(Arc::new(intervals)), ..made })
    }

    fn of(curve: Curve, unit: f64, made_from: Arc<[u64]>, [length, energy]: [f64; 2]) -> Self {
        let [value, slope, second] = 0.0_f64.all_on(&curve);
        let singular = !(value.is_finite() && slope.is_finite() && second.is_finite());
        let (curve, features) = (Arc::new(curve), Arc::default());
        Self { curve, plain: None, intervals: None, unit, made_from, length, energy, singular, features }
    }

    /// Where the derivative of v or its second one change their sign, and where it first is no power of r any more. What
    /// v itself is far out may be no more than the rounding of a constant that is subtracted.
    fn look(&self) -> Vec<f64> {
        let mut found = Vec::new();
        let mut before = [0.0; 2];
        let mut power: Option<f64> = None;
        for k in -NEARBY * PER_OCTAVE..=NEARBY * PER_OCTAVE {
            let part = f64::from(k.rem_euclid(PER_OCTAVE)) / f64::from(PER_OCTAVE);
            let r = scale(Exponential::exp(core::f64::consts::LN_2 * part), k.div_euclid(PER_OCTAVE));
            let [value, slope, second] = r.all_on(&self.curve);
            let known = |x: f64| x == 0.0 || (LARGE.recip()..LARGE).contains(&x.abs());
            // What is left of terms that cancel, as of √(1 + r²) far out, has no sign.
            if (r * slope).abs() <= ROUNDED * value.abs() || (r * second).abs() <= ROUNDED * slope.abs() {
                continue;
            }
            if !(known(slope) && known(second)) {
                before = [0.0; 2];
                continue;
            }
            let signs = [slope, second].map(|x| if x == 0.0 { 0.0 } else { x.signum() });
            let turns = signs.iter().zip(before).any(|(here, before)| here * before < 0.0);
            // A second derivative of nothing may be but one that has left the range.
            let here = if slope == 0.0 || second == 0.0 { None } else { Some(r * second / slope) };
            let departs = here.is_some_and(|here| (here - *power.get_or_insert(here)).abs() > 1.0);
            if turns || departs {
                found.push(r);
            }
            if departs {
                // Once.
                power = Some(f64::NAN);
            }
            for (before, sign) in before.iter_mut().zip(signs) {
                if sign != 0.0 {
                    *before = sign;
                }
            }
        }
        if found.len() > 2 * MOST {
            drop(found.drain(MOST..found.len() - MOST));
        }
        found
    }

    fn features(&self) -> &[f64] {
        self.features.get_or_init(|| self.look())
    }
}

impl Formula for Expressed {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    /// What cannot be read is no number; [`make`](Declaration::make) refuses it.
    fn new(values: &[Value]) -> Self {
        Self::read(values).unwrap_or_else(|_| Self::of(Curve::nowhere(), 1.0, Arc::new([]), [1.0; 2]))
    }
    fn scaled(&self, values: &[Value], _: Units) -> Self {
        let [length, energy] = [2, 3].map(|index: usize| values[index].number());
        Self { length, energy, ..self.clone() }
    }
    fn numbers(&self) -> Numbers<f64> {
        let inverse = 1.0 / (self.length * self.unit);
        [inverse, self.energy, -self.energy * inverse, self.energy * inverse * inverse, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(self.made_from.to_vec())
    }
    fn singular(&self) -> bool {
        self.singular
    }
    fn size(&self) -> f64 {
        let size = |r: &f64| (r * r.all_on(&self.curve)[1]).abs();
        self.features().first().map(size).filter(|size| *size > 0.0 && size.is_finite()).unwrap_or(1.0)
    }
    fn lengths(&self) -> Option<Vec<f64>> {
        let lengths = self.features().iter().map(|r| r * self.unit * self.length);
        Some(lengths.filter(|length| *length > 0.0 && length.is_finite()).collect())
    }
    fn told(&self, r: f64) -> Option<[(DoubleDouble, f64); 3]> {
        let mut told = self.told_by(&self.curve, self.unit, r);
        let enough = |(value, off): &(DoubleDouble, f64)| *off <= ENOUGH * value.high().abs();
        if let (Some(plain), false) = (&self.plain, told.iter().all(enough)) {
            // What leaves the range in one unit of length may stay within it in another.
            let other = self.told_by(plain, 1.0, r);
            for (told, other) in told.iter_mut().zip(other).filter(|(told, other)| other.1 < told.1) {
                *told = other;
            }
        }
        Some(told)
    }
    fn hidden(&self) -> Option<Hidden> {
        let [per_length, energy, ..] = self.numbers();
        self.intervals.as_ref().map(|intervals| Hidden::new(Intervals::clone(intervals), per_length, energy))
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[1] * (r * own[0]).value_on(&self.curve)
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[2] * (r * own[0]).slope_on(&self.curve)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[3] * (r * own[0]).all_on(&self.curve)[2]
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let [value, slope, second] = (r * own[0]).all_on(&self.curve);
        [own[1] * value, own[2] * slope, own[3] * second]
    }
}
