//! Typed parameters: what a potential or a force is made from, and what is told of it.
//!
//! The one idea: what a parameter is (a number above zero, a vector, a potential, one number for each particle) and
//! its dimension are said once, in a [`Declaration`]. Checks, the Python class, its documentation, files and changes of
//! units follow from it.

use super::Potential;
use crate::error::{Error, Result};
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::scale;
use crate::units::{Dimension, Units};
use crate::words::{number, numbers};
use core::fmt;
use std::sync::Arc;

/// Which numbers are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// All that are finite.
    Any,
    /// At least zero.
    NotNegative,
    /// Above zero.
    Positive,
}

/// What a parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Number(Sign),
    /// One number for all, or one for each of what the force acts on.
    Numbers(Sign),
    /// One body or several, by their index in the scene.
    Indices,
    /// Three components that turn with the bodies.
    Vector,
    /// As a vector; as of an angular velocity, its sign changes when space is reflected or time is reversed.
    AxialVector,
    /// As a vector, of any length above zero.
    Direction,
    /// A place, which turns and moves with the bodies.
    Point,
    /// A potential energy.
    Potential,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// Several numbers that are one thing, as the places or the values of a table.
    Table(Sign),
}

/// The most numbers of a table.
const TABLE_MAX: usize = 1 << 20;

/// The dimension of a parameter.
#[derive(Clone, Copy, Debug)]
pub enum Dimensions {
    /// The same always.
    Fixed(Dimension),
    /// It depends on the parameters, as that of `k` in k/rⁿ on `n`.
    Of(fn(&[Value]) -> [f64; 3]),
}

/// One parameter of a declaration.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name in the Python interface.
    pub name: &'static str,
    /// What it means.
    pub description: &'static str,
    /// What it is.
    pub kind: Kind,
    /// Its dimension.
    pub dimensions: Dimensions,
    /// Its value, or each of its components, or the place of the word, if it is not given.
    pub default: Option<f64>,
}

impl Parameter {
    /// A parameter without a dimension that has to be given.
    pub const fn new(name: &'static str, kind: Kind, description: &'static str) -> Self {
        Self { name, description, kind, dimensions: Dimensions::Fixed([0; 3]), default: None }
    }
    /// A number of that dimension.
    pub const fn number(name: &'static str, dimension: Dimension, description: &'static str) -> Self {
        Self::new(name, Kind::Number(Sign::Any), description).of(dimension)
    }
    /// A number above zero.
    pub const fn positive(name: &'static str, dimension: Dimension, description: &'static str) -> Self {
        Self::new(name, Kind::Number(Sign::Positive), description).of(dimension)
    }
    /// With exponents of length, mass and time.
    pub const fn of(self, dimension: Dimension) -> Self {
        Self { dimensions: Dimensions::Fixed(dimension), ..self }
    }
    /// With a dimension that depends on the parameters.
    pub const fn depending(self, dimension: fn(&[Value]) -> [f64; 3]) -> Self {
        Self { dimensions: Dimensions::Of(dimension), ..self }
    }
    /// With a value that it has if none is given.
    pub const fn or(self, default: f64) -> Self {
        Self { default: Some(default), ..self }
    }

    fn check(&self, class: &str, value: &Value) -> Result<()> {
        let refuse = |expected: &str, came: String| {
            let Self { name, description, .. } = self;
            Err(Error::invalid(name, format!("{class} expected {expected} ({description}), got {came}")))
        };
        match (self.kind, value) {
            (Kind::Number(sign), Value::Number(value)) if !sign.allows(*value) => {
                refuse(sign.expected(), number(*value))
            }
            (Kind::Numbers(sign), Value::Numbers(values)) => {
                match values.iter().find(|x| !sign.allows(**x)) {
                    Some(&wrong) => refuse(sign.expected(), number(wrong)),
                    None => Ok(()),
                }
            }
            (Kind::Table(_), Value::Table(values)) if values.len() > TABLE_MAX => {
                refuse(&format!("at most {TABLE_MAX} numbers"), values.len().to_string())
            }
            (Kind::Table(sign), Value::Table(values)) => {
                match values.iter().enumerate().find(|(_, x)| !sign.allows(**x)) {
                    Some((at, &wrong)) => {
                        refuse(sign.expected(), format!("{}[{at}] = {}", self.name, number(wrong)))
                    }
                    None => Ok(()),
                }
            }
            (Kind::Direction, Value::Vector([0.0, 0.0, 0.0])) => {
                refuse("a direction", "0.0 in every component".to_owned())
            }
            (Kind::Vector | Kind::AxialVector | Kind::Direction | Kind::Point, Value::Vector(values))
                if values.iter().any(|x| !x.is_finite()) =>
            {
                refuse("three finite numbers", numbers(values))
            }
            (Kind::Choice(words), Value::Word(word)) if !words.contains(&word.as_str()) => {
                Err(crate::words::unknown(self.name, word, words.iter().copied()))
            }
            (Kind::Number(_), Value::Number(_))
            | (Kind::Indices, Value::Indices(_))
            | (Kind::Vector | Kind::AxialVector | Kind::Direction | Kind::Point, Value::Vector(_))
            | (Kind::Potential, Value::Potential(_))
            | (Kind::Choice(_), Value::Word(_)) => Ok(()),
            _ => Err(Error::Internal(format!("{class}: {} is of another kind", self.name))),
        }
    }
}

impl Sign {
    fn allows(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::NotNegative => value >= 0.0,
                Self::Positive => value > 0.0,
            }
    }
    fn expected(self) -> &'static str {
        match self {
            Self::Any => "a finite number",
            Self::NotNegative => "a finite number of at least 0",
            Self::Positive => "a finite number above 0",
        }
    }
}

/// The value of a parameter.
#[derive(Clone, Debug)]
pub enum Value {
    /// Of a number.
    Number(f64),
    /// Of one number for all, or one for each.
    Numbers(Vec<f64>),
    /// Of indices of bodies.
    Indices(Vec<usize>),
    /// Of a vector or a point.
    Vector([f64; 3]),
    /// Of a potential.
    Potential(Arc<dyn Potential>),
    /// Of a choice.
    Word(String),
    /// Of a table.
    Table(Arc<[f64]>),
}

impl Value {
    /// The number that it is; NaN of another kind, which [`Declaration::build`] does not let through.
    pub fn number(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            _ => f64::NAN,
        }
    }
    /// As [`number`](Self::number), or the largest of a table.
    pub fn size(&self) -> f64 {
        match self {
            Self::Table(values) => values.iter().fold(0.0, |most: f64, x| most.max(x.abs())),
            other => other.number(),
        }
    }
    /// As [`number`](Self::number), of a vector.
    pub fn vector(&self) -> [f64; 3] {
        match self {
            Self::Vector(values) => *values,
            _ => [f64::NAN; 3],
        }
    }
    /// The numbers that it is; none of another kind.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Numbers(values) => values.clone(),
            _ => Vec::new(),
        }
    }
    /// As [`numbers`](Self::numbers), of indices.
    pub fn indices(&self) -> Vec<usize> {
        match self {
            Self::Indices(values) => values.clone(),
            _ => Vec::new(),
        }
    }
    /// As [`numbers`](Self::numbers), of a table.
    pub fn table(&self) -> &[f64] {
        match self {
            Self::Table(values) => values,
            _ => &[],
        }
    }
    /// The word that it is; none of another kind.
    pub fn word(&self) -> &str {
        match self {
            Self::Word(word) => word,
            _ => "",
        }
    }
    /// The potential that it is.
    ///
    /// # Errors
    /// Of another kind.
    pub fn potential(&self) -> Result<Arc<dyn Potential>> {
        match self {
            Self::Potential(potential) => Ok(Arc::clone(potential)),
            _ => Err(Error::Internal("expected a potential".to_owned())),
        }
    }

    /// In units larger by 2 to the power of `exponent`.
    fn divided(&self, exponent: f64, units: Units) -> Self {
        let divide = dividing(exponent);
        match self {
            Self::Number(value) => Self::Number(divide(*value)),
            Self::Numbers(values) => Self::Numbers(values.iter().copied().map(divide).collect()),
            Self::Vector(values) => Self::Vector(values.map(divide)),
            Self::Potential(potential) => Self::Potential(potential.scaled(units)),
            Self::Table(values) => Self::Table(values.iter().copied().map(divide).collect()),
            other => other.clone(),
        }
    }
}

/// Divides by 2 to the power of `exponent`: exact for a whole exponent, else rounded.
fn dividing(exponent: f64) -> impl Fn(f64) -> f64 {
    let floor = exponent.floor();
    let rest = exponent - floor;
    let whole = -(floor.clamp(-4400.0, 4400.0) as i32);
    let part = if rest == 0.0 { 1.0 } else { Exponential::exp(-rest * core::f64::consts::LN_2) };
    move |value| scale(value, whole) * part
}

/// What a potential or a force declares about itself.
pub struct Declaration<T: ?Sized + 'static> {
    /// Its name in the registry.
    pub name: &'static str,
    /// The name of its Python class.
    pub class_name: &'static str,
    /// What it is for, in one line.
    pub summary: &'static str,
    /// Its law in terms of the parameters.
    pub formula: &'static str,
    /// What else a user should know, or nothing.
    pub notes: &'static str,
    /// Where the law comes from.
    pub source: &'static str,
    /// An example for its documentation, as typed into Python and as it answers.
    pub example: &'static str,
    /// What of it is at rest, and would move in a boosted frame; or nothing.
    pub at_rest: &'static str,
    /// Why motion under it cannot be run backward; or nothing.
    pub one_way: &'static str,
    /// Its parameters, in order.
    pub parameters: &'static [Parameter],
    /// Makes one from its parameters, already checked against the declaration.
    pub make: fn(&[Value]) -> Result<Arc<T>>,
}

impl<T: ?Sized> fmt::Debug for Declaration<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {:?}", self.class_name, self.parameters)
    }
}

impl<T: ?Sized> Declaration<T> {
    /// Makes one after checking its parameters.
    ///
    /// # Errors
    /// The wrong number of parameters, or one that is not what is declared.
    pub fn build(&self, values: &[Value]) -> Result<Arc<T>> {
        if values.len() != self.parameters.len() {
            let names: Vec<&str> = self.parameters.iter().map(|parameter| parameter.name).collect();
            return Err(Error::invalid(
                "parameters",
                format!("{} takes {}, got {} values", self.class_name, names.join(", "), values.len()),
            ));
        }
        let mut all = self.parameters.iter().zip(values);
        all.try_for_each(|(parameter, value)| parameter.check(self.class_name, value))?;
        (self.make)(values)
    }

    /// The exponents of length, mass and time of each parameter.
    pub fn exponents(&self, values: &[Value]) -> Vec<[f64; 3]> {
        let of = |parameter: &Parameter| match parameter.dimensions {
            Dimensions::Fixed(dimension) => dimension.map(f64::from),
            Dimensions::Of(dimension) => dimension(values),
        };
        self.parameters.iter().map(of).collect()
    }

    /// The parameters of the same in other units.
    pub fn scaled(&self, values: &[Value], units: Units) -> Vec<Value> {
        let exponents = self.exponents(values);
        let sizes = [units.length, units.mass, units.time].map(f64::from);
        let sum = |[l, m, t]: [f64; 3]| l * sizes[0] + m * sizes[1] + t * sizes[2];
        values.iter().zip(exponents).map(|(value, exponent)| value.divided(sum(exponent), units)).collect()
    }
}
