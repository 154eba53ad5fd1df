//! Order conditions of a splitting for `q'' = a(q)` alone: special Nyström trees.
//!
//! Such a splitting is a Nyström method: kick `i` is at `q + h c_i v + h² Σ_j b_j (c_i - c_j) a_j`, with `c` the drifts so
//! far, and its coordinates have weights `b_i (1 - c_i)`, with which their conditions follow from those of the velocities.
//! A vertex is an acceleration; a child is a velocity, by itself or with an acceleration beneath. The time is a coordinate
//! like any other, with the velocity 1.
//! Source: Hairer, Nørsett & Wanner, *Solving ODE I*, II.14, theorem 14.10 and lemma 14.13.

use super::{Family, Kind, splitting};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// A table that a test may change.
#[derive(Clone)]
pub(super) struct Table(pub(super) splitting::Table);

/// What hangs on a vertex, or several such things: the exact value at the end of a step over all its integrals, the values
/// at the kicks, and the magnitudes of their terms.
#[derive(Clone)]
struct Branch {
    exact: DoubleDouble,
    values: Vec<(DoubleDouble, f64)>,
}

impl Branch {
    fn times(&self, other: &Self) -> Self {
        let pairs = self.values.iter().zip(&other.values);
        let values = pairs.map(|(x, y)| (x.0 * y.0, x.1 * y.1)).collect();
        Self { exact: self.exact * other.exact, values }
    }
}

/// Every collection of children with `missing` vertices in all, none of more than `largest` and of those only the first
/// `limit`.
fn collections(
    children: &[Vec<Branch>],
    missing: usize,
    largest: usize,
    limit: usize,
) -> Vec<Option<Branch>> {
    if missing == 0 {
        return vec![None];
    }
    let mut found = vec![];
    for size in 1..=missing.min(largest) {
        let all = children[size].len();
        for index in 0..if size == largest { limit.min(all) } else { all } {
            let branch = &children[size][index];
            for rest in collections(children, missing - size, size, index + 1) {
                found.push(Some(rest.map_or_else(|| branch.clone(), |rest| branch.times(&rest))));
            }
        }
    }
    found
}

impl Table {
    /// The worst miss over the trees of at most `order` vertices, and that of the whole drift from 1.
    pub(super) fn misses(&self, order: usize) -> Vec<Family> {
        let Self(splitting::Table { kicks, drifts }) = self;
        let mut nodes = vec![(DoubleDouble::zero(), 0.0)];
        for drift in drifts {
            let (node, magnitude) = nodes[nodes.len() - 1];
            nodes.push((node + *drift, magnitude + drift.to_f64().abs()));
        }
        let mut family = Family::new(Kind::Step);
        let end = nodes[nodes.len() - 1];
        family.note(end.0, DoubleDouble::one(), end.1);

        let mut children: Vec<Vec<Branch>> = vec![vec![]; order + 2];
        children[1].push(Branch { exact: DoubleDouble::one(), values: nodes.clone() });
        let leaf =
            Branch { exact: DoubleDouble::one(), values: vec![(DoubleDouble::one(), 1.0); kicks.len()] };
        for size in 1..=order {
            let number = |n: usize| DoubleDouble::from(n as f64);
            for tree in collections(&children, size - 1, size - 1, usize::MAX) {
                let tree = tree.unwrap_or_else(|| leaf.clone());
                let kicked = |(&kick, value): (&DoubleDouble, &(DoubleDouble, f64))| {
                    (kick * value.0, kick.to_f64().abs() * value.1)
                };
                let terms: Vec<_> = kicks.iter().zip(&tree.values).map(kicked).collect();
                let sum = |terms: &mut dyn Iterator<Item = (DoubleDouble, f64)>| {
                    terms.fold((DoubleDouble::zero(), 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
                };
                let (found, magnitude) = sum(&mut terms.iter().copied());
                family.note(found, tree.exact / number(size), magnitude);
                if size + 1 < order {
                    let at = |i: usize| {
                        sum(&mut (0..i).map(|j| {
                            let (between, size) = (nodes[i].0 - nodes[j].0, nodes[i].1 + nodes[j].1);
                            (terms[j].0 * between, terms[j].1 * size)
                        }))
                    };
                    children[size + 1].push(Branch {
                        exact: tree.exact / number(size * (size + 1)),
                        values: (0..kicks.len()).map(at).collect(),
                    });
                }
            }
        }
        vec![family]
    }
}

#[test]
fn there_are_as_many_special_trees_as_nystrom_has_conditions() {
    // Trees by vertices, as counted by Hairer, Nørsett & Wanner, II.14, table 14.3: 1, 1, 2, 3, 6, 10, 20.
    let mut children: Vec<Vec<Branch>> = vec![vec![]; 9];
    let one = Branch { exact: DoubleDouble::one(), values: vec![] };
    children[1].push(one.clone());
    let counts: Vec<usize> = (1..=7)
        .map(|size| {
            let trees = collections(&children, size - 1, size - 1, usize::MAX).len();
            children[size + 1].extend(vec![one.clone(); trees]);
            trees
        })
        .collect();
    assert_eq!(counts, [1, 1, 2, 3, 6, 10, 20]);
}
