//! One step of a collocation method, for one trajectory: the lanes are its stages.
//!
//! The one idea: the right-hand side at all stages is one run of the code, so eight stages cost what one would. Stages begin
//! where the polynomial of the step before leads, and are iterated until nothing changes; of q'' = a(t, q, q') accelerations
//! alone are iterated, and coordinates follow by the square of the matrix.
//! E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical Integration* (2006), VIII.6.

use super::Table;
use super::changes::Changes;
use super::columns::larger;
use super::noise;
use super::pace::FADING;
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// Iterations after which stages are given up.
pub(super) const MOST_ITERATIONS: u32 = 60;
/// Where a size turns out to be less than this part of what it seemed by the rates that stages began with, they are found again.
pub(super) const WILD: f64 = 0.125;
/// So many times at most.
pub(super) const AGAIN: u32 = 3;
/// No number's scale is below this times the largest: noise on what stands still would never converge.
pub(super) const LEAST_SCALE: f64 = 1e-8;
/// Nor below this where no more is to be told than rounding: rates that are found together, as by a solution of linear
/// equations, are rounded by the largest of them, and what they give to what hardly moves beside it is noise.
pub(super) const ROUNDED_SCALE: f64 = 1e-4;

/// A way by no more than this part of a coordinate tells nothing of the force that it is by: polynomials that lead ahead make
/// some thousand times as much of its rounding, and of that steps are to feel no more than a hundredth.
pub(super) const UNFELT: f64 = 262_144.0 * f64::EPSILON;

/// What the stages of a step hold.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// Right-hand sides (accelerations, of the second order), a row of stages each.
    pub(super) rates: Vec<Lanes>,
    /// Where they began.
    pub(super) guess: Vec<Lanes>,
    /// Where the stages of the second order would be without accelerations, from the coordinates.
    drifts: Vec<Lanes>,
    /// Of each number the largest rate of a step, and the farthest that rates are from where they began.
    pub(super) told: Vec<(f64, f64)>,
    /// What one is measured by, inverted.
    pub(super) scales: Vec<f64>,
    /// The same of its changes: noise is no change.
    pub(super) measures: Vec<f64>,
    /// How noisy rates are, where that was asked for.
    pub(super) noise: Vec<f64>,
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
            drifts: row,
            told: vec![(0.0, 0.0); evaluated],
            scales: vec![0.0; evaluated],
            measures: vec![0.0; evaluated],
            noise: vec![0.0; evaluated],
            sizes: vec![0.0; evaluated],
            tried: vec![0.0; evaluated],
            least: vec![0.0; evaluated],
        }
    }

    /// The most that anything is measured by, inverted, where rounding is not to count.
    #[inline]
    pub(super) fn limit(&self) -> f64 {
        limit(self.scales.iter().copied())
    }

    /// Remembers how large numbers were in the step that was tried. One that was not kept leaves what it met beside what was
    /// known: a motion from rest has no other size at first.
    #[inline]
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
    /// By what the last one changed the stages, as a part of sizes.
    pub(super) change: f64,
    /// The most that one left of a change.
    pub(super) left: f64,
}

/// A step on its way.
pub(super) struct Work<'a> {
    pub(super) table: &'static Table,
    pub(super) form: Form,
    /// Whether accelerations look at velocities.
    pub(super) velocity: bool,
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
    let [a, b, c, d, e, f, g, h] = lanes.0;
    let larger = |x: f64, y: f64| f64::from_bits(x.to_bits().max(y.to_bits()));
    let largest = larger(larger(larger(a, e), larger(c, g)), larger(larger(b, f), larger(d, h)));
    if largest.is_nan() { f64::INFINITY } else { largest }
}

/// How large a number is, or was before, and how far it goes in the step.
#[inline(always)]
fn size<V: Vector8>(y: f64, rates: &Lanes, h: f64, before: f64) -> f64 {
    let now = y.abs() + (h * largest(V::load(*rates).abs().store())).abs();
    // What overflows in a step that is too long is no size.
    if now > before && now < f64::INFINITY { now } else { before }
}

/// The velocity that moves a coordinate of the second order by what its rounding makes of forces: where less is all there is,
/// as beside an unstable equilibrium, forces are noise, and no step would be short enough for it.
#[inline(always)]
fn unfelt(form: Form, y: &[f64], i: usize, h: f64) -> f64 {
    match form {
        Form::FirstOrder(_) => 0.0,
        Form::SecondOrder(_) => UNFELT * (y[i] / h).abs(),
    }
}

/// Sets what changes are measured by: how large a number is, or was lately, and how far it goes in the step.
#[inline(always)]
fn set_scales<V: Vector8>(
    stages: &mut Stages,
    (rates, outputs): (&[Lanes], &[u16]),
    (form, y): (Form, &[f64]),
    h: f64,
    fading: f64,
) {
    let mut most = 0.0;
    let now = form.measured(y);
    // Indices: several iterators zipped are functions of their own, which a loop of a few numbers pays for.
    for i in 0..stages.tried.len() {
        let least = Real::max(stages.least[i], unfelt(form, y, i, h));
        let known = Real::max(fading * stages.sizes[i], least);
        let tried = size::<V>(now[i], &rates[usize::from(outputs[i])], h, known);
        stages.tried[i] = tried;
        most = if tried > most { tried } else { most };
    }
    for i in 0..stages.tried.len() {
        let size = stages.tried[i];
        let size = if size > LEAST_SCALE * most { size } else { LEAST_SCALE * most };
        stages.scales[i] = if size > 0.0 { 1.0 / size } else { 0.0 };
        stages.measures[i] = Real::min(stages.scales[i], noise::cap(stages.noise[i], h));
    }
}

/// Iterates the stages from `stages.rates` on until nothing changes.
#[inline(always)]
fn iterate_body<V: Vector8 + Scalar>(work: &mut Work<'_>) -> Iterated {
    let Work { table, form, velocity, machine, state, stages, t, h, fading } = work;
    let (code, registers) = machine.parts();
    let outputs = code.output_registers();
    let evaluated = form.evaluated();
    let second_order = matches!(form, Form::SecondOrder(_));
    let (y, rest) = state.all();
    let (length, all_move) = (h.abs(), !second_order || *velocity);
    let (h, h2) = (V::splat(*h), V::splat(*h * *h));
    let passed = V::load(table.c) * h;
    // Rounded alone, the way to a stage would err alike in every step, and the energy drift with their number.
    let passed_rest = V::load(table.c_rest).multiply_add(h, V::load(table.c).multiply_add(h, -passed));
    registers[code.variables()] = (passed + V::splat(*t)).store();
    if second_order {
        for (i, drift) in stages.drifts.iter_mut().enumerate() {
            let v = V::splat(y[evaluated + i]);
            *drift = passed.multiply_add(v, passed_rest.multiply_add(v, V::splat(rest[i]))).store();
        }
    }
    // What is read where the code has left it is there sooner than a copy of it, if no state is written there.
    let stay = outputs.iter().all(|&output| usize::from(output) > code.variables());
    let mut changes = Changes::default();
    for iteration in 1..=MOST_ITERATIONS {
        for i in 0..evaluated {
            let found = iteration > 1 && stay;
            let rates = if found { &registers[usize::from(outputs[i])] } else { &stages.rates[i] };
            let mut moved = V::zero();
            let from = if second_order { evaluated + i } else { i };
            if all_move {
                let sum = combined::<V>(&table.a, rates);
                moved = sum.multiply_add(h, V::splat(rest[from])) + V::splat(y[from]);
            }
            if second_order {
                let sum = combined::<V>(&table.a2, rates);
                let place = sum.multiply_add(h2, V::load(stages.drifts[i])) + V::splat(y[i]);
                registers[i] = place.store();
            }
            if all_move {
                registers[from] = moved.store();
            }
        }
        execute::execute::<V, 1>(code, Part::Body, V::view_mut(registers));
        if iteration == 1 {
            set_scales::<V>(stages, (registers, outputs), (*form, y), work.h, *fading);
        }
        let mut change = V::zero();
        let own = own_lanes(table.stages);
        for i in 0..evaluated {
            let found = V::load(registers[usize::from(outputs[i])]);
            let scale = V::splat(Real::min(stages.measures[i], changes.limit) * length);
            let moved = V::select(own, (found - V::load(stages.rates[i])).abs(), V::zero());
            change = larger(moved * scale, change);
            stages.rates[i] = found.store();
        }
        let change = largest(change.store());
        if let Some(converged) = changes.judged(change, || stages.limit()) {
            return Iterated { converged, evaluations: iteration, change, left: changes.left };
        }
    }
    Iterated { converged: false, evaluations: MOST_ITERATIONS, change: f64::INFINITY, left: changes.left }
}

/// Whether what stages were found by is far more than they came to: they began with wild rates, as of a way into a steep wall,
/// and beside those anything has converged.
#[inline(always)]
fn began_wildly_body<V: Vector8>(work: &Work<'_>) -> bool {
    let Work { form, state, stages, h, fading, .. } = work;
    let y = state.all().0;
    let now = form.measured(y);
    for i in 0..stages.tried.len() {
        let least = Real::max(stages.least[i], unfelt(*form, y, i, *h));
        let known = Real::max(*fading * stages.sizes[i], least);
        if size::<V>(now[i], &stages.rates[i], *h, known) < WILD * stages.tried[i] {
            return true;
        }
    }
    false
}

/// Finds the stages from `stages.rates` on, measured by what they come to.
pub(super) fn found(work: &mut Work<'_>) -> Iterated {
    let mut all = iterate(work);
    for _ in 0..AGAIN {
        if !all.converged || !began_wildly(work) {
            return all;
        }
        let again = iterate(work);
        all = Iterated { evaluations: all.evaluations + again.evaluations, ..again };
    }
    all.converged &= !began_wildly(work);
    all
}

/// The lanes of so many stages.
#[inline(always)]
pub(super) fn own_lanes(stages: usize) -> Bits {
    Bits(u8::MAX >> (WIDTH - stages))
}

/// Sets what the stages, so many of the lanes, tell of each number.
#[inline(always)]
fn told_body<V: Vector8>(stages: &mut Stages, count: usize) {
    let own = own_lanes(count);
    for i in 0..stages.told.len() {
        let (rates, guess) = (V::load(stages.rates[i]), V::load(stages.guess[i]));
        let most = V::select(own, rates.abs(), V::zero()).store();
        let astray = V::select(own, (rates - guess).abs(), V::zero()).store();
        stages.told[i] = (largest(most), largest(astray));
    }
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
    for (i, to) in to.iter_mut().enumerate() {
        *to = combined::<V>(weights, &rates[i]).store();
    }
}

tiered! {
    fn iterate[][](work: &mut Work<'_>) -> Iterated = iterate_body;
    fn began_wildly[][](work: &Work<'_>) -> bool = began_wildly_body;
    pub(super) fn told[][](stages: &mut Stages, count: usize) -> () = told_body;
    pub(super) fn advance[][](work: &Work<'_>, next: &mut State<f64>) -> () = advance_body;
    pub(super) fn led[][](weights: &[Lanes; WIDTH], rates: &[Lanes], to: &mut [Lanes]) -> () = led_body;
}
