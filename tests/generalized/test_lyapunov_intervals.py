"""Lyapunov's exponents do not ask for the unit of time: how long a part of the run may be is found."""

from __future__ import annotations

import time

import numpy as np
import pytest

import visviva as vv


def henon_heiles(slower: float) -> vv.Hamiltonian:
    """The system of Hénon and Heiles in other units of time: all rates are divided by one number."""
    return vv.Hamiltonian(
        lambda q, p, t, s: (
            0.5 * (p[0] ** 2 + p[1] ** 2) + s**-2 * (0.5 * (q[0] ** 2 + q[1] ** 2) + q[0] ** 2 * q[1] - q[1] ** 3 / 3.0)
        ),
        ["x", "y"],
        parameters={"s": slower},
        position=[0.0, 0.1],
        momentum=[0.5 / slower, 0.1 / slower],
    )


@pytest.mark.parametrize("slower", [1e-4, 1.0, 1e4])
def test_the_unit_of_time_is_nobodys_business(slower: float) -> None:
    """A chaotic orbit: parts are of one unit of time, or of what length serves."""
    given = henon_heiles(1.0).lyapunov_exponents(100.0, interval=1.0)
    begun = time.perf_counter()
    found = henon_heiles(slower).lyapunov_exponents(100.0 * slower) * slower
    # 10 ms are enough; a part for each unit of a small one would take hundreds of times as long.
    assert time.perf_counter() - begun < 3.0
    # Momenta in other units change lengths of neighbors by s at both ends, and rates within the norms there.
    np.testing.assert_allclose(found.sum(), 0.0, rtol=0, atol=1e-10)
    if slower == 1.0:
        np.testing.assert_allclose(found, given, rtol=0, atol=1e-8)


@pytest.mark.parametrize("rate", [1.0, 50.0])
def test_neighbors_that_part_fast_are_followed(rate: float) -> None:
    """x'' = k² x: the exponents are ±k, also where e^(kT) is beyond all numbers."""
    saddle = vv.Lagrangian(
        lambda q, v, t, k: 0.5 * (v[0] ** 2 + (k * q[0]) ** 2),
        ["x"],
        parameters={"k": rate},
        position=[0.0],
        velocity=[0.0],
    )
    found = saddle.lyapunov_exponents(200.0)
    # Velocities in units of places: the frame turns into the two directions within 1/k, ln(k)/T of the exponent.
    np.testing.assert_allclose(found, [rate, -rate], rtol=0, atol=(1.0 + np.log(rate)) / 200.0)
