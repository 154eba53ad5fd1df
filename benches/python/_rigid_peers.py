"""A free rigid body and a heavy top by SciPy, MuJoCo and heyoka: functions that run them from the start to the end.

SciPy and heyoka integrate the angular momentum in the body and the quaternion. What heyoka compiles is compiled when
its function is made, and is not timed. Peers that are not installed are left out.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Attitude = Callable[[], np.ndarray]

TOLERANCES = (1e-9, 1e-12)
EPSILON = 2.0**-52

# The driver of Hairer & Vilmart (2006): moments and angular momentum.
MOMENTS, MOMENTUM, END = np.array([0.6, 0.8, 1.0]), np.array([1.8, 0.4, -0.9]), 100.0
# The top of Brüls, Cardona & Arnold (2012): about the fixed point, the center at (0, 1, 0).
TOP_MOMENTS, TOP_SPIN, TOP_END = np.array([15.234375, 0.46875, 15.234375]), np.array([0.0, 150.0, -4.61538]), 2.0
TOP_MASS, TOP_GRAVITY = 15.0, 9.81


def free_bodies() -> Iterator[tuple[str, Attitude]]:
    """What finds the attitude of the free body at its end, by the name of the code and its accuracy."""
    yield from _of(MOMENTS, MOMENTUM, 0.0, END, (1e-2, 1e-3))


def tops() -> Iterator[tuple[str, Attitude]]:
    """What finds that of the top."""
    yield from _of(TOP_MOMENTS, TOP_MOMENTS * TOP_SPIN, TOP_MASS * TOP_GRAVITY, TOP_END, (1e-4, 1e-5))


def _of(
    moments: np.ndarray, momentum: np.ndarray, weight: float, end: float, steps: tuple[float, ...]
) -> Iterator[tuple[str, Attitude]]:
    for rtol in TOLERANCES:
        yield f"SciPy DOP853 {rtol:g}", _scipy(moments, momentum, weight, end, rtol)
    if find_spec("mujoco"):
        for h in steps:
            yield f"MuJoCo RK4 h = {h:g}", _mujoco(moments, momentum / moments, weight, end, h)
    if find_spec("heyoka"):
        for tolerance in (*TOLERANCES, EPSILON):
            yield f"heyoka {tolerance:.3g}", _heyoka(moments, momentum, weight, end, tolerance)


def _rates(state: Any, moments: list[float], weight: float) -> list[Any]:
    """Rates of the momentum in the body and of the quaternion; the weight, along −z, pulls at (0, 1, 0) in the body."""
    a, b, c, x, y, z, w = state
    p, q, r = a / moments[0], b / moments[1], c / moments[2]
    momentum = [b * r - c * q, c * p - a * r, a * q - b * p]
    if weight:
        momentum[0] -= weight * (w * w + z * z - x * x - y * y)
        momentum[2] += weight * 2.0 * (x * z - y * w)
    turn = [0.5 * (w * p + y * r - z * q), 0.5 * (w * q + z * p - x * r), 0.5 * (w * r + x * q - y * p)]
    return [*momentum, *turn, -0.5 * (x * p + y * q + z * r)]


def _scipy(moments: np.ndarray, momentum: np.ndarray, weight: float, end: float, rtol: float) -> Attitude:
    from scipy.integrate import solve_ivp

    of, start = moments.tolist(), [*momentum, 0.0, 0.0, 0.0, 1.0]

    def rate(_: float, y: np.ndarray) -> list[float]:
        return _rates(y.tolist(), of, weight)

    return lambda: solve_ivp(rate, (0.0, end), start, "DOP853", rtol=rtol, atol=rtol).y[3:, -1]


def _heyoka(moments: np.ndarray, momentum: np.ndarray, weight: float, end: float, tolerance: float) -> Attitude:
    import heyoka

    state = heyoka.make_vars(*"abcxyzw")
    start = [*momentum, 0.0, 0.0, 0.0, 1.0]
    rates = list(zip(state, _rates(state, moments.tolist(), weight), strict=True))
    integrator = heyoka.taylor_adaptive(rates, start, tol=tolerance)

    def attitude() -> np.ndarray:
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.propagate_until(end)
        return integrator.state[3:].copy()

    return attitude


def _mujoco(moments: np.ndarray, spin: np.ndarray, weight: float, end: float, h: float) -> Attitude:
    import mujoco

    mass, arm, own = (TOP_MASS, 1.0, moments - [TOP_MASS, 0.0, TOP_MASS]) if weight else (1.0, 0.0, moments)
    joint = '<joint type="ball"/>' if weight else "<freejoint/>"
    model = mujoco.MjModel.from_xml_string(
        f'''<mujoco><option timestep="{h}" gravity="0 0 {-weight / mass}" integrator="RK4"/><worldbody><body>{joint}
        <inertial pos="0 {arm} 0" mass="{mass}" diaginertia="{" ".join(map(repr, own.tolist()))}"/></body></worldbody>
        </mujoco>'''
    )
    data = mujoco.MjData(model)

    def attitude() -> np.ndarray:
        mujoco.mj_resetData(model, data)
        data.qvel[-3:] = spin
        mujoco.mj_step(model, data, nstep=round(end / h))
        return np.roll(data.qpos[-4:], -1)

    return attitude
