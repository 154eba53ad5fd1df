//! What massive bodies do to massless ones that move through their steps, one in each lane.
//!
//! The one idea: massless bodies exert nothing, so the massive ones can be integrated before, and whoever knows their way
//! knows the force on each massless body without any other.

use super::ForceTerm;
pub use super::gravity::series::few::FewMassless;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes};
use crate::ode::series::Jet;
use crate::units::Units;

/// The massive bodies that massless ones follow.
#[derive(Clone, Copy, Debug)]
pub struct Leaders<'a> {
    /// Their places in the scene.
    pub bodies: &'a [usize],
    /// Components of a place: 3, or 2 in a plane.
    pub components: usize,
    /// The units of the integration.
    pub units: Units,
    /// Whether the method asks for series.
    pub expands: bool,
}

/// Where they are and how they move at some time, component after component: one system in each lane, or the same in all.
#[derive(Clone, Copy, Debug)]
pub struct Massive<'a> {
    /// Positions.
    pub places: &'a [Lanes],
    /// Velocities, for a force that needs them.
    pub velocities: &'a [Lanes],
}

/// Their coefficients about some time, in the unit of time of those who follow.
#[derive(Clone, Copy, Debug)]
pub struct MassiveSeries<'a> {
    /// Blocks of coordinates, component after component, from order 0 on; one more than those of who follows.
    pub places: &'a [Lanes],
    /// What those of order 0 leave out.
    pub rests: &'a [Lanes],
}

/// Those of packed massive bodies, eight in a row, for each of a few massless ones about its time and in its unit of it.
#[derive(Clone, Copy, Debug)]
pub struct MassiveRows<'a> {
    /// The lanes of the massless bodies.
    pub lanes: &'a [usize],
    /// Rows of each component.
    pub rows: usize,
    /// As of [`MassiveSeries`], for one massless body after another.
    pub places: &'a [Lanes],
    /// Likewise.
    pub rests: &'a [Lanes],
}

/// A force of massive bodies on a massless one in each lane.
pub trait Following: Send {
    /// In these lanes the massive bodies have those masses, and this is the force on them.
    fn lead(&mut self, own: &dyn ForceTerm, units: Units, mass: &[f64], lanes: Bits);

    /// Whether it looks at velocities.
    fn needs_velocity(&self) -> bool {
        false
    }

    /// Writes the accelerations at places and velocities, one number for each component, into `a` if `first`, else adds
    /// them.
    fn apply(&mut self, massive: Massive<'_>, state: (&[Lanes], &[Lanes]), a: &mut [Lanes], first: bool);

    /// As [`Series::coefficient`](super::series::Series::coefficient).
    ///
    /// # Errors
    /// Those of the library itself.
    fn coefficient(
        &mut self,
        massive: MassiveSeries<'_>,
        of: (usize, &Jet<Lanes>),
        a: &mut [Lanes],
        first: bool,
    ) -> Result<()>;

    /// Who expands the motions of a few under this force alone, with the massive bodies in the lanes, if anybody does.
    fn few(&mut self) -> Option<FewMassless<'_>> {
        None
    }

    /// Expands a motion under this force alone.
    ///
    /// # Errors
    /// Those of the library itself.
    fn expand(&mut self, massive: MassiveSeries<'_>, jet: &mut Jet<Lanes>, a: &mut [Lanes]) -> Result<()> {
        for n in 0..jet.order {
            self.coefficient(massive, (n, &*jet), a, true)?;
            jet.raise(n, a);
        }
        Ok(())
    }
}
