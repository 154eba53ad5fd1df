//! How the work of a plan is shared out over threads: over units or copies, or inside a force evaluation, and where it is so
//! little that waking a thread would cost more.

use super::super::closed_form::Cut;
use super::super::events::Event;
use super::super::request::Request;
use super::Plan;

/// From this many pairs per evaluation on, one force evaluation is shared out over threads.
const PAIRS_FOR_THREADS: u64 = 60_000;
/// From this many units times pairs on, units are shared out over threads: fewer are done before a thread wakes.
const WORK_FOR_THREADS: u64 = 64;
/// From this many states of bodies on, closed forms are shared out over threads.
const STATES_FOR_THREADS: usize = 4_096;

impl Plan {
    /// Threads over units or copies, and inside a force evaluation.
    pub(super) fn share_threads(&self, request: &Request) -> (usize, usize) {
        let threads = request.threads;
        if self.events.iter().any(Event::calls) {
            return (1, 1);
        }
        if !self.solutions.integrates() {
            let rows = self.copies.saturating_mul(request.times.len());
            let work = rows.saturating_mul(self.particles);
            let cut = Cut::new(self.particles, self.copies, request.times.len(), threads);
            let threads = threads.min(cut.parts());
            return (if work < STATES_FOR_THREADS { 1 } else { threads }, 1);
        }
        let units = self.copies * self.watched_kinds().len();
        let together =
            if self.guided { self.copies * self.pieces(self.passive.len(), threads) } else { units };
        let groups = together.div_ceil(self.layout.units());
        let pairs = self.pairs_per_evaluation();
        if groups == 1 && pairs >= PAIRS_FOR_THREADS {
            (1, threads)
        } else if (units as u64) * (1 + pairs) < WORK_FOR_THREADS {
            (1, 1)
        } else {
            (threads.min(groups), 1)
        }
    }
}
