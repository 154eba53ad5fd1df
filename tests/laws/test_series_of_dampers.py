"""Dampers by their Taylor series: beside closed forms and another method, also where their ends meet.

Bounds: a step by series is off by less than a tenth of rtol; runs here are of some tens of steps.
"""

import numpy as np
import pytest
from nets import FIELDS, goes_as_by_another_method_with_its_own_bits, net

import visviva as vv


@pytest.mark.parametrize("direction", [[1, 0, 0], [3, 4, 0], [1, 2, -2]])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_damped_spring_swings_as_the_damped_oscillator(direction: list[float], rtol: float) -> None:
    """μ s″ = −k (s − length) − c s′ with μ = 3/4: s − length = e^(−γt) (a cos ωt + b sin ωt)."""
    k, c, length, mu = 12.0, 0.75, 1.0, 0.75
    along = np.asarray(direction) / np.linalg.norm(direction)
    bodies = vv.Particles([1.0, 3.0], [np.zeros(3), 1.5 * along], [np.zeros(3), 0.4 * along])
    scene = vv.Scene(bodies, vv.Spring(0, 1, k, length), vv.Damper(0, 1, c))
    t = np.linspace(0.0, 5.0, 26)
    out = scene.run(t=t, method="taylor", rtol=rtol)
    gamma = c / (2.0 * mu)
    omega = np.sqrt(k / mu - gamma**2)
    a, b = 0.5, (0.4 + 0.5 * gamma) / omega
    exact = length + np.exp(-gamma * t) * (a * np.cos(omega * t) + b * np.sin(omega * t))
    distance = np.linalg.norm(out.position[:, 1] - out.position[:, 0], axis=1)
    # Twenty radians, whose phase may err by the tolerance each.
    assert distance == pytest.approx(exact, rel=0, abs=20 * rtol + 1e-13)


@pytest.mark.parametrize("direction", [[0, 1, 0], [3, 4, 0], [1, 2, -2]])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_damper_brakes_ends_that_pass_each_other_head_on(direction: list[float], rtol: float) -> None:
    """μ s′ = μ v − c (s − s₀) on both sides of zero: s − s₀ = v τ (1 − e^(−t/τ)), τ = μ/c = 3/2."""
    along = np.asarray(direction) / np.linalg.norm(direction)
    bodies = vv.Particles([1.0, 3.0], [np.zeros(3), along], [np.zeros(3), -4.0 * along])
    scene = vv.Scene(bodies, vv.Damper(0, 1, 0.5))
    t = np.linspace(0.0, 3.0, 31)
    out = scene.run(t=t, method="taylor", rtol=rtol)
    apart = (out.position[:, 1] - out.position[:, 0]) @ along
    assert apart == pytest.approx(1.0 - 6.0 * (1.0 - np.exp(-t / 1.5)), rel=0, abs=20 * rtol + 1e-12)


@pytest.mark.parametrize("beside", [1e-1, 1e-3, 1e-6])
def test_ends_that_pass_each_other_closely_keep_angular_momentum(beside: float) -> None:
    """The line turns by half a turn within the width of the passage, and what it does not brake goes on."""
    bodies = vv.Particles([1.0, 3.0], [[0.0, 0, 0], [1.0, beside, 0]], [[0.0, 0, 0], [-4.0, 0, 0]])
    scene = vv.Scene(bodies, vv.Damper(0, 1, 0.5))
    out = scene.run(t=np.linspace(0.0, 1.0, 21), method="taylor", rtol=1e-12)
    other = scene.run(t=1.0, method="verner98", rtol=1e-13)
    d, v = out.position[:, 1] - out.position[:, 0], out.velocity[:, 1] - out.velocity[:, 0]
    # Twelve is the product of the largest distance and speed.
    assert np.cross(d, v)[:, 2] == pytest.approx(4.0 * beside, rel=0, abs=12e-12)
    # The passage, within which a width of 1e-6 turns the line, magnifies the tolerance of either ten times.
    assert out.position[-1] == pytest.approx(other.position[-1], rel=0, abs=1e-11)


@pytest.mark.parametrize("count", [2, 6, 8, 13])
@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("fields", FIELDS)
def test_damped_nets_go_as_by_another_method_and_with_their_own_bits(count: int, dimensions: int, fields: str) -> None:
    scene = net(count, dimensions, extra=count // 2)
    ends = np.arange(count - 1)
    damper = vv.Damper(ends, ends + 1, c=np.linspace(0.0, 2.0, count - 1) if count > 2 else 0.5)
    scene = vv.Scene(scene.particles, damper, *scene.forces, *FIELDS[fields])
    goes_as_by_another_method_with_its_own_bits(scene, 2.0, "verner98")


def test_copies_with_dampers_of_their_own_have_the_bits_they_have_alone() -> None:
    scene = net(4, 3)
    scene = vv.Scene(scene.particles, vv.Damper([0, 1, 2], [1, 2, 3], 0.5), *scene.forces)
    own = np.random.default_rng(3).uniform(0.0, 2.0, (37, 3))
    copies = scene.ensemble(parameters={0: {"c": own}})
    together = copies.run(t=2.0, method="taylor", rtol=1e-10, threads=2)
    for copy, out in zip(copies, together, strict=True):
        assert np.array_equal(copy.run(t=2.0, method="taylor", rtol=1e-10).position, out.position)


def test_a_net_of_springs_and_dampers_loses_what_the_dampers_take() -> None:
    """dE/dt = −Σ c (d s/dt)², integrated along the motion by its own rows."""
    scene = net(5, 3)
    c = np.array([0.5, 0.25, 1.0, 0.75])
    scene = vv.Scene(scene.particles, vv.Damper([0, 1, 2, 3], [1, 2, 3, 4], c), *scene.forces)
    # Forty panels of twenty nodes: rates change fast where ends pass each other.
    nodes, weights = np.polynomial.legendre.leggauss(20)
    t = np.concatenate([0.05 * (panel + 0.5 + 0.5 * nodes) for panel in range(40)])
    out = scene.run(t=[0.0, *t, 2.0], rtol=1e-12)
    assert out.plan.method == "taylor"
    d = np.diff(out.position[1:-1], axis=1)
    rate = (d * np.diff(out.velocity[1:-1], axis=1)).sum(axis=2) / np.linalg.norm(d, axis=2)
    lost = np.tile(0.025 * weights, 40) @ (c * rate**2).sum(axis=1)
    # What forty panels of twenty nodes leave of a rate whose passages they do not follow to the last digit.
    assert out.energy[0] - out.energy[-1] == pytest.approx(lost, rel=1e-9, abs=0)
