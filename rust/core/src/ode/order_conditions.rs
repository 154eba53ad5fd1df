//! Proof, in double-double, that every table has the order it declares.
//!
//! The one idea: the checks run over [`METHODS`] and know nothing of any method but what it declares. That
//! they are sharp is shown by changing every coefficient in its twelfth digit: each change must be noticed.

mod multistep;
mod nystrom;
mod runge_kutta;
mod splitting;
mod trees;

use super::{Method, Scheme};
use crate::numerics::double_double::DoubleDouble;
use crate::registry::METHODS;
use runge_kutta::Orders;
use trees::{Tree, trees_to_order};

/// A condition holds when it misses by less than this share of the sum of the magnitudes of its terms.
/// The worst measured is 3.2e-32 (the continuous extension of DOP853): a few roundings of 2^-106 = 1.2e-32.
const HOLDS: f64 = 1e-31;

/// A condition fails when it misses by more than this share: far more than rounding. The least measured is 1.2e-9, order 11 of
/// Sofroniou and Spaletta's composition of order 10.
const FAILS: f64 = 1e-12;

/// What a family of conditions is about.
#[derive(Debug)]
enum Kind {
    /// The nodes are the row sums.
    Nodes,
    /// The order of the step.
    Step,
    /// The order of an embedded formula.
    Estimate,
    /// The order of the continuous extension.
    Dense,
    /// The extension joins the nodes with its derivative.
    Ends,
    /// The order of the velocity at a node.
    Velocity,
}

/// A family of conditions, and by how much the worst of them is missed.
#[derive(Debug)]
struct Family {
    kind: Kind,
    /// Largest miss.
    miss: f64,
    /// Largest miss as a share of the sum of the magnitudes of the terms.
    share: f64,
}

impl Family {
    fn new(kind: Kind) -> Self {
        Self { kind, miss: 0.0, share: 0.0 }
    }

    /// Notes a condition `found = exact`. A miss that is not a number counts as infinite.
    fn note(&mut self, found: DoubleDouble, exact: DoubleDouble, magnitude: f64) {
        let miss = (found - exact).to_f64().abs();
        let miss = if miss.is_nan() { f64::INFINITY } else { miss };
        let scale = magnitude + exact.to_f64().abs();
        self.miss = self.miss.max(miss);
        if miss > 0.0 {
            self.share = self.share.max(miss / scale);
        }
    }
}

/// A table of any kind, with the orders it is held to.
enum Subject {
    Splitting(splitting::Table, usize),
    NystromSplitting(nystrom::Table, usize),
    RungeKutta(runge_kutta::Table, Orders),
    Multistep(multistep::Table, usize),
}

impl Subject {
    /// `None` of a method without a table.
    fn new(method: &Method, trees: &[Tree]) -> Option<Self> {
        let (step, dense) = (method.order as usize, method.dense_order as usize);
        Some(match &method.scheme {
            Scheme::Splitting(table) | Scheme::Boris(table) => Self::Splitting(table.into(), step),
            Scheme::NystromSplitting(table) => Self::NystromSplitting(nystrom::Table(table.into()), step),
            Scheme::RungeKutta(table) => {
                Self::RungeKutta(table.into(), Orders { step, dense, estimates: vec![] })
            }
            Scheme::Embedded(table) => {
                let table = runge_kutta::Table::from(table);
                let estimates = table.estimate_orders(trees);
                Self::RungeKutta(table, Orders { step, dense, estimates })
            }
            Scheme::Multistep(table) => Self::Multistep(table.into(), step),
            Scheme::Taylor(_) => return None,
        })
    }

    fn misses(&self, trees: &[Tree]) -> Vec<Family> {
        match self {
            Self::Splitting(table, order) => table.misses(*order),
            Self::NystromSplitting(table, order) => table.misses(*order),
            Self::RungeKutta(table, orders) => table.misses(orders, trees),
            Self::Multistep(table, order) => table.misses(*order),
        }
    }

    /// The same table with coefficient `index` changed in its twelfth significant digit.
    fn changed(&self, index: usize) -> Option<Self> {
        let change = |coefficient: &mut DoubleDouble| {
            let size = coefficient.to_f64().abs();
            let digit = if size == 0.0 { -12.0 } else { size.log10().floor() - 11.0 };
            *coefficient += DoubleDouble::from(10f64.powf(digit));
        };
        match self {
            Self::Splitting(table, order) => {
                let mut table = table.clone();
                table.coefficients().into_iter().nth(index).map(change)?;
                Some(Self::Splitting(table, *order))
            }
            Self::NystromSplitting(table, order) => {
                let mut table = table.clone();
                table.0.coefficients().into_iter().nth(index).map(change)?;
                Some(Self::NystromSplitting(table, *order))
            }
            Self::RungeKutta(table, orders) => {
                let mut table = table.clone();
                table.coefficients().into_iter().nth(index).map(change)?;
                let orders = Orders { estimates: orders.estimates.clone(), ..*orders };
                Some(Self::RungeKutta(table, orders))
            }
            Self::Multistep(table, order) => {
                let mut table = table.clone();
                table.coefficients().into_iter().nth(index).map(change)?;
                Some(Self::Multistep(table, *order))
            }
        }
    }
}

/// All trees that a Runge–Kutta method's conditions need: one order more than it has.
fn trees_of(method: &Method) -> Vec<Tree> {
    match method.scheme {
        Scheme::Multistep(_)
        | Scheme::Splitting(_)
        | Scheme::NystromSplitting(_)
        | Scheme::Boris(_)
        | Scheme::Taylor(_) => vec![],
        _ => trees_to_order(method.order as usize + 1),
    }
}

#[test]
fn every_table_satisfies_its_order_conditions_to_thirty_digits() {
    for method in METHODS {
        let trees = trees_of(method);
        let Some(subject) = Subject::new(method, &trees) else { continue };
        for family in subject.misses(&trees) {
            // Both as a share of the terms and outright: the worst measured is 4.0e-31, in the second
            // estimate of DOP853, whose terms reach 100.
            assert!(family.share < HOLDS && family.miss < 1e-30, "{}: {family:?}", method.name);
        }
    }
}

#[test]
fn no_table_satisfies_the_conditions_of_the_next_order() {
    for method in METHODS {
        let trees = trees_of(method);
        let Some(subject) = Subject::new(method, &trees) else { continue };
        let families = match subject {
            Subject::Splitting(table, order) => table.misses(order + 1),
            Subject::NystromSplitting(table, order) => table.misses(order + 1),
            Subject::RungeKutta(table, orders) => {
                let estimates = orders.estimates.iter().map(|order| order + 1).collect();
                let next = Orders { step: orders.step + 1, dense: orders.dense + 1, estimates };
                table.misses(&next, &trees)
            }
            Subject::Multistep(table, order) => table.misses(order + 1),
        };
        for family in families.iter().filter(|family| !matches!(family.kind, Kind::Nodes | Kind::Ends)) {
            assert!(family.share > FAILS, "{}: {family:?}", method.name);
        }
    }
}

#[test]
fn a_change_in_the_twelfth_digit_of_any_coefficient_is_noticed() {
    for method in METHODS {
        let trees = trees_of(method);
        let Some(subject) = Subject::new(method, &trees) else { continue };
        let mut index = 0;
        while let Some(changed) = subject.changed(index) {
            let families = changed.misses(&trees);
            // The least measured is 3.3e-16, 15 powers of ten above what a true table misses by.
            let noticed = families.iter().any(|family| family.share > 1e-16);
            assert!(noticed, "{}: coefficient {index}: {families:?}", method.name);
            index += 1;
        }
        // Euler's method has a weight and a node.
        assert!(index >= 2, "{}: no coefficients were changed", method.name);
    }
}

#[test]
fn the_step_control_raises_the_error_to_the_power_its_estimates_have() {
    for method in METHODS {
        let Scheme::Embedded(table) = &method.scheme else { continue };
        let orders = runge_kutta::Table::from(table).estimate_orders(&trees_of(method));
        // An estimate of order q is O(h^(q+1)); E² / sqrt(E² + 0.01 E3²) is O(E²/E3) as h → 0.
        let power = match orders[..] {
            [first, second] => 2 * (first + 1) - (second + 1),
            _ => orders[0] + 1,
        };
        assert_eq!(power, table.error_exponent as usize, "{}: orders {orders:?}", method.name);
    }
}

#[test]
fn a_method_is_what_it_declares() {
    for method in METHODS {
        let name = method.name;
        let Some(subject) = Subject::new(method, &trees_of(method)) else { continue };
        let stages = match subject {
            Subject::Splitting(table, _) | Subject::NystromSplitting(nystrom::Table(table), _) => {
                assert!(method.symplectic, "{name}: kicks and drifts are symplectic");
                assert_eq!(method.reversible, table.is_palindrome(), "{name}");
                table.evaluations()
            }
            Subject::RungeKutta(table, _) => {
                assert!(!method.symplectic && !method.reversible, "{name}: no explicit method is");
                table.stages()
            }
            Subject::Multistep(..) => {
                assert!(!method.symplectic && !method.reversible, "{name}: its start is neither");
                1
            }
        };
        assert_eq!(stages, method.stages as usize, "{name}");
        assert!(method.dense_order <= method.order, "{name}");
    }
}
