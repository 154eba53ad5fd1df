//! Whole runs with several contacts at one instant, and mergers beside forces that ask for no mass.

use super::Collisions;
use crate::error::{Error, Result};
use crate::forces::term::ForceTerm;
use crate::forces::{driven_force, harmonic, linear_drag};
use crate::parallel::{Control, Ticker};
use crate::potentials::parameters::Value;
use crate::scene::Scene;
use crate::scene::request::Request;
use crate::scene::run::{Output, run};
use std::sync::Arc;

/// Balls of radius 1/2 and mass 1, those that come with their velocities and others at rest.
fn balls(position: &[[f64; 3]], coming: &[[f64; 3]], forces: Vec<Arc<dyn ForceTerm>>) -> Scene {
    let count = position.len();
    let mut velocity = coming.to_vec();
    velocity.resize(count, [0.0; 3]);
    Scene {
        copies: 1,
        particles: count,
        mass: vec![1.0; count],
        position: position.to_vec(),
        velocity,
        forces,
        own_forces: None,
        radius: vec![0.5; count],
        rigid: None,
        t0: 0.0,
        t0_rest: 0.0,
        continuation: None,
    }
}

fn collided(scene: &Scene, rule: Collisions, end: f64) -> Result<Output> {
    let control = Control::default();
    let request = Request {
        times: vec![end],
        method: "auto".to_owned(),
        dt: None,
        time_transformation: None,
        rtol: 1e-9,
        rtol_given: true,
        atol: None,
        max_step: None,
        first_step: None,
        max_steps: None,
        record: Vec::new(),
        events: Vec::new(),
        collisions: Some(rule),
        threads: 1,
    };
    run(scene, &request, &mut Ticker::quiet(&control))
}

fn near(found: [f64; 3], wanted: [f64; 3], by: f64) -> bool {
    (0..3).all(|c| (found[c] - wanted[c]).abs() <= by)
}

#[test]
fn two_balls_at_once_get_the_same_whatever_their_numbers_are() -> Result<()> {
    let places = [[-3.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -0.5, 0.0]];
    let root = 3.0_f64.sqrt();
    let wanted = [[-0.2, 0.0, 0.0], [0.6, 0.2 * root, 0.0], [0.6, -0.2 * root, 0.0]];
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mut scene = balls(&order.map(|body| places[body]), &[], Vec::new());
        for (place, &body) in order.iter().enumerate() {
            scene.velocity[place] = [if body == 0 { 1.0 } else { 0.0 }, 0.0, 0.0];
        }
        let output = collided(&scene, Collisions::Bounce(1.0), 10.0)?;
        for (place, &body) in order.iter().enumerate() {
            let found = output.reached.velocity[place];
            assert!(near(found, wanted[body], 1e-14), "{order:?}: {found:?}");
        }
        let lines = output.collisions.map_or(0, |collided| collided.table.lines.len());
        assert_eq!(lines, 2);
    }
    Ok(())
}

#[test]
fn a_break_is_its_own_mirror_image() -> Result<()> {
    for (rows, restitution) in [(2, 1.0), (3, 1.0), (4, 1.0), (4, 0.6), (5, 1.0)] {
        let mut position = vec![[-3.0, 0.0, 0.0]];
        for row in 0..rows {
            for column in 0..=row {
                let (x, y) = (0.75_f64.sqrt() * f64::from(row), f64::from(column) - 0.5 * f64::from(row));
                position.push([x, y, 0.0]);
            }
        }
        let scene = balls(&position, &[[1.0, 0.0, 0.0]], Vec::new());
        let output = collided(&scene, Collisions::Bounce(restitution), 8.0)?;
        let (x, v) = (&output.reached.position, &output.reached.velocity);
        for (place, own) in x.iter().zip(v) {
            let mirrored = |of: &[f64; 3]| [of[0], -of[1], of[2]];
            let image = x.iter().position(|other| near(*other, mirrored(place), 1e-9));
            assert!(image.is_some_and(|image| near(v[image], mirrored(own), 1e-9)), "{rows} rows: {place:?}");
        }
        let momentum: f64 = v.iter().map(|v| v[0]).sum();
        assert!((momentum - 1.0).abs() < 1e-13);
        let energy: f64 = v.iter().flatten().map(|v| 0.5 * v * v).sum();
        let lost = output
            .collisions
            .map_or(0.0, |collided| collided.table.lines.iter().map(|line| line.energy_lost).sum::<f64>());
        assert!((energy + lost - 0.5).abs() < 1e-13, "{energy} and {lost}");
    }
    Ok(())
}

#[test]
fn as_many_balls_leave_a_row_as_came() -> Result<()> {
    for coming in 1..4_usize {
        let position: Vec<[f64; 3]> = (0..5_u8)
            .map(|k| [f64::from(k) - if usize::from(k) < coming { 3.0 } else { 0.0 }, 0.0, 0.0])
            .collect();
        let scene = balls(&position, &vec![[1.0, 0.0, 0.0]; coming], Vec::new());
        let output = collided(&scene, Collisions::Bounce(1.0), 8.0)?;
        for (body, v) in output.reached.velocity.iter().enumerate() {
            let wanted = if body < 5 - coming { 0.0 } else { 1.0 };
            assert!(near(*v, [wanted, 0.0, 0.0], 1e-13), "{coming}: {v:?}");
        }
    }
    Ok(())
}

#[test]
fn mergers_beside_forces_that_ask_for_no_mass_are_refused() -> Result<()> {
    let spring = harmonic::DECLARATION.build(&[Value::Number(1.0), Value::Vector([0.0; 3])])?;
    let drive = driven_force::DECLARATION.build(&[
        Value::Vector([0.0, 1.0, 0.0]),
        Value::Number(0.0),
        Value::Number(0.0),
    ])?;
    let drag = linear_drag::DECLARATION.build(&[Value::Number(2.0)])?;
    let places = [[0.0; 3], [3.0, 0.0, 0.0]];
    let coming = [[1.0, 0.0, 0.0]];
    for force in [spring, drive] {
        let scene = balls(&places, &coming, vec![drag.clone(), force]);
        let refused = collided(&scene, Collisions::Merge, 6.0);
        assert!(matches!(refused, Err(Error::InvalidInput { argument, .. }) if argument == "collisions"));
        let _ = collided(&scene, Collisions::Bounce(1.0), 0.5)?;
    }
    let output = collided(&balls(&places, &coming, vec![drag]), Collisions::Merge, 6.0)?;
    assert_eq!(output.outcomes.len(), 1);
    Ok(())
}
