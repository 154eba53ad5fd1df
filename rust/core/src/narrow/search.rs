//! The search for what lies between the places where a step looks: arguments are followed on the way, and functions of them asked
//! where they move.
//!
//! The one idea: rates are found with a function as it is at a place, and as it is at either of the two places between which no
//! method looks. What differs from both, for as long as the argument moves by 1, is an impulse that nobody feels; small beside what
//! it pushes, it may stay so.

mod seen_as;
mod sides;

use super::features::{AtEnds, Fades};
use super::way::Way;
use super::{Features, REACH_OF_EQUAL_WAVES};
use crate::expressions::Machine;
use crate::expressions::narrow::Kind;
use crate::numerics::lanes::{Lanes, WIDTH};
use seen_as::SeenAs;
use sides::Sampled;
use std::sync::Arc;

/// Between two places where a method looks arguments are sampled at least twice, and so densely.
const SPACING: f64 = 1.0 / 12.0;
/// Rounds of a search for a turning point, each in a part of 2/9 of the last.
const TURNING_ROUNDS: usize = 12;
/// In the last of them what turns smoothly changes by less than this.
const SHARP: f64 = 0.5;
/// Rounds of a search for a level, and how near an argument has to come to it.
const LEVEL_ROUNDS: usize = 40;
const NEAR: f64 = 0.2;
/// Functions of an argument between these are looked at whenever it has moved by so much …
const LEVELS: f64 = 60.0;
const LEVEL: f64 = 2.0;
/// … and so far from a turning point and from a place where the method looks.
const BESIDE: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// So many levels at once, which leave lanes for the ends of a piece.
const AT_ONCE: usize = WIDTH - 2;
/// The least part of the way, and the most, that a step is tried again with.
const LEAST: f64 = 1.0 / 16.0;
const MOST: f64 = 0.9;
/// Of a number that is small beside others this part of them is its size.
const SMALLEST_SIZE: f64 = 1e-8;

/// What is unseen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Criteria {
    /// By how much an argument moves that is followed.
    pub(super) reach: f64,
    /// Whether steps are equal: they are not to be shorter, and what they see too coarsely is not unseen.
    pub(super) equal: bool,
    /// What may be unseen, as a part of a number.
    pub(super) tolerance: f64,
}

/// A place on the way, and an argument there.
#[derive(Clone, Copy, Debug)]
struct Point {
    theta: f64,
    u: f64,
}

/// Where an argument turns.
#[derive(Clone, Copy, Debug)]
struct Turning {
    at: Point,
    /// Whether it does so as the logarithm of what vanishes, however closely it is looked at.
    is_sharp: bool,
}

/// A piece of the way on which an argument goes to one side, between two places where the method looks.
#[derive(Clone, Copy, Debug)]
struct Piece {
    argument: usize,
    from: Point,
    to: Point,
    /// Those places.
    looks: [f64; 2],
}

/// A search at work.
#[derive(Debug)]
pub(super) struct Search {
    of: Arc<Features>,
    values: Machine<Lanes>,
    rates: Machine<Lanes>,
    /// With absolute values of their own.
    sided: Option<Machine<Lanes>>,
    parameters: Vec<f64>,
}

impl Search {
    pub(super) fn new(of: &Arc<Features>) -> Self {
        let none = vec![Lanes([0.0; WIDTH]); of.values.parameters()];
        Self {
            of: of.clone(),
            values: Machine::new(of.values.clone(), &none),
            rates: Machine::new(of.rates.clone(), &none),
            sided: of.sided.as_ref().map(|code| Machine::new(code.clone(), &none)),
            parameters: vec![0.0; none.len()],
        }
    }

    /// The part of a way on which nothing that matters is unseen, short of what is.
    pub(super) fn seen_until(&mut self, parameters: &[f64], way: Way, criteria: Criteria) -> f64 {
        if self.parameters != parameters {
            let wide: Vec<Lanes> = parameters.iter().map(|&value| Lanes([value; WIDTH])).collect();
            self.values.set_parameters(&wide);
            self.rates.set_parameters(&wide);
            if let Some(sided) = &mut self.sided {
                sided.set_parameters(&wide);
            }
            self.parameters.copy_from_slice(parameters);
        }
        let sampled = self.sampled(&way);
        let mut pieces = self.pieces(&way, &sampled, criteria);
        pieces.sort_by(|a, b| a.from.theta.total_cmp(&b.from.theta));
        let sizes = sizes(&way, self.of.rates.outputs());
        let mut first = self.unseen_sides(&way, &sampled, &sizes, criteria).unwrap_or(f64::INFINITY);
        for piece in pieces {
            if piece.from.theta >= first {
                break;
            }
            if let Some(theta) = self.unseen(&way, &piece, &sizes, criteria)
                && theta < first
            {
                first = theta;
            }
        }
        if first > 1.0 { 1.0 } else { (MOST * first).clamp(LEAST, MOST) }
    }

    /// All arguments on the way.
    fn sampled(&mut self, way: &Way) -> Sampled {
        let mut places: Vec<f64> = way.looks.places().first().copied().into_iter().collect();
        for looks in way.looks.places().windows(2) {
            let parts = ((looks[1] - looks[0]) / SPACING).ceil().max(2.0);
            let part = |k: usize| looks[0] + (looks[1] - looks[0]) * (k as f64 / parts);
            places.extend((1..parts as usize).map(part).chain([looks[1]]));
        }
        let mut values = vec![Vec::with_capacity(places.len()); self.of.fades.len()];
        for eight in places.chunks(WIDTH) {
            way.run(&lanes(eight), &mut self.values);
            for (argument, values) in values.iter_mut().enumerate() {
                values.extend_from_slice(&self.values.output(argument).0[..eight.len()]);
            }
        }
        Sampled { places, values }
    }

    /// The pieces of the way on which arguments move by more than the reach between two places where the method looks. Equal steps
    /// that go through poles tell more than that something was unseen.
    fn pieces(
        &mut self,
        way: &Way,
        Sampled { places, values }: &Sampled,
        Criteria { reach, equal, .. }: Criteria,
    ) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (argument, values) in values.iter().enumerate() {
            if !self.of.has_others(argument) || values.len() < 2 {
                continue;
            }
            let mut turnings: Vec<Turning> = Vec::new();
            for j in 1..values.len() - 1 {
                let (before, after) = (values[j] - values[j - 1], values[j + 1] - values[j]);
                if before * after < 0.0 || (before == 0.0) != (after == 0.0) {
                    turnings.push(self.turning(
                        way,
                        argument,
                        (places[j - 1], places[j + 1]),
                        before > after,
                    ));
                }
            }
            // What turns right behind the beginning or before the end is on one side of it at all samples.
            let last = values.len() - 1;
            for (edge, inner) in [(0, 1), (last, last - 1)] {
                let (near, far) = (edge.min(inner), edge.max(inner));
                let is_top = values[edge] > values[inner];
                turnings.push(self.turning(way, argument, (places[near], places[far]), is_top));
            }
            let sample = |theta: f64| places.iter().zip(values).find(|(place, _)| **place == theta);
            for looks in way.looks.places().windows(2) {
                let ends = looks.iter().filter_map(|&theta| sample(theta));
                let inside = || turnings.iter().filter(|p| p.at.theta > looks[0] && p.at.theta < looks[1]);
                let at_ends = self.of.at_ends[argument];
                if equal && matches!(at_ends, AtEnds::Power(_)) && inside().any(|p| p.is_sharp) {
                    continue;
                }
                let mut points: Vec<Point> =
                    ends.map(|(&theta, &u)| Point { theta, u }).chain(inside().map(|p| p.at)).collect();
                points.sort_by(|a, b| a.theta.total_cmp(&b.theta));
                let least = points.iter().fold(f64::INFINITY, |least, p| least.min(p.u));
                let most = points.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p.u));
                let is_wave = self.of.fades[argument] == Fades::Nowhere;
                let reach = at_ends.reach(if equal && is_wave { REACH_OF_EQUAL_WAVES } else { reach });
                if most - least <= reach || self.of.fades[argument].holds(least, most) {
                    continue;
                }
                let looks = [looks[0], looks[1]];
                let moving = points.windows(2).filter(|two| (two[1].u - two[0].u).abs() > BESIDE[0]);
                pieces.extend(moving.map(|two| Piece { argument, from: two[0], to: two[1], looks }));
            }
        }
        pieces
    }

    /// Where an argument turns between two places.
    fn turning(
        &mut self,
        way: &Way,
        argument: usize,
        (mut from, mut to): (f64, f64),
        is_top: bool,
    ) -> Turning {
        let mut found = [f64::NAN; WIDTH];
        let mut best = Point { theta: from, u: f64::NAN };
        for _ in 0..TURNING_ROUNDS {
            let part = (to - from) / (WIDTH + 1) as f64;
            let thetas: [f64; WIDTH] = core::array::from_fn(|k| from + part * (k + 1) as f64);
            way.run(&thetas, &mut self.values);
            found = self.values.output(argument).0;
            best = Point { theta: thetas[0], u: found[0] };
            for (&theta, &u) in thetas.iter().zip(&found) {
                if if is_top { u > best.u } else { u < best.u } {
                    best = Point { theta, u };
                }
            }
            (from, to) = (best.theta - part, best.theta + part);
        }
        Turning { at: best, is_sharp: found.iter().any(|u| (u - best.u).abs() > SHARP) }
    }

    /// The first place of a piece at which what no look sees matters.
    fn unseen(&mut self, way: &Way, piece: &Piece, sizes: &[f64], criteria: Criteria) -> Option<f64> {
        let levels = levels(piece.from.u, piece.to.u);
        let looks = self.functions_at(way, &lanes(&piece.looks));
        let seen_as = self.seen_as(way, piece, criteria.equal);
        let mut last = piece.from;
        for (index, some) in levels.chunks(AT_ONCE).enumerate() {
            // One that is known comes before them, so that how long each lasts is known.
            let mut points = vec![last];
            points.extend(self.at_levels(way, piece, some).into_iter().take(some.len()));
            if (index + 1) * AT_ONCE >= levels.len() {
                points.push(piece.to);
            }
            if let Some(theta) =
                self.first_that_matters(way, piece, (&looks, &points), (sizes, criteria.tolerance, seen_as))
            {
                return Some(theta);
            }
            last = points[points.len() - 1];
        }
        None
    }

    /// The first of some places at which rates with the functions there are not those with the functions at either look.
    fn first_that_matters(
        &mut self,
        way: &Way,
        piece: &Piece,
        (looks, points): (&[Lanes], &[Point]),
        (sizes, tolerance, seen_as): (&[f64], f64, SeenAs),
    ) -> Option<f64> {
        let thetas: Vec<f64> = points.iter().map(|point| point.theta).collect();
        let thetas = lanes(&thetas);
        let functions = self.functions_at(way, &thetas);
        let actual = self.rates_with(way, &thetas, &functions);
        let frozen: [Vec<Lanes>; 2] = [0, 1].map(|side| {
            let mut there = functions.clone();
            for ((function, look), owner) in there.iter_mut().zip(looks).zip(&self.of.owners) {
                if *owner == piece.argument {
                    *function = Lanes([look.0[side]; WIDTH]);
                }
            }
            self.rates_with(way, &thetas, &there)
        });
        // The time in which the argument moves by 1 there.
        let apart = |pair: &[Point]| {
            let (time, moved) = ((pair[1].theta - pair[0].theta).abs(), (pair[1].u - pair[0].u).abs());
            if moved > 1.0 { time / moved } else { time }
        };
        let gaps: Vec<f64> = points.windows(2).map(apart).collect();
        let most = sizes.iter().copied().fold(0.0, f64::max);
        let between_looks = way.h.abs() * (piece.looks[1] - piece.looks[0]);
        let matters = |k: &usize| {
            let after = gaps.get(*k).copied().unwrap_or(0.0);
            let before = if *k > 0 { gaps[*k - 1] } else { 0.0 };
            // Of a wave equal steps may see the same part again and again.
            let time = if seen_as == SeenAs::Wave { between_looks } else { way.h.abs() * before.max(after) };
            actual.iter().enumerate().any(|(i, rate)| {
                let apart = |side: usize| (rate.0[*k] - frozen[side][i].0[*k]).abs();
                let least = smaller(apart(0), apart(1));
                let impulse = least * time;
                let is_between = least <= (frozen[0][i].0[*k] - frozen[1][i].0[*k]).abs();
                // What is no number matters.
                impulse.is_nan()
                    || (impulse > tolerance * sizes[i]
                        && !(is_between && seen_as.knows(impulse, (tolerance, most))))
            })
        };
        (0..points.len()).find(matters).map(|k| points[k].theta)
    }

    /// Places of a piece where its argument has these levels.
    fn at_levels(&mut self, way: &Way, piece: &Piece, levels: &[f64]) -> Vec<Point> {
        let levels = lanes(levels);
        let (mut from, mut to) = ([piece.from; WIDTH], [piece.to; WIDTH]);
        let mut found = from;
        for round in 0..LEVEL_ROUNDS {
            let thetas: [f64; WIDTH] = core::array::from_fn(|lane| {
                let (a, b) = (from[lane], to[lane]);
                let part = (levels[lane] - a.u) / (b.u - a.u);
                // A straight line leads there fast, or not at all; then halves do.
                let part = if round % 3 == 2 || !(part > 0.0 && part < 1.0) { 0.5 } else { part };
                a.theta + part * (b.theta - a.theta)
            });
            way.run(&thetas, &mut self.values);
            let u = self.values.output(piece.argument).0;
            let mut all = true;
            for lane in 0..WIDTH {
                found[lane] = Point { theta: thetas[lane], u: u[lane] };
                all &= (u[lane] - levels[lane]).abs() <= NEAR;
                let is_before = (u[lane] < levels[lane]) == (piece.from.u < piece.to.u);
                if is_before {
                    from[lane] = found[lane];
                } else {
                    to[lane] = found[lane];
                }
            }
            if all {
                break;
            }
        }
        found.to_vec()
    }

    /// All functions at eight places.
    fn functions_at(&mut self, way: &Way, thetas: &[f64; WIDTH]) -> Vec<Lanes> {
        way.run(thetas, &mut self.values);
        let first = self.of.fades.len();
        (0..self.of.owners.len()).map(|index| self.values.output(first + index)).collect()
    }

    /// The right-hand side at eight places, with these values of the functions; absolute values follow from them.
    fn rates_with(&mut self, way: &Way, thetas: &[f64; WIDTH], functions: &[Lanes]) -> Vec<Lanes> {
        let others = functions.iter().zip(&self.of.kinds).filter(|(_, kind)| **kind != Kind::Absolute);
        let numbers = self.of.values.variables();
        for (number, (function, _)) in self.rates.state()[numbers..].iter_mut().zip(others) {
            *number = *function;
        }
        way.run(thetas, &mut self.rates);
        (0..self.of.rates.outputs()).map(|index| self.rates.output(index)).collect()
    }

    /// The same, with absolute values as they are given.
    fn rates_with_sides(&mut self, way: &Way, thetas: &[f64; WIDTH], functions: &[Lanes]) -> Vec<Lanes> {
        let Some(sided) = &mut self.sided else { return self.rates_with(way, thetas, functions) };
        sided.state()[self.of.values.variables()..].copy_from_slice(functions);
        way.run(thetas, sided);
        (0..self.of.rates.outputs()).map(|index| sided.output(index)).collect()
    }
}

/// The smaller of two numbers, either of which may be none.
fn smaller(a: f64, b: f64) -> f64 {
    if a <= b || b.is_nan() { a } else { b }
}

/// Eight places, the last as often as there are too few.
fn lanes(places: &[f64]) -> [f64; WIDTH] {
    core::array::from_fn(|lane| places[lane.min(places.len() - 1)])
}

/// The levels between two values of an argument at which functions are looked at, on the way from one to the other.
fn levels(from: f64, to: f64) -> Vec<f64> {
    let (least, most) = (from.min(to), from.max(to));
    let mut levels: Vec<f64> = BESIDE.iter().flat_map(|beside| [least + beside, most - beside]).collect();
    let count = (2.0 * LEVELS / LEVEL) as usize;
    levels.extend((0..=count).map(|k| LEVEL * k as f64 - LEVELS));
    levels.retain(|level| *level > least && *level < most);
    levels.sort_by(f64::total_cmp);
    if from > to {
        levels.reverse();
    }
    levels
}

/// How large the numbers are that the right-hand side moves, so many from the last.
fn sizes(way: &Way, moved: usize) -> Vec<f64> {
    let [start, end] = way.ends();
    let size = |(a, b): (&f64, &f64)| a.abs().max(b.abs()).max((b - a).abs());
    let sizes: Vec<f64> = start.iter().zip(end).skip(start.len() - moved).map(size).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    sizes.into_iter().map(|size| size.max(SMALLEST_SIZE * most)).collect()
}
