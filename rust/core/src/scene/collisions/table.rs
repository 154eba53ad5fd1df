//! The collisions of a run, as a table.

/// A collision.
#[derive(Clone, Copy, Debug)]
pub struct Collision {
    /// The copy.
    pub copy: usize,
    /// When.
    pub t: f64,
    /// The two bodies, in the order of their indices.
    pub bodies: (usize, usize),
    /// How fast they approached along the line of their centers.
    pub speed: f64,
    /// Where they touched.
    pub position: [f64; 3],
    /// The kinetic energy that was lost.
    pub energy_lost: f64,
    /// The body that is left of both, if they merged.
    pub survivor: Option<usize>,
}

/// The collisions of a run, copy after copy, in the order of the motion.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The lines.
    pub lines: Vec<Collision>,
}
