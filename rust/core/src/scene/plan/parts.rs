//! Into what units a copy is cut: massless bodies that follow the massive ones, and the list of all units.

use super::{Groups, Plan};
use crate::scene::layout::Layout;
use crate::scene::unit::Unit;
use std::sync::Arc;

/// So many massless bodies take long enough for the massive ones to be integrated again for them, on another thread.
const FOLLOWERS_WORTH_A_GUIDE: usize = 128;
/// The most massless bodies that follow at a time: their steps stay in a cache.
const FOLLOWERS_MAX: usize = 1024;

impl Plan {
    /// Whether the massless bodies are integrated apart, so that they stay out of the massive ones' steps.
    pub fn passive_apart(&self) -> bool {
        self.groups == Groups::All
            && !self.touching
            && !self.neighbors
            && !self.turning.steps()
            && (self.has_own_times() || self.relative)
            && !self.active.is_empty()
            && !self.passive.is_empty()
    }

    /// How a unit lies in lanes: massless bodies that follow others have a lane each.
    pub fn layout_of(&self, unit: &Unit) -> Layout {
        if unit.follows { Layout::Batched } else { self.layout }
    }

    /// Units that one state holds at a fixed step. Where each lane halves steps of its own, or tells what it has not seen, a lane
    /// is one unit's alone.
    pub fn in_lockstep(&self) -> usize {
        let alone = self.tolerance.is_some() || self.passes_over();
        if alone { self.layout.units() } else { self.layout.in_lockstep() }
    }

    /// Whether steps of a given length may pass over what is narrower than they are.
    pub fn passes_over(&self) -> bool {
        !self.has_own_times() && self.has_narrow()
    }

    /// Whether something in the forces may be narrower than a step.
    pub fn has_narrow(&self) -> bool {
        self.forces.iter().any(|force| force.may_be_narrow())
    }

    /// Into how many pieces so many massless bodies of a copy are cut that follow the massive ones; for each of them the
    /// massive ones are integrated again.
    pub fn pieces(&self, massless: usize, threads: usize) -> usize {
        if self.layout == Layout::Batched {
            return 1;
        }
        let useful = (massless / FOLLOWERS_WORTH_A_GUIDE).min((2 * threads).div_ceil(self.copies));
        massless.div_ceil(FOLLOWERS_MAX).max(if threads > 1 { useful } else { 1 }).max(1)
    }

    /// The massive bodies of a copy, for massless ones to follow; `recorded` or not.
    pub fn guide(&self, copy: usize, recorded: bool) -> Unit {
        let active = self.active.len();
        let leads = recorded;
        let recorded = if recorded { 0..active } else { active..active };
        Unit {
            copy,
            bodies: Arc::from(&self.active[..]),
            active,
            recorded,
            leads,
            follows: false,
            make_up: 0,
            events: Arc::from([]),
        }
    }

    /// The units of the integration, in the order in which they are begun.
    pub fn unit_list(&self) -> Vec<Unit> {
        let kinds = &self.watched_kinds();
        (0..self.copies)
            .flat_map(|copy| kinds.iter().enumerate().map(move |(index, kind)| (copy, index, kind)))
            .map(|(copy, index, kind)| Unit { copy, leads: index == 0, ..kind.clone() })
            .collect()
    }

    /// The first of them.
    pub fn first_unit(&self) -> Option<Unit> {
        self.watched_kinds().into_iter().next().map(|kind| Unit { leads: true, ..kind })
    }

    /// The units of each copy.
    pub fn watched_kinds(&self) -> Vec<Unit> {
        let mut kinds = self.kinds();
        self.watch(&mut kinds);
        kinds
    }
}
