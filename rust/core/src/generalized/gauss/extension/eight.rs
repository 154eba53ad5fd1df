//! The continuous extensions of steps of eight trajectories: a lane is a trajectory, with the operations that it has alone
//! ([`one`](super::one)), in their order.

use super::super::changes::Changes;
use super::super::columns::{AT_ONCE, NOTHING, Row, Work, combined, larger};
use super::super::step::MOST_ITERATIONS;
use super::{Extension, MOVED, TERMS, integrals};
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
    /// Rates at the places more.
    rates: Vec<Row>,
    /// Where the stages alone lead there, as of one trajectory, and where all rates do.
    led: [Vec<Row>; 2],
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
        let pair = [rows.clone(), rows.clone()];
        Self {
            rates: rows,
            led: pair.clone(),
            there: pair,
            changed: vec![Lanes::zero(); evaluated],
            coefficients: vec![[Lanes::zero(); TERMS]; evaluated],
        }
    }
}

/// Where the stages alone lead, and the rates to begin with.
#[inline(always)]
fn begin<V: Vector8>(tables: &Extension, work: &Work<'_>, of: &mut ExtensionOfEight) {
    let Work { table, form, state, columns, h, running, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let (y, rest) = state.all();
    let (stages, h) = (table.stages, V::load(*h));
    let h2 = h * h;
    for i in 0..evaluated {
        let (row, from) = (&columns.rates[i], if second_order { evaluated + i } else { i });
        for k in 0..stages {
            let guess = combined!(stages, row, j => V::splat(tables.guess[j].0[k]));
            of.rates[i][k] = V::select(*running, guess, V::load(of.rates[i][k])).store();
            let way = combined!(stages, row, j => V::splat(tables.way[0][j].0[k]));
            of.led[0][i][k] = way.multiply_add(h, V::load(rest[from])).store();
            if second_order {
                let passed = V::splat(tables.places.0[k]) * h;
                let drift = passed.multiply_add(V::load(y[from]), V::load(rest[i]));
                let way_of_way = combined!(stages, row, j => V::splat(tables.way_of_way[0][j].0[k]));
                of.led[1][i][k] = way_of_way.multiply_add(h2, drift).store();
            }
        }
    }
}

/// Writes the numbers at all places that rates lead to.
#[inline(always)]
fn place<V: Vector8>(tables: &Extension, work: &Work<'_>, of: &mut ExtensionOfEight) {
    let Work { table, form, velocity, state, h, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let y = state.all().0;
    let (stages, h) = (table.stages, V::load(*h));
    let h2 = h * h;
    for i in 0..evaluated {
        let (row, from) = (&of.rates[i], if second_order { evaluated + i } else { i });
        for k in 0..stages {
            if second_order {
                let sum = combined!(stages, row, j => V::splat(tables.way_of_way[1][j].0[k]));
                let place = sum.multiply_add(h2, V::load(of.led[1][i][k])) + V::load(y[i]);
                of.there[1][i][k] = place.store();
            }
            if !second_order || *velocity {
                let sum = combined!(stages, row, j => V::splat(tables.way[1][j].0[k]));
                let moved = sum.multiply_add(h, V::load(of.led[0][i][k])) + V::load(y[from]);
                of.there[0][i][k] = moved.store();
            }
        }
    }
}

/// Evaluates rates at all places, in the lanes of the mask.
#[inline(always)]
fn evaluate<V: Vector8 + Scalar>(
    tables: &Extension,
    work: &mut Work<'_>,
    of: &mut ExtensionOfEight,
    active: Bits,
) {
    let Work { table, form, velocity, machine, h, t, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let (stages, h, t) = (table.stages, V::load(*h), V::load(*t));
    let (code, registers) = machine.parts();
    let (variables, outputs) = (code.variables(), code.output_registers());
    of.changed.fill(Lanes::zero());
    for first in (0..stages).step_by(AT_ONCE) {
        for block in 0..AT_ONCE {
            let k = (first + block).min(stages - 1);
            registers[variables * AT_ONCE + block] = (V::splat(tables.places.0[k]) * h + t).store();
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
                let rate = &mut of.rates[i][first + block];
                let before = V::load(*rate);
                // As of one trajectory: an end may have no rate.
                let is_a_number = (found - found).less_equal(V::zero());
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
    let mut limit = Lanes::splat(f64::INFINITY);
    let mut settled = FoundOfEight { converged: Bits::splat(false), evaluations: [MOST_ITERATIONS; WIDTH] };
    let mut active = running;
    for iteration in 1..=MOST_ITERATIONS {
        place::<V>(tables, work, of);
        evaluate::<V>(tables, work, of, active);
        let length = V::splat(MOVED) * V::load(work.h).abs();
        let mut most = V::zero();
        for (&measure, &changed) in work.columns.measures.iter().zip(&of.changed) {
            let scale = V::load(measure).min(V::load(limit)) * length;
            most = larger(V::load(changed) * scale, most);
        }
        let most = most.store();
        let open = active;
        for lane in (0..WIDTH).filter(|&lane| open.lane(lane)) {
            let judged = changes[lane].judged(most.0[lane], || work.columns.limit(lane));
            limit.0[lane] = changes[lane].limit;
            if let Some(converged) = judged {
                let alone = Bits(1 << lane);
                settled.evaluations[lane] = iteration;
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
            let [by_stages, by_places] = &tables.coefficients[term / WIDTH];
            let (own, row) = (term % WIDTH, &work.columns.rates[i]);
            let by_stages = combined!(stages, row, j => V::splat(by_stages[j].0[own]));
            let row = &of.rates[i];
            let found = by_stages + combined!(stages, row, j => V::splat(by_places[j].0[own]));
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
