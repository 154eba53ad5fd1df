"""Stiff springs in Cartesian coordinates: what the rounding of a place makes of the force does not set the pace.

A bead on a spring of stiffness K swings slowly and shakes fast. Of a place near 1 the last digit is K ε of an
acceleration, far more than the last digits of that: no iteration of stages gets below it, and polynomials through
stages multiply it.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy

import visviva as vv

GRAVITY = 9.81
SPAN = 2.0


def bead(stiffness: float, start: float = 1.0, *, momenta: bool = False) -> vv.Lagrangian | vv.Hamiltonian:
    if momenta:
        x, y, p, q, k = sympy.symbols("x y p q k")
        energy = (p**2 + q**2) / 2 + k * (sympy.sqrt(x**2 + y**2) - 1) ** 2 / 2 + GRAVITY * y
        return vv.Hamiltonian(
            energy, q=[x, y], p=[p, q], position=[start, 0.0], momentum=[0.0, 0.0], parameters={"k": stiffness}
        )
    x, y, t = vv.coordinate("x"), vv.coordinate("y"), vv.time
    k = sympy.symbols("k")
    potential = k * (sympy.sqrt(x**2 + y**2) - 1) ** 2 / 2 + GRAVITY * y
    kinetic = (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
    return vv.Lagrangian(kinetic - potential, [x, y], position=[start, 0.0], parameters={"k": stiffness})


def periods(stiffness: float) -> float:
    return SPAN * np.sqrt(stiffness) / (2.0 * np.pi)


@pytest.mark.parametrize("momenta", [False, True])
@pytest.mark.parametrize("stiffness", [1e4, 1e6, 1e8])
def test_steps_follow_the_motion_and_not_its_rounding(stiffness: float, momenta: bool) -> None:
    exact = bead(stiffness).run(SPAN, method="taylor", rtol=1e-14).position[-1]
    out = bead(stiffness, momenta=momenta).run(SPAN)
    assert out.stats.method == "gauss16"
    # Of order 16 a period takes about five steps for a tolerance of 1e-12; by rounding alone it took 120.
    assert out.stats.steps < 10.0 * periods(stiffness)
    # Of the tolerance in each step, some thousand of which do not add up.
    assert out.position[-1] == pytest.approx(exact, rel=0.0, abs=1e-10)


@pytest.mark.parametrize("part", [0.5, 0.1])
@pytest.mark.parametrize("momenta", [False, True])
def test_equal_steps_that_resolve_the_spring_are_taken(part: float, momenta: bool) -> None:
    stiffness = 1e8
    exact = bead(stiffness).run(SPAN, method="taylor", rtol=1e-14).position[-1]
    out = bead(stiffness, momenta=momenta).run(SPAN, method="gauss16", dt=part / np.sqrt(stiffness))
    # A twelfth, or a sixtieth, of a period is as good as exact; what is left is K ε of each acceleration.
    assert out.position[-1] == pytest.approx(exact, rel=0.0, abs=1e-13)
    assert out.conservation()["energy"] < 1e-13


@pytest.mark.parametrize("method", ["gauss8", "gauss16"])
@pytest.mark.parametrize(("offset", "stiffness", "start"), [(0.0, 1e8, 1.0), (10.0, 1e8, 1.0), (1e3, 1e6, 1.0 + 1e-8)])
def test_shaking_below_the_rounding_of_a_polynomial_is_followed_too(
    method: str, offset: float, stiffness: float, start: float
) -> None:
    """Vibrations of 1e-8 and less, far off: places were off by 1e-9 where noise hid them, and velocities by 1e-5."""
    x, y, t = vv.coordinate("x"), vv.coordinate("y"), vv.time
    potential = stiffness * (sympy.sqrt((x - offset) ** 2 + y**2) - 1) ** 2 / 2 + GRAVITY * y
    kinetic = (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
    system = vv.Lagrangian(kinetic - potential, [x, y], position=[offset + start, 0.0])
    exact = system.run(1.0, method="taylor", rtol=1e-14)
    out = system.run(1.0, method=method)
    # K ε |x| of each acceleration, at 1e4 of which a period ends: a random walk of some thousand.
    rounding = np.finfo(float).eps * (offset + 1.0)
    assert out.position[-1] == pytest.approx(exact.position[-1], rel=0.0, abs=30.0 * rounding)
    assert out.velocity[-1] == pytest.approx(exact.velocity[-1], rel=0.0, abs=30.0 * rounding * np.sqrt(stiffness))


def test_a_shaking_bead_is_followed_as_well() -> None:
    # Shaken by a millionth: the energy of that is 5e-5 of the whole, and it takes as many steps as it has turns.
    stiffness = 1e8
    for start in (1.0 + 1e-6, 1.0 + 1e-4):
        exact = bead(stiffness, start).run(SPAN, method="taylor", rtol=1e-14).position[-1]
        out = bead(stiffness, start).run(SPAN)
        assert 2.0 * periods(stiffness) < out.stats.steps < 20.0 * periods(stiffness)
        # 3000 turns, each of which loses a few ε of its phase: 1e-12 of the amplitude, and K ε of the accelerations.
        assert out.position[-1] == pytest.approx(exact, rel=0.0, abs=1e-12)


@pytest.mark.parametrize("how", [{}, {"method": "gauss16", "dt": 4e-5}, {"method": "gauss8", "rtol": 1e-8}])
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_have_the_bits_that_they_have_alone(how: dict[str, object], threads: int) -> None:
    # 21 of stiffnesses from 1 to 1e8: noise is told of some, and asked for in the same lanes as others that have none.
    stiffness = np.geomspace(1.0, 1e8, 21)[np.random.default_rng(3).permutation(21)]
    many = bead(1.0).ensemble(parameters={"k": stiffness})
    out = many.run([0.1, 0.3], threads=threads, **how)
    assert (out.status == vv.Status.OK).all()
    for copy in range(21):
        alone = many[copy].run([0.1, 0.3], **how)
        assert np.array_equal(alone.position, out.position[copy])
        assert np.array_equal(alone.velocity, out.velocity[copy])
        assert alone.stats.steps == out[copy].stats.steps
