//! Which unit looks for which event.
//!
//! The one idea: events leave every bit of a run as it is, so they never change what is integrated together. A unit that
//! holds all bodies of an event looks for it; where none does, one more unit integrates them together, recording nothing.

use super::super::unit::Unit;
use super::{Groups, Plan};
use std::sync::Arc;

impl Plan {
    /// Gives each event to one of the kinds of units, or to one more.
    pub(super) fn watch(&self, kinds: &mut Vec<Unit>) {
        if let (true, [all]) = (self.touching, &mut kinds[..]) {
            // One unit has all bodies.
            all.events = (0..self.events.len()).collect();
            return;
        }
        let own = kinds.len();
        for (index, event) in self.events.iter().enumerate() {
            let looked_at = event.bodies(&self.groups, self.particles, &self.active);
            // Those that follow others are taken through steps of theirs, not through steps of the run.
            let holds =
                |unit: &Unit| !unit.follows && looked_at.iter().all(|body| unit.bodies.contains(body));
            let place = kinds.iter().position(holds).unwrap_or_else(|| {
                kinds.push(self.together(&looked_at, kinds.len() - own));
                kinds.len() - 1
            });
            let unit = &mut kinds[place];
            unit.events = unit.events.iter().copied().chain([index]).collect();
        }
    }

    /// A unit of these bodies and of those on which they depend, which records nothing.
    fn together(&self, looked_at: &[usize], extra: usize) -> Unit {
        let (active, bodies): (usize, Vec<usize>) = match &self.groups {
            Groups::Single => (0, looked_at.to_vec()),
            Groups::Listed(groups) => {
                let touched = groups.iter().filter(|group| looked_at.iter().any(|body| group.contains(body)));
                let coupled: Vec<usize> = touched.flat_map(|group| group.iter().copied()).collect();
                let alone = looked_at.iter().copied().filter(|body| !coupled.contains(body));
                (coupled.len(), coupled.iter().copied().chain(alone).collect())
            }
            Groups::All => {
                let massless = looked_at.iter().copied().filter(|body| !self.active.contains(body));
                (self.active.len(), self.active.iter().copied().chain(massless).collect())
            }
        };
        Unit {
            copy: 0,
            active,
            recorded: bodies.len()..bodies.len(),
            bodies: Arc::from(bodies),
            leads: false,
            follows: false,
            // Of no other unit; groups count from 1.
            make_up: usize::MAX - extra,
            events: Arc::from([]),
        }
    }

    /// Whether an event is looked for on other steps than those of all bodies that it looks at: in a unit of its own, or in
    /// that of massless bodies beside massive ones that have steps of their own.
    pub(super) fn watches_apart(&self) -> bool {
        let kinds = self.watched_kinds();
        let beside =
            |unit: &Unit| !unit.events.is_empty() && !unit.follows && unit.recorded.len() < unit.bodies.len();
        kinds.len() > self.kinds().len() || (self.has_own_times() && kinds.iter().any(beside))
    }
}
