//! Rigid bodies that nothing turns: their orientations at all output times, by the exact solution.

use super::super::Scene;
use super::super::columns::Columns;
use super::super::request::Request;
use super::{Outcome, Reached};
use crate::error::Result;
use crate::parallel::{Ticker, for_chunks};
use crate::rigid::free::FreeRotation;
use crate::rigid::motion::bodies::RigidBodies;
use crate::rigid::motion::conserved::Scenery;
use crate::rigid::quaternion::Quaternion;

/// Orientations that one thread finds at a time, about.
const TOGETHER: usize = 1 << 12;

/// Fills in orientations and angular velocities of some copies, of the rows that each has and of where it ended: of a scene,
/// which may go on with a run that began at `start`. Then bodies turn on from there, as they would have in one run.
///
/// # Errors
/// A spin that no body has, or turns that nobody can count.
pub(super) fn turn_freely(
    (scene, start): (&Scene, &Scene),
    copies: &[usize],
    request: &Request,
    columns: &mut Columns,
    outcomes: &[Outcome],
    reached: &mut Reached,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let Some(bodies) = &scene.rigid else { return Ok(()) };
    let times = columns.times;
    let of = |&copy: &usize| copy * bodies.count..(copy + 1) * bodies.count;
    let all: Vec<usize> = copies.iter().flat_map(of).collect();
    let together = TOGETHER.div_ceil(times.max(1));
    let chunks: Vec<&[usize]> = all.chunks(together).collect();
    let found = for_chunks(request.threads, chunks.len(), ticker, |chunk, ticker| {
        let mut found = Vec::new();
        for &body in chunks[chunk] {
            let (motion, t0) = motion_of((scene, start), bodies, body)?;
            let outcome = &outcomes[body / bodies.count];
            let rows = request.times[..if columns.rigid > 0 { outcome.rows } else { 0 }].iter();
            for &t in rows.chain([&outcome.time]) {
                motion.check_time(t - t0)?;
                let state = motion.state(t - t0);
                found.push(if t == scene.t0 {
                    (bodies.orientation[body], bodies.angular_velocity[body])
                } else {
                    bodies.given(body, state.orientation, state.angular_velocity)
                });
            }
            let _ = ticker.tick();
        }
        Ok(found)
    })?;
    let mut found = found.into_iter().flatten();
    for body in all {
        let (copy, place) = (body / bodies.count, body % bodies.count);
        let rows = if columns.rigid > 0 { outcomes[copy].rows } else { 0 };
        for (row, (orientation, spin)) in found.by_ref().take(rows + 1).enumerate() {
            if row == rows {
                reached.orientation[body] = orientation;
                reached.angular_velocity[body] = spin;
                continue;
            }
            let at = (copy * times + row) * bodies.count + place;
            columns.orientation[4 * at..4 * at + 4].copy_from_slice(&orientation);
            columns.angular_velocity[3 * at..3 * at + 3].copy_from_slice(&spin);
        }
    }
    Ok(())
}

/// How a body turns, and from which time on: that at which an earlier run began, if the body is where that led.
fn motion_of(
    (scene, start): (&Scene, &Scene),
    bodies: &RigidBodies,
    body: usize,
) -> Result<(FreeRotation, f64)> {
    if let Some(begun) = start.rigid.as_ref().filter(|_| start.t0 != scene.t0) {
        let (orientation, spin) = begun.principal(body);
        let motion = FreeRotation::new(begun.moments[body], spin, orientation)?;
        motion.check_time(scene.t0 - start.t0)?;
        let state = motion.state(scene.t0 - start.t0);
        let here = (bodies.orientation[body], bodies.angular_velocity[body]);
        if begun.given(body, state.orientation, state.angular_velocity) == here {
            return Ok((motion, start.t0));
        }
    }
    let (orientation, spin) = bodies.principal(body);
    Ok((FreeRotation::new(bodies.moments[body], spin, orientation)?, scene.t0))
}

/// What the rigid bodies of a recorded row add to its columns.
pub(super) struct Turning<'a> {
    bodies: &'a RigidBodies,
    place: Vec<[f64; 3]>,
    orientation: Vec<Quaternion>,
    angular_velocity: Vec<[f64; 3]>,
    constant: f64,
}

impl<'a> Turning<'a> {
    /// Of a copy at an output time; `None` without rigid bodies.
    pub(super) fn read(scene: &'a Scene, columns: &Columns, copy: usize, time: usize) -> Option<Self> {
        let bodies = scene.rigid.as_ref()?;
        let row = copy * columns.times + time;
        let point = |values: &[f64], at: usize| [values[3 * at], values[3 * at + 1], values[3 * at + 2]];
        let own = row * columns.rigid..(row + 1) * columns.rigid;
        let newtonian = scene.forces_of(copy).iter().filter_map(|force| force.as_newtonian());
        Some(Self {
            bodies,
            place: (0..scene.particles)
                .map(|particle| point(&columns.position, row * columns.particles + particle))
                .collect(),
            orientation: own
                .clone()
                .map(|at| core::array::from_fn(|c| columns.orientation[4 * at + c]))
                .collect(),
            angular_velocity: own.map(|at| point(&columns.angular_velocity, at)).collect(),
            constant: newtonian.map(|(constant, _)| constant).sum(),
        })
    }

    /// As the sums see it.
    pub(super) fn scenery(&'a self, scene: &'a Scene, copy: usize) -> Scenery<'a> {
        Scenery {
            bodies: self.bodies,
            copy,
            mass: scene.masses(copy),
            place: &self.place,
            orientation: &self.orientation,
            angular_velocity: &self.angular_velocity,
            constant: self.constant,
        }
    }
}
