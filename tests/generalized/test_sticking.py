"""Dry friction: a body comes to rest, and the run says so instead of crawling on."""

import numpy as np
import pytest

import visviva as vv

FRICTION = 0.1


def sliding(place: float, speed: float = 1e-3) -> vv.Lagrangian:
    return vv.Lagrangian(
        lambda q, v, t: (v @ v - q @ q) / 2,
        ["x"],
        position=[place],
        velocity=[speed],
        dissipation=lambda q, v, t: FRICTION * abs(v[0]),
    )


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_body_on_a_spring_sticks_where_friction_holds_it(rtol: float) -> None:
    """Half swings about ±0.1 lose 0.2 each: from 1.05 the fifth ends at −0.05, within reach of friction, at t = 5π."""
    with pytest.raises(vv.ConvergenceError, match="a velocity sticks at zero") as stuck:
        sliding(1.05).run(np.linspace(0.0, 30.0, 301), rtol=rtol)
    # The first speed of 1e-3 shifts the phase by 1e-3 and the amplitude by 1e-6.
    assert stuck.value.time == pytest.approx(5 * np.pi, abs=2e-3)
    out = stuck.value.trajectory
    assert isinstance(out, vv.generalized.GeneralizedTrajectory)
    # The last output is up to 0.1 before the end, where x is as flat as 1 − cos; measured 5.7e-6.
    assert out["x"][-1] == pytest.approx(-0.05, abs=2e-5)
    assert out.steps < 20_000


@pytest.mark.parametrize("method", ["dop853", "verner98", "dormand_prince54"])
def test_every_method_says_why_it_ends(method: str) -> None:
    with pytest.raises(vv.ConvergenceError, match="a velocity sticks at zero"):
        sliding(0.25).run([0.0, 30.0], method=method, rtol=1e-9)
    copies = sliding(0.25).ensemble(position=[[0.25], [0.35]]).run([0.0, 30.0], method=method, rtol=1e-9)
    assert (copies.status == vv.Status.STEP_FAILURE).all()


def test_turns_on_the_way_are_no_sticking() -> None:
    """Before it sticks, the velocity passes zero four times, each time beyond the reach of friction."""
    out = sliding(1.05).run(np.pi * np.arange(5.0))
    # The first speed of 1e-3 changes the amplitude by 1e-6 / 2; measured 3e-7.
    np.testing.assert_allclose(out["x"], [1.05, -0.85, 0.65, -0.45, 0.25], rtol=0, atol=1e-6)


def test_copies_that_stick_end_alone() -> None:
    copies = sliding(1.0).ensemble(position=[[1.05], [50.0]], velocity=[[1e-3], [1e-3]])
    out = copies.run(np.array([0.0, 30.0]))
    assert out.status.tolist() == [vv.Status.STEP_FAILURE, vv.Status.OK]
    assert out.steps[0] < 20_000
    # Next to the same one alone.
    np.testing.assert_array_equal(out.position[1], sliding(50.0).run(np.array([0.0, 30.0])).position)


def test_a_valley_of_two_slopes_is_no_friction() -> None:
    """In V = |x| it is the place that passes zero: with any small swing the motion goes on, with period 4 √(2 A)."""
    for amplitude in (1.0, 1e-6):
        valley = vv.Lagrangian(lambda q, v, t: v @ v / 2 - abs(q[0]), ["x"], position=[amplitude])
        period = 4 * (2 * amplitude) ** 0.5
        # Six kinks cost a step's tolerance each; measured 1.1e-10.
        assert valley.run(3 * period)["x"][-1] == pytest.approx(amplitude, rel=1e-9, abs=0.0)


def test_a_start_at_rest_has_no_direction_of_friction() -> None:
    with pytest.raises(vv.InvalidInput, match="no number at a velocity of 0") as refused:
        sliding(1.05, 0.0).run(1.0)
    assert refused.value.argument == "velocity"
    pole = vv.systems.spherical_pendulum(position=[0.0, 0.0], velocity=[0.0, 0.0])
    with pytest.raises(vv.InvalidInput, match="no number at the start") as refused:
        pole.run(1.0)
    assert refused.value.argument == "position"


#: Equal steps of methods whose stages lie on both sides of the leap, and in eight lanes.
EQUAL = [("rk4", 0.1), ("rk4", 0.01), ("midpoint", 0.01), ("heun", 0.01), ("euler", 0.001), ("gauss4", 0.01)]


def pushed(push: float = 0.3) -> vv.Lagrangian:
    """v' = −0.3 − 0.5 sign v: from 1 to rest at t = 1.25, 0.625 away, where it is held."""
    return vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - push * q[0],
        ["x"],
        position=[0.0],
        velocity=[1.0],
        dissipation=lambda q, v, t: 0.5 * abs(v[0]),
    )


@pytest.mark.parametrize(("method", "dt"), EQUAL)
def test_equal_steps_do_not_creep(method: str, dt: float) -> None:
    with pytest.raises(vv.ConvergenceError, match="a velocity sticks at zero") as stuck:
        pushed().run([0.0, 100.0], method=method, dt=dt)
    assert abs(stuck.value.time - 1.25) <= 2.0 * dt
    # A step before it, at less than a step's change of the velocity; Euler's error is half a step's way.
    assert abs(float(stuck.value.trajectory.final.position[0]) - 0.625) <= dt  # type: ignore[union-attr]
    copies = pushed().ensemble(velocity=[[1.0], [2.0], [0.5]]).run([0.0, 100.0], method=method, dt=dt)
    assert (copies.status == vv.Status.STEP_FAILURE).all()


@pytest.mark.parametrize(("method", "dt"), EQUAL)
def test_equal_steps_pass_where_friction_does_not_hold(method: str, dt: float) -> None:
    """With a push of 0.7 beyond the friction of 0.5 it turns at t = 1/1.2 and comes back."""
    out = pushed(0.7).run([0.0, 3.0], method=method, dt=dt)
    turned = 1.0 / 1.2
    # A step across the leap errs by a step's way.
    assert float(out.position[-1, 0]) == pytest.approx(0.5 * turned - 0.1 * (3.0 - turned) ** 2, abs=2.0 * dt)


def test_equal_steps_stop_at_zero_of_drag_only_where_it_is_dry() -> None:
    """Drag that goes with the square of the velocity holds nothing, nor does a stiff damper."""
    quadratic = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 - q[0] ** 2) / 2,
        ["x"],
        position=[1.0],
        velocity=[0.0],
        forces={"x": lambda q, v, t: -0.5 * v[0] * abs(v[0]) - 5.0 * v[0]},
    )
    assert quadratic.run([0.0, 30.0], method="rk4", dt=0.01).status is vv.Status.OK


def spring(place: float, t0: float, friction: object) -> vv.Lagrangian:
    forces = {"x": friction}
    return vv.Lagrangian(lambda q, v, t: (v @ v - q @ q) / 2, ["x"], position=[place], t0=t0, forces=forces)


@pytest.mark.parametrize("friction", [
    lambda q, v, t: -FRICTION * np.sign(v[0]), lambda q, v, t: -FRICTION * v[0] / abs(v[0]),
    lambda q, v, t: -FRICTION * np.where(v[0] > 0.0, 1.0, -1.0),
])  # fmt: skip
def test_what_dry_friction_is_told_to_be_written_as_works(friction: object) -> None:
    """From rest at 1.05 half swings about ±0.1: −0.85 at π, 0.65 at 2π; by a smooth step, and by events at turns."""
    with pytest.raises(vv.InvalidInput) as refused:
        spring(1.05, 0.0, friction).run(1.0)
    told = refused.value.message
    assert "np.tanh(" in told
    assert "a thousandth of the usual values" in told
    assert "end the run by an event where it switches" in told
    # Friction of 0.1 is weaker for a time of 1e-4 at each turn, which moves the place by 0.1 (1e-4)² and the like.
    smooth = spring(1.05, 0.0, lambda q, v, t: -FRICTION * np.tanh(v[0] / 1e-4)).run(np.pi * np.arange(3.0))
    np.testing.assert_allclose(smooth["x"], [1.05, -0.85, 0.65], rtol=0, atol=1e-8)
    place, t0 = 1.05, 0.0
    for sign, end in ((1.0, -0.85), (-1.0, 0.65)):
        turn = vv.events.expression(lambda q, v, t: v[0], direction=sign, terminal=True)
        out = spring(place, t0, lambda q, v, t, sign=sign: sign * FRICTION).run(t0 + 4.0, events=[turn])
        place, t0 = out.final.position[0], out.final.t0
        # The place of a turn is flat in time: an event is found to round-off, and the run to 1e-12 of a step.
        assert place == pytest.approx(end, rel=1e-11, abs=0)
    assert t0 == pytest.approx(2.0 * np.pi, rel=1e-8, abs=0)
