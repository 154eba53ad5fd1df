"""Rigid bodies in a scene, stepped: what a step costs, alone and by the hundred thousand, and what 10⁷ of them leave.

Costs of steps are differences between a long and a short run, so that what every run takes once is not counted; against
SciPy and MuJoCo whole runs are timed. References have 34 digits (see `rigid.py` and `tests/rigid`).
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np
from _harness import Row, at_most, faster, minima, report

import visviva as vv
from rigid import MOMENTS, MOMENTUM, mujoco_attitude, off, scipy_attitude

if TYPE_CHECKING:
    from collections.abc import Iterator

SPIN = MOMENTUM / MOMENTS
TOP_CENTER = np.array([-0.1504168227456418, -0.7241655916368957, -0.6730222695604441])
COPIES, STEPS = 100_000, 1000
LONG = 10_000_000


def free() -> vv.Scene:
    return vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN))


def top() -> vv.Scene:
    """Of Brüls, Cardona & Arnold (2012)."""
    inertia = np.diag([0.234375, 0.46875, 0.234375])
    body = vv.RigidBody(
        15.0, inertia=inertia, position=[0, 1, 0], angular_velocity=[0.0, 150.0, -4.61538], pivot=[0, -1, 0]
    )
    return vv.Scene(body, vv.UniformField([0.0, 0.0, -9.81]))


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


def against_others() -> Iterator[Row]:
    scene = free()
    for rtol, bar, how in (
        (1e-9, 50.0, {"method": "moser_veselov10", "dt": 0.1}),
        (1e-12, 200.0, {"method": "moser_veselov10", "dt": 0.05}),
        (1e-12, 200.0, {}),
    ):
        peer = scipy_attitude(rtol)
        ours, theirs = minima(lambda how=how: scene.run(t=100.0, **how), peer)
        here, there = off(scene.run(t=100.0, **how).orientation[-1, 0]), off(peer())
        name = how.get("method", "closed form")
        sides = (f"{ours * 1e6:.0f} µs, error {here:.0e}", f"{theirs * 1e3:.1f} ms, error {there:.0e}")
        yield faster(f"free body to t = 100 by {name}, against SciPy DOP853 {rtol:g}", *sides, theirs / ours, bar)
    if find_spec("mujoco"):
        peer = mujoco_attitude(1e-3)
        ours, theirs = minima(lambda: scene.run(t=100.0, method="moser_veselov10", dt=0.05), peer)
        sides = (f"{ours * 1e6:.0f} µs", f"{theirs * 1e3:.1f} ms, error {off(peer()):.0e}")
        yield faster("the same, against MuJoCo RK4, h = 1e-3", *sides, theirs / ours, None)


def heavy_top() -> Iterator[Row]:
    scene, how = top(), {"method": "kahan_li8", "dt": 1 / 32}
    seconds = 64 * per_step(scene, 64, **how)
    error = np.abs(scene.run(t=2.0, **how).position[-1, 0] - TOP_CENTER).max()
    note = f"center {error:.0e} off; MuJoCo RK4 0.95 s for 3e-12"
    yield at_most(
        "Brüls–Cardona top, 2 s in 64 steps of kahan_li8, inside one run", seconds * 1e6, 150.0, " µs", note, ".0f"
    )


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
    """Steps of a hundredth of a body whose center is held: the exact turn, and what its rounding leaves."""
    held = vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN, pivot=[0, 0, 0]))
    spins = SPIN * (1.0 + np.arange(32)[:, None, None] / 320)
    t = 0.01 * np.array([0, *np.round(np.geomspace(1e3, LONG, 17))])
    for method in ("leapfrog", "moser_veselov8"):
        out = held.ensemble(angular_velocity=spins).run(t=t, method=method, dt=0.01)
        energy = np.abs(out.energy / out.energy[:, :1] - 1.0)
        momentum = np.linalg.norm(out.angular_momentum - out.angular_momentum[:, :1], axis=-1)
        momentum /= np.linalg.norm(out.angular_momentum[:, :1], axis=-1)
        length = np.abs(np.linalg.norm(out.orientation, axis=-1) - 1.0).max()
        name = "exact turns" if method == "leapfrog" else method
        yield at_most(f"10⁷ steps of {name}: energy, worst of 32", energy[:, -1].max(), 1e-12, "")
        yield at_most(f"10⁷ steps of {name}: angular momentum", momentum.max(), 1e-13, "")
        yield at_most(f"10⁷ steps of {name}: |q| − 1", length, 4 * np.finfo(float).eps, "")
        rms = np.sqrt((energy**2).mean(axis=0))[1:]
        growth = np.polyfit(np.log(t[1:]), np.log(rms), 1)[0]
        yield Row(
            f"10⁷ steps of {name}: growth of the rms energy",
            f"t^{growth:.2f}",
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
