"""The cones that a free symmetric body rolls on: one fixed in the body, one in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva._html import brief_tuple
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._polhode import polhode

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
class ConeAngles(NamedTuple):
    """Half-angles of the cones of a free symmetric body, in radians; what `cone_angles` returns.

    Attributes
    ----------
    body : float
        Between the angular velocity and the body's axis: the cone that rolls.
    space : float
        Between the angular velocity and the angular momentum: the cone that it rolls on, or, of a body that is flat
        (C > A), around.
    axis : float
        Between the body's axis and the angular momentum: the cone of the precession.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.6.

    Examples
    --------
    >>> import visviva as vv
    >>> cones = vv.rigid.cone_angles([2.0, 2.0, 1.0], [0.5, 0.0, 1.25])  # a long body: its cone rolls on the outside
    >>> round(abs(cones.body + cones.space - cones.axis), 12)
    0.0
    """

    body: float
    space: float
    axis: float

    def __repr__(self) -> str:
        return brief_tuple(self)


@known_keywords
def cone_angles(moments: ArrayLike, angular_velocity: ArrayLike) -> ConeAngles:
    """Give the half-angles of the cones on which a free symmetric body rolls (Poinsot).

    Units: any; the angles are in radians.

    Parameters
    ----------
    moments : array_like, shape (3,)
        The principal moments of inertia, two of them equal.
    angular_velocity : array_like, shape (3,)
        Along the body's principal axes, not zero.

    Returns
    -------
    ConeAngles
        Each in [0, π/2], to a few units in the last place, small ones too.

    Raises
    ------
    InvalidInput
        As `polhode`; for a body at rest, one without equal moments, and a sphere, which has no axis.

    See Also
    --------
    polhode : the rates at which it goes round.

    Notes
    -----
    Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 5.6.

    Examples
    --------
    >>> import visviva as vv
    >>> cones = vv.rigid.cone_angles([2.0, 2.0, 3.0], [0.5, 0.0, 1.25])
    >>> round(cones.axis, 12), round(abs(cones.body - cones.axis - cones.space), 12)
    (0.260602391747, 0.0)
    """
    path = polhode(moments, angular_velocity)
    own, spin = np.asarray(moments, dtype=float), np.asarray(angular_velocity, dtype=float)
    if not spin.any():
        raise InvalidInput("angular_velocity", "expected a body that turns, got one at rest")
    at = _symmetry_axis(own)
    if path.kind not in ("steady", "symmetric") or at is None:
        raise InvalidInput("moments", f"expected two that are equal and a third that is not, got {own.tolist()}")
    # By a power of two, exactly, so that no square of them overflows or vanishes.
    spin = np.ldexp(spin, -np.frexp(np.abs(spin).max())[1])
    across, along = float(np.hypot(*np.delete(spin, at))), abs(float(spin[at]))
    equal, third = float(np.delete(own, at)[0]), float(own[at])
    return ConeAngles(
        body=float(np.arctan2(across, along)),
        # The difference of the other two, without their subtraction.
        space=float(np.arctan2(abs(third - equal) * across * along, equal * across * across + third * along * along)),
        axis=float(np.arctan2(equal * across, third * along)),
    )


def _symmetry_axis(moments: NDArray[np.float64]) -> int | None:
    pairs = [at for at in range(3) if moments[at - 1] == moments[at - 2]]
    return pairs[0] if len(pairs) == 1 else None
