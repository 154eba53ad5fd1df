"""Massless bodies beside flattened and relativistic ones: each follows the massive ones by itself, to the last bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

ADAPTIVE = [method.name for method in vv.methods() if method.adaptive]

FLAT = vv.Oblate(0, G=1.0, J2=0.02, radius=0.3, axis=[0.3, -0.2, 1.0], J4=-0.01)
UPRIGHT = vv.Oblate(0, G=1.0, J2=0.02, radius=0.3, axis=[0.0, 0.0, 2.0])
SEVERAL = vv.Oblate([2, 0], G=1.0, J2=[0.5, 0.02], radius=[0.1, 0.3], axis=[0.0, 1.0, 1.0])
CURVED = vv.PostNewtonian(0, G=1.0, c=20.0)
BOTH_CURVED = vv.PostNewtonian([1, 0], G=1.0, c=20.0)
FORCES = {
    "flat": (vv.Gravity(1.0), FLAT),
    "curved": (vv.Gravity(1.0), CURVED),
    "all": (SEVERAL, vv.UniformField([0.0, 1e-3, 0.0]), vv.Gravity(1.0, softening=0.01), BOTH_CURVED),
    "no gravity": (FLAT,),
}


def system(massive: int, massless: int, *, planar: bool = False) -> vv.Particles:
    """A star, lighter bodies about it that start with some speed out of their circles, and massless ones between."""
    rng = np.random.default_rng(massive)

    def orbits(radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle, tilt = rng.uniform(0.0, 2 * np.pi, radius.size), rng.uniform(-0.2, 0.2, radius.size) * (not planar)
        speed = rng.uniform(0.9, 1.1, radius.size) / radius**0.5
        x = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), tilt], axis=1)
        return x, speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), tilt], axis=1)

    planets, cloud = orbits(2.0 * 1.4 ** np.arange(massive - 1)), orbits(rng.uniform(1.0, 6.0, 150))
    mass = np.concatenate([[1.0], 1e-3 * rng.uniform(0.5, 2.0, massive - 1), np.zeros(massless)])
    parts = zip(([0.0, 0.0, 0.0], [0.01, 0.02, 0.0]), planets, cloud, strict=True)
    position, velocity = (np.vstack([star, near, far[:massless]]) for star, near, far in parts)
    return vv.Particles(mass, position, velocity)


def kept(particles: vv.Particles, which: Any) -> vv.Particles:
    return vv.Particles(particles.mass[which], particles.position[which], particles.velocity[which])


@pytest.mark.parametrize("method", ADAPTIVE)
@pytest.mark.parametrize("forces", FORCES.values(), ids=FORCES)
@pytest.mark.parametrize("massive", [3, 12])
def test_a_massless_body_has_the_bits_it_has_alone(massive: int, forces: tuple[vv.Force, ...], method: str) -> None:
    """And the massive ones those that they have without any; outputs lie between steps."""
    every = system(massive, 70)
    times = [-0.2, -1.4, -2.0] if massive == 12 else [0.5, 2.0, 3.1]
    how: dict[str, Any] = {"t": times, "method": method, "rtol": 1e-7}
    planets = vv.Scene(kept(every, np.arange(massive)), *forces).run(**how)
    outs = [vv.Scene(every, *forces).run(threads=threads, **how) for threads in (1, 3)]
    for out in outs:
        np.testing.assert_array_equal(out.position[:, :massive], planets.position)
        np.testing.assert_array_equal(out.velocity[:, :massive], planets.velocity)
        assert out.stats.evaluations == outs[0].stats.evaluations
    for index in (massive, massive + 37, massive + 69):
        alone = vv.Scene(kept(every, [*range(massive), index]), *forces).run(**how)
        for out in outs:
            np.testing.assert_array_equal(out.position[:, index], alone.position[:, -1])
            np.testing.assert_array_equal(out.velocity[:, index], alone.velocity[:, -1])


@pytest.mark.parametrize("method", ["dop853", "verner98", "tsitouras54", "taylor"])
@pytest.mark.parametrize("massless", [3, 20])
@pytest.mark.parametrize("planar", [False, True])
def test_copies_have_the_bits_they_have_alone(method: str, massless: int, planar: bool) -> None:
    """Up to eight bodies share lanes with those of other copies. Of masses, places and parameters of their own, and of
    a source that has no mass in one of them."""
    bodies = system(3, massless, planar=planar)
    grow = np.linspace(0.9, 1.1, 12)
    mass = bodies.mass * grow[:, None]
    mass[4, 0] = 0.0
    own = {"position": bodies.position * grow[::-1, None, None], "mass": mass}
    scene = vv.Scene(bodies, vv.Gravity(1.0), UPRIGHT, vv.PostNewtonian([0, 1], G=1.0, c=20.0))
    flattening = [vv.Oblate(0, G=1.0, J2=0.02 * s, radius=0.3, axis=[0, 0, 2.0]) for s in grow]
    relativity = [vv.PostNewtonian([0, 1], G=s, c=20.0) for s in grow]
    others = [(scene.forces[0], *two) for two in zip(flattening, relativity, strict=True)]
    parameters = {1: {"J2": 0.02 * grow}, 2: {"G": grow}}
    for given, sets in (({}, [scene.forces] * 12), ({"parameters": parameters}, others)):
        runs = [scene.ensemble(**own, **given).run(t=[0.4, 2.0], method=method, threads=n) for n in (1, 3)]
        for member, forces in enumerate(sets):
            own_bodies = vv.Particles(mass[member], own["position"][member], bodies.velocity)
            one = vv.Scene(own_bodies, *forces).run(t=[0.4, 2.0], method=method)
            for run in runs:
                np.testing.assert_array_equal(run.position[member], one.position)
                np.testing.assert_array_equal(run.velocity[member], one.velocity)


@pytest.mark.parametrize("method", ["dop853", "taylor"])
@pytest.mark.parametrize("forces", FORCES.values(), ids=FORCES)
@pytest.mark.parametrize("planar", [False, True])
def test_followers_have_the_acceleration_of_the_scene(method: str, forces: tuple[vv.Force, ...], planar: bool) -> None:
    """(v(h) − v(−h))/2h is the acceleration but for h²/6 of its second derivative, some hundredth of 1e-8 here, and for
    the rounding of v over h, 1e-12; relativity is strong (c = 20 beside speeds of one)."""
    if planar and any(isinstance(one, vv.Oblate) for one in forces):
        forces = (vv.Gravity(1.0), UPRIGHT)
    scene, h = vv.Scene(system(3, 12, planar=planar), *forces), 1e-4
    after, before = (scene.run(t=t, method=method, rtol=1e-13).velocity[-1] for t in (h, -h))
    found, expected = ((after - before) / (2 * h))[3:], scene.acceleration()[3:]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8 * np.linalg.norm(expected, axis=1).max())


@pytest.mark.parametrize("method", ["tsitouras54", "dop853", "verner98", "taylor"])
@pytest.mark.parametrize("forces", FORCES.values(), ids=FORCES)
def test_followers_go_where_bodies_of_tiny_mass_go(method: str, forces: tuple[vv.Force, ...]) -> None:
    """Those are integrated together with the massive ones and exert nothing that a number tells."""
    bodies = system(3, 9)
    masses = np.where(bodies.mass > 0.0, bodies.mass, 1e-40)
    joint = vv.Scene(vv.Particles(masses, bodies.position, bodies.velocity), *forces)
    how: dict[str, Any] = {"t": [0.9, 5.0, 12.0], "rtol": 1e-11}
    exact, out = (
        joint.run(**{**how, "rtol": 1e-13}, method="verner98"),
        vv.Scene(bodies, *forces).run(method=method, **how),
    )
    # About a hundred steps in up to twelve radians of the nearest, whose errors grow with the time.
    np.testing.assert_allclose(out.position, exact.position, rtol=0.0, atol=3e-8)
    np.testing.assert_allclose(out.velocity, exact.velocity, rtol=0.0, atol=3e-8)


@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
def test_satellites_of_a_flat_planet_precess(method: str) -> None:
    """dΩ/dt = −(3/2) n J2 (R/a)² cos i of circles, to first order in J2: beside a moon and each other."""
    j2, radius = 1e-5, 0.5
    tilt = np.array([0.2, 0.8, 1.2, 2.0, 2.9])
    zero = np.zeros_like(tilt)
    x = np.stack([zero + 1.0, zero, zero], axis=1)
    v = np.stack([zero, np.cos(tilt), np.sin(tilt)], axis=1)
    bodies = vv.Particles(
        np.concatenate([[1.0, 1e-14], zero]),
        np.vstack([[[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]], x]),
        np.vstack([[[0.0, 0.0, 0.0], [0.0, 30.0**-0.5, 0.0]], v]),
    )
    scene = vv.Scene(bodies, vv.Gravity(1.0), vv.Oblate(0, 1.0, j2, radius, [0, 0, 1.0]))
    turns = 20
    out = scene.run(t=2 * np.pi * np.linspace(0, turns, 40 * turns + 1), rtol=1e-12, method=method)
    ell = np.cross(out.position - out.position[:, :1], out.velocity - out.velocity[:, :1])[:, 2:]
    node = np.unwrap(np.arctan2(ell[..., 0], -ell[..., 1]), axis=0)
    # Means over whole turns take out what swings within one; the rest is of the order of J2².
    rate = (node[-40:].mean(axis=0) - node[1:41].mean(axis=0)) / (2 * np.pi * (turns - 1))
    share = j2 * radius**2
    np.testing.assert_allclose(rate, -1.5 * share * np.cos(tilt), rtol=0.0, atol=1e-4 * share)


@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
@pytest.mark.parametrize("drift", [0.0, 3.0])
def test_pericenters_of_massless_bodies_advance(method: str, drift: float) -> None:
    """6πGM/(c² a (1 − e²)) a turn, also about a star that moves. Means over turns of 2π, which is not quite the period,
    are off by a part in c²/80, 2e-5."""
    c, eccentric = 2000.0, np.array([0.2, 0.4, 0.6])
    zero = np.zeros_like(eccentric)
    speed = ((1.0 + eccentric) / (1.0 - eccentric)) ** 0.5
    bodies = vv.Particles(
        np.concatenate([[1.0, 1e-14], zero]),
        np.vstack([[[0.0, 0.0, 0.0], [40.0, 0.0, 0.0]], np.stack([1.0 - eccentric, zero, zero], axis=1)]),
        np.vstack([[[0.0, 0.0, 0.0], [0.0, 40.0**-0.5, 0.0]], np.stack([zero, speed, zero], axis=1)])
        + np.array([0.0, drift, 0.0]),
    )
    scene = vv.Scene(bodies, vv.Gravity(1.0), vv.PostNewtonian(0, 1.0, c))
    turns = 20
    out = scene.run(t=2 * np.pi * np.linspace(0, turns, 40 * turns + 1), rtol=1e-13, method=method)
    x, v = ((each - each[:, :1])[:, 2:] for each in (out.position, out.velocity))
    lenz = np.cross(v, np.cross(x, v)) - x / np.linalg.norm(x, axis=2)[..., None]
    angle = np.unwrap(np.arctan2(lenz[..., 1], lenz[..., 0]), axis=0)
    each = (angle[-40:].mean(axis=0) - angle[1:41].mean(axis=0)) / (turns - 1)
    expected = 6.0 * np.pi / (c**2 * (1.0 - eccentric**2))
    np.testing.assert_allclose(each, expected, rtol=1e-4, atol=0.0)


@pytest.mark.parametrize("method", ["dop853", "taylor"])
@pytest.mark.parametrize("forces", FORCES.values(), ids=FORCES)
def test_events_of_followers(method: str, forces: tuple[vv.Force, ...]) -> None:
    """Events leave every bit, and are found where outputs at their times are: within twice the tolerance of a step."""
    bodies = system(3, 20)
    how: dict[str, Any] = {"method": method, "rtol": 1e-10}
    scene = vv.Scene(bodies, *forces)
    plain = scene.run(t=[0.0, 6.0], **how)
    # Half of the way, and of what a distance changes by: passed for sure.
    start, end = plain.position
    apart = [np.linalg.norm(place[1] - place[5]) for place in (start, end)]
    asked = [
        vv.events.distance(1, 5, below=sum(apart) / 2, direction=0),
        vv.events.plane((start[7] + end[7]) / 2, end[7] - start[7], body=7),
    ]
    watched = scene.run(t=[0.0, 6.0], events=asked, **how)
    np.testing.assert_array_equal(watched.position, plain.position)
    assert len(watched.events.t) >= 2
    there = scene.run(t=np.concatenate([[0.0], np.unique(watched.events.t), [6.0]]), **how)
    order = np.argsort(watched.events.t)
    found, looked_at = watched.events.position[order], watched.events.which[order]
    for place, at, event in zip(there.position[1:-1], found, looked_at, strict=True):
        bodies_of = [1, 5] if event == 0 else [7]
        np.testing.assert_allclose(place[bodies_of], at[bodies_of], rtol=0.0, atol=1e-7)
