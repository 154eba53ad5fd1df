"""Several contacts at one instant: what symmetry, and the books, ask for, whatever the bodies are called."""

import itertools
from typing import Any

import numpy as np
import pytest

import visviva as vv

ROOT = np.sqrt(3.0)
MIRROR = np.array([1.0, -1.0, 1.0])


def rack(rows: int, *, mass: float = 1.0, speed: float = 1.0) -> vv.Scene:
    """A ball of mass 1 that comes along x, and rows of 1, 2, 3, … balls that touch; of two rows the second alone."""
    places = [
        [ROOT / 2 * row, column - row / 2.0, 0.0] for row in range(rows) for column in range(row + 1) if row or rows > 2
    ]
    position = np.array([[-3.0, 0.0, 0.0], *places])
    velocity = np.zeros(position.shape)
    velocity[0, 0] = speed
    return vv.Scene(vv.Particles([1.0, *[mass] * len(places)], position, velocity, radius=0.5))


def energy(out: vv.Trajectory) -> np.ndarray:
    return 0.5 * np.einsum("n,tnc,tnc->t", out.scene.particles.mass, out.velocity, out.velocity)


def test_a_ball_that_hits_two_at_once_comes_back_with_a_fifth_of_its_speed() -> None:
    scene = rack(2)
    expected = np.array([[-0.2, 0.0, 0.0], [0.6, -0.2 * ROOT, 0.0], [0.6, 0.2 * ROOT, 0.0]])
    for order in itertools.permutations(range(3)):
        bodies = scene.particles[list(order)]
        out = vv.Scene(bodies).run(t=10.0, collisions="bounce")
        np.testing.assert_allclose(out.velocity[-1], expected[list(order)], rtol=0, atol=1e-14)
        assert len(out.collisions) == 2
        np.testing.assert_allclose(out.collisions.speed, ROOT / 2, rtol=1e-13)
        assert not out.collisions.energy_lost.any()


@pytest.mark.parametrize("restitution", [1.0, 0.7])
@pytest.mark.parametrize("rows", [2, 3, 4])
@pytest.mark.parametrize("mass", [1.0, 0.3, 20.0])
def test_a_scene_that_is_its_mirror_image_stays_that(rows: int, mass: float, restitution: float) -> None:
    out = rack(rows, mass=mass).run(t=6.0, collisions="bounce", restitution=restitution)
    last = out.final.particles
    for body, (x, v) in enumerate(zip(last.position, last.velocity, strict=True)):
        there = np.abs(last.position - x * MIRROR).max(axis=1)
        image = int(there.argmin())
        # Rounding of contacts that follow one another.
        assert there[image] < 1e-9, body
        np.testing.assert_allclose(last.velocity[image], v * MIRROR, rtol=0, atol=1e-9)
    np.testing.assert_allclose(out.momentum[-1], out.momentum[0], rtol=0, atol=1e-13)
    lost = energy(out)[0] - energy(out)[-1]
    np.testing.assert_allclose(lost, out.collisions.energy_lost.sum(), rtol=0, atol=1e-13)
    assert (out.collisions.energy_lost >= 0.0).all()


def test_backwards_it_all_comes_together_again() -> None:
    scene = rack(2)
    there = scene.run(t=5.0, collisions="bounce").final
    back = there.run(t=0.0, collisions="bounce")
    np.testing.assert_allclose(back.final.particles.position, scene.particles.position, rtol=0, atol=1e-9)


def test_balls_that_hit_one_from_both_sides_part_as_they_came() -> None:
    """Half of the speed is left to both, and the one between them stays: whoever is asked first."""
    bodies = vv.Particles(
        np.ones(3), [[-3.0, 0, 0], [0, 0, 0], [3.0, 0, 0]], [[1.0, 0, 0], [0, 0, 0], [-1.0, 0, 0]], radius=0.5
    )
    out = vv.Scene(bodies).run(t=4.0, collisions="bounce", restitution=0.5)
    np.testing.assert_allclose(out.velocity[-1, :, 0], [-0.5, 0.0, 0.5], rtol=0, atol=1e-15)
    np.testing.assert_allclose(out.collisions.energy_lost, 0.375, rtol=1e-15)


@pytest.mark.parametrize("coming", [1, 2, 3])
def test_as_many_balls_leave_a_row_as_came(coming: int) -> None:
    """Newton's cradle: what touches and does not approach waits for its turn."""
    x = np.concatenate([np.arange(coming) - coming - 2.0, np.arange(5 - coming, dtype=float)])
    position = np.stack([x, 0 * x, 0 * x], axis=1)
    velocity = np.zeros((5, 3))
    velocity[:coming, 0] = 1.0
    out = vv.Scene(vv.Particles(np.ones(5), position, velocity, radius=0.5)).run(t=6.0, collisions="bounce")
    np.testing.assert_allclose(out.velocity[-1, :, 0], [0.0] * (5 - coming) + [1.0] * coming, rtol=0, atol=1e-13)


def test_the_fastest_goes_first_whatever_the_bodies_are_called() -> None:
    """A ball that reaches two at once and not along their middle."""
    base = rack(2)
    way = np.array([np.cos(0.2), np.sin(0.2), 0.0])
    position = base.particles.position.copy()
    position[0] = np.array([0.0, 0.0, 0.0]) - 3.0 * way
    velocity = np.zeros((3, 3))
    velocity[0] = way
    wanted = None
    for order in itertools.permutations(range(3)):
        bodies = vv.Particles(np.ones(3), position[list(order)], velocity[list(order)], radius=0.5)
        out = vv.Scene(bodies).run(t=10.0, collisions="bounce")
        found = out.velocity[-1][np.argsort(order)]
        wanted = found if wanted is None else wanted
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13)


def test_massless_balls_bounce_off_two_at_once() -> None:
    """Off two that it does not move: the mirror image of its way in their plane of touching, twice."""
    scene = rack(2)
    bodies = vv.Particles([0.0, 1.0, 1.0], scene.particles.position, scene.particles.velocity, radius=0.5)
    out = vv.Scene(bodies).run(t=10.0, collisions="bounce")
    np.testing.assert_allclose(out.velocity[-1], [[-1.0, 0, 0], [0, 0, 0], [0, 0, 0]], rtol=0, atol=1e-14)


ACTING: list[tuple[Any, str]] = [
    (vv.Harmonic(1.0), "Harmonic"),
    (vv.DrivenForce([0.0, 1.0, 0.0], 0.0), "DrivenForce"),
    (vv.CentralField(vv.potentials.Plummer(-1.0, 1.0)), "CentralField"),
    (vv.PairPotential(vv.potentials.Morse(1.0, 1.0, 1.5)), "PairPotential"),
    (vv.QuadraticDrag(0.1), "QuadraticDrag"),
    (vv.Drag(1.0, 0.1, 0.1), "Drag"),
    (vv.ExpressionForce(potential=lambda r, v, t: r[0] ** 2), "ExpressedForce"),
]


@pytest.mark.parametrize(("force", "name"), ACTING, ids=[name for _, name in ACTING])
def test_mergers_beside_forces_that_ask_for_no_mass_are_refused(force: vv.forces.Force, name: str) -> None:
    """One of mass 2 would feel the force of one of the two it was made of."""
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [3.0, 0, 0]], [[0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    scene = vv.Scene(bodies, force)
    for asked in (scene.run, scene.plan):
        with pytest.raises(vv.InvalidInput, match=rf"^collisions: {name} acts on every body alike.*whatever its mass"):
            asked(t=6.0, collisions="merge")
    # What does not merge goes on as it is.
    assert scene.plan(t=6.0, collisions="bounce")


@pytest.mark.parametrize(
    "force", [vv.Gravity(1.0), vv.UniformField([0, 1.0, 0]), vv.LinearDrag(2.0), vv.RotatingFrame([0, 0, 0.1])]
)
def test_a_merged_body_feels_what_both_felt(force: vv.forces.Force) -> None:
    """The acceleration of the center of mass of both, at one place with one velocity, is that of what they become."""
    bodies = vv.Particles([1.0, 1.0], [[-2, 0, 0], [2.0, 0, 0]], [[1.0, 0.3, 0], [-1.0, 0.3, 0]], radius=0.5)
    scene = vv.Scene(bodies, force)
    out = scene.run(t=6.0, collisions="merge")
    assert out.collisions.survivor.tolist() == [0]
    alone = vv.Scene(vv.Particles([1.0], out.final.particles.position[:1], out.final.particles.velocity[:1]), force)
    np.testing.assert_allclose(out.final.acceleration()[0], alone.acceleration()[0], rtol=1e-14)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_meet_at_once_as_each_does_alone(threads: int) -> None:
    """Nine copies, each at a speed of its own; a fifth of it comes back."""
    scene = rack(2)
    speeds = np.linspace(0.5, 2.0, 9)
    velocity = np.tile(scene.particles.velocity, (9, 1, 1))
    velocity[:, 0, 0] = speeds
    copies = scene.ensemble(velocity=velocity).run(t=10.0, collisions="bounce", threads=threads)
    # Some roundings of the impulses.
    np.testing.assert_allclose(copies.velocity[:, -1, 0, 0], -speeds / 5, rtol=1e-14)
    for copy in (0, 4, 8):
        alone = scene.with_state(velocity=velocity[copy]).run(t=10.0, collisions="bounce")
        np.testing.assert_array_equal(alone.velocity[-1], copies.velocity[copy, -1])
