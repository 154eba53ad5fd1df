//! No step allocates: scratch is made once per run.
//!
//! The allocator counts, for each thread by itself: a test is one.

use super::support::{Problem, five_lanes, fixed_stepper, henon_heiles, three_bodies};
use core::cell::Cell;
use std::alloc::{GlobalAlloc, Layout, System};
use visviva_core::forces::Dynamics;
use visviva_core::forces::gravity::Tiles;
use visviva_core::forces::gravity::closed::ClosedKernel;
use visviva_core::numerics::element::Shape;
use visviva_core::numerics::lanes::Lanes;
use visviva_core::numerics::real::{Mask, Real};
use visviva_core::ode::state::State;
use visviva_core::ode::step_control::Controlled;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: everything is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn allocations(work: impl FnOnce()) -> u64 {
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
}

fn fixed<S: ClosedKernel>(problem: Problem<S>) -> Vec<(&'static str, u64)> {
    let Problem { state, mut dynamics, .. } = problem;
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    METHODS
        .iter()
        .filter(|method| method.has_table())
        .map(|method| {
            let mut state = state.clone();
            let mut stepper = fixed_stepper(method, 1.0 / 64.0, &dynamics, &state);
            let count = allocations(|| {
                for node in 0..10 {
                    assert_eq!(stepper.step(node, 1, &mut state, &mut dynamics, &mut ticker), Ok(1));
                }
            });
            (method.name, count)
        })
        .collect()
}

fn adaptive<S: Controlled + ClosedKernel>(problem: Problem<S>) -> Vec<(&'static str, u64)> {
    let Problem { mut state, mut dynamics, .. } = problem;
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut counts = Vec::new();
    for method in METHODS {
        if !method.adaptive() {
            continue;
        }
        let mut between = state.clone();
        let (mut trial, mut clock, norm) =
            super::support::adaptive(method, &dynamics, dynamics.shape, &state, 1e-9, 1e3);
        let all = S::Mask::splat(true);
        trial.start(all, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
        // What looks between steps is made at the first look, once.
        let mut steps = |count: u64| {
            for _ in 0..count {
                let outcome =
                    trial.attempt(all, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
                trial.dense(&outcome, &mut dynamics, &state, &mut ticker).unwrap();
                trial.at(&outcome, &mut dynamics, &state, S::splat(0.5), &mut between, &mut ticker).unwrap();
                trial.keep(outcome.accepted, &mut state);
            }
        };
        steps(1);
        let count = allocations(|| steps(10));
        counts.push((method.name, count));
    }
    counts
}

/// Twenty massive bodies and two hundred massless ones, on one thread.
fn swarm() -> Problem<Lanes> {
    let shape = Shape { rows: 3 + 25, components: 3 };
    let q: Vec<Lanes> =
        (0..shape.len()).map(|k| Lanes(core::array::from_fn(|lane| (8 * k + lane) as f64))).collect();
    let v = vec![Lanes::zero(); shape.len()];
    Problem {
        dynamics: Dynamics::new(shape, vec![Box::new(Tiles::new(shape, &[1.0; 20], 0.1, 1))]),
        state: State::new(&q, &v),
        mass: Vec::new(),
    }
}

#[test]
fn no_step_allocates() {
    assert_eq!(allocations(|| drop(vec![0_u8; 10])), 1, "the count counts");
    let counts = [
        fixed(henon_heiles::<f64>()),
        fixed(three_bodies::<f64>()),
        fixed(five_lanes()),
        fixed(swarm()),
        adaptive(three_bodies::<f64>()),
        adaptive::<Lanes>(five_lanes()),
    ];
    for (method, count) in counts.into_iter().flatten() {
        assert_eq!(count, 0, "{method} allocates");
    }
}
