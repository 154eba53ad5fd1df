"""What Lagrangians and Hamiltonians share, beside a state (`States`) and runs (`Runs`): what is found on the graph."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._attributes_elsewhere import OF_SYSTEMS, no_attribute
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._flow import Flow
from visviva.generalized._runs import Runs
from visviva.generalized._symbolic import free_name, sympy, trees
from visviva.generalized._trajectory import check_run

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from visviva.generalized._nodes import Node
    from visviva.generalized._trajectory import GeneralizedTrajectory
    from visviva.typing import Formula

__all__ = ["GeneralizedSystem"]


@known_keywords
class GeneralizedSystem(Runs, Flow):
    """A mechanical system in generalized coordinates, and a state of it: base of `Lagrangian` and `Hamiltonian`.

    Units: those of the system, which are those of its parameters; angles in radians.

    Attributes
    ----------
    coordinates : tuple of str
        Names.
    parameters : dict of str to float
        Values; `at` changes them without deriving anything again.
    position : ndarray, shape (n,)
        Coordinates at the start.
    t0 : float
        The time there.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.4, § 2.7 and § 8.1.

    Examples
    --------
    >>> import visviva as vv
    >>> system = vv.systems.pendulum()
    >>> isinstance(system, vv.generalized.GeneralizedSystem), system.coordinates
    (True, ('theta',))
    """

    __slots__ = ()

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            first = re.match(r"\w+", OF_SYSTEMS.get(name, ""))
            # What a Lagrangian has a Hamiltonian may not have.
            no_attribute(OF_SYSTEMS if first and hasattr(type(self), first[0]) else {})(self, name)

    def __init__(self) -> None:
        """Refuse: it is made of a Lagrangian or a Hamiltonian."""
        raise InvalidInput(
            "GeneralizedSystem", "expected visviva.Lagrangian(L, …) or visviva.Hamiltonian(H, …), got their base itself"
        )

    @property
    def cyclic(self) -> list[str]:
        """Coordinates that nothing depends on: their momenta are conserved.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.spherical_pendulum().cyclic
        ['phi']
        """
        return [self.coordinates[index] for index in self._structure["cyclic"]]

    @property
    def autonomous(self) -> bool:
        """Whether nothing depends on the time.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum().autonomous, vv.systems.moving_pivot().autonomous
        (True, False)
        """
        return bool(self._structure["autonomous"])

    @property
    def conserved(self) -> list[str]:
        """What the graph tells to be conserved: ``energy`` (Jacobi's integral, or H), momenta of cyclic coordinates.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.spherical_pendulum().conserved
        ['energy', 'momentum of phi']
        """
        energy = ["energy"] if self._structure["conserves_energy"] else []
        return [*energy, *(f"momentum of {name}" for name in self.cyclic)]

    def _shown(self, name: str) -> list[Any]:
        """Expressions of the core as SymPy's."""
        return self._trees(*self._model.expressions(name))

    def _trees(self, nodes: Sequence[Node], roots: Sequence[int]) -> list[Any]:
        (first, second), source = self._symbols(), self._source.symbols
        parameters = [sympy().Symbol(name) for name in self.parameters] if source is None else list(source[2])
        return trees(nodes, roots, [*first, *second], parameters)

    def _symbols(self) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Symbols of coordinates, and of velocities or momenta; those of a function are made of names."""
        if self._source.symbols is not None:
            return self._source.symbols[0], self._source.symbols[1]
        sp, letter = sympy(), "v" if self._source.kind == "lagrangian" else "p"
        taken = {*self.coordinates, *self.parameters}
        first = tuple(sp.Symbol(name) for name in self.coordinates)
        return first, tuple(sp.Symbol(free_name(f"{letter}_{name}", taken)) for name in self.coordinates)

    def evaluate(self, *expressions: Formula, trajectory: GeneralizedTrajectory | None = None) -> NDArray[np.float64]:
        """Values of further expressions, at the start or along a trajectory.

        Units: those of the system.

        Parameters
        ----------
        *expressions : sympy.Expr or callable
            Of the same kind as the function of the system.
        trajectory : GeneralizedTrajectory, optional
            Where; the start if not given.

        Returns
        -------
        ndarray, shape (k,) or (T, k)

        Raises
        ------
        InvalidInput
            For an expression that the core does not know.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pendulum = vv.systems.pendulum(position=[0.5])
        >>> pendulum.evaluate(lambda q, v, t, l, **others: l * np.sin(q[0])).round(6)
        array([0.479426])
        """
        nodes, roots = self._source.nodes("expressions", expressions)
        if trajectory is None:
            t, states = np.array([self.t0]), self._start()[None, :]
        else:
            check_run(trajectory)
            t, states = trajectory.t, trajectory._states
        found = self._model.evaluate(nodes, roots, t, states, self._values[None, :])
        return found[0] if trajectory is None else found
