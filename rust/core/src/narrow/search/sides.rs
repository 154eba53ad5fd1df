//! Tents and boxes: what is written with absolute values and switches, whose arguments change sides twice within a step.
//!
//! The one idea: of such it matters on which side of zero an argument is, and that changes at once. A stretch between two changes on
//! which hardly any stage looks is known to nobody; there the rates are also found with the sides before it and after it.

use super::super::features::{AtEnds, Fades};
use super::super::way::Way;
use super::{Criteria, Search, lanes};
use crate::expressions::narrow::Kind;
use crate::numerics::lanes::{Lanes, WIDTH};

/// Rounds of a search for a change of sides, each in a ninth of the last; fewer, once it is known to this part of the way to where an
/// argument turns.
const ROUNDS: usize = 14;
const KNOWN: f64 = 1e-3;
/// Of a velocity this part is at stake where sides are asked about: less is left to the error of a step.
const AT_STAKE: f64 = 1e-3;
/// So many looks that count know a stretch.
const LOOKS: usize = 3;

/// Arguments at places of a way.
pub(super) struct Sampled {
    pub(super) places: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
}

/// A stretch of a way on which no argument changes sides, and places before it and after it, as far as they are in the step: in the
/// stretches there, and of equal steps the looks.
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
        Criteria { reach, equal, .. }: Criteria,
    ) -> Option<f64> {
        let of = self.of.clone();
        let is_switch =
            |a: usize| equal && of.fades[a] != Fades::Nowhere && !matches!(of.at_ends[a], AtEnds::Power(_));
        let switches: Vec<bool> = (0..of.fades.len()).map(is_switch).collect();
        let mut changes = Vec::new();
        for argument in (0..of.fades.len()).filter(|&a| of.has_absolute(a) || switches[a]) {
            if !comes_near_zero(&sampled.values[argument]) {
                continue;
            }
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
            let segments = [k.checked_sub(1).and_then(middle), middle(k + 1)];
            let is_inner = segments.iter().all(Option::is_some);
            let looks = way.looks.places();
            let beside = if equal {
                [looks.iter().rfind(|look| **look <= from), looks.iter().find(|look| **look >= to)]
                    .map(Option::<&f64>::copied)
            } else {
                segments
            };
            // Equal steps are as coarse as they were asked for: what begins or ends in one is known to it.
            (is_inner || !equal)
                && way.looks.counted_between(from, to) < LOOKS
                && self.sides_matter(way, (&Stretch { from, to, beside }, &switches), sizes, equal)
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
        let about = nearest.max(from + 1) - 1..=nearest.min(to - 1) + 1;
        if side * values[nearest] > 0.0 && !comes_near_zero(&values[about]) {
            return Vec::new();
        }
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
        let turning = to;
        for _ in 0..ROUNDS {
            if (to - from).abs() <= KNOWN * (turning - from).abs() {
                break;
            }
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
        equal: bool,
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
        let actual = self.rates_with_sides(way, &thetas, &functions);
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
            self.rates_with_sides(way, &thetas, &there)
        });
        let time = way.h.abs() * (to - from);
        actual.iter().enumerate().any(|(i, actual)| {
            (0..WIDTH).any(|k| {
                let apart = |side: usize| places[side].map(|_| (actual.0[k] - otherwise[side][i].0[k]).abs());
                let least = [0, 1].into_iter().filter_map(apart).fold(f64::NAN, f64::min);
                // Of a stair between two looks equal steps know as much as of one that is a step.
                let is_stair = equal
                    && (actual.0[k] - otherwise[0][i].0[k]) * (actual.0[k] - otherwise[1][i].0[k]) < 0.0;
                let impulse = least * time;
                // At zero itself, where rounding may put it, there is no number.
                impulse > AT_STAKE * sizes[i] && !is_stair
            })
        })
    }
}

/// Whether an argument may be zero anywhere between samples: between two of them it goes no farther than it does beside.
fn comes_near_zero(values: &[f64]) -> bool {
    let most = values.windows(2).fold(0.0_f64, |most, two| most.max((two[1] - two[0]).abs()));
    let side = values[0].signum();
    // What is no number is looked for, what does not move at all is not.
    most != 0.0 && !values.iter().all(|value| value.signum() == side && value.abs() > most)
}
