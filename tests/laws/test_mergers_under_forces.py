"""Mergers of bodies that forces tell apart: what the merged body feels, against scenes put together by hand."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from merging import CHARGE, FORCES, GRAVITY, HOW, MASS, OBLATE, POSITION, TIMES, VELOCITY, contact, falling

import visviva as vv
from visviva._mergers import remaining

each_force = pytest.mark.parametrize("name", FORCES)


@each_force
def test_a_merged_body_feels_what_is_left_of_the_force(name: str) -> None:
    """The run up to the contact, both put together by hand, and a run of what is left under the force on that.

    Both runs err by 1e-13 a step; the contact is told to 1e-14, and the places after it are as exact as that.
    """
    out, met, left = contact(name)
    first, there = out.collisions.t[0], [0, 2, 3]
    assert met.t0 == pytest.approx(first, rel=1e-14, abs=0)
    later = out.t > first
    assert later.sum() >= 2
    by_hand = left.run(out.t[later], **HOW)
    for column in ("position", "velocity"):
        found = getattr(out, column)[later][:, there]
        np.testing.assert_allclose(found, getattr(by_hand, column), rtol=0, atol=2e-12)
    np.testing.assert_allclose(out.energy[later], by_hand.energy, rtol=2e-12, atol=0)
    np.testing.assert_allclose(out.momentum[later], by_hand.momentum, rtol=0, atol=1e-12)


@each_force
def test_what_is_told_of_a_merged_scene_is_told_of_what_is_left(name: str) -> None:
    """Energies that a run records, those from its states, and those of its end are of the same bodies and forces."""
    scene = falling(GRAVITY, FORCES[name][0])
    record = ("position", "velocity", "energy", "potential_energy", "momentum")
    out = scene.run(TIMES, record=record, **HOW)
    assert len(out.collisions)
    again = scene.run(TIMES, **HOW)
    for column in ("energy", "potential_energy"):
        np.testing.assert_allclose(getattr(again, column), getattr(out, column), rtol=1e-14, atol=1e-15)
    told = out.final.invariants()
    assert told.energy == pytest.approx(out.energy[-1], rel=1e-13, abs=0)
    # The slope of the velocities about the last row: h²/6 of their third derivatives, and rounding over h.
    h = 1e-4
    around = scene.run([0.0, TIMES[-1] - h, TIMES[-1] + h], **HOW)
    assert around.collisions.t[-1] < TIMES[-1] - h
    slope = (around.velocity[2] - around.velocity[1]) / (2.0 * h)
    np.testing.assert_allclose(out.final.acceleration(), slope, rtol=1e-6, atol=1e-8)


@each_force
def test_a_run_goes_on_from_mergers(name: str) -> None:
    """Both runs keep to 1e-13 a step; their steps differ."""
    scene = falling(GRAVITY, FORCES[name][0])
    whole = scene.run(TIMES[-1], **HOW)
    half = scene.run(1.5, **HOW)
    assert len(half.collisions)
    final: vv.Scene = pickle.loads(pickle.dumps(half.final))
    on = final.run(TIMES[-1], **HOW)
    for column in ("position", "velocity", "momentum", "angular_momentum"):
        np.testing.assert_allclose(getattr(on, column)[-1], getattr(whole, column)[-1], rtol=0, atol=2e-12)
    assert on.energy[-1] == pytest.approx(whole.energy[-1], rel=2e-13, abs=0)
    bounced = final.run(TIMES[-1], **(HOW | {"collisions": "bounce"}))
    if len(half.collisions) == len(whole.collisions):
        np.testing.assert_array_equal(bounced.position[-1], on.position[-1])
        np.testing.assert_array_equal(bounced.velocity[-1], on.velocity[-1])
    with pytest.raises(vv.InvalidInput, match=r"run on with collisions=|no body in the place of"):
        # Without a word of what has merged, parts are bodies without mass in the place of others.
        vv.Scene(final.particles, vv.Coulomb(1.0, k=1.0), vv.Oblate(0, J2=0.1, radius=1.0, **OBLATE)).run(2.0)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("method", [{"method": "auto"}, {"method": "leapfrog", "dt": 1e-3}], ids=["auto", "leapfrog"])
def test_copies_merge_as_each_does_alone(threads: int, method: dict[str, Any]) -> None:
    """With own masses, starts and charges of copies: some merge at once, some late, some never."""
    random = np.random.default_rng(5)
    charges, mass = random.normal(size=(6, 4)), random.uniform(0.5, 2.0, (6, 4))
    position = np.array(POSITION) + 0.1 * random.normal(size=(6, 4, 3))
    position[4] *= 4.0
    pull = vv.Coulomb(CHARGE, k=0.5)
    scene = falling(pull, vv.Spring([0, 1], [2, 3], k=0.3), vv.Oblate([0, 1], J2=0.05, radius=0.4, **OBLATE))
    own = {"parameters": {pull: {"charge": charges}}, "mass": mass, "position": position}
    out = scene.ensemble(**own).run(TIMES, collisions="merge", threads=threads, **method)
    assert 0 < len(set(out.collisions.member.tolist())) < 6
    for copy in range(6):
        forces = (vv.Coulomb(charges[copy], k=0.5), *scene.forces[1:])
        bodies = vv.Particles(mass[copy], position[copy], VELOCITY, radius=[0.5, 0.3, 0.3, 0.2])
        alone = vv.Scene(bodies, *forces).run(TIMES, collisions="merge", **method)
        np.testing.assert_array_equal(out.position[copy], alone.position)
        np.testing.assert_array_equal(out.velocity[copy], alone.velocity)
        np.testing.assert_allclose(out[copy].energy, alone.energy, rtol=1e-14, atol=1e-15)


def test_opposite_charges_become_one_without() -> None:
    """Two that fall on each other from rest are a body without charge, at rest where their center of mass has been.

    The field moves each of them until then, and both together not at all. All their energy is gone: none is left of
    that in the field, nor of that of each other.
    """
    bodies = vv.Particles([1.0, 3.0], [[-1, 0, 0], [1, 0, 0]], radius=0.1)
    fields = (vv.Coulomb([2.0, -2.0], k=1.0), vv.UniformElectricField([0.0, 0.1, 0.0], [2.0, -2.0]))
    out = vv.Scene(bodies, *fields).run([0.0, 3.0, 5.0], collisions="merge", rtol=1e-13)
    assert out.collisions.survivor.tolist() == [1]
    met = vv.Scene(bodies, *fields).run(3.0, collisions="stop", rtol=1e-13).final
    assert abs(met.particles.velocity[:, 1]).min() > 0.05
    np.testing.assert_array_equal(out.velocity[1], out.velocity[2])
    np.testing.assert_allclose(out.position[1:, 1], [[0.5, 0.0, 0.0]] * 2, rtol=0, atol=1e-14)
    np.testing.assert_allclose(out.velocity[1:, 1], 0.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(out.momentum, 0.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(out.energy, [-2.0, 0.0, 0.0], rtol=1e-15, atol=1e-15)
    # What was lost is what falling brought: −4 (1/2 − 1/0.2), and the work of the field over the way between them.
    work = 0.2 * (met.particles.position[0, 1] - met.particles.position[1, 1])
    assert out.collisions.energy_lost[0] == pytest.approx(18.0 + work, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    "force",
    [
        vv.QuadraticDrag([1.0, 2.0]),
        vv.Drag(1.0, 0.1, [0.1, 0.2]),
        vv.ExpressionForce(force=lambda r, v, t: -r, bodies=[0]),
    ],
    ids=["QuadraticDrag", "Drag", "ExpressedForce"],
)
def test_numbers_of_bodies_that_do_not_add_are_refused(force: vv.forces.Force) -> None:
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [3.0, 0, 0]], [[0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    with pytest.raises(vv.InvalidInput, match="tells bodies apart, and nothing says what one feels"):
        vv.Scene(bodies, force).run(6.0, collisions="merge")


def test_bodies_that_are_not_there_are_told_before_they_merge() -> None:
    """Of a scene in which bodies have merged, too."""
    bodies = vv.Particles([1.0, 0.0, 1.0], [[0, 0, 0], [0, 0, 0], [3.0, 0, 0]], radius=[0.5, 0.0, 0.5])
    for force, argument in (
        (vv.Spring(0, 7, 1.0), "j"),
        (vv.Oblate(7, J2=0.1, radius=1.0, **OBLATE), "body"),
        (vv.PostNewtonian(7, G=1.0, c=1.0), "body"),
        (vv.Coulomb([1.0, 2.0], k=1.0), "charge"),
    ):
        for rule in ("merge", "bounce")[: 2 if argument != "charge" else 1]:
            with pytest.raises(vv.InvalidInput, match=rf"^{argument}: expected"):
                vv.Scene(bodies, force).run(1.0, collisions=rule)


@each_force
def test_where_nobody_is_gone_a_force_is_what_it_was(name: str) -> None:
    """All values of a force are told again, each in its place."""
    scene = falling(GRAVITY, FORCES[name][0])
    again = remaining(scene, np.arange(len(MASS)))
    here, there = (each.run(t=0.5, method="rk4", dt=0.125) for each in (scene, again))
    # Relativistic bodies are told in the order of their numbers, so that their pulls add up in another one.
    np.testing.assert_allclose(here.position, there.position, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(here.energy, there.energy, rtol=1e-14, atol=0)
