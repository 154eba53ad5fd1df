"""What a notebook shows of an object is a table whose texts are escaped; completion shows public names alone."""

import importlib
import pkgutil
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest

import visviva as vv
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
        vv.Scene(balls).run(t=4.0, collisions="bounce").collisions, pendulum, pendulum.hamiltonian(),
        pendulum.plan(t=1.0), pendulum.run(t=1.0), pendulums, pendulums.run(t=1.0), beam,
        pendulums.run(t=1.0, events=["theta"]).events,
        vv.RigidBodies([1.0], inertia=np.eye(3)[None]),
        vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0]),
        *records(),
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


def test_every_kind_that_is_shown_is_tried() -> None:
    def below(kind: type) -> set[type]:
        return {kind, *(found for child in kind.__subclasses__() for found in below(child))}

    for name in PUBLIC:
        importlib.import_module(name)
    leaves = {kind.__name__ for kind in below(Shown) if not kind.__subclasses__()}
    tried = {type(thing).__name__ for thing in THINGS.values()}
    # These print as texts by the very same way as Elements.
    assert leaves - tried == {"Advice", "CircularOrbits", "Conic", "WorkPrecision"}


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


@pytest.mark.parametrize("name", PUBLIC)
def test_completion_shows_public_names_alone(name: str) -> None:
    module = importlib.import_module(name)
    shown = set(dir(module))
    assert shown - {"__version__"} == set(module.__all__)
    assert not any(each.startswith("_") for each in module.__all__)
    assert all(hasattr(module, each) for each in module.__all__)
