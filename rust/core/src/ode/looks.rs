//! Where a step looks at the forces, and what steps of equal length are asked of.
//!
//! The one idea: what lies between two places where a method looks may be unseen, whether these are of one step or of two. Methods
//! that begin and end with a drift never look at a node: they go through it on a straight line, from the last look of a step to the
//! first one of the next.

use super::Method;
use super::step_control::Controlled;
use super::system::{Form, System, Taken};
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::real::Mask;
use std::borrow::Cow;

/// A step has thrown what it changes the velocities of by so many times as much as they have been: in six steps a period of an
/// oscillator none does.
const THROWN: f64 = 1.0;

/// Places of a step at which a method looks, as parts of it, ascending.
#[derive(Clone, Debug)]
pub struct Looks {
    places: Cow<'static, [f64]>,
    longest_gap: f64,
    /// Those that no weight of the method counts.
    uncounted: Cow<'static, [f64]>,
}

impl Looks {
    /// At both ends alone.
    pub const AT_ENDS: Self =
        Self { places: Cow::Borrowed(&[0.0, 1.0]), longest_gap: 1.0, uncounted: Cow::Borrowed(&[]) };

    /// At these places, in any order, those within the step alone.
    pub fn at(places: impl IntoIterator<Item = f64>) -> Self {
        let mut places: Vec<f64> = places.into_iter().filter(|place| (0.0..=1.0).contains(place)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let longest_gap = places.windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max);
        Self { places: Cow::Owned(places), longest_gap, uncounted: Cow::Borrowed(&[]) }
    }

    /// At both ends, and at these places.
    pub fn with_ends(inner: impl IntoIterator<Item = f64>) -> Self {
        Self::at(inner.into_iter().chain([0.0, 1.0]))
    }

    /// These, and both ends.
    #[must_use]
    pub fn and_ends(self) -> Self {
        Self::with_ends(self.places.iter().copied())
    }

    /// The same, of a method whose weights do not count what it sees at some of these.
    #[must_use]
    pub fn but_uncounted(self, places: impl IntoIterator<Item = f64>) -> Self {
        Self { uncounted: places.into_iter().collect(), ..self }
    }

    /// How many of them between two places count.
    pub fn counted_between(&self, from: f64, to: f64) -> usize {
        let counts = |&&place: &&f64| place > from && place < to && !self.uncounted.contains(&place);
        self.places.iter().filter(counts).count()
    }

    /// The places.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// The longest part of a step between two of them.
    pub const fn longest_gap(&self) -> f64 {
        self.longest_gap
    }

    /// Whether the method looks at the beginning of a step.
    fn has_beginning(&self) -> bool {
        self.places.first() == Some(&0.0)
    }
}

/// What asks after each of a run's equal steps what it has not seen.
#[derive(Clone, Debug)]
pub struct EqualLooks<S> {
    looks: Looks,
    /// Of a method that looks at no node.
    between_steps: Option<BetweenSteps>,
    /// The fastest that anything has been, lane by lane.
    fastest: S,
    /// Room for the ends of straight ways.
    ends: [Vec<S>; 2],
}

/// The straight way from the last look of a step through a node to the first look of the next step.
#[derive(Clone, Debug)]
struct BetweenSteps {
    /// How long before the node it begins, and after it ends, as parts of a step.
    parts: [f64; 2],
    /// Places of looks from the first of a step to that of the next.
    from_first_to_first: Looks,
}

/// A step among equal ones.
#[derive(Clone, Copy)]
pub struct EqualStep<'a, S: Element> {
    /// The lanes that are asked of.
    pub asked: S::Mask,
    /// The time before it, and its length.
    pub times: (S, S),
    /// The states at its ends.
    pub ends: [&'a [S]; 2],
    /// Whether it is the first of a run, and the last.
    pub is_outermost: [bool; 2],
    /// Whether lanes are parts of one system.
    pub is_one: bool,
}

impl<S: Element> EqualStep<'_, S> {
    /// With its looks.
    fn taken<'a>(&'a self, looks: &'a Looks) -> Taken<'a, S> {
        Taken { looks, ..Taken::from_end_to_end(self.asked, self.times, self.ends) }
    }

    /// The straight way through an end of it, from one part of a step beside that to another.
    fn straight<'a>(&self, end: usize, parts: [f64; 2], ends: &'a mut [Vec<S>; 2]) -> Taken<'a, S> {
        let (from, h) = self.times;
        let from = if end == 0 { from } else { from + h };
        let past = parts.map(|part| h * S::splat(part));
        let (q, v) = self.ends[end].split_at(self.ends[end].len() / 2);
        for (end, past) in ends.iter_mut().zip(past) {
            end.clear();
            end.extend(q.iter().zip(v).map(|(&q, &v)| q + v * past));
            end.extend_from_slice(v);
        }
        Taken::from_end_to_end(self.asked, (from + past[0], past[1] - past[0]), [&ends[0], &ends[1]])
    }

    /// How fast anything is at its beginning, and by how much the velocity of anything changes, at most.
    fn speeds(&self) -> [S; 2] {
        let n = self.ends[0].len() / 2;
        let (mut speed, mut change) = (S::zero(), S::zero());
        for (&before, &after) in self.ends[0][n..].iter().zip(&self.ends[1][n..]) {
            speed = speed.max(before.abs());
            change = change.max((after - before).abs());
        }
        [speed, change]
    }
}

impl BetweenSteps {
    /// Of a method that looks there, not at nodes.
    fn of(looks: &Looks) -> Option<Self> {
        let (&first, &last) = (looks.places().first()?, looks.places().last()?);
        let from_first_to_first = Looks::with_ends(looks.places().iter().map(|place| place - first));
        Some(Self { parts: [last - 1.0, first], from_first_to_first })
    }
}

impl<S: Controlled> EqualLooks<S> {
    /// Of a method.
    pub fn of(method: &Method) -> Self {
        let looks = method.looks();
        let between_steps = if looks.has_beginning() { None } else { BetweenSteps::of(&looks) };
        Self { looks, between_steps, fastest: S::zero(), ends: [vec![], vec![]] }
    }

    /// The part of a step up to which nothing was unseen, as `ask` has it from the system.
    ///
    /// # Errors
    /// As `ask`.
    pub fn ask(
        &mut self,
        step: EqualStep<'_, S>,
        system: &mut dyn System<S>,
        ask: impl Fn(&Taken<'_, S>, &mut dyn System<S>) -> Result<Option<S>>,
    ) -> Result<Option<S>> {
        let [is_first, is_last] = step.is_outermost;
        let Self { looks, between_steps, fastest, ends } = self;
        let mut seen = None;
        let outermost;
        let mut within = &*looks;
        if let Some(between) = between_steps {
            if !is_last {
                seen = ask(&step.straight(1, between.parts, ends), system)?;
            }
            // Before the first look of a run and after the last one there is no other.
            let ends =
                [(is_first, 0.0), (is_last, 1.0)].into_iter().filter_map(|(is, end)| is.then_some(end));
            outermost = Looks::at(looks.places().iter().copied().chain(ends));
            within = &outermost;
        }
        let mut thrown = S::Mask::splat(false);
        if matches!(system.form(), Form::SecondOrder(_)) {
            // Where nothing but its beginning tells where a step would have led had it felt nothing.
            let [mut speed, mut change] = step.speeds();
            if step.is_one {
                (speed, change) = (speed.largest_lane(), change.largest_lane());
            }
            *fastest = if is_first { speed } else { fastest.max(speed) };
            thrown = step.asked.and((*fastest * S::splat(THROWN)).less(change));
        }
        if thrown.any() {
            let straight = step.straight(0, [0.0, 1.0], ends);
            seen = least(seen, ask(&Taken { asked: thrown, looks, ..straight }, system)?);
        }
        Ok(least(seen, ask(&step.taken(within), system)?))
    }

    /// The lanes in which nothing would have been unseen in steps so many times as long as the one that was last asked of.
    pub fn are_calm(&self, step: EqualStep<'_, S>, times: f64, system: &mut dyn System<S>) -> S::Mask {
        let looks = self.between_steps.as_ref().map_or(&self.looks, |between| &between.from_first_to_first);
        system.calm(&step.taken(looks), times)
    }
}

/// The smaller of two parts of a step, where there are any.
fn least<S: Element>(a: Option<S>, b: Option<S>) -> Option<S> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}
