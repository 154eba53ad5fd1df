//! Steps on which nothing of what lies ahead is felt.
//!
//! The one idea: a method knows a force by what it does within a step, so one that is shorter than a step may be passed over
//! unseen; where a step changes nothing of the motion, it is a small part of the run at most.

use crate::numerics::element::Element;
use crate::numerics::real::Mask;
use crate::ode::series::Jet;
use crate::ode::system::Form;

/// Where a step changes velocities by less than this part of them, nothing of what lies ahead is felt …
pub(super) const FREE: f64 = 1e-3;
/// … and it is as long as this part of the run at most: forces that are short beside a step are between its stages.
pub(super) const LONGEST_FREE: f64 = 1.0 / 128.0;

/// Terms of a series that tell of a force, if the first does not.
const TERMS: usize = 3;

/// The longest step up to `h` of a motion with this series, in its unit of time: `longest_free` where nothing is felt.
pub(super) fn longest_step<S: Element>(form: Form, jet: &Jet<S>, h: S, longest_free: S) -> S {
    // No step leads beyond the run.
    let step = h.min(longest_free * S::splat(1.0 / LONGEST_FREE));
    let mut felt = h.less_equal(longest_free);
    for terms in [1, TERMS] {
        for index in 0..jet.len {
            if felt.all() {
                return h;
            }
            felt = felt.or(is_felt(form, jet, index, step, terms));
        }
    }
    S::select(felt, h, h.min(longest_free))
}

/// Whether so many terms change a number in a step.
///
/// Of equations of the first order, rates that change do so with the square of the step, and so do the numbers.
fn is_felt<S: Element>(form: Form, jet: &Jet<S>, index: usize, step: S, terms: usize) -> S::Mask {
    let term = |blocks: &[S], order: usize| blocks[order * jet.len + index].abs();
    let change = |blocks: &[S], from: usize| {
        (from..from + terms).rev().fold(S::zero(), |change, order| (change + term(blocks, order)) * step)
    };
    match form {
        Form::FirstOrder(_) => {
            let size = term(&jet.q, 0).max(term(&jet.q, 1) * step);
            (S::splat(FREE * FREE) * size).less(change(&jet.q, 2) * step)
        }
        Form::SecondOrder(_) => (S::splat(FREE) * term(&jet.v, 0)).less(change(&jet.v, 1)),
    }
}
