"""Copies with softening lengths of their own share lanes, and each has the bits that it has alone."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

import visviva as vv

COPIES = 19
LENGTHS = np.linspace(0.2, 0.8, COPIES)
METHODS: list[dict[str, Any]] = [
    {"method": "leapfrog", "dt": 0.005},
    {"method": "rk4", "dt": 0.01},
    {"method": "stormer13", "dt": 0.005},
    {"method": "dop853"},
    {"method": "verner98"},
    {"method": "taylor"},
]
#: Two and three bodies have kernels of their own for `stormer13`; nine are more than share lanes.
BODIES = {"two": 2, "three": 3, "eight": 8, "nine": 9}
each_method = pytest.mark.parametrize("how", METHODS, ids=lambda how: how["method"])


def cluster(bodies: int, massless: int, planar: bool) -> vv.Particles:
    rng = np.random.default_rng(bodies)
    position, velocity = (rng.normal(size=(bodies + massless, 3)) * size for size in (1.0, 0.3))
    if planar:
        position[:, 2] = velocity[:, 2] = 0.0
    return vv.Particles([*rng.uniform(0.2, 0.5, bodies), *[0.0] * massless], position, velocity)


def compare(scene: vv.Scene, softening: np.ndarray[Any, Any], how: dict[str, Any]) -> None:
    force = type(scene.forces[0]).__name__
    ensemble = scene.ensemble(parameters={force: {"softening": softening}})
    out = ensemble.run(t=1.0, threads=1, **how)
    np.testing.assert_array_equal(out.position, ensemble.run(t=1.0, threads=3, **how).position)
    for copy in (0, 3, 8, 11, len(softening) - 1):
        alone = ensemble[copy]
        assert alone.forces[0].softening == softening[copy]
        np.testing.assert_array_equal(out.position[copy], alone.run(t=1.0, **how).position)
    # Or the lengths would change nothing.
    assert len({row.tobytes() for row in out.position[:, -1]}) == len(softening)


@each_method
@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("bodies", BODIES)
def test_gravity(bodies: str, planar: bool, how: dict[str, Any]) -> None:
    scene = vv.Scene(cluster(BODIES[bodies], 0, planar), vv.Gravity(1.0, softening=0.1))
    compare(scene, LENGTHS, how)


@each_method
def test_gravity_on_massless_bodies(how: dict[str, Any]) -> None:
    compare(vv.Scene(cluster(3, 4, False), vv.Gravity(1.0, softening=0.1)), LENGTHS, how)


@each_method
def test_charges(how: dict[str, Any]) -> None:
    charges = np.array([0.5, -0.3, 0.4, -0.6])
    scene = vv.Scene(cluster(4, 0, False), vv.Coulomb(charges, k=1.0, softening=0.1))
    compare(scene, LENGTHS, how)


@each_method
def test_some_without_any(how: dict[str, Any]) -> None:
    """These have other kernels, and keep the bits that they have alone, too."""
    softening = LENGTHS.copy()
    softening[3] = 0.0
    compare(vv.Scene(cluster(3, 0, False), vv.Gravity(1.0, softening=0.1)), softening, how)


@each_method
def test_beside_a_potential(how: dict[str, Any]) -> None:
    field = vv.CentralField(vv.potentials.Plummer(-1.0, 1.0))
    if how["method"] != "taylor":  # which takes no central field
        compare(vv.Scene(cluster(3, 0, False), vv.Gravity(1.0, softening=0.1), field), LENGTHS, how)


def test_lengths_of_their_own_cost_what_one_for_all_costs() -> None:
    """Eight times as much, when each such copy had its steps for itself."""
    scene = vv.Scene(cluster(3, 0, False), vv.Gravity(1.0, softening=0.1))
    rng = np.random.default_rng(1)
    starts = scene.particles.position + 0.01 * rng.normal(size=(256, 3, 3))
    shared = scene.ensemble(position=starts)
    own = scene.ensemble(position=starts, parameters={"Gravity": {"softening": np.linspace(0.05, 0.4, 256)}})

    def fastest(ensemble: vv.EnsembleScene) -> float:
        def once() -> float:
            begun = time.perf_counter()
            ensemble.run(t=4.0, method="leapfrog", dt=0.004, threads=1)
            return time.perf_counter() - begun

        return min(once() for _ in range(5))

    # 1.1 here; the rest is for a busy machine.
    assert fastest(own) < 3.0 * fastest(shared)
