//! Massive bodies along one of their steps, and what massless ones feel there.
//!
//! The one idea: between its ends a step of the massive bodies is a polynomial of time, so a massless body can take
//! steps of its own through it, as often as it needs, and the massive ones are integrated once.

use super::super::super::plan::Plan;
use super::super::super::unit::{Prepared, uncoupled};
use crate::error::Result;
use crate::forces::gravity::passive::Pull;
use crate::forces::gravity::series::passive::PullSeries;
use crate::forces::series::Series;
use crate::forces::{Force, Phase};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::state::State;
use crate::ode::system::{Form, Needs, System};
use crate::ode::trial::Trial;
use crate::parallel::Ticker;
use std::sync::{Arc, OnceLock};

mod series;
use series::{Coefficients, Shifted};

/// Where massive bodies are during a step of theirs, one system in each lane or the same in all: for each coordinate
/// `q + (e + θ(f0 + (1-θ)(f1 + θ(f2 + …))))` at the fraction θ of the step.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// How long the step is.
    pub(super) h: Lanes,
    /// Coordinates, component after component.
    numbers: usize,
    /// A block of numbers for `q`, one for `e` and one for each `f`.
    blocks: Vec<Lanes>,
    /// The same as series, of a method that has them.
    coefficients: Option<Coefficients>,
    /// The times of the stages of a step as long as this one, and where the bodies are then, once somebody has asked.
    stages: Vec<(Lanes, OnceLock<Vec<Lanes>>)>,
}

impl Path {
    /// Of the step that the trial has tried from a state, once its continuous extension is ready; its stages are at these
    /// fractions of it.
    pub(super) fn new(
        unit: &Prepared,
        (trial, fractions): (&dyn Trial<Lanes>, &[Lanes]),
        state: &State<Lanes>,
        h: Lanes,
        packed: bool,
    ) -> Self {
        let (q, rest) = state.position();
        let mut blocks = [q, rest].concat();
        trial.extension(state, h, &mut blocks);
        let numbers = unit.unit.active * unit.shape.components;
        if packed {
            blocks = Self::apart(unit, &blocks, q.len());
        }
        let coefficients = trial.series().map(|jet| Coefficients::new(unit, jet, packed));
        let stages = fractions.iter().map(|&fraction| (h * fraction, OnceLock::new())).collect();
        Self { h, numbers, blocks, coefficients, stages }
    }

    /// Of packed bodies each in all lanes: their numbers in blocks of a length.
    fn apart(unit: &Prepared, blocks: &[Lanes], len: usize) -> Vec<Lanes> {
        let rows = len / unit.shape.components;
        let mut apart = Vec::with_capacity(blocks.len() / len * unit.unit.active * unit.shape.components);
        for block in blocks.chunks(len) {
            for component in block.chunks(rows) {
                for slot in 0..unit.unit.active {
                    let (row, lane) = unit.locate(slot, 0);
                    apart.push(Lanes::splat(component[row].0[lane]));
                }
            }
        }
        apart
    }

    /// Writes where the bodies are at the time `t` since the start of the step.
    fn at(&self, t: &Lanes, into: &mut [Lanes]) {
        Lanes::pass(At { path: self, t, into });
    }

    /// Where the bodies are at a stage of a step as long as this one, if `t` is the time of one in these lanes: most massless
    /// bodies take such a step, and all that do ask for the same places.
    fn at_stage(&self, t: &Lanes, lanes: Bits) -> Option<&[Lanes]> {
        let is_then = |time: &Lanes| (0..WIDTH).all(|lane| time.0[lane] == t.0[lane] || !lanes.lane(lane));
        let (time, places) = self.stages.iter().find(|(time, _)| is_then(time))?;
        Some(places.get_or_init(|| {
            let mut places = vec![Lanes::zero(); self.numbers];
            self.at(time, &mut places);
            places
        }))
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
        let Path { numbers, blocks, h, .. } = self.path;
        let (blocks, into) = (V::view(blocks), V::view_mut(self.into));
        let theta = V::load(*self.t) / V::load(*h);
        let mut start = 0;
        while *numbers - start >= 6 {
            at::<V, 6>(blocks, *numbers, start, theta, into);
            start += 6;
        }
        while *numbers - start >= 3 {
            at::<V, 3>(blocks, *numbers, start, theta, into);
            start += 3;
        }
        while *numbers - start >= 1 {
            at::<V, 1>(blocks, *numbers, start, theta, into);
            start += 1;
        }
    }
}

/// `G` coordinates from `start` on: one alone would wait for each of its operations.
#[inline(always)]
fn at<V: Real, const G: usize>(blocks: &[V], numbers: usize, start: usize, theta: V, into: &mut [V]) {
    let rest = V::one() - theta;
    let mut sums = [V::zero(); G];
    let terms = blocks.len() / numbers - 2;
    for term in (0..terms).rev() {
        let factor = if term % 2 == 0 { theta } else { rest };
        let block = &blocks[(2 + term) * numbers + start..][..G];
        for g in 0..G {
            sums[g] = factor * (block[g] + sums[g]);
        }
    }
    let (q, e) = (&blocks[start..][..G], &blocks[numbers + start..][..G]);
    for g in 0..G {
        into[start + g] = q[g] + (e[g] + sums[g]);
    }
}

/// One of the forces on massless bodies.
enum Term {
    /// The massive ones pull, with these `G·m`.
    Pull { strength: Vec<Lanes>, softening2: f64, series: PullSeries },
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
    pub(super) fn new(plan: &Plan, guide: &Prepared, units: &[&Prepared]) -> Self {
        let numbers = guide.unit.active * guide.shape.components;
        let mut terms = Vec::with_capacity(plan.forces.len());
        for (force, kernel) in plan.forces.iter().zip(uncoupled(plan, units)) {
            match (force.as_newtonian(), kernel) {
                (Some((_, softening)), _) => {
                    let softening = plan.units.take(softening, [1, 0, 0]);
                    let softening2 = softening * softening;
                    terms.push(Term::Pull {
                        series: PullSeries::new(guide.unit.active, guide.shape.components, softening2),
                        strength: vec![Lanes::zero(); guide.unit.active],
                        softening2,
                    });
                }
                (None, other) => terms.extend(other.map(|(force, series)| Term::Other(force, series))),
            }
        }
        let needs = terms.iter().fold(Needs { time: true, ..Needs::default() }, |needs, term| match term {
            Term::Pull { .. } => needs,
            Term::Other(force, _) => needs.and(force.needs()),
        });
        let blocks = vec![Lanes::zero(); 3 * numbers];
        Self {
            components: guide.shape.components,
            path: Arc::new(Path { h: Lanes::one(), numbers, blocks, coefficients: None, stages: Vec::new() }),
            base: Lanes::zero(),
            running: Bits(0xff),
            terms,
            needs,
            places: vec![Lanes::zero(); numbers],
            shifted: Shifted::default(),
            evaluations: 0,
        }
    }

    /// Takes over the masses of a guide, and what is its own of the forces, for its lanes.
    pub(super) fn attach(&mut self, plan: &Plan, guide: &Prepared, lanes: Bits) {
        for (term, force) in self.terms.iter_mut().zip(plan.forces_of(guide.unit.copy)) {
            if let (Term::Pull { strength, .. }, Some((constant, _))) = (term, force.as_newtonian()) {
                let constant = plan.units.take(constant, [3, -1, -2]);
                for (strength, mass) in strength.iter_mut().zip(&guide.mass) {
                    *strength = Lanes::select(lanes, Lanes::splat(constant * mass), *strength);
                }
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
    }

    /// Where the massive bodies of a lane are at the time `t` since the start of their step.
    pub(super) fn places(&mut self, t: f64, lane: usize) -> Vec<[f64; 3]> {
        self.path.at(&Lanes::splat(t), &mut self.places);
        let massive = self.places.len() / self.components;
        let mut places = vec![[0.0; 3]; massive];
        for (number, place) in self.places.iter().enumerate() {
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
        for (index, term) in self.terms.iter_mut().enumerate() {
            match term {
                Term::Pull { strength, softening2, .. } => Lanes::pass(Pull {
                    places,
                    strength,
                    softening2: *softening2,
                    q,
                    a: &mut *a,
                    first: index == 0,
                }),
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
}
