"""Conjugate points and the least eigenvalue: the same in all units, of whatever masses, at whatever times of a path.

Linear systems in normal coordinates have closed forms: places return after every half turn of each mode, and the least
eigenvalue is (π/T)² − ω² of the fastest. Bounds: ten roundings of the times, and of the largest term of λ, with as many
more as the mixing of modes loses.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv


def half_turns(frequencies: list[float], time: float) -> np.ndarray:
    """All k π/ω before a time."""
    every = [k * np.pi / w for w in frequencies for k in range(1, int(w * time / np.pi) + 2)]
    return np.sort([t for t in every if t < time * (1 - 1e-13)])


def oscillators(masses: list[float], frequencies: list[float]) -> vv.Lagrangian:
    def expression(q: list, v: list, t: object) -> object:
        return sum(
            m * (v[i] ** 2 - (w * q[i]) ** 2) / 2 for i, (m, w) in enumerate(zip(masses, frequencies, strict=True))
        )

    return vv.Lagrangian(expression, [f"q{i}" for i in range(len(masses))])


@pytest.mark.parametrize(
    ("masses", "frequencies", "time"),
    [
        ([1.0, 1e3], [1.0, 1.3], 10.0),
        ([1.0, 1e24], [1.0, 1.3], 10.0),
        ([1e21, 1e21], [1.0, 1.3], 10.0),
        ([1e-200, 1e150], [1.0, 1.3], 10.0),
        ([1e5, 1.0, 1e-5], [0.3, 1.0, 20.0], 7.0),
        ([1.0, 1.0], [1e13, 1.7e13], 1e-12),
        ([3.0, 1.0], [1e-13, 2e-13], 1e14),
        ([1e24, 1.0, 1e-24], [1.0, 1.0, 1.0], 20.0),
    ],
)
def test_oscillators_of_whatever_masses(masses: list[float], frequencies: list[float], time: float) -> None:
    at_rest = np.linspace(0.0, time, 41), np.zeros((41, len(masses)))
    found = oscillators(masses, frequencies).accessory_problem(at_rest)
    assert found.conjugate_points == pytest.approx(half_turns(frequencies, time), rel=2e-15, abs=0)
    least = (np.pi / time) ** 2 - max(frequencies) ** 2
    assert found.eigenvalue == pytest.approx(least, rel=1e-14, abs=0)


@pytest.mark.parametrize("per_half_turn", [1, 2, 3, 8])
def test_times_of_a_path_that_are_conjugate(per_half_turn: int) -> None:
    """What returns within a rounding of a time of the path is counted once; at its end it is not before it."""
    time = 4 * np.pi
    times = np.linspace(0.0, time, 8 * per_half_turn + 1)
    found = oscillators([1.0, 1e4], [1.0, 2.0]).accessory_problem((times, np.zeros((len(times), 2))))
    wanted = np.sort([*(np.pi * np.arange(1, 4)), *(np.pi / 2 * np.arange(1, 8))])
    assert found.conjugate_points == pytest.approx(wanted, rel=2e-15, abs=0)


@pytest.mark.parametrize("seed", range(6))
def test_modes_that_are_mixed(seed: int) -> None:
    """Whatever the coordinates, in which the masses are no diagonal matrix, neighbors return when modes do."""
    random = np.random.default_rng(seed)
    n = 2 + seed % 3
    frequencies = np.sort(random.uniform(0.3, 6.0, n))
    mixing = np.linalg.qr(random.normal(size=(n, n)))[0] * 10.0 ** random.uniform(-6, 6, n)
    mass, stiffness = mixing.T @ mixing, mixing.T @ np.diag(frequencies**2) @ mixing

    def expression(q: list, v: list, t: object) -> object:
        pairs = [(i, j) for i in range(n) for j in range(n)]
        return sum(mass[i, j] * v[i] * v[j] - stiffness[i, j] * q[i] * q[j] for i, j in pairs) / 2

    system = vv.Lagrangian(expression, [f"q{i}" for i in range(n)])
    found = system.accessory_problem((np.linspace(0.0, 5.0, 21), np.zeros((21, n))))
    assert found.conjugate_points == pytest.approx(half_turns(list(frequencies), 5.0), rel=1e-13, abs=0)
    assert found.eigenvalue == pytest.approx(
        (np.pi / 5.0) ** 2 - frequencies[-1] ** 2, abs=1e-12 * frequencies[-1] ** 2
    )


@pytest.mark.parametrize(
    ("radius", "speed", "mass"),
    [(1.0, 1.0, 1e24), (1.495978707e11, 29784.0, 5.972e24), (1.495978707e11, 29784.0, 1.0), (1e-10, 1e-3, 1e-30)],
)
def test_an_orbit_in_other_units(radius: float, speed: float, mass: float) -> None:
    """Neighbors of a planet return after a revolution, in the units of an atlas as in its own."""
    period, gm = 2 * np.pi * radius / speed, speed**2 * radius
    orbit = vv.Lagrangian(
        lambda q, v, t: mass * ((v[0] ** 2 + v[1] ** 2) / 2 + gm / (q[0] ** 2 + q[1] ** 2) ** 0.5),
        ["x", "y"],
        position=[radius, 0.0],
        velocity=[0.0, speed],
    )
    found = orbit.accessory_problem(orbit.run(t=np.linspace(0.0, 1.2 * period, 241)))
    # The path between its times is known to h⁶; its rates to h⁴, which is what the eigenvalue feels.
    assert found.conjugate_points / period == pytest.approx([1.0], rel=1e-9, abs=0)
    assert found.eigenvalue * period**2 == pytest.approx(-0.7385093112, rel=1e-8, abs=0)
