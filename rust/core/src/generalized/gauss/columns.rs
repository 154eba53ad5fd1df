//! One step of a collocation method, for eight trajectories: a lane is a trajectory, and a block of registers is a stage.
//!
//! The one idea: every lane does the operations that [`step`](super::step) does for one trajectory, in their order, and what
//! has converged stands still under a mask while the others go on, so a copy has the bits that it has alone. Stages go through
//! the code four at a time, which share what is interpreted.

use super::Table;
use super::changes::Changes;
use super::noise;
use super::pace::FADING;
use super::step::{AGAIN, LEAST_SCALE, MOST_ITERATIONS, UNFELT, WILD, limit};
use crate::expressions::execute::{self, Part, Scalar};
use crate::expressions::machine::Blocks;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// Stages that go through the code at once.
pub(super) const AT_ONCE: usize = 4;

/// A number at all stages.
pub(super) type Row = [Lanes; WIDTH];

/// A number at all stages, where it is nothing.
pub(super) const NOTHING: Row = [Lanes([0.0; WIDTH]); WIDTH];

/// What the stages of eight steps hold.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// Right-hand sides (accelerations, of the second order).
    pub(super) rates: Vec<Row>,
    /// Where they began.
    pub(super) guess: Vec<Row>,
    /// The numbers whose rates these are (velocities, of the second order), and the coordinates of the second order.
    numbers: Vec<Row>,
    places: Vec<Row>,
    /// Where those would be without accelerations, from the coordinates.
    drifts: Vec<Row>,
    /// The most by which an iteration moved rates.
    moved: Vec<Lanes>,
    /// What a number is measured by, inverted.
    pub(super) scales: Vec<Lanes>,
    /// The same of its changes: noise is no change.
    pub(super) measures: Vec<Lanes>,
    /// How noisy rates are, where that was asked for.
    pub(super) noise: Vec<Lanes>,
    /// How large numbers were and how far they went, lately.
    pub(super) sizes: Vec<Lanes>,
    /// The same with the steps that are tried.
    pub(super) tried: Vec<Lanes>,
    /// What no size is less than, of motions from rest.
    pub(super) least: Vec<Lanes>,
}

impl Columns {
    pub(super) fn new(evaluated: usize) -> Self {
        let (rows, row) = (vec![NOTHING; evaluated], vec![Lanes([0.0; WIDTH]); evaluated]);
        Self {
            rates: rows.clone(),
            guess: rows.clone(),
            numbers: rows.clone(),
            places: rows.clone(),
            drifts: rows,
            moved: row.clone(),
            scales: row.clone(),
            measures: row.clone(),
            noise: row.clone(),
            sizes: row.clone(),
            tried: row.clone(),
            least: row,
        }
    }

    /// The most that anything is measured by, inverted, where rounding is not to count, of one trajectory.
    #[inline]
    pub(super) fn limit(&self, lane: usize) -> f64 {
        limit(self.scales.iter().map(|scale| scale.0[lane]))
    }

    /// Remembers how large numbers were in the steps that were tried, as for one trajectory.
    pub(super) fn remember(&mut self, tried: Bits, kept: Bits) {
        remembered(self, tried, kept);
    }
}

/// What came of an iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settled {
    pub(super) converged: Bits,
    pub(super) evaluations: [u32; WIDTH],
    /// By what the last one changed the stages, as parts of sizes.
    pub(super) change: Lanes,
    /// The most that one left of a change.
    pub(super) left: Lanes,
}

/// Steps on their way.
pub(super) struct Work<'a> {
    pub(super) table: &'static Table,
    pub(super) form: Form,
    /// Whether accelerations look at velocities.
    pub(super) velocity: bool,
    pub(super) machine: &'a mut Blocks<AT_ONCE>,
    pub(super) state: &'a State<Lanes>,
    pub(super) columns: &'a mut Columns,
    /// Their beginnings, as the system counts time, and their lengths.
    pub(super) t: Lanes,
    pub(super) h: Lanes,
    /// What is left of the sizes of the steps before them.
    pub(super) fading: Lanes,
    /// The lanes that take one.
    pub(super) running: Bits,
}

impl Table {
    /// The stages, and with fewer than lanes the start of the step, which one trajectory has in all lanes that are left.
    pub(super) fn columns(&self) -> usize {
        if self.stages < WIDTH { self.stages + 1 } else { WIDTH }
    }
}

/// Σ over the stages `j` of `weight · values[j]`, in the order of [`combined`](super::step::combined). A macro and no function of
/// a closure, which would be compiled without the tier's instructions.
macro_rules! combined {
    ($columns:expr, $values:expr, $j:ident => $weight:expr) => {{
        let (half, columns) = (WIDTH / 2, $columns);
        let (mut even, mut odd) = (V::zero(), V::zero());
        for $j in 0..columns.min(half) {
            even = V::load($values[$j]).multiply_add($weight, even);
        }
        for $j in half..columns {
            odd = V::load($values[$j]).multiply_add($weight, odd);
        }
        even + odd
    }};
}
pub(super) use combined;

/// The larger of two numbers that are none below zero; a NaN counts as infinite.
#[inline(always)]
pub(super) fn larger<V: Vector8>(x: V, most: V) -> V {
    let number = V::select(x.less_equal(x), x, V::splat(f64::INFINITY));
    V::select(x.less_equal(most), most, number)
}

/// How large a number is, or was before, and how far it goes in the step.
#[inline(always)]
fn size_of<V: Vector8>(y: V, rates: &[Lanes], h: V, before: V) -> V {
    let mut largest = V::zero();
    for &rate in rates {
        largest = larger(V::load(rate).abs(), largest);
    }
    let now = y.abs() + (h * largest).abs();
    // What overflows in a step that is too long is no size.
    V::select(now.less(V::splat(f64::INFINITY)), now, V::zero()).max(before)
}

/// The velocities that move a coordinate by no more than its rounding, as of one trajectory.
#[inline(always)]
fn unfelt<V: Vector8>(form: Form, y: &[Lanes], i: usize, h: V) -> V {
    match form {
        Form::FirstOrder(_) => V::zero(),
        Form::SecondOrder(_) => V::splat(UNFELT) * (V::load(y[i]) / h).abs(),
    }
}

/// Sets what changes are measured by, in the lanes that run, as of one trajectory.
#[inline(always)]
fn set_scales<V: Vector8>(
    columns: &mut Columns,
    count: usize,
    (form, y): (Form, &[Lanes]),
    (h, fading): (V, V),
    running: Bits,
) {
    let mut most = V::zero();
    let now = form.measured(y);
    for i in 0..columns.tried.len() {
        let least = V::load(columns.least[i]).max(unfelt(form, y, i, h));
        let known = (fading * V::load(columns.sizes[i])).max(least);
        let after = size_of(V::load(now[i]), &columns.rates[i][..count], h, known);
        columns.tried[i] = V::select(running, after, V::load(columns.tried[i])).store();
        most = after.max(most);
    }
    let least = V::splat(LEAST_SCALE) * most;
    for i in 0..columns.tried.len() {
        let size = V::load(columns.tried[i]).max(least);
        let scale = V::select(V::zero().less(size), V::one() / size, V::zero());
        columns.scales[i] = V::select(running, scale, V::load(columns.scales[i])).store();
        let cap = noise::cap(V::load(columns.noise[i]), h);
        columns.measures[i] = V::load(columns.scales[i]).min(cap).store();
    }
}

/// Writes the numbers of all stages that their rates lead to.
#[inline(always)]
fn place_stages<V: Vector8>(work: &mut Work<'_>, h: V, count: usize) {
    let Work { table, form, velocity, state, columns, .. } = work;
    let (evaluated, second_order) = (form.evaluated(), matches!(form, Form::SecondOrder(_)));
    let (y, rest) = state.all();
    let h2 = h * h;
    for i in 0..evaluated {
        let row = &columns.rates[i];
        if second_order {
            let y = V::load(y[i]);
            for k in 0..count {
                let sum = combined!(count, row, j => V::splat(table.a2[j].0[k]));
                columns.places[i][k] = (sum.multiply_add(h2, V::load(columns.drifts[i][k])) + y).store();
            }
        }
        if !second_order || *velocity {
            let from = if second_order { evaluated + i } else { i };
            let (y, rest) = (V::load(y[from]), V::load(rest[from]));
            for k in 0..count {
                let sum = combined!(count, row, j => V::splat(table.a[j].0[k]));
                columns.numbers[i][k] = (sum.multiply_add(h, rest) + y).store();
            }
        }
    }
}

/// Writes where the stages of the second order would be without accelerations, from the coordinates.
#[inline(always)]
fn drift<V: Vector8>(work: &mut Work<'_>, h: V, count: usize) {
    let Work { table, form, state, columns, .. } = work;
    let (y, rest) = state.all();
    let evaluated = form.evaluated();
    for k in 0..count {
        let c = V::splat(table.c.0[k]);
        let passed = c * h;
        let passed_rest = V::splat(table.c_rest.0[k]).multiply_add(h, c.multiply_add(h, -passed));
        for (i, drifts) in columns.drifts.iter_mut().enumerate() {
            let v = V::load(y[evaluated + i]);
            let left_out = passed_rest.multiply_add(v, V::load(rest[i]));
            drifts[k] = passed.multiply_add(v, left_out).store();
        }
    }
}

/// Iterates the stages from `columns.rates` on until nothing changes in any lane.
#[inline(always)]
fn iterate_body<V: Vector8 + Scalar>(work: &mut Work<'_>) -> Settled {
    let (table, form, running, count) = (work.table, work.form, work.running, work.table.columns());
    let evaluated = form.evaluated();
    let second_order = matches!(form, Form::SecondOrder(_));
    let all_move = !second_order || work.velocity;
    let (h, t) = (V::load(work.h), V::load(work.t));
    if second_order {
        drift(work, h, count);
    }
    let mut settled = Settled {
        converged: Bits::splat(false),
        evaluations: [MOST_ITERATIONS; WIDTH],
        change: Lanes([f64::INFINITY; WIDTH]),
        left: Lanes([0.0; WIDTH]),
    };
    let mut changes = [Changes::default(); WIDTH];
    let mut limit = Lanes::splat(f64::INFINITY);
    let mut active = running;
    for iteration in 1..=MOST_ITERATIONS {
        place_stages(work, h, count);
        let Work { machine, state, columns, fading, .. } = &mut *work;
        let (code, registers) = machine.parts();
        let (variables, outputs) = (code.variables(), code.output_registers());
        columns.moved.fill(Lanes([0.0; WIDTH]));
        for first in (0..count).step_by(AT_ONCE) {
            // What begins is the same in every iteration, and has no weight.
            if iteration > 1 && first >= table.stages {
                break;
            }
            for block in 0..AT_ONCE {
                let k = (first + block).min(count - 1);
                registers[variables * AT_ONCE + block] = (V::splat(table.c.0[k]) * h + t).store();
                for i in 0..evaluated {
                    if second_order {
                        registers[i * AT_ONCE + block] = columns.places[i][k];
                    }
                    if all_move {
                        let from = if second_order { evaluated + i } else { i };
                        registers[from * AT_ONCE + block] = columns.numbers[i][k];
                    }
                }
            }
            execute::execute::<V, AT_ONCE>(code, Part::Body, V::view_mut(registers));
            for i in 0..evaluated {
                let mut most = V::load(columns.moved[i]);
                for block in 0..AT_ONCE.min(count - first) {
                    let found = V::load(registers[usize::from(outputs[i]) * AT_ONCE + block]);
                    let rate = &mut columns.rates[i][first + block];
                    let before = V::load(*rate);
                    if first + block < table.stages {
                        most = larger((found - before).abs(), most);
                    }
                    *rate = V::select(active, found, before).store();
                }
                columns.moved[i] = most.store();
            }
        }
        if iteration == 1 {
            set_scales(columns, count, (form, state.all().0), (h, V::load(*fading)), running);
        }
        let mut most = V::zero();
        for i in 0..evaluated {
            let scale = V::load(columns.measures[i]).min(V::load(limit)) * h.abs();
            most = larger(V::load(columns.moved[i]) * scale, most);
        }
        let most = most.store();
        let open = active;
        for lane in (0..WIDTH).filter(|&lane| open.lane(lane)) {
            let judged = changes[lane].judged(most.0[lane], || columns.limit(lane));
            limit.0[lane] = changes[lane].limit;
            settled.left.0[lane] = changes[lane].left;
            if let Some(converged) = judged {
                let lane_alone = Bits(1 << lane);
                (settled.evaluations[lane], settled.change.0[lane]) = (iteration, most.0[lane]);
                active = active.and(lane_alone.not());
                settled.converged =
                    if converged { settled.converged.or(lane_alone) } else { settled.converged };
            }
        }
        if !active.any() {
            break;
        }
    }
    settled
}

/// The weighted sum of the stages, in the order of [`Lanes::horizontal_sum`].
#[inline(always)]
pub(super) fn weighted<V: Vector8>(weights: &[Lanes; 2], row: &Row, last: usize) -> V {
    let mut terms = [V::zero(); WIDTH];
    for (j, term) in terms.iter_mut().enumerate() {
        let rate = V::load(row[j.min(last)]);
        *term = V::splat(weights[0].0[j]).multiply_add(rate, V::splat(weights[1].0[j]) * rate);
    }
    let [a, b, c, d, e, f, g, h] = terms;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// The lanes that run whose stages were found by far more than they came to, as of one trajectory.
#[inline(always)]
fn began_wildly_body<V: Vector8>(work: &Work<'_>) -> Bits {
    let Work { table, form, state, columns, h, fading, running, .. } = work;
    let y = state.all().0;
    let (h, fading) = (V::load(*h), V::load(*fading));
    let mut wild = Bits(0);
    let now = form.measured(y);
    for i in 0..columns.tried.len() {
        let least = V::load(columns.least[i]).max(unfelt(*form, y, i, h));
        let known = (fading * V::load(columns.sizes[i])).max(least);
        let size = size_of(V::load(now[i]), &columns.rates[i][..table.columns()], h, known);
        wild = wild.or(size.less(V::splat(WILD) * V::load(columns.tried[i])));
    }
    wild.and(*running)
}

/// Finds the stages from `columns.rates` on, measured by what they come to.
pub(super) fn found(work: &mut Work<'_>) -> Settled {
    let (mut all, running) = (iterate(work), work.running);
    for _ in 0..AGAIN {
        let wild = began_wildly(work).and(all.converged);
        if !wild.any() {
            return all;
        }
        work.running = wild;
        let again = iterate(work);
        work.running = running;
        all.converged = all.converged.and(wild.not().or(again.converged));
        for lane in (0..WIDTH).filter(|&lane| wild.lane(lane)) {
            all.evaluations[lane] += again.evaluations[lane];
            all.change.0[lane] = again.change.0[lane];
            all.left.0[lane] = again.left.0[lane];
        }
    }
    all.converged = all.converged.and(began_wildly(work).not());
    all
}

#[inline(always)]
fn remembered_body<V: Vector8>(columns: &mut Columns, tried: Bits, kept: Bits) {
    for (size, &most) in columns.sizes.iter_mut().zip(&columns.tried) {
        let (before, most) = (V::load(*size), V::load(most));
        let beside = V::select(kept, most, most.max(V::splat(FADING) * before));
        *size = V::select(tried, beside, before).store();
    }
}

tiered! {
    fn remembered[][](columns: &mut Columns, tried: Bits, kept: Bits) = remembered_body;
    fn iterate[][](work: &mut Work<'_>) -> Settled = iterate_body;
    fn began_wildly[][](work: &Work<'_>) -> Bits = began_wildly_body;
}
