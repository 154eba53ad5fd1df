//! One step of a collocation method, for one trajectory: the lanes are its stages.
//!
//! The one idea: the right-hand side at all stages is one run of the code, so eight stages cost what one would. Stages begin
//! where the polynomial of the step before leads, and are iterated until nothing changes; of q'' = a(t, q, q') accelerations
//! alone are iterated, and coordinates follow by the square of the matrix.
//! E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical Integration* (2006), VIII.6.

use super::Table;
use super::pace::FADING;
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// Iterations after which stages are given up.
pub(super) const MOST_ITERATIONS: u32 = 60;
/// Below this, in units of how much a step changes a number, changes that no longer fall are round-off.
const ROUND_OFF: f64 = 1e-13;
/// As above, where the right-hand side itself has lost digits.
const STAGNATION: f64 = 1e-9;
/// Where a size turns out to be less than this part of what it seemed by the rates that stages began with, they are found again.
pub(super) const WILD: f64 = 0.125;
/// So many times at most.
pub(super) const AGAIN: u32 = 3;
/// So many changes in a row that are none of them smaller than all before: those of a spiral fall, but not one by one.
const NO_LONGER_FALLING: u32 = 5;
/// No number's scale is below this times the largest: noise on what stands still would never converge.
pub(super) const LEAST_SCALE: f64 = 1e-8;
/// Nor below this where no more is to be told than rounding: rates that are found together, as by a solution of linear
/// equations, are rounded by the largest of them, and what they give to what hardly moves beside it is noise.
const ROUNDED_SCALE: f64 = 1e-4;

/// What the stages of a step hold.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// Right-hand sides (accelerations, of the second order), a row of stages each.
    pub(super) rates: Vec<Lanes>,
    /// Where they began.
    pub(super) guess: Vec<Lanes>,
    /// The numbers that are iterated (velocities, of the second order).
    numbers: Vec<Lanes>,
    /// What one is measured by, inverted.
    pub(super) scales: Vec<f64>,
    /// How large numbers were and how far they went, lately.
    pub(super) sizes: Vec<f64>,
    /// The same with the step that is tried.
    pub(super) tried: Vec<f64>,
    /// What no size is less than, of a motion from rest.
    pub(super) least: Vec<f64>,
}

impl Stages {
    pub(super) fn new(evaluated: usize) -> Self {
        let row = vec![Lanes([0.0; WIDTH]); evaluated];
        Self {
            rates: row.clone(),
            guess: row.clone(),
            numbers: row,
            scales: vec![0.0; evaluated],
            sizes: vec![0.0; evaluated],
            tried: vec![0.0; evaluated],
            least: vec![0.0; evaluated],
        }
    }

    /// The most that anything is measured by, inverted, where rounding is not to count.
    pub(super) fn limit(&self) -> f64 {
        limit(self.scales.iter().copied())
    }

    /// Whether what stages were found by is far more than they came to: they began with wild rates, as of a way into a steep
    /// wall, and beside those anything has converged.
    fn began_wildly(&self, y: &[f64], h: f64, fading: f64) -> bool {
        let mut sizes = self.tried.iter().zip(&self.sizes).zip(&self.least).zip(&self.rates).zip(y);
        sizes.any(|((((&tried, &known), &least), rates), &y)| {
            size(y, rates, h, Real::max(fading * known, least)) < WILD * tried
        })
    }

    /// Remembers how large numbers were in the step that was tried. One that was not kept leaves what it met beside what was
    /// known: a motion from rest has no other size at first.
    pub(super) fn remember(&mut self, kept: bool) {
        for (size, &tried) in self.sizes.iter_mut().zip(&self.tried) {
            let before = FADING * *size;
            *size = if kept || tried > before { tried } else { before };
        }
    }
}

/// The most that anything is measured by beside these, inverted, where rounding is not to count.
#[inline(always)]
pub(super) fn limit(scales: impl Iterator<Item = f64>) -> f64 {
    scales.fold(f64::INFINITY, Real::min) * (1.0 / ROUNDED_SCALE)
}

/// What came of an iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Iterated {
    pub(super) converged: bool,
    pub(super) evaluations: u32,
}

/// How stages changed, iteration after iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Changes {
    last: f64,
    least: f64,
    in_vain: u32,
    /// The most that a change is measured by, inverted.
    pub(super) limit: f64,
}

impl Default for Changes {
    fn default() -> Self {
        Self { last: f64::INFINITY, least: f64::INFINITY, in_vain: 0, limit: f64::INFINITY }
    }
}

impl Changes {
    /// Whether the stages have converged, or never will; nothing while that is open. Where changes no longer fall that may be
    /// rounding, they are measured by the `limit` from there on.
    #[inline(always)]
    pub(super) fn judged(
        &mut self,
        iteration: u32,
        change: f64,
        limit: impl FnOnce() -> f64,
    ) -> Option<bool> {
        // The first change is from the numbers of another step, and tells nothing.
        if iteration == 0 {
            return None;
        }
        let stands = change >= self.last;
        self.in_vain = if change < self.least { 0 } else { self.in_vain + 1 };
        self.least = if change < self.least { change } else { self.least };
        self.last = change;
        let for_long = self.in_vain == NO_LONGER_FALLING;
        if change == 0.0 || (stands && change < ROUND_OFF) || (for_long && change < STAGNATION) {
            return Some(true);
        }
        if for_long && change < STAGNATION * (ROUNDED_SCALE / LEAST_SCALE) && self.limit == f64::INFINITY {
            *self = Self { limit: limit(), ..Self::default() };
            return None;
        }
        (!change.is_finite() || for_long).then_some(false)
    }
}

/// A step on its way.
pub(super) struct Work<'a> {
    pub(super) table: &'static Table,
    pub(super) form: Form,
    pub(super) machine: &'a mut Machine<Lanes>,
    pub(super) state: &'a State<f64>,
    pub(super) stages: &'a mut Stages,
    /// Its beginning, as the system counts time, and its length.
    pub(super) t: f64,
    pub(super) h: f64,
    /// What is left of the sizes of the step before it.
    pub(super) fading: f64,
}

/// Σ over the stages of `weights[stage] · values[stage]`, for each stage of a row.
#[inline(always)]
pub(super) fn combined<V: Vector8>(weights: &[Lanes; WIDTH], values: &Lanes) -> V {
    let (mut even, mut odd) = (V::zero(), V::zero());
    for j in 0..WIDTH / 2 {
        even = V::splat(values.0[j]).multiply_add(V::load(weights[j]), even);
        odd = V::splat(values.0[j + WIDTH / 2]).multiply_add(V::load(weights[j + WIDTH / 2]), odd);
    }
    even + odd
}

/// The largest of lanes that are none below zero; a NaN counts as infinite. Their bits are in the order of the numbers, and those
/// of a NaN beyond all.
#[inline(always)]
pub(super) fn largest(lanes: Lanes) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes.0.map(f64::to_bits);
    let largest = f64::from_bits(a.max(e).max(c.max(g)).max(b.max(f).max(d.max(h))));
    if largest.is_nan() { f64::INFINITY } else { largest }
}

/// How large a number is, or was before, and how far it goes in the step.
#[inline(always)]
fn size(y: f64, rates: &Lanes, h: f64, before: f64) -> f64 {
    let now = y.abs() + (h * largest(Lanes(rates.0.map(f64::abs)))).abs();
    // What overflows in a step that is too long is no size.
    if now > before && now < f64::INFINITY { now } else { before }
}

/// Sets what changes are measured by: how large a number is, or was lately, and how far it goes in the step.
#[inline(always)]
fn set_scales(stages: &mut Stages, y: &[f64], h: f64, fading: f64) {
    let mut most = 0.0;
    let sizes = stages.tried.iter_mut().zip(&stages.sizes).zip(&stages.least);
    for ((((tried, known), least), rates), y) in sizes.zip(&stages.rates).zip(y) {
        *tried = size(*y, rates, h, Real::max(fading * *known, *least));
        most = if *tried > most { *tried } else { most };
    }
    for (scale, &size) in stages.scales.iter_mut().zip(&stages.tried) {
        let size = if size > LEAST_SCALE * most { size } else { LEAST_SCALE * most };
        *scale = if size > 0.0 { 1.0 / size } else { 0.0 };
    }
}

/// Iterates the stages from `stages.rates` on until nothing changes.
#[inline(always)]
fn iterate_body<V: Vector8 + Scalar>(work: &mut Work<'_>) -> Iterated {
    let Work { table, form, machine, state, stages, t, h, fading } = work;
    let (code, registers) = machine.parts();
    let outputs = code.output_registers();
    let evaluated = form.evaluated();
    let second_order = matches!(form, Form::SecondOrder(_));
    let (y, rest) = state.all();
    let (h, h2) = (V::splat(*h), V::splat(*h * *h));
    let passed = V::load(table.c) * h;
    // Rounded alone, the way to a stage would err alike in every step, and the energy drift with their number.
    let passed_rest = V::load(table.c_rest).multiply_add(h, V::load(table.c).multiply_add(h, -passed));
    registers[code.variables()] = (passed + V::splat(*t)).store();
    let mut changes = Changes::default();
    for iteration in 0..MOST_ITERATIONS {
        let mut change = V::zero();
        for i in 0..evaluated {
            let from = if second_order { evaluated + i } else { i };
            let rates = &stages.rates[i];
            let number =
                combined::<V>(&table.a, rates).multiply_add(h, V::splat(rest[from])) + V::splat(y[from]);
            let scale = Real::min(stages.scales[i], changes.limit);
            change = change.max((number - V::load(stages.numbers[i])).abs() * V::splat(scale));
            stages.numbers[i] = number.store();
            registers[from] = number.store();
            if second_order {
                let v = V::splat(y[from]);
                let drift = passed.multiply_add(v, passed_rest.multiply_add(v, V::splat(rest[i])));
                let place = combined::<V>(&table.a2, rates).multiply_add(h2, drift) + V::splat(y[i]);
                registers[i] = place.store();
            }
        }
        let change = largest(change.store());
        if let Some(converged) = changes.judged(iteration, change, || stages.limit()) {
            return Iterated { converged, evaluations: iteration };
        }
        execute::execute::<V, 1>(code, Part::Body, V::view_mut(registers));
        for i in 0..evaluated {
            stages.rates[i] = registers[usize::from(outputs[i])];
        }
        if iteration == 0 {
            set_scales(stages, if second_order { &y[evaluated..] } else { y }, work.h, *fading);
        }
    }
    Iterated { converged: false, evaluations: MOST_ITERATIONS }
}

/// Finds the stages from `stages.rates` on, measured by what they come to.
pub(super) fn found(work: &mut Work<'_>) -> Iterated {
    let mut all = iterate(work);
    let y = work.form.measured(work.state.all().0);
    let wild = |work: &Work<'_>| work.stages.began_wildly(y, work.h, work.fading);
    for _ in 0..AGAIN {
        if !all.converged || !wild(work) {
            return all;
        }
        let again = iterate(work);
        all = Iterated { converged: again.converged, evaluations: all.evaluations + again.evaluations };
    }
    all.converged &= !wild(work);
    all
}

/// The weighted sum of the stages.
#[inline(always)]
fn weighted<V: Vector8>(weights: &[Lanes; 2], rates: &Lanes) -> f64 {
    let rates = V::load(*rates);
    let low = V::load(weights[1]) * rates;
    V::load(weights[0]).multiply_add(rates, low).store().horizontal_sum()
}

/// Writes the state at the end of the step.
#[inline(always)]
fn advance_body<V: Vector8>(work: &Work<'_>, next: &mut State<f64>) {
    let Work { table, form, state, stages, h, .. } = work;
    let evaluated = form.evaluated();
    let (y, rest) = state.all();
    let (next, next_rest) = next.all_mut();
    // A closure would be compiled without the tier's instructions.
    macro_rules! put {
        ($index:expr, $change:expr) => {{
            let (index, change) = ($index, $change);
            let sum = y[index] + change;
            let moved = sum - y[index];
            next_rest[index] = (y[index] - (sum - moved)) + (change - moved);
            next[index] = sum;
        }};
    }
    for i in 0..evaluated {
        let rates = &stages.rates[i];
        match form {
            Form::FirstOrder(_) => put!(i, weighted::<V>(&table.b, rates).mul_add(*h, rest[i])),
            Form::SecondOrder(_) => {
                let v = evaluated + i;
                put!(v, weighted::<V>(&table.b, rates).mul_add(*h, rest[v]));
                // h v is kept whole: rounded, it would err at every step to the same side of a slow motion.
                let drift = y[v] * *h;
                let lost = y[v].mul_add(*h, -drift);
                // So is h², of which the same holds.
                let (h2, moved) = (*h * *h, weighted::<V>(&table.b2, rates));
                let small = moved.mul_add(h.mul_add(*h, -h2), rest[v].mul_add(*h, rest[i] + lost));
                put!(i, drift + moved.mul_add(h2, small));
            }
        }
    }
}

/// Where the polynomial through the stages leads, to the stages of the next step or to other places.
#[inline(always)]
fn led_body<V: Vector8>(weights: &[Lanes; WIDTH], rates: &[Lanes], to: &mut [Lanes]) {
    for (to, rates) in to.iter_mut().zip(rates) {
        *to = combined::<V>(weights, rates).store();
    }
}

tiered! {
    fn iterate[][](work: &mut Work<'_>) -> Iterated = iterate_body;
    pub(super) fn advance[][](work: &Work<'_>, next: &mut State<f64>) -> () = advance_body;
    pub(super) fn led[][](weights: &[Lanes; WIDTH], rates: &[Lanes], to: &mut [Lanes]) -> () = led_body;
}
