//! Where functions that move by much are too weak to matter, as those of a bump that is passed far beside.
//!
//! The one idea: rates that are sums of products with exp, and with tanh on one side of its wall, are between those with its least
//! and its greatest value in the step; where both are the same but for what may be unseen, so is all between.

use super::Features;
use super::ends::Hull;
use crate::expressions::Machine;
use crate::expressions::function::Function;
use crate::expressions::narrow::Kind;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::ode::step_control::Controlled;
use crate::ode::system::Taken;
use std::sync::Arc;

/// exp of less is weak if anything is, and beyond this tanh of half an argument is on one side of its wall.
const FAR: f64 = 20.0;

/// A look at work.
#[derive(Debug)]
pub(super) struct Weak {
    of: Arc<Features>,
    rates: Machine<Lanes>,
    parameters: Vec<f64>,
}

impl Weak {
    pub(super) fn new(of: &Arc<Features>) -> Self {
        let none = vec![Lanes([0.0; WIDTH]); of.rates.parameters()];
        let (of, rates) = (of.clone(), Machine::new(of.rates.clone(), &none));
        Self { of, rates, parameters: vec![0.0; none.len()] }
    }

    /// Whether all functions that move by much in a lane of a step do so where they are too weak to matter.
    pub(super) fn holds<S: Controlled>(
        &mut self,
        parameters: &[f64],
        (step, lane, t0): (&Taken<'_, S>, usize, f64),
        hulls: &[Hull],
        tolerance: f64,
    ) -> bool {
        let far = |(hull, plain): (&Hull, &bool)| {
            hull.moves_little || (*plain && (hull.most < -FAR || hull.least > FAR))
        };
        if !hulls.iter().zip(&self.of.plain).all(far) {
            return false;
        }
        let functions = self.of.kinds.iter().map(|kind| match kind {
            Kind::Call(function) => Some(*function),
            Kind::Divided(_) | Kind::Absolute => None,
        });
        // Of a quotient the argument does not tell all.
        let Some(functions) = functions.collect::<Option<Vec<_>>>() else { return false };
        if self.parameters != parameters {
            let wide: Vec<Lanes> = parameters.iter().map(|&value| Lanes([value; WIDTH])).collect();
            self.rates.set_parameters(&wide);
            self.parameters.copy_from_slice(parameters);
        }
        // At either end with the least values and with the greatest.
        let numbers = step.ends[0].len();
        let state = self.rates.state();
        for (index, number) in state.iter_mut().enumerate().take(numbers) {
            let ends = step.ends.map(|end| end[index].lane(lane));
            *number = Lanes(core::array::from_fn(|place| ends[place / 2 % 2]));
        }
        let of = functions.into_iter().zip(&self.of.owners);
        for (number, (function, &owner)) in state[numbers..].iter_mut().zip(of) {
            let hull = &hulls[owner];
            *number = Lanes(core::array::from_fn(|place| {
                let u = match (hull.moves_little, place % 2) {
                    (true, _) => hull.ends[place / 2 % 2],
                    (_, 0) => hull.least,
                    _ => hull.most,
                };
                value(function, u)
            }));
        }
        let (from, h) = (t0 + step.from.lane(lane), step.h.lane(lane));
        self.rates.run(Lanes(core::array::from_fn(|place| if place / 2 % 2 == 0 { from } else { from + h })));
        let moved = self.of.rates.outputs();
        (0..moved).all(|index| {
            let rate = self.rates.output(index).0;
            let apart = (rate[1] - rate[0]).abs().max((rate[3] - rate[2]).abs());
            let [a, b] = step.ends.map(|end| end[numbers - moved + index].lane(lane));
            let size = a.abs().max(b.abs()).max((b - a).abs());
            apart * h.abs() <= tolerance * size
        })
    }
}

/// A function of its argument (twice that, of tanh), good enough to tell what matters.
fn value(function: Function, u: f64) -> f64 {
    match function {
        Function::Tanh => {
            let e = Exponential::exp(-u.abs());
            ((1.0 - e) / (1.0 + e)).copysign(u)
        }
        Function::SechSquared => {
            let e = Exponential::exp(-u.abs());
            4.0 * e / ((1.0 + e) * (1.0 + e))
        }
        Function::Sinh => 0.5 * (Exponential::exp(u) - Exponential::exp(-u)),
        Function::Cosh => 0.5 * (Exponential::exp(u) + Exponential::exp(-u)),
        Function::Sin => crate::numerics::angles::sin(u),
        Function::Cos => crate::numerics::angles::cos(u),
        _ => Exponential::exp(u),
    }
}
