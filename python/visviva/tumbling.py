"""What ``visviva toutatis`` and ``visviva dzhanibekov`` show: bodies that turn freely, with tables and pictures."""

from __future__ import annotations

from datetime import datetime, timedelta
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np

import visviva as vv
from visviva._arrays import whole_number
from visviva._residuals import new_panels
from visviva._style import FRAME
from visviva.errors import InvalidInput
from visviva.plot import new_figure
from visviva.rigid import _pictures

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["dzhanibekov", "toutatis"]

# The case of the tests of Principia has the moments (3, 5, 9), which no body has: 9 > 3 + 5. Adding one number to each
# 1/I, here 1/15, leaves the angular momentum as the body sees it as it was, and so the flips.
_MOMENTS = np.array([2.5, 3.75, 5.625])
_MOMENTUM = np.array([0.0, 2.0, 0.01])
_MOST_FLIPS = 1000
# Lines of a table, and decades of days of which dates are known.
_ROWS = 15
_MOST_DAYS = 1e6


def toutatis(output: Path, days: float) -> list[Path]:
    """Follow 4179 Toutatis from its published spin state; print its periods, its attitude and what radar saw of it."""
    if not 0.0 < days <= _MOST_DAYS:
        raise InvalidInput("days", f"expected a number above 0 and up to {_MOST_DAYS:g}, got {days}")
    data = vv.datasets.toutatis()
    path = vv.rigid.polhode(data.moments, data.angular_velocity)
    print(f"4179 Toutatis from {data.epoch} UTC ({data.source})")
    print("published: ratios of the moments, angular velocity and attitude at that time, attitudes by radar")
    print("computed: everything below, as a free rotation in closed form; torques of Sun and Earth are left out\n")
    print(f"around its long axis, relative to the body (polhode)   {path.period:.14g} days")
    print(f"long axis around the angular momentum, on average      {2 * np.pi / path.precession_rate:.14g} days")
    out = data.motion(np.linspace(0.0, days, _ROWS))
    angles = np.degrees(vv.rigid.euler_angles(out.orientation)) % 360.0
    along = vv.rigid.rotate(out.orientation, [0.0, 0.0, 1.0])
    longitude, latitude = np.degrees(np.arctan2(along[:, 1], along[:, 0])) % 360.0, np.degrees(np.arcsin(along[:, 2]))
    print(f"\n{'UTC':<18}{'φ':>8}{'θ':>8}{'ψ':>8}   [degrees, z–x–z]   long axis: longitude, latitude in the ecliptic")
    start = datetime.fromisoformat(data.epoch)
    for t, (phi, theta, psi), east, north in zip(out.t, angles, longitude, latitude, strict=True):
        date = (start + timedelta(days=float(t))).strftime("%Y-%m-%dT%H:%M")
        print(f"{date:<18}{phi:>8.2f}{theta:>8.2f}{psi:>8.2f}{'':>32}{east:>10.2f}{north:>10.2f}")
    found = data.compare()
    print(f"\nagainst what radar saw:\n{found}")
    drift = out.angular_momentum - out.angular_momentum[0]
    size = np.linalg.norm(out.angular_momentum[0])
    print(f"\nangular momentum in space stays to {np.abs(drift).max() / size:.1e}, energy to {_spread(out.energy):.1e}")
    if find_spec("matplotlib") is None:
        return []
    figure, ((polhode, _), (axes, _), (seen, off)) = new_panels([False, False, True], (6.0, 5.5), solid=(0, 1))
    fine = data.motion(np.linspace(0.0, days, 4001))
    _pictures.polhode(polhode, fine)
    _pictures.traces(axes, fine)
    found.plot(ax=seen, residuals=off)
    picture = output / "toutatis.png"
    figure.savefig(picture, dpi=150)
    return [picture]


def dzhanibekov(output: Path, flips: int) -> list[Path]:
    """Let a handle flip over and over; print when it does: by its period, by its states, by integration in steps."""
    flips = whole_number("flips", flips, 1, _MOST_FLIPS)
    spin = _MOMENTUM / _MOMENTS
    path = vv.rigid.polhode(_MOMENTS, spin)
    print(f"A body with moments {_MOMENTS.tolist()} and the angular momentum {_MOMENTUM.tolist()}")
    print(f"period {path.period:.15g}, flips every {path.flip_time:.15g}, 1 − k² = {path.complement**2:.6g}")
    # At the start its middle component is the largest there is, a quarter of a period from where it vanishes.
    exact = np.multiply(np.arange(flips) + 0.5, path.flip_time, dtype=np.float64)
    states = _zeros(spin, exact)
    integrated = _integrated(spin, exact[-1] + 0.25 * path.period)
    print(f"\n{'flip':>4}{'(n + ½) 2K/λ':>24}{'closed form − that':>22}{'DOP853 at 1e-12 − that':>26}")
    shown = np.unique(np.linspace(0, flips - 1, min(flips, 2 * _ROWS)).astype(int))
    for at in shown:
        other = f"{integrated[at] - exact[at]:.1e}" if at < len(integrated) else "–"
        print(f"{at + 1:>4}{exact[at]:>24.13f}{states[at] - exact[at]:>22.1e}{other:>26}")
    if find_spec("matplotlib") is None:
        return []
    figure, (components, polhode, axes) = new_figure(3, (15.0, 5.0), solid=(1, 2))
    out = vv.rigid.free_rotation(_MOMENTS, spin, np.linspace(0.0, exact[-1] + 0.25 * path.period, 4001))
    _pictures.spin(components, out)
    for time in exact[-len(shown) :] if flips <= 2 * _ROWS else ():
        components.axvline(time, color=FRAME, linewidth=0.6, zorder=0)
    _pictures.polhode(polhode, out)
    _pictures.traces(axes, out)
    picture = output / "dzhanibekov.png"
    figure.savefig(picture, dpi=150)
    return [picture]


def _zeros(spin: NDArray[np.float64], near: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where the states do not turn about the middle axis, by halving, near these times."""
    half = 0.25 * (near[0] if len(near) == 1 else near[1] - near[0])
    low, high = near - half, near + half
    middle: NDArray[np.float64] = near
    sign = np.sign(vv.rigid.free_rotation(_MOMENTS, spin, low).angular_velocity[:, 1])
    for _ in range(60):
        middle = 0.5 * (low + high)
        before = vv.rigid.free_rotation(_MOMENTS, spin, middle).angular_velocity[:, 1] * sign > 0.0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return middle


def _integrated(spin: NDArray[np.float64], end: float) -> NDArray[np.float64]:
    """The same times by integrating Euler's equations, step by step."""
    a, b, c = (_MOMENTS[[1, 2, 0]] - _MOMENTS[[2, 0, 1]]) / _MOMENTS

    def rate(_: float, w: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y, z = w.tolist()
        return np.array([a * y * z, b * z * x, c * x * y])

    def flip(_: float, w: NDArray[np.float64]) -> Any:
        return w[1]

    found = vv.solve_ivp(rate, (0.0, min(float(end), 1e3)), spin, "DOP853", events=flip, rtol=1e-12, atol=1e-15)
    return np.zeros(0) if found.t_events is None else found.t_events[0]


def _spread(values: NDArray[np.float64]) -> float:
    return float(np.ptp(values) / np.abs(values[0]))


def __dir__() -> list[str]:
    return list(__all__)
