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

/// Room to go back.
pub(super) struct Ahead<S> {
    /// The state before the steps ahead.
    start: State<S>,
    /// What the stepper held there.
    held: Vec<Vec<S>>,
    /// The state before a step that is looked into.
    before: State<S>,
}

impl<S: Element> Ahead<S> {
    /// For states like this one, if they are small enough for it to save time.
    pub(super) fn new(state: &State<S>) -> Option<Self> {
        (state.all().0.len() <= MOST_ELEMENTS).then(|| Self {
            start: state.clone(),
            held: Vec::new(),
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
        self.leave(walk);
        recorder.note(0, walk.state);
        let count = at_most.min(WIDTH as u64);
        let mut node = 0;
        let taken = walk.steps(count, ticker, &mut |state| {
            node += 1;
            recorder.note(node, state);
        });
        let suspects = match taken {
            Ok(()) => recorder.suspects(count as usize),
            // The steps up to the one that failed have not been looked at.
            Err(_) => Bits(0xff),
        };
        if suspects == Bits(0) {
            return Ok(true);
        }
        walk.repeated += walk.system.evaluations() - evaluations;
        self.take_up(start, walk);
        for index in 0..count as usize {
            if suspects.lane(index) {
                self.before.copy_from(walk.state);
            }
            walk.step(1, ticker)?;
            walk.stepper.settle(walk.state);
            if suspects.lane(index) && !walk.look(Some(&self.before), ticker, recorder)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Keeps what is at the present node.
    fn leave(&mut self, walk: &mut Walk<'_, S>) {
        self.start.copy_from(walk.state);
        let held = &mut self.held;
        let mut block = 0;
        walk.stepper.memory(walk.node, &mut |numbers| {
            match held.get_mut(block) {
                Some(room) => room.copy_from_slice(numbers),
                None => held.push(numbers.to_vec()),
            }
            block += 1;
        });
    }

    /// Goes back to the node at which that was kept.
    fn take_up(&self, node: u64, walk: &mut Walk<'_, S>) {
        (walk.node, walk.stands) = (node, true);
        walk.state.copy_from(&self.start);
        let mut held = self.held.iter();
        walk.stepper.memory(node, &mut |numbers| {
            if let Some(kept) = held.next() {
                numbers.copy_from_slice(kept);
            }
        });
    }
}
