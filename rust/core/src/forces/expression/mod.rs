//! Forces of one's own, as expressions: a potential energy or the components of a force, of places, velocities and time.
//!
//! The one idea: what a user writes is a graph in the scene's own coordinates and units, with derivatives taken on it; a
//! scene that is shifted, turned or rescaled changes the few numbers that lead from its bodies to those coordinates.

mod alone;
mod compiled;
mod expanded;
mod kernel;
mod unseen;

use super::Force;
use super::bodies::{Of, PreciseBodies};
use super::context::Context;
use super::derivative::Derivative;
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::term::{Bodies, Conserves, ForceDeclaration, ForceTerm};
use crate::error::{Error, Result};
use crate::expressions::{Code, Machine, series};
use crate::narrow::Features;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::units::{Dimension, Units};
use crate::words::number;
use expanded::Expanded;
use kernel::{Change, Kernel};
use std::sync::{Arc, OnceLock};

/// Numbers that expressions are of: a place and a velocity.
const VARIABLES: usize = 6;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "expressed_force",
    class_name: "ExpressedForce",
    summary: "A force of one's own on every body, or on some, as `visviva.ExpressionForce` makes it",
    formula: "F or F/m of x, y, z, vx, vy, vz and t, or V(x, y, z, t) with F = −∇V",
    notes: "The place, the velocity and the time in the expressions are those of a body from `origin`, along the axes \
            `first`, `second` and `third`, in the units `length`, `mass` and `time`: so a scene that is shifted, turned or \
            rescaled takes the force along. What acts by a force, or a potential energy, needs bodies with a mass. A potential \
            energy without time in it is conserved with the kinetic energy; one with time is not counted.",
    source: "A. Griewank & A. Walther, Evaluating Derivatives (2008), for the derivatives",
    example: ">>> spring = vv.ExpressionForce(potential=lambda r, v, t, k: k * r[0] ** 2 / 2, parameters={\"k\": 4.0})\n\
              >>> ion = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), spring)\n\
              >>> ion.run(t=1.0, rtol=1e-12).position[-1, 0, 0].round(9).item()\n\
              -0.416146837",
    at_rest: "field",
    one_way: "what velocities and time do in it is not known",
    parameters: &[
        Parameter::new(
            "gives",
            Kind::Choice(&["force", "potential", "acceleration"]),
            "What the expressions give",
        ),
        Parameter::new(
            "nodes",
            Kind::Table(Sign::Any),
            "The expressions, as `visviva.ExpressionForce` writes them",
        ),
        Parameter::new(
            "values",
            Kind::Table(Sign::Any),
            "Of the parameters in them, in the units `length`, `mass` and `time`",
        ),
        Parameter::new("first", Kind::Vector, "The axis of x"),
        Parameter::new("second", Kind::Vector, "The axis of y"),
        Parameter::new("third", Kind::Vector, "The axis of z"),
        Parameter::new("origin", Kind::Point, "Where x, y and z are 0").of([1, 0, 0]).or(0.0),
        Parameter::positive("length", [1, 0, 0], "The unit of length in the expressions").or(1.0),
        Parameter::positive("mass", [0, 1, 0], "The unit of mass in them").or(1.0),
        Parameter::positive("time", [0, 0, 1], "The unit of time in them").or(1.0),
        Parameter::new("bodies", Kind::Indices, "The bodies on which it acts, or none for all").or(0.0),
    ],
    make: |values| match values {
        [gives, nodes, parameters, first, second, third, origin, length, mass, time, bodies] => {
            let axes = [first.vector(), second.vector(), third.vector()];
            check_axes(&axes)?;
            let gives = Gives::named(gives.word());
            let expressions = compiled::read(gives, nodes.table(), parameters.table())?;
            Ok(Arc::new(ExpressionForce {
                gives,
                bodies: bodies.indices(),
                values: values.to_vec(),
                expressions,
                place: Place {
                    axes,
                    origin: origin.vector(),
                    scales: [length, mass, time].map(Value::number),
                },
            }))
        }
        _ => Err(Error::Internal("ExpressedForce takes eleven parameters".to_owned())),
    },
};

/// How far from one and zero products of axes may be: they have been turned, perhaps often.
const SQUARE: f64 = 1e-9;

/// Refuses axes that are not of length one and at right angles.
fn check_axes(axes: &[[f64; 3]; 3]) -> Result<()> {
    for (i, name) in ["first", "second", "third"].into_iter().enumerate() {
        for j in 0..=i {
            let product: f64 = (0..3).map(|c| axes[i][c] * axes[j][c]).sum();
            let wanted = if i == j { 1.0 } else { 0.0 };
            if (product - wanted).abs() > SQUARE {
                return Err(Error::invalid(name, "expected axes of length 1 at right angles to each other"));
            }
        }
    }
    Ok(())
}

/// What expressions give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gives {
    Force,
    Potential,
    Acceleration,
}

impl Gives {
    fn named(word: &str) -> Self {
        match word {
            "potential" => Self::Potential,
            "acceleration" => Self::Acceleration,
            _ => Self::Force,
        }
    }

    /// The exponents of length, mass and time in what moves a body.
    fn dimension(self) -> Dimension {
        if self == Self::Acceleration { [1, 0, -2] } else { [1, 1, -2] }
    }
}

/// Expressions as they run.
#[derive(Debug)]
struct Expressions {
    /// The components of the force.
    force: Arc<Code>,
    /// The same as recurrences of Taylor coefficients, if it is smooth wherever it goes.
    series: Option<Arc<series::Series>>,
    /// The potential energy, if that was given.
    potential: Option<Arc<Code>>,
    parameters: Vec<f64>,
    needs: Needs,
    /// Whether there may be more in them than a step sees, and whether series see all.
    may_hide: bool,
    is_told: bool,
    /// What may be too narrow for a step, of accelerations: a further parameter is what they are of the components.
    narrow: Option<Arc<Features>>,
    /// What they were made from, but for the parameters.
    made_from: Vec<u64>,
    /// How the force changes along a direction, if that is known, once somebody has asked.
    change: OnceLock<Option<Arc<Code>>>,
}

/// What leads from a scene to the coordinates of the expressions.
#[derive(Clone, Copy, Debug)]
struct Place {
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
    /// The units of length, mass and time.
    scales: [f64; 3],
}

#[derive(Debug)]
struct ExpressionForce {
    gives: Gives,
    /// Those on which it acts, by their places in the scene; none for all.
    bodies: Vec<usize>,
    /// All that it was made from.
    values: Vec<Value>,
    expressions: Expressions,
    place: Place,
}

impl Place {
    /// The place and the velocity of a body, in the scene's units, as the expressions have them.
    fn local(&self, position: [f64; 3], velocity: [f64; 3]) -> [f64; VARIABLES] {
        let [length, _, time] = self.scales;
        let mut found = [0.0; VARIABLES];
        for (axis, along) in self.axes.iter().enumerate() {
            for c in 0..3 {
                found[axis] += along[c] * (position[c] - self.origin[c]) / length;
                found[3 + axis] += along[c] * velocity[c] * time / length;
            }
        }
        found
    }

    /// The unit of what moves a body.
    fn unit(&self, gives: Gives) -> f64 {
        let [length, mass, time] = self.scales;
        if gives == Gives::Acceleration { length / (time * time) } else { mass * length / (time * time) }
    }

    /// What moves a body along the scene's axes, in its units.
    fn global(&self, gives: Gives, pull: &[f64; 3]) -> [f64; 3] {
        let unit = self.unit(gives);
        core::array::from_fn(|c| {
            let along: f64 = (0..3).map(|axis| self.axes[axis][c] * pull[axis]).sum();
            along * unit
        })
    }
}

impl ExpressionForce {
    /// Whether it acts on a body of the scene.
    fn acts_on(&self, body: usize) -> bool {
        self.bodies.is_empty() || self.bodies.contains(&body)
    }
}

impl ForceTerm for ExpressionForce {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(Kernel::new(self, context))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let expressions = &self.expressions;
        let change =
            expressions.change.get_or_init(|| compiled::change(self.gives, expressions).map(Arc::new));
        Some(Box::new(Change::new(self, change.as_ref()?, context)))
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        Some(Box::new(Expanded::new(self, context)?))
    }
    fn has_series(&self) -> bool {
        self.expressions.series.is_some()
    }

    fn check_units(&self, units: Units) -> Result<()> {
        let unit = units.take(self.place.unit(self.gives), self.gives.dimension());
        if unit.is_normal() {
            return Ok(());
        }
        let what = if self.gives == Gives::Acceleration { "an acceleration" } else { "a force" };
        let message = format!(
            "expected units in which what an ExpressionForce gives is a number, but {what} of 1 is {} of those that \
             move these bodies; choose units nearer to theirs",
            number(unit)
        );
        Err(Error::invalid("forces", message))
    }

    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let Expressions { force, potential, parameters, needs, .. } = &self.expressions;
        if needs.time || needs.velocities() {
            return Ok((Scaled::ZERO, Scaled::from(f64::NAN)));
        }
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let [length, mass, time] = self.place.scales;
        let mut force = Machine::new(force.clone(), parameters);
        let mut potential = potential.as_ref().map(|code| Machine::new(code.clone(), parameters));
        for body in (0..bodies.len()).filter(|&body| self.acts_on(body)) {
            let place = bodies.vector(Of::Position, body);
            let whole = |value: DoubleDouble, unit: i32| scale(value.to_f64(), unit);
            let position = place.map(|x| whole(x, bodies.units.length));
            let state = self.place.local(position, [0.0; 3]);
            if let Some(potential) = &mut potential {
                let mut value = [0.0];
                potential.evaluate(0.0, &state, &mut value);
                let unit = length / time;
                energy = energy.plus(Scaled::from(value[0]).times(mass).times(unit).times(unit));
            }
            let mut pull = [0.0; 3];
            force.evaluate(0.0, &state, &mut pull);
            // Of an acceleration the force is that of the mass.
            let (share, unit) = match self.gives {
                Gives::Acceleration => (bodies.mass()[body], bodies.units.length + bodies.units.mass),
                Gives::Force | Gives::Potential => (1.0, bodies.units.length),
            };
            for (place, pull) in place.iter().zip(self.place.global(self.gives, &pull)) {
                work = work.plus(Scaled::new(*place * DoubleDouble::from(share), unit).times(pull));
            }
            ticker.tick()?;
        }
        Ok((energy, work))
    }

    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        let Some(body) = self.bodies.iter().find(|&&body| body >= view.particles) else { return Ok(()) };
        let count = view.particles;
        Err(Error::invalid(
            "bodies",
            format!("expected indices of the {count} bodies of the scene, got {body}"),
        ))
    }
    fn needs_mass(&self, body: usize) -> bool {
        self.gives != Gives::Acceleration && self.acts_on(body)
    }
    fn names_bodies(&self) -> bool {
        !self.bodies.is_empty()
    }
    /// An acceleration is that of whoever remains: on a body into which others have gone it acts if it did before.
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        if self.bodies.is_empty() {
            return OfRemaining::Same;
        }
        let known = self.bodies.iter().all(|&body| body < remaining.places.len());
        let (true, Gives::Acceleration, Some((_, others))) = (known, self.gives, self.values.split_last())
        else {
            return OfRemaining::Unknown;
        };
        let there: Vec<usize> =
            self.bodies.iter().filter_map(|&body| remaining.place_if_there(body)).collect();
        if there.is_empty() {
            return OfRemaining::Nothing;
        }
        OfRemaining::Values(others.iter().cloned().chain([Value::Indices(there)]).collect())
    }
    fn needs(&self) -> Needs {
        self.expressions.needs
    }
    fn conserves(&self) -> Conserves {
        let energy = self.expressions.potential.is_some() && !self.expressions.needs.time;
        Conserves { energy, ..Conserves::NOTHING }
    }
    /// The origin of the coordinates that the expressions have.
    fn fixed_point(&self) -> Option<[f64; 3]> {
        Some(self.place.origin)
    }
    /// Copies may have parameters of their own.
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        let Place { axes, origin, scales } = &self.place;
        let place = axes.as_flattened().iter().chain(origin).chain(scales).map(|x| x.to_bits());
        let bodies = core::iter::once(self.bodies.len()).chain(self.bodies.iter().copied());
        let made_from = self.expressions.made_from.iter().copied();
        Some(place.chain(bodies.map(|body| body as u64)).chain(made_from).collect())
    }
    fn may_change_anywhere(&self) -> bool {
        self.expressions.may_hide
    }
    fn may_be_narrow(&self) -> bool {
        self.expressions.narrow.is_some()
    }
    fn is_formula(&self) -> bool {
        true
    }
    fn is_told(&self) -> bool {
        self.expressions.is_told
    }
    fn series_in_every_lane(&self) -> bool {
        true
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        times: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let Expressions { force, parameters, .. } = &self.expressions;
        let mut force = Machine::new(force.clone(), parameters);
        let mut strongest = 0.0;
        let by_force = self.gives != Gives::Acceleration;
        for &(_, mass, position) in bodies.iter().filter(|(body, ..)| self.acts_on(*body)) {
            let position = position.map(|x| scale(x, units.length));
            for t in times {
                let mut pull = [0.0; 3];
                force.evaluate(t / self.place.scales[2], &self.place.local(position, [0.0; 3]), &mut pull);
                let pull = units.take_vector(self.place.global(self.gives, &pull), self.gives.dimension());
                let share = if by_force { mass } else { 1.0 };
                strongest = pull.iter().fold(strongest, |most: f64, x| most.max(x.abs() / share));
            }
        }
        Ok(strongest)
    }
}
