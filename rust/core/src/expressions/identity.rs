//! c·sin²x·r + c·cos²x·r = c·r: what makes the mass matrix of a chain of rods constant where it is.

use super::function::Function;
use super::graph::{Graph, Id, Node};
use rustc_hash::FxHashMap;

/// Products of more factors are not looked into.
const MOST_FACTORS: usize = 16;

/// The factors of nested products, ascending; none if there are too many.
fn factors(graph: &Graph, id: Id) -> Option<Vec<Id>> {
    let (mut found, mut waiting) = (Vec::new(), vec![id]);
    while let Some(id) = waiting.pop() {
        match *graph.node(id) {
            Node::Product(a, b) => waiting.extend([a, b]),
            _ => found.push(id),
        }
        if found.len() + waiting.len() > MOST_FACTORS {
            return None;
        }
    }
    found.sort_unstable();
    Some(found)
}

/// The first argument whose sine (or cosine) is squared in a product, and the other factors.
fn squared(graph: &Graph, id: Id, function: Function) -> Option<(Id, Vec<Id>)> {
    let mut all = factors(graph, id)?;
    let place = all.windows(2).position(|pair| {
        pair[0] == pair[1] && matches!(graph.node(pair[0]), Node::Call(f, _) if *f == function)
    })?;
    let &Node::Call(_, argument) = graph.node(all[place]) else { return None };
    drop(all.drain(place..place + 2));
    Some((argument, all))
}

/// The terms of a sum with one pair of squares joined, if there is one.
pub(super) fn squares_of_sine_and_cosine(graph: &mut Graph, terms: &[(Id, f64)]) -> Option<Vec<(f64, Id)>> {
    if !terms.iter().any(|&(id, _)| matches!(graph.node(id), Node::Product(..))) {
        return None;
    }
    let mut sines: FxHashMap<(u64, Id, Vec<Id>), usize> = FxHashMap::default();
    for (index, &(id, coefficient)) in terms.iter().enumerate() {
        if let Some((argument, rest)) = squared(graph, id, Function::Sin) {
            let _ = sines.insert((coefficient.to_bits(), argument, rest), index);
        }
    }
    if sines.is_empty() {
        return None;
    }
    let (cosine, sine, rest) = terms.iter().enumerate().find_map(|(index, &(id, coefficient))| {
        let (argument, rest) = squared(graph, id, Function::Cos)?;
        let key = (coefficient.to_bits(), argument, rest);
        sines.get(&key).map(|&sine| (index, sine, key.2))
    })?;
    let rest = graph.product(&rest);
    let mut joined: Vec<(f64, Id)> = terms
        .iter()
        .enumerate()
        .filter(|&(index, _)| index != cosine && index != sine)
        .map(|(_, &(id, coefficient))| (coefficient, id))
        .collect();
    joined.push((terms[sine].1, rest));
    Some(joined)
}
