//! The continuous extensions of steps of eight trajectories: a lane is a trajectory, with the operations that it has alone
//! ([`one`](super::one)), in their order.

use super::super::changes::Changes;
use super::super::columns::{AT_ONCE, NOTHING, Row, Work, combined, larger};
use super::super::step::MOST_ITERATIONS;
use super::{ENOUGH, Extension, MOVED, Rows, TERMS, integrals};
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::double_double::two_sum;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// What is found of eight steps.
#[derive(Clone, Debug)]
pub(in super::super) struct ExtensionOfEight {
    /// Rates at the stages, and at the places more.
    rates: [Vec<Row>; 2],
    /// The numbers whose rates these are, and the coordinates of the second order, at the stages or at the places more.
    there: [Vec<Row>; 2],
    /// The most by which an iteration changed rates.
    changed: Vec<Lanes>,
    /// Coefficients of the polynomials of rates.
    coefficients: Vec<[Lanes; TERMS]>,
}

/// What came of it in the lanes.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct FoundOfEight {
    pub(in super::super) converged: Bits,
    pub(in super::super) evaluations: [u32; WIDTH],
}

impl ExtensionOfEight {
    pub(in super::super) fn new(evaluated: usize) -> Self {
        let rows = vec![NOTHING; evaluated];
        let pair = [rows.clone(), rows];
        Self {
            rates: pair.clone(),
            there: pair,
            changed: vec![Lanes::zero(); evaluated],
            coefficients: vec![[Lanes::zero(); TERMS]; evaluated],
        }
    }
}

/// What stages and places more add to a lane of a row, in the order of one trajectory.
macro_rules! sum {
    ($stages:expr, $weights:expr, $rates:expr, $i:expr, $lane:expr) => {{
        let (weights, rates): (&Rows, &[Vec<Row>; 2]) = ($weights, $rates);
        let (own, more) = (&rates[0][$i], &rates[1][$i]);
        combined!($stages, own, j => V::splat(weights[0][j].0[$lane]))
            + combined!($stages, more, j => V::splat(weights[1][j].0[$lane]))
    }};
}

/// The rates to begin with, in the lanes that run.
#[inline(always)]
fn begin<V: Vector8>(tables: &Extension, work: &Work<'_>, of: &mut ExtensionOfEight) {
    let Work { table, columns, running, .. } = work;
    let stages = table.stages;
    let [own, more] = &mut of.rates;
    for ((row, own), more) in columns.rates.iter().zip(own).zip(more) {
        for k in 0..stages {
            own[k] = V::select(*running, V::load(row[k]), V::load(own[k])).store();
            let guess = combined!(stages, row, j => V::splat(tables.guess[j].0[k]));
            more[k] = V::select(*running, guess, V::load(more[k])).store();
        }
    }
}

/// Writes the numbers at the stages or at the places more that rates lead to.
#[inline(always)]
fn place<V: Vector8>(tables: &Extension, work: &Work<'_>, of: &mut ExtensionOfEight, to: usize) {
    let Work { table, form, velocity, state, h, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let (y, rest) = state.all();
    let (stages, h) = (table.stages, V::load(*h));
    let h2 = h * h;
    for i in 0..evaluated {
        let from = if second_order { evaluated + i } else { i };
        for k in 0..stages {
            if second_order {
                let passed = V::splat(tables.places[to].0[k]) * h;
                let drift = passed.multiply_add(V::load(y[from]), V::load(rest[i]));
                let way = sum!(stages, &tables.way_of_way[to], &of.rates, i, k).multiply_add(h2, drift);
                of.there[1][i][k] = (way + V::load(y[i])).store();
            }
            if !second_order || *velocity {
                let way = sum!(stages, &tables.way[to], &of.rates, i, k).multiply_add(h, V::load(rest[from]));
                of.there[0][i][k] = (way + V::load(y[from])).store();
            }
        }
    }
}

/// Evaluates rates at the stages or at the places more, in the lanes of the mask.
#[inline(always)]
fn evaluate<V: Vector8 + Scalar>(
    tables: &Extension,
    work: &mut Work<'_>,
    of: &mut ExtensionOfEight,
    (to, active): (usize, Bits),
) {
    let Work { table, form, velocity, machine, h, t, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let (stages, h, t) = (table.stages, V::load(*h), V::load(*t));
    let (code, registers) = machine.parts();
    let (variables, outputs) = (code.variables(), code.output_registers());
    for first in (0..stages).step_by(AT_ONCE) {
        for block in 0..AT_ONCE {
            let k = (first + block).min(stages - 1);
            registers[variables * AT_ONCE + block] = (V::splat(tables.places[to].0[k]) * h + t).store();
            for i in 0..evaluated {
                if second_order {
                    registers[i * AT_ONCE + block] = of.there[1][i][k];
                }
                if !second_order || *velocity {
                    let from = if second_order { evaluated + i } else { i };
                    registers[from * AT_ONCE + block] = of.there[0][i][k];
                }
            }
        }
        execute::execute::<V, AT_ONCE>(code, Part::Body, V::view_mut(registers));
        for i in 0..evaluated {
            let mut most = V::load(of.changed[i]);
            for block in 0..AT_ONCE.min(stages - first) {
                let found = V::load(registers[usize::from(outputs[i]) * AT_ONCE + block]);
                let rate = &mut of.rates[to][i][first + block];
                let before = V::load(*rate);
                // As of one trajectory: an end may have no rate.
                let is_a_number = found.abs().less_equal(V::splat(f64::MAX));
                let found = V::select(is_a_number.and(active), found, before);
                most = larger((found - before).abs(), most);
                *rate = found.store();
            }
            of.changed[i] = most.store();
        }
    }
}

/// Finds the extensions of steps whose stages are found, in the lanes that run.
#[inline(always)]
fn find_body<V: Vector8 + Scalar>(
    tables: &Extension,
    work: &mut Work<'_>,
    of: &mut ExtensionOfEight,
) -> FoundOfEight {
    let (stages, running) = (work.table.stages, work.running);
    begin::<V>(tables, work, of);
    let mut changes = [Changes::default(); WIDTH];
    let (mut last, mut limit) = (Lanes::zero(), Lanes::splat(f64::INFINITY));
    let mut settled = FoundOfEight { converged: Bits::splat(false), evaluations: [0; WIDTH] };
    let mut active = running;
    for iteration in 1..=MOST_ITERATIONS {
        of.changed.fill(Lanes::zero());
        let first = usize::from(iteration == 1);
        for to in first..2 {
            place::<V>(tables, work, of, to);
            evaluate::<V>(tables, work, of, (to, active));
        }
        let length = V::splat(MOVED) * V::load(work.h).abs();
        let mut most = V::zero();
        for (&measure, &changed) in work.columns.measures.iter().zip(&of.changed) {
            let scale = V::load(measure).min(V::load(limit)) * length;
            most = larger(V::load(changed) * scale, most);
        }
        let most = most.store();
        let open = active;
        for lane in (0..WIDTH).filter(|&lane| open.lane(lane)) {
            settled.evaluations[lane] += 2 - first as u32;
            let change = most.0[lane];
            let enough = change * change <= ENOUGH * last.0[lane];
            last.0[lane] = change;
            let judged =
                if enough { Some(true) } else { changes[lane].judged(change, || work.columns.limit(lane)) };
            limit.0[lane] = changes[lane].limit;
            if let Some(converged) = judged {
                let alone = Bits(1 << lane);
                settled.converged = if converged { settled.converged.or(alone) } else { settled.converged };
                active = active.and(alone.not());
            }
        }
        if !active.any() {
            break;
        }
    }
    for (i, coefficients) in of.coefficients.iter_mut().enumerate() {
        for (term, coefficient) in coefficients.iter_mut().enumerate().take(tables.terms) {
            let found = sum!(stages, &tables.coefficients[term / WIDTH], &of.rates, i, term % WIDTH);
            *coefficient = V::select(running, found, V::load(*coefficient)).store();
        }
    }
    settled
}

/// Σ over the terms of coefficients times integrals, in the order of [`Lanes::horizontal_sum`].
#[inline(always)]
fn summed<V: Vector8>(coefficients: &[Lanes; TERMS], integrals: &[V; TERMS]) -> V {
    let mut sums = [V::zero(); WIDTH];
    for (term, sum) in sums.iter_mut().enumerate() {
        let high = V::load(coefficients[WIDTH + term]) * integrals[WIDTH + term];
        *sum = V::load(coefficients[term]).multiply_add(integrals[term], high);
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Writes the states at fractions of the steps, which are `h` long.
#[inline(always)]
fn read_body<V: Vector8>(
    tables: &Extension,
    of: &ExtensionOfEight,
    (form, state): (Form, &State<Lanes>),
    (theta, h): (Lanes, Lanes),
    into: &mut State<Lanes>,
) {
    let (theta, h) = (V::load(theta), V::load(h));
    let [once, twice] = integrals(theta, tables.terms);
    let evaluated = form.evaluated();
    let (y, rest) = state.all();
    let (into, into_rest) = into.all_mut();
    for (i, coefficients) in of.coefficients.iter().enumerate() {
        let v = if matches!(form, Form::SecondOrder(_)) { evaluated + i } else { i };
        let (speed, left) = (V::load(y[v]), V::load(rest[v]));
        let (sum, lost) = two_sum(speed, summed(coefficients, &once).multiply_add(h, left));
        (into[v], into_rest[v]) = (sum.store(), lost.store());
        if v != i {
            let drift = speed.multiply_add(theta * h, V::load(rest[i]));
            let (sum, lost) = two_sum(V::load(y[i]), summed(coefficients, &twice).multiply_add(h * h, drift));
            (into[i], into_rest[i]) = (sum.store(), lost.store());
        }
    }
}

tiered! {
    pub(in super::super) fn find[][](tables: &Extension, work: &mut Work<'_>, of: &mut ExtensionOfEight) -> FoundOfEight = find_body;
    pub(in super::super) fn read[][](tables: &Extension, of: &ExtensionOfEight, from: (Form, &State<Lanes>), at: (Lanes, Lanes), into: &mut State<Lanes>) -> () = read_body;
}
