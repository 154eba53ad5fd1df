"""What rounding may do to expressions, and tests of identities at states where it leaves nothing of them.

sinh² of a large number leaves the range of numbers, and 1 − tanh² loses all digits: neither says that a transformation
is not canonical. One that is off by 1e-9 is seen all the same, where numbers are of their usual sizes.
"""

import time
from typing import Any

import mpmath
import numpy as np
import pytest

import visviva as vv
from visviva.generalized._calculus import Calculus
from visviva.generalized._known_functions import FUNCTIONS
from visviva.generalized._rounding import rounding_of

ONE = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2, ["x"], position=[0.3], momentum=[0.2])
TWO = vv.Hamiltonian(
    lambda q, p, t: (p[0] ** 2 + p[1] ** 2) / 2 - 1 / np.sqrt(q[0] ** 2 + q[1] ** 2),
    ["x", "y"],
    position=[1.0, 0.5],
    momentum=[0.2, 0.3],
)


def elliptic(q: Any, p: Any) -> list[Any]:
    """Cartesian coordinates and momenta of elliptic ones, x + iy = cosh(μ + iν)."""
    sinh, cosh, sin, cos = np.sinh(q[0]), np.cosh(q[0]), np.sin(q[1]), np.cos(q[1])
    square = sinh**2 + sin**2
    return [
        cosh * cos,
        sinh * sin,
        (sinh * cos * p[0] - cosh * sin * p[1]) / square,
        (cosh * sin * p[0] + sinh * cos * p[1]) / square,
    ]


def bipolar(q: Any, p: Any) -> list[Any]:
    """The same of bipolar coordinates: conformal, with x = sinh τ/D, y = sin σ/D, D = cosh τ − cos σ."""
    sinh, cosh, sin, cos = np.sinh(q[1]), np.cosh(q[1]), np.sin(q[0]), np.cos(q[0])
    far = cosh - cos
    a, b = 1.0 - cosh * cos, -sinh * sin
    return [sinh / far, sin / far, b * p[0] + a * p[1], -a * p[0] + b * p[1]]


MAPS: dict[str, tuple[vv.Hamiltonian, Any]] = {
    "Gudermann's function": (ONE, lambda q, p: [np.arctan(np.sinh(q[0])), p[0] * np.cosh(q[0])]),
    "tanh": (ONE, lambda q, p: [np.tanh(q[0]), p[0] / (1.0 - np.tanh(q[0]) ** 2)]),
    "elliptic": (TWO, elliptic),
    "bipolar": (TWO, bipolar),
}


@pytest.mark.parametrize("name", MAPS)
def test_what_leaves_the_range_of_numbers_far_away_is_canonical(name: str) -> None:
    system, transformation = MAPS[name]
    found = system.is_canonical(lambda q, p, t: transformation(q, p))
    assert found.holds
    assert not found.proved
    assert found.residual <= 1e-12


@pytest.mark.parametrize("off", [1e-3, 1e-9])
@pytest.mark.parametrize("name", MAPS)
def test_what_is_off_by_a_little_is_not(name: str, off: float) -> None:
    """One momentum too large by a part: brackets are off by that part, near the start."""
    system, transformation = MAPS[name]

    def other(q: Any, p: Any, t: Any) -> list[Any]:
        *all_but_last, last = transformation(q, p)
        return [*all_but_last, last * (1.0 + off)]

    found = system.is_canonical(other)
    assert not found.holds
    assert found.residual > 0.1 * off


def test_translations_in_elliptic_coordinates() -> None:
    """Free motion: the momentum along x is kept, as along a run; that along the distance of the foci's line is none."""
    free = vv.Lagrangian(
        lambda q, v, t: (np.sinh(q[0]) ** 2 + np.sin(q[1]) ** 2) * (v[0] ** 2 + v[1] ** 2) / 2.0,
        ["mu", "nu"],
        position=[1.0, 0.5],
        velocity=[0.2, 0.3],
    )

    def along_x(q: Any, v: Any, t: Any) -> list[Any]:
        square = np.sinh(q[0]) ** 2 + np.sin(q[1]) ** 2
        return [np.sinh(q[0]) * np.cos(q[1]) / square, -np.cosh(q[0]) * np.sin(q[1]) / square]

    assert free.noether(along_x).holds
    assert not free.noether(lambda q, v, t: [along_x(q, v, t)[0], 0.5 * along_x(q, v, t)[1]]).holds
    assert not free.noether(lambda q, v, t: [1.0, 0.0]).holds


@pytest.mark.parametrize("steps", [1, 2, 3])
def test_steps_of_leapfrog_about_a_center(steps: int) -> None:
    """Each is canonical, and so are they one after another; of Euler's explicit method none is, by the step squared.

    Multiplied out in full, terms grow as a power of their number: ten seconds are ten times what a step takes.
    """

    def pull(q: Any) -> list[Any]:
        cube = (q[0] ** 2 + q[1] ** 2) ** 1.5
        return [-q[0] / cube, -q[1] / cube]

    def leapfrog(q: Any, p: Any, t: Any) -> list[Any]:
        for _ in range(steps):
            p = [p[i] + 0.025 * pull(q)[i] for i in range(2)]
            q = [q[i] + 0.05 * p[i] for i in range(2)]
            p = [p[i] + 0.025 * pull(q)[i] for i in range(2)]
        return [*q, *p]

    def euler(q: Any, p: Any, t: Any) -> list[Any]:
        for _ in range(steps):
            q, p = [q[i] + 0.05 * p[i] for i in range(2)], [p[i] + 0.05 * pull(q)[i] for i in range(2)]
        return [*q, *p]

    begun = time.perf_counter()
    assert TWO.is_canonical(leapfrog).holds
    assert time.perf_counter() - begun < 10.0 * steps
    assert not TWO.is_canonical(euler).holds


ARGUMENTS = np.concatenate([[0.0, 1e-300, 0.3, 0.999], np.linspace(1.01, 40.0, 9), [400.0, 800.0]])
EXPRESSIONS: dict[str, tuple[Any, Any]] = {
    "1 - tanh^2": (lambda x: 1.0 - np.tanh(x) ** 2, lambda x: 1 - mpmath.tanh(x) ** 2),
    "cosh/(1 + sinh^2)": (
        lambda x: np.cosh(x) / (1.0 + np.sinh(x) ** 2),
        lambda x: mpmath.cosh(x) / (1 + mpmath.sinh(x) ** 2),
    ),
    "(1 - cos)/x^2": (lambda x: (1.0 - np.cos(x)) / (x * x), lambda x: (1 - mpmath.cos(x)) / (x * x)),
    "exp(-x) exp(x)": (lambda x: np.exp(-x) * np.exp(x + 1.0), lambda x: mpmath.exp(mpmath.mpf(1))),
    "sqrt": (lambda x: np.sqrt(1.0 + x * x) - x, lambda x: mpmath.sqrt(1 + x * x) - x),
    "power": (lambda x: (1.0 + x) ** 2.5 - x**2.5, lambda x: (1 + x) ** mpmath.mpf(2.5) - x ** mpmath.mpf(2.5)),
    "atan2": (lambda x: np.arctan2(x, 2.0) - x / 2.0, lambda x: mpmath.atan2(x, 2) - x / 2),
} | {
    name: (
        lambda x, name=name: getattr(np, name.replace("a", "arc", 1) if name[0] == "a" else name)(x * 0.9 + 0.01),
        lambda x, name=name: getattr(mpmath, name)(mpmath.mpf(0.9) * x + mpmath.mpf(0.01)),
    )
    for name in FUNCTIONS
}


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_errors_are_within_what_is_told(name: str) -> None:
    """Against fifty digits; and not much less than what is told, where a number has lost none of its digits."""
    own, exact = EXPRESSIONS[name]
    c = Calculus(ONE)
    expressions = c.of_user("transformation", [lambda q, p, t: own(q[0])])
    states = np.stack([ARGUMENTS, np.zeros(len(ARGUMENTS))], axis=1)
    times = np.zeros(len(ARGUMENTS))
    with np.errstate(all="ignore"):
        values = c.values(expressions, times, states, ONE._values)[:, 0]
    told = rounding_of(c, expressions, times, states)[:, 0]
    known = 0
    with mpmath.workdps(400):
        for x, value, off in zip(ARGUMENTS, values, told, strict=True):
            if not np.isfinite(off):
                continue
            known += 1
            wanted = exact(mpmath.mpf(float(x)))
            assert abs(mpmath.mpf(float(value)) - wanted) <= off
    assert known >= 2
