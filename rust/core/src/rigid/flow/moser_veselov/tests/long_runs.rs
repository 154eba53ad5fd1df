//! What many steps leave: errors that are rounded to one side would add up.

use super::*;

#[test]
fn energy_and_momentum_stay() {
    for order in Order::ALL {
        let mut body = Body::new(order, MOMENTS, MOMENTUM);
        let before = body.energy(MOMENTS);
        for _ in 0..100_000 {
            assert!(body.step(0.1));
        }
        // A random walk of roundings of 0.3 rad: 300 of 3e-17. After 10^7 steps 7e-13 for order two, else 1e-15.
        assert!((body.energy(MOMENTS) / before - 1.0).abs() < 1e-14, "{order:?}");
        let [x, y, z, w] = body.q;
        assert!((x * x + y * y + z * z + w * w - 1.0).abs() <= 4.0 * f64::EPSILON);
    }
}

/// Nothing is rounded to one side, though moments and steps are round numbers: 200 000 steps walk by 1e-18 each, and five times
/// what that leaves is allowed. The products that lost their low parts made 4e-20 a step.
#[test]
fn energies_do_not_drift() {
    for order in [Order::Four, Order::Eight] {
        for spin in
            [MOMENTUM, [2.06, 0.37, -0.84], [1.7531622376021023, 0.4758697909214809, -1.0431639389190777]]
        {
            let mut body = Body::new(order, MOMENTS, spin);
            let energy = |body: &Body<f64>| {
                let all = core::array::from_fn(|c| {
                    DoubleDouble::from(body.q[c]) + DoubleDouble::from(body.q_low[c])
                });
                let own = turned_back(all, spin.map(DoubleDouble::from));
                (0..3).fold(DoubleDouble::from(0.0), |sum, c| {
                    sum + own[c] * own[c] / DoubleDouble::from(MOMENTS[c])
                })
            };
            let before = energy(&body);
            for _ in 0..200_000 {
                assert!(body.step(0.1));
            }
            let drift = (energy(&body) / before - DoubleDouble::from(1.0)).to_f64() / 2e5;
            assert!(drift.abs() <= 1.2e-20, "{order:?}, {spin:?}: {drift:e}");
        }
    }
}

#[test]
fn roundings_of_the_moments_do_not_add_up() {
    let mut sum = 0.0;
    let bodies =
        [MOMENTS, [0.3, 0.7, 0.9], [1.1, 0.7, 0.9], [0.7, 1.3, 1.7], [2.3, 1.9, 0.9], [0.9, 0.7, 1.3]];
    for moments in bodies {
        let wide = |numbers: [f64; 3]| numbers.map(DoubleDouble::from);
        let mut body = Body::new(Order::Four, moments, MOMENTUM);
        let mut reference = Body::new(Order::Four, wide(moments), wide(MOMENTUM));
        let h = 1.0 / 1024.0;
        for _ in 0..10_000 {
            assert!(body.step(h) && reference.step(DoubleDouble::from(h)));
        }
        let speed = over(MOMENTUM, moments).map(|part| part * part).iter().sum::<f64>().sqrt();
        sum += apart(reference.q.map(DoubleDouble::to_f64), body.q) / (speed * 10_000.0 * h * f64::EPSILON);
    }
    // A moment that is rounded, its inverse or a ratio makes about a quarter of ε of the whole angle.
    let mean = sum / bodies.len() as f64;
    assert!(mean < 0.12, "{mean}");
}
