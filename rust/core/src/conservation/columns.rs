//! The table of derived columns: what can be recorded of a state beside positions and velocities.
//!
//! To add one, write its line in [`COLUMNS`]. The list of names that `record` takes, the shapes of the arrays and the
//! names and descriptions that Python shows follow from it.

use super::{PreciseBodies, angular_momentum, center_of_mass, kinetic_energy, momentum};
use crate::error::Result;
use crate::forces::ForceTerm;
use crate::forces::together::potential_and_virial;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::words::unknown;
use std::sync::Arc;

/// A derived column.
#[derive(Debug)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// What it is, in a line.
    pub description: &'static str,
    /// Numbers for each time.
    pub width: usize,
    /// Whether it is computed from velocities, too.
    pub needs_velocity: bool,
    /// Whether it is the sum of kinetic energy, potential energy and nothing else, and of which of them.
    pub energies: [bool; 2],
    /// Its numbers, the first `width` of these.
    value: fn(&mut Snapshot<'_, '_>) -> Result<[Scaled; 3]>,
}

/// Every derived column, in the order of the documentation.
pub static COLUMNS: &[Column] = &[
    Column {
        name: "energy",
        description: "total energy",
        width: 1,
        needs_velocity: true,
        energies: [true, true],
        value: |state| Ok(one(kinetic_energy(state.bodies).plus(state.pairs()?.0))),
    },
    Column {
        name: "momentum",
        description: "total momentum",
        width: 3,
        needs_velocity: true,
        energies: [false, false],
        value: |state| Ok(momentum(state.bodies)),
    },
    Column {
        name: "angular_momentum",
        description: "total angular momentum about the origin",
        width: 3,
        needs_velocity: true,
        energies: [false, false],
        value: |state| Ok(angular_momentum(state.bodies, state.about)),
    },
    Column {
        name: "center_of_mass",
        description: "center of mass; of massless bodies alone, their mean",
        width: 3,
        needs_velocity: false,
        energies: [false, false],
        value: |state| Ok(center_of_mass(state.bodies)),
    },
    Column {
        name: "kinetic_energy",
        description: "kinetic energy",
        width: 1,
        needs_velocity: true,
        energies: [true, false],
        value: |state| Ok(one(kinetic_energy(state.bodies))),
    },
    Column {
        name: "potential_energy",
        description: "potential energy of all forces",
        width: 1,
        needs_velocity: false,
        energies: [false, true],
        value: |state| Ok(one(state.pairs()?.0)),
    },
    Column {
        name: "virial",
        description: "virial, the sum of r·F",
        width: 1,
        needs_velocity: false,
        energies: [false, false],
        value: |state| Ok(one(state.pairs()?.1)),
    },
];

fn one(value: Scaled) -> [Scaled; 3] {
    [value, Scaled::ZERO, Scaled::ZERO]
}

/// The column of a name.
///
/// # Errors
/// `InvalidInput` of `argument` for a name that there is not.
pub fn column(argument: &str, name: &str) -> Result<&'static Column> {
    let names = COLUMNS.iter().map(|column| column.name);
    COLUMNS.iter().find(|column| column.name == name).ok_or_else(|| unknown(argument, name, names))
}

/// A state whose columns are computed, those that share a sum over pairs from one sum.
pub struct Snapshot<'a, 't> {
    forces: &'a [Arc<dyn ForceTerm>],
    bodies: &'a PreciseBodies,
    about: [f64; 3],
    threads: usize,
    ticker: &'a mut Ticker<'t>,
    pairs: Option<(Scaled, Scaled)>,
}

impl<'a, 't> Snapshot<'a, 't> {
    /// Of bodies that were [settled](PreciseBodies::settle).
    pub fn new(
        forces: &'a [Arc<dyn ForceTerm>],
        bodies: &'a PreciseBodies,
        about: [f64; 3],
        threads: usize,
        ticker: &'a mut Ticker<'t>,
    ) -> Self {
        Self { forces, bodies, about, threads, ticker, pairs: None }
    }

    fn pairs(&mut self) -> Result<(Scaled, Scaled)> {
        if let Some(pairs) = self.pairs {
            return Ok(pairs);
        }
        let pairs = potential_and_virial(self.forces, self.bodies, self.threads, self.ticker)?;
        self.pairs = Some(pairs);
        Ok(pairs)
    }

    /// The numbers of a column; its [width](Column::width) says how many of the three.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn value(&mut self, column: &Column) -> Result<[f64; 3]> {
        Ok((column.value)(self)?.map(Scaled::to_f64))
    }
}
