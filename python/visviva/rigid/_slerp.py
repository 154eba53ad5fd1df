"""Orientations between two others."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._arguments import map_rows
from visviva.rigid._orientation import quaternion_from_rotation_vector, quaternion_product, rotation_vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def slerp(start: ArrayLike, end: ArrayLike, fraction: ArrayLike) -> NDArray[np.float64]:
    """Interpolate between orientations by spherical linear interpolation: one turn at a steady rate, the shorter way.

    Units: none: rotations and fractions are without dimension.

    Parameters
    ----------
    start, end : array_like, shape (…, 4)
        Quaternions (x, y, z, w), or rotations of SciPy.
    fraction : array_like, shape (…)
        How far on the way: 0 gives `start`, 1 `end`; beyond them the turn goes on at its rate. It broadcasts against
        the leading axes of the quaternions.

    Returns
    -------
    ndarray, shape (…, 4)
        Unit quaternions, those at 1 up to their sign. Of two orientations that are half a turn apart one of the two
        ways is taken.

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6, NaN or infinity, or axes that do not broadcast.

    Notes
    -----
    Shoemake, *SIGGRAPH Comput. Graph.* 19 (1985) 245. The angle comes from the difference of the two, so that small
    ones keep their digits. A body that turns freely does not turn at a steady rate: `free_rotation` knows its
    orientation at every time.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> quarter = vv.rigid.quaternion_from_rotation_vector([0.0, 0.0, np.pi / 2])
    >>> between = vv.rigid.slerp([0.0, 0.0, 0.0, 1.0], quarter, [0.0, 0.5, 1.0])
    >>> np.degrees(vv.rigid.rotation_vector(between)[:, 2]).round(12)
    array([ 0., 45., 90.])
    """
    first, last = _unit("start", start), _unit("end", end)
    part = float_array("fraction", fraction, None)
    shape = _broadcast("end", first.shape[:-1], last.shape[:-1], "start")
    _broadcast("fraction", shape, part.shape, "start and end")
    turn = rotation_vector(quaternion_product(first * [-1.0, -1.0, -1.0, 1.0], last))
    return quaternion_product(first, quaternion_from_rotation_vector(part[..., None] * turn))


def _unit(name: str, given: ArrayLike) -> NDArray[np.float64]:
    try:
        return map_rows(partial(_core.rotation_form, "normalized"), (4,), (name, given, (4,)))
    except InvalidInput as error:
        raise InvalidInput(name, error.message) from None


def _broadcast(name: str, lead: tuple[int, ...], own: tuple[int, ...], before: str) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(lead, own)
    except ValueError:
        raise InvalidInput(name, f"expected axes that broadcast with {lead} of {before}, got {own}") from None
