//! A copy on which no force acts, on its way through its collisions: rows are those of straight lines, contacts are known.

use super::first_leg::Leg;
use super::flights::Flights;
use super::member::Member;
use crate::error::{Error, Result};
use crate::forces::remaining::Remaining;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::Ticker;
use crate::scene::Scene;
use crate::scene::integrate::Ending;
use crate::scene::request::Request;
use crate::scene::run::run_through;

impl Member {
    /// Goes on to the next contact, or to the end; the spheres that touch there.
    pub(super) fn fly(
        &mut self,
        whole: &Scene,
        request: &Request,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(usize, usize)>> {
        let end = request.times.last().map_or(self.t0, |&end| end);
        if self.flights.is_none() && whole.copies == 1 {
            ticker.control().add_total((request.times.len() - self.outcome.rows) as u64);
        }
        match self.next_contact(end, ticker) {
            Ok(contact) => self.fly_to(contact, whole, request, ticker),
            // Nothing of what was run is lost.
            Err(Error::Interrupted) => {
                self.make_columns(whole, request)?;
                self.outcome.ending = Ending::Interrupted;
                Ok(None)
            }
            Err(other) => Err(other),
        }
    }

    /// How long after the start the next contact is, and whose; none after the end.
    fn next_contact(
        &mut self,
        end: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(DoubleDouble, (usize, usize))>> {
        let (now, end) = (self.along(self.time()), self.along((end, 0.0)));
        let flights = match &mut self.flights {
            Some(flights) => {
                flights.disturb(&self.bodies, ticker)?;
                flights
            }
            None => {
                let found = Flights::new(&self.bodies, (now, (end - now).to_f64()), ticker)?;
                self.flights.insert(found)
            }
        };
        Ok(flights.first().filter(|(at, _)| *at <= end))
    }

    fn fly_to(
        &mut self,
        contact: Option<(DoubleDouble, (usize, usize))>,
        whole: &Scene,
        request: &Request,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(usize, usize)>> {
        let left = &request.times[self.outcome.rows..];
        let before = |&t: &f64| contact.is_none_or(|(at, _)| self.along((t, 0.0)) <= at);
        let times = left[..left.partition_point(before)].to_vec();
        if !times.is_empty() {
            let leg = Remaining::of(&self.bodies.host);
            let scene = leg.scene(whole, self.copy, &self.bodies, self.time())?;
            let (_, total) = ticker.control().progress();
            let output = run_through(&scene, &self.asked(times, Vec::new()), ticker)?;
            if whole.copies == 1 {
                // All rows are counted from the start.
                ticker.control().set_total(total);
            }
            let _ = self.take(whole, request, &leg, &[], Leg::of(output)?)?;
            if self.outcome.ending != Ending::Finished {
                return Ok(None);
            }
        }
        self.make_columns(whole, request)?;
        let (Some((at, pair)), Some(flights)) = (contact, &mut self.flights) else { return Ok(None) };
        flights.go_to(at, &mut self.bodies);
        self.set_time(at);
        Ok(Some(pair))
    }

    /// How long after the start a time is, along the run.
    fn along(&self, (t, rest): (f64, f64)) -> DoubleDouble {
        let elapsed = DoubleDouble::sum(t, -self.t0) + DoubleDouble::from(rest);
        if self.bodies.direction < 0.0 { -elapsed } else { elapsed }
    }
}
