//! Springs of one system whose bodies are in lanes: eight springs in a register.
//!
//! The one idea: where the ends of eight springs are is a permutation of each row of bodies that has some, and what bodies have
//! from the eight is a permutation of the pulls, as often as a body is at an end: in their order, with zeros where there is
//! none.

use super::Seen;
use crate::forces::series::beside::Beside;
use crate::forces::series::pairs::Pairs;
use crate::numerics::element::View;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;

/// Eight springs of a system whose bodies are in lanes.
#[derive(Default)]
pub(super) struct Eight {
    /// Where their ends are.
    ends: [Vec<Part>; 2],
    /// What they do, in their order.
    shares: Vec<Share>,
}

/// Ends in a row of bodies.
struct Part {
    row: usize,
    /// The lane of each, and which of them are there.
    lanes: [i64; WIDTH],
    here: Bits,
}

/// What a row of bodies has from a spring at each of them.
struct Share {
    row: usize,
    /// Which of the eight.
    springs: [i64; WIDTH],
    /// 1/mass, negative at the second end and zero where there is none.
    weight: Lanes,
}

impl Eight {
    /// From the places of the ends of at most eight springs among the numbers of a component.
    pub(super) fn new(springs: &[(usize, usize)], inverse_mass: &[Lanes]) -> Self {
        let mut eight = Self::default();
        for (spring, &(i, j)) in springs.iter().enumerate() {
            for (end, (place, sign)) in [(i, 1.0), (j, -1.0)].into_iter().enumerate() {
                let (row, lane) = (place / WIDTH, place % WIDTH);
                let parts = &mut eight.ends[end];
                let known = parts.iter().position(|part| part.row == row).unwrap_or_else(|| {
                    parts.push(Part { row, lanes: [0; WIDTH], here: Bits(0) });
                    parts.len() - 1
                });
                parts[known].lanes[spring] = lane as i64;
                parts[known].here.0 |= 1 << spring;
                // The first of the row that has nothing at this body: what is there already acts before.
                let free = |share: &Share| share.row == row && share.weight.0[lane] == 0.0;
                let known = eight.shares.iter().position(free).unwrap_or_else(|| {
                    eight.shares.push(Share { row, springs: [0; WIDTH], weight: Lanes::zero() });
                    eight.shares.len() - 1
                });
                let share = &mut eight.shares[known];
                share.springs[lane] = spring as i64;
                share.weight.0[lane] = sign * inverse_mass[row].0[lane];
            }
        }
        eight
    }
}

/// Springs of one system, eight in each register.
pub(super) struct Eights<'a, V> {
    pub(super) seen: Seen<'a, V>,
    pub(super) beside: &'a Beside,
    pub(super) eights: &'a [Eight],
    pub(super) rows: usize,
}

impl<V: View<Lanes> + Vector8> Pairs<V> for Eights<'_, V> {
    const EXPONENT: f64 = -0.5;
    #[inline(always)]
    fn registers(&self) -> usize {
        self.eights.len()
    }
    #[inline(always)]
    fn softening2(&self, register: usize) -> V {
        self.seen.softening2[register]
    }
    #[inline(always)]
    fn difference(&self, register: usize, _: (usize, usize), component: &[V]) -> V {
        let mut places = [V::zero(); 2];
        for (place, parts) in places.iter_mut().zip(&self.eights[register].ends) {
            for part in parts {
                *place = V::select(part.here, component[part.row].permute(&part.lanes), *place);
            }
        }
        places[1] - places[0]
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
        for (pull, eight) in pulls.iter().zip(self.eights) {
            for share in &eight.shares {
                let weight = <V as Vector8>::load(share.weight);
                for c in 0..C {
                    let a = &mut a[c * self.rows + share.row];
                    *a = weight.multiply_add(pull[c].permute(&share.springs), *a);
                }
            }
        }
    }
}
