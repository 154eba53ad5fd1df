//! By what eight tried steps are judged before they are taken: how smooth the motion is, whether the ends are those of the
//! stages, and what lies between these unseen.

use super::super::columns::NOTHING;
use super::super::told::{errors, led, missed, smoothness};
use super::GaussEight;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::ode::system::{Form, System, Taken, Visited};

impl GaussEight {
    /// How far the polynomials of the steps before lead astray; in a first step, how much its last term adds. What
    /// rounding and noise explain is nothing.
    pub(super) fn smoothness(&self, h: Lanes, running: Bits) -> Lanes {
        let mut amplified = Lanes::one();
        for (lane, amplified) in amplified.0.iter_mut().enumerate() {
            *amplified = self.amplified(lane, h);
        }
        let first = self.lanes(|_, pace| pace.kept == 0).and(running);
        smoothness(self.table, &self.columns, (amplified, h), first)
    }

    /// So many times what rates are off a step is led astray in a lane.
    pub(super) fn amplified(&self, lane: usize, h: Lanes) -> f64 {
        let steps = (self.length.0[lane], h.0[lane]);
        self.beyond.rounding.amplified(self.table, self.paces[lane].kept, steps)
    }

    /// By how much the rates at the ends of steps are not those that the stages lead to, where that is to be asked.
    pub(super) fn missed(&mut self, t: Lanes, h: Lanes, running: Bits) -> Lanes {
        let asked = self.lanes(|_, pace| pace.missable(self.steps)).and(running);
        if !asked.any() {
            return Lanes::zero();
        }
        self.machine.run(t, self.next.all().0);
        for (i, rate) in self.ends.iter_mut().enumerate() {
            *rate = self.machine.output(i);
        }
        for lane in (0..WIDTH).filter(|&lane| asked.lane(lane)) {
            self.taken[lane] += 1;
        }
        let (stages, ending) = (self.table.stages, &self.beyond.ending);
        let mut most = missed((&ending.weights, ending.noise), stages, &self.columns, &self.ends, h);
        let first = self.lanes(|_, pace| pace.kept == 0).and(asked);
        if first.any() {
            let begun = missed((&ending.first, ending.noise), stages, &self.columns, &self.begin, h);
            for lane in (0..WIDTH).filter(|&lane| first.lane(lane)) {
                let (begun, most) = (begun.0[lane], &mut most.0[lane]);
                *most = if begun <= *most { *most } else { begun };
            }
        }
        most
    }

    /// Tells the paces by how much steps err, as their polynomials tell, as parts of sizes.
    pub(super) fn ask_for_errors(&mut self, (t, h): (Lanes, Lanes), state: &State<Lanes>, running: Bits) {
        self.paces.iter_mut().for_each(|pace| pace.error = 0.0);
        let asked = self.lanes(|_, pace| pace.may_err(self.steps)).and(running);
        self.take_errors(h, asked, None);
        let again = self.lanes(|_, pace| pace.errs(self.steps)).and(running);
        if again.any() {
            let missed = self.missed_between((t, h), state, again);
            self.take_errors(h, again, Some(&missed));
            let noisy = self.lanes(|_, pace| pace.errs(self.steps)).and(again);
            self.look_for_noise((t, true), state, noisy);
            self.take_errors(h, noisy, Some(&missed));
        }
    }

    /// By how much rates between the stages are not those of the polynomials.
    fn missed_between(&mut self, (t, h): (Lanes, Lanes), state: &State<Lanes>, asked: Bits) -> Vec<Lanes> {
        let Self { beyond, table, form, machine, columns, taken, .. } = self;
        let (y, n) = (state.all().0, form.evaluated());
        let mut missed = vec![Lanes::zero(); n];
        let Some(between) = &beyond.between else { return missed };
        let led_by = |weights: &[Lanes; WIDTH]| {
            let mut to = vec![NOTHING; n];
            led(weights, table.stages, &columns.rates, &mut to);
            to
        };
        let (way, way_of_way, rates) =
            (led_by(&between.way), led_by(&between.way_of_way), led_by(&between.rates));
        let mut there = y.to_vec();
        for place in 0..WIDTH {
            let x = Lanes::splat(between.places.0[place]);
            for i in 0..n {
                match form {
                    Form::FirstOrder(_) => there[i] = y[i] + h * way[i][place],
                    Form::SecondOrder(_) => {
                        there[n + i] = y[n + i] + h * way[i][place];
                        there[i] = y[i] + h * (x * y[n + i] + h * way_of_way[i][place]);
                    }
                }
            }
            machine.run(t + h * x, &there);
            for (i, missed) in missed.iter_mut().enumerate() {
                let away = (machine.output(i) - rates[i][place]).abs();
                for (most, away) in missed.0.iter_mut().zip(away.0) {
                    // What is no number counts as infinite.
                    let away = if away.is_nan() { f64::INFINITY } else { away };
                    *most = if away > *most { away } else { *most };
                }
            }
        }
        for lane in (0..WIDTH).filter(|&lane| asked.lane(lane)) {
            taken[lane] += 1;
        }
        missed
    }

    fn take_errors(&mut self, h: Lanes, asked: Bits, missed_between: Option<&[Lanes]>) {
        let Some(rows) = self.beyond.coefficients.as_ref().filter(|_| asked.any()) else { return };
        let missed = missed_between.map(|missed| (missed, self.beyond.ending.noise));
        let found = errors(rows, self.table.stages, &self.columns, missed, h);
        for (lane, pace) in self.paces.iter_mut().enumerate().filter(|(lane, _)| asked.lane(*lane)) {
            pace.error = found.0[lane];
        }
    }

    /// The parts of steps between whose stages nothing lies that none of them feels, in the lanes of the mask.
    pub(super) fn seen_until(
        &mut self,
        system: &mut dyn System<Lanes>,
        state: &State<Lanes>,
        (from, h): (Lanes, Lanes),
        asked: Bits,
    ) -> Result<Lanes> {
        if !asked.any() {
            return Ok(Lanes::one());
        }
        let last = self.table.stages - 1;
        for (index, row) in self.columns.rates.iter().enumerate() {
            [self.edges[0][index], self.edges[1][index]] = [row[0], row[last]];
        }
        let Self { table, form, looks, columns, next, edges, .. } = self;
        let rates = Some([&edges[0][..], &edges[1][..]]);
        let ends = [state.all().0, next.all().0];
        let visited = |lane: usize| {
            let of = |end: &[Lanes]| end.iter().map(|y| y.0[lane]).collect::<Vec<f64>>();
            table.visited(*form, ends.map(of), h.0[lane], |i, k| columns.rates[i][k].0[lane])
        };
        let visited = Some(&visited as &dyn Fn(usize) -> Visited);
        let seen =
            system.seen_until(&Taken { asked, from, h, ends, rates, looks, series: false, visited })?;
        Ok(seen.unwrap_or(Lanes::one()))
    }
}
