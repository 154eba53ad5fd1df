//! How forces along lines change along a direction: where the ends of a line `d` of length r part by `e`, `F d/r` changes by
//! `(F/r) e + (F′ − F/r) (d·e)/r² d`.
//!
//! The one idea: a potential is asked for many lengths at once, whatever the lines are: from a point to bodies, or from body
//! to body. Those between bodies are summed in order of index, in whatever lanes: the same bits alone and in a batch.

use super::Phase;
use super::derivative::{Along, Derivative};
use crate::error::Result;
use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::lanes::{Bits, Lanes, WIDTH, as_numbers};
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;
use crate::potentials::kernels::{Around, Pairs};
use crate::potentials::{Numbers, Potential};
use std::sync::Arc;

/// Some lines, in lanes; component after component.
struct Lines {
    count: usize,
    components: usize,
    /// The lines; then what the forces along them change by.
    d: Vec<Lanes>,
    e: Vec<Lanes>,
    /// Their lengths, −dV/dr and d²V/dr².
    of_length: [Vec<Lanes>; 3],
}

impl Lines {
    fn new(count: usize, components: usize) -> Self {
        let room = |count: usize| vec![Lanes::zero(); count];
        let (d, e) = (room(count * components), room(count * components));
        Self { count, components, d, e, of_length: [room(count), room(count), room(count)] }
    }

    /// Puts what forces by a potential change by into the place of the lines.
    fn change(&mut self, potential: &dyn Potential, numbers: &Numbers<Lanes>) {
        let Self { count, components, d, e, of_length: [r, force, curvature] } = self;
        Lanes::pass(Lengths { of: [*count, *components], d, r });
        potential.force_and_curvature(numbers, r, force, curvature);
        Lanes::pass(Change { of: [*count, *components], d, e, r, force, curvature });
    }
}

struct Lengths<'a> {
    of: [usize; 2],
    d: &'a [Lanes],
    r: &'a mut [Lanes],
}

impl Pass<Lanes> for Lengths<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [count, components] = self.of;
        let (d, r) = (V::view(self.d), V::view_mut(self.r));
        for at in 0..count {
            let mut square = V::zero();
            for c in 0..components {
                square = d[c * count + at].multiply_add(d[c * count + at], square);
            }
            r[at] = square.sqrt();
        }
    }
}

struct Change<'a> {
    of: [usize; 2],
    d: &'a mut [Lanes],
    e: &'a [Lanes],
    r: &'a [Lanes],
    force: &'a [Lanes],
    curvature: &'a [Lanes],
}

impl Pass<Lanes> for Change<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [count, components] = self.of;
        let (d, e, r) = (V::view_mut(self.d), V::view(self.e), V::view(self.r));
        let (force, curvature) = (V::view(self.force), V::view(self.curvature));
        for at in 0..count {
            let per_r = V::one() / r[at];
            let mut along = V::zero();
            for c in 0..components {
                along = (d[c * count + at] * per_r).multiply_add(e[c * count + at], along);
            }
            // In the middle of what is smooth there all directions are alike.
            let middle = r[at].less_equal(V::zero());
            let pull = V::select(middle, -curvature[at], force[at] * per_r);
            let along = V::select(middle, V::zero(), -(curvature[at] + pull) * (along * per_r));
            for c in 0..components {
                d[c * count + at] = pull.multiply_add(e[c * count + at], along * d[c * count + at]);
            }
        }
    }
}

/// Around a fixed point.
pub(super) struct AroundPoint {
    potential: Arc<dyn Potential>,
    field: Around,
    lines: Lines,
}

impl AroundPoint {
    pub(super) fn boxed(potential: Arc<dyn Potential>, field: Around) -> Box<dyn Derivative<Lanes>> {
        let lines = Lines::new(field.shape.rows / field.numbers.len(), field.shape.components);
        Box::new(Self { potential, field, lines })
    }
}

impl Derivative<Lanes> for AroundPoint {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { potential, field, lines } = self;
        let (rows, count) = (field.shape.rows, lines.count);
        for (block, (numbers, center)) in field.numbers.iter().zip(&field.center).enumerate() {
            for (c, center) in center.iter().enumerate().take(lines.components) {
                let own = c * rows + block * count..c * rows + (block + 1) * count;
                let (d, e) = (&mut lines.d[c * count..][..count], &mut lines.e[c * count..][..count]);
                Lanes::pass(Apart { of: &phase.q[own.clone()], from: center, into: d });
                e.copy_from_slice(&along.q[own]);
            }
            lines.change(&**potential, numbers);
            let inverse_mass = &field.inverse_mass[block * count..][..count];
            for c in 0..lines.components {
                let into = &mut change[c * rows + block * count..][..count];
                Lanes::pass(Moved { by: &lines.d[c * count..][..count], inverse_mass, into });
            }
        }
        Ok(())
    }
}

struct Apart<'a> {
    of: &'a [Lanes],
    from: &'a Lanes,
    into: &'a mut [Lanes],
}

impl Pass<Lanes> for Apart<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let from = *V::view_one(self.from);
        for (into, &of) in V::view_mut(self.into).iter_mut().zip(V::view(self.of)) {
            *into = of - from;
        }
    }
}

/// Forces over masses, where there are bodies.
struct Moved<'a> {
    by: &'a [Lanes],
    inverse_mass: &'a [Lanes],
    into: &'a mut [Lanes],
}

impl Pass<Lanes> for Moved<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let (by, inverse_mass, into) = (V::view(self.by), V::view(self.inverse_mass), V::view_mut(self.into));
        for at in 0..into.len() {
            let nobody = inverse_mass[at].less_equal(V::zero());
            into[at] = V::select(nobody, V::zero(), by[at] * inverse_mass[at]);
        }
    }
}

/// Between all bodies.
pub(super) struct Between {
    potential: Arc<dyn Potential>,
    pairs: Pairs,
    /// Whether the lanes are bodies of one system.
    together: bool,
    inverse_mass: Vec<Lanes>,
    lines: Lines,
    force: Vec<Lanes>,
    /// Whether there are so many that an evaluation ticks.
    is_long: bool,
}

impl Between {
    pub(super) fn boxed(
        potential: Arc<dyn Potential>,
        pairs: Pairs,
        (together, is_long): (bool, bool),
        inverse_mass: Vec<Lanes>,
    ) -> Box<dyn Derivative<Lanes>> {
        let count = if together { pairs.bodies } else { pairs.bodies * pairs.bodies.saturating_sub(1) / 2 };
        let lines = Lines::new(count, pairs.shape.components);
        let force = vec![Lanes::zero(); pairs.shape.len()];
        Box::new(Self { potential, pairs, together, inverse_mass, lines, force, is_long })
    }

    /// Of a block of systems.
    fn of_systems(&mut self, block: usize, q: &[Lanes], along: &[Lanes]) {
        let Self { potential, pairs, lines, force, .. } = self;
        let of = [pairs.shape.rows, block * pairs.bodies, pairs.bodies];
        Lanes::pass(LayPairs { of, q, along, d: &mut lines.d, e: &mut lines.e });
        lines.change(&**potential, &pairs.numbers[block]);
        Lanes::pass(AddPairs { of, lines: &lines.d, force });
    }

    /// Of the bodies in a row.
    fn of_row(&mut self, row: usize, q: &[Lanes], along: &[Lanes]) {
        let Self { potential, pairs, lines, force, .. } = self;
        let of = [pairs.shape.rows, row, pairs.bodies];
        Lanes::pass(LayRow { of, q, along, d: &mut lines.d, e: &mut lines.e });
        lines.change(&**potential, &pairs.numbers[0]);
        Lanes::pass(AddRow { of, lines: &lines.d, force });
    }
}

impl Derivative<Lanes> for Between {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.force.fill(Lanes::zero());
        let Shape { rows, components } = self.pairs.shape;
        for part in 0..if self.together { rows } else { self.pairs.blocks } {
            if self.together {
                self.of_row(part, phase.q, along.q);
            } else {
                self.of_systems(part, phase.q, along.q);
            }
            if self.is_long {
                ticker.tick()?;
            }
        }
        for c in 0..components {
            let (by, into) = (&self.force[c * rows..][..rows], &mut change[c * rows..][..rows]);
            Lanes::pass(Moved { by, inverse_mass: &self.inverse_mass, into });
        }
        Ok(())
    }

    fn stops_midway(&self) -> bool {
        self.is_long
    }
}

/// From each body of systems to those after it: of rows in all, the first of them, and bodies.
struct LayPairs<'a> {
    of: [usize; 3],
    q: &'a [Lanes],
    along: &'a [Lanes],
    d: &'a mut [Lanes],
    e: &'a mut [Lanes],
}

impl Pass<Lanes> for LayPairs<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [rows, start, bodies] = self.of;
        let (q, along, d, e) =
            (V::view(self.q), V::view(self.along), V::view_mut(self.d), V::view_mut(self.e));
        let mut at = 0;
        for c in 0..q.len() / rows {
            for i in c * rows + start..c * rows + start + bodies {
                for j in i + 1..c * rows + start + bodies {
                    (d[at], e[at]) = (q[j] - q[i], along[j] - along[i]);
                    at += 1;
                }
            }
        }
    }
}

/// Adds to both ends.
struct AddPairs<'a> {
    of: [usize; 3],
    lines: &'a [Lanes],
    force: &'a mut [Lanes],
}

impl Pass<Lanes> for AddPairs<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [rows, start, bodies] = self.of;
        let (lines, force) = (V::view(self.lines), V::view_mut(self.force));
        let mut at = 0;
        for c in 0..force.len() / rows {
            for i in c * rows + start..c * rows + start + bodies {
                for j in i + 1..c * rows + start + bodies {
                    force[i] -= lines[at];
                    force[j] += lines[at];
                    at += 1;
                }
            }
        }
    }
}

/// From the bodies of a row to each: of rows in all, that one, and bodies.
struct LayRow<'a> {
    of: [usize; 3],
    q: &'a [Lanes],
    along: &'a [Lanes],
    d: &'a mut [Lanes],
    e: &'a mut [Lanes],
}

impl Pass<Lanes> for LayRow<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [rows, row, bodies] = self.of;
        let (places, directions) = (as_numbers(self.q), as_numbers(self.along));
        let (q, along, d, e) =
            (V::view(self.q), V::view(self.along), V::view_mut(self.d), V::view_mut(self.e));
        for c in 0..q.len() / rows {
            let own = c * rows + row;
            for j in 0..bodies {
                let other = c * rows * WIDTH + j;
                d[c * bodies + j] = V::splat(places[other]) - q[own];
                e[c * bodies + j] = V::splat(directions[other]) - along[own];
            }
        }
    }
}

/// Adds to the bodies of the row what comes of all others.
struct AddRow<'a> {
    of: [usize; 3],
    lines: &'a [Lanes],
    force: &'a mut [Lanes],
}

impl Pass<Lanes> for AddRow<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let [rows, row, bodies] = self.of;
        let (lines, force) = (V::view(self.lines), V::view_mut(self.force));
        for c in 0..force.len() / rows {
            let mut sum = force[c * rows + row];
            for j in 0..bodies {
                let others = if j / WIDTH == row { Bits(1 << (j % WIDTH)).not() } else { Bits(0xff) };
                sum = V::select(V::mask(others), sum - lines[c * bodies + j], sum);
            }
            force[c * rows + row] = sum;
        }
    }
}
