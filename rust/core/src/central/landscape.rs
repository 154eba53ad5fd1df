//! The monotone pieces of U(r) = V + r V′/2, found once, and the turning points that follow.
//!
//! r²(E − V) = l²/2m at a turning point, and the left side has the slope 2r (E − U). So it is monotone between two
//! distances where U = E, and U is monotone between two where 3V′ + rV″ changes sign, which no energy moves. Each question
//! is about one zero between two places where signs are known: none is missed, and the outermost is the outermost.

use super::field::Field;
use super::roots::{bracket, precise};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::potentials::Potential;
use std::sync::Arc;

/// What happens at a turning point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The motion is beyond it.
    Pericenter,
    /// The motion is within.
    Apocenter,
}

/// A distance at which the radial velocity is zero, or would change its sign at a jump of V.
#[derive(Clone, Copy, Debug)]
pub struct TurningPoint {
    /// The distance, to about thirty digits.
    pub radius: DoubleDouble,
    /// On which side the motion is.
    pub turn: Turn,
    /// Whether V jumps there, so that the radial velocity does.
    pub jump: bool,
}

/// What r²V is near the center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Center {
    /// It goes to zero: nothing with an angular momentum comes there.
    Reached,
    /// It goes to −C, C > 0: what has l² < 2mC falls there. Or C < 0, and nothing does.
    InverseSquare(f64),
    /// It falls without end: everything falls there.
    Attracting,
    /// It rises without end: nothing comes there.
    Repelling,
    /// The potential begins farther out.
    Unknown,
}

/// A range in which V is continuous; nothing where V is infinite.
#[derive(Clone, Debug)]
struct Zone {
    ends: Option<(f64, f64)>,
    /// Places between which U is monotone; rounding hides what U does before the first and after the last.
    pieces: Vec<f64>,
}

/// What a potential can do.
#[derive(Clone, Debug)]
pub struct Landscape {
    field: Field,
    /// Ranges in which V is continuous, in the field's units.
    zones: Vec<Zone>,
    center: Center,
}

impl Landscape {
    /// Of one potential.
    pub fn new(potential: &Arc<dyn Potential>) -> Self {
        Self::of(core::slice::from_ref(potential))
    }

    /// Of a sum.
    pub fn of(potentials: &[Arc<dyn Potential>]) -> Self {
        let mut field = Field::new(potentials);
        let mut places = field.places();
        places.retain(|&r| {
            let [value, force, curvature] = field.at(r);
            let beyond = |x: f64| x.abs() >= LARGE;
            // Of a derivative that is no number, as a quotient of what has left the range, the value may be one.
            value.abs() < LARGE && !beyond(r * force) && !beyond(r * r * curvature)
        });
        field.known(&mut places);
        let jumps = field.jumps();
        let mut zones = Vec::new();
        let mut from = 0;
        for jump in jumps.iter().copied().chain([f64::INFINITY]) {
            let to = places.partition_point(|r| *r < jump);
            let mut zone: Vec<f64> = places[from..to].to_vec();
            if jump.is_finite() && !zone.is_empty() {
                zone.push(jump.next_down());
            }
            if !zones.is_empty() && zone.first().is_some_and(|first| *first > jumps[zones.len() - 1]) {
                zone.insert(0, jumps[zones.len() - 1]);
            }
            let ends = zone.first().copied().zip(zone.last().copied());
            zones.push(Zone { ends, pieces: monotone(&field, &zone) });
            from = to;
        }
        let center = center(&field, zones.iter().find_map(|zone| zone.ends).map(|(first, _)| first));
        Self { field, zones, center }
    }

    /// The potential, and units in which its numbers are near one.
    pub fn field(&self) -> &Field {
        &self.field
    }
    /// What is in the middle.
    pub fn center(&self) -> Center {
        self.center
    }
    /// Distances at which U and r³V′ are stationary, ascending: where two circles of one energy or one l merge.
    pub fn stationary(&self) -> Vec<f64> {
        let inner = |zone: &Zone| {
            zone.pieces.get(1..zone.pieces.len().saturating_sub(1)).unwrap_or_default().to_vec()
        };
        self.zones.iter().flat_map(inner).map(|r| self.field.give_length(r)).collect()
    }

    /// Distances, ascending, at which r²(E − V) is stationary: there a circle has that energy.
    pub fn critical_radii(&self, energy: f64) -> Vec<f64> {
        let energy = self.field.take_energy(energy);
        let found = self.crossings(|r| self.field.circular_energy(r) - energy);
        found.into_iter().flatten().map(|r| self.field.give_length(r)).collect()
    }

    /// Distances, ascending, of circles with that l²/m = r³V′; repelling forces have none.
    pub fn circular_radii(&self, momentum: DoubleDouble) -> Vec<f64> {
        let momentum = self.field.take_centrifugal(momentum).to_f64();
        let found = self.crossings(|r| self.field.circular_momentum(r) - momentum / r / r);
        found.into_iter().flatten().map(|r| self.field.give_length(r)).collect()
    }

    /// All turning points, ascending, at an energy and with that l²/2m.
    pub fn turning_points(&self, energy: f64, centrifugal: DoubleDouble) -> Vec<TurningPoint> {
        self.turning_points_between(&self.critical_radii(energy), energy, centrifugal)
    }

    /// As [`turning_points`](Self::turning_points), with the [critical radii](Self::critical_radii) of the energy at hand.
    pub fn turning_points_between(
        &self,
        critical: &[f64],
        energy: f64,
        centrifugal: DoubleDouble,
    ) -> Vec<TurningPoint> {
        self.turns(critical, self.radial(DoubleDouble::from(energy), centrifugal))
    }

    /// The radial motion at an energy that is known to thirty digits.
    pub(super) fn radial(&self, energy: DoubleDouble, centrifugal: DoubleDouble) -> Radial<'_> {
        let field = &self.field;
        let energy = DoubleDouble::new(field.take_energy(energy.high()), field.take_energy(energy.low()));
        Radial { field, energy, centrifugal: field.take_centrifugal(centrifugal) }
    }

    /// Its turning points, ascending.
    pub(super) fn turns(&self, critical: &[f64], motion: Radial<'_>) -> Vec<TurningPoint> {
        let field = &self.field;
        let mut found = Vec::new();
        let mut before: Option<bool> = None;
        for zone in &self.zones {
            let Some((first, last)) = zone.ends else {
                // V is infinite there.
                before = Some(false);
                continue;
            };
            let inside = critical.iter().map(|r| field.take_length(*r)).filter(|r| *r > first && *r < last);
            let places: Vec<f64> = [first].into_iter().chain(inside).chain([last]).collect();
            let allowed: Vec<bool> = places.iter().map(|r| motion.allowed(*r)).collect();
            let turn = |allowed: bool| if allowed { Turn::Pericenter } else { Turn::Apocenter };
            if before.is_some_and(|before| before != allowed[0]) {
                let radius = DoubleDouble::from(field.give_length(first));
                found.push(TurningPoint { radius, turn: turn(allowed[0]), jump: true });
            }
            for (ends, signs) in places.windows(2).zip(allowed.windows(2)) {
                if signs[0] != signs[1] {
                    let radius = motion.root(ends[0], ends[1], signs[1]);
                    let scaled = |x: f64| field.give_length(x);
                    let radius = DoubleDouble::new(scaled(radius.high()), scaled(radius.low()));
                    found.push(TurningPoint { radius, turn: turn(signs[1]), jump: false });
                }
            }
            before = allowed.last().copied();
        }
        found
    }

    /// The nearest place to the center at which V is a number, in the field's units.
    pub(super) fn nearest(&self) -> f64 {
        self.zones.iter().find_map(|zone| zone.ends).map_or(f64::NAN, |(first, _)| first)
    }

    /// Whether the motion reaches as near to the center, and as far out, as the potential is known.
    pub(super) fn open_ends(&self, motion: Radial<'_>) -> (bool, bool) {
        let mut ends = self.zones.iter().filter_map(|zone| zone.ends);
        let first = ends.next();
        let last = ends.next_back().or(first).map(|(_, last)| last);
        let first = first.map(|(first, _)| first);
        let reaches = |r: Option<f64>| r.is_some_and(|r| motion.allowed(r));
        (reaches(first), reaches(last))
    }

    /// Whether every distance is one of a circle: V is −l²/2mr² and an energy, which only rounding tells from E.
    pub(super) fn every_circle(&self, motion: Radial<'_>) -> bool {
        let still = |r: f64| {
            let (value, turning) = (self.field.value(r), motion.centrifugal.high() / r / r);
            let size = motion.energy.high().abs() + value.abs() + turning;
            turning > 0.0 && motion.kinetic(DoubleDouble::from(r)).0.high().abs() <= ROUNDED * size
        };
        // Places apart by more than any force that is no inverse cube would go on with it.
        let places = |first: f64, last: f64| {
            let (low, high) = (exponent(first) + 1, exponent(last));
            let between = (0..=LOOKS).map(move |k| scale(1.1, low + (high - low) * k / LOOKS));
            [first, last].into_iter().chain(between.filter(move |r| *r > first && *r < last))
        };
        self.zones.iter().all(|zone| zone.ends.is_some_and(|(first, last)| places(first, last).all(still)))
    }

    /// In each zone the zeros of a function that is monotone between its places.
    fn crossings(&self, f: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let of = |zone: &Zone| {
            let zone = &zone.pieces;
            let signs: Vec<f64> = zone.iter().map(|r| f(*r)).collect();
            let mut found = Vec::new();
            for (ends, signs) in zone.windows(2).zip(signs.windows(2)) {
                if signs[0] == 0.0 && signs[1] != 0.0 {
                    found.push(ends[0]);
                } else if (signs[0] < 0.0) != (signs[1] < 0.0) && signs[0] != 0.0 && signs[1] != 0.0 {
                    found.push(bracket(&f, ends[0], ends[1], signs[1] > 0.0).0);
                }
            }
            found
        };
        self.zones.iter().map(of).collect()
    }
}

/// The radial motion at an energy and with an angular momentum, in the field's units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radial<'a> {
    pub(super) field: &'a Field,
    pub(super) energy: DoubleDouble,
    /// l²/2m.
    pub(super) centrifugal: DoubleDouble,
}

impl Radial<'_> {
    /// E − V − l²/2mr², the kinetic energy of the motion along r, and its slope.
    pub(super) fn kinetic(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        let (value, force) = self.field.precise(r);
        let turning = self.centrifugal / r / r;
        let kinetic = self.energy - value - turning;
        (kinetic, force + (turning / r).scale(2.0))
    }
    /// As [`kinetic`](Self::kinetic), rounded.
    pub(super) fn roughly(&self, r: f64) -> f64 {
        self.energy.high() - self.field.value(r) - self.centrifugal.high() / r / r
    }
    /// Whether it may be there.
    pub(super) fn allowed(&self, r: f64) -> bool {
        let (value, turning) = (self.field.value(r), self.centrifugal.high() / r / r);
        let energy = self.energy.high();
        let rough = energy - value - turning;
        let doubtful = rough.abs() <= DOUBTFUL * (energy.abs() + value.abs() + turning.abs());
        let kinetic = if doubtful { self.kinetic(DoubleDouble::from(r)).0.high() } else { rough };
        if kinetic.is_nan() { rough >= 0.0 } else { kinetic >= 0.0 }
    }
    /// The one turning point between two places.
    fn root(&self, low: f64, high: f64, rises: bool) -> DoubleDouble {
        let (a, b) = bracket(|r| self.roughly(r), low, high, rises);
        precise(|r| self.kinetic(r), [low, high], 0.5 * (a + b), rises)
    }
}

/// The places of a zone between which U is monotone: the ends of what can be told, and where 3V′ + rV″ changes sign.
fn monotone(field: &Field, places: &[f64]) -> Vec<f64> {
    let slope = |r: f64| field.slope(r);
    // What rounding hides says nothing.
    let told: Vec<(f64, f64)> =
        places.iter().map(|r| (*r, slope(*r))).filter(|(_, slope)| *slope != 0.0).collect();
    let (Some(&(first, _)), Some(&(last, _))) = (told.first(), told.last()) else { return Vec::new() };
    let mut found = vec![first];
    let mut cross = |from: (f64, f64), to: (f64, f64)| {
        if (from.1 < 0.0) != (to.1 < 0.0) {
            found.push(bracket(slope, from.0, to.0, to.1 > 0.0).0);
        }
    };
    for at in 0..told.len().saturating_sub(1) {
        cross(told[at], told[at + 1]);
        let Some(&[before, here, after]) = told.get(at..at + 3) else { continue };
        let (same, sign) =
            ((before.1 < 0.0) == (here.1 < 0.0) && (here.1 < 0.0) == (after.1 < 0.0), here.1.signum());
        if same && sign * here.1 < sign * before.1 && sign * here.1 < sign * after.1 {
            // It came near to zero and went away again: perhaps it was beyond, between places.
            if let Some(beyond) = dip(slope, before.0, after.0, sign) {
                let beyond = (beyond, -sign);
                if beyond.0 < here.0 {
                    cross(before, beyond);
                    cross(beyond, here);
                } else {
                    cross(here, beyond);
                    cross(beyond, after);
                }
            }
        }
    }
    found.push(last);
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}

/// A place where a function is beyond zero, by golden sections of the range in which it comes nearest.
fn dip(f: impl Fn(f64) -> f64, low: f64, high: f64, sign: f64) -> Option<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (low, high);
    for _ in 0..SECTIONS {
        let (x, y) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        let (fx, fy) = (sign * f(x), sign * f(y));
        if fx < 0.0 {
            return Some(x);
        }
        if fy < 0.0 {
            return Some(y);
        }
        if fx < fy {
            b = y;
        } else {
            a = x;
        }
    }
    None
}

/// How much of the energies rounding takes, and at how many places that is looked for.
const ROUNDED: f64 = 4.0 * f64::EPSILON;
const LOOKS: i32 = 64;

/// What r²V does from the nearest place inward.
fn center(field: &Field, nearest: Option<f64>) -> Center {
    let Some(r) = nearest else { return Center::Unknown };
    if field.domain().is_some_and(|(low, _)| low > 0.0) {
        return Center::Unknown;
    }
    // At a power of two, so that C is not rounded.
    let r = scale(1.0, exponent(r) + 1);
    let size = |r: f64| r * (r * field.value(r));
    let (here, out) = (size(r), size(4.0 * r));
    if (here - out).abs() <= CONSTANT * here.abs() {
        return if here == 0.0 {
            Center::Reached
        } else {
            Center::InverseSquare(field.give_centrifugal(-here))
        };
    }
    match (here.abs() > out.abs(), here > 0.0) {
        (false, _) => Center::Reached,
        (true, true) => Center::Repelling,
        (true, false) => Center::Attracting,
    }
}

/// Numbers beyond this are not compared.
const LARGE: f64 = 1e270;
/// A difference that is a smaller part of its terms is taken in double-double.
const DOUBTFUL: f64 = 1e-12;
/// Sections of a range, each 0.62 of the one before.
const SECTIONS: usize = 45;
/// r²V that changes less over two octaves is constant.
const CONSTANT: f64 = 1e-14;

#[cfg(test)]
mod tests;
