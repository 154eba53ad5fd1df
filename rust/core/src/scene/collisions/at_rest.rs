//! The impulses that bring contacts to rest along their lines, found at once.
//!
//! The one idea: in velocities times the roots of the masses it is a projection, whose error is that of the angle between contacts;
//! sweeps over them lose what is light between what is heavy. None pulls: who would is left out, who then approaches comes back.

use super::impact::Meeting;
use nalgebra::{DMatrix, DVector};

/// More contacts than this are left to sweeps, whose work grows less steeply.
const MOST: usize = 32;
/// A direction that is so small beside the largest is one that others have; what is small, and not so small, tells nothing.
const DEPENDENT: f64 = 1e-13;
const SMALL: f64 = 1e-7;
/// A pull, or an approach, of this part of the largest is rounding.
const ROUNDING: f64 = 1e-11;

/// What brings contacts to rest.
pub(super) struct AtRest {
    /// By how much the impulse of each changes the speed with which its two approach, in units of the fastest.
    pub(super) changes: Vec<f64>,
    /// By how much each body changes its velocity, in the same units.
    pub(super) moved: Vec<[f64; 3]>,
}

impl AtRest {
    /// Of contacts between bodies, by their places among these masses; nothing where it is not found.
    pub(super) fn of(contacts: &[([usize; 2], &Meeting)], masses: &[f64], fastest: f64) -> Option<Self> {
        let heaviest = masses.iter().fold(0.0_f64, |most, &mass| most.max(mass));
        if contacts.len() > MOST || masses.iter().any(|&mass| mass / heaviest < f64::MIN_POSITIVE) {
            return None;
        }
        let mut active: Vec<usize> = (0..contacts.len()).collect();
        for _ in 0..4 * contacts.len() {
            let found = Self::with(contacts, &active, (masses, heaviest), fastest)?;
            let largest = found.changes.iter().fold(0.0_f64, |most, change| most.max(change.abs()));
            let pulls = (active.iter().enumerate())
                .min_by(|(_, a), (_, b)| found.changes[**a].total_cmp(&found.changes[**b]));
            if let Some((place, &contact)) = pulls
                && found.changes[contact] < -ROUNDING * largest
            {
                let _ = active.remove(place);
                continue;
            }
            let approaching =
                (0..contacts.len()).filter(|contact| !active.contains(contact)).find(|&contact| {
                    let ([i, j], meeting) = contacts[contact];
                    let away: f64 =
                        (0..3).map(|c| meeting.normal[c] * (found.moved[j][c] - found.moved[i][c])).sum();
                    meeting.speed / fastest - away > ROUNDING
                });
            match approaching {
                Some(contact) => active.push(contact),
                None => return Some(found),
            }
        }
        None
    }

    /// With impulses of either sign in these contacts alone.
    fn with(
        contacts: &[([usize; 2], &Meeting)],
        active: &[usize],
        (masses, heaviest): (&[f64], f64),
        fastest: f64,
    ) -> Option<Self> {
        let roots: Vec<f64> = masses.iter().map(|mass| (mass / heaviest).sqrt()).collect();
        let mut directions = DMatrix::zeros(3 * masses.len(), active.len());
        let mut needed = DVector::zeros(active.len());
        for (column, &contact) in active.iter().enumerate() {
            let ([i, j], meeting) = contacts[contact];
            let root = (meeting.reduced / heaviest).sqrt();
            for c in 0..3 {
                directions[(3 * i + c, column)] = -meeting.normal[c] * root / roots[i];
                directions[(3 * j + c, column)] = meeting.normal[c] * root / roots[j];
            }
            needed[column] = root * (meeting.speed / fastest);
        }
        let decomposed = directions.col_piv_qr();
        let (across, upper) = (decomposed.q(), decomposed.r());
        decomposed.p().permute_rows(&mut needed);
        let largest = upper.diagonal().amax();
        let rank = (0..upper.nrows()).take_while(|&k| upper[(k, k)].abs() > DEPENDENT * largest).count();
        if (0..rank).any(|k| upper[(k, k)].abs() < SMALL * largest) {
            return None;
        }
        let upper = upper.view((0, 0), (rank, rank)).into_owned();
        let along = upper.transpose().solve_lower_triangular(&needed.rows(0, rank))?;
        let moved = across.columns(0, rank) * &along;
        let impulses = upper.solve_upper_triangular(&along)?;
        let mut all = DVector::zeros(active.len());
        all.rows_mut(0, rank).copy_from(&impulses);
        decomposed.p().inv_permute_rows(&mut all);
        let mut changes = vec![0.0; contacts.len()];
        for (column, &contact) in active.iter().enumerate() {
            changes[contact] = all[column] / (contacts[contact].1.reduced / heaviest).sqrt();
        }
        let mut moved: Vec<[f64; 3]> = roots
            .iter()
            .enumerate()
            .map(|(body, root)| core::array::from_fn(|c| moved[3 * body + c] / root))
            .collect();
        // Impulses leave the momentum as it is, whatever rounding made of them.
        let total: f64 = roots.iter().map(|root| root * root).sum();
        for c in 0..3 {
            let drift = roots.iter().zip(&moved).map(|(root, by)| root * root * by[c]).sum::<f64>() / total;
            moved.iter_mut().for_each(|by| by[c] -= drift);
        }
        Some(Self { changes, moved })
    }
}
