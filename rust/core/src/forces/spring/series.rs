//! Springs as a recurrence of Taylor coefficients.
//!
//! The one idea: with `d = x_j - x_i` and `s = |d|²` the force on the first end is `k (1 - length s^(-1/2)) d`: a power of the
//! squared distance, as gravity is one (see [`pairs`](crate::forces::series::pairs)), and a constant beside it in the factor of
//! order 0. Springs are added one after another, in the order in which they are listed, whether the lanes are eight of them or
//! systems: the same bits alone and in a batch.
//!
//! What else acts and is linear in the place and the velocity of each body is added order by order on the way.
//!
//! Where a spring is pressed together to nothing its force turns about, so steps end before (see
//! [`apart`](crate::forces::series::apart)).

use super::Kernel;
use crate::error::Result;
use crate::forces::series::Series;
use crate::forces::series::apart::Apart;
use crate::forces::series::beside::Beside;
use crate::forces::series::pairs::{Kept, Orders, Pairs, Whole};
use crate::numerics::element::{Element, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
use crate::tiered;
use eights::{Eight, Eights};

mod eights;

/// Ends that are so small a part of its length apart as good as meet.
const NOTHING: f64 = 64.0 * f64::EPSILON;

/// Some springs in each register.
pub(super) struct SpringSeries {
    springs: Springs,
    kept: Kept<Lanes>,
    /// Of each register, the distance of ends that makes no difference.
    near: Vec<Lanes>,
    beside: Beside,
}

/// What springs are made of, register by register, and how they lie.
struct Springs {
    k: Vec<Lanes>,
    length: Vec<Lanes>,
    /// No zero where there is no length, so that the ends may meet.
    softening2: Vec<Lanes>,
    inverse_mass: Vec<Lanes>,
    rows: usize,
    lie: Lie,
}

enum Lie {
    /// One of each of eight systems, between these rows.
    Each(Vec<(usize, usize)>),
    /// Eight of one system.
    Eights(Vec<Eight>),
}

impl SpringSeries {
    pub(super) fn new(kernel: Kernel) -> Self {
        let Kernel { linked, k, length, .. } = kernel;
        let ends: Vec<(usize, usize)> = linked.links.iter().map(|&(_, ends)| ends).collect();
        let (k, length, lie) = if linked.packed {
            let eights =
                ends.chunks(WIDTH).map(|springs| Eight::new(springs, &linked.inverse_mass)).collect();
            (abreast(&k), abreast(&length), Lie::Eights(eights))
        } else {
            let bodies = linked.shape.rows / linked.blocks.max(1);
            let own = |block: usize| ends.iter().map(move |&(i, j)| (block * bodies + i, block * bodies + j));
            (k, length, Lie::Each((0..linked.blocks).flat_map(own).collect()))
        };
        let none =
            |length: &Lanes, of: f64, other: f64| length.map(|l| if l == 0.0 { other } else { of * l });
        Self {
            kept: Kept::new(linked.shape, k.len()),
            beside: Beside::default(),
            near: length.iter().map(|length| none(length, NOTHING, f64::INFINITY)).collect(),
            springs: Springs {
                softening2: length.iter().map(|length| none(length, 0.0, 1.0)).collect(),
                k,
                length,
                inverse_mass: linked.inverse_mass,
                rows: linked.shape.rows,
                lie,
            },
        }
    }
}

/// Numbers that are the same in all lanes, eight in each register.
fn abreast(numbers: &[Lanes]) -> Vec<Lanes> {
    let eight = |eight: &[Lanes]| {
        Lanes(core::array::from_fn(|lane| eight.get(lane).map_or(0.0, |number| number.0[0])))
    };
    numbers.chunks(WIDTH).map(eight).collect()
}

/// Springs in the registers of a tier.
struct Seen<'a, V> {
    k: &'a [V],
    length: &'a [V],
    softening2: &'a [V],
}

impl Springs {
    #[inline(always)]
    fn seen<V: View<Lanes>>(&self) -> Seen<'_, V> {
        Seen { k: V::view(&self.k), length: V::view(&self.length), softening2: V::view(&self.softening2) }
    }
}

impl<V: Real> Seen<'_, V> {
    /// The power of order 0, and the factor of the difference.
    #[inline(always)]
    fn begin(&self, register: usize, [square, inverse]: [V; 2], unit2: V) -> [V; 2] {
        let (k, length) = (unit2 * self.k[register], self.length[register]);
        let r = square.sqrt();
        let per_r = r * inverse;
        let stretched = V::select(length.less_equal(V::zero()), V::one(), (r - length) * per_r);
        [-(k * length) * per_r, k * stretched]
    }
}

/// [`Lie::Each`].
struct Each<'a, V> {
    seen: Seen<'a, V>,
    beside: &'a Beside,
    ends: &'a [(usize, usize)],
    inverse_mass: &'a [V],
    rows: usize,
}

impl<V: View<Lanes> + Vector8> Pairs<V> for Each<'_, V> {
    const EXPONENT: f64 = -0.5;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.ends.len()
    }
    #[inline(always)]
    fn softening2(&self, register: usize) -> V {
        self.seen.softening2[register]
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        let (from, to) = self.ends[register];
        component[to] - component[from]
    }
    #[inline(always)]
    fn begin(&self, register: usize, squares: [V; 2], unit2: V) -> [V; 2] {
        self.seen.begin(register, squares, unit2)
    }
    #[inline(always)]
    fn beside(&self, n: usize, coefficients: [&[V]; 2], a: &mut [V]) {
        self.beside.add(n, coefficients, a);
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool) {
        if first {
            a.fill(V::zero());
        }
        for (pull, &(i, j)) in pulls.iter().zip(self.ends) {
            for c in 0..C {
                let (at, other) = (c * self.rows + i, c * self.rows + j);
                a[at] = self.inverse_mass[i].multiply_add(pull[c], a[at]);
                a[other] = self.inverse_mass[j].multiply_subtract_from(pull[c], a[other]);
            }
        }
    }
}

#[inline(always)]
fn one_order<V: Vector8 + InverseCube>((springs, beside): (&Springs, &Beside), orders: Orders<'_, Lanes>) {
    let (seen, rows) = (springs.seen::<V>(), springs.rows);
    match &springs.lie {
        Lie::Each(ends) => {
            let inverse_mass = Vector8::view(&springs.inverse_mass);
            orders.run::<V, _>(&Each { seen, beside, ends, inverse_mass, rows });
        }
        Lie::Eights(eights) => orders.run::<V, _>(&Eights { seen, beside, eights, rows }),
    }
}

#[inline(always)]
fn all_orders<V: Vector8 + InverseCube>((springs, beside): (&Springs, &Beside), whole: Whole<'_, Lanes>) {
    let (seen, rows) = (springs.seen::<V>(), springs.rows);
    match &springs.lie {
        Lie::Each(ends) => {
            let inverse_mass = Vector8::view(&springs.inverse_mass);
            whole.run::<V, _>(&Each { seen, beside, ends, inverse_mass, rows });
        }
        Lie::Eights(eights) => whole.run::<V, _>(&Eights { seen, beside, eights, rows }),
    }
}

tiered! {
    fn one_order_tier[][](springs: (&Springs, &Beside), orders: Orders<'_, Lanes>) = one_order;
    fn all_orders_tier[][](springs: (&Springs, &Beside), whole: Whole<'_, Lanes>) = all_orders;
}

impl Series<Lanes> for SpringSeries {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        one_order_tier((&self.springs, &self.beside), Orders { kept: &mut self.kept, jet, n, a, first });
        self.beside.coefficient(n, jet, a, ticker)
    }
    fn takes_linear(&self) -> bool {
        true
    }
    fn take_linear(&mut self, linear: Vec<Box<dyn Series<Lanes>>>) {
        self.beside = Beside::new(linear);
    }
    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], ticker: &mut Ticker<'_>) -> Result<()> {
        self.beside.look(jet, a, self.springs.rows, ticker)?;
        all_orders_tier((&self.springs, &self.beside), Whole { kept: &mut self.kept, jet, a });
        Ok(())
    }
    fn smooth_until(&self, jet: &Jet<Lanes>, h: Lanes) -> Option<Lanes> {
        Some(Lanes::pass(Apart { kept: &self.kept, near: &self.near, jet, h: &h }))
    }
}
