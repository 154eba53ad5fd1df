"""Over random bad input: a named refusal and nothing else."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import visviva as vv
from visviva import _core

BAD_NUMBERS = st.sampled_from([np.nan, np.inf, -np.inf, 1j, "1", None, [1.0], object(), np.datetime64("2026-01-01")])
NAMES = [method.name for method in vv.methods()]
PAIR = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [1, 0, 0]]), vv.Gravity(1.0))


def refused(argument: str, **arguments: Any) -> str:
    """The message, having made sure that `argument` is refused by run and by plan alike."""
    with pytest.raises(vv.InvalidInput) as caught:
        PAIR.run(**({"t": 1.0} | arguments))
    assert caught.value.argument == argument
    if not {"threads", "progress"} & set(arguments):
        with pytest.raises(vv.InvalidInput) as planned:
            PAIR.plan(**({"t": 1.0} | arguments))
        assert str(planned.value) == str(caught.value)
    return str(caught.value)


@given(value=BAD_NUMBERS, name=st.sampled_from(["t", "dt", "rtol", "atol", "max_step"]))
def test_not_a_number(value: object, name: str) -> None:
    if value is None and name != "t":
        return
    if name == "t" and value == [1.0]:
        return
    refused(name, **({"method": "rk4", "dt": 0.1} | {name: value}))


@given(
    value=st.floats(max_value=0.0) | BAD_NUMBERS,
    fixed=st.sampled_from([n.name for n in vv.methods() if not n.adaptive]),
)
def test_steps_against_the_direction_of_time(value: object, fixed: str) -> None:
    refused("dt", method=fixed, dt=value)


@given(rtol=st.floats(max_value=2.2e-14))
def test_a_tolerance_below_rounding(rtol: float) -> None:
    refused("rtol", method="dop853", rtol=rtol)


@given(atol=st.floats(max_value=0.0, exclude_max=True))
def test_a_negative_absolute_tolerance(atol: float) -> None:
    refused("atol", method="dop853", atol=atol)


@given(threads=st.integers(max_value=0) | st.sampled_from(["2", 1.5, True, np.nan]))
def test_threads(threads: object) -> None:
    refused("threads", threads=threads)


@given(name=st.text(max_size=12).filter(lambda text: text not in {*NAMES, "auto"}))
def test_unknown_methods(name: str) -> None:
    refused("method", method=name)


@pytest.mark.parametrize(
    ("given_name", "meant"),
    [
        ("leap_frog", "leapfrog"),
        ("dopri853", "dop853"),
        ("RK4", "rk4"),
        ("yoshida", "yoshida4"),
        ("kahan_li_8", "kahan_li8"),
    ],
)
def test_the_nearest_method_is_named(given_name: str, meant: str) -> None:
    message = refused("method", method=given_name)
    assert meant in message
    if given_name != "RK4":  # the core compares with capitals, and the list of names must do
        assert message.endswith(f"; did you mean '{meant}'?")


@given(name=st.text(max_size=12))
def test_unknown_columns(name: str) -> None:
    known = {"position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass"}
    if name not in known:
        refused("record", record=("position", name))


def test_the_nearest_column_is_named() -> None:
    assert "; did you mean 'velocity'?" in refused("record", record=("position", "velocities"))


@given(times=st.lists(st.floats(-5.0, 5.0), max_size=6))
def test_unsorted_and_empty_times(times: list[float]) -> None:
    steps = np.diff([0.0, *times])
    # A time may be asked for twice.
    if len(times) > 0 and (np.all(steps >= 0) or np.all(steps <= 0)):
        return
    refused("t", t=times)


def test_a_missing_step_is_asked_for() -> None:
    assert "rk4" in refused("dt", method="rk4")


@given(mass=st.floats(max_value=0.0, exclude_max=True, allow_infinity=False), index=st.integers(0, 2))
def test_negative_masses(mass: float, index: int) -> None:
    masses = np.ones((2, 3))
    masses[1, index] = mass
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Particles(masses[1], np.eye(3))
    assert caught.value.argument == "mass"
    assert f"mass[{index}] is {mass}" in str(caught.value)
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Scene(vv.Particles(masses[0], np.eye(3))).ensemble(mass=masses)
    assert caught.value.argument == "mass"
    assert f"mass[1, {index}] is {mass}" in str(caught.value)


def test_the_core_looks_at_masses_itself() -> None:
    with pytest.raises(vv.InvalidInput, match=r"mass\[1\]") as caught:
        _core.acceleration(
            mass=np.array([1.0, -1.0]), forces=[], position=np.eye(3)[:2], velocity=np.zeros((2, 3)), t0=0.0
        )
    assert caught.value.argument == "mass"


@given(value=st.sampled_from([np.nan, np.inf, -np.inf]), body=st.integers(0, 2), axis=st.integers(0, 2))
@pytest.mark.parametrize("name", ["mass", "position", "velocity"])
def test_what_is_not_finite_is_named_with_its_place(name: str, value: float, body: int, axis: int) -> None:
    state = {"mass": np.ones(3), "position": np.eye(3), "velocity": np.zeros((3, 3))}
    where = (body,) if name == "mass" else (body, axis)
    state[name][where] = value
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Particles(**state)
    assert caught.value.argument == name
    assert f"{name}[{', '.join(map(str, where))}] is {value}" in str(caught.value)
    copies = vv.Scene(vv.Particles(np.ones(3), np.eye(3)))
    with pytest.raises(vv.InvalidInput) as caught:
        copies.ensemble(**{name: np.stack([state[name], state[name]])})
    assert caught.value.argument == name
    assert f"{name}[{', '.join(map(str, (0, *where)))}] is {value}" in str(caught.value)


@given(data=st.data(), count=st.integers(2, 6))
def test_coincident_bodies_are_both_named(data: st.DataObject, count: int) -> None:
    position = np.arange(3.0 * count).reshape(count, 3)
    first, second = sorted(data.draw(st.permutations(range(count)))[:2])
    position[second] = position[first]
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Scene(vv.Particles(np.ones(count), position), vv.Gravity(1.0)).run(t=1.0, method="dop853")
    assert caught.value.argument == "position"
    assert str(first) in str(caught.value)
    assert str(second) in str(caught.value)
    vv.Scene(vv.Particles(np.ones(count), position), vv.Gravity(1.0, softening=0.1)).run(t=0.1, method="dop853")
