//! Steps on which nothing of what lies ahead is felt.
//!
//! The one idea: a method knows a force by what it does within a step, so one that is shorter than a step may be passed over
//! unseen; where a step changes nothing of the motion, it is a small part of the run at most.

use crate::numerics::element::{Element, Pass, View};
use crate::numerics::real::{Mask, Real};
use crate::ode::series::Jet;
use crate::ode::system::Form;

/// Where a step changes velocities by less than this part of them, nothing of what lies ahead is felt …
pub(super) const FREE: f64 = 1e-3;
/// … and it is as long as this part of the run at most: forces that are short beside a step are between its stages.
pub(super) const LONGEST_FREE: f64 = 1.0 / 128.0;

/// Terms of a series that tell of a force, if the first does not.
const TERMS: usize = 3;

/// The longest step up to `h` of a motion with this series: `longest_free` where nothing is felt.
#[derive(Debug)]
pub(super) struct LongestStep<'a, S> {
    pub(super) form: Form,
    pub(super) jet: &'a Jet<S>,
    pub(super) h: &'a S,
    pub(super) longest_free: &'a S,
}

impl<S: Element> Pass<S> for LongestStep<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let Jet { q, v, len, unit, .. } = self.jet;
        let (unit, second_order) = (V::load(*unit), matches!(self.form, Form::SecondOrder(_)));
        let (h, longest_free) = (V::load(*self.h) / unit, V::load(*self.longest_free) / unit);
        let blocks = V::view(if second_order { v } else { q });
        // No step leads beyond the run.
        let step = h.min(longest_free * V::splat(1.0 / LONGEST_FREE));
        let mut felt = h.less_equal(longest_free);
        for terms in [1, TERMS] {
            for index in 0..*len {
                if felt.all() {
                    return *self.h;
                }
                let of = Terms { blocks, len: *len, index, step };
                felt = felt.or(if second_order { of.change_velocity(terms) } else { of.change(terms) });
            }
        }
        (V::select(felt, h, h.min(longest_free)) * unit).store()
    }
}

/// The terms of one number's series over a step.
#[derive(Clone, Copy)]
struct Terms<'a, V> {
    blocks: &'a [V],
    len: usize,
    index: usize,
    step: V,
}

impl<V: Real> Terms<'_, V> {
    #[inline(always)]
    fn size(&self, order: usize) -> V {
        self.blocks[order * self.len + self.index].abs()
    }

    /// What so many terms from an order on come to.
    #[inline(always)]
    fn sum(&self, from: usize, terms: usize) -> V {
        let (mut sum, mut order) = (V::zero(), from + terms);
        while order > from {
            order -= 1;
            sum = (sum + self.size(order)) * self.step;
        }
        sum
    }

    /// Whether so many terms change a velocity.
    #[inline(always)]
    fn change_velocity(&self, terms: usize) -> V::Mask {
        (V::splat(FREE) * self.size(0)).less(self.sum(1, terms))
    }

    /// Whether so many terms change a number of the first order: rates that change do so with the square of the step, and so
    /// do the numbers.
    #[inline(always)]
    fn change(&self, terms: usize) -> V::Mask {
        let size = self.size(0).max(self.size(1) * self.step);
        (V::splat(FREE * FREE) * size).less(self.sum(2, terms) * self.step)
    }
}
