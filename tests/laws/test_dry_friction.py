"""Dry friction as an expression in a scene: a body comes to rest, and the run says so instead of creeping on."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

METHODS = ["auto", "dop853", "verner98", "dormand_prince54", "bogacki_shampine32"]


def along_a_line(r: Any, v: Any, t: Any) -> list[Any]:
    return [0.3 - 0.5 * v[0] / np.abs(v[0]), 0.0 * v[0], 0.0 * v[0]]


def in_a_plane(r: Any, v: Any, t: Any) -> list[Any]:
    speed = np.sqrt(v[0] ** 2 + v[1] ** 2)
    return [-0.5 * v[0] / speed, -0.5 * v[1] / speed, 0.0 * v[0]]


def thrown(force: Any, velocity: list[float]) -> vv.Scene:
    return vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [velocity]), vv.ExpressionForce(force=force))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("force", "velocity", "rest", "place"),
    [
        (along_a_line, [1.0, 0.0, 0.0], 5.0, [2.5, 0.0, 0.0]),
        # A speed of 1.25 is gone after 2.5.
        (in_a_plane, [1.0, 0.75, 0.0], 2.5, [1.25, 0.9375, 0.0]),
    ],
    ids=["line", "plane"],
)
def test_a_body_that_friction_holds_is_told(
    method: str, force: Any, velocity: list[float], rest: float, place: list[float]
) -> None:
    with pytest.raises(vv.ConvergenceError, match="velocity of body 0 sticks at zero") as stuck:
        thrown(force, velocity).run([0.0, 100.0], method=method)
    out = stuck.value.trajectory
    assert isinstance(out, vv.Trajectory)
    assert out.stats.steps < 50_000
    # It creeps on for some thousand steps until it is asked; none is longer than a tolerance allows.
    assert stuck.value.time == pytest.approx(rest, abs=5e-3)
    np.testing.assert_allclose(out.final.particles.position[0], place, rtol=0.0, atol=1e-4)


def test_copies_that_stick_end_alone() -> None:
    scene = thrown(along_a_line, [1.0, 0.0, 0.0])
    copies = scene.ensemble(velocity=np.array([[[1.0, 0.0, 0.0]], [[40.0, 0.0, 0.0]], [[2.0, 0.0, 0.0]]]))
    for threads in (1, 3):
        out = copies.run([0.0, 100.0], threads=threads)
        assert list(out.status) == [vv.Status.STEP_FAILURE, vv.Status.OK, vv.Status.STEP_FAILURE]
        fast = thrown(along_a_line, [40.0, 0.0, 0.0]).run([0.0, 100.0])
        np.testing.assert_array_equal(out.position[1], fast.position)


def test_many_short_steps_are_no_sticking() -> None:
    """A stiff damper takes as many steps and rests: both sides of zero are alike to it."""
    stiff = thrown(lambda r, v, t: [-1e4 * (v[0] - 1e-3), 0.0 * v[0], 0.0 * v[0]], [0.0, 0.0, 0.0])
    out = stiff.run([0.0, 100.0], max_steps=3_000_000)
    assert float(out.position[-1, 0, 0]) == pytest.approx(1e-3 * (100.0 - 1e-4), rel=1e-9, abs=0.0)


@pytest.mark.parametrize("bodies", [3, 20])
def test_among_many_bodies_with_their_own_masses(bodies: int) -> None:
    """Beside another force, a unit in one lane and in all: each copy ends as alone, on one thread and on three."""
    random = np.random.default_rng(bodies)
    mass = random.uniform(0.5, 2.0, bodies)
    position, velocity = 10.0 * random.normal(size=(bodies, 3)), random.normal(size=(bodies, 3))

    def in_space(r: Any, v: Any, t: Any) -> list[Any]:
        speed = np.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
        return [-0.5 * v[k] / speed for k in range(3)]

    scene = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1e-4), vv.ExpressionForce(force=in_space))
    copies = scene.ensemble(mass=np.array([mass * (1.0 + 0.1 * k) for k in range(5)]))
    runs = [copies.run([0.0, 50.0], threads=threads, method="dop853") for threads in (1, 3)]
    for out in runs:
        assert (out.status == vv.Status.STEP_FAILURE).all()
        assert out.stats.steps == runs[0].stats.steps
    with pytest.raises(vv.ConvergenceError, match="sticks at zero") as stuck:
        copies[2].run([0.0, 50.0], method="dop853")
    # The first to come to rest: mass times speed over the friction.
    first = float((mass * 1.2 * np.linalg.norm(velocity, axis=1) / 0.5).min())
    assert stuck.value.time == pytest.approx(first, abs=2e-2)
