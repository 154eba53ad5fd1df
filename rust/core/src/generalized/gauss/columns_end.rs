//! The end of a step of eight trajectories, from the stages that [`columns`](super::columns) has found.

use super::columns::{Work, weighted};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::ode::state::State;
use crate::ode::system::Form;
use crate::tiered;

/// Writes the states at the end of the steps.
#[inline(always)]
fn advance_body<V: Vector8>(work: &Work<'_>, next: &mut State<Lanes>) {
    let Work { table, form, state, columns, h, .. } = work;
    let (evaluated, last) = (form.evaluated(), table.columns() - 1);
    let (y, rest) = state.all();
    let (next, next_rest) = next.all_mut();
    let h = V::load(*h);
    // A closure would be compiled without the tier's instructions.
    macro_rules! put {
        ($index:expr, $change:expr) => {{
            let (index, change): (usize, V) = ($index, $change);
            let y = V::load(y[index]);
            let sum = y + change;
            let moved = sum - y;
            next_rest[index] = ((y - (sum - moved)) + (change - moved)).store();
            next[index] = sum.store();
        }};
    }
    for i in 0..evaluated {
        let row = &columns.rates[i];
        match form {
            Form::FirstOrder(_) => {
                put!(i, weighted::<V>(&table.b, row, last).multiply_add(h, V::load(rest[i])))
            }
            Form::SecondOrder(_) => {
                let v = evaluated + i;
                let (y, rest_v) = (V::load(y[v]), V::load(rest[v]));
                put!(v, weighted::<V>(&table.b, row, last).multiply_add(h, rest_v));
                let drift = y * h;
                let lost = y.multiply_add(h, -drift);
                let rest_q = rest_v.multiply_add(h, V::load(rest[i]) + lost);
                let (h2, moved) = (h * h, weighted::<V>(&table.b2, row, last));
                let small = moved.multiply_add(h.multiply_add(h, -h2), rest_q);
                put!(i, drift + moved.multiply_add(h2, small));
            }
        }
    }
}

tiered! {
    pub(super) fn advance[][](work: &Work<'_>, next: &mut State<Lanes>) -> () = advance_body;
}
