//! Listed bodies, each of which acts on all others, with reaction: the loops of [`oblate`](super::oblate) and of
//! [`post_newtonian`](super::post_newtonian).
//!
//! Canonical order: sources one after another as they are listed; what each gives is added to every other body, and then
//! the reaction to the source, −Σ mᵢ aᵢ/M, whose sum goes over the massive bodies in order of index, whatever the lanes
//! are. Products and sums of that sum are not fused, so that one number has the bits of a lane.

use super::context::{Arrangement, Context, packed_place};
use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::binary::Binary;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Real;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;

/// What a source does to another body.
pub(super) trait Law: Send + 'static {
    /// Whether it looks at velocities.
    const VELOCITY: bool;

    /// The acceleration of a body at `d` from the source of that place in the list, which moves with `w` relative to it;
    /// `strength` is the source's gravitational parameter. Inlined, and without closures: it is compiled for each tier.
    fn pull<S: InverseCube>(&self, source: usize, strength: S, d: [S; 3], w: [S; 3]) -> [S; 3];
}

/// A source in lanes.
#[derive(Debug)]
struct Source {
    /// Its place in the list.
    index: usize,
    /// Its row in a block and lane 0; or if packed, its row and lane.
    place: (usize, usize),
    /// Its gravitational parameter, and 1/mass, in each block; one number in every lane if packed.
    strength: Vec<Lanes>,
    inverse_mass: Vec<Lanes>,
    /// Above zero where another body is.
    others: Vec<Lanes>,
}

/// The forces of some sources.
#[derive(Debug)]
pub(super) struct Kernel<L> {
    law: L,
    shape: Shape,
    packed: bool,
    blocks: usize,
    active: usize,
    sources: Vec<Source>,
    mass: Vec<Lanes>,
    /// What one source gives, row after row and component after component.
    scratch: Vec<Lanes>,
}

impl<L: Law> Kernel<L> {
    /// Of the bodies of a context that are listed and have mass; `constant` is the gravitational one, in its units.
    pub(super) fn new(law: L, listed: &[usize], constant: f64, context: &Context<'_>) -> Self {
        let packed = context.arrangement == Arrangement::Packed;
        let (shape, active) = (context.shape, context.active);
        let bodies = context.first().bodies;
        let slots = listed.iter().enumerate().filter_map(|(index, body)| {
            bodies[..active].iter().position(|other| other == body).map(|slot| (index, slot))
        });
        let sources = slots.map(|(index, slot)| {
            let place = if packed { packed_place(slot, active) } else { (slot, 0) };
            let of = |mass: &dyn Fn(f64) -> f64| -> Vec<Lanes> {
                if packed {
                    return vec![Lanes::splat(mass(context.first().mass[slot]))];
                }
                context.in_rows(1, |system, _| mass(system.mass[slot]))
            };
            Source {
                index,
                place,
                strength: of(&|mass| constant * mass),
                // Some ensemble members may have it without mass: there it does nothing.
                inverse_mass: of(&|mass| if mass > 0.0 { 1.0 / mass } else { 0.0 }),
                others: context.per_body(|_, other| if other == slot { 0.0 } else { 1.0 }),
            }
        });
        Self {
            law,
            shape,
            packed,
            blocks: context.blocks(),
            active,
            sources: sources.collect(),
            mass: context.per_body(|system, slot| system.mass[slot]),
            scratch: vec![Lanes::zero(); shape.len()],
        }
    }
}

/// A vector of a state, component after component.
#[inline(always)]
fn vector<S: Real>(values: &[S], at: usize, stride: usize, components: usize) -> [S; 3] {
    let mut vector = [S::zero(); 3];
    for c in 0..components {
        vector[c] = values[c * stride + at];
    }
    vector
}

#[inline(always)]
fn difference<S: Real>(to: [S; 3], from: [S; 3]) -> [S; 3] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

/// Bodies of one system: a row of them at a time.
#[inline(always)]
fn packed<V: Vector8 + InverseCube + Binary, L: Law>(
    kernel: &mut Kernel<L>,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
) {
    let Shape { rows, components } = kernel.shape;
    let stride = rows * WIDTH;
    let Kernel { law, sources, scratch, mass, active, .. } = kernel;
    for source in sources.iter() {
        let own = source.place.0 * WIDTH + source.place.1;
        let (mut place, mut speed) = ([V::zero(); 3], [V::zero(); 3]);
        for c in 0..components {
            place[c] = V::splat(as_numbers(q)[c * stride + own]);
            if L::VELOCITY {
                speed[c] = V::splat(as_numbers(v)[c * stride + own]);
            }
        }
        let strength = V::load(source.strength[0]);
        for row in 0..rows {
            let there = V::zero().less(V::load(source.others[row]));
            let mut d = difference(vector(V::view(q), row, rows, components), place);
            let mut w = [V::zero(); 3];
            if L::VELOCITY {
                w = difference(vector(V::view(v), row, rows, components), speed);
            }
            // Where nobody else is, a place that gives a number.
            d[0] = V::select(there, d[0], V::one());
            let term = law.pull(source.index, strength, d, w);
            for c in 0..components {
                let at = c * rows + row;
                let term = V::select(there, term[c], V::zero());
                V::view_mut(scratch)[at] = term;
                let a = &mut V::view_mut(a)[at];
                *a += term;
            }
        }
        let (scratch, mass, a) = (as_numbers(scratch), as_numbers(mass), as_numbers_mut(a));
        for c in 0..components {
            let mut sum = 0.0;
            for slot in 0..*active {
                // Those that have mass fill rows from the first on.
                sum += mass[slot] * scratch[c * stride + slot];
            }
            a[c * stride + own] += -(sum * source.inverse_mass[0].0[0]);
        }
    }
}

/// Systems in lanes, a row for each body.
#[inline(always)]
fn batched<V: Vector8 + InverseCube, L: Law>(kernel: &Kernel<L>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes]) {
    let Shape { rows, components } = kernel.shape;
    let (q, v, a, mass) = (V::view(q), V::view(v), V::view_mut(a), V::view(&kernel.mass));
    let bodies = rows / kernel.blocks.max(1);
    for block in 0..kernel.blocks {
        for source in &kernel.sources {
            let own = block * bodies + source.place.0;
            let place = vector(q, own, rows, components);
            let mut speed = [V::zero(); 3];
            if L::VELOCITY {
                speed = vector(v, own, rows, components);
            }
            let strength = V::load(source.strength[block]);
            let mut sum = [V::zero(); 3];
            for slot in 0..bodies {
                let at = block * bodies + slot;
                if at == own {
                    continue;
                }
                let mut w = [V::zero(); 3];
                if L::VELOCITY {
                    w = difference(vector(v, at, rows, components), speed);
                }
                let d = difference(vector(q, at, rows, components), place);
                let term = kernel.law.pull(source.index, strength, d, w);
                for c in 0..components {
                    let a = &mut a[c * rows + at];
                    *a += term[c];
                    if slot < kernel.active {
                        sum[c] += mass[at] * term[c];
                    }
                }
            }
            let inverse_mass = V::load(source.inverse_mass[block]);
            for c in 0..components {
                a[c * rows + own] += -(sum[c] * inverse_mass);
            }
        }
    }
}

#[inline(always)]
fn kernel<V: Vector8 + InverseCube + Binary, L: Law>(
    kernel: &mut Kernel<L>,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
) {
    if kernel.packed {
        packed::<V, L>(kernel, q, v, a);
    } else {
        batched::<V, L>(kernel, q, v, a);
    }
}

tiered! {
    fn kernel_tier[L: Law][L](of: &mut Kernel<L>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes]) = kernel;
}

impl<L: Law> Force<Lanes> for Kernel<L> {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        if first {
            a.fill(Lanes::zero());
        }
        kernel_tier(self, phase.q, phase.v, a);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { velocity: L::VELOCITY, ..Needs::default() }
    }
}
