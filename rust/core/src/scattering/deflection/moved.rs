//! Deflections by powers of the distance at energies far from their unit: each in a unit that is near.
//!
//! The one idea: k/rⁿ is the same in any unit of length, so what happens at 1e-120 of the strength happens at one. There no
//! derivative of V leaves the range of numbers, and no integral ends before the motion does.

use super::Deflector;
use super::profile::Profile;
use crate::Result;
use crate::numerics::power_of_two::scale;
use crate::parallel::Ticker;
use std::collections::BTreeMap;

impl Deflector {
    /// The same about a unit of length that is near for an energy, if this one is not.
    pub(in crate::scattering) fn near(&self, energy: f64) -> Option<Self> {
        let octaves = self.octaves_to(energy);
        (octaves != 0).then(|| self.moved(octaves)).flatten()
    }
    fn octaves_to(&self, energy: f64) -> i32 {
        self.profile.as_ref().map_or(0, |profile| profile.octaves_to(energy))
    }
    /// Of a pair: none where its impact parameter leaves the range of numbers.
    fn octaves_of(&self, energy: f64, b: f64) -> i32 {
        let octaves = self.octaves_to(energy);
        let stays = b == 0.0 || scale(b, -octaves).is_normal();
        if stays { octaves } else { 0 }
    }
    fn moved(&self, octaves: i32) -> Option<Self> {
        let profile = self.profile.as_ref()?.moved(octaves);
        Some(Self { profile: Some(profile), ..*self })
    }
    /// Of pairs, each by the deflector that is near; nothing if that is this one for all.
    pub(super) fn by_near_ones<T: Send + Copy>(
        &self,
        (energy, b): (&[f64], &[f64]),
        of: impl Fn(&Self, &[f64], &[f64], &mut Ticker<'_>) -> Result<Vec<T>>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Vec<T>>> {
        if !self.profile.as_ref().is_some_and(Profile::is_power)
            || energy.iter().zip(b).all(|(energy, b)| self.octaves_of(*energy, *b) == 0)
        {
            return Ok(None);
        }
        let mut places: BTreeMap<i32, Vec<usize>> = BTreeMap::new();
        for (place, (energy, b)) in energy.iter().zip(b).enumerate() {
            places.entry(self.octaves_of(*energy, *b)).or_default().push(place);
        }
        let mut found: Vec<Option<T>> = vec![None; energy.len().min(b.len())];
        for (octaves, places) in places {
            let moved = if octaves == 0 { None } else { self.moved(octaves) };
            let pick = |from: &[f64]| places.iter().map(|place| from[*place]).collect::<Vec<f64>>();
            let values = of(moved.as_ref().unwrap_or(self), &pick(energy), &pick(b), ticker)?;
            for (place, value) in places.into_iter().zip(values) {
                found[place] = Some(value);
            }
        }
        Ok(Some(found.into_iter().flatten().collect()))
    }
}
