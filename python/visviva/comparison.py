"""Work against precision: what each method costs for what it is off, on a problem whose answer is known.

The one idea: full sweeps of steps and tolerances, so that no setting is picked; the time of a run alone, least of
several; the error of places against the reference and of the energy against the start. The envelope, the fastest of all
for each error, is what a user wants to know.
Source: Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, II.10.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from visviva._arrays import number, positive, whole_number
from visviva._html import Shown
from visviva._keywords import did_you_mean, known_keywords
from visviva._problem import Problem
from visviva._sweeps import Point, Runner
from visviva._text import article, count
from visviva.errors import InvalidInput
from visviva.integrators import Method
from visviva.integrators import methods as all_methods

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from visviva.typing import MethodName

__all__ = ["Point", "WorkPrecision", "work_precision"]

# Errors at which the table compares.
_MARKS = (1e-3, 1e-6, 1e-9, 1e-12)
# Lines that a column of a legend names.
_IN_A_COLUMN = 24


@known_keywords
@dataclass(frozen=True, slots=True)
class WorkPrecision(Shown):
    """Runs of a problem by several methods; the answer of `work_precision`. Print it, or plot it.

    Attributes
    ----------
    name : str
        The problem.
    points : tuple of Point

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.work_precision(vv.problems.figure_eight(), ["dop853", "kahan_li8"], seconds=0.005, repeats=1)
    >>> found.series
    ('dop853', 'kahan_li8')
    """

    name: str
    points: tuple[Point, ...]

    @property
    def series(self) -> tuple[str, ...]:
        """The methods, in the order in which they came."""
        return tuple(dict.fromkeys(point.series for point in self.points))

    def best(self, error: float, series: str | None = None) -> Point | None:
        """The fastest run whose position error is at most `error`; None if there is none.

        Parameters
        ----------
        error : float
            The largest position error, in the units of the problem's lengths.
        series : str, optional
            Only runs of this method.

        Returns
        -------
        Point or None
            Its time in seconds, its error in the units of the problem's lengths.

        Raises
        ------
        visviva.InvalidInput
            If `error` is not a number. An unknown series has no best run.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.WorkPrecision("none", ()).best(1e-6) is None
        True
        """
        limit = number("error", error)
        good = (p for p in self.points if p.position_error <= limit and series in (None, p.series))
        return min(good, key=lambda point: point.seconds, default=None)

    def envelope(self) -> tuple[Point, ...]:
        """The runs that no other beats in both time and error, from the least precise on.

        Returns
        -------
        tuple of Point
            With falling errors and rising times.

        Examples
        --------
        >>> import visviva as vv
        >>> three = [("a", 1.0, 1e-3), ("b", 2.0, 1e-6), ("c", 3.0, 1e-5)]
        >>> points = tuple(vv.Point(name, 0.1, seconds, error, error) for name, seconds, error in three)
        >>> [point.series for point in vv.WorkPrecision("three", points).envelope()]
        ['a', 'b']
        """
        front: list[Point] = []
        for point in sorted(self.points, key=lambda p: (p.seconds, p.position_error)):
            if not front or point.position_error < front[-1].position_error:
                front.append(point)
        return tuple(front)

    def joined(self, points: Iterable[Point]) -> WorkPrecision:
        """The same with more points, for example of another package.

        Parameters
        ----------
        points : iterable of Point
            What is put behind those that there are.

        Returns
        -------
        WorkPrecision

        Raises
        ------
        visviva.InvalidInput
            For what are no points.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.WorkPrecision("one", ()).joined([vv.Point("peer", 0.1, 2.0, 1e-6, 1e-7)]).best(1e-5).series
        'peer'
        """
        more = tuple(points) if isinstance(points, Iterable) else (points,)
        for point in more:
            if not isinstance(point, Point):
                raise InvalidInput(
                    "points",
                    f"expected several Point(series, setting, seconds, …), got {article(type(point).__name__)}",
                )
        return WorkPrecision(self.name, (*self.points, *more))

    def only(self, series: Iterable[str]) -> WorkPrecision:
        """The runs of some of the series, for a picture in which each line can be followed.

        Parameters
        ----------
        series : iterable of str
            Their names; the order stays.

        Returns
        -------
        WorkPrecision
            The runs of these series alone.

        Raises
        ------
        visviva.InvalidInput
            For a name that is no series of these runs.

        Examples
        --------
        >>> import visviva as vv
        >>> both = vv.WorkPrecision("two", (vv.Point("a", 0.1, 1.0, 1e-3, 1e-4), vv.Point("b", 0.1, 2.0, 1e-6, 1e-7)))
        >>> both.only(["b"]).series
        ('b',)
        """
        wanted = [series] if isinstance(series, str) or not isinstance(series, Iterable) else list(series)
        for name in wanted:
            if name not in self.series:
                near = did_you_mean(str(name), self.series)
                raise InvalidInput("series", f"expected some of {', '.join(self.series)}, got {name!r}{near}")
        return WorkPrecision(self.name, tuple(point for point in self.points if point.series in wanted))

    def __repr__(self) -> str:
        return f"WorkPrecision({self.name!r}, {count(len(self.series), 'method')}, {count(len(self.points), 'run')})"

    def __str__(self) -> str:
        head = f"{self.name:<24}" + "".join(f"{f'to {mark:g}':>12}" for mark in _MARKS) + f"{'best':>12}"
        lines = [head]
        for name in self.series:
            cells = (self.best(mark, name) for mark in _MARKS)
            shown = "".join(f"{'—' if cell is None else _seconds(cell.seconds):>12}" for cell in cells)
            least = min(p.position_error for p in self.points if p.series == name)
            lines.append(f"{name:<24}{shown}{least:>12.1e}")
        return "\n".join(lines)

    def plot(self, *, ax: Axes | None = None, peers: Iterable[str] = ()) -> Axes:
        """Time against error of places, a line for each method, the envelope marked.

        Exact answers, whose error is 0, are on no logarithmic axis and not drawn.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; in a figure of its own if not given.
        peers : iterable of str, optional
            Series that are drawn as another's: dashed, with open marks.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        visviva.InvalidInput
            If matplotlib is not installed; for what are no axes, several of them too: one problem is one picture.

        Examples
        --------
        >>> import visviva as vv
        >>> points = [vv.Point("rk4", 0.1 / k, 1e-3 * k, 1e-3 / k**4, 1e-3 / k**4) for k in (1, 2, 4)]
        >>> vv.WorkPrecision("test", tuple(points)).plot().get_xscale()
        'log'
        """
        from visviva._style import legend_beside
        from visviva.plot import given_axes, new_figure

        columns = 1 + len(self.series) // _IN_A_COLUMN
        axes = new_figure(1, (6.0 + 1.3 * columns, 5.0))[1][0] if ax is None else given_axes(ax)
        if isinstance(peers, str) or not isinstance(peers, Iterable):
            raise InvalidInput("peers", f"expected names of series, as in ('REBOUND',), got {peers!r}")
        others = frozenset(peers)
        front = [point for point in self.envelope() if point.position_error > 0.0]
        axes.plot(
            [p.position_error for p in front],
            [p.seconds for p in front],
            color="0.85",
            linewidth=7.0,
            solid_capstyle="round",
            zorder=0,
            label="best of all",
        )
        for name in self.series:
            own = [p for p in self.points if p.series == name and p.position_error > 0.0]
            # As it was swept, from the roughest setting on: in the order of times their noise would be drawn as a path.
            own.sort(key=lambda point: -point.setting)
            style: dict[str, Any] = (
                {"linestyle": "--", "marker": "s", "markerfacecolor": "none"} if name in others else {"marker": "o"}
            )
            axes.plot(
                [p.position_error for p in own],
                [p.seconds for p in own],
                markersize=3.0,
                linewidth=1.0,
                label=name,
                **style,
            )
        axes.set(xscale="log", yscale="log", xlabel="error of positions", ylabel="seconds", title=self.name)
        axes.invert_xaxis()
        axes.grid(alpha=0.3)
        # Beside the lines, which are everywhere within.
        legend_beside(axes, columns=columns, fontsize="x-small")
        return axes


@known_keywords
def work_precision(
    problem: Problem,
    methods: Iterable[MethodName | Method] | None = None,
    *,
    seconds: float = 0.5,
    repeats: int = 3,
    threads: int = 1,
) -> WorkPrecision:
    """Run a problem by several methods over all their steps or tolerances: time against error.

    Methods that choose their steps are given relative tolerances from 10⁻² down to 2.3·10⁻¹⁴, two in a decade; those of
    fixed steps, whole numbers of steps from 16 up, each √2 times the last, until no more is gained. Nothing is recorded
    but the end. A closed form is used by the method "auto" alone.

    Parameters
    ----------
    problem : Problem
        One of `visviva.problems`, with a reference at its end.
    methods : iterable of str or Method, optional
        By default all that the scene's forces allow.
    seconds : float, optional
        A method is taken no further once two runs in turn take so long, in seconds.
    repeats : int, optional
        Runs for each time, of which the least is taken.
    threads : int, optional

    Returns
    -------
    WorkPrecision

    Raises
    ------
    visviva.InvalidInput
        For what is no problem, one that has no reference at its end, a method that there is not or that the forces of
        the scene do not allow, or a time or a number of repeats that is not positive.

    References
    ----------
    Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.10.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.work_precision(vv.problems.kepler(e=0.6), ["dop853", "leapfrog"], seconds=0.01, repeats=1)
    >>> found.best(1e-6).series
    'dop853'
    """
    if not isinstance(problem, Problem):
        raise InvalidInput("problem", f"expected one of visviva.problems, got {type(problem).__name__}")
    if problem.t_end not in [reference.t for reference in problem.references]:
        raise InvalidInput(
            "problem", f"expected a reference at the end, but {problem.name} has none at {problem.t_end}"
        )
    limit, times = positive("seconds", seconds), whole_number("repeats", repeats, low=1)
    known = {method.name: method for method in all_methods()}
    names = list(known) if methods is None else [m.name if isinstance(m, Method) else m for m in methods]
    if not names:
        raise InvalidInput("methods", "expected one or more methods, got none; leave it out for all")
    run = Runner(problem, limit, times, whole_number("threads", threads, low=1))
    points: list[Point] = []
    for name in names:
        if name != "auto":
            try:
                problem.scene.plan(
                    problem.t_end,
                    method=name,
                    dt=None if name in known and known[name].adaptive else problem.t_end / 16,
                )
            except InvalidInput:
                if methods is not None:
                    raise
                continue
        points.extend(run.closed() if name == "auto" else run.sweep(known[name]))
    return WorkPrecision(problem.name, tuple(points))


def _seconds(value: float) -> str:
    for size, unit in ((1e-3, "µs"), (1.0, "ms")):
        if value < size:
            return f"{value / size * 1e3:.3g} {unit}"
    return f"{value:.3g} s"


def __dir__() -> list[str]:
    return list(__all__)
