"""Mass properties of what a closed mesh of triangles encloses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._keywords import known_keywords
from visviva._packages import needed
from visviva._paths import path_text
from visviva.errors import InvalidInput
from visviva.rigid._mass import MassProperties, is_a_body

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import ArrayLike, NDArray


@known_keywords
def mesh(
    vertices: ArrayLike, faces: ArrayLike, *, mass: float | None = None, density: float | None = None
) -> MassProperties:
    """Give the mass properties of the solid that a closed mesh of triangles encloses.

    Units: those of the caller; a tensor is in mass · length².

    Parameters
    ----------
    vertices : array_like, shape (V, 3)
        Corners.
    faces : array_like of integers, shape (F, 3)
        The numbers of the corners of each triangle, all of them counterclockwise as seen from outside, or all
        clockwise. Corners at the same place may have several numbers. Cavities are closed meshes that run the other
        way.
    mass, density : float, optional
        One of the two; without either the density is 1.

    Returns
    -------
    MassProperties
        To 1e-12 also where the origin is a million sizes away.

    Raises
    ------
    InvalidInput
        For a mesh with holes or with triangles that run against each other (with the number of edges), one that
        encloses nothing, a number of no vertex, or both of mass and density.

    Notes
    -----
    Integrals over tetrahedra (Zhang & Chen 2001; Tonon 2005) from the middle of the mesh, on every core
    (``VISVIVA_THREADS``), with the same bits on any number of them. That the mesh is closed is told by the areas that
    it has where its corners are scattered at random, which miss an open edge once in 2¹²¹ meshes; edges are counted
    only to say what is wrong.

    References
    ----------
    F. Tonon, *Explicit exact formulas for the 3-D tetrahedron inertia tensor in terms of its vertex coordinates*, J.
    Math. Stat. 1 (2005) 8.

    Examples
    --------
    >>> import visviva as vv
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> body = vv.rigid.mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], density=480.0)
    >>> round(body.mass, 12), body.tensor.round(12)
    (80.0, array([[6., 1., 1.],
           [1., 6., 1.],
           [1., 1., 6.]]))
    """
    corners, triangles = float_array("vertices", vertices, (None, 3)), _whole_numbers(faces)
    if mass is not None and density is not None:
        raise InvalidInput("density", "expected mass or density, got both")
    volume, center, tensor = _core.mesh_enclosed(corners, triangles)
    if not is_a_body(tensor):
        raise InvalidInput(
            "faces",
            "expected parts that wind alike, a cavity inside of what it is in the other way: together they have the "
            f"tensor {tensor.tolist()}, which no body has; turn the faces of one part round (faces[:, ::-1])",
        )
    if mass is not None:
        weight = positive("mass", mass, "mass")
        return MassProperties(weight, center, tensor * (weight / volume))
    per_volume = 1.0 if density is None else positive("density", density)
    return MassProperties(volume * per_volume, center, tensor * per_volume)


@known_keywords
def load_mesh(path: str | PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    r"""Read vertices and faces from a file (STL, OBJ, PLY, …); needs ``trimesh``.

    Units: those of the file.

    Parameters
    ----------
    path : str or path
        The file.

    Returns
    -------
    tuple of ndarray
        Vertices, shape (V, 3), and faces, shape (F, 3), for `mesh`.

    Raises
    ------
    InvalidInput
        For what is no path.
    MissingPackage
        Without trimesh.

    Examples
    --------
    >>> import pathlib, tempfile, visviva as vv
    >>> from importlib.util import find_spec
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "corner.obj"
    >>> text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    >>> length = path.write_text(text)
    >>> if find_spec("trimesh"):
    ...     vertices, faces = vv.rigid.load_mesh(path)
    ...     assert vertices.shape == (4, 3) and faces.shape == (4, 3)
    """
    file = path_text("path", path)
    found: Any = needed("trimesh", "load_mesh", "mesh").load_mesh(file, process=False)
    return np.array(found.vertices, dtype=np.float64), np.array(found.faces, dtype=np.int64)


def _whole_numbers(faces: ArrayLike) -> NDArray[np.int64]:
    try:
        array = np.asarray(faces)
    except ValueError:  # rows of different lengths
        raise InvalidInput("faces", "expected three numbers in each row, got rows of different lengths") from None
    if array.dtype.kind not in "iu" or array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput("faces", f"expected whole numbers of shape (F, 3), got {array.dtype.name} of {array.shape}")
    return np.ascontiguousarray(array, dtype=np.int64)
