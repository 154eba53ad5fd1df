//! Spheres of one unit along its steps: eight of them are come to the end of in one pass, all pairs of few bodies.
//!
//! The one idea: whether a pair may touch is told by d² − R² and its rate at both ends of a step, which need no division and no
//! unit of their own; the few steps in which one may do so are looked at as if there were no others.

use super::Bodies;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};
use super::contacts::Contacts;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::tiered;

/// A number at nine nodes.
type AtNodes = [f64; WIDTH + 1];

/// Bodies of which some are spheres, and how they move at nine nodes, in the plan's units.
pub(super) struct Spheres {
    /// Of each body the components of its place, of what that leaves out, of its velocity and of what that leaves out.
    bodies: Vec<[[AtNodes; 3]; 4]>,
    /// Which may touch, and the sum of their radii, squared.
    pairs: Vec<([usize; 2], f64)>,
}

impl Spheres {
    /// Of these spheres and points, whose radii are in such a unit, if they are few.
    pub(super) fn of(contacts: &Contacts, unit_of_length: f64) -> Option<Self> {
        let count = contacts.few()?;
        let square = |length: f64| (length / unit_of_length) * (length / unit_of_length);
        // Points never meet points.
        let pairs = contacts.pairs_of_all().filter(|(_, length)| *length > 0.0);
        let pairs = pairs.map(|(places, length)| (places, square(length)));
        Some(Self { bodies: vec![[[[0.0; WIDTH + 1]; 3]; 4]; count], pairs: pairs.collect() })
    }

    /// Takes note in one of nine places of how the bodies move at a node.
    #[inline(always)]
    pub(super) fn note(&mut self, place: usize, bodies: &Bodies, state: &State<Lanes>) {
        for (body, numbers) in self.bodies.iter_mut().enumerate() {
            bodies.numbers_of(body, state, |component, all| {
                for (numbers, number) in numbers.iter_mut().zip(all) {
                    numbers[component][place] = number;
                }
            });
        }
    }

    /// The steps `h`, of eight between those nodes, in which a pair may touch.
    pub(super) fn suspects(&self, h: f64) -> Bits {
        suspects(self, h)
    }
}

tiered! {
    fn suspects[][](spheres: &Spheres, h: f64) -> Bits = steps_of_pairs;
}

#[inline(always)]
fn steps_of_pairs<V: Vector8>(spheres: &Spheres, h: f64) -> Bits {
    let h = V::splat(h);
    let mut suspects = Bits(0);
    for &([i, j], square) in &spheres.pairs {
        let (a, b) = (&spheres.bodies[i], &spheres.bodies[j]);
        let (mut value, mut rate) = ([V::splat(-square); 2], [V::zero(); 2]);
        for c in 0..3 {
            for end in 0..2 {
                let distance = apart::<V>([&a[0][c], &b[0][c]], [&a[1][c], &b[1][c]], end);
                let velocity = apart::<V>([&a[2][c], &b[2][c]], [&a[3][c], &b[3][c]], end);
                value[end] = distance.multiply_add(distance, value[end]);
                rate[end] = (distance + distance).multiply_add(velocity, rate[end]);
            }
        }
        let coefficients = cubic(value, rate, h);
        let near = keeps_clear(coefficients).not();
        if near.any() {
            let [a, b, c, d] = coefficients;
            suspects = suspects.or(after_all(near, [a.store(), b.store(), c.store(), d.store()]));
        }
    }
    suspects
}

/// The steps, of those in which a pair may be near zero, that do not keep clear at a closer look.
#[inline(never)]
fn after_all(near: Bits, cubics: [Lanes; 4]) -> Bits {
    let suspected =
        |&step: &usize| near.lane(step) && !keeps_clear_after_all(cubics.map(|lanes| lanes.0[step]));
    (0..WIDTH).filter(suspected).fold(Bits(0), |all, step| all.or(Bits(1 << step)))
}

/// How far numbers are apart at eight nodes, from the first or from the second on, each with what it leaves out.
#[inline(always)]
fn apart<V: Vector8>([a, b]: [&AtNodes; 2], [a_rest, b_rest]: [&AtNodes; 2], from: usize) -> V {
    (eight::<V>(a, from) - eight(b, from)) + (eight::<V>(a_rest, from) - eight(b_rest, from))
}

/// The numbers of eight nodes, from the first or from the second on.
#[inline(always)]
pub(super) fn eight<V: Vector8>(numbers: &AtNodes, from: usize) -> V {
    let mut lanes = [0.0; WIDTH];
    lanes.copy_from_slice(&numbers[from..from + WIDTH]);
    V::load(Lanes(lanes))
}
