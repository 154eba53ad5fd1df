"""Copies whose J2, J4, axes, constants of gravity, speeds of light differ share lanes, and have the bits of alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

COPIES = 11
#: A planet, two moons, and dust that follows them.
BODIES = vv.Particles(
    [1.0, 1e-3, 2e-3, 0.0, 0.0],
    [[0, 0, 0], [3.0, 0, 0.1], [0, 5.0, 0], [2.0, 2.0, 0.3], [-4.0, 0, 0]],
    [[0, 0, 0], [0, 0.57, 0], [-0.44, 0, 0.02], [-0.3, 0.4, 0], [0, -0.5, 0.1]],
)
SPREAD = np.linspace(0.5, 1.5, COPIES)
OBLATE: dict[str, Any] = {"J2": 0.01, "radius": 1.0, "axis": [0.1, 0.2, 1.0], "J4": 1e-3}
CASES: dict[str, tuple[list[vv.forces.Force], dict[str, Any]]] = {
    "J2": ([vv.Oblate(0, 1.0, **OBLATE)], {"Oblate": {"J2": 0.01 * SPREAD}}),
    "J4 and radius": (
        [vv.Oblate(0, 1.0, **OBLATE)],
        {"Oblate": {"J4": 1e-3 * SPREAD, "radius": 1.0 + 0.1 * SPREAD}},
    ),
    "no J4 in some": (
        [vv.Oblate(0, 1.0, **OBLATE)],
        {"Oblate": {"J4": np.where(np.arange(COPIES) % 3 == 0, 0.0, 1e-3)}},
    ),
    "axis and constant": (
        [vv.Oblate(0, 1.0, **OBLATE)],
        {"Oblate": {"axis": np.stack([SPREAD, 1 - SPREAD, SPREAD**2], axis=1), "G": SPREAD}},
    ),
    "two oblate bodies": (
        [vv.Oblate([2, 0], 1.0, J2=[0.02, 0.01], radius=[0.2, 1.0], axis=[0.0, 0.0, 1.0])],
        {"Oblate": {"J2": np.outer(SPREAD, [0.02, 0.01])}},
    ),
    "another body in some": (
        [vv.Oblate(0, 1.0, **OBLATE)],
        {"Oblate": {"body": np.arange(COPIES) % 2, "J2": 0.01 * SPREAD}},
    ),
    "speed of light": ([vv.PostNewtonian(0, 1.0, 20.0)], {"PostNewtonian": {"c": 20.0 * SPREAD}}),
    "several relativistic": (
        [vv.PostNewtonian([0, 1], 1.0, 20.0)],
        {"PostNewtonian": {"c": 20.0 * SPREAD, "G": SPREAD}},
    ),
    "all of them": (
        [vv.Oblate(0, 1.0, **OBLATE), vv.PostNewtonian(0, 1.0, 20.0)],
        {"Oblate": {"J2": 0.01 * SPREAD}, "PostNewtonian": {"c": 20.0 / SPREAD}},
    ),
}


def ensemble_and_alone(
    name: str, bodies: vv.Particles, **how: Any
) -> tuple[vv.EnsembleTrajectory, list[vv.Trajectory]]:
    forces, parameters = CASES[name]
    ensemble = vv.Scene(bodies, vv.Gravity(1.0), *forces).ensemble(parameters=parameters)
    return ensemble.run(**how), [ensemble[copy].run(**how) for copy in range(COPIES)]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("massive", [3, 5])
@pytest.mark.parametrize(
    "method", [{"method": "rk4", "dt": 0.05}, {"method": "dop853"}, {"method": "verner98"}, {"method": "taylor"}]
)
def test_each_copy_is_as_alone(name: str, massive: int, method: dict[str, Any]) -> None:
    """Three massive bodies, and the dust with them: what follows has lanes of its own."""
    bodies = vv.Particles(BODIES.mass[:massive], BODIES.position[:massive], BODIES.velocity[:massive])
    for threads in (1, 3):
        together, alone = ensemble_and_alone(name, bodies, t=np.linspace(0.0, 2.0, 3), threads=threads, **method)
        for copy, single in enumerate(alone):
            np.testing.assert_array_equal(together.position[copy], single.position)
            np.testing.assert_array_equal(together.velocity[copy], single.velocity)


@pytest.mark.parametrize("name", CASES)
def test_splittings_and_energies_too(name: str) -> None:
    how: dict[str, Any] = {"t": np.linspace(0.0, 2.0, 3), "record": ("position", "energy")}
    method = {"method": "rk4"} if "PostNewtonian" in CASES[name][1] else {"method": "yoshida4"}
    together, alone = ensemble_and_alone(name, BODIES, dt=0.05, **method, **how)
    for copy, single in enumerate(alone):
        np.testing.assert_array_equal(together.position[copy], single.position)
        np.testing.assert_array_equal(together.energy[copy], single.energy)


@pytest.mark.parametrize("name", ["J2", "speed of light"])
def test_copies_differ_by_what_they_have(name: str) -> None:
    """Against the same scenes put together by hand, in which nothing is shared."""
    forces, parameters = CASES[name]
    ((_, ((which, values),)),) = ((class_name, of.items()) for class_name, of in parameters.items())
    together = vv.Scene(BODIES, vv.Gravity(1.0), *forces).ensemble(parameters=parameters).run(t=5.0, method="dop853")
    for copy in (0, 4, COPIES - 1):
        own = {"J2": vv.Oblate(0, 1.0, **(OBLATE | {"J2": values[copy]})), "c": vv.PostNewtonian(0, 1.0, values[copy])}
        by_hand = vv.Scene(BODIES, vv.Gravity(1.0), own[which]).run(t=5.0, method="dop853")
        np.testing.assert_array_equal(together.position[copy], by_hand.position)
