"""What a notebook shows of an object is a table whose texts are escaped; completion shows public names alone."""

import importlib
import inspect
import pkgutil
import re
from enum import Enum
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva._body_force import BodyForce
from visviva._html import Shown

MODULES = ["visviva", *(found.name for found in pkgutil.walk_packages(vv.__path__, "visviva."))]
PUBLIC = [name for name in MODULES if not any(part.startswith("_") for part in name.split("."))]


class Balanced(HTMLParser):
    """The texts of well-formed HTML, and which tags there are."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: set[str] = set()
        self.texts: list[str] = []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, _: Any) -> None:
        self.open.append(tag)
        self.tags.add(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def things() -> dict[str, Any]:
    """One of each kind that a notebook may show."""
    bodies = vv.Particles(
        [1.0, 1e-3, 0.0], [[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 0], [0, 1, 0], [0, 0.7, 0]], names=["a", "b", "c"]
    )
    scene = vv.Scene(bodies, vv.Gravity(G=1.0))
    copies = scene.ensemble(velocity=bodies.velocity * np.array([1.0, 0.9])[:, None, None])
    run = scene.run(t=[0.0, 1.0, 9.0], events=[vv.events.apsis("b", "a")])
    handle = vv.RigidBodies([1.0], moments=[[1.0, 2.0, 3.0]], angular_velocity=[[0.1, 1.0, 0.1]])
    balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    pendulum = vv.systems.pendulum()
    pendulums = pendulum.ensemble(position=[[0.1], [0.2]])
    beam = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=2.0, n_events=100, seed=1
    )
    problem = vv.problems.kepler(e=0.5)
    each = [
        bodies, scene, scene.plan(t=1.0), copies, copies.run(t=1.0), run, run.events, run.conservation(),
        run.elements(about="a"), scene.invariants(), handle, vv.Scene(handle).run(t=1.0), problem,
        scene.megno(t=5.0), copies.megno(t=[1.0, 2.0]),
        vv.Scene(balls).run(t=4.0, collisions="bounce").collisions, pendulum, pendulum.hamiltonian(),
        pendulum.plan(t=1.0), pendulum.run(t=1.0), pendulums, pendulums.run(t=1.0), beam,
        pendulums.run(t=1.0, events=["theta"]).events,
        vv.RigidBodies([1.0], inertia=np.eye(3)[None]),
        vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0]),
        *records(), *motions(), *systems(), *answers(), *beams(),
    ]  # fmt: skip
    return {f"{type(thing).__name__} {index}": thing for index, thing in enumerate(each)}


def records() -> list[Any]:
    """Results that are fields, of many numbers."""
    sun, many = vv.potentials.Coulomb(-1.0), np.linspace(1.0, 2.0, 500)
    places = np.column_stack([many, many, many])
    hard = {"beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 1.0, "n_events": 100, "seed": 1}
    run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), tally=["cm_angle", ("lab_angle", "energy")], **hard)
    foil = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7e6, n_events=10, seed=1)
    counts, spin = vv.datasets.geiger_marsden_1913(), vv.datasets.toutatis()
    return [
        vv.orbits.radial_motion(sun, energy=-0.5, angular_momentum=0.4 * many),
        vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0]),
        vv.collisions.elastic(1.0, 2.0, places, [0.0, 0.0, 0.0], normal=[1, 0, 0]),
        vv.audit.curl(vv.Harmonic(1.0), places), vv.scattering.moderation(mass_ratio=many),
        vv.systems.henon_heiles().poincare("x", t=50.0), vv.systems.coupled_oscillators().normal_modes(),
        run["cm_angle"], run["lab_angle", "energy"], foil["transmitted_angle"],
        counts, counts.compare()[0], spin, spin.radar, spin.compare(),
        vv.scattering.deflect(vv.potentials.Yukawa(1.0, 1.0), energy=1.0, impact_parameter=many),
    ]  # fmt: skip


def motions() -> list[Any]:
    """Parts of runs, and what is told of bodies that turn, orbit or are thrown."""
    book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0], name="book")
    turned = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 50))["book"]
    top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    sun, times = vv.potentials.Coulomb(-1.0), np.linspace(0.0, 3.0, 301)
    return [
        turned, turned.turning, vv.rigid.free_rotation([1, 2, 3], [0.1, 1.0, 0.1], times),
        vv.rigid.polhode([1, 2, 3], [0.1, 1.0, 0.3]), vv.rigid.sphere(2.0, 0.1),
        top, top.solve(times, theta=0.3, psi_dot=50.0), top.nutation(0.3, psi_dot=50.0),
        vv.drag.throw(speed=12.0, g=9.80665, tau=1.75), vv.datasets.solar_system(), vv.datasets.outer_solar_system(),
        vv.orbits.circular_orbit(sun, 1.0), vv.orbits.conic(1.0, 1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0]),
        vv.orbits.precessing_conic(1.0, 1.0, 0.1, position=[1.0, 0, 0], velocity=[0.0, 1.1, 0.0]),
        *vv.orbits.range_of_motion(sun, energy=-0.5, angular_momentum=0.6),
    ]  # fmt: skip


def systems() -> list[Any]:
    """What is told of systems in generalized coordinates."""
    free = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"])
    plane = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"])
    swing = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0]).run(t=np.linspace(0.0, 4.0, 81))
    return [
        vv.systems.pendulum().equations,
        *vv.systems.pendulum().equilibria(), free.action(([0.0, 2.0], [0.0, 1.0])), free.legendre_transform(),
        free.discrete_action((np.arange(50.0), np.arange(50.0))), free.noether(lambda q, v, t: [1.0]), swing.stats,
        plane.is_canonical(lambda q, p, t: [2 * q[0], p[0]]), swing.system.accessory_problem(swing),
    ]  # fmt: skip


def answers() -> list[Any]:
    """What is told of runs before and after them, of methods, and of any equation."""
    problem = vv.problems.kepler(e=0.5)
    advice = problem.scene.advise(t=10.0, accuracy=1e-6)
    plan = problem.scene.plan(t=1.0, method="leapfrog", dt=0.01)
    points = [vv.Point("rk4", 0.1 / k, 1e-3 * k, 1e-3 / k**4, 1e-3 / k**4) for k in range(1, 20)]
    report = vv.stress.run(["dop853"], cases=["two bodies in one place"])
    decay = vv.solve_ivp(lambda t, y: -y, (0.0, 5.0), np.ones(20), dense_output=True)
    run = problem.scene.run(t=1.0, method="leapfrog", dt=0.01)
    along = np.zeros((2, 2, 3))
    kept = problem.scene.ensemble(position=problem.scene.particles.position[None]).run(t=1.0).conservation()
    return [
        kept, *kept.rows,
        advice, *advice.options, plan.cost(), run.stats, run.conservation().energy, points[0],
        vv.WorkPrecision("kepler", tuple(points)), report, *report.verdicts, decay, decay.sol, problem.references[-1],
        vv.audit.third_law([[0, 0, 0], [1.0, 0, 0]], along), *vv.methods(), vv.events.apsis(1, 0), vv.units.SI,
    ]  # fmt: skip


def beams() -> list[Any]:
    """What comes and what it meets, and marks of a deflection function."""
    s, well = vv.scattering, vv.potentials.LennardJones(1.0, 1.0)
    many = np.linspace(1.0, 2.0, 500)
    lines, strata = s.Spectrum(many, many), s.Strata(many - 1.0)
    run = s.monte_carlo(
        vv.potentials.HardSphere(1.0), beam_energy=lines, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1,
        importance=strata,
    )  # fmt: skip
    foil = s.Foil("gold", 0.4).run("alpha", beam_energy=7e6, n_events=10, seed=1)
    return [
        lines, strata, run, run.beam, foil, foil.bombardment, foil.bombardment.foil, foil.bombardment.foil.material,
        foil.bombardment.ion, s.Spread.gaussian(0.01), s.Bins.linear(4), s.LargeAngles(0.1),
        s.Channel(q_value=-1.5, probability=(many, many - 1.0)),
        *s.rainbows(well, energy=10.0), *s.glories(well, energy=10.0),
        *s.orbiting(vv.potentials.PowerLaw(-1.0, 4), energy=1.0),
    ]  # fmt: skip


THINGS = things()


@pytest.mark.parametrize("name", THINGS)
def test_html_is_well_formed_and_text_is_short(name: str) -> None:
    shown = Balanced(THINGS[name]._repr_html_())
    assert shown.tags <= {"table", "caption", "thead", "tbody", "tr", "th", "td", "p", "pre"}
    assert any(text.strip() for text in shown.texts)
    text = repr(THINGS[name])
    assert "\n" not in text
    assert len(text) <= 300
    assert " object at 0x" not in text


def public_classes() -> dict[str, type]:
    """Those that a room shows, by name; no errors, enumerations, named tuples and types to annotate with."""
    rooms = [vv, *(getattr(vv, room) for room in vv._ROOMS)]
    found = {f"{room.__name__}.{name}": getattr(room, name) for room in rooms for name in room.__all__}
    return {
        name: kind
        for name, kind in found.items()
        if isinstance(kind, type)
        and not issubclass(kind, BaseException | Enum | tuple)
        and kind.__module__ != "visviva.typing"
    }


#: Arguments that print as the calls that make them, and the numbers of a system that is being written down.
PARTS = (vv.forces.Force, vv.potentials.Potential, BodyForce, vv.generalized.Expression)
SHOWN = {name: kind for name, kind in public_classes().items() if not issubclass(kind, PARTS)}


@pytest.mark.parametrize("name", SHOWN)
def test_every_public_class_is_shown_and_tried(name: str) -> None:
    kind = SHOWN[name]
    assert issubclass(kind, Shown)
    assert any(type(thing) is kind for thing in THINGS.values()) or kind.__subclasses__()


def test_a_report_shows_what_failed_or_how_many_did_what() -> None:
    fine = vv.stress.Verdict("two bodies", "rk4", "ok", "", 1e-9, 1e-12, 0.01)
    bad = vv.stress.Verdict("a <wall>", "dop853", "FAILED", "hangs", 1.0, 1.0, 99.0)
    assert [*Balanced(vv.stress.Report([fine, fine])._repr_html_()).texts] == ["2 verdicts, 0 failed", "ok", "2"]
    texts = Balanced(vv.stress.Report([fine, bad])._repr_html_()).texts
    assert texts[0] == "2 verdicts, 1 failed"
    assert {"a <wall>", "dop853", "FAILED"} <= set(texts)
    assert "two bodies" not in texts


def test_an_expression_tells_what_it_is() -> None:
    seen: list[Any] = []
    vv.Lagrangian(lambda q, v, t: seen.extend([q[0], v[0] ** 2]) or v[0] ** 2, ["x"])
    assert [repr(each) for each in seen[:2]] == ["Expression(variable)", "Expression(power)"]


def test_names_of_bodies_are_escaped() -> None:
    bodies = vv.Particles([1.0], [[0.0, 0.0, 0.0]], names=["<script>alert('x')</script> & co"])
    for thing in (bodies, vv.Scene(bodies), vv.Scene(bodies).run(t=1.0)):
        text = thing._repr_html_()
        assert "<script" not in text
        assert "alert(" in "".join(Balanced(text).texts)


def test_long_tables_are_cut_and_say_so() -> None:
    shown = vv.Particles(np.ones(100), np.zeros((100, 3)))._repr_html_()
    assert shown.count("<tr>") == 13
    assert "and 88 more" in shown


#: A word of what is inside.
INSIDE = {"core"}
#: They refuse, whatever they are given.
NO_EXAMPLE = {"CompiledTorque.rotated", "CompiledTorque.rescaled"}


def ours(kind: type, name: str) -> bool:
    """Whether a name of a class is not one of Python's own, as ``items`` of a mapping is."""
    return next(each for each in kind.__mro__ if name in vars(each)).__module__.startswith("visviva")


def is_explained(kind: type, name: str) -> bool:
    """Whether a name is one that people find in the reference: with an example, or among the attributes."""
    value = inspect.getattr_static(kind, name, None)
    told = inspect.getdoc(value) or ""
    if isinstance(value, property):
        return bool(told)
    if inspect.isroutine(getattr(value, "__func__", value)) and not inspect.ismemberdescriptor(value):
        return ">>>" in told or f"{kind.__name__}.{name}" in NO_EXAMPLE
    lines = "\n".join(each.__doc__ or "" for each in kind.__mro__ if each.__module__.startswith("visviva"))
    return re.search(rf"(?m)^ *(\w+, )*{name}\b", lines) is not None


@pytest.mark.parametrize("name", public_classes())
def test_completion_of_a_class_shows_public_names_alone(name: str) -> None:
    kind = public_classes()[name]
    shown = [each for each in dir(kind) if not each.startswith("_") and ours(kind, each)]
    assert [each for each in shown if not is_explained(kind, each) or INSIDE & set(each.split("_"))] == []


@pytest.mark.parametrize("name", THINGS)
def test_completion_of_an_object_shows_public_names_alone(name: str) -> None:
    thing, kind = THINGS[name], type(THINGS[name])
    more = {each for each in dir(thing) if not each.startswith("_")} - set(dir(kind))
    assert [each for each in more if not is_explained(kind, each) or INSIDE & set(each.split("_"))] == []


@pytest.mark.parametrize("name", PUBLIC)
def test_completion_shows_public_names_alone(name: str) -> None:
    module = importlib.import_module(name)
    shown = set(dir(module))
    assert shown - {"__version__"} == set(module.__all__)
    assert not any(each.startswith("_") for each in module.__all__)
    assert all(hasattr(module, each) for each in module.__all__)


def public_named_tuples() -> list[type[Any]]:
    rooms = [vv, *(getattr(vv, room) for room in vv._ROOMS)]
    kinds = [getattr(room, name) for room in rooms for name in room.__all__]
    return [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, tuple) and hasattr(kind, "_fields")]


@pytest.mark.parametrize("kind", public_named_tuples(), ids=lambda kind: kind.__name__)
def test_named_tuples_are_short_in_words(kind: Any) -> None:
    """In one line with their names, however many numbers they hold."""
    text = repr(kind(*(np.arange(3000.0).reshape(1000, 3) for _ in kind._fields)))
    assert text.startswith(f"{kind.__name__}({kind._fields[0]}=")
    assert "<(1000, 3) from 0 to 2999>" in text
    assert "\n" not in text
    assert len(text) <= 300


def test_there_are_named_tuples() -> None:
    assert len(public_named_tuples()) >= 7
