"""DOP853 on the outer Solar System over 10^6 days at rtol 1e-13, against SciPy's DOP853.

SciPy gets its right-hand side the way a careful user would write it: pairs once, NumPy throughout, no Python
loop. A second row compiles it with numba, for whoever would go that far; the bar is against the first. SciPy's
``atol`` is one number for positions and velocities alike; 1e-16 (of AU and AU per day) keeps it below
rtol × |y| for every component most of the time, so that both sides control relative error.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numba
import numpy as np
from _harness import Row, faster, minima, report
from _reference import Reference, error
from scipy.integrate import solve_ivp

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    Derivative = Callable[[float, NDArray[np.float64]], NDArray[np.float64]]

END = 1e6
RTOL = 1e-13
ATOL = 1e-16


def with_numpy(scene: vv.Scene) -> Derivative:
    """y' for y = (positions, velocities): every pair once, summed up by one matrix product."""
    mass = scene.particles.mass
    count = len(mass)
    first, second = np.triu_indices(count, 1)
    pairs = np.arange(len(first))
    incidence = np.zeros((count, len(first)))
    incidence[first, pairs] = scene.forces[0].G * mass[second]
    incidence[second, pairs] = -scene.forces[0].G * mass[first]

    def derivative(_: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        position = y[: 3 * count].reshape(count, 3)
        separation = position[second] - position[first]
        square = np.einsum("ij,ij->i", separation, separation)
        acceleration = incidence @ (separation / (square * np.sqrt(square))[:, None])
        return np.concatenate((y[3 * count :], acceleration.ravel()))

    return derivative


def with_numba(scene: vv.Scene) -> Derivative:
    """The same as compiled loops."""
    strength = scene.forces[0].G * scene.particles.mass
    count = len(strength)

    @numba.njit
    def derivative(_, y):  # type: ignore[no-untyped-def]
        out = np.zeros_like(y)
        out[: 3 * count] = y[3 * count :]
        for i in range(count):
            for j in range(i + 1, count):
                x, v, w = y[3 * j] - y[3 * i], y[3 * j + 1] - y[3 * i + 1], y[3 * j + 2] - y[3 * i + 2]
                square = x * x + v * v + w * w
                weight = 1.0 / (square * np.sqrt(square))
                for axis, part in enumerate((x, v, w)):
                    out[3 * (count + i) + axis] += strength[j] * weight * part
                    out[3 * (count + j) + axis] -= strength[i] * weight * part
        return out

    derivative(0.0, np.arange(6.0 * count))
    return derivative


def rows() -> Iterator[Row]:
    problem = vv.problems.outer_solar_system()
    scene = problem.scene
    reference = Reference(scene)
    quadruple = problem.references[0]
    gap = error(quadruple.position, reference.positions(quadruple.t))
    assert gap < 1e-12, f"the two references are {gap:.1e} AU apart"
    truth = reference.positions(END)

    start = np.concatenate([scene.particles.position.ravel(), scene.particles.velocity.ravel()])

    def ours() -> vv.Trajectory:
        return scene.run(t=END, method="dop853", rtol=RTOL, threads=1)

    def scipy(derivative: Derivative) -> NDArray[np.float64]:
        solution = solve_ivp(derivative, (0.0, END), start, "DOP853", t_eval=[END], rtol=RTOL, atol=ATOL)
        assert solution.success, solution.message
        return solution.y[:18, -1].reshape(6, 3)

    mine = error(ours().position[-1], truth)
    for name, make, bar in (("NumPy", with_numpy, 150.0), ("numba", with_numba, None)):
        derivative = make(scene)
        theirs = error(scipy(derivative), truth)
        fast, slow = minima(ours, lambda f=derivative: scipy(f), repeats=4)
        row = faster(
            f"1e6 d, rtol 1e-13, right-hand side for SciPy in {name}",
            f"{fast * 1e3:.2f} ms, error {mine:.2e} AU",
            f"SciPy {slow * 1e3:.0f} ms, error {theirs:.2e} AU",
            slow / fast,
            bar,
        )
        no_larger = mine <= theirs
        yield row if bar is None else Row(**{**vars(row), "passed": row.passed and no_larger})


if __name__ == "__main__":
    report(
        "DOP853 on the outer Solar System",
        rows(),
        f"rtol = {RTOL:g}; atol: ours the default, SciPy's {ATOL:g}. Errors are the largest distance of a body "
        "from the extended-precision reference; the bar also asks for no larger error than SciPy's.",
    )
