"""What ``visviva pendulum`` shows: one pendulum against elliptic functions, and many double pendulums that part."""

from __future__ import annotations

from importlib.util import find_spec
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

import visviva as vv
from visviva._style import VERMILION
from visviva.plot import new_figure

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["pendulum"]

#: The modulus: the pendulum starts at 2 asin k = 174.9° and stays near the top for most of its time.
_MODULUS = 0.999
_GRAVITY = 9.81
#: How far apart the starts of the double pendulums are, in rad.
_APART = 1e-9


def pendulum(output: Path, members: int, threads: int | None) -> list[Path]:
    """Run both; print tables and draw pictures."""
    single = _against_elliptic_functions()
    many = _parting(members, threads)
    if find_spec("matplotlib") is None:
        return []
    path = output / "pendulum.png"
    figure, (left, right) = new_figure(2, (11.0, 4.0))
    t, theta, error = single
    left.plot(t, theta)
    left.set(xlabel="t [s]", ylabel="θ [rad]", title=f"Pendulum at k = {_MODULUS}")
    residual = left.twinx()
    residual.semilogy(t, np.maximum(error, 1e-17), ".", markersize=2, color=VERMILION)
    residual.set_ylabel("error against elliptic functions [rad]", color=VERMILION)
    residual.set_ylim(1e-17, 1e-6)
    t, spread = many
    right.semilogy(t, np.maximum(spread, 1e-16))
    right.set(xlabel="t [s]", ylabel="median distance [rad]", title=f"{members} double pendulums, {_APART:g} rad apart")
    figure.savefig(path, dpi=150)
    return [path]


def _against_elliptic_functions() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Run one pendulum over ten periods."""
    system = vv.systems.pendulum(position=[2.0 * np.arcsin(_MODULUS)], g=_GRAVITY, l=1.0)
    period = system.period()
    t = np.linspace(0.0, 10.0 * period, 1001)
    begin = perf_counter()
    out = system.run(t)
    seconds = perf_counter() - begin
    exact = 2.0 * np.arcsin(_MODULUS * _sine_amplitude(np.sqrt(_GRAVITY) * (t + 0.25 * period), _MODULUS))
    error = np.abs(out["theta"] - exact)
    print(f"One pendulum from {np.degrees(2 * np.arcsin(_MODULUS)):.2f}°, by its Lagrangian, over ten periods")
    print(f"  period by quadrature       {period:.15f} s")
    print(f"  4 K(k) √(l/g)              {2 * np.pi / _mean(1.0, np.sqrt(1 - _MODULUS**2)) / np.sqrt(_GRAVITY):.15f} s")
    print(f"  largest error of the angle {error.max():.1e} rad, of the energy {max(out.conservation().values()):.1e}")
    print(f"  {out.steps} steps of gauss16, {out.evaluations} evaluations, {1e3 * seconds:.2f} ms with 1001 outputs\n")
    return t, out["theta"], error


def _parting(members: int, threads: int | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Run double pendulums from starts that are next to each other."""
    system = vv.systems.double_pendulum(position=[2.0, 2.5])
    starts = np.array([2.0, 2.5]) + _APART * np.linspace(-1.0, 1.0, members)[:, None]
    t = np.linspace(0.0, 20.0, 201)
    begin = perf_counter()
    out = system.ensemble(position=starts).run(t, threads=threads)
    seconds = perf_counter() - begin
    first = out.position[members // 2]
    spread = np.median(np.abs(out.position - first).max(axis=2), axis=0)
    drift = np.ptp(out.energy, axis=1).max() / np.abs(out.energy).max()
    exponent = system.lyapunov_exponents(50.0)[0]
    print(f"{members} double pendulums from (2, 2.5) rad, {_APART:g} rad apart")
    for second in (0, 5, 10, 15, 20):
        print(f"  t = {second:2d} s: median distance {spread[10 * second]:.1e} rad")
    print(f"  largest change of an energy {drift:.1e}; largest Lyapunov exponent over 50 s {exponent:.2f} / s")
    rates = f"{members / seconds:.0f} trajectories/s, {out.evaluations.sum() / seconds:.3g} evaluations/s"
    print(f"  {seconds:.3f} s, {rates}")
    return t, spread


def _mean(a: float, b: float) -> float:
    """Give the arithmetic-geometric mean."""
    while abs(a - b) > 1e-15 * a:
        a, b = 0.5 * (a + b), float(np.sqrt(a * b))
    return a


def _sine_amplitude(u: NDArray[np.float64], k: float) -> NDArray[np.float64]:
    """Jacobi's sn(u, k) by the descending scale of means (Abramowitz & Stegun, 16.4)."""
    a, b, c = [1.0], [np.sqrt((1.0 - k) * (1.0 + k))], [k]
    while abs(c[-1]) > 2e-16:
        a.append(0.5 * (a[-1] + b[-1]))
        c.append(0.5 * (a[-2] - b[-1]))
        b.append(np.sqrt(a[-2] * b[-1]))
    steps = len(a) - 1
    # Whole periods leave the sine as it is.
    quarter = 0.5 * np.pi / a[-1]
    angle = 2.0**steps * a[-1] * (u - 4.0 * quarter * np.round(u / (4.0 * quarter)))
    for step in range(steps, 0, -1):
        angle = 0.5 * (angle + np.arcsin(c[step] / a[step] * np.sin(angle)))
    return np.sin(angle)


def __dir__() -> list[str]:
    return list(__all__)
