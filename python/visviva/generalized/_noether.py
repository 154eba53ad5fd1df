"""E. Noether's theorem: whether an infinitesimal transformation is a symmetry, and the momentum that it conserves.

The one idea: with q → q + ε ξ(q, t) and t → t + ε τ(q, t) the action changes by ε ∫ Δ dt,
Δ = ξ ∂L/∂q + (ξ̇ − q̇ τ̇) ∂L/∂q̇ + τ ∂L/∂t + L τ̇. It is a symmetry if Δ is the rate of a function F(q, t), that is, if
the Euler–Lagrange equations of Δ are 0 = 0; then p ξ − (p q̇ − L) τ − F is conserved. All of them are expressions: they
vanish by the rules of the graph, which proves it, or at states of many sizes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias, overload

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._calculus import Calculus, expression_list
from visviva.generalized._probe import Finding, Probe
from visviva.generalized._source import _label

if TYPE_CHECKING:
    from collections.abc import Iterator

    import sympy
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._nodes import Expression
    from visviva.generalized._trajectory import GeneralizedTrajectory

    _Array: TypeAlias = NDArray[np.float64]

__all__ = ["NoetherSymmetry", "noether"]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_MOST_PARTS = 256


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NoetherSymmetry(Record):
    """Whether a transformation is a symmetry of a Lagrangian, and what it conserves. Made by `Lagrangian.noether`.

    Units: residuals are relative, without dimension.

    Attributes
    ----------
    system : Lagrangian
    holds : bool
        Whether it is a symmetry.
    proved : bool
        Whether that follows from the expressions, whatever the parameters; else it was seen at states of many sizes.
    residual : float
        The largest of what had to vanish there, relative to what it is made of.
    reason : str
        What tells that it is none, or of which kind it is.

    References
    ----------
    E. Noether, Nachr. Ges. Wiss. Göttingen (1918) 235; H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd
    ed., § 13.7.

    Examples
    --------
    >>> import visviva as vv
    >>> def L(q, v, t):
    ...     return (v[0] ** 2 + v[1] ** 2 - q[0] ** 2 - q[1] ** 2) / 2
    >>> plane = vv.Lagrangian(L, ["x", "y"], position=[1.0, 0.0])
    >>> turn = plane.noether(lambda q, v, t: [-q[1], q[0]])
    >>> turn.holds, turn.conserved()
    (True, 0.0)
    """

    system: Lagrangian
    holds: bool
    proved: bool
    residual: float
    reason: str
    _calculus: Calculus
    #: p ξ − (p q̇ − L) τ, less a gauge that was given.
    _momentum: Expression
    #: Δ and its derivatives by velocities, of which F is found; None where there is no F to be found.
    _gauge: list[Expression] | None

    def __repr__(self) -> str:
        return f"NoetherSymmetry(holds={self.holds}, {self.reason})"

    @property
    def expression(self) -> sympy.Expr:
        """What is conserved, as an expression of SymPy.

        Raises
        ------
        InvalidInput
            Where L changes by the rate of a function that was not given.

        Examples
        --------
        >>> import visviva as vv
        >>> plane = vv.Lagrangian(lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2, ["x", "y"], position=[1.0, 0.0])
        >>> plane.noether(lambda q, v, t: [-q[1], q[0]]).expression
        -v_x*y + v_y*x
        """
        if self._gauge is not None:
            raise InvalidInput(
                "gauge", "L changes by the rate of a function of q and t: pass it to noether to have it in"
            )
        return self._calculus.to_sympy([self._momentum])[0]

    @overload
    def conserved(self, trajectory: None = None) -> float: ...
    @overload
    def conserved(self, trajectory: GeneralizedTrajectory) -> NDArray[np.float64]: ...
    def conserved(self, trajectory: GeneralizedTrajectory | None = None) -> float | NDArray[np.float64]:
        """Give what is conserved, at the start or along a trajectory; of what is no symmetry it changes.

        Parameters
        ----------
        trajectory : GeneralizedTrajectory, optional
            Where; the start if not given.

        Returns
        -------
        float or ndarray, shape (T,)
            p ξ − (p q̇ − L) τ − F, in the units of the system, with F = 0 at its start where it was not given.

        Raises
        ------
        ConvergenceError
            If F cannot be found by quadrature on the straight line from the start; pass ``gauge``.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> falling = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - 9.81 * q[0], ["z"], velocity=[3.0], position=[0.0])
        >>> shift = falling.noether([1.0])
        >>> along = shift.conserved(falling.run(t=np.linspace(0.0, 1.0, 11)))
        >>> bool(np.ptp(along) < 1e-14)
        True
        """
        system = self.system
        if trajectory is None:
            t, states, values = np.array([system.t0]), system._start()[None, :], system._values
        else:
            t, states, values = trajectory.t, trajectory._states, trajectory.system._values
        found = self._calculus.values([self._momentum], t, states, values)[:, 0]
        if self._gauge is not None:
            found = found - self._function(t, states[:, : len(system.coordinates)], values)
        return float(found[0]) if trajectory is None else found

    def _function(self, t: _Array, q: _Array, parameters: _Array) -> _Array:
        """Give F: Δ at rest and its slopes by velocities, along the straight line from the start."""
        assert self._gauge is not None
        system, parts, before = self.system, 1, np.full(len(t), np.nan)
        first = np.zeros(q.shape[1]) if system.position is None else system.position
        while parts <= _MOST_PARTS:
            s = ((np.arange(parts)[:, None] + 0.5 * (_NODES + 1.0)) / parts).ravel()
            weights = np.tile(0.5 * _WEIGHTS / parts, parts)
            times = system.t0 + s * (t - system.t0)[:, None]
            places = first + s[:, None] * (q - first)[:, None, :]
            states = np.concatenate([places, np.zeros_like(places)], axis=2).reshape(-1, 2 * q.shape[1])
            rates = self._calculus.values(self._gauge, times.ravel(), states, parameters).reshape(*times.shape, -1)
            shares = rates[..., 0] * (t - system.t0)[:, None] + (rates[..., 1:] * (q - first)[:, None, :]).sum(axis=2)
            found, size = np.asarray(shares @ weights, dtype=float), np.abs(shares) @ weights
            if (np.abs(found - before) <= 1e-14 * size).all():
                return found
            before, parts = found, 2 * parts
        raise ConvergenceError("the function whose rate L changes by is not found by quadrature; pass it as gauge")


def noether(system: Lagrangian, generator: Any, time_shift: Any, gauge: Any) -> NoetherSymmetry:
    """Test a transformation."""
    c, n = Calculus(system), len(system.coordinates)
    xi = c.of_user("generator", _by_coordinate(system, generator))
    tau = c.of_user("time_shift", [time_shift])[0]
    given = c.of_user("gauge", [0 if gauge is None else gauge])[0]
    *moved, of_tau, of_gauge, of_L = c.with_derivatives([*xi, tau, given, *c.of_system("function")])
    v = c.velocities()
    for argument, rows in (("generator", moved), ("time_shift", [of_tau]), ("gauge", [of_gauge])):
        if any(not c.is_zero(slope) for row in rows for slope in row[n + 1 : 2 * n + 1]):
            raise InvalidInput(argument, "expected a function of coordinates and time; it depends on velocities")

    def rate(row: list[Expression]) -> Expression:
        return sum((v[i] * row[1 + i] for i in range(n)), row[2 * n + 1])

    L, slopes, momenta = of_L[0], of_L[1 : n + 1], of_L[n + 1 : 2 * n + 1]
    flow, shift = [row[0] for row in moved], of_tau[0]
    terms = [flow[i] * slopes[i] for i in range(n)]
    terms += [rate(moved[i]) * momenta[i] for i in range(n)]
    terms += [-(v[i] * rate(of_tau)) * momenta[i] for i in range(n)]
    terms += [shift * of_L[2 * n + 1], L * rate(of_tau), -rate(of_gauge)]
    momentum = sum((momenta[i] * (flow[i] - v[i] * shift) for i in range(n)), L * shift) - of_gauge[0]
    test = _Test(c)
    others = list(_others(system, c, flow, shift, v))
    whole = c.with_derivatives([sum(terms, c.constant(0.0))])[0]
    unchanged = test.vanish([[(term,) for term in terms]])
    kind, found = "L does not change", None
    if (not unchanged.holds or unchanged.open) and gauge is None:
        unchanged = test.vanish(_equations(c, terms, v, n))
        kind, found = "L changes by the rate of a function", [whole[0], *whole[n + 1 : 2 * n + 1]]
    elif gauge is not None:
        kind = "L changes by the rate of the gauge"
    results = [(kind, unchanged)]
    results += [(what, test.vanish([[(term,) for term in each]])) for what, each in others]
    failed = [what for what, outcome in results if not outcome.holds]
    if not failed and any(outcome.open for _, outcome in results):
        raise InvalidInput(
            "position",
            "not decided: some of the terms that must cancel are nowhere to be seen, 0 or drowned by others at all "
            "states that were tried, of the sizes of the start, the parameters and 1; start where they are large, "
            "or take other units",
        )
    holds = not failed
    reason = kind
    if failed:
        reason = failed[0] if failed[0] != kind else "L changes by what is no rate" + (" of the gauge" if gauge else "")
    return NoetherSymmetry(
        system=system,
        holds=holds,
        proved=holds and all(outcome.proved for _, outcome in results),
        residual=max(outcome.residual for _, outcome in results),
        reason=reason,
        _calculus=c,
        _momentum=momentum,
        _gauge=found if holds else None,
    )


def _by_coordinate(system: Lagrangian, generator: Any) -> list[Any]:
    """Give ξ for each coordinate: of a sequence, of what is said by coordinate, or of a function that gives all."""
    n, names = len(system.coordinates), list(system.coordinates)
    if hasattr(generator, "items"):
        by_name = {_label(key): value for key, value in generator.items()}
        unknown = [key for key in by_name if key not in names]
        if unknown:
            raise InvalidInput("generator", f"there is no coordinate {unknown[0]!r}; there are {names}")
        return [by_name.get(name, 0) for name in names]
    return expression_list("generator", generator, n, f"an expression for each of {names}")


def _equations(c: Calculus, terms: list[Expression], v: list[Expression], n: int) -> list[list[tuple[Expression, ...]]]:
    """Give the Euler–Lagrange equations of a sum without accelerations, and its second derivatives by velocities.

    Term by term: what a sum is made of tells the size against which it vanishes.
    """
    first = c.with_derivatives(terms)
    second = c.with_derivatives([row[n + 1 + i] for row in first for i in range(n)])
    conditions: list[list[tuple[Expression, ...]]] = []
    for i in range(n):
        of = [second[k * n + i] for k in range(len(terms))]
        conditions.append(
            [
                (row[1 + i], -own[2 * n + 1], *(-(v[j] * own[1 + j]) for j in range(n)))
                for row, own in zip(first, of, strict=True)
            ]
        )
        conditions += [[(own[n + 1 + j],) for own in of] for j in range(i + 1)]
    return conditions


def _others(
    system: Lagrangian, c: Calculus, flow: list[Expression], shift: Expression, v: list[Expression]
) -> Iterator[tuple[str, list[Expression]]]:
    """Give what else must vanish: the work of further forces along the transformation, and what leaves constraints."""
    description, n = system._source.description, len(v)
    along = [flow[i] - v[i] * shift for i in range(n)]
    if description["forces"]:
        forces = c.adopted(description["nodes"], description["forces"])
        yield "the forces do work along it", [along[i] * forces[i] for i in range(n)]
    if description["dissipation"] is not None:
        row = c.with_derivatives(c.adopted(description["nodes"], [description["dissipation"]]))[0]
        yield "the dissipation does work along it", [along[i] * row[n + 1 + i] for i in range(n)]
    for index, row in enumerate(c.with_derivatives(c.adopted(description["nodes"], description["holonomic"]))):
        yield f"it leaves constraint {index}", [*(flow[i] * row[1 + i] for i in range(n)), shift * row[2 * n + 1]]
    first = len(description["holonomic"])
    for index, row in enumerate(c.with_derivatives(c.adopted(description["nodes"], description["nonholonomic"]))):
        terms = [along[i] * row[n + 1 + i] for i in range(n)]
        yield f"it leaves constraint {first + index}", [*terms, shift * row[0]]


class _Test:
    """Whether sums vanish: by the rules of the graph, or at states of many sizes."""

    def __init__(self, c: Calculus) -> None:
        self._calculus = c
        self._probe = Probe(c)

    def vanish(self, conditions: list[list[tuple[Expression, ...]]]) -> _Outcome:
        """Look at all sums."""
        c, findings = self._calculus, []
        for condition in conditions:
            parts = [part for term in condition for part in term]
            whole = c.with_derivatives([sum(parts, c.constant(0.0))])[0][0]
            if c.is_zero(whole):
                continue
            found = self._probe.check_sum(parts)
            if not found.known:
                raise InvalidInput("generator", "L has values at too few states near the start to test it there")
            findings.append(found)
            if not found.vanishes:
                break
        return _Outcome(findings)


class _Outcome:
    """Whether all sums vanish, whether that is proved, and the largest relative residual."""

    def __init__(self, findings: list[Finding]) -> None:
        self.holds = all(found.vanishes for found in findings)
        self.proved = not findings
        self.residual = max((found.residual for found in findings), default=0.0)
        #: Whether it only seems to hold: a term was not seen.
        self.open = self.holds and not all(found.seen for found in findings)
