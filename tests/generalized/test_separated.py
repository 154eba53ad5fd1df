"""Kicks and drifts of H = T(p) + V(q, t): the motion of the Lagrangian, the declared order, areas kept, refusals.

Bounds: orders as of the property suite, ± 0.15; what is the same but for roundings to some hundred of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

SPLITTINGS = [row["name"] for row in _core.methods() if row["asks"] == "separable"]
NYSTROM = [row["name"] for row in _core.methods() if row["asks"] == "nystrom"]


def relativistic(position: float = 0.8, momentum: float = 0.6) -> vv.Hamiltonian:
    """A particle as fast as light in a well, which time shakes."""
    return vv.Hamiltonian(
        lambda q, p, t: np.sqrt(1.0 + p[0] ** 2) + q[0] ** 4 / 4.0 + 0.3 * q[0] * np.cos(1.7 * t),
        ["x"],
        position=[position],
        momentum=[momentum],
    )


def heavy(position: ArrayLike = (0.7, -0.4), mass: float = 2.5) -> vv.Hamiltonian:
    """Masses that are not one, and bound to each other."""
    return vv.Hamiltonian(
        lambda q, p, t, m: p[0] ** 2 / (2.0 * m) + (p[1] - 0.5 * p[0]) ** 2 - np.cos(q[0]) + q[0] * q[1] ** 3 / 3.0,
        ["x", "y"],
        parameters={"m": mass},
        position=position,
        momentum=[0.3, 0.2],
    )


@pytest.mark.parametrize("method", [*SPLITTINGS, *NYSTROM])
def test_masses_make_no_difference(method: str) -> None:
    """The Lagrangian of the same system goes through the same kicks and drifts."""
    times = [0.31, 1.0, 2.05]
    of_h = heavy().run(times, method=method, dt=0.02)
    of_l = heavy().lagrangian().run(times, method=method, dt=0.02)
    assert np.allclose(of_h.position, of_l.position, rtol=0.0, atol=3e-14)
    assert np.allclose(of_h.momentum, of_l.momentum, rtol=0.0, atol=3e-14)


@pytest.mark.parametrize("method", SPLITTINGS)
def test_order(method: str) -> None:
    [order] = [each.order for each in vv.methods() if each.name == method]
    exact = relativistic().run(2.0, method="gauss16", rtol=1e-15).position[-1, 0]
    longest = {1: 0.02, 2: 0.05, 3: 0.05, 4: 0.1}.get(order, 0.25)

    def off(dt: float) -> float:
        return abs(relativistic().run(2.0, method=method, dt=dt).position[-1, 0] - exact)

    errors = np.array([off(2.0 / round(2.0 / (longest / part))) for part in (1.0, 2.0)])
    # Of methods of order 8 and 10 half a step is rounding already: there it has to fall at least as far as that.
    assert errors[1] < 2.0 ** (0.35 - order) * errors[0] or errors[1] < 2e-14
    assert errors[1] < 1e-2


@pytest.mark.parametrize("method", ["symplectic_euler", "leapfrog", "mclachlan4", "kahan_li8"])
def test_areas_are_kept(method: str) -> None:
    """det ∂(x, p)/∂(x₀, p₀) = 1 of one degree of freedom, by differences of fourth order: 1e-10 of their own."""

    def end(x: float, p: float) -> np.ndarray:
        out = relativistic(x, p).run(3.0, method=method, dt=0.1)
        return np.array([out.position[-1, 0], out.momentum[-1, 0]])

    h = 1e-3

    def slope(dx: float, dp: float) -> np.ndarray:
        near, far = (end(0.8 + k * dx, 0.6 + k * dp) - end(0.8 - k * dx, 0.6 - k * dp) for k in (1.0, 2.0))
        return (8.0 * near - far) / (12.0 * h)

    jacobian = np.stack([slope(h, 0.0), slope(0.0, h)], axis=1)
    assert abs(np.linalg.det(jacobian) - 1.0) < 1e-9


@pytest.mark.parametrize("method", ["leapfrog", "leapfrog_dkd", "yoshida4", "sofroniou_spaletta8"])
def test_energy_does_not_drift(method: str) -> None:
    free = vv.Hamiltonian(
        lambda q, p, t: np.sqrt(1.0 + p[0] ** 2) + q[0] ** 2 / 2.0, ["x"], position=[1.5], momentum=[0.0]
    )
    out = free.run(np.linspace(0.0, 2000.0, 401), method=method, dt=0.1)
    off = out.energy / out.energy[0] - 1.0
    early, late = np.abs(off[:41]).max(), np.abs(off[-40:]).max()
    assert late < 1.5 * early + 1e-13
    back = vv.Hamiltonian(
        lambda q, p, t: np.sqrt(1.0 + p[0] ** 2) + q[0] ** 2 / 2.0,
        ["x"],
        position=out.position[40],
        momentum=-out.momentum[40],
    ).run(out.t[40], method=method, dt=0.1)
    assert np.allclose(back.position[-1], [1.5], rtol=0.0, atol=1e-12)


def test_outputs_between_nodes_copies_and_threads_change_no_bit() -> None:
    system = heavy()
    starts = np.random.default_rng(2).normal(size=(11, 2)) * 0.3
    whole = system.run(2.0, method="kahan_li8", dt=0.05)
    parted = system.run([0.013, 0.7, 1.99, 2.0], method="kahan_li8", dt=0.05)
    assert np.array_equal(whole.position[-1], parted.position[-1])
    one, three = (
        system.ensemble(position=starts).run([0.5, 2.0], method="yoshida6", dt=0.05, threads=threads)
        for threads in (1, 3)
    )
    assert np.array_equal(one.position, three.position)
    assert np.array_equal(one.momentum, three.momentum)
    for copy, start in enumerate(starts):
        alone = heavy(start).run([0.5, 2.0], method="yoshida6", dt=0.05)
        assert np.array_equal(alone.position, one.position[copy])


def test_refused_where_kicks_and_drifts_make_no_method() -> None:
    for method in NYSTROM:
        with pytest.raises(vv.InvalidInput, match="T quadratic in p"):
            relativistic().run(1.0, method=method, dt=0.1)
    for method in ("stormer13", "boris"):
        with pytest.raises(vv.InvalidInput, match=r"H = p²/2 \+ V"):
            heavy().run(1.0, method=method, dt=0.1)
    mixed = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 * (1.0 + q[0] ** 2), ["x"], position=[1.0], momentum=[0.2])
    with pytest.raises(vv.InvalidInput, match=r"H = T\(p\) \+ V\(q\); here they do"):
        mixed.run(1.0, method="leapfrog", dt=0.1)
    shaken = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 * np.cos(t) + q[0], ["x"], position=[1.0], momentum=[0.2])
    with pytest.raises(vv.InvalidInput, match=r"H = T\(p\) \+ V\(q\); here they do"):
        shaken.run(1.0, method="yoshida4", dt=0.1)


def test_copies_with_masses_of_their_own_and_events() -> None:
    """Each has the bits and the events that it has alone, by one thread and three; backward in time, too."""
    masses = np.linspace(0.5, 4.0, 11)
    crossing = vv.events.coordinate("x", 0.0)
    for end in (3.0, -3.0):
        one, three = (
            heavy()
            .ensemble(parameters={"m": masses})
            .run(end, method="kahan_li8", dt=0.05, events=[crossing], threads=threads)
            for threads in (1, 3)
        )
        assert np.array_equal(one.position, three.position)
        assert len(one.events.t) == len(three.events.t) >= 11
        for copy, mass in enumerate(masses):
            alone = heavy(mass=mass).run(end, method="kahan_li8", dt=0.05, events=[crossing])
            assert np.array_equal(alone.position[-1], one.position[copy, -1])
            assert np.array_equal(alone.events.t, one.events.t[one.events.member == copy])
            # On the section to the roundings of a place, and the exact motion's to the method's error there.
            assert np.abs(alone.events.position[:, 0]).max() < 1e-14
