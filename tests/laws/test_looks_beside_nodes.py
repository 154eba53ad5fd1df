"""Walls at every place of an equal step, for methods that look at its nodes and for those that drift through them.

A wall of ten times the energy turns a body back. Equal steps that do not resolve it say so, wherever in a step it lies:
between two looks of one step, or between the last look of a step and the first one of the next.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

DT = 0.04
#: Of height 5 for an energy of 1/2, by the distance from their middle in widths: the potential and its slope.
WALLS: dict[str, tuple[Callable[[Any], Any], Callable[[Any], Any]]] = {
    "gauss": (lambda u: 5 * np.exp(-(u**2)), lambda u: -10 * u * np.exp(-(u**2))),
    "sech": (lambda u: 5 / np.cosh(u) ** 2, lambda u: -10 * np.tanh(u) * (1 - np.tanh(u) ** 2)),
    "step": (lambda u: 2.5 * (1 + np.tanh(u)), lambda u: 2.5 * (1 - np.tanh(u) ** 2)),
    "eighth power": (lambda u: 5 / (1 + u**8), lambda u: -40 * u**7 / (1 + u**8) ** 2),
}
#: The first drift through nodes, the others look there.
METHODS = (
    "leapfrog_dkd",
    "pefrl4",
    "blanes_moan_s6",
    "blanes_moan_rkn6_14",
    "boris",
    "boris4",
    "leapfrog",
    "rk4",
    "mclachlan4",
    "kahan_li8",
)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("width", [1e-3, 1e-5])
def test_a_wall_turns_a_body_back_or_is_told_wherever_it_is_in_a_step(width: float, name: str, method: str) -> None:
    for part in (0.0, 0.02, 0.1, 0.25, 1 / 3, 0.5, 0.77):
        body = vv.Particles([1.0], [[-1.0 - part * DT, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
        wall = vv.ExpressionForce(potential=lambda r, v, t: WALLS[name][0](r[0] / width))
        with pytest.raises((vv.ConvergenceError, vv.AccuracyWarning), match=r"narrower than the step|does not resolve"):
            vv.Scene(body, wall).run(2.0, method=method, dt=DT)


# blanes_moan_rkn6_14 looks 1.5 widths before and after one of these places: a flank, seen coarsely, turns the body.
@pytest.mark.parametrize("method", [method for method in METHODS if method != "blanes_moan_rkn6_14"])
@pytest.mark.parametrize("name", WALLS)
def test_so_is_one_without_a_potential_which_has_no_energy_to_tell(name: str, method: str) -> None:
    width = 1e-3
    for part in (0.0, 0.02, 0.1, 0.25, 1 / 3, 0.5, 0.77):
        body = vv.Particles([1.0], [[-1.0 - part * DT, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
        wall = vv.ExpressionForce(force=lambda r, v, t: (-WALLS[name][1](r[0] / width) / width, 0.0 * r[0], 0.0 * r[0]))
        # Steps of 40 widths see no part of a wall well.
        with pytest.raises(vv.ConvergenceError, match="narrower than the step"):
            vv.Scene(body, wall).run(2.0, method=method, dt=DT)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", WALLS)
def test_steps_that_see_a_wall_well_turn_back(name: str, method: str) -> None:
    # A step is a fiftieth of its width.
    width = 2.0
    body = vv.Particles([1.0], [[-12.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    wall = vv.ExpressionForce(potential=lambda r, v, t: WALLS[name][0](r[0] / width))
    out = vv.Scene(body, wall).run(30.0, method=method, dt=DT)
    # Of the second order, with 50 steps in a width: a thousandth.
    assert out.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=1e-3)


@pytest.mark.parametrize("method", ["leapfrog_dkd", "pefrl4", "boris"])
def test_the_last_step_ends_where_nobody_looks_and_so_does_a_part_of_one(method: str) -> None:
    wall = vv.ExpressionForce(potential=lambda r, v, t: WALLS["step"][0]((r[0] + 1e-3) / 1e-5))
    scene = vv.Scene(vv.Particles([1.0], [[-1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), wall)
    for end in (1.0, 1.001):
        with pytest.raises(vv.ConvergenceError, match="narrower than the step"):
            scene.run(end, method=method, dt=DT)
    # Before the wall nothing is told.
    assert scene.run(0.96, method=method, dt=DT).status == vv.Status.OK
    # A part of a step that begins at a node begins where nobody looked either.
    behind = vv.ExpressionForce(force=lambda r, v, t: (-2.5e5 * (1 - np.tanh((r[0] - 2e-3) / 1e-5) ** 2), 0 * t, 0 * t))
    for end in (1.02, 1.03):
        with pytest.raises(vv.ConvergenceError, match="narrower than the step"):
            vv.Scene(scene.particles, behind).run(end, method=method, dt=DT)


@pytest.mark.parametrize("method", ["leapfrog_dkd", "pefrl4", "leapfrog"])
def test_copies_end_where_each_ends_alone(method: str) -> None:
    wall = vv.ExpressionForce(
        potential=lambda r, v, t, w: 5 * np.exp(-((r[0] / w) ** 2)), parameters={"w": 1.0}, bodies=[0]
    )
    places = np.zeros((11, 2, 3))
    places[:, 0, 0] = -12.0 - DT * np.linspace(0.0, 1.0, 11)
    places[:, 1, 1] = 1.0
    scene = vv.Scene(vv.Particles([1.0, 1.0], places[0], [[1.0, 0, 0], [0.0, 0, 0]]), wall)
    widths = np.where(np.arange(11) % 4 == 1, 1e-3, 2.0)
    many = scene.ensemble(position=places, parameters={wall: {"w": widths}})
    out = many.run(30.0, method=method, dt=DT, threads=2)
    assert ((out.status == vv.Status.STEP_FAILURE) == (widths < 1.0)).all()
    for copy in np.flatnonzero(widths > 1.0):
        alone = many[int(copy)].run(30.0, method=method, dt=DT)
        assert np.array_equal(out.position[copy], alone.position)


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "leapfrog_dkd", "yoshida4"])
def test_a_running_wave_that_goes_by_in_a_step_is_told(method: str) -> None:
    # Its phase turns by 150 in a step, which equal steps take for whatever they happen to see.
    wave = vv.ExpressionForce(force=lambda r, v, t: (np.cos(1000.0 * (r[0] - 3.0 * t)), 0.0 * t, 0.0 * t))
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    with pytest.raises(vv.ConvergenceError, match="narrower than the step"):
        vv.Scene(body, wave).run(10.0, method=method, dt=0.05)
    # With 40 steps in a turn it is followed: the body quivers by 1/2000² beside where it goes freely.
    out = vv.Scene(body, wave).run(1.0, method=method, dt=2 * np.pi / 2000.0 / 40.0)
    assert out.position[-1, 0, 0] == pytest.approx(1.0, rel=0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("method", "turns"), [("rk4", 1), ("midpoint", 1), ("boris4", 1), ("mclachlan4", 1), ("kahan_li8", 3)]
)
def test_a_drive_of_as_many_turns_as_steps_is_told(method: str, turns: int) -> None:
    # Every step sees it in the same phases.
    dt = 0.1
    drive = vv.ExpressionForce(force=lambda r, v, t: (5.0 * np.cos(2.0 * np.pi * turns / dt * t), 0.0 * t, 0.0 * t))
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), drive)
    with pytest.raises((vv.ConvergenceError, vv.AccuracyWarning), match=r"narrower than the step|does not resolve"):
        scene.run(10.0, method=method, dt=dt)
    # With 20 steps in a turn it is not, and gives what it gives in a turn, nothing.
    out = scene.run(1.0, method=method, dt=dt / turns / 20.0)
    assert out.velocity[-1, 0, 0] == pytest.approx(1.0, rel=0.0, abs=1e-2)
