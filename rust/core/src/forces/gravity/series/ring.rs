//! Up to eight bodies of one trajectory, the lanes over the bodies: all pairs at one distance around the ring in a register.

use super::pair::Along;
use super::{Kept, Orders, Pairs, Whole};
use crate::error::Result;
use crate::forces::series::Series;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::ode::series::Jet;
use crate::parallel::Ticker;
use crate::tiered;

/// The pairs at one distance.
struct Turn {
    forward: [i64; WIDTH],
    backward: [i64; WIDTH],
    /// `G·m` of the body ahead, and of the one behind; `None` when that is the same body.
    ahead: Lanes,
    behind: Option<Lanes>,
}

struct Turns {
    turns: Vec<Turn>,
    /// 1 in the lanes without a body.
    softening2: Lanes,
    rows: usize,
}

/// Pairs around the ring of the bodies in row 0.
pub struct RingPairs {
    bodies: Turns,
    shape: Shape,
    kept: Option<Kept<Lanes>>,
    /// Two bodies.
    pair: Option<Box<Along>>,
}

impl RingPairs {
    /// From the `G·m` of the bodies, at most [`RING_MAX`](super::RING_MAX) of them.
    pub fn new(shape: Shape, strength: &[f64], softening: f64) -> Self {
        let n = strength.len();
        let body = |lane: usize, distance: usize| if lane < n { (lane + distance) % n } else { lane };
        let weights = |distance: usize| {
            Lanes(core::array::from_fn(|lane| if lane < n { strength[(lane + distance) % n] } else { 0.0 }))
        };
        let turn = |k: usize| Turn {
            forward: core::array::from_fn(|lane| body(lane, k) as i64),
            backward: core::array::from_fn(|lane| body(lane, n - k) as i64),
            ahead: weights(k),
            behind: (2 * k != n).then(|| weights(n - k)),
        };
        let turns: Vec<Turn> = (1..=n / 2).map(turn).collect();
        let softening2 =
            Lanes(core::array::from_fn(|lane| if lane < n { softening * softening } else { 1.0 }));
        let pair = match strength {
            &[first, second] if shape.rows == 1 => {
                Some(Box::new(Along::new([first, second], softening * softening)))
            }
            _ => None,
        };
        // Two bodies under nothing else need none.
        let kept = pair.is_none().then(|| Kept::new(shape, turns.len()));
        Self { bodies: Turns { turns, softening2, rows: shape.rows }, shape, kept, pair }
    }
}

impl<V: Vector8> Pairs<V> for Turns {
    const IN_FULL: bool = true;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.turns.len()
    }
    #[inline(always)]
    fn softening2(&self, _: usize) -> V {
        V::load(self.softening2)
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        let place = component[0];
        place.permute(&self.turns[register].forward) - place
    }
    #[inline(always)]
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool) {
        let mut sum = [V::zero(); C];
        for (index, turn) in self.turns.iter().enumerate() {
            let pull = &pulls[index];
            let ahead = V::load(turn.ahead);
            for c in 0..C {
                sum[c] = ahead.multiply_add(pull[c], sum[c]);
            }
            if let Some(behind) = turn.behind {
                let behind = V::load(behind);
                for c in 0..C {
                    sum[c] = behind.multiply_subtract_from(pull[c].permute(&turn.backward), sum[c]);
                }
            }
        }
        for c in 0..C {
            let a = &mut a[c * self.rows];
            *a = if first { sum[c] } else { *a + sum[c] };
        }
    }
}

#[inline(always)]
fn one_order<V: Vector8 + InverseCube>(bodies: &Turns, orders: Orders<'_, Lanes>) {
    orders.run::<V, Turns>(bodies);
}

#[inline(always)]
fn all_orders<V: Vector8 + InverseCube>(bodies: &Turns, whole: Whole<'_, Lanes>) {
    whole.run::<V, Turns>(bodies);
}

tiered! {
    fn one_order_tier[][](bodies: &Turns, orders: Orders<'_, Lanes>) = one_order;
    fn all_orders_tier[][](bodies: &Turns, whole: Whole<'_, Lanes>) = all_orders;
}

impl Series<Lanes> for RingPairs {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let kept = self.kept.get_or_insert_with(|| Kept::new(self.shape, self.bodies.turns.len()));
        one_order_tier(&self.bodies, Orders { kept, jet, n, a, first });
        Ok(())
    }
    fn expand(&mut self, jet: &mut Jet<Lanes>, a: &mut [Lanes], _: &mut Ticker<'_>) -> Result<()> {
        if let Some(pair) = &mut self.pair {
            pair.expand(jet);
            return Ok(());
        }
        let kept = self.kept.get_or_insert_with(|| Kept::new(self.shape, self.bodies.turns.len()));
        all_orders_tier(&self.bodies, Whole { kept, jet, a });
        Ok(())
    }
}
