//! What the deflection function of one energy has: branches, rainbows, glories, orbits, and the cross sections they make.
//!
//! The one idea: between its edges, where something orbits or V ends, ψ(b) is smooth, and between the zeros of dψ/db,
//! which are the rainbows, it is monotone. So a grid that is fine wherever ψ may bend, with the analytic derivative on
//! it, cuts the line of impact parameters into monotone stretches, and every question of which b leads to an angle is a
//! bracketed root on each of them (`branches`). Integrals over b go by the same edges (`transport`), and means of those by
//! the energies where orbits begin (`collision_integral`).
//! Sources: Goldstein, Poole & Safko, *Classical Mechanics* (3rd ed.), §3.10–3.11; K. W. Ford, J. A. Wheeler, Ann.
//! Phys. 7 (1959) 259; J. O. Hirschfelder, C. F. Curtiss, R. B. Bird, *Molecular Theory of Gases and Liquids* (1954), §8.2.

mod branches;
mod collision_integral;
mod top;
mod transport;

pub use branches::Branch;
pub use collision_integral::{CollisionIntegrals, OF_ANGLES_IN_MEAN};
pub use transport::transport;

use super::deflection::{Deflection, Deflector, Edge, Status};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::Ticker;
use core::f64::consts::{LN_2, PI};

/// Octaves of impact parameters on either side of the potential's length at the energy.
const OCTAVES: i32 = 24;
/// So many, at least, beyond another length that matters.
const BEYOND: i32 = 8;
/// Samples to an octave.
const PER_OCTAVE: i32 = 12;
/// Samples towards an edge, each this much nearer than the one before.
const TOWARDS_EDGE: i32 = 56;
const NEARER: f64 = 0.562_341_325_190_349; // 10^(−1/4)
/// Samples between two bends that are so near.
const PER_BEND: i32 = 4;
const BETWEEN: f64 = 1.0 / 16.0;
/// Angles below this are not looked at.
const SMALLEST: f64 = 1e-13;
/// Halvings and secants until a root has all its digits.
const MOST_STEPS: usize = 100;

/// An extremum of ψ(b): infinite cross section at an angle beyond which nothing of its stretches goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rainbow {
    /// Where ψ is extremal.
    pub impact_parameter: f64,
    /// ψ there.
    pub angle: f64,
}

/// An impact parameter that is not zero and leads straight on or straight back: ψ = kπ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glory {
    /// Not zero.
    pub impact_parameter: f64,
    /// kπ.
    pub angle: f64,
    /// dψ/db.
    pub derivative: f64,
}

/// A place on the line of impact parameters.
#[derive(Clone, Copy, Debug)]
struct Sample {
    b: f64,
    angle: f64,
    complement: f64,
    derivative: f64,
    closest_approach: f64,
    /// Whether ψ rises with b (1) or falls (−1); 0 where rounding of ψ is all there is of it.
    way: f64,
}

/// As a part of ψ, what its derivative loses of it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The deflection function at one energy, cut into monotone stretches.
#[derive(Debug)]
pub struct Structure<'a> {
    deflector: &'a Deflector,
    energy: f64,
    /// [`Deflector::length`].
    length: f64,
    /// Monotone between neighbours of one stretch.
    stretches: Vec<Vec<Sample>>,
    edges: Vec<Edge>,
    /// [`Deflector::bends`].
    bends: Vec<f64>,
    rainbows: Vec<Rainbow>,
}

impl<'a> Structure<'a> {
    /// Of an energy.
    ///
    /// # Errors
    /// As [`Deflector::deflect`].
    pub fn new(deflector: &'a Deflector, energy: f64, ticker: &mut Ticker<'_>) -> Result<Self> {
        let edges = deflector.edges(energy);
        let length = deflector.length(energy);
        let bends = deflector.bends(energy);
        let mut made =
            Self { deflector, energy, length, stretches: Vec::new(), edges, bends, rainbows: Vec::new() };
        let ends: Vec<f64> = [0.0]
            .into_iter()
            .chain(made.edges.iter().map(|edge| edge.impact_parameter))
            .chain([f64::INFINITY])
            .collect();
        for pair in ends.windows(2) {
            if pair[0] < deflector.range() {
                made.cut([pair[0], pair[1].min(deflector.range())], ticker)?;
            }
        }
        Ok(made)
    }
    /// Where something orbits, V ends or has an edge.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }
    /// The extrema of ψ(b), from the smallest impact parameter on.
    pub fn rainbows(&self) -> &[Rainbow] {
        &self.rainbows
    }
    /// The largest impact parameter that is captured; 0 if none is.
    pub fn capture(&self) -> f64 {
        let captures = self.edges.iter().filter(|edge| edge.captures);
        captures.map(|edge| edge.impact_parameter).fold(0.0, f64::max)
    }
    /// Impact parameters that lead straight on or straight back, nearer to an edge than which none is told from the next.
    ///
    /// # Errors
    /// As [`Deflector::deflect`].
    pub fn glories(&self, ticker: &mut Ticker<'_>) -> Result<Vec<Glory>> {
        let mut found = Vec::new();
        if let Some(square) = self.deflector.winds(self.energy) {
            let glory = |found: Branch| Glory {
                impact_parameter: found.impact_parameter,
                angle: found.angle,
                derivative: found.derivative,
            };
            return Ok(winding(square, (1_u32..).map(f64::from)).into_iter().map(glory).collect());
        }
        for stretch in &self.stretches {
            let (low, high) = range(stretch);
            for k in (low / PI).ceil() as i64..=(high / PI).floor() as i64 {
                let target = PI * k as f64;
                if let Some(sample) = self.solve(stretch, target, ticker)?
                    && sample.b > 0.0
                    && !(k == 0 && sample.angle == 0.0 && sample.derivative == 0.0)
                {
                    found.push(Glory {
                        impact_parameter: sample.b,
                        angle: target,
                        derivative: sample.derivative,
                    });
                }
            }
        }
        found.sort_by(|a, b| a.impact_parameter.total_cmp(&b.impact_parameter));
        found.dedup_by(|a, b| a.impact_parameter == b.impact_parameter);
        Ok(found)
    }

    fn sample(&self, b: f64, ticker: &mut Ticker<'_>) -> Result<Sample> {
        Ok(sampled(b, self.deflections(&[b], ticker)?.first()))
    }
    /// Samples between two edges, cut where the derivative changes its sign.
    fn cut(&mut self, ends: [f64; 2], ticker: &mut Ticker<'_>) -> Result<()> {
        let places =
            places(ends, &self.edges, &self.bends, (self.length, self.deflector.lengths(self.energy)));
        let looked_from = self.bends.last().copied().unwrap_or(0.0).max(4.0 * self.length);
        let found = self.deflections(&places, ticker)?;
        let scattered = places.iter().zip(&found).filter(|(_, found)| found.status != Status::Captured);
        let mut samples: Vec<Sample> = scattered.map(|(b, found)| sampled(*b, Some(found))).collect();
        if ends[0] == 0.0 {
            samples = self.about_top(samples, ticker)?;
        }
        let mut stretch: Vec<Sample> = Vec::new();
        for next in samples {
            if let Some(at) = stretch.iter().rposition(|sample| sample.way != 0.0)
                && stretch[at].way * next.way < 0.0
            {
                let top = self.rainbow(stretch[at], next, ticker)?;
                // What is between tells nothing but rounding.
                stretch.truncate(at + 1);
                self.rainbows.push(Rainbow { impact_parameter: top.b, angle: top.angle });
                stretch.push(top);
                self.stretches.push(core::mem::replace(&mut stretch, vec![top]));
            }
            stretch.push(next);
            // What is still to come is even less.
            if next.angle.abs() < SMALLEST && next.b > looked_from && ends[1] == f64::INFINITY {
                break;
            }
        }
        if stretch.len() > 1 {
            self.stretches.push(stretch);
        }
        Ok(())
    }
    /// The zero of dψ/db between two samples.
    fn rainbow(&self, mut low: Sample, mut high: Sample, ticker: &mut Ticker<'_>) -> Result<Sample> {
        let mut weights = [low.derivative, high.derivative];
        for _ in 0..MOST_STEPS {
            let b = false_position([low.b, high.b], weights);
            let next = self.sample(b, ticker)?;
            if b <= low.b || b >= high.b || next.derivative == 0.0 {
                return Ok(next);
            }
            if next.derivative * low.derivative > 0.0 {
                weights = [next.derivative, 0.5 * weights[1]];
                low = next;
            } else {
                weights = [0.5 * weights[0], next.derivative];
                high = next;
            }
            if high.b - low.b <= 1e-13 * high.b {
                break;
            }
        }
        self.sample(0.5 * (low.b + high.b), ticker)
    }
}

/// Of V = −C/r² with that C/E what leads to ψ = −πx, of increasing x, as far as float64 tells impact parameters apart; from the
/// smallest on. b² = C/E q²/(q² − 1), q = 1 + x.
fn winding(square: f64, parts: impl Iterator<Item = f64>) -> Vec<Branch> {
    let mut found: Vec<Branch> = Vec::new();
    let (mut last, mut alike) = (f64::NAN, 0);
    for x in parts.filter(|x| *x > 0.0) {
        let (q, less) = (1.0 + x, x * (2.0 + x));
        let b = square.sqrt() * (q / less.sqrt());
        // Twice where both sides lead there.
        if x == last {
            continue;
        }
        last = x;
        if found.last().is_some_and(|outer| b >= outer.impact_parameter) {
            // Both sides of one turn may be alike before one turn and the next are.
            alike += 1;
            if alike == 3 {
                break;
            }
            continue;
        }
        alike = 0;
        found.push(Branch {
            impact_parameter: b,
            angle: -PI * x,
            derivative: PI * b * (less / square) * (less / q),
        });
    }
    found.reverse();
    found
}

fn sampled(b: f64, found: Option<&Deflection>) -> Sample {
    let nothing = f64::NAN;
    let (angle, complement, derivative, closest_approach) = found
        .map_or((nothing, nothing, nothing, nothing), |found| {
            (found.angle, found.complement, found.derivative, found.closest_approach)
        });
    let told = b * derivative.abs() > ROUNDING * angle.abs();
    let way = if told { derivative.signum() } else { 0.0 };
    Sample { b, angle, complement, derivative, closest_approach, way }
}

/// The least and the largest angle of a stretch.
fn range(stretch: &[Sample]) -> (f64, f64) {
    let first = stretch.first().map_or(f64::NAN, |sample| sample.angle);
    let last = stretch.last().map_or(f64::NAN, |sample| sample.angle);
    (first.min(last), first.max(last))
}

/// Where a straight line between two values of opposite sign is zero, kept off the ends.
fn false_position(places: [f64; 2], values: [f64; 2]) -> f64 {
    let [low, high] = places;
    let line = low + (high - low) * (values[0] / (values[0] - values[1]));
    if line > low && line < high { line } else { 0.5 * (low + high) }
}

/// Impact parameters to look at between two ends: to every octave, ever nearer to orbits, and about features.
fn places(ends: [f64; 2], edges: &[Edge], bends: &[f64], (length, lengths): (f64, [f64; 2])) -> Vec<f64> {
    let [low, high] = ends;
    let [nearer, farther] = lengths.map(|other| (ln(other / length) / LN_2) as i32);
    let first = (nearer - BEYOND).min(-OCTAVES);
    let last = (farther + BEYOND).max(OCTAVES);
    let octaves = (first * PER_OCTAVE..=last * PER_OCTAVE)
        .map(|k| length * Exponential::exp(f64::from(k) * LN_2 / f64::from(PER_OCTAVE)));
    let mut places: Vec<f64> = octaves.filter(|b| *b > low && *b < high).collect();
    let orbits = |b: f64| edges.iter().any(|edge| edge.impact_parameter == b);
    let reach = if high < f64::INFINITY { 0.5 * (high - low) } else { low.max(length) };
    for k in 0..TOWARDS_EDGE {
        let off = reach * NEARER.powi(k);
        if low > 0.0 && orbits(low) && off > 4.0 * f64::EPSILON * low {
            places.push(low + off);
        }
        if high < f64::INFINITY && off > 4.0 * f64::EPSILON * high {
            places.push(high - off);
        }
    }
    if low == 0.0 {
        places.push(0.0);
        // Also where there is one edge only, not far from zero.
        places.extend((1..16).map(|k| reach.min(length) * f64::from(k) / 16.0));
    }
    places.extend(bends);
    for pair in bends.windows(2).filter(|pair| pair[1] - pair[0] < BETWEEN * pair[1]) {
        places.extend(
            (1..PER_BEND).map(|k| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(PER_BEND)),
        );
    }
    places.retain(|b| *b >= low && *b < high);
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}
