//! From what a run begins: the scene as it is, or the beginning of an earlier run, which it goes on with.

use super::super::Scene;
use super::super::collisions;
use super::super::continuation::Continuation;
use super::super::integrate::Report;
use super::super::plan::{Plan, with_method};
use super::super::request::Request;
use super::patterns::{Pattern, patterns};
use super::{Kept, Part};
use crate::error::Result;
use crate::parallel::Ticker;

/// The plan of a run.
///
/// # Errors
/// As [`Plan::new`].
pub fn plan(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Plan> {
    match collisions::wanted(scene, request)? {
        Some(rule) => collisions::plan(scene, request, rule, ticker),
        None => plan_through(scene, request, ticker),
    }
}

/// The plan of a run in which spheres pass through each other, or end it where they touch.
///
/// # Errors
/// As [`Plan::new`].
pub(in super::super) fn plan_through(
    scene: &Scene,
    request: &Request,
    ticker: &mut Ticker<'_>,
) -> Result<Plan> {
    match &scene.continuation {
        None => Plan::new(scene, request, ticker),
        Some(_) => Ok(Begun::of(scene, request, ticker)?.plan),
    }
}

/// A run that is planned: as a whole and in parts.
pub(super) struct Begun {
    /// The scene that is planned from, if it is another.
    start: Option<Scene>,
    pub(super) plan: Plan,
    groups: Option<Vec<Pattern>>,
    plans: Vec<Plan>,
}

impl Begun {
    /// Plans a run.
    pub(super) fn of(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Self> {
        let named = request.dt.and_then(|_| with_method(scene, request));
        let same = named.as_ref().unwrap_or(request);
        if let (Some(start), Some(from)) = (Continuation::start(scene, same), &scene.continuation) {
            // What is wrong with the request is told of the scene as it is.
            let _ = same.check(scene)?;
            let mut begun = Self::planned(&start, request, false, ticker)?;
            begun.plans.iter_mut().chain([&mut begun.plan]).for_each(|plan| plan.from = from.node);
            begun.start = Some(start);
            let mut parts = begun.parts(scene).into_iter();
            if parts.all(|part| from.agrees(scene, (part.scene, part.plan), part.members, ticker)) {
                drop(parts);
                return Ok(begun);
            }
        }
        Self::planned(scene, request, false, ticker)
    }

    /// Plans a run from the scene as it is, or that of a scene beside its neighbors.
    pub(super) fn planned(
        scene: &Scene,
        request: &Request,
        neighbors: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let plan = Plan::of(scene, request, neighbors, ticker)?;
        let Some(groups) = patterns(scene, (&plan, request.rtol), ticker)? else {
            return Ok(Self { start: None, plan, groups: None, plans: Vec::new() });
        };
        let mut apart = Vec::with_capacity(groups.len());
        for group in groups {
            planned_apart(group, (request, neighbors), &mut apart, ticker)?;
        }
        let (groups, plans) = apart.into_iter().unzip();
        Ok(Self { start: None, plan, groups: Some(groups), plans })
    }

    /// The scene that is planned from.
    pub(super) fn start<'a>(&'a self, whole: &'a Scene) -> &'a Scene {
        self.start.as_ref().unwrap_or(whole)
    }

    /// The copies that are run together.
    pub(super) fn parts<'a>(&'a self, whole: &'a Scene) -> Vec<Part<'a>> {
        match &self.groups {
            None => {
                vec![Part { whole, scene: self.start(whole), plan: &self.plan, members: None }]
            }
            Some(groups) => groups
                .iter()
                .zip(&self.plans)
                .map(|((members, scene), plan)| Part { whole, scene, plan, members: Some(members) })
                .collect(),
        }
    }
}

/// Plans copies of one pattern. Their own plan may be by another method than that of all, and tell more of them apart.
fn planned_apart(
    (members, part): Pattern,
    asked: (&Request, bool),
    into: &mut Vec<(Pattern, Plan)>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let plan = Plan::of(&part, asked.0, asked.1, ticker)?;
    let Some(groups) = patterns(&part, (&plan, asked.0.rtol), ticker)?.filter(|groups| groups.len() > 1)
    else {
        into.push(((members, part), plan));
        return Ok(());
    };
    for (own, part) in groups {
        let members = own.iter().map(|&copy| members[copy]).collect();
        planned_apart((members, part), asked, into, ticker)?;
    }
    Ok(())
}

impl Kept {
    /// Takes in what units hold. A copy is kept if all of its units came to one node.
    pub(super) fn gather(&mut self, part: &Part<'_>, reports: &mut [Report]) {
        for report in reports.iter_mut().filter(|report| !report.unit.recorded.is_empty()) {
            let copy = part.member(report.unit.copy);
            let node = report.held.as_ref().map_or(0, |held| held.node);
            let node = match core::mem::replace(&mut self.nodes[copy], node) {
                u64::MAX => node,
                before if before == node => node,
                _ => 0,
            };
            self.nodes[copy] = node;
            if let Some(held) = report.held.take().filter(|_| node > 0) {
                self.held.put(part.plan, part.whole.particles, (copy, &report.unit), &held);
            }
        }
    }
}
