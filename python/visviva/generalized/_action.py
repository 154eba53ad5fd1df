"""The action of a motion or of any path, and its variations.

The one idea: on panels with Gauss's nodes a smooth path is a polynomial, so its velocity and the integral over a panel
are known to round-off; panels are halved until nothing changes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, number
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["Actions"]

#: Nodes of a panel, panels at first and at most, and by how much of the integrand's size two integrals may differ.
_NODES, _PANELS, _MOST_PANELS, _TOLERANCE = 16, 8, 4096, 1e-12


@known_keywords
class Actions:
    """Base of `Lagrangian`: S = ∫ L dt and how it changes with the path."""

    __slots__ = ()

    def action(self: Any, t: float, *, path: Callable[..., ArrayLike] | None = None) -> float:
        """The action S = ∫ L dt from the start to a time, of the motion from the start or of any path.

        Parameters
        ----------
        t : float
            The end; the integral begins at ``t0``.
        path : callable, optional
            Coordinates, shape (T, n), or (T,) of one coordinate, at times (T,); smooth. The motion from the start if
            not given.

        Returns
        -------
        float
            To some 1e-12 of the integral of the size of L; of a motion, to the tolerance of its run, too.

        Raises
        ------
        InvalidInput
            For a path that gives another shape.
        ConvergenceError
            For a path that is not smooth, or a motion that ends at a singularity.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (2.1).

        Examples
        --------
        A free particle: m (Δx)²/2T.

        >>> import visviva as vv
        >>> free = vv.Lagrangian(lambda q, v, t: 1.5 * v[0] ** 2, ["x"], position=[1.0], velocity=[2.0])
        >>> round(free.action(2.0), 12), round(free.action(2.0, path=lambda t: 1.0 + t**2), 12)
        (12.0, 16.0)
        """
        function = self._model.expressions("function")

        def integrand(t: NDArray[np.float64], states: NDArray[np.float64]) -> NDArray[np.float64]:
            values: NDArray[np.float64] = _values(self, function, t, states)[:, 0]
            return values

        return _integral(self, t, path, integrand)

    def first_variation(
        self: Any, t: float, variation: Callable[..., ArrayLike], *, path: Callable[..., ArrayLike] | None = None
    ) -> float:
        """How the action changes with a variation η of the path: dS(q + εη)/dε at ε = 0.

        Parameters
        ----------
        t : float
            The end.
        variation : callable
            η, as a path is given. Where it vanishes at both ends, the first variation of every motion is zero
            (Hamilton's principle), if nothing but L is acting.
        path : callable, optional
            As in `action`.

        Returns
        -------
        float
            ∫ (∂L/∂q · η + ∂L/∂q̇ · η̇) dt.

        Raises
        ------
        InvalidInput, ConvergenceError
            As in `action`.

        References
        ----------
        Goldstein et al., (2.9).

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pendulum = vv.systems.pendulum(position=[2.5])
        >>> bool(abs(pendulum.first_variation(2.0, lambda t: np.sin(np.pi * t / 2.0))) < 1e-11)
        True
        """
        _path("variation", variation)
        slopes, conjugates = (self._model.expressions(name) for name in ("slopes", "conjugates"))

        def integrand(
            t: NDArray[np.float64], states: NDArray[np.float64], eta: NDArray[np.float64], rate: NDArray[np.float64]
        ) -> NDArray[np.float64]:
            changes = _values(self, slopes, t, states) * eta + _values(self, conjugates, t, states) * rate
            summed: NDArray[np.float64] = changes.sum(axis=1)
            return summed

        return _integral(self, t, path, integrand, variation)

    def second_variation(
        self: Any, t: float, variation: Callable[..., ArrayLike], *, path: Callable[..., ArrayLike] | None = None
    ) -> float:
        """The second variation of the action: d²S(q + εη)/dε² at ε = 0.

        Parameters
        ----------
        t, variation, path
            As in `first_variation`.

        Returns
        -------
        float
            Positive for every η that vanishes at both ends of a short motion, whose action is the least; of either sign
            beyond the first point that motions from the start meet again.

        Raises
        ------
        InvalidInput, ConvergenceError
            As in `action`.

        References
        ----------
        I. M. Gelfand & S. V. Fomin, *Calculus of Variations* (1963), section 25.

        Examples
        --------
        An oscillator's changes its sign after half a period, (m/2T)(π² − ω²T²):

        >>> import numpy as np, visviva as vv
        >>> swing = vv.systems.oscillator(k=4.0, m=1.0, position=[1.0])
        >>> [round(swing.second_variation(T, lambda t: np.sin(np.pi * t / T)), 6) for T in (1.0, 2.0)]
        [2.934802, -1.532599]
        """
        _path("variation", variation)
        curvatures = self._model.expressions("curvatures")
        n = len(self.coordinates)

        def integrand(
            t: NDArray[np.float64], states: NDArray[np.float64], eta: NDArray[np.float64], rate: NDArray[np.float64]
        ) -> NDArray[np.float64]:
            both = np.concatenate([eta, rate], axis=1)
            matrix = _values(self, curvatures, t, states).reshape(-1, 2 * n, 2 * n)
            summed: NDArray[np.float64] = np.einsum("ti,tij,tj->t", both, matrix, both)
            return summed

        return _integral(self, t, path, integrand, variation)


def _values(system: GeneralizedSystem, of: Any, t: NDArray[np.float64], states: NDArray[np.float64]) -> Any:
    nodes, roots = of
    return system._model.evaluate(nodes, roots, t, states, system._values[None, :])


def _integral(
    system: Any, t: float, path: Any, integrand: Callable[..., NDArray[np.float64]], variation: Any = None
) -> float:
    """Integrate over the motion or a path, on panels that are halved until nothing changes."""
    end = number("t", t)
    if end == system.t0:
        return 0.0
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    derivative = _differentiation(nodes)
    last, panels = np.nan, _PANELS
    while panels <= _MOST_PANELS:
        edges = np.linspace(system.t0, end, panels + 1)
        half = np.diff(edges)[:, None] / 2.0
        times = (edges[:-1, None] + half) + half * nodes
        flat = times.ravel()

        def along(name: str, given: Any, times: Any = times, half: Any = half) -> tuple[Any, Any]:
            values = _sampled(system, name, given, times.ravel()).reshape(*times.shape, -1)
            rates = np.einsum("ij,pjn->pin", derivative, values) / half[..., None]
            return values.reshape(times.size, -1), rates.reshape(times.size, -1)

        states = system.run(flat)._states if path is None else np.concatenate(along("path", path), axis=1)
        changes = () if variation is None else along("variation", variation)
        parts = integrand(flat, states, *changes).reshape(times.shape) * weights * half
        found, size = float(parts.sum()), float(np.abs(parts).sum())
        if abs(found - last) <= _TOLERANCE * size:
            return found
        last, panels = found, 2 * panels
    what = "the motion" if path is None else "the path"
    raise ConvergenceError(f"the integral over {what} does not settle: expected it, and its variation, to be smooth")


def _path(name: str, given: Any) -> Callable[..., ArrayLike]:
    if not callable(given):
        raise InvalidInput(name, f"expected a function of times that gives coordinates, got {type(given).__name__}")
    path: Callable[..., ArrayLike] = given
    return path


def _sampled(system: GeneralizedSystem, name: str, given: Any, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give coordinates (T, n) of a path at times."""
    n = len(system.coordinates)
    values = float_array(name, _path(name, given)(t), None)
    if n == 1 and values.shape == t.shape:
        values = values[:, None]
    if values.shape != (len(t), n):
        raise InvalidInput(
            name, f"expected coordinates of shape ({len(t)}, {n}) at {len(t)} times, got shape {values.shape}"
        )
    return values


def _differentiation(nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the matrix that takes values at nodes to the slopes of their polynomial there."""
    apart = nodes[:, None] - nodes
    np.fill_diagonal(apart, 1.0)
    weights = 1.0 / apart.prod(axis=1)
    matrix = weights / weights[:, None] / apart
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    differentiation: NDArray[np.float64] = matrix
    return differentiation
