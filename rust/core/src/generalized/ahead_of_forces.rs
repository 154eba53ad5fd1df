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

/// Terms of a series that tell of a force.
const TERMS: usize = 3;

/// The longest step up to `h` of a motion with this series, in its unit of time: `longest_free` where nothing is felt.
///
/// Of equations of the first order, rates that change do so with the square of the step, and so do the numbers.
pub(super) fn longest_step<S: Element>(form: Form, jet: &Jet<S>, h: S, longest_free: S) -> S {
    let (blocks, first, part) = match form {
        Form::FirstOrder(_) => (&jet.q, 1, FREE * FREE),
        Form::SecondOrder(_) => (&jet.v, 0, FREE),
    };
    // No step leads beyond the run.
    let step = h.min(longest_free * S::splat(1.0 / LONGEST_FREE));
    let term = |order: usize, index: usize| blocks[order * jet.len + index].abs();
    let mut felt = S::Mask::splat(false);
    for index in 0..jet.len {
        let before = (0..=first).rev().fold(S::zero(), |size, order| (size * step).max(term(order, index)));
        let after = (1..=TERMS).rev().fold(S::zero(), |change, k| (change + term(first + k, index)) * step);
        let after = if first == 1 { after * step } else { after };
        felt = felt.or((S::splat(part) * before).less(after));
    }
    S::select(felt, h, h.min(longest_free))
}
