//! The forces of a plan: of all copies, or of each its own.

use super::super::Scene;
use super::super::frame::Frame;
use crate::error::Result;
use crate::forces::ForceTerm;
use crate::ode::Method;
use std::sync::Arc;

/// The forces, of some, that do anything in this scene.
pub(super) fn acting(scene: &Scene, forces: &[Arc<dyn ForceTerm>]) -> Vec<Arc<dyn ForceTerm>> {
    let bodies = scene.bodies();
    forces.iter().filter(|force| force.acts(&bodies)).cloned().collect()
}

/// Sets of forces that do something, about what bodies are integrated under each, and which of them each copy has.
#[derive(Clone, Debug)]
pub(super) struct Own {
    sets: Vec<(Vec<Arc<dyn ForceTerm>>, Frame)>,
    of_copy: Vec<usize>,
}

impl Own {
    /// The forces that copies have of their own, if they have; about origins that move, if they may.
    ///
    /// # Errors
    /// When the method cannot take one of them, or a drive is not known at these times, at which it is integrated.
    pub(super) fn of(
        scene: &Scene,
        method: &Method,
        integrated: Option<[f64; 2]>,
        moves: bool,
    ) -> Result<Option<Self>> {
        let Some(own) = &scene.own_forces else { return Ok(None) };
        let set = |forces: &Vec<Arc<dyn ForceTerm>>| {
            let forces = acting(scene, forces);
            super::refusals::check_method(method, &forces)?;
            if let Some(times) = integrated {
                super::refusals::check_drives(&forces, times)?;
            }
            Ok(about(forces, moves))
        };
        let sets = own.sets.iter().map(set).collect::<Result<_>>()?;
        Ok(Some(Self { sets, of_copy: own.of_copy.clone() }))
    }

    /// Those of a copy.
    pub(super) fn forces(&self, copy: usize) -> &[Arc<dyn ForceTerm>] {
        &self.sets[self.of_copy[copy]].0
    }

    /// About what its bodies are integrated.
    pub(super) fn frame(&self, copy: usize) -> Frame {
        self.sets[self.of_copy[copy]].1
    }
}

/// About what bodies are integrated under these forces, and those that are left: what accelerates all alike moves the
/// origin, and nothing relative to it.
pub(super) fn about(forces: Vec<Arc<dyn ForceTerm>>, integrates: bool) -> (Vec<Arc<dyn ForceTerm>>, Frame) {
    let frame = if integrates { Frame::of(&forces) } else { Frame::Given };
    let falls = matches!(frame, Frame::Falling(_));
    let left = forces.into_iter().filter(|force| !falls || force.as_uniform().is_none());
    (left.collect(), frame)
}
