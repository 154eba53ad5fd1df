"""What the plan tells of long quiet runs, for which steps of equal length are better, and that it is true."""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def planets(eccentricity: float, *, sign: float = 1.0) -> vv.Scene:
    """A sun and eight planets, the innermost at its pericenter; periods 2 pi, 27 of them, and 150 and more."""
    near = 1.0 - eccentricity
    speed = np.sqrt(1.001 * (1.0 + eccentricity) / near)
    far = 28.0 + 8.0 * np.arange(6)
    place = np.zeros((9, 3))
    velocity = np.zeros((9, 3))
    place[1:, 0] = [near, 9.0, *far]
    velocity[1:, 1] = [speed, 1 / 3, *far**-0.5]
    velocity[2, 2] = 0.02
    return vv.Scene(vv.Particles([1.0, 1e-3, 1e-4, *[1e-9] * 6], place, velocity), vv.Gravity(sign))


def told(scene: vv.Scene, t: float, **how: Any) -> dict[str, float] | None:
    rows = [row for row in scene.plan(t=t, **how).rows if row[0] == "long span"]
    if not rows:
        return None
    ((_, decision, reason),) = rows
    assert "stormer13" in reason
    return {"periods": float(decision.split()[0]), "dt": float(reason.split("dt=")[1].split()[0])}


@pytest.mark.parametrize("eccentricity", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_long_quiet_span_is_told_with_a_better_way(eccentricity: float, direction: float) -> None:
    """The period is that of the circle through the pericenter; the way that is told is closer than the plan's own."""
    scene, period = planets(eccentricity), 2.0 * np.pi * (1.0 - eccentricity) ** 1.5
    found = told(scene, direction * 400.0 * period)
    assert found is not None
    assert found["periods"] == pytest.approx(400.0, rel=2e-3)  # the planet's own mass, and the outer one
    assert found["dt"] == pytest.approx(direction * period / 200.0, rel=0.05, abs=0)  # two digits
    end = direction * 400.0 * period
    exact = scene.run(t=end, method="kahan_li8", dt=direction * period / 400.0).position[-1]
    ours = scene.run(t=end, method="stormer13", dt=found["dt"])
    other = scene.run(t=end)
    assert other.plan.method == "verner98"
    off, of_auto = (np.abs(out.position[-1] - exact).max() for out in (ours, other))
    assert off < 0.1 * of_auto
    assert ours.stats.evaluations < other.stats.evaluations


def test_of_others_nothing_is_told() -> None:
    """Short spans, wide encounters, unbound bodies, other forces and methods, softening, and what has a closed form."""
    scene, long = planets(0.3), 4000.0
    assert told(scene, long) is not None
    assert told(scene, 100.0) is None
    assert told(scene, long, method="dop853") is None
    assert told(planets(0.6), long) is None
    assert told(vv.problems.figure_eight().scene, long) is None
    assert told(planets(0.3, sign=-1.0), long) is None
    bodies = scene.particles
    for forces in ([vv.Gravity(1.0, softening=0.01)], [vv.Gravity(1.0), vv.LinearDrag(1e9)]):
        assert told(vv.Scene(bodies, *forces), long) is None
    flung = vv.Particles(bodies.mass, bodies.position, bodies.velocity * np.array([1, 1, 9, 1, 1, 1, 1, 1, 1])[:, None])
    assert told(vv.Scene(flung, vv.Gravity(1.0)), long) is None
