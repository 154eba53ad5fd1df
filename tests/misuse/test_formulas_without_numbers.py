"""Formulas that have no number where a body is: said as that, whatever chooses the steps."""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def scene(x: float, vx: float = 0.0) -> vv.Scene:
    """A root of what is negative beyond x = 0.5."""

    def force(r: Any, v: Any, t: Any) -> list[Any]:
        return [np.sqrt(0.5 - r[0]), 0.0 * r[1], 0.0 * r[2]]

    other = vv.Particles([1.0, 1.0], [[-3.0, 0.0, 0.0], [x, 0.0, 0.0]], [[0.0, 0.0, 0.0], [vx, 1.0, 0.0]])
    return vv.Scene(other, vv.ExpressionForce(force=force, bodies=[1]))


@pytest.mark.parametrize("method", ["auto", "taylor", "dop853", "verner98", "bogacki_shampine32"])
def test_at_the_start(method: str) -> None:
    with pytest.raises(vv.ConvergenceError, match=r"a formula has no number for the force on body 1 where it is"):
        scene(1.0).run(t=1.0, method=method)


def test_a_member_that_has_none_spoils_no_other() -> None:
    copies = scene(0.0).ensemble(position=[[[-3.0, 0, 0], [1.0, 0, 0]], [[-3.0, 0, 0], [-20.0, 0, 0]]])
    out = copies.run(t=1.0)
    assert list(out.status) == [vv.Status.STEP_FAILURE, vv.Status.OK]
    assert np.array_equal(out.position[1], copies[1].run(t=1.0).position)


def test_close_bodies_are_still_told_as_that() -> None:
    """Two that fall on each other beside a formula that has numbers everywhere."""
    pair = vv.Particles([1.0, 1.0], [[-1.0, 0, 0], [1.0, 0, 0]], [[0.0, 0, 0], [0.0, 0, 0]])
    with pytest.raises(vv.CloseEncounter):
        vv.Scene(pair, vv.Gravity(1.0), vv.ExpressionForce(potential=lambda r, v, t: 1e-9 * r[0] ** 2)).run(t=5.0)
