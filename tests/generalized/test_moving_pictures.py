"""Moving pictures of systems: points are where the masses are, which their energy tells.

Bounds: sines, cosines and lengths of some products, 1e-14 of them.
"""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

G = 9.81
# Of each system, the masses of the points that are drawn, and which direction is up.
MASSES: dict[str, tuple[list[float], int]] = {
    "pendulum": ([0.0, 1.0], 1),
    "double_pendulum": ([0.0, 1.0, 1.0], 1),
    "chain": ([0.0] + [1.0] * 10, 1),
    "spring_pendulum": ([0.0, 1.0], 1),
    "spherical_pendulum": ([0.0, 1.0], 2),
    "cart_pendulum": ([2.0, 1.0], 1),
    "atwood": ([2.0, 0.0, 0.0, 1.0], 1),
    "swinging_atwood": ([3.0, 0.0, 0.0, 1.0], 1),
}


def positions(out: Any, **how: Any) -> Any:
    """What is drawn: the marks of all frames, shape (T, P, d)."""
    moving = out.animate(frames=100_000, **how)
    axes = moving._fig.axes[0]
    frames = []
    for frame in moving.new_frame_seq():
        moving._draw_frame(frame)
        marks = [line for line in axes.lines if line.get_marker() == "o"]
        frames.append([[float(x[0]) for x in getattr(m, "get_data_3d", m.get_data)()] for m in marks])
    return np.array(frames)


@pytest.mark.parametrize("name", MASSES)
def test_masses_at_the_points_have_the_energy_of_the_system(name: str) -> None:
    masses, up = MASSES[name]
    step = 1e-3
    out = getattr(vv.systems, name)().run(t=np.arange(9) * step)
    drawn = positions(out)
    # Differences of eighth order about the middle, of times 1 ms apart: exact to round-off over the step.
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0.0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / step
    velocity = np.einsum("t,tpd->pd", weights, drawn)
    kinetic = 0.5 * float(np.sum(np.array(masses) * (velocity**2).sum(axis=1)))
    by_momenta = 0.5 * float((out.momentum[4] * out.velocity[4]).sum())
    assert abs(kinetic - by_momenta) < 1e-10 * max(1.0, by_momenta)
    # What gravity (and a spring) gave since the start; systems are at rest there, or conserve what they have.
    height = G * (np.array(masses) * drawn[..., up]).sum(axis=1)
    if name == "spring_pendulum":
        height = height + 20.0 * (np.hypot(*(drawn[:, 1] - drawn[:, 0]).T) - 1.0) ** 2
    started = 0.5 * float((out.momentum[0] * out.velocity[0]).sum())
    assert abs((kinetic - started) + (height[4] - height[0])) < 1e-10 * max(1.0, by_momenta)


def test_guides_turn_and_shake_as_they_are_told() -> None:
    t = np.linspace(0.0, 1.0, 11)
    rod = positions(vv.systems.rod(Omega=2.0).run(t))[:, 1]
    np.testing.assert_allclose(
        np.arctan2(rod[:, 1], rod[:, 0]), (2.0 * t + np.pi) % (2 * np.pi) - np.pi, rtol=0, atol=1e-14
    )
    np.testing.assert_allclose(np.hypot(*rod.T), np.cosh(2.0 * t), rtol=1e-14)
    hoop = positions(vv.systems.hoop(Omega=2.0, R=3.0).run(t))[:, 1]
    np.testing.assert_allclose(np.linalg.norm(hoop, axis=1), 3.0, rtol=1e-14)
    shaken = vv.systems.kapitza().run(t)
    pivot, bob = positions(shaken).transpose(1, 0, 2)
    values = shaken.system.parameters
    assert (pivot[:, 1] == values["a"] * np.cos(values["Omega"] * t)).all()
    np.testing.assert_allclose(np.linalg.norm(bob - pivot, axis=1), values["l"], rtol=1e-14)


@pytest.mark.parametrize("name", vv.systems.__all__)
def test_every_system_moves(name: str, tmp_path: Path) -> None:
    system = getattr(vv.systems, name)()
    system.run(t=[0.0, 0.1, 0.2]).animate(tmp_path / "moving.gif", frames=2)
    assert (tmp_path / "moving.gif").read_bytes()[:4] == b"GIF8"
    # Of other parameters, from a pickle, of a copy and run on, it knows its points still.
    copies = system.ensemble(position=np.array([system.position])).run(t=[0.0, 0.1])
    for other in (pickle.loads(pickle.dumps(system)), system.run(t=0.1).final):
        assert len(list(other.run(t=[0.1, 0.2]).animate().new_frame_seq())) >= 1
    copies[0].animate()


def test_points_of_ones_own_are_drawn_and_joined() -> None:
    out = vv.systems.oscillator().run(t=np.linspace(0.0, 1.0, 5))
    drawn = positions(out, points=lambda q, t, **_: [(0.0, 0.0, 0.0), (q[0], t, 2.0)])
    assert (drawn[:, 1] == np.stack([out["x"], out.t, np.full(5, 2.0)], axis=1)).all()
    moving: Any = out.animate(points=lambda q, t, **_: [(0.0, 0.0), (q[0], t)], plane="xy")
    moving._draw_frame(4)
    rod = next(line for line in moving._fig.axes[0].lines if len(line.get_xdata()) == 2)
    assert (np.array(rod.get_data())[:, 1] == [out["x"][4], 1.0]).all()


@pytest.mark.parametrize(
    "wrong",
    [
        {"points": [(0, 0)]},
        {"points": lambda q: q},
        {"points": lambda _q, _t, **_: 1.0},
        {"points": lambda _q, _t, **_: []},
        {"points": lambda q, _t, **_: [(q[0],)]},
        {"points": lambda q, _t, **_: [(q[0], 0.0), (q[0], 0.0, 0.0)]},
        {"points": lambda q, _t, **_: [(q[0], "up")]},
        {"points": lambda q, _t, **_: [(q[0], [1.0, 2.0])]},
        {"points": lambda q, _t, **_: [(q[0] * np.nan, 0.0)]},
        {"plane": "yx"},
        {"trail": 2.0},
        {"frames": 0},
    ],
)
def test_what_is_no_picture_is_refused_by_name(wrong: dict[str, Any]) -> None:
    out = vv.systems.pendulum().run(t=[0.0, 0.1, 0.2])
    with pytest.raises(vv.InvalidInput, match=f"^{next(iter(wrong))}: "):
        out.animate(**wrong)


def test_a_system_that_does_not_know_its_points_says_what_to_give() -> None:
    own = vv.Lagrangian(lambda _q, v, _t: v[0] ** 2 / 2, ["x"], position=[1.0])
    with pytest.raises(vv.InvalidInput, match=r"^points: the points of .*\['x'\].*points=lambda q, t"):
        own.run(t=1.0).animate()
