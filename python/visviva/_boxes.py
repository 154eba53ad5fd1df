"""Rigid bodies as moving pictures show them: the homogeneous box that has the same mass and moments.

The one idea: a box of half-edges a, b, c and mass m has I_x = m (b² + c²)/3, so a² = 3 (I_y + I_z − I_x)/(2 m); every
rigid body has one, flat where one moment is the sum of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._animation import Places, animate_places
from visviva.errors import InvalidInput
from visviva.plot import directions
from visviva.rigid._orientation import matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.animation import FuncAnimation
    from numpy.typing import ArrayLike, NDArray

    from visviva.body_turning import BodyTurning
    from visviva.rigid._free import FreeRotation
    from visviva.trajectory import Trajectory

__all__ = ["animate_turning", "boxes", "half_edges"]

# A way along all twelve edges of a cube, from corner to corner: three of them are gone over twice.
_CORNERS = (
    0b000,
    0b100,
    0b110,
    0b010,
    0b000,
    0b001,
    0b101,
    0b100,
    0b101,
    0b111,
    0b110,
    0b111,
    0b011,
    0b010,
    0b011,
    0b001,
)
_OUTLINE = np.array([[2.0 * (corner >> at & 1) - 1.0 for at in (2, 1, 0)] for corner in _CORNERS])


def half_edges(moments: ArrayLike, mass: float) -> NDArray[np.float64]:
    """Half the edges of the box with these principal moments about its center, shape (3,)."""
    given = np.asarray(moments, dtype=np.float64)
    squares: NDArray[np.float64] = np.maximum(1.5 * (given.sum() - 2.0 * given) / mass, 0.0)
    return np.sqrt(squares)


def boxes(trajectory: Trajectory, bodies: Sequence[int]) -> NDArray[np.float64] | None:
    """The outlines of the rigid bodies among these, one after the other, shape (T, K, 3); NaN between two lines.

    From the fixed point of a body, which its box need not reach, a line goes to its center.
    """
    rigid = trajectory.scene.rigid_bodies
    if rigid is None or "orientation" not in trajectory.recorded:
        return None
    first = len(trajectory.scene.particles) - len(rigid)
    lines = []
    for body in bodies:
        if body < first:
            continue
        at = body - first
        if rigid.moments is not None:
            moments, axes = rigid.moments[at], np.eye(3)
        else:
            moments, axes = np.linalg.eigh(np.asarray(rigid.inertia)[at])
        outline = (_OUTLINE * half_edges(moments, float(rigid.mass[at]))) @ axes.T
        gap = np.full((1, 3), np.nan)
        if rigid.pivoted[at] and rigid.pivot is not None:
            outline = np.concatenate([outline, gap, np.zeros((1, 3)), rigid.pivot[at][None]])
        turned = np.concatenate([outline, gap]) @ np.swapaxes(matrix(trajectory.orientation[:, at]), -1, -2)
        lines.append(turned + trajectory.position[:, body, None])
    return np.concatenate(lines, axis=1) if lines else None


def animate_turning(motion: FreeRotation | BodyTurning, path: Any, plane: object, how: dict[str, Any]) -> FuncAnimation:
    """As `FreeRotation.animate`."""
    if motion.t.ndim != 1 or not len(motion.t):
        raise InvalidInput("animate", f"expected a path along several times, got t of shape {motion.t.shape}")
    order = np.argsort(motion.t, kind="stable")
    turns = matrix(motion.orientation[order])
    half = half_edges(motion.moments, 1.0)
    # The corners on the unit sphere, as the ends of the axes are.
    outline = _OUTLINE * half / np.linalg.norm(half)
    gap, center = np.full((1, 3), np.nan), np.zeros((1, 3))
    outlines = [outline, *(each for axis in np.eye(3) for each in (gap, center, axis[None]))]
    lines = np.concatenate(outlines) @ np.swapaxes(turns, -1, -2)
    tips = np.swapaxes(turns, -1, -2)
    shown = directions(tips, "xyz" if plane is None else plane)
    return animate_places(Places(motion.t[order], tips, ("x", "y", "z"), lines), path, shown=shown, **how)


def __dir__() -> list[str]:
    return list(__all__)
