"""Moving pictures of rigid bodies: the box has the body's moments, and turns as the body does."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva._boxes import _OUTLINE, boxes, half_edges


@pytest.mark.parametrize("edges", [(1.0, 2.0, 3.0), (0.5, 0.5, 4.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0)])
def test_the_box_is_the_one_that_has_the_moments(edges: tuple[float, float, float]) -> None:
    a, b, c = edges
    mass = 2.5
    moments = mass / 12.0 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    # A difference of squares that cancels leaves the root of what is rounded.
    np.testing.assert_allclose(2.0 * half_edges(moments, mass), edges, rtol=0, atol=1e-7)


def test_the_outline_goes_along_every_edge_and_no_diagonal() -> None:
    steps = {frozenset((tuple(p), tuple(q))) for p, q in pairwise(_OUTLINE)}
    assert len(steps) == 12
    assert all(np.abs(np.subtract(*edge)).sum() == 2.0 for edge in map(tuple, steps))


@pytest.mark.parametrize("tilted", [False, True])
def test_boxes_keep_their_shape_and_turn_with_the_body(tilted: bool) -> None:
    moments, spin = [1.0, 2.0, 2.5], [0.1, 1.0, 0.2]
    if tilted:  # the same body, its axes not the principal ones
        turn = vv.rigid.matrix(np.array([0.5, 0.5, 0.1, 0.7]) / np.linalg.norm([0.5, 0.5, 0.1, 0.7]))
        body = vv.RigidBody(1.0, inertia=turn @ np.diag(moments) @ turn.T, angular_velocity=turn @ spin)
    else:
        body = vv.RigidBody(1.0, moments, angular_velocity=spin)
    out = vv.Scene(vv.Particles([1.0], [[9.0, 0, 0]]), body).run(t=np.linspace(0.0, 10.0, 21))
    outline: Any = boxes(out, [0, 1])
    corners = outline[:, :16] - out.position[:, 1:2]
    np.testing.assert_allclose(
        np.linalg.norm(corners, axis=-1), np.sqrt((half_edges(moments, 1.0) ** 2).sum()), rtol=1e-14
    )
    # Corners go round the angular velocity: their rate of change along a finite difference of second order.
    fine: Any = vv.Scene(body).run(t=[0.0, 0.999, 1.0, 1.001])
    corner = boxes(fine, [0])
    assert corner is not None
    rate = (corner[3, :16] - corner[1, :16]) / 0.002
    omega = vv.rigid.rotate(fine.orientation[2, 0], fine.angular_velocity[2, 0])
    # h²/6 = 1.7e-7 times the third derivative, which is about ω³ of the corner's distance; measured 4.4e-7.
    np.testing.assert_allclose(rate, np.cross(omega, corner[2, :16]), rtol=0.0, atol=2e-6)
    assert boxes(out, [0]) is None
    assert boxes(vv.Scene(body).run(t=1.0, record=("position",)), [0]) is None


def test_of_a_held_body_a_line_goes_to_where_it_is_held() -> None:
    top = vv.RigidBody(1.0, [1.0, 1.0, 0.5], position=[0, 0.6, 0.8], orientation=[-np.sin(np.arccos(0.8) / 2), 0, 0,
        np.cos(np.arccos(0.8) / 2)], angular_velocity=[0, 0, 20.0], pivot=[0, 0, -1])  # fmt: skip
    scene = vv.Scene(top, vv.UniformField([0, 0, -9.81]))
    out = scene.run(t=np.linspace(0.0, 1.0, 11))
    held: Any = boxes(out, [0])
    np.testing.assert_allclose(held[:, 18], 0.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(held[:, 17], out.position[:, 0], rtol=0, atol=1e-14)


def test_pictures_are_made_and_files_written(tmp_path: Path) -> None:
    out = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.2])).run(t=np.linspace(0, 5, 6))
    free = vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], np.linspace(0.0, 5.0, 6))
    for at, result in enumerate((out, free, out.body(0).turning)):
        moving: Any = result.animate(tmp_path / f"{at}.gif")  # type: ignore[attr-defined]
        assert moving._fig.axes[0].name == "3d"
        assert (tmp_path / f"{at}.gif").read_bytes()[:4] == b"GIF8"
        flat: Any = result.animate(plane="xz")  # type: ignore[attr-defined]
        assert flat._fig.axes[0].get_ylabel() == "z"
    # Times in any order are shown in their order.
    back = vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], np.linspace(5.0, 0.0, 6)).animate()
    assert list(back.new_frame_seq()) == list(range(6))
    with pytest.raises(vv.InvalidInput, match=r"^animate: expected a path"):
        vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], 1.0).animate()
    with pytest.raises(vv.InvalidInput, match=r"^plane: "):
        free.animate(plane="zx")  # type: ignore[arg-type]
