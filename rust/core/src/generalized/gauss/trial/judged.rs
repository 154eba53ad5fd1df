//! By what a tried step of one trajectory is judged before it is taken: how smooth the motion is, whether the ends are those of
//! the stages, and what lies between these unseen.

use super::super::between::shows;
use super::super::decay::error_of_mean;
use super::super::noise;
use super::super::rounding::{HARDLY, ROUNDING};
use super::super::step::{Stages, largest, led};
use super::GaussStep;
use crate::error::Result;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::system::{Form, System, Taken, Visited};

/// The greatest of so many numbers, without their signs; a NaN counts as infinite.
fn greatest(stages: usize, of: impl Fn(usize) -> f64) -> f64 {
    largest(Lanes(core::array::from_fn(|k| if k < stages { of(k).abs() } else { 0.0 })))
}

impl GaussStep {
    /// The most that noise leads a step astray, as a part of a size.
    pub(super) fn most_noise(&self, state: &State<f64>, h: f64) -> f64 {
        let largest = state.all().0.iter().fold(0.0, |most, y| Real::max(y.abs(), most));
        let scale = self.stages.scales.iter().fold(0.0, |most, &scale| Real::max(scale, most));
        let amplified = self.beyond.rounding.amplified(self.table, self.pace.kept, (self.length, h));
        noise::most(largest, (self.form, h)) * amplified * h.abs() * scale
    }

    /// How far the polynomial of the step before leads astray; in the first step, how much its last term adds. What rounding and
    /// noise explain is nothing.
    pub(super) fn smoothness(&self, h: f64) -> f64 {
        let largest_rate = self.stages.told.iter().fold(0.0, |most, told| Real::max(told.0, most));
        let amplified = self.beyond.rounding.amplified(self.table, self.pace.kept, (self.length, h));
        let rounding = ROUNDING * amplified * largest_rate;
        let mut most = 0.0;
        let Stages { told, rates, scales, noise, .. } = &self.stages;
        for i in 0..told.len() {
            let (largest, astray) = told[i];
            let astray = if self.pace.kept == 0 { self.table.leading(|k| rates[i].0[k]) } else { astray };
            let hardly_moves = largest <= HARDLY * largest_rate;
            let astray = if hardly_moves && astray <= rounding { 0.0 } else { astray };
            let delta = Real::max(astray - amplified * noise[i], 0.0) * h.abs() * scales[i];
            most = if delta > most { delta } else { most };
        }
        most
    }

    /// By how much the step changes velocities, as parts of them; of the first order, where rates that differ between stages
    /// change numbers with the square of the step, the root of that.
    pub(super) fn felt(&self, h: f64) -> f64 {
        let second_order = matches!(self.form, Form::SecondOrder(_));
        let mut most = 0.0;
        let Stages { told, rates, scales, .. } = &self.stages;
        for i in 0..told.len() {
            let beside = |k: usize| rates[i].0[k] - rates[i].0[0];
            let change = if second_order { told[i].0 } else { greatest(self.table.stages, beside) };
            let felt = change * h.abs() * scales[i];
            most = if felt <= most { most } else { felt };
        }
        if second_order { most } else { most.sqrt() }
    }

    /// The part of the step between whose stages nothing lies that none of them feels.
    pub(super) fn seen_until(
        &mut self,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        (from, h): (f64, f64),
    ) -> Result<f64> {
        let last = self.table.stages - 1;
        for (index, rates) in self.stages.rates.iter().enumerate() {
            [self.edges[0][index], self.edges[1][index]] = [rates.0[0], rates.0[last]];
        }
        let Self { table, form, looks, stages, next, edges, .. } = self;
        let rates = Some([&edges[0][..], &edges[1][..]]);
        let ends = [state.all().0, next.all().0];
        let visited =
            |_: usize| table.visited(*form, ends.map(|end| end.to_vec()), h, |i, k| stages.rates[i].0[k]);
        let (asked, visited) = (true, Some(&visited as &dyn Fn(usize) -> Visited));
        let seen =
            system.seen_until(&Taken { asked, from, h, ends, rates, looks, series: false, visited })?;
        Ok(seen.unwrap_or(1.0))
    }

    /// By how much the rates at the end of the step, and at the beginning of the first, are not those that the stages lead to,
    /// as a part of a size.
    pub(super) fn missed(&mut self, t: f64, h: f64) -> f64 {
        let Self { beyond, machine, stages, led: there, begin, next, pace, .. } = self;
        led(&beyond.ending.weights, &stages.rates, there);
        for (register, &y) in machine.state().iter_mut().zip(next.all().0) {
            *register = Lanes([y; WIDTH]);
        }
        machine.run(Lanes([t; WIDTH]));
        self.evaluations += 1;
        let limit = stages.limit();
        let part = |away: f64, i: usize| {
            let by_noise = beyond.ending.noise * stages.noise[i];
            let away = if away.abs() < by_noise { 0.0 } else { away.abs() - by_noise };
            away * h.abs() * Real::min(stages.scales[i], limit)
        };
        let mut most = 0.0;
        for (i, led) in there.iter().enumerate() {
            let missed = part(machine.output(i).0[0] - led.0[0], i);
            most = if missed <= most { most } else { missed };
        }
        if pace.kept > 0 {
            return most;
        }
        led(&beyond.ending.first, &stages.rates, there);
        for (i, (led, begin)) in there.iter().zip(begin.iter()).enumerate() {
            let missed = part(begin - led.0[0], i);
            most = if missed <= most { most } else { missed };
        }
        most
    }

    /// Looks by how much rates between the stages are not those of the polynomial.
    pub(super) fn look_between(&mut self, (t, h): (f64, f64), state: &State<f64>) {
        let Self { beyond, form, machine, stages, led: there, missed_between, .. } = self;
        let Some(between) = &beyond.between else { return };
        let (y, n, h) = (state.all().0, form.evaluated(), Lanes::splat(h));
        let numbers = |i: usize| Lanes::splat(y[i]);
        led(&between.way, &stages.rates, there);
        match form {
            Form::FirstOrder(_) => {
                for (i, (register, &way)) in machine.state().iter_mut().zip(&*there).enumerate() {
                    *register = numbers(i) + h * way;
                }
            }
            Form::SecondOrder(_) => {
                for (i, (register, &way)) in machine.state().iter_mut().skip(n).zip(&*there).enumerate() {
                    *register = numbers(n + i) + h * way;
                }
                led(&between.way_of_way, &stages.rates, there);
                for (i, (register, &way)) in machine.state().iter_mut().zip(&*there).enumerate() {
                    *register = numbers(i) + h * (between.places * numbers(n + i) + h * way);
                }
            }
        }
        machine.run(Lanes::splat(t) + h * between.places);
        self.evaluations += 1;
        led(&between.rates, &stages.rates, there);
        for (i, missed) in missed_between.iter_mut().enumerate() {
            let away = machine.output(i) - there[i];
            *missed = largest(away.map(f64::abs));
        }
    }

    /// By how much the step errs, as its polynomial tells, and rates between the stages show if these were looked at; as a part
    /// of a size.
    pub(super) fn error(&mut self, h: f64, is_looked_at: bool) -> f64 {
        let Self { beyond, stages, led: coefficients, missed_between, .. } = self;
        let Some(rows) = &beyond.coefficients else { return 0.0 };
        led(rows, &stages.rates, coefficients);
        let limit = stages.limit();
        let mut most = 0.0;
        for (i, coefficients) in coefficients.iter().enumerate() {
            let (error, last) = error_of_mean(coefficients.0, stages.noise[i]);
            let part = error * h.abs() * Real::min(stages.scales[i], limit);
            let missed = missed_between[i] - beyond.ending.noise * stages.noise[i];
            if part > most && (!is_looked_at || shows(missed, last)) {
                most = part;
            }
        }
        most
    }
}
