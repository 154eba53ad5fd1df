//! The events that the units found, put together: one table, copy after copy, in the order of the motion.

use super::super::integrate::{Ending, Report};
use super::{Outcome, Part};

/// A line of the table.
#[derive(Clone, Copy, Debug)]
struct Line {
    copy: usize,
    which: usize,
    t: f64,
    /// What that leaves out.
    t_rest: f64,
    /// Where its states begin.
    states: usize,
    /// The spheres that touch, if it is that.
    spheres: Option<(usize, usize)>,
}

/// The events of a run.
#[derive(Clone, Debug, Default)]
pub struct Events {
    lines: Vec<Line>,
    /// Position and velocity of every particle, event after event; NaN of those that are integrated apart.
    states: Vec<[[f64; 3]; 2]>,
}

impl Events {
    /// Adds what the units of a part found up to the end of their copy.
    pub(super) fn gather(&mut self, part: &Part<'_>, reports: &[Report], outcomes: &[Outcome]) {
        let t0 = part.scene.t0;
        let elapsed = |t: f64| (t - t0).abs();
        let mut ends = vec![f64::INFINITY; outcomes.len()];
        for report in reports {
            let copy = part.member(report.unit.copy);
            let end = match report.ending {
                // What was found beyond the last state of a run that was interrupted is true.
                Ending::Finished | Ending::Interrupted => f64::INFINITY,
                // When is not known: later than all that was found on the way.
                Ending::NotFinite => {
                    let last = report.found.last().map_or(0.0, |found| elapsed(found.t));
                    last.max(elapsed(outcomes[copy].time))
                }
                _ => elapsed(report.time),
            };
            ends[copy] = ends[copy].min(end);
        }
        for report in reports {
            let copy = part.member(report.unit.copy);
            for found in report.found.iter().filter(|found| elapsed(found.t) <= ends[copy]) {
                let states = self.states.len();
                self.states.resize(states + part.scene.particles, [[f64::NAN; 3]; 2]);
                for (&state, &body) in found.states.iter().zip(&*report.unit.bodies) {
                    self.states[states + body] = state;
                }
                self.lines.push(Line {
                    copy,
                    which: found.which,
                    t: found.t,
                    t_rest: found.t_rest,
                    states,
                    spheres: found.spheres,
                });
            }
        }
    }

    /// Brings the table into order.
    pub(super) fn sort(&mut self, direction: f64) {
        self.lines.sort_by(|a, b| {
            let later = (direction * a.t).total_cmp(&(direction * b.t));
            a.copy.cmp(&b.copy).then(later).then(a.which.cmp(&b.which))
        });
    }

    /// The spheres that touched last, if that is what ended the run, and what the time of that leaves out.
    pub fn contact(&self) -> Option<((usize, usize), f64)> {
        self.lines.last().and_then(|line| Some((line.spheres?, line.t_rest)))
    }

    /// Those of one copy, of a table in order.
    pub fn of_copy(&self, copy: usize, particles: usize) -> Self {
        let first = self.lines.partition_point(|line| line.copy < copy);
        let own = self.lines[first..].iter().take_while(|line| line.copy == copy);
        let mut events = Self::default();
        for line in own {
            let states = events.states.len();
            events.states.extend(&self.states[line.states..line.states + particles]);
            events.lines.push(Line { states, ..*line });
        }
        events
    }

    /// Adds events of another table, which are called otherwise there, of bodies that are `places` of it each.
    pub fn extend(&mut self, other: &Self, copy: usize, names: &[usize], places: &[usize]) {
        for line in other.lines.iter().filter(|line| line.spheres.is_none()) {
            let states = self.states.len();
            self.states.extend(places.iter().map(|place| other.states[line.states + place]));
            self.lines.push(Line { copy, which: names[line.which], states, ..*line });
        }
    }

    /// Adds an event, with the states of all bodies.
    pub fn put(&mut self, copy: usize, which: usize, t: f64, bodies: impl Iterator<Item = [[f64; 3]; 2]>) {
        let states = self.states.len();
        self.states.extend(bodies);
        self.lines.push(Line { copy, which, t, t_rest: 0.0, states, spheres: None });
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The copy, the event and the time of each.
    pub fn lines(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        self.lines.iter().map(|line| (line.copy, line.which, line.t))
    }

    /// The positions (0) or velocities (1) of all particles at each.
    pub fn states(&self, of: usize, particles: usize) -> Vec<f64> {
        let lines = self.lines.iter();
        lines
            .flat_map(|line| &self.states[line.states..line.states + particles])
            .flat_map(|state| state[of])
            .collect()
    }
}
