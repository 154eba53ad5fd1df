//! A scene: what there is, what is asked of it, what must be done, and the doing of it.
//!
//! [`Scene`] is plain data. [`plan`](plan::plan) is a pure function from (scene, request) to a
//! [`Plan`](plan::Plan), and the only place where work is skipped; [`run`](run::run) does what it says.

pub mod acceleration;
pub mod closed_form;
pub mod columns;
pub mod frame;
pub mod integrate;
pub mod layout;
pub mod plan;
pub mod request;
pub mod room;
pub mod run;
pub mod unit;

use crate::error::{Error, Result};
use crate::potentials::Potential;
use crate::words::{number, numbers};
use std::sync::Arc;

/// A force of a scene, as described.
#[derive(Clone, Debug)]
pub enum ForceSpec {
    /// Newtonian gravity between all pairs.
    Gravity {
        /// The gravitational constant.
        constant: f64,
        /// Plummer softening length.
        softening: f64,
    },
    /// The same acceleration everywhere.
    UniformField {
        /// The acceleration.
        g: [f64; 3],
    },
    /// A fixed centre with a potential energy `V(r)`.
    CentralField {
        /// The potential energy.
        potential: Arc<dyn Potential>,
        /// Where it is.
        center: [f64; 3],
    },
}

/// A batch of copies of a scene with the same forces (a batch of one is a scene).
#[derive(Clone, Debug)]
pub struct Scene {
    /// Copies.
    pub copies: usize,
    /// Particles in each.
    pub particles: usize,
    /// Masses, `copies × particles`.
    pub mass: Vec<f64>,
    /// Positions, `copies × particles`.
    pub position: Vec<[f64; 3]>,
    /// Velocities, `copies × particles`.
    pub velocity: Vec<[f64; 3]>,
    /// The forces, in the order in which they are added.
    pub forces: Vec<ForceSpec>,
    /// The time of this state.
    pub t0: f64,
}

/// The distance of two points, scaled so that it neither overflows nor vanishes for finite ones.
pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d: [f64; 3] = core::array::from_fn(|c| (a[c] - b[c]).abs());
    let largest = d.into_iter().fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let sum: f64 = d.into_iter().map(|x| (x / largest) * (x / largest)).sum();
    largest * sum.sqrt()
}

impl Scene {
    /// The masses of a copy.
    pub fn masses(&self, copy: usize) -> &[f64] {
        &self.mass[copy * self.particles..(copy + 1) * self.particles]
    }
    /// The positions of a copy.
    pub fn positions(&self, copy: usize) -> &[[f64; 3]] {
        &self.position[copy * self.particles..(copy + 1) * self.particles]
    }
    /// The velocities of a copy.
    pub fn velocities(&self, copy: usize) -> &[[f64; 3]] {
        &self.velocity[copy * self.particles..(copy + 1) * self.particles]
    }

    fn name(&self, what: &str, copy: usize, particle: usize) -> String {
        if self.copies == 1 { format!("{what}[{particle}]") } else { format!("{what}[{copy}, {particle}]") }
    }

    /// Refuses what no run could be made of.
    ///
    /// # Errors
    /// Negative or non-finite masses, non-finite coordinates, coincident bodies that attract each other
    /// without softening, a particle on a singular centre, a massless particle where its mass is needed.
    pub fn validate(&self) -> Result<()> {
        let count = self.copies * self.particles;
        if self.mass.len() != count || self.position.len() != count || self.velocity.len() != count {
            return Err(Error::Internal("the arrays of a scene differ in length".to_owned()));
        }
        for (index, &mass) in self.mass.iter().enumerate() {
            if !(mass >= 0.0 && mass.is_finite()) {
                let name = self.name("mass", index / self.particles, index % self.particles);
                return Err(Error::invalid(
                    "mass",
                    format!("expected finite masses of at least 0, got {name} = {}", number(mass)),
                ));
            }
        }
        for (argument, values) in [("position", &self.position), ("velocity", &self.velocity)] {
            if let Some(index) = values.iter().position(|x| x.iter().any(|x| !x.is_finite())) {
                let name = self.name(argument, index / self.particles, index % self.particles);
                return Err(Error::invalid(
                    argument,
                    format!("expected finite numbers, got {name} = {}", numbers(&values[index])),
                ));
            }
        }
        if !self.t0.is_finite() {
            return Err(Error::invalid("t0", format!("expected a finite time, got {}", number(self.t0))));
        }
        self.forces.iter().try_for_each(|force| match force {
            ForceSpec::Gravity { constant, softening } => self.validate_gravity(*constant, *softening),
            ForceSpec::UniformField { g } if g.iter().any(|g| !g.is_finite()) => {
                Err(Error::invalid("g", format!("expected three finite numbers, got {}", numbers(g))))
            }
            ForceSpec::UniformField { .. } => Ok(()),
            ForceSpec::CentralField { potential, center } => self.validate_center(&**potential, *center),
        })
    }

    fn validate_gravity(&self, constant: f64, softening: f64) -> Result<()> {
        if !constant.is_finite() {
            return Err(Error::invalid("G", format!("expected a finite number, got {}", number(constant))));
        }
        if !(softening >= 0.0 && softening.is_finite()) {
            let message = format!("expected a finite length of at least 0, got {}", number(softening));
            return Err(Error::invalid("softening", message));
        }
        if softening > 0.0 {
            return Ok(());
        }
        for copy in 0..self.copies {
            let (mass, position) = (self.masses(copy), self.positions(copy));
            // Sorted along x, bodies that coincide are neighbours: O(N log N), not O(N²).
            let mut order: Vec<usize> = (0..self.particles).collect();
            order.sort_by(|&i, &j| {
                let (a, b) = (position[i], position[j]);
                a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2])).then(i.cmp(&j))
            });
            for pair in order.windows(2) {
                let (i, j) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                if position[i] == position[j] && (mass[i] > 0.0 || mass[j] > 0.0) {
                    let (first, second) = (self.name("position", copy, i), self.name("position", copy, j));
                    return Err(Error::invalid(
                        "position",
                        format!(
                            "expected distinct positions for bodies that attract each other, got {first} = \
                             {second} = {}; move one of them or give Gravity a softening",
                            numbers(&position[i])
                        ),
                    ));
                }
            }
        }
        Ok(())
    }

    fn validate_center(&self, potential: &dyn Potential, center: [f64; 3]) -> Result<()> {
        if center.iter().any(|x| !x.is_finite()) {
            return Err(Error::invalid(
                "center",
                format!("expected three finite numbers, got {}", numbers(&center)),
            ));
        }
        if let Some(index) = self.mass.iter().position(|&mass| mass == 0.0) {
            let name = self.name("mass", index / self.particles, index % self.particles);
            return Err(Error::invalid(
                "mass",
                format!("CentralField acts by its force, so every mass must be positive, got {name} = 0.0"),
            ));
        }
        if !potential.singular() {
            return Ok(());
        }
        match self.position.iter().position(|&position| position == center) {
            None => Ok(()),
            Some(index) => {
                let name = self.name("position", index / self.particles, index % self.particles);
                Err(Error::invalid(
                    "position",
                    format!(
                        "{name} = {} is the singular center of CentralField; move one of the two",
                        numbers(&center)
                    ),
                ))
            }
        }
    }
}
