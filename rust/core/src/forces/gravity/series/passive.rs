//! One massless body in each lane, along series of the massive ones.

use super::few::FewPulls;
use super::{Kept, Orders, Pairs, Whole};
use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::Lanes;
use crate::ode::series::Jet;

/// Pulls of massive bodies on massless ones.
pub struct PullSeries {
    kept: Kept<Lanes>,
    softening2: f64,
    few: Option<Box<FewPulls>>,
}

/// Massive bodies by their coefficients, in the unit of time of those on whom they pull.
#[derive(Clone, Copy, Debug)]
pub struct Massive<'a, S> {
    /// Their `G·m`.
    pub strength: &'a [S],
    /// Blocks of coordinates, component after component, from order 0 on.
    pub places: &'a [S],
    /// What those of order 0 leave out.
    pub rests: &'a [S],
}

impl PullSeries {
    /// Of so many massive bodies in so many dimensions.
    pub fn new(massive: usize, components: usize, softening2: f64) -> Self {
        Self { kept: Kept::new(Shape { rows: 1, components }, massive), softening2, few: None }
    }

    /// The pulls of as many bodies on a few.
    pub fn few(&mut self) -> &mut FewPulls {
        let (massive, softening2) = (self.kept.registers(), self.softening2);
        let components = self.kept.components();
        self.few.get_or_insert_with(|| Box::new(FewPulls::new(massive, components, softening2)))
    }

    /// As [`Series::coefficient`](crate::forces::series::Series::coefficient).
    pub fn coefficient(
        &mut self,
        massive: Massive<'_, Lanes>,
        (n, jet): (usize, &Jet<Lanes>),
        a: &mut [Lanes],
        first: bool,
    ) {
        let orders = Orders { kept: &mut self.kept, jet, n, a, first };
        Lanes::pass(Pull { massive, softening2: self.softening2, orders });
    }

    /// As [`Series::expand`](crate::forces::series::Series::expand).
    pub fn expand(&mut self, massive: Massive<'_, Lanes>, jet: &mut Jet<Lanes>, a: &mut [Lanes]) {
        let whole = Whole { kept: &mut self.kept, jet, a };
        Lanes::pass(AllPulls { massive, softening2: self.softening2, whole });
    }
}

struct Pull<'a> {
    massive: Massive<'a, Lanes>,
    softening2: f64,
    orders: Orders<'a, Lanes>,
}

/// Of all orders.
struct AllPulls<'a> {
    massive: Massive<'a, Lanes>,
    softening2: f64,
    whole: Whole<'a, Lanes>,
}

impl Pass<Lanes> for Pull<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        self.orders.run::<V, Seen<'_, V>>(&Seen::of(self.massive, self.softening2));
    }
}

impl Pass<Lanes> for AllPulls<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        self.whole.run::<V, Seen<'_, V>>(&Seen::of(self.massive, self.softening2));
    }
}

struct Seen<'a, V> {
    massive: Massive<'a, V>,
    softening2: f64,
}

impl<'a, V: View<Lanes>> Seen<'a, V> {
    #[inline(always)]
    fn of(Massive { strength, places, rests }: Massive<'a, Lanes>, softening2: f64) -> Self {
        let massive = Massive { strength: V::view(strength), places: V::view(places), rests: V::view(rests) };
        Self { massive, softening2 }
    }
}

impl<V: InverseCube> Pairs<V> for Seen<'_, V> {
    const IN_FULL: bool = true;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.massive.strength.len()
    }
    #[inline(always)]
    fn softening2(&self, _: usize) -> V {
        V::splat(self.softening2)
    }
    #[inline(always)]
    fn difference(&self, register: usize, (n, c): (usize, usize), component: &[V]) -> V {
        let Massive { strength, places, rests } = self.massive;
        places[n * rests.len() + c * strength.len() + register] - component[0]
    }
    #[inline(always)]
    fn rest(&self, register: usize, c: usize, component: &[V]) -> V {
        let Massive { strength, rests, .. } = self.massive;
        rests[c * strength.len() + register] - component[0]
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool) {
        let mut sum = [V::zero(); C];
        for (pull, &strength) in pulls.iter().zip(self.massive.strength) {
            for c in 0..C {
                sum[c] = strength.multiply_add(pull[c], sum[c]);
            }
        }
        for c in 0..C {
            a[c] = if first { sum[c] } else { a[c] + sum[c] };
        }
    }
}
