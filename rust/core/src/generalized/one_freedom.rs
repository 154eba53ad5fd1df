//! One degree of freedom at constant energy: where it turns back, its period and its action, by quadrature.
//!
//! The one idea: nothing is taken from values of the energy, whose digits a small swing or a far zero would have used up, but
//! all from integrals of the slope, over panels in which nothing narrow can hide ([`way`]). From its turning point each
//! distance is a square, so that the time, which has a root there, is smooth ([`quadrature`]).
//! L. D. Landau & E. M. Lifshitz, *Mechanics*, (11.5), (49.7).

mod quadrature;
mod way;

use super::gauss;
use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::intervals::{Interval, Intervals};
use crate::expressions::{Code, Machine};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use core::f64::consts::PI;
use quadrature::Piece;
use std::sync::Arc;
use way::{Panel, Way};

/// The last digit of a place may be this part of a swing.
const COARSEST: f64 = 2.3e-7;
/// The least part of a panel in which there have to be slopes.
const FEWEST: f64 = 0.25;
/// So much of a place are a few of its last digits.
const LAST_DIGITS: f64 = 8.0 * f64::EPSILON;
/// What differs by less than this part of its size after a turn is the same: turns as 2π have fifteen digits, and places may
/// have lost some.
const REPEATS: f64 = 1e-9;
/// A period of which rounding leaves less than six digits is not told.
const UNKNOWN: f64 = 1e-6;
/// How a slope changes at a turning point is told by one this part of a panel beside it.
const BESIDE: f64 = 1e-3;
/// Two periods that differ by no more than so many times what is unknown of one are the same.
const AGREES: f64 = 64.0;
/// Places between two that are a whole number of parts of a way off are this part of one further.
const SOMEWHERE: f64 = 0.618_034;
/// Where less than this part of the greatest kinetic energy is left, it is counted from the turning point.
const NEAR_AN_END: f64 = 0.25;

/// The slope of the energy at rest and the mass: what a motion of one coordinate depends on.
#[derive(Clone, Debug)]
pub struct OneFreedom {
    machine: Machine<Lanes>,
    /// Energy at rest, mass, slope.
    intervals: Intervals,
    parameters: Vec<f64>,
    /// The kinetic energy at the start, and what the energy would be at rest there.
    kinetic: f64,
    at_rest: f64,
    start: f64,
    t: f64,
}

/// Refuses a motion whose last digits change its period by more than is told.
fn refuse_if_unknown(end: f64, of: &str, unknown: f64) -> Result<()> {
    if unknown > UNKNOWN {
        return Err(Error::invalid(
            "position",
            format!(
                "the motion comes so near to standing still, at {end}, that the last digit of its {of} changes its \
                 period by a part of {unknown:.0e}: it is on a separatrix, but for rounding"
            ),
        ));
    }
    Ok(())
}

/// An oscillation.
#[derive(Clone, Copy, Debug)]
pub struct Oscillation {
    /// Where it turns back.
    pub turning: (f64, f64),
    /// The time of a whole swing.
    pub period: f64,
    /// ∮ p dq / 2π.
    pub action: f64,
}

impl OneFreedom {
    /// Of a Lagrangian of one coordinate that conserves energy and has T = m(q) q̇²/2.
    ///
    /// # Errors
    /// Another system.
    pub fn new(model: &mut Model, state: &[f64], parameters: &[f64], t: f64) -> Result<Self> {
        let refused = |why: &str| Err(Error::invalid("L", format!("a period is that of {why}")));
        if model.source.kind != Kind::Lagrangian
            || model.source.coordinates != 1
            || !model.multipliers.is_empty()
        {
            return refused("a Lagrangian of one coordinate; reduce the others by routhian");
        }
        let (q, v) = model.source.halves();
        let mass = model.mass[0][0];
        if model.source.graph.reachable(&[mass]).contains(&v[0]) {
            return refused("a Lagrangian that is quadratic in the velocity");
        }
        let slope = model.source.graph.gradient(model.energy, &q)[0];
        let roots = vec![model.energy, mass, slope];
        let code: Arc<Code> = Arc::new(model.function(&roots)?);
        let machine = Machine::new(code, &parameters.iter().copied().map(Lanes::splat).collect::<Vec<_>>());
        let intervals = Intervals::new(model.source.graph.clone(), roots);
        let parameters = parameters.to_vec();
        let mut of = Self { machine, intervals, parameters, kinetic: 0.0, at_rest: 0.0, start: state[0], t };
        let [at_rest, mass, _] = of.values([state[0]; WIDTH]).map(|values| values[0]);
        of.at_rest = at_rest;
        of.kinetic = 0.5 * mass * state[1] * state[1];
        Ok(of)
    }

    /// Energy, mass and slope of the energy at rest at eight places.
    fn values(&mut self, places: [f64; WIDTH]) -> [[f64; WIDTH]; 3] {
        let mut found = [Lanes([0.0; WIDTH]); 3];
        self.machine.evaluate(Lanes::splat(self.t), &[Lanes(places), Lanes::splat(0.0)], &mut found);
        found.map(|lanes| lanes.0)
    }

    /// The same between two places.
    fn bounds(&mut self, places: Interval) -> way::Bounds {
        let found = self.intervals.over(Interval::at(self.t), &[places, Interval::at(0.0)], &self.parameters);
        way::Bounds { energy: found.values[0], slope: found.values[2], is_plain: found.is_plain }
    }

    /// How much the energy at rest rises from a place to another, and the sum of sizes that this is made of.
    fn rise(&mut self, from: f64, width: f64) -> [f64; 2] {
        let (nodes, weights) = gauss::quadrature();
        let slopes = self.values(nodes.map(|x| from + x * width))[2];
        let (mut sums, mut counted) = ([0.0; 2], 1.0);
        for (weight, slope) in weights.iter().zip(slopes) {
            // On a kink there is none; the others tell what is beside it.
            if slope.is_nan() {
                counted -= weight;
            } else {
                sums[0] += weight * slope;
                sums[1] += weight * slope.abs();
            }
        }
        if counted < FEWEST {
            // Or all are on it, in what is too short to matter.
            return [if width.abs() <= LAST_DIGITS * from.abs() { 0.0 } else { f64::NAN }; 2];
        }
        [sums[0] * width / counted, sums[1] * width.abs() / counted]
    }

    /// The panel between two places.
    fn panel(&mut self, from: f64, to: f64) -> Panel {
        Panel { from, to, rise: self.rise(from, to - from) }
    }

    /// The oscillation through the start.
    ///
    /// # Errors
    /// A motion that does not turn back, or stands still.
    pub fn oscillation(&mut self) -> Result<Oscillation> {
        let stands_still = || {
            Error::invalid(
                "position",
                "the motion stands still, or swings by less than its place tells apart: an equilibrium; see linearize()",
            )
        };
        if self.kinetic == 0.0 && self.values([self.start; WIDTH])[2][0] == 0.0 {
            return Err(stands_still());
        }
        let endless = || {
            Error::invalid(
                "position",
                "the motion does not turn back, and has no period, unless its energy repeats after some way: that of a \
                 rotation is period(turn=2π)",
            )
        };
        let down = way::outward(self, -1.0, None)?;
        let up = if down.turns { way::outward(self, 1.0, None)? } else { Way::default() };
        if !(down.turns && up.turns) {
            return Err(endless());
        }
        let mut start = down.panels.len();
        let mut panels: Vec<Panel> =
            down.panels.into_iter().rev().map(Panel::reversed).chain(up.panels).collect();
        if let [panel] = panels[..] {
            // A piece has no more than one turning point.
            let middle = panel.from + 0.5 * (panel.to - panel.from);
            panels = vec![self.panel(panel.from, middle), self.panel(middle, panel.to)];
            start *= 2;
        }
        let ends = panels.first().zip(panels.last()).map(|(first, last)| (first.from, last.to));
        let Some((low, high)) = ends else { return Err(stands_still()) };
        // How much of the swing the last digit of a place is.
        let digit = f64::EPSILON * low.abs().max(high.abs()) / (0.5 * (high - low));
        if digit.is_nan() || digit > COARSEST {
            return Err(stands_still());
        }
        let pieces = self.pieces_of_a_swing(&panels, start);
        let [time, action] = quadrature::integral(self, &pieces)?;
        let (end, unknown) = self.unknown_beside_the_top(&panels, start, 2.0 * time);
        if let Some(even) = self.even_oscillation()?
            && (even.period - 2.0 * time).abs() <= AGREES * unknown.max(f64::EPSILON) * even.period
        {
            return Ok(even);
        }
        refuse_if_unknown(end, "energy", unknown)?;
        Ok(Oscillation { turning: (low, high), period: 2.0 * time, action: action / PI })
    }

    /// The oscillation of what starts at rest where all seems to be even: it turns back at the opposite place then, whatever
    /// digits the energy has, and a quarter of it tells the rest. None where it is not so.
    ///
    /// # Errors
    /// A place where the slope is no number; a motion that hardly leaves its start.
    fn even_oscillation(&mut self) -> Result<Option<Oscillation>> {
        let far = self.start.abs();
        if self.kinetic != 0.0 || !self.is_even() {
            return Ok(None);
        }
        let way = way::outward(self, -self.start.signum(), Some(far))?;
        let Some((first, others)) = way.panels.split_first().filter(|_| !way.turns) else { return Ok(None) };
        let known = way::energies(&way.panels, 0, (0.0, 0.0));
        let inner = others.iter().zip(&known[1..]).zip(&known[2..]);
        let inner = inner.map(|((panel, &from), &to)| Piece::inner(panel, &[from, to]));
        let pieces: Vec<Piece> =
            core::iter::once(Piece::at_an_end(first.from, first.to)).chain(inner).collect();
        let [time, action] = quadrature::integral(self, &pieces)?;
        let period = 4.0 * time;
        // Places beside the start are as far from the top as their last digits tell.
        let [mass, slope, change] = self.mass_and_slopes(self.start, first.to);
        let unknown = f64::EPSILON * far * (change * mass).sqrt() / (slope * period);
        refuse_if_unknown(self.start, "place", unknown)?;
        Ok(Some(Oscillation { turning: (-far, far), period, action: 2.0 * action / PI }))
    }

    /// Whether energy and mass are the same numbers at opposite places up to the start, and slopes opposite ones.
    fn is_even(&mut self) -> bool {
        let places = core::array::from_fn(|k| self.start * (k as f64 + SOMEWHERE) / WIDTH as f64);
        let (here, there) = (self.values(places), self.values(places.map(|place| -place)));
        here[0] == there[0] && here[1] == there[1] && here[2] == there[2].map(|slope| -slope)
    }

    /// Of panels from one turning point to the other, with the start after so many of them: near a turning point the energy
    /// is counted from there, where its sum keeps all digits of what is left, else from the start.
    fn pieces_of_a_swing(&self, panels: &[Panel], start: usize) -> Vec<Piece> {
        let count = panels.len();
        let known = way::energies(panels, start, (self.kinetic, self.kinetic));
        let greatest = known.iter().map(|energy| energy.0).fold(0.0, f64::max);
        let is_near = |energy: &(f64, f64)| energy.0 < NEAR_AN_END * greatest;
        let below = (1..count).find(|&place| !is_near(&known[place])).unwrap_or(count);
        let above = (1..count).rev().find(|&place| !is_near(&known[place])).unwrap_or(0);
        let (from_below, from_above) =
            (way::energies(panels, 0, (0.0, 0.0)), way::energies(panels, count, (0.0, 0.0)));
        let piece = |(index, panel): (usize, &Panel)| match index {
            0 => Piece::at_an_end(panel.from, panel.to),
            _ if index + 1 == count => Piece::at_an_end(panel.to, panel.from),
            _ if index < below => Piece::inner(panel, &from_below[index..]),
            _ if index >= above => Piece::inner(panel, &from_above[index..]),
            _ => Piece::inner(panel, &known[index..]),
        };
        panels.iter().enumerate().map(piece).collect()
    }

    /// By what part of itself the rounding of the energy changes the period of a motion that turns back near to where it would
    /// stand still, and where. With a slope s that changes by k along the way, the time goes as ln(s) √(m/k), and s as the root
    /// of the energy that is left to the top.
    fn unknown_beside_the_top(&mut self, panels: &[Panel], start: usize, period: f64) -> (f64, f64) {
        let mut worst = (self.start, 0.0);
        let [Some(first), Some(last)] = [panels.first(), panels.last()] else { return worst };
        let known = way::energies(panels, start, (self.kinetic, self.kinetic));
        let ends = [(first.from, first.to, known[0].1), (last.to, last.from, known[panels.len()].1)];
        for (end, inward, of) in ends {
            // Where the motion begins at rest it turns back whatever its energy is.
            if end == self.start {
                continue;
            }
            let [mass, slope, change] = self.mass_and_slopes(end, inward);
            let rounding = f64::EPSILON * of;
            let unknown = rounding * (change * mass).sqrt() / (slope * slope * period);
            if unknown > worst.1 {
                worst = (end, unknown);
            }
        }
        worst
    }

    /// The mass at a turning point, the slope, and how that changes towards the inside, without their signs.
    fn mass_and_slopes(&mut self, end: f64, inward: f64) -> [f64; 3] {
        let beside = end + BESIDE * (inward - end);
        let [_, mass, slope] = self.values(core::array::from_fn(|k| if k == 0 { end } else { beside }));
        [mass[0], slope[0].abs(), ((slope[1] - slope[0]) / (beside - end)).abs()]
    }

    /// The time in which the coordinate goes on by `turn`, and ∫ p dq / 2π over it, of a motion that never turns back.
    ///
    /// # Errors
    /// A motion that turns back on the way; an energy that does not repeat after it.
    pub fn rotation(&mut self, turn: f64) -> Result<[f64; 2]> {
        self.refuse_unless_it_repeats(turn)?;
        let way = way::outward(self, turn.signum(), Some(turn.abs()))?;
        if way.turns || self.kinetic == 0.0 {
            return Err(Error::invalid(
                "turn",
                "the motion turns back before it has gone so far; the period of an oscillation is period()",
            ));
        }
        let known = way::energies(&way.panels, 0, (self.kinetic, self.kinetic));
        let pieces: Vec<Piece> = way
            .panels
            .iter()
            .zip(known.windows(2))
            .map(|(panel, known)| Piece::inner(panel, known))
            .collect();
        let [time, action] = quadrature::integral(self, &pieces)?;
        Ok([time, action / (2.0 * PI)])
    }

    /// Whether energy, mass and slope are the same a turn further, at eight places.
    fn refuse_unless_it_repeats(&mut self, turn: f64) -> Result<()> {
        let places = core::array::from_fn(|k| self.start + turn * k as f64 / WIDTH as f64);
        let (here, there) = (self.values(places), self.values(places.map(|place| place + turn)));
        let greatest =
            |values: [f64; WIDTH]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // An energy has no zero of its own: what is swung through, and what moves, are its sizes.
        let depth = self.kinetic + greatest(here[0].map(|energy| energy - self.at_rest));
        let sizes = [depth, greatest(here[1]), greatest(here[2])];
        for ((here, there), size) in here.iter().zip(there).zip(sizes) {
            // On a kink there is no slope.
            let differs =
                |(x, y): (&f64, f64)| !((x - y).abs() <= REPEATS * size || x.is_nan() && y.is_nan());
            if here.iter().zip(there).any(differs) {
                return Err(Error::invalid(
                    "turn",
                    format!(
                        "the energy does not repeat where the coordinate has gone on by {turn}: no period"
                    ),
                ));
            }
        }
        Ok(())
    }
}
