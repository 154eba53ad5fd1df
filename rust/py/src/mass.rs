//! Mass properties: particles, solids, meshes, and what is made of them.

use crate::arrays::{copied, in_place, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use visviva_core::Error;
use visviva_core::parallel::thread_count;
use visviva_core::rigid::mesh::enclosed;
use visviva_core::rigid::quaternion::{Matrix, unit};
use visviva_core::rigid::solids;
use visviva_core::rigid::tensor::{self, MassProperties};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Mass (or volume), center and tensor.
type Body<'py> = (f64, Column<'py>, Column<'py>);

fn rows<const K: usize>(values: &[f64]) -> Vec<[f64; K]> {
    values.as_chunks::<K>().0.to_vec()
}

fn given(py: Python<'_>, tensor: Matrix) -> PyResult<Column<'_>> {
    moved(py, tensor.concat(), &[3, 3])
}

/// Exactly so many numbers of an argument.
fn fixed<const K: usize>(name: &str, array: &Array<'_>, shape: [Option<usize>; 1]) -> PyResult<[f64; K]> {
    let (values, _) = copied(name, array, shape)?;
    <[f64; K]>::try_from(values)
        .map_err(|_| raised(array.py(), Error::invalid(name, format!("expected {K} numbers"))))
}

fn matrix(name: &str, array: &Array<'_>) -> PyResult<Matrix> {
    let (values, _) = copied(name, array, [Some(3), Some(3)])?;
    <Matrix>::try_from(rows::<3>(&values))
        .map_err(|_| raised(array.py(), Error::invalid(name, "expected shape (3, 3)")))
}

fn body(py: Python<'_>, found: MassProperties) -> PyResult<Body<'_>> {
    Ok((found.mass, moved(py, found.center.to_vec(), &[3])?, given(py, found.tensor)?))
}

/// The inertia tensor of particles about the origin.
#[pyfunction]
pub(crate) fn particles_tensor<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    position: Array<'py>,
) -> PyResult<Column<'py>> {
    let (mass, [count]) = copied("mass", &mass, [None])?;
    let (position, _) = copied("position", &position, [Some(count), Some(3)])?;
    let found = compute(py, 0, None, |_| Ok(tensor::of_particles(&mass, &rows(&position))))?.whole(py)?;
    given(py, found)
}

/// Bodies together: their masses, centers and tensors about them.
#[pyfunction]
pub(crate) fn bodies_together<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    center: Array<'py>,
    tensor: Array<'py>,
) -> PyResult<Body<'py>> {
    let (mass, [count]) = copied("mass", &mass, [None])?;
    let (center, _) = copied("center", &center, [Some(count), Some(3)])?;
    let (tensor, _) = copied("tensor", &tensor, [Some(count), Some(9)])?;
    let found = compute(py, 0, None, |_| {
        let own = tensor
            .as_chunks::<9>()
            .0
            .iter()
            .map(|&[a, b, c, d, e, f, g, h, i]| [[a, b, c], [d, e, f], [g, h, i]]);
        let parts = mass.iter().zip(rows::<3>(&center)).zip(own);
        let parts: Vec<_> =
            parts.map(|((&mass, center), tensor)| MassProperties { mass, center, tensor }).collect();
        MassProperties::together(&parts)
    })?
    .whole(py)?;
    body(py, found)
}

/// A tensor about the center, about a point that the center is off by `offset`.
#[pyfunction]
pub(crate) fn tensor_about<'py>(
    py: Python<'py>,
    tensor: Array<'py>,
    mass: f64,
    offset: Array<'py>,
) -> PyResult<Column<'py>> {
    given(py, tensor::about(matrix("tensor", &tensor)?, mass, fixed("offset", &offset, [Some(3)])?))
}

/// A tensor in other axes.
#[pyfunction]
pub(crate) fn tensor_rotated<'py>(
    py: Python<'py>,
    tensor: Array<'py>,
    quaternion: Array<'py>,
) -> PyResult<Column<'py>> {
    let turn = unit("quaternion", fixed("quaternion", &quaternion, [Some(4)])?)
        .map_err(|error| raised(py, error))?;
    given(py, tensor::rotated(matrix("tensor", &tensor)?, turn))
}

/// Principal moments and axes.
#[pyfunction]
pub(crate) fn principal_axes<'py>(
    py: Python<'py>,
    tensor: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>)> {
    let (moments, axes) = tensor::principal(matrix("tensor", &tensor)?).map_err(|error| raised(py, error))?;
    Ok((moved(py, moments.to_vec(), &[3])?, given(py, axes)?))
}

/// The tensor of a solid or shell about its center, by name.
#[pyfunction]
pub(crate) fn solid_tensor<'py>(
    py: Python<'py>,
    kind: &str,
    mass: f64,
    lengths: Vec<f64>,
) -> PyResult<Column<'py>> {
    given(py, solids::tensor(kind, mass, &lengths).map_err(|error| raised(py, error))?)
}

/// Volume, center and tensor, of density one, of what a mesh encloses; read where it is, in less time than a copy takes.
#[pyfunction]
pub(crate) fn mesh_enclosed<'py>(
    py: Python<'py>,
    vertices: Array<'py>,
    faces: PyReadonlyArrayDyn<'py, i64>,
) -> PyResult<Body<'py>> {
    let (vertices, faces) = (in_place("vertices", &vertices)?, in_place("faces", &faces)?);
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let found = compute(py, 0, None, |ticker| enclosed(vertices, faces, threads, ticker))?.whole(py)?;
    body(py, MassProperties { mass: found.volume, center: found.center, tensor: found.tensor })
}
