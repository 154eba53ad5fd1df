//! Every method of the registry, held to what it declares about itself.
//!
//! Register a method and it is tested here; nothing below knows any method by name but the golden cases.

mod adaptive;
mod closed;
mod fixed;
mod golden;
mod order;
mod structure;
mod taylor;

use super::support::{Problem, advance, henon_heiles, three_bodies};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::ode::state::State;
use visviva_core::registry::METHODS;

type Make = fn() -> Problem<DoubleDouble>;
const PROBLEMS: [(&str, Make, f64); 2] = [
    ("Hénon–Heiles", henon_heiles::<DoubleDouble>, 2.0),
    ("three bodies", three_bodies::<DoubleDouble>, 0.75),
];

/// The state at `t`, by the tableau of highest order with a step far below what the tests use.
fn reference(make: Make, t: f64, steps: usize) -> State<DoubleDouble> {
    let method = METHODS.iter().filter(|method| method.has_table());
    let method = method.max_by_key(|method| (method.order, method.adaptive())).unwrap();
    let Problem { mut state, mut dynamics, .. } = make();
    advance(method, t / steps as f64, steps, &mut state, &mut dynamics);
    state
}
