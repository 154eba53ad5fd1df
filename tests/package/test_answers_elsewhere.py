"""Answers to names of elsewhere name what is there: every attribute, keyword and method in all of them."""

import copy
import inspect
import pickle
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import visviva as vv
from visviva import _attributes_elsewhere, _elsewhere, _names_elsewhere

ROOMS = [name for name in vv.__all__ if inspect.ismodule(getattr(vv, name))]
#: By kind, what was asked for and what is told.
TOLD: list[tuple[str, str]] = [
    *((f"visviva.{names[0]}", told) for names, told in _names_elsewhere.ANSWERS.items()),
    *((f"{room}.{names[0]}", told) for room, all_ in _names_elsewhere.IN_ROOMS.items() for names, told in all_.items()),
    *((f"{called}({keyword}=)", told) for (called, keyword), told in _elsewhere.OF_KEYWORDS.items()),
    *((f"{called}({missing}=) missing", told) for (called, missing), told in _elsewhere.MISSING.items()),
    *(
        (f"{table}.{name}", told)
        for table in _attributes_elsewhere.__all__
        if table.startswith("OF_")
        for name, told in getattr(_attributes_elsewhere, table).items()
    ),
]


def resolved(path: str) -> Any:
    found: Any = vv
    for part in path.split("."):
        found = getattr(found, part)
    return found


def callables(called: str) -> Iterator[Callable[..., Any]]:
    """What is called so in the package: functions and classes, and methods by their own names or qualified ones."""
    for room in (vv, *(getattr(vv, room) for room in ROOMS)):
        for name in room.__all__:
            each = getattr(room, name)
            if name == called and callable(each):
                yield each
            for method in vars(each) if isinstance(each, type) else ():
                bound = getattr(each, method)
                if callable(bound) and called in (method, getattr(bound, "__qualname__", "")):
                    yield bound
    yield from (method for method in (vv.Lagrangian.run,) if method.__qualname__ == called)


@pytest.mark.parametrize(("asked", "told"), TOLD, ids=[asked for asked, _ in TOLD])
def test_what_an_answer_names_is_there(asked: str, told: str) -> None:
    for path in re.findall(r"\b(?:visviva|vv)\.([A-Za-z_][\w.]*\w|\w)", told):
        resolved(path)
    for path, given in re.findall(r"\b(?:visviva|vv)\.([\w.]+)\(([^()]*)\)", told):
        keywords = re.findall(r"(\w+)=", given)
        if keywords:
            assert set(keywords) <= set(inspect.signature(resolved(path)).parameters), told
    # Of a scene, where an answer goes on with what it has.
    for method, given in re.findall(r"\b(?:Scene\(…\)|scene)\.(\w+)\(([^()]*)\)", told):
        known = inspect.signature(getattr(vv.Scene, method)).parameters
        assert set(re.findall(r"(\w+)=", given)) <= set(known), told
    for method in re.findall(r"method='(\w+)'", told):
        assert method in {method.name for method in vv.methods()}


@pytest.mark.parametrize("of", [*_elsewhere.OF_KEYWORDS], ids="-".join)
def test_keywords_of_elsewhere_are_none_here_and_what_takes_their_place_is_one(of: tuple[str, str]) -> None:
    called, keyword = of
    known = [set(inspect.signature(each).parameters) for each in callables(called)]
    assert known
    assert any(keyword not in names for names in known)
    told = re.match(r"give (?:it|them) as (\w+)", _elsewhere.OF_KEYWORDS[of])
    assert told is None or any(told[1] in names for names in known)


def test_names_of_elsewhere_are_none_here() -> None:
    for names in _names_elsewhere.ANSWERS:
        assert not set(names) & set(vv.__all__)
    for room, answers in _names_elsewhere.IN_ROOMS.items():
        assert not {name for names in answers for name in names} & set(getattr(vv, room).__all__)


def test_no_name_has_two_answers() -> None:
    for answers in (_names_elsewhere.ANSWERS, *_names_elsewhere.IN_ROOMS.values()):
        told: dict[str, str] = {}
        for names, each in answers.items():
            for name in names:
                key = name if len(name) < 3 else _names_elsewhere.plain(name)
                assert told.setdefault(key, each) == each, name


@pytest.mark.parametrize(
    ("name", "there"),
    [
        ("UniformGravity", "UniformField"),
        ("uniform_gravity", "UniformField"),
        ("Planet", "Particles"),
        ("Joint", "Lagrangian"),
        ("LorentzForce", "UniformMagneticField"),
        ("J2", "Oblate"),
        ("TestParticle", "mass 0"),
        ("G", "units.SI.G"),
        ("g", "UniformField"),
        ("run", "Scene"),
    ],
)
def test_names_of_physics_are_answered(name: str, there: str) -> None:
    with pytest.raises(AttributeError, match=rf"^module 'visviva' has no attribute '{name}'; .*{there}"):
        getattr(vv, name)


@pytest.mark.parametrize(
    ("room", "name", "there"),
    [
        (vv.events, "collision", r"run\(t=…, collisions=…\)"),
        (vv.events, "periapsis", "apsis.*direction=1"),
        (vv.events, "time", "give them to the run as t"),
        (vv.forces, "ExpressionForce", "it is visviva.ExpressionForce"),
        (vv.forces, "LorentzForce", "UniformMagneticField"),
        (vv.potentials, "Gravity", r"potentials\.Coulomb\(k=…\)"),
        (vv.potentials, "Spring", r"it is visviva\.potentials\.Custom"),
        (vv.potentials, "Coriolis", r"it is visviva\.RotatingFrame"),
        (vv.rigid, "Sphere", "did you mean 'sphere'"),
        (vv.systems, "elastic_pendulum", r"systems\.spring_pendulum"),
        (vv.systems, "kepler", r"systems\.central_force"),
        (vv.orbits, "kepler_equation", "eccentric_from_mean"),
        (vv.scattering, "Coulomb", r"it is visviva\.potentials\.Coulomb"),
        (vv.scattering, "cm_to_lab", "lab_angle"),
    ],
)
def test_names_of_a_room_are_answered(room: Any, name: str, there: str) -> None:
    with pytest.raises(AttributeError, match=rf"has no attribute '{name}'; .*{there}"):
        getattr(room, name)


def test_apsides_of_the_answers_are_those_that_they_are_named_after() -> None:
    """The ellipse of e = 1/2 starts at its pericenter, r = 1/2, and is at r = 3/2 half a period later."""
    scene = vv.problems.kepler(e=0.5).scene
    for direction, distance in ((1, 0.5), (-1, 1.5)):
        found = scene.run(t=7.0, events=[vv.events.apsis(1, 0, direction=direction)]).events
        first, second = found.position[0, 0], found.position[0, 1]
        # Ten roundings of a place; an apsis is where the distance changes least.
        assert ((second - first) ** 2).sum() ** 0.5 == pytest.approx(distance, rel=2e-15, abs=0)


RUN = vv.problems.kepler(e=0.5).scene.run(t=1.0, events=[vv.events.apsis(1, 0)])
SWING = vv.systems.pendulum().run(t=1.0)
BODY = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 2.0, 0.0])


@pytest.mark.parametrize(
    ("of", "name", "there"),
    [
        (RUN, "at", "position and velocity at the times asked for as t"),
        (RUN, "interpolate", "position and velocity"),
        (RUN, "method", r"plan\.method"),
        (RUN, "positions", "position"),
        (RUN, "velocities", "velocity"),
        (RUN, "y", "position and velocity"),
        (SWING, "at", "position and velocity"),
        (SWING, "positions", "position"),
        (SWING, "y", "position and velocity"),
        (SWING.system, "equations_of_motion", "equations"),
        (RUN.scene.particles, "masses", "mass"),
        (RUN.events, "time", "t$"),
        (RUN.events, "copy", "member"),
    ],
)
def test_attributes_of_results_are_answered(of: Any, name: str, there: str) -> None:
    with pytest.raises(AttributeError, match=rf"has no attribute '{name}'; it is {there}"):
        getattr(of, name)


def test_objects_that_answer_are_copied_and_pickled() -> None:
    for of in (RUN.scene.particles, RUN.events, BODY, vv.rigid.sphere(1.0, 1.0), vv.potentials.Yukawa(1.0, 2.0)):
        assert type(copy.deepcopy(of)) is type(of)
        assert type(pickle.loads(pickle.dumps(of))) is type(of)


@pytest.mark.parametrize(
    ("call", "keyword", "cure"),
    [
        (lambda: vv.Spring(0, 1, stiffness=1.0), "stiffness", "give it as k"),  # type: ignore[call-arg]
        (lambda: vv.Damper(0, 1, damping=1.0), "damping", "give it as c"),  # type: ignore[call-arg]
        (lambda: vv.AttachedSpring(0, [0, 0, 0], k=1.0), "k", "give it as stiffness"),  # type: ignore[call-arg]
        (lambda: vv.LinearDrag(gamma=1.0), "gamma", "tau = m / γ"),  # type: ignore[call-arg]
        (lambda: vv.UniformMagneticField([0, 0, 1], q=1.0), "q", "give it as charge"),  # type: ignore[call-arg]
        (lambda: RUN.scene.run(1.0, accuracy=1e-6), "accuracy", r"rtol .*advise\(t, accuracy=…\)"),  # type: ignore
        (lambda: SWING.system.run(1.0, accuracy=1e-6), "accuracy", "give rtol"),  # type: ignore[call-arg]
        (lambda: SWING.system.run(1.0, y0=[1.0]), "y0", "the system's"),  # type: ignore[call-arg]
    ],
)
def test_keywords_of_other_forces_are_answered(call: Callable[[], Any], keyword: str, cure: str) -> None:
    with pytest.raises(vv.UnknownKeyword, match=rf"^{keyword}: .*; .*{cure}"):
        call()


@pytest.mark.parametrize(
    ("method", "cure"), [("RK45", "'dormand_prince54'"), ("verlet", "'leapfrog'"), ("Radau", "'gauss16' is implicit")]
)
def test_methods_of_others_are_answered_in_generalized_coordinates(method: str, cure: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^method: {method} is none of visviva.methods\(\); {cure}"):
        SWING.system.run(t=1.0, method=method)  # type: ignore[arg-type]
