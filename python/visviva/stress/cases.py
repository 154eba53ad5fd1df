"""The abuse: scenes and spans that nobody should ask for, each with what is known of the answer.

The one idea: a case says what it is and what it may end as, and nothing of methods; so a method joins by being
registered, and a case by a line of `CASES`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import problems
from visviva.forces import CentralField, Gravity, LinearDrag, PairPotential, Spring, UniformField
from visviva.particles import Particles
from visviva.potentials import LennardJones, Yukawa
from visviva.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["CASES", "Case"]


@dataclass(frozen=True)
class Case:
    """A scene under abuse.

    Attributes
    ----------
    name : str
    make : callable
        Makes the scene.
    span : float
        Of the run.
    steps : float
        Steps of methods that do not choose theirs.
    closed : bool
        Whether the plan has a closed form for the scene, which the states are compared with.
    amplifies : float
        By how much the motion enlarges an error of a step, at most: bounds what adaptive methods may be off.
    most : int
        The most steps that a run may take, if it is to be stopped there.
    long : bool
        Whether it takes long, and is left out of the short form.
    """

    name: str
    make: Callable[[], Scene]
    span: float
    steps: float = 400.0
    closed: bool = False
    amplifies: float = 1e4
    most: int | None = None
    long: bool = False
    how: dict[str, Any] = field(default_factory=dict)


def _kepler(e: float, mass_ratio: float = 1.0) -> Scene:
    return problems.kepler(e=e, mass_ratio=mass_ratio).scene


def _planets(offset: float = 0.0, drift: float = 0.0, **units: float) -> Scene:
    scene = problems.outer_solar_system().scene
    bodies = scene.particles
    moved = Scene(Particles(bodies.mass, bodies.position + offset, bodies.velocity + drift), *scene.forces)
    return moved.rescaled(**units) if units else moved


def _pair(separation: float, velocity: float, *, mass: float = 1.0) -> Scene:
    """Two bodies head-on, or past each other at that impact parameter."""
    position = np.array([[-1.0, 0.5 * separation, 0.0], [1.0, -0.5 * separation, 0.0]])
    return Scene(Particles([mass, mass], position, [[velocity, 0, 0], [-velocity, 0, 0]]), Gravity(1.0))


def _oscillator(stiffness: float) -> Scene:
    """Two bodies on a spring, stretched by a tenth: angular frequency √(2k)."""
    bodies = Particles([1.0, 1.0], np.array([[0, 0, 0], [1.1, 0, 0]]), np.zeros((2, 3)))
    return Scene(bodies, Spring(0, 1, stiffness, 1.0))


def _spring_beside_field(stiffness: float) -> Scene:
    bodies = Particles([1.0, 1.0], np.array([[0, 0, 0], [1.1, 0, 0]]), np.array([[0.0, 1.0, 0], [0.0, 1.0, 0]]))
    return Scene(bodies, Spring(0, 1, stiffness, 1.0), UniformField((0, -1.0, 0)))


def _lattice(spacing: float) -> Scene:
    places = spacing * np.stack(np.meshgrid(*[np.arange(2.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return Scene(Particles(np.ones(8), places, np.zeros((8, 3))), PairPotential(LennardJones(1.0, 1.0)))


PERIOD = 2.0 * pi

CASES: list[Case] = [
    *(
        Case(f"Kepler, e = {name}", partial(_kepler, e), PERIOD, steps, closed=True, amplifies=(1 - e) ** -1.5)
        for name, e, steps in [
            ("0", 0.0, 400),
            ("0.9", 0.9, 2000),
            ("0.9999", 0.9999, 4000),
            ("1 - 1e-6", 1 - 1e-6, 4000),
            ("1 - 1e-12", 1 - 1e-12, 4000),
        ]
    ),
    Case("mass ratio 1e-15", lambda: _kepler(0.5, 1e-15), PERIOD, 1000, closed=True, amplifies=100),
    Case("mass ratio 1e-300", lambda: _kepler(0.5, 1e-300), PERIOD, 1000, closed=True, amplifies=100),
    Case("planets 1e9 AU away", lambda: _planets(offset=1e9), 1e4),
    Case("planets at 1e3 AU/d", lambda: _planets(drift=1e3), 1e4),
    Case("units of length of 1e100", lambda: _planets(length=1e100), 1e4),
    Case("units of length of 1e-100", lambda: _planets(length=1e-100), 1e4),
    Case("units of mass of 1e100", lambda: _planets(mass=1e100), 1e4),
    Case("units of time of 1e-100", lambda: _planets(time=1e-100), 1e-96),
    Case("a million orbits", lambda: _kepler(0.5), 1e6 * PERIOD, 1e8, closed=True, amplifies=1e14, long=True),
    Case("a million orbits, most steps 10000", lambda: _kepler(0.5), 1e6 * PERIOD, 1e8, most=10_000),
    Case("a span of one step", lambda: _kepler(0.5), 1e-3, 1, closed=True, amplifies=100),
    Case("a span of 1e12 steps, most 10000", _planets, 1e12, 1e12, most=10_000),
    Case("a span of 1e-300", _planets, 1e-300, 3),
    Case("a stiff spring, 1e12", lambda: _oscillator(1e12), 1e-4, 4000),
    Case("a stiff spring beside a field", lambda: _spring_beside_field(1e8), 1e-2, 4000),
    Case("a step of 0.99 of the stability limit", lambda: _oscillator(0.5), 1e3, 1e3 / 1.98, how={"fixed": True}),
    Case("a step of 1.01 of the stability limit", lambda: _oscillator(0.5), 1e3, 1e3 / 2.02, how={"fixed": True}),
    Case("a step of 100 stability limits", lambda: _oscillator(0.5), 1e5, 5e2, how={"fixed": True}),
    *(
        Case(f"passing at {b:g}", partial(_pair, b, 1.0), 3.0, 3000, closed=True, amplifies=20 / b if b else 1e300)
        for b in (1e-2, 1e-5, 1e-12, 0.0)
    ),
    Case("a fall onto a point that attracts", lambda: _fall(-1.0), 3.0, 1000),
    Case("a fall onto a point that repels", lambda: _fall(1.0), 3.0, 1000),
    Case("masses of 1e-310", lambda: _pair(0.5, 1e-155, mass=1e-310), 1e154, 1000, amplifies=1e6),
    Case("velocities of 1e-320", lambda: _with_velocity(1e-320), 1.0),
    Case("velocities of 1e300", lambda: _with_velocity(1e300), 1e3),
    Case("velocities of 1e300 until beyond float64", lambda: _with_velocity(1e300), 1e10),
    Case("atoms half as close as they like", lambda: _lattice(0.5), 1.0, 4000, amplifies=1e8),
    Case("atoms a millionth as close as they like", lambda: _lattice(1e-6), 1.0, 4000, amplifies=1e8),
    Case("drag of 1e-300", lambda: _dragged(1e-300), 1.0, closed=True, amplifies=1e6, most=10_000),
    Case("drag for 1e300 of its times", lambda: _dragged(1e-3), 1e297, closed=True, amplifies=1e6, most=10_000),
    Case("two bodies in one place", lambda: _pair_at_rest(0.0), 1.0),
    Case("two bodies a denormal apart", lambda: _pair_at_rest(1e-310), 1.0, amplifies=1e300),
    Case("nothing that moves", lambda: Scene(Particles([1.0], np.zeros((1, 3)), np.zeros((1, 3)))), 1.0, closed=True),
]


def _fall(k: float) -> Scene:
    bodies = Particles([1.0], [[1.0, 0, 0]], [[-1.0, 0, 0]])
    return Scene(bodies, CentralField(Yukawa(k=k, length=1.0)))


def _with_velocity(speed: float) -> Scene:
    bodies = problems.figure_eight().scene.particles
    return Scene(Particles(bodies.mass, bodies.position, np.full((3, 3), speed / sqrt(3.0))), Gravity(1.0))


def _dragged(tau: float) -> Scene:
    bodies = Particles([1.0], [[0, 0, 0]], [[1.0, 2.0, 0]])
    return Scene(bodies, LinearDrag(tau), UniformField((0, -1.0, 0)))


def _pair_at_rest(apart: float) -> Scene:
    return Scene(Particles([1.0, 1.0], np.array([[0, 0, 0], [apart, 0, 0]]), np.zeros((2, 3))), Gravity(1.0))


def __dir__() -> list[str]:
    return list(__all__)
