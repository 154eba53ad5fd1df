//! Timings of the kernels: `cargo run --release -p visviva-benches [name]`.
//!
//! Minima over repeats, since the machine is noisy. `visviva-benches count` is for `benches/instructions.py`, which
//! counts instructions with callgrind.

mod cases;
mod count;

use cases::{Asked, Bodies, cluster, figure_eights, request, steps};
use std::time::Instant;

fn repeats() -> usize {
    std::env::var("VISVIVA_BENCH_REPEATS").ok().and_then(|text| text.parse().ok()).unwrap_or(7)
}

/// The least time of a run in nanoseconds.
fn time(scene: &Bodies, request: &Asked) -> f64 {
    (0..repeats())
        .map(|_| {
            let start = Instant::now();
            let _ = steps(scene, request);
            start.elapsed().as_secs_f64() * 1e9
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    if wanted == "count" {
        return count::count(std::env::args().skip(2));
    }
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
                time(&figure_eights(copies), &Asked { rtol: 1e-11, ..request(method, dt, vec![50.0], 1) });
            format!("{:.1} us per copy", all * 1e-3 / copies as f64)
        });
    }
    report("dop853/6", &|| {
        let scene = cluster(6, true);
        let all = time(&scene, &request("dop853", None, vec![20.0], 1));
        format!("{:.3} ms", all * 1e-6)
    });
}
