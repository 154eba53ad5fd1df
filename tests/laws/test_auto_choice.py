"""What `auto` takes: series where few bodies are coupled by forces that have them, else DOP853."""

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


def test_many_bodies_and_forces_without_series_are_stepped_by_dop853() -> None:
    def method(scene: vv.Scene) -> str:
        return scene.plan(t=1.0).method

    def bodies(count: int) -> vv.Particles:
        random = np.random.default_rng(count)
        return vv.Particles(np.ones(count), random.normal(size=(count, 3)), random.normal(size=(count, 3)))

    assert method(vv.Scene(bodies(8), vv.Gravity(1.0))) == "taylor"
    assert method(vv.Scene(bodies(9), vv.Gravity(1.0))) == "dop853"
    assert method(vv.Scene(bodies(40), vv.Harmonic(1.0), vv.RotatingFrame([0.1, 0.0, 0.3]))) == "taylor"  # each alone
    assert method(vv.Scene(bodies(3), vv.Gravity(1.0), vv.QuadraticDrag(0.1))) == "dop853"
    # √(x²) ends a motion by series where it turns.
    bend = vv.ExpressionForce(potential=lambda r, v, t: (r[0] ** 2) ** 0.5)
    assert method(vv.Scene(bodies(1), bend)) == "dop853"
