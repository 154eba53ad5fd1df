"""Action against reaction: what the forces between bodies add up to; see `visviva.audit`.

The one idea: a table of who acts on whom tells it, whatever made the forces.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array, positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class ThirdLaw(Record):
    """What `third_law` finds.

    Units: those of the forces, and of them times a length; `rtol` is without dimension.

    Attributes
    ----------
    force : ndarray, shape (3,)
        The sum of all forces between the bodies, zero if action is reaction.
    torque : ndarray, shape (3,)
        The sum of their torques, zero if they act along the lines between the bodies, besides.
    weak : bool
        Whether the force of each body on each other one is opposite to the other's on it.
    strong : bool
        Whether both lie along the line between them, too.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> along = np.zeros((2, 2, 3))
    >>> along[0, 1], along[1, 0] = [2.0, 0.0, 0.0], [-2.0, 0.0, 0.0]
    >>> audit = vv.audit.third_law([[0, 0, 0], [1.0, 0, 0]], along)
    >>> audit.weak, audit.strong
    (True, True)
    """

    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    weak: bool
    strong: bool


@known_keywords
def third_law(position: ArrayLike, forces: ArrayLike, *, rtol: float = 1e-12) -> ThirdLaw:
    """Newton's third law for forces between bodies, in its weak and in its strong form.

    Units: those of the forces, and of them times a length; `rtol` is without dimension.

    Parameters
    ----------
    position : array_like, shape (N, 3)
    forces : array_like, shape (N, N, 3)
        ``forces[i, j]`` is the force on body i by body j; nothing acts on itself.
    rtol : float
        What counts as zero beside the larger of two forces.

    Returns
    -------
    ThirdLaw

    Raises
    ------
    visviva.InvalidInput
        For a force of a body on itself.

    Notes
    -----
    Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> across = np.zeros((2, 2, 3))
    >>> across[0, 1], across[1, 0] = [0.5, 0.25, 2.0], [-0.5, -0.25, -2.0]
    >>> audit = vv.audit.third_law([[0, 0, 0], [1.0, 2.0, -1.0]], across)
    >>> audit.weak, audit.strong, audit.torque.tolist()
    (True, False, [-4.25, 2.5, 0.75])
    """
    x = float_array("position", position, (None, 3))
    f = float_array("forces", forces, (len(x), len(x), 3))
    rtol = positive("rtol", rtol)
    for i in range(len(x)):
        if f[i, i].any():
            raise InvalidInput("forces", f"expected no force of a body on itself, got forces[{i}, {i}] = {f[i, i]}")
    back = f.swapaxes(0, 1)
    apart = x[:, None] - x
    size = np.maximum(np.abs(f), np.abs(back)).max(axis=2)
    weak = bool((np.abs(f + back).max(axis=2) <= rtol * size).all())
    across = np.abs(np.cross(apart, f)).max(axis=2)
    # Far from the origin places themselves are rounded.
    known = rtol * np.abs(apart).max(axis=2) + 4.0 * np.finfo(float).eps * np.abs(x).max(initial=0.0)
    strong = weak and bool((across <= size * known).all())
    return ThirdLaw(f.sum(axis=(0, 1)), np.cross(x[:, None], f).sum(axis=(0, 1)), weak, strong)
