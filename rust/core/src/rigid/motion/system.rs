//! Rigid bodies that torques turn, beside points, as a system of the first order: for methods that choose their steps.
//!
//! The one idea: half a quaternion times the spin is its rate, and of a quaternion only the direction is looked at, so that what
//! a step leaves of its length does not matter; it is drawn to length 1 when the step is kept. So are bodies that are held
//! at a point put where their orientations have them.

use super::acting::Loads;
use super::acting::unseen::Unseen;
use super::bodies::{Arrangement, LaneBody};
use super::flows::{hold, settle_held, twist};
use super::series::{Expand, InLanes, expanding};
use super::splitting::Pulls;
use super::turn::of_length_one;
use super::vectors::{cross, dot, times_plus, turned, turned_back};
use crate::error::{Error, Result};
use crate::numerics::element::{Element, PairMut, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::state::State;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::parallel::Ticker;

/// Points and bodies; a state is coordinates and quaternions, then velocities and momenta.
pub struct BodySystem {
    points: Box<dyn System<Lanes>>,
    pulls: Pulls,
    /// A state that is looked at.
    at: State<Lanes>,
    /// The same as series, for a method that asks for them.
    series: Option<Box<dyn Expand>>,
    /// Whether something may be unseen by the points.
    looks: bool,
    /// Formulas of torques in which something may be unseen.
    unseen: Vec<Unseen>,
}

impl BodySystem {
    /// Of points and bodies that lie so under these loads, with states like that one.
    pub fn new(
        points: Box<dyn System<Lanes>>,
        (arrangement, loads): (Arrangement, Loads),
        state: &State<Lanes>,
    ) -> Self {
        let unseen = loads.watched(&arrangement.bodies);
        let pulls = Pulls::new(arrangement, loads, 0.0);
        Self { points, pulls, at: state.clone(), series: None, looks: false, unseen }
    }

    /// Whose points may pass over something unseen, or not.
    #[must_use]
    pub fn looking(self, looks: bool) -> Self {
        Self { looks, ..self }
    }

    /// With its series, if it has some.
    ///
    /// # Errors
    /// Only errors of the library itself.
    pub fn with_series(mut self, of: InLanes) -> Result<Self> {
        self.series = expanding(&self.pulls.arrangement, &self.pulls.loads, of)?;
        Ok(self)
    }

    /// Where bodies lie.
    pub const fn arrangement(&self) -> &Arrangement {
        &self.pulls.arrangement
    }
}

impl System<Lanes> for BodySystem {
    fn form(&self) -> Form {
        Form::FirstOrder(self.at.all().0.len())
    }
    fn needs(&self) -> Needs {
        Needs { time: true, velocity: true, rotation: false }
    }
    fn evaluations(&self) -> u64 {
        self.points.evaluations()
    }
    fn stops_midway(&self) -> bool {
        self.points.stops_midway()
    }

    fn rate(&mut self, t: &Lanes, y: &[Lanes], rate: &mut [Lanes], ticker: &mut Ticker<'_>) -> Result<()> {
        let Self { points, pulls, at, .. } = self;
        let (now, rest) = at.all_mut();
        now.copy_from_slice(y);
        rest.fill(Lanes::zero());
        settle(&pulls.arrangement, at);
        pulls.evaluate(t, at, &mut **points, ticker)?;
        let Pulls { arrangement, a, torque, .. } = &*pulls;
        let (of_q, of_v) = rate.split_at_mut(at.q().len());
        Lanes::pass(Rates { arrangement, q: at.q(), v: at.v(), a, torque, of_q, of_v });
        Ok(())
    }

    fn expand(&mut self, jet: &mut Jet<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        let without = || Error::Internal("a function of the caller has no series".to_owned());
        let series = self.series.as_mut().ok_or_else(without)?;
        series.expand(jet, &mut *self.points, ticker)
    }

    fn smooth_until(&self, jet: &Jet<Lanes>, h: &Lanes) -> Option<Lanes> {
        self.series.as_ref().and_then(|series| series.smooth_until(jet, h, &*self.points))
    }

    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let Self { points, pulls, looks, unseen, .. } = self;
        let mut until = None;
        if *looks {
            until = step.ask_first_of_halves(pulls.arrangement.points(), &mut **points)?;
        }
        for formula in unseen {
            if let Some(seen) = formula.seen_until(step, &pulls.arrangement)? {
                until = Some(until.map_or(seen, |until: Lanes| until.min(seen)));
            }
        }
        Ok(until)
    }

    fn settle(&self, state: &mut State<Lanes>) {
        settle(&self.pulls.arrangement, state);
    }
}

fn settle(arrangement: &Arrangement, state: &mut State<Lanes>) {
    let (q, _) = state.halves_mut();
    Lanes::pass(Unit { arrangement, q: (&mut *q.0, &mut *q.1) });
    hold(arrangement, state);
    settle_held(arrangement, state);
}

/// Draws all quaternions to length 1.
struct Unit<'a> {
    arrangement: &'a Arrangement,
    q: PairMut<'a, Lanes>,
}

impl Pass<Lanes> for Unit<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let (q, rest) = V::pair_mut(self.q);
        for body in 0..self.arrangement.bodies.len() {
            let at = self.arrangement.at(body);
            let (to, left) = of_length_one(
                [q[at], q[at + 1], q[at + 2], q[at + 3]],
                [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]],
            );
            [q[at], q[at + 1], q[at + 2], q[at + 3]] = to;
            [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]] = left;
        }
    }
}

/// The rates of a state that is settled.
struct Rates<'a> {
    arrangement: &'a Arrangement,
    q: &'a [Lanes],
    v: &'a [Lanes],
    a: &'a [Lanes],
    torque: &'a [Lanes],
    of_q: &'a mut [Lanes],
    of_v: &'a mut [Lanes],
}

impl Pass<Lanes> for Rates<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Arrangement { rows, bodies, .. } = self.arrangement;
        let points = self.arrangement.points();
        let (q, v, a, torque) = (V::view(self.q), V::view(self.v), V::view(self.a), V::view(self.torque));
        let (of_q, of_v) = (V::view_mut(self.of_q), V::view_mut(self.of_v));
        of_q[..points].copy_from_slice(&v[..points]);
        of_v[..points].copy_from_slice(&a[..points]);
        for (body, of) in bodies.iter().enumerate() {
            let at = self.arrangement.at(body);
            let LaneBody { inverse, row, pivoted, center, .. } = of;
            let to = [q[at], q[at + 1], q[at + 2], q[at + 3]];
            let momentum = turned_back(to, [v[at], v[at + 1], v[at + 2]]);
            let mut half = momentum;
            for c in 0..3 {
                half[c] = V::splat(0.5) * V::load(inverse[c]) * momentum[c];
            }
            let axis = [to[0], to[1], to[2]];
            let across = cross(axis, half);
            for c in 0..3 {
                of_q[at + c] = to[3].multiply_add(half[c], across[c]);
            }
            of_q[at + 3] = -dot(axis, half);
            [of_v[at], of_v[at + 1], of_v[at + 2]] = twist::<V>(of, *rows, (q, a), torque, (body, at));
            of_v[at + 3] = V::zero();
            if *pivoted {
                // The velocity of its center follows from its turning, and so does the rate of that.
                let (mut arm, mut spin) = (half, half);
                for c in 0..3 {
                    arm[c] = V::load(center[c]);
                    spin[c] = half[c] + half[c];
                }
                let torque = turned_back(to, [of_v[at], of_v[at + 1], of_v[at + 2]]);
                let free = cross(spin, momentum);
                let mut faster = torque;
                for c in 0..3 {
                    faster[c] = V::load(inverse[c]) * (torque[c] - free[c]);
                }
                let inward = cross(spin, cross(spin, arm));
                let pull = turned(to, times_plus(cross(faster, arm), V::one(), inward));
                for c in 0..3 {
                    of_v[c * rows + row] = pull[c];
                }
            }
        }
    }
}
