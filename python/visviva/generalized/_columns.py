"""The columns of runs in generalized coordinates, alike for one and for an ensemble.

The one idea: a run keeps states, which are coordinates and one of velocities and momenta. The other, the energy and the
reactions are computed from them when they are first asked for, all in one call of the core.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._attributes_elsewhere import OF_RUNS
from visviva._exported import Columns, chosen_columns
from visviva._keywords import did_you_mean
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["StateColumns", "exported"]

_OF_STATES = {
    "q": "position",
    "qdot": "velocity",
    "x": "position",
    "theta": "position",
    "H": "energy",
    "E": "energy",
    "multipliers": "reactions, the forces of constraints",
    "constraint_forces": "reactions",
}
_HAVE_SYSTEMS = ("system", "ensemble")


class StateColumns:
    """Base of what has states, as the last axis of an array."""

    __slots__ = ()

    _states: NDArray[np.float64]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            # What is unpickled has no system yet.
            advice = "" if name.startswith("_") or name in _HAVE_SYSTEMS else self._elsewhere(name)
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}{advice}", name=name, obj=self
            )

    def __setstate__(self, state: tuple[None, dict[str, Any]]) -> None:
        # Arrays that were pickled or copied would be writable.
        for name, value in state[1].items():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
            setattr(self, name, value)

    def _elsewhere(self, name: str) -> str:
        if name in self._whose.coordinates:
            return f"; it is out[{name!r}]"
        here = _OF_STATES.get(name, OF_RUNS.get(name, ""))
        first = re.match(r"\w+", here)
        return f"; it is {here}" if first and hasattr(type(self), first[0]) else ""

    def _no_coordinate(self, name: object) -> InvalidInput:
        names = self._whose.coordinates
        label = getattr(getattr(name, "func", None), "__name__", "")
        if label in names:
            hint = f"; give its name, out[{label!r}]"
        elif isinstance(name, str):
            hint = f"; it is out.{name}" if name in dir(type(self)) else did_you_mean(name, names)
        else:
            hint = ""
        return InvalidInput("name", f"there is no coordinate {name!r}; there are {list(names)}{hint}")

    @property
    @abstractmethod
    def _whose(self) -> GeneralizedSystem:
        """The system that was run."""

    @abstractmethod
    def _column(self, first: int, last: int | None) -> NDArray[np.float64]:
        """Of what is computed from states these numbers, as the last axis."""

    @property
    def _n(self) -> int:
        return len(self._whose.coordinates)

    @property
    def position(self) -> NDArray[np.float64]:
        """Coordinates, shape (T, n), or (B, T, n) of an ensemble, in the units of the system."""
        return self._states[..., : self._n]

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities, shape (T, n), or (B, T, n), in the units of the system; of a Hamiltonian ∂H/∂p.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum(position=[0.5]).run(t=[0.0, 1.0])
        >>> out.velocity.shape
        (2, 1)
        >>> vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0).velocity.shape
        (2, 2, 1)
        """
        lagrangian = self._whose._source.kind == "lagrangian"
        return self._states[..., self._n :] if lagrangian else self._column(0, self._n)

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Momenta, shape (T, n), or (B, T, n), in the units of the system; of a Lagrangian ∂L/∂q̇.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum(position=[0.5]).run(t=[0.0, 1.0])
        >>> out.momentum.shape
        (2, 1)
        >>> vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0).momentum.shape
        (2, 2, 1)
        """
        hamiltonian = self._whose._source.kind == "hamiltonian"
        return self._states[..., self._n :] if hamiltonian else self._column(0, self._n)

    @property
    def energy(self) -> NDArray[np.float64]:
        """Jacobi's integral, or H, shape (T,), or (B, T), in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum(position=[0.5]).run(t=[0.0, 1.0])
        >>> out.energy.round(9)
        array([-8.60908493, -8.60908493])
        >>> vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0).energy.round(6)
        array([[-9.760991, -9.760991],
               [-9.614453, -9.614453]])
        """
        return self._column(self._n, self._n + 1)[..., 0]

    @property
    def reactions(self) -> NDArray[np.float64]:
        """Multipliers of the constraints, shape (T, c), or (B, T, c), in units of energy over those of the constraint.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.atwood(m1=3.0, m2=2.0, g=10.0).run(t=0.5).reactions[-1].round(12)
        array([-24.])
        >>> vv.systems.atwood().ensemble(parameters={"m1": [2.0, 3.0]}).run(t=0.2).reactions[:, 0].round(6)
        array([[-13.08 ],
               [-14.715]])
        """
        return self._column(self._n + 1, None)


def exported(
    run: Any, columns: str | Sequence[str] | None, rows: tuple[str, ...], coordinates: Sequence[str]
) -> Columns:
    """The columns of a run, or of an ensemble of them, over time, coordinates and constraints."""
    known = ["position", "velocity", "momentum", "energy", "reactions"]
    # Without constraints there are no reactions to show, unless somebody asks.
    usual = known if run.reactions.shape[-1] else known[:-1]
    over = {"energy": (), "reactions": ("constraint",)}
    of = {
        name: ((*rows, *over.get(name, ("coordinate",))), getattr(run, name))
        for name in chosen_columns(columns, usual, known)
    }
    axes = {"time": run.t, "coordinate": np.array(coordinates), "constraint": np.arange(run.reactions.shape[-1])}
    return Columns(axes, of)
