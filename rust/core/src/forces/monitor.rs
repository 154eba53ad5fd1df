//! What time transformations watch: potential energies of attraction, or inverse distances, added up over pairs and centers.
//!
//! The one idea: both are Σ wᵢ wⱼ/rᵢⱼ, with masses or with ones for weights, so one loop serves both. Lanes are trajectories, in
//! which each pair is taken once, or the bodies of one, in which each is taken twice; a system is laid out in one way whatever
//! else there is, so the orders of the two sums are never compared.

use super::ForceTerm;
use super::context::{Arrangement, Context, packed_place};
use super::gravity::newton::CONSTANT;
use super::term::Coupling;
use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::step_control::Controlled;
use crate::ode::transformation::{Monitor, Transformation};
use std::sync::Arc;

/// Terms `factor/√(r² + softening²)`.
#[derive(Clone, Copy, Debug)]
struct Attraction {
    factor: f64,
    softening2: f64,
}

/// The sum at work.
#[derive(Debug)]
pub struct InverseDistances {
    arrangement: Arrangement,
    shape: Shape,
    /// Bodies with mass, and the others, of a system.
    active: usize,
    passive: usize,
    /// What each body weighs in pairs, and its mass.
    weight: Vec<Lanes>,
    mass: Vec<Lanes>,
    pairs: Vec<Attraction>,
    /// Whether each body is there: lanes without one are not.
    present: Vec<Lanes>,
    centers: Vec<(Attraction, [f64; 3])>,
}

impl InverseDistances {
    /// Of what a time transformation watches in those forces.
    pub fn new(by: Transformation, forces: &[Arc<dyn ForceTerm>], context: &Context<'_>) -> Self {
        let units = context.units;
        let present = context.per_body(|_, _| 1.0);
        let mass = context.per_body(|system, slot| system.mass[slot]);
        let center = |center: [f64; 3]| units.take_vector(center, [1, 0, 0]);
        let soft = |softening: f64| {
            let softening = units.take(softening, [1, 0, 0]);
            softening * softening
        };
        let (weight, pairs, mut centers): (_, Vec<Attraction>, Vec<(Attraction, [f64; 3])>) = match by {
            Transformation::PotentialEnergy => {
                let newtonian = forces.iter().filter_map(|force| force.as_newtonian());
                let pairs = newtonian.map(|(constant, softening)| Attraction {
                    factor: units.take(constant, CONSTANT),
                    softening2: soft(softening),
                });
                let coulomb = forces.iter().filter_map(|force| force.as_inverse_distance_center());
                // An energy times a length.
                let centers = coulomb.map(|(k, at)| {
                    (Attraction { factor: units.take(-k, [3, 1, -2]), softening2: 0.0 }, center(at))
                });
                (mass.clone(), pairs.collect(), centers.collect())
            }
            Transformation::Distance => {
                let between = forces.iter().filter(|force| force.coupling() == Coupling::AllPairs);
                let near = |softening: f64| Attraction { factor: 1.0, softening2: soft(softening) };
                let pairs = between.map(|force| force.softening()).reduce(f64::min).map(near);
                let centers = forces
                    .iter()
                    .filter_map(|force| Some((near(force.softening()), center(force.center()?))));
                (present.clone(), pairs.into_iter().collect(), centers.collect())
            }
        };
        // Two fields about one point are one place to come near to, as hard as the harder of them.
        if by == Transformation::Distance {
            centers.sort_by(|(a, _), (b, _)| a.softening2.total_cmp(&b.softening2));
            let all = core::mem::take(&mut centers);
            for center in all {
                if !centers.iter().any(|(_, at)| *at == center.1) {
                    centers.push(center);
                }
            }
        }
        Self {
            arrangement: context.arrangement,
            shape: context.shape,
            active: context.active,
            passive: context.first().bodies.len() - context.active,
            weight,
            mass,
            pairs,
            present,
            centers,
        }
    }
}

impl Monitor<Lanes> for InverseDistances {
    fn at(&mut self, q: &[Lanes], gradient: &mut [Lanes]) -> Lanes {
        gradient.fill(Lanes::zero());
        // A body by itself moves in no time but time.
        let paired = !self.pairs.is_empty() && self.active > 0 && self.active + self.passive > 1;
        if !paired && self.centers.is_empty() {
            return Lanes::one();
        }
        let mut sum = Lanes::zero();
        for &pairs in &self.pairs {
            sum += match self.arrangement {
                Arrangement::Batched => Lanes::pass(Pairs { of: self, pairs, q, gradient: &mut *gradient }),
                Arrangement::Packed => {
                    let both_ways = Lanes::pass(Others { of: self, pairs, q, gradient: &mut *gradient });
                    Lanes::splat(0.5) * both_ways.sum_of_lanes()
                }
            };
        }
        for &(field, center) in &self.centers {
            let around = Lanes::pass(Center { of: self, field, center, q, gradient: &mut *gradient });
            sum += match self.arrangement {
                Arrangement::Batched => around,
                Arrangement::Packed => around.sum_of_lanes(),
            };
        }
        sum
    }

    fn kinetic_energy(&self, v: &[Lanes]) -> Lanes {
        let twice = Lanes::pass(Squares { mass: &self.mass, v });
        let energy = Lanes::splat(0.5) * twice;
        match self.arrangement {
            Arrangement::Batched => energy,
            Arrangement::Packed => energy.sum_of_lanes(),
        }
    }
}

/// The vector from one place to another, and its length as `1/√(r² + softening²)`; 0 where that is not there.
#[inline(always)]
fn apart<V: Real>(from: [V; 3], to: [V; 3], softening2: V) -> ([V; 3], V) {
    let d = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let mut r2 = d[0].multiply_add(d[0], softening2);
    r2 = d[1].multiply_add(d[1], r2);
    r2 = d[2].multiply_add(d[2], r2);
    (d, V::select(V::zero().less(r2), V::one() / r2.sqrt(), V::zero()))
}

#[inline(always)]
fn place<V: Real>(q: &[V], row: usize, Shape { rows, components }: Shape) -> [V; 3] {
    [q[row], q[rows + row], if components == 3 { q[2 * rows + row] } else { V::zero() }]
}

/// Adds `scale·d` to a row of the gradient, if there is one.
#[inline(always)]
fn add<V: Real>(gradient: &mut [V], row: usize, Shape { rows, components }: Shape, scale: V, d: [V; 3]) {
    if !gradient.is_empty() {
        for c in 0..components {
            gradient[c * rows + row] = scale.multiply_add(d[c], gradient[c * rows + row]);
        }
    }
}

/// The pairs of trajectories in lanes, each once.
struct Pairs<'a> {
    of: &'a InverseDistances,
    pairs: Attraction,
    q: &'a [Lanes],
    gradient: &'a mut [Lanes],
}

impl Pass<Lanes> for Pairs<'_> {
    type Output = Lanes;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> Lanes {
        let Self { of, pairs: Attraction { factor, softening2 }, q, gradient } = self;
        let (q, gradient, weight) = (V::view(q), V::view_mut(gradient), V::view(&of.weight));
        let (factor, softening2) = (V::splat(factor), V::splat(softening2));
        let mut sum = V::zero();
        for i in 0..of.active {
            let own = factor * weight[i];
            for j in i + 1..of.active + of.passive {
                let (d, inverse) = apart(place(q, i, of.shape), place(q, j, of.shape), softening2);
                let term = own * weight[j] * inverse;
                sum += term;
                let pull = term * inverse * inverse;
                add(gradient, i, of.shape, pull, d);
                add(gradient, j, of.shape, -pull, d);
            }
        }
        sum.store()
    }
}

/// The pairs of bodies in lanes, each from both sides.
struct Others<'a> {
    of: &'a InverseDistances,
    pairs: Attraction,
    q: &'a [Lanes],
    gradient: &'a mut [Lanes],
}

impl Pass<Lanes> for Others<'_> {
    type Output = Lanes;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> Lanes {
        let Self { of, pairs: Attraction { factor, softening2 }, q: numbers, gradient } = self;
        let (q, gradient, weight) = (V::view(numbers), V::view_mut(gradient), V::view(&of.weight));
        let softening2 = V::splat(softening2);
        let with_mass = of.active.div_ceil(WIDTH);
        let mut sum = V::zero();
        for slot in 0..of.active + of.passive {
            let (row, lane) = packed_place(slot, of.active);
            let Shape { rows, components } = of.shape;
            let z = if components == 3 { numbers[2 * rows + row].0[lane] } else { 0.0 };
            let from = [V::splat(numbers[row].0[lane]), V::splat(numbers[rows + row].0[lane]), V::splat(z)];
            let own = V::splat(factor * of.weight[row].0[lane]);
            // Massless bodies are apart from each other.
            for other in 0..if slot < of.active { rows } else { with_mass } {
                let (d, inverse) = apart(from, place(q, other, of.shape), softening2);
                let mut weight = weight[other];
                if other == row {
                    let mut others = of.weight[other];
                    others.0[lane] = 0.0;
                    weight = V::load(others);
                }
                let term = own * weight * inverse;
                sum += term;
                add(gradient, other, of.shape, -(term * inverse * inverse), d);
            }
        }
        sum.store()
    }
}

/// The distances of all bodies from a center.
struct Center<'a> {
    of: &'a InverseDistances,
    field: Attraction,
    center: [f64; 3],
    q: &'a [Lanes],
    gradient: &'a mut [Lanes],
}

impl Pass<Lanes> for Center<'_> {
    type Output = Lanes;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> Lanes {
        let Self { of, field: Attraction { factor, softening2 }, center: [x, y, z], q, gradient } = self;
        let (q, gradient, present) = (V::view(q), V::view_mut(gradient), V::view(&of.present));
        let (factor, softening2) = (V::splat(factor), V::splat(softening2));
        let center = [V::splat(x), V::splat(y), V::splat(z)];
        let mut sum = V::zero();
        for row in 0..of.shape.rows {
            let (d, inverse) = apart(center, place(q, row, of.shape), softening2);
            let term = factor * present[row] * inverse;
            sum += term;
            add(gradient, row, of.shape, -(term * inverse * inverse), d);
        }
        sum.store()
    }
}

/// `Σ m v²`.
struct Squares<'a> {
    mass: &'a [Lanes],
    v: &'a [Lanes],
}

impl Pass<Lanes> for Squares<'_> {
    type Output = Lanes;
    #[inline(always)]
    fn run<V: View<Lanes>>(self) -> Lanes {
        let (mass, v) = (V::view(self.mass), V::view(self.v));
        let mut sum = V::zero();
        for (row, &v) in v.iter().enumerate() {
            sum = (mass[row % mass.len()] * v).multiply_add(v, sum);
        }
        sum.store()
    }
}
