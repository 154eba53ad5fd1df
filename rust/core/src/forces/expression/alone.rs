//! The series of the only body that there is.
//!
//! The one idea: a number takes less time than lanes of which one is looked at, and has the same bits.

use super::expanded::SPACE;
use super::kernel::{Way, turned};
use crate::expressions::series::{Beside, Coefficients, Equations, Expansion, Seen, Series};
use crate::numerics::element::Scaled;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::ode::series::Jet;
use crate::tiered;
use std::sync::Arc;

/// Its series, with room for coefficients, component after component.
pub(super) struct Alone {
    series: Expansion<f64>,
    places: Vec<f64>,
    velocities: Vec<f64>,
    inverse: Vec<Scaled<f64>>,
}

impl Alone {
    pub(super) fn new(series: &Arc<Series>, parameters: &[Lanes]) -> Self {
        let parameters: Vec<f64> = parameters.iter().map(|parameter| parameter.0[0]).collect();
        let series = Expansion::new(series.clone(), &parameters);
        Self { series, places: Vec::new(), velocities: Vec::new(), inverse: Vec::new() }
    }

    /// As the motion of a row, whose first coefficients are there.
    pub(super) fn expand(
        &mut self,
        equations: &Equations<'_, Lanes>,
        (places, velocities): (&[Lanes], &[Lanes]),
        order: usize,
    ) {
        let Equations { t, unit, inverse, seen, .. } = *equations;
        let number = |lanes: &Lanes| lanes.0[0];
        let matrix = |of: &[[Lanes; SPACE]; SPACE]| of.each_ref().map(|row| row.each_ref().map(number));
        let beside = seen.and_then(|seen| seen.beside).map(|beside| Beside {
            first: beside.first.each_ref().map(number),
            of_places: matrix(&beside.of_places),
            of_velocities: matrix(&beside.of_velocities),
        });
        let Self { series, places: into, velocities: moving, inverse: own, .. } = self;
        if own.len() < inverse.len() {
            *own = inverse.iter().map(|(high, low)| (high.0[0], low.0[0])).collect();
        }
        into.resize(places.len(), 0.0);
        moving.resize(velocities.len(), 0.0);
        for (into, from) in into.iter_mut().zip(&places[..2 * SPACE]) {
            *into = from.0[0];
        }
        for (into, from) in moving.iter_mut().zip(&velocities[..SPACE]) {
            *into = from.0[0];
        }
        let factors = seen.map(|seen| [seen.time, seen.velocity, seen.rate].map(number));
        let seen = factors.as_ref().map(|[time, velocity, rate]| {
            let beside = beside.as_ref();
            Seen { time, velocity, rate, beside }
        });
        let (t, unit, velocity) = (t.0[0], unit.0[0], equations.velocity);
        let equations = Equations { second_order: true, velocity, t, unit, inverse: &own[..], seen };
        series.motion(&equations, Coefficients { order, len: SPACE, q: into, v: moving });
    }

    /// Takes them to the first lane of the motion.
    pub(super) fn end(&self, way: &Way, jet: &mut Jet<Lanes>) {
        end_tier(way, self, jet);
    }

    /// As [`Expansion::smooth_until`].
    pub(super) fn smooth_until(&self, order: usize, h: f64) -> f64 {
        self.series.smooth_until(order, h)
    }
}

/// Takes the coefficients, from the first that was found on, back to the units and axes of the integration.
#[inline(always)]
#[expect(clippy::extra_unused_type_parameters, reason = "the tier gives its instructions, not its lanes")]
fn end_body<V: Vector8>(way: &Way, alone: &Alone, jet: &mut Jet<Lanes>) {
    let (rows, len, back) = (way.shape.rows, jet.len, 1.0 / way.place);
    for n in 0..jet.order {
        let [places, velocities] =
            [&alone.places[(n + 2) * SPACE..][..SPACE], &alone.velocities[(n + 1) * SPACE..][..SPACE]];
        let place = turned(&way.axes, [places[0], places[1], places[2]], true);
        let velocity = turned(&way.axes, [velocities[0], velocities[1], velocities[2]], true);
        for c in 0..way.shape.components {
            jet.q[(n + 2) * len + c * rows].0[0] = place[c] * back;
            jet.v[(n + 1) * len + c * rows].0[0] = velocity[c] * back;
        }
    }
}

tiered! {
    fn end_tier[][](way: &Way, alone: &Alone, jet: &mut Jet<Lanes>) = end_body;
}
