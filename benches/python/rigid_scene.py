"""Rigid bodies in a scene, stepped: what a step costs, alone and by the hundred thousand, and what 10⁷ of them leave.

Costs of steps are differences between a long and a short run, so that what every run takes once is not counted; against
other codes whole runs are timed, ours with the least work that leaves no larger an error than theirs; bars are of what
a run does that names no method. References have 34 digits (see `rigid.py` and `tests/rigid`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from _harness import Row, at_most, faster, minima, report
from _rigid_peers import END, MOMENTS, MOMENTUM, TOP_END, TOP_GRAVITY, TOP_MASS, TOP_SPIN, free_bodies, tops

import visviva as vv
from rigid import off

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SPIN = MOMENTUM / MOMENTS
BARS = {"SciPy DOP853 1e-09": 50.0, "SciPy DOP853 1e-12": 200.0}
TOP_CENTER = np.array([-0.1504168227456418, -0.7241655916368957, -0.6730222695604441])
COPIES, STEPS = 100_000, 1000
LONG = 10_000_000


def free() -> vv.Scene:
    return vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN))


def top() -> vv.Scene:
    """Of Brüls, Cardona & Arnold (2012)."""
    inertia = np.diag([0.234375, 0.46875, 0.234375])
    body = vv.RigidBody(TOP_MASS, inertia=inertia, position=[0, 1, 0], angular_velocity=TOP_SPIN, pivot=[0, -1, 0])
    return vv.Scene(body, vv.UniformField([0.0, 0.0, -TOP_GRAVITY]))


def rows() -> Iterator[Row]:
    yield from steps()
    yield from against_others()
    yield from heavy_top()
    yield from many()
    yield from long_run()


def per_step(scene: Any, steps: int, **how: Any) -> float:
    """Seconds that one step takes."""
    dt = how["dt"]
    short, long = minima(
        lambda: scene.run(t=steps * dt, **how, record=()), lambda: scene.run(t=11 * steps * dt, **how, record=())
    )
    return (long - short) / (10 * steps)


def steps() -> Iterator[Row]:
    for method in ("moser_veselov8", "moser_veselov10"):
        for dt in (0.1, 0.02):
            rate = 1e-6 / per_step(free(), 1000, method=method, dt=dt)
            error = off(free().run(t=100.0, method=method, dt=dt).orientation[-1, 0])
            what = f"free body, {method}, h = {dt:g}: million steps a second"
            note = f"angle {error:.0e} off at t = 100; MuJoCo RK4 0.13 to 0.2"
            barred = dt == 0.1 and method == "moser_veselov8"
            yield Row(what, f"{rate:.2f}", note, "", "≥ 2.5" if barred else "", rate >= 2.5 if barred else None)


@dataclass(frozen=True)
class Run:
    """How a scene is run, and what that leaves and takes."""

    name: str
    how: dict[str, Any]
    error: float
    seconds: float


def ladder(
    scene: vv.Scene, t: float, methods: tuple[str, ...], error: Callable[[Any], float], steps: tuple[int, int]
) -> list[Run]:
    """Runs by methods in ever more steps."""
    found = []
    for method in methods:
        for count in sorted({round(n) for n in np.geomspace(*steps, 40)}):
            how = {"method": method, "dt": t / count}
            (seconds,) = minima(lambda how=how: scene.run(t=t, **how), repeats=3)
            found.append(Run(f"{count} steps of {method}", how, error(scene.run(t=t, **how)), seconds))
    return found


def at_equal_error(
    what: str, scene: vv.Scene, t: float, runs: list[Run], peer: tuple[Callable[[], object], float], bar: float | None
) -> Iterator[Row]:
    """The peer beside the least work that leaves no larger an error; nothing where none of these runs does."""
    theirs, largest = peer
    good = [run for run in runs if run.error <= largest]
    if good:
        run = min(good, key=lambda run: run.seconds)
        ours, seconds = minima(lambda: scene.run(t=t, **run.how), theirs)
        sides = (f"{ours * 1e6:.0f} µs, error {run.error:.0e}", f"{seconds * 1e3:.2f} ms, error {largest:.0e}")
        yield faster(f"{what}: {run.name}", *sides, seconds / ours, bar)


def against_others() -> Iterator[Row]:
    scene = free()

    def error(out: Any) -> float:
        return off(out.orientation[-1, 0])

    stepped = ladder(scene, END, ("moser_veselov8", "moser_veselov10"), error, (200, 8000))
    exact = [Run("closed form", {}, error(scene.run(t=END)), 0.0)]
    for name, peer in free_bodies():
        what = f"free body to t = {END:g}, against {name}"
        for runs, bar in ((stepped, None), (exact, BARS.get(name))):
            yield from at_equal_error(what, scene, END, runs, (peer, off(peer())), bar)


def heavy_top() -> Iterator[Row]:
    scene, how = top(), {"method": "kahan_li8", "dt": 1 / 32}

    def error(center: np.ndarray) -> float:
        return float(np.abs(center - TOP_CENTER).max())

    seconds = 64 * per_step(scene, 64, **how)
    note = f"center {error(scene.run(t=TOP_END, **how).position[-1, 0]):.0e} off"
    yield at_most(
        "Brüls–Cardona top, 2 s in 64 steps of kahan_li8, inside one run", seconds * 1e6, 150.0, " µs", note, ".0f"
    )
    runs = ladder(scene, TOP_END, ("kahan_li8",), lambda out: error(out.position[-1, 0]), (20, 400))
    for name, peer in tops():
        theirs = error(vv.rigid.rotate(peer(), np.array([0.0, 1.0, 0.0])))
        yield from at_equal_error(f"the top, a whole run, against {name}", scene, TOP_END, runs, (peer, theirs), None)


def many() -> Iterator[Row]:
    spins = SPIN * (1.0 + np.random.default_rng(1).uniform(0.0, 0.2, (COPIES, 1, 1)))
    copies = free().ensemble(angular_velocity=spins)
    how = {"t": STEPS * 0.1, "method": "moser_veselov8", "dt": 0.1, "record": ("orientation",)}
    one, two = minima(lambda: copies.run(**how, threads=1), lambda: copies.run(**how, threads=2), repeats=2)
    efficiency = one / two / 2
    what = f"{COPIES} bodies × {STEPS} steps"
    yield Row(
        f"{what}: efficiency of two threads",
        f"{two:.1f} s",
        f"{one:.1f} s on one",
        f"{efficiency:.2f}",
        "≥ 0.85",
        efficiency >= 0.85,
    )
    alone = per_step(free(), 1000, method="moser_veselov8", dt=0.1)
    ratio = alone / (one / COPIES / STEPS)
    sides = (f"{one / COPIES / STEPS * 1e9:.0f} ns", f"alone {alone * 1e9:.0f} ns")
    yield faster(f"{what}: a body's step on one core", *sides, ratio, 4.0)
    same = np.array_equal(copies.run(**how, threads=1).orientation, copies.run(**how, threads=2).orientation)
    yield Row(f"{what}: the same bits on one thread and on two", str(same), "", "", "True", same)


def long_run() -> Iterator[Row]:
    """Steps of a tenth of a body whose center is held: what rounding leaves of what turns keep.

    The growth is that of where the walk stands above the rounding of an output, from 10⁵ steps on.
    """
    held = vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN, pivot=[0, 0, 0]))
    random = np.random.default_rng(5)
    spins = SPIN * (1.0 + 0.2 * random.uniform(-1.0, 1.0, (64, 1, 3)))
    t = 0.1 * np.array([0, *np.round(np.geomspace(LONG / 100, LONG, 33))])
    for method in ("leapfrog", "moser_veselov8"):
        out = held.ensemble(angular_velocity=spins).run(t=t, method=method, dt=0.1)
        energy = np.abs(out.energy / out.energy[:, :1] - 1.0)
        momentum = np.linalg.norm(out.angular_momentum - out.angular_momentum[:, :1], axis=-1)
        momentum /= np.linalg.norm(out.angular_momentum[:, :1], axis=-1)
        length = np.abs(np.linalg.norm(out.orientation, axis=-1) - 1.0).max()
        name = "exact turns" if method == "leapfrog" else method
        yield at_most(f"10⁷ steps of {name}: energy, worst of 64", energy[:, -1].max(), 1e-12, "")
        yield at_most(f"10⁷ steps of {name}: angular momentum", momentum.max(), 1e-13, "")
        yield at_most(f"10⁷ steps of {name}: |q| − 1", length, 4 * np.finfo(float).eps, "")
        rms = np.sqrt((energy**2).mean(axis=0))[1:]
        growth = np.polyfit(np.log(t[1:]), np.log(rms), 1)[0]
        yield Row(
            f"10⁷ steps of {name}: growth of the rms energy",
            f"t^{growth:.2f}, {rms[-1]:.1e} at the end",
            "",
            "",
            "0.5 ± 0.1",
            abs(growth - 0.5) <= 0.1,
        )


if __name__ == "__main__":
    report(
        "Rigid bodies in a scene",
        rows(),
        "Steps of a free body by a discrete motion, of a heavy top, of 10⁵ bodies on two threads, and 10⁷ in a row.",
    )
