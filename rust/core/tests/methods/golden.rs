//! Textbook cases of single methods.

use super::super::support::{Problem, advance, harmonic};
use visviva_core::ode::Scheme;
use visviva_core::registry::METHODS;

fn golden(id: &str) -> serde_json::Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/golden.json");
    let cases: Vec<serde_json::Value> =
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    cases.into_iter().find(|case| case["id"] == id).unwrap()
}

#[test]
fn golden_oscillators() {
    for (id, name) in [("GI-verlet-oscillator", "leapfrog"), ("GI-rk4-oscillator", "rk4")] {
        let case = golden(id);
        let number = |group: &str, name: &str| case[group][name].as_f64().unwrap();
        let method = METHODS.iter().find(|method| method.name == name).unwrap();
        let Problem { mut state, mut dynamics, .. } = harmonic::<f64>();
        advance(method, number("inputs", "h"), number("inputs", "n") as usize, &mut state, &mut dynamics);
        let (x, v) = (state.q()[0], state.v()[0]);
        assert!((x - number("outputs", "x_n")).abs() < 5e-16, "{id}: {x}"); // measured 3.4e-16
        assert!((v - number("outputs", "v_n")).abs() < 5e-16, "{id}: {v}");
        if let Some(ratio) = case["outputs"]["energy_ratio"].as_f64() {
            assert!((v * v + x * x - ratio).abs() < 1e-15);
        }
        if let Some(energy) = case["outputs"]["H_mod"].as_f64() {
            let h = number("inputs", "h");
            assert!((0.5 * v * v + 0.5 * (1.0 - h * h / 4.0) * x * x - energy).abs() < 5e-16);
        }
    }
}

#[test]
fn golden_yoshida_coefficients() {
    let case = golden("GI-yoshida4");
    let Scheme::Splitting(table) = &METHODS.iter().find(|method| method.name == "yoshida4").unwrap().scheme
    else {
        panic!("yoshida4 is a splitting")
    };
    for (drift, name) in table.drifts.iter().zip(["w1", "w0", "w1"]) {
        assert_eq!(drift.to_f64(), case["outputs"][name].as_f64().unwrap());
    }
}
