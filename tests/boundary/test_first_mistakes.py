"""What somebody new gets wrong is refused at once, by name, with what to write instead."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva._attributes_elsewhere import OF_RUNS, OF_SCENES
from visviva._elsewhere import OF_KEYWORDS
from visviva._names_elsewhere import ANSWERS, IN_ROOMS

PAIR = vv.Particles([1.0, 1.0], [[-1.0, 0, 0], [1.0, 0, 0]], [[0, -0.5, 0], [0, 0.5, 0]])
ORBIT = vv.Scene(PAIR, vv.Gravity(G=1.0))
BOOK = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.01, 2.0, 0.0]))


@pytest.mark.parametrize("argument", ["potential", "force", "acceleration"])
def test_a_parameter_that_was_not_given_is_asked_for(argument: str) -> None:
    def formula(position: Any, velocity: Any, t: Any, k: Any) -> Any:
        return k * position[0] ** 2 if argument == "potential" else [-k * each for each in position]

    with pytest.raises(
        vv.InvalidInput, match=r"^parameters: expected a value of 'k'.*pass parameters={'k': "
    ) as caught:
        vv.ExpressionForce(**{argument: formula})
    assert argument in str(caught.value)


@pytest.mark.parametrize("scene", [ORBIT, BOOK])
def test_both_ways_of_an_event_function_are_shown(scene: vv.Scene) -> None:
    with pytest.raises(vv.InvalidInput, match=r"^events: events\[1\].*as f\(t, position, velocity\)") as caught:
        scene.run(t=1.0, events=[vv.events.energy(0.0), lambda t: t - 0.5])
    assert "rigid bodies as f(t, position, velocity, orientation, angular_velocity)" in str(caught.value)


def test_what_an_event_function_raises_says_which_one_it_was() -> None:
    def far(t: float, position: Any, velocity: Any) -> float:
        return float(position[7, 0])

    def turned(t: float, position: Any, velocity: Any, orientation: Any, angular_velocity: Any) -> float:
        raise KeyError("turned")

    runs: list[tuple[Any, type[Exception], list[Any], str]] = [
        (ORBIT, IndexError, [lambda t, r, v: r[0, 0], far], r"events\[1\].*far"),
        (ORBIT, IndexError, [vv.events.function(far)], r"events\[0\].*far"),
        (BOOK, KeyError, [turned], r"events\[0\].*turned"),
        (vv.systems.pendulum(position=[0.1]), IndexError, ["theta", vv.events.function(far)], r"events\[1\].*far"),
    ]
    for asked, kind, events, note in runs:
        with pytest.raises(kind) as caught:
            asked.run(t=1.0, events=events)
        assert caught.type is kind
        (told,) = caught.value.__notes__
        assert re.search(note, told)
        assert told.endswith("at t = 0.0")


def test_a_result_keeps_the_name_of_a_function() -> None:
    def apart(t: float, position: Any, velocity: Any) -> float:
        return float(position[1, 0] - position[0, 0])

    found = ORBIT.run(t=10.0, events=[apart]).events
    assert str(dict(found.definitions[0].parameters)["name"]).endswith("apart")


@pytest.mark.parametrize(
    ("argument", "make"),
    [
        ("mass", lambda: vv.Particles(["1 kg"], [[0.0, 0, 0]])),
        ("position", lambda: vv.Particles([1.0], [["5 km", 0, 0]])),
        ("position", lambda: vv.Particles([1.0], np.array([["5 km", 0, 0]], dtype=object))),
        ("G", lambda: vv.Gravity(G="6.67e-11 m3/(kg s2)")),  # type: ignore[arg-type]
        ("g", lambda: vv.UniformField([0, 0, "-9.81m/s²"])),
        ("l", lambda: vv.systems.pendulum(l="1 m")),  # type: ignore[arg-type]
        ("moments", lambda: vv.RigidBody(1.0, ["1 kg m2", 1, 1])),
        ("dt", lambda: ORBIT.run(t=1.0, dt="1e-3 s")),  # type: ignore[arg-type]
        ("t", lambda: ORBIT.run(t="5 µs")),
        ("value", lambda: vv.events.energy("3 J")),  # type: ignore[arg-type]
    ],
)
def test_units_are_left_out_of_numbers(argument: str, make: Callable[[], object]) -> None:
    with pytest.raises(vv.InvalidInput, match=r"leave the unit of '.*' out .* plain numbers.*vv\.units") as caught:
        make()
    assert caught.value.argument == argument


@pytest.mark.parametrize("text", ["1e5", "-3", "1_000", "north", ".5e-3"])
def test_texts_without_a_unit_are_told_of_none(text: str) -> None:
    with pytest.raises(vv.InvalidInput, match="expected real numbers, got a str") as caught:
        vv.Gravity(G=text)  # type: ignore[arg-type]
    assert "unit" not in str(caught.value)


@pytest.mark.parametrize(
    ("argument", "force"),
    [
        ("charge", vv.Coulomb(charge=[1.0, 1.0, 1.0], k=1.0)),
        ("charge", vv.UniformMagneticField([0.0, 0.0, 1.0], charge=[1.0, 1.0, 1.0])),
        ("charge", vv.UniformElectricField([0.0, 0.0, 1.0], charge=[1.0, 1.0, 1.0])),
        ("coefficient", vv.QuadraticDrag([0.1, 0.1, 0.1])),
    ],
)
def test_numbers_of_bodies_that_are_not_there_are_refused(argument: str, force: vv.forces.Force) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: expected .*2 bodies, got 3"):
        vv.Scene(PAIR, force).plan(t=0.1)
    third = vv.RigidBody(1.0, [1.0, 1.0, 1.0], position=[0.0, 3.0, 0.0])
    assert vv.Scene(PAIR, third, force).run(t=0.1).status == vv.Status.OK


def test_sums_of_loads_and_of_rigid_bodies_say_what_to_write() -> None:
    drag, motor = vv.RotationalDrag(0.5), vv.AppliedTorque([0.0, 0.0, 2.0])
    sums: tuple[Callable[[], Any], ...] = (lambda: drag + motor, lambda: sum([drag, motor]), lambda: motor + 1.0)
    for added in sums:
        with pytest.raises(TypeError, match=r": forces on rigid bodies are not added; give a scene a list of them"):
            added()
    # Along a principal axis of moment 2, I dω/dt = M − c ω: ω = (M/c) (1 − exp(−c t/I)).
    body = vv.RigidBody(1.0, [1.0, 1.0, 2.0])
    spin = vv.Scene(body, [drag, motor]).run(t=1.0, rtol=1e-12).angular_velocity[-1, 0, 2]
    # One thousandfold of rtol for steps that add up; nothing is compared with 0.
    assert spin == pytest.approx(4.0 * (1.0 - np.exp(-0.25)), rel=1e-9, abs=0)
    with pytest.raises(TypeError, match=r"^RigidBodies are not added; give a scene a list of them"):
        body + body
    assert len(vv.Scene([body, body]).particles) == 2


def test_a_force_without_a_potential_is_told_beside_the_drift_of_the_energy() -> None:
    by_components = vv.ExpressionForce(force=lambda r, v, t: [-each for each in r])
    by_potential = vv.ExpressionForce(potential=lambda r, v, t: 0.5 * (r[0] ** 2 + r[1] ** 2 + r[2] ** 2))
    told, silent = (vv.Scene(PAIR, force).run(t=1.0).conservation() for force in (by_components, by_potential))
    assert (told.without_potential, told.energy.conserved) == (1, False)
    assert "ExpressionForce(potential=…)" in str(told)
    assert "ExpressionForce(potential=…)" in told._repr_html_()
    assert (silent.without_potential, silent.energy.conserved) == (0, True)
    assert "ExpressionForce" not in str(silent)


def test_a_plan_whose_steps_are_those_of_events_alone_expects_no_number_of_them() -> None:
    """Without its events a free body has a closed form, so a trial has no step; the run has."""
    events = [lambda t, r, v, q, w: q[0, 0]]
    plan = BOOK.plan(t=10.0, events=events)
    assert not plan.closed_form
    assert plan.cost() is None
    assert "steps: 0" not in str(plan)
    assert BOOK.run(t=10.0, events=events).stats.steps > 0
    without = BOOK.plan(t=10.0).cost()
    assert without is not None
    assert without.steps == 0


SOLID = vv.rigid.box(2.0, 0.1, 0.4, 0.9)
EARTH = {"Gravity": {"G": [1.0, 2.0]}}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: ORBIT.run(t=1.0, events=vv.events.apsis), r"events: events\[0\]: expected an event.*call apsis\(…\)"),
        (lambda: ORBIT.run(t=1.0, events="apsis"), "events: expected a list of events, got str"),
        (lambda: ORBIT.run(t=1.0, collisions=True), "collisions: expected one of merge, bounce, stop, got True"),
        (ORBIT.run, r"t: .*got none; give it as run\(t=10.0\)"),
        (lambda: ORBIT.run(t=1.0, steps=100), r"steps: .*; give output times as t, as np\.linspace"),
        (vv.Gravity, r"G: .*got none; give it as Gravity\(1\.0\).*vv\.units\.SI\.G"),
        (lambda: vv.UniformField(-9.81), r"g: expected shape \(3,\), got \(\); give its three components"),
        (lambda: vv.Scene(PAIR, vv.Gravity), r"parts: .*got the class Gravity; make one of it: Gravity\(…\)"),
        (lambda: vv.Scene(PAIR, lambda r: r), r"parts: .*got a function; a force by a formula is ExpressionForce"),
        (lambda: ORBIT.ensemble(parameters=EARTH["Gravity"]), r"parameters: .*: {'Gravity': {'G': values}}"),
        (lambda: ORBIT.ensemble(parameters={"gravity": EARTH["Gravity"]}), "parameters: .*did you mean 'Gravity'"),
        (lambda: vv.ExpressionForce(potential="x**2"), r"potential: expected a function or.*sympy\.sympify"),
        (lambda: vv.RigidBody(SOLID), r"mass: .* give mass=solid\.mass, inertia=solid\.tensor"),
        (lambda: vv.RigidBody(2.0, SOLID), r"moments: .* give mass=solid\.mass, inertia=solid\.tensor"),
        (lambda: vv.RigidBody(2.0, inertia=[1.0, 1.0, 1.0]), "inertia: .*; give principal moments as moments"),
        (lambda: vv.RigidBody(2.0, inertia=[[1.0], [1.0, 1.0]]), "inertia: expected an array of real numbers"),
        (
            lambda: vv.RigidBody(2.0, [1, 1, 1], orientation=np.eye(3)),
            r"orientation: .*quaternion_from_matrix makes one",
        ),
        (
            lambda: vv.RigidBody(2.0, [1, 1, 1], orientation=[0, 0, 1]),
            r"orientation: .*quaternion_from_euler makes one",
        ),
        (lambda: vv.RigidBody(2.0, [1, 1, 1], omega=[0, 0, 1]), "omega: .*; give it as angular_velocity"),
    ],
)
def test_what_is_meant_is_told(wrong: Callable[[], object], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match="^" + message):
        wrong()


def test_what_the_cures_name_does_what_was_meant() -> None:
    """As they are written in messages: the same body by its solid, the same turn by its matrix or its angles."""
    body = vv.RigidBody(mass=SOLID.mass, inertia=SOLID.tensor)
    assert body.moments is None
    assert np.array_equal(body.inertia[0], SOLID.tensor)
    turn = vv.rigid.quaternion_from_euler([0.0, 0.0, np.pi / 2])
    # Of a quarter turn each component is 0 or the root of 1/2, some roundings off.
    assert np.abs(turn) == pytest.approx([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)], rel=1e-15, abs=1e-16)
    again = vv.rigid.quaternion_from_matrix(vv.rigid.matrix(turn))
    # A rotation has two quaternions.
    assert abs(again @ turn) == pytest.approx(1.0, rel=1e-15, abs=0)
    assert len(ORBIT.ensemble(parameters=EARTH)) == 2


def test_what_is_no_coordinate_is_told_from_one_and_from_a_column() -> None:
    system = vv.systems.pendulum()
    out, copies = system.run(t=1.0), system.ensemble(position=[[0.1], [0.2]]).run(t=1.0)
    for run in (out, copies):
        with pytest.raises(vv.InvalidInput, match=r"no coordinate 'energy'; there are \['theta'\]; it is out\.energy$"):
            run["energy"]
        with pytest.raises(vv.InvalidInput, match=r"no coordinate 'thta'; .*; did you mean 'theta'\?$"):
            run["thta"]
    with pytest.raises(vv.InvalidInput, match=r"no coordinate theta\(t\); .*; give its name, out\['theta'\]$"):
        out[vv.coordinate("theta")]


def test_a_function_in_the_place_of_a_torque_is_told_where_it_goes() -> None:
    with pytest.raises(vv.InvalidInput, match=r"^torque: expected three numbers, got a function; .*vv\.CompiledTorque"):
        vv.AppliedTorque(lambda t: [0.0, 0.0, t])  # type: ignore[arg-type]


def test_what_is_told_to_be_called_otherwise_is_so() -> None:
    """None of these names is one of visviva's, which would never come to be told."""
    out = ORBIT.run(t=1.0)
    for name, told in OF_RUNS.items():
        assert not hasattr(type(out), name)
        with pytest.raises(AttributeError, match=re.escape(f"; it is {told}")):
            getattr(out, name)
    for name, told in OF_SCENES.items():
        with pytest.raises(AttributeError, match=re.escape(told)):
            getattr(ORBIT, name)
    for names, told in ANSWERS.items():
        for name in names:
            with pytest.raises(AttributeError, match=re.escape(told)):
                getattr(vv, name)
    for room, answers in IN_ROOMS.items():
        for name, told in ((name, told) for names, told in answers.items() for name in names):
            with pytest.raises(AttributeError, match=re.escape(told)):
                getattr(getattr(vv, room), name)
    of_scenes = {"run": ORBIT.run, "ensemble": ORBIT.ensemble, "Particles": vv.Particles, "RigidBody": vv.RigidBody}
    for (called, keyword), told in OF_KEYWORDS.items():
        if called in of_scenes:
            with pytest.raises(vv.UnknownKeyword, match=re.escape(told)):
                of_scenes[called](**{keyword: 1.0})


def test_expressions_of_what_is_told_are_those_of_the_run() -> None:
    out = BOOK.run(t=[1.0])
    assert eval(OF_RUNS["rotation"], {"vv": vv, "out": out}).shape == (1, 1, 3, 3)
    pair = ORBIT.run(t=[0.0])
    assert eval(OF_RUNS["distance"], {"np": np, "out": pair}).tolist() == [2.0]
