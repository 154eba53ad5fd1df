"""Forces: what acts on the particles, one class for each that the core has registered.

The classes are made from the core's registry, so a force that is added there (one file, one line) appears here with its
parameters, its documentation, its files and its tests. `forces.pyi` spells them out for editors and type checkers;
`tools/write_stubs.py` writes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from visviva import _core
from visviva._declared import Declared, class_from_entry
from visviva._keywords import known_keywords, refuse_subclass, unknown_name
from visviva._moves import displacement, orthogonal
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@known_keywords
class Force(Declared):
    """What every force has: frozen parameters, and how they change with the frame and the units.

    Frozen, hashable and picklable. A force of one's own is added to the core: docs/how-to/add-a-force.md.

    Attributes
    ----------
    kind : str
        What it is called in files.

    Examples
    --------
    >>> import visviva as vv
    >>> isinstance(vv.Gravity(1.0), vv.forces.Force)
    True
    """

    __slots__ = ()

    _no_sum = "forces are not added; give a scene several, as Scene(particles, a, b), where they add up"

    def __init__(self) -> None:
        """Refuse: kinds of it have parameters, and say how to act."""
        raise InvalidInput("Force", "expected one of its kinds, as Gravity(G=1.0) or Harmonic(k=1.0), got Force itself")

    def __init_subclass__(cls, **arguments: Any) -> None:
        super().__init_subclass__(**arguments)
        if "_parameters" not in vars(cls):
            refuse_subclass(cls, "forces are described in it, one file each: docs/how-to/add-a-force.md")

    def shifted(self, position: ArrayLike, velocity: ArrayLike) -> Self:
        """The force as it acts on bodies displaced by ``position`` (3,) and boosted by ``velocity`` (3,).

        Units: those of the scene.

        Parameters
        ----------
        position, velocity : array_like, shape (3,)
            By what is displaced, and boosted.

        Returns
        -------
        Force
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            For what are not three numbers each; for a boost, if the force has a place or a medium at rest, which would
            move.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> vv.Harmonic(2.0).shifted(np.array([1.0, 0.0, 0.0]), np.zeros(3))
        Harmonic(k=2.0, center=(1.0, 0.0, 0.0))
        """
        moved_by, boost = displacement(position, velocity)
        points = [p.name for p in self._parameters if p.kind == "point"]
        if boost.any() and self._at_rest:
            advice = ", or let a heavy body be the center" if points else ""
            raise InvalidInput(
                "velocity",
                f"{type(self).__name__} has a fixed {self._at_rest}, which would move in the boosted frame; "
                f"shift the position only{advice}",
            )
        moved = {name: np.add(getattr(self, name), moved_by) for name in points}
        return type(self)(**(self._values() | moved)) if moved else self

    def _resolved(self, names: tuple[str, ...], count: int) -> Self:
        """The force with indices in place of the names of bodies, as a scene of so many keeps it."""
        named = [p for p in self._parameters if p.kind == "indices" and isinstance(getattr(self, p.name), str | tuple)]
        found = {p.name: p.resolved(getattr(self, p.name), names, count) for p in named}
        return type(self)(**(self._values() | found)) if found else self

    def rotated(self, rotation: ArrayLike) -> Self:
        """The force as it acts on bodies turned (or reflected) by an orthogonal matrix (3, 3).

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix, without dimension; of determinant −1 a reflection.

        Returns
        -------
        Force
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        >>> vv.UniformField([1.0, 0.0, 0.0]).rotated(quarter)
        UniformField(g=(0.0, 1.0, 0.0))
        """
        matrix = orthogonal(rotation)
        turned = {
            p.name: matrix @ np.array(getattr(self, p.name))
            for p in self._parameters
            if p.kind in ("vector", "direction", "point")
        }
        axial = np.sign(np.linalg.det(matrix)) * matrix
        turned |= {
            p.name: axial @ np.array(getattr(self, p.name)) for p in self._parameters if p.kind == "axial_vector"
        }
        return type(self)(**(self._values() | turned)) if turned else self

    def reversed(self) -> Self:
        """The force under which bodies with reversed velocities retrace their path.

        Returns
        -------
        Force
            With the same parameters where velocities do not enter, else with the signs that reversal gives them.

        Raises
        ------
        visviva.InvalidInput
            If there is none: for drag, or a force that goes on with time.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.Gravity(1.0).reversed()
        Gravity(G=1.0, softening=0.0)
        >>> vv.UniformMagneticField([0.0, 0.0, 1.0]).reversed()
        UniformMagneticField(B=(-0.0, -0.0, -1.0), charge=1.0)
        """
        if self._one_way:
            raise InvalidInput("forces", f"{type(self).__name__} cannot be reversed: {self._one_way}")
        axial = {p.name: np.negative(getattr(self, p.name)) for p in self._parameters if p.kind == "axial_vector"}
        return type(self)(**(self._values() | axial)) if axial else self

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """The force in units of which ``length``, ``mass`` and ``time`` make one old unit.

        Parameters
        ----------
        length, mass, time : float
            What one old unit is in new ones; positive.

        Returns
        -------
        Force
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.UniformField([0.0, 0.0, -9.5]).rescaled(length=100.0)
        UniformField(g=(0.0, 0.0, -950.0))
        """
        return self._rescaled(length, mass, time)


def _formula_of(force: Any) -> str:
    from visviva.expression_force import formula_of  # which needs this module

    return formula_of(force)


def _in_units_that_fit(force: Any) -> None:
    Force.__post_init__(force)
    from visviva.expression_force import check_units  # which needs this module

    check_units(force)


# What a class has beside what is declared.
_FURTHER: dict[str, dict[str, Any]] = {
    "expressed_force": {
        "__repr__": _formula_of,
        "__post_init__": _in_units_that_fit,
        "_checked_together": ("length", "mass", "time"),
    }
}
_BY_NAME = {
    entry["name"]: class_from_entry(entry, Force, __name__, _FURTHER.get(entry["name"], {})) for entry in _core.forces()
}
_CLASSES = {made.__name__: made for made in _BY_NAME.values()}
globals().update(_CLASSES)
__all__ = ["Force"]
__all__ += list(_CLASSES)


def force_from_core(description: dict[str, Any]) -> Force:
    """The force of a dictionary made by ``_to_core``; used when a file is loaded."""
    kind = description["kind"]
    if kind not in _BY_NAME:
        raise InvalidInput(
            "path", f"the file holds a force {kind!r} that this version does not know; use a newer visviva"
        )
    if isinstance(description.get("potential"), str):
        # As the first version wrote it: the potential's name and its parameters, side by side.
        from visviva.potentials import potential_by_name

        potential = potential_by_name(description["potential"], description["parameters"])
        description = description | {"potential": potential._to_core()}
    found: Force = _BY_NAME[kind]._from_core(description)
    return found


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
