"""Absolute tolerances of each kind and of each body: what they mean, what they leave as it is, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv


def three(massless: int = 0) -> vv.Scene:
    rng = np.random.default_rng(5)
    mass = np.append([1.0, 0.5, 0.25], np.zeros(massless))
    position = np.vstack([np.eye(3), 3.0 + rng.random((massless, 3))])
    return vv.Scene(vv.Particles(mass, position, 0.3 * rng.normal(size=position.shape)), vv.Gravity(1.0))


def many(massless: int = 0) -> vv.Scene:
    """More bodies than lanes."""
    rng = np.random.default_rng(6)
    position = 3.0 * rng.normal(size=(11 + massless, 3))
    return vv.Scene(vv.Particles(np.append(np.full(11, 0.1), np.zeros(massless)), position), vv.Gravity(1.0))


def bits(scene: vv.Scene, atol: Any, **how: Any) -> tuple[bytes, int]:
    out = scene.run([0.3, 1.0], method="dop853", rtol=1e-10, atol=atol, **how)
    return out.position.tobytes(), out.stats.steps


@pytest.mark.parametrize("make", [three, many])
@pytest.mark.parametrize("massless", [0, 9])
def test_the_same_number_in_any_form_has_the_same_bits(make: Any, massless: int) -> None:
    scene = make(massless)
    each = np.full(len(scene.particles), 1e-8)
    one = bits(scene, 1e-8)
    for atol in (each, each.tolist(), {"position": 1e-8, "velocity": each}, {"velocity": 1e-8, "position": 1e-8}):
        assert bits(scene, atol) == one
    assert bits(scene, each, threads=1) == bits(scene, each, threads=3)


@pytest.mark.parametrize("make", [three, many])
def test_the_strictest_decides_and_each_body_has_its_own(make: Any) -> None:
    scene = make()
    count = len(scene.particles)
    loose, strict = bits(scene, 1e-2)[1], bits(scene, 1e-12)[1]
    assert strict > loose + 2
    for body in range(count):
        own = np.full(count, 1e-2)
        own[body] = 1e-12
        # The steps of one body that is held to much are more than those of none, and at most those of all.
        assert loose < bits(scene, own)[1] <= strict + 1
    kinds = [{"position": 1e-2, "velocity": 1e-2} | {kind: 1e-12} for kind in ("position", "velocity")]
    steps = [bits(scene, atol)[1] for atol in kinds]
    assert loose <= min(steps)
    assert loose < max(steps) <= strict + 1


def test_a_kind_that_is_left_out_is_free_of_scale() -> None:
    scene = three()
    default = bits(scene, None)
    huge = bits(scene, {"position": 1e6, "velocity": 1e6})
    assert bits(scene, {"position": 1e6})[1] > huge[1]
    assert bits(scene, {"velocity": 1e6})[1] > huge[1]
    assert default[1] >= bits(scene, {"velocity": 1e6})[1]


def test_a_body_by_itself_is_held_to_its_own() -> None:
    rng = np.random.default_rng(7)
    particles = vv.Particles(np.ones(20), rng.normal(size=(20, 3)), rng.normal(size=(20, 3)))
    field = vv.CentralField(vv.potentials.Plummer(k=-1.0, a=0.5))
    each = 10.0 ** rng.integers(-12, -2, 20)
    out = vv.Scene(particles, field).run(2.0, method="dop853", rtol=1e-10, atol=each)
    for body in (0, 7, 8, 19):
        alone = vv.Scene(particles[[body]], field).run(2.0, method="dop853", rtol=1e-10, atol=each[[body]])
        assert np.array_equal(out.position[-1, body], alone.position[-1, 0])


def test_a_member_and_a_massless_body_are_as_if_alone() -> None:
    scene = three(9)
    each = 10.0 ** np.linspace(-12, -3, 12)
    starts = scene.particles.position + 1e-3 * np.random.default_rng(8).normal(size=(5, 12, 3))
    copies = scene.ensemble(position=starts)
    out = copies.run(1.0, rtol=1e-10, atol=each)
    for index, copy in enumerate(copies):
        alone = copy.run(1.0, rtol=1e-10, atol=each)
        assert np.array_equal(out[index].position, alone.position)
    massive = vv.Scene(scene.particles[[0, 1, 2]], vv.Gravity(1.0)).run(1.0, rtol=1e-10, atol=each[:3])
    whole = scene.run(1.0, rtol=1e-10, atol=each)
    assert np.array_equal(whole.position[:, :3], massive.position)
    body = vv.Scene(scene.particles[[0, 1, 2, 7]], vv.Gravity(1.0)).run(1.0, rtol=1e-10, atol=each[[0, 1, 2, 7]])
    assert np.array_equal(whole.position[:, 7], body.position[:, 3])


@pytest.mark.parametrize(
    ("atol", "told"),
    [
        ([1e-9, 1e-9], "atol: expected one number, or one for each of 3 bodies, got 2"),
        ({"position": [1e-9]}, None),
        ({"place": 1e-9}, r"expected the keys 'position' and 'velocity', or one of them, got \['place'\]"),
        ({}, "expected the keys"),
        ({"velocity": -1.0}, "atol: expected a number of at least 0 or None, got -1.0"),
        ([1e-9, -1e-9, 0.0], "atol: expected a number of at least 0 or None, got -1e-09"),
        ([1e-9, np.nan, 0.0], "finite"),
        (np.zeros((3, 1)), "atol"),
        ("1e-9", "atol"),
    ],
)
def test_what_is_no_tolerance_is_refused(atol: Any, told: str | None) -> None:
    if told is None:
        assert three().run(1.0, atol=atol).status == 0
        return
    for ask in (three().run, three().plan):
        with pytest.raises(vv.InvalidInput, match=told) as refused:
            ask(1.0, method="dop853", atol=atol)
        assert refused.value.argument.startswith("atol")


def test_fixed_steps_and_collisions_refuse_them() -> None:
    with pytest.raises(vv.InvalidInput, match=r"atol: leapfrog has a fixed step.*got several"):
        three().run(1.0, method="leapfrog", dt=0.1, atol=[1e-9, 1e-8, 1e-7])
    bodies = three().particles
    spheres = vv.Scene(vv.Particles(bodies.mass, bodies.position, bodies.velocity, radius=0.01), vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput, match="one number for all bodies beside collisions"):
        spheres.run(1.0, atol=[1e-9, 1e-8, 1e-7], collisions="merge")
    assert spheres.run(1.0, atol={"velocity": 1e-8}, collisions="merge").status == 0
