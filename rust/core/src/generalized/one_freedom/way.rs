//! From the start to a turning point, panel after panel.
//!
//! The one idea: bounds of the slope over all of a panel say that no turning point is in it, or that there is at most one; and
//! that nothing narrow is, so that its integral is what eight samples and twice eight agree on. What bounds cannot say of a
//! panel they say of a shorter one.

use super::OneFreedom;
use crate::error::{Error, Result};
use crate::expressions::intervals::Interval;

/// The first panel, in units of the place.
const FIRST: f64 = 1e-2;
/// So far away, in units of the place, nothing turns back any more.
const FAR: f64 = 1e20;
/// The most panels of a way, tried ones too.
const MOST: usize = 1 << 18;
/// Eight samples and twice eight that agree to this have an error that is its square.
const AGREEMENT: f64 = 1e-13;
/// What does not agree to this is not noise.
pub(super) const NOISE: f64 = 1e-6;
/// The part of the energies that a kink may hide.
const KINK: f64 = 1e-12;
/// A barrier is out of reach by more than this part of the energies.
const MARGIN: f64 = 1e-9;

/// Bounds over a panel.
pub(super) struct Bounds {
    pub(super) energy: Interval,
    pub(super) slope: Interval,
    pub(super) is_plain: bool,
}

/// A part of the way in which the integral of the slope is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    pub(super) from: f64,
    pub(super) to: f64,
    /// How much the energy at rest rises, and the sum of sizes that this is made of.
    pub(super) rise: [f64; 2],
}

impl Panel {
    /// The same in the other direction.
    pub(super) fn reversed(self) -> Self {
        Self { from: self.to, to: self.from, rise: [-self.rise[0], self.rise[1]] }
    }
}

/// The kinetic energy at all places between panels, and what it is the rest of, from what they are after `at` panels.
pub(super) fn energies(panels: &[Panel], at: usize, known: (f64, f64)) -> Vec<(f64, f64)> {
    let mut energies = vec![known; panels.len() + 1];
    for index in at..panels.len() {
        energies[index + 1] = after(energies[index], panels[index].rise);
    }
    for index in (0..at).rev() {
        energies[index] = after(energies[index + 1], panels[index].reversed().rise);
    }
    energies
}

fn after((left, of): (f64, f64), [rise, size]: [f64; 2]) -> (f64, f64) {
    (left - rise, of + size)
}

/// A way out.
#[derive(Default)]
pub(super) struct Way {
    pub(super) panels: Vec<Panel>,
    /// Its last place is a turning point.
    pub(super) turns: bool,
}

/// What there is in a panel.
enum Content {
    /// Motion all through.
    Passed(Panel),
    /// A turning point.
    Turning,
    /// A place where the slope is no finite number.
    NoNumber,
    /// More than can be told at once.
    Unclear,
}

/// The way in a direction (1 or −1), up to the first turning point, or so far at most.
///
/// # Errors
/// A place where the slope is no number.
pub(super) fn outward(of: &mut OneFreedom, direction: f64, limit: Option<f64>) -> Result<Way> {
    let unit = of.start.abs().max(1.0);
    let mut way = Way::default();
    let (start, mut from, mut width, mut noise) = (of.start, of.start, FIRST * unit, 0.0);
    let mut energy = (of.kinetic, of.kinetic);
    for tried in 0..MOST {
        let mut to = from + direction * width;
        let gone = |to: f64| (to - start).abs();
        if let Some(limit) = limit {
            if gone(from) >= limit {
                return Ok(way);
            }
            if gone(to) >= limit {
                to = start + direction * limit;
            }
        } else if gone(from) > FAR * unit || (tried.is_power_of_two() && never(of, from, direction)) {
            return Ok(way);
        }
        // What shorter panels would not tell either is told by its ends.
        let least = 2.0 * f64::EPSILON * from.abs().max(gone(from)).max(f64::MIN_POSITIVE);
        match content(of, (from, to), energy, direction, &mut noise, width <= least) {
            Content::Passed(panel) => {
                way.panels.push(panel);
                (from, energy, width) = (to, after(energy, panel.rise), 2.0 * width);
            }
            Content::Turning => {
                let last = turning(of, (from, to), energy.0);
                if last.from != last.to {
                    way.panels.push(last);
                }
                way.turns = true;
                return Ok(way);
            }
            Content::NoNumber => {
                return Err(Error::invalid(
                    "position",
                    format!(
                        "the motion meets a place where the slope of its energy is no finite number: q = {to:e}"
                    ),
                ));
            }
            Content::Unclear => width = 0.5 * (to - from).abs(),
        }
    }
    Err(Error::invalid(
        "position",
        format!(
            "the slope of the energy changes too often to be followed to a turning point: from q = {from:e} on"
        ),
    ))
}

/// Whether the energy suffices for all places that lie ahead.
fn never(of: &mut OneFreedom, from: f64, direction: f64) -> bool {
    let ahead = of.bounds(Interval::between(from, direction * f64::INFINITY));
    let highest = ahead.energy.high;
    highest.is_finite() && of.at_rest + of.kinetic - highest > MARGIN * (of.at_rest.abs() + of.kinetic)
}

/// The rise over both halves of a panel with what it is made of, and how well that agrees with the rise over the whole.
fn twice(of: &mut OneFreedom, from: f64, width: f64) -> ([f64; 2], f64) {
    let [whole, first, second] =
        [(0.0, 1.0), (0.0, 0.5), (0.5, 0.5)].map(|(begin, part)| of.rise(from + begin * width, part * width));
    let halves = [first[0] + second[0], first[1] + second[1]];
    (halves, (halves[0] - whole[0]).abs() / halves[1])
}

/// What there is in a panel; whether it is the `last` that is tried, since shorter ones would tell no more.
fn content(
    of: &mut OneFreedom,
    (from, to): (f64, f64),
    (left, energy): (f64, f64),
    direction: f64,
    noise: &mut f64,
    last: bool,
) -> Content {
    let bounds = of.bounds(Interval::between(from, to));
    if !bounds.is_plain && !last {
        return Content::Unclear;
    }
    let width = to - from;
    let ([rise, size], change) = twice(of, from, width);
    if last {
        // What cannot be told has to be too short to matter.
        let is_finite = bounds.slope.low.is_finite() && bounds.slope.high.is_finite();
        if size.is_nan() || !is_finite && size > KINK * (energy + size) {
            return Content::NoNumber;
        }
    } else if change > AGREEMENT.max(4.0 * *noise) {
        // Of what is smooth hardly anything is left when a panel is halved; of rounding, all, again and again.
        let again = [0.5, 0.25].map(|part| twice(of, from, part * width).1);
        if change > NOISE || again[0] < 0.25 * change || again[1] < 0.25 * again[0] {
            return Content::Unclear;
        }
        *noise = change;
    }
    let panel = Panel { from, to, rise: [rise, size] };
    // Rising all the way, where this is positive.
    let slopes = [bounds.slope.low * direction, bounds.slope.high * direction];
    let (least, steepest) = (slopes[0].min(slopes[1]), slopes[0].max(slopes[1]));
    if last || least >= 0.0 {
        return if left - rise < 0.0 { Content::Turning } else { Content::Passed(panel) };
    }
    let suffices = of.at_rest + of.kinetic - bounds.energy.high > MARGIN * (of.at_rest.abs() + of.kinetic);
    if left - steepest.max(0.0) * width.abs() >= 0.0 || suffices {
        Content::Passed(panel)
    } else {
        Content::Unclear
    }
}

/// The last panel of a way, whose energy rises: its end is halved to the last number inside.
fn turning(of: &mut OneFreedom, (start, end): (f64, f64), left: f64) -> Panel {
    let mut panel = Panel { from: start, to: start, rise: [0.0; 2] };
    let mut outside = end;
    loop {
        let middle = panel.to + 0.5 * (outside - panel.to);
        if middle == panel.to || middle == outside {
            return panel;
        }
        // From one number to another: what a rounded place leaves out would be much of the last panels.
        let next = of.panel(panel.to, middle);
        let rise = [panel.rise[0] + next.rise[0], panel.rise[1] + next.rise[1]];
        if rise[0] > left {
            outside = middle;
        } else {
            panel = Panel { to: middle, rise, ..panel };
        }
    }
}
