use super::*;
use crate::potentials::parameters::Value;
use crate::registry::potential;

fn made(name: &str, values: &[f64]) -> Arc<dyn Potential> {
    let values: Vec<Value> = values.iter().map(|x| Value::Number(*x)).collect();
    potential(name).unwrap().build(&values).unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} {b}");
}

#[test]
fn lennard_jones_orbits_below_four_fifths() {
    // E_c = 4/5 at r = 5^(1/6); below it x = r⁻⁶ = (16 ∓ √(256 − 320 E))/80.
    let found = Landscape::new(&made("lennard_jones", &[1.0, 1.0]));
    assert_eq!(found.center(), Center::Repelling);
    let edge = found.stationary();
    assert_eq!(edge.len(), 1);
    close(edge[0], 5.0_f64.powf(1.0 / 6.0), 1e-15);
    assert!(found.critical_radii(0.81).is_empty());
    for energy in [0.1, 0.5, 0.79] {
        let radii = found.critical_radii(energy);
        assert_eq!(radii.len(), 2);
        for (r, sign) in radii.iter().zip([1.0, -1.0]) {
            let x: f64 = (16.0 + sign * f64::sqrt(256.0 - 320.0 * energy)) / 80.0;
            close(*r, x.powf(-1.0 / 6.0), 4e-15);
        }
    }
    // Below the barrier three turning points, above one.
    let radii = found.critical_radii(0.5);
    let barrier = radii[1]
        * radii[1]
        * (0.5 - found.field().give_energy(found.field().value(found.field().take_length(radii[1]))));
    for (share, count) in [(0.999, 1), (1.001, 3), (1.0 - 1e-14, 1), (1.0 + 1e-14, 3)] {
        let points = found.turning_points(0.5, DoubleDouble::from(barrier * share));
        assert_eq!(points.len(), count, "{share}");
        assert_eq!(points.last().unwrap().turn, Turn::Pericenter);
    }
}

#[test]
fn units_change_no_bit() {
    let near = Landscape::new(&made("lennard_jones", &[1.0, 1.5]));
    let units = |x: f64, e: i32| x * 2.0_f64.powi(e);
    let far = Landscape::new(&made("lennard_jones", &[units(1.0, -80), units(1.5, -33)]));
    let there = far.turning_points(units(-0.25, -80), DoubleDouble::from(units(0.5, -80 - 66)));
    let here = near.turning_points(-0.25, DoubleDouble::from(0.5));
    assert_eq!(here.len(), 2);
    for (a, b) in here.iter().zip(there) {
        assert_eq!(units(a.radius.high(), -33), b.radius.high());
    }
}

#[test]
fn ellipses_hyperbolas_and_falls() {
    // r² + r/E... of V = −1/r: E r² + r − l²/2 = 0.
    let found = Landscape::new(&made("coulomb", &[-1.0]));
    assert_eq!(found.center(), Center::Reached);
    for (energy, half) in
        [(-0.3, 0.5), (-1e-9, 0.5), (-1e-30, 1e-40), (-0.5, 0.5 - 1e-12), (0.7, 3.0), (0.0, 0.25)]
    {
        let points = found.turning_points(energy, DoubleDouble::from(half));
        let root = f64::sqrt(1.0 + 4.0 * energy * half);
        close(points[0].radius.to_f64(), 2.0 * half / (1.0 + root), 1e-9);
        assert_eq!(points.len(), if energy < 0.0 { 2 } else { 1 });
        for point in &points {
            let r = point.radius;
            let rest = DoubleDouble::from(energy) * r * r + r - DoubleDouble::from(half);
            assert!(rest.high().abs() <= 1e-28 * (half + r.high()), "{energy} {half} {rest:?}");
        }
    }
    let falls = Landscape::new(&made("power_law", &[-1.0, 2.0]));
    assert_eq!(falls.center(), Center::InverseSquare(1.0));
    assert_eq!(falls.open_ends(falls.radial(DoubleDouble::from(1.0), DoubleDouble::from(0.9))), (true, true));
    assert_eq!(
        falls.open_ends(falls.radial(DoubleDouble::from(1.0), DoubleDouble::from(1.1))),
        (false, true)
    );
    assert_eq!(
        falls.open_ends(falls.radial(DoubleDouble::from(-1.0), DoubleDouble::from(0.9))),
        (true, false)
    );
    let steep = Landscape::new(&made("power_law", &[-1.0, 4.0]));
    assert_eq!(steep.center(), Center::Attracting);
    assert_eq!(steep.turning_points(1.0, DoubleDouble::from(2.1)).len(), 2);
    assert_eq!(steep.turning_points(1.0, DoubleDouble::from(1.9)).len(), 0);
}

#[test]
fn jumps_turn() {
    let sphere = Landscape::new(&made("hard_sphere", &[2.0]));
    let points = sphere.turning_points(1.0, DoubleDouble::from(1.0));
    assert_eq!(points.len(), 1);
    assert!(points[0].jump && points[0].radius.to_f64() == 2.0);
    let points = sphere.turning_points(1.0, DoubleDouble::from(9.0));
    assert_eq!((points.len(), points[0].radius.to_f64(), points[0].jump), (1, 3.0, false));
    // −V₀ within 1: inside, r ≥ √(Λ/(E + V₀)); bound below zero.
    let well = Landscape::new(&made("square_well", &[3.0, 1.0]));
    let points = well.turning_points(-1.0, DoubleDouble::from(0.5));
    assert_eq!(points.len(), 2);
    close(points[0].radius.to_f64(), 0.5, 1e-15);
    assert!(points[1].jump && points[1].turn == Turn::Apocenter && points[1].radius.to_f64() == 1.0);
    // Above it, and not within: the edge lets nothing in where the step is climbed with Λ.
    let points = well.turning_points(1.0, DoubleDouble::from(4.5));
    assert_eq!((points.len(), points[0].jump), (1, false));
    let points = well.turning_points(1.0, DoubleDouble::from(2.0));
    assert_eq!(points.len(), 3);
}

#[test]
fn narrow_wells_far_out_are_seen() {
    // Morse of width 1/1000 at 1.
    let found = Landscape::new(&made("morse", &[1.0, 1000.0, 1.0]));
    let points = found.turning_points(-0.5, DoubleDouble::from(1e-9));
    assert_eq!(points.len(), 2);
    let x = f64::sqrt(0.5);
    close(points[0].radius.to_f64(), 1.0 - (1.0 + x).ln() / 1000.0, 1e-9);
    close(points[1].radius.to_f64(), 1.0 - (1.0 - x).ln() / 1000.0, 1e-9);
}

#[test]
fn a_root_that_is_a_number_is_found_at_once() {
    // 9/13 and 9/7, of which E is known to the last bit.
    let sum = [made("coulomb", &[-1.0]), made("power_law", &[-0.05, 2.0])];
    let points = Landscape::of(&sum).turning_points(-0.505_555_555_555_555_6, DoubleDouble::from(0.5));
    assert_eq!(points.len(), 2);
    close(points[0].radius.to_f64(), 9.0 / 13.0, 1e-15);
    close(points[1].radius.to_f64(), 9.0 / 7.0, 1e-15);
}
