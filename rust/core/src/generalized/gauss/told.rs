//! What eight steps tell: where the polynomials through their stages lead, how far they lead astray, what they miss and feel.
//!
//! The one idea: lanes are trajectories, as in [`columns`](super::columns), and every lane has what [`trial`](super::trial) asks
//! of one.

use super::Table;
use super::between::SHOWN;
use super::columns::{Columns, NOTHING, Row, combined, larger};
use super::decay::{FLAT, OF_NOISE};
use super::rounding::{HARDLY, ROUNDING};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::ode::system::Form;
use crate::tiered;

/// Where the polynomial through the stages leads, to the stages of the next steps.
#[inline(always)]
fn led_body<V: Vector8>(weights: &[Lanes; WIDTH], stages: usize, rates: &[Row], to: &mut [Row]) {
    for (to, row) in to.iter_mut().zip(rates) {
        for place in 0..stages {
            to[place] = combined!(stages, row, j => V::splat(weights[j].0[place])).store();
        }
    }
}

/// Where the polynomial through the stages leads, to these fractions of the step, in the lanes of the mask.
#[inline(always)]
fn led_to_body<V: Vector8>(table: &Table, fractions: &Row, lanes: Bits, rates: &[Row], to: &mut [Row]) {
    let stages = table.stages;
    for place in 0..stages {
        let x = V::load(fractions[place]);
        let mut weights = [V::zero(); WIDTH];
        for (k, weight) in weights.iter_mut().enumerate().take(stages) {
            *weight = V::splat(table.weights.0[k]);
            for j in (0..stages).filter(|&j| j != k) {
                *weight = *weight * (x - V::splat(table.c.0[j]));
            }
        }
        for (to, row) in to.iter_mut().zip(rates) {
            let led = combined!(stages, row, j => weights[j]);
            to[place] = V::select(lanes, led, V::load(to[place])).store();
        }
    }
}

/// The farthest that the stages are from where they began, in every lane.
#[inline(always)]
fn astray_body<V: Vector8>(rates: &Row, guess: &Row, stages: usize) -> Lanes {
    let mut most = V::zero();
    for (&rate, &guess) in rates.iter().zip(guess).take(stages) {
        most = larger((V::load(rate) - V::load(guess)).abs(), most);
    }
    most.store()
}

/// How far the polynomials of the steps before lead astray, as parts of sizes; in the first steps of these lanes, how much
/// their last terms add. What rounding explains, which is so many times the largest rate, is nothing, as is what noise does, so many
/// times which leads them astray.
#[inline(always)]
fn smoothness_body<V: Vector8>(
    table: &Table,
    columns: &Columns,
    (amplified, h): (Lanes, Lanes),
    first: Bits,
) -> Lanes {
    let stages = table.stages;
    let mut largest = V::zero();
    for row in &columns.rates {
        largest = V::load(astray_body::<V>(row, &NOTHING, stages)).max(largest);
    }
    let amplified = V::load(amplified);
    let (rounding, hardly) = (V::splat(ROUNDING) * amplified * largest, largest * V::splat(HARDLY));
    let mut most = V::zero();
    let rows = columns.rates.iter().zip(&columns.guess).zip(&columns.scales).zip(&columns.noise);
    for (((row, guess), &scale), &noise) in rows {
        let mut away = astray_body::<V>(row, guess, stages);
        for lane in 0..WIDTH {
            if first.lane(lane) {
                away.0[lane] = table.leading(|k| row[k].0[lane]);
            }
        }
        let away = V::load(away);
        let hardly_moves = V::load(astray_body::<V>(row, &NOTHING, stages)).less_equal(hardly);
        let away = V::select(away.less_equal(rounding).and(hardly_moves), V::zero(), away);
        let away = (away - amplified * V::load(noise)).max(V::zero());
        most = (away * V::load(h).abs() * V::load(scale)).max(most);
    }
    most.store()
}

/// Puts the rates of steps that were kept into the place of those before.
#[inline(always)]
fn kept_body<V: Vector8>(rates: &[Row], kept: Bits, before: &mut [Row]) {
    for (before, rates) in before.iter_mut().zip(rates) {
        for (before, &rate) in before.iter_mut().zip(rates) {
            *before = V::select(kept, V::load(rate), V::load(*before)).store();
        }
    }
}

/// By how much the step changes velocities, as parts of them, in every lane; of the first order, where rates that differ between
/// stages change numbers with the square of the step, the root of that.
#[inline(always)]
fn felt_body<V: Vector8>(form: Form, stages: usize, columns: &Columns, h: Lanes) -> Lanes {
    let second_order = matches!(form, Form::SecondOrder(_));
    let mut most = V::zero();
    for (row, &scale) in columns.rates.iter().zip(&columns.scales) {
        let beside = if second_order { V::zero() } else { V::load(row[0]) };
        for &rate in row.iter().take(stages) {
            most = larger((V::load(rate) - beside).abs() * V::load(h).abs() * V::load(scale), most);
        }
    }
    if second_order { most.store() } else { Lanes(most.store().0.map(f64::sqrt)) }
}

/// By how much rates that were found at the ends of steps are not those that the stages lead to, as parts of sizes; so many times
/// their noise is nothing.
#[inline(always)]
fn missed_body<V: Vector8>(
    (weights, noise): (&[Lanes; WIDTH], f64),
    stages: usize,
    columns: &Columns,
    found: &[Lanes],
    h: Lanes,
) -> Lanes {
    let mut most = V::zero();
    let limit = Lanes(core::array::from_fn(|lane| columns.limit(lane)));
    let rows = columns.rates.iter().zip(found).zip(&columns.scales).zip(&columns.noise);
    for (((row, &found), &scale), &own) in rows {
        let led = combined!(stages, row, j => V::load(weights[j]));
        let scale = V::load(scale).min(V::load(limit));
        let away = (V::load(found) - led).abs();
        let by_noise = V::splat(noise) * V::load(own);
        let away = V::select(away.less(by_noise), V::zero(), away - by_noise);
        most = larger(away * V::load(h).abs() * scale, most);
    }
    most.store()
}

/// By how much steps err, as [`error_of_mean`](super::decay::error_of_mean) has it of one, as parts of sizes; of what was looked
/// at between the stages, where that shows it.
#[inline(always)]
fn errors_body<V: Vector8>(
    weights: &[Lanes; WIDTH],
    stages: usize,
    columns: &Columns,
    missed: Option<(&[Lanes], f64)>,
    h: Lanes,
) -> Lanes {
    let limit = Lanes(core::array::from_fn(|lane| columns.limit(lane)));
    let mut most = V::zero();
    let rows = columns.rates.iter().zip(&columns.scales).zip(&columns.noise);
    for (i, ((row, &scale), &noise)) in rows.enumerate() {
        macro_rules! coefficient {
            ($place:expr) => {
                combined!(stages, row, j => V::splat(weights[j].0[$place])).abs()
            };
        }
        let before = coefficient!(4).max(coefficient!(5));
        let last = coefficient!(6).max(coefficient!(7)) - V::splat(OF_NOISE) * V::load(noise);
        let fall = last / (V::splat(FLAT) * before);
        let square = fall * fall;
        let error = V::select(fall.less(V::one()), last * (square * square * fall), last);
        let error = V::select(V::zero().less(last), error, V::zero());
        let part = error * V::load(h).abs() * V::load(scale).min(V::load(limit));
        let part = match missed {
            Some((missed, of_noise)) => {
                let missed = V::load(missed[i]) - V::splat(of_noise) * V::load(noise);
                V::select((V::splat(SHOWN) * last).less_equal(missed), part, V::zero())
            }
            None => part,
        };
        most = V::select(most.less(part), part, most);
    }
    most.store()
}

tiered! {
    pub(super) fn smoothness[][](table: &Table, columns: &Columns, of: (Lanes, Lanes), first: Bits) -> Lanes = smoothness_body;
    pub(super) fn kept[][](rates: &[Row], kept: Bits, before: &mut [Row]) -> () = kept_body;
    pub(super) fn led[][](weights: &[Lanes; WIDTH], stages: usize, rates: &[Row], to: &mut [Row]) -> () = led_body;
    pub(super) fn led_to[][](table: &Table, fractions: &Row, lanes: Bits, rates: &[Row], to: &mut [Row]) -> () = led_to_body;
    pub(super) fn missed[][](weights: (&[Lanes; WIDTH], f64), stages: usize, columns: &Columns, found: &[Lanes], h: Lanes) -> Lanes = missed_body;
    pub(super) fn errors[][](weights: &[Lanes; WIDTH], stages: usize, columns: &Columns, missed: Option<(&[Lanes], f64)>, h: Lanes) -> Lanes = errors_body;
    pub(super) fn felt[][](form: Form, stages: usize, columns: &Columns, h: Lanes) -> Lanes = felt_body;
}
