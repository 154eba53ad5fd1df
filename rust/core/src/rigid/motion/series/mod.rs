//! Rigid bodies that torques turn, beside points, as Taylor series.
//!
//! The one idea: what moves them is written as expressions of the numbers of a state, and their recurrences are those of
//! formulas. Where forces pull alike everywhere the whole motion is one walk through all orders; else accelerations are asked
//! for order by order. The center of a held body goes where its orientation takes it, and is known with that.

pub(super) mod equations;
mod one_body;
mod together;
pub(super) mod writer;

use super::acting::Loads;
use super::bodies::Arrangement;
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::ode::series::Jet;
use crate::ode::system::System;
use crate::parallel::Ticker;
use together::{Bodies, Held};

/// Expands motions of bodies and points.
pub(super) trait Expand: Send {
    /// Expands one up to the order of the jet.
    ///
    /// # Errors
    /// Those of the forces on points.
    fn expand(
        &mut self,
        jet: &mut Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// As [`System::smooth_until`].
    fn smooth_until(&self, jet: &Jet<Lanes>, h: &Lanes, points: &dyn System<Lanes>) -> Option<Lanes>;
}

/// What is known of the systems in the lanes.
#[derive(Clone, Copy, Debug)]
pub struct InLanes {
    /// Whether there is one, in the first lane.
    pub alone: bool,
    /// Whether forces pull alike everywhere.
    pub alike: bool,
}

/// What expands the motions of bodies that lie so, under these loads; nothing if some load is a function of the caller.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn expanding(
    arrangement: &Arrangement,
    loads: &Loads,
    of: InLanes,
) -> Result<Option<Box<dyn Expand>>> {
    if !loads.are_written() {
        return Ok(None);
    }
    if let Some(one) = one_body::OneBody::new(arrangement, loads, of) {
        return Ok(Some(Box::new(one)));
    }
    // A number takes less time than lanes of which one is looked at, and has the same bits.
    Ok(Some(if of.alone {
        Box::new(Bodies::<f64>::new(arrangement, loads, of.alike)?)
    } else {
        Box::new(Bodies::<Lanes>::new(arrangement, loads, of.alike)?)
    }))
}

/// Finds the velocity of a coordinate from where it is, but for the highest order, of which nothing tells.
fn follow<S: Held>(jet: &mut Jet<Lanes>, coordinate: usize) {
    let (len, per_unit) = (jet.len, S::one() / S::of(&jet.unit));
    for n in 2..=jet.order {
        let slope = S::splat(n as f64) * S::of(&jet.q[n * len + coordinate]);
        (slope * per_unit).put(&mut jet.q[(n - 1) * len + len / 2 + coordinate]);
    }
}
