//! Links of one system whose bodies are in lanes: eight links in a register.
//!
//! The one idea: where the ends of eight links are is a permutation of each row of bodies that has some, and what bodies have
//! from the eight is a permutation of the pulls, as often as a body is at an end: in their order, with zeros where there is
//! none.

use super::Lie;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Real;

/// Eight links of a system whose bodies are in lanes.
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

/// What a row of bodies has from a link at each of them.
struct Share {
    row: usize,
    /// Which of the eight.
    links: [i64; WIDTH],
    /// 1/mass, negative at the second end and zero where there is none.
    weight: Lanes,
}

impl Eight {
    /// From the places of the ends of at most eight links among the numbers of a component.
    pub(super) fn new(links: &[(usize, usize)], inverse_mass: &[Lanes]) -> Self {
        let mut eight = Self::default();
        for (link, &(i, j)) in links.iter().enumerate() {
            for (end, (place, sign)) in [(i, 1.0), (j, -1.0)].into_iter().enumerate() {
                let (row, lane) = (place / WIDTH, place % WIDTH);
                let parts = &mut eight.ends[end];
                let known = parts.iter().position(|part| part.row == row).unwrap_or_else(|| {
                    parts.push(Part { row, lanes: [0; WIDTH], here: Bits(0) });
                    parts.len() - 1
                });
                parts[known].lanes[link] = lane as i64;
                parts[known].here.0 |= 1 << link;
                // The first of the row that has nothing at this body: what is there already acts before.
                let free = |share: &Share| share.row == row && share.weight.0[lane] == 0.0;
                let known = eight.shares.iter().position(free).unwrap_or_else(|| {
                    eight.shares.push(Share { row, links: [0; WIDTH], weight: Lanes::zero() });
                    eight.shares.len() - 1
                });
                let share = &mut eight.shares[known];
                share.links[lane] = link as i64;
                share.weight.0[lane] = sign * inverse_mass[row].0[lane];
            }
        }
        eight
    }
}

impl<V: Vector8> Lie<V> for [Eight] {
    #[inline(always)]
    fn registers(&self) -> usize {
        self.len()
    }
    #[inline(always)]
    fn difference(&self, register: usize, component: &[V]) -> V {
        let mut places = [V::zero(); 2];
        for (place, parts) in places.iter_mut().zip(&self[register].ends) {
            for part in parts {
                *place = V::select(part.here, component[part.row].permute(&part.lanes), *place);
            }
        }
        places[1] - places[0]
    }
    #[inline(always)]
    fn add<const C: usize>(&self, pulls: &[[V; C]], _: &[V], rows: usize, a: &mut [V]) {
        for (pull, eight) in pulls.iter().zip(self) {
            for share in &eight.shares {
                let weight = V::load(share.weight);
                for c in 0..C {
                    let a = &mut a[c * rows + share.row];
                    *a = weight.multiply_add(pull[c].permute(&share.links), *a);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::as_numbers;

    /// Nineteen links among twenty bodies, some of which many links join.
    #[test]
    fn links_act_in_their_order() {
        let links: Vec<(usize, usize)> = (0..19).map(|n| ((7 * n + 3) % 20, (n * n) % 5 + 20)).collect();
        let number = |n: usize| 1.0 / (3.0 + (n * n % 101) as f64);
        let rows = |offset: usize| -> Vec<Lanes> {
            (0..4)
                .map(|row| Lanes(core::array::from_fn(|lane| number(offset + row * WIDTH + lane))))
                .collect()
        };
        let (inverse_mass, place) = (rows(1), rows(40));
        let eights: Vec<Eight> = links.chunks(WIDTH).map(|eight| Eight::new(eight, &inverse_mass)).collect();
        let mut pulls = Vec::new();
        for (register, eight) in links.chunks(WIDTH).enumerate() {
            let difference: Lanes = eights[..].difference(register, &place);
            for (lane, &(i, j)) in eight.iter().enumerate() {
                assert_eq!(difference.0[lane], as_numbers(&place)[j] - as_numbers(&place)[i]);
            }
            pulls.push([difference, -difference]);
        }
        let (mut found, mut expected) = (rows(80).repeat(2), rows(80).repeat(2));
        eights[..].add(&pulls, &inverse_mass, 4, &mut found);
        let mass = as_numbers(&inverse_mass);
        for (n, &(i, j)) in links.iter().enumerate() {
            for (c, pull) in pulls[n / WIDTH].iter().enumerate() {
                for (body, sign) in [(i, 1.0), (j, -1.0)] {
                    let a = &mut expected[4 * c + body / WIDTH].0[body % WIDTH];
                    *a = (sign * mass[body]).mul_add(pull.0[n % WIDTH], *a);
                }
            }
        }
        assert_eq!(found, expected);
    }
}
