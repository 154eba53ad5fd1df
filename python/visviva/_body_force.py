"""What all forces on rigid bodies have in common.

The one idea: each is a frozen description with plain values. A scene puts indices in the place of names; the core takes
the values by name.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, cast

import numpy as np

from visviva._arrays import float_array, number, positive, whole_number
from visviva._declared import unit_change
from visviva._keywords import known_keywords, refuse_subclass
from visviva._moves import displacement, orthogonal
from visviva._names import body_index
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import NoReturn

    from _typeshed import DataclassInstance
    from numpy.typing import ArrayLike

__all__ = ["BodyForce", "Vector", "body_of", "not_negative", "set_frozen", "vector"]

Vector: TypeAlias = tuple[float, float, float]


@known_keywords
class BodyForce:
    """What every force on rigid bodies has: frozen values, and how they change with the frame and the units.

    Bodies are counted from 0 among the rigid bodies of a scene, or named.

    Attributes
    ----------
    kind : str
        What it is called in files.

    Examples
    --------
    >>> import visviva as vv
    >>> isinstance(vv.RotationalDrag(0.5), vv.rigid.BodyForce)
    True
    """

    __slots__ = ()

    kind: ClassVar[str]
    # What brings each value to other units: exponents of length, mass and time.
    _dimensions: ClassVar[dict[str, tuple[int, int, int]]]
    # Which of its values name bodies, and of what: rigid bodies or particles.
    _bodies: ClassVar[dict[str, Literal["bodies", "particles"]]] = {"body": "bodies"}
    _one_way: ClassVar[str] = ""

    def __init_subclass__(cls, **arguments: Any) -> None:
        super().__init_subclass__(**arguments)
        refuse_subclass(cls, "a custom torque is an ExpressionTorque, or a CompiledTorque")

    if not TYPE_CHECKING:  # to which there is no sum of them

        def __add__(self, other: object) -> NoReturn:
            raise TypeError(
                f"{type(self).__name__}: forces on rigid bodies are not added; give a scene a list of them, as "
                "Scene(body, [a, b]), where they add up"
            )

        __radd__ = __add__

    def _values(self) -> dict[str, Any]:
        return {each.name: getattr(self, each.name) for each in fields(cast("DataclassInstance", self))}

    def _with(self, **changes: Any) -> Self:
        return type(self)(**(self._values() | changes))

    def _differing(self) -> dict[str, Any]:
        """What may differ from copy to copy of an ensemble, by name."""
        return {name: getattr(self, name) for name in self._dimensions}

    def _of_copy(self, own: Mapping[str, Any]) -> Self:
        """The force with values that a copy has of its own."""
        return self._with(**own)

    def _core_arguments(self) -> dict[str, Any]:
        """What the core takes: the kind and every value by name, vectors as arrays of shape (3,).

        Raises
        ------
        visviva.InvalidInput
            For a body that is given by name, outside a scene.

        Examples
        --------
        >>> import visviva as vv
        >>> sorted(vv.AppliedTorque([0.0, 0.0, 2.0], body=0)._core_arguments())
        ['body', 'frame', 'kind', 'torque']
        """
        for name in self._bodies:
            if isinstance(given := getattr(self, name), str):
                raise InvalidInput(name, f"expected the index of a body outside a scene, got {given!r}")
        values = {name: np.array(v) if isinstance(v, tuple) else v for name, v in self._values().items()}
        return {"kind": self.kind} | values

    def _resolved(self, bodies: tuple[tuple[str, ...], int], particles: tuple[tuple[str, ...], int]) -> Self:
        """The force with indices in place of names, as a scene keeps it; known are names and numbers of both."""
        if not bodies[1]:
            raise InvalidInput(
                "forces", f"expected rigid bodies in the scene for {type(self).__name__} to act on, got none"
            )
        known = {"bodies": bodies, "particles": particles}
        given = {name: (getattr(self, name), *known[of]) for name, of in self._bodies.items()}
        return self._with(**{name: _checked_index(name, *each) for name, each in given.items() if each[0] is not None})

    def shifted(self, position: ArrayLike, velocity: ArrayLike) -> Self:
        """The force as it acts on bodies displaced by ``position`` (3,) and boosted by ``velocity`` (3,).

        Parameters
        ----------
        position, velocity : array_like, shape (3,)
            By what is displaced, and boosted, in the units of the scene.

        Returns
        -------
        BodyForce
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            For what are not three numbers each; for a boost, if the force has a fixed place, which would move.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> vv.RotationalDrag(0.5).shifted(np.array([1.0, 0.0, 0.0]), np.zeros(3))
        RotationalDrag(coefficient=0.5, body=None)
        """
        displacement(position, velocity)
        return self

    def rotated(self, rotation: ArrayLike) -> Self:
        """The force as it acts on bodies turned (or reflected) by an orthogonal matrix (3, 3).

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix, without dimension; of determinant −1 a reflection.

        Returns
        -------
        BodyForce
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal; for a compiled function, which knows the axes that it was written for.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> vv.RotationalDrag(0.5).rotated(np.diag([1.0, -1.0, 1.0]))
        RotationalDrag(coefficient=0.5, body=None)
        """
        orthogonal(rotation)
        return self

    def reversed(self) -> Self:
        """The force under which bodies with their motion turned round retrace their path.

        Returns
        -------
        BodyForce
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            If there is none: for drag, damping, or a compiled function.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.AppliedTorque([0.0, 0.0, 2.0]).reversed()
        AppliedTorque(torque=(0.0, 0.0, 2.0), body=None, frame='space')
        """
        if self._one_way:
            raise InvalidInput("forces", f"{type(self).__name__} cannot be reversed: {self._one_way}")
        return self

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """The force in units of which ``length``, ``mass`` and ``time`` make one old unit.

        Parameters
        ----------
        length, mass, time : float
            What one old unit is in new ones; positive.

        Returns
        -------
        BodyForce
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.RotationalDrag(0.5).rescaled(length=10.0)
        RotationalDrag(coefficient=50.0, body=None)
        """
        named = (("length", length), ("mass", mass), ("time", time))
        scales = tuple(positive(unit, scale, "number of new units per old one") for unit, scale in named)
        new = {}
        for name, powers in self._dimensions.items():
            change, old = unit_change(name, powers, scales), getattr(self, name)
            new[name] = tuple(map(change, old)) if isinstance(old, tuple) else old if old is None else change(old)
        return self._with(**new)


def set_frozen(force: BodyForce, **values: Any) -> None:
    """Set the values of a frozen force, when it is made."""
    for name, value in values.items():
        object.__setattr__(force, name, value)


def vector(name: str, value: object) -> Vector:
    """Three numbers."""
    x, y, z = float_array(name, value, (3,)).tolist()
    return x, y, z


def not_negative(name: str, value: object) -> float:
    """A number of at least 0."""
    checked = number(name, value)
    if checked < 0.0:
        raise InvalidInput(name, f"expected a number of at least 0, got {checked!r}")
    return checked


def body_of(name: str, value: object) -> int | str | None:
    """The index or the name of a body, if one is given."""
    return value if value is None or isinstance(value, str) else whole_number(name, value, low=0)


def _checked_index(argument: str, value: object, names: tuple[str, ...], count: int) -> int:
    """The index of a body that is there."""
    what = "particles" if argument == "particle" else "rigid bodies"
    if not count:
        raise InvalidInput(argument, f"expected {what} in the scene, which has none")
    if isinstance(value, int) and value >= count:
        raise InvalidInput(argument, f"expected one of the {count} {what} of the scene, counted from 0, got {value}")
    return body_index(argument, value, names, count)
