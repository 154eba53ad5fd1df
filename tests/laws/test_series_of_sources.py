"""Series of what flattening and relativity add to the pulls of bodies, in every arrangement of lanes.

Bounds: momenta are kept to the rounding of theirs, 1e-4, and energies to that of theirs in a step.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv


def planets(count: int, *, planar: bool = False) -> vv.Particles:
    """A heavy body and light ones about it on orbits of some eccentricity."""
    rng = np.random.default_rng(count)
    mass = np.concatenate([[1.0], 1e-4 * rng.uniform(0.5, 2.0, count - 1)])
    radius = 1.0 + 0.7 * np.arange(count - 1)
    angle = 2.4 * np.arange(count - 1)
    zero = np.zeros(count - 1)
    tilt = zero if planar else 0.1 * rng.standard_normal(count - 1)
    place = np.stack([radius * np.cos(angle), radius * np.sin(angle), tilt], axis=1)
    speed = (
        np.stack([-np.sin(angle), np.cos(angle), zero], axis=1)
        * (rng.uniform(0.9, 1.1, count - 1) / radius**0.5)[:, None]
    )
    return vv.Particles(mass, np.vstack([np.zeros(3), place]), np.vstack([np.zeros(3), speed]))


FLAT = vv.Oblate([0], G=1.0, J2=0.02, J4=-0.01, radius=0.5, axis=[0.3, -0.2, 1.0])
UPRIGHT = vv.Oblate([0], G=1.0, J2=0.02, J4=0.0, radius=0.5, axis=[0.0, 0.0, 2.0])
SEVERAL = vv.Oblate([0, 1], G=1.0, J2=[0.02, 0.3], radius=[0.5, 0.05], axis=[0.0, 1.0, 1.0])
CURVED = vv.PostNewtonian([0], G=1.0, c=20.0)


@pytest.mark.parametrize("count", [2, 4, 9, 12])
@pytest.mark.parametrize(
    "forces",
    [(FLAT,), (SEVERAL,), (CURVED,), (CURVED, FLAT), (CURVED, vv.UniformField((0.0, 0.0, -0.1)))],
    ids=["flat", "several", "curved", "both", "in a field"],
)
def test_they_lead_where_another_method_does(count: int, forces: tuple[vv.Force, ...]) -> None:
    scene = vv.Scene(planets(count), vv.Gravity(G=1.0), *forces)
    series, other = (scene.run(t=20.0, method=method, rtol=1e-12) for method in ("taylor", "verner98"))
    assert series.stats.method == "taylor"
    # 1e-12 a step, some hundreds of steps whose errors grow with the time.
    np.testing.assert_allclose(series.position[-1], other.position[-1], rtol=0.0, atol=2e-9)
    np.testing.assert_allclose(series.velocity[-1], other.velocity[-1], rtol=0.0, atol=2e-9)


@pytest.mark.parametrize("count", [2, 4, 9])
@pytest.mark.parametrize(("force", "planar"), [(FLAT, False), (CURVED, False), (UPRIGHT, True), (CURVED, True)])
def test_a_member_has_the_bits_that_it_has_alone(count: int, force: vv.Force, planar: bool) -> None:
    scene = vv.Scene(planets(count, planar=planar), vv.Gravity(G=1.0), force)
    bodies = scene.particles
    velocity = bodies.velocity * np.linspace(0.97, 1.03, 11)[:, None, None]
    mass = bodies.mass * np.linspace(0.9, 1.1, 11)[:, None]
    many = scene.ensemble(velocity=velocity, mass=mass)
    runs = [many.run(t=5.0, method="taylor", threads=threads) for threads in (1, 3)]
    np.testing.assert_array_equal(runs[0].position, runs[1].position)
    for member in (0, 5, 10):
        own = vv.Particles(mass[member], bodies.position, velocity[member])
        alone = vv.Scene(own, *scene.forces).run(t=5.0, method="taylor")
        np.testing.assert_array_equal(alone.position[-1], runs[0].position[member, -1])


def test_momentum_is_kept_and_so_is_the_energy_of_flattening() -> None:
    scene = vv.Scene(planets(5), vv.Gravity(G=1.0), SEVERAL)
    out = scene.run(t=[0.0, 50.0], method="taylor", rtol=1e-13, record=("momentum", "energy"))
    np.testing.assert_allclose(out.momentum[-1], out.momentum[0], rtol=0.0, atol=4e-18)
    np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=1e-14)


def test_the_advance_of_a_pericenter() -> None:
    """6πGM/(c² a (1 − e²)) a turn (Schwarzschild), to the order 1/c⁴ that the field leaves out."""
    a, e, c = 1.0, 0.6, 200.0
    place, speed = a * (1.0 - e), ((1.0 + e) / (1.0 - e)) ** 0.5
    light = vv.Particles([1.0, 1e-12], [[0.0, 0.0, 0.0], [place, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, speed, 0.0]])
    scene = vv.Scene(light, vv.Gravity(G=1.0), vv.PostNewtonian([0], G=1.0, c=c))
    out = scene.run(t=40.0 * np.pi, method="taylor", rtol=1e-13, events=[vv.events.apsis(1, 0)])
    place = out.events.position[:, 1] - out.events.position[:, 0]
    near = place[np.linalg.norm(place, axis=1) < 1.0]
    turned = np.unwrap(np.arctan2(near[:, 1], near[:, 0]))
    each = np.diff(turned).mean()
    expected = 6.0 * np.pi / (c**2 * a * (1.0 - e**2))
    assert each == pytest.approx(expected, rel=30.0 / c**2, abs=0)
