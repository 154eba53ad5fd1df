//! Rigid bodies as a scene has them, and as lanes have them.
//!
//! The one idea: a rigid body is a point with mass, its center, of which everything that acts on points knows, and beside
//! it an orientation and an angular momentum. The momentum is that in space, about the center of a free body or about the
//! point that is held: a body that nothing turns then keeps it to the bit, and a torque is added to it as a kick is.

use super::super::moments::check;
use super::super::quaternion::{IDENTITY, Quaternion, conjugate, product, rotated, unit};
use super::flows::Free;
use super::loads::{Load, OwnLoads};
use super::turn::Inverses;
use super::vectors::turned;
use crate::error::{Error, Result};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::rigid::flow::moser_veselov::MoserVeselov;
use crate::units::Units;
use crate::words::{number, numbers};
use std::sync::Arc;

/// What a rod has of its spin about itself is rounding, below this part of it.
const ABOUT_ITSELF: f64 = 1e-12;

/// Of a tolerance rounding may take so much in a step: some hundred steps add up.
const SHARE_OF_ROUNDING: f64 = 0.1;

/// The rigid bodies of a batch of copies of a scene: the last bodies of each.
#[derive(Clone, Debug, Default)]
pub struct RigidBodies {
    /// How many there are in each copy.
    pub count: usize,
    /// Principal moments about the center, or about the point that is held; `copies × count`, as all that follows.
    pub moments: Vec<[f64; 3]>,
    /// From the principal axes to the axes that the caller has in the body.
    pub axes: Vec<Quaternion>,
    /// The center along the principal axes, from the point that is held.
    pub center: Vec<[f64; 3]>,
    /// Whether a point is held.
    pub pivoted: Vec<bool>,
    /// From the caller's axes to space.
    pub orientation: Vec<Quaternion>,
    /// Along the caller's axes.
    pub angular_velocity: Vec<[f64; 3]>,
    /// What pulls at points of the bodies, or turns them: of the first copy, and of all that have none of their own.
    pub loads: Vec<Load>,
    /// The same of copies that have their own, which differ in nothing but numbers.
    pub own_loads: Option<OwnLoads>,
}

impl RigidBodies {
    /// Those of some copies.
    #[must_use]
    pub fn of(&self, members: &[usize]) -> Self {
        fn pick<T: Copy>(values: &[T], count: usize, members: &[usize]) -> Vec<T> {
            members.iter().flat_map(|&copy| &values[copy * count..(copy + 1) * count]).copied().collect()
        }
        Self {
            count: self.count,
            moments: pick(&self.moments, self.count, members),
            axes: pick(&self.axes, self.count, members),
            center: pick(&self.center, self.count, members),
            pivoted: pick(&self.pivoted, self.count, members),
            orientation: pick(&self.orientation, self.count, members),
            angular_velocity: pick(&self.angular_velocity, self.count, members),
            loads: self.loads_of(members.first().copied().unwrap_or(0)).to_vec(),
            own_loads: self.own_loads.as_ref().map(|own| own.of(members)),
        }
    }

    /// The loads of a copy.
    pub fn loads_of(&self, copy: usize) -> &[Load] {
        self.own_loads.as_ref().map_or(&self.loads, |own| &own.sets[own.of_copy[copy]])
    }

    /// The loads of all copies.
    pub fn all_loads(&self) -> impl Iterator<Item = &Load> {
        self.loads.iter().chain(self.own_loads.iter().flat_map(|own| own.sets.iter().flatten()))
    }

    /// The same bodies, turned so and with these angular velocities.
    #[must_use]
    pub fn at(self, turned: &[(Quaternion, [f64; 3])]) -> Self {
        let (orientation, angular_velocity) = turned.iter().copied().unzip();
        Self { orientation, angular_velocity, ..self }
    }

    /// The orientation of the principal axes of a body, and its angular velocity along them: of a rod none about itself,
    /// where the turn of its axes may leave some roundings.
    pub fn principal(&self, at: usize) -> (Quaternion, [f64; 3]) {
        let (orientation, mut spin) =
            Self::to_principal(self.axes[at], self.orientation[at], self.angular_velocity[at]);
        for c in 0..3 {
            if self.moments[at][c] == 0.0 {
                spin[c] = 0.0;
            }
        }
        (orientation, spin)
    }

    /// An orientation and an angular velocity of the caller's axes, of principal ones.
    pub fn to_principal(axes: Quaternion, orientation: Quaternion, spin: [f64; 3]) -> (Quaternion, [f64; 3]) {
        if axes == IDENTITY {
            return (orientation, spin);
        }
        (product(orientation, axes), rotated(conjugate(axes), spin))
    }

    /// The same of the caller's axes.
    pub fn given(&self, at: usize, orientation: Quaternion, spin: [f64; 3]) -> (Quaternion, [f64; 3]) {
        if self.axes[at] == IDENTITY {
            return (orientation, spin);
        }
        (product(orientation, conjugate(self.axes[at])), rotated(self.axes[at], spin))
    }

    /// Refuses what is no body.
    ///
    /// # Errors
    /// By name.
    pub fn validate(&self, copies: usize, particles: usize) -> Result<()> {
        let bodies = copies * self.count;
        let lengths = [self.moments.len(), self.axes.len(), self.center.len(), self.pivoted.len()];
        let states = [self.orientation.len(), self.angular_velocity.len()];
        if self.count > particles || lengths.iter().chain(&states).any(|&length| length != bodies) {
            return Err(Error::Internal("the arrays of rigid bodies differ in length".to_owned()));
        }
        for at in 0..bodies {
            check("moments", self.moments[at])?;
            let _ = unit("orientation", self.orientation[at])?;
            let _ = unit("axes", self.axes[at])?;
            let spin = self.angular_velocity[at];
            if spin.iter().any(|part| !part.is_finite()) {
                let message = format!("expected finite numbers, got {}", numbers(&spin));
                return Err(Error::invalid("angular_velocity", message));
            }
            let (_, principal) = Self::to_principal(self.axes[at], self.orientation[at], spin);
            for c in 0..3 {
                if self.moments[at][c] == 0.0 && principal[c].abs() > ABOUT_ITSELF * length(spin) {
                    let message = format!(
                        "expected no spin about the axis of a rod, whose moment is 0, got {} about it",
                        number(principal[c])
                    );
                    return Err(Error::invalid("angular_velocity", message));
                }
            }
        }
        if let Some(OwnLoads { sets, of_copy }) = &self.own_loads {
            let alike = |set: &Vec<Load>| {
                set.len() == self.loads.len()
                    && set.iter().zip(&self.loads).all(|(own, load)| own.name() == load.name())
            };
            if of_copy.len() != copies
                || of_copy.iter().any(|&set| set >= sets.len())
                || !sets.iter().all(alike)
            {
                return Err(Error::Internal("loads of copies differ in kind".to_owned()));
            }
        }
        self.all_loads().try_for_each(|load| load.validate(self.count, particles))
    }

    /// Whether a body of each copy is held, or has a load.
    pub fn is_loaded(&self) -> bool {
        !self.loads.is_empty() || self.pivoted.contains(&true)
    }

    /// Whether rounding of the angular momentum in space leaves more of a spin than a part `rtol` of it, in a body of a copy:
    /// about the axis of least moment of a needle, or of what is held at the end of a long arm.
    pub fn loses_spin(&self, copy: usize, rtol: f64) -> bool {
        let moments = &self.moments[copy * self.count..(copy + 1) * self.count];
        moments.iter().any(|moments| {
            let largest = moments.iter().fold(0.0_f64, |most, &of| most.max(of));
            let least =
                moments.iter().filter(|&&of| of > 0.0).fold(f64::INFINITY, |least, &of| least.min(of));
            largest / least * f64::EPSILON > SHARE_OF_ROUNDING * rtol
        })
    }

    /// Whether some body is no sphere: gravity turns it.
    pub fn any_shape(&self) -> bool {
        self.moments.iter().any(|[a, b, c]| a != b || b != c)
    }

    /// The angular momentum in space of a body that spins so along its principal axes.
    pub fn momentum(&self, at: usize, orientation: Quaternion, spin: [f64; 3]) -> [f64; 3] {
        let moments = self.moments[at];
        turned(orientation, [0, 1, 2].map(|c| moments[c] * spin[c]))
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// The rigid bodies of up to eight systems, one in each lane, in the units of the integration.
#[derive(Clone, Debug)]
pub struct LaneBody {
    /// The row of its center among those of the points.
    pub row: usize,
    /// Principal moments.
    pub moments: [Lanes; 3],
    /// Their inverses, 0 about the axis of a rod.
    pub inverse: [Lanes; 3],
    /// Whether it is a rod in some lane.
    pub rod: bool,
    /// Its axis, 0 where it is no rod.
    pub axis: [Lanes; 3],
    /// Inverses and their differences, to more digits.
    pub exact: Inverses<Lanes>,
    /// Of two moments that agree, the inverse.
    pub pair: Lanes,
    /// Whether two moments agree, in all lanes or in some.
    pub symmetric: Symmetric,
    /// Mass.
    pub mass: Lanes,
    /// The center along the principal axes, from the point that is held.
    pub center: [Lanes; 3],
    /// That point.
    pub pivot: [Lanes; 3],
    /// Whether there is one.
    pub pivoted: bool,
    /// What turns it freely in place of the exact solution.
    pub discrete: Option<Box<MoserVeselov<Lanes>>>,
}

/// In which lanes two moments of a body agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetric {
    /// In all of them.
    All,
    /// In none.
    None,
    /// In these.
    Some(crate::numerics::lanes::Bits),
}

/// A rigid body of one system at the start, in the units of the integration.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Its number among the rigid bodies of the batch.
    pub at: usize,
    /// Of its principal axes.
    pub orientation: Quaternion,
    /// In space.
    pub momentum: [f64; 3],
    moments: [f64; 3],
    mass: f64,
    center: [f64; 3],
    pivot: [f64; 3],
    pivoted: bool,
}

impl Start {
    /// The angular velocity along its principal axes that goes with a momentum along them.
    pub fn spin(&self, momentum: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| inverse(self.moments[c]) * momentum[c])
    }

    /// Its mass, in the units of the integration.
    pub const fn mass(&self) -> f64 {
        self.mass
    }

    /// Of the body `at` with that mass and that place of its center, all in the scene's units.
    pub fn new(bodies: &RigidBodies, at: usize, mass: f64, place: [f64; 3], units: Units) -> Self {
        let (orientation, spin) = bodies.principal(at);
        let moment = units.mass + 2 * units.length;
        let lever = turned(orientation, bodies.center[at]);
        Self {
            at,
            orientation,
            momentum: bodies.momentum(at, orientation, spin).map(|part| scale(part, units.time - moment)),
            moments: bodies.moments[at].map(|part| scale(part, -moment)),
            mass: scale(mass, -units.mass),
            center: bodies.center[at].map(|part| scale(part, -units.length)),
            pivot: [0, 1, 2].map(|c| scale(place[c] - lever[c], -units.length)),
            pivoted: bodies.pivoted[at],
        }
    }
}

/// Nothing spins about the axis of a rod.
fn inverse(moment: f64) -> f64 {
    if moment == 0.0 { 0.0 } else { 1.0 / moment }
}

impl LaneBody {
    /// A body of each of some systems, with its row; lanes without a system repeat the last.
    pub fn new(free: Free, starts: &[Start], row: usize) -> Self {
        let of = |number: &dyn Fn(&Start) -> f64| {
            Lanes(core::array::from_fn(|lane| number(&starts[lane.min(starts.len() - 1)])))
        };
        let vector = |part: fn(&Start) -> [f64; 3]| [0, 1, 2].map(|c| of(&|start| part(start)[c]));
        let rounded = |part: fn(&Start) -> ([f64; 3], [f64; 3])| {
            (
                [0, 1, 2].map(|c| of(&|start| part(start).0[c])),
                [0, 1, 2].map(|c| of(&|start| part(start).1[c])),
            )
        };
        let pair = |start: &Start| {
            let [a, b, c] = start.moments;
            if a == b || a == c {
                Some(a)
            } else if b == c {
                Some(b)
            } else {
                None
            }
        };
        let agree: [bool; WIDTH] =
            core::array::from_fn(|lane| pair(&starts[lane.min(starts.len() - 1)]).is_some());
        let bits = agree.iter().enumerate().map(|(lane, &agree)| u8::from(agree) << lane).sum();
        Self {
            row,
            moments: vector(|start| start.moments),
            inverse: [0, 1, 2].map(|c| of(&|start| inverse(start.moments[c]))),
            rod: starts.iter().any(|start| start.moments.contains(&0.0)),
            axis: [0, 1, 2].map(|c| of(&|start| f64::from(u8::from(start.moments[c] == 0.0)))),
            exact: Inverses {
                inverse: rounded(|start| Inverses::of(start.moments).inverse),
                differences: rounded(|start| Inverses::of(start.moments).differences),
            },
            pair: of(&|start| inverse(pair(start).unwrap_or(0.0))),
            symmetric: match bits {
                0xff => Symmetric::All,
                0 => Symmetric::None,
                some => Symmetric::Some(crate::numerics::lanes::Bits(some)),
            },
            mass: of(&|start| start.mass),
            center: vector(|start| start.center),
            pivot: vector(|start| start.pivot),
            pivoted: starts.iter().any(|start| start.pivoted),
            discrete: match free {
                // A rod has no inverse of its moment, and is symmetric.
                Free::Discrete(order)
                    if starts.iter().all(|start| start.moments.iter().all(|of| *of > 0.0)) =>
                {
                    Some(Box::new(MoserVeselov::new(order, &vector(|start| start.moments))))
                }
                _ => None,
            },
        }
    }
}

/// Where the numbers of rigid bodies lie in a state: behind those of points, four for each in both halves.
#[derive(Clone, Debug)]
pub struct Arrangement {
    /// Rows of points, and so numbers of each of their components.
    pub rows: usize,
    /// The bodies, those of the first eight systems first.
    pub bodies: Arc<[LaneBody]>,
    /// Whether some point is none of a held body.
    pub free_points: bool,
}

impl Arrangement {
    /// Numbers of the points in each half.
    pub const fn points(&self) -> usize {
        3 * self.rows
    }
    /// Where the numbers of a body begin in each half.
    pub const fn at(&self, body: usize) -> usize {
        self.points() + 4 * body
    }
    /// Numbers of each half.
    pub fn half(&self) -> usize {
        self.at(self.bodies.len())
    }
    /// The rows of the centers of held bodies.
    pub fn held(&self) -> impl Iterator<Item = usize> {
        self.bodies.iter().filter(|body| body.pivoted).map(|body| body.row)
    }
}
