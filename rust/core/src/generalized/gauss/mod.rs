//! Gauss's collocation methods of orders 4, 8 and 16: symplectic for any Lagrangian and any Hamiltonian, separable or not.
//!
//! The one idea: with up to eight stages, the lanes are the stages ([`step`]), so an implicit method costs hardly more for a
//! step than an explicit one for a stage. How smooth the motion is, is told by how far the polynomial of a step leads astray
//! in the next one, and by how its terms fall ([`decay`], [`between`]); where energy is conserved steps are chosen at the start and then held ([`pace`]). What is at rest is measured
//! by what will push it ([`rest`]), and rounding by nothing
//! ([`rounding`], [`noise`]). Of an ensemble the lanes are trajectories ([`eight`]), each with the operations that it has
//! alone.

mod between;
mod changes;
mod columns;
mod columns_end;
mod decay;
mod eight;
mod ending;
mod extension;
mod noise;
mod pace;
mod rest;
mod rounding;
mod step;
mod tables;
mod told;
mod trial;
mod visited;

use crate::numerics::lanes::{Lanes, WIDTH};
use crate::ode::looks::Looks;
use between::Between;
pub use eight::GaussEight;
use ending::Ending;
use extension::Extension;
pub use pace::Steps;
use rounding::Rounding;
use std::sync::OnceLock;
pub use trial::GaussStep;

/// A collocation method: row `j` of a matrix holds what stage `j` contributes to each of the stages.
#[derive(Debug)]
pub struct Table {
    pub(super) stages: usize,
    /// Nodes, and what they leave out: without it all steps would err to one side, and energies drift.
    c: Lanes,
    c_rest: Lanes,
    a: [Lanes; WIDTH],
    /// The square of `a`.
    a2: [Lanes; WIDTH],
    /// Weights of the rates, and what they leave out.
    b: [Lanes; 2],
    /// Weights of the accelerations in the coordinates, b·a.
    b2: [Lanes; 2],
    /// The polynomial through the stages at those of the next step.
    ahead: [Lanes; WIDTH],
    /// Barycentric weights of the nodes.
    weights: Lanes,
}

/// A method of this family.
#[derive(Debug)]
pub struct Method {
    /// Its name in the Python interface.
    pub name: &'static str,
    /// Its order.
    pub order: u32,
    table: &'static Table,
    beyond: OnceLock<Beyond>,
    extension: OnceLock<Extension>,
}

/// What follows from a table alone, found when it is first asked for.
#[derive(Debug)]
struct Beyond {
    ending: Ending,
    /// See [`decay::coefficients`].
    coefficients: Option<[Lanes; WIDTH]>,
    between: Option<Between>,
    rounding: Rounding,
}

/// The methods of this family.
pub static METHODS: [Method; 3] = [
    Method {
        name: "gauss4",
        order: 4,
        table: &tables::GAUSS4,
        beyond: OnceLock::new(),
        extension: OnceLock::new(),
    },
    Method {
        name: "gauss8",
        order: 8,
        table: &tables::GAUSS8,
        beyond: OnceLock::new(),
        extension: OnceLock::new(),
    },
    Method {
        name: "gauss16",
        order: 16,
        table: &tables::GAUSS16,
        beyond: OnceLock::new(),
        extension: OnceLock::new(),
    },
];

impl Method {
    fn beyond(&'static self) -> &'static Beyond {
        let found = || Beyond {
            ending: Ending::of(self.table),
            coefficients: decay::coefficients(self.table),
            between: Between::of(self.table),
            rounding: Rounding::of(self.table),
        };
        self.beyond.get_or_init(found)
    }

    /// What the states within its steps are read by, found when it is first asked for.
    fn extension(&'static self) -> &'static Extension {
        self.extension.get_or_init(|| Extension::of(self.table))
    }

    /// Steps that are chosen for a relative tolerance, and held or not.
    pub fn chosen(&self, rtol: f64, held: bool) -> Steps {
        let (delta, band) = self.table.delta(rtol);
        Steps::Chosen { tolerance: rtol, delta, band, held }
    }

    /// Whether its stages are fewer than the lanes.
    pub fn leaves_lanes(&self) -> bool {
        self.table.stages < WIDTH
    }
}

/// The method of that name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

/// Nodes on 0 … 1 and weights of the quadrature of order 16.
pub(super) fn quadrature() -> (&'static [f64; WIDTH], &'static [f64; WIDTH]) {
    let table = &tables::GAUSS16;
    (&table.c.0, &table.b[0].0)
}

impl Table {
    /// Where a step looks: its stages, and what the ends of it show.
    fn looks(&self) -> Looks {
        Looks::with_ends(self.c.0.into_iter().take(self.stages))
    }

    /// The polynomial through the stages at these fractions of the step: a row for what each stage contributes.
    fn at(&self, fractions: &Lanes) -> [Lanes; WIDTH] {
        let mut rows = [Lanes([0.0; WIDTH]); WIDTH];
        for (place, &x) in fractions.0.iter().enumerate() {
            for (k, row) in rows.iter_mut().enumerate().take(self.stages) {
                let mut weight = self.weights.0[k];
                for j in (0..self.stages).filter(|&j| j != k) {
                    weight *= x - self.c.0[j];
                }
                row.0[place] = weight;
            }
        }
        rows
    }
}
