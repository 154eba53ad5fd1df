//! Many trajectories of a model, eight side by side.
//!
//! The one idea: a lane is a trajectory, with steps of its own; when one ends, the next that waits takes its lane. Each
//! lane does what [`solve`](super::run::solve) does for one, operation by operation, so a copy has the bits that it has alone.
//! Methods with equal steps go from node to node together, and take up copies eight at a time.

mod endings;
mod events;
mod outputs;
mod side_by_side;

pub use side_by_side::SideBySide;

use super::events::{Function, Watch};
use super::gauss::GaussEight;
use super::model::Model;
use super::motion::Motion;
use super::poles::Poles;
use super::run::{Integrator, Request, Solution, norm, solve, too_many_steps};
use super::sticking::Sticking;
use crate::error::{Error, Result};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::Scheme;
use crate::ode::norm::Norm;
use crate::ode::run::{Ending, is_lost, smallest_step};
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Settled};
use crate::ode::system::{Form, System};
use crate::ode::trial::Cost;
use crate::parallel::Ticker;
use side_by_side::trial;

/// The largest linear system with which stages that fill all lanes go side by side: dearer equations gain less by what four
/// blocks of them share than trajectories lose that wait for the slowest of eight.
const LARGEST_SYSTEM: usize = 1;

/// Whether a run goes side by side: outputs are read at given times, nobody else's function is called, and no state is put elsewhere
/// on the way.
pub fn together(model: &Model, request: &Request) -> bool {
    let lanes_are_trajectories = match request.integrator {
        Integrator::Table(_) => true,
        Integrator::Gauss(method) => {
            method.leaves_lanes() || model.systems.iter().all(|system| system.right.len() <= LARGEST_SYSTEM)
        }
        _ => false,
    };
    lanes_are_trajectories
        && request.outputs.is_some()
        && !request.events.iter().any(|event| matches!(event.function, Function::Called(_)))
        && model.projection.is_none()
        && request.span.0 != request.span.1
}

/// A trajectory in its lane.
struct Slot<'a> {
    /// Its place among all.
    index: usize,
    solution: Solution,
    next_output: usize,
    /// The shortest step from where it is.
    smallest: f64,
    /// Where the step that is tried begins.
    from: f64,
    /// Evaluations of all lanes together before it began.
    before: u64,
    sticking: Sticking,
    poles: Poles,
    watch: Watch<'a>,
    /// Where an event ends it.
    stop: Option<f64>,
    /// Evaluations of the system that it alone has asked for.
    looked: u64,
}

/// What is at work.
struct Abreast<'a> {
    model: &'a Model,
    request: &'a Request,
    outputs: &'a [f64],
    system: Motion<Lanes>,
    trial: Box<dyn SideBySide>,
    cost: Cost,
    /// Whether all lanes are on the same steps.
    in_step: bool,
    norm: Norm<Lanes>,
    clock: Clock<Lanes>,
    state: State<Lanes>,
    between: State<Lanes>,
    parameters: Vec<Lanes>,
    slots: [Option<Slot<'a>>; WIDTH],
    /// Evaluations of the system that single lanes have asked for.
    looked: u64,
    done: Vec<Option<Solution>>,
    /// Those that went through a pole.
    passed: Vec<usize>,
}

/// Runs states (n numbers each) with their parameters. Each that ends is told to the ticker.
///
/// # Errors
/// As [`solve`](super::run::solve).
pub fn solve_together(
    model: &Model,
    request: &Request,
    (states, parameters): (&[f64], &[f64]),
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Solution>> {
    let (numbers, count) = (model.numbers(), model.source.parameters);
    let members = states.len() / numbers;
    let member =
        |index: usize| (&states[index * numbers..][..numbers], &parameters[index * count..][..count]);
    let mut run = Abreast::new(model, request, member(0), members)?;
    let mut waiting = 0..members;
    let outcome = loop {
        let fresh = run.take_up(&mut waiting, member)?;
        let running = run.running();
        if !running.any() {
            break Ok(());
        }
        if let Err(error) = run.advance(fresh, running, ticker) {
            break Err(error);
        }
    };
    match outcome {
        Ok(()) => {
            // By themselves, in shorter steps.
            for index in core::mem::take(&mut run.passed) {
                run.done[index] = Some(solve(model, request, member(index), ticker)?);
            }
        }
        Err(Error::Interrupted) => run.interrupt(),
        Err(error) => return Err(error),
    }
    let untouched = |(index, solution): (usize, Option<Solution>)| {
        let begun = || Solution::at(request.span.0, member(index).0);
        solution.unwrap_or_else(|| Solution { ending: Ending::Interrupted, ..begun() })
    };
    Ok(run.done.into_iter().enumerate().map(untouched).collect())
}

impl<'a> Abreast<'a> {
    /// For runs like that of the first member, which stands in idle lanes.
    fn new(
        model: &'a Model,
        request: &'a Request,
        (y0, parameters): (&[f64], &[f64]),
        members: usize,
    ) -> Result<Self> {
        let wide = |values: &[f64]| values.iter().map(|&x| Lanes::splat(x)).collect::<Vec<_>>();
        let (t0, end) = request.span;
        let parameters = wide(parameters);
        let mut system = Motion::<Lanes>::of(model, request, &parameters, Lanes::splat(t0));
        let y0 = wide(y0);
        let state = match system.form() {
            Form::FirstOrder(_) => State::first_order(y0),
            Form::SecondOrder(n) => State::new(&y0[..n], &y0[n..]),
        };
        let max_step = request.longest_step(model);
        let (trial, in_step): (Box<dyn SideBySide>, bool) = match request.integrator {
            Integrator::Gauss(method) => {
                let of = (model.code.clone(), &*parameters, model.form, model.needs().velocity);
                let eight = GaussEight::new(method, of, &state, (request.gauss_steps(method), max_step), t0);
                (Box::new(eight), false)
            }
            Integrator::Table(method) => {
                let max_step = Lanes::splat(max_step);
                let in_step = !matches!(method.scheme, Scheme::Embedded(_) | Scheme::Taylor(_));
                (trial(method, request, &mut system, &state, max_step)?, in_step)
            }
            _ => {
                return Err(Error::Internal(
                    "points of a step and trajectories cannot both be the lanes".to_owned(),
                ));
            }
        };
        Ok(Self {
            model,
            request,
            outputs: request.outputs.as_deref().unwrap_or_default(),
            cost: trial.cost(),
            trial,
            in_step,
            norm: norm(request, system.form().len()),
            system,
            clock: Clock::new(Lanes::splat(end - t0)),
            between: state.clone(),
            state,
            parameters,
            slots: [const { None }; WIDTH],
            looked: 0,
            done: (0..members).map(|_| None).collect(),
            passed: vec![],
        })
    }

    /// Evaluations of the system that all lanes have taken together.
    fn taken_together(&self) -> u64 {
        self.system.evaluations() - self.looked
    }

    fn running(&self) -> Bits {
        let lanes = self.slots.iter().enumerate().filter(|(_, slot)| slot.is_some());
        lanes.fold(Bits(0), |mask, (lane, _)| mask.or(Bits(1 << lane)))
    }

    /// Gives free lanes to those that wait; which lanes were given.
    fn take_up<'m>(
        &mut self,
        waiting: &mut core::ops::Range<usize>,
        member: impl Fn(usize) -> (&'m [f64], &'m [f64]),
    ) -> Result<Bits> {
        let mut fresh = Bits(0);
        if self.in_step && self.slots.iter().any(Option::is_some) {
            return Ok(fresh);
        }
        let (t0, end) = self.request.span;
        for lane in 0..WIDTH {
            if self.slots[lane].is_some() {
                continue;
            }
            let Some(index) = waiting.next() else { break };
            let (y0, parameters) = member(index);
            let (y, rest) = self.state.all_mut();
            for ((y, rest), &value) in y.iter_mut().zip(rest).zip(y0) {
                (y.0[lane], rest.0[lane]) = (value, 0.0);
            }
            for (own, &value) in self.parameters.iter_mut().zip(parameters) {
                own.0[lane] = value;
            }
            let atol = self.request.absolute_tolerances(self.model, parameters, y0);
            if let (Some(mean), Some(atol)) = (&mut self.norm.mean, atol) {
                for (own, value) in mean.atol.iter_mut().zip(atol) {
                    own.0[lane] = value;
                }
            }
            fresh = fresh.or(Bits(1 << lane));
            let solution = Solution::at(t0, y0);
            let (from, before) = (t0, self.taken_together());
            let sticking = Sticking::new(self.model, parameters, t0);
            let poles = Poles::new(self.model, parameters, t0, y0);
            let mut watch = Watch::new(&self.request.events, parameters);
            watch.start(t0, y0)?;
            self.slots[lane] = Some(Slot {
                index,
                solution,
                next_output: 0,
                smallest: 0.0,
                from,
                before,
                sticking,
                poles,
                watch,
                stop: None,
                looked: 0,
            });
        }
        if fresh.any() {
            self.system.set_parameters(&self.parameters);
            self.trial.set_parameters(&self.parameters);
            self.clock.restart(fresh, Lanes::splat(end - t0));
        }
        Ok(fresh)
    }

    /// Tries a step in every lane, and keeps those that are accepted.
    fn advance(&mut self, fresh: Bits, running: Bits, ticker: &mut Ticker<'_>) -> Result<()> {
        if fresh.any() {
            let Self { trial, system, state, clock, norm, .. } = self;
            let before = system.evaluations();
            trial.start(fresh, system, state, clock, norm, ticker)?;
            let start = self.system.evaluations() - before;
            for (_, slot) in self.in_lanes(fresh) {
                slot.solution.evaluations += start;
            }
        }
        self.begin_steps(running);
        ticker.tick()?;
        let Self { trial, system, state, clock, norm, .. } = self;
        let outcome = trial.attempt(running, system, state, clock, norm, ticker)?;
        let kept = self.judge(&outcome, running, ticker);
        let mut kept = self.short_of_poles(kept, ticker);
        let watches = kept.any() && !self.request.events.is_empty();
        if watches {
            kept = self.look_for_events(&outcome, kept, ticker)?;
        }
        self.record(&outcome, kept, watches, ticker)?;
        self.look_for_rest(kept, ticker);
        self.trial.keep(kept, &mut self.state);
        for (_, slot) in self.in_lanes(kept) {
            slot.solution.last_time = slot.solution.reached;
        }
        self.stop_at_events(kept, ticker);
        for lane in 0..WIDTH {
            if outcome.finished.and(kept).lane(lane) {
                self.end(lane, Ending::Finished, None, ticker);
            }
        }
        Ok(())
    }

    /// The slots in the lanes of a mask.
    fn in_lanes(&mut self, mask: Bits) -> impl Iterator<Item = (usize, &mut Slot<'a>)> {
        let slots = self.slots.iter_mut().enumerate().filter(move |(lane, _)| mask.lane(*lane));
        slots.filter_map(|(lane, slot)| slot.as_mut().map(|slot| (lane, slot)))
    }

    /// Where steps begin that are no second tries: no step is shorter than the time can tell.
    fn begin_steps(&mut self, running: Bits) {
        let (t0, end) = self.request.span;
        let Self { clock, slots, .. } = self;
        for (lane, slot) in slots.iter_mut().enumerate().filter(|(lane, _)| running.lane(*lane)) {
            let Some(slot) = slot else { continue };
            if slot.smallest != 0.0 {
                continue;
            }
            slot.from = t0 + clock.elapsed.0[lane];
            slot.smallest = smallest_step(slot.from);
            let h = &mut clock.h.0[lane];
            if h.abs() < slot.smallest && clock.elapsed.0[lane] != clock.end.0[lane] {
                *h = slot.smallest.copysign(end - t0);
            }
        }
    }

    /// Ends the lanes that cannot go on, and counts; those whose step is to be kept.
    fn judge(&mut self, outcome: &Settled<Lanes>, running: Bits, ticker: &mut Ticker<'_>) -> Bits {
        let mut kept = Bits(0);
        let (t0, end) = self.request.span;
        // Nothing times a number is no number where that is none, or infinite.
        let mut nothing = [0.0; WIDTH];
        for y in self.trial.next().all().0 {
            for (nothing, y) in nothing.iter_mut().zip(y.0) {
                *nothing += y * 0.0;
            }
        }
        for lane in (0..WIDTH).filter(|&lane| running.lane(lane)) {
            let finite = nothing[lane] == 0.0;
            let (h, elapsed) = (self.clock.h.0[lane], self.clock.elapsed.0[lane]);
            let (cost, in_step, together) = (self.cost, self.in_step, self.taken_together());
            let (taken, lost) = (self.trial.taken(lane), self.trial.lost(lane));
            let Some(slot) = &mut self.slots[lane] else { continue };
            let Slot { solution, smallest, .. } = slot;
            solution.evaluations += cost.tried + taken;
            if in_step {
                solution.evaluations = together - slot.before + slot.looked;
            }
            if lost.is_some() {
                self.end(lane, Ending::StepTooSmall, lost, ticker);
                continue;
            }
            if !outcome.accepted.lane(lane) {
                if h.is_nan() || h.abs() < *smallest {
                    self.end(lane, Ending::StepTooSmall, None, ticker);
                }
                continue;
            }
            solution.evaluations += cost.kept;
            if is_lost(outcome.h.0[lane], *smallest) && !outcome.finished.lane(lane) {
                self.end(lane, Ending::StepTooSmall, None, ticker);
                continue;
            }
            if !finite {
                self.end(lane, Ending::NotFinite, None, ticker);
                continue;
            }
            if solution.steps == self.request.max_steps {
                let why = too_many_steps(self.request.max_steps);
                self.end(lane, Ending::TooManySteps, Some(why), ticker);
                continue;
            }
            *smallest = 0.0;
            solution.steps += 1;
            solution.reached = if outcome.finished.lane(lane) { end } else { t0 + elapsed };
            let length = (solution.reached - slot.from).abs();
            solution.h = if length > solution.h { length } else { solution.h };
            kept = kept.or(Bits(1 << lane));
        }
        kept
    }
}
