"""What rigid bodies are made from: principal axes, unit quaternions and fixed points, checked body by body."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._names import body_label
from visviva.errors import InvalidInput
from visviva.rigid._inertia import parallel_axis, principal_axes
from visviva.rigid._orientation import quaternion_from_matrix, rotate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from visviva._arrays import Sizes
    from visviva._body_force import BodyForce
    from visviva.rigid_bodies import RigidBodies

__all__ = ["IDENTITY", "body_suffix", "pivots", "principal", "refuse_on_rods", "unit_quaternions"]

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])
# Principal moments of a tensor that rounding alone keeps from 0, relative to the largest.
_OF_A_ROD = 16.0 * np.finfo(float).eps
# How near to the axis of a rod is on it, relative to the distance along it.
_ON_AXIS = 1e-12


def principal(
    argument: str, given: NDArray[np.float64], mass: float, pivot: NDArray[np.float64] | None, of: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Principal moments of a body about its center of mass, or its fixed point, and the quaternion from their axes.

    Given are moments (3,) or a tensor (3, 3) about the center; where the tensor is diagonal the axes are the body's
    own, whatever the order of the moments.

    Raises
    ------
    InvalidInput
        For moments or a tensor of no body.
    """
    try:
        _check_moments(given if given.ndim == 1 else principal_axes(given).moments)
    except InvalidInput as error:
        raise InvalidInput(argument, error.message.replace("tensor[", f"{argument}[") + of) from None
    tensor = np.diag(given) if given.ndim == 1 else given
    if pivot is not None:
        tensor = parallel_axis(tensor, mass, pivot)
        if not np.isfinite(tensor).all():
            raise InvalidInput("pivot", f"expected moments about it within float64{of}; choose other units")
    if not (tensor - np.diag(np.diag(tensor))).any():
        return np.diag(tensor).copy(), IDENTITY
    moments, axes = principal_axes(tensor)
    return np.where(moments <= _OF_A_ROD * moments[2], 0.0, moments), quaternion_from_matrix(axes)


def body_suffix(body: int, number: int, names: tuple[str, ...]) -> str:
    """The end of a message about one of several bodies."""
    return f" ({body_label(body, names)})" if number > 1 else ""


def _check_moments(moments: NDArray[np.float64]) -> None:
    """Refuse what are no moments of a body, as everything of `visviva.rigid` does."""
    _core.free_rotation(moments, np.zeros(3), IDENTITY, np.zeros(0))


def unit_quaternions(turns: NDArray[np.float64], names: tuple[str, ...]) -> NDArray[np.float64]:
    """The quaternions, of length 1."""
    normalized = np.empty(turns.shape)
    for body, turn in enumerate(turns):
        try:
            normalized[body] = _core.rotation_form("normalized", turn[None])[0]
        except InvalidInput as error:
            raise InvalidInput("orientation", error.message + body_suffix(body, len(turns), names)) from None
    return normalized


def pivots(given: Any, sizes: Sizes) -> NDArray[np.float64] | None:
    """The fixed points, with rows of NaN for free bodies; None if there is no other."""
    free = np.zeros(0, bool)
    try:
        array = np.asarray(given)
        if array.dtype.kind == "f" and array.ndim == 2:
            free = np.isnan(array).all(axis=-1)
            given = np.where(free[:, None], 0.0, array) if free.any() else given
    except ValueError:  # of rows that differ in length, which are refused below
        pass
    checked = float_array("pivot", given, ("K", 3), sizes)
    if free.all() and len(free) == len(checked):
        return None
    return np.where(free[:, None], np.nan, checked) if free.any() else checked.copy()


def refuse_on_rods(bodies: RigidBodies, loads: Sequence[BodyForce]) -> None:
    """Refuse what would turn a rod about its own axis, about which it has no moment and does not turn.

    Raises
    ------
    InvalidInput
        For a torque along the body's axes, or a point of a spring, that is not across or on the axis of a rod.
    """
    for body, moments in enumerate(bodies.principal_moments):
        if moments.all():
            continue
        axis = rotate(bodies.axes[body], np.where(moments == 0.0, 1.0, 0.0))
        of = f"the axis of {body_label(body, bodies.names)}, a rod, which does not turn about it"
        for load in loads:
            known = load._values()
            if known["body"] in (None, body) and known.get("frame") == "body":
                along = abs(float(axis @ known["torque"]))
                if along > _ON_AXIS * np.abs(known["torque"]).max():
                    raise InvalidInput("torque", f"expected a torque across {of}, got {known['torque']}")
            for end, point in (("body", "point"), ("to", "to_point")):
                if point in known and known[end] == body:
                    off = np.abs(known[point] - (axis @ known[point]) * axis).max()
                    if off > _ON_AXIS * np.abs(known[point]).max():
                        raise InvalidInput(point, f"expected a point on {of}, got {known[point]}")
