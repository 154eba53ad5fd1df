//! The continuous extension of a step of one trajectory: lanes are places, then coefficients.

use super::super::changes::Changes;
use super::super::columns::larger;
use super::super::step::{MOST_ITERATIONS, Work, combined, largest, own_lanes};
use super::{ENOUGH, Extension, MOVED, Rows, TERMS, integrals};
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::double_double::two_sum;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// What is found of a step.
#[derive(Clone, Debug)]
pub(in super::super) struct ExtensionOfOne {
    /// Rates at the stages, and at the places more.
    rates: [Vec<Lanes>; 2],
    /// Coefficients of the polynomials of rates.
    coefficients: Vec<[Lanes; 2]>,
}

impl ExtensionOfOne {
    pub(in super::super) fn new(evaluated: usize) -> Self {
        let row = vec![Lanes([0.0; WIDTH]); evaluated];
        Self { rates: [row.clone(), row], coefficients: vec![[Lanes([0.0; WIDTH]); 2]; evaluated] }
    }
}

/// What stages and places more add to a row of lanes.
#[inline(always)]
fn sum<V: Vector8>(weights: &Rows, rates: &[Vec<Lanes>; 2], i: usize) -> V {
    combined::<V>(&weights[0], &rates[0][i]) + combined::<V>(&weights[1], &rates[1][i])
}

/// Writes the numbers at the stages or at the places more that rates lead to, and the times there.
#[inline(always)]
fn place<V: Vector8>(tables: &Extension, work: &mut Work<'_>, of: &ExtensionOfOne, to: usize) {
    let Work { form, velocity, machine, state, t, h, .. } = work;
    let (code, registers) = machine.parts();
    let evaluated = form.evaluated();
    let second_order = matches!(form, Form::SecondOrder(_));
    let (y, rest) = state.all();
    let (h, h2) = (V::splat(*h), V::splat(*h * *h));
    let passed = V::load(tables.places[to]) * h;
    registers[code.variables()] = (passed + V::splat(*t)).store();
    for i in 0..evaluated {
        let from = if second_order { evaluated + i } else { i };
        if second_order {
            let drift = passed.multiply_add(V::splat(y[from]), V::splat(rest[i]));
            let way = sum::<V>(&tables.way_of_way[to], &of.rates, i).multiply_add(h2, drift);
            registers[i] = (way + V::splat(y[i])).store();
        }
        if !second_order || *velocity {
            let way = sum::<V>(&tables.way[to], &of.rates, i).multiply_add(h, V::splat(rest[from]));
            registers[from] = (way + V::splat(y[from])).store();
        }
    }
}

/// Finds the extension of a step whose stages are found: whether its rates converge, and after how many evaluations.
#[inline(always)]
fn find_body<V: Vector8 + Scalar>(
    tables: &Extension,
    work: &mut Work<'_>,
    of: &mut ExtensionOfOne,
) -> (bool, u32) {
    let (evaluated, own, length) = (work.form.evaluated(), own_lanes(work.table.stages), work.h.abs());
    for i in 0..evaluated {
        of.rates[0][i] = work.stages.rates[i];
        of.rates[1][i] = combined::<V>(&tables.guess, &work.stages.rates[i]).store();
    }
    let mut changes = Changes::default();
    let (mut last, mut settled, mut evaluations) = (0.0, false, 0);
    for iteration in 1..=MOST_ITERATIONS {
        let mut change = V::zero();
        // Rates at the stages are those of the polynomial at first.
        for to in usize::from(iteration == 1)..2 {
            place::<V>(tables, work, of, to);
            let Work { machine, stages, .. } = &mut *work;
            let (code, registers) = machine.parts();
            execute::execute::<V, 1>(code, Part::Body, V::view_mut(registers));
            evaluations += 1;
            let outputs = code.output_registers();
            for i in 0..evaluated {
                let rate = &mut of.rates[to][i];
                let (found, before) = (V::load(registers[usize::from(outputs[i])]), V::load(*rate));
                // An end may have no rate, as on a pole of the coordinates: there is that of the polynomial.
                let found = V::select(found.abs().less_equal(V::splat(f64::MAX)), found, before);
                let scale = V::splat(Real::min(stages.measures[i], changes.limit) * (MOVED * length));
                let moved = V::select(own, (found - before).abs(), V::zero());
                change = larger(moved * scale, change);
                *rate = found.store();
            }
        }
        let change = largest(change.store());
        settled = change * change <= ENOUGH * last;
        last = change;
        if settled {
            break;
        }
        if let Some(converged) = changes.judged(change, || work.stages.limit()) {
            settled = converged;
            break;
        }
    }
    for (i, coefficients) in of.coefficients.iter_mut().enumerate() {
        for (coefficients, weights) in coefficients.iter_mut().zip(&tables.coefficients) {
            *coefficients = sum::<V>(weights, &of.rates, i).store();
        }
    }
    (settled, evaluations)
}

/// Σ over the terms of coefficients times integrals.
#[inline(always)]
fn summed<V: Vector8>(coefficients: &[Lanes; 2], integrals: &[Lanes; 2]) -> f64 {
    let high = V::load(coefficients[1]) * V::load(integrals[1]);
    V::load(coefficients[0]).multiply_add(V::load(integrals[0]), high).store().horizontal_sum()
}

/// Writes the state at a fraction of the step, which is `h` long.
#[inline(always)]
fn read_body<V: Vector8>(
    tables: &Extension,
    of: &ExtensionOfOne,
    (form, state): (Form, &State<f64>),
    (theta, h): (f64, f64),
    into: &mut State<f64>,
) {
    let [once, twice] = integrals(theta, tables.terms);
    let (once, twice) = (halves(&once), halves(&twice));
    let evaluated = form.evaluated();
    let (y, rest) = state.all();
    let (into, into_rest) = into.all_mut();
    for (i, coefficients) in of.coefficients.iter().enumerate() {
        let way = summed::<V>(coefficients, &once);
        match form {
            Form::FirstOrder(_) => (into[i], into_rest[i]) = two_sum(y[i], way.multiply_add(h, rest[i])),
            Form::SecondOrder(_) => {
                let v = evaluated + i;
                (into[v], into_rest[v]) = two_sum(y[v], way.multiply_add(h, rest[v]));
                let drift = y[v].multiply_add(theta * h, rest[i]);
                let way_of_way = summed::<V>(coefficients, &twice);
                (into[i], into_rest[i]) = two_sum(y[i], way_of_way.multiply_add(h * h, drift));
            }
        }
    }
}

/// What belongs to the first eight coefficients, and to the others.
#[inline(always)]
fn halves(all: &[f64; TERMS]) -> [Lanes; 2] {
    let (mut low, mut high) = ([0.0; WIDTH], [0.0; WIDTH]);
    low.copy_from_slice(&all[..WIDTH]);
    high.copy_from_slice(&all[WIDTH..]);
    [Lanes(low), Lanes(high)]
}

tiered! {
    pub(in super::super) fn find[][](tables: &Extension, work: &mut Work<'_>, of: &mut ExtensionOfOne) -> (bool, u32) = find_body;
    pub(in super::super) fn read[][](tables: &Extension, of: &ExtensionOfOne, from: (Form, &State<f64>), at: (f64, f64), into: &mut State<f64>) -> () = read_body;
}
