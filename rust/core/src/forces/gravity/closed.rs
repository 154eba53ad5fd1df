//! Two or three bodies that nothing else acts on, under a multistep method: accelerations and step in one pass.
//!
//! The one idea: a step of such a method costs little more than reading and writing what it holds. So the first body
//! of a system is left out (its centre of mass tells where it is), and the coordinates of the others, relative to it,
//! are weighed while they are in registers.

use super::few::sums;
use super::relative::Relative;
use super::{CLOSED_MAX, FewBodies};
use crate::error::Result;
#[cfg(test)]
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Shape};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::ode::multistep::{MultistepStep, Past};
use crate::ode::passes::multistep::{Nodes, step_group};
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::system::System;
use crate::ode::{Method, Scheme};
use crate::parallel::Ticker;
use crate::tiered;

/// Accelerations relative to the first of `N` bodies, from coordinates relative to it: `G` numbers of the others.
#[inline(always)]
fn accelerations<
    S: InverseCube,
    const N: usize,
    const HALF: usize,
    const G: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    q: &[S],
    strength: &[S],
    softening2: S,
) -> [S; G] {
    let components = G / (N - 1);
    let mut position = [[S::zero(); 3]; N];
    for g in 0..G {
        position[1 + g / components][g % components] = q[g];
    }
    let sum = sums::<S, N, N, HALF, PLANAR, SOFT>(&position, strength, &[softening2]);
    let mut a = [S::zero(); G];
    for g in 0..G {
        let c = g % components;
        a[g] = sum[1 + g / components][c] - sum[0][c];
    }
    a
}

#[inline(always)]
fn kernel<
    S: InverseCube,
    const N: usize,
    const HALF: usize,
    const G: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    (strength, softening2): (&[S], &[S]),
    mut nodes: Nodes<'_, S>,
    steps: u64,
) {
    let systems = softening2.len();
    for step in 0..steps {
        for system in 0..systems {
            let (start, strength) = (system * G, &strength[system * N..][..N]);
            let (mut place, mut a) = ([S::zero(); G], [S::zero(); G]);
            place.copy_from_slice(&nodes.q.0[start..][..G]);
            if step == 0 {
                a.copy_from_slice(&nodes.a[start..][..G]);
            } else {
                a = accelerations::<S, N, HALF, G, PLANAR, SOFT>(&place, strength, softening2[system]);
            }
            step_group(&mut nodes, start, a, place);
        }
        nodes.past.newest =
            if nodes.past.newest + 1 == nodes.weights.len() { 0 } else { nodes.past.newest + 1 };
    }
    for system in 0..systems {
        let (start, strength) = (system * G, &strength[system * N..][..N]);
        let place = &nodes.q.0[start..][..G];
        let a = accelerations::<S, N, HALF, G, PLANAR, SOFT>(place, strength, softening2[system]);
        nodes.a[start..][..G].copy_from_slice(&a);
    }
}

/// The kernel for so many bodies, in the plane or in space, softened or not, of these strengths and softening lengths (squared).
#[inline(always)]
fn select_kernel<S: InverseCube>(
    (bodies, shape, soft): (usize, Shape, bool),
    numbers: (&[S], &[S]),
    nodes: Nodes<'_, S>,
    steps: u64,
) {
    macro_rules! select {
        ($bodies:literal, $half:literal, $group:literal, $planar:literal) => {
            if soft {
                kernel::<S, $bodies, $half, $group, $planar, true>(numbers, nodes, steps)
            } else {
                kernel::<S, $bodies, $half, $group, $planar, false>(numbers, nodes, steps)
            }
        };
    }
    match (bodies, shape.components) {
        (2, 2) => select!(2, 1, 2, true),
        (2, 3) => select!(2, 1, 3, false),
        (3, 2) => select!(3, 1, 4, true),
        (3, 3) => select!(3, 1, 6, false),
        // Others are not offered by `systems`.
        _ => {}
    }
}

#[inline(always)]
fn lanes_kernel<V: Vector8 + InverseCube>(few: &FewBodies<Lanes>, nodes: Nodes<'_, Lanes>, steps: u64) {
    let numbers = (V::view(&few.strength), V::view(&few.softening2));
    select_kernel::<V>((few.bodies(), few.shape, few.soft), numbers, nodes.view::<V>(), steps);
}

tiered! {
    fn lanes_steps[][](few: &FewBodies<Lanes>, nodes: Nodes<'_, Lanes>, steps: u64) = lanes_kernel;
}

/// Of one trajectory, as tests have it.
#[cfg(test)]
fn plain_steps<S: Element>(few: &FewBodies<S>, nodes: Nodes<'_, S>, steps: u64) {
    let numbers = (&few.strength[..], &few.softening2[..]);
    select_kernel((few.bodies(), few.shape, few.soft), numbers, nodes, steps);
}

/// Scalars for which closed systems have a kernel.
pub trait ClosedKernel: Element {
    /// Steps of a multistep method, in coordinates relative to the first body of each system: those of the bodies from
    /// the second on, system after system, the components of a body together. The present accelerations are those of
    /// the last node after it.
    fn steps(few: &FewBodies<Self>, nodes: Nodes<'_, Self>, steps: u64);
}

macro_rules! closed_kernel {
    ($($type:ty: $steps:ident),+) => {$(
        impl ClosedKernel for $type {
            fn steps(few: &FewBodies<Self>, nodes: Nodes<'_, Self>, steps: u64) {
                $steps(few, nodes, steps);
            }
        }
    )+};
}
closed_kernel!(Lanes: lanes_steps);
#[cfg(test)]
closed_kernel!(f64: plain_steps, DoubleDouble: plain_steps);

/// Whether closed systems of so many bodies, none of them massless, have a kernel for the method.
pub fn serves(method: &Method, massive: usize) -> bool {
    matches!(method.scheme, Scheme::Multistep(_)) && (2..=CLOSED_MAX).contains(&massive)
}

/// A multistep method for closed systems: once it has started, the kernel takes the steps.
#[derive(Debug)]
pub(super) struct ClosedStep<S> {
    few: FewBodies<S>,
    general: MultistepStep<S>,
    /// Other coordinates than those of the state, once it has started, and their past.
    relative: Option<(Relative<S>, Past<S>)>,
    /// Room for velocities in them.
    velocity: Vec<S>,
    /// Whether the state belongs to the present node.
    settled: bool,
}

impl<S: ClosedKernel> ClosedStep<S> {
    pub(super) fn new(few: FewBodies<S>, general: MultistepStep<S>) -> Self {
        Self { few, general, relative: None, velocity: Vec::new(), settled: true }
    }
}

impl<S: ClosedKernel> Stepper<S> for ClosedStep<S> {
    fn restart(&mut self) {
        self.general.restart();
        self.relative = None;
        self.settled = true;
    }

    fn step(
        &mut self,
        node: u64,
        at_most: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        if let Some((relative, past)) = &mut self.relative {
            self.settled = false;
            S::steps(&self.few, past.nodes(relative.coordinates_mut(), self.general.weights()), at_most);
            system.count(at_most);
            relative.pass(at_most);
            past.pass(at_most);
            return Ok(at_most);
        }
        let steps = self.general.step(node, at_most, state, system, ticker)?;
        if !self.general.starting() {
            let relative = Relative::new(&self.few, self.general.weights().h, state);
            let (v, v_error) = relative.of_compensated(state.velocity());
            let mut past = self.general.past().map(v.len(), |a, out| relative.of(a, out));
            past.start((&v, &v_error), self.general.weights());
            self.relative = Some((relative, past));
        }
        Ok(steps)
    }

    fn settle(&mut self, state: &mut State<S>) {
        let (Some((relative, past)), false) = (&mut self.relative, self.settled) else { return };
        self.velocity.resize(past.d.len(), S::zero());
        past.velocity(&mut self.velocity, self.general.weights());
        relative.write(state, &self.velocity);
        self.settled = true;
    }

    fn memory(&mut self, node: u64, each: &mut dyn FnMut(&mut [S])) {
        let Some(steps) = self.general.steps_since_start(node) else {
            return self.general.memory(node, each);
        };
        let (relative, past) = self.relative.get_or_insert_with(|| {
            let relative = Relative::blank(&self.few, self.general.weights().h);
            let past = self.general.past().map(relative.len(), |_, _| {});
            (relative, past)
        });
        relative.memory(steps, past, node, each);
        self.settled = true;
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.general.between(node, past, state, system, ticker)
    }
}

impl<S: ClosedKernel> FewBodies<S> {
    /// What takes steps `h` of the method for systems on which nothing else acts, if it is one that they have a kernel for.
    pub fn closed_stepper(
        &self,
        method: &'static Method,
        h: f64,
        system: &dyn System<S>,
        state: &State<S>,
    ) -> Option<Box<dyn Stepper<S>>> {
        let Scheme::Multistep(table) = &method.scheme else { return None };
        let massive = self.strength.len() / self.systems;
        if massive != self.bodies() || !serves(method, massive) {
            return None;
        }
        Some(Box::new(ClosedStep::new(self.clone(), MultistepStep::new(table, h, system, state))))
    }
}
