"""Falls into a force that grows faster than gravity: who fell, and that no tolerance is to blame."""

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize("rtol", [1e-9, 1e-11])
@pytest.mark.parametrize("method", ["dop853", "verner98"])
def test_a_fall_into_the_field_of_a_flat_body_is_an_encounter(method: str, rtol: float) -> None:
    """J2 alone goes as 1/r⁴: the two are never nearer than a part in 1e5 of where they began, and as fast as 1e9."""
    draw = np.random.default_rng(3)
    bodies = vv.Particles(draw.uniform(0.5, 2, 3), draw.normal(size=(3, 3)) * 2, draw.normal(size=(3, 3)) * 0.5)
    flat = vv.Oblate(0, 1.0, 0.1, 0.5, [0, 0.6, 0.8], J4=0.05)
    with pytest.raises(vv.CloseEncounter) as met:
        vv.Scene(bodies, flat, vv.Harmonic(1.5, [0.1, 0.2, 0.3])).run(t=2.0, rtol=rtol, method=method)
    error = met.value
    assert 0 in error.bodies
    last = error.trajectory.final.particles.position
    apart = np.linalg.norm(last[error.bodies[0]] - last[error.bodies[1]])
    assert apart < 1e-3
    assert error.distance == pytest.approx(apart, rel=1e-2, abs=0.0)


def test_steps_that_no_fall_makes_short_are_still_told_as_such() -> None:
    """Fast bodies that are far from each other are no encounter."""
    far = vv.Particles([1.0, 1.0], [[0, 0, 0], [1e3, 0, 0]], [[1e9, 0, 0], [0, 0, 0]])
    scene = vv.Scene(far, vv.ExpressionForce(force=lambda r, v, t: (1e30 / (1e-8 - t), 0.0, 0.0)))
    with pytest.raises(vv.ConvergenceError):
        scene.run(t=1.0, method="dop853")
