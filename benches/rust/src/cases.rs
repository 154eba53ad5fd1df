//! What is run: the one place of the benches that speaks the core's language.

use std::sync::Arc;
use visviva_core::forces::ForceTerm;
use visviva_core::forces::gravity::newton::Gravity;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::potentials::parameters::Value;
use visviva_core::registry;
use visviva_core::scattering::bins::Bins;
use visviva_core::scattering::monte_carlo::{Beam, Mixture, Quantity, Tally, monte_carlo};
use visviva_core::scene::Scene;
use visviva_core::scene::request::Request;
use visviva_core::scene::room::give_back;
use visviva_core::scene::run::run;

/// A scene of the core.
pub type Bodies = Scene;
/// What is asked of it.
pub type Asked = Request;

/// A reproducible number in [-1, 1).
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn gravity(softening: f64) -> Vec<Arc<dyn ForceTerm>> {
    vec![Arc::new(Gravity::new(1.0, softening))]
}

/// A force of the registry.
fn force(name: &str, values: &[Value]) -> Vec<Arc<dyn ForceTerm>> {
    registry::force(name).and_then(|declared| (declared.make)(values).ok()).into_iter().collect()
}

/// `particles` bodies of equal mass in a cube; a heavy one in the middle if `solar`.
pub fn cluster(particles: usize, solar: bool) -> Bodies {
    let mut seed = 1;
    let point = |scale: f64, seed: &mut u64| [noise(seed) * scale, noise(seed) * scale, noise(seed) * scale];
    let mut position: Vec<[f64; 3]> = (0..particles).map(|_| point(1.0, &mut seed)).collect();
    let velocity: Vec<[f64; 3]> = (0..particles).map(|_| point(0.1, &mut seed)).collect();
    let mut mass = vec![1.0 / particles as f64; particles];
    if solar {
        mass.fill(1e-3);
        mass[0] = 1.0;
        position[0] = [0.0; 3];
    }
    let forces = gravity(if solar { 0.0 } else { 0.01 });
    Scene {
        copies: 1,
        particles,
        mass,
        position,
        velocity,
        forces,
        own_forces: None,
        radius: Vec::new(),
        t0: 0.0,
        t0_rest: 0.0,
        rigid: None,
        continuation: None,
    }
}

/// As [`cluster`], softened so that every method takes it easily, with the mass in the first `massive` bodies.
pub fn soft_cluster(particles: usize, massive: usize) -> Bodies {
    let mut scene = cluster(particles, false);
    scene.forces = gravity(0.2);
    for (i, mass) in scene.mass.iter_mut().enumerate() {
        *mass = if i < massive { 1.0 / massive as f64 } else { 0.0 };
    }
    scene
}

/// Bodies around the Yukawa potential of a fixed center.
pub fn around_a_center(particles: usize) -> Bodies {
    let values = [-2.0, 1.5].map(Value::Number);
    let potential = registry::potential("yukawa").and_then(|declared| (declared.make)(&values).ok());
    let forces = potential
        .map(|potential| {
            force("central_field", &[Value::Potential(potential), Value::Vector([3.0, 0.0, 0.0])])
        })
        .unwrap_or_default();
    Scene { forces, ..cluster(particles, false) }
}

/// Bodies on which nothing acts, or a uniform field.
pub fn free(particles: usize, field: bool) -> Bodies {
    let forces = if field { force("uniform_field", &[Value::Vector([0.0, 0.3, -9.81])]) } else { Vec::new() };
    Scene { forces, ..cluster(particles, false) }
}

/// Perturbed copies of the figure-eight of three equal bodies (Chenciner & Montgomery).
pub fn figure_eights(copies: usize) -> Bodies {
    let (x, v) = ([0.97000436, -0.24308753, 0.0], [0.466_203_684_069_539_3, 0.432_365_730_917_476_8, 0.0]);
    let scaled = |a: [f64; 3], factor: f64| a.map(|a| a * factor);
    let mut seed = 1;
    let mut position = Vec::new();
    for _ in 0..copies {
        for body in [x, scaled(x, -1.0), [0.0; 3]] {
            position.push(body.map(|x| x + 1e-4 * noise(&mut seed)));
        }
    }
    Scene {
        copies,
        particles: 3,
        mass: vec![1.0; 3 * copies],
        position,
        velocity: [v, v, scaled(v, -2.0)].repeat(copies),
        forces: gravity(0.0),
        own_forces: None,
        radius: Vec::new(),
        t0: 0.0,
        t0_rest: 0.0,
        rigid: None,
        continuation: None,
    }
}

/// Positions and velocities at `times`; without `dt` the method chooses its steps at a tolerance of 1e-13.
pub fn request(method: &str, dt: Option<f64>, times: Vec<f64>, threads: usize) -> Asked {
    Request {
        times,
        method: method.to_owned(),
        dt,
        time_transformation: None,
        rtol: 1e-13,
        rtol_given: true,
        atol: None,
        max_step: None,
        first_step: None,
        max_steps: None,
        record: vec!["position".to_owned(), "velocity".to_owned()],
        threads,
        events: Vec::new(),
        collisions: None,
    }
}

/// The names of the methods, and whether they choose their own steps.
pub fn methods() -> Vec<(&'static str, bool)> {
    registry::METHODS.iter().map(|method| (method.name, method.adaptive())).collect()
}

/// Runs, and tells the steps that were tried, of all copies.
pub fn steps(scene: &Bodies, request: &Asked) -> u64 {
    let control = Control::new(0);
    let output = run(scene, request, &mut Ticker::quiet(&control));
    assert!(output.is_ok(), "{output:?}");
    let mut tried = 0;
    if let Ok(output) = output {
        tried = output.outcomes.iter().map(|outcome| outcome.counts.steps + outcome.counts.rejected).sum();
        give_back(output.columns.position);
        give_back(output.columns.velocity);
    }
    tried
}

/// Scatters `events` projectiles into 180 bins of the angle.
pub fn scatter(events: u64) {
    let counted = Beam::coulomb(1.5, 2.0, (1.0, 4.0), 3.0).and_then(|beam| {
        let edges = beam.edges(Quantity::CmAngle, &Bins::Count(180))?;
        let control = Control::new(0);
        let asked = [Tally::new(vec![(Quantity::CmAngle, edges)])?];
        monte_carlo(&Mixture::of(beam), &asked, 1, 0, events, 1, &mut Ticker::quiet(&control))
    });
    assert!(counted.is_ok(), "{counted:?}");
}
