//! Derivatives by formulas against differences of the kernels, whether lanes are bodies or systems.

use super::Along;
use crate::error::Result;
use crate::forces::context::{Arrangement, Context, System, packed_place};
use crate::forces::gravity::{FewBodies, newton::Gravity};
use crate::forces::{Force, ForceDeclaration, ForceTerm, Phase};
use crate::forces::{
    central_field, coulomb, damper, driven_force, harmonic, linear_drag, pair_potential, quadratic_drag,
    rotating_frame, spring, uniform_electric_field, uniform_field, uniform_magnetic_field,
};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::parallel::{Control, Ticker};
use crate::potentials::parameters::Value;
use crate::registry;
use crate::units::Units;
use std::sync::Arc;

/// Bodies in no order, whose distances are about one; the last of them massless if there are to be some.
struct Bodies {
    mass: Vec<f64>,
    active: usize,
}

/// A number of a body that looks like any other.
fn number(body: usize, kind: usize, c: usize) -> f64 {
    let x = ((body * 12 + kind * 3 + c + 1) as f64 * 0.618_033_988_749_894_9).fract();
    if kind == 0 { 8.0 * x + 0.25 * (body * c) as f64 } else { x - 0.5 }
}

impl Bodies {
    fn new(count: usize, massless: usize) -> Self {
        let mass = (0..count).map(|i| if i < count - massless { 0.5 + 0.25 * (i % 4) as f64 } else { 0.0 });
        Self { mass: mass.collect(), active: count - massless }
    }

    /// The same in every lane, or in the lanes.
    fn context<'a>(
        &self,
        systems: &'a [System<'a>],
        arrangement: Arrangement,
        components: usize,
    ) -> Context<'a> {
        let count = self.mass.len();
        let rows = match arrangement {
            Arrangement::Batched => count,
            Arrangement::Packed => self.active.div_ceil(WIDTH) + (count - self.active).div_ceil(WIDTH),
        };
        Context {
            arrangement,
            shape: Shape { rows, components },
            active: self.active,
            systems,
            term: 0,
            units: Units::default(),
            t0: 0.0,
            threads: 1,
            equal_steps: false,
        }
    }

    fn place(&self, body: usize, context: &Context<'_>) -> (usize, Option<usize>) {
        match context.arrangement {
            Arrangement::Batched => (body, None),
            Arrangement::Packed => {
                let (row, lane) = packed_place(body, self.active);
                (row, Some(lane))
            }
        }
    }

    /// Numbers of a kind, laid out; far apart where there is no body.
    fn laid(&self, kind: usize, context: &Context<'_>) -> Vec<Lanes> {
        let Shape { rows, components } = context.shape;
        let mut found = vec![Lanes::zero(); context.shape.len()];
        if kind == 0 && context.arrangement == Arrangement::Packed {
            for (at, lanes) in found.iter_mut().enumerate() {
                *lanes = Lanes(core::array::from_fn(|lane| 1e3 + (at * WIDTH + lane) as f64));
            }
        }
        for body in 0..self.mass.len() {
            let (row, lane) = self.place(body, context);
            for c in 0..components {
                let lanes = &mut found[c * rows + row];
                match lane {
                    Some(lane) => lanes.0[lane] = number(body, kind, c),
                    None => *lanes = Lanes::splat(number(body, kind, c)),
                }
            }
        }
        found
    }

    /// What is in the places of the bodies.
    fn picked(&self, numbers: &[Lanes], context: &Context<'_>) -> Vec<f64> {
        let Shape { rows, components } = context.shape;
        let mut found = Vec::new();
        for body in 0..self.mass.len() {
            let (row, lane) = self.place(body, context);
            found.extend((0..components).map(|c| numbers[c * rows + row].0[lane.unwrap_or(3)]));
        }
        found
    }
}

/// The change of a force along a direction, by its formula and by differences of seven places.
fn compared(
    term: &Arc<dyn ForceTerm>,
    bodies: &Bodies,
    arrangement: Arrangement,
    components: usize,
) -> [Vec<f64>; 2] {
    let (all, forces) = ((0..bodies.mass.len()).collect::<Vec<_>>(), [Arc::clone(term)]);
    let systems = [System { bodies: &all, mass: &bodies.mass, forces: &forces }];
    let context = bodies.context(&systems, arrangement, components);
    let [q, v, of_q, of_v] = [0, 1, 2, 3].map(|kind| bodies.laid(kind, &context));
    let (control, t) = (Control::new(0), Lanes::splat(0.375));
    let mut ticker = Ticker::quiet(&control);
    let mut change = vec![Lanes::splat(f64::NAN); q.len()];
    let mut derivative = term.derivative(&context).unwrap();
    let along = Along { q: &of_q, v: &of_v };
    derivative.apply(&Phase { t: &t, q: &q, v: &v }, along, &mut change, &mut ticker).unwrap();
    let mut kernel = term.kernel(&context);
    let step = 1.0 / 512.0;
    let mut at = |steps: f64| -> Result<Vec<f64>> {
        let moved = |from: &[Lanes], along: &[Lanes]| -> Vec<Lanes> {
            from.iter().zip(along).map(|(&x, &d)| d.multiply_add(Lanes::splat(steps * step), x)).collect()
        };
        let (q, v) = (moved(&q, &of_q), moved(&v, &of_v));
        let mut a = vec![Lanes::zero(); q.len()];
        kernel.apply(&Phase { t: &t, q: &q, v: &v }, &mut a, true, &mut ticker)?;
        Ok(bodies.picked(&a, &context))
    };
    let weights = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
    let mut expected = vec![0.0; bodies.mass.len() * components];
    for (steps, weight) in weights {
        let (above, below) = (at(steps).unwrap(), at(-steps).unwrap());
        for (expected, (above, below)) in expected.iter_mut().zip(above.iter().zip(&below)) {
            *expected += weight * (above - below) / (60.0 * step);
        }
    }
    [bodies.picked(&change, &context), expected]
}

/// Checks a force on some bodies: within a part of the largest change, and that lanes do not matter to a bit.
fn check(term: &Arc<dyn ForceTerm>, count: usize, massless: usize, components: usize) {
    let bodies = Bodies::new(count, massless);
    let both = [Arrangement::Batched, Arrangement::Packed]
        .map(|arrangement| compared(term, &bodies, arrangement, components));
    for [found, expected] in &both {
        let largest = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        for (at, (found, expected)) in found.iter().zip(expected).enumerate() {
            // Sevenths derivatives times step⁶/140, 1e-16 times some thousands, and rounding over the step.
            let off = (found - expected).abs() / largest;
            assert!(off < 2e-11, "{term:?} {count} {components} at {at}: {found} {expected}");
        }
    }
    let bits = |[found, _]: &[Vec<f64>; 2]| found.iter().map(|x| (x + 0.0).to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&both[0]), bits(&both[1]), "{term:?} {count} {components}");
}

fn made(declaration: &ForceDeclaration, values: Vec<Value>) -> Arc<dyn ForceTerm> {
    (declaration.make)(&values).unwrap()
}

#[test]
fn pulls_between_bodies() {
    for softening in [0.0, 0.25] {
        let gravity: Arc<dyn ForceTerm> = Arc::new(Gravity::new(0.75, softening));
        for (count, massless) in [(2, 0), (3, 0), (3, 1), (8, 0), (11, 3), (19, 0), (40, 15)] {
            check(&gravity, count, massless, 3);
            check(&gravity, count, massless, 2);
        }
        let charge = vec![1.0, -0.5, 0.0, 2.0, 0.25];
        let (charge, k, softening) = (Value::Numbers(charge), Value::Number(1.5), Value::Number(softening));
        check(&made(&coulomb::DECLARATION, vec![charge, k, softening]), 5, 0, 3);
    }
}

#[test]
fn others() {
    let vector = Value::Vector([0.5, -1.0, 0.75]);
    let one = || Value::Numbers(vec![0.5]);
    let of_each = || Value::Numbers(vec![0.5, 1.5, -0.25]);
    let turning = Value::Vector([0.0, 0.0, 0.75]);
    let center = Value::Vector([0.5, 0.25, 0.0]);
    let links = || [Value::Indices(vec![0, 1]), Value::Indices(vec![1, 2])];
    let springs = |length: Vec<f64>| {
        let [i, j] = links();
        made(&spring::DECLARATION, vec![i, j, Value::Numbers(vec![2.0, 0.5]), Value::Numbers(length)])
    };
    let all = [
        made(&uniform_field::DECLARATION, vec![vector.clone()]),
        made(&harmonic::DECLARATION, vec![Value::Number(2.5), center.clone()]),
        made(&linear_drag::DECLARATION, vec![Value::Number(0.75)]),
        made(&quadratic_drag::DECLARATION, vec![one()]),
        made(&rotating_frame::DECLARATION, vec![turning.clone(), center]),
        made(&uniform_electric_field::DECLARATION, vec![vector.clone(), of_each()]),
        made(&uniform_magnetic_field::DECLARATION, vec![turning, of_each()]),
        made(&driven_force::DECLARATION, vec![vector, Value::Number(2.0), Value::Number(0.25)]),
        made(&damper::DECLARATION, {
            let [i, j] = links();
            vec![i, j, Value::Numbers(vec![1.5, 0.5])]
        }),
        springs(vec![0.0]),
        springs(vec![0.5, 0.0]),
    ];
    for term in &all {
        check(term, 3, 0, 3);
    }
}

#[test]
fn potentials_along_lines() {
    let [power, morse, plummer] =
        [("power_law", vec![-1.5, 1.0]), ("morse", vec![0.75, 0.5, 1.25]), ("plummer", vec![-1.5, 0.75])]
            .map(|(name, values)| {
                let values: Vec<Value> = values.into_iter().map(Value::Number).collect();
                Value::Potential(registry::potential(name).unwrap().build(&values).unwrap())
            });
    for potential in [power, morse, plummer] {
        let center = Value::Vector([-1.0, 0.25, -0.5]);
        let between = made(&pair_potential::DECLARATION, vec![potential.clone()]);
        let around = made(&central_field::DECLARATION, vec![potential, center]);
        for count in [2, 5, 19] {
            for components in [2, 3] {
                check(&between, count, 0, components);
                check(&around, count, 0, components);
            }
        }
    }
}

/// To rounding: beside differences of numbers of twice the digits.
#[test]
fn gravity_to_the_last_digits() {
    let bodies = Bodies::new(5, 0);
    let term: Arc<dyn ForceTerm> = Arc::new(Gravity::new(1.0, 0.0));
    let [found, _] = compared(&term, &bodies, Arrangement::Batched, 3);
    let shape = Shape { rows: 5, components: 3 };
    let strength = bodies.mass.iter().map(|&mass| DoubleDouble::from(mass)).collect();
    let mut few = FewBodies::new(shape, strength, vec![DoubleDouble::from(0.0)]);
    let (control, zero) = (Control::new(0), DoubleDouble::from(0.0));
    let mut ticker = Ticker::quiet(&control);
    let step = 2.0_f64.powi(-30);
    let mut at = |side: f64| {
        let mut q = vec![zero; 15];
        for body in 0..5 {
            for c in 0..3 {
                let along = DoubleDouble::from(side * step * number(body, 2, c));
                q[c * 5 + body] = DoubleDouble::from(number(body, 0, c)) + along;
            }
        }
        let mut a = vec![zero; 15];
        few.apply(&Phase { t: &zero, q: &q, v: &[] }, &mut a, true, &mut ticker).unwrap();
        a
    };
    let (above, below) = (at(1.0), at(-1.0));
    for body in 0..5 {
        for c in 0..3 {
            let expected = (above[c * 5 + body] - below[c * 5 + body]).to_f64() / (2.0 * step);
            let off = (found[body * 3 + c] - expected).abs();
            // Some roundings of terms of about one; the third derivatives, some tens, times 2⁻⁶⁰.
            assert!(off < 4e-15, "{body} {c}: {} {expected}", found[body * 3 + c]);
        }
    }
}
