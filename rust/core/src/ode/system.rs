//! What an integrator asks of a mechanical system: its derivatives, and what it can do besides.
//!
//! The one idea: problem and method meet in this trait and nowhere else. What a system is and needs is asked once per
//! run, never per step, so a kernel that fuses much stays whole behind one virtual call.

use super::Method;
use super::looks::Looks;
use super::series::Jet;
use super::state::State;
use super::stepper::Stepper;
use super::transformation::Monitor;
use crate::error::{Error, Result};
use crate::numerics::element::{Element, PairMut};
use crate::numerics::real::Mask;
use crate::parallel::Ticker;

/// The form of a system's equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `y' = f(t, y)`, so many numbers.
    FirstOrder(usize),
    /// `q'' = a(t, q, v)`, so many coordinates; the state is `[q | v]`.
    SecondOrder(usize),
}

impl Form {
    /// Numbers of a state.
    pub const fn len(self) -> usize {
        match self {
            Self::FirstOrder(numbers) => numbers,
            Self::SecondOrder(coordinates) => 2 * coordinates,
        }
    }
    /// Whether a state has no numbers.
    pub const fn is_empty(self) -> bool {
        self.len() == 0
    }
    /// Of a state the numbers whose derivatives have to be evaluated: velocities, of the second order.
    pub fn measured<N>(self, state: &[N]) -> &[N] {
        &state[self.len() - self.evaluated()..]
    }
    /// Numbers of a derivative that has to be evaluated: the velocities of the second order are known.
    pub const fn evaluated(self) -> usize {
        match self {
            Self::FirstOrder(numbers) => numbers,
            Self::SecondOrder(coordinates) => coordinates,
        }
    }
}

/// What the evaluation of a system looks at besides coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The time.
    pub time: bool,
    /// The velocities, for anything but a rotation.
    pub velocity: bool,
    /// The velocities, to turn them about a fixed axis at a fixed rate: then it can do so exactly ([`System::rotate`]).
    pub rotation: bool,
}

impl Needs {
    /// What either looks at.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self {
            time: self.time | other.time,
            velocity: self.velocity | other.velocity,
            rotation: self.rotation | other.rotation,
        }
    }

    /// Whether velocities have to be there.
    pub const fn velocities(self) -> bool {
        self.velocity | self.rotation
    }
}

/// States on the way of a step: places as parts of it, ascending, the first 0 and the last 1, with the states there.
pub type Visited = Vec<(f64, Vec<f64>)>;

/// A step that was taken, for who asks what it has not seen.
pub struct Taken<'a, S: Element> {
    /// The lanes that are asked of.
    pub asked: S::Mask,
    /// The time before it.
    pub from: S,
    /// Its length.
    pub h: S,
    /// The states at its ends.
    pub ends: [&'a [S]; 2],
    /// The derivatives there or near there, as [`System::rate`] or [`System::acceleration`] gives them, if they are known.
    pub rates: Option<[&'a [S]; 2]>,
    /// Where the method looks.
    pub looks: &'a Looks,
    /// Whether what it knows of its beginning tells of all the step, as a series does.
    pub series: bool,
    /// The states that it went through in a lane, if more than its ends are known.
    pub visited: Option<&'a dyn Fn(usize) -> Visited>,
}

impl<'a, S: Element> Taken<'a, S> {
    /// One of which nothing is known but where it began and where it ended.
    pub fn from_end_to_end(asked: S::Mask, (from, h): (S, S), ends: [&'a [S]; 2]) -> Self {
        Self { asked, from, h, ends, rates: None, looks: &Looks::AT_ENDS, series: false, visited: None }
    }

    /// Asks the first `numbers` of each half of the state, which are a system of the second order of their own.
    ///
    /// # Errors
    /// As [`System::seen_until`].
    pub fn ask_first_of_halves(&self, numbers: usize, system: &mut dyn System<S>) -> Result<Option<S>> {
        let ends = self.ends.map(|state| first_of_halves(state, numbers));
        // Of the second order accelerations are all that is told.
        let first = |rates: &[S]| if rates.len() == self.ends[0].len() { rates.len() / 2 } else { 0 };
        let accelerations = |rates: &[S]| rates[first(rates)..][..numbers].to_vec();
        let rates = self.rates.map(|rates| rates.map(accelerations));
        let visited = |lane: usize| -> Visited {
            let whole = self.visited.map(|visited| visited(lane)).unwrap_or_default();
            whole.into_iter().map(|(place, state)| (place, first_of_halves(&state, numbers))).collect()
        };
        let step = Taken {
            ends: [&ends[0], &ends[1]],
            rates: rates.as_ref().map(|[first, last]| [&first[..], &last[..]]),
            visited: self.visited.map(|_| &visited as &dyn Fn(usize) -> Visited),
            ..*self
        };
        system.seen_until(&step)
    }
}

/// The first numbers of each half of a state.
fn first_of_halves<T: Copy>(state: &[T], numbers: usize) -> Vec<T> {
    let (first, second) = state.split_at(state.len() / 2);
    [&first[..numbers], &second[..numbers]].concat()
}

/// A system of ordinary differential equations, of one trajectory or of eight in lanes. Times are counted from the start
/// of the run, so that a start far from zero costs no digits; a system that does not need them may be given any.
pub trait System<S: Element>: Send {
    /// The form of its equations, for the whole run.
    fn form(&self) -> Form;

    /// What its evaluation looks at.
    fn needs(&self) -> Needs {
        Needs { time: true, velocity: true, rotation: false }
    }

    /// Evaluations so far.
    fn evaluations(&self) -> u64;

    /// Counts evaluations that a [`special`](Self::special) kernel has done.
    fn count(&mut self, evaluations: u64) {
        let _ = evaluations;
    }

    /// Writes `f(t, y)` of a system of the first order.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when the caller asked to stop; the derivative is then unfinished.
    fn rate(&mut self, t: &S, y: &[S], rate: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        let _ = (t, y, rate, ticker);
        Err(Error::Internal("the system has no rates".to_owned()))
    }

    /// Writes `a(t, q, v)` of a system of the second order. If it does not need velocities they may be of any time.
    ///
    /// # Errors
    /// As [`rate`](Self::rate).
    fn acceleration(&mut self, t: &S, q: &[S], v: &[S], a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        let _ = (t, q, v, a, ticker);
        Err(Error::Internal("the system has no accelerations".to_owned()))
    }

    /// As [`acceleration`](Self::acceleration), without what rotates velocities.
    ///
    /// # Errors
    /// As [`rate`](Self::rate).
    fn kick(&mut self, t: &S, q: &[S], a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        self.acceleration(t, q, &[], a, ticker)
    }

    /// Expands the motion from the state that the jet begins with, up to its order.
    ///
    /// # Errors
    /// As [`rate`](Self::rate); of a system that has no series.
    fn expand(&mut self, jet: &mut Jet<S>, ticker: &mut Ticker<'_>) -> Result<()> {
        let _ = (jet, ticker);
        Err(Error::Internal("the system has no series".to_owned()))
    }

    /// Writes the coefficient of order `n` of the accelerations of a motion (in the jet's unit of time) whose coefficients of
    /// places and velocities are there up to that order, and were asked for in turn.
    ///
    /// # Errors
    /// As [`expand`](Self::expand).
    fn coefficient(&mut self, n: usize, jet: &Jet<S>, a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        let _ = (n, jet, a, ticker);
        Err(Error::Internal("the system has no series".to_owned()))
    }

    /// The longest step up to `h` over which what it was [expanded](Self::expand) in last is as smooth as that tells, if
    /// anything in it may turn sharply.
    fn smooth_until(&self, jet: &Jet<S>, h: &S) -> Option<S> {
        let _ = (jet, h);
        None
    }

    /// The part of a step up to which nothing that matters lies between the places where the method looks, 1 in lanes where that
    /// holds for all of it; nothing if it does in all.
    ///
    /// # Errors
    /// [`Error::Convergence`] where no shorter step can be taken.
    fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        let _ = step;
        Ok(None)
    }

    /// The lanes in which nothing would have been unseen in a step so many times as long as the one that was last
    /// [asked of](Self::seen_until), if all went on as it does there: in those a few steps may go unasked.
    fn calm(&mut self, step: &Taken<'_, S>, times: f64) -> S::Mask {
        let _ = (step, times);
        S::Mask::splat(true)
    }

    /// How long a step of a system of the second order may be from a state with these accelerations, if something on the
    /// way acts that no step feels before it is there.
    fn longest_step(&self, state: (&[S], &[S]), a: &[S]) -> Option<S> {
        let _ = (state, a);
        None
    }

    /// Takes a state to which a step or a polynomial has led to where states of the system are, if its numbers are bound to
    /// each other, as those of a quaternion.
    fn settle(&self, state: &mut State<S>) {
        let _ = state;
    }

    /// Turns velocities exactly as what rotates them does in the time `h`.
    fn rotate(&mut self, h: f64, v: PairMut<'_, S>) {
        let _ = (h, v);
    }

    /// Whether an evaluation takes so long that it ticks, and so may be interrupted in its middle. Whoever changes a
    /// state between evaluations must then be able to take that back.
    fn stops_midway(&self) -> bool {
        false
    }

    /// A kernel that takes steps `h` of the method itself, faster than a force evaluation at a time.
    fn special(&self, method: &'static Method, h: f64, state: &State<S>) -> Option<Box<dyn Stepper<S>>> {
        let _ = (method, h, state);
        None
    }
    /// What tells a time transformation how fast time goes, if the system was made for one.
    fn monitor(&mut self) -> Option<&mut dyn Monitor<S>> {
        None
    }
}
