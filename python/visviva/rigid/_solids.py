"""Solids and shells of uniform density, with their centers of mass at the origin and their axes along z."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, positive
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._mass import MassProperties, composite, particles

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def solid_of_kind(kind: str, mass: object, *, shell: object = False, **lengths: object) -> MassProperties:
    """Check the arguments of a body that the core knows by name, and give it."""
    hollow = is_shell(shell)
    weight = positive("mass", mass, "mass")
    checked = [number(name, value) for name, value in lengths.items()]
    tensor = _core.solid_tensor(kind + "_shell" if hollow else kind, weight, checked)
    return MassProperties(weight, np.zeros(3), tensor)


def is_shell(shell: object) -> bool:
    """Check the argument."""
    if not isinstance(shell, bool | np.bool_):
        raise InvalidInput("shell", f"expected True or False, got {shell!r}")
    return bool(shell)


@known_keywords
def box(mass: float, a: float, b: float, c: float, *, shell: bool = False) -> MassProperties:
    """Give a box with sides a, b, c along x, y, z; as a shell, its six faces.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, a, b, c : float
        Positive.
    shell : bool
        Whether the mass is on the surface, evenly.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.box(12.0, 1.0, 2.0, 3.0).principal_axes().moments
    array([ 5., 10., 13.])
    """
    return solid_of_kind("box", mass, shell=shell, a=a, b=b, c=c)


@known_keywords
def sphere(mass: float, radius: float, *, inner_radius: float = 0.0) -> MassProperties:
    """Give a sphere, solid, hollow, or with ``inner_radius=radius`` a thin shell.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius : float
        Positive.
    inner_radius : float
        Of the hollow, from 0 to the radius.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length out of range.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.sphere(5.0, 1.0).tensor[0, 0], vv.rigid.sphere(3.0, 1.0, inner_radius=1.0).tensor[0, 0]
    (np.float64(2.0), np.float64(2.0))
    """
    return solid_of_kind("sphere", mass, radius=radius, inner_radius=inner_radius)


@known_keywords
def hemisphere(mass: float, radius: float, *, shell: bool = False) -> MassProperties:
    """Give half of a sphere; its center of mass is 3/8 of the radius (of a shell 1/2) from the disc.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius : float
        Positive.
    shell : bool
        Whether the mass is on the half sphere, evenly, without the disc.

    Returns
    -------
    MassProperties
        About the center of mass. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3: the integral of the tensor over the body.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.hemisphere(5.0, 1.0).tensor.diagonal()
    array([1.296875, 1.296875, 2.      ])
    """
    return solid_of_kind("hemisphere", mass, shell=shell, radius=radius)


@known_keywords
def ellipsoid(mass: float, a: float, b: float, c: float, *, shell: bool = False) -> MassProperties:
    """Give an ellipsoid with the semi-axes a, b, c along x, y, z; as a shell, its surface.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, a, b, c : float
        Positive.
    shell : bool
        Whether the mass is on the surface, evenly: a sheet of one thickness. What is between two ellipsoids of the same
        shape is thicker at the tips, and is the solid less another.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    Notes
    -----
    Of the surface, ∫ x² dS/S = a²(1 + ⟨N²⟩)/4 with the mean square of what the unit normal has along x; by Carlson's
    R_D (DLMF 19.33 has the area).

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2; of the surface, DLMF (https://dlmf.nist.gov), § 19.33.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.ellipsoid(5.0, 1.0, 2.0, 3.0).tensor.diagonal()
    array([13., 10.,  5.])
    >>> vv.rigid.ellipsoid(3.0, 1.0, 1.0, 1.0, shell=True).tensor.diagonal().round(12)
    array([2., 2., 2.])
    """
    return solid_of_kind("ellipsoid", mass, shell=shell, a=a, b=b, c=c)


@known_keywords
def cylinder(
    mass: float, radius: float, height: float, *, inner_radius: float = 0.0, shell: bool = False
) -> MassProperties:
    """Give a cylinder: solid, a pipe with an inner radius, or as a shell the wall with both discs.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius, height : float
        Positive.
    inner_radius : float
        Of a pipe, from 0 to the radius; with the radius itself, a thin wall without discs.
    shell : bool
        Whether the mass is on the whole surface, evenly.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length out of range, or a shell with an inner radius.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.cylinder(12.0, 1.0, 2.0).tensor.diagonal()
    array([7., 7., 6.])
    """
    inner = {"inner_radius": number("inner_radius", inner_radius)}
    if is_shell(shell) and inner["inner_radius"] != 0.0:
        raise InvalidInput("inner_radius", f"expected 0 of a shell, got {inner_radius!r}")
    return solid_of_kind("cylinder", mass, shell=shell, radius=radius, height=height, **({} if shell else inner))


@known_keywords
def cone(mass: float, radius: float, height: float, *, shell: bool = False) -> MassProperties:
    """Give a cone with its apex up; its center of mass is 1/4 of the height (of a shell 1/3) above its base.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius, height : float
        Positive.
    shell : bool
        Whether the mass is on the side, evenly, without the base.

    Returns
    -------
    MassProperties
        About the center of mass. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.cone(80.0, 1.0, 2.0).tensor.diagonal()
    array([24., 24., 24.])
    """
    return solid_of_kind("cone", mass, shell=shell, radius=radius, height=height)


@known_keywords
def capsule(mass: float, radius: float, height: float, *, shell: bool = False) -> MassProperties:
    """Give a cylinder of that height between two half spheres.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius, height : float
        Positive; the height is that of the cylinder alone.
    shell : bool
        Whether the mass is on the surface, evenly.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3: the integral of the tensor over the body.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.capsule(10.0, 1.0, 2.0).tensor.diagonal().round(12)
    array([12.1, 12.1,  4.6])
    """
    return solid_of_kind("capsule", mass, shell=shell, radius=radius, height=height)


@known_keywords
def torus(mass: float, major_radius: float, minor_radius: float, *, shell: bool = False) -> MassProperties:
    """Give a ring of circular cross-section about z.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, major_radius, minor_radius : float
        Positive: the radius of the circle that the middle of the ring is, and that of its cross-section, which is not
        larger.
    shell : bool
        Whether the mass is on the surface, evenly.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length out of range.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3: the integral of the tensor over the body.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.torus(8.0, 2.0, 1.0).tensor.diagonal()
    array([21., 21., 38.])
    """
    return solid_of_kind("torus", mass, shell=shell, major_radius=major_radius, minor_radius=minor_radius)


@known_keywords
def tetrahedron(mass: float, vertices: ArrayLike, *, shell: bool = False) -> MassProperties:
    """Give a tetrahedron; as a shell, its four faces.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass : float
        Positive.
    vertices : array_like, shape (4, 3)
        Its corners, in any order; flat ones are taken as the limit they are.
    shell : bool
        Whether the mass is on the surface, evenly.

    Returns
    -------
    MassProperties
        With its center of mass where it is. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass that is not positive, another shape, or a shell whose faces have no area.

    Notes
    -----
    Second moments of a tetrahedron are those of m/20 at each corner and 4m/5 at the center, of a triangle those of m/12
    and 3m/4 (Tonon 2005).

    References
    ----------
    F. Tonon, *Explicit exact formulas for the 3-D tetrahedron inertia tensor in terms of its vertex coordinates*, J.
    Math. Stat. 1 (2005) 8.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.tetrahedron(80.0, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).tensor.round(12)
    array([[6., 1., 1.],
           [1., 6., 1.],
           [1., 1., 6.]])
    """
    weight, corners = positive("mass", mass, "mass"), float_array("vertices", vertices, (4, 3))
    if not is_shell(shell):
        return _simplex(weight, corners)
    faces = [np.delete(corners, at, axis=0) for at in range(4)]
    edges = [face[1:] - face[0] for face in faces]
    areas = np.array([np.linalg.norm(np.cross(*edge)) for edge in edges])
    if not 0.0 < areas.max() < np.inf:
        raise InvalidInput("vertices", "expected faces with areas in the range of float64")
    shares = weight * (areas / areas.sum())
    bodies = [_simplex(share, face) for share, face in zip(shares.tolist(), faces, strict=True) if share > 0.0]
    return composite(bodies)


def _simplex(mass: float, corners: NDArray[np.float64]) -> MassProperties:
    """Give a rod, triangle or tetrahedron: of n corners each has 1/(n (n + 1)) of the mass, the center the rest."""
    n = len(corners)
    points = np.vstack([corners, corners[0] + (corners - corners[0]).mean(axis=0)])
    return particles(mass * np.array([1.0 / (n * (n + 1))] * n + [n / (n + 1)]), points)
