"""Times far from zero are numbers that lie apart: what changes fast from one to the next is told, and nothing else."""

import warnings
from typing import Any

import numpy as np
import pytest

import visviva as vv

BODY = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
BY_HAND = vv.ExpressionForce(force=lambda r, _v, t: (np.cos(50.0 * t), 0.0 * r[0], 0.0 * r[0]))


def heard(run: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run()
    return [str(warning.message) for warning in caught]


@pytest.mark.parametrize("copies", [0, 3])
@pytest.mark.parametrize(("t0", "told"), [(0.0, False), (1e4, False), (1.7e9, True), (-1.7e9, True)])
def test_a_drive_of_the_time_since_1970(t0: float, told: bool, copies: int) -> None:
    """Fifty radians in a second, 2.4e-7 s from number to number: 1.2e-5 of the force, as much of its rounded phase."""
    scene = vv.Scene(BODY, BY_HAND, t0=t0)
    several = scene.ensemble(position=np.zeros((copies, 1, 3))) if copies else scene
    messages = heard(lambda: several.run(t=t0 + 1.0, method="kahan_li8", dt=0.01))
    assert len(messages) == told
    for message in messages:
        change = float(message.split("forces[0] changes by ")[1].split()[0])
        # 1.2e-5 and the rounding of 50 t, up to 1.5e-5; the largest of seventeen is seen, over the largest force there.
        assert 0.5e-5 < change < 5e-5


@pytest.mark.parametrize(("frequency", "t0"), [(0.7, 1e9), (0.7, 1.7e9), (0.7, 1e12), (0.3, 1e9), (0.3, 1e12)])
def test_a_slow_drive_whose_phase_rounds_to_the_same_number(frequency: float, t0: float) -> None:
    """At round times ω t is the same number beside each: the next but one tells."""
    drive = vv.ExpressionForce(force=lambda r, v, t: (np.cos(frequency * t) - r[0], 0.0 * r[0], 0.0 * r[0]))
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), drive, t0=t0)
    assert len(heard(lambda: scene.run(t=t0 + 1.0, method="dop853", rtol=1e-12))) == 1


def test_what_counts_from_the_start_is_as_exact_there() -> None:
    """`DrivenForce` is told nothing of, and rightly: it goes as it would from zero with a phase that is exact."""
    scene = vv.Scene(BODY, vv.DrivenForce([1.0, 0.0, 0.0], frequency=50.0), t0=1.7e9)
    messages = heard(lambda: scene.run(t=1.7e9 + 1.0, method="kahan_li8", dt=0.01))
    still = vv.Scene(BODY, vv.ExpressionForce(potential=lambda r, _v, _t: 0.5 * r[0] ** 2), t0=1.7e9)
    assert messages + heard(lambda: still.run(t=1.7e9 + 1.0, method="kahan_li8", dt=0.01)) == []
