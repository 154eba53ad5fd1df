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
}

impl<S: Element> Ahead<S> {
    /// For states like this one, if they are small enough for it to save time.
    pub(super) fn new(state: &State<S>) -> Option<Self> {
        (state.all().0.len() <= MOST_ELEMENTS)
            .then(|| Self { start: Stand::new(state), end: Stand::new(state) })
    }

    /// Takes steps, up to so many, from a node after the first step of the run; `false` if one of them ends it. There is
    /// room for the state before a step that is looked into.
    ///
    /// # Errors
    /// Those of the steps and of the looks.
    pub(super) fn advance(
        &mut self,
        at_most: u64,
        walk: &mut Walk<'_, S>,
        before: &mut State<S>,
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
                before.copy_from(walk.state);
            }
            let evaluations = walk.system.evaluations();
            walk.step(1, ticker)?;
            walk.stepper.settle(walk.state);
            again += walk.system.evaluations() - evaluations;
            if suspects.lane(index) && !walk.look(before, ticker, recorder)? {
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

#[cfg(test)]
mod tests {
    use super::super::fixed::{self, Place, Taken};
    use super::super::stepper::{stepper, tests::Pendulum};
    use super::*;
    use crate::parallel::Control;
    use crate::registry::METHODS;

    /// Looks into some steps, and writes down where they begin and end.
    struct Sample {
        ahead: bool,
        wanted: Vec<u64>,
        stops: u64,
        seen: Vec<(u64, [u64; 2], u64)>,
        first: u64,
        last: Option<[u64; 2]>,
    }

    fn bits(state: &State<f64>) -> [u64; 2] {
        [state.q()[0].to_bits(), state.v()[0].to_bits()]
    }

    impl Recorder<f64> for Sample {
        fn record(&mut self, _: usize, state: &State<f64>, _: &mut Ticker<'_>) -> Result<()> {
            self.last = Some(bits(state));
            Ok(())
        }
        fn watches(&self) -> Option<usize> {
            Some(0)
        }
        fn looks_ahead(&self) -> bool {
            self.ahead
        }
        fn note(&mut self, place: usize, node: u64, _: &State<f64>) {
            if place == 0 {
                self.first = node;
            }
            assert_eq!(node, self.first + place as u64);
        }
        fn suspects(&mut self, steps: usize) -> Bits {
            let wanted = (0..steps).filter(|&step| self.wanted.contains(&(self.first + step as u64 + 1)));
            wanted.fold(Bits(0), |mask, step| Bits(mask.0 | 1 << step))
        }
        fn look(&mut self, taken: Taken<'_, f64>, ticker: &mut Ticker<'_>) -> Result<bool> {
            let end = taken.node + 1;
            if self.wanted.contains(&end) {
                // Shadow steps go from where the step began, and a whole one leads to where it ended.
                let mut between = taken.before.clone();
                taken.stepper.between(taken.node, 0.01, &mut between, taken.system, ticker)?;
                let paid = taken.system.evaluations() - taken.repeated;
                self.seen.push((end, bits(&between), paid));
            }
            Ok(end != self.stops)
        }
        fn goes_on(&mut self, _: &State<f64>) -> bool {
            true
        }
    }

    /// What was seen, the last state, how the run ended, and what it cost.
    type Told = (Vec<(u64, [u64; 2], u64)>, Option<[u64; 2]>, (u64, bool, bool), u64);

    fn run(method: usize, ahead: bool, wanted: &[u64], stops: u64, fails_after: f64) -> Told {
        let control = Control::default();
        let mut ticker = Ticker::quiet(&control);
        let mut state = State::new(&[0.3], &[1.1]);
        let mut pendulum = Pendulum::new(fails_after);
        let mut stepper = stepper(METHODS[method], 0.07, &pendulum, &state).unwrap();
        let mut sample =
            Sample { ahead, wanted: wanted.to_vec(), stops, seen: Vec::new(), first: 0, last: None };
        let places = [Place { node: 203, past: None }].into_iter();
        let (most, system) = (u64::MAX, &mut pendulum);
        let ended = fixed::run(&mut *stepper, 0, most, &mut state, system, places, &mut ticker, &mut sample);
        let cost = pendulum.evaluations - ended.repeated;
        (sample.seen, sample.last, (ended.node, ended.stands, ended.outcome.is_ok()), cost)
    }

    #[test]
    fn steps_ahead_show_what_steps_one_by_one_show() {
        for (method, named) in METHODS.iter().enumerate().filter(|(_, method)| !method.adaptive()) {
            for wanted in [&[][..], &[1, 2, 7, 8, 9, 10, 64, 65, 66, 130, 131, 202, 203], &[33], &[203]] {
                // Stopped by a look that is in the midst of steps ahead, by none, and by a force that fails.
                for (stops, fails_after) in
                    [(u64::MAX, f64::INFINITY), (66, f64::INFINITY), (131, f64::INFINITY), (u64::MAX, 9.0)]
                {
                    let one_by_one = run(method, false, wanted, stops, fails_after);
                    let ahead = run(method, true, wanted, stops, fails_after);
                    let looked_at = stops == u64::MAX || wanted.contains(&stops);
                    if fails_after.is_finite() {
                        assert!(!ahead.2.2 && !ahead.2.1, "{}", named.name);
                        assert_eq!((&ahead.0, ahead.2), (&one_by_one.0, one_by_one.2), "{}", named.name);
                    } else if looked_at {
                        assert_eq!(ahead, one_by_one, "{} {wanted:?}", named.name);
                    }
                }
            }
        }
    }
}
