"""Collisions are asked for, and no body has a radius: nothing would ever happen, which is said."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from pathlib import Path

RULES = ["merge", "bounce", "stop"]
PLACES, SPEEDS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]]


def scene(radius: Any = 0.0) -> vv.Scene:
    return vv.Scene(vv.Particles([1.0, 1.0], PLACES, SPEEDS, radius=radius), vv.Gravity(0.0))


@pytest.mark.parametrize("rule", RULES)
def test_who_has_forgotten_the_radii_is_told(rule: Any) -> None:
    """Bodies went through each other with status OK, an empty table and no word."""
    points = scene()
    copies = points.ensemble(mass=np.ones((3, 2)))
    for call in (
        points.run,
        points.plan,
        copies.run,
        copies.plan,
        copies[1:].run,
        pickle.loads(pickle.dumps(copies)).run,
    ):
        with pytest.raises(vv.InvalidInput, match=r"^collisions: expected bodies with a radius, and none has one"):
            call(t=1.0, collisions=rule)
    assert len(scene([0.1, 0.0]).run(t=2.0, collisions=rule).collisions) == 1


@pytest.mark.parametrize("rule", RULES)
def test_copies_of_points_among_copies_of_spheres(rule: Any, tmp_path: Path) -> None:
    """A radius of zero that is given is meant: it may be the end of a series of radii, or a part of an ensemble."""
    copies = scene().ensemble(radius=[[0.0, 0.0]] * 9 + [[0.1, 0.1]])
    out = copies.run(t=2.0, collisions=rule)
    assert out.collisions.member.tolist() == [9]
    assert len(copies[:9].run(t=2.0, collisions=rule).collisions) == 0
    pytest.importorskip("pyarrow")
    status = copies.run_to_parquet(t=2.0, collisions=rule, to=tmp_path / "a", copies_at_once=8)
    assert (status == out.status).all()


def test_what_is_left_of_a_merger_goes_on() -> None:
    left = scene(0.1).run(t=1.0, collisions="merge").final
    assert left.run(t=2.0, collisions="merge").status is vv.Status.OK
