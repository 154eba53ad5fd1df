//! Where a quantity turns: the draws between which it only rises or only falls, as bisection needs them.

use super::{Beam, Target};
use crate::numerics::angles::atan2;
use crate::numerics::philox::DRAW_BITS;
use crate::scattering::event_table::EventTable;
use crate::scattering::monte_carlo::quantity::Quantity;
use crate::scattering::monte_carlo::strata::Strata;
use core::f64::consts::PI;

/// Parts of a piece of a table at whose ends it is looked for turning points, besides those near its own ends.
const TRIED: u64 = 16;
/// And so often the part next to an end is halved.
const NEAREST: u32 = 26;
/// The first of these halves lies in the last of those parts.
const FARTHEST: u32 = TRIED.ilog2() + 1;
/// What ψ changes by rounding, relative to it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// The last draw.
const LAST: u64 = (1 << DRAW_BITS) - 1;

impl Beam {
    /// Whether two impact parameters lead to one value in some channel: a heavy projectile's laboratory angle.
    pub fn two_branches(&self, quantity: Quantity) -> bool {
        quantity == Quantity::LabAngle
            && self.exits.iter().any(|exit| exit.turning_point(quantity, self.energy).is_some())
    }
    /// The draws between which a quantity rises or falls in a channel: those at which it may turn.
    pub(in crate::scattering::monte_carlo) fn turning_draws(
        &self,
        quantity: Quantity,
        exit: usize,
    ) -> Vec<u64> {
        match &self.target {
            Target::Coulomb { reach, .. } => self
                .exits
                .get(exit)
                .and_then(|exit| exit.turning_point(quantity, self.energy))
                .map(|t| (t / reach) * (t / reach))
                .filter(|share| *share < 1.0)
                .map(|share| self.draw(share))
                .into_iter()
                .collect(),
            Target::Table(..) if quantity == Quantity::ImpactParameter => Vec::new(),
            Target::Table(table, _) => self.turns(quantity, exit, table),
            // No step function is made of what has several draws.
            Target::Tables(..) | Target::Direct(..) => Vec::new(),
        }
    }
    /// The first draw with at least that b/b_max, as it is rounded: pieces of a table do not quite meet, and what is looked for
    /// in one of them is not to be hidden by a draw of the next.
    fn first_at(&self, part: f64) -> u64 {
        let (mut low, mut high) = (0, 1_u64 << DRAW_BITS);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.share(middle).sqrt() < part { low = middle + 1 } else { high = middle }
        }
        low
    }
    /// Those of a table: the ends of its pieces, and within a piece where ψ turns, where it passes a whole multiple of π (the
    /// angle that is seen is folded there), and the angle at which the quantity itself turns. ψ has its sign and all its
    /// turns, and is a smooth function of the draw in a piece: of what is folded no sample would tell a narrow fold.
    fn turns(&self, quantity: Quantity, exit: usize, table: &EventTable) -> Vec<u64> {
        let angle = |draw: u64| table.angle(self.share(draw).sqrt());
        let turning = self.exits.get(exit).and_then(|exit| exit.turning_point(quantity, self.energy));
        let levels = Levels { turning: turning.map(|cotangent| 2.0 * atan2(1.0, cotangent)) };
        let mut draws: Vec<u64> = table.starts().iter().map(|part| self.first_at(*part)).collect();
        // What is tried is to be near in each stratum, however few draws a piece has in one of them.
        draws.extend(self.strata().into_iter().flat_map(Strata::boundaries));
        draws.sort_unstable();
        draws.dedup();
        let mut turns = draws.clone();
        for pair in draws.windows(2) {
            let [from, to] = [pair[0], (pair[1] - 1).min(LAST)];
            let extrema = extrema(&angle, from, to);
            turns.extend(&extrema);
            let marks: Vec<u64> = [from].into_iter().chain(extrema).chain([to]).collect();
            for ends in marks.windows(2) {
                levels.passed(&angle, [ends[0], ends[1]], &mut turns);
            }
        }
        turns
    }
}

/// The angles ψ at which a quantity turns.
struct Levels {
    /// Of the angle that is seen, from 0 to π, where it turns between.
    turning: Option<f64>,
}

impl Levels {
    /// The first draws beyond each level between two, between which ψ rises or falls.
    fn passed(&self, angle: &impl Fn(u64) -> Option<f64>, [from, to]: [u64; 2], turns: &mut Vec<u64>) {
        let (Some(first), Some(last)) = (angle(from), angle(to)) else { return };
        if !(first.is_finite() && last.is_finite()) {
            return;
        }
        let [least, most] = [first.min(last), first.max(last)];
        let [lowest, highest] = [(least / PI).floor(), (most / PI).ceil()];
        let mut multiple = lowest;
        while multiple <= highest {
            let level = multiple * PI;
            let beside = if multiple % 2.0 == 0.0 { self.turning } else { None };
            for level in [Some(level), beside.map(|angle| level - angle), beside.map(|angle| level + angle)] {
                if let Some(level) = level.filter(|level| least < *level && *level <= most) {
                    turns.push(first_beyond(angle, [from, to], level, last > first));
                }
            }
            multiple += 1.0;
        }
    }
}

/// The first draw at which ψ, which rises or falls between two, is beyond a level between theirs.
fn first_beyond(
    angle: &impl Fn(u64) -> Option<f64>,
    [mut from, mut to]: [u64; 2],
    level: f64,
    rises: bool,
) -> u64 {
    while to - from > 1 {
        let middle = from + (to - from) / 2;
        let beyond = angle(middle).is_some_and(|angle| if rises { angle >= level } else { angle <= level });
        if beyond { to = middle } else { from = middle }
    }
    to
}

/// Where ψ turns between two draws.
fn extrema(angle: &impl Fn(u64) -> Option<f64>, from: u64, to: u64) -> Vec<u64> {
    let mut tried: Vec<u64> = Vec::new();
    let width = to - from;
    // Near an end a turn is seen at its own distance from it.
    let nearer = || (FARTHEST..=NEAREST).map(|halvings| width >> halvings);
    tried.extend(nearer().map(|off| from + off).chain(nearer().map(|off| to - off)));
    tried.extend((0..=TRIED).map(|i| from + (u128::from(width) * u128::from(i) / u128::from(TRIED)) as u64));
    tried.sort_unstable();
    tried.dedup();
    // What changes by no more than rounding tells nothing of rising or falling.
    let mut told: Vec<(u64, f64)> = Vec::new();
    for draw in tried {
        let Some(now) = angle(draw) else { continue };
        if told.last().is_none_or(|(_, before)| (now - before).abs() > ROUNDING * now.abs()) {
            told.push((draw, now));
        }
    }
    let mut extrema = Vec::new();
    for three in told.windows(3) {
        let [(from, first), (_, middle), (to, last)] = [three[0], three[1], three[2]];
        if (middle > first) != (last > middle) {
            extrema.push(extremum(angle, from, to, middle > first));
        }
    }
    extrema.sort_unstable();
    extrema.dedup();
    extrema
}

/// Where a function with one maximum (or minimum) between two draws has it.
fn extremum(at: &impl Fn(u64) -> Option<f64>, from: u64, to: u64, maximum: bool) -> u64 {
    let (mut from, mut to) = (from, to);
    let sign = if maximum { 1.0 } else { -1.0 };
    let value = |draw| at(draw).map_or(f64::NEG_INFINITY, |value| sign * value);
    while to - from > 2 {
        let third = (to - from) / 3;
        let (left, right) = (from + third, to - third);
        if value(left) < value(right) { from = left } else { to = right }
    }
    from + 1
}
