//! How exact steps are and how long they may be, of what a request asks and the plan knows better.

use super::super::request::Request;
use super::{AS_KNOWN, Plan};

/// What steps are held to that are chosen of themselves where nobody asks for anything. Errors of single steps add up over
/// many turns: the planets are off by 6e-5 AU after a century of steps held to 1e-9, and by 6e-8 with this, in 1.2 (series)
/// to 1.8 times the time (Verner's 9(8)).
const OF_ITSELF: f64 = 1e-12;

/// That, of a request which leaves both the method and the tolerance open.
pub(super) fn of_itself(automatic: bool, request: &Request) -> Option<f64> {
    (automatic && !request.rtol_given).then_some(request.rtol.min(OF_ITSELF))
}

impl Plan {
    /// The relative tolerance of a run: events do not cost the digits that a closed form has.
    pub fn rtol(&self, request: &Request) -> f64 {
        let known = self.known.as_ref().is_some_and(|known| !known.integrates());
        if known { request.rtol.min(AS_KNOWN) } else { self.held_to.unwrap_or(request.rtol) }
    }

    /// The longest step of a run, with the sign of time left out.
    pub fn max_step(&self, request: &Request) -> f64 {
        request.max_step.or(self.longest_untold).unwrap_or(f64::MAX)
    }
}
