"""Functions of one's own among the events, of which nothing is known but their values.

Bounds: zeros of a harmonic motion to some roundings of their times.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from event_scenes import kepler

import visviva as vv


@pytest.mark.parametrize("method", ["dop853", "verner98"])
def test_functions_are_sampled_where_a_free_body_takes_few_steps(method: str) -> None:
    """sin of the time, 14 zeros in a run of a handful of steps: half were between the places that were looked at."""
    free = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), vv.LinearDrag(1e9))
    wave = [lambda t, position, velocity: float(np.sin(t))]
    out = free.run(45.0, method=method, events=wave)
    assert out.stats.steps < 45
    np.testing.assert_allclose(out.events.t, np.pi * np.arange(1, 15), rtol=1e-14)


@pytest.mark.parametrize("how", [{"method": "dop853"}, {"method": "leapfrog", "dt": 0.01}])
def test_a_function_that_is_never_a_number_is_told(how: dict[str, Any]) -> None:
    scene = kepler()
    lost = [lambda t, x, v: float(x[1, 0]), lambda t, x, v: float("nan")]
    with pytest.warns(vv.AccuracyWarning, match=r"events\[1\] gave NaN whenever it was asked"):
        scene.run(1.0, events=lost, **how)
    # One that is a number somewhere may have zeros there.
    with warnings.catch_warnings():
        warnings.simplefilter("error", vv.AccuracyWarning)
        scene.run(1.0, events=[lambda t, x, v: float("nan") if t < 0.5 else 1.0], **how)
