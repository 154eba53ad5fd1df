"""`vv.solve_ivp` against SciPy with the same functions; compiled ones against SciPy and heyoka at equal error."""

# ruff: noqa: ARG001, B023  (right-hand sides take a time; what a loop defines is called before it goes on)

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
from _harness import Row, faster, minima, report
from scipy.integrate import solve_ivp

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

RATE = numba.types.void(numba.float64, numba.types.CPointer(numba.float64), numba.types.CPointer(numba.float64))

# Arenstorf's orbit (Hairer, Nørsett & Wanner, II.0): a period of the restricted three-body problem.
MU = 0.012277471
ARENSTORF = [0.994, 0.0, 0.0, -2.00158510637908252240537862224]
PERIOD = 17.0652165601579625588917206249


def arenstorf(t: float, y: np.ndarray) -> list[float]:
    x, z, u, w = y
    near = ((x + MU) ** 2 + z * z) ** 1.5
    far = ((x - 1 + MU) ** 2 + z * z) ** 1.5
    return [
        u,
        w,
        x + 2 * w - (1 - MU) * (x + MU) / near - MU * (x - 1 + MU) / far,
        z - 2 * u - (1 - MU) * z / near - MU * z / far,
    ]


@numba.cfunc(RATE)
def arenstorf_compiled(t: float, y: Any, rate: Any) -> None:
    x, z, u, w = y[0], y[1], y[2], y[3]
    a, b = x + MU, x - 1 + MU
    near, far = a * a + z * z, b * b + z * z
    near, far = (1 - MU) / (near * sqrt(near)), MU / (far * sqrt(far))
    rate[0], rate[1] = u, w
    rate[2] = x + 2 * w - near * a - far * b
    rate[3] = z - 2 * u - near * z - far * z


def lorenz(t: float, y: np.ndarray) -> list[float]:
    x, w, z = y
    return [10.0 * (w - x), x * (28.0 - z) - w, x * w - 8.0 / 3.0 * z]


@numba.cfunc(RATE)
def lorenz_compiled(t: float, y: Any, rate: Any) -> None:
    rate[0] = 10.0 * (y[1] - y[0])
    rate[1] = y[0] * (28.0 - y[2]) - y[1]
    rate[2] = y[0] * y[1] - 8.0 / 3.0 * y[2]


def chain(n: int) -> Callable[[float, np.ndarray], np.ndarray]:
    """A chain of oscillators in NumPy: n equations."""
    half = n // 2

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        out = np.empty(n)
        out[:half] = y[half:]
        out[half:] = -2.0 * y[:half]
        out[half + 1 :] += y[: half - 1]
        out[half:-1] += y[1:half]
        return out

    return rate


def heyoka_system(name: str) -> tuple[Any, Any]:
    import heyoka as hy

    if name == "Arenstorf":
        x, z, u, w = hy.make_vars("x", "z", "u", "w")
        near = ((x + MU) ** 2 + z**2) ** -1.5
        far = ((x - 1 + MU) ** 2 + z**2) ** -1.5
        return hy, [
            (x, u),
            (z, w),
            (u, x + 2 * w - (1 - MU) * (x + MU) * near - MU * (x - 1 + MU) * far),
            (w, z - 2 * u - (1 - MU) * z * near - MU * z * far),
        ]
    x, w, z = hy.make_vars("x", "w", "z")
    return hy, [(x, 10.0 * (w - x)), (w, x * (28.0 - z) - w), (z, x * w - 8.0 / 3.0 * z)]


MANY = 20


def many(side: Callable[[], object]) -> Callable[[], None]:
    """A short side so often in a turn that what another side left in the caches does not count."""

    def turn() -> None:
        for _ in range(MANY):
            side()

    return turn


def with_error_below(bound: float, exact: np.ndarray, end: Callable[[float], np.ndarray]) -> float:
    """The loosest tolerance, of four in a power of ten, that leaves an error below the bound."""
    for exponent in np.arange(4.0, 15.6, 0.25):
        if np.abs(end(10.0**-exponent) - exact).max() < bound:
            return float(10.0**-exponent)
    return float("nan")


def compiled_rows() -> Iterator[Row]:
    problems = (
        ("Arenstorf", arenstorf, arenstorf_compiled, ARENSTORF, PERIOD, 1e-6),
        ("Lorenz", lorenz, lorenz_compiled, [1.0, 1.0, 1.0], 20.0, 1e-5),
    )
    for name, function, compiled, y0, end, bound in problems:
        # Beyond what any side is asked for: the period itself, or a fine run of fixed steps.
        exact = np.array(y0)
        if name == "Lorenz":
            exact = vv.solve_ivp(compiled, (0, end), y0, "rk4", dt=2e-5, t_eval=[end]).y[:, -1]

        def ours(tol: float, compiled: Any = compiled, y0: Any = y0, end: float = end) -> np.ndarray:
            return vv.solve_ivp(compiled, (0, end), y0, "DOP853", rtol=tol, atol=tol).y[:, -1]

        def scipys(tol: float, function: Any = function, y0: Any = y0, end: float = end) -> np.ndarray:
            return solve_ivp(function, (0, end), y0, "DOP853", rtol=tol, atol=tol).y[:, -1]

        tol, scipy_tol = with_error_below(bound, exact, ours), with_error_below(bound, exact, scipys)
        us, them = minima(many(lambda: ours(tol)), lambda: scipys(scipy_tol))
        us /= MANY
        label = f"{name}, error below {bound:g}: `@cfunc`"
        yield faster(f"{label} against SciPy in Python", f"{us * 1e6:.0f} µs", f"{them * 1e3:.1f} ms", them / us, 200)
        try:
            hy, system = heyoka_system(name)
        except ImportError:
            continue

        integrators: dict[float, Any] = {}

        def heyokas(tol: float, y0: Any = y0, end: float = end, made: Any = integrators) -> np.ndarray:
            if tol not in made:
                made[tol] = hy.taylor_adaptive(system, y0, tol=tol)  # compiled once, not timed
            integrator = made[tol]
            integrator.time, integrator.state[:] = 0.0, y0
            integrator.propagate_until(end)
            return integrator.state.copy()

        heyoka_tol = with_error_below(bound, exact, heyokas)
        us, them = (turn / MANY for turn in minima(many(lambda: ours(tol)), many(lambda: heyokas(heyoka_tol))))
        yield faster(f"{label} against heyoka", f"{us * 1e6:.0f} µs", f"{them * 1e6:.0f} µs", them / us, 1 / 3)


def python_rows() -> Iterator[Row]:
    small = np.array([1.0, 1.0, 1.0])
    cases: list[tuple[str, Callable[..., Any], np.ndarray, float, float]] = [
        ("Lorenz, lists", lorenz, small, 20.0, 1.0),
        ("a chain of 10 equations, NumPy", chain(10), np.linspace(-1, 1, 10), 50.0, 1.5),
        ("a chain of 100 equations, NumPy", chain(100), np.linspace(-1, 1, 100), 20.0, 1.0),
    ]
    for what, function, y0, end, bar in cases:
        for method in ("RK45", "DOP853"):

            def side(solve: Any, function: Any = function, y0: Any = y0, end: float = end, method: str = method) -> Any:
                return solve(function, (0, end), y0, method=method, rtol=1e-6, atol=1e-6)

            us, them = minima(lambda: side(vv.solve_ivp), lambda: side(solve_ivp))
            yield faster(f"{what}, {method}, Python", f"{us * 1e3:.1f} ms", f"{them * 1e3:.1f} ms", them / us, bar)


def rows() -> Iterator[Row]:
    yield from python_rows()
    yield from compiled_rows()


if __name__ == "__main__":
    report(
        "Initial value problems",
        rows(),
        "Peer: SciPy's `solve_ivp` with the same function of Python, and heyoka's Taylor method (compiled beforehand). "
        "At equal error: each side with the loosest tolerance that reaches it.",
    )
