"""What `solve_ivp` gives: SciPy's fields, asked by attribute or as of a dictionary, and the solution between nodes."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Literal, overload

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._html import Record, Shown
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

__all__ = ["OdeResult", "OdeSolution"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OdeSolution(Shown):
    """The solution between its nodes: a polynomial for each step.

    Attributes
    ----------
    ts : ndarray, shape (S + 1,)
        The nodes, in the units of the problem.
    n_segments : int
        The steps, S.
    t_min, t_max : float
        The ends of the span that it is good for; beyond them it is what the outermost steps say.

    References
    ----------
    Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.6 (dense output).

    Examples
    --------
    >>> import visviva as vv
    >>> solution = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), [1.0], rtol=1e-10, atol=1e-12, dense_output=True).sol
    >>> abs(float(solution(1.0)[0]) - 0.36787944117) < 1e-9
    True
    """

    ts: NDArray[np.float64]
    _extension: tuple[NDArray[np.float64], ...]

    def __post_init__(self) -> None:
        made_by(self, "visviva.solve_ivp(..., dense_output=True)", ts=(self.ts, np.ndarray))
        # The solution is evaluated with them.
        self.ts.setflags(write=False)

    @property
    def n_segments(self) -> int:
        """The steps, each of which has its polynomial.

        Examples
        --------
        >>> import visviva as vv
        >>> solution = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), [1.0], dense_output=True).sol
        >>> solution.n_segments == len(solution.ts) - 1
        True
        """
        return len(self.ts) - 1

    @property
    def t_min(self) -> float:
        """The smaller end of the span, in the units of the problem's time.

        Examples
        --------
        >>> import visviva as vv
        >>> solution = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), [1.0], dense_output=True).sol
        >>> solution.t_min
        0.0
        """
        return float(min(self.ts[0], self.ts[-1]))

    @property
    def t_max(self) -> float:
        """The larger end of the span, in the units of the problem's time.

        Examples
        --------
        >>> import visviva as vv
        >>> solution = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), [1.0], dense_output=True).sol
        >>> solution.t_max
        5.0
        """
        return float(max(self.ts[0], self.ts[-1]))

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """Evaluate the solution: shape (n,) at one time, (n, T) at T times.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            Times, in the units of the problem, in any order.

        Returns
        -------
        ndarray, shape (n,) or (n, T)
            States there.

        Raises
        ------
        visviva.InvalidInput
            For an array of more than one axis, NaN or infinity.

        Examples
        --------
        >>> import visviva as vv
        >>> decay = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), [1.0, 2.0], rtol=1e-10, dense_output=True)
        >>> decay.sol([0.0, 1.0]).round(6)
        array([[1.      , 0.367879],
               [2.      , 0.735759]])
        """
        times = float_array("t", t, None)
        if times.ndim > 1:
            raise InvalidInput("t", f"expected one time or an array of times, got shape {times.shape}")
        states = _core.interpolate(self._extension, times.reshape(-1))
        return states[0] if times.ndim == 0 else states.T

    def __repr__(self) -> str:
        return f"<OdeSolution of {self.n_segments} steps from t = {self.ts[0]} to {self.ts[-1]}>"


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OdeResult(Record):
    """What `solve_ivp` gives, with the fields of SciPy's result.

    Attributes
    ----------
    t : ndarray, shape (T,)
        Times: the nodes, or `t_eval` as far as the run came, in the units of the problem.
    y : ndarray, shape (n, T)
        States there.
    sol : OdeSolution or None
        The solution as a function of time, if `dense_output`.
    t_events : list of ndarray or None
        For each event the times of its zeros, shape (K,).
    y_events : list of ndarray or None
        The states there, one in a row, shape (K, n).
    nfev : int
        Evaluations of the right-hand side.
    njev, nlu : int
        Always 0: no method here takes Jacobians.
    status : int
        0 at the end of the span, 1 at an event that ends the run, -1 if the run could not go on.
    message : str
        The same in words.
    success : bool
        Whether `status` is not -1.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], rtol=1e-10, atol=1e-12)
    >>> found.status, found.success, found["y"][:, -1].round(9)
    (0, True, array([0.36787944]))
    """

    t: NDArray[np.float64]
    y: NDArray[np.float64]
    sol: OdeSolution | None
    t_events: list[NDArray[np.float64]] | None
    y_events: list[NDArray[np.float64]] | None
    nfev: int
    njev: int
    nlu: int
    status: int
    message: str
    success: bool

    @overload
    def __getitem__(self, name: Literal["t", "y"]) -> NDArray[np.float64]: ...
    @overload
    def __getitem__(self, name: Literal["sol"]) -> OdeSolution | None: ...
    @overload
    def __getitem__(self, name: Literal["t_events", "y_events"]) -> list[NDArray[np.float64]] | None: ...
    @overload
    def __getitem__(self, name: Literal["nfev", "njev", "nlu", "status"]) -> int: ...
    @overload
    def __getitem__(self, name: Literal["message"]) -> str: ...
    @overload
    def __getitem__(self, name: Literal["success"]) -> bool: ...
    def __getitem__(self, name: str) -> object:
        if name not in self.keys():
            raise KeyError(name)
        return getattr(self, name)

    def keys(self) -> list[str]:
        """Names of the fields, so that ``dict(result)`` works.

        Returns
        -------
        list of str
            In the order of SciPy's fields.

        Examples
        --------
        >>> import visviva as vv
        >>> "y" in vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).keys()
        True
        """
        return [field.name for field in fields(self)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def get(self, name: str, default: object = None) -> object:
        """Give a field by name, or something else where there is none of that name.

        Parameters
        ----------
        name : str
            The name.
        default : object, optional
            What is given in its place.

        Returns
        -------
        object

        Examples
        --------
        >>> import visviva as vv
        >>> vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).get("status")
        0
        """
        return getattr(self, name) if isinstance(name, str) and name in self.keys() else default

    def values(self) -> list[object]:
        """All fields, in the order of their names.

        Returns
        -------
        list
            What each field holds.

        Examples
        --------
        >>> import visviva as vv
        >>> len(vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).values())
        11
        """
        return [getattr(self, name) for name in self]

    def items(self) -> list[tuple[str, object]]:
        """Names and fields.

        Returns
        -------
        list of tuple
            Pairs of a name and what the field holds.

        Examples
        --------
        >>> import visviva as vv
        >>> dict(vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).items())["success"]
        True
        """
        return [(name, getattr(self, name)) for name in self]

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the components of the state against time: `sol` if it is there, else marks at the times of `t`.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes
            Without `sol` nobody knows the way between times, and lines join them only to guide the eye.

        Raises
        ------
        visviva.InvalidInput
            If there is no time, or matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.solve_ivp(lambda t, y: [y[1], -y[0]], (0.0, 6.0), [1.0, 0.0], dense_output=True)
        >>> [line.get_label() for line in found.plot().lines]
        ['y[0]', 'y[1]']
        """
        from visviva._style import legend_beside
        from visviva.plot import LEGEND, POINTS, axes_or_new

        if not len(self.t):
            raise InvalidInput("plot", "expected a result with times, got none")
        axes = axes_or_new(ax)
        t, y, marks = self.t, self.y, "."
        if self.sol is not None:
            t = np.linspace(self.t[0], self.t[-1], POINTS)
            y, marks = self.sol(t), ""
        for at, component in enumerate(y):
            axes.plot(t, component, marker=marks, markersize=3, linewidth=0.8, label=f"y[{at}]")
        axes.set(xlabel="t", ylabel="y")
        if 1 < len(y) <= LEGEND:
            legend_beside(axes)
        return axes

    def __repr__(self) -> str:
        return (
            f"OdeResult(status={self.status}, message={self.message!r}, nfev={self.nfev}, t of {len(self.t)}, "
            f"y of shape {np.shape(self.y)})"
        )
