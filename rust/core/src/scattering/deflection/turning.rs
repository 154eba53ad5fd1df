//! The outermost turning point, where 1 − b²/r² − V/E = 0 for the first time on the way in.

use super::Edge;
use super::profile::{Center, Profile};

/// Edges of V beyond which a table is taken for smooth.
const MANY: usize = 8;

/// Nearer than this part of it b is no less than a rim: what is left of G there is rounding.
const TOUCHED: f64 = 8.0 * f64::EPSILON;

/// Where the way in leads.
#[derive(Clone, Debug)]
pub(super) enum Way {
    /// To a turning point between two distances.
    Turns {
        bracket: [f64; 2],
        /// Where h is stationary outside of it, and at its inner end: the barriers that were passed or nearly so.
        barriers: Vec<f64>,
    },
    /// Straight through the center, at b = 0.
    Through,
    /// Into the center, at b = 0, where V → −∞ as −1/rⁿ, n below 2.
    Bounces(f64),
    /// Into the center.
    Captured,
}

/// Where h is stationary at an energy, remembered for the next pair, which often has the same.
#[derive(Debug, Default)]
pub(super) struct Critical {
    energy: f64,
    radii: Vec<f64>,
}

impl Critical {
    /// The way in at an energy and an impact parameter, in units of the profile.
    pub(super) fn way(&mut self, profile: &Profile, energy: f64, b: f64) -> Way {
        if energy < profile.one_turning_point_from() {
            if energy != self.energy {
                *self = Self { energy, radii: profile.critical_radii(energy) };
            }
        } else if !self.radii.is_empty() {
            *self = Self::default();
        }
        let radii = &self.radii;
        let rim = profile.pulling_rim(energy);
        let mut outside = f64::INFINITY;
        // Inward h falls to the first of each pair and rises to the second.
        for at in (0..radii.len()).step_by(2) {
            let lowest = radii[at];
            // What but touches a rim is not told from what passes it.
            let least = if Some(lowest) == rim { lowest * (1.0 - TOUCHED) } else { f64::INFINITY };
            if b >= least || !Profile::reached(lowest, profile.value(lowest), energy, b) {
                return Self::turns(profile, energy, b, [lowest, outside], radii[..=at].to_vec());
            }
            let Some(highest) = radii.get(at + 1) else { return Way::Captured };
            outside = *highest;
        }
        if b == 0.0 {
            match profile.center() {
                Center::Open(value) if value < energy => return Way::Through,
                Center::Attractive(power) if power < 2.0 => return Way::Bounces(power),
                Center::Attractive(_) => return Way::Captured,
                _ => {}
            }
        }
        match profile.center() {
            Center::Attractive(power) if power > 2.0 => Way::Captured,
            _ => Self::turns(profile, energy, b, [0.0, outside], radii.clone()),
        }
    }

    /// How many turning points there are, after [`way`](Self::way) at that energy.
    pub(super) fn turning_points(&self, profile: &Profile, energy: f64, b: f64) -> u32 {
        let mut allowed = true;
        let mut count = 0;
        let at_center = match profile.center() {
            Center::Attractive(power) => {
                power > 2.0 || (power == 2.0 && profile.bracket(energy, b, [0.0, f64::INFINITY]).is_none())
            }
            Center::Open(value) => b == 0.0 && value < energy,
            Center::Repulsive => false,
        };
        let marks = self.radii.iter().map(|r| Profile::reached(*r, profile.value(*r), energy, b));
        for here in marks.chain([at_center]) {
            count += u32::from(here != allowed);
            allowed = here;
        }
        count
    }

    fn turns(profile: &Profile, energy: f64, b: f64, ends: [f64; 2], barriers: Vec<f64>) -> Way {
        profile.bracket(energy, b, ends).map_or(Way::Captured, |bracket| Way::Turns { bracket, barriers })
    }
}

/// Where the deflection function is not smooth at an energy, in the caller's units.
pub(super) fn edges(profile: &Profile, energy: f64) -> Vec<Edge> {
    let e = profile.take_energy(energy);
    let radii = if e < profile.one_turning_point_from() { profile.critical_radii(e) } else { Vec::new() };
    let mut critical = Critical::default();
    let mut edges: Vec<Edge> = Vec::new();
    let rim = profile.pulling_rim(e);
    for r in radii.iter().step_by(2) {
        let rest = 1.0 - profile.value(*r) / e;
        // Nothing comes from outside to what is behind a wall.
        if rest <= 0.0 {
            break;
        }
        let b = if Some(*r) == rim { *r } else { r * rest.sqrt() };
        let hidden = edges.iter().any(|edge| edge.impact_parameter <= profile.give_length(b));
        if b > 0.0 && !hidden {
            let captures = matches!(critical.way(profile, e, b * (1.0 - 1e-9)), Way::Captured);
            edges.push(Edge {
                impact_parameter: profile.give_length(b),
                orbit: (Some(*r) != rim).then(|| profile.give_length(*r)),
                captures,
            });
        }
    }
    // What has an edge itself shows it to what just touches it.
    let rims = profile.breaks().iter().filter(|_| profile.breaks().len() <= MANY);
    let end = (profile.range() < f64::INFINITY).then(|| profile.range());
    for b in rims.map(|r| profile.give_length(*r)).chain(end) {
        edges.push(Edge { impact_parameter: b, orbit: None, captures: false });
    }
    edges.sort_by(|a, b| a.impact_parameter.total_cmp(&b.impact_parameter));
    edges.dedup_by(|a, b| a.impact_parameter == b.impact_parameter);
    edges
}

/// How near b is to where a barrier has its top, as a part of it.
pub(super) fn nearness(profile: &Profile, energy: f64, b: f64, barriers: &[f64]) -> f64 {
    let off = |r: &f64| {
        let rest = 1.0 - profile.value(*r) / energy;
        if rest > 0.0 { (r * rest.sqrt() / b - 1.0).abs() } else { f64::INFINITY }
    };
    // Nothing stays on a rim.
    let rim = profile.pulling_rim(energy);
    barriers.iter().step_by(2).filter(|r| Some(**r) != rim).map(off).fold(f64::INFINITY, f64::min)
}
