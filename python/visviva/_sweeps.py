"""Full sweeps of steps and tolerances over a problem: what each run took and what it is off."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from math import inf, isfinite, nan
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import AccuracyWarning, Error, InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

    from visviva._problem import Problem
    from visviva.integrators import Method
    from visviva.trajectory import Trajectory

_TIGHTEST = 2.3e-14
# After so many steps that got no better, smaller ones are at the rounding.
_NO_BETTER = 4


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Point(Record):
    """One run.

    Attributes
    ----------
    series : str
        The method.
    setting : float
        Its step, in the units of the problem, or its relative tolerance.
    seconds : float
        What the run took, in seconds, the least of several.
    position_error : float
        The largest distance of a body from its reference at the end, in the units of the problem.
    energy_error : float
        |E − E₀|/|E₀| there; NaN where the scene does not conserve its energy, or a peer did not tell.

    Examples
    --------
    >>> import visviva as vv
    >>> point = vv.Point("rk4", setting=0.01, seconds=2e-3, position_error=1e-8, energy_error=1e-9)
    >>> point.series, point.position_error
    ('rk4', 1e-08)
    """

    series: str
    setting: float
    seconds: float
    position_error: float
    energy_error: float


@dataclass(frozen=True, slots=True)
class Runner:
    """Runs of one problem."""

    problem: Problem
    limit: float
    repeats: int
    threads: int

    def closed(self) -> Iterator[Point]:
        """The scene as it is run without a method."""
        point, _ = self.point("auto", nan, {})
        if point is not None:
            yield point

    def sweep(self, method: Method) -> Iterator[Point]:
        """All settings, as far as they gain something."""
        least, no_better, slow = inf, 0, 0
        for setting in self.settings(method):
            how = {"rtol": setting} if method.adaptive else {"dt": setting}
            point, took = self.point(method.name, setting, {"method": method.name, **how})
            slow = slow + 1 if took > self.limit else 0
            if point is not None:
                yield point
                no_better = 0 if point.position_error < 0.9 * least else no_better + 1
                least = min(least, point.position_error)
            # One slow run may have been held up.
            if slow == 2 or (no_better >= _NO_BETTER and least < 1e-6):
                return

    def settings(self, method: Method) -> Iterator[float]:
        if method.adaptive:
            yield from (max(10.0 ** (-0.5 * k), _TIGHTEST) for k in range(4, 28))
        else:
            span = self.problem.t_end - self.problem.scene.t0
            yield from (span / round(16.0 * 2.0 ** (0.5 * k)) for k in range(60))

    def point(self, name: str, setting: float, how: dict[str, Any]) -> tuple[Point | None, float]:
        """A run and its errors, None if it did not come to its end or nowhere near; and the seconds it took."""
        scene, end = self.problem.scene, self.problem.t_end
        took, out = inf, None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # rough steps are meant
            for _ in range(self.repeats):
                begun = perf_counter()
                try:
                    out = scene.run(end, threads=self.threads, **how)
                except InvalidInput:
                    raise
                except Error:
                    return None, perf_counter() - begun
                took = min(took, perf_counter() - begun)
                if took > self.limit:
                    break
        assert out is not None
        error = self.problem.error(out)
        size = float(np.abs(self.problem.references[0].position).max())
        if not isfinite(error) or error > size:
            return None, took
        return Point(name, setting, took, error, self.energy_error(out)), took

    def energy_error(self, out: Trajectory) -> float:
        scene = self.problem.scene
        p = scene.particles
        keeps = _core.conserves(
            mass=p.mass,
            forces=scene._keywords["forces"],
            position=p.position,
            velocity=p.velocity,
            about=np.zeros(3),
        )
        if not keeps["energy"]:
            return nan
        start = scene.invariants().energy
        return abs(out.final.invariants().energy - start) / (abs(start) or 1.0)
