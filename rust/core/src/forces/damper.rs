//! Dampers between listed pairs of bodies: what slows down the rate at which their distance changes.
//!
//! Canonical order: dampers act one after another, in the order in which they are listed, whatever the lanes are.
//! Products and sums are not fused, so that one number has the bits of a lane.

use super::bodies::PreciseBodies;
use super::context::{Context, System};
use super::derivative::{Along, Derivative};
use super::links::series::{LinkLaw, LinkSeries, Numbers};
use super::links::{Linked, Links, OfLinks, check_counts, of_link};
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::term::{About, Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use super::{Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::tiered;
use std::sync::Arc;

/// The exponents of length, mass and time in a force over a speed.
const COEFFICIENT: [i32; 3] = [0, 1, -1];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "damper",
    class_name: "Damper",
    summary: "A damper between two bodies, or one for each of several pairs",
    formula: "F = −c d|rⱼ − rᵢ|/dt along the line between them",
    notes: "Numbers are for all pairs, arrays of shape (M,) for each of M pairs. Beside a Spring between the same bodies \
            it is a damped spring. Momentum and angular momentum are conserved, energy is not. Ends must have mass, and \
            must not coincide: the direction would not be known.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.5",
    example: ">>> vv.Damper(i=0, j=1, c=0.5)\nDamper(i=0, j=1, c=0.5)",
    at_rest: "",
    one_way: "damping takes energy away, run backward it would bring some",
    parameters: &[
        Parameter::new("i", Kind::Indices, "The body at one end"),
        Parameter::new("j", Kind::Indices, "The body at the other end"),
        Parameter::new(
            "c",
            Kind::Numbers(Sign::NotNegative),
            "The force over the rate of the distance, or shape (M,): of each of M pairs",
        )
        .of(COEFFICIENT),
    ],
    make: |values| Ok(Arc::new(Dampers::new(values)?)),
};

/// Dampers, in the order in which they act.
#[derive(Debug)]
struct Dampers {
    links: Links,
    coefficient: Vec<f64>,
}

impl Dampers {
    fn new(values: &[Value]) -> Result<Self> {
        let [i, j, c] = values else {
            return Err(Error::Internal("Damper takes three parameters".to_owned()));
        };
        let (i, j, c) = (i.indices(), j.indices(), c.numbers());
        let count = check_counts("dampers", &[("i", i.len()), ("j", j.len()), ("c", c.len())])?;
        let coefficient = (0..count).map(|at| of_link(&c, at)).collect();
        Ok(Self { links: Links::new(count, &i, &j), coefficient })
    }

    fn acting(&self, context: &Context<'_>) -> Kernel {
        let linked = Linked::new(&self.links, context);
        let number = |system: &System<'_>, at: usize| {
            context.units.take(context.own(self, system).coefficient[at], COEFFICIENT)
        };
        Kernel { coefficient: linked.numbers(context, number), linked }
    }
}

/// `c s'/(2s)` of the squared distance `s`, for the recurrences of its series.
struct Law;

impl LinkLaw for Law {
    const EXPONENT: f64 = -1.0;
    const BY_RATE: bool = true;
    fn may_meet([coefficient, _]: Numbers<f64>) -> bool {
        coefficient == 0.0
    }
    /// Its force goes on as it is where ends meet head on, and has no length.
    fn near(_: Numbers<f64>) -> f64 {
        0.0
    }
    #[inline(always)]
    fn of_rate<V: Real>([coefficient, _]: Numbers<V>, unit: V) -> V {
        coefficient * unit
    }
}

impl ForceTerm for Dampers {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.acting(context))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        Some(Box::new(self.acting(context)))
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let Kernel { linked, coefficient } = self.acting(context);
        let nothing = vec![Lanes::zero(); coefficient.len()];
        Some(Box::new(LinkSeries::<Law>::new(linked, [coefficient, nothing])))
    }
    fn series_in_every_lane(&self) -> bool {
        true
    }
    fn has_series(&self) -> bool {
        true
    }
    fn potential_and_virial(
        &self,
        _: &PreciseBodies,
        _: usize,
        _: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        Ok((Scaled::ZERO, Scaled::from(f64::NAN)))
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        self.links.validate(view)?;
        self.links.refuse_coincident(view, "a Damper", |at| self.coefficient[at] > 0.0)
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.links.at(particle).next().is_some()
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.coefficient.iter().any(|&c| c != 0.0)
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn coupling(&self) -> Coupling {
        Coupling::Listed(self.links.pairs().to_vec())
    }
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        let Some([i, j, links]) = remaining.links(self.links.pairs()) else { return OfRemaining::Unknown };
        if links.is_empty() {
            return OfRemaining::Nothing;
        }
        let coefficients = links.iter().map(|&at| self.coefficient[at]).collect();
        OfRemaining::Values(vec![Value::Indices(i), Value::Indices(j), Value::Numbers(coefficients)])
    }
    fn conserves(&self) -> Conserves {
        Conserves { momentum: true, angular_momentum: About::Everywhere, spin: true, energy: false }
    }
    fn never_gives_energy(&self) -> bool {
        true
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
}

#[derive(Debug)]
struct Kernel {
    linked: Linked,
    coefficient: OfLinks,
}

/// Places and velocities, in the lanes or one after another.
type Moving<'a, S> = (&'a [S], &'a [S]);

/// Adds the drag of a damper to the accelerations of its ends, whose numbers are at these places; or what it changes by along a
/// direction.
#[inline(always)]
fn act<S: Real>(
    coefficient: S,
    (i, j): (usize, usize),
    (stride, components): (usize, usize),
    inverse_mass: &[S],
    ((q, v), along): (Moving<'_, S>, Option<Moving<'_, S>>),
    a: &mut [S],
) {
    let mut d = [S::zero(); 3];
    let (mut square, mut closing) = (S::zero(), S::zero());
    for c in 0..components {
        d[c] = q[c * stride + j] - q[c * stride + i];
        square += d[c] * d[c];
        closing += d[c] * (v[c * stride + j] - v[c * stride + i]);
    }
    let share = coefficient * closing / square;
    let mut force = [S::zero(); 3];
    for c in 0..components {
        force[c] = share * d[c];
    }
    if let Some((of_places, of_velocities)) = along {
        let (mut apart, mut faster, mut parting) = ([S::zero(); 3], S::zero(), S::zero());
        for c in 0..components {
            let (first, second) = (c * stride + i, c * stride + j);
            apart[c] = of_places[second] - of_places[first];
            faster +=
                apart[c] * (v[second] - v[first]) + d[c] * (of_velocities[second] - of_velocities[first]);
            parting += apart[c] * d[c];
        }
        let other = (coefficient * faster - (share + share) * parting) / square;
        for c in 0..components {
            force[c] = share * apart[c] + other * d[c];
        }
    }
    for c in 0..components {
        let force = force[c];
        a[c * stride + i] += force * inverse_mass[i];
        a[c * stride + j] += -force * inverse_mass[j];
    }
}

#[inline(always)]
fn kernel<V: Vector8>(
    force: &Kernel,
    ((q, v), along): (Moving<'_, Lanes>, Option<Moving<'_, Lanes>>),
    a: &mut [Lanes],
    first: bool,
) {
    let linked = &force.linked;
    let Shape { rows, components } = linked.shape;
    if first {
        a.fill(Lanes::zero());
    }
    if linked.packed {
        let stride = rows * WIDTH;
        let (q, v, a) = (as_numbers(q), as_numbers(v), as_numbers_mut(a));
        let inverse_mass = as_numbers(&linked.inverse_mass);
        let along = along.map(|(q, v)| (as_numbers(q), as_numbers(v)));
        let moving = ((q, v), along);
        for (at, &(_, ends)) in linked.links.iter().enumerate() {
            act::<f64>(force.coefficient[at].0[0], ends, (stride, components), inverse_mass, moving, a);
        }
        return;
    }
    let (q, v, a, inverse_mass) = (V::view(q), V::view(v), V::view_mut(a), V::view(&linked.inverse_mass));
    let moving = ((q, v), along.map(|(q, v)| (V::view(q), V::view(v))));
    let bodies = rows / linked.blocks.max(1);
    let (dampers, coefficient) = (linked.links.len(), V::view(&force.coefficient));
    for block in 0..linked.blocks {
        for (at, &(_, (i, j))) in linked.links.iter().enumerate() {
            let ends = (block * bodies + i, block * bodies + j);
            act::<V>(coefficient[block * dampers + at], ends, (rows, components), inverse_mass, moving, a);
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, of: (Moving<'_, Lanes>, Option<Moving<'_, Lanes>>), a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, ((phase.q, phase.v), None), a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
}

impl Derivative<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, ((phase.q, phase.v), Some((along.q, along.v))), change, true);
        Ok(())
    }
}
