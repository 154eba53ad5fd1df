"""Wrong calls: each is refused by name, with what was expected, and nothing fails inside."""

import re
from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np
import pytest
import wrong_calls
import wrong_results

import visviva as vv

CALLS = [*wrong_calls.CALLS, *wrong_results.CALLS]


def shown(value: object) -> str:
    """Without the address of a function, which every process has another of."""
    return value.__qualname__ if isinstance(value, FunctionType) else re.sub(r" at 0x\w+", "", f"{value!r:.40}")


WRONG = [
    pytest.param(call, good | {argument: value}, argument, id=f"{call.__qualname__}({argument}={shown(value)})")
    for call, good, arguments in CALLS
    for argument, values in arguments.items()
    for value in values
] + [
    pytest.param(call, {"path": value}, "path", id=f"{call.__qualname__}({shown(value)})")
    for call, values in wrong_results.PATHS
    for value in values
]


# What was expected, or what is wrong with what came.
SAID = (
    "expected|there is no|is called with|is none of|must be|has (a fixed|no) |out of bounds|cannot be|estimates no|"
    "is (no|bent) "
)


def test_there_are_enough() -> None:
    assert len(WRONG) >= 250


@pytest.mark.parametrize(("call", "good"), [(call, good) for call, good, _ in CALLS if call is not vv.load])
def test_the_right_call_runs(call: Callable[..., Any], good: dict[str, Any]) -> None:
    call(**good)


@pytest.mark.parametrize(("call", "given", "argument"), WRONG)
def test_refused_by_name(call: Callable[..., Any], given: dict[str, Any], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as refused:
        call(**given)
    assert argument in refused.value.argument
    assert len(str(refused.value)) > len(argument) + 10  # and not the name alone
    assert re.search(SAID, refused.value.message)


# Calls that no argument of a list can stand for: what is called, and the argument or attribute that is named.
OTHERS: dict[str, tuple[Callable[[], Any], str]] = {
    "Status": (lambda: vv.Status(99), "Status"),
    "Status by text": (lambda: vv.Status("OK"), "Status"),  # type: ignore[arg-type]
    "DeflectionStatus": (lambda: vv.scattering.DeflectionStatus(None), "DeflectionStatus"),  # type: ignore[arg-type]
    "Force": (vv.forces.Force, "Force"),
    "Potential": (vv.potentials.Potential, "Potential"),
    "GeneralizedSystem": (vv.generalized.GeneralizedSystem, "GeneralizedSystem"),
    "places of a function": (lambda: wrong_results.plain(lambda q, v, t: v[3] ** 2), "L"),
    "math of a function": (lambda: wrong_results.plain(lambda q, v, t: round(q[0])), "L"),
    "larger of a function": (lambda: wrong_results.plain(lambda q, v, t: np.fmax(q[0], 1.0)), "L"),
    "collisions of a wrong kind": (lambda: wrong_calls.SCENE.run(1.0, collisions="bang"), "collisions"),  # type: ignore[arg-type]
    "a copy": (lambda: wrong_results.SWINGS["x"], "index"),  # type: ignore[index]
    "a motion of a copy": (lambda: wrong_results.SWINGS.run(t=1.0)[0.5], "index"),  # type: ignore[index]
    "several copies": (lambda: wrong_results.SWINGS[[0.5]], "index"),  # type: ignore[list-item]
    "lines of events": (
        lambda: wrong_calls.PENDULUM.run(t=1.0, events=["theta"]).events[[0.5]],  # type: ignore[index]
        "index",
    ),
    "no problem": (lambda: vv.work_precision([]), "problem"),  # type: ignore[arg-type]
    "events of a Monte Carlo": (
        lambda: vv.scattering.monte_carlo(  # type: ignore[call-arg]
            wrong_calls.K, beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1, save_every=5
        ),
        "save_every",
    ),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_wrong_calls_are_refused_by_name(name: str) -> None:
    call, argument = OTHERS[name]
    with pytest.raises(vv.InvalidInput) as refused:
        call()
    assert refused.value.argument == argument
    assert len(refused.value.message) > 20


NAMED_TUPLES = [
    vv.rigid.ConeAngles,
    vv.rigid.PrincipalAxes,
    vv.rigid.ScrewAxis,
    vv.rigid.SteadyPrecession,
    vv.rigid.TopMomenta,
    vv.scattering.CrossSection,
    vv.scattering.Fraction,
]


@pytest.mark.parametrize("kind", NAMED_TUPLES, ids=lambda kind: kind.__name__)
def test_named_tuples_are_made_of_their_fields(kind: Any) -> None:
    fields = kind._fields
    with pytest.raises(vv.errors.UnknownKeyword, match=fields[0]):
        kind(nothing_like_it=1)
    with pytest.raises(vv.errors.WrongArguments, match="at most"):
        kind(*range(len(fields) + 1))
    with pytest.raises(vv.errors.WrongArguments, match=f"{fields[-1]}: expected with every call"):
        kind(*range(len(fields) - 1))
    made = kind(*range(len(fields)))
    assert made == kind(**dict(zip(fields, range(len(fields)), strict=True))) == tuple(range(len(fields)))
    assert made._replace(**{fields[0]: 7})[0] == 7


@pytest.mark.parametrize(
    ("call", "keyword", "cure"),
    [
        (lambda **given: wrong_calls.PENDULUM.run(1.0, **given), "save_every", r"visviva.load\(path\).final"),
        (lambda **given: wrong_results.SWINGS.run(1.0, **given), "save_to", r"visviva.load\(path\)\[i\].final"),
        (lambda **given: vv.scattering.monte_carlo(wrong_calls.K, **given), "save_every", "first_event=result.next"),
        (lambda **given: wrong_results.FOIL.run("alpha", **given), "save_every", "first_event=result.next_event"),
    ],
    ids=["run", "ensemble", "Monte Carlo", "foil"],
)
def test_what_is_not_saved_as_it_goes_says_what_to_do(call: Callable[..., Any], keyword: str, cure: str) -> None:
    with pytest.raises(vv.errors.UnknownKeyword, match=cure) as refused:
        call(**{keyword: 1})
    assert refused.value.argument == keyword


def test_errors_of_ones_own_say_where_they_are_from() -> None:
    """They stay what they are, with a note."""

    def own(q: Any, v: Any, t: Any) -> Any:
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine") as raised:
        wrong_results.plain(own)
    assert not isinstance(raised.value, vv.Error)
    assert any(note.startswith("L: raised in") and "own" in note for note in raised.value.__notes__)


def test_what_stays_is_not_given_again() -> None:
    scene = wrong_calls.SCENE
    faster = scene.with_state(velocity=np.ones((2, 3)))
    assert np.array_equal(faster.particles.position, scene.particles.position)
    assert faster.particles.velocity.tolist() == np.ones((2, 3)).tolist()
    moved = faster.with_state(2.0 * scene.particles.position, t0=3.0)
    assert np.array_equal(moved.particles.velocity, faster.particles.velocity)
    assert moved.t0 == 3.0
    assert moved.forces == scene.forces
