"""Mergers of bodies that forces tell apart: what the merged body feels, against scenes put together by hand."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva._mergers import remaining

GRAVITY = vv.Gravity(1.0)
TIMES = np.linspace(0.0, 1.8, 10)
#: Body 1 falls on body 0, and then body 2 on what they have become; body 3 goes its way.
MASS = [5.0, 1.0, 0.5, 0.2]
POSITION = [[0, 0, 0], [3, 0.05, 0], [0, 4, 0], [-6, 0.3, 0.2]]
VELOCITY = [[0, 0, 0], [-1, 0, 0], [0, -1.0, 0.02], [0, 0.5, 0]]
CHARGE = [1.0, -0.5, 0.25, 0.125]
OBLATE: dict[str, Any] = {"G": 1.0, "axis": [0.1, 0.2, 1.0]}


def slowed(bodies: int | list[int]) -> vv.ExpressionForce:
    """Drag by a gas that turns, on some bodies."""
    return vv.ExpressionForce(
        acceleration=lambda r, v, t, rate: [-rate * (v[0] + r[1] / 4), -rate * (v[1] - r[0] / 4), -rate * v[2]],
        parameters={"rate": 0.2},
        bodies=bodies,
    )


#: A force on four bodies, and that on bodies 0, 2 and 3 when body 1 is a part of body 0.
FORCES: dict[str, tuple[vv.forces.Force, vv.forces.Force | None]] = {
    "oblate host": (vv.Oblate(0, J2=0.01, radius=0.5, **OBLATE), vv.Oblate(0, J2=0.01, radius=0.5, **OBLATE)),
    "oblate part": (vv.Oblate(1, J2=0.01, radius=0.3, **OBLATE), None),
    "several oblate": (
        vv.Oblate([2, 1, 0], J2=[0.01, 0.02, 0.03], radius=[0.3, 0.4, 0.5], J4=[1e-3, 2e-3, 3e-3], **OBLATE),
        vv.Oblate([1, 0], J2=[0.01, 0.03], radius=[0.3, 0.5], J4=[1e-3, 3e-3], **OBLATE),
    ),
    "relativistic part": (vv.PostNewtonian(1, G=1.0, c=20.0), vv.PostNewtonian(0, G=1.0, c=20.0)),
    "both relativistic": (vv.PostNewtonian([1, 3, 0], G=1.0, c=20.0), vv.PostNewtonian([0, 2], G=1.0, c=20.0)),
    "spring between them": (vv.Spring(0, 1, k=0.1, length=1.0), None),
    "springs": (
        vv.Spring([0, 1, 3], [1, 2, 1], k=[0.1, 0.2, 0.3], length=[0.5, 0.0, 2.0]),
        vv.Spring([0, 2], [1, 0], k=[0.2, 0.3], length=[0.0, 2.0]),
    ),
    "dampers": (vv.Damper([0, 1, 3], [1, 2, 1], c=[0.1, 0.2, 0.3]), vv.Damper([0, 2], [1, 0], c=[0.2, 0.3])),
    "charges": (vv.Coulomb(CHARGE, k=0.5), vv.Coulomb([0.5, 0.25, 0.125], k=0.5)),
    "equal charges": (vv.Coulomb(0.5, k=0.5), vv.Coulomb([1.0, 0.5, 0.5], k=0.5)),
    "charges in an electric field": (
        vv.UniformElectricField([0.1, 0.2, 0.3], CHARGE),
        vv.UniformElectricField([0.1, 0.2, 0.3], [0.5, 0.25, 0.125]),
    ),
    "charges in a magnetic field": (
        vv.UniformMagneticField([0.1, 0.2, 0.3], CHARGE),
        vv.UniformMagneticField([0.1, 0.2, 0.3], [0.5, 0.25, 0.125]),
    ),
    # A body goes on as before when others go into it: dragged or not.
    "an acceleration of parts": (slowed([2, 1]), slowed(1)),
    "an acceleration of the host": (slowed([0, 1, 3]), slowed([0, 2])),
    "an acceleration of one that goes": (slowed(1), None),
}
each_force = pytest.mark.parametrize("name", FORCES)
HOW: dict[str, Any] = {"collisions": "merge", "method": "dop853", "rtol": 1e-13}


def falling(*forces: vv.forces.Force) -> vv.Scene:
    return vv.Scene(vv.Particles(MASS, POSITION, VELOCITY, radius=[0.5, 0.3, 0.3, 0.2]), *forces)


@each_force
def test_a_merged_body_feels_what_is_left_of_the_force(name: str) -> None:
    """The run up to the contact, both put together by hand, and a run of what is left under the force on that.

    Both runs err by 1e-13 a step; the contact is told to 1e-14, and the places after it are as exact as that.
    """
    before, after = FORCES[name]
    out = falling(GRAVITY, before).run(TIMES, **HOW)
    first = out.collisions.t[0]
    met = falling(GRAVITY, before).run(TIMES[-1], **(HOW | {"collisions": "stop"})).final
    assert met.t0 == pytest.approx(first, rel=1e-14, abs=0)
    mass, position, velocity = met.particles.mass, met.particles.position.copy(), met.particles.velocity.copy()
    position[0], velocity[0] = (mass[:2] @ of[:2] / mass[:2].sum() for of in (position, velocity))
    radius = [np.cbrt(0.5**3 + 0.3**3), 0.3, 0.2]
    there = [0, 2, 3]
    bodies = vv.Particles([6.0, 0.5, 0.2], position[there], velocity[there], radius=radius)
    forces = [GRAVITY] if after is None else [GRAVITY, after]
    left = vv.Scene(bodies, *forces, t0=met.t0)
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
    # The rate of change of the momentum, over a hundredth of the rows' spacing.
    after = out.final.run(TIMES[-1] + 1e-4, **HOW)
    assert not len(after.collisions)
    rate = (after.velocity[-1] - out.velocity[-1]) / 1e-4
    np.testing.assert_allclose(out.final.acceleration(), rate, rtol=2e-3, atol=1e-5)


@each_force
def test_a_run_goes_on_from_mergers(name: str) -> None:
    """Both runs keep to 1e-13 a step; their steps differ."""
    scene = falling(GRAVITY, FORCES[name][0])
    whole = scene.run(TIMES[-1], **HOW)
    half = scene.run(1.5, **HOW)
    assert len(half.collisions)
    final: vv.Scene = pickle.loads(pickle.dumps(half.final))
    on = final.run(TIMES[-1], **HOW)
    np.testing.assert_allclose(on.position[-1], whole.position[-1], rtol=0, atol=1e-12)
    bounced = final.run(TIMES[-1], **(HOW | {"collisions": "bounce"}))
    if len(half.collisions) == len(whole.collisions):
        np.testing.assert_array_equal(bounced.position[-1], on.position[-1])
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
    """Two that fall on each other are a body without charge, which no field moves."""
    bodies = vv.Particles([1.0, 3.0], [[-1, 0, 0], [1, 0, 0]], radius=0.1)
    fields = (vv.Coulomb([2.0, -2.0], k=1.0), vv.UniformElectricField([0.0, 0.1, 0.0], [2.0, -2.0]))
    out = vv.Scene(bodies, *fields).run([0.0, 3.0, 5.0], collisions="merge")
    assert out.collisions.survivor.tolist() == [1]
    np.testing.assert_allclose(out.velocity[1], out.velocity[2], rtol=0, atol=0)
    # The momentum of both was that of no force: the charges add to nothing.
    np.testing.assert_allclose(out.momentum[2], 0.0, rtol=0, atol=1e-14)


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
