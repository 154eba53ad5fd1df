"""One rigid body of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, positive
from visviva._elsewhere import SOLID
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._arguments import checked_rows
from visviva.rigid._mass import MassProperties
from visviva.rigid_bodies import RigidBodies

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["RigidBody"]


@known_keywords
def RigidBody(  # noqa: N802
    mass: float,
    moments: ArrayLike | None = None,
    inertia: ArrayLike | None = None,
    position: ArrayLike = (0.0, 0.0, 0.0),
    velocity: ArrayLike = (0.0, 0.0, 0.0),
    orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    pivot: ArrayLike | None = None,
    name: str | None = None,
) -> RigidBodies:
    """One rigid body, as `RigidBodies` of one: every argument without its first axis.

    Units: those of the scene.

    Parameters
    ----------
    mass : float
        Positive.
    moments : array_like, shape (3,), optional
        Principal moments of inertia about the center of mass; the body's axes are then its principal ones.
    inertia : array_like, shape (3, 3), optional
        The inertia tensor about the center of mass, in place of `moments`.
    position, velocity : array_like, shape (3,), optional
        Of the center of mass. The velocity of a body with a fixed point follows from its spin.
    orientation : array_like, shape (4,), optional
        The quaternion (x, y, z, w) from the body to space.
    angular_velocity : array_like, shape (3,), optional
        Along the body's axes.
    pivot : array_like, shape (3,), optional
        Where in the body the point is that is fixed in space, from the center of mass; a free body has none.
    name : str, optional
        Its name.

    Returns
    -------
    RigidBodies
        Of one body.

    Raises
    ------
    visviva.InvalidInput
        As `RigidBodies`.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.3–5.5.

    Examples
    --------
    >>> import visviva as vv
    >>> brick = vv.rigid.box(2.0, 0.1, 0.4, 0.9)
    >>> vv.RigidBody(brick.mass, inertia=brick.tensor, angular_velocity=[0.1, 5.0, 0.1], name="brick")
    RigidBodies(1 body: brick)
    """
    if name is not None and not (isinstance(name, str) and name.strip()):
        raise InvalidInput("name", f"expected a text that is not empty, got {name!r}")
    _refuse_what_is_meant_otherwise(mass, moments, inertia, orientation)
    turn = checked_rows("orientation", orientation, (4,))
    vectors = {"position": position, "velocity": velocity, "angular_velocity": angular_velocity}
    return RigidBodies(
        [positive("mass", mass, "mass")],
        None if moments is None else float_array("moments", moments, (3,))[None],
        None if inertia is None else float_array("inertia", inertia, (3, 3))[None],
        orientation=float_array("orientation", turn, (4,))[None],
        pivot=None if pivot is None else float_array("pivot", pivot, (3,))[None],
        names=None if name is None else [name],
        **{argument: float_array(argument, value, (3,))[None] for argument, value in vectors.items()},
    )


def _refuse_what_is_meant_otherwise(mass: object, moments: object, inertia: object, orientation: object) -> None:
    """Refuse what tells a body or a turn in another way, with what makes of it what is taken."""
    for argument, value in {"mass": mass, "moments": moments, "inertia": inertia}.items():
        if isinstance(value, MassProperties):
            raise InvalidInput(argument, f"expected numbers, got a solid; {SOLID}")
    if _shape(inertia) == (3,):
        raise InvalidInput("inertia", "expected shape (3, 3), got (3,); give principal moments as moments")
    shape = _shape(orientation)
    if shape in ((3, 3), (3,)):
        made = "matrix" if len(shape) == 2 else "euler"
        raise InvalidInput(
            "orientation",
            f"expected a quaternion (x, y, z, w), got shape {shape}; vv.rigid.quaternion_from_{made} makes one",
        )


def _shape(value: Any) -> tuple[int, ...]:
    try:
        return np.shape(value)
    except ValueError:  # of rows that differ in length, which are refused where they are read
        return ()


def __dir__() -> list[str]:
    return list(__all__)
