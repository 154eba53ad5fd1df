//! How the motion of each ensemble member is found: by a closed form of the registry, or step by step.

use super::super::Scene;
use crate::closed_forms::{ClosedForm, Member, free};
use crate::error::Result;
use crate::forces::ForceTerm;
use crate::forces::term::Bodies;
use crate::parallel::Ticker;
use crate::registry::CLOSED_FORMS;

/// A closed form, or none for an integration.
type Solution = Option<&'static ClosedForm>;

/// The solution of each ensemble member.
#[derive(Clone, Debug)]
pub struct Solutions {
    /// Each of them, or the first if all are the same.
    each: Vec<Solution>,
    members: usize,
}

impl Solutions {
    /// What the registry has for the members of a scene.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub fn of(scene: &Scene, ticker: &mut Ticker<'_>) -> Result<Self> {
        let members = scene.copies;
        let solution = |copy: usize| {
            ticker.tick()?;
            let member = member(scene, copy);
            Ok(CLOSED_FORMS.iter().copied().find(|form| (form.applies)(&member)))
        };
        let mut each: Vec<Solution> = (0..members).map(solution).collect::<Result<_>>()?;
        if each.windows(2).all(|pair| pair[0] == pair[1]) {
            each.truncate(1);
        }
        Ok(Self { each, members })
    }

    /// Straight lines, along which contacts are known as well; all others step by step.
    pub fn straight_lines(mut self) -> Self {
        for solution in &mut self.each {
            *solution = solution.filter(|form| core::ptr::eq(*form, &free::FORM));
        }
        self
    }

    /// Step by step.
    pub fn integration(members: usize) -> Self {
        Self { each: vec![None], members }
    }

    /// That of a member.
    pub fn of_member(&self, copy: usize) -> Solution {
        if let [all] = self.each[..] { all } else { self.each.get(copy).copied().flatten() }
    }

    /// Whether any member is integrated.
    pub fn integrates(&self) -> bool {
        self.each.contains(&None)
    }

    /// Whether all members are integrated.
    pub fn integrates_all(&self) -> bool {
        self.each.iter().all(Option::is_none)
    }

    /// The solutions there are, in the order of their first members, and of how many members each is.
    pub fn counts(&self) -> Vec<(Solution, usize)> {
        if let [all] = self.each[..] {
            return vec![(all, self.members)];
        }
        let mut counts: Vec<(Solution, usize)> = Vec::new();
        for &solution in &self.each {
            match counts.iter_mut().find(|(other, _)| *other == solution) {
                Some((_, count)) => *count += 1,
                None => counts.push((solution, 1)),
            }
        }
        counts
    }
}

/// A member of a scene, for closed forms to look at.
pub fn member(scene: &Scene, copy: usize) -> Member<'_> {
    let alone = scene.bodies_of(copy);
    let Bodies { mass, position, velocity, .. } = alone;
    let forces = scene.forces_of(copy).iter().filter(|force| force.acts(&alone));
    let forces = forces.map(|force| &**force as &dyn ForceTerm).collect();
    Member { mass, position, velocity, forces, t0: scene.t0 }
}
