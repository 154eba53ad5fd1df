//! Volume, center and inertia of what a closed mesh of triangles encloses.
//!
//! The one idea: the triangles and one point near them all are tetrahedra with signed volumes; their integrals are
//! polynomials of the corners as seen from that point, so that it does not matter how far the origin is. Whether a mesh
//! is closed is told on the way by one more sum of that kind: the corners are scattered over a plane at random, all at
//! one place to one point, and the signed areas of a closed mesh cancel there, too.
//! Source: Zhang & Chen, ICIP 2001; Tonon, J. Math. Stat. 1 (2005) 8; Schwartz, J. ACM 27 (1980) 701 for the last.

use super::quaternion::{Matrix, cross, dot};
use super::tensor::from_second_moments;
use crate::error::{Error, Result};
use crate::parallel::{Ticker, for_chunks};
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
/// Blocks that a thread takes at once.
const BLOCKS: usize = 32;

/// Ten sums: volume, first moments, second moments.
type Sums = [f64; 10];

/// What a mesh of these corners and triangles encloses; the same bits for any number of threads.
///
/// # Errors
/// `InvalidInput` for a triangle of corners that are not there, a mesh that is not closed or does not enclose anything,
/// and triangles that run against their neighbours, with the number of edges where it is so.
pub fn enclosed(
    vertices: &[[f64; 3]],
    faces: &[[i64; 3]],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Enclosed> {
    let (middle, size) = middle_and_size(vertices);
    let taken = BLOCK * BLOCKS;
    let parts = for_chunks(threads, faces.len().div_ceil(taken), ticker, |chunk, ticker| {
        ticker.tick()?;
        let start = chunk * taken;
        let mut area = 0;
        let blocks = faces[start..faces.len().min(start + taken)].chunks(BLOCK).enumerate();
        let sums = blocks.map(|(at, block)| summed(vertices, block, start + at * BLOCK, middle, &mut area));
        Ok((sums.collect::<Result<Vec<Sums>>>()?, area))
    })?;
    if parts.iter().fold(0_u128, |sum, (_, area)| sum.wrapping_add(*area)) != 0 {
        return Err(open(vertices, faces));
    }
    let mut whole = [0.0; 10];
    for sums in parts.iter().flat_map(|(sums, _)| sums) {
        for (sum, part) in whole.iter_mut().zip(sums) {
            *sum += part;
        }
    }
    let volume = whole[0] / 6.0;
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

/// The sums of some triangles, of which the first has that number; their area in the random plane is added to others.
fn summed(
    vertices: &[[f64; 3]],
    faces: &[[i64; 3]],
    first: usize,
    middle: [f64; 3],
    area: &mut u128,
) -> Result<Sums> {
    let mut sums = [0.0; 10];
    for (at, face) in faces.iter().enumerate() {
        let [Some(a), Some(b), Some(c)] =
            [corner(vertices, face[0]), corner(vertices, face[1]), corner(vertices, face[2])]
        else {
            let (count, at) = (vertices.len(), first + at);
            let message = format!("expected numbers of the {count} vertices, but faces[{at}] has another");
            return Err(Error::invalid("faces", message));
        };
        let ((u, v), (u1, v1), (u2, v2)) = (scattered(a), scattered(b), scattered(c));
        let (u1, v1, u2, v2) =
            (u1.wrapping_sub(u), v1.wrapping_sub(v), u2.wrapping_sub(u), v2.wrapping_sub(v));
        *area = area.wrapping_add(u1.wrapping_mul(v2).wrapping_sub(v1.wrapping_mul(u2)));
        let seen = |[x, y, z]: [f64; 3]| [x - middle[0], y - middle[1], z - middle[2]];
        sums = added(sums, [seen(a), seen(b), seen(c)]);
    }
    Ok(sums)
}

/// The vertex of that number.
#[inline(always)]
fn corner(vertices: &[[f64; 3]], number: i64) -> Option<[f64; 3]> {
    vertices.get(usize::try_from(number).ok()?).copied()
}

/// Where a corner is in a plane of 2¹²⁸ by 2¹²⁸ points, as if drawn at random.
///
/// Twice the signed area of a triangle is a sum over its edges, u v' − v u' of the ends of each, so that what is left of
/// a whole mesh are the edges that are not run through as often one way as the other. If one is left over an odd number
/// of times, the sum is a polynomial of the second degree in some of the numbers drawn that vanishes for 65 of 2¹²⁸ draws
/// at most; a factor 2ᵗ of all such numbers makes that 2ᵗ times as many.
#[inline(always)]
fn scattered([x, y, z]: [f64; 3]) -> (u128, u128) {
    // −0 is 0.
    let (x, y, z) = ((x + 0.0).to_bits(), (y + 0.0).to_bits(), (z + 0.0).to_bits());
    let a = folded(x ^ 0x2d35_8dcc_aa6c_78a5, y ^ 0x8bb8_4b93_962e_acc9);
    let b = folded(y ^ 0x4b33_a62e_d433_d4a3, z ^ 0x4d5a_2da5_1de1_aa47);
    let c = folded(z ^ 0xa076_1d64_78bd_642f, x ^ 0xe703_7ed1_a0b4_28db);
    let u = wide(
        folded(a ^ 0x8ebc_6af0_9c88_c6e3, b ^ 0x5899_65cc_7537_4cc3),
        folded(b ^ 0x1d8e_4e27_c47d_124f, c ^ 0xeb44_acca_b455_d165),
    );
    let v = wide(
        folded(c ^ 0x9c6e_6877_736c_46e3, a ^ 0x9ea6_98a3_b3bd_52c1),
        folded(a.wrapping_add(b) ^ 0x8fe1_b5d4_9c7f_5b21, c ^ 0xd6e8_feb8_6659_fd93),
    );
    (u, v)
}

/// A number of two halves.
#[inline(always)]
fn wide(high: u64, low: u64) -> u128 {
    u128::from(high) << 64 | u128::from(low)
}

/// The two halves of a product, one over the other.
#[inline(always)]
fn folded(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    #[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
    let (low, high) = (product as u64, (product >> 64) as u64);
    low ^ high
}

/// The middle of the box about all corners, and half its longest side.
fn middle_and_size(vertices: &[[f64; 3]]) -> ([f64; 3], f64) {
    let box_ = vertices.iter().fold([(f64::INFINITY, f64::NEG_INFINITY); 3], |mut sides, v| {
        for (side, part) in sides.iter_mut().zip(v) {
            *side = (side.0.min(*part), side.1.max(*part));
        }
        sides
    });
    let middle = box_.map(|(low, high)| 0.5 * low + 0.5 * high);
    let size = (0..3).fold(0.0, |most: f64, axis| {
        most.max((box_[axis].1 - middle[axis]).abs()).max((box_[axis].0 - middle[axis]).abs())
    });
    (middle, size)
}

/// What is wrong with a mesh that is not closed, with the number of edges.
fn open(vertices: &[[f64; 3]], faces: &[[i64; 3]]) -> Error {
    // Files keep the corners of each triangle apart: those at the same place are one.
    let mut first = HashMap::new();
    let places = vertices.iter().enumerate();
    let numbers: Vec<usize> =
        places.map(|(at, v)| *first.entry(v.map(|part| (part + 0.0).to_bits())).or_insert(at)).collect();
    let place = |at: i64| usize::try_from(at).ok().and_then(|at| numbers.get(at)).copied();
    let mut balance: HashMap<(usize, usize), (i64, i64)> = HashMap::new();
    for [a, b, c] in faces {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // An edge from a corner to itself is none.
            let (Some(from), Some(to)) = (place(*from), place(*to)) else { continue };
            if from != to {
                let (net, count) = balance.entry((from.min(to), from.max(to))).or_default();
                *net += if from < to { 1 } else { -1 };
                *count += 1;
            }
        }
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
