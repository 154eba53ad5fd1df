//! Order conditions of a Runge–Kutta table: nodes, step, error estimates, continuous extension.

use super::super::{Embedded, Tableau};
use super::trees::Tree;
use super::{Family, HOLDS, Kind};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// A table that a test may change.
#[derive(Clone)]
pub(super) struct Table {
    a: Vec<Vec<DoubleDouble>>,
    b: Vec<DoubleDouble>,
    c: Vec<DoubleDouble>,
    estimates: Vec<Vec<DoubleDouble>>,
    dense_a: Vec<Vec<DoubleDouble>>,
    dense_c: Vec<DoubleDouble>,
    dense: Vec<Vec<DoubleDouble>>,
}

/// The orders a table is held to.
pub(super) struct Orders {
    pub(super) step: usize,
    pub(super) dense: usize,
    /// Each estimate vanishes to this order: the embedded formula `b - error` has it.
    pub(super) estimates: Vec<usize>,
}

fn owned(rows: &[&[DoubleDouble]]) -> Vec<Vec<DoubleDouble>> {
    rows.iter().map(|row| row.to_vec()).collect()
}

impl From<&Tableau> for Table {
    fn from(tableau: &Tableau) -> Self {
        Self {
            a: owned(tableau.a),
            b: tableau.b.to_vec(),
            c: tableau.c.to_vec(),
            estimates: vec![],
            dense_a: vec![],
            dense_c: vec![],
            dense: vec![],
        }
    }
}

impl From<&Embedded> for Table {
    fn from(method: &Embedded) -> Self {
        let estimates = [Some(method.error), method.second_error];
        Self {
            estimates: estimates.into_iter().flatten().map(<[_]>::to_vec).collect(),
            dense_a: owned(method.dense_a),
            dense_c: method.dense_c.to_vec(),
            dense: owned(method.dense),
            ..Self::from(&method.tableau)
        }
    }
}

/// Φ_i of every tree at every stage, and the sum of the magnitudes of its terms.
struct Weights {
    value: Vec<Vec<DoubleDouble>>,
    magnitude: Vec<Vec<f64>>,
}

impl Weights {
    fn new(a: &[Vec<DoubleDouble>], trees: &[Tree]) -> Self {
        let largest = trees.iter().map(|tree| tree.order).max().unwrap_or(0);
        let mut weights = Self { value: vec![], magnitude: vec![] };
        let mut grown: Vec<Vec<(DoubleDouble, f64)>> = vec![];
        for tree in trees {
            let mut value = vec![DoubleDouble::one(); a.len()];
            let mut magnitude = vec![1.0; a.len()];
            for stage in 0..a.len() {
                for &branch in &tree.branches {
                    value[stage] = value[stage] * grown[branch][stage].0;
                    magnitude[stage] *= grown[branch][stage].1;
                }
            }
            if tree.order < largest {
                grown.push(a.iter().map(|row| dot(row, &value, &magnitude)).collect());
            }
            weights.value.push(value);
            weights.magnitude.push(magnitude);
        }
        weights
    }

    /// `Σ weight_i Φ_i` of a tree, and the sum of the magnitudes of its terms.
    fn sum(&self, weight: &[DoubleDouble], tree: usize) -> (DoubleDouble, f64) {
        dot(weight, &self.value[tree], &self.magnitude[tree])
    }
}

fn dot(weight: &[DoubleDouble], value: &[DoubleDouble], magnitude: &[f64]) -> (DoubleDouble, f64) {
    let mut sum = (DoubleDouble::zero(), 0.0);
    for stage in 0..weight.len() {
        sum.0 += weight[stage] * value[stage];
        sum.1 += weight[stage].to_f64().abs() * magnitude[stage];
    }
    sum
}

impl Table {
    /// Every coefficient, to be changed.
    pub(super) fn coefficients(&mut self) -> Vec<&mut DoubleDouble> {
        let rows = self.a.iter_mut().chain(&mut self.estimates).chain(&mut self.dense_a);
        let lists = [&mut self.b, &mut self.c, &mut self.dense_c];
        rows.chain(&mut self.dense).chain(lists).flatten().collect()
    }

    /// Force evaluations per step; row `i` of an explicit tableau has `i` entries, and so on.
    pub(super) fn stages(&self) -> usize {
        let all = self.a.len() + 1 + self.dense_a.len();
        assert!(self.coupling().iter().enumerate().all(|(i, row)| row.len() == i), "explicit rows");
        assert!(self.dense.is_empty() || self.dense.len() == all, "a dense row for every stage");
        assert!(self.estimates.iter().all(|estimate| estimate.len() <= self.a.len() + 1), "estimates");
        assert_eq!((self.c.len(), self.dense_c.len()), (self.a.len(), self.dense_a.len()), "nodes");
        self.a.len()
    }

    /// The coupling of all stages: the method's own, the end of the step, the extension's.
    fn coupling(&self) -> Vec<Vec<DoubleDouble>> {
        self.a.iter().chain([&self.b]).chain(&self.dense_a).cloned().collect()
    }

    /// Weights of all stages at `θ`.
    fn dense_weights(&self, theta: DoubleDouble) -> Vec<DoubleDouble> {
        let other = DoubleDouble::one() - theta;
        let nested = |row: &Vec<DoubleDouble>| {
            row.iter().enumerate().rev().fold(DoubleDouble::zero(), |inner, (k, &coefficient)| {
                (coefficient + inner) * if k % 2 == 0 { theta } else { other }
            })
        };
        self.dense.iter().map(nested).collect()
    }

    /// The largest order to which each estimate vanishes.
    pub(super) fn estimate_orders(&self, trees: &[Tree]) -> Vec<usize> {
        let weights = Weights::new(&self.coupling(), trees);
        let fails = |estimate: &[DoubleDouble], tree: usize| {
            let (sum, magnitude) = weights.sum(estimate, tree);
            sum.to_f64().abs() > HOLDS * magnitude
        };
        let order = |estimate: &Vec<DoubleDouble>| {
            (0..trees.len()).find(|&tree| fails(estimate, tree)).map_or(0, |tree| trees[tree].order - 1)
        };
        self.estimates.iter().map(order).collect()
    }

    /// The worst miss of each family of conditions at these orders.
    pub(super) fn misses(&self, orders: &Orders, trees: &[Tree]) -> Vec<Family> {
        let one = DoubleDouble::one();
        let mut nodes = Family::new(Kind::Nodes);
        let stages = self.a.iter().zip(&self.c).chain(self.dense_a.iter().zip(&self.dense_c));
        for (row, &node) in stages {
            let (sum, magnitude) = dot(row, &vec![one; row.len()], &vec![1.0; row.len()]);
            nodes.note(sum, node, magnitude);
        }
        let mut step = Family::new(Kind::Step);
        let mut estimates: Vec<Family> =
            orders.estimates.iter().map(|_| Family::new(Kind::Estimate)).collect();
        let mut dense = Family::new(Kind::Dense);
        let weights = Weights::new(&self.coupling(), trees);
        // A polynomial of degree n without constant term that vanishes at n points is zero: agreement
        // at these points is agreement at every θ.
        let degree = self.dense.first().map_or(0, Vec::len);
        let points: Vec<DoubleDouble> = (1..=degree)
            .map(|k| DoubleDouble::from(k as f64) / DoubleDouble::from((degree + 1) as f64))
            .collect();
        let at_points: Vec<_> = points.iter().map(|&theta| self.dense_weights(theta)).collect();
        for (index, tree) in trees.iter().enumerate() {
            let exact = one / DoubleDouble::from(tree.density);
            if tree.order <= orders.step {
                let (sum, magnitude) = weights.sum(&self.b, index);
                step.note(sum, exact, magnitude);
            }
            for ((family, &order), estimate) in
                estimates.iter_mut().zip(&orders.estimates).zip(&self.estimates)
            {
                if tree.order <= order {
                    let (sum, magnitude) = weights.sum(estimate, index);
                    family.note(sum, DoubleDouble::zero(), magnitude);
                }
            }
            if tree.order <= orders.dense {
                for (&theta, weight) in points.iter().zip(&at_points) {
                    let (sum, magnitude) = weights.sum(weight, index);
                    let power = (1..tree.order).fold(theta, |power, _| power * theta);
                    dense.note(sum, power * exact, magnitude);
                }
            }
        }
        let mut families = vec![nodes, step];
        families.append(&mut estimates);
        if !self.dense.is_empty() {
            families.extend([dense, self.ends()]);
        }
        families
    }

    /// The extension meets the nodes with their derivatives: `w(1) = b`, `w'(0) = k_0`, `w'(1) = k_s`.
    fn ends(&self) -> Family {
        let mut family = Family::new(Kind::Ends);
        for (stage, row) in self.dense.iter().enumerate() {
            let value = self.b.get(stage).copied().unwrap_or(DoubleDouble::zero());
            let is = |at: usize| DoubleDouble::from(f64::from(u8::from(stage == at)));
            let magnitude = row[..3].iter().map(|entry| entry.to_f64().abs()).sum();
            family.note(row[0], value, magnitude);
            family.note(row[0] + row[1], is(0), magnitude);
            family.note(row[0] - row[1] - row[2], is(self.a.len()), magnitude);
        }
        family
    }
}
