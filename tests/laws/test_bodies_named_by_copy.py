"""Ensembles whose copies name other bodies: each runs as the scene with that force does alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

BODIES = vv.Particles(
    [1.0, 0.5, 0.25],
    [[0, 0, 0], [2.0, 0, 0], [0, 3.0, 0]],
    [[0, 0, 0], [0, 0.7, 0], [-0.5, 0, 0.1]],
    names=["a", "b", "c"],
)
AXIS = [0.0, 0.6, 0.8]
CASES: dict[str, tuple[vv.forces.Force, str, Any]] = {
    "oblate": (vv.Oblate(0, G=1.0, J2=0.1, radius=0.3, axis=AXIS), "body", np.array([0, 1, 2])),
    "oblate by name": (vv.Oblate("a", G=1.0, J2=0.1, radius=0.3, axis=AXIS), "body", ["a", "c", "b"]),
    "several oblate": (vv.Oblate([0, 1], G=1.0, J2=0.1, radius=0.3, axis=AXIS), "body", [[0, 1], [2, 0], ["b", "c"]]),
    "relativistic": (vv.PostNewtonian(0, G=1.0, c=20.0), "body", [2, 1, 0]),
    "springs": (vv.Spring([0], [2], k=1.0), "i", np.array([[0], [1], [1]])),
    "a damper": (vv.Damper(0, 2, c=1.0), "j", ["c", 1, "b"]),
    "thrust": (vv.ExpressionForce(acceleration=lambda r, v, t: 0.1 * v, bodies=[0]), "bodies", [[0], [1, 2], ["b"]]),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_name_bodies_of_their_own(name: str, threads: int) -> None:
    force, parameter, values = CASES[name]
    scene = vv.Scene(BODIES, vv.Gravity(1.0), force)
    out = scene.ensemble(parameters={1: {parameter: values}}).run([1.0, 3.0], method="dop853", threads=threads)
    ends = set()
    for copy in range(3):
        own = type(force)(**{**force._values(), parameter: values[copy]})
        alone = vv.Scene(BODIES, vv.Gravity(1.0), own).run([1.0, 3.0], method="dop853")
        np.testing.assert_array_equal(out.position[copy], alone.position)
        np.testing.assert_array_equal(out[copy].energy, alone.energy)
        ends.add(alone.position.tobytes())
    assert len(ends) > 1, "others, as other bodies act"


def test_bodies_that_are_none_are_refused_by_the_copy() -> None:
    scene = vv.Scene(BODIES, vv.Gravity(1.0), CASES["oblate"][0])
    for values, words in (
        ([0, 7], "body: expected a body from 0 to 2, got 7"),
        (["a", "z"], "Oblate of copy 1: body: .*'z'"),
        ([0.5, 1], "Oblate of copy 0: body: expected a whole number, got 0.5"),
        (0, "values of 'body' with a leading axis over the copies, got 0"),
        ([], "with a leading axis over the copies"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            scene.ensemble(parameters={"Oblate": {"body": values}}).run(1.0)
    with pytest.raises(
        vv.InvalidInput, match=r"expected parameters of Oblate \(body, G, J2, radius, axis, J4\), got 'k'"
    ):
        scene.ensemble(parameters={"Oblate": {"k": [1.0, 2.0]}})
