//! Tents and boxes: what is written with absolute values and switches, whose arguments change sides twice within a step.
//!
//! The one idea: of such it matters on which side of zero an argument is, and that changes at once. A stretch between two changes on
//! which hardly any stage looks is known to nobody; there the rates are also found with the sides before it and after it.

use super::super::features::{AtEnds, Fades};
use super::super::way::Way;
use super::{Criteria, Search, lanes, smaller};
use crate::expressions::narrow::Kind;
use crate::numerics::lanes::{Lanes, WIDTH};

/// Rounds of a search for a change of sides, each in a ninth of the last.
const ROUNDS: usize = 14;
/// What lasts no longer than this part of the time is no stretch that steps could be made shorter for.
const HARDLY: f64 = 1e-12;
/// So many looks that count know a stretch.
const LOOKS: usize = 3;

/// Arguments at places of a way.
pub(super) struct Sampled {
    pub(super) places: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
}

/// A stretch of a way on which no argument changes sides, and places in those before it and after it, as far as they are in the step.
struct Stretch {
    from: f64,
    to: f64,
    beside: [Option<f64>; 2],
}

impl Search {
    /// Where the first stretch begins on which sides that hardly a look has matter. Of switches in steps that can be shorter their
    /// levels tell, as they are smooth.
    pub(super) fn unseen_sides(
        &mut self,
        way: &Way,
        sampled: &Sampled,
        sizes: &[f64],
        Criteria { reach, equal, tolerance }: Criteria,
    ) -> Option<f64> {
        let of = self.of.clone();
        let is_switch =
            |a: usize| equal && of.fades[a] != Fades::Nowhere && !matches!(of.at_ends[a], AtEnds::Power(_));
        let switches: Vec<bool> = (0..of.fades.len()).map(is_switch).collect();
        let mut changes = Vec::new();
        for argument in (0..of.fades.len()).filter(|&a| of.has_absolute(a) || switches[a]) {
            for looks in way.looks.places().windows(2) {
                let index = |look: f64| sampled.places.partition_point(|&place| place < look);
                let range = [index(looks[0]), index(looks[1])];
                let [a, b] = range.map(|sample| sampled.values[argument][sample]);
                if of.has_absolute(argument) || (b - a).abs() > reach {
                    changes.extend(self.changes(way, argument, sampled, range));
                }
            }
        }
        if changes.is_empty() {
            return None;
        }
        changes.extend([0.0, 1.0]);
        changes.sort_by(f64::total_cmp);
        let stretches: Vec<[f64; 2]> = changes.windows(2).map(|two| [two[0], two[1]]).collect();
        let middle = |k: usize| stretches.get(k).map(|[from, to]| 0.5 * (from + to));
        let unknown = (0..stretches.len()).find(|&k| {
            let [from, to] = stretches[k];
            let beside = [k.checked_sub(1).and_then(middle), middle(k + 1)];
            // Equal steps are as coarse as they were asked for: what begins or ends in one is known to it. Of others a step control
            // knows what time hardly tells apart.
            let is_inner = beside.iter().all(Option::is_some);
            let counts =
                is_inner || (!equal && (to - from) * way.h.abs() > HARDLY * way.t.abs().max(way.h.abs()));
            counts
                && way.looks.counted_between(from, to) < LOOKS
                && self.sides_matter(way, (&Stretch { from, to, beside }, &switches), sizes, tolerance)
        })?;
        // What is known too little at the beginning is left by a step that ends before it changes.
        Some(stretches[unknown][usize::from(unknown == 0)])
    }

    /// Where an argument changes sides between two samples: once, or there and back again.
    fn changes(&mut self, way: &Way, argument: usize, sampled: &Sampled, [from, to]: [usize; 2]) -> Vec<f64> {
        let (places, values) = (&sampled.places, &sampled.values[argument]);
        let side = values[from].signum();
        if values[from] * values[to] <= 0.0 {
            return vec![self.change(way, argument, [places[from], places[to]], side)];
        }
        let lower = |&a: &usize, &b: &usize| (side * values[a]).total_cmp(&(side * values[b]));
        let nearest = (from..=to).min_by(lower).unwrap_or(from);
        let about = (places[nearest.max(from + 1) - 1], places[nearest.min(to - 1) + 1]);
        let turning = self.turning(way, argument, about, side < 0.0).at;
        if side * turning.u >= 0.0 {
            return Vec::new();
        }
        let beside = [places[from], places[to]];
        beside.map(|place| self.change(way, argument, [place, turning.theta], side)).to_vec()
    }

    /// Where an argument that is on a side of zero at the first of two places, and not at the second, changes over.
    fn change(&mut self, way: &Way, argument: usize, [mut from, mut to]: [f64; 2], side: f64) -> f64 {
        for _ in 0..ROUNDS {
            let part = (to - from) / (WIDTH + 1) as f64;
            let thetas: [f64; WIDTH] = core::array::from_fn(|k| from + part * (k + 1) as f64);
            way.run(&thetas, &mut self.values);
            let u = self.values.output(argument).0;
            let crossed = u.iter().position(|u| side * u <= 0.0).unwrap_or(WIDTH);
            if crossed > 0 {
                from = thetas[crossed - 1];
            }
            if let Some(&theta) = thetas.get(crossed) {
                to = theta;
            }
        }
        from
    }

    /// Whether the sides on a stretch move anything by what matters, beside those before it and those after it.
    fn sides_matter(
        &mut self,
        way: &Way,
        (stretch, switches): (&Stretch, &[bool]),
        sizes: &[f64],
        tolerance: f64,
    ) -> bool {
        let Stretch { from, to, beside: places } = *stretch;
        let part = (to - from) / (WIDTH + 1) as f64;
        let thetas = core::array::from_fn(|k| from + part * (k + 1) as f64);
        let beside = self.functions_at(way, &lanes(&places.map(|place| place.unwrap_or(from))));
        let arguments_beside: Vec<Lanes> =
            (0..self.of.fades.len()).map(|argument| self.values.output(argument)).collect();
        let functions = self.functions_at(way, &thetas);
        let here: Vec<f64> =
            (0..self.of.fades.len()).map(|a| self.values.output(a).0[WIDTH / 2].signum()).collect();
        let actual = self.rates_with(way, &thetas, &functions);
        let otherwise: [Vec<Lanes>; 2] = [0, 1].map(|side| {
            let mut there = functions.clone();
            let features = self.of.owners.iter().zip(&self.of.kinds);
            for ((function, beside), (&owner, kind)) in there.iter_mut().zip(&beside).zip(features) {
                if arguments_beside[owner].0[side].signum() == here[owner] {
                    continue;
                }
                if *kind == Kind::Absolute {
                    *function = Lanes(function.0.map(|value| -value));
                } else if switches[owner] {
                    *function = Lanes([beside.0[side]; WIDTH]);
                }
            }
            self.rates_with(way, &thetas, &there)
        });
        let time = way.h.abs() * (to - from);
        actual.iter().enumerate().any(|(i, actual)| {
            (0..WIDTH).any(|k| {
                let apart = |side: usize| places[side].map(|_| (actual.0[k] - otherwise[side][i].0[k]).abs());
                let least =
                    [0, 1].into_iter().filter_map(apart).fold(f64::INFINITY, |least, by| smaller(by, least));
                let impulse = least * time;
                // What is no number matters.
                impulse.is_nan() || impulse > tolerance * sizes[i]
            })
        })
    }
}
