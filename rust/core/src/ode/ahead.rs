//! Steps ahead of who looks at each of them, and back where he has to look.
//!
//! The one idea: which steps may hold events is told of eight of them in one pass, from what was noted at their nodes. Mostly
//! none does. Else the stepper is put back to where it stood and takes the same steps again, with a look at those.

use super::fixed::{Recorder, Walk};
use super::state::State;
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::lanes::{Bits, WIDTH};
use crate::parallel::Ticker;

/// Elements of a state above which steps are taken one by one: then a look is little beside a step.
const MOST_ELEMENTS: usize = 64;

/// Where a run stood: all that it takes to go on from there.
struct Stand<S> {
    node: u64,
    state: State<S>,
    /// What the stepper held.
    held: Vec<Vec<S>>,
}

impl<S: Element> Stand<S> {
    fn new(state: &State<S>) -> Self {
        Self { node: 0, state: state.clone(), held: Vec::new() }
    }

    /// Keeps what is at the present node, a settled one.
    fn keep(&mut self, walk: &mut Walk<'_, S>) {
        self.node = walk.node;
        self.state.copy_from(walk.state);
        let mut block = 0;
        walk.stepper.memory(walk.node, &mut |numbers| {
            match self.held.get_mut(block) {
                Some(room) => room.copy_from_slice(numbers),
                None => self.held.push(numbers.to_vec()),
            }
            block += 1;
        });
    }

    /// Goes to the node at which that was kept.
    fn take_up(&self, walk: &mut Walk<'_, S>) {
        (walk.node, walk.stands) = (self.node, true);
        walk.state.copy_from(&self.state);
        let mut held = self.held.iter();
        walk.stepper.memory(walk.node, &mut |numbers| {
            if let Some(kept) = held.next() {
                numbers.copy_from_slice(kept);
            }
        });
    }
}

/// Room to go back.
pub(super) struct Ahead<S> {
    /// Before the steps ahead and after them.
    start: Stand<S>,
    end: Stand<S>,
    /// The state before a step that is looked into.
    before: State<S>,
}

impl<S: Element> Ahead<S> {
    /// For states like this one, if they are small enough for it to save time.
    pub(super) fn new(state: &State<S>) -> Option<Self> {
        (state.all().0.len() <= MOST_ELEMENTS).then(|| Self {
            start: Stand::new(state),
            end: Stand::new(state),
            before: state.clone(),
        })
    }

    /// Takes steps, up to so many, from a node after the first step of the run; `false` if one of them ends it.
    ///
    /// # Errors
    /// Those of the steps and of the looks.
    pub(super) fn advance(
        &mut self,
        at_most: u64,
        walk: &mut Walk<'_, S>,
        ticker: &mut Ticker<'_>,
        recorder: &mut impl Recorder<S>,
    ) -> Result<bool> {
        let (start, evaluations) = (walk.node, walk.system.evaluations());
        self.start.keep(walk);
        recorder.note(0, start, walk.state);
        let count = at_most.min(WIDTH as u64);
        let mut place = 0;
        let taken = walk.steps(count, ticker, &mut |state| {
            place += 1;
            recorder.note(place, start + place as u64, state);
        });
        let whole = taken.is_ok();
        // If one of them failed, those up to it have not been looked at.
        let suspects = if whole { recorder.suspects(count as usize) } else { Bits(0xff) };
        if suspects == Bits(0) {
            return Ok(true);
        }
        if whole {
            self.end.keep(walk);
        }
        let repeated = walk.repeated;
        walk.repeated += walk.system.evaluations() - evaluations;
        self.start.take_up(walk);
        let last = count.min(u64::from(u8::BITS - suspects.0.leading_zeros()));
        let mut again = 0;
        for index in 0..last as usize {
            if suspects.lane(index) {
                self.before.copy_from(walk.state);
            }
            let evaluations = walk.system.evaluations();
            walk.step(1, ticker)?;
            walk.stepper.settle(walk.state);
            again += walk.system.evaluations() - evaluations;
            if suspects.lane(index) && !walk.look(Some(&self.before), ticker, recorder)? {
                return Ok(false);
            }
        }
        if whole {
            // From here on it is these steps that were taken for nothing.
            walk.repeated = repeated + again;
            self.end.take_up(walk);
        }
        Ok(true)
    }
}
