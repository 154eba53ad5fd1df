"""A system in generalized coordinates and a state of it: `States`, the base of all that is asked of either.

The one idea: a model of the core, values of its parameters, and a state; another start or other values share the model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number
from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva.errors import FrozenAttribute, InvalidInput
from visviva.generalized._source import Source, _label

if TYPE_CHECKING:
    from collections.abc import Mapping

    import sympy
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._ensemble import GeneralizedEnsemble
    from visviva.generalized._system import GeneralizedSystem
    from visviva.typing import ParameterValues

__all__ = ["States", "as_system"]


@known_keywords
class States(Shown):
    """Base of `GeneralizedSystem`: what it is made of, and the same system elsewhere."""

    __slots__ = (
        "_looks_at_start",
        "_model",
        "_projects",
        "_second",
        "_source",
        "_structure",
        "_values",
        "coordinates",
        "parameters",
        "position",
        "t0",
    )

    coordinates: tuple[str, ...]
    parameters: dict[str, float]
    position: NDArray[np.float64] | None
    t0: float
    _source: Source
    _model: _core.GeneralizedModel
    _values: NDArray[np.float64]
    _second: NDArray[np.float64]
    #: Whether starts are put on the constraints: ``consistent="project"``.
    _projects: bool
    #: What the core has found of the equations.
    _structure: dict[str, Any]
    #: How often the start was looked at: once will do, since it never changes.
    _looks_at_start: int

    #: What the second half of a state is called.
    _second_name = "velocity"

    def _prepare(
        self,
        source: Source,
        values: list[Any],
        state: tuple[ArrayLike | None, ArrayLike | None, float],
        model: _core.GeneralizedModel | None = None,
        projects: bool = False,
    ) -> None:
        position, second, t0 = state
        n = len(source.names)
        set_ = object.__setattr__
        set_(self, "_source", source)
        set_(self, "_projects", projects)
        set_(self, "coordinates", source.names)
        numbers = [
            number(f"parameters[{name!r}]", value) for name, value in zip(source.parameters, values, strict=True)
        ]
        set_(self, "parameters", dict(zip(source.parameters, numbers, strict=True)))
        set_(self, "_values", np.array(numbers, dtype=float))
        set_(self, "position", None if position is None else _frozen(float_array("position", position, (n,))))
        set_(self, "_second", _frozen(np.zeros(n) if second is None else float_array(self._second_name, second, (n,))))
        set_(self, "t0", number("t0", t0))
        set_(self, "_model", _core.GeneralizedModel(source.description) if model is None else model)
        set_(self, "_structure", self._model.structure())
        set_(self, "_looks_at_start", 0)

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenAttribute(name, f"a {type(self).__name__} is frozen; at({name}=…) makes another one")

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.position, self._second, self.t0)
        return _system_from_parts, (type(self), self._source, self._values.tolist(), state, self._projects)

    def __repr__(self) -> str:
        names = ", ".join(self.coordinates)
        return f"{type(self).__name__}({names}; {len(self.parameters)} parameters)"

    def _sheet(self) -> Sheet:
        values = ", ".join(f"{name} = {value:g}" for name, value in self.parameters.items())
        rows = [("coordinates", ", ".join(self.coordinates)), ("parameters", values)]
        if self.position is not None:
            rows.append(("position", ", ".join(f"{value:g}" for value in self.position)))
            rows.append((self._second_name, ", ".join(f"{value:g}" for value in self._second)))
        return Sheet(type(self).__name__, rows)

    def _constraints(self) -> int:
        description = self._source.description
        return len(description["holonomic"]) + len(description["nonholonomic"])

    def _check_start(self) -> None:
        """Refuse a start from which the equations have no meaning."""
        if not self._looks_at_start:
            self._look_at_start()
            object.__setattr__(self, "_looks_at_start", 1)

    def _look_at_start(self) -> None:
        """Refuse a start from which the equations have no meaning; `_check_start` asks once."""

    def at(
        self,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        momentum: ArrayLike | None = None,
        parameters: ParameterValues | None = None,
        t0: float | None = None,
    ) -> Self:
        """The same system from another start, or with other parameters; nothing is derived again.

        Units: those of the system.

        Parameters
        ----------
        position, velocity, momentum : array_like, shape (n,), optional
            The new start, with velocities or momenta: the ones follow from the others (see `legendre_transform`).
        parameters : dict, optional
            New values of some parameters.
        t0 : float, optional
            The time of the start.

        Returns
        -------
        Lagrangian or Hamiltonian
            Another one; `self` stays as it is. If that was made with ``consistent="project"``, the new start is put on
            the constraints, too.

        Raises
        ------
        InvalidInput
            For another shape, a parameter that is not there, velocities beside momenta, or those that do not follow.
        ConvergenceError
            Where a start to be put on the constraints comes to none.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum().at(position=[2.0]).position
        array([2.])
        >>> vv.systems.henon_heiles().at(momentum=[0.1, 0.2]).momentum
        array([0.1, 0.2])
        """
        own, other = (velocity, momentum) if self._second_name == "velocity" else (momentum, velocity)
        if other is None:
            return self._at(position, own, parameters, t0)._on_constraints()
        name = self._other(own)
        moved = self._at(position, None, parameters, t0)
        n = len(self.coordinates)
        transform = as_system(moved).legendre_transform()
        conjugate = transform.conjugate(moved._start()[:n], float_array(name, other, (n,)))
        return moved._at(None, conjugate)._on_constraints()

    def ensemble(
        self,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        momentum: ArrayLike | None = None,
        parameters: Mapping[str, ArrayLike] | Mapping[sympy.Symbol, ArrayLike] | None = None,
        consistent: Literal["project"] | None = None,
    ) -> GeneralizedEnsemble:
        """Many copies, from starts or with parameters of their own.

        Units: those of the system.

        Parameters
        ----------
        position, velocity, momentum : array_like, shape (B, n), optional
            The starts, with velocities or momenta as in `at`.
        parameters : dict, optional
            Values (B,) of some parameters.
        consistent : {"project"}, optional
            Puts starts that violate the constraints on them; a run refuses them otherwise. If not given, they are put
            there if the system was made with it.

        Returns
        -------
        GeneralizedEnsemble
            Of B copies.

        Raises
        ------
        InvalidInput
            For shapes that do not go together, parameters that are not there, or velocities beside momenta.
        ConvergenceError
            Where a start to be put on the constraints comes to none.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> many = vv.systems.pendulum().ensemble(position=np.linspace(0.1, 3.0, 30)[:, None])
        >>> many.run(t=10.0).position.shape
        (30, 2, 1)
        """
        own, other = (velocity, momentum) if self._second_name == "velocity" else (momentum, velocity)
        if other is not None:
            own = self._conjugates(position, self._other(own), other, parameters)
        from visviva.generalized._ensemble import GeneralizedEnsemble

        if consistent is None and self._projects:
            consistent = "project"
        return GeneralizedEnsemble(as_system(self), position, own, parameters, consistent)

    def _other(self, own: ArrayLike | None) -> str:
        """Give the name of what the second half of a state is not, unless both are given."""
        name = "momentum" if self._second_name == "velocity" else "velocity"
        if own is not None:
            raise InvalidInput(name, f"expected velocity or momentum, got both: the {name} follows from the other")
        return name

    def _conjugates(
        self, position: ArrayLike | None, name: str, other: ArrayLike, parameters: Mapping[Any, Any] | None
    ) -> NDArray[np.float64]:
        """Give velocities (B, n) of momenta, or momenta of velocities."""
        if parameters:
            raise InvalidInput(
                name, f"expected the {self._second_name} of copies with parameters of their own, which does not follow"
            )
        sizes: dict[str, tuple[int, str]] = {}
        n = len(self.coordinates)
        places = None if position is None else float_array("position", position, ("B", n), sizes)
        given = float_array(name, other, ("B", n), sizes)
        if places is None:
            places = np.broadcast_to(self._start()[:n], given.shape)
        return as_system(self).legendre_transform().conjugate(places, given)

    def _at(
        self,
        position: ArrayLike | None,
        second: ArrayLike | None,
        parameters: ParameterValues | None = None,
        t0: float | None = None,
    ) -> Self:
        other = object.__new__(type(self))
        state = (
            self.position if position is None else position,
            self._second if second is None else second,
            self.t0 if t0 is None else t0,
        )
        other._prepare(self._source, self._with_parameters(parameters), state, self._model, self._projects)
        return other

    def _on_constraints(self) -> Self:
        """Give the system at the nearest start on its constraints, where that was asked for when it was made."""
        if not self._projects or not self._constraints() or self.position is None:
            return self
        state = self._model.projected(self.t0, self._start(), self._values)[2]
        n = len(self.coordinates)
        return self._at(state[:n], state[n:])

    def _with_parameters(self, changed: Mapping[Any, Any] | None) -> list[Any]:
        values: dict[str, Any] = dict(self.parameters)
        if changed is not None and not hasattr(changed, "items"):
            kind = type(changed).__name__
            raise InvalidInput("parameters", f"expected values by parameter, as {{'l': 2.0}}, got {kind}")
        for key, value in (changed or {}).items():
            name = _label(key)
            if name not in values:
                raise InvalidInput("parameters", f"there is no parameter {name!r}; there are {list(values)}")
            values[name] = value
        return list(values.values())

    def _start(self) -> NDArray[np.float64]:
        if self.position is None:
            raise InvalidInput(
                "position", f"expected the coordinates {list(self.coordinates)} at the start; pass position=[…]"
            )
        return np.concatenate([self.position, self._second])


def as_system(states: States) -> GeneralizedSystem:
    """Give the states as the system that they are always part of."""
    system: Any = states
    found: GeneralizedSystem = system
    return found


def _system_from_parts(
    cls: type[States], source: Source, values: list[float], state: Any, projects: bool = False
) -> States:
    system = object.__new__(cls)
    system._prepare(source, values, state, projects=projects)
    return system


def _frozen(array: NDArray[np.float64]) -> NDArray[np.float64]:
    own = array.copy()
    own.flags.writeable = False
    return own
