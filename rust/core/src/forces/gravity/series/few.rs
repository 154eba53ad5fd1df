//! A few massless bodies, each with the massive ones in the lanes of its own registers.
//!
//! The one idea: what a pair does is the same in whatever lane it is, and pulls are added body by body, so it makes no
//! difference to a bit whether massless bodies lie in the lanes or those that pull; of few it is quicker that these do.

use super::{Kept, Pairs, Whole};
use crate::forces::following::MassiveRows;
use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;

/// Pulls of packed bodies on a few massless ones.
pub struct FewPulls {
    kept: Kept<Lanes>,
    softening2: f64,
    /// The `G·m` of the massive bodies.
    strength: Vec<f64>,
    /// The motions of the massless ones: a row each, with the same in all lanes.
    jet: Option<Jet<Lanes>>,
    /// Their units of time, squared.
    units2: Vec<Lanes>,
    /// Of each register the massless body, and the row of the massive ones.
    registers: Vec<(usize, usize)>,
    a: Vec<Lanes>,
}

/// Those, and the `G·m` of the massive bodies for each lane.
pub struct FewMassless<'a> {
    pub(in crate::forces) strength: &'a [Lanes],
    pub(in crate::forces) series: &'a mut FewPulls,
}

impl FewMassless<'_> {
    /// So many at most.
    pub const MOST: usize = WIDTH / 2;

    /// Expands their motions.
    pub fn expand(self, massive: MassiveRows<'_>, jet: &mut Jet<Lanes>) {
        let Self { strength, series: few } = self;
        let massless = massive.lanes.len();
        let components = few.kept.components();
        few.strength.clear();
        few.strength.extend(strength.iter().map(|strength| strength.0[massive.lanes[0]]));
        if few.registers.len() != massless * massive.rows {
            few.registers.clear();
            few.registers
                .extend((0..massless).flat_map(|body| (0..massive.rows).map(move |row| (body, row))));
            few.kept.lay_out(massless);
            few.units2.resize(massless, Lanes::zero());
            few.a.resize(massless * components, Lanes::zero());
        }
        let room = || Jet::new(FewMassless::MOST * components, jet.inverse.len() - 3);
        let own = few.jet.get_or_insert_with(room);
        (own.order, own.len) = (jet.order, massless * components);
        Lanes::pass(Expand { few, massive, jet });
    }
}

impl FewPulls {
    pub(super) fn new(massive: usize, components: usize, softening2: f64) -> Self {
        let rows = massive.div_ceil(WIDTH);
        let shape = Shape { rows: FewMassless::MOST, components };
        Self {
            kept: Kept::new(shape, FewMassless::MOST * rows),
            softening2,
            strength: Vec::with_capacity(massive),
            jet: None,
            units2: Vec::new(),
            registers: Vec::new(),
            a: Vec::new(),
        }
    }
}

struct Expand<'a> {
    few: &'a mut FewPulls,
    massive: MassiveRows<'a>,
    jet: &'a mut Jet<Lanes>,
}

impl Pass<Lanes> for Expand<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { few, massive: MassiveRows { lanes, rows, places, rests }, jet } = self;
        let FewPulls { kept, softening2, strength, jet: own, units2, registers, a } = few;
        let Some(own) = own else { return };
        let (components, massless) = (jet.len, lanes.len());
        for (body, &lane) in lanes.iter().enumerate() {
            let unit = V::splat(jet.unit.0[lane]);
            units2[body] = (unit * unit).store();
            for c in 0..components {
                let at = c * massless + body;
                V::view_mut(&mut own.q)[at] = V::splat(jet.q[c].0[lane]);
                V::view_mut(&mut own.q)[own.len + at] = V::splat(jet.q[components + c].0[lane]);
                V::view_mut(&mut own.v)[at] = V::splat(jet.v[c].0[lane]);
                V::view_mut(&mut own.rests[0])[at] = V::splat(jet.rests[0][c].0[lane]);
            }
        }
        let (places, rests) = (V::view(places), V::view(rests));
        let of_each = (places.len() / massless, rests.len() / massless);
        let seen = Seen {
            places,
            rests,
            of_each,
            rows,
            registers,
            units2: V::view(units2),
            strength,
            softening2: *softening2,
        };
        Whole { kept, jet: &mut *own, a }.run::<V, Seen<'_, V>>(&seen);
        let (of_q, of_v) = (V::view(&own.q), V::view(&own.v));
        for (body, &lane) in lanes.iter().enumerate() {
            let mask = V::mask(Bits(1 << lane));
            let (q, v) = (V::view_mut(&mut jet.q), V::view_mut(&mut jet.v));
            for n in 1..=own.order {
                for c in 0..components {
                    let at = c * massless + body;
                    let into = &mut q[(n + 1) * components + c];
                    *into = V::select(mask, of_q[(n + 1) * own.len + at], *into);
                    let into = &mut v[n * components + c];
                    *into = V::select(mask, of_v[n * own.len + at], *into);
                }
            }
        }
    }
}

struct Seen<'a, V> {
    /// For each massless body the blocks of the massive ones, and what those of order 0 leave out; so many registers.
    places: &'a [V],
    rests: &'a [V],
    of_each: (usize, usize),
    rows: usize,
    registers: &'a [(usize, usize)],
    units2: &'a [V],
    strength: &'a [f64],
    softening2: f64,
}

impl<V: View<Lanes>> Pairs<V> for Seen<'_, V> {
    const IN_FULL: bool = true;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.registers.len()
    }
    #[inline(always)]
    fn softening2(&self, _: usize) -> V {
        V::splat(self.softening2)
    }
    #[inline(always)]
    fn difference(&self, register: usize, (n, c): (usize, usize), component: &[V]) -> V {
        let (body, row) = self.registers[register];
        let (blocks, len) = self.of_each;
        self.places[body * blocks + n * len + c * self.rows + row] - component[body]
    }
    #[inline(always)]
    fn rest(&self, register: usize, c: usize, component: &[V]) -> V {
        let (body, row) = self.registers[register];
        self.rests[body * self.of_each.1 + c * self.rows + row] - component[body]
    }
    #[inline(always)]
    fn begin(&self, register: usize, [square, _]: [V; 2], _: V) -> [V; 2]
    where
        V: InverseCube,
    {
        let power = self.units2[self.registers[register].0] * square.inverse_cube();
        [power, power]
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], _: bool) {
        let massless = self.units2.len();
        for (body, pulls) in pulls.chunks_exact(self.rows).enumerate() {
            let mut sum = [0.0; C];
            for (pull, strength) in pulls.iter().zip(self.strength.chunks(WIDTH)) {
                let mut row = [[0.0; WIDTH]; C];
                for c in 0..C {
                    row[c] = pull[c].store().0;
                }
                for (lane, &strength) in strength.iter().enumerate() {
                    for c in 0..C {
                        sum[c] = strength.multiply_add(row[c][lane], sum[c]);
                    }
                }
            }
            for c in 0..C {
                a[c * massless + body] = V::splat(sum[c]);
            }
        }
    }
}
