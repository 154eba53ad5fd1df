"""Lagrangians: `Lagrangian`."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._changes import legendre, routhian
from visviva.generalized._consistency import check_on_constraints, projected, wants_projection
from visviva.generalized._equations import EquationsOfMotion, euler_lagrange
from visviva.generalized._laws import Laws
from visviva.generalized._small_motions import SmallMotions
from visviva.generalized._source import described
from visviva.generalized._starts import is_beyond_domain, refuse_a_start, refuse_beyond_domain
from visviva.generalized._symbolic import sympy as imported_sympy
from visviva.generalized._system import GeneralizedSystem
from visviva.generalized._variations import Variations

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import sympy
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.typing import Formula, ParameterValues

__all__ = ["Lagrangian"]


@known_keywords
class Lagrangian(GeneralizedSystem, SmallMotions, Variations, Laws):
    """A system by its Lagrangian L(q, q̇, t).

    Units: those of the system, which are those of its parameters; angles in radians.

    Parameters
    ----------
    L : sympy.Expr or callable
        The Lagrangian: an expression, or a function ``L(q, v, t, **parameters)`` of arithmetic and NumPy's functions,
        called once. Velocity-dependent potentials and explicit times are welcome.
    coordinates : sequence
        As `coordinate` makes them (their velocities are ``theta.diff(vv.time)``), or symbols with ``velocities=``; for
        a function, names.
    velocities : sequence of sympy.Symbol, optional
        The velocities of coordinates that are symbols.
    parameters : dict, optional
        Values of symbols.
    position, velocity : array_like, shape (n,), optional
        The start; at rest if no velocity is given.
    forces : dict, optional
        Generalized forces by coordinate, of coordinates, velocities and time, each given as `L` is.
    dissipation : sympy.Expr or callable, optional
        Rayleigh's function R: the forces −∂R/∂q̇.
    constraints : sequence of sympy.Expr or callable, optional
        The left sides of holonomic constraints g(q, t) = 0, kept by multipliers; states are put back on them after
        every step.
    nonholonomic : sequence of sympy.Expr or callable, optional
        The left sides of constraints a(q, t)·q̇ + b(q, t) = 0.
    consistent : {"project"}, optional
        Puts a start that violates the constraints on them, also those that `at` and `ensemble` make; otherwise `run`
        and `plan` refuse it.
    t0 : float
        The time of the start.

    Raises
    ------
    InvalidInput
        For symbols without a value, functions that the core does not know, coordinates without kinetic energy.
    ConvergenceError
        Where a start to be put on the constraints comes to none.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (1.57), (1.70), (2.23).

    Examples
    --------
    >>> import sympy as sp, visviva as vv
    >>> theta, g, l = vv.coordinate("theta"), *sp.symbols("g l")
    >>> L = l**2 * theta.diff(vv.time) ** 2 / 2 + g * l * sp.cos(theta)
    >>> pendulum = vv.Lagrangian(L, [theta], parameters={g: 9.81, l: 1.0}, position=[3.0])
    >>> pendulum.run(t=10.0).position.round(6)
    array([[3.      ],
           [2.925056]])

    Without SymPy:

    >>> import numpy as np
    >>> spring = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 / 2, ["x"], position=[1.0])
    >>> spring.run(t=2 * np.pi).position[-1].round(9)
    array([1.])
    """

    __slots__ = ()

    def __init__(
        self,
        L: Formula,
        coordinates: Sequence[sympy.Expr | str] | sympy.Expr,
        *,
        velocities: Sequence[sympy.Expr] | None = None,
        parameters: ParameterValues | None = None,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        forces: Mapping[str, Formula] | Mapping[sympy.Expr, Formula] | None = None,
        dissipation: Formula | None = None,
        constraints: Sequence[Formula] | Formula = (),
        nonholonomic: Sequence[Formula] | Formula = (),
        consistent: Literal["project"] | None = None,
        t0: float = 0.0,
    ) -> None:
        further = {
            "forces": forces,
            "dissipation": dissipation,
            "constraints": constraints,
            "nonholonomic": nonholonomic,
        }
        source, values = described("lagrangian", L, coordinates, velocities, parameters, further)
        try:
            self._prepare(source, values, (position, velocity, t0))
        except InvalidInput as error:
            raise _named(error, source.names) from None
        if wants_projection(consistent):
            state: Any = (position, velocity, t0)
            if self._constraints() and self.position is not None:
                nearest, n = projected(self, self._start(), self._values), len(source.names)
                state = (nearest[:n], nearest[n:], t0)
            self._prepare(source, values, state, self._model, projects=True)

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities at the start, shape (n,), in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum(velocity=[1.5]).velocity
        array([1.5])
        """
        return self._second

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Generalized momenta ∂L/∂q̇ at the start, shape (n,), in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum(l=2.0, velocity=[1.5]).momentum  # m l² θ̇
        array([6.])
        """
        return self._columns_at_start()[: len(self.coordinates)]

    @property
    def energy(self) -> float:
        """Jacobi's integral Σ q̇ ∂L/∂q̇ − L at the start, in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum(g=10.0, position=[0.0], velocity=[2.0]).energy
        -8.0
        """
        return float(self._columns_at_start()[len(self.coordinates)])

    def _columns_at_start(self) -> NDArray[np.float64]:
        columns = self._model.columns(np.array([self.t0]), self._start()[None, :], self._values[None, :])
        first: NDArray[np.float64] = columns[0]
        return first

    @property
    def equations(self) -> EquationsOfMotion:
        """Lagrange's equations, momenta and Jacobi's integral as expressions of SymPy, to be printed or used.

        They are put into SymPy's expressions when they are asked for; the core has derived them.

        Examples
        --------
        >>> import visviva as vv
        >>> print(vv.systems.coupled_oscillators().equations.equations[0])  # doctest: +ELLIPSIS
        Eq(..., 0)
        """
        return euler_lagrange(self)

    @property
    def mass_matrix(self) -> sympy.Matrix:
        """∂²L/∂q̇∂q̇ as a matrix of SymPy.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.spring_pendulum().mass_matrix
        Matrix([
        [m,      0],
        [0, m*r**2]])
        """
        n = len(self.coordinates)
        return imported_sympy().Matrix(n, n, self._shown("mass_matrix"))

    @property
    def momenta(self) -> list[sympy.Expr]:
        """∂L/∂q̇ as expressions of SymPy.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum().momenta
        [l**2*m*v_theta]
        """
        return self._shown("conjugates")

    @property
    def kinetic_split(self) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
        """L by degrees of the velocities: its parts L2, L1 and L0, as expressions of SymPy; h = L2 − L0.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.rod().kinetic_split
        (-Omega**2*m*r**2/2 + m*(Omega**2*r**2 + v_r**2)/2, 0, Omega**2*m*r**2/2)
        """
        nodes, roots = self._model.by_degree()
        second, first, rest = self._trees(nodes, roots)
        return second, first, rest

    def hamiltonian(self) -> Hamiltonian:
        """The Hamiltonian of the system, at the same state; momenta are called ``p_<name>``.

        Returns
        -------
        Hamiltonian
            With momenta that belong to the velocities.

        Raises
        ------
        InvalidInput
            For a Lagrangian that is not quadratic in the velocities, dissipation or constraints.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 8.1.

        Examples
        --------
        >>> import visviva as vv
        >>> pendulum = vv.systems.pendulum(position=[0.5], velocity=[1.0])
        >>> abs(pendulum.hamiltonian().energy - pendulum.energy) < 1e-14
        True
        """
        made: Any = legendre(self)
        hamiltonian: Hamiltonian = made
        return hamiltonian

    def routhian(
        self, momenta: Mapping[str, float | None] | Mapping[sympy.Expr, float | None] | None = None
    ) -> Lagrangian:
        """The system without cyclic coordinates, as a Lagrangian with their momenta as parameters ``p_<name>``.

        Units: those of the system.

        Parameters
        ----------
        momenta : dict, optional
            Which ones, and their momenta (None: those of the start); all cyclic ones of the start if not given.

        Returns
        -------
        Lagrangian
            Of the coordinates that are left; Routh's function takes the place of L.

        Raises
        ------
        InvalidInput
            For coordinates that are not cyclic.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 8.3.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.spherical_pendulum().routhian().coordinates
        ('theta',)
        """
        made: Any = routhian(self, momenta)
        reduced: Lagrangian = made
        return reduced

    @property
    def degrees_of_freedom(self) -> int:
        """Coordinates less constraints, which are independent of each other.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.atwood().degrees_of_freedom
        1
        """
        return len(self.coordinates) - self._constraints()

    def _look_at_start(self) -> None:
        state = self._start()
        if self._constraints():
            check_on_constraints(self, state)
        here = np.array([self.t0]), state[None, :], self._values[None, :]
        rates = self._model.rates(*here)[0].tolist()
        if not all(map(isfinite, rates)):
            index = list(map(isfinite, rates)).index(False)
            refuse_a_start(self, state, f"the acceleration of {self.coordinates[index]!r} is no number")
        # Beyond its domain a function may still have numbers for rates, as −√(1 − v²) of a velocity above 1.
        if is_beyond_domain(self, self._model.columns(*here))[0]:
            refuse_beyond_domain(self)


def _named(error: InvalidInput, names: tuple[str, ...]) -> InvalidInput:
    """Put names in the place of numbers of coordinates."""
    message = error.message
    for index, name in reversed(list(enumerate(names))):
        message = message.replace(f"coordinate {index} ", f"coordinate {name!r} ")
    return InvalidInput(error.argument, message)
