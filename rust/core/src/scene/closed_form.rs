//! Scenes whose motion is known in closed form: any time costs the same, and nothing is stepped.
//!
//! Straight lines and parabolas are evaluated in double-double and rounded once. Kepler orbits come from
//! [`KeplerOrbit`]: a few units in the last place times the conditioning of the problem.

use super::Scene;
use super::columns::{Entry, Writer};
use super::plan::{Plan, Solution};
use super::run::Reached;
use crate::error::Result;
use crate::forces::bodies::PreciseBodies;
use crate::nbody::kepler::KeplerOrbit;
use crate::nbody::two_body::{ExactState, TwoBody};
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::Ticker;
use nalgebra::Vector3;

/// The motion of one particle relative to another point.
enum Path {
    /// Uniform acceleration (which may be zero).
    Parabola { position: [f64; 3], velocity: [f64; 3], acceleration: [f64; 3] },
    /// A Kepler orbit about a point, seen from a moving base.
    Orbit { orbit: Box<KeplerOrbit>, base: Box<Path> },
}

impl Path {
    fn line(position: [f64; 3], velocity: [f64; 3]) -> Self {
        Self::Parabola { position, velocity, acceleration: [0.0; 3] }
    }

    /// Position and velocity after a time, unrounded where they can be.
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        match self {
            Self::Parabola { position, velocity, acceleration } => {
                let at = |c: usize| {
                    let (x, v) = (DoubleDouble::from(position[c]), DoubleDouble::from(velocity[c]));
                    let a = DoubleDouble::from(acceleration[c]);
                    (x + elapsed * (v + a * elapsed.scale(0.5)), v + a * elapsed)
                };
                let states: [_; 3] = core::array::from_fn(at);
                (states.map(|state| state.0), states.map(|state| state.1))
            }
            Self::Orbit { orbit, base } => {
                let (mut position, mut velocity) = base.state(elapsed);
                let (relative, rate) = orbit.state(elapsed.to_f64());
                for c in 0..3 {
                    position[c] += DoubleDouble::from(relative[c]);
                    velocity[c] += DoubleDouble::from(rate[c]);
                }
                (position, velocity)
            }
        }
    }
}

/// The motion of the particles of a copy.
enum Motion {
    /// Each on its own path.
    Paths(Vec<Path>),
    /// Two that attract each other.
    Pair(Box<TwoBody>),
}

impl Motion {
    fn states(&self, elapsed: DoubleDouble, states: &mut Vec<ExactState>) {
        states.clear();
        match self {
            Self::Paths(paths) => states.extend(paths.iter().map(|path| path.state(elapsed))),
            Self::Pair(pair) => states.extend(pair.unrounded(elapsed)),
        }
    }
}

fn orbit(mu: f64, from: ([f64; 3], [f64; 3]), to: ([f64; 3], [f64; 3])) -> Result<Box<KeplerOrbit>> {
    let difference = |a: [f64; 3], b: [f64; 3]| Vector3::from_fn(|c, _| b[c] - a[c]);
    Ok(Box::new(KeplerOrbit::new(mu, difference(from.0, to.0), difference(from.1, to.1))?))
}

fn motion(scene: &Scene, plan: &Plan, copy: usize) -> Result<Motion> {
    let (mass, position, velocity) = (scene.masses(copy), scene.positions(copy), scene.velocities(copy));
    let state = |i: usize| (position[i], velocity[i]);
    let gravity = plan.forces.iter().find_map(|force| force.as_newtonian());
    let constant = gravity.map_or(0.0, |(constant, _)| constant);
    let all = 0..scene.particles;
    let paths: Result<Vec<Path>> = match &plan.solution {
        Solution::TwoBody => {
            let states = [0, 1].map(|i| (Vector3::from(position[i]), Vector3::from(velocity[i])));
            return Ok(Motion::Pair(Box::new(TwoBody::new(constant, [mass[0], mass[1]], states)?)));
        }
        Solution::Uniform(g) => Ok(all
            .map(|i| Path::Parabola { position: position[i], velocity: velocity[i], acceleration: *g })
            .collect()),
        Solution::OneMassive(center) => all
            .map(|i| {
                let base = Path::line(position[*center], velocity[*center]);
                if i == *center {
                    return Ok(base);
                }
                let orbit = orbit(constant * mass[*center], state(*center), state(i))?;
                Ok(Path::Orbit { orbit, base: Box::new(base) })
            })
            .collect(),
        Solution::FixedCenter { k, center } => all
            .map(|i| {
                let still = (*center, [0.0; 3]);
                let orbit = orbit(-k / mass[i], still, state(i))?;
                Ok(Path::Orbit { orbit, base: Box::new(Path::line(*center, [0.0; 3])) })
            })
            .collect(),
        Solution::Free | Solution::Integration => {
            Ok(all.map(|i| Path::line(position[i], velocity[i])).collect())
        }
    };
    Ok(Motion::Paths(paths?))
}

/// Fills the columns from the closed form.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted), or what the closed form refuses.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    times: &[f64],
    writer: &Writer<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Reached> {
    let mut bodies = PreciseBodies::default();
    let mut reached = Reached { position: Vec::new(), velocity: Vec::new() };
    for copy in 0..scene.copies {
        let motion = motion(scene, plan, copy)?;
        let (mut states, mut last) = (Vec::new(), Vec::new());
        for (index, &t) in times.iter().enumerate() {
            motion.states(DoubleDouble::sum(t, -scene.t0), &mut states);
            last.clear();
            // SAFETY: no other thread writes here.
            let output = unsafe { writer.output(copy, index) };
            for (particle, state) in states.iter().enumerate() {
                let entry = entry(scene, copy, particle, *state, t);
                output.write(particle, &entry);
                last.push(entry);
            }
            if writer.derives() {
                bodies.clear(last.len());
                for (particle, entry) in last.iter().enumerate() {
                    let position = [entry.position, entry.position_rest];
                    let velocity = [entry.velocity, entry.velocity_rest];
                    bodies.set(particle, scene.masses(copy)[particle], position, velocity);
                }
                bodies.settle();
                output.derive(&bodies, ticker)?;
            }
            ticker.tick()?;
        }
        reached.position.extend(last.iter().map(|entry| entry.position));
        reached.velocity.extend(last.iter().map(|entry| entry.velocity));
    }
    Ok(reached)
}

fn entry(scene: &Scene, copy: usize, particle: usize, (position, velocity): ExactState, t: f64) -> Entry {
    if t == scene.t0 {
        // The state at the start is the one that was given, to the bit.
        return Entry {
            position: scene.positions(copy)[particle],
            velocity: scene.velocities(copy)[particle],
            ..Entry::default()
        };
    }
    Entry {
        position: position.map(DoubleDouble::high),
        velocity: velocity.map(DoubleDouble::high),
        position_rest: position.map(DoubleDouble::low),
        velocity_rest: velocity.map(DoubleDouble::low),
    }
}
