"""A force of the time, however small, does not silence what is told of steps that resolve nothing."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from visviva.forces import Force

WEAK = vv.DrivenForce((1e-9, 0.0, 0.0), frequency=1.0)
WRITTEN = vv.ExpressionForce(force=lambda r, v, t: (1e-9 * np.cos(t), 0.0 * t, 0.0 * t))
PAIR = vv.Particles([1.0, 1.0], [[0.0, 0.0, 0.0], [1.1, 0.0, 0.0]])
STIFF = {
    "spring": (vv.Spring(0, 1, 500.0, length=1.0),),
    "trap": (vv.Harmonic(k=700.0),),
    "field": (vv.CentralField(vv.potentials.Custom(lambda r, k: k * r * r, parameters={"k": 400.0})),),
    "pair": (vv.PairPotential(vv.potentials.Custom(lambda r, k: k * (r - 1.0) ** 2, parameters={"k": 300.0})),),
    "trap in a magnetic field": (vv.UniformMagneticField((0.0, 0.0, 1.0)), vv.Harmonic(k=700.0)),
}


def warned(run: vv.Scene | vv.EnsembleScene, **how: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run.run(**how)
    assert {each.category for each in caught} <= {vv.AccuracyWarning}
    return [str(each.message) for each in caught]


@pytest.mark.parametrize("weak", [WEAK, WRITTEN], ids=["driven", "written"])
@pytest.mark.parametrize("forces", STIFF)
@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "stormer13", "boris", "rk4"])
def test_steps_that_make_it_grow_without_end(method: str, forces: str, weak: Force) -> None:
    """They gave 1e25 with status OK and without a word, and are warned of without the weak force."""
    if method in ("leapfrog", "yoshida4", "stormer13") and "magnetic" in forces:
        pytest.skip("these methods take no magnetic field")
    scene, how = vv.Scene(PAIR, *STIFF[forces], weak), {"t": 3.0, "method": method, "dt": 0.1}
    [message] = warned(scene, **how)
    # Of what the drive cannot have given the energy tells, too.
    assert weak is WEAK or "the velocity of body" in message
    assert "is off by" in message
    assert "a step of dt = 0.1 does not resolve this motion" in message
    assert warned(scene, **how | {"dt": 0.002}) == []


def test_copies_and_parts_of_a_run_tell_it_too() -> None:
    spring = vv.Spring(0, 1, 500.0, length=1.0)
    copies = vv.Scene(PAIR, spring, WRITTEN).ensemble(parameters={spring: {"k": [1.0, 2.0, 500.0, 3.0]}})
    for threads in (1, 3):
        [message] = warned(copies, t=3.0, method="leapfrog", dt=0.1, threads=threads)
        assert message.startswith("in copy 2, after a step from the end the velocity of body")


def test_light_bodies_in_a_soft_well_have_no_energy_to_tell() -> None:
    """At its bottom a softened mass holds them as a spring of 700 does."""
    bodies = vv.Particles([1.0, 0.0], [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]])
    [message] = warned(vv.Scene(bodies, vv.Gravity(700.0, softening=1.0)), t=3.0, method="leapfrog", dt=0.1)
    assert "the velocity of body 1" in message
    assert warned(vv.Scene(bodies, vv.Gravity(700.0, softening=1.0)), t=3.0, method="leapfrog", dt=0.01) == []


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "stormer13", "boris", "yoshida4", "rk4", "euler"])
@pytest.mark.parametrize("periods", [1.0, 2.0, 2.0 / 3.0])
def test_a_drive_of_which_every_step_sees_the_same(method: str, periods: float) -> None:
    """A step of one period saw a constant force: 66 for -0.07, OK. Half of two periods does no better."""
    frequency = 20.0 * np.pi
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    scene = vv.Scene(body, vv.DrivenForce((1.0, 0.0, 0.0), frequency=frequency, phase=0.4))
    dt = 0.1 * periods
    [message] = warned(scene, t=120 * dt, method=method, dt=dt)
    assert "the velocity of body 0" in message
    assert warned(scene, t=4.0, method=method, dt=0.001) == []


def test_a_drive_that_moves_nothing_is_not_blamed() -> None:
    """Two hundred steps of it, were it constant, would change the velocity by a millionth."""
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    hum = vv.DrivenForce((1e-7, 0.0, 0.0), frequency=20.0 * np.pi)
    assert warned(vv.Scene(body, hum), t=20.0, method="leapfrog", dt=0.1) == []


def test_what_hardly_moves_yet_is_not_blamed() -> None:
    """Under a sine from rest Euler's first step finds no force at all, which is nothing beside what follows."""
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    sine = vv.DrivenForce((1.0, 0.0, 0.0), frequency=1.0, phase=-0.5 * np.pi)
    for method in ("euler", "symplectic_euler", "leapfrog", "rk4"):
        for turns in (0.64, 1.0, 2.0):  # after whole turns it rests again
            how = {"t": turns * 2.0 * np.pi, "method": method, "dt": np.pi / 100.0}
            assert warned(vv.Scene(body, sine), **how) == []
            assert warned(vv.Scene(body, sine, vv.Harmonic(k=1e-3)), **how) == []


def test_bodies_that_balance_where_others_turn_are_not_blamed() -> None:
    """In the middle of two on a circle nothing pulls but rounding, which no step resolves."""
    places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    speeds = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -0.5, 0.0]]
    three = vv.Particles([1e-3, 1.0, 1.0], places, speeds)
    scene = vv.Scene(three, vv.Gravity(G=1.0), vv.DrivenForce((0.0, 0.0, 1e-9), frequency=0.1))
    for method in ("leapfrog", "kahan_li8", "stormer13", "rk4"):
        assert warned(scene, t=0.6, method=method, dt=0.01) == []


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "rk4"])
def test_a_passage_that_a_drive_cannot_have_paid_for(method: str) -> None:
    """Where both ends are calm no step tells; but no drive so weak gives a thousand times the energy."""
    pair = vv.PairPotential(vv.potentials.LennardJones(epsilon=30.0, sigma=1.0))
    center = vv.CentralField(vv.potentials.Coulomb(k=-1.0))
    falling = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.3, 0.0]])
    for scene, how in (
        (vv.Scene(PAIR, pair, WEAK), {"t": 3.0, "dt": 0.1}),
        (vv.Scene(falling, center, WEAK), {"t": 10.0, "dt": 0.3}),
    ):
        [message] = warned(scene, method=method, **how)
        assert "off by" in message
        assert warned(scene, t=how["t"], method=method, dt=2e-4) == []


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "stormer13", "rk4", "verner98"])
def test_what_a_drive_does_pay_for_is_not_blamed(method: str) -> None:
    """Resonance from rest, a push from rest, one against the motion: all of the energy is the drive's."""
    step = {} if method == "verner98" else {"dt": 0.02}
    body = vv.Particles([2.0], [[0.0, 0.0, 0.0]])
    moving = vv.Particles([2.0, 0.5], [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], [[1e-3, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    resonant = vv.DrivenForce((0.3, 0.0, 0.0), frequency=1.0)
    slow = vv.DrivenForce((5.0, 1.0, 0.0), frequency=1e-3)
    for scene in (
        vv.Scene(body, vv.Harmonic(k=2.0), resonant),
        vv.Scene(body, slow),
        vv.Scene(moving, slow),
        vv.Scene(moving, vv.Spring(0, 1, 3.0, length=1.0), vv.Gravity(1e-3), slow, resonant),
    ):
        for t in (0.5, 40.0, -40.0):
            signed = {name: np.copysign(dt, t) for name, dt in step.items()}
            assert warned(scene, t=t, method=method, **signed) == []


@pytest.mark.parametrize("frequency", [0.0, 1e-3])
def test_a_strong_drive_is_no_measure_where_drag_holds_the_body(frequency: float) -> None:
    """Its terminal speed is 0.01, and steps of 2.8 times of decay made -0.08 of it, without a word for a day."""
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    drive = vv.DrivenForce((1.0, 0.0, 0.0), frequency=frequency)
    scene = vv.Scene(body, drive, vv.LinearDrag(tau=0.01))
    [message] = warned(scene, t=2.8, method="rk4", dt=0.028)
    assert "the velocity of body 0 is off" in message
    assert warned(scene, t=2.8, method="rk4", dt=0.002) == []


@pytest.mark.parametrize("force", [1e-6, 1e-4])
def test_a_swing_between_two_rests_without_energies_is_not_blamed(force: float) -> None:
    """At both turning points V is zero, so what is there is what a resonant drive gave, and no measure of the swing."""
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    drive = vv.DrivenForce((force, 0.0, 0.0), frequency=1.0, phase=0.5 * np.pi)
    scene = vv.Scene(body, vv.Harmonic(k=1.0), vv.UniformField((-1.0, 0.0, 0.0)), drive)
    for steps in (200, 20000):
        assert warned(scene, t=2.0 * np.pi, method="kahan_li8", dt=2.0 * np.pi / steps) == []


def test_a_hum_that_a_spring_holds_is_not_blamed_however_long_it_lasts() -> None:
    """Taken for constant it would give a free body all of its velocity; the spring lets it move by a thousandth."""
    body = vv.Particles([1.0], [[1.0, 0.0, 0.0]])
    scene = vv.Scene(body, vv.Harmonic(k=1.0), vv.DrivenForce((1e-3, 0.0, 0.0), frequency=20.0 * np.pi))
    assert warned(scene, t=1000.0, method="kahan_li8", dt=0.1) == []


def test_the_step_that_a_drive_needs_is_named_by_its_period() -> None:
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    scene = vv.Scene(body, vv.DrivenForce((1.0, 0.0, 0.0), frequency=20.0 * np.pi))
    [message] = warned(scene, t=24.0, method="leapfrog", dt=0.2)
    assert message == (
        "by a DrivenForce that has less than two steps to a period the velocity of body 0 is off by 1 of itself: take "
        "steps of a sixth of its period or less, or an adaptive method (verner98)"
    )
