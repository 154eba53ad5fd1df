//! How much of a value in double-double is rounding.
//!
//! The one idea: next to each value on the way stands what it may be off by, carried along by derivatives: a difference of
//! near values has what both were off by, and what left the range of numbers is off by all of itself. So the place is known
//! beyond which a formula says nothing any more, as √(1 + r²) − r does far out.
//! Source: N. J. Higham, *Accuracy and Stability of Numerical Algorithms* (2nd ed., 2002), §3.3 (running error analysis).

use super::{Digits, Precise, Step};
use crate::expressions::function::Function;
use crate::numerics::double_double::DoubleDouble;

/// What a function of which double-double has no more digits than a program may be off by, against its result.
const ROUNDED: f64 = 1e-15;
/// What is larger than this because it left the range, or is a root of that, divides to next to nothing.
const FAR: f64 = 1e60;
/// An exponential of less is nothing, also as a part of what is hardly a number.
const VANISHED: f64 = -800.0;
/// What is off by less is known, however small it is.
const NOTHING: f64 = 1e-270;
/// Numbers that are off by less than this part of them need no more digits.
const ENOUGH: f64 = 1e-10;
/// Numbers beyond this, or beneath its inverse, may have left the range, or have lost the lower of their two parts.
const LARGE: f64 = 1e275;

impl Precise {
    /// The values of functions of one number, to as many digits as it takes to have some, and by how much rounding may have
    /// them off.
    ///
    /// Beyond the range of numbers a value stays at its end, off by more than any number.
    pub fn told(&self, x: DoubleDouble) -> Vec<(DoubleDouble, f64)> {
        let found = self.told_in(x.high());
        let enough = |(value, off): &(f64, f64)| *off <= ENOUGH * value.abs() + NOTHING;
        if found.iter().all(enough) {
            return found.into_iter().map(|(value, off)| (DoubleDouble::from(value), off)).collect();
        }
        self.told_in(x)
    }

    fn told_in<S: Digits>(&self, x: S) -> Vec<(S, f64)> {
        let mut values: Vec<S> = Vec::with_capacity(self.steps.len());
        let mut offs: Vec<f64> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let (mut value, mut all_digits) = step.value(&values, 0.0, &[x], &[]);
            if value.rounded().is_nan() {
                // Of what is infinite two parts are no number.
                let rounded: Vec<f64> = values.iter().map(|value| value.rounded()).collect();
                value = S::from(step.value(&rounded, 0.0, &[x.rounded()], &[]).0);
                all_digits = false;
            }
            let rounding = if all_digits { S::ROUNDING } else { ROUNDED };
            let size = value.rounded().abs();
            let mut off = match step {
                Step::Constant(_) | Step::Parameter(_) | Step::Time => 0.0,
                _ => carried(step, (&values, &offs), size) + rounding * size + lost(step, &values, size),
            };
            if size > LARGE {
                value = S::from(LARGE.copysign(value.rounded()));
                off = f64::INFINITY;
            }
            values.push(value);
            offs.push(if off.is_nan() { f64::INFINITY } else { off });
        }
        self.roots.iter().map(|root| (values[*root], offs[*root])).collect()
    }
}

/// What the values of which a step is made are off by makes of its own, whose size is known.
fn carried<S: Digits>(step: &Step, (values, offs): (&[S], &[f64]), size: f64) -> f64 {
    let of = |place: usize| (values[place].rounded().abs(), offs[place]);
    match step {
        Step::Constant(_) | Step::Variable(_) | Step::Parameter(_) | Step::Time => 0.0,
        Step::Sum(_, terms) => terms
            .iter()
            .map(|(factor, term)| {
                let (x, off) = of(*term);
                factor.abs() * (off + S::ROUNDING * x)
            })
            .sum(),
        Step::Product(a, b) => {
            let ((x, x_off), (y, y_off)) = (of(*a), of(*b));
            x * y_off + y * x_off
        }
        Step::Quotient(a, b) => {
            let ((x, x_off), (y, y_off)) = (of(*a), of(*b));
            // What is larger than it is told to be divides to less than this.
            if y_off == f64::INFINITY && y > FAR { (x + x_off) / y } else { (x_off + size * y_off) / y }
        }
        Step::Angle(a, b) => {
            let ((y, y_off), (x, x_off)) = (of(*a), of(*b));
            let distance = y.hypot(x);
            (x / distance * y_off + y / distance * x_off) / distance
        }
        Step::Call(function, a) => {
            let slope = steepness(*function, values[*a].rounded(), size);
            if slope == 0.0 { 0.0 } else { slope * offs[*a] }
        }
        Step::Power(a, exponent) => {
            let (x, off) = of(*a);
            if off == f64::INFINITY && *exponent < 0.0 { size } else { exponent.abs() * (size / x) * off }
        }
    }
}

/// What a result may be off by because it is beneath the range, or because the lower of its two parts is.
fn lost<S: Digits>(step: &Step, values: &[S], size: f64) -> f64 {
    let x = |place: &usize| values[*place].rounded().abs();
    let known = match step {
        Step::Product(a, b) => x(a) == 0.0 || x(b) == 0.0,
        Step::Quotient(a, _) | Step::Power(a, _) => x(a) == 0.0,
        Step::Call(Function::Exp, a) => values[*a].rounded() < VANISHED,
        Step::Call(Function::SechSquared, a) => x(a) > -VANISHED,
        Step::Call(_, a) => x(a) == 0.0,
        Step::Angle(..) => false,
        // Sums are as exact as what they are sums of.
        _ => true,
    };
    if known || size > LARGE.recip() { 0.0 } else { LARGE.recip() }
}

/// |f′| at x, where |f| is `size`.
fn steepness(function: Function, x: f64, size: f64) -> f64 {
    let slope = match function {
        // Of a large number nothing is known but that it is a wave.
        Function::Sin | Function::Cos => 1.0,
        Function::Tan => 1.0 + size * size,
        Function::Exp => size,
        Function::Ln => 1.0 / x,
        Function::Sqrt => 0.5 / size,
        Function::Sinh | Function::Cosh => 1.0 + size,
        Function::Tanh => 1.0 - size * size,
        Function::Asin | Function::Acos => 1.0 / ((1.0 - x) * (1.0 + x)).sqrt(),
        Function::Atan => 1.0 / (1.0 + x * x),
        Function::Asinh => 1.0 / x.hypot(1.0),
        Function::Acosh => 1.0 / ((x - 1.0) * (x + 1.0)).sqrt(),
        Function::Atanh => 1.0 / ((1.0 - x) * (1.0 + x)),
        Function::SechSquared => 2.0 * size,
    };
    slope.abs()
}

#[cfg(test)]
mod tests;
