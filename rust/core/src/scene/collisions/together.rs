//! Spheres that meet at one instant, one of them more than one other: impulses that do not depend on who is asked first.
//!
//! Those that approach fastest go first. Where several do, equally fast, and share bodies, none is first: the impulses are
//! those together that bring all of these contacts to rest along their lines (the projection of the velocities, in the
//! metric of the masses, onto those with which nobody approaches), and with restitution 1 + e times as much. So a scene
//! that is its own mirror image stays that. J. J. Moreau, *Unilateral contact and dry friction in finite freedom
//! dynamics*, in Nonsmooth Mechanics and Applications (Springer, 1988), §8; the projection by sweeps over the contacts as
//! M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235, and at once ([`AtRest`]) where they come to no end.

use super::at_rest::AtRest;
use super::impact::Meeting;
use super::{CONTACT, Collision, Impact};

/// Sweeps over the contacts, each of which brings impulses nearer to rest by a factor; energy is exact after any number.
const SWEEPS: usize = 4096;

/// A contact among others.
struct Contact {
    /// Its bodies, by their places among those that take part.
    places: [usize; 2],
    meeting: Meeting,
    /// By how much its impulse changes the speed with which the two approach, in units of the fastest.
    change: f64,
}

impl Impact {
    /// Of pairs in contact, the one that approaches fastest (of equal ones the first) and those that approach as fast
    /// and share bodies with it, or with one that does.
    pub fn fastest(&self, touching: &[(usize, usize)]) -> Vec<(usize, usize)> {
        let speeds: Vec<f64> =
            touching.iter().map(|&pair| self.approach(pair).unwrap_or(f64::NEG_INFINITY)).collect();
        let largest = speeds.iter().fold(f64::NEG_INFINITY, |most, &speed| most.max(speed));
        let mut others: Vec<(usize, usize)> = (touching.iter().zip(&speeds))
            .filter(|&(_, &speed)| speed > 0.0 && speed >= largest * (1.0 - CONTACT))
            .map(|(&pair, _)| pair)
            .collect();
        let first = speeds.iter().position(|&speed| speed > 0.0 && speed == largest);
        let Some(first) = first.map(|place| touching[place]) else { return Vec::new() };
        let mut together = vec![first];
        others.retain(|&pair| pair != first);
        let meet =
            |a: &(usize, usize), b: &(usize, usize)| a.0 == b.0 || a.0 == b.1 || a.1 == b.0 || a.1 == b.1;
        while let Some(next) = others.iter().position(|other| together.iter().any(|pair| meet(pair, other))) {
            together.push(others.remove(next));
        }
        together.sort_unstable();
        together
    }

    /// They bounce together; the collisions, each with how fast its two part.
    pub fn bounce_together(
        &mut self,
        pairs: &[(usize, usize)],
        restitution: f64,
        t: f64,
    ) -> Vec<(Collision, f64)> {
        if let &[pair] = pairs {
            return vec![self.bounce(pair, restitution, t)];
        }
        let mut bodies: Vec<usize> = pairs.iter().flat_map(|&(i, j)| [i, j]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let place = |body: usize| bodies.binary_search(&body).unwrap_or_default();
        let mut contacts: Vec<Contact> = pairs
            .iter()
            .map(|&(i, j)| Contact { places: [place(i), place(j)], meeting: self.meeting(i, j), change: 0.0 })
            .collect();
        let fastest = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.meeting.speed));
        let mut moved = vec![[0.0; 3]; bodies.len()];
        if !rest(&mut contacts, &mut moved, fastest) {
            let masses: Vec<f64> = bodies.iter().map(|&body| self.mass[body]).collect();
            let meetings: Vec<([usize; 2], &Meeting)> =
                contacts.iter().map(|contact| (contact.places, &contact.meeting)).collect();
            if let Some(found) = AtRest::of(&meetings, &masses, fastest) {
                moved = found.moved;
                for (contact, change) in contacts.iter_mut().zip(found.changes) {
                    contact.change = change;
                }
            }
        }
        // What all impulses together are short of keeping the energy by, with restitution 1: nothing but what the sweeps
        // have left.
        let largest = bodies.iter().fold(0.0_f64, |most, &body| most.max(self.mass[body]));
        let (mut work, mut energy) = (0.0, 0.0);
        for contact in &contacts {
            let reduced = contact.meeting.reduced / largest;
            work += reduced * contact.change * (contact.meeting.speed / fastest);
        }
        for (&body, by) in bodies.iter().zip(&moved) {
            energy += self.mass[body] / largest * by.iter().map(|v| v * v).sum::<f64>();
        }
        let exact = if work > 0.0 && energy > 0.0 { work / energy } else { 1.0 };
        let lost = (1.0 - restitution) * (1.0 + restitution);
        let collisions: Vec<Collision> = (pairs.iter().zip(&contacts))
            .map(|(&pair, contact)| {
                let speed = contact.meeting.speed;
                let energy_lost =
                    0.5 * contact.meeting.reduced * (exact * contact.change * fastest) * speed * lost;
                Collision { energy_lost, ..self.collision(pair, t, &contact.meeting) }
            })
            .collect();
        let change = (1.0 + restitution) * exact * fastest * self.direction;
        for (&body, by) in bodies.iter().zip(&moved) {
            for c in 0..3 {
                self.velocity[body][c] += change * by[c];
            }
        }
        let parting = pairs.iter().map(|&(i, j)| (-self.meeting(i, j).speed).max(0.0));
        collisions.into_iter().zip(parting).collect()
    }
}

/// The impulses that bring contacts to rest, none of which pulls: changes of velocities along the run, in units of the
/// fastest; whether sweeps came to an end of it.
fn rest(contacts: &mut [Contact], moved: &mut [[f64; 3]], fastest: f64) -> bool {
    for _ in 0..SWEEPS {
        let mut most = 0.0_f64;
        for contact in &mut *contacts {
            let ([i, j], meeting) = (contact.places, &contact.meeting);
            let away: f64 = (0..3).map(|c| meeting.normal[c] * (moved[j][c] - moved[i][c])).sum();
            let change = (contact.change + (meeting.speed / fastest - away)).max(0.0);
            let more = change - contact.change;
            for c in 0..3 {
                moved[i][c] -= meeting.shares[0] * more * meeting.normal[c];
                moved[j][c] += meeting.shares[1] * more * meeting.normal[c];
            }
            contact.change = change;
            most = most.max(more.abs());
        }
        if most <= f64::EPSILON {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A ball flies into others that it reaches at one instant and that are at rest, or come along its way.
    fn met(around: &[[f64; 3]], mass: &[f64], velocity: &[[f64; 3]]) -> Impact {
        let mut position = vec![[0.0; 3]];
        position.extend(around);
        let count = position.len();
        Impact {
            mass: mass.to_vec(),
            radius: vec![0.5; count],
            position,
            velocity: velocity.to_vec(),
            host: (0..count).collect(),
            direction: 1.0,
        }
    }

    fn energy(bodies: &Impact) -> f64 {
        let square = |v: &[f64; 3]| v.iter().map(|v| v * v).sum::<f64>();
        bodies.mass.iter().zip(&bodies.velocity).map(|(m, v)| 0.5 * m * square(v)).sum()
    }

    fn momentum(bodies: &Impact) -> [f64; 3] {
        core::array::from_fn(|c| bodies.mass.iter().zip(&bodies.velocity).map(|(m, v)| m * v[c]).sum())
    }

    #[test]
    fn a_ball_that_hits_two_comes_back_with_a_fifth_of_its_speed() {
        let root = 0.75_f64.sqrt();
        let mut bodies =
            met(&[[root, 0.5, 0.0], [root, -0.5, 0.0]], &[1.0; 3], &[[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        let touching = bodies.touching();
        let pairs = bodies.fastest(&touching);
        assert_eq!(pairs, [(0, 1), (0, 2)]);
        let collisions = bodies.bounce_together(&pairs, 1.0, 0.0);
        let expected =
            [[-0.2, 0.0, 0.0], [0.6, 0.6 / 3.0_f64.sqrt(), 0.0], [0.6, -0.6 / 3.0_f64.sqrt(), 0.0]];
        for (found, wanted) in bodies.velocity.iter().zip(&expected) {
            assert!((0..3).all(|c| (found[c] - wanted[c]).abs() < 4e-16), "{found:?}");
        }
        for (collision, parting) in collisions {
            assert!((collision.speed - root).abs() < 4e-16 && (parting - root).abs() < 4e-16);
            assert_eq!(collision.energy_lost, 0.0);
        }
    }

    #[test]
    fn what_is_light_between_what_is_heavy_stays_where_it_is() {
        for light in [1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-12] {
            let mut bodies = met(
                &[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]],
                &[light, 1.0, 1.0],
                &[[0.0; 3], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            );
            let pairs = bodies.fastest(&[(0, 1), (0, 2)]);
            assert_eq!(pairs.len(), 2);
            let collisions = bodies.bounce_together(&pairs, 0.5, 0.0);
            // What is light is told as well as the angle between its contacts, the root of the ratio of the masses.
            let rounding = 1e-15 / light.sqrt();
            let wanted = [0.0, 0.5, -0.5];
            for (found, wanted) in bodies.velocity.iter().zip(wanted) {
                assert!((found[0] - wanted).abs() <= rounding, "{light}: {found:?}");
            }
            let lost: f64 = collisions.iter().map(|(collision, _)| collision.energy_lost).sum();
            assert!((lost - 0.75).abs() <= rounding, "{light}: {lost}");
            // Momentum is kept to some roundings of the heavy ones' speeds.
            assert!(momentum(&bodies)[0].abs() <= 1e-14, "{light}");
        }
    }

    proptest! {
        /// Momentum and the energy that restitution leaves are exact, no contact still approaches by much, and nobody is
        /// pulled, whatever the masses and however many are met.
        #[test]
        fn impulses_together_keep_what_one_keeps(
            count in 2_usize..6, heavy in -8_i32..8, restitution in 0.0..=1.0_f64, angle in 0.3..1.3_f64,
        ) {
            // On a cone about the way of the ball, whose surface it meets everywhere at one speed.
            let around: Vec<[f64; 3]> = (0..count)
                .map(|k| {
                    let turn = core::f64::consts::TAU * (k as f64 / count as f64).powi(2);
                    [angle.cos(), angle.sin() * turn.cos(), angle.sin() * turn.sin()]
                })
                .collect();
            let mut mass = vec![10.0_f64.powi(heavy); count + 1];
            mass[0] = 1.0;
            let mut velocity = vec![[0.0; 3]; count + 1];
            velocity[0] = [1.0, 0.0, 0.0];
            let mut bodies = met(&around, &mass, &velocity);
            let pairs: Vec<(usize, usize)> = (1..=count).map(|other| (0, other)).collect();
            prop_assert_eq!(bodies.fastest(&pairs), pairs.clone());
            let (before, carried) = (energy(&bodies), momentum(&bodies));
            let collisions = bodies.bounce_together(&pairs, restitution, 0.0);
            let lost: f64 = collisions.iter().map(|(collision, _)| collision.energy_lost).sum();
            prop_assert!((energy(&bodies) + lost - before).abs() < 1e-13 * before);
            let now = momentum(&bodies);
            prop_assert!((0..3).all(|c| (now[c] - carried[c]).abs() < 1e-13));
            for &pair in &pairs {
                prop_assert!(bodies.approach(pair).is_none_or(|speed| speed < 1e-6));
            }
        }
    }
}
