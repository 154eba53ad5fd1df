//! Where massive bodies are during a step of theirs.
//!
//! The one idea: packed, eight of them lie in a row; where all who ask do so for one time, rows are summed as they lie and each
//! body then goes to all lanes, and where they do not, each of its numbers goes there on the way.

use super::super::super::super::unit::Prepared;
use super::series::Coefficients;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes, WIDTH, as_numbers};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::trial::Trial;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// How the numbers of packed bodies lie in a block: component after component, so many rows of eight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packed {
    pub(super) bodies: usize,
    pub(super) rows: usize,
}

impl Packed {
    /// Whether there are fewer rows than bodies.
    #[inline]
    pub(super) fn are_several(self) -> bool {
        self.bodies > 1
    }
}

/// The time of all these lanes, if it is one.
pub(super) fn one_time(t: &Lanes, lanes: Bits) -> Option<f64> {
    let first = t.0[lanes.0.trailing_zeros() as usize % WIDTH];
    (0..WIDTH).all(|lane| t.0[lane] == first || !lanes.lane(lane)).then_some(first)
}

/// A step of massive bodies, one system in each lane or the same in all: for each coordinate
/// `q + (e + θ(f0 + (1-θ)(f1 + θ(f2 + …))))` at the fraction θ of the step.
#[derive(Debug, Default)]
pub(in super::super) struct Path {
    /// How long the step is.
    pub(in super::super) h: Lanes,
    /// Coordinates, component after component.
    pub(super) numbers: usize,
    /// Whether velocities are asked for: they come after the places.
    moving: bool,
    /// How bodies lie in blocks, if they are packed.
    packed: Option<Packed>,
    /// Where each of their numbers is in a block.
    places: Vec<usize>,
    /// A block of numbers for `q`, one for `e` and one for each `f`.
    blocks: Vec<Lanes>,
    /// The same as series, of a method that has them.
    pub(super) coefficients: Option<Coefficients>,
    /// The times of the stages of a step as long as this one, and where the bodies are then, once somebody has asked.
    stages: Vec<(Lanes, OnceLock<Vec<Lanes>>)>,
    /// Room for those.
    spare: Mutex<Vec<Vec<Lanes>>>,
}

/// Paths along the last two steps: who follows the later one has left the other, whose room serves the next.
#[derive(Default)]
pub(in super::super) struct Paths([Option<Arc<Path>>; 2]);

impl Paths {
    /// That along the next step, once it is laid.
    pub(in super::super) fn next(&mut self, lay: impl FnOnce(&mut Path)) -> Arc<Path> {
        let [older, last] = &mut self.0;
        let mut path = older.take().and_then(|path| Arc::try_unwrap(path).ok()).unwrap_or_default();
        lay(&mut path);
        let path = Arc::new(path);
        *older = last.replace(Arc::clone(&path));
        path
    }
}

impl Path {
    /// Bodies at rest at the origin.
    pub(super) fn at_rest(numbers: usize) -> Self {
        Self { h: Lanes::one(), numbers, blocks: vec![Lanes::zero(); 3 * numbers], ..Self::default() }
    }

    /// Lays it along the step that the trial has tried from a state, once its continuous extension is ready; its stages are at
    /// these fractions of it. Where massless bodies ask for velocities, with those.
    pub(in super::super) fn lay(
        &mut self,
        unit: &Prepared,
        (trial, fractions): (&dyn Trial<Lanes>, &[Lanes]),
        state: &State<Lanes>,
        h: Lanes,
        (packed, moving): (bool, bool),
    ) {
        let (q, rest) = state.position();
        self.blocks.clear();
        self.blocks.extend_from_slice(q);
        self.blocks.extend_from_slice(rest);
        trial.extension(state, h, &mut self.blocks);
        let components = unit.shape.components;
        (self.h, self.moving, self.numbers) = (h, moving, unit.unit.active * components);
        self.packed = packed.then(|| Packed { bodies: unit.unit.active, rows: q.len() / components });
        if let Some(Packed { bodies, rows }) = self.packed.filter(|_| self.places.len() != self.numbers) {
            let component = |c: usize| (0..bodies).map(move |body| c * rows * WIDTH + body);
            self.places = (0..components).flat_map(component).collect();
        }
        match trial.series() {
            Some(jet) => self.coefficients.get_or_insert_default().take_up(jet, self.packed),
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
    pub(super) fn told(&self) -> usize {
        if self.moving { 2 * self.numbers } else { self.numbers }
    }

    /// Writes where the bodies are at the time `t` since the start of the step in these lanes, and then how they move if that is
    /// asked for: the derivative of the same polynomial.
    pub(super) fn at(&self, t: &Lanes, lanes: Bits, into: &mut [Lanes]) {
        let one = self
            .packed
            .filter(|packed| packed.are_several())
            .and_then(|_| one_time(t, lanes))
            .map(Lanes::splat);
        self.at_times((one.as_ref().unwrap_or(t), one.is_some()), into);
    }

    fn at_times(&self, (t, one): (&Lanes, bool), into: &mut [Lanes]) {
        Lanes::pass(At { path: self, t, one, into });
    }

    /// Where the bodies are at a stage of a step as long as this one, if `t` is the time of one in these lanes: most massless
    /// bodies take such a step, and all that do ask for the same places.
    pub(super) fn at_stage(&self, t: &Lanes, lanes: Bits) -> Option<&[Lanes]> {
        let one = self.packed.is_some_and(|packed| packed.are_several());
        let is_then = |time: &Lanes| (0..WIDTH).all(|lane| time.0[lane] == t.0[lane] || !lanes.lane(lane));
        // Packed, a stage is at one time.
        let asked = if one && !self.stages.is_empty() { Some(one_time(t, lanes)?) } else { None };
        let (time, places) = self
            .stages
            .iter()
            .find(|(time, _)| asked.map_or_else(|| is_then(time), |asked| time.0[0] == asked))?;
        Some(places.get_or_init(|| {
            let spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let mut places = spare.unwrap_or_default();
            places.resize(self.told(), Lanes::zero());
            self.at_times((time, one), &mut places);
            places
        }))
    }
}

struct At<'a> {
    path: &'a Path,
    t: &'a Lanes,
    /// Whether that is one time, and the bodies are packed.
    one: bool,
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
fn along<V: View<Lanes>, const MOVING: bool>(At { path, t, one, into }: At<'_>) {
    let Path { numbers, blocks, h, packed, places, .. } = path;
    let times = (V::load(*t) / V::load(*h), V::one() / V::load(*h));
    let into = V::view_mut(into);
    match *packed {
        Some(packed) if one => {
            let len = *numbers / packed.bodies * packed.rows;
            let from = AsTheyLie { blocks: V::view(blocks), len };
            groups::<V, _, MOVING>(
                &from,
                len,
                times,
                &mut ToAll { packed, numbers: *numbers, into, row: 0, start: 0 },
            );
        }
        Some(packed) => {
            let len = *numbers / packed.bodies * packed.rows * WIDTH;
            let from = Spread { numbers: as_numbers(blocks), places, len };
            groups::<V, _, MOVING>(&from, *numbers, times, &mut InPlace { numbers: *numbers, into });
        }
        None => {
            let from = AsTheyLie { blocks: V::view(blocks), len: *numbers };
            groups::<V, _, MOVING>(&from, *numbers, times, &mut InPlace { numbers: *numbers, into });
        }
    }
}

/// Blocks of numbers.
trait Source<V> {
    fn blocks(&self) -> usize;
    /// Where the number `i` is in each block.
    fn place(&self, i: usize) -> usize;
    /// Of a block the numbers at these places, of which the first is that of the number `start`.
    fn read<const G: usize>(&self, block: usize, start: usize, places: &[usize; G]) -> [V; G];
}

struct AsTheyLie<'a, V> {
    blocks: &'a [V],
    len: usize,
}

impl<V: Copy> Source<V> for AsTheyLie<'_, V> {
    #[inline(always)]
    fn blocks(&self) -> usize {
        self.blocks.len() / self.len
    }
    #[inline(always)]
    fn place(&self, i: usize) -> usize {
        i
    }
    #[inline(always)]
    fn read<const G: usize>(&self, block: usize, start: usize, _: &[usize; G]) -> [V; G] {
        let group = &self.blocks[block * self.len + start..][..G];
        let mut read = [group[0]; G];
        read.copy_from_slice(group);
        read
    }
}

/// Those of packed bodies, each in all lanes.
struct Spread<'a> {
    numbers: &'a [f64],
    places: &'a [usize],
    len: usize,
}

impl<V: Real> Source<V> for Spread<'_> {
    #[inline(always)]
    fn blocks(&self) -> usize {
        self.numbers.len() / self.len
    }
    #[inline(always)]
    fn place(&self, i: usize) -> usize {
        self.places[i]
    }
    #[inline(always)]
    fn read<const G: usize>(&self, block: usize, _: usize, places: &[usize; G]) -> [V; G] {
        let block = &self.numbers[block * self.len..][..self.len];
        let mut read = [V::zero(); G];
        for g in 0..G {
            read[g] = V::splat(block[places[g]]);
        }
        read
    }
}

/// Where places and rates go.
trait Target<V> {
    fn put(&mut self, i: usize, place: V, rate: Option<V>);
}

struct InPlace<'a, V> {
    numbers: usize,
    into: &'a mut [V],
}

impl<V: Copy> Target<V> for InPlace<'_, V> {
    #[inline(always)]
    fn put(&mut self, i: usize, place: V, rate: Option<V>) {
        self.into[i] = place;
        if let Some(rate) = rate {
            self.into[self.numbers + i] = rate;
        }
    }
}

/// Of rows of packed bodies, one after another, each body goes to all lanes.
struct ToAll<'a, V> {
    packed: Packed,
    numbers: usize,
    into: &'a mut [V],
    /// The next row, and where its component begins.
    row: usize,
    start: usize,
}

impl<V: View<Lanes>> Target<V> for ToAll<'_, V> {
    #[inline(always)]
    fn put(&mut self, _: usize, place: V, rate: Option<V>) {
        let Packed { bodies, rows } = self.packed;
        let first = self.row * WIDTH;
        let (at, count) = (self.start + first, (bodies - first).min(WIDTH));
        spread(place, &mut self.into[at..][..count]);
        if let Some(rate) = rate {
            spread(rate, &mut self.into[self.numbers + at..][..count]);
        }
        self.row += 1;
        if self.row == rows {
            (self.row, self.start) = (0, self.start + bodies);
        }
    }
}

#[inline(always)]
fn spread<V: View<Lanes>>(row: V, into: &mut [V]) {
    let row = row.store();
    for (into, &number) in into.iter_mut().zip(&row.0) {
        *into = V::splat(number);
    }
}

#[inline(always)]
fn groups<V: Real, S: Source<V>, const MOVING: bool>(
    from: &S,
    count: usize,
    times: (V, V),
    into: &mut impl Target<V>,
) {
    let mut start = 0;
    while count - start >= 6 {
        at::<V, S, MOVING, 6>(from, start, times, into);
        start += 6;
    }
    while count - start >= 3 {
        at::<V, S, MOVING, 3>(from, start, times, into);
        start += 3;
    }
    while count - start >= 1 {
        at::<V, S, MOVING, 1>(from, start, times, into);
        start += 1;
    }
}

/// `G` coordinates from `start` on: one alone would wait for each of its operations.
#[inline(always)]
fn at<V: Real, S: Source<V>, const MOVING: bool, const G: usize>(
    from: &S,
    start: usize,
    (theta, per_step): (V, V),
    into: &mut impl Target<V>,
) {
    let rest = V::one() - theta;
    let (mut sums, mut slopes) = ([V::zero(); G], [V::zero(); G]);
    let mut places = [0; G];
    for g in 0..G {
        places[g] = from.place(start + g);
    }
    for term in (0..from.blocks() - 2).rev() {
        let even = term % 2 == 0;
        let factor = if even { theta } else { rest };
        let block = from.read(2 + term, start, &places);
        for g in 0..G {
            let inner = block[g] + sums[g];
            if MOVING {
                // 1 − θ falls as θ grows.
                slopes[g] = factor.multiply_add(slopes[g], if even { inner } else { -inner });
            }
            sums[g] = factor * inner;
        }
    }
    let (q, e) = (from.read(0, start, &places), from.read(1, start, &places));
    for g in 0..G {
        let place = q[g] + (e[g] + sums[g]);
        into.put(start + g, place, if MOVING { Some(slopes[g] * per_step) } else { None });
    }
}
