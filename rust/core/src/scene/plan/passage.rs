//! Whether equal steps bring a light body through the pericenter of its orbit at all.
//!
//! The one idea: a step that is too long there throws the body onto another orbit, of which no total energy knows. How long
//! that is depends on the method and the more on how eccentric the orbit is, since what is lost is a part of the energy at
//! the pericenter; so the method itself goes through one, from far out to far out, eight times with its nodes elsewhere.

use crate::error::Result;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::Method;
use crate::ode::state::State;
use crate::ode::stepper::stepper;
use crate::ode::system::{Form, Needs, System};
use crate::parallel::{Control, Ticker};
use core::f64::consts::TAU;

/// From so many steps in a turn at the pericenter on every method brings through what is bound at all.
const ENOUGH: f64 = 128.0;
/// By this part of itself the energy of the orbit changes where the body is lost.
const LOST: f64 = 0.2;
/// Of each method's order that counts, at most: coefficients are larger as the order is.
const ORDER: i32 = 8;
/// From this eccentric anomaly to that past the pericenter, or from so far out in pericenter distances.
const HALF_WAY: f64 = 2.0;
const FAR: f64 = 20.0;

/// How likely an orbit is to be lost, to be compared with others: the part of its energy that a step may make, less what the
/// method and all orbits have alike. None where it is not looked into.
pub(super) fn suspicion(method: &Method, eccentricity: f64, steps: f64) -> Option<f64> {
    let order = (method.order as i32).min(ORDER);
    (steps < ENOUGH && eccentricity < 1.0).then(|| 1.0 / ((1.0 - eccentricity) * steps.powi(order)))
}

/// So many steps in a turn on a circle through the pericenter as bring a body through so often, if these do not.
pub(super) fn fewest_steps(
    method: &'static Method,
    eccentricity: f64,
    steps: f64,
    passages: f64,
) -> Option<f64> {
    // What a symplectic method loses once it has back elsewhere.
    let times = if method.symplectic { 1.0 } else { passages.max(1.0) };
    let is_lost = |steps: f64| times * change(method, eccentricity, steps).unwrap_or(0.0) > LOST;
    if !is_lost(steps) {
        return None;
    }
    // To a fifth, which is all that is meant.
    let mut enough = steps;
    while is_lost(enough) && enough < ENOUGH {
        enough *= 1.2;
    }
    Some(enough.ceil())
}

/// By what part of itself the energy of the orbit is another after the pericenter, in the worst of eight passages.
fn change(method: &'static Method, e: f64, steps: f64) -> Result<f64> {
    // In units of the pericenter distance, and of the time in which a circle there turns by a radian.
    let (h, axis) = (TAU / steps, 1.0 / (1.0 - e));
    let furthest = ((1.0 - FAR / axis) / e).max(-1.0).acos().min(HALF_WAY);
    let before = axis * axis.sqrt() * (furthest - e * furthest.sin());
    let count = (2.0 * before / h).ceil() as u64;
    let mut state = State::new(&[Lanes::zero(); 2], &[Lanes::zero(); 2]);
    let ((q, _), (v, _)) = state.halves_mut();
    for lane in 0..WIDTH {
        // Later by an eighth of a step each.
        let mean = (-before + h * lane as f64 / WIDTH as f64) / (axis * axis.sqrt());
        let mut anomaly = -furthest;
        for _ in 0..8 {
            anomaly -= (anomaly - e * anomaly.sin() - mean) / (1.0 - e * anomaly.cos());
        }
        let minor = (1.0 - e * e).sqrt();
        let rate = axis.sqrt().recip() / (1.0 - e * anomaly.cos());
        q[0].0[lane] = axis * (anomaly.cos() - e);
        q[1].0[lane] = axis * minor * anomaly.sin();
        v[0].0[lane] = -rate * anomaly.sin();
        v[1].0[lane] = rate * minor * anomaly.cos();
    }
    let (mut system, control) = (Center, Control::new(0));
    let mut ticker = Ticker::quiet(&control);
    let mut stepper = stepper(method, h, &system, &state)?;
    let mut node = 0;
    while node < count {
        node += stepper.step(node, count - node, &mut state, &mut system, &mut ticker)?;
    }
    stepper.settle(&mut state);
    let energy = -0.5 / axis;
    let changed = |lane: usize| {
        let [x, y, u, w] = [state.q()[0], state.q()[1], state.v()[0], state.v()[1]].map(|of| of.0[lane]);
        let now = 0.5 * (u * u + w * w) - 1.0 / (x * x + y * y).sqrt();
        ((now - energy) / energy).abs()
    };
    // What is no number is lost altogether.
    let worse = |most: f64, changed: f64| if changed <= most { most } else { changed };
    let number = |changed: f64| if changed.is_nan() { f64::INFINITY } else { changed };
    Ok((0..WIDTH).map(|lane| number(changed(lane))).fold(0.0, worse))
}

/// The pull of a mass at rest, of one to a unit of length and time, in a plane.
struct Center;

impl System<Lanes> for Center {
    fn form(&self) -> Form {
        Form::SecondOrder(2)
    }
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn evaluations(&self) -> u64 {
        0
    }
    fn acceleration(
        &mut self,
        _: &Lanes,
        q: &[Lanes],
        _: &[Lanes],
        a: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let square = q[0] * q[0] + q[1] * q[1];
        let pull = -(square * square.sqrt());
        (a[0], a[1]) = (q[0] / pull, q[1] / pull);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::method;

    #[test]
    fn what_runs_lose_is_lost_and_what_they_bring_through_is_not() {
        // Of runs of massless bodies through one pericenter: energies off by more than themselves, and by less than a fifth.
        // Steps in a turn as fast as at the pericenter, which is √(1 + e) times as fast as a circle.
        for (name, e, loses, brings) in [
            ("leapfrog", 0.9, 2.0, 6.0),
            ("leapfrog", 0.99, 4.0, 8.0),
            ("leapfrog", 0.999, 5.0, 10.0),
            ("rk4", 0.9, 4.0, 8.0),
            ("rk4", 0.99, 6.0, 12.0),
            ("rk4", 0.999, 8.0, 24.0),
            ("stormer13", 0.9, 8.0, 14.0),
            ("stormer13", 0.99, 10.0, 16.0),
            ("midpoint", 0.99, 16.0, 40.0),
            ("yoshida8", 0.999, 5.0, 10.0),
        ] {
            let (method, speed) = (method(name).unwrap(), f64::sqrt(1.0 + e));
            let enough = fewest_steps(method, e, loses * speed, 1.0).unwrap();
            assert!(enough <= 1.25 * brings * speed + 1.0, "{name} {e}: {enough}");
            assert_eq!(fewest_steps(method, e, brings * speed, 1.0), None);
        }
        let [rk4, kahan_li8] = ["rk4", "kahan_li8"].map(|name| method(name).unwrap());
        assert!(change(kahan_li8, 0.99, 6.0).unwrap() < 0.1);
        // Of an orbit of e = 0.9 in 400 steps it loses 4 % each time.
        let steps = 400.0 * 0.1_f64.powf(1.5);
        assert_eq!(fewest_steps(rk4, 0.9, steps, 2.0), None);
        assert!(fewest_steps(rk4, 0.9, steps, 10.0).is_some());
    }
}
