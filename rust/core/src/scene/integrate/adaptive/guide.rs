//! Massive bodies along one of their steps, and what massless ones feel there.
//!
//! The one idea: between its ends a step of the massive bodies is a polynomial of time, so a massless body can take
//! steps of its own through it, as often as it needs, and the massive ones are integrated once.

use super::super::super::plan::Plan;
use super::super::super::unit::{Prepared, uncoupled};
use crate::error::{Error, Result};
use crate::forces::following::{Following, Leaders, Massive};
use crate::forces::series::Series;
use crate::forces::{Force, Phase};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::Scheme;
use crate::ode::series::Jet;
use crate::ode::state::State;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::ode::trial::Trial;
use crate::parallel::Ticker;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

mod series;
use series::{Coefficients, Shifted};

/// Where massive bodies are during a step of theirs, one system in each lane or the same in all: for each coordinate
/// `q + (e + θ(f0 + (1-θ)(f1 + θ(f2 + …))))` at the fraction θ of the step.
#[derive(Debug, Default)]
pub(super) struct Path {
    /// How long the step is.
    pub(super) h: Lanes,
    /// Coordinates, component after component.
    numbers: usize,
    /// Whether velocities are asked for: they come after the places.
    moving: bool,
    /// A block of numbers for `q`, one for `e` and one for each `f`.
    blocks: Vec<Lanes>,
    /// The same as series, of a method that has them.
    coefficients: Option<Coefficients>,
    /// The times of the stages of a step as long as this one, and where the bodies are then, once somebody has asked.
    stages: Vec<(Lanes, OnceLock<Vec<Lanes>>)>,
    /// Room for those, and for blocks of bodies that are packed.
    spare: Mutex<Vec<Vec<Lanes>>>,
    packed: Vec<Lanes>,
}

/// Paths along the last two steps: who follows the later one has left the other, whose room serves the next.
#[derive(Default)]
pub(super) struct Paths([Option<Arc<Path>>; 2]);

impl Paths {
    /// That along the next step, once it is laid.
    pub(super) fn next(&mut self, lay: impl FnOnce(&mut Path)) -> Arc<Path> {
        let [older, last] = &mut self.0;
        let mut path = older.take().and_then(|path| Arc::try_unwrap(path).ok()).unwrap_or_default();
        lay(&mut path);
        let path = Arc::new(path);
        *older = last.replace(Arc::clone(&path));
        path
    }
}

impl Path {
    /// Lays it along the step that the trial has tried from a state, once its continuous extension is ready; its stages are at
    /// these fractions of it. Where massless bodies ask for velocities, with those.
    pub(super) fn lay(
        &mut self,
        unit: &Prepared,
        (trial, fractions): (&dyn Trial<Lanes>, &[Lanes]),
        state: &State<Lanes>,
        h: Lanes,
        (packed, moving): (bool, bool),
    ) {
        let (q, rest) = state.position();
        let blocks = if packed { &mut self.packed } else { &mut self.blocks };
        blocks.clear();
        blocks.extend_from_slice(q);
        blocks.extend_from_slice(rest);
        trial.extension(state, h, blocks);
        if packed {
            apart(unit, &self.packed, q.len(), &mut self.blocks);
        }
        (self.h, self.moving, self.numbers) = (h, moving, unit.unit.active * unit.shape.components);
        match trial.series() {
            Some(jet) => self.coefficients.get_or_insert_default().take_up(unit, jet, packed),
            None => self.coefficients = None,
        }
        let spare = self.spare.get_mut().unwrap_or_else(PoisonError::into_inner);
        self.stages.resize_with(fractions.len(), Default::default);
        for ((time, places), &fraction) in self.stages.iter_mut().zip(fractions) {
            *time = h * fraction;
            spare.extend(places.take());
        }
    }

    /// How many numbers tell where the bodies are, and how they move if that is asked for.
    fn told(&self) -> usize {
        if self.moving { 2 * self.numbers } else { self.numbers }
    }

    /// Writes where the bodies are at the time `t` since the start of the step, and then how they move if that is asked for:
    /// the derivative of the same polynomial.
    fn at(&self, t: &Lanes, into: &mut [Lanes]) {
        Lanes::pass(At { path: self, t, into });
    }

    /// Where the bodies are at a stage of a step as long as this one, if `t` is the time of one in these lanes: most massless
    /// bodies take such a step, and all that do ask for the same places.
    fn at_stage(&self, t: &Lanes, lanes: Bits) -> Option<&[Lanes]> {
        let is_then = |time: &Lanes| (0..WIDTH).all(|lane| time.0[lane] == t.0[lane] || !lanes.lane(lane));
        let (time, places) = self.stages.iter().find(|(time, _)| is_then(time))?;
        Some(places.get_or_init(|| {
            let spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let mut places = spare.unwrap_or_default();
            places.resize(self.told(), Lanes::zero());
            self.at(time, &mut places);
            places
        }))
    }
}

/// Of packed bodies each in all lanes: their numbers in blocks of a length.
fn apart(unit: &Prepared, blocks: &[Lanes], len: usize, into: &mut Vec<Lanes>) {
    let rows = len / unit.shape.components;
    into.clear();
    for block in blocks.chunks(len) {
        for component in block.chunks(rows) {
            for slot in 0..unit.unit.active {
                let (row, lane) = unit.locate(slot, 0);
                into.push(Lanes::splat(component[row].0[lane]));
            }
        }
    }
}

struct At<'a> {
    path: &'a Path,
    t: &'a Lanes,
    into: &'a mut [Lanes],
}

impl Pass<Lanes> for At<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        if self.path.moving { along::<V, true>(self) } else { along::<V, false>(self) }
    }
}

#[inline(always)]
fn along<V: View<Lanes>, const MOVING: bool>(At { path, t, into }: At<'_>) {
    let Path { numbers, blocks, h, .. } = path;
    let (blocks, into) = (V::view(blocks), V::view_mut(into));
    let (theta, per_step) = (V::load(*t) / V::load(*h), V::one() / V::load(*h));
    let mut start = 0;
    while *numbers - start >= 6 {
        at::<V, MOVING, 6>(blocks, *numbers, start, (theta, per_step), into);
        start += 6;
    }
    while *numbers - start >= 3 {
        at::<V, MOVING, 3>(blocks, *numbers, start, (theta, per_step), into);
        start += 3;
    }
    while *numbers - start >= 1 {
        at::<V, MOVING, 1>(blocks, *numbers, start, (theta, per_step), into);
        start += 1;
    }
}

/// `G` coordinates from `start` on: one alone would wait for each of its operations.
#[inline(always)]
fn at<V: Real, const MOVING: bool, const G: usize>(
    blocks: &[V],
    numbers: usize,
    start: usize,
    (theta, per_step): (V, V),
    into: &mut [V],
) {
    let rest = V::one() - theta;
    let (mut sums, mut slopes) = ([V::zero(); G], [V::zero(); G]);
    let terms = blocks.len() / numbers - 2;
    for term in (0..terms).rev() {
        let even = term % 2 == 0;
        let factor = if even { theta } else { rest };
        let block = &blocks[(2 + term) * numbers + start..][..G];
        for g in 0..G {
            let inner = block[g] + sums[g];
            if MOVING {
                // 1 − θ falls as θ grows.
                slopes[g] = factor.multiply_add(slopes[g], if even { inner } else { -inner });
            }
            sums[g] = factor * inner;
        }
    }
    let (q, e) = (&blocks[start..][..G], &blocks[numbers + start..][..G]);
    for g in 0..G {
        into[start + g] = q[g] + (e[g] + sums[g]);
        if MOVING {
            into[numbers + start + g] = slopes[g] * per_step;
        }
    }
}

/// One of the forces on massless bodies.
enum Term {
    /// That of the massive ones.
    Following(Box<dyn Following>),
    /// Another, which does not couple them.
    Other(Box<dyn Force<Lanes>>, Option<Box<dyn Series<Lanes>>>),
}

/// The forces on a massless body in each lane, while massive ones move along their step.
pub(super) struct Guided {
    components: usize,
    path: Arc<Path>,
    /// The time at which the step of the massive bodies begins.
    base: Lanes,
    /// The lanes whose bodies move; in the others nothing matters.
    pub(super) running: Bits,
    /// In the scene's order, which is the order of summation.
    terms: Vec<Term>,
    needs: Needs,
    /// Where the massive bodies are at the time of an evaluation.
    places: Vec<Lanes>,
    /// Their series about that time.
    shifted: Shifted,
    evaluations: u64,
}

impl Guided {
    /// For the massless bodies `units`, all following massive ones like `guide`.
    ///
    /// # Errors
    /// Only errors of the library itself.
    pub(super) fn new(plan: &Plan, guide: &Prepared, units: &[&Prepared]) -> Result<Self> {
        let numbers = guide.unit.active * guide.shape.components;
        let leaders = Leaders {
            bodies: &guide.unit.bodies,
            components: guide.shape.components,
            units: plan.units,
            expands: matches!(plan.method.scheme, Scheme::Taylor(_)),
        };
        let mut terms = Vec::with_capacity(plan.forces.len());
        for (force, kernel) in plan.forces_of(guide.unit.copy).iter().zip(uncoupled(plan, units)) {
            terms.push(match kernel {
                Some((force, series)) => Term::Other(force, series),
                None => Term::Following(force.following(&leaders).ok_or_else(unled)?),
            });
        }
        let needs = terms.iter().fold(Needs { time: true, ..Needs::default() }, |needs, term| match term {
            Term::Following(force) => Needs { velocity: needs.velocity | force.needs_velocity(), ..needs },
            Term::Other(force, _) => needs.and(force.needs()),
        });
        let blocks = vec![Lanes::zero(); 3 * numbers];
        let path = Path { h: Lanes::one(), numbers, blocks, ..Path::default() };
        Ok(Self {
            components: guide.shape.components,
            path: Arc::new(path),
            base: Lanes::zero(),
            running: Bits(0xff),
            terms,
            needs,
            places: vec![Lanes::zero(); numbers],
            shifted: Shifted::default(),
            evaluations: 0,
        })
    }

    /// Whether a force looks at the velocities of massive bodies.
    pub(super) fn asks_for_velocities(&self) -> bool {
        self.terms.iter().any(|term| matches!(term, Term::Following(force) if force.needs_velocity()))
    }

    /// Takes over the masses of a guide, and what is its own of the forces, for its lanes.
    pub(super) fn attach(&mut self, plan: &Plan, guide: &Prepared, lanes: Bits) {
        for (term, force) in self.terms.iter_mut().zip(plan.forces_of(guide.unit.copy)) {
            if let Term::Following(leading) = term {
                leading.lead(&**force, plan.units, &guide.mass, lanes);
            }
        }
    }

    /// The massless bodies in the lanes are these now.
    pub(super) fn take_up(&mut self, plan: &Plan, units: &[&Prepared]) {
        let kernels = plan.forces.iter().zip(uncoupled(plan, units));
        for (term, (_, kernel)) in self.terms.iter_mut().zip(kernels) {
            if let (Term::Other(force, series), Some(own)) = (term, kernel) {
                (*force, *series) = own;
            }
        }
    }

    /// The massive bodies move along this path, from the time `base` on.
    pub(super) fn follow(&mut self, path: &Arc<Path>, base: Lanes) {
        (self.path, self.base) = (Arc::clone(path), base);
        self.places.resize(path.told(), Lanes::zero());
    }

    /// Where the massive bodies of a lane are at the time `t` since the start of their step.
    pub(super) fn places(&mut self, t: f64, lane: usize) -> Vec<[f64; 3]> {
        self.path.at(&Lanes::splat(t), &mut self.places);
        let massive = self.path.numbers / self.components;
        let mut places = vec![[0.0; 3]; massive];
        for (number, place) in self.places.iter().enumerate().take(self.path.numbers) {
            places[number % massive][number / massive] = place.0[lane];
        }
        places
    }
}

impl System<Lanes> for Guided {
    fn form(&self) -> Form {
        Form::SecondOrder(self.components)
    }

    fn needs(&self) -> Needs {
        self.needs
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn acceleration(
        &mut self,
        t: &Lanes,
        q: &[Lanes],
        v: &[Lanes],
        a: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.evaluations += 1;
        let places = match self.path.at_stage(t, self.running) {
            Some(places) => places,
            None => {
                self.path.at(t, &mut self.places);
                &self.places
            }
        };
        let (places, velocities) = places.split_at(self.path.numbers);
        for (index, term) in self.terms.iter_mut().enumerate() {
            match term {
                Term::Following(force) => force.apply(Massive { places, velocities }, (q, v), a, index == 0),
                Term::Other(force, _) => {
                    let phase = Phase { t: &(self.base + *t), q, v };
                    force.apply(&phase, a, index == 0, ticker)?;
                }
            }
        }
        Ok(())
    }

    fn expand(&mut self, jet: &mut Jet<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        self.expand_series(jet, ticker)
    }

    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let step = Taken { from: self.base + step.from, ..*step };
        let mut until: Option<Lanes> = None;
        for term in &mut self.terms {
            let Term::Other(force, _) = term else { continue };
            if let Some(seen) = force.seen_until(&step)? {
                until = Some(until.map_or(seen, |until| until.min(seen)));
            }
        }
        Ok(until)
    }
}

fn unled() -> Error {
    Error::Internal("a force that massless bodies do not follow".to_owned())
}
