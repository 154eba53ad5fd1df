//! Where a quantity turns: the draws between which it only rises or only falls, as bisection needs them.

use super::{Beam, Target};
use crate::numerics::philox::DRAW_BITS;
use crate::scattering::event_table::EventTable;
use crate::scattering::monte_carlo::quantity::Quantity;
use crate::scattering::monte_carlo::strata::Strata;

/// Points of a piece of a table among which turning points are looked for.
const TRIED: u64 = 8;

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
            Target::Tables(..) => Vec::new(),
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
    /// Those of a table: the ends of its pieces, and within a piece where what is tried rises and falls.
    fn turns(&self, quantity: Quantity, exit: usize, table: &EventTable) -> Vec<u64> {
        let at = |draw: u64| self.value(quantity, exit, self.share(draw));
        let mut draws: Vec<u64> = table.starts().iter().map(|part| self.first_at(*part)).collect();
        // What is tried is to be near in each stratum, however few draws a piece has in one of them.
        draws.extend(self.strata().into_iter().flat_map(Strata::boundaries));
        draws.sort_unstable();
        let mut turns = draws.clone();
        for pair in draws.windows(2).filter(|pair| pair[1] - pair[0] > TRIED) {
            let width = pair[1] - pair[0];
            let tried: Vec<u64> = (0..=TRIED)
                .map(|i| pair[0] + (u128::from(width) * u128::from(i) / u128::from(TRIED)) as u64)
                .collect();
            for three in tried.windows(3) {
                let [Some(first), Some(middle), Some(last)] = [at(three[0]), at(three[1]), at(three[2])]
                else {
                    continue;
                };
                if (middle - first) * (last - middle) < 0.0 {
                    turns.push(extremum(&at, three[0], three[2], middle > first));
                }
            }
        }
        turns
    }
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
