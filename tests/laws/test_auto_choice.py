"""What `auto` takes: series where few bodies are coupled by forces that have them, else Verner's 9(8).

Bounds: a pulse is integrated to rtol = 1e-9 of its height of 200, in steps across 1/300 of the time; ten times what
is reached.
"""

import numpy as np
import pytest

import visviva as vv

KOZAI = vv.Scene(
    vv.Particles(
        [1.0, 1e-3, 0.5],
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [8.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.1, 0.42]],
    ),
    vv.Gravity(1.0),
)


@pytest.mark.parametrize("scene", [KOZAI, vv.problems.figure_eight().scene, vv.problems.pythagorean().scene])
def test_few_bodies_are_closer_than_by_dop853_at_one_tolerance(scene: vv.Scene) -> None:
    """At a tolerance of 1e-9 the errors were a hundred to a thousand times those of series, in the same time."""
    exact = scene.run(t=10.0, method="taylor", rtol=3e-14).position[-1]
    ours, other = scene.run(t=10.0), scene.run(t=10.0, method="dop853")
    assert ours.plan.method == "taylor"
    assert np.abs(ours.position[-1] - exact).max() < 0.1 * np.abs(other.position[-1] - exact).max()


@pytest.mark.parametrize("rtol", [1e-9, 1e-12])
def test_planets_are_closer_than_by_dop853_at_one_tolerance(rtol: float) -> None:
    """A Sun and eight planets for forty turns of Mercury, the errors of which are a twentieth and an eighth."""
    scene = vv.datasets.solar_system().scene
    exact = scene.run(t=3652.5, method="taylor", rtol=3e-14).position[-1]
    ours, other = scene.run(t=3652.5, rtol=rtol), scene.run(t=3652.5, rtol=rtol, method="dop853")
    assert ours.plan.method == "verner98"
    assert np.abs(ours.position[-1] - exact).max() < 0.2 * np.abs(other.position[-1] - exact).max()


def test_many_bodies_and_forces_without_series_are_stepped_by_verner98() -> None:
    def method(scene: vv.Scene) -> str:
        return scene.plan(t=1.0).method

    def bodies(count: int) -> vv.Particles:
        random = np.random.default_rng(count)
        return vv.Particles(np.ones(count), random.normal(size=(count, 3)), random.normal(size=(count, 3)))

    assert method(vv.Scene(bodies(8), vv.Gravity(1.0))) == "taylor"
    assert method(vv.Scene(bodies(9), vv.Gravity(1.0))) == "verner98"
    # Other forces may have parameters of their own for each copy, and series share no lanes then.
    assert method(vv.Scene(bodies(3), vv.Gravity(1.0), vv.LinearDrag(10.0))) == "verner98"
    assert method(vv.Scene(bodies(3), vv.Gravity(1.0), vv.QuadraticDrag(0.1))) == "verner98"


def test_what_is_written_as_an_expression_is_met_by_shorter_steps() -> None:
    """A wall higher than the body's energy along it, five lengths ahead: longer steps went through."""
    wall = vv.ExpressionForce(potential=lambda r, v, t: np.tanh(50.0 * r[0]))
    body = vv.Particles([1.0], [[-5.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    out = vv.Scene(body, wall, vv.UniformField([0.0, 0.0, -9.81])).run(t=40.0)
    assert out.plan.method == "dop853"
    # Written to 1e-5 of what small steps give; here 1.5e-6 off.
    assert out.position[-1, 0, 0] == pytest.approx(-34.98791, abs=1e-5)


@pytest.mark.parametrize("method", ["auto", "verner98", "bogacki_shampine32"])
@pytest.mark.parametrize("width", [0.3, 0.05, 0.02])
def test_no_step_is_a_large_part_of_a_run_among_expressions(method: vv.typing.MethodName, width: float) -> None:
    """Bodies and a wall higher than their energies: many went through it where it was narrower than a step."""
    wall = vv.ExpressionForce(potential=lambda r, v, t: 50.0 * np.exp(-(((r[0] - 3.0) / width) ** 2)))
    random = np.random.default_rng(1)
    place, speed = random.uniform(-1.0, 1.0, 100), random.uniform(1.0, 5.0, 100)
    at_rest = np.zeros((100, 2))
    bodies = vv.Particles(np.ones(100), np.c_[place, at_rest], np.c_[speed, at_rest])
    out = vv.Scene(bodies, wall).run(t=6.0, method=method)
    assert (out.position[-1, :, 0] < 3.0).all()


def test_a_pulse_within_a_long_free_way_is_felt() -> None:
    """It changes the velocity by its integral, √π times its height and width; no step of a free body ends before it."""
    pulse = vv.ExpressionForce(force=lambda r, v, t: (200.0 * np.exp(-(((t - 3.0) / 0.02) ** 2)), 0.0, 0.0))
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]), pulse)
    for method in ("auto", "verner98"):
        assert scene.run(t=6.0, method=method).velocity[-1, 0, 0] == pytest.approx(
            4.0 * np.sqrt(np.pi), rel=4e-10, abs=0
        )
    assert "longest step" in str(scene.plan(t=6.0))
    assert "longest step" not in str(scene.plan(t=6.0, max_step=1.0))


def test_massless_bodies_do_not_enter_the_choice() -> None:
    """Massive bodies have the bits that they have without them."""
    random = np.random.default_rng(1)
    particles = KOZAI.particles
    many = vv.Particles(
        [*particles.mass, *[0.0] * 20],
        np.r_[particles.position, 3.0 * random.normal(size=(20, 3))],
        np.r_[particles.velocity, random.normal(size=(20, 3))],
    )
    out = vv.Scene(many, vv.Gravity(1.0)).run(t=3.0)
    assert out.plan.method == "taylor"
    assert (out.position[:, :3] == KOZAI.run(t=3.0).position).all()


@pytest.mark.parametrize("method", ["auto", "taylor"])
def test_massless_bodies_that_may_touch_fall_as_they_must(method: vv.typing.MethodName) -> None:
    """They did not move at all, with status OK, where `taylor` was named beside `collisions`."""
    place = [[0.0, 0, 0], [1.0, 0, 0]]
    scene = vv.Scene(vv.Particles([1.0, 0.0], place, np.zeros((2, 3)), radius=[0.1, 0.0]), vv.Gravity(1.0))
    out = scene.run(t=2.0, method=method, collisions="merge")
    # From rest at 1 to the surface at 0.1.
    exact = (np.arccos(np.sqrt(0.1)) + np.sqrt(0.1 * 0.9)) / np.sqrt(2.0)
    assert out.collisions.t == pytest.approx([exact], abs=1e-7)
