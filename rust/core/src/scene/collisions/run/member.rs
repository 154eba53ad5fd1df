//! One copy on its way through its collisions: leg after leg, each to the next contact or to the end.

use super::super::{Collision, Collisions, Impact};
use super::first_leg::Leg;
use super::flights::Flights;
use super::settled::Met;
use super::squeezed::Squeezed;
use super::start::{bodies_of, part_of};
use super::wanted;
use crate::error::Result;
use crate::forces::remaining::Remaining;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::Ticker;
use crate::scene::Scene;
use crate::scene::collisions::flies;
use crate::scene::columns::Columns;
use crate::scene::events::Event;
use crate::scene::integrate::Ending;
use crate::scene::request::Request;
use crate::scene::room::give_back;
use crate::scene::run::{Events, Kept, Outcome, Reached, run_through};
use std::collections::BTreeMap;

/// The longest first step after a collision, beside the mean time from one to the next.
const TIMES_BETWEEN: f64 = 4.0;

/// A copy, and what has been done of its run.
pub(super) struct Member {
    pub(super) bodies: Impact,
    pub(super) columns: Columns,
    pub(super) outcome: Outcome,
    /// What the time of that leaves out.
    time_rest: f64,
    /// When the run began.
    pub(super) t0: f64,
    pub(super) events: Events,
    pub(super) lines: Vec<Collision>,
    pub(super) kept: Option<Kept>,
    /// The node that the last leg went on from.
    pub(super) from: u64,
    /// Where the last leg began.
    pub(super) begun: Reached,
    pub(super) copy: usize,
    /// What is asked of each leg, but for times and events.
    of_a_leg: Request,
    pub(super) rule: Collisions,
    pub(super) met: BTreeMap<(usize, usize), Met>,
    pub(super) squeezed: Squeezed,
    /// The bodies on their way to the next contact, where no force acts.
    pub(super) flights: Option<Flights>,
    /// How often each event was found.
    pub(super) found: Vec<u64>,
}

impl Member {
    /// Runs a copy, whose first leg may be known.
    pub(super) fn run(
        scene: &Scene,
        request: &Request,
        (rule, copy): (Collisions, usize),
        (direction, first): (f64, Option<Leg>),
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let bodies = bodies_of(scene, copy, rule, direction);
        let of_a_leg = Request {
            times: Vec::new(),
            events: Vec::new(),
            threads: if scene.copies > 1 { 1 } else { request.threads },
            collisions: None,
            ..request.clone()
        };
        let mut member = Self {
            begun: bodies.states(),
            bodies,
            columns: Columns::default(),
            outcome: Outcome { rows: 0, time: scene.t0, ..Outcome::finished(request) },
            time_rest: 0.0,
            t0: scene.t0,
            events: Events::default(),
            lines: Vec::new(),
            kept: None,
            from: 0,
            copy,
            of_a_leg,
            rule,
            met: BTreeMap::new(),
            squeezed: Squeezed::default(),
            flights: None,
            found: vec![0; request.events.len()],
        };
        let Some(mut found) = member.first(scene, request, first, ticker)? else { return Ok(member) };
        let end = request.times.len();
        loop {
            let goes_on = member.collide_and_look(scene, request, found, ticker)?;
            // Who has nothing more to record is where the collision has put it.
            if !goes_on || member.outcome.rows == end {
                return Ok(member);
            }
            let touching = if member.flights.is_none() { member.touching(Some(found)) } else { Vec::new() };
            match member.leg(scene, request, (end, Some(&touching)), ticker)? {
                Some(next) => found = next,
                None => return Ok(member),
            }
        }
    }

    /// Runs to the first contact beyond the start; the spheres that touch there.
    fn first(
        &mut self,
        scene: &Scene,
        request: &Request,
        first: Option<Leg>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(usize, usize)>> {
        if let Some(first) = first {
            let names: Vec<usize> = (0..request.events.len()).collect();
            return self.take(scene, request, &Remaining::of(&self.bodies.host), &names, first);
        }
        let mut touching = self.bodies.touching();
        // Those that overlap from the start are refused unless they are to merge.
        let merges = self.rule == Collisions::Merge && touching.iter().any(|&pair| self.bodies.overlap(pair));
        if merges || touching.iter().any(|&pair| self.bodies.approach(pair).is_some()) {
            // The rows of the start are of before.
            let at_start = request.times.iter().take_while(|&&t| t == scene.t0).count();
            if at_start > 0 {
                let nothing = Request { events: Vec::new(), ..request.clone() };
                let _ = self.leg(scene, &nothing, (at_start, None), ticker)?;
            }
            if !self.collide(None) || self.outcome.rows == request.times.len() {
                return Ok(None);
            }
            touching = self.bodies.touching();
        }
        self.leg(scene, request, (request.times.len(), Some(&touching)), ticker)
    }

    /// Runs on to the next contact, or to the end; the spheres that touch there. None are looked for without those that
    /// touch at the start.
    fn leg(
        &mut self,
        whole: &Scene,
        request: &Request,
        (end, touching): (usize, Option<&[(usize, usize)]>),
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(usize, usize)>> {
        if self.flights.is_some() {
            return self.fly(whole, request, ticker);
        }
        let leg = Remaining::of(&self.bodies.host);
        let mut scene = leg.scene(whole, self.copy, &self.bodies, self.time())?;
        if touching.is_some() && request.events.is_empty() && flies(&scene, 0, request) {
            return self.fly(whole, request, ticker);
        }
        if self.lines.is_empty() && self.outcome.rows == 0 {
            scene.continuation =
                whole.continuation.as_ref().map(|from| part_of(from, whole, self.copy, &leg));
        }
        let (events, names) = match touching {
            Some(touching) => leg.events(&request.events, &self.found, &scene, touching),
            None => (Vec::new(), Vec::new()),
        };
        let max_steps = request.max_steps.map(|most| most.saturating_sub_unsigned(self.outcome.counts.steps));
        if max_steps.is_some_and(|most| most < 1) && self.outcome.counts.steps > 0 {
            self.outcome.ending = Ending::TooManySteps;
            return Ok(None);
        }
        let times = request.times[self.outcome.rows..end].to_vec();
        let asked = Request { max_steps, ..self.asked(times, events) };
        let (done, total) = ticker.control().progress();
        let output = Leg::of(run_through(&scene, &asked, ticker)?)?;
        if whole.copies == 1 {
            // What a leg leaves to be done is counted with the next one.
            ticker.control().set_total(total + ticker.control().progress().0 - done);
        }
        self.take(whole, request, &leg, &names, output)
    }

    /// What is asked of a leg.
    pub(super) fn asked(&self, times: Vec<f64>, events: Vec<Event>) -> Request {
        Request { times, events, first_step: self.first_step(), ..self.of_a_leg.clone() }
    }

    /// The longest first step of a leg, a few times the mean time from one collision to the next. Those that come near each
    /// other in a step are all looked at, which in one that is long beside that time are most of all pairs.
    fn first_step(&self) -> Option<f64> {
        let between = self.elapsed().abs() / self.lines.len() as f64;
        (between > 0.0 && between.is_finite()).then_some(TIMES_BETWEEN * between)
    }

    /// How far it has come, and what that leaves out.
    pub(super) fn time(&self) -> (f64, f64) {
        (self.outcome.time, self.time_rest)
    }

    /// Comes to a time so long after the start, along the run.
    pub(super) fn set_time(&mut self, along: DoubleDouble) {
        let elapsed = if self.bodies.direction < 0.0 { -along } else { along };
        (self.outcome.time, self.time_rest) = (DoubleDouble::from(self.t0) + elapsed).parts();
    }

    /// How long after the start that is.
    pub(super) fn elapsed(&self) -> f64 {
        (self.outcome.time - self.t0) + self.time_rest
    }

    /// The pairs in contact, and one that was found: spheres that graze each other may be told apart already.
    pub(super) fn touching(&self, found: Option<(usize, usize)>) -> Vec<(usize, usize)> {
        let mut touching = match &self.flights {
            Some(flights) => flights.touching(&self.bodies),
            None => self.bodies.touching(),
        };
        if let Some(found) = found.filter(|&pair| self.bodies.is_whole(pair) && !touching.contains(&pair)) {
            touching.push(found);
        }
        touching
    }

    /// Takes in what a leg gives; the spheres that touch at its end.
    pub(super) fn take(
        &mut self,
        whole: &Scene,
        request: &Request,
        leg: &Remaining,
        names: &[usize],
        output: Leg,
    ) -> Result<Option<(usize, usize)>> {
        let outcome = output.outcome;
        self.begun = self.bodies.states();
        for (place, &body) in leg.bodies.iter().enumerate() {
            self.bodies.position[body] = output.reached.position[place];
            self.bodies.velocity[body] = output.reached.velocity[place];
        }
        self.bodies.follow();
        for (_, which, _) in output.events.lines() {
            if let Some(&name) = names.get(which) {
                self.found[name] += 1;
            }
        }
        self.events.extend(&output.events, self.copy, names, &leg.places);
        let rows = self.outcome.rows;
        self.outcome.rows += outcome.rows;
        (self.outcome.time, self.time_rest) = (outcome.time, 0.0);
        self.outcome.add(&outcome);
        let at_once = leg.bodies.len() == whole.particles && outcome.rows == request.times.len();
        if rows == 0 && at_once {
            self.columns = output.columns;
        } else {
            self.make_columns(whole, request)?;
            record(&mut self.columns, &output.columns, (rows, outcome.rows), leg);
            give_back(output.columns.position);
            give_back(output.columns.velocity);
        }
        self.from = output.from;
        self.kept = output.kept.map(|kept| Kept { held: kept.held.of_bodies(&leg.places), ..kept });
        if outcome.ending == Ending::Stopped
            && let Some(((i, j), rest)) = output.events.contact()
        {
            self.time_rest = rest;
            let (i, j) = (leg.bodies[i], leg.bodies[j]);
            return Ok(Some((i.min(j), i.max(j))));
        }
        self.outcome.ending = match outcome.ending {
            Ending::CloseEncounter { bodies: (i, j), distance } => {
                Ending::CloseEncounter { bodies: (leg.bodies[i], leg.bodies[j]), distance }
            }
            other => other,
        };
        Ok(None)
    }

    /// Room for all rows, if there is none yet.
    pub(super) fn make_columns(&mut self, whole: &Scene, request: &Request) -> Result<()> {
        if self.columns.times == 0 {
            self.columns = Columns::new(1, request.times.len(), whole.particles, &wanted(request))?;
        }
        Ok(())
    }
}

impl Outcome {
    /// Adds the cost and the doubts of a leg.
    fn add(&mut self, leg: &Self) {
        self.counts += leg.counts;
        self.energy_error = self.energy_error.max(leg.energy_error);
    }
}

/// Copies rows of a leg to their places: from this one on, so many.
fn record(all: &mut Columns, of_leg: &Columns, (from, rows): (usize, usize), leg: &Remaining) {
    let particles = leg.places.len();
    for (into, own) in [(&mut all.position, &of_leg.position), (&mut all.velocity, &of_leg.velocity)] {
        if into.is_empty() {
            continue;
        }
        let own = own.chunks_exact(3 * leg.bodies.len());
        for (into, own) in into.chunks_exact_mut(3 * particles).skip(from).zip(own).take(rows) {
            for (point, place) in into.chunks_exact_mut(3).zip(&leg.places) {
                point.copy_from_slice(&own[3 * place..3 * place + 3]);
            }
        }
    }
    for (into, own) in all.derived.iter_mut().zip(&of_leg.derived) {
        let width = own.column.width;
        into.values[from * width..(from + rows) * width].copy_from_slice(&own.values[..rows * width]);
    }
}
