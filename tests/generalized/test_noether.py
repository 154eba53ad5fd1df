"""Noether's theorem: symmetries that textbooks know, their momenta along motions, and transformations that are none.

Bounds: residuals and what stays along a motion are sums of some ten products of numbers of size 1, 1e-14 and twice
that.
"""

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp
from by_symbols import coordinates

import visviva as vv

T = np.linspace(0.0, 6.0, 61)


def plane(potential: Callable[..., Any], **further: Any) -> vv.Lagrangian:
    start = {"position": [1.0, 0.2], "velocity": [0.3, 0.8]}
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - potential(*q, t), ["x", "y"], **(start | further)
    )


def line(L: Callable[..., Any], **further: Any) -> vv.Lagrangian:
    return vv.Lagrangian(lambda q, v, t: L(q[0], v[0], t), ["x"], **({"position": [1.1], "velocity": [0.4]} | further))


def turn(q: Any, v: Any, t: Any) -> list[Any]:
    return [-q[1], q[0]]


CENTRAL = plane(lambda x, y, t: -1 / np.sqrt(x**2 + y**2))
PAIR = vv.Lagrangian(
    lambda q, v, t: v[0] ** 2 + v[1] ** 2 / 2 - np.cosh(q[0] - q[1]),
    ["a", "b"],
    position=[0.2, 1.0],
    velocity=[1.0, -0.5],
)
MAGNETIC = vv.Lagrangian(
    lambda q, v, t: v[0] ** 2 + v[1] ** 2 + 1.5 * (q[0] * v[1] - q[1] * v[0]),
    ["x", "y"],
    position=[0.3, 0.1],
    velocity=[0.5, -0.2],
)
FALLING = line(lambda x, v, t: v**2 / 2 - 9.81 * x)
GROWING = line(lambda x, v, t: np.exp(0.3 * t) * (v**2 - 4 * x**2) / 2)
CONFORMAL = line(lambda x, v, t: v**2 / 2 - 0.7 / x**2)
DISGUISED = line(lambda x, v, t: v**2 / 2 + np.cos(x * t) * (x + t * v) + v * np.exp(-(x**2)))

Row = tuple[vv.Lagrangian, Any, Any, Callable[..., Any]]
#: System, ξ, τ, and what is conserved at (q, v, t), but for a constant.
SYMMETRIES: dict[str, Row] = {
    "rotation": (CENTRAL, turn, 0, lambda q, v, t: q[0] * v[1] - q[1] * v[0]),
    "time": (CENTRAL, [0, 0], 1, lambda q, v, t: 1 / np.hypot(*q) - (v[0] ** 2 + v[1] ** 2) / 2),
    "translation of two": (PAIR, [1, 1], 0, lambda q, v, t: 2 * v[0] + v[1]),
    "boost": (PAIR, lambda q, v, t: [t, t], 0, lambda q, v, t: (2 * v[0] + v[1]) * t - 2 * q[0] - q[1]),
    "translation in a field": (FALLING, [1], 0, lambda q, v, t: v[0] + 9.81 * t),
    "boost in a field": (
        FALLING,
        [lambda q, v, t: t],
        0,
        lambda q, v, t: v[0] * t - q[0] + 9.81 * t**2 / 2,
    ),
    "translation of a charge": (MAGNETIC, {"x": 1}, 0, lambda q, v, t: 2 * v[0] - 3 * q[1]),
    "turn of a charge": (
        MAGNETIC,
        turn,
        0,
        lambda q, v, t: 2 * (q[0] * v[1] - q[1] * v[0]) + 1.5 * (q[0] ** 2 + q[1] ** 2),
    ),
    "growth": (
        GROWING,
        [lambda q, v, t: -0.15 * q[0]],
        1,
        lambda q, v, t: -np.exp(0.3 * t) * ((v[0] ** 2 + 4 * q[0] ** 2) / 2 + 0.15 * q[0] * v[0]),
    ),
    "dilatation": (
        CONFORMAL,
        [lambda q, v, t: q[0] / 2],
        lambda q, v, t: t,
        lambda q, v, t: v[0] * q[0] / 2 - (v[0] ** 2 / 2 + 0.7 / q[0] ** 2) * t,
    ),
    "special conformal": (
        CONFORMAL,
        [lambda q, v, t: q[0] * t],
        lambda q, v, t: t**2,
        lambda q, v, t: v[0] * q[0] * t - (v[0] ** 2 / 2 + 0.7 / q[0] ** 2) * t**2 - q[0] ** 2 / 2,
    ),
    "oscillator": (
        line(lambda x, v, t: (v**2 - x**2) / 2),
        [lambda q, v, t: np.sin(t)],
        0,
        lambda q, v, t: v[0] * np.sin(t) - q[0] * np.cos(t),
    ),
    "disguised": (DISGUISED, [1], 0, lambda q, v, t: v[0]),
}


@pytest.mark.parametrize("name", SYMMETRIES)
def test_symmetries(name: str) -> None:
    system, xi, tau, wanted = SYMMETRIES[name]
    found = system.noether(xi, time_shift=tau)
    assert found.holds, found
    assert found.residual <= 1e-14
    out = system.run(T)
    along = found.conserved(out)
    values = np.array([wanted(*each) for each in zip(out.position, out.velocity, out.t, strict=True)])
    # A run, a quadrature, and terms that grow with powers of the time: some thousand roundings of the largest.
    scale = 1e-12 * (1.0 + np.abs(out.momentum * out.velocity).max() + np.abs(out.position).max()) * 10.0
    assert np.ptp(along) <= scale
    assert np.ptp(along - values) <= scale
    assert found.conserved() == pytest.approx(along[0], abs=scale)


def test_what_the_rules_of_the_graph_prove() -> None:
    """Time and cyclic coordinates are proved for all parameters; cancellations of products are seen at states."""
    spherical = vv.systems.spherical_pendulum()
    assert spherical.noether({"phi": 1}).proved
    assert spherical.noether([0, 0], time_shift=1).proved
    assert FALLING.noether([1]).proved
    assert PAIR.noether([1, 1]).proved
    assert not CENTRAL.noether(turn).proved
    assert not spherical.noether({"theta": 1}).holds


def test_the_potentials_that_a_helix_allows() -> None:
    """A screw along z: V(x² + y², z − c φ) allows it, and a potential with another pitch does not."""
    pitch = 0.7

    def L(q: Any, v: Any, t: Any, c: Any) -> Any:
        phase = np.arctan2(q[1], q[0]) - q[2] / c
        return (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 - np.exp(-(q[0] ** 2) - q[1] ** 2) * np.cos(phase)

    def screw(q: Any, v: Any, t: Any, c: Any) -> list[Any]:
        return [-q[1], q[0], c]

    start = {"position": [1.0, 0.0, 0.0], "velocity": [0.1, 0.5, 0.2]}
    system = vv.Lagrangian(L, ["x", "y", "z"], parameters={"c": pitch}, **start)
    found = system.noether(screw)
    assert found.holds
    assert np.ptp(found.conserved(system.run(T))) <= 2e-14
    assert not system.noether(lambda q, v, t, c: [-q[1], q[0], 1.01 * c]).holds


def test_broken_symmetries_are_seen_and_drift() -> None:
    broken = plane(lambda x, y, t: (x**2 + y**2) / 2 + 1e-4 * x)
    found = broken.noether(turn)
    assert not found.holds
    assert not found.proved
    assert 1e-6 < found.residual < 1e-2
    assert "no rate" in found.reason
    assert np.ptp(found.conserved(broken.run(T))) > 1e-5
    # V that depends on the time has no energy.
    assert not plane(lambda x, y, t: x**2 * (1 + t)).noether([0, 0], time_shift=1).holds
    # The wrong gauge.
    assert FALLING.noether([1], gauge=lambda q, v, t: -9.81 * t).holds
    wrong = FALLING.noether([1], gauge=lambda q, v, t: -9.8 * t)
    assert not wrong.holds
    assert "of the gauge" in wrong.reason


def test_forces_and_constraints_must_allow_it() -> None:
    pushed = plane(lambda x, y, t: 0 * x, forces={"x": lambda q, v, t: q[1]})
    assert pushed.noether([0, 1]).holds
    assert pushed.noether([1, 0]).reason == "the forces do work along it"
    rubbed = plane(lambda x, y, t: 0 * x, dissipation=lambda q, v, t: v[0] ** 2)
    assert rubbed.noether([0, 1]).holds
    assert rubbed.noether([1, 0]).reason == "the dissipation does work along it"
    assert not rubbed.noether([0, 0], time_shift=1).holds
    ring = plane(
        lambda x, y, t: 0 * x,
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1],
        position=[1.0, 0.0],
        velocity=[0.0, 0.8],
    )
    found = ring.noether(turn)
    assert found.holds
    assert np.ptp(found.conserved(ring.run(T))) <= 1e-14
    assert ring.noether([1, 0]).reason == "it leaves constraint 0"
    skate = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2,
        ["x", "y", "angle"],
        nonholonomic=[lambda q, v, t: np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1]],
        position=[0.0, 0.0, 0.3],
        velocity=[np.cos(0.3), np.sin(0.3), 0.5],
    )
    assert skate.noether({"angle": 1}).holds
    assert skate.noether([0, 0, 0], time_shift=1).holds
    assert skate.noether({"x": 1}).reason == "it leaves constraint 0"


def test_expressions_of_sympy() -> None:
    (x, y), (vx, vy) = coordinates("x y")
    k = sp.Symbol("k")
    L = (vx**2 + vy**2) / 2 - k * (x**2 + y**2)
    system = vv.Lagrangian(L, [x, y], parameters={k: 2.0}, position=[1.0, 0.0])
    found = system.noether({x: -y, y: x})
    assert found.holds
    assert sp.expand(found.expression - (x * vy - y * vx)) == 0
    energy = system.noether([0, 0], time_shift=1)
    assert sp.expand(energy.expression + (vx**2 + vy**2) / 2 + k * (x**2 + y**2)) == 0
    t = sp.Symbol("t")
    free = vv.Lagrangian(vx**2 / 2, [x])
    assert sp.expand(free.noether([t], gauge=x).expression - (vx * t - x)) == 0
    with pytest.raises(vv.errors.InvalidInput, match="pass it to noether"):
        free.noether([t]).expression  # noqa: B018


REFUSED = [
    (lambda: FALLING.noether([lambda q, v, t: v[0]]), "generator", "it depends on velocities"),
    (lambda: FALLING.noether([1], time_shift=lambda q, v, t: v[0]), "time_shift", "it depends on velocities"),
    (lambda: FALLING.noether([1], gauge=lambda q, v, t: v[0]), "gauge", "it depends on velocities"),
    (lambda: FALLING.noether([1, 2]), "generator", r"an expression for each of \['x'\]"),
    (
        lambda: FALLING.noether(lambda q, v, t: [1, 2]),
        "generator",
        r"an expression for each of \['x'\], got 2 of the function",
    ),
    (lambda: FALLING.noether({"y": 1}), "generator", "there is no coordinate 'y'"),
    (lambda: FALLING.noether(1.0), "generator", "an expression for each of"),
    (lambda: line(lambda x, v, t: v**2 + np.sqrt(x - 50)).noether([1]), "generator", "too few states"),
]


@pytest.mark.parametrize(("call", "argument", "words"), REFUSED)
def test_refused(call: Any, argument: str, words: str) -> None:
    with pytest.raises(vv.errors.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument


def test_it_pickles() -> None:
    boost = PAIR.noether(lambda q, v, t: [t, t])
    again = pickle.loads(pickle.dumps(boost))
    assert (again.holds, again.reason, again.conserved()) == (boost.holds, boost.reason, boost.conserved())
