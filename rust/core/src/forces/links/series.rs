//! Forces along links as recurrences of Taylor coefficients.
//!
//! The one idea: they are powers of the squared distance, as gravity is one, or its rate over it (see
//! [`pairs`](crate::forces::series::pairs)). Links are added one after another, in the order in which they are listed, whether
//! the lanes are eight of them or systems: the same bits alone and in a batch. What else acts and is linear in the place and the
//! velocity of each body is added order by order on the way.
//!
//! Where the ends of a link meet its force turns about, so steps end before (see [`apart`](crate::forces::series::apart)).

use super::{Linked, OfLinks};
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
use core::marker::PhantomData;
use eights::Eight;

mod eights;

/// Two numbers of which a law of links is made.
pub(in crate::forces) type Numbers<V> = [V; 2];

/// What a link does; the numbers are those of links in a register, zeros where there is none.
pub(in crate::forces) trait LinkLaw: Send + 'static {
    /// As [`Pairs::EXPONENT`].
    const EXPONENT: f64;
    /// As [`Pairs::BY_RATE`].
    const BY_RATE: bool = false;
    /// Whether the law does not ask for a direction, so that the ends may meet.
    fn may_meet(of: Numbers<f64>) -> bool;
    /// The distance of the ends that makes no difference.
    fn near(of: Numbers<f64>) -> f64;
    /// As [`Pairs::begin`].
    #[inline(always)]
    fn begin<V: Real>(_of: Numbers<V>, _squares: [V; 2], unit2: V) -> [V; 2] {
        [unit2; 2]
    }
    /// As [`Pairs::of_rate`].
    #[inline(always)]
    fn of_rate<V: Real>(_of: Numbers<V>, unit: V) -> V {
        unit
    }
}

/// Some links in each register.
pub(in crate::forces) struct LinkSeries<L> {
    lying: Lying<L>,
    kept: Kept<Lanes>,
    /// Of each register, the distance of the ends that makes no difference.
    near: Vec<Lanes>,
    beside: Beside,
}

/// What links are made of, register by register, and how they lie.
struct Lying<L> {
    numbers: Numbers<OfLinks>,
    /// No zero where the ends may meet.
    softening2: Vec<Lanes>,
    inverse_mass: Vec<Lanes>,
    rows: usize,
    ends: Ends,
    law: PhantomData<L>,
}

enum Ends {
    /// A link of each of eight systems, between these rows.
    Each(Vec<(usize, usize)>),
    /// Eight of one system.
    Eights(Vec<Eight>),
}

impl<L: LinkLaw> LinkSeries<L> {
    pub(in crate::forces) fn new(linked: Linked, numbers: Numbers<OfLinks>) -> Self {
        let ends = linked.links.iter().map(|&(_, ends)| ends);
        let (numbers, ends) = if linked.packed {
            let all: Vec<(usize, usize)> = ends.collect();
            let eights = all.chunks(WIDTH).map(|eight| Eight::new(eight, &linked.inverse_mass)).collect();
            (numbers.map(|numbers| abreast(&numbers)), Ends::Eights(eights))
        } else {
            let bodies = linked.shape.rows / linked.blocks.max(1);
            let own = |block: usize| ends.clone().map(move |(i, j)| (block * bodies + i, block * bodies + j));
            let each = (0..linked.blocks).flat_map(own).collect();
            (numbers, Ends::Each(each))
        };
        let of_each = |of: fn(Numbers<f64>) -> f64| -> Vec<Lanes> {
            let lanes = |(one, other): (&Lanes, &Lanes)| {
                Lanes(core::array::from_fn(|lane| of([one.0[lane], other.0[lane]])))
            };
            numbers[0].iter().zip(&numbers[1]).map(lanes).collect()
        };
        let near = of_each(|of| if L::may_meet(of) { f64::INFINITY } else { L::near(of) });
        let softening2 = of_each(|of| if L::may_meet(of) { 1.0 } else { 0.0 });
        let (rows, law) = (linked.shape.rows, PhantomData);
        Self {
            kept: Kept::new(linked.shape, near.len()),
            near,
            beside: Beside::default(),
            lying: Lying { numbers, softening2, inverse_mass: linked.inverse_mass, rows, ends, law },
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

/// Links in the registers of a tier, and where their ends are.
struct Seen<'a, V, L, E: ?Sized> {
    numbers: Numbers<&'a [V]>,
    softening2: &'a [V],
    inverse_mass: &'a [V],
    rows: usize,
    beside: &'a Beside,
    ends: &'a E,
    law: PhantomData<L>,
}

impl<L: LinkLaw> Lying<L> {
    #[inline(always)]
    fn seen<'a, V: View<Lanes>, E: ?Sized>(&'a self, ends: &'a E, beside: &'a Beside) -> Seen<'a, V, L, E> {
        let [one, other] = &self.numbers;
        Seen {
            numbers: [V::view(one), V::view(other)],
            softening2: V::view(&self.softening2),
            inverse_mass: V::view(&self.inverse_mass),
            rows: self.rows,
            beside,
            ends,
            law: PhantomData,
        }
    }
}

/// How ends lie among the rows of bodies.
trait Lie<V> {
    /// How many registers hold all links.
    fn registers(&self) -> usize;
    /// As [`Pairs::difference`].
    fn difference(&self, register: usize, component: &[V]) -> V;
    /// Adds what the pulls do to the accelerations of bodies of these masses, of which there are so many rows.
    fn add<const C: usize>(&self, pulls: &[[V; C]], inverse_mass: &[V], rows: usize, a: &mut [V]);
}

impl<V: Real> Lie<V> for [(usize, usize)] {
    #[inline(always)]
    fn registers(&self) -> usize {
        self.len()
    }
    #[inline(always)]
    fn difference(&self, register: usize, component: &[V]) -> V {
        let (from, to) = self[register];
        component[to] - component[from]
    }
    #[inline(always)]
    fn add<const C: usize>(&self, pulls: &[[V; C]], inverse_mass: &[V], rows: usize, a: &mut [V]) {
        for (pull, &(i, j)) in pulls.iter().zip(self) {
            for c in 0..C {
                let (at, other) = (c * rows + i, c * rows + j);
                a[at] = inverse_mass[i].multiply_add(pull[c], a[at]);
                a[other] = inverse_mass[j].multiply_subtract_from(pull[c], a[other]);
            }
        }
    }
}

impl<V: View<Lanes>, L: LinkLaw, E: Lie<V> + ?Sized> Pairs<V> for Seen<'_, V, L, E> {
    const EXPONENT: f64 = L::EXPONENT;
    const BY_RATE: bool = L::BY_RATE;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.ends.registers()
    }
    #[inline(always)]
    fn softening2(&self, register: usize) -> V {
        self.softening2[register]
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        self.ends.difference(register, component)
    }
    #[inline(always)]
    fn begin(&self, register: usize, squares: [V; 2], unit2: V) -> [V; 2] {
        L::begin([self.numbers[0][register], self.numbers[1][register]], squares, unit2)
    }
    #[inline(always)]
    fn of_rate(&self, register: usize, unit: V) -> V {
        L::of_rate([self.numbers[0][register], self.numbers[1][register]], unit)
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
        self.ends.add::<C>(pulls, self.inverse_mass, self.rows, a);
    }
}

#[inline(always)]
fn one_order<V: Vector8 + InverseCube, L: LinkLaw>(
    (lying, beside): (&Lying<L>, &Beside),
    orders: Orders<'_, Lanes>,
) {
    match &lying.ends {
        Ends::Each(ends) => orders.run::<V, _>(&lying.seen::<V, _>(&ends[..], beside)),
        Ends::Eights(ends) => orders.run::<V, _>(&lying.seen::<V, _>(&ends[..], beside)),
    }
}

#[inline(always)]
fn all_orders<V: Vector8 + InverseCube, L: LinkLaw>(
    (lying, beside): (&Lying<L>, &Beside),
    whole: Whole<'_, Lanes>,
) {
    match &lying.ends {
        Ends::Each(ends) => whole.run::<V, _>(&lying.seen::<V, _>(&ends[..], beside)),
        Ends::Eights(ends) => whole.run::<V, _>(&lying.seen::<V, _>(&ends[..], beside)),
    }
}

tiered! {
    fn one_order_tier[L: LinkLaw][L](links: (&Lying<L>, &Beside), orders: Orders<'_, Lanes>) = one_order;
    fn all_orders_tier[L: LinkLaw][L](links: (&Lying<L>, &Beside), whole: Whole<'_, Lanes>) = all_orders;
}

impl<L: LinkLaw> Series<Lanes> for LinkSeries<L> {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        one_order_tier((&self.lying, &self.beside), Orders { kept: &mut self.kept, jet, n, a, first });
        self.beside.coefficient(n, jet, a, ticker)
    }
    fn takes_linear(&self) -> bool {
        true
    }
    fn take_linear(&mut self, linear: Vec<Box<dyn Series<Lanes>>>) {
        self.beside = Beside::new(linear);
    }
    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], ticker: &mut Ticker<'_>) -> Result<()> {
        self.beside.look(jet, a, self.lying.rows, ticker)?;
        all_orders_tier((&self.lying, &self.beside), Whole { kept: &mut self.kept, jet, a });
        Ok(())
    }
    fn smooth_until(&self, jet: &Jet<Lanes>, h: &Lanes) -> Option<Lanes> {
        Some(Lanes::pass(Apart { kept: &self.kept, near: &self.near, jet, h }))
    }
}
