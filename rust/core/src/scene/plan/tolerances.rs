//! How exact steps are and how long they may be, of what a request asks and the plan knows better.

use super::super::request::Request;
use super::{AS_KNOWN, Plan};

impl Plan {
    /// The relative tolerance of a run: events do not cost the digits that a closed form has.
    pub fn rtol(&self, request: &Request) -> f64 {
        if let Some(rtol) = self.held_to {
            rtol
        } else if self.known.as_ref().is_some_and(|known| !known.integrates()) {
            request.rtol.min(AS_KNOWN)
        } else {
            request.rtol
        }
    }

    /// The longest step of a run, with the sign of time left out.
    pub fn max_step(&self, request: &Request) -> f64 {
        request.max_step.or(self.longest_untold).unwrap_or(f64::MAX)
    }
}
