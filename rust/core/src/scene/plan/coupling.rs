//! What has to be integrated together: the connected parts of the graph of which body depends on which.

use crate::forces::ForceTerm;
use crate::forces::term::Coupling;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// How the bodies of a copy hang together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Groups {
    /// Each by itself.
    Single,
    /// All together: every body that has mass acts on every other one.
    All,
    /// By listed pairs: the groups of more than one, each in order of index.
    Listed(Vec<Arc<[usize]>>),
}

impl Groups {
    /// Of so many bodies under these forces, of which some are tied to others besides.
    pub fn of(
        particles: usize,
        forces: &[Arc<dyn ForceTerm>],
        ties: impl Iterator<Item = (usize, usize)>,
    ) -> Self {
        let mut parent: Vec<usize> = (0..particles).collect();
        for (i, j) in ties {
            let (i, j) = (root(&mut parent, i), root(&mut parent, j));
            parent[i.max(j)] = i.min(j);
        }
        for force in forces {
            match force.coupling() {
                Coupling::None => {}
                Coupling::AllPairs => return Self::All,
                Coupling::Listed(pairs) => {
                    for (i, j) in pairs {
                        let (i, j) = (root(&mut parent, i), root(&mut parent, j));
                        parent[i.max(j)] = i.min(j);
                    }
                }
            }
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for body in 0..particles {
            groups.entry(root(&mut parent, body)).or_default().push(body);
        }
        let listed: Vec<Arc<[usize]>> =
            groups.into_values().filter(|group| group.len() > 1).map(Arc::from).collect();
        if listed.is_empty() { Self::Single } else { Self::Listed(listed) }
    }

    /// The bodies of each group, and the pairs that forces list between them.
    pub(super) fn sizes(&self, forces: &[Arc<dyn ForceTerm>]) -> Vec<(usize, usize)> {
        let Self::Listed(groups) = self else { return Vec::new() };
        let mut sizes: Vec<(usize, usize)> = groups.iter().map(|group| (group.len(), 0)).collect();
        let of: BTreeMap<usize, usize> = groups
            .iter()
            .enumerate()
            .flat_map(|(place, group)| group.iter().map(move |&body| (body, place)))
            .collect();
        for force in forces {
            let Coupling::Listed(pairs) = force.coupling() else { continue };
            for (body, _) in pairs {
                if let Some(size) = of.get(&body).and_then(|&place| sizes.get_mut(place)) {
                    size.1 += 1;
                }
            }
        }
        sizes
    }

    /// The most bodies of a group.
    pub fn largest(&self, particles: usize) -> usize {
        match self {
            Self::Single => 1,
            Self::All => particles,
            Self::Listed(groups) => groups.iter().map(|group| group.len()).max().unwrap_or(1),
        }
    }
}

/// The bodies that a force joins by listed pairs, in order of index; none of a force that acts on any.
pub(super) fn joined_by(force: &dyn ForceTerm) -> Option<Box<[usize]>> {
    let Coupling::Listed(pairs) = force.coupling() else { return None };
    let bodies: BTreeSet<usize> = pairs.into_iter().flat_map(|(i, j)| [i, j]).collect();
    Some(bodies.into_iter().collect())
}

/// Whether two lists of bodies in order have one in common.
pub(super) fn meet(one: &[usize], other: &[usize]) -> bool {
    let (few, many) = if one.len() < other.len() { (one, other) } else { (other, one) };
    few.iter().any(|body| many.binary_search(body).is_ok())
}

/// The body by which the group of a body is known; the way to it is shortened.
fn root(parent: &mut [usize], mut body: usize) -> usize {
    while parent[body] != body {
        parent[body] = parent[parent[body]];
        body = parent[body];
    }
    body
}
