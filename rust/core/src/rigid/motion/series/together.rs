//! Any rigid bodies and points together, from the expressions of what moves them.
//!
//! The one idea: under pulls that are alike everywhere these are equations of the first order in the numbers of a state, and
//! whoever expands such equations expands them; else points are shown to forces order by order, as points alone are.

use super::super::acting::Loads;
use super::super::bodies::Arrangement;
use super::equations::{self, Written};
use super::{Expand, follow};
use crate::error::Result;
use crate::expressions::series::{Coefficient, Coefficients, Equations, Expansion};
use crate::numerics::element::Scaled;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::system::System;
use crate::parallel::Ticker;
use std::sync::Arc;

/// What coefficients of lanes are held in.
pub(super) trait Held: Coefficient {
    /// Of lanes.
    fn of(lanes: &Lanes) -> Self;
    /// Into lanes.
    fn put(self, into: &mut Lanes);
    /// Coefficients to be found, of which those of the order 0 are there: in `room`, or where they are.
    fn begin<'a>(lanes: &'a mut [Lanes], len: usize, room: &'a mut Vec<Self>) -> &'a mut [Self];
    /// Takes them back, all but those of the order 0.
    fn end(room: &[Self], lanes: &mut [Lanes], len: usize);
}

impl Held for f64 {
    fn of(lanes: &Lanes) -> Self {
        lanes.0[0]
    }
    fn put(self, into: &mut Lanes) {
        into.0[0] = self;
    }
    fn begin<'a>(lanes: &'a mut [Lanes], len: usize, room: &'a mut Vec<Self>) -> &'a mut [Self] {
        room.resize(lanes.len(), 0.0);
        for (into, from) in room.iter_mut().zip(&lanes[..len]) {
            *into = from.0[0];
        }
        room
    }
    fn end(room: &[Self], lanes: &mut [Lanes], len: usize) {
        for (into, from) in lanes.iter_mut().zip(room).skip(len) {
            into.0[0] = *from;
        }
    }
}

impl Held for Lanes {
    fn of(lanes: &Lanes) -> Self {
        *lanes
    }
    fn put(self, into: &mut Lanes) {
        *into = self;
    }
    fn begin<'a>(lanes: &'a mut [Lanes], _: usize, _: &'a mut Vec<Self>) -> &'a mut [Self] {
        lanes
    }
    fn end(_: &[Self], _: &mut [Lanes], _: usize) {}
}

/// The motions of bodies and points, in numbers or in lanes.
pub(super) struct Bodies<S> {
    arrangement: Arrangement,
    rates: Expansion<S>,
    /// Of the centers of held bodies, where they are asked for before the pulls on them are known.
    centers: Option<Expansion<S>>,
    alike: bool,
    /// Those of the rates, until the pulls among them, which are alike everywhere and at all times, are known.
    parameters: Option<Vec<S>>,
    inverse: Vec<Scaled<S>>,
    room: Vec<S>,
    /// The accelerations by forces.
    pulls: Vec<Lanes>,
    rates_of_order: Vec<Lanes>,
    /// The motion of points, as forces see it.
    points: Jet<Lanes>,
}

impl<S: Held> Bodies<S> {
    /// Of bodies that lie so, under these loads, and forces that pull `alike` everywhere or not.
    ///
    /// # Errors
    /// Only errors of the library itself.
    pub(super) fn new(arrangement: &Arrangement, loads: &Loads, alike: bool) -> Result<Self> {
        let expansion = |(series, parameters): Written| {
            let parameters: Vec<S> = parameters.iter().map(S::of).collect();
            (Expansion::new(Arc::new(series), &parameters), parameters)
        };
        let (rates, parameters) = expansion(equations::rates(arrangement, loads, alike)?);
        let centers = if alike || arrangement.held().next().is_none() {
            None
        } else {
            Some(expansion(equations::centers(arrangement)?).0)
        };
        Ok(Self {
            rates,
            centers,
            alike,
            parameters: Some(parameters),
            inverse: Vec::new(),
            room: Vec::new(),
            pulls: vec![Lanes::zero(); arrangement.points()],
            rates_of_order: vec![Lanes::zero(); 2 * arrangement.half()],
            points: Jet::new(arrangement.points(), 0),
            arrangement: arrangement.clone(),
        })
    }

    /// In one walk, under pulls that are alike everywhere.
    fn expand_at_once(
        &mut self,
        jet: &mut Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { arrangement, rates, parameters, inverse, room, pulls, .. } = self;
        let (points_len, half, len) = (arrangement.points(), arrangement.half(), jet.len);
        if let Some(parameters) = parameters.take() {
            let (q, v) = (&jet.q[..points_len], &jet.q[half..half + points_len]);
            points.acceleration(&jet.t, q, v, pulls, ticker)?;
            let pulled = pulls.iter().map(S::of).chain(parameters.into_iter().skip(points_len));
            rates.set_parameters(&pulled.collect::<Vec<S>>());
        }
        if inverse.len() < jet.inverse.len() {
            *inverse = jet.inverse.iter().map(|(high, low)| (S::of(high), S::of(low))).collect();
        }
        let (order, t, unit) = (jet.order, S::of(&jet.t), S::of(&jet.unit));
        let equations = Equations { second_order: false, velocity: false, t, unit, inverse, seen: None };
        let blocks = S::begin(&mut jet.q, len, room);
        rates.motion(&equations, Coefficients { order, len, q: &mut *blocks, v: &mut [] });
        let held = arrangement.held().next().is_some();
        if held {
            // Of the highest order no rate was asked for.
            for (number, coefficient) in blocks[order * len..][..len].iter().enumerate() {
                rates.set(number, order, *coefficient);
            }
            rates.expand(order);
        }
        S::end(room, &mut jet.q, len);
        if held {
            let mut output = len;
            for row in arrangement.held() {
                for c in 0..3 {
                    for n in 1..=order {
                        let arm = rates.output(output, n);
                        arm.put(&mut jet.q[n * len + c * arrangement.rows + row]);
                    }
                    output += 1;
                }
            }
            let rows = arrangement.rows;
            arrangement.held().for_each(|row| (0..3).for_each(|c| follow::<S>(jet, c * rows + row)));
        }
        Ok(())
    }

    /// Order by order, with pulls that differ from place to place.
    fn expand_in_turn(
        &mut self,
        jet: &mut Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let (half, len) = (self.arrangement.half(), jet.len);
        let many = self.arrangement.points();
        let per_unit = Lanes::one() / jet.unit;
        if self.points.order < jet.order {
            self.points = Jet::new(many, jet.order);
        }
        (self.points.t, self.points.unit, self.points.per_unit) = (jet.t, jet.unit, per_unit);
        (self.points.order, self.points.forward) = (jet.order, jet.forward);
        for n in 0..=jet.order {
            for number in 0..len {
                self.rates.set(number, n, S::of(&jet.q[n * len + number]));
            }
            self.set_centers(n, jet);
            if n == jet.order {
                return Ok(());
            }
            let Self { points: moving, pulls, rates, rates_of_order, .. } = self;
            let now = &jet.q[n * len..][..len];
            moving.q[n * many..][..many].copy_from_slice(&now[..many]);
            for (into, velocity) in moving.v[n * many..][..many].iter_mut().zip(&now[half..]) {
                *into = *velocity * jet.unit;
            }
            // Forces may look at the places of the next order, which velocities tell.
            let (next, inverse) = (&mut moving.q[(n + 1) * many..][..many], jet.inverse[n + 1].0);
            for (next, velocity) in next.iter_mut().zip(&moving.v[n * many..]) {
                *next = *velocity * inverse;
            }
            points.coefficient(n, moving, pulls, ticker)?;
            for (at, pull) in pulls.iter().enumerate() {
                rates.set(len + at, n, S::of(&(*pull * per_unit * per_unit)));
            }
            rates.expand(n);
            for (number, rate) in rates_of_order.iter_mut().enumerate() {
                rates.output(number, n).put(rate);
            }
            jet.raise_rates(n, rates_of_order);
        }
        Ok(())
    }

    /// Finds the coefficients of an order of the centers of held bodies.
    fn set_centers(&mut self, n: usize, jet: &mut Jet<Lanes>) {
        let Some(centers) = &mut self.centers else { return };
        let Arrangement { rows, .. } = self.arrangement;
        let (half, len) = (self.arrangement.half(), jet.len);
        for number in 0..len {
            centers.set(number, n, S::of(&jet.q[n * len + number]));
        }
        centers.expand(n);
        if n == 0 {
            return;
        }
        for (index, row) in self.arrangement.held().enumerate() {
            for c in 0..3 {
                let at = n * len + c * rows + row;
                centers.output(6 * index + c, n).put(&mut jet.q[at]);
                centers.output(6 * index + 3 + c, n).put(&mut jet.q[at + half]);
            }
        }
    }
}

impl<S: Held> Expand for Bodies<S> {
    fn expand(
        &mut self,
        jet: &mut Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if self.alike {
            self.expand_at_once(jet, points, ticker)
        } else {
            self.expand_in_turn(jet, points, ticker)
        }
    }

    fn smooth_until(&self, jet: &Jet<Lanes>, h: &Lanes, points: &dyn System<Lanes>) -> Option<Lanes> {
        let of_points = if self.alike { None } else { points.smooth_until(&self.points, h) };
        if !self.rates.may_turn_sharply() {
            return of_points;
        }
        let h = of_points.unwrap_or(*h);
        let mut smooth = h / jet.unit;
        self.rates.smooth_until(jet.order, S::of(&smooth)).put(&mut smooth);
        Some(smooth * jet.unit)
    }
}
