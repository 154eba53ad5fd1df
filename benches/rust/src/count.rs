//! Cases whose instructions are counted: `benches/instructions.py` runs each at two sizes under callgrind, and what the
//! larger takes more, per unit of work, is what a step (an output, an event) costs, without what it takes to begin.

use crate::cases::{
    Bodies, around_a_center, cluster, figure_eights, free, methods, request, scatter, soft_cluster, steps,
};

/// What makes a scene.
type Make = fn() -> Bodies;

/// A case: its name, the smaller and the larger size, and what runs it and tells the units of work done.
pub struct Case {
    name: String,
    sizes: (u64, u64),
    run: Box<dyn Fn(u64) -> u64>,
}

fn case(name: String, sizes: (u64, u64), run: impl Fn(u64) -> u64 + 'static) -> Case {
    Case { name, sizes, run: Box::new(run) }
}

const STEP: f64 = 1.0 / 1024.0;

/// `size` steps of a method; one that chooses its own goes that far in units of a quarter.
fn stepping(name: String, method: &'static str, adaptive: bool, sizes: (u64, u64), scene: Bodies) -> Case {
    case(name, sizes, move |size| {
        let (dt, end) = if adaptive { (None, size as f64 * 0.25) } else { (Some(STEP), size as f64 * STEP) };
        steps(&scene, &request(method, dt, vec![end], 1))
    })
}

fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for (method, adaptive) in methods() {
        // An adaptive step of dop853 is some fifty times longer than the fixed one.
        let long = if adaptive { (4, 24) } else { (1000, 5000) };
        let short = if adaptive { (1, 4) } else { (60, 160) };
        for particles in [2, 3, 6] {
            let scene = soft_cluster(particles, particles);
            cases.push(stepping(format!("step/{method}/{particles}"), method, adaptive, long, scene));
        }
        for particles in [20, 100] {
            let scene = soft_cluster(particles, particles);
            cases.push(stepping(format!("step/{method}/{particles}"), method, adaptive, short, scene));
        }
        let scene = soft_cluster(45, 5);
        cases.push(stepping(format!("massless/{method}/5+40"), method, adaptive, short, scene));
        let scene = around_a_center(64);
        cases.push(stepping(format!("center/{method}/64"), method, adaptive, short, scene));
        let scene = figure_eights(64);
        cases.push(stepping(format!("members/{method}/64"), method, adaptive, short, scene));
    }
    cases.push(stepping("gravity/leapfrog/1024".to_owned(), "leapfrog", false, (2, 6), cluster(1024, false)));
    for every in [2u64, 10] {
        cases.push(case(format!("outputs/leapfrog/6/every={every}"), (2000, 8000), move |size| {
            let times = (0..=size / every).map(|i| (i * every) as f64 * STEP).collect();
            steps(&soft_cluster(6, 6), &request("leapfrog", Some(STEP), times, 1))
        }));
    }
    let closed: [(&str, Make); 3] =
        [("free/8", || free(8, false)), ("uniform/8", || free(8, true)), ("kepler/2", || cluster(2, true))];
    for (name, scene) in closed {
        cases.push(case(format!("closed/{name}"), (1000, 5000), move |size| {
            let times = (0..size).map(|i| i as f64 * 0.01).collect();
            let _ = steps(&scene(), &request("auto", None, times, 1));
            size
        }));
    }
    for (name, column) in [("energy", "energy"), ("momenta", "angular_momentum")] {
        cases.push(case(format!("column/{name}/9"), (500, 2500), move |size| {
            let times = (0..size).map(|i| i as f64 * STEP).collect();
            let mut asked = request("leapfrog", Some(STEP), times, 1);
            asked.record = vec![column.to_owned()];
            steps(&soft_cluster(9, 9), &asked)
        }));
    }
    cases.push(case("monte_carlo/cm_angle".to_owned(), (200_000, 1_000_000), |size| {
        scatter(size);
        size
    }));
    cases
}

/// Without a name lists the cases with their sizes; with one runs it and prints the units of work done.
pub fn count(mut arguments: impl Iterator<Item = String>) {
    let (name, size) = (arguments.next(), arguments.next().and_then(|size| size.parse().ok()));
    for case in all() {
        match (&name, size) {
            (Some(name), Some(size)) if *name == case.name => println!("{}", (case.run)(size)),
            (Some(_), _) => {}
            (None, _) => println!("{} {} {}", case.name, case.sizes.0, case.sizes.1),
        }
    }
}
