//! Vectors of expressions, and numbers that differ from lane to lane as their parameters.

use crate::expressions::{Graph, Id};
use crate::numerics::lanes::{Lanes, WIDTH};

/// A vector of expressions.
pub(in crate::rigid::motion) type Vector = [Id; 3];

/// Expressions while they are written.
pub(in crate::rigid::motion) struct Writer {
    pub(in crate::rigid::motion) graph: Graph,
    /// The numbers that its parameters stand for.
    pub(super) parameters: Vec<Lanes>,
}

impl Writer {
    /// With so many parameters that are set later.
    pub(super) fn new(open: usize) -> Self {
        Self { graph: Graph::default(), parameters: vec![Lanes([0.0; WIDTH]); open] }
    }

    /// A number of each lane, whatever it is: an expression without a term that is 0 may be rounded in another order.
    pub(in crate::rigid::motion) fn number(&mut self, of: &Lanes) -> Id {
        self.parameters.push(*of);
        self.graph.parameter(self.parameters.len() as u32 - 1)
    }

    /// A vector of each lane.
    pub(in crate::rigid::motion) fn vector(&mut self, of: &[Lanes; 3]) -> Vector {
        of.each_ref().map(|part| self.number(part))
    }

    /// The zero vector.
    pub(in crate::rigid::motion) fn nothing(&mut self) -> Vector {
        [self.graph.constant(0.0); 3]
    }

    /// The variables from one on.
    pub(super) fn variables<const N: usize>(&mut self, at: [usize; N]) -> [Id; N] {
        at.map(|at| self.graph.variable(at as u32))
    }

    /// `a + factor·b`, by a plain number.
    pub(in crate::rigid::motion) fn plus(&mut self, a: Vector, factor: f64, b: Vector) -> Vector {
        [0, 1, 2].map(|c| self.graph.sum(0.0, &[(1.0, a[c]), (factor, b[c])]))
    }

    /// The product with a number.
    pub(in crate::rigid::motion) fn times(&mut self, a: Vector, factor: Id) -> Vector {
        a.map(|part| self.graph.multiply(part, factor))
    }

    /// The products of components.
    pub(in crate::rigid::motion) fn each_times(&mut self, a: Vector, b: Vector) -> Vector {
        [0, 1, 2].map(|c| self.graph.multiply(a[c], b[c]))
    }

    /// The vector product.
    pub(in crate::rigid::motion) fn cross(&mut self, a: Vector, b: Vector) -> Vector {
        [0, 1, 2].map(|c| {
            let (next, last) = ((c + 1) % 3, (c + 2) % 3);
            let terms = [self.graph.multiply(a[next], b[last]), self.graph.multiply(a[last], b[next])];
            self.graph.subtract(terms[0], terms[1])
        })
    }

    /// The scalar product.
    pub(in crate::rigid::motion) fn dot(&mut self, a: Vector, b: Vector) -> Id {
        self.graph.dot(a, b)
    }
}

/// The matrix by which a quaternion `[x, y, z, w]` turns vectors.
pub(in crate::rigid::motion) struct Rotation {
    rows: [Vector; 3],
}

impl Rotation {
    /// Of a quaternion of length 1.
    pub(super) fn of(writer: &mut Writer, [x, y, z, w]: [Id; 4]) -> Self {
        let graph = &mut writer.graph;
        let [xx, yy, zz] = [x, y, z].map(|part| graph.multiply(part, part));
        let [xy, yz, xz] = [(x, y), (y, z), (x, z)].map(|(a, b)| graph.multiply(a, b));
        let [xw, yw, zw] = [x, y, z].map(|part| graph.multiply(part, w));
        let mut entry = |constant: f64, sign: f64, a: Id, b: Id| {
            graph.sum(constant, &[(if constant == 0.0 { 2.0 } else { -2.0 }, a), (2.0 * sign, b)])
        };
        Self {
            rows: [
                [entry(1.0, -1.0, yy, zz), entry(0.0, -1.0, xy, zw), entry(0.0, 1.0, xz, yw)],
                [entry(0.0, 1.0, xy, zw), entry(1.0, -1.0, xx, zz), entry(0.0, -1.0, yz, xw)],
                [entry(0.0, -1.0, xz, yw), entry(0.0, 1.0, yz, xw), entry(1.0, -1.0, xx, yy)],
            ],
        }
    }

    /// A vector that is turned.
    pub(in crate::rigid::motion) fn turned(&self, writer: &mut Writer, v: Vector) -> Vector {
        self.rows.map(|row| writer.dot(row, v))
    }

    /// A vector that is turned back.
    pub(in crate::rigid::motion) fn turned_back(&self, writer: &mut Writer, v: Vector) -> Vector {
        [0, 1, 2].map(|c| writer.dot(self.rows.map(|row| row[c]), v))
    }
}
