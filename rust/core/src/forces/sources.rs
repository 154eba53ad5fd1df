//! Listed bodies, each of which acts on all others, with reaction: the loops of [`oblate`](super::oblate) and of
//! [`post_newtonian`](super::post_newtonian).
//!
//! Canonical order: sources one after another as they are listed; what each gives is added to every other body, and then
//! the reaction to the source, Σ (−mᵢ/M) aᵢ, each with the factor of its pull first. Its sum takes the massive bodies by eights in order of index, each eight as
//! ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7)), zero where there is none or the source itself, whatever the lanes are.
//! Products and sums of that sum are not fused. In lanes over bodies nothing is read or written by single numbers: a
//! vector that is read soon after waits long for them.

mod beside_gravity;
mod following;
mod series;

pub(super) use following::following;
pub(super) use series::{Written, WrittenLaw};

use super::context::{Arrangement, Context, System, packed_place};
use super::{Adds, Force, ForceTerm, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;
use crate::units::Units;

/// How many numbers of its own a source has, at most.
pub(super) const NUMBERS: usize = 7;

/// What a source does to another body.
pub(super) trait Law: Send + 'static {
    /// The force of which it is the law: each system has one of its own.
    type Term: ForceTerm;
    /// Whether it looks at velocities.
    const VELOCITY: bool;

    /// The gravitational constant of a force, in the units of the integration.
    fn constant(term: &Self::Term, units: Units) -> f64;

    /// The numbers of the source of that place in the list and of that gravitational parameter, in those units.
    fn numbers(term: &Self::Term, source: usize, strength: f64, units: Units) -> [f64; NUMBERS];

    /// What the source of that place in the list gives to a body, by its gravitational parameter and its numbers.
    /// Inlined, and without closures: it is compiled for each tier.
    fn pull<S: Real>(&self, source: usize, of: &OfSource<S>, relative: &Relative<S>) -> Pull<S>;
}

/// What a source is, in each lane.
#[derive(Debug)]
pub(super) struct OfSource<S> {
    /// Its gravitational parameter.
    pub strength: S,
    pub numbers: [S; NUMBERS],
}

/// The same, the gravitational parameter first, as it is kept and as parameters of an expression.
type Told = [Lanes; 1 + NUMBERS];

impl<S: Real> OfSource<S> {
    #[inline(always)]
    fn told(all: &[S]) -> Self {
        let mut numbers = [S::zero(); NUMBERS];
        numbers.copy_from_slice(&all[1..1 + NUMBERS]);
        Self { strength: all[0], numbers }
    }
}

/// An acceleration, as a product: what waits for it need not wait for both. The factor is zero where r⁻³ is.
#[derive(Debug)]
pub(super) struct Pull<S> {
    pub factor: S,
    pub vector: [S; 3],
}

impl<S: Real> Pull<S> {
    /// The product, without negative zeros: as one added to zero.
    #[inline(always)]
    fn acceleration(&self) -> [S; 3] {
        let Self { factor, vector: [x, y, z] } = *self;
        let zero = S::zero();
        [factor.multiply_add(x, zero), factor.multiply_add(y, zero), factor.multiply_add(z, zero)]
    }
    /// A share of it, likewise.
    #[inline(always)]
    fn reaction(&self, share: S) -> [S; 3] {
        Self { factor: share * self.factor, vector: self.vector }.acceleration()
    }
}

/// Where a body is and how it moves, relative to a source.
#[derive(Debug)]
pub(super) struct Relative<S> {
    pub d: [S; 3],
    /// If the law looks at it.
    pub velocity: [S; 3],
    /// Of the distance, the square and the power −3.
    pub square: S,
    pub inverse_cube: S,
}

#[inline(always)]
fn squared<S: Real>(d: [S; 3]) -> S {
    d[2].multiply_add(d[2], d[1].multiply_add(d[1], d[0] * d[0]))
}

impl<S: InverseCube> Relative<S> {
    #[inline(always)]
    fn new(d: [S; 3], velocity: [S; 3]) -> Self {
        let square = squared(d);
        Self { d, velocity, square, inverse_cube: square.inverse_cube() }
    }
}

/// A source in lanes.
#[derive(Debug)]
struct Source {
    /// Its place in the list.
    index: usize,
    /// Its row in a block and lane 0; or if packed, its row and lane.
    place: (usize, usize),
    /// What it is in each block; in every lane if packed.
    of: Vec<Told>,
    /// −m/M of every body in its row and lane, zero of the source itself.
    shares: Vec<Lanes>,
    /// If packed, where other bodies are, row after row.
    others: Vec<Bits>,
    /// If packed, its lane alone, if it has mass.
    itself: Bits,
    /// If packed, its lane, eight times.
    lane: [i64; WIDTH],
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
}

impl<L: Law> Kernel<L> {
    /// Of the bodies of a context that are listed and have mass.
    pub(super) fn new(law: L, term: &L::Term, listed: &[usize], context: &Context<'_>) -> Self {
        let packed = context.arrangement == Arrangement::Packed;
        let (shape, active) = (context.shape, context.active);
        let bodies = context.first().bodies;
        let slots = listed.iter().enumerate().filter_map(|(index, body)| {
            bodies[..active].iter().position(|other| other == body).map(|slot| (index, slot))
        });
        let sources = slots.map(|(index, slot)| {
            let place = if packed { packed_place(slot, active) } else { (slot, 0) };
            let parameter = |system: &System<'_>| {
                L::constant(context.own(term, system), context.units) * system.mass[slot]
            };
            let strength = context.per_system(parameter);
            let numbers: Vec<Vec<Lanes>> = (0..NUMBERS)
                .map(|number| {
                    context.per_system(|system| {
                        let own = context.own(term, system);
                        L::numbers(own, index, parameter(system), context.units)[number]
                    })
                })
                .collect();
            let of = |(block, &strength): (usize, &Lanes)| -> Told {
                core::array::from_fn(|at| at.checked_sub(1).map_or(strength, |number| numbers[number][block]))
            };
            let others = context.per_body(|_, other| if other == slot { 0.0 } else { 1.0 });
            // Some ensemble members may have it without mass: there it does nothing.
            let share = |own: f64, other: f64| if own > 0.0 { -other / own } else { 0.0 };
            let shares = context.per_body(|system, other| {
                if other == slot { 0.0 } else { share(system.mass[slot], system.mass[other]) }
            });
            let massive = u8::from(context.first().mass[slot] > 0.0);
            Source {
                index,
                place,
                itself: Bits(massive << place.1),
                lane: [place.1 as i64; WIDTH],
                of: strength.iter().enumerate().map(of).collect(),
                shares,
                others: others.iter().map(|row| Lanes::zero().less(*row)).collect(),
            }
        });
        Self { law, shape, packed, blocks: context.blocks(), active, sources: sources.collect() }
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

/// What a source gives to a row of bodies, at places and speeds, and its reaction: zero where nobody is or the source itself.
#[inline(always)]
fn on_row<V: Vector8 + InverseCube, L: Law>(
    (kernel, source): (&Kernel<L>, &Source),
    row: usize,
    (place, speed): ([V; 3], [V; 3]),
    (own, own_speed): ([V; 3], [V; 3]),
) -> [[V; 3]; 2] {
    let there = source.others[row];
    let mut d = difference(place, own);
    let mut velocity = [V::zero(); 3];
    if L::VELOCITY {
        velocity = difference(speed, own_speed);
    }
    // Where nobody else is, a place that gives a number.
    d[0] = V::select(there, d[0], V::one());
    let of = OfSource::told(V::view(&source.of[0]));
    let mut pull = kernel.law.pull(source.index, &of, &Relative::new(d, velocity));
    pull.factor = V::select(there, pull.factor, V::zero());
    [pull.acceleration(), pull.reaction(V::load(source.shares[row]))]
}

/// Bodies of one system: a row of them at a time, or `ONE` row alone. What is known when compiled stays in registers.
#[inline(always)]
fn packed<V: Vector8 + InverseCube, L: Law, const PLANAR: bool, const ONE: bool>(
    kernel: &Kernel<L>,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
) {
    let rows = if ONE { 1 } else { kernel.shape.rows };
    let massive = if ONE { 1 } else { kernel.active.div_ceil(WIDTH) };
    let components = if PLANAR { 2 } else { 3 };
    let q = &V::view(q)[..components * rows];
    let v = &V::view(v)[..if L::VELOCITY { components * rows } else { 0 }];
    let a = &mut V::view_mut(a)[..components * rows];
    for source in &kernel.sources {
        let own = if ONE { 0 } else { source.place.0 };
        let (mut place, mut speed) = ([V::zero(); 3], [V::zero(); 3]);
        for c in 0..components {
            place[c] = q[c * rows + own].permute(&source.lane);
            if L::VELOCITY {
                speed[c] = v[c * rows + own].permute(&source.lane);
            }
        }
        let mut sum = [V::zero(); 3];
        // Of the row that the source is in, which waits for the reaction.
        let mut beside = [V::zero(); 3];
        for row in 0..rows {
            let mut own_speed = [V::zero(); 3];
            if L::VELOCITY {
                own_speed = vector(v, row, rows, components);
            }
            let bodies = (vector(q, row, rows, components), own_speed);
            let [term, reaction] = on_row((kernel, source), row, bodies, (place, speed));
            for c in 0..components {
                if row == own {
                    beside[c] = term[c];
                } else {
                    a[c * rows + row] += term[c];
                }
                if row < massive {
                    sum[c] += reaction[c].sum_in_every_lane();
                }
            }
        }
        for c in 0..components {
            a[c * rows + own] += V::select(source.itself, sum[c], beside[c]);
        }
    }
}

/// Systems in lanes, a row for each body.
#[inline(always)]
fn batched<V: Vector8 + InverseCube, L: Law>(kernel: &Kernel<L>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes]) {
    let Shape { rows, components } = kernel.shape;
    let (q, v, a) = (V::view(q), V::view(v), V::view_mut(a));
    let bodies = rows / kernel.blocks.max(1);
    for block in 0..kernel.blocks {
        for source in &kernel.sources {
            let own = block * bodies + source.place.0;
            let place = vector(q, own, rows, components);
            let mut speed = [V::zero(); 3];
            if L::VELOCITY {
                speed = vector(v, own, rows, components);
            }
            let of = OfSource::told(V::view(&source.of[block]));
            let shares = V::view(&source.shares);
            let mut sum = [V::zero(); 3];
            for first in (0..bodies).step_by(WIDTH) {
                let mut parts = [[V::zero(); WIDTH]; 3];
                for place_in_eight in 0..WIDTH.min(bodies - first) {
                    let slot = first + place_in_eight;
                    let at = block * bodies + slot;
                    if at == own {
                        continue;
                    }
                    let mut velocity = [V::zero(); 3];
                    if L::VELOCITY {
                        velocity = difference(vector(v, at, rows, components), speed);
                    }
                    let d = difference(vector(q, at, rows, components), place);
                    let pull = kernel.law.pull(source.index, &of, &Relative::new(d, velocity));
                    let (term, reaction) = (pull.acceleration(), pull.reaction(shares[at]));
                    for c in 0..components {
                        a[c * rows + at] += term[c];
                        if slot < kernel.active {
                            parts[c][place_in_eight] = reaction[c];
                        }
                    }
                }
                if first < kernel.active {
                    for c in 0..components {
                        let p = &parts[c];
                        sum[c] += ((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7]));
                    }
                }
            }
            for c in 0..components {
                a[c * rows + own] += sum[c];
            }
        }
    }
}

#[inline(always)]
fn kernel<V: Vector8 + InverseCube, L: Law>(kernel: &Kernel<L>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes]) {
    match (kernel.packed, kernel.shape.components == 2, kernel.shape.rows == 1) {
        (false, ..) => batched::<V, L>(kernel, q, v, a),
        (true, false, false) => packed::<V, L, false, false>(kernel, q, v, a),
        (true, false, true) => packed::<V, L, false, true>(kernel, q, v, a),
        (true, true, false) => packed::<V, L, true, false>(kernel, q, v, a),
        (true, true, true) => packed::<V, L, true, true>(kernel, q, v, a),
    }
}

tiered! {
    fn kernel_tier[L: Law][L](of: &Kernel<L>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes]) = kernel;
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
    fn adds(&self) -> Adds {
        if self.sources.len() <= 1 { Adds::Once } else { Adds::Severally }
    }
    fn needs(&self) -> Needs {
        Needs { velocity: L::VELOCITY, ..Needs::default() }
    }
}
