"""The place of a copy among the others of an ensemble leaves no trace in its bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

METHODS = vv.methods()
"""With a fixed step copies go in lockstep, eight in the lanes and eight more in the rows after; a method that chooses
its steps takes up the next copy in whatever lane falls free."""
NAMES = [method.name for method in METHODS]


def step(method: vv.Method, dt: float) -> dict[str, Any]:
    return {"rtol": 10.0 ** -min(10, 2 * method.order)} if method.adaptive else {"dt": dt}


COPIES = 36

# Random places, among them some next to the center, where the step is far too long: bits are looked at here.
pytestmark = pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")


def ensemble(mass: list[float], *forces: vv.Force) -> vv.EnsembleScene:
    """Copies at random places, each with its own masses."""
    random = np.random.default_rng(1687)
    masses = np.array(mass) * random.uniform(0.5, 2.0, size=(COPIES, len(mass)))
    position = 3.0 * random.normal(size=(COPIES, len(mass), 3))
    velocity = 0.3 * random.normal(size=(COPIES, len(mass), 3))
    one = vv.Scene(vv.Particles(mass=masses[0], position=position[0], velocity=velocity[0]), *forces)
    return one.ensemble(mass=masses, position=position, velocity=velocity)


GRAVITY = vv.Gravity(G=1.0, softening=0.1)
ENSEMBLES = {
    "three bodies": ensemble([1.0, 0.5, 0.25], GRAVITY),
    "massless bodies, too": ensemble([1.0, 0.5, 0.0, 0.0], GRAVITY),
    "more bodies than lanes": ensemble([1.0, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.125, 0.0], GRAVITY),
    "a fixed center": ensemble([1.0, 1.0], GRAVITY, vv.CentralField(vv.potentials.Yukawa(k=-3.0, length=2.0))),
}


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@pytest.mark.parametrize("name", ENSEMBLES)
@pytest.mark.parametrize("copies", [2, 8, 9, 15, 16, 17, 24, COPIES])
def test_a_copy_is_the_same_alone(name: str, copies: int, method: vv.Method) -> None:
    if method.name == "taylor" and name == "a fixed center":
        pytest.skip("a Yukawa field has no Taylor series")
    run: dict[str, Any] = {"t": [0.5, 1.02], "method": method.name} | step(method, 0.05)
    every = ENSEMBLES[name]
    some = every.scene.ensemble(
        mass=every.mass[:copies], position=every.position[:copies], velocity=every.velocity[:copies]
    )
    together = some.run(threads=1, **run)
    for copy in sorted({0, 7 % copies, 8 % copies, copies - 1}):
        bodies = vv.Particles(mass=every.mass[copy], position=every.position[copy], velocity=every.velocity[copy])
        alone = vv.Scene(bodies, *every.scene.forces).run(threads=1, **run)
        np.testing.assert_array_equal(together.position[copy], alone.position)
        np.testing.assert_array_equal(together.velocity[copy], alone.velocity)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
def test_a_group_of_copies_leaves_nothing_to_the_next(method: vv.Method) -> None:
    """Groups of sixteen use the same memory, one after another; here the first of them goes wild."""
    calm = ENSEMBLES["three bodies"]
    position = np.resize(calm.position, (300, 3, 3))
    velocity = np.resize(calm.velocity, (300, 3, 3))
    velocity[:16] *= 1e6
    run: dict[str, Any] = {"t": [0.013, 1.0], "method": method.name, "threads": 1} | step(method, 0.025)
    scene = vv.Scene(calm.scene.particles, vv.Gravity(G=1.0, softening=0.1))
    together = scene.ensemble(position=position, velocity=velocity).run(**run)
    for copy in (16, 40, 299):
        bodies = vv.Particles(mass=scene.particles.mass, position=position[copy], velocity=velocity[copy])
        alone = vv.Scene(bodies, *scene.forces).run(**run)
        np.testing.assert_array_equal(together.position[copy], alone.position)
        np.testing.assert_array_equal(together.velocity[copy], alone.velocity)
