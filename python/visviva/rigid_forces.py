"""Torques on the rigid bodies of a scene: constant, by a compiled function, and drag against turning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NoReturn, Self

import numpy as np

from visviva._body_force import BodyForce, Vector, body_of, not_negative, set_frozen, vector
from visviva._compiled import torque_address
from visviva._keywords import did_you_mean, known_keywords
from visviva._moves import orthogonal
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from visviva.typing import CompiledFunction

__all__ = ["AppliedTorque", "CompiledTorque", "RotationalDrag"]


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class AppliedTorque(BodyForce):
    """A constant torque, along axes of space or along those of the body.

    Units: those of the scene; a torque is mass · length² / time².

    Parameters
    ----------
    torque : array_like, shape (3,)
        The torque; about the fixed point of a body that has one.
    body : int or str, optional
        The rigid body; all of them, each with this torque, if not given.
    frame : {"space", "body"}, optional
        Along whose axes it is.

    Raises
    ------
    visviva.InvalidInput
        For NaN or infinity, another shape, or another frame.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.5 (Euler's equations).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.AppliedTorque([0.0, 0.0, 2.0], body="wheel", frame="body")
    AppliedTorque(torque=(0.0, 0.0, 2.0), body='wheel', frame='body')
    """

    kind: ClassVar[str] = "applied_torque"
    _dimensions = {"torque": (2, 1, -2)}  # noqa: RUF012 — a ClassVar of the base

    torque: Vector
    body: int | str | None
    frame: Literal["space", "body"]

    def __init__(
        self, torque: ArrayLike, body: int | str | None = None, frame: Literal["space", "body"] = "space"
    ) -> None:
        if callable(torque):
            raise InvalidInput(
                "torque",
                "expected three numbers, got a function; a torque of the time and the state is "
                "vv.ExpressionTorque(function), or vv.CompiledTorque(function) of a compiled one",
            )
        set_frozen(self, torque=vector("torque", torque), body=body_of("body", body), frame=frame)
        if not isinstance(frame, str) or frame not in ("space", "body"):
            hint = did_you_mean(str(frame), ("space", "body"))
            raise InvalidInput("frame", f"expected 'space' or 'body', got {frame!r}{hint}")

    def rotated(self, rotation: ArrayLike) -> Self:
        """The torque turned with space, or as it is in the body; an axial vector.

        Units: the matrix is without dimension.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix; of determinant −1 a reflection.

        Returns
        -------
        AppliedTorque

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        >>> vv.AppliedTorque([1.0, 0.0, 0.0]).rotated(quarter)
        AppliedTorque(torque=(0.0, 1.0, 0.0), body=None, frame='space')
        """
        matrix = orthogonal(rotation)
        if self.frame == "body":
            return self
        return self._with(torque=np.sign(np.linalg.det(matrix)) * matrix @ np.array(self.torque))


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class RotationalDrag(BodyForce):
    """Drag against turning: the torque −coefficient ω.

    Units: those of the scene; `coefficient` is mass · length² / time.

    Parameters
    ----------
    coefficient : float
        Not negative.
    body : int or str, optional
        The rigid body; all of them if not given.

    Raises
    ------
    visviva.InvalidInput
        For a negative number, NaN or infinity.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.5 (Euler's equations).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.RotationalDrag(0.1, body=0)
    RotationalDrag(coefficient=0.1, body=0)
    """

    kind: ClassVar[str] = "rotational_drag"
    _dimensions = {"coefficient": (2, 1, -1)}  # noqa: RUF012
    _one_way = "drag takes energy away, run backward it would bring some"

    coefficient: float
    body: int | str | None

    def __init__(self, coefficient: float, body: int | str | None = None) -> None:
        set_frozen(self, coefficient=not_negative("coefficient", coefficient), body=body_of("body", body))


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class CompiledTorque(BodyForce):
    """A torque by a compiled function of the time, the orientation and the angular velocity.

    Units: those of the scene; angular velocities in radians per time.

    Parameters
    ----------
    function : int, numba CFunc, ctypes function or scipy.LowLevelCallable
        ``void f(double t, const double *orientation, const double *angular_velocity, double *torque)``, or its address:
        the quaternion (x, y, z, w) from the body to space and the angular velocity along the body's axes are read, the
        torque along the axes of space, about the center of mass or the fixed point, is written.
    body : int or str, optional
        The rigid body; all of them, one after another, if not given.

    Raises
    ------
    visviva.InvalidInput
        For what is no compiled function, or one of another signature.

    Notes
    -----
    It is called from several threads at once and must keep nothing from call to call. A compiled function is at its
    address in this process only: it can be neither pickled nor saved.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.5 (Euler's equations).

    Examples
    --------
    >>> import ctypes, visviva as vv
    >>> numbers = ctypes.POINTER(ctypes.c_double)
    >>> @ctypes.CFUNCTYPE(None, ctypes.c_double, numbers, numbers, numbers)
    ... def motor(t, orientation, angular_velocity, torque):
    ...     torque[0], torque[1], torque[2] = 0.0, 0.0, 0.5 - 0.1 * angular_velocity[2]
    >>> vv.CompiledTorque(motor, body=0).body
    0
    """

    kind: ClassVar[str] = "compiled_torque"
    _dimensions = {}  # noqa: RUF012
    _one_way = "a function has no known reverse"

    function: CompiledFunction
    body: int | str | None

    def __init__(self, function: CompiledFunction, body: int | str | None = None) -> None:
        torque_address(function)
        set_frozen(self, function=function, body=body_of("body", body))

    @property
    def address(self) -> int:
        """Where the function is.

        Examples
        --------
        >>> import visviva as vv
        >>> import ctypes
        >>> numbers = ctypes.POINTER(ctypes.c_double)
        >>> @ctypes.CFUNCTYPE(None, ctypes.c_double, numbers, numbers, numbers)
        ... def motor(t, orientation, angular_velocity, torque):
        ...     torque[0], torque[1], torque[2] = 0.0, 0.0, 0.5
        >>> vv.CompiledTorque(motor, body=0).address == ctypes.cast(motor, ctypes.c_void_p).value
        True
        """
        return torque_address(self.function)

    def _core_arguments(self) -> dict[str, Any]:
        """What the core takes, the address in the place of the function, which has to be kept as long as it is used."""
        known = BodyForce._core_arguments(self)
        return {"kind": self.kind, "address": self.address, "body": known["body"]}

    def rotated(self, rotation: ArrayLike) -> Self:
        """Refuse: the function is of the axes of space that it was written for.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            As of other torques, without dimension.

        Returns
        -------
        CompiledTorque
            Itself, for the matrix that turns nothing.

        Raises
        ------
        visviva.InvalidInput
            For every other one.
        """
        if np.array_equal(orthogonal(rotation), np.eye(3)):
            return self
        raise InvalidInput("forces", "CompiledTorque cannot be rotated: what it computes is along the axes it knows")

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """Refuse: the function computes in its own units.

        Parameters
        ----------
        length, mass, time : float, optional
            What one old unit is in new ones; positive.

        Returns
        -------
        CompiledTorque
            Itself, where no unit is another.

        Raises
        ------
        visviva.InvalidInput
            Where one is.
        """
        if (length, mass, time) == (1.0, 1.0, 1.0):
            return self
        raise InvalidInput("forces", "CompiledTorque cannot be rescaled: it computes in units of its own")

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __reduce__(self) -> NoReturn:
        raise InvalidInput(
            "function", "a compiled function is at its address in this process only: it cannot be pickled"
        )


def __dir__() -> list[str]:
    return list(__all__)
