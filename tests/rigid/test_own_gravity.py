"""Copies of rigid bodies with constants of gravity of their own: the torques and the tides of each are its own, too."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

COLUMNS: Any = ("position", "velocity", "orientation", "angular_velocity", "energy")


def bodies() -> vv.RigidBodies:
    return vv.RigidBodies(
        [3.0, 1.0],
        moments=[[1.0, 2.0, 2.5], [0.4, 0.4, 0.4]],
        position=[[0.0, 0.0, 0.0], [4.0, 0.5, 0.2]],
        velocity=[[0.0, 0.0, 0.0], [0.0, 0.8, 0.1]],
        angular_velocity=[[0.1, 1.0, 0.2], [0.0, 0.0, 0.0]],
    )


@pytest.mark.parametrize("constants", [[1.0, 0.5], [0.5, 1.0], [0.7] * 9 + [1.0] * 9, [0.5, 0.25, 1.0]])
@pytest.mark.parametrize("how", [{}, {"method": "kahan_li8", "dt": 0.05}, {"method": "rk4", "dt": 0.05}])
def test_each_copy_moves_as_it_does_alone(constants: list[float], how: dict[str, Any]) -> None:
    gravity = vv.Gravity(G=1.0)
    many = vv.Scene(bodies(), gravity).ensemble(parameters={gravity: {"G": constants}})
    for threads in (1, 3):
        out = many.run([0.0, 5.0], record=COLUMNS, threads=threads, **how)
        for member, constant in enumerate(constants):
            alone = vv.Scene(bodies(), vv.Gravity(G=constant)).run([0.0, 5.0], record=COLUMNS, **how)
            for column in COLUMNS:
                np.testing.assert_array_equal(getattr(out, column)[member], getattr(alone, column), err_msg=column)


@pytest.mark.parametrize("constants", [[0.5, 0.0], [0.0, 0.5], [0.0, 0.25, 0.0, 0.5]])
@pytest.mark.parametrize("how", [{}, {"method": "kahan_li8", "dt": 0.05}])
def test_where_nothing_pulls_a_body_turns_freely(constants: list[float], how: dict[str, Any]) -> None:
    gravity = vv.Gravity(G=1.0)
    many = vv.Scene(bodies(), gravity).ensemble(parameters={gravity: {"G": constants}})
    out = many.run([0.0, 5.0], record=COLUMNS, **how)
    for member, constant in enumerate(constants):
        alone = vv.Scene(bodies(), vv.Gravity(G=constant)).run([0.0, 5.0], record=COLUMNS, **how)
        for column in COLUMNS:
            np.testing.assert_array_equal(getattr(out, column)[member], getattr(alone, column), err_msg=column)
        assert out[member].final == alone.final
