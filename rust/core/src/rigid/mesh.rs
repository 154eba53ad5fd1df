//! Volume, center and inertia of what a closed mesh of triangles encloses.
//!
//! The one idea: the triangles and one point near them all are tetrahedra with signed volumes; their integrals are
//! polynomials of the corners as seen from that point, so that it does not matter how far the origin is. Whether a mesh
//! is closed is told by one sum: each edge adds a random number along, and takes it away back.
//! Source: Zhang & Chen, ICIP 2001; Tonon, J. Math. Stat. 1 (2005) 8; the sum as in Zobrist hashing.

use super::quaternion::{Matrix, cross, dot};
use super::tensor::from_second_moments;
use crate::error::{Error, Result};
use crate::parallel::Ticker;
use std::collections::HashMap;

/// What a mesh encloses, of density one.
#[derive(Clone, Copy, Debug)]
pub struct Enclosed {
    /// Positive, whichever way the triangles run.
    pub volume: f64,
    /// The center of mass.
    pub center: [f64; 3],
    /// About the center.
    pub tensor: Matrix,
}

/// Triangles that are summed before they are added to the sums of others.
const BLOCK: usize = 512;

/// Ten sums: volume, first moments, second moments.
type Sums = [f64; 10];

/// What a mesh of these corners and triangles encloses.
///
/// # Errors
/// `InvalidInput` for a triangle of corners that are not there, a mesh that is not closed or does not enclose anything,
/// and triangles that run against their neighbours, with the number of edges where it is so.
pub fn enclosed(vertices: &[[f64; 3]], faces: &[[usize; 3]], ticker: &mut Ticker<'_>) -> Result<Enclosed> {
    if let Some((at, _)) =
        faces.iter().enumerate().find(|(_, face)| face.iter().any(|corner| *corner >= vertices.len()))
    {
        let message =
            format!("expected numbers of the {} vertices, but faces[{at}] has another", vertices.len());
        return Err(Error::invalid("faces", message));
    }
    if !is_closed(faces) {
        // Files keep the corners of each triangle apart: those at the same place are one.
        let merged = merged(vertices, faces);
        if !is_closed(&merged) {
            return Err(open(&merged));
        }
    }
    let middle = middle(vertices);
    let mut whole = [0.0; 10];
    for (index, block) in faces.chunks(BLOCK).enumerate() {
        if index % 16 == 0 {
            ticker.tick()?;
        }
        let sums = block.iter().fold([0.0; 10], |sums, face| {
            let corners = face.map(|at| core::array::from_fn(|axis| vertices[at][axis] - middle[axis]));
            added(sums, corners)
        });
        for (sum, part) in whole.iter_mut().zip(sums) {
            *sum += part;
        }
    }
    let volume = whole[0] / 6.0;
    // The volume of the sphere about the middle through the furthest corner, without the factor.
    let size = vertices
        .iter()
        .fold(0.0, |most: f64, v| (0..3).fold(most, |most, axis| most.max((v[axis] - middle[axis]).abs())));
    if volume.is_nan() || volume.abs() <= 1e-14 * size * size * size {
        let message = "expected a mesh that encloses a volume; what it encloses this way and that cancels, or it is flat";
        return Err(Error::invalid("faces", message));
    }
    let offset: [f64; 3] = core::array::from_fn(|axis| whole[1 + axis] / (4.0 * whole[0]));
    let second = |at: usize, i: usize, j: usize| {
        (whole[at] / 120.0 - volume * offset[i] * offset[j]) * volume.signum()
    };
    let (xx, yy, zz) = (second(4, 0, 0), second(5, 1, 1), second(6, 2, 2));
    let (xy, yz, zx) = (second(7, 0, 1), second(8, 1, 2), second(9, 2, 0));
    Ok(Enclosed {
        volume: volume.abs(),
        center: core::array::from_fn(|axis| middle[axis] + offset[axis]),
        tensor: from_second_moments([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]),
    })
}

/// The sums and those of one tetrahedron more.
#[inline(always)]
fn added(mut sums: Sums, [a, b, c]: [[f64; 3]; 3]) -> Sums {
    let volume = dot(a, cross(b, c));
    sums[0] += volume;
    let total: [f64; 3] = core::array::from_fn(|axis| a[axis] + b[axis] + c[axis]);
    let second = |i: usize, j: usize| total[i] * total[j] + (a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    for axis in 0..3 {
        sums[1 + axis] += volume * total[axis];
        sums[4 + axis] += volume * second(axis, axis);
        sums[7 + axis] += volume * second(axis, (axis + 1) % 3);
    }
    sums
}

/// The middle of the box about all corners.
fn middle(vertices: &[[f64; 3]]) -> [f64; 3] {
    core::array::from_fn(|axis| {
        let (low, high) = vertices
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v[axis]), high.max(v[axis])));
        0.5 * low + 0.5 * high
    })
}

/// A number of an edge that no other has, but for one chance in 2^64.
#[inline(always)]
fn mixed(low: usize, high: usize) -> u64 {
    let mut x =
        (low as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (high as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    x = (x ^ (x >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    x = (x ^ (x >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^ (x >> 32)
}

fn edges(face: &[usize; 3]) -> [(usize, usize); 3] {
    [(face[0], face[1]), (face[1], face[2]), (face[2], face[0])]
}

/// Whether each edge is run through as often one way as the other.
fn is_closed(faces: &[[usize; 3]]) -> bool {
    let mut sum = 0_u64;
    for face in faces {
        for (from, to) in edges(face) {
            let number = mixed(from.min(to), from.max(to));
            sum = if from < to { sum.wrapping_add(number) } else { sum.wrapping_sub(number) };
            // An edge from a corner to itself is none.
            if from == to {
                sum = sum.wrapping_add(number);
            }
        }
    }
    sum == 0
}

/// The faces, with one number for corners at one place.
fn merged(vertices: &[[f64; 3]], faces: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut first = HashMap::new();
    let numbers: Vec<usize> = vertices
        .iter()
        // −0 is 0.
        .enumerate()
        .map(|(at, v)| *first.entry(v.map(|part| (part + 0.0).to_bits())).or_insert(at))
        .collect();
    faces.iter().map(|face| face.map(|at| numbers[at])).collect()
}

/// What is wrong, with the number of edges.
fn open(faces: &[[usize; 3]]) -> Error {
    let mut balance: HashMap<(usize, usize), (i64, i64)> = HashMap::new();
    for (from, to) in faces.iter().flat_map(edges).filter(|(from, to)| from != to) {
        let (net, count) = balance.entry((from.min(to), from.max(to))).or_default();
        *net += if from < to { 1 } else { -1 };
        *count += 1;
    }
    let wrong = || balance.values().filter(|(net, _)| *net != 0);
    let against = wrong().filter(|(_, count)| count % 2 == 0).count();
    let border = wrong().count() - against;
    let message = if border > 0 {
        format!(
            "expected a closed mesh, but {border} of its {} edges are on the border of a hole",
            balance.len()
        )
    } else {
        format!(
            "expected triangles that all run the same way round, but on {against} of the {} edges two neighbours run \
             against each other; turn some of them over",
            balance.len()
        )
    };
    Error::invalid("faces", message)
}
