"""Walls (a/x)ⁿ, which nothing passes and no stage of a long step feels: steps through them are taken again.

Bounds: a few roundings of an energy of size 1; copies and one alone part by the rounding of a lane, which a wall
amplifies by its steepness, to 6e-15.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)


def floor(a: float, power: int) -> vv.Lagrangian:
    """A body that falls on a floor at x = 0."""
    return vv.Lagrangian(vx**2 / 2 - 9.81 * x - (sp.Float(a) / x) ** power, [x], position=[1.0])


@pytest.mark.parametrize("method", ["auto", "gauss8", "taylor", "dop853", "verner98"])
@pytest.mark.parametrize(("a", "power"), [(0.01, 12), (0.005, 12), (0.01, 6), (1e-4, 2)])
def test_a_ball_comes_back_from_a_hard_floor(a: float, power: int, method: str) -> None:
    """It fell through to x = −25 with an energy that was kept to 1e-10; steps of 1e-4 see the floor."""
    right = floor(a, power).run(3.0, method="dop853", rtol=1e-13, max_step=1e-4).position[-1, 0]
    assert right > 0.0
    out = floor(a, power).run(3.0, method=method)
    # Each of three or so bounces multiplies errors; rtol is 1e-12.
    assert out.position[-1, 0] == pytest.approx(right, abs=1e-5)


def test_two_balls_in_a_trap_do_not_change_places() -> None:
    """Against dop853 in steps of 1e-4; they had passed through each other, the energy kept to 7e-8."""
    wall = (sp.Float(0.015) / (y - x)) ** 12
    balls = vv.Lagrangian((vx**2 + vy**2) / 2 - (x**2 + y**2) / 2 - wall, [x, y], position=[-1.0, 0.8])
    right = balls.run(20.0, method="dop853", rtol=1e-13, max_step=1e-4).position[-1]
    np.testing.assert_allclose(balls.run(20.0).position[-1], right, rtol=0, atol=1e-4)


def test_copies_have_the_bits_they_have_alone() -> None:
    places = [[1.0], [0.7], [1.3], [0.4], [1.1], [0.9], [2.0], [1.7], [0.5]]
    for method in ("gauss16", "taylor"):
        many = floor(0.01, 12).ensemble(position=places).run([1.0, 3.0], method=method)
        assert (many.position > 0.0).all()
        for index, place in enumerate(places):
            alone = vv.Lagrangian(vx**2 / 2 - 9.81 * x - (sp.Float(0.01) / x) ** 12, [x], position=place).run(
                [1.0, 3.0], method=method
            )
            np.testing.assert_array_equal(many.position[index], alone.position)


def test_equal_steps_through_a_pole_end_the_run_by_name() -> None:
    with pytest.raises(vv.ConvergenceError, match=r"went through a pole.*shorter dt"):
        floor(0.001, 12).run(3.0, method="gauss16", dt=0.05)


def test_what_stays_finite_where_it_divides_by_zero_is_no_pole() -> None:
    """L = v²/2 + sin x/x, whose divisor changes its sign in every swing."""
    swing = vv.Lagrangian(vx**2 / 2 + sp.sin(x) / x, [x], position=[1.0])
    out = swing.run(50.0)
    assert out.status is vv.Status.OK
    assert np.ptp(out.energy) < 1e-14


def test_outputs_events_and_momenta_lead_to_the_same_end() -> None:
    """To the bit, but for momenta, whose steps are of other numbers: rtol is 1e-12."""
    plain = floor(0.01, 12).run(3.0)
    read = floor(0.01, 12).run(np.linspace(0.0, 3.0, 301))
    assert (read.position > 0.0).all()
    assert read.position[-1] == plain.position[-1]
    watched = floor(0.01, 12).run(3.0, events=[vv.events.coordinate("x", 0.5)])
    assert watched.position[-1] == plain.position[-1]
    assert len(watched.events) == 6  # twice for each of three bounces
    assert floor(0.01, 12).hamiltonian().run(3.0).position[-1, 0] == pytest.approx(plain.position[-1, 0], abs=1e-9)


def test_walls_that_move_and_beads_on_wires() -> None:
    """The wall swings; the bead on x = y falls half as fast. Steps of 1e-4 see both walls."""
    moving = (sp.Float(0.01) / (x - sp.sin(vv.time) / 10)) ** 12
    swung = vv.Lagrangian(vx**2 / 2 - 9.81 * x - moving, [x], position=[1.0])
    bead = vv.Lagrangian(
        (vx**2 + vy**2) / 2 - 9.81 * y - (sp.Float(0.01) / y) ** 12, [x, y], constraints=[x - y], position=[1.0, 1.0]
    )
    for system in (swung, bead):
        right = system.run(2.0, method="dop853", rtol=1e-13, max_step=1e-4).position[-1]
        np.testing.assert_allclose(system.run(2.0).position[-1], right, rtol=0, atol=1e-9)


@pytest.mark.parametrize("threads", [1, 3])
def test_walls_of_copies_are_their_own(threads: int) -> None:
    a = sp.Symbol("a")
    ball = vv.Lagrangian(vx**2 / 2 - 9.81 * x - (a / x) ** 12, [x], parameters={a: 0.01}, position=[1.0])
    walls = np.tile(np.linspace(0.005, 0.02, 9), 20)
    many = ball.ensemble(parameters={a: walls}).run([3.0], threads=threads)
    for index in (0, 3, 8, 90, 179):
        alone = floor(walls[index], 12).run([3.0])
        assert many.position[index, 0] == pytest.approx(alone.position[0], abs=1e-13)
    assert (many.position[:9] == many.position[9:18]).all()
