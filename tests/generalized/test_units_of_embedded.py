"""Embedded methods know no unit: a system in other units has the same motion, and errors in proportion."""

import numpy as np
import pytest

import visviva as vv


def swing(a: float, start: float, velocity: float) -> vv.Lagrangian:
    """A pendulum whose coordinate is an arc of the radius a."""

    def L(q, v, t, a):
        return v[0] ** 2 / 2 + a * a * np.cos(q[0] / a)

    return vv.Lagrangian(L, ["x"], parameters={"a": a}, position=[start * a], velocity=[velocity * a])


@pytest.mark.parametrize("start", [(2.0, 0.0), (0.0, 1.5), (1.0, -0.5)])
@pytest.mark.parametrize("a", [1e-30, 1e-15, 1e-9, 1e9, 1e30])
@pytest.mark.parametrize("method", ["dop853", "dormand_prince54", "verner98"])
def test_lengths_of_any_size(a: float, start: tuple[float, float], method: str) -> None:
    """The absolute tolerance was a thousandth of the relative one in the user's units: at 1e-9 m nothing was right."""
    exact = swing(1.0, *start).run(10.0, method="gauss16", rtol=1e-13).position[-1, 0]
    for rtol, bound in ((1e-6, 1e-4), (1e-11, 1e-9)):
        found = swing(a, *start).run(10.0, method=method, rtol=rtol).position[-1, 0] / a
        assert abs(found - exact) < bound


@pytest.mark.parametrize("size", [1e-15, 1e-9, 1.0, 1e12])
def test_an_absolute_value_in_any_unit(size: float) -> None:
    """`auto` takes dop853 there; after ten periods the start is reached again."""
    s = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - abs(q[0]), ["x"], position=[size])
    end = s.run(10 * 4 * np.sqrt(2 * size)).position[-1, 0]
    # The turn itself is stationary there; the kinks cost a step's tolerance each.
    assert end == pytest.approx(size, rel=1e-8, abs=0)


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e12])
def test_momenta_and_times_of_any_unit(unit: float) -> None:
    """A Hamiltonian in other units of mass: momenta go with it."""
    H = vv.Hamiltonian(
        lambda q, p, t, m: p[0] ** 2 / (2 * m) - m * np.cos(q[0]), ["x"], parameters={"m": unit}, position=[2.0]
    )
    out = H.run(10.0, method="dop853", rtol=1e-10)
    exact = vv.systems.pendulum(g=1.0, position=[2.0]).run(10.0)
    # Of a tolerance of 1e-10 a step; measured 3.5e-11 in any unit.
    assert abs(out.position[-1, 0] - exact.position[-1, 0]) < 2e-10


def test_what_rests_at_first_has_the_size_that_others_give_it() -> None:
    """A plane motion in three coordinates: the third stays at rounding, and costs no step."""

    def L(q, v, t):
        r = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2)
        return (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 + 1 / r

    start = {"position": [1e-9, 0, 0], "velocity": [0, 3e4, 0]}
    space = vv.Lagrangian(L, ["x", "y", "z"], **start).run(t=1e-12, method="dop853")

    def turned(x):
        return [x[0], (x[1] + x[2]) / 2**0.5, (x[1] - x[2]) / 2**0.5]

    slanted = {"position": [1e-9, 0, 0], "velocity": [0, 3e4 / 2**0.5, 3e4 / 2**0.5]}
    tilt = vv.Lagrangian(lambda q, v, t: L(turned(q), turned(v), t), ["x", "y", "z"], **slanted)
    tilt = tilt.run(t=1e-12, method="dop853")
    assert tilt.steps < 2 * space.steps


def test_copies_in_units_of_their_own_have_the_bits_of_one() -> None:
    system = swing(1.0, 2.0, 0.0)
    sizes = 10.0 ** np.arange(-12, 12, dtype=float)
    copies = system.ensemble(parameters={"a": sizes}, position=2.0 * sizes[:, None]).run(5.0, method="dop853")
    for copy, size in enumerate(sizes):
        alone = swing(size, 2.0, 0.0).run(5.0, method="dop853")
        assert (copies.position[copy] == alone.position).all()
