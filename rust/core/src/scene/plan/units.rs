//! What each copy is made of: which bodies are integrated together.

use super::super::unit::Unit;
use super::coupling::Groups;
use super::{PASSIVE_PER_UNIT, Plan};
use std::sync::Arc;

impl Plan {
    /// A unit for each group of bodies.
    pub(super) fn kinds(&self) -> Vec<Unit> {
        let none: Arc<[usize]> = Arc::from([]);
        let kind = |bodies: Arc<[usize]>, active, recorded, make_up| Unit {
            copy: 0,
            bodies,
            active,
            recorded,
            leads: false,
            follows: false,
            make_up,
            events: Arc::clone(&none),
        };
        let active = self.active.len();
        // Bodies by themselves are all of one make-up, whichever they are; rigid ones of as many as there are makes.
        let groups = match &self.groups {
            Groups::Listed(groups) => groups.len(),
            _ => 0,
        };
        let alone = |&body: &usize| {
            let make = self.make_of(body);
            kind(Arc::from([body]), 0, 0..1, if make > 0 { groups + make } else { 0 })
        };
        match &self.groups {
            Groups::Single => self.passive.iter().map(alone).collect(),
            Groups::Listed(groups) => {
                let group = |(index, bodies): (usize, &Arc<[usize]>)| {
                    kind(Arc::clone(bodies), bodies.len(), 0..bodies.len(), 1 + index)
                };
                groups.iter().enumerate().map(group).chain(self.passive.iter().map(alone)).collect()
            }
            Groups::All if self.guided => {
                let following = |body| Unit { follows: true, ..kind(Arc::from([body]), 0, 0..1, 1) };
                let massless = self.passive.iter().copied().map(following);
                core::iter::once(self.guide(0, true)).chain(massless).collect()
            }
            Groups::All if self.passive_apart() => {
                let with_active = |run: &[usize]| {
                    let bodies: Arc<[usize]> = self.active.iter().chain(run).copied().collect();
                    let recorded = active..bodies.len();
                    kind(bodies, active, recorded, run.len())
                };
                let massive = kind(Arc::from(&self.active[..]), active, 0..active, 0);
                let together = if self.transformed.is_some() { 1 } else { PASSIVE_PER_UNIT };
                let massless = self.passive.chunks(together).map(with_active);
                core::iter::once(massive).chain(massless).collect()
            }
            Groups::All => {
                let bodies: Arc<[usize]> = self.active.iter().chain(&self.passive).copied().collect();
                let recorded = 0..bodies.len();
                vec![kind(bodies, active, recorded, 0)]
            }
        }
    }
}
