"""Conjugate points and the least eigenvalue: the same in all units, of whatever masses, at whatever times of a path.

Linear systems in normal coordinates have closed forms: places return after every half turn of each mode, and the least
eigenvalue is (π/T)² − ω² of the fastest. Bounds: ten roundings of the times, and of the largest term of λ, with as many
more as the mixing of modes loses.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva.generalized import _path


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


def quadratic(mass: np.ndarray, stiffness: np.ndarray) -> vv.Lagrangian:
    def expression(q: list, v: list, t: object) -> object:
        pairs = np.ndindex(mass.shape)
        return sum(mass[i, j] * v[i] * v[j] - stiffness[i, j] * q[i] * q[j] for i, j in pairs) / 2

    return vv.Lagrangian(expression, [f"q{i}" for i in range(len(mass))])


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


def test_returns_at_times_of_a_path_are_each_counted() -> None:
    """Rounding decides on which side of a time a neighbor is back: step by step 8 of 11 were counted."""
    found = oscillators([1.0], [1.5]).accessory_problem((np.linspace(0.0, 8 * np.pi, 9), np.zeros((9, 1))))
    assert found.conjugate_points == pytest.approx(half_turns([1.5], 8 * np.pi), rel=2e-15, abs=0)


@pytest.mark.parametrize("seed", [8, 12, 14, 17])
def test_double_returns_of_mixed_modes_at_times_of_a_path(seed: int) -> None:
    random, frequencies = np.random.default_rng(seed), np.array([1.0, 1.0, 2.0])
    mixing = np.linalg.qr(random.normal(size=(3, 3)))[0] * 10.0 ** random.uniform(-3, 3, 3)
    system = quadratic(mixing.T @ mixing, mixing.T @ np.diag(frequencies**2) @ mixing)
    times = np.append(np.linspace(0.0, 4 * np.pi, 17), 4 * np.pi * 1.001)
    found = system.accessory_problem((times, np.zeros((18, 3))))
    assert found.conjugate_points == pytest.approx(half_turns([1.0, 1.0, 2.0], times[-1]), rel=1e-13, abs=0)


@pytest.mark.parametrize("seed", range(6))
def test_modes_that_are_mixed(seed: int) -> None:
    """Whatever the coordinates, in which the masses are no diagonal matrix, neighbors return when modes do."""
    random = np.random.default_rng(seed)
    n = 2 + seed % 3
    frequencies = np.sort(random.uniform(0.3, 6.0, n))
    mixing = np.linalg.qr(random.normal(size=(n, n)))[0] * 10.0 ** random.uniform(-6, 6, n)
    system = quadratic(mixing.T @ mixing, mixing.T @ np.diag(frequencies**2) @ mixing)
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


@pytest.mark.parametrize("gauge", [1e3, 1e6, 1e12])
def test_the_rate_of_a_function_changes_nothing(gauge: float) -> None:
    """L + d/dt (K q²/2) has the same neighbors, whatever K."""
    system = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 / 2 + gauge * q[0] * v[0], ["x"])
    found = system.accessory_problem((np.linspace(0.0, 10.0, 21), np.zeros((21, 1))))
    assert found.conjugate_points == pytest.approx(np.pi * np.arange(1, 4), rel=2e-15, abs=0)
    assert found.eigenvalue == pytest.approx((np.pi / 10) ** 2 - 1, rel=1e-13, abs=0)


@pytest.mark.parametrize("count", [2, 3, 11, 201])
def test_what_depends_on_the_time_between_the_times_of_a_path(count: int) -> None:
    """A spring that is there for a twentieth of the time unit, along a path at rest that two times tell."""
    pulse = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - 20 * np.exp(-(((t - 3.0) / 0.05) ** 2)) * q[0] ** 2 / 2, ["x"]
    )
    found = pulse.accessory_problem((np.linspace(0.0, 10.0, count), np.zeros((count, 1))))
    # Jacobi's equation by mpmath's Taylor series, 25 digits.
    assert found.conjugate_points == pytest.approx([3.724912522750921], rel=1e-12, abs=0)
    assert found.eigenvalue == pytest.approx(-0.7253333605755329, abs=1e-12)


def test_many_coordinates() -> None:
    """A chain between walls, whose frequencies are 2 sin(kπ/2(n + 1))."""
    n, time = 8, 10.0
    chain = vv.Lagrangian(
        lambda q, v, t: (
            (
                sum(x * x for x in v)
                - sum(
                    (b - a) ** 2
                    for a, b in zip([0.0, *(q[i] for i in range(n))], [*(q[i] for i in range(n)), 0.0], strict=True)
                )
            )
            / 2
        ),
        [f"q{i}" for i in range(n)],
    )
    frequencies = 2 * np.sin(np.arange(1, n + 1) * np.pi / (2 * (n + 1)))
    found = chain.accessory_problem((np.linspace(0.0, time, 21), np.zeros((21, n))))
    assert found.conjugate_points == pytest.approx(half_turns(list(frequencies), time), rel=5e-15, abs=0)
    assert found.eigenvalue == pytest.approx((np.pi / time) ** 2 - frequencies[-1] ** 2, abs=1e-13)


@pytest.mark.parametrize("rows", [21, 101, 501])
def test_a_run_whose_rows_are_far_apart(rows: int) -> None:
    """Of e = 0.9, whose pericenters are between rows: neighbors return after each revolution, and once between them."""
    kepler = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + 1 / np.sqrt(q[0] ** 2 + q[1] ** 2),
        ["x", "y"],
        position=[1.9, 0.0],
        velocity=[0.0, np.sqrt(2 / 1.9 - 1)],
    )
    found = kepler.accessory_problem(kepler.run(np.linspace(0.0, 13.0, rows), rtol=1e-13))
    # 7.23093628: Jacobi's equation by DOP853, beside the motion. What is off by 1e-13 of the orbit's size in a path is
    # 1e-12 at its pericenter, and some hundred times that in what comes back from there.
    assert found.conjugate_points == pytest.approx([2 * np.pi, 7.23093628, 4 * np.pi], abs=1e-8)


def test_rows_that_the_equations_of_motion_do_not_lead_to_are_joined_as_they_are(monkeypatch: Any) -> None:
    """Of coarse steps: more places between them, each of two runs, took a minute and told nothing."""
    counted = []
    through = _path._through
    monkeypatch.setattr(_path, "_through", lambda *given: counted.append(len(given[1])) or through(*given))
    pendulum = vv.systems.pendulum(position=[1.0])
    run = pendulum.run(np.linspace(0.0, 20.0, 101), method="rk4", dt=0.2)
    exact = pendulum.run(np.linspace(0.0, 20.0, 101), rtol=1e-13)
    coarse = pendulum.accessory_problem(run)
    assert counted == [101]
    # The path is off by the phase of rk4: (ωh)⁴/120 of the time, with ω = √9.81.
    assert coarse.conjugate_points == pytest.approx(pendulum.accessory_problem(exact).conjugate_points, rel=3e-3, abs=0)
    assert max(counted) > 101


@pytest.mark.parametrize("count", [2, 3, 41])
def test_rates_that_vanish_at_the_middle_of_a_path(count: int) -> None:
    """Steps were as long as the middles of pieces allow: no conjugate point was found where there are 17."""
    hill = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - 10 * q[0] ** 4, ["x"])
    found = hill.accessory_problem((np.linspace(0.0, 1.0, count), np.linspace(-10.0, 10.0, count)))
    assert found.index == 17
    # With 401 places on the same line.
    assert found.eigenvalue == pytest.approx(-9021.98293588297, rel=1e-12, abs=0)
