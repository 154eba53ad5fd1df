//! Timings of the kernels: `cargo run --release -p visviva-benches [name]`.
//!
//! Minima over repeats, since the machine is noisy. Under `valgrind --tool=callgrind` with one repeat
//! (`VISVIVA_BENCH_REPEATS=1`) the same program counts instructions.

use std::sync::Arc;
use std::time::Instant;
use visviva_core::forces::gravity::newton::Gravity;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::scene::Scene;
use visviva_core::scene::request::Request;
use visviva_core::scene::room::give_back;
use visviva_core::scene::run::run;

fn repeats() -> usize {
    std::env::var("VISVIVA_BENCH_REPEATS").ok().and_then(|text| text.parse().ok()).unwrap_or(7)
}

/// A reproducible number in [-1, 1).
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// `particles` bodies of equal mass in a cube; a heavy one in the middle if `solar`.
fn cluster(particles: usize, solar: bool) -> Scene {
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
    Scene {
        copies: 1,
        particles,
        mass,
        position,
        velocity,
        forces: vec![Arc::new(Gravity::new(1.0, if solar { 0.0 } else { 0.01 }))],
        t0: 0.0,
    }
}

/// Perturbed copies of the figure-eight of three equal bodies (Chenciner & Montgomery).
fn figure_eights(copies: usize) -> Scene {
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
        forces: vec![Arc::new(Gravity::new(1.0, 0.0))],
        t0: 0.0,
    }
}

fn request(method: &str, dt: Option<f64>, times: Vec<f64>, threads: usize) -> Request {
    Request {
        times,
        method: method.to_owned(),
        dt,
        rtol: 1e-13,
        atol: None,
        max_step: None,
        max_steps: None,
        record: vec!["position".to_owned(), "velocity".to_owned()],
        threads,
    }
}

/// The least time of a run in nanoseconds.
fn time(scene: &Scene, request: &Request) -> f64 {
    let control = Control::new(0);
    (0..repeats())
        .map(|_| {
            let start = Instant::now();
            let output = run(scene, request, &mut Ticker::quiet(&control));
            let elapsed = start.elapsed().as_secs_f64() * 1e9;
            assert!(output.is_ok(), "{output:?}");
            if let Ok(output) = output {
                give_back(output.columns.position);
                give_back(output.columns.velocity);
            }
            elapsed
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let report = |name: &str, line: &dyn Fn() -> String| {
        if name.contains(&wanted) {
            println!("{name:34} {}", line());
        }
    };
    for (particles, threads) in [(1024, 1), (4096, 1), (4096, 2)] {
        report(&format!("gravity/{particles}/threads={threads}"), &|| {
            let scene = cluster(particles, false);
            let steps = 4096 / particles * 4;
            let run = |steps: usize| {
                time(&scene, &request("leapfrog", Some(1e-6), vec![steps as f64 * 1e-6], threads))
            };
            let per_step = (run(3 * steps) - run(steps)) / (2 * steps) as f64;
            format!("{:.3} ns per ordered pair", per_step / (particles * (particles - 1)) as f64)
        });
    }
    for method in ["leapfrog", "yoshida4", "kahan_li8", "rk4", "stormer13"] {
        report(&format!("step/{method}/6"), &|| {
            let scene = cluster(6, true);
            let steps = 100_000.0;
            let all = time(&scene, &request(method, Some(1e-5), vec![steps * 1e-5], 1));
            format!("{:.1} ns per step", all / steps)
        });
    }
    for every in [10, 2] {
        report(&format!("outputs/leapfrog/6/every={every}"), &|| {
            let scene = cluster(6, true);
            let steps = 100_000usize;
            let none = time(&scene, &request("leapfrog", Some(1e-5), vec![steps as f64 * 1e-5], 1));
            let times = (0..=steps / every).map(|i| (i * every) as f64 * 1e-5).collect();
            let some = time(&scene, &request("leapfrog", Some(1e-5), times, 1));
            format!("{:.3} x", some / none)
        });
    }
    for (method, dt) in [("kahan_li8", Some(0.0625)), ("stormer13", Some(0.0215)), ("dop853", None)] {
        report(&format!("ensemble/figure_eight/{method}"), &|| {
            let copies = 512;
            let all =
                time(&figure_eights(copies), &Request { rtol: 1e-11, ..request(method, dt, vec![50.0], 1) });
            format!("{:.1} us per copy", all * 1e-3 / copies as f64)
        });
    }
    report("dop853/6", &|| {
        let scene = cluster(6, true);
        let all = time(&scene, &request("dop853", None, vec![20.0], 1));
        format!("{:.3} ms", all * 1e-6)
    });
}
