//! Gauss's methods as trials of eight trajectories, each with steps of its own.
//!
//! The one idea: a lane that starts, is refused or ends is a bit of a mask; whatever is decided of its step, its own [`Pace`]
//! decides, as it does for one trajectory ([`trial`](super::trial)).

mod beside_noise;
mod judged;

use super::columns::{AT_ONCE, Columns, NOTHING, Row, Work};
use super::extension::{self, ExtensionOfEight};
use super::pace::{Pace, Steps, first_step};
use super::rest;
use super::told::{felt, kept, led, led_to};
use super::trial::{NOTHING_WITHIN, no_convergence};
use super::{Beyond, Method, Table};
use crate::error::Result;
use crate::expressions::Code;
use crate::expressions::machine::Blocks;
use crate::generalized::abreast::SideBySide;
use crate::narrow::UNSEEN;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::looks::Looks;
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::system::{Form, System};
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;
use std::sync::Arc;

/// A collocation method at work on eight trajectories.
pub struct GaussEight {
    method: &'static Method,
    table: &'static Table,
    /// Where a step looks.
    looks: Looks,
    beyond: &'static Beyond,
    form: Form,
    /// Whether accelerations look at velocities.
    velocity: bool,
    machine: Blocks<AT_ONCE>,
    columns: Columns,
    /// Rates of the last kept steps, and their lengths.
    before: Vec<Row>,
    length: Lanes,
    length_tried: Lanes,
    /// Rates at the ends of the steps that are tried.
    ends: Vec<Lanes>,
    /// Rates at the beginnings of the first ones.
    begin: Vec<Lanes>,
    /// What is read within the steps that were tried, and of which lanes that has been found.
    extension: ExtensionOfEight,
    extended: Bits,
    /// Rates at the first and at the last stages.
    edges: [Vec<Lanes>; 2],
    next: State<Lanes>,
    steps: Steps,
    longest: f64,
    /// Where the system's time stands at the start.
    t0: f64,
    paces: [Pace; WIDTH],
    /// Evaluations of all stages that nobody was told of.
    taken: [u64; WIDTH],
    /// Why lanes cannot go on.
    lost: [Option<String>; WIDTH],
}

impl GaussEight {
    /// At work on states like `state`; the code gives the rates of the first order, the accelerations of the second.
    pub fn new(
        method: &'static Method,
        (code, parameters, form, velocity): (Arc<Code>, &[Lanes], Form, bool),
        state: &State<Lanes>,
        (steps, longest): (Steps, f64),
        t0: f64,
    ) -> Self {
        let evaluated = form.evaluated();
        Self {
            method,
            table: method.table,
            looks: method.table.looks(),
            beyond: method.beyond(),
            form,
            velocity,
            machine: Blocks::new(code, parameters),
            columns: Columns::new(evaluated),
            before: vec![NOTHING; evaluated],
            length: Lanes::zero(),
            length_tried: Lanes::zero(),
            ends: vec![Lanes::zero(); evaluated],
            begin: vec![Lanes::zero(); evaluated],
            extension: ExtensionOfEight::new(evaluated),
            extended: Bits(0),
            edges: [vec![Lanes::zero(); evaluated], vec![Lanes::zero(); evaluated]],
            next: state.clone(),
            steps,
            longest,
            t0,
            paces: [Pace::default(); WIDTH],
            taken: [0; WIDTH],
            lost: [const { None }; WIDTH],
        }
    }

    /// Lanes of which something holds.
    fn lanes(&self, holds: impl Fn(usize, &Pace) -> bool) -> Bits {
        let lanes = self.paces.iter().enumerate().filter(|(lane, pace)| holds(*lane, pace));
        lanes.fold(Bits(0), |mask, (lane, _)| mask.or(Bits(1 << lane)))
    }

    /// Stages that begin where the last steps lead, or at their ends.
    fn guess(&mut self, h: Lanes, running: Bits) {
        let first = self.lanes(|_, pace| pace.kept == 0).and(running);
        let equal = self.lanes(|lane, _| h.0[lane] == self.length.0[lane]);
        let other = running.and(first.not()).and(equal.not());
        led(&self.table.ahead, self.table.stages, &self.before, &mut self.columns.guess);
        if other.any() {
            let ratio = h / self.length;
            let fractions = self.table.c.0.map(|c| Lanes::one() + Lanes::splat(c) * ratio);
            led_to(self.table, &fractions, other, &self.before, &mut self.columns.guess);
        }
        if first.any() {
            for guess in self.columns.guess.iter_mut().flatten() {
                *guess = Lanes::select(first, Lanes::zero(), *guess);
            }
        }
        self.columns.rates.copy_from_slice(&self.columns.guess);
    }

    /// Looks for what motions from rest are measured by, in the lanes of the mask, over the spans of their runs.
    fn look_ahead(&mut self, y: &[Lanes], lanes: Bits, (begin, span): (Lanes, Lanes)) {
        for look in 0..rest::LOOKS {
            let times = core::array::from_fn(|lane| rest::time(look, (begin.0[lane], span.0[lane])));
            self.machine.run(Lanes(times), y);
            for (i, least) in self.columns.least.iter_mut().enumerate() {
                let rates = self.machine.output(i);
                for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
                    least.0[lane] = rest::size(least.0[lane], rates.0[lane], span.0[lane]);
                }
            }
        }
        for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
            self.taken[lane] += (rest::LOOKS / WIDTH) as u64;
        }
    }

    /// Finds what states within the steps of these lanes are read by.
    fn extend(&mut self, outcome: &Settled<Lanes>, state: &State<Lanes>, lanes: Bits) {
        if !lanes.any() {
            return;
        }
        let (t, h, fading) = (Lanes::splat(self.t0) + outcome.from, outcome.h, Lanes::one());
        let Self { table, form, velocity, machine, columns, .. } = self;
        let (table, form, velocity) = (*table, *form, *velocity);
        let mut work = Work { table, form, velocity, machine, state, columns, t, h, fading, running: lanes };
        let found = extension::find_eight(self.method.extension(), &mut work, &mut self.extension);
        self.count(&found.evaluations, lanes);
        self.extended = self.extended.or(found.converged);
        for lane in (0..WIDTH).filter(|&lane| lanes.and(found.converged.not()).lane(lane)) {
            self.lost[lane] = Some(NOTHING_WITHIN.to_owned());
        }
    }

    fn count(&mut self, evaluations: &[u32; WIDTH], lanes: Bits) {
        for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
            self.taken[lane] += u64::from(evaluations[lane]);
        }
    }
}

impl SideBySide for GaussEight {
    fn set_parameters(&mut self, parameters: &[Lanes]) {
        self.machine.set_parameters(parameters);
    }

    fn taken(&mut self, lane: usize) -> u64 {
        core::mem::take(&mut self.taken[lane])
    }

    fn lost(&mut self, lane: usize) -> Option<String> {
        self.lost[lane].take()
    }
}

impl Trial<Lanes> for GaussEight {
    fn start(
        &mut self,
        fresh: Bits,
        _: &mut dyn System<Lanes>,
        state: &State<Lanes>,
        clock: &mut Clock<Lanes>,
        _: &Norm<Lanes>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        for size in self.columns.sizes.iter_mut().chain(&mut self.columns.least) {
            *size = Lanes::select(fresh, Lanes::zero(), *size);
        }
        if matches!(self.steps, Steps::Chosen { .. }) {
            self.machine.run(Lanes::splat(self.t0) + clock.elapsed, state.all().0);
            for (i, begin) in self.begin.iter_mut().enumerate() {
                *begin = Lanes::select(fresh, self.machine.output(i), *begin);
            }
        }
        for lane in (0..WIDTH).filter(|&lane| fresh.lane(lane)) {
            (self.taken[lane], self.lost[lane]) = (0, None);
            let span = clock.end.0[lane] - clock.elapsed.0[lane];
            self.paces[lane] = Pace::over(span);
            clock.h.0[lane] = match self.steps {
                Steps::Equal(h) => h.copysign(span),
                Steps::Chosen { .. } => {
                    self.taken[lane] = 1;
                    let y = |i: usize| state.all().0[i].0[lane];
                    let rate = |i: usize| self.machine.output(i).0[lane];
                    first_step(self.form, (y, rate), (span, self.longest))
                }
            };
        }
        if matches!(self.steps, Steps::Chosen { held: false, .. }) {
            let y = state.all().0;
            let rests = |lane: usize| self.form.measured(y).iter().all(|y| y.0[lane] == 0.0);
            let at_rest = self.lanes(|lane, _| rests(lane)).and(fresh);
            if at_rest.any() {
                let begin = Lanes::splat(self.t0) + clock.elapsed;
                self.look_ahead(y, at_rest, (begin, clock.end - clock.elapsed));
            }
        }
        Ok(())
    }

    fn attempt(
        &mut self,
        running: Bits,
        system: &mut dyn System<Lanes>,
        state: &State<Lanes>,
        clock: &mut Clock<Lanes>,
        _: &Norm<Lanes>,
        _: &mut Ticker<'_>,
    ) -> Result<Settled<Lanes>> {
        let h = Lanes::next_step(clock, running);
        self.extended = Bits(0);
        let planned = clock.h;
        self.guess(h, running);
        let t = Lanes::splat(self.t0) + clock.elapsed;
        let (iterated, known) = self.iterated((t, h), state, running);
        self.count(&iterated.evaluations, running);
        let smoothness = self.smoothness(h, running);
        for (lane, pace) in self.paces.iter_mut().enumerate().filter(|(lane, _)| running.lane(*lane)) {
            pace.converged = iterated.converged.lane(lane);
            pace.delta = if pace.converged { smoothness.0[lane] } else { f64::INFINITY };
        }
        let asked = running.and(known.not());
        let noisy = self.lanes(|lane, pace| {
            asked.lane(lane) && pace.may_be_noise(self.steps, || self.most_noise(lane, state, h))
        });
        let mut is_known = known;
        if noisy.any() {
            self.look_for_noise((t, false), state, noisy);
            let smoothness = self.smoothness(h, running);
            for lane in (0..WIDTH).filter(|&lane| noisy.lane(lane)) {
                self.paces[lane].takes_beside_noise(smoothness.0[lane]);
            }
            is_known = known.or(noisy.and(self.lanes(|_, pace| pace.noisy)));
        }
        let of =
            |tolerance: f64| (self.beyond.rounding.resolving(self.table, self.form, tolerance), self.form);
        for lane in (0..WIDTH).filter(|&lane| running.lane(lane)) {
            let left = is_known.lane(lane).then_some(iterated.left.0[lane]);
            self.paces[lane].resolving = self.steps.resolving(left, of);
        }
        let felt = felt(self.form, self.table.stages, &self.columns, h);
        for lane in (0..WIDTH).filter(|&lane| running.lane(lane)) {
            let pace = &mut self.paces[lane];
            pace.felt = if pace.converged { felt.0[lane] } else { f64::INFINITY };
        }
        let missed = self.missed(t + h, h, running);
        let mut errors = Lanes::zero();
        for (pace, missed) in self.paces.iter_mut().zip(missed.0) {
            pace.missed = missed;
        }
        self.ask_for_errors((t, h), state, running);
        for lane in (0..WIDTH).filter(|&lane| running.lane(lane)) {
            let pace = &mut self.paces[lane];
            if pace.refuses(self.steps, &self.beyond.ending) {
                errors.0[lane] = 4.0;
                if matches!(self.steps, Steps::Equal(_)) {
                    self.lost[lane] = Some(no_convergence(h.0[lane]));
                }
            }
        }
        let asked = errors.less_equal(Lanes::zero()).and(running);
        let seen = self.seen_until(system, state, (clock.elapsed, h), asked)?;
        for lane in (0..WIDTH).filter(|&lane| asked.lane(lane) && seen.0[lane] < 1.0) {
            errors.0[lane] = 4.0;
            if matches!(self.steps, Steps::Equal(_)) {
                self.lost[lane] = Some(UNSEEN.to_owned());
            }
        }
        let kept = errors.less_equal(Lanes::zero());
        let remembered = kept.or(self.lanes(|_, pace| pace.kept == 0));
        self.columns.remember(running.and(iterated.converged).and(remembered), kept);
        let outcome = Lanes::settle(clock, running, errors, &Rule::new(1, Lanes::splat(f64::INFINITY)));
        self.length_tried = h;
        for lane in (0..WIDTH).filter(|&lane| running.lane(lane)) {
            let (pace, h) = (&mut self.paces[lane], h.0[lane]);
            clock.h.0[lane] = if seen.0[lane] < 1.0 {
                pace.after_unseen(h, seen.0[lane])
            } else if errors.0[lane] > 0.0 {
                pace.instead_of(h, self.steps, self.table)
            } else if outcome.finished.lane(lane) {
                planned.0[lane]
            } else {
                pace.after(h, (self.steps, self.longest), self.table)
            };
        }
        Ok(outcome)
    }

    fn next(&self) -> &State<Lanes> {
        &self.next
    }

    /// Of lanes whose fraction is zero nothing is asked.
    fn at(
        &mut self,
        outcome: &Settled<Lanes>,
        _: &mut dyn System<Lanes>,
        state: &State<Lanes>,
        theta: Lanes,
        into: &mut State<Lanes>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let asked = Lanes::zero().less(theta);
        self.extend(outcome, state, asked.and(self.extended.not()));
        let from = (self.form, state);
        extension::read_eight(self.method.extension(), &self.extension, from, (theta, outcome.h), into);
        Ok(())
    }

    fn keep(&mut self, accepted: Bits, state: &mut State<Lanes>) {
        state.take_over(&self.next, accepted);
        kept(&self.columns.rates, accepted, &mut self.before);
        self.length = Lanes::select(accepted, self.length_tried, self.length);
        for (lane, pace) in self.paces.iter_mut().enumerate() {
            pace.kept += u64::from(accepted.lane(lane));
        }
    }

    fn cost(&self) -> Cost {
        // What stages take is told by their own count.
        Cost::default()
    }
}
