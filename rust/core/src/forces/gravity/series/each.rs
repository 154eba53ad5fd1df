//! A pair in each register: of one trajectory, or of eight in lanes.

use super::pair::{Beside, Between};
use super::{Kept, Orders, Pairs, Whole};
use crate::error::Result;
use crate::forces::series::Series;
use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// Pairs of bodies, a row each.
pub struct EachPair<S> {
    bodies: Ring<S>,
    kept: Kept<S>,
    /// Two bodies, with nothing beside them.
    pair: Option<Box<Between>>,
}

/// Massive bodies on a ring, and massless ones after them.
struct Ring<S> {
    /// The pairs `i, i + distance`, distance by distance; of the longest one in an even number, each once. Then those of each
    /// massless body with every massive one.
    pairs: Vec<(usize, usize)>,
    strength: Vec<S>,
    softening2: f64,
    rows: usize,
}

impl<S: Element> EachPair<S> {
    /// From the `G·m` of the massive bodies, which come first.
    pub fn new(shape: Shape, strength: Vec<S>, softening: f64) -> Self {
        let n = strength.len();
        let pairs = (1..=n / 2).flat_map(|distance| {
            let count = if 2 * distance == n { distance } else { n };
            (0..count).map(move |i| (i, (i + distance) % n))
        });
        let massless = (n..shape.rows).flat_map(|i| (0..n).map(move |massive| (i, massive)));
        let pairs: Vec<_> = pairs.chain(massless).collect();
        let kept = Kept::new(shape, pairs.len());
        let softening2 = softening * softening;
        let pair = (n == 2 && shape.rows == 2).then(|| Box::new(Between::new(softening2)));
        Self { bodies: Ring { pairs, strength, softening2, rows: shape.rows }, kept, pair }
    }
}

/// [`Ring`] in the registers of a tier.
struct Seen<'a, V> {
    pairs: &'a [(usize, usize)],
    strength: &'a [V],
    softening2: f64,
    rows: usize,
}

impl<S: Element> Ring<S> {
    #[inline(always)]
    fn seen<V: View<S>>(&self) -> Seen<'_, V> {
        let Self { pairs, strength, softening2, rows } = self;
        Seen { pairs, strength: V::view(strength), softening2: *softening2, rows: *rows }
    }
}

impl<V: Real> Pairs<V> for Seen<'_, V> {
    #[inline(always)]
    fn registers(&self) -> usize {
        self.pairs.len()
    }
    #[inline(always)]
    fn softening2(&self, _: usize) -> V {
        V::splat(self.softening2)
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        let (from, to) = self.pairs[register];
        component[to] - component[from]
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool) {
        let n = self.strength.len();
        for i in 0..n {
            let mut sum = [V::zero(); C];
            let (mut ahead, mut behind) = (i, i);
            for distance in 1..=n / 2 {
                ahead = if ahead + 1 == n { 0 } else { ahead + 1 };
                behind = if behind == 0 { n - 1 } else { behind - 1 };
                let own = (distance - 1) * n;
                let opposite = ahead == behind;
                if !opposite || i < ahead {
                    for c in 0..C {
                        sum[c] = self.strength[ahead].multiply_add(pulls[own + i][c], sum[c]);
                    }
                }
                if !opposite || behind < i {
                    for c in 0..C {
                        sum[c] = self.strength[behind].multiply_subtract_from(pulls[own + behind][c], sum[c]);
                    }
                }
            }
            for c in 0..C {
                let a = &mut a[c * self.rows + i];
                *a = if first { sum[c] } else { *a + sum[c] };
            }
        }
        let on_massless = &pulls[n * (n - 1) / 2..];
        for (i, pulls) in (n..self.rows).zip(on_massless.chunks_exact(n)) {
            let mut sum = [V::zero(); C];
            for (pull, &strength) in pulls.iter().zip(self.strength) {
                for c in 0..C {
                    sum[c] = strength.multiply_add(pull[c], sum[c]);
                }
            }
            for c in 0..C {
                let a = &mut a[c * self.rows + i];
                *a = if first { sum[c] } else { *a + sum[c] };
            }
        }
    }
}

struct OneOrder<'a, S>(&'a Ring<S>, Orders<'a, S>);
struct AllOrders<'a, S>(&'a Ring<S>, Whole<'a, S>);

impl<S: Element> Pass<S> for OneOrder<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        self.1.run::<V, Seen<'_, V>>(&self.0.seen());
    }
}

impl<S: Element> Pass<S> for AllOrders<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        self.1.run::<V, Seen<'_, V>>(&self.0.seen());
    }
}

impl<S: Element> Series<S> for EachPair<S> {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<S>,
        a: &mut [S],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        S::pass(OneOrder(&self.bodies, Orders { kept: &mut self.kept, jet, n, a, first }));
        Ok(())
    }
    fn expand(&mut self, jet: &mut Jet<S>, a: &mut [S], _: &mut Ticker<'_>) -> Result<()> {
        if let Some(between) = &self.pair {
            S::pass(Beside { between, strength: &self.bodies.strength, jet });
            return Ok(());
        }
        S::pass(AllOrders(&self.bodies, Whole { kept: &mut self.kept, jet, a }));
        Ok(())
    }
}
