"""Hamiltonians: `Hamiltonian`."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._canonical import CanonicalTest, canonical_test
from visviva.generalized._changes import legendre
from visviva.generalized._equations import HamiltonsEquations, hamiltons_equations
from visviva.generalized._fixed_points import fixed_points
from visviva.generalized._small_motions import SmallMotions
from visviva.generalized._source import described
from visviva.generalized._starts import is_beyond_domain, refuse_a_start, refuse_beyond_domain
from visviva.generalized._symbolic import trees
from visviva.generalized._system import GeneralizedSystem

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import sympy
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._equilibria import Equilibrium
    from visviva.generalized._lagrangian import Lagrangian
    from visviva.typing import Formula, ParameterValues, SymbolicExpression

__all__ = ["Hamiltonian"]


@known_keywords
class Hamiltonian(GeneralizedSystem, SmallMotions):
    """A system by its Hamiltonian H(q, p, t).

    Units: those of the system, which are those of its parameters; angles in radians.

    Parameters
    ----------
    H : sympy.Expr or callable
        The Hamiltonian: an expression, or a function ``H(q, p, t, **parameters)`` of arithmetic and NumPy's functions.
    q, p : sequence of sympy.Symbol
        Coordinates and momenta; for a function, names of coordinates, and no ``p``.
    parameters : dict, optional
        Values of symbols.
    position, momentum : array_like, shape (n,), optional
        The start; zero momenta if none are given.
    forces : dict, optional
        Forces by coordinate that are not −∂H/∂q.
    t0 : float
        The time of the start.

    Raises
    ------
    InvalidInput
        For symbols without a value and functions that the core does not know.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (8.18).

    Examples
    --------
    >>> import sympy as sp, visviva as vv
    >>> x, y, px, py = sp.symbols("x y px py")
    >>> H = (px**2 + py**2) / 2 + (x**2 + y**2) / 2 + x**2 * y - y**3 / 3
    >>> henon_heiles = vv.Hamiltonian(H, q=[x, y], p=[px, py], position=[0.1, 0.0], momentum=[0.0, 0.5])
    >>> henon_heiles.run(t=100.0).position[-1].round(12)
    array([-0.04019424,  0.67901692])
    """

    __slots__ = ()
    _second_name = "momentum"

    def __init__(
        self,
        H: Formula,
        q: Sequence[sympy.Expr | str] | sympy.Expr,
        p: Sequence[sympy.Expr] | sympy.Expr | None = None,
        *,
        parameters: ParameterValues | None = None,
        position: ArrayLike | None = None,
        momentum: ArrayLike | None = None,
        forces: Mapping[str, Formula] | Mapping[sympy.Expr, Formula] | None = None,
        t0: float = 0.0,
    ) -> None:
        source, values = described("hamiltonian", H, q, p, parameters, {"forces": forces})
        self._prepare(source, values, (position, momentum, t0))

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Momenta at the start, shape (n,), in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.henon_heiles().momentum
        array([0. , 0.5])
        """
        return self._second

    @property
    def energy(self) -> float:
        """H at the start, in the units of the system.

        Examples
        --------
        >>> import visviva as vv
        >>> round(vv.systems.henon_heiles().energy, 12)
        0.13
        """
        n = len(self.coordinates)
        return float(self._model.columns(np.array([self.t0]), self._start()[None, :], self._values[None, :])[0, n])

    @property
    def equations(self) -> HamiltonsEquations:
        """q̇ and ṗ as expressions of SymPy, further forces among them; ``print`` and notebooks show equations.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.henon_heiles().equations
        ([p_x, p_y], [-2*x*(y + 1/2), -x**2 + y**2/3 - 2*y*(1/2 - y/3)])
        """
        return hamiltons_equations(self)

    def lagrangian(self) -> Lagrangian:
        """The Lagrangian of the system, at the same state.

        Returns
        -------
        Lagrangian
            With velocities that belong to the momenta.

        Raises
        ------
        InvalidInput
            For a Hamiltonian that is not quadratic in the momenta.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 8.1.

        Examples
        --------
        >>> import visviva as vv
        >>> hamiltonian = vv.systems.henon_heiles()
        >>> abs(hamiltonian.lagrangian().energy - hamiltonian.energy) < 1e-15
        True
        """
        made: Any = legendre(self)
        lagrangian: Lagrangian = made
        return lagrangian

    def equilibria(self, near: ArrayLike | None = None) -> list[Equilibrium]:
        """States at which neither coordinates nor momenta change, their stability and their frequencies.

        Each is told once: of states along a coordinate that nothing depends on, one. Of a curve of equilibria in
        others a dozen states stand for all, and ``continuum`` says that others go on.

        Units: those of the system.

        Parameters
        ----------
        near : array_like, shape (S, 2n), optional
            States (coordinates, then momenta) where Newton's method starts. If not given, a grid over −π … π of some
            thousand of them, and as many without momenta; for coordinates that are lengths places of other sizes, too,
            as of a Lagrangian. It may miss some.

        Returns
        -------
        list of Equilibrium

        Raises
        ------
        InvalidInput
            Where equations depend on the time, and for states of another shape.

        References
        ----------
        V. I. Arnold, *Mathematical Methods of Classical Mechanics*, 2nd ed., § 22.

        Examples
        --------
        >>> import sympy, visviva as vv
        >>> q, p = sympy.symbols("q p")
        >>> well = vv.Hamiltonian(sympy.sqrt(1 + p**2) + (q**2 - 1) ** 2 / 4, q=[q], p=[p])
        >>> [(round(float(e.position[0]), 9), e.stable) for e in well.equilibria()]
        [(-1.0, True), (0.0, False), (1.0, True)]
        """
        return fixed_points(self, near)

    def poisson(self, f: SymbolicExpression, g: SymbolicExpression) -> sympy.Expr:
        """The Poisson bracket {f, g} = Σ ∂f/∂q ∂g/∂p − ∂f/∂p ∂g/∂q, as an expression of SymPy.

        Parameters
        ----------
        f, g : sympy.Expr
            Functions of coordinates, momenta, time and parameters.

        Returns
        -------
        sympy.Expr
            In the symbols of the Hamiltonian.

        Raises
        ------
        InvalidInput
            For an expression that the core does not know; of a system that is a function of Python.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 9.5.

        Examples
        --------
        >>> import sympy as sp, visviva as vv
        >>> x, y, z, px, py, pz = sp.symbols("x y z px py pz")
        >>> free = vv.Hamiltonian((px**2 + py**2 + pz**2) / 2, q=[x, y, z], p=[px, py, pz])
        >>> free.poisson(y * pz - z * py, z * px - x * pz)
        -px*y + py*x
        """
        if self._source.symbols is None:
            raise InvalidInput("f", "brackets are of expressions of SymPy; pass the Hamiltonian as one, too")
        nodes, roots = self._source.nodes("f", [f, g])
        found, places = self._model.poisson(nodes, (roots[0], roots[1]))
        first, second, parameters = self._source.symbols
        return trees(found, places, [*first, *second], list(parameters))[0]

    def is_canonical(
        self, transformation: Sequence[SymbolicExpression] | Callable[..., Sequence[SymbolicExpression]]
    ) -> CanonicalTest:
        """Whether a transformation (q, p) → (Q, P) is canonical: MᵀJM = J for its derivatives M.

        Parameters
        ----------
        transformation : sequence or callable
            Q, then P: 2n expressions of coordinates, momenta, time and parameters, or a function
            ``(q, p, t, **parameters)`` that gives all of them.

        Returns
        -------
        CanonicalTest
            True or false, with the largest residual.

        Raises
        ------
        InvalidInput
            For another number of expressions, or what the core does not know.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (9.55).

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"])
        >>> bool(H.is_canonical(lambda q, p, t: [np.arctan2(q[0], p[0]), (p[0] ** 2 + q[0] ** 2) / 2]))
        True
        """
        return canonical_test(self, transformation)

    def _look_at_start(self) -> None:
        here = np.array([self.t0]), self._start()[None, :], self._values[None, :]
        if not all(map(isfinite, self._model.rates(*here)[0].tolist())):
            refuse_a_start(self, self._start(), "a rate of Hamilton's equations is no number")
        # Rates of log(q) are numbers where H is none.
        if is_beyond_domain(self, self._model.columns(*here))[0]:
            refuse_beyond_domain(self)
