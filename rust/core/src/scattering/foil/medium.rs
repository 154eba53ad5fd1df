//! What an ion meets in a foil, built once: its loss, and of each element the deflections and how far out they count.

use super::angles::{Angles, Source, reach};
use super::octaves::Octaves;
use super::slowing::{PARTS, Slowing};
use super::stopping::{Atoms, Projectile};
use super::{Element, Foil, Run};
use crate::numerics::angles::sin_cos;
use crate::numerics::elementary::{Exponential, cbrt, ln};
use crate::parallel::Ticker;
use crate::scattering::kinematics::Collision;
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};

/// One element of it.
#[derive(Clone, Debug)]
pub(super) struct Atom {
    /// How many in an Å³.
    density: f64,
    /// m₂/(m₁ + m₂).
    pub(super) share: f64,
    pub(super) angles: Angles,
    /// The impact parameters that count, cell by cell of the energy.
    cuts: Vec<f64>,
    /// Those that are forced, and where b² is this part of theirs events are half as dense as head-on.
    pub(super) forced: f64,
    knee: f64,
}

/// A foil with an ion in it.
#[derive(Clone, Debug)]
pub(super) struct Medium {
    /// In Å.
    pub(super) thickness: f64,
    pub(super) energy: f64,
    pub(super) lowest: f64,
    /// The way the beam comes.
    pub(super) beam: [f64; 3],
    pub(super) slowing: Slowing,
    pub(super) atoms: Vec<Atom>,
    octaves: Octaves,
    /// Collisions to an Å, cell by cell.
    rates: Vec<f64>,
    /// Whether there is but the forced collision.
    pub(super) single: bool,
    /// How far the forced collision is at most, and how many there are on the way.
    pub(super) forced: Option<(f64, f64)>,
}

/// The forced collision is looked for on a path so much longer than the straight one: soft ones make it longer.
const LONGER: f64 = 1.25;

impl Medium {
    pub(super) fn new(foil: &Foil, run: &Run, threads: usize, ticker: &mut Ticker<'_>) -> Result<Self> {
        let atoms = foil.atoms();
        foil.stopping.reaches(&atoms, run.energy)?;
        let slowing = Slowing::new(&foil.stopping, run.ion, &atoms, run.lowest, run.energy);
        let octaves = Octaves::new(run.lowest, run.energy, PARTS);
        let total: f64 = foil.elements.iter().map(|element| element.density).sum();
        // A disc to each atom of a layer that is as thick as atoms are apart: no one collides with two at once.
        let cap = 1.0 / (cbrt(total) * PI.sqrt());
        let (sine, cosine) = sin_cos(run.incidence);
        let straight = foil.thickness / cosine;
        let length = if run.single { straight } else { LONGER * straight };
        let left = slowing.along(run.energy, length, run.lowest).0.max(run.lowest);
        let mut built = Vec::new();
        for element in &foil.elements {
            let limits = Limits { octaves, cap, left };
            built.push(Atom::build(element, foil, run, limits, threads, ticker)?);
        }
        let rates = (0..octaves.cells()).map(|cell| built.iter().map(|atom| atom.rate(cell)).sum()).collect();
        let forced: f64 = built.iter().map(Atom::forced_rate).sum();
        if run.forced_angle.is_some() && forced <= 0.0 {
            return Err(Error::invalid(
                "forced_angle",
                "expected an angle by which collisions turn, got a greater one than any",
            ));
        }
        Ok(Self {
            thickness: foil.thickness,
            energy: run.energy,
            lowest: run.lowest,
            beam: [sine, 0.0, cosine],
            slowing,
            atoms: built,
            octaves,
            rates,
            single: run.single,
            forced: run.forced_angle.map(|_| (length, forced)),
        })
    }
    /// The cell of an energy, and collisions to an Å in it.
    #[inline]
    pub(super) fn rate(&self, energy: f64) -> (usize, f64) {
        let cell = self.octaves.cell(energy);
        (cell, self.rates[cell])
    }
    /// Which atom a collision is with, and the impact parameter.
    #[inline]
    pub(super) fn met(&self, cell: usize, which: f64, share: f64) -> (&Atom, usize, f64) {
        let at = chosen(&self.atoms, |atom| atom.rate(cell), which * self.rates[cell]);
        (&self.atoms[at], at, self.atoms[at].cuts[cell] * share.sqrt())
    }
    /// The same of the forced collision, with what it stands for: how many are on the way, over how often it is drawn.
    pub(super) fn met_forced(
        &self,
        (length, rate): (f64, f64),
        which: f64,
        share: f64,
    ) -> (&Atom, usize, f64, f64) {
        let at = chosen(&self.atoms, Atom::forced_rate, which * rate);
        let atom = &self.atoms[at];
        let (part, weight) = atom.drawn(share);
        (atom, at, atom.forced * part.sqrt(), weight * length * rate)
    }
    /// The largest weight an event may have.
    pub(super) fn largest_weight(&self) -> f64 {
        self.forced.map_or(1.0, |(length, rate)| {
            let most = self.atoms.iter().filter(|atom| atom.forced > 0.0).map(|atom| atom.drawn(1.0).1);
            length * rate * most.fold(0.0, f64::max)
        })
    }
    /// Collisions on a straight way at the beam's energy, and the largest error of sin²(ψ/2) and the bytes of the tables.
    pub(super) fn told(&self) -> (f64, f64, usize) {
        let worst = self.atoms.iter().fold(0.0_f64, |worst, atom| worst.max(atom.angles.error()));
        let bytes = self.atoms.iter().map(|atom| atom.angles.bytes()).sum();
        (self.rate(self.energy).1 * self.thickness / self.beam[2], worst, bytes)
    }
}

/// Which of several, each with its part of a whole.
fn chosen(atoms: &[Atom], part: impl Fn(&Atom) -> f64, drawn: f64) -> usize {
    let mut sum = 0.0;
    let passed = |atom: &&Atom| {
        sum += part(atom);
        sum <= drawn
    };
    atoms.iter().take_while(passed).count().min(atoms.len() - 1)
}

/// What bounds impact parameters.
#[derive(Clone, Copy)]
struct Limits {
    octaves: Octaves,
    cap: f64,
    /// The energy at the end of the way of forced collisions.
    left: f64,
}

impl Atom {
    fn build(
        element: &Element,
        foil: &Foil,
        run: &Run,
        Limits { octaves, cap, left }: Limits,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let Projectile { mass, .. } = run.ion;
        let share = Collision::new(mass, element.mass)?.relative_share();
        let deflector = Source::deflector(&element.potential)?;
        let source = Source { deflector: &deflector, minimum: foil.minimum_angle, threads };
        let mut relative: Vec<f64> =
            (0..octaves.cells()).map(|cell| octaves.bounds(cell).0.max(run.lowest) * share).collect();
        let cuts = if run.single {
            vec![0.0; relative.len()]
        } else {
            reach(&source, &relative, foil.minimum_angle, cap, ticker)?
        };
        relative.clear();
        let (mut forced, mut knee) = (0.0, 1.0);
        if let Some(angle) = run.forced_angle {
            // By as much at the end of the way: every collision that turns by it is among them.
            forced = reach(&source, &[left * share], angle, cap, ticker)?[0];
            if forced > 0.0 {
                let back = reach(&source, &[run.energy * share], FRAC_PI_2, cap, ticker)?[0];
                // What turns nothing back has no knee.
                knee = if back > 0.0 { (back / forced).powi(2).clamp(1e-6, 1.0) } else { 1.0 };
            }
        }
        let radius = |from: f64, to: f64| {
            let cells = octaves.cell(from / share)..=octaves.cell(to / share);
            cuts[cells].iter().copied().fold(forced, f64::max).max(1e-6 * cap)
        };
        let range = (run.lowest * share, run.energy * share);
        let angles = Angles::build(&element.potential, &source, range, &radius, ticker)?;
        Ok(Self { density: element.density, share, angles, cuts, forced, knee })
    }
    #[inline]
    fn rate(&self, cell: usize) -> f64 {
        self.density * PI * self.cuts[cell] * self.cuts[cell]
    }
    fn forced_rate(&self) -> f64 {
        self.density * PI * self.forced * self.forced
    }
    /// b² as a part of that of the disc, of which equal factors beyond the knee get equally many events, and one over
    /// their density.
    fn drawn(&self, share: f64) -> (f64, f64) {
        let logarithm = ln(1.0 + 1.0 / self.knee);
        let part = (self.knee * (Exponential::exp(share * logarithm) - 1.0)).clamp(0.0, 1.0);
        (part, (part + self.knee) * logarithm)
    }
}

/// How many atoms of each element are in an Å³ of a density in g/cm³, from masses in u and parts of the atoms.
pub fn number_densities(density: f64, masses: &[f64], fractions: &[f64]) -> Vec<f64> {
    let mass: f64 = masses.iter().zip(fractions).map(|(mass, part)| mass * part).sum();
    // Avogadro's number over the cubic ångströms of a cubic centimeter.
    fractions.iter().map(|part| part * density / mass * 0.602_214_076).collect()
}

impl Foil {
    fn atoms(&self) -> Vec<Atoms> {
        let of = |element: &Element| Atoms {
            atomic_number: element.atomic_number,
            density: element.density,
            excitation: element.excitation,
        };
        self.elements.iter().map(of).collect()
    }
    /// What electrons take, and the atoms they are of, up to the largest of some energies.
    fn up_to(&self, energy: &[f64]) -> Result<Vec<Atoms>> {
        let atoms = self.atoms();
        self.stopping.reaches(&atoms, energy.iter().copied().fold(0.0, f64::max))?;
        Ok(atoms)
    }
    /// S(E) in eV/Å at energies in eV.
    ///
    /// # Errors
    /// `InvalidInput` naming `mean_excitation_energy`, or `stopping` for a table that ends before.
    pub fn losses(&self, ion: Projectile, energy: &[f64]) -> Result<Vec<f64>> {
        let atoms = self.up_to(energy)?;
        if let Some(energy) = energy.iter().find(|energy| **energy > FASTEST * ion.rest_energy()) {
            let message = format!(
                "expected at most {} times the ion's rest energy of {}, got {}",
                number(FASTEST),
                number(ion.rest_energy()),
                number(*energy)
            );
            return Err(Error::invalid("energy", message));
        }
        Ok(energy.iter().map(|energy| self.stopping.loss(ion, &atoms, *energy)).collect())
    }
    /// How far an ion goes until its energy is `lowest`, by electrons alone: ∫dE/S in Å.
    ///
    /// # Errors
    /// As [`losses`](Self::losses); `InvalidInput` naming `stopping` where there is none.
    pub fn ranges(&self, ion: Projectile, energy: &[f64], lowest: f64) -> Result<Vec<f64>> {
        let atoms = self.up_to(energy)?;
        if self.stopping.is_nothing() {
            return Err(Error::invalid("stopping", "expected one that stops, got 'none'"));
        }
        let inverse = |energy: f64| 1.0 / self.stopping.loss(ion, &atoms, energy);
        let range = |energy: &f64| {
            // In u = √E, in which dE/S is smooth down to 0: 2u/S du by Gauss's rule of three points.
            let (from, to) = (lowest.sqrt(), energy.sqrt());
            let width = (to - from) / f64::from(PIECES);
            let piece = |i: u32| {
                let middle = from + width * (f64::from(i) + 0.5);
                let at = |x: f64| (middle + 0.5 * width * x) * inverse((middle + 0.5 * width * x).powi(2));
                width * (5.0 * (at(-GAUSS) + at(GAUSS)) + 8.0 * at(0.0)) / 9.0
            };
            (0..PIECES).map(piece).sum()
        };
        if let Some(energy) = energy.iter().find(|energy| **energy < lowest) {
            let message =
                format!("expected at least the lowest, {}, got {}", number(lowest), number(*energy));
            return Err(Error::invalid("energy", message));
        }
        Ok(energy.iter().map(range).collect())
    }
}

/// Beyond, the electrons' density effect leaves nothing of Bethe's formula.
const FASTEST: f64 = 10.0;
/// √(3/5): Gauss's outer points.
const GAUSS: f64 = 0.774_596_669_241_483_4;
/// Pieces of a range.
const PIECES: u32 = 400;
