//! Rooted trees: the index set of the order conditions of Runge–Kutta methods.
//!
//! Source: Hairer, Nørsett & Wanner, *Solving ODE I*, II.2.

/// A rooted tree: a root whose branches are trees.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// Number of vertices.
    pub(super) order: usize,
    /// γ: the condition of this tree reads `Σ b_i Φ_i = 1/γ`.
    pub(super) density: f64,
    /// Indices of the branches, in the list that holds the tree, all smaller than its own.
    pub(super) branches: Vec<usize>,
}

/// Every rooted tree of at most `order` vertices, smallest first.
pub(super) fn trees_to_order(order: usize) -> Vec<Tree> {
    let mut trees = vec![Tree { order: 1, density: 1.0, branches: vec![] }];
    for size in 2..=order {
        let smaller = trees.len();
        grow(&mut trees, size, size - 1, smaller, &mut vec![]);
    }
    trees
}

/// Adds the trees of `size` vertices whose branches are `chosen` and `missing` more vertices in
/// trees of index below `limit` or equal to the last chosen (so that each collection comes once).
fn grow(trees: &mut Vec<Tree>, size: usize, missing: usize, limit: usize, chosen: &mut Vec<usize>) {
    if missing == 0 {
        let density = chosen.iter().map(|&branch| trees[branch].density).product::<f64>() * size as f64;
        trees.push(Tree { order: size, density, branches: chosen.clone() });
        return;
    }
    for branch in 0..limit {
        if trees[branch].order <= missing {
            chosen.push(branch);
            grow(trees, size, missing - trees[branch].order, branch + 1, chosen);
            let _ = chosen.pop();
        }
    }
}

#[test]
fn there_are_as_many_trees_as_cayley_counted() {
    let trees = trees_to_order(9);
    let counts: Vec<usize> =
        (1..=9).map(|order| trees.iter().filter(|tree| tree.order == order).count()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115, 286]); // OEIS A000081
    // The tallest tree has γ = n!, the bushiest γ = n.
    let of_order_nine = || trees.iter().filter(|tree| tree.order == 9).map(|tree| tree.density);
    assert_eq!(of_order_nine().fold(0.0, f64::max), 362_880.0);
    assert_eq!(of_order_nine().fold(f64::INFINITY, f64::min), 9.0);
}
