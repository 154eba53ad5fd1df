//! `ForceTerm`: a force as a scene describes it, before there are lanes.
//!
//! The one idea: whatever the rest of the core wants to know of a force, it asks here, so that a force is one file and
//! one line of [`registry::FORCES`](crate::registry::FORCES). What a force does not answer has the answer that makes
//! no promise: nothing is conserved, the motion fills space, no closed form applies.

use super::Force;
use super::bodies::PreciseBodies;
use super::context::Context;
use super::derivative::Derivative;
use super::driven_force::Drive;
use super::following::{Following, Leaders};
use super::linear::Linear;
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::uniform_magnetic_field::MagneticField;
use crate::error::{Error, Result};
use crate::numerics::lanes::Lanes;
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::Declaration;
use crate::units::Units;
use core::any::Any;
use core::fmt::Debug;

/// What a force declares about itself.
pub type ForceDeclaration = Declaration<dyn ForceTerm>;

/// Which bodies a force makes depend on each other, and so to be integrated together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// None: it acts on each for itself.
    None,
    /// All that have mass with each other, and each massless body with them.
    AllPairs,
    /// Those of some pairs.
    Listed(Vec<(usize, usize)>),
}

/// About which points a force leaves the angular momentum constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum About {
    /// None.
    Nowhere,
    /// One.
    Point([f64; 3]),
    /// All.
    Everywhere,
}

/// What a force leaves constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conserves {
    /// The total momentum, and with it the uniform motion of the centre of mass.
    pub momentum: bool,
    /// The angular momentum about some points at rest.
    pub angular_momentum: About,
    /// The angular momentum about the moving centre of mass.
    pub spin: bool,
    /// The sum of the kinetic energy and of what [`ForceTerm::potential_and_virial`] gives.
    pub energy: bool,
}

impl Conserves {
    /// Nothing.
    pub const NOTHING: Self =
        Self { momentum: false, angular_momentum: About::Nowhere, spin: false, energy: false };
    /// Everything, as forces between two bodies along the line from one to the other do.
    pub const EVERYTHING: Self =
        Self { momentum: true, angular_momentum: About::Everywhere, spin: true, energy: true };
}

/// The bodies of a scene, one copy after another, for a force to look at.
#[derive(Clone, Copy, Debug)]
pub struct Bodies<'a> {
    /// Copies.
    pub copies: usize,
    /// Bodies of each.
    pub particles: usize,
    /// Masses.
    pub mass: &'a [f64],
    /// Positions.
    pub position: &'a [[f64; 3]],
    /// Velocities.
    pub velocity: &'a [[f64; 3]],
    /// Which copy it is, of one among several.
    pub copy: Option<usize>,
}

impl<'a> Bodies<'a> {
    /// The masses and the positions of a copy.
    pub fn copy(&self, copy: usize) -> (&'a [f64], &'a [[f64; 3]]) {
        let own = copy * self.particles..(copy + 1) * self.particles;
        (&self.mass[own.clone()], &self.position[own])
    }
    /// What a refusal calls the quantity of a body, by its place in the arrays.
    pub fn name(&self, what: &str, index: usize) -> String {
        let (copy, particle) = (index / self.particles, index % self.particles);
        let copy = self.copy.unwrap_or(copy);
        if self.copies == 1 && self.copy.is_none() {
            format!("{what}[{particle}]")
        } else {
            format!("{what}[{copy}, {particle}]")
        }
    }
    /// Two bodies of one copy in one place, by their places in the arrays, if that matters for their masses.
    pub fn coincident(&self, matters: impl Fn(f64, f64) -> bool) -> Option<(usize, usize)> {
        for copy in 0..self.copies {
            let (mass, position) = self.copy(copy);
            // Sorted along x, bodies that coincide are neighbours: O(N log N), not O(N²).
            let mut order: Vec<usize> = (0..self.particles).collect();
            order.sort_by(|&i, &j| {
                let (a, b) = (position[i], position[j]);
                a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2])).then(i.cmp(&j))
            });
            for pair in order.windows(2) {
                let (i, j) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                if position[i] == position[j] && matters(mass[i], mass[j]) {
                    return Some((copy * self.particles + i, copy * self.particles + j));
                }
            }
        }
        None
    }
    /// Refuses an array of a parameter that is neither one number nor one for each body.
    ///
    /// # Errors
    /// By the name of the parameter.
    pub fn check_count(&self, name: &str, count: usize) -> Result<()> {
        if count == 1 || count == self.particles {
            return Ok(());
        }
        let expected = format!("expected one number, or one for each of {} bodies", self.particles);
        Err(Error::invalid(name, format!("{expected}, got {count}")))
    }
}

/// A force of a scene, as described.
pub trait ForceTerm: Any + Debug + Send + Sync {
    /// What it declares about itself.
    fn declaration(&self) -> &'static ForceDeclaration;

    /// The kernel for lanes laid out and scaled as the context says.
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>>;

    /// One kernel of this force and another, with the bits of their sum, where that is faster: see
    /// [`gravity::beside`](super::gravity).
    fn kernel_after(&self, _other: &dyn ForceTerm, _: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        None
    }

    /// How its accelerations change along a direction, by formulas, if it knows that: of every copy of one kind of force, or of
    /// none ([`Self::in_every_lane`]).
    fn derivative(&self, _: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        None
    }

    /// The kernel for a method of Taylor series, if the force [has](Self::has_series) one.
    fn series(&self, _: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        None
    }

    /// Whether motions under it can be expanded in Taylor series.
    fn has_series(&self) -> bool {
        false
    }

    /// Whether it holds a body to another, so that they swing, and series take less time than other methods.
    fn holds(&self, _particle: usize) -> bool {
        false
    }

    /// Whether its series has lane by lane what its kernel has.
    fn series_in_every_lane(&self) -> bool {
        false
    }

    /// What massive bodies do by it to massless ones that move through their steps, of a force that couples all pairs; if
    /// there is nothing of the kind, they are integrated together.
    fn following(&self, _: &Leaders<'_>) -> Option<Box<dyn Following>> {
        None
    }

    /// Its potential energy of these bodies, zero if it has none, and Σ r·F; the same on any number of threads.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)>;

    /// Refuses bodies that it cannot act on.
    ///
    /// # Errors
    /// By name.
    fn validate(&self, _: &Bodies<'_>) -> Result<()> {
        Ok(())
    }
    /// Refuses units of a motion in which what it is made of is beyond all numbers.
    ///
    /// # Errors
    /// By name.
    fn check_units(&self, _: Units) -> Result<()> {
        Ok(())
    }
    /// Whether it acts on a body by a force, so that the body must have mass to be moved.
    fn needs_mass(&self, _particle: usize) -> bool {
        false
    }
    /// Whether it does anything to these bodies.
    fn acts(&self, _: &Bodies<'_>) -> bool {
        true
    }
    /// What it looks at beside positions.
    fn needs(&self) -> Needs {
        Needs::default()
    }
    /// Which bodies it makes depend on each other.
    fn coupling(&self) -> Coupling {
        Coupling::None
    }
    /// Whether it tells bodies apart by their place in the scene, as listed pairs do and numbers for each.
    fn names_bodies(&self) -> bool {
        matches!(self.coupling(), Coupling::Listed(_))
    }
    /// What it is of the bodies that remain when some have become parts of others.
    fn of_remaining(&self, _: &Remaining) -> OfRemaining {
        if self.names_bodies() { OfRemaining::Unknown } else { OfRemaining::Same }
    }
    /// What it leaves constant.
    fn conserves(&self) -> Conserves {
        Conserves::NOTHING
    }
    /// Whether the sum of the kinetic and of the potential energies never grows by it.
    fn never_gives_energy(&self) -> bool {
        self.conserves().energy
    }
    /// Whether it looks at differences of places at most: bodies that are shifted as a whole feel the same.
    fn translation_invariant(&self) -> bool {
        self.between() || self.as_uniform().is_some()
    }
    /// Whether it is the same for bodies that move uniformly as a whole, besides.
    fn galilean_invariant(&self) -> bool {
        self.between() || (self.translation_invariant() && !self.needs().velocities())
    }
    /// Whether it acts between bodies, action being reaction.
    fn between(&self) -> bool {
        self.coupling() != Coupling::None && self.conserves().momentum
    }
    /// Whether bodies that move in the plane z = 0 stay there.
    fn keeps_plane(&self) -> bool {
        false
    }
    /// The point about which it acts, where it may be singular: distances are measured from there.
    fn center(&self) -> Option<[f64; 3]> {
        None
    }
    /// The point at rest that places are told from, singular there or not.
    fn fixed_point(&self) -> Option<[f64; 3]> {
        self.center()
    }
    /// The distances, of bodies from each other or from its center, between which it is, if not at all.
    fn domain(&self) -> Option<(f64, f64)> {
        None
    }
    /// The speed of a body up to which it is, in the scene's units, if not at any.
    fn speed_limit(&self, _particle: usize) -> Option<f64> {
        None
    }
    /// A length below which it has no structure, or zero.
    fn length(&self) -> f64 {
        0.0
    }
    /// A length below which it grows no more, or zero: by it distances are softened that a time transformation watches.
    fn softening(&self) -> f64 {
        self.length()
    }
    /// The unit of time that goes with units of length and mass, all as exponents of two, if the force has one.
    fn unit_of_time(&self, _length: i32, _mass: i32) -> Option<i32> {
        None
    }
    /// The largest acceleration that it gives to one of some bodies at rest, by which a step is chosen if nothing else
    /// tells: their places in the scene, masses and positions in those units; a force that changes in time is asked at these
    /// times of the run, in the scene's units.
    ///
    /// # Errors
    /// When the caller asks to stop.
    fn strongest(
        &self,
        _: &[(usize, f64, [f64; 3])],
        _: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        Ok(0.0)
    }
    /// The largest rate at which it slows down or turns such a body, or changes in time: nothing it does to a body by itself
    /// takes longer than one over it.
    fn rate(&self, _: &[(usize, f64, [f64; 3])], _: Units) -> f64 {
        0.0
    }
    /// What ensemble members must have alike, as numbers, to share lanes, each with a force of this kind: its kernel has
    /// all else lane by lane ([`Context::own`]). `None`: nothing, so only members with the very same force share lanes.
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        None
    }
    /// Whether nothing tells over how short a way, or a time, it may change: a step knows what its stages meet, and the
    /// longer it is, the more is between them.
    fn may_change_anywhere(&self) -> bool {
        false
    }
    /// Whether something in it may be narrower than a step, which [`System::seen_until`](crate::ode::system::System::seen_until)
    /// finds.
    fn may_be_narrow(&self) -> bool {
        false
    }
    /// Whether it is a formula of places and times that is not known beforehand, nor what their last digits change in it.
    fn is_formula(&self) -> bool {
        false
    }
    /// What it makes, if its acceleration of a body is linear in the place and the velocity of that body alone, but for a
    /// constant.
    fn as_linear(&self) -> Option<&dyn Linear> {
        None
    }
    /// Whether a Taylor series tells all of such a formula, wherever it is made.
    fn is_told(&self) -> bool {
        false
    }
    /// What its kernel leaves out, and why.
    fn skipped(&self) -> Option<(&'static str, &'static str)> {
        None
    }

    /// The acceleration, if it is the same for every body everywhere and always.
    fn as_uniform(&self) -> Option<[f64; 3]> {
        None
    }
    /// The gravitational constant and the softening length, if it is Newton's gravity.
    fn as_newtonian(&self) -> Option<(f64, f64)> {
        None
    }
    /// k times the charges of two bodies and the softening length, if it is Coulomb's law.
    fn as_coulomb(&self, _pair: [usize; 2]) -> Option<(Scaled, f64)> {
        None
    }
    /// `k` and the center, if it is that of a potential energy k/r about a fixed point.
    fn as_inverse_distance_center(&self) -> Option<(f64, [f64; 3])> {
        None
    }
    /// The time τ of decay, if it is the acceleration −v/τ on every body.
    fn as_linear_drag(&self) -> Option<f64> {
        None
    }
    /// The coefficient of a body, if it is the force −coefficient |v| v.
    fn as_quadratic_drag(&self, _particle: usize) -> Option<f64> {
        None
    }
    /// The stiffness and the center, if it is the force −k (r − center) on every body.
    fn as_harmonic(&self) -> Option<(f64, [f64; 3])> {
        None
    }
    /// What it is, if it is a cosine of time, the same force on every body.
    fn as_driven(&self) -> Option<Drive> {
        None
    }
    /// The field and the charge of a body, if it is that of a uniform electric field.
    fn as_electric(&self, _particle: usize) -> Option<([f64; 3], f64)> {
        None
    }
    /// The angular velocity and a point of the axis, if it is what a rotating frame makes.
    fn as_rotating(&self) -> Option<([f64; 3], [f64; 3])> {
        None
    }
    /// The field and the charges, if it is that of a uniform magnetic field.
    fn as_magnetic(&self) -> Option<MagneticField<'_>> {
        None
    }
}
