"""Runs that resolve nothing say so, as scenes do."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import sympy

import visviva as vv

EQUAL = {"method": "rk4", "dt": 0.01}
PASSED_OVER = r"the energy at the end is off by .* of kinetic \+ \|potential\|: something .* was passed over.* max_step"
SAYS = r"the energy at the end is off by .* of kinetic \+ \|potential\|: a step of dt"


@pytest.mark.parametrize("hamiltonian", [False, True])
def test_a_step_beyond_the_limit_of_stability(hamiltonian: bool) -> None:
    """ωh = 3: Runge-Kutta's fourth order multiplies an oscillation by 1.5 each step; leapfrog by 7 (ωh > 2)."""
    oscillator: Any = vv.systems.oscillator(k=100.0, m=1.0, position=[1.0])
    oscillator = oscillator.hamiltonian() if hamiltonian else oscillator
    for method in ("rk4", "leapfrog"):
        with pytest.warns(vv.AccuracyWarning, match=SAYS):
            oscillator.run(t=30.0, method=method, dt=0.3)


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "midpoint"])
def test_a_weak_force_of_the_time_does_not_silence_it(method: str) -> None:
    """Without one the energy tells; with it 1.7e12 for 0.4 came with status OK and no word."""

    def weakly(q: Any, v: Any, t: Any) -> Any:
        return 0.5 * v[0] ** 2 - 250.0 * q[0] ** 2 + 1e-9 * q[0] * np.cos(t)

    def friction(q: Any, v: Any, t: Any) -> Any:
        return 1e-9 * v[0] ** 2

    driven = vv.Lagrangian(weakly, ["x"], position=[1.0])
    systems = [driven]
    if method != "leapfrog":
        systems.append(
            vv.Lagrangian(
                lambda q, v, t: 0.5 * v[0] ** 2 - 250.0 * q[0] ** 2, ["x"], position=[1.0], dissipation=friction
            )
        )
    says = r"the velocities are off by .* of themselves: a step of dt = 0\.1 does not resolve"
    for system in systems:
        with pytest.warns(vv.AccuracyWarning, match=says) as caught:
            system.run(t=3.0, method=method, dt=0.1)
        assert len(caught) == 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            system.run(t=3.0, method=method, dt=0.002)
    with pytest.warns(vv.AccuracyWarning, match="in copy [01], after"):
        driven.ensemble(position=[[1.0], [0.5]]).run(t=3.0, method=method, dt=0.1, threads=3)


@pytest.mark.parametrize("further", ["drive", "dissipation"])
def test_eulers_method_is_not_believed_at_rest(further: str) -> None:
    """One of its steps moves what rests from where it is, two halves of it do the same: 4.7e11 for 1 came silently."""

    def energies(q: Any, v: Any, t: Any) -> Any:
        return 0.5 * v[0] ** 2 - 242.0 * q[0] ** 2 + (1e-9 * q[0] * np.cos(t) if further == "drive" else 0.0)

    friction = {"dissipation": lambda q, v, t: 1e-9 * v[0] ** 2} if further == "dissipation" else {}
    oscillator = vv.Lagrangian(energies, ["x"], position=[1.0], **friction)
    # ωdt = 2.2; at both ends of four steps it is faster than at any other time.
    for t in (0.1, 0.2, 1.0, 3.0):
        with pytest.warns(vv.AccuracyWarning, match="the velocities are off by"):
            oscillator.run(t=t, method="euler", dt=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        oscillator.run(t=0.3, method="euler", dt=0.001)


def test_steps_are_taken_again_where_that_takes_no_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many copies with few steps it would take as long as the run."""
    system = vv.Lagrangian
    runs, run = [], system._run

    def counted(*arguments: Any, **keywords: Any) -> Any:
        runs.append(len(arguments[2]))
        return run(*arguments, **keywords)

    monkeypatch.setattr(system, "_run", counted)
    moving = vv.systems.moving_pivot(position=[0.1])
    for copies, t, looked_at in ((2048, 0.1, True), (2049, 0.1, False), (2049, 10.0, True)):
        runs.clear()
        moving.ensemble(position=np.linspace(0.0, 1.0, copies)[:, None]).run(t=t, method="rk4", dt=0.01)
        assert runs == [copies] * (1 + 4 * looked_at)


def test_a_motion_that_has_blown_up_beyond_all_energies_is_said() -> None:
    """Squares of 1e200 are beyond float64, and told nothing."""
    driven = vv.Lagrangian(lambda q, v, t: 0.5 * v[0] ** 2 - 2e4 * q[0] ** 2 + q[0] * np.cos(t), ["x"], position=[1.0])
    with pytest.warns(vv.AccuracyWarning, match="the velocities are off by"):
        out = driven.run(t=6.0, method="leapfrog", dt=0.1)
    assert abs(out["x"][-1]) > 1e155


def test_copies_are_named() -> None:
    pendulums = vv.systems.double_pendulum().ensemble(position=[[0.1, 0.1], [2.0, 2.5]])
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, " + SAYS):
        pendulums.run(t=5.0, method="rk4", dt=0.2)


@pytest.mark.parametrize("how", [{"method": "rk4", "dt": 0.01}, {"method": "gauss4", "dt": 0.05}, {}])
def test_what_resolves_it_is_not_blamed(how: dict[str, Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pendulum = vv.systems.double_pendulum(position=[2.0, 2.5])
        pendulum.run(t=5.0, **how)
        # At rest nothing is there to be compared with.
        pendulum.at(position=[0.0, 0.0], velocity=[0.0, 0.0]).run(t=5.0, **how)
        driven = vv.systems.pendulum(position=[np.pi], velocity=[0.0])
        driven.run(t=5.0, **how)


def cliff(shape: str) -> Any:
    """A ball falls on a wall of 5000 a thousandth wide, or by roots 1e-10: steps of a sixth of a second passed it."""
    x = vv.coordinate("x")
    s = x / sympy.Float("1e-10" if shape == "of roots" else ".001")
    clipped = (sympy.Abs(s + 1) - sympy.Abs(s - 1)) / 2
    rises = {
        "smooth": sympy.tanh(s),
        "of pieces": clipped * (3 - clipped**2) / 2,
        "of roots": s / sympy.sqrt(1 + s**2),
    }[shape]
    return vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - 9.81 * x - 5e3 * (1 - rises) / 2, [x], position=[1.0])


@pytest.mark.parametrize("method", ["auto", "gauss8", "dop853", "verner98", "taylor"])
def test_chosen_steps_do_not_pass_over_a_smooth_cliff(method: Any) -> None:
    """It was below the wall, with 5000 of energy that nothing gave it, and status OK."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        out = cliff("smooth").run([0.0, 5.0], method=method)
        # Of a wall of 5000 that is met five times, in steps of 1e-12 (gauss8: of an order that follows it to 1e-6).
        np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=0, atol=1e-4)
        both = cliff("smooth").ensemble(position=[[2.0], [1.0]]).run([0.0, 0.6], method=method)
        assert (both.position[:, -1] > 0.0).all()
        assert cliff("smooth").run(5.0, method=method, max_step=1e-3).position[-1, 0] > 0.0


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "tsitouras54"])
def test_nor_over_one_between_two_absolute_values(method: Any) -> None:
    """It is nothing on either side, and no function like exp."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for end in (0.6, 1.0, 2.0, 5.0):
            out = cliff("of pieces").run([0.0, end], method=method)
            # Of the wall's 5000, met four times in a unit of time, at corners that a step of 1e-12 of it is told from.
            np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=0, atol=1e-7)
        # Within half a second a ball from a height of 2 does not come down.
        both = cliff("of pieces").ensemble(position=[[2.0], [1.0]]).run([0.0, 0.6], method=method)
        assert (both.position[:, -1] > 0.0).all()
        assert cliff("of pieces").run(5.0, method=method, max_step=1e-3).position[-1, 0] > 0.0


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98"])
def test_what_chosen_steps_pass_over_is_told(method: Any) -> None:
    """A cliff of roots, far thinner than its fall is long, is seen by nobody on its way."""
    with pytest.warns(vv.AccuracyWarning, match=PASSED_OVER) as caught:
        out = cliff("of roots").run([0.0, 5.0], method=method)
    assert abs(out.energy[-1] - out.energy[0]) > 4e3
    assert caught[0].filename == __file__
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, " + PASSED_OVER):
        cliff("of roots").ensemble(position=[[2.0], [1.0]]).run([0.0, 0.6], method=method)


@pytest.mark.parametrize("how", [{}, EQUAL, {"method": "dop853"}, {"method": "dop853", "rtol": 1e-4}])
def test_a_motion_that_comes_back_to_rest_is_not_blamed(how: dict[str, Any]) -> None:
    """At both ends all energies are zero but for rounding, of which every part was off by one."""
    x = vv.coordinate("x")
    bungee = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - 2 * x**2 - 9.8 * x, [x], position=[0.0])
    quartic = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - x**4 / 4 - x, [x], position=[0.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for system, period in ((bungee, np.pi), (quartic, 4.3273635)):
            assert abs(system.run(period, **how).position[-1, 0]) < 1e-3
            assert abs(system.ensemble(position=[[0.0]] * 3).run(period, **how).position[:, -1]).max() < 1e-3


def test_steps_that_follow_a_tolerance_but_lose_more_say_so() -> None:
    """Through the point of hypot's cone a motion turns within a step: 5e-7 of a place, 2e-6 of the energy, is lost."""
    bead = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 10.0 * (np.hypot(q[0], q[1]) - 0.3) ** 2,
        ["x", "y"],
        position=[1.0, 0.0],
    )
    with pytest.warns(vv.AccuracyWarning, match=r"times rtol = 1e-12, .*sharp bends.*dop853"):
        bead.run(20.0)
    with pytest.warns(vv.AccuracyWarning, match=r"in copy 1, .* times rtol = 1e-12"):
        bead.ensemble(position=[[1.0, 1.0], [1.0, 0.0]], velocity=[[0.0, 1.0], [0.0, 0.0]]).run(20.0)
    # Far from it, and by steps that notice, it does not.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bead.ensemble(position=[[1.0, 1.0]], velocity=[[0.0, 1.0]]).run(20.0)
        bead.run(20.0, method="dop853")


@pytest.mark.parametrize("offset", [0.0, 1.0, 1e6])
def test_what_rounding_makes_of_an_energy_is_no_lack_of_steps(offset: float) -> None:
    """A motion of 1e-6 about an energy that is a sum of ones: 1e-16 of these is 1e-4 of what it moves by."""
    small = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 + np.cos(q[0]) - np.sqrt(1.0 + q[0] ** 2) + offset,
        ["x"],
        position=[1e-6],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        small.run(50.0)
        small.run(50.0, method="dop853")


@pytest.mark.parametrize("turns", [1e11, 1e12])
def test_an_angle_that_has_few_digits_left_is_no_lack_of_steps(turns: float) -> None:
    """A last digit of the angle is 1e-5 there, and 1e-6 of the energy."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vv.systems.pendulum(position=[turns], velocity=[8.0]).run(20.0)


@pytest.mark.parametrize(("method", "dt"), [("stormer13", 0.1), ("stormer13", 0.2), ("yoshida4", 2.5)])
def test_what_has_blown_up_is_told_wherever_it_ends(method: str, dt: float) -> None:
    """A pendulum that swings by a radian: its energy may come back to a tenth of what it went through."""
    swinging = vv.systems.pendulum(position=[1.0], g=4.0)
    for t in np.linspace(60.0, 96.0, 7):
        with pytest.warns(vv.AccuracyWarning, match="energy"):
            swinging.run(t=float(t), method=method, dt=dt)  # type: ignore[arg-type]


def test_a_copy_that_fails_beside_one_that_does_not() -> None:
    """The look at the steps of both was an error of shapes, and the run was lost."""
    driven = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 / 3 - q[0] ** 4 / 4 + 0.9 * q[0] * np.cos(t), ["x"], position=[0.3]
    )
    starts = [[0.3], [2.92]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        out = driven.ensemble(position=starts).run(5.0, method="euler", dt=0.1)
        alone = driven.at(position=starts[0]).run(5.0, method="euler", dt=0.1)
    assert out.status[0] == vv.Status.OK
    assert out.status[1] != vv.Status.OK
    np.testing.assert_array_equal(out[0].final.position, alone.final.position)
    assert np.isnan(out.position[1, -1]).all()
