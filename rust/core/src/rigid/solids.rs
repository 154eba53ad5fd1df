//! Mass properties of solids and shells about their centers, with z for the axis they have.
//!
//! The one idea: a body with three planes of symmetry has three second moments ∫ x² dm, and its tensor follows; they
//! are written so that a wall may be as thin as one likes.
//! Sources: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 5.4; integrals of one line each, but for the shell
//! of an ellipsoid.

use super::quaternion::Matrix;
use super::tensor::from_second_moments;
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::symmetric_second_kind;
use crate::words::{number, unknown};

/// What a body is called, the lengths it takes, and its second moments per mass.
struct Solid {
    name: &'static str,
    lengths: &'static [&'static str],
    moments: fn(&[f64]) -> [f64; 3],
}

fn squared(x: f64) -> f64 {
    x * x
}

/// Of the surface of an ellipsoid: of the square of a semi-axis a quarter, times one more than the mean square of what
/// the unit normal has along it.
///
/// With Q = Σ nᵢ²/aᵢ² on the unit sphere and mean values over it, x = a n and dS ∝ √Q; integrals of derivatives along
/// circles vanish, and give 4⟨nᵢ² √Q⟩ = ⟨√Q⟩ + ⟨nᵢ²/√Q⟩/aᵢ² and 2⟨nᵢ²/√Q⟩ = Σ_{j≠i} ⟨nⱼ² Q^(−3/2)⟩/aⱼ², which are R_D.
fn ellipsoid_shell(l: &[f64]) -> [f64; 3] {
    let half = [l[0], l[1], l[2]];
    let least = half[0].min(half[1]).min(half[2]);
    // 1/a, 1/b and 1/c in units of the largest of them; what is further off is as flat or as thin as can be told.
    let inverse = half.map(|a| DoubleDouble::from(least) / DoubleDouble::from(a.min(least * 1e60)));
    let parts: [DoubleDouble; 3] = core::array::from_fn(|at| {
        let [x, y, z] = [inverse[(at + 1) % 3], inverse[(at + 2) % 3], inverse[at]];
        symmetric_second_kind([x, y, z]) * z * z
    });
    let normal: [DoubleDouble; 3] =
        core::array::from_fn(|at| inverse[at] * inverse[at] * (parts[(at + 1) % 3] + parts[(at + 2) % 3]));
    let whole = normal[0] + normal[1] + normal[2];
    core::array::from_fn(|at| squared(half[at]) * (0.25 + 0.25 * (normal[at] / whole).to_f64()))
}

const SOLIDS: &[Solid] = &[
    Solid {
        name: "box",
        lengths: &["a", "b", "c"],
        moments: |l| [l[0], l[1], l[2]].map(|side| squared(side) / 12.0),
    },
    Solid {
        name: "box_shell",
        lengths: &["a", "b", "c"],
        moments: |l| {
            // Of a side's square, the two faces across have a quarter and the others a twelfth.
            let areas = [l[1] * l[2], l[2] * l[0], l[0] * l[1]];
            let whole = areas[0] + areas[1] + areas[2];
            core::array::from_fn(|at| squared(l[at]) / 12.0 * (1.0 + 2.0 * areas[at] / whole))
        },
    },
    Solid {
        name: "sphere",
        lengths: &["radius", "inner_radius"],
        moments: |l| {
            let (a, b) = (l[0], l[1]);
            // (a⁵ − b⁵)/(a³ − b³), divided through by a − b.
            let (high, low) = ((a * a + b * b) * (a * a + a * b) + b * b * b * b, a * a + a * b + b * b);
            [high / low / 5.0; 3]
        },
    },
    Solid {
        name: "hemisphere",
        lengths: &["radius"],
        // The center is 3/8 of the radius above the disc.
        moments: |l| [squared(l[0]) / 5.0, squared(l[0]) / 5.0, squared(l[0]) * (19.0 / 320.0)],
    },
    Solid {
        name: "hemisphere_shell",
        lengths: &["radius"],
        // The center is half of the radius above the rim.
        moments: |l| [squared(l[0]) / 3.0, squared(l[0]) / 3.0, squared(l[0]) / 12.0],
    },
    Solid {
        name: "ellipsoid",
        lengths: &["a", "b", "c"],
        moments: |l| [l[0], l[1], l[2]].map(|half| squared(half) / 5.0),
    },
    Solid { name: "ellipsoid_shell", lengths: &["a", "b", "c"], moments: ellipsoid_shell },
    Solid {
        name: "cylinder",
        lengths: &["radius", "height", "inner_radius"],
        moments: |l| {
            let across = (squared(l[0]) + squared(l[2])) / 4.0;
            [across, across, squared(l[1]) / 12.0]
        },
    },
    Solid {
        name: "cylinder_shell",
        lengths: &["radius", "height"],
        moments: |l| {
            let wall = l[1] / (l[0] + l[1]);
            let (across, along) = (squared(l[0]) / 4.0, squared(l[1]) / 12.0);
            [across * (1.0 + wall), across * (1.0 + wall), along * (3.0 - 2.0 * wall)]
        },
    },
    Solid {
        name: "cone",
        lengths: &["radius", "height"],
        moments: |l| {
            let across = squared(l[0]) * (3.0 / 20.0);
            [across, across, squared(l[1]) * (3.0 / 80.0)]
        },
    },
    Solid {
        name: "cone_shell",
        lengths: &["radius", "height"],
        moments: |l| [squared(l[0]) / 4.0, squared(l[0]) / 4.0, squared(l[1]) / 18.0],
    },
    Solid {
        name: "capsule",
        lengths: &["radius", "height"],
        moments: |l| {
            let (r, h) = (l[0], l[1]);
            let wall = h / (h + r * (4.0 / 3.0));
            let caps = 1.0 - wall;
            let across = r * r * (wall / 4.0 + caps / 5.0);
            [across, across, wall * h * h / 12.0 + caps * (h * h / 4.0 + h * r * 0.375 + r * r / 5.0)]
        },
    },
    Solid {
        name: "capsule_shell",
        lengths: &["radius", "height"],
        moments: |l| {
            let (r, h) = (l[0], l[1]);
            let wall = h / (h + 2.0 * r);
            let caps = 1.0 - wall;
            let across = r * r * (wall / 2.0 + caps / 3.0);
            [across, across, wall * h * h / 12.0 + caps * (h * h / 4.0 + h * r / 2.0 + r * r / 3.0)]
        },
    },
    Solid {
        name: "torus",
        lengths: &["major_radius", "minor_radius"],
        moments: |l| {
            let across = squared(l[0]) / 2.0 + squared(l[1]) * 0.375;
            [across, across, squared(l[1]) / 4.0]
        },
    },
    Solid {
        name: "torus_shell",
        lengths: &["major_radius", "minor_radius"],
        moments: |l| {
            let across = squared(l[0]) / 2.0 + squared(l[1]) * 0.75;
            [across, across, squared(l[1]) / 2.0]
        },
    },
    Solid { name: "rod", lengths: &["length"], moments: |l| [0.0, 0.0, squared(l[0]) / 12.0] },
    Solid {
        name: "disc",
        lengths: &["radius", "inner_radius"],
        moments: |l| {
            let across = (squared(l[0]) + squared(l[1])) / 4.0;
            [across, across, 0.0]
        },
    },
    Solid {
        name: "plate",
        lengths: &["a", "b"],
        moments: |l| [squared(l[0]) / 12.0, squared(l[1]) / 12.0, 0.0],
    },
];

/// The tensor about the center of a body of that name, of one unit of mass times `mass`.
///
/// # Errors
/// `InvalidInput` for lengths that are not positive (an inner radius: not negative, and not beyond the outer one).
pub fn tensor(name: &str, mass: f64, lengths: &[f64]) -> Result<Matrix> {
    let found = SOLIDS.iter().find(|solid| solid.name == name);
    let solid = found.ok_or_else(|| unknown("kind", name, SOLIDS.iter().map(|solid| solid.name)))?;
    if lengths.len() != solid.lengths.len() {
        return Err(Error::Internal(format!("{} lengths of a {name}", lengths.len())));
    }
    for (label, length) in solid.lengths.iter().zip(lengths) {
        let inner = *label == "inner_radius";
        if !(length.is_finite() && (*length > 0.0 || inner && *length == 0.0)) {
            let expected = if inner { "a radius of at least 0" } else { "a positive length" };
            return Err(Error::invalid(label, format!("expected {expected}, got {}", number(*length))));
        }
        if inner && *length > lengths[0] {
            let (inner, outer) = (number(*length), number(lengths[0]));
            return Err(Error::invalid(label, format!("expected at most radius = {outer}, got {inner}")));
        }
    }
    if name.starts_with("torus") && lengths[1] > lengths[0] {
        let (minor, major) = (number(lengths[1]), number(lengths[0]));
        let message =
            format!("expected at most major_radius = {major}, beyond which it meets itself, got {minor}");
        return Err(Error::invalid("minor_radius", message));
    }
    let [x, y, z] = (solid.moments)(lengths).map(|moment| mass * moment);
    Ok(from_second_moments([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]))
}
