use super::*;
use core::f64::consts::PI;
use proptest::prelude::*;

/// m₁ + m₂ → m₃ + m₄ with decades between masses and any Q that the energy allows.
fn reactions() -> impl Strategy<Value = (Reaction, Encounter, [f64; 4], f64)> {
    (-6.0..6.0f64, -0.5..0.5f64, -2.0..2.0f64, any::<bool>()).prop_map(|(ratio, changed, q, change)| {
        let (m1, m2) = (10.0_f64.powf(ratio), 1.0);
        let (m3, m4) = if change { (m1 + changed * m1.min(m2), m2 - changed * m1.min(m2)) } else { (m1, m2) };
        let share = (m3 + m4 - m1) / (m3 + m4);
        let q = if q < 0.0 { 0.5 * q * share } else { q };
        let reaction = Reaction::new((m1, m2), (m3, m4), q).unwrap();
        (reaction, reaction.at(1.0).unwrap(), [m1, m2, m3, m4], q)
    })
}

proptest! {
    #[test]
    fn energy_and_momentum_are_those_of_the_beam((_, encounter, masses, q) in reactions(), psi in 0.0..PI) {
        let half = HalfAngle::of(psi);
        let [m1, _, m3, m4] = masses;
        let (mine, theirs) = (encounter.projectile(), encounter.target());
        let (e3, e4) = (mine.energy(half), theirs.energy(half.mirrored()));
        prop_assert!((e3 + e4 - 1.0 - q).abs() < 4e-15 * (1.0 + q.abs()), "{e3} {e4}");
        // Momenta √(m E), in units of the beam's.
        let (p3, p4) = ((m3 / m1).sqrt(), (m4 / m1).sqrt());
        let velocity = |product: &Product, half: HalfAngle| {
            let (along, across) = product.circle().velocity(half);
            let unit = product.ahead.sqrt() / product.circle().fast;
            (unit * along, unit * across)
        };
        let (a3, a4) = (velocity(mine, half), velocity(theirs, half.mirrored()));
        let size = 1.0 + p3 * e3.sqrt() + p4 * e4.sqrt();
        prop_assert!((p3 * a3.0 + p4 * a4.0 - 1.0).abs() < 4e-15 * size, "{a3:?} {a4:?}");
        prop_assert!((p3 * a3.1 - p4 * a4.1).abs() < 4e-15 * size);
        prop_assert!((a3.0 * a3.0 + a3.1 * a3.1 - e3).abs() < 8e-15 * (mine.ahead + mine.back));
        let opening = mine.circle().lab_angle(half) + theirs.circle().lab_angle(half.mirrored());
        // Angles near π are known to 4e-16 of π only, and where one body hardly moves, to that over its speed.
        let slowest = (e3.min(e4) / (1.0 + q.abs())).sqrt().max(1e-12);
        prop_assert!((encounter.opening_angle(half) - opening).abs() < 1e-14 / slowest.min(0.1), "{opening}");
    }
    #[test]
    fn angles_lead_back((_, encounter, ..) in reactions(), psi in 0.01..3.13f64) {
        let half = HalfAngle::of(psi);
        for (product, half) in [(encounter.projectile(), half), (encounter.target(), half.mirrored())] {
            let circle = product.circle();
            let (angle, jacobian) = (circle.lab_angle(half), circle.jacobian(half));
            prop_assert!(angle <= circle.greatest_angle() * (1.0 + 1e-15));
            let branches = circle.branches(angle);
            // Ill-conditioned by dψ/dθ, which grows as the root of the jacobian and without bound at the edge.
            let found = branches.iter().flatten().find(|found| (found.0 - half.cm_angle()).abs() < 1e-6);
            if jacobian < 1e5 && jacobian > 1e-5 {
                let found = found.expect("a branch");
                // Near the greatest angle it goes as the inverse root of the distance from there, which ε of the angle changes.
                let known = 1e-9 + 4.0 * f64::EPSILON * jacobian * jacobian;
                prop_assert!((found.1 / jacobian - 1.0).abs() < known, "{} {jacobian}", found.1);
                let energies = product.energies(angle.min(circle.greatest_angle())).unwrap();
                let energy = product.energy(half);
                let nearest = energies.iter().flatten().map(|e| (e - energy).abs()).fold(9e99, f64::min);
                prop_assert!(nearest < 1e-9 * product.ahead.max(product.back), "{nearest:e}");
            }
        }
    }
}

/// Against numbers of a 7-digit table: m₁ = 1, m₂ = 4, Q = -1.
#[test]
fn an_endoergic_collision_has_two_branches_below_four_thirds() {
    let reaction = Reaction::new((1.0, 4.0), (1.0, 4.0), -1.0).unwrap();
    assert_eq!((reaction.threshold(), reaction.turning_energy()), (1.25, Some(4.0 / 3.0)));
    let greatest = |energy| reaction.at(energy).unwrap().projectile().circle().greatest_angle();
    assert!((greatest(1.26).to_degrees() - 20.876_102_6).abs() < 5e-8);
    assert_eq!(greatest(1.25), 0.0);
    assert_eq!(greatest(1.334), PI);
    assert!(reaction.at(1.249_999).is_err());
}

#[test]
fn a_small_q_is_next_to_none() {
    let elastic = Encounter::elastic(Collision::new(3.0, 3.0).unwrap());
    for q in [1e-300, -1e-300, 1e-30, -1e-20] {
        let almost = Reaction::new((3.0, 3.0), (3.0, 3.0), q).unwrap().at(1.0).unwrap();
        for psi in [0.0, 1e-200, 1e-8, 1.0, 3.0] {
            let half = HalfAngle::of(psi);
            let difference =
                almost.projectile().circle().lab_angle(half) - elastic.projectile().circle().lab_angle(half);
            assert!(difference.abs() <= 2e-16 * psi, "{q} {psi} {difference}");
            let (mine, theirs) = (almost.opening_angle(half), elastic.opening_angle(half));
            // The target of a forward collision is at rest: a Q that is not nothing decides where it goes.
            assert!(psi < 1e-7 || (mine - theirs).abs() < 1e-12, "{q} {psi} {mine} {theirs}");
        }
    }
}
