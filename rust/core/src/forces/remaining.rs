//! Bodies that remain when some have become parts of others, and the forces on them.
//!
//! The one idea: a merger changes of a force only what names bodies, so that it is made again from other values of its
//! parameters. Charges add; what belongs to a body that has gone into another is gone with it.

use super::ForceTerm;
use crate::error::Result;
use crate::potentials::parameters::Value;
use std::sync::Arc;

/// The bodies that remain.
#[derive(Clone, Debug)]
pub struct Remaining {
    /// Those that are by themselves, by their indices.
    pub bodies: Vec<usize>,
    /// Which of them each body is, or is a part of.
    pub places: Vec<usize>,
}

/// What a force is of the bodies that remain.
#[derive(Clone, Debug)]
pub enum OfRemaining {
    /// What it was: it asks nothing of bodies but their masses and states.
    Same,
    /// One of its kind with these values of its parameters.
    Values(Vec<Value>),
    /// None: all that it acted by is gone.
    Nothing,
    /// It tells bodies apart, and nothing says what one that is put together of two feels.
    Unknown,
}

impl Remaining {
    /// From the body of which each is a part: itself, if it is by itself.
    pub fn of(hosts: &[usize]) -> Self {
        let bodies: Vec<usize> = (0..hosts.len()).filter(|&body| hosts.get(body) == Some(&body)).collect();
        let place = |host: &usize| bodies.partition_point(|body| body < host);
        let places = hosts.iter().map(place).collect();
        Self { bodies, places }
    }

    /// Whether some are parts of others.
    pub fn some_have_gone(&self) -> bool {
        self.bodies.len() < self.places.len()
    }

    /// The place of a body that has not gone into another.
    pub fn place_if_there(&self, body: usize) -> Option<usize> {
        self.bodies.binary_search(&body).ok()
    }

    /// The sum of the numbers of all parts of each that remains, of one number for all bodies or one for each; none of
    /// arrays of another length.
    pub fn sums(&self, numbers: &[f64]) -> Option<Vec<f64>> {
        let mut sums = vec![0.0; self.bodies.len()];
        for (body, &place) in self.places.iter().enumerate() {
            let number = if let [of_all] = numbers { of_all } else { numbers.get(body)? };
            *sums.get_mut(place)? += number;
        }
        Some(sums)
    }

    /// The ends of links between those that remain, and the places in the list of those links; none of links to bodies that
    /// are not.
    pub fn links(&self, pairs: &[(usize, usize)]) -> Option<[Vec<usize>; 3]> {
        let (mut i, mut j, mut links) = (Vec::new(), Vec::new(), Vec::new());
        for (at, &(from, to)) in pairs.iter().enumerate() {
            let (from, to) = (*self.places.get(from)?, *self.places.get(to)?);
            if from != to {
                i.push(from);
                j.push(to);
                links.push(at);
            }
        }
        Some([i, j, links])
    }

    /// The forces on those that remain. One that tells them apart is left as it is, for whoever checks it to refuse.
    ///
    /// # Errors
    /// Values of which no force can be made.
    pub fn forces(&self, forces: &[Arc<dyn ForceTerm>]) -> Result<Vec<Arc<dyn ForceTerm>>> {
        if !self.some_have_gone() {
            return Ok(forces.to_vec());
        }
        let of = |force: &Arc<dyn ForceTerm>| match force.of_remaining(self) {
            OfRemaining::Same | OfRemaining::Unknown => Some(Ok(Arc::clone(force))),
            OfRemaining::Values(values) => Some(force.declaration().build(&values)),
            OfRemaining::Nothing => None,
        };
        forces.iter().filter_map(of).collect()
    }
}

impl OfRemaining {
    /// With these values, if there are any, of something that is left.
    pub fn values(values: Option<Vec<Value>>) -> Self {
        values.map_or(Self::Unknown, Self::Values)
    }
}

#[cfg(test)]
mod tests {
    use super::Remaining;

    /// Bodies 1 and 4 are parts of 3, and 2 is one of 0.
    #[test]
    fn parts_are_where_their_hosts_are() {
        let remaining = Remaining::of(&[0, 3, 0, 3, 3]);
        assert_eq!(remaining.bodies, [0, 3]);
        assert_eq!(remaining.places, [0, 1, 0, 1, 1]);
        assert_eq!((remaining.place_if_there(3), remaining.place_if_there(1)), (Some(1), None));
        assert!(remaining.some_have_gone() && !Remaining::of(&[0, 1]).some_have_gone());
    }

    /// The charge of the whole is that of its parts, each told or the same for all.
    #[test]
    fn numbers_of_parts_add() {
        let remaining = Remaining::of(&[0, 3, 0, 3, 3]);
        assert_eq!(remaining.sums(&[1.0, 2.0, 4.0, 8.0, 16.0]), Some(vec![5.0, 26.0]));
        assert_eq!(remaining.sums(&[0.5]), Some(vec![1.0, 1.5]));
        assert_eq!(remaining.sums(&[0.5, 1.0]), None);
    }

    /// A link between parts of one body is none; one to a body that is not there is told.
    #[test]
    fn links_go_with_their_ends() {
        let remaining = Remaining::of(&[0, 3, 0, 3, 3]);
        let [i, j, links] = remaining.links(&[(0, 2), (2, 1), (4, 3), (3, 0)]).expect("they are there");
        assert_eq!((i, j, links), (vec![0, 1], vec![1, 0], vec![1, 3]));
        assert!(remaining.links(&[(0, 5)]).is_none());
    }
}
