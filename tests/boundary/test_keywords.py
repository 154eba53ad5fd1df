"""Every public function, constructor and method refuses a keyword that it does not take, and says which is nearest.

The callables are found, not listed: a public name that is added without `known_keywords` fails here.
"""

import enum
import inspect
import pickle
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest

import visviva as vv

ONE = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]))


def public(module: ModuleType) -> Iterator[tuple[str, Callable[..., Any], bool]]:
    """Name, callable, and whether it wants a `self`, of all that a module and the rooms in it export."""
    for name in module.__all__:
        found = getattr(module, name)
        label = f"{module.__name__}.{name}"
        if isinstance(found, ModuleType):
            if found is not vv.typing:  # nothing there is called
                yield from public(found)
        elif not isinstance(found, type):
            if callable(found):  # units are numbers
                yield label, found, False
        # Exceptions are made by the package; the values of an enumeration or a tuple are given by position.
        elif not issubclass(found, BaseException | enum.Enum | tuple) and found is not vv.forces.Force:
            for attribute, value in inspect.getmembers(found, inspect.isfunction):
                home = next(base for base in found.__mro__ if attribute in vars(base))
                ours = home.__module__.startswith("visviva")  # not what a base from elsewhere brings
                if ours and (attribute == "__init__" or not attribute.startswith("_")):
                    yield f"{label}.{attribute}", value, not isinstance(vars(home)[attribute], staticmethod)


CALLABLES = list({label: (label, *rest) for label, *rest in public(vv)}.values())


def parameters(function: Callable[..., Any], method: bool) -> list[str]:
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    names = [name for name, found in inspect.signature(function).parameters.items() if found.kind in kinds]
    return names[1:] if method else names


def test_the_walk_finds_the_public_names() -> None:
    labels = {label for label, *_ in CALLABLES}
    for name in (
        "Scene.run",
        "Scene.__init__",
        "EnsembleScene.plan",
        "Trajectory.conservation",
        "Gravity.__init__",
        "load",
        "methods",
        "potentials.Yukawa.__init__",
        "potentials.Yukawa.value",
        "scattering.monte_carlo",
        "scattering.kinematic_factor",
        "collisions.restitution",
        "orbits.state",
        "problems.kepler",
        "datasets.outer_solar_system",
    ):
        assert f"visviva.{name}" in labels


@pytest.mark.parametrize(("label", "function", "method"), CALLABLES, ids=[label for label, *_ in CALLABLES])
def test_an_unknown_keyword_is_refused_by_name(label: str, function: Callable[..., Any], method: bool) -> None:
    arguments = (None,) if method else ()
    with pytest.raises(vv.UnknownKeyword) as caught:
        function(*arguments, zzzzzzzzzz=1)
    assert caught.value.argument == "zzzzzzzzzz"
    assert "did you mean" not in str(caught.value)
    known = parameters(function, method)
    for name in known:
        assert name in caught.value.message
        misspelt = name + name[-1] + name[-1]
        with pytest.raises(vv.UnknownKeyword) as caught:
            function(*arguments, **{misspelt: 1})
        assert caught.value.argument == misspelt
        assert str(caught.value).endswith(f"got {misspelt!r}; did you mean '{name}'?")


@pytest.mark.parametrize(("label", "function", "method"), CALLABLES, ids=[label for label, *_ in CALLABLES])
def test_missing_and_superfluous_arguments_are_refused_by_name(
    label: str, function: Callable[..., Any], method: bool
) -> None:
    taken = list(inspect.signature(function).parameters.values())[method:]
    arguments = (None,) if method else ()
    if all(parameter.kind is not parameter.VAR_POSITIONAL for parameter in taken):
        with pytest.raises(vv.WrongArguments, match=r"got 40$"):
            function(*arguments, *[None] * 40)
    needed = [p.name for p in taken if p.default is p.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
    if needed:
        with pytest.raises(vv.WrongArguments) as caught:
            function(*arguments)
        assert caught.value.argument == needed[0]
    if taken and taken[0].kind is inspect.Parameter.POSITIONAL_OR_KEYWORD:
        with pytest.raises(vv.WrongArguments) as caught:
            function(*arguments, None, **{taken[0].name: None})
        assert caught.value.argument == taken[0].name


def test_a_type_error_from_inside_is_not_taken_for_a_wrong_call() -> None:
    def failing(t: float, q: float, v: float) -> float:
        raise TypeError("of the user's own function")

    with pytest.raises(TypeError, match="own function") as caught:
        vv.solve_ivp(lambda t, y: failing(t, 0.0, 0.0), (0.0, 1.0), [1.0])
    assert not isinstance(caught.value, vv.WrongArguments)


@pytest.mark.parametrize(("label", "function", "method"), CALLABLES, ids=[label for label, *_ in CALLABLES])
def test_what_is_checked_still_looks_like_itself(label: str, function: Callable[..., Any], method: bool) -> None:
    original = function.__wrapped__  # type: ignore[attr-defined]
    assert isinstance(original, FunctionType)
    assert inspect.signature(function) == inspect.signature(original)
    assert (function.__doc__, function.__name__, function.__module__) == (
        original.__doc__,
        original.__name__,
        original.__module__,
    )


@pytest.mark.parametrize(
    ("call", "came", "meant"),
    [
        (lambda: ONE.run(t=1.0, metod="dop853"), "metod", "method"),
        (lambda: ONE.run(t=1.0, Method="dop853"), "Method", "method"),
        (lambda: ONE.run(1.0, tol=1e-9), "tol", "rtol"),
        (lambda: ONE.plan(t=1.0, rtoll=1e-9), "rtoll", "rtol"),
        (lambda: ONE.ensemble(positon=np.zeros((2, 1, 3))), "positon", "position"),
        (lambda: ONE.ensemble(position=np.zeros((2, 1, 3))).run(t=1.0, max_step_=1), "max_step_", "max_step"),
        (lambda: vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), t=0.0), "t", "t0"),
        (lambda: vv.Particles(mas=[1.0], position=[[0, 0, 0]]), "mas", "mass"),
        (lambda: vv.Particles([1.0], [[0, 0, 0]], velocities=[[0, 0, 0]]), "velocities", "velocity"),
        (lambda: vv.Gravity(g=1.0), "g", "G"),
        (lambda: vv.UniformField(G=[0, 0, -1]), "G", "g"),
        (lambda: vv.CentralField(vv.potentials.Coulomb(1.0), centre=[0, 0, 0]), "centre", "center"),
        (lambda: vv.potentials.Coulomb(kk=1.0), "kk", "k"),
        (lambda: replace(vv.potentials.Coulomb(1.0), kk=1.0), "kk", "k"),
        (lambda: vv.potentials.Yukawa(k=1.0, lenght=2.0), "lenght", "length"),
        (lambda: vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), energy=1.0), "energy", "beam_energy"),
        (lambda: vv.orbits.state(1.0, pericentre=1.0, eccentricity=0.0), "pericentre", "pericenter"),
    ],
)
def test_the_nearest_name_is_suggested(call: Callable[[], object], came: str, meant: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        call()
    assert caught.value.argument == came
    assert str(caught.value).endswith(f"; did you mean '{meant}'?")


@pytest.mark.parametrize(
    "call",
    [
        lambda: ONE.run(t=1.0, heartbeat=print),
        lambda: vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], progress=True),
        lambda: vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), gravity=1.0),
    ],
)
def test_letters_that_are_shared_by_chance_make_no_name_near(call: Callable[[], object]) -> None:
    with pytest.raises(vv.UnknownKeyword) as caught:
        call()
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize(
    ("call", "cure"),
    [
        (lambda: ONE.run(t_end=1.0), "give the end, or the output times, as t"),
        (lambda: vv.Particles(m=[1.0], position=[[0, 0, 0]]), "give it as mass"),
        (lambda: vv.Particles([1.0], pos=[[0, 0, 0]]), "give it as position"),
        (lambda: vv.Particles([1.0], [[0, 0, 0]], v=[[0, 0, 0]]), "give it as velocity"),
        (lambda: vv.Particles([1.0], x=[[0, 0, 0]]), "give positions as position"),
    ],
)
def test_a_name_from_elsewhere_leads_to_ours(call: Callable[[], object], cure: str) -> None:
    with pytest.raises(vv.UnknownKeyword, match=cure):
        call()


def test_a_keyword_that_is_no_text_is_refused_like_any_other() -> None:
    with pytest.raises(vv.UnknownKeyword, match="expected a keyword of run"):
        ONE.run(t=1.0, **{"\ud800": 1})


def test_it_is_the_error_that_programs_catch() -> None:
    for kind in (TypeError, ValueError, vv.Error, vv.InvalidInput):
        with pytest.raises(kind, match="metod"):
            ONE.run(t=1.0, metod="rk4")  # type: ignore[call-arg]


def test_checked_classes_pickle_and_copy_with_changes() -> None:
    yukawa = vv.potentials.Yukawa(k=1.0, length=2.0)
    assert pickle.loads(pickle.dumps(yukawa)) == yukawa
    assert replace(yukawa, length=3.0) == vv.potentials.Yukawa(1.0, 3.0)
    assert replace(vv.Gravity(1.0), softening=0.5) == vv.Gravity(1.0, 0.5)
    assert pickle.loads(pickle.dumps(vv.scattering.monte_carlo)) is vv.scattering.monte_carlo
