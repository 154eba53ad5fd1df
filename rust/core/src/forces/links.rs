//! Links between listed pairs of bodies: who is linked to whom, and where their numbers lie in lanes.
//!
//! Canonical order: links act one after another, in the order in which they are listed, whatever the lanes are.

use super::context::{Arrangement, Context, System, packed_place};
use super::term::Bodies;
use crate::error::{Error, Result};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;

pub(super) mod series;

/// Pairs of bodies, in the order in which their links act.
#[derive(Debug)]
pub struct Links {
    pairs: Vec<(usize, usize)>,
    /// Each end and the place of its link in the list, in the order of the bodies: there may be as many links as
    /// bodies, and units as links.
    ends: Vec<(usize, usize)>,
}

/// Refuses parameters that are neither one number nor one for each link; how many links they make.
///
/// # Errors
/// By the name of the parameter.
pub fn check_counts(what: &str, lengths: &[(&str, usize)]) -> Result<usize> {
    let count = lengths.iter().map(|&(_, found)| found).max().unwrap_or(0);
    for &(name, found) in lengths {
        if found != 1 && found != count {
            let message = format!("expected one value or one for each of {count} {what}, got {found}");
            return Err(Error::invalid(name, message));
        }
    }
    Ok(count)
}

/// The value of a link, of one for all or one for each.
pub fn of_link<T: Copy>(values: &[T], link: usize) -> T {
    values[link.min(values.len() - 1)]
}

impl Links {
    /// From the bodies at either end, one for all or one for each of so many links.
    pub fn new(count: usize, i: &[usize], j: &[usize]) -> Self {
        let pairs: Vec<(usize, usize)> = (0..count).map(|at| (of_link(i, at), of_link(j, at))).collect();
        let each = pairs.iter().enumerate();
        let mut ends: Vec<(usize, usize)> =
            each.flat_map(|(at, pair)| [(pair.0, at), (pair.1, at)]).collect();
        ends.sort_unstable();
        Self { pairs, ends }
    }

    /// The pairs, in order.
    pub fn pairs(&self) -> &[(usize, usize)] {
        &self.pairs
    }

    /// The links at a body, by their places in the list.
    pub fn at(&self, body: usize) -> impl Iterator<Item = usize> {
        let from = self.ends.partition_point(|&(other, _)| other < body);
        self.ends.iter().skip(from).take_while(move |&&(other, _)| other == body).map(|&(_, at)| at)
    }

    /// The links between some of these bodies by their places in the list, in the order in which they act, and the places
    /// of their ends among the bodies.
    pub fn between(
        &self,
        bodies: impl Iterator<Item = usize>,
    ) -> impl Iterator<Item = (usize, (usize, usize))> {
        let mut places: Vec<(usize, usize)> = bodies.enumerate().map(|(place, body)| (body, place)).collect();
        places.sort_unstable();
        let mut own: Vec<usize> = places.iter().flat_map(|&(body, _)| self.at(body)).collect();
        own.sort_unstable();
        own.dedup();
        own.into_iter().filter_map(move |at| {
            let pair = *self.pairs.get(at)?;
            let place = |end: usize| {
                let found = places.binary_search_by_key(&end, |&(body, _)| body).ok()?;
                places.get(found).map(|&(_, place)| place)
            };
            // Those between bodies of other systems act there.
            Some((at, (place(pair.0)?, place(pair.1)?)))
        })
    }

    /// Refuses ends that are no bodies, or one and the same.
    ///
    /// # Errors
    /// By name.
    pub fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        for &(i, j) in &self.pairs {
            for (name, body) in [("i", i), ("j", j)] {
                if body >= view.particles {
                    let message =
                        format!("expected a body from 0 to {}, got {body}", view.particles.max(1) - 1);
                    return Err(Error::invalid(name, message));
                }
            }
            if i == j {
                return Err(Error::invalid("j", format!("expected another body than i, got {j} for both")));
            }
        }
        Ok(())
    }

    /// Refuses ends that coincide at the start: their direction would not be known.
    ///
    /// # Errors
    /// By name.
    pub fn refuse_coincident(
        &self,
        view: &Bodies<'_>,
        what: &str,
        matters: impl Fn(usize) -> bool,
    ) -> Result<()> {
        for (_, &(i, j)) in self.pairs.iter().enumerate().filter(|&(at, _)| matters(at)) {
            let meet = |copy: &usize| view.copy(*copy).1[i] == view.copy(*copy).1[j];
            if let Some(copy) = (0..view.copies).find(meet) {
                let [first, second] = [i, j].map(|body| view.name("position", copy * view.particles + body));
                let message =
                    format!("expected distinct ends of {what}, got {first} = {second}; move one of them");
                return Err(Error::invalid("position", message));
            }
        }
        Ok(())
    }
}

/// The links of a system in lanes.
#[derive(Debug)]
pub struct Linked {
    /// How coordinates lie.
    pub shape: Shape,
    /// Whether lanes are the bodies of one system.
    pub packed: bool,
    /// Blocks of rows.
    pub blocks: usize,
    /// Places in the list, and of their ends: rows in a block, or if packed among all numbers of a component.
    pub links: Vec<(usize, (usize, usize))>,
    /// 1/mass.
    pub inverse_mass: Vec<Lanes>,
}

/// Numbers of links, one after another, of each block.
pub type OfLinks = Vec<Lanes>;

impl Linked {
    /// A number of each link, by its place in the list, of each system.
    pub fn numbers(&self, context: &Context<'_>, of: impl Fn(&System<'_>, usize) -> f64) -> OfLinks {
        let number = |system: &System<'_>, link: usize| of(system, self.links[link].0);
        if !self.packed {
            return context.in_rows(self.links.len(), number);
        }
        let system = context.first();
        (0..self.links.len()).map(|link| Lanes::splat(number(&system, link))).collect()
    }

    /// Those between the bodies of a context.
    pub fn new(links: &Links, context: &Context<'_>) -> Self {
        let packed = context.arrangement == Arrangement::Packed;
        let place = |slot: usize| {
            let (row, lane) = packed_place(slot, context.active);
            if packed { row * WIDTH + lane } else { slot }
        };
        let own = links.between(context.first().bodies.iter().copied());
        Self {
            shape: context.shape,
            packed,
            blocks: context.blocks(),
            links: own.map(|(at, (i, j))| (at, (place(i), place(j)))).collect(),
            inverse_mass: context.per_body(|system, slot| 1.0 / system.mass[slot]),
        }
    }
}
