"""Ensembles over the numbers of what acts on rigid bodies: each copy is the scene that has them alone."""

import ctypes
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from copies_elsewhere import COLUMNS, assert_same
from loads_of_copies import CASES, COPIES, DRAG, PAIR, WEIGHT, made_by_hand, numbers, with_method

import visviva as vv

TIMES = [0.1, 0.515]
HOW: list[dict[str, Any]] = [
    {},
    {"method": "taylor"},
    {"method": "verner98"},
    {"dt": 0.01},
]


@pytest.mark.parametrize("how", HOW, ids=lambda how: how.get("method", "equal steps" if how else "auto"))
@pytest.mark.parametrize("name", CASES)
def test_members_are_as_if_alone(name: str, how: dict[str, Any]) -> None:
    scene, parameters = CASES[name]
    how = with_method(how, scene)
    copies = scene.ensemble(parameters=parameters)
    alone = [made_by_hand(scene, parameters, copy) for copy in range(COPIES)]
    assert list(copies) == alone
    assert len({one.body_forces for one in alone}) > COPIES // 2
    assert copies.body_forces == tuple(one.body_forces for one in alone)
    expected = [one.run(t=TIMES, record=COLUMNS, **how) for one in alone]
    for threads in (1, 3):
        out = copies.run(t=TIMES, record=COLUMNS, threads=threads, **how)
        for copy in range(COPIES):
            assert_same(out[copy], expected[copy])
            assert out.per_trajectory["steps"][copy] == expected[copy].stats.steps


@pytest.mark.parametrize("how", [{}, {"method": "taylor"}, {"method": "rk4", "dt": 0.01}], ids=str)
def test_beside_everything_else_of_their_own(how: dict[str, Any]) -> None:
    """Moments of all symmetries, spins, masses and forces on points, some of which are none."""
    scene, parameters = CASES["several"]
    rng = np.random.default_rng(3)
    second = rng.uniform(0.02, 0.3, (COPIES, 2, 3))
    second[::3, 1] = second[::3, 1, :1]
    second[1::3, :, 1] = second[1::3, :, 0]
    masses = np.tile(scene.particles.mass, (COPIES, 1)) * rng.uniform(0.5, 2.0, (COPIES, 4))
    copies = scene.ensemble(
        parameters=parameters | {"Gravity": {"G": numbers(rng, zeros=True)}},
        mass=masses,
        moments=second.sum(axis=-1, keepdims=True) - second,
        angular_velocity=rng.normal(size=(COPIES, 2, 3)),
    )
    out = copies.run(t=TIMES, record=COLUMNS, **how)
    for copy in range(COPIES):
        assert_same(out[copy], copies[copy].run(t=TIMES, record=COLUMNS, **how))
    assert list(copies[2:9]) == [copies[copy] for copy in range(2, 9)]
    assert_same(copies[2:9].run(t=TIMES, record=COLUMNS, **how), out[2:9])


TORQUES = np.linspace(-3.0, 3.0, 17)
SYMMETRIC = vv.RigidBody(1.0, [1.0, 1.2, 2.0])


@pytest.mark.parametrize("how", [*HOW[:3], {"method": "kahan_li8", "dt": 0.01}], ids=str)
def test_a_torque_spins_up(how: dict[str, Any]) -> None:
    """ω = τ t / I about a principal axis."""
    torques = np.multiply.outer(TORQUES, [0.0, 0.0, 1.0])
    copies = vv.Scene(SYMMETRIC, vv.AppliedTorque([0, 0, 1.0])).ensemble(
        parameters={"AppliedTorque": {"torque": torques}}
    )
    # Linear in time, which every method has but for the roundings of 200 steps.
    assert copies.run(t=2.0, **how).angular_velocity[:, -1, 0, 2] == pytest.approx(TORQUES, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    ("how", "bound"), [({"rtol": 1e-12}, 1e-12), ({"method": "verner98"}, 1e-11), ({"method": "taylor"}, 1e-13)]
)
def test_drag_takes_a_spin_away(how: dict[str, Any], bound: float) -> None:
    """exp(−c t / I), and where there is none the spin stays to the bit. Errors of a few steps of the tolerance."""
    coefficients = np.linspace(0.0, 2.0, 17)
    body = vv.RigidBody(1.0, [1.0, 1.2, 2.0], angular_velocity=[0.0, 0.0, 3.0])
    copies = vv.Scene(body, DRAG).ensemble(parameters={DRAG: {"coefficient": coefficients}})
    spin = copies.run(t=2.0, **how).angular_velocity[:, -1, 0, 2]
    assert spin == pytest.approx(3.0 * np.exp(-coefficients), rel=bound, abs=0.0)
    assert spin[0] == 3.0


@pytest.mark.parametrize(
    ("how", "bound"),
    [({"rtol": 1e-12}, 1e-12), ({"method": "verner98"}, 1e-9), ({"method": "kahan_li8", "dt": 0.01}, 1e-14)],
)
def test_a_body_hangs_on_springs_of_all_stiffnesses(how: dict[str, Any], bound: float) -> None:
    """Held at its center it swings with √(k/m) about where it hangs, and falls where there is no spring.

    Bounds: errors of steps of the tolerance, and of 200 of order eight and of 1 % of a turn.
    """
    stiffness = np.linspace(0.0, 6.0, 17)
    spring = vv.AttachedSpring(0, [0, 0, 0], stiffness=1.0, anchor=[0, 0, 0])
    body = vv.RigidBody(0.5, [1.0, 1.2, 2.0], position=[1.0, 0, 0])
    copies = vv.Scene(body, WEIGHT, spring).ensemble(parameters={spring: {"stiffness": stiffness}})
    place = copies.run(t=2.0, **how).position[:, -1, 0]
    phase = 2.0 * np.sqrt(2.0 * stiffness)
    assert place[:, 0] == pytest.approx(np.cos(phase), rel=0.0, abs=bound)
    # g (1 − cos ωt) / ω², of which g t² / 2 is the limit.
    fallen = 2.0 * np.sinc(phase / (2.0 * np.pi)) ** 2
    assert place[:, 2] == pytest.approx(-fallen, rel=0.0, abs=bound)


def test_events_are_those_of_each_copy() -> None:
    scene, parameters = CASES["anchored spring"]
    copies = scene.ensemble(parameters=parameters)
    rises = vv.events.plane([0.0, 0.0, 0.5], [0.0, 0.0, 1.0], body="brick")
    out = copies.run(t=8.0, events=[rises])
    assert len(out.events) > COPIES
    for copy in range(COPIES):
        alone = copies[copy].run(t=8.0, events=[rises])
        assert np.array_equal(out[copy].events.t, alone.events.t)
        assert np.array_equal(out[copy].events.position, alone.events.position, equal_nan=True)


WORDS = r"the energy at the end is off by .* of kinetic \+ \|potential\|"


def test_a_warning_names_the_copy(tmp_path: Path) -> None:
    """Of a step that is too long for one spring only: its energy is off by itself, not by the springs of others."""
    body = vv.RigidBody(1.0, [1.0, 1.5, 2.0], angular_velocity=[0.1, 0.2, 0.0])
    spring = vv.AttachedSpring(0, [0.1, 0, 0.5], stiffness=1.0, length=0.5, anchor=[0, 0.5, 2.0])
    copies = vv.Scene(body, spring).ensemble(parameters={spring: {"stiffness": [1.0, 1.0, 400.0, 1.0]}})
    how: dict[str, Any] = {"t": 8.0, "method": "rk4", "dt": 0.1}
    with pytest.warns(vv.AccuracyWarning, match="in copy 2, " + WORDS):
        copies.run(**how)
    with pytest.warns(vv.AccuracyWarning, match="in copy 2, " + WORDS):
        copies.run_to_parquet(**how, to=tmp_path / "run.parquet", copies_at_once=3)
    copies[:2].run(**how)


@pytest.mark.parametrize("damped", [0, 1])
def test_only_energies_that_are_conserved_are_looked_at(damped: int) -> None:
    """What a damper takes, a third of all here, is no error; that of the other copy is."""
    body = vv.RigidBody(1.0, [1.0, 1.5, 2.0], angular_velocity=[0.1, 0.2, 0.0])
    spring = vv.AttachedSpring(0, [0.1, 0, 0.5], stiffness=1.0, length=0.5, anchor=[0, 0.5, 2.0])
    own = {"damping": np.zeros(2), "stiffness": np.ones(2)}
    own["damping"][damped] = 0.5
    out = vv.Scene(body, spring).ensemble(parameters={spring: own}).run(t=8.0, method="rk4", dt=0.1)
    assert out.energy[damped, -1] < 0.67 * out.energy[damped, 0]
    own["stiffness"][1 - damped] = 400.0
    with pytest.warns(vv.AccuracyWarning, match=f"in copy {1 - damped}, " + WORDS):
        vv.Scene(body, spring).ensemble(parameters={spring: own}).run(t=8.0, method="rk4", dt=0.1)


def test_a_step_that_resolves_nothing_is_said_of_the_copy_with_drag() -> None:
    """What dampers take is no error of the energy; a step of two and a half times I/c is too long."""
    body = vv.RigidBody(1.0, [1.0, 1.5, 2.0], angular_velocity=[0.1, 0.2, 0.0])
    how: dict[str, Any] = {"t": 8.0, "method": "rk4", "dt": 0.1}
    for largest, looked_at in ((0.1, False), (25.0, True)):
        copies = vv.Scene(body, DRAG).ensemble(parameters={DRAG: {"coefficient": [0.1, 0.0, largest]}})
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            copies.run(**how)
        told = "in copy 2, after the first step the spin of rigid body 0 is off by 0.26 of itself"
        assert [str(each.message).startswith(told) for each in caught] == [True] * looked_at


def test_many_copies_are_looked_at_where_that_costs_nothing() -> None:
    body = vv.RigidBody(1.0, [1.0, 1.5, 2.0], angular_velocity=[0.1, 0.2, 0.0])
    spring = vv.AttachedSpring(0, [0.1, 0, 0.5], stiffness=400.0, length=0.5, anchor=[0, 0.5, 2.0])
    for copies, looked_at in ((16, True), (17, False)):
        stiffness = {spring: {"stiffness": 400.0 + np.arange(copies)}}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            vv.Scene(body, spring).ensemble(parameters=stiffness).run(t=8.0, method="rk4", dt=0.1)
        assert [each.category for each in caught] == [vv.AccuracyWarning] * looked_at


NUMBERS = ctypes.POINTER(ctypes.c_double)


@ctypes.CFUNCTYPE(None, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS)
def motor(t: float, orientation: Any, angular_velocity: Any, torque: Any) -> None:
    torque[0], torque[1], torque[2] = 0.1, 0.0, 1.0


def test_beside_a_compiled_torque(tmp_path: Path) -> None:
    scene = vv.Scene(PAIR, vv.CompiledTorque(motor, body=0), DRAG)
    copies = scene.ensemble(parameters={DRAG: {"coefficient": numbers(np.random.default_rng(5), zeros=True)}})
    out = copies.run(t=TIMES)
    for copy in range(COPIES):
        assert_same(out[copy], copies[copy].run(t=TIMES))
    with pytest.raises(vv.InvalidInput, match="such a run cannot be saved"):
        out.save(tmp_path / "run.npz")
    for name in ("function", "address", "body"):
        with pytest.raises(vv.InvalidInput, match=f"got '{name}': bodies, axes and functions are the same in all"):
            scene.ensemble(parameters={"CompiledTorque": {name: [motor, motor]}})


def test_what_other_copies_have_decides_nothing() -> None:
    """Damping of one was asked of another, which took another method; a torque of 0 left terms in another order."""
    ball = vv.RigidBody(1.0, [1.0, 1.0, 1.0], angular_velocity=[0.1, 0.2, 0.3])
    spring = vv.AttachedSpring(0, [0.1, 0.2, 0.5], stiffness=1.0, length=1.0, anchor=[0.0, 0.0, 6.0])
    damped = vv.Scene(ball, spring).ensemble(parameters={spring: {"damping": [0.1, 0.0]}})
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 0.7, 0.3])
    torque = vv.AppliedTorque([0.0, 0.0, 1.0], frame="body")
    springs = [
        vv.AttachedSpring(0, [0.1, 0.2, 0.3], stiffness=1.0, length=1.0, anchor=[0.0, 0.0, 6.0]),
        vv.AttachedSpring(0, [0.3, 0.2, -0.3], stiffness=1.3, length=1.0, anchor=[0.0, 5.0, 6.0]),
    ]
    turned = vv.Scene(body, *springs, torque).ensemble(parameters={torque: {"torque": [[0.1, 0.3, 0.2], [0, 0, 0.2]]}})
    for copies, method in ((damped, "auto"), (damped, "taylor"), (turned, "taylor"), (turned, "auto")):
        together = copies.run(t=[0.3, 0.777], method=method)
        for copy in range(2):
            alone = copies[copy].run(t=[0.3, 0.777], method=method)
            assert np.array_equal(alone.angular_velocity, together.angular_velocity[copy]), (method, copy)
