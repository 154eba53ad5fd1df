"""Where forces may give any energy, half the steps tell whether a run was thrown off course, and nothing of others."""

import warnings
from typing import Any

import numpy as np
import pytest

import visviva as vv

MEETING = vv.Particles([1.0, 1.0], [[1.0, 0, 0], [-1.0, 0, 0]], [[0, 0.05, 0], [0, -0.05, 0]])
BESIDE: dict[str, list[Any]] = {
    "a potential of the time": [vv.ExpressionForce(potential=lambda r, _v, t: 1e-9 * r[0] * t)],
    "a force of the velocity": [vv.ExpressionForce(force=lambda _r, v, _t: (1e-9 * v[0], 0.0 * v[0], 0.0 * v[0]))],
    "a drive": [vv.DrivenForce([0.1, 0.0, 0.0], 1.0)],
    "a drive and drag": [vv.DrivenForce([0.1, 0.0, 0.0], 1.0), vv.LinearDrag(1e3)],
}


def heard(run: Any) -> tuple[vv.Trajectory, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        out = run()
    return out, [str(warning.message) for warning in caught]


@pytest.mark.parametrize("name", list(BESIDE))
@pytest.mark.parametrize("back", [False, True])
def test_bodies_that_meet_between_two_steps(name: str, back: bool) -> None:
    """They fall together from a distance of 2 to one of 0.0025, and are thrown apart by whatever a step makes of it."""
    if back and name == "a drive and drag":
        pytest.skip("drag backward in time gives energy itself")
    scene = vv.Scene(MEETING, vv.Gravity(1.0), *BESIDE[name])
    end = -4.0 if back else 4.0
    right = scene.run(t=end, rtol=1e-12, record=["energy"]).energy[-1]
    out, messages = heard(lambda: scene.run(t=end, method="rk4", dt=4 / 256, record=["energy"]))
    assert abs(out.energy[-1] - right) > 0.5
    assert len(messages) == 1
    assert "the energy at the end is off by" in messages[0]
    _, silent = heard(lambda: scene.run(t=end / 4.0, method="rk4", dt=4 / 256))
    assert silent == []


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "kahan_li8", "verner98"])
def test_a_resonance_is_no_error(method: str) -> None:
    """A drive at the frequency of the oscillator: its energy grows to a hundred times what it was."""
    drive = vv.ExpressionForce(force=lambda r, _v, t: (-r[0] + np.cos(t), -r[1], -r[2]))
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), drive)
    how: dict[str, Any] = {} if method == "verner98" else {"dt": 0.01}
    out, messages = heard(lambda: scene.run(t=40.0, method=method, record=["energy"], **how))
    assert messages == []
    # x = cos t + t sin t / 2, so v² is (t cos t / 2 − sin t / 2)²; places do not count in a force without a potential.
    exact = 0.125 * (40.0 * np.cos(40.0) - np.sin(40.0)) ** 2
    assert out.energy[-1] == pytest.approx(exact, rel=2e-3 if method == "leapfrog" else 1e-8, abs=0)


def test_what_begins_with_nothing_is_not_measured_by_it() -> None:
    push = vv.ExpressionForce(force=lambda r, _v, t: (1.0 + t, 0.0 * r[1], 0.0 * r[2]))
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]), push)
    assert heard(lambda: scene.run(t=3.0, method="rk4", dt=0.01))[1] == []


def test_a_copy_of_one_is_told_as_alone_and_the_motion_is_not_touched() -> None:
    scene = vv.Scene(MEETING, vv.Gravity(1.0), *BESIDE["a drive"])
    how: dict[str, Any] = {"t": 4.0, "method": "rk4", "dt": 4 / 256}
    alone, messages = heard(lambda: scene.run(**how))
    copy, told = heard(lambda: scene.ensemble(velocity=MEETING.velocity[None]).run(**how))
    assert len(messages) == len(told) == 1
    np.testing.assert_array_equal(copy.position[0], alone.position)
    assert copy.stats.steps == alone.stats.steps == 256
