"""Legendre's transformation by numbers: H(q, p) of any Lagrangian that is convex in the velocities, and back.

The one idea: p = ∂L/∂q̇ is the minimum of the convex function L − p q̇, so Newton's method with the mass matrix finds it
from anywhere, its steps halved until they lead nearer in the norm of that matrix, which knows no units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from visviva._arrays import float_array, number
from visviva._html import Shown
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva.errors import ConvergenceError, FrozenAttribute, InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._nodes import Node
    from visviva.generalized._system import GeneralizedSystem

    _Array: TypeAlias = NDArray[np.float64]

__all__ = ["LegendreTransform"]

_MOST_STEPS = 200
_MOST_HALVINGS = 60
#: What is left of p, relative to what it is made of: that of a root, with the round-off of an expression.
_RESIDUAL = 1e-12
#: An eigenvalue of the mass matrix below this times the largest is negative.
_NEGATIVE = 1e-10
#: Multiples of what was found at which the function is looked at, too: it may be bent elsewhere.
_MULTIPLES = (-2.0, -1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 2.0)
#: Multiples of what was found at which derivatives are the same if they come to a limit there, and are not.
_BEYOND = 2.0
_WELL_WITHIN = 1e-3
#: Sizes that are tried where the derivatives at rest tell none.
_SIZES = tuple(10.0**power for power in range(-40, 41, 2))
_NAMES = {"lagrangian": ("momentum", "velocity", "velocities"), "hamiltonian": ("velocity", "momentum", "momenta")}


@known_keywords
class LegendreTransform(Shown):
    """The Hamiltonian of a Lagrangian, or the Lagrangian of a Hamiltonian, evaluated by numbers.

    Made by the method ``legendre_transform`` of either. Called with places and momenta (or velocities), of shape (...,
    n), it gives H (or L), of shape (...), in the units of the system. It is refused where the function is not convex,
    since p then has several velocities or none.

    Attributes
    ----------
    system : Lagrangian or Hamiltonian
        What is transformed.

    References
    ----------
    V. I. Arnold, *Mathematical Methods of Classical Mechanics*, 2nd ed., section 14.

    Examples
    --------
    >>> import visviva as vv
    >>> quartic = vv.Lagrangian(lambda q, v, t, a: a * v[0] ** 4 / 4, ["x"], parameters={"a": 1.7})
    >>> H = quartic.legendre_transform()
    >>> H([0.0], [1.2393]).round(12), H.conjugate([0.0], [1.2393]).round(12)
    (np.float64(0.8365275), array([0.9]))
    """

    __slots__ = ("_parts", "system")

    system: GeneralizedSystem
    _parts: dict[str, tuple[list[Node], list[int]]]

    def __init__(self, system: GeneralizedSystem) -> None:
        from visviva.generalized._system import GeneralizedSystem

        made_by(self, "legendre_transform() of a Lagrangian or a Hamiltonian", system=(system, GeneralizedSystem))
        n = len(system.coordinates)
        nodes, all_second = system._model.expressions("curvatures")
        square = [all_second[i * 2 * n + j] for i in range(n, 2 * n) for j in range(n, 2 * n)]
        given = system._model.expressions
        object.__setattr__(self, "system", system)
        parts = {"function": given("function"), "conjugates": given("conjugates"), "slopes": given("slopes")}
        object.__setattr__(self, "_parts", parts | {"mass": (nodes, square)})

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenAttribute(name, "a LegendreTransform is frozen; that of system.at(…) is another one")

    def __reduce__(self) -> tuple[type[LegendreTransform], tuple[GeneralizedSystem]]:
        return LegendreTransform, (self.system,)

    def __repr__(self) -> str:
        return f"LegendreTransform({self.system!r})"

    def __call__(self, position: ArrayLike, second: ArrayLike, *, t: float | None = None) -> _Array:
        """Give Σ p q̇ − L, or Σ p q̇ − H.

        Units: those of the system.

        Parameters
        ----------
        position : array_like, shape (..., n)
            Places.
        second : array_like, shape (..., n)
            Momenta of a Lagrangian, velocities of a Hamiltonian.
        t : float, optional
            The time; that of the start if not given.

        Returns
        -------
        ndarray, shape (...)

        Raises
        ------
        InvalidInput
            For other shapes, or where the function is not convex.
        ConvergenceError
            For momenta (or velocities) that none has.

        Examples
        --------
        >>> import visviva as vv
        >>> L = vv.systems.henon_heiles().legendre_transform()
        >>> L([[0.1, 0.0], [0.0, 0.0]], [[0.0, 0.5], [1.0, 1.0]]).round(9)
        array([0.12, 1.  ])
        """
        q, p, v, times = self._solved(position, second, t)
        found: _Array = ((p * v).sum(axis=1) - self._values("function", q, v, times)[:, 0]).reshape(
            np.shape(position)[:-1]
        )
        return found[()]

    def conjugate(self, position: ArrayLike, second: ArrayLike, *, t: float | None = None) -> _Array:
        """Give the velocities that have these momenta, or the momenta that have these velocities.

        Units: those of the system.

        Parameters
        ----------
        position, second, t
            As in a call.

        Returns
        -------
        ndarray, shape (..., n)

        Raises
        ------
        InvalidInput, ConvergenceError
            As a call.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> light = vv.Lagrangian(lambda q, v, t: -np.sqrt(1 - v[0] ** 2), ["x"]).legendre_transform()
        >>> light.conjugate([0.0], [0.75]).round(12)
        array([0.6])
        """
        return self._solved(position, second, t)[2].reshape(np.shape(position))

    def gradient(self, position: ArrayLike, second: ArrayLike, *, t: float | None = None) -> tuple[_Array, _Array]:
        """Give the derivatives by position and by the other argument: of H they are −ṗ and q̇ without further forces.

        Units: those of the system.

        Parameters
        ----------
        position, second, t
            As in a call.

        Returns
        -------
        ndarray, shape (..., n)
            By places.
        ndarray, shape (..., n)
            By momenta or velocities.

        Raises
        ------
        InvalidInput, ConvergenceError
            As a call.

        Examples
        --------
        >>> import visviva as vv
        >>> H = vv.systems.oscillator(k=4.0, m=2.0).legendre_transform()
        >>> H.gradient([0.5], [1.0])
        (array([2.]), array([0.5]))
        """
        q, _, v, times = self._solved(position, second, t)
        # The core has ∂L/∂q and −∂H/∂q.
        sign = -1.0 if self.system._source.kind == "lagrangian" else 1.0
        slopes = sign * self._values("slopes", q, v, times)
        return slopes.reshape(np.shape(position)), v.reshape(np.shape(position))

    # --- Newton's method for many states at once -----------------------------------------------------------------

    def _values(self, part: str, q: _Array, v: _Array, t: float) -> _Array:
        nodes, roots = self._parts[part]
        states = np.ascontiguousarray(np.concatenate([q, v], axis=1))
        with np.errstate(all="ignore"):
            return self.system._model.evaluate(nodes, roots, np.full(len(q), t), states, self.system._values[None, :])

    def _mass(self, q: _Array, v: _Array, t: float) -> _Array:
        n = q.shape[1]
        return self._values("mass", q, v, t).reshape(-1, n, n)

    def _solved(self, position: ArrayLike, second: ArrayLike, t: float | None) -> tuple[_Array, _Array, _Array, float]:
        """Give places, momenta, velocities (or the other way round) and the time, one row for each state."""
        given, _, _ = _NAMES[self.system._source.kind]
        n = len(self.system.coordinates)
        q = float_array("position", position, None)
        if q.ndim == 0 or q.shape[-1] != n:
            raise InvalidInput("position", f"expected shape (..., {n}), got {q.shape}")
        p = float_array(given, second, q.shape).reshape(-1, n)
        q = q.reshape(-1, n)
        time = self.system.t0 if t is None else number("t", t)
        return q, p, self._newton(q, p, time), time

    def _newton(self, q: _Array, p: _Array, t: float) -> _Array:
        v, rest = self._begun(q, p, t)
        active = (rest != 0.0).any(axis=1)
        for _ in range(_MOST_STEPS):
            rows = np.flatnonzero(active)
            if not rows.size:
                break
            mass = self._mass(q[rows], v[rows], t)
            self._check_convex(mass, q[rows], v[rows])
            mass = _damped(mass, rest[rows])
            step, size = _step(mass, rest[rows])
            left = np.arange(len(rows))
            for halving in range(_MOST_HALVINGS):
                trial = v[rows[left]] + 0.5**halving * step[left]
                others = self._missing(q[rows[left]], p[rows[left]], trial, t)
                with np.errstate(invalid="ignore"):
                    better = _step(mass[left], np.where(np.isfinite(others), others, np.inf))[1] < size[left]
                v[rows[left[better]]], rest[rows[left[better]]] = trial[better], others[better]
                left = left[~better]
                if not left.size:
                    break
            # Where no shorter step leads nearer, what is left is round-off, or there is nothing to find.
            active[rows[left]] = False
            active &= (rest != 0.0).any(axis=1)
        self._check_found(q, p, v, rest, t)
        return v

    def _missing(self, q: _Array, p: _Array, v: _Array, t: float) -> _Array:
        return p - self._values("conjugates", q, v, t)

    def _begun(self, q: _Array, p: _Array, t: float) -> tuple[_Array, _Array]:
        """Give where Newton's method starts: at rest, or where no step is known there at the best size towards p."""
        v = np.zeros_like(q)
        rest, mass = self._missing(q, p, v, t), self._mass(q, v, t)
        known = np.asarray(np.isfinite(mass).all(axis=(1, 2)) & np.isfinite(rest).all(axis=1))
        known[known] = np.abs(np.linalg.det(mass[known])) > 0.0
        least = np.where(np.isfinite(rest).all(axis=1), np.linalg.norm(rest, axis=1), np.inf)
        for size in _SIZES if not known.all() else ():
            trial = size * np.copysign(1.0, p)
            others = self._missing(q, p, trial, t)
            lengths = np.linalg.norm(others, axis=1)
            better = ~known & (lengths < least) & np.isfinite(self._mass(q, trial, t)).all(axis=(1, 2))
            v[better], rest[better], least[better] = trial[better], others[better], lengths[better]
        if not (np.isfinite(rest).all() and np.isfinite(self._mass(q, v, t)).all()):
            row = int(np.argmin(np.isfinite(rest).all(axis=1)))
            raise InvalidInput("position", f"the function has no derivatives at {q[row].tolist()}: a singularity")
        return v, rest

    def _check_found(self, q: _Array, p: _Array, v: _Array, rest: _Array, t: float) -> None:
        given, _, several = _NAMES[self.system._source.kind]
        mass = self._mass(q, v, t)
        made_of = np.abs(p) + np.abs(p - rest) + (np.abs(mass) * np.abs(v)[:, None, :]).sum(axis=2)
        missed = ~(np.abs(rest) <= _RESIDUAL * made_of.max(axis=1, keepdims=True)).all(axis=1)
        if missed.any():
            row = int(np.argmax(missed))
            raise ConvergenceError(
                f"no {several} were found that have the {given} {p[row].tolist()} at {q[row].tolist()}: "
                "it may be out of reach of the derivative"
            )
        limit = self._is_limit(q, p, v, t)
        if limit.any():
            row = int(np.argmax(limit))
            raise ConvergenceError(
                f"no {several} were found that have the {given} {p[row].tolist()} at {q[row].tolist()}: it is, to all "
                f"its digits, a limit that the derivative comes to as {several} grow without end"
            )
        for multiple in _MULTIPLES:
            self._check_convex(self._mass(q, multiple * v, t), q, multiple * v)

    def _is_limit(self, q: _Array, p: _Array, v: _Array, t: float) -> NDArray[np.bool_]:
        """Whether twice of what was found has the same derivatives, as next to the speed of light.

        Those of a homogeneous function are the same at a small part of it, too, and are no limit.
        """
        with np.errstate(all="ignore"):
            beyond, within = (np.abs(self._missing(q, p, part * v, t)).max(axis=1) for part in (_BEYOND, _WELL_WITHIN))
            rounding = np.finfo(float).eps * np.abs(p).max(axis=1)
            found: NDArray[np.bool_] = (beyond <= rounding) & (within > rounding)
        return found

    def _check_convex(self, mass: _Array, q: _Array, v: _Array) -> None:
        """Refuse a negative eigenvalue; where the function has no value there is none."""
        known = np.isfinite(mass).all(axis=(1, 2))
        lowest = np.full(len(mass), np.inf)
        values = np.linalg.eigvalsh(mass[known])
        lowest[known] = values[:, 0] + _NEGATIVE * np.abs(values).max(axis=1)
        if (lowest < 0.0).any():
            row = int(np.argmin(lowest))
            _, name, several = _NAMES[self.system._source.kind]
            raise InvalidInput(
                "L" if name == "velocity" else "H",
                f"expected a function that is convex in the {several}; it is not at the {name} {v[row].tolist()} and "
                f"the position {q[row].tolist()}, so its transform has several values",
            )


def _damped(mass: _Array, rest: _Array) -> _Array:
    """Give the mass matrices with something on the diagonal where they are singular: a step of 1 then."""
    largest = np.abs(mass).max(axis=(1, 2))
    least = np.linalg.eigvalsh(mass)[:, 0]
    length = np.linalg.norm(rest, axis=1)
    more = np.where(least > 1e-12 * largest, 0.0, np.maximum(1e-12 * largest, length))
    more = np.where((more == 0.0) & (largest == 0.0), 1.0, more)
    damped: _Array = mass + more[:, None, None] * np.eye(mass.shape[1])
    return damped


def _step(mass: _Array, rest: _Array) -> tuple[_Array, _Array]:
    """Give Newton's steps, and the size of what they are to bring to zero: its square in the norm of the matrix."""
    with np.errstate(all="ignore"):
        step = np.asarray(np.linalg.solve(mass, rest[:, :, None])[:, :, 0], dtype=float)
        return step, np.abs((rest * step).sum(axis=1))
