//! Steps of a given length: what every method with a fixed step offers to the run.
//!
//! The one idea: the run knows nodes and never what happens between them, so a method may take many steps in one call
//! and keep its state to itself until somebody reads it.

use super::boris::BorisStep;
use super::multistep::MultistepStep;
use super::runge_kutta::RungeKuttaStep;
use super::separated::SeparatedStep;
use super::splitting::SplittingStep;
use super::state::State;
use super::system::{Form, System};
use super::{Method, Scheme};
use crate::error::{Error, Result};
use crate::numerics::element::Element;
use crate::parallel::Ticker;

/// A method with a step `h`, ready to advance a state from node to node, `n·h` after the start.
pub trait Stepper<S: Element>: Send {
    /// Begins anew, at another state, which is node 0.
    fn restart(&mut self);

    /// Advances the state at `node` by one step or, where that saves time, by more, up to `at_most`; returns how many.
    /// What it makes may stay behind until [`settle`](Self::settle).
    ///
    /// # Errors
    /// Those of an evaluation.
    fn step(
        &mut self,
        node: u64,
        at_most: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64>;

    /// Advances the state at `node` by so many steps, and shows each settled state that they lead to.
    ///
    /// # Errors
    /// Those of an evaluation; state and stepper are then of no node.
    fn steps(
        &mut self,
        node: u64,
        count: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
        each: &mut dyn FnMut(&State<S>),
    ) -> Result<()> {
        for taken in 0..count {
            let _one = self.step(node + taken, 1, state, system, ticker)?;
            self.settle(state);
            each(state);
        }
        Ok(())
    }

    /// Completes the state at the present node, which is to be read.
    fn settle(&mut self, state: &mut State<S>) {
        let _ = state;
    }

    /// Stands at `node`, a settled one, and goes over what it holds there besides the state: at most
    /// [`held`](Method::held) blocks, which lie as coordinates do. Read, they are the node's; overwritten with those of
    /// the same node of another run, of a stepper alike, the steps go on as there.
    fn memory(&mut self, node: u64, each: &mut dyn FnMut(&mut [S])) {
        let _ = (node, each);
    }

    /// From now on shadow steps may begin at the node before the present one, too, if one step has led from there.
    fn look_back(&mut self) {}

    /// Advances a copy of the settled state at `node`, the present one or where one [may look back](Self::look_back) to, by a
    /// step `past` instead, leaving the sequence as it is.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// As [`between`](Self::between), for who wants the coordinates: their velocities may be those that the forces before the
    /// end of the step make, where those at its end would take an evaluation.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn positions_between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.between(node, past, state, system, ticker)
    }
}

/// Numbers that the steps of one call change, about: some milliseconds at most between two looks at whether to stop.
const NUMBERS_PER_CALL: usize = 4096;

/// How many steps of a state of so many coordinates one call takes: more than one saves the way in and out.
pub fn per_call(coordinates: usize, at_most: u64) -> u64 {
    at_most.min((NUMBERS_PER_CALL / coordinates.max(1)) as u64).max(1)
}

/// The time of nodes, for systems that need it.
#[derive(Clone, Copy, Debug)]
pub struct Nodes {
    h: f64,
    needed: bool,
}

impl Nodes {
    /// Of steps `h` of a system.
    pub fn new<S: Element>(h: f64, system: &dyn System<S>) -> Self {
        Self { h, needed: system.needs().time }
    }
    /// Of steps `h` of a system that may need the time.
    pub const fn always(h: f64) -> Self {
        Self { h, needed: true }
    }
    /// The time of a node, as a product and never as a sum of steps.
    #[inline(always)]
    pub fn time<S: Element>(&self, node: u64) -> S {
        if self.needed { S::splat(self.h * node as f64) } else { S::zero() }
    }
    /// The time so long after a node.
    #[inline(always)]
    pub fn after<S: Element>(&self, node: u64, delay: &S) -> S {
        if self.needed { self.time::<S>(node) + *delay } else { *delay }
    }
    /// The acceleration at a state so long after a node.
    ///
    /// # Errors
    /// Those of an evaluation.
    #[inline(always)]
    pub fn acceleration<S: Element>(
        &self,
        (node, delay): (u64, &S),
        state: &State<S>,
        a: &mut [S],
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if self.needed {
            return self.timed((node, delay), state, a, system, ticker);
        }
        system.acceleration(delay, state.q(), state.v(), a, ticker)
    }
    /// A function of its own: the room for a time would be a burden where none is needed.
    #[inline(never)]
    fn timed<S: Element>(
        &self,
        (node, delay): (u64, &S),
        state: &State<S>,
        a: &mut [S],
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        system.acceleration(&self.after(node, delay), state.q(), state.v(), a, ticker)
    }
}

/// The method with step `h`, for a system and states like `state`.
///
/// # Errors
/// A method that chooses its own steps.
pub fn stepper<S: Element>(
    method: &'static Method,
    h: f64,
    system: &dyn System<S>,
    state: &State<S>,
) -> Result<Box<dyn Stepper<S>>> {
    if let Some(special) = system.special(method, h, state) {
        return Ok(special);
    }
    Ok(match &method.scheme {
        Scheme::Boris(table) => Box::new(BorisStep::new(table, h, system)),
        Scheme::Splitting(table) | Scheme::NystromSplitting(table) => match system.form() {
            Form::SecondOrder(_) => Box::new(SplittingStep::new(table, h, system)),
            Form::FirstOrder(_) => Box::new(SeparatedStep::new(table, h, system)),
        },
        Scheme::RungeKutta(tableau) => Box::new(RungeKuttaStep::new(tableau, h, system, state)),
        Scheme::Multistep(table) => Box::new(MultistepStep::new(table, h, system, state)),
        Scheme::Embedded(_) | Scheme::Taylor(_) => {
            return Err(Error::invalid("dt", format!("{} chooses its own steps; leave dt out", method.name)));
        }
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::ode::system::Needs;
    use crate::parallel::Control;
    use crate::registry::METHODS;

    /// A driven pendulum: the time of an acceleration is seen in its bits. Its force fails from some time on.
    pub(in super::super) struct Pendulum {
        pub(in super::super) evaluations: u64,
        pub(in super::super) fails_after: f64,
    }
    impl Pendulum {
        /// Whose force fails after that time.
        pub(in super::super) fn new(fails_after: f64) -> Self {
            Self { evaluations: 0, fails_after }
        }
    }
    impl System<f64> for Pendulum {
        fn form(&self) -> Form {
            Form::SecondOrder(1)
        }
        fn needs(&self) -> Needs {
            Needs { time: true, ..Needs::default() }
        }
        fn evaluations(&self) -> u64 {
            self.evaluations
        }
        fn acceleration(
            &mut self,
            t: &f64,
            q: &[f64],
            _: &[f64],
            a: &mut [f64],
            _: &mut Ticker<'_>,
        ) -> Result<()> {
            if *t > self.fails_after {
                return Err(Error::Convergence { message: "no force".to_owned(), time: *t });
            }
            self.evaluations += 1;
            a[0] = t.cos() - q[0].sin();
            Ok(())
        }
    }

    #[test]
    fn what_is_held_at_a_node_is_all_that_the_next_steps_need() {
        let control = Control::default();
        let mut ticker = Ticker::quiet(&control);
        let start = State::new(&[0.3], &[1.1]);
        for method in METHODS.iter().filter(|method| !method.adaptive()) {
            let new = || stepper(method, 0.07, &Pendulum::new(f64::INFINITY), &start).unwrap();
            for held_at in [1, 5, 12, 13, 40] {
                let (mut whole, mut state) = (new(), start.clone());
                let mut blocks: Vec<Vec<f64>> = Vec::new();
                let (mut other, mut resumed) = (new(), start.clone());
                let pendulum = &mut Pendulum::new(f64::INFINITY);
                for node in 0..60 {
                    if node == held_at {
                        whole.settle(&mut state);
                        whole.memory(node, &mut |block| blocks.push(block.to_vec()));
                        assert!(blocks.len() <= method.held(), "{}", method.name);
                        resumed.copy_from(&state);
                        let mut held = blocks.iter();
                        other.memory(node, &mut |block| block.copy_from_slice(held.next().unwrap()));
                        assert!(held.next().is_none());
                    }
                    assert_eq!(whole.step(node, 1, &mut state, pendulum, &mut ticker).unwrap(), 1);
                    if node >= held_at {
                        let _ = other.step(node, 1, &mut resumed, pendulum, &mut ticker).unwrap();
                    }
                }
                whole.settle(&mut state);
                other.settle(&mut resumed);
                let bits = |of: &State<f64>| {
                    let (y, rest) = of.all();
                    y.iter().chain(rest).map(|x| x.to_bits()).collect::<Vec<_>>()
                };
                assert_eq!(bits(&state), bits(&resumed), "{} from node {held_at}", method.name);
            }
        }
    }

    /// Positions inside a step are those of a shadow step; who kicks last needs no force for them, and nobody leaves a trace.
    #[test]
    fn positions_between_nodes_are_those_of_shadow_steps() {
        let control = Control::default();
        let mut ticker = Ticker::quiet(&control);
        let start = State::new(&[0.3], &[1.1]);
        for method in METHODS.iter().filter(|method| !method.adaptive()) {
            let pendulum = &mut Pendulum::new(f64::INFINITY);
            let (mut plain, mut looking) =
                [0; 2].map(|_| stepper(method, 0.07, pendulum, &start).unwrap()).into();
            let (mut state, mut other) = (start.clone(), start.clone());
            looking.look_back();
            for node in 0..20 {
                let before = other.clone();
                let _ = plain.step(node, 1, &mut state, pendulum, &mut ticker).unwrap();
                let _ = looking.step(node, 1, &mut other, pendulum, &mut ticker).unwrap();
                looking.settle(&mut other);
                let (mut whole, mut places) = (before.clone(), before);
                let begun = pendulum.evaluations;
                looking.positions_between(node, 0.03, &mut places, pendulum, &mut ticker).unwrap();
                let taken = pendulum.evaluations - begun;
                looking.between(node, 0.03, &mut whole, pendulum, &mut ticker).unwrap();
                assert_eq!(whole.q(), places.q(), "{} at node {node}", method.name);
                // Of the velocity an impulse of a part of the step is known otherwise.
                assert!((whole.v()[0] - places.v()[0]).abs() < 0.03 * 0.07, "{}", method.name);
                assert!(taken <= pendulum.evaluations - begun - taken, "{}", method.name);
                assert!(taken == 0 || method.name != "leapfrog");
            }
            plain.settle(&mut state);
            assert_eq!(state.all(), other.all(), "{} leaves a trace", method.name);
        }
    }
}
