//! What a step keeps: the symplectic form, the way back, momentum and angular momentum.

use super::super::support::{Problem, advance, bodies, distance, exactly, henon_heiles, momenta};
use super::{Make, PROBLEMS};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::ode::{Method, Scheme};
use visviva_core::registry::METHODS;

/// `max |Mᵀ J M − J|` of one step of `h`, J weighted by the masses; M by central differences.
fn symplectic_defect(method: &'static Method, make: Make, h: f64) -> f64 {
    // The differences are wrong by ε² f''' ~ 1e-20 and by 1e-32 / ε = 1e-22.
    let epsilon = 1e-10;
    let n = make().mass.len();
    let moved = |index: usize, by: f64| {
        let Problem { mut state, mut dynamics, .. } = make();
        state.all_mut().0[index] += DoubleDouble::from(by);
        advance(method, h, 1, &mut state, &mut dynamics);
        let (y, rest) = state.all();
        y.iter().zip(rest).map(|(&y, &rest)| y + rest).collect::<Vec<_>>()
    };
    let columns: Vec<Vec<DoubleDouble>> = (0..2 * n)
        .map(|index| {
            let (plus, minus) = (moved(index, epsilon), moved(index, -epsilon));
            let two = DoubleDouble::from(2.0) * DoubleDouble::from(epsilon);
            plus.iter().zip(minus).map(|(&plus, minus)| (plus - minus) / two).collect()
        })
        .collect();
    let mass = make().mass;
    let mut worst = 0.0_f64;
    for i in 0..2 * n {
        for j in 0..2 * n {
            let mut form = DoubleDouble::default();
            for k in 0..n {
                let area = columns[i][k] * columns[j][n + k] - columns[i][n + k] * columns[j][k];
                form += DoubleDouble::from(mass[k]) * area;
            }
            let unit = if j == i + n {
                mass[i]
            } else if i == j + n {
                -mass[j]
            } else {
                0.0
            };
            worst = worst.max((form - DoubleDouble::from(unit)).to_f64().abs());
        }
    }
    worst
}

#[test]
fn symplectic_methods_keep_the_symplectic_form_and_the_others_do_not() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS.iter().filter(|method| method.has_table()) {
            let defect = symplectic_defect(method, make, 0.5);
            println!("{name}, {}: |MᵀJM − J| = {defect:.1e}", method.name);
            if method.symplectic {
                assert!(defect < 1e-17, "{name}, {}: {defect:e}", method.name);
            } else {
                // The least measured is 3.7e-10, of order 9: far above what the differences are wrong by.
                assert!(defect > 1e-12, "{name}, {} is symplectic after all: {defect:e}", method.name);
            }
        }
    }
}

#[test]
fn reversible_methods_return_and_the_others_do_not() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS.iter().filter(|method| method.has_table()) {
            let Problem { mut state, mut dynamics, .. } = make();
            let start = state.clone();
            advance(method, 0.5, 4, &mut state, &mut dynamics);
            assert!(distance(&state, &start) > 0.1);
            advance(method, -0.5, 4, &mut state, &mut dynamics);
            let missed = distance(&state, &start);
            println!("{name}, {}: returns within {missed:.1e}", method.name);
            if method.reversible {
                // The largest measured is 5.2e-27: compositions go far back and forth in these long steps.
                assert!(missed < 1e-25, "{name}, {}: {missed:e}", method.name);
            } else {
                // The least measured is 2.9e-10, of order 9.
                assert!(missed > 1e-15, "{name}, {} is reversible after all: {missed:e}", method.name);
            }
        }
    }
}

#[test]
fn reversible_methods_return_in_double_precision_too() {
    for method in METHODS.iter().filter(|method| method.reversible) {
        let Problem { mut state, mut dynamics, .. } = henon_heiles::<f64>();
        let start = exactly(&state);
        advance(method, 1.0 / 16.0, 1000, &mut state, &mut dynamics);
        advance(method, -1.0 / 16.0, 1000, &mut state, &mut dynamics);
        let missed = distance(&exactly(&state), &start);
        println!("{}: returns within {missed:.1e} after 2000 steps", method.name);
        assert!(missed < 1e-13, "{}: {missed:e}", method.name);
    }
}

/// Five unequal bodies in space, without symmetry, softened so that no close encounter magnifies the rounding.
/// Copies differ in the heaviest mass.
fn five_bodies(copy: u32) -> Problem<f64> {
    let mass = [1.0 + 1e-3 * f64::from(copy), 0.7, 0.4, 0.01, 1e-6];
    let q = [0.0, 2.0, -3.0, 5.0, -6.5, 0.0, 0.5, 1.0, -4.0, 4.0, 0.0, -0.25, 0.5, 1.0, -1.0];
    let v = [0.1, 0.2, -0.3, 0.3, -0.2, -0.2, 0.6, -0.5, 0.4, -0.4, 0.0, 0.1, -0.1, 0.1, 0.2];
    bodies(&mass, &q, &v, 0.5)
}

/// Largest drift of `Σ m v` and of `Σ m x × v` over the steps, relative to `Σ m |v|` and `Σ m |x| |v|` (about 1);
/// rms over eight copies, since rounding is a random walk and one walk may go twice as far as another.
fn drift(method: &'static Method, h: f64, steps: usize) -> [f64; 2] {
    let copies: Vec<[f64; 2]> = (0..8).map(|copy| drift_of(five_bodies(copy), method, h, steps)).collect();
    [0, 1].map(|index| (copies.iter().map(|drift| drift[index].powi(2)).sum::<f64>() / 8.0).sqrt())
}

fn drift_of(problem: Problem<f64>, method: &'static Method, h: f64, steps: usize) -> [f64; 2] {
    let Problem { mut state, mut dynamics, mass } = problem;
    let start = momenta(&exactly(&state), &mass);
    let mut worst = [0.0_f64; 2];
    for _ in 0..20 {
        advance(method, h, steps / 20, &mut state, &mut dynamics);
        for (index, (now, start)) in momenta(&exactly(&state), &mass).into_iter().zip(start).enumerate() {
            worst[index / 3] = worst[index / 3].max((now - start).to_f64().abs());
        }
    }
    worst
}

/// The sum of the magnitudes of what accelerations are weighed with in a step.
fn magnitude(method: &Method) -> f64 {
    let weights = match &method.scheme {
        Scheme::Splitting(table) | Scheme::NystromSplitting(table) | Scheme::Boris(table) => table.kicks,
        Scheme::RungeKutta(table) => table.b,
        Scheme::Embedded(table) => table.tableau.b,
        Scheme::Multistep(table) => table.start.b,
        Scheme::Taylor(_) => &[],
    };
    weights.iter().map(|weight| weight.to_f64().abs()).sum()
}

#[test]
fn momentum_is_kept_by_all_and_angular_momentum_by_the_symplectic() {
    for method in METHODS.iter().filter(|method| method.has_table()) {
        let [linear, angular] = drift(method, 1.0 / 16.0, 4000);
        println!("{}: momentum {linear:.1e}, angular momentum {angular:.1e}", method.name);
        // Measured 1e-16 to 1.7e-16; 4e-16 for yoshida8, whose kicks add up to 9 in magnitude, and 1e-15 for dop853 and
        // what it starts, whose weights add up to 13.
        let limit = 2e-16 * magnitude(method).max(2.0);
        assert!(linear < limit, "{}: {linear:e}", method.name);
        if method.symplectic {
            assert!(angular < 1e-14, "{}: {angular:e}", method.name);
        } else {
            assert!(drift(method, 0.25, 400)[1] > 1e-11, "{} keeps angular momentum after all", method.name);
        }
    }
}
