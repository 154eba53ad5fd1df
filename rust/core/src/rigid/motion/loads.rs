//! What pulls at points of rigid bodies and what turns them, as a scene describes it.

use super::formula::Formula;
use crate::error::{Error, Result};
use crate::words::{number, numbers};
use core::fmt::{Debug, Formatter};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A torque in space, from the time since the start of the scene's time, the orientation and the angular velocity in the body.
pub type TorqueFunction = Arc<dyn Fn(f64, &[f64; 4], &[f64; 3]) -> [f64; 3] + Send + Sync>;

/// One end of a spring.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// A point of a rigid body, from its center along the caller's axes.
    Body(usize, [f64; 3]),
    /// A body of the scene, by its index among all.
    Particle(usize),
    /// A point in space.
    Anchor([f64; 3]),
}

/// A force or a torque on rigid bodies, which are counted by themselves.
#[derive(Clone)]
pub enum Load {
    /// A torque that stays what it is, in space or along the caller's axes in the body; on one body or on all.
    Torque {
        /// Which body.
        body: Option<usize>,
        /// The torque.
        torque: [f64; 3],
        /// Whether it turns with the body.
        in_body: bool,
    },
    /// A torque −coefficient·ω.
    Drag {
        /// Which body.
        body: Option<usize>,
        /// The coefficient.
        coefficient: f64,
    },
    /// A spring and damper between two points.
    Spring {
        /// Its ends.
        ends: [End; 2],
        /// Force by length.
        stiffness: f64,
        /// The length without force.
        length: f64,
        /// Force by speed.
        damping: f64,
    },
    /// A torque that the caller computes.
    Function {
        /// Which body.
        body: Option<usize>,
        /// What computes it.
        function: TorqueFunction,
    },
    /// A torque as a formula, in space or along the caller's axes in the body.
    Formula {
        /// Which body.
        body: Option<usize>,
        /// Its expressions.
        formula: Arc<Formula>,
        /// The values of their parameters.
        parameters: Vec<f64>,
        /// Whether it turns with the body.
        in_body: bool,
    },
}

impl End {
    /// The point in it: of a body along its axes, of an anchor in space.
    pub const fn point(&self) -> [f64; 3] {
        match self {
            Self::Body(_, point) | Self::Anchor(point) => *point,
            Self::Particle(_) => [0.0; 3],
        }
    }
}

/// Numbers of loads, 0 of those that have none like that.
macro_rules! numbers {
    ($($kind:ident: $name:ident, $what:literal;)+) => {
        impl Load {$(
            #[doc = $what]
            pub const fn $name(&self) -> f64 {
                match self {
                    Self::$kind { $name, .. } => *$name,
                    _ => 0.0,
                }
            }
        )+}
    };
}

numbers! {
    Drag: coefficient, "The torque over the angular velocity.";
    Spring: stiffness, "Force by length.";
    Spring: length, "The length without force.";
    Spring: damping, "Force by speed.";
}

impl Debug for Load {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

impl Load {
    /// The class that Python has for it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Torque { .. } => "AppliedTorque",
            Self::Drag { .. } => "RotationalDrag",
            Self::Spring { .. } => "AttachedSpring",
            Self::Function { .. } => "CompiledTorque",
            Self::Formula { .. } => "ExpressionTorque",
        }
    }

    /// Whether it looks at velocities.
    pub fn needs_velocity(&self) -> bool {
        match self {
            Self::Torque { .. } => false,
            Self::Drag { coefficient, .. } => *coefficient != 0.0,
            Self::Spring { damping, .. } => *damping != 0.0,
            Self::Function { .. } => true,
            Self::Formula { formula, .. } => formula.looks_at_velocity,
        }
    }

    /// Whether motions under it can be expanded in series: what a caller's function or formula does is not written in them.
    pub const fn has_series(&self) -> bool {
        !matches!(self, Self::Function { .. } | Self::Formula { .. })
    }

    /// Whether it is a formula, which may change with the time as fast as it likes.
    pub const fn is_formula(&self) -> bool {
        matches!(self, Self::Formula { .. })
    }

    /// The bodies of a scene of so many, `rigid` of them, that it makes depend on each other.
    pub fn pair(&self, particles: usize, rigid: usize) -> Option<(usize, usize)> {
        let Self::Spring { ends: [one, other], .. } = self else { return None };
        let index = |end: &End| match end {
            End::Body(body, _) => Some(particles - rigid + body),
            End::Particle(index) => Some(*index),
            End::Anchor(_) => None,
        };
        Some((index(one)?, index(other)?))
    }

    /// Whether it is a spring that needs a direction between ends at one place, the points of bodies being where `at` says.
    pub fn coincides(&self, at: impl Fn(usize, [f64; 3]) -> [f64; 3], places: &[[f64; 3]]) -> bool {
        let Self::Spring { ends, length, damping, .. } = self else { return false };
        let [one, other] = ends.map(|end| match end {
            End::Body(body, point) => at(body, point),
            End::Particle(index) => places[index],
            End::Anchor(point) => point,
        });
        (*length > 0.0 || *damping > 0.0) && one == other
    }

    /// Whether it pulls a body of the scene that is no rigid one.
    pub fn pulls(&self, particle: usize) -> bool {
        let at = |end: &End| matches!(end, End::Particle(index) if *index == particle);
        matches!(self, Self::Spring { ends, .. } if ends.iter().any(at))
    }

    /// Whether it acts on a rigid body.
    pub fn acts_on(&self, rigid: usize) -> bool {
        let at = |end: &End| matches!(end, End::Body(body, _) if *body == rigid);
        match self {
            Self::Torque { body, .. }
            | Self::Drag { body, .. }
            | Self::Function { body, .. }
            | Self::Formula { body, .. } => body.is_none_or(|body| body == rigid),
            Self::Spring { ends, .. } => ends.iter().any(at),
        }
    }

    /// Refuses what is no load on so many rigid bodies of so many particles.
    ///
    /// # Errors
    /// By name.
    pub fn validate(&self, rigid: usize, particles: usize) -> Result<()> {
        let exists = |body: usize| {
            if body < rigid {
                return Ok(());
            }
            Err(Error::invalid("body", format!("expected one of {rigid} rigid bodies, got {body}")))
        };
        let finite = |name: &str, values: &[f64]| {
            if values.iter().all(|value| value.is_finite()) {
                return Ok(());
            }
            Err(Error::invalid(name, format!("expected finite numbers, got {}", numbers(values))))
        };
        let positive = |name: &str, value: f64| {
            if value >= 0.0 && value.is_finite() {
                return Ok(());
            }
            Err(Error::invalid(name, format!("expected a number of at least 0, got {}", number(value))))
        };
        match self {
            Self::Torque { body, torque, .. } => {
                finite("torque", torque)?;
                body.map_or(Ok(()), exists)
            }
            Self::Drag { body, coefficient } => {
                positive("coefficient", *coefficient)?;
                body.map_or(Ok(()), exists)
            }
            Self::Function { body, .. } => body.map_or(Ok(()), exists),
            Self::Formula { body, parameters, .. } => {
                finite("parameters", parameters)?;
                body.map_or(Ok(()), exists)
            }
            Self::Spring { ends, stiffness, length, damping } => {
                positive("stiffness", *stiffness)?;
                positive("length", *length)?;
                positive("damping", *damping)?;
                ends.iter().try_for_each(|end| match end {
                    End::Body(body, point) => {
                        finite("point", point)?;
                        exists(*body)
                    }
                    End::Particle(index) if *index < particles => Ok(()),
                    End::Particle(index) => Err(Error::invalid(
                        "particle",
                        format!("expected one of {particles} bodies, got {index}"),
                    )),
                    End::Anchor(point) => finite("anchor", point),
                })
            }
        }
    }
}

/// Loads that copies have of their own.
#[derive(Clone, Debug)]
pub struct OwnLoads {
    /// Different sets of them.
    pub sets: Vec<Vec<Load>>,
    /// Which of these each copy has.
    pub of_copy: Vec<usize>,
}

impl OwnLoads {
    /// Those of some copies, and no others: what is asked of all sets is asked of theirs.
    pub(super) fn of(&self, members: &[usize]) -> Self {
        let mut known = BTreeMap::new();
        let mut sets = Vec::new();
        let of_copy = members.iter().map(|&copy| {
            let set = self.of_copy[copy];
            *known.entry(set).or_insert_with(|| {
                sets.push(self.sets[set].clone());
                sets.len() - 1
            })
        });
        let of_copy = of_copy.collect();
        Self { sets, of_copy }
    }
}
