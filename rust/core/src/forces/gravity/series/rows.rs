//! Many bodies of one trajectory: those that have a mass pull whole rows of eight, in order of index.

use super::{Kept, Orders, Pairs, Whole};
use crate::error::Result;
use crate::forces::series::Series;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
use crate::tiered;

struct Bodies {
    strength: Vec<f64>,
    softening2: f64,
    rows: usize,
    /// 1 in the lanes of the first row where something is to be pulled.
    pulled: Lanes,
}

/// Every massive body with every row of bodies: what a body does to itself is zero.
pub(super) struct RowPairs {
    bodies: Bodies,
    kept: Kept<Lanes>,
}

impl RowPairs {
    /// From the `G·m` of the massive bodies, which come first.
    pub(super) fn new(shape: Shape, strength: Vec<f64>, softening: f64) -> Self {
        Self::on(shape, strength, softening, Lanes::one())
    }

    /// As [`Self::new`], of at most a row of massive bodies, which somebody else pulls.
    pub(super) fn beside(shape: Shape, strength: Vec<f64>, softening: f64) -> Self {
        let massive = strength.len();
        let pulled = Lanes(core::array::from_fn(|lane| if lane < massive { 0.0 } else { 1.0 }));
        Self::on(shape, strength, softening, pulled)
    }

    fn on(shape: Shape, strength: Vec<f64>, softening: f64, pulled: Lanes) -> Self {
        let kept = Kept::new(shape, shape.rows * strength.len());
        let bodies = Bodies { strength, softening2: softening * softening, rows: shape.rows, pulled };
        Self { bodies, kept }
    }
}

impl<V: Vector8> Pairs<V> for Bodies {
    #[inline(always)]
    fn registers(&self) -> usize {
        self.rows * self.strength.len()
    }
    #[inline(always)]
    fn softening2(&self, register: usize) -> V {
        let (row, body) = (register / self.strength.len(), register % self.strength.len());
        let mut own = Lanes([self.softening2; WIDTH]);
        if body / WIDTH == row {
            own.0[body % WIDTH] += 1.0;
        }
        V::load(own)
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        let (row, body) = (register / self.strength.len(), register % self.strength.len());
        V::splat(component[body / WIDTH].store().0[body % WIDTH]) - component[row]
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool) {
        for (row, pulls) in pulls.chunks_exact(self.strength.len()).enumerate() {
            let mut sum = [V::zero(); C];
            for (pull, &strength) in pulls.iter().zip(&self.strength) {
                for c in 0..C {
                    sum[c] = V::splat(strength).multiply_add(pull[c], sum[c]);
                }
            }
            if row == 0 {
                let pulled = V::zero().less(V::load(self.pulled));
                sum = sum.map(|sum| V::select(pulled, sum, V::zero()));
            }
            for c in 0..C {
                let a = &mut a[c * self.rows + row];
                *a = if first { sum[c] } else { *a + sum[c] };
            }
        }
    }
}

#[inline(always)]
fn one_order<V: Vector8 + InverseCube>(bodies: &Bodies, orders: Orders<'_, Lanes>) {
    orders.run::<V, Bodies>(bodies);
}

#[inline(always)]
fn all_orders<V: Vector8 + InverseCube>(bodies: &Bodies, whole: Whole<'_, Lanes>) {
    whole.run::<V, Bodies>(bodies);
}

tiered! {
    fn one_order_tier[][](bodies: &Bodies, orders: Orders<'_, Lanes>) = one_order;
    fn all_orders_tier[][](bodies: &Bodies, whole: Whole<'_, Lanes>) = all_orders;
}

impl Series<Lanes> for RowPairs {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        one_order_tier(&self.bodies, Orders { kept: &mut self.kept, jet, n, a, first });
        Ok(())
    }
    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], _: &mut Ticker<'_>) -> Result<()> {
        all_orders_tier(&self.bodies, Whole { kept: &mut self.kept, jet, a });
        Ok(())
    }
}
