"""Expressions that act on some bodies of a scene, and those that give accelerations, which massless bodies feel."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from pathlib import Path

METHODS: list[dict[str, Any]] = [
    {},
    {"method": "verner98"},
    {"method": "taylor"},
    {"method": "rk4", "dt": 0.01},
    {"method": "leapfrog", "dt": 0.01},
]


def pull(r: Any, v: Any, t: Any, k: Any) -> list[Any]:
    """A spring to the origin."""
    return [-k * each for each in r]


def bodies(masses: list[float]) -> vv.Particles:
    random = np.random.default_rng(4)
    n = len(masses)
    return vv.Particles(masses, 3.0 * random.normal(size=(n, 3)), random.normal(size=(n, 3)))


@pytest.mark.parametrize("options", METHODS)
@pytest.mark.parametrize("beside", [[], [vv.Gravity(1e-3)]])
def test_those_that_are_not_named_feel_nothing(options: dict[str, Any], beside: list[vv.Force]) -> None:
    """The named ones move as under a force on all, the others as under none."""
    particles = bodies([1.0, 2.0, 0.5, 1.5])
    spring = {"force": pull, "parameters": {"k": 2.0}}
    run = {"t": 2.0, **options}
    some = vv.Scene(particles, *beside, vv.ExpressionForce(**spring, bodies=[1, 3])).run(**run)
    if beside:
        springs = [vv.ExpressionForce(**spring, bodies=index) for index in (3, 1)]
        apart = vv.Scene(particles, *beside, *springs).run(**run)
        np.testing.assert_allclose(some.position[-1], apart.position[-1], rtol=0, atol=1e-10)
        return
    of_all = vv.Scene(particles, vv.ExpressionForce(**spring)).run(**run)
    np.testing.assert_allclose(some.position[-1, [1, 3]], of_all.position[-1, [1, 3]], rtol=0, atol=1e-12)
    free = particles.position + 2.0 * particles.velocity
    np.testing.assert_allclose(some.position[-1, [0, 2]], free[[0, 2]], rtol=0, atol=1e-13)


@pytest.mark.parametrize("options", METHODS)
def test_an_acceleration_is_a_force_for_each_unit_of_mass(options: dict[str, Any]) -> None:
    particles = bodies([1.0, 2.0, 0.5, 1.5])
    by_force = [
        vv.ExpressionForce(force=pull, parameters={"k": 0.7 * float(mass)}, bodies=index)
        for index, mass in enumerate(particles.mass)
    ]
    one = vv.Scene(particles, *by_force).run(2.0, **options)
    other = vv.Scene(particles, vv.ExpressionForce(acceleration=pull, parameters={"k": 0.7})).run(2.0, **options)
    np.testing.assert_allclose(one.position, other.position, rtol=0, atol=1e-11)
    assert np.isnan(other.virial).any() == np.isnan(one.virial).any()
    np.testing.assert_allclose(one.virial, other.virial, rtol=0, atol=1e-10)


@pytest.mark.parametrize("options", METHODS)
def test_dust_is_pushed_and_the_star_is_not(options: dict[str, Any]) -> None:
    """Radiation takes a part β of gravity away: the orbit of dust is that of a star of (1 − β) of the mass."""
    place, speed, beta = [[0.0, 0, 0], [1.0, 0, 0], [0, 2.0, 0]], [[0.0, 0, 0], [0, 0.9, 0], [-0.6, 0, 0]], 0.2

    def light(r: Any, v: Any, t: Any, push: Any) -> list[Any]:
        distance = (r[0] ** 2 + r[1] ** 2 + r[2] ** 2) ** 0.5
        return [push * each / distance**3 for each in r]

    pushed = vv.ExpressionForce(acceleration=light, parameters={"push": beta}, bodies=[1, 2])
    dust = vv.Scene(vv.Particles([1.0, 0.0, 0.0], place, speed), vv.Gravity(1.0), pushed)
    lighter = vv.Scene(vv.Particles([1.0 - beta, 0.0, 0.0], place, speed), vv.Gravity(1.0))
    one, other = dust.run(5.0, **options), lighter.run(5.0, method="taylor", rtol=1e-13)
    # Equal steps of 0.01 are off by 1e-8 (rk4) and 1e-4 (leapfrog) on these orbits.
    atol = {"rk4": 1e-7, "leapfrog": 1e-3}.get(options.get("method", ""), 1e-7)
    np.testing.assert_allclose(one.position[-1], other.position[-1], rtol=0, atol=atol)
    assert (one.position[:, 0] == 0.0).all()


def test_copies_alone_files_and_names(tmp_path: Path) -> None:
    """Copies with parameters of their own have the bits that they have alone; files and pickles keep the bodies."""
    particles = vv.Particles(
        [1.0, 0.0, 2.0],
        [[0.0, 0, 0], [1, 0, 0], [3, 0, 0]],
        [[0.0, 0, 0], [0, 1, 0], [0, 0.5, 0]],
        names=["a", "b", "c"],
    )
    force = vv.ExpressionForce(acceleration=pull, parameters={"k": 0.5}, bodies=["b", "c"])
    scene = vv.Scene(particles, vv.Gravity(0.1), force)
    assert "bodies=[1, 2]" in repr(scene.forces[1])
    assert pickle.loads(pickle.dumps(scene)) == scene
    copies = scene.ensemble(parameters={1: {"k": [0.5, 0.75, 0.25, 2.0, 1.0]}})
    out = copies.run([1.0, 2.0], threads=2)
    for index in range(5):
        np.testing.assert_array_equal(copies[index].run([1.0, 2.0]).position, out.position[index])
    out.save(tmp_path / "out.npz")
    again = vv.load(tmp_path / "out.npz")
    np.testing.assert_array_equal(again.final[3].run(3.0).position, out.final[3].run(3.0).position)


def test_what_is_refused() -> None:
    particles = bodies([1.0, 0.0])
    with pytest.raises(vv.InvalidInput, match=r"bodies.*expected indices of the 2 bodies of the scene, got 5"):
        vv.Scene(particles, vv.ExpressionForce(acceleration=pull, parameters={"k": 1.0}, bodies=5)).run(1.0)
    with pytest.raises(vv.InvalidInput, match="every mass must be positive"):
        vv.Scene(particles, vv.ExpressionForce(force=pull, parameters={"k": 1.0})).run(1.0)
    vv.Scene(particles, vv.ExpressionForce(force=pull, parameters={"k": 1.0}, bodies=0)).run(1.0)
    with pytest.raises(vv.InvalidInput, match="got force and acceleration"):
        vv.ExpressionForce(force=pull, acceleration=pull, parameters={"k": 1.0})
    with pytest.raises(vv.InvalidInput, match="got none of them"):
        vv.ExpressionForce(parameters={"k": 1.0})
    with pytest.raises(vv.InvalidInput, match=r"acceleration.*expected three components"):
        vv.ExpressionForce(acceleration=lambda r, v, t: r[0])
    for wrong in ([], -1, 1.5, [0, -1]):
        with pytest.raises(vv.InvalidInput, match="bodies"):
            vv.Scene(particles, vv.ExpressionForce(acceleration=lambda r, v, t: r, bodies=wrong)).run(1.0)  # type: ignore[arg-type]
    merging = vv.Particles([1.0, 1.0], [[0.0, 0, 0], [3, 0, 0]], [[0.0, 0, 0], [-1, 0, 0]], radius=0.5)
    with pytest.raises(vv.InvalidInput, match="tells bodies apart"):
        vv.Scene(merging, vv.ExpressionForce(force=lambda r, v, t: r, bodies=1)).run(3.0, collisions="merge")
    out = vv.Scene(merging, vv.ExpressionForce(acceleration=lambda r, v, t: [0.0, 0.0, -1.0])).run(
        3.0, collisions="merge"
    )
    assert len(out.collisions) == 1
