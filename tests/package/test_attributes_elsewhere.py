"""Answers to attributes of elsewhere: whatever an answer names is there, and what was asked for is not.

Every word of an answer is a name that resolves, with what calls of it give, or one of the plain words below: a name
that is misspelled or gone is neither.
"""

from __future__ import annotations

import inspect
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _attributes_elsewhere

RUN = vv.problems.kepler(e=0.5).scene.run(t=1.0, events=[vv.events.apsis(1, 0)])
SWING = vv.systems.pendulum().run(t=1.0)
BODY = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 2.0, 0.0])
TURNING = vv.Scene(BODY).run(t=0.0)
SOLID = vv.rigid.box(1.0, 1.0, 2.0, 3.0)

HOLDERS: list[tuple[object, dict[str, str]]] = [
    (RUN, _attributes_elsewhere.OF_RUNS),
    (RUN.events, _attributes_elsewhere.OF_TABLES),
    (RUN.scene.particles, _attributes_elsewhere.OF_PARTICLES),
    (BODY, _attributes_elsewhere.OF_BODIES),
    (SOLID, _attributes_elsewhere.OF_SOLIDS),
    (vv.rigid.HeavyTop(A=1.0, C=0.5, mass=1.0, g=9.8, R=0.5), _attributes_elsewhere.OF_TOPS),
    (
        vv.scattering.deflect(vv.potentials.Coulomb(1.0), energy=1.0, impact_parameter=1.0),
        _attributes_elsewhere.OF_DEFLECTIONS,
    ),
    (vv.potentials.Yukawa(1.0, 2.0), _attributes_elsewhere.OF_POTENTIALS),
    (SWING.system, _attributes_elsewhere.OF_SYSTEMS),
    (RUN.scene, _attributes_elsewhere.OF_SCENES),
]
OF_CLASS = [type(of).__name__ for of, _ in HOLDERS]
# What is no attribute: an expression, or what is known elsewhere.
NO_ATTRIBUTE = ("vv.", "np.", "len(", "known of ", "a scene ")


@pytest.mark.parametrize(("of", "answers"), HOLDERS[:-1], ids=OF_CLASS[:-1])
def test_what_is_told_of_an_attribute_is_there_and_the_attribute_is_not(of: object, answers: dict[str, str]) -> None:
    known = (RUN, TURNING, SWING) if of is RUN else (of, vv.systems.henon_heiles()) if of is SWING.system else (of,)
    for name, told in answers.items():
        assert not hasattr(of, name)
        first = re.match(r"\w+", told)
        assert first
        assert told.startswith(NO_ATTRIBUTE) or any(first[0] in dir(each) for each in known)
        if told.startswith(NO_ATTRIBUTE) or hasattr(type(of), first[0]):
            with pytest.raises(AttributeError, match=rf"has no attribute '{name}'; it is {re.escape(told)}$"):
                getattr(of, name)


def test_a_scene_tells_what_takes_the_place_of_what_it_has_not() -> None:
    for name, told in _attributes_elsewhere.OF_SCENES.items():
        with pytest.raises(AttributeError, match=rf"has no attribute '{name}'; {re.escape(told)}$"):
            getattr(RUN.scene, name)


# What answers say beside names.
WORDS = frozenset(
    re.findall(
        r"\w+",
        """
        L N a all an and argument as asked at between bodies both by change copy cost degrees do does each
        end ends event expressions for force from go has impact is it its known largest little looks make
        makes masses more needs new no not notebook of on one or other outputs parameters parts pictures run
        runs saved set shape shows sign so stays step takes tests that the there time times to velocities w
        way what where with x y yours z
        """,
    )
)
# Arguments that anybody may choose.
CHOSEN = frozenset({"path", "which", "another", "body"})
CHAIN = re.compile(r"[A-Za-z_]\w*(?:\([^()]*\)|\[[^\[\]]*\]|\.[A-Za-z_]\w*)*")
PART = re.compile(r"\.([A-Za-z_]\w*)|\(([^()]*)\)|\[([^\[\]]*)\]")
SCENE = RUN.scene
OF_SYSTEM = (vv.systems.henon_heiles(), vv.systems.double_pendulum().equilibria()[0])
#: What is given by calls in answers, by the last name before them.
GIVEN: dict[str, Any] = {
    "run": RUN,
    "Scene": SCENE,
    "invariants": SCENE.invariants(),
    "megno": SCENE.megno(t=1.0),
    "elements": RUN.elements(1, about=0),
    "to_pandas": RUN.to_pandas(),
    "of": RUN.events,
    "principal_axes": SOLID.principal_axes(),
    "normal_modes": vv.systems.double_pendulum().normal_modes(),
    "definitions": RUN.events.definitions[0],
    "forces": SCENE.forces[0],
}
ROOTS = SimpleNamespace(vv=vv, visviva=vv, np=np, len=len, scene=SCENE, out=TURNING, particles=SCENE.particles)


def has(of: object, name: str) -> bool:
    try:
        return hasattr(of, name)
    except vv.InvalidInput:  # what is not recorded
        return False


def whole(chain: str, holders: tuple[object, ...], free: frozenset[str]) -> str | None:
    """The first name of a chain of attributes, calls and items that is nowhere; None where all are there."""
    head = re.match(r"\w+", chain)
    assert head
    name, rest = head[0], chain[head.end() :]
    if not rest and name in free:
        return None
    found: Any = next((getattr(each, name) for each in holders if has(each, name)), holders)
    if found is holders:
        return chain
    for attribute, arguments, _ in PART.findall(rest):
        if attribute:
            if not has(found, attribute):
                return chain
            name, found = attribute, getattr(found, attribute)
            continue
        if arguments:
            keywords = set(re.findall(r"(\w+)=", arguments))
            parameters = set(inspect.signature(found).parameters)
            if keywords - parameters:
                return chain
            own = free & CHOSEN | keywords | parameters
            wrong = next(filter(None, (whole(each, holders, own) for each in CHAIN.findall(arguments))), None)
            if wrong is not None:
                return wrong
        found = GIVEN.get(name, found)
    return None


def missing(told: str, *of: object) -> list[str]:
    """What an answer names that neither is there nor is a plain word."""
    return [wrong for chain in CHAIN.findall(told) if (wrong := whole(chain, (*of, ROOTS, vv), WORDS | CHOSEN))]


@pytest.mark.parametrize(("of", "answers"), HOLDERS, ids=OF_CLASS)
def test_every_name_in_an_answer_is_there(of: object, answers: dict[str, str]) -> None:
    others: dict[int, tuple[object, ...]] = {id(RUN): (TURNING, SWING), id(SWING.system): OF_SYSTEM, id(SCENE): (RUN,)}
    for name, told in answers.items():
        assert missing(told, of, *others.get(id(of), ())) == [], name


@pytest.mark.parametrize(
    ("told", "wrong"),
    [
        ("position and velocty", "velocty"),
        ("final.aceleration() where a run of a scene ends", "final.aceleration()"),
        ("it is invariants().enrgy", "invariants().enrgy"),
        ("to_pandas().to_cvs(path)", "to_pandas().to_cvs(path)"),
        ("megno(time=…).lyapunov_exponent", "megno(time=…).lyapunov_exponent"),
        ("vv.rigid.matrix(out.orientatoin)", "out.orientatoin"),
        ("a scene runs to a tmie", "tmie"),
        ("it is that of forces[0].Gee", "forces[0].Gee"),
    ],
)
def test_names_that_are_nowhere_are_found_in_answers(told: str, wrong: str) -> None:
    assert missing(told, RUN, SCENE) == [wrong]
