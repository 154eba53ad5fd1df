"""Spheres on which no force acts fly straight from one contact to the next: known times against steps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from numpy.typing import NDArray

import visviva as vv

Array = NDArray[np.float64]
RULES = ["bounce", "merge", "stop"]


def mixture(n: int, seed: int) -> dict[str, Any]:
    """Spheres of several sizes and masses, and some points without a mass, on a grid that lets none overlap."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(n ** (1 / 3)))
    grid = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)[:n] * 1.0
    point = random.random(n) < 0.25
    return {
        "mass": np.where(point, 0.0, 10.0 ** random.uniform(-2, 2, n)),
        "position": grid - 1.0 + 0.02 * random.normal(size=(n, 3)),
        "velocity": random.normal(size=(n, 3)) - 1.5 * (grid - 1.0),
        "radius": np.where(point, 0.0, random.uniform(0.1, 0.4, n)),
    }


def scene_of(given: dict[str, Any], t0: float = 0.0) -> vv.Scene:
    return vv.Scene(vv.Particles(**given), t0=t0)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("rule", RULES)
def test_known_times_are_those_that_steps_find(rule: str, seed: int) -> None:
    """The first collisions agree; what roundings are made of by more of them grows tenfold in each."""
    scene = scene_of(mixture(20, seed), t0=3.0)
    span = scene.t0 + np.linspace(0.0, 1.5, 7)
    options: dict[str, Any] = {"collisions": rule, "restitution": 0.8 if rule == "bounce" else None}
    known = scene.run(span, **options)
    found = scene.run(span, method="verner98", rtol=1e-12, **options)
    assert known.stats.steps == 0
    assert found.stats.steps > 0
    count = min(len(known.collisions), len(found.collisions), 12)
    assert count > 0
    assert rule != "bounce" or len(known.collisions) == len(found.collisions) > 5
    for name in ("t", "speed", "energy_lost", "position"):
        mine, theirs = getattr(known.collisions, name)[:count], getattr(found.collisions, name)[:count]
        np.testing.assert_allclose(mine, theirs, rtol=1e-8, atol=1e-8)
    for name in ("first", "second", "survivor"):
        np.testing.assert_array_equal(getattr(known.collisions, name)[:count], getattr(found.collisions, name)[:count])
    rows = min(len(known.t), len(found.t))
    assert len(known.t) == len(found.t)
    np.testing.assert_allclose(known.position[:rows], found.position[:rows], rtol=0, atol=1e-6)


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("t0", [0.0, -1e5])
def test_the_time_of_a_contact_to_the_last_digits(offset: float, t0: float) -> None:
    """|d + w t| = R, with 40 digits; a graze is as exact as its distance from the sphere allows."""
    random = np.random.default_rng(7)
    for depth in (0.0, 0.5, 0.9, 0.999999):
        along = random.normal(size=3)
        along /= np.linalg.norm(along)
        across = np.cross(along, [1.0, 0.0, 0.0])
        across *= depth / np.linalg.norm(across)
        position = np.array([[0.0, 0, 0], 40.0 * along + across]) + offset
        velocity = np.array([[0.0, 0, 0], -3.0 * along])
        given = {"mass": [1.0, 2.0], "position": position, "velocity": velocity, "radius": [0.25, 0.75]}
        out = scene_of(given, t0).run(t0 + 20.0, collisions="bounce")
        with mp.workdps(40):
            d = [mpf(b) - mpf(a) for a, b in zip(*position.tolist(), strict=True)]
            w = [mpf(b) - mpf(a) for a, b in zip(*velocity.tolist(), strict=True)]
            b = sum(x * y for x, y in zip(d, w, strict=True))
            root = mp.sqrt(b**2 - sum(y**2 for y in w) * (sum(x**2 for x in d) - 1))
            expected = mpf(t0) + (-b - root) / sum(y**2 for y in w)
            # The number of the time itself, and eight roundings of places where d ends on the sphere at this slope.
            slope = float(-root / 3)
            slack = 2.0**-52 * abs(t0 + 20) + 2.0**-50 * 40 / 3 / abs(slope)
            assert abs(float(expected - mpf(float(out.collisions.t[0])))) <= slack


@pytest.mark.parametrize("power", [400, -400, 900, -900])
def test_units_are_nobodys_business(power: int) -> None:
    """In lengths and times that differ by powers of two all bits are the same."""
    given = mixture(12, 3)
    length, time = 2.0**power, 2.0 ** (power // 2)
    other = given | {
        "position": given["position"] * length,
        "velocity": given["velocity"] * (length / time),
        "radius": given["radius"] * length,
    }
    one = scene_of(given).run([0.5, 2.0], collisions="bounce")
    two = scene_of(other).run([0.5 * time, 2.0 * time], collisions="bounce")
    assert len(one.collisions) == len(two.collisions) > 3
    np.testing.assert_array_equal(one.collisions.t * time, two.collisions.t)
    np.testing.assert_array_equal(one.position * length, two.position)


def test_time_runs_back() -> None:
    """Elastic bounces, reversed: as exact as some collisions of bodies with masses from 1e-2 to 1e2 leave it."""
    scene = scene_of(mixture(12, 5), t0=1.0)
    there = scene.run(2.0, collisions="bounce")
    back = there.final.run(1.0, collisions="bounce")
    assert len(there.collisions) == len(back.collisions) > 3
    np.testing.assert_allclose(back.position[-1], scene.particles.position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(back.collisions.t[::-1], there.collisions.t, rtol=0, atol=1e-9)


def test_contacts_at_one_time_are_settled_together() -> None:
    """A scene that is its own mirror image stays that: four balls meet one in the middle, which stays at rest."""
    ring = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    given = {
        "mass": np.ones(5),
        "position": np.vstack([np.zeros(3), 3.7 * ring]),
        "velocity": np.vstack([np.zeros(3), -1.1 * ring]),
        "radius": 0.5,
    }
    out = scene_of(given).run([0.0, 5.0], collisions="bounce")
    assert len(out.collisions) == 4
    assert np.ptp(out.collisions.t) == 0.0
    np.testing.assert_array_equal(out.velocity[-1, 0], 0.0)
    np.testing.assert_allclose(out.velocity[-1, 1:], 1.1 * ring, rtol=0, atol=1e-15)


def test_a_row_at_the_time_of_a_contact_is_of_before() -> None:
    given = {"mass": [1.0, 1.0], "position": [[-2.0, 0, 0], [2, 0, 0]], "velocity": [[1.0, 0, 0], [-1, 0, 0]]}
    scene = scene_of(given | {"radius": 0.5})
    for times in ([1.5, 2.0], [1.5]):
        out = scene.run(times, collisions="bounce")
        np.testing.assert_array_equal(out.velocity[0, :, 0], [1.0, -1.0])
        np.testing.assert_array_equal(out.final.particles.velocity[:, 0], [-1.0, 1.0])
        np.testing.assert_array_equal(out.collisions.t, [1.5])


@pytest.mark.parametrize("rule", RULES)
def test_copies_alone_and_a_field_beside(rule: str) -> None:
    """Copies with a force among copies without: each has the bits that it has alone, and the plan tells of both."""
    given = mixture(10, 11)
    scene = vv.Scene(vv.Particles(**given), vv.UniformField((0.0, 0.0, -1.0)))
    copies = scene.ensemble(parameters={scene.forces[0]: {"g": [[0.0, 0, 0], [0, 0, -1], [0, 0, 0]]}})
    out = copies.run([0.5, 1.5], collisions=rule, record=("position", "energy"))
    for index in range(3):
        alone = copies[index].run([0.5, 1.5], collisions=rule, record=("position", "energy"))
        rows = len(alone.t)
        np.testing.assert_array_equal(out.position[index, :rows], alone.position)
        np.testing.assert_array_equal(out.energy[index, :rows], alone.energy)
        np.testing.assert_array_equal(out[index].collisions.t, alone.collisions.t)
    assert "straight lines (2)" in str(copies.plan(1.5, collisions=rule))


def test_points_meet_no_points() -> None:
    """Ten thousand points and two spheres: the pairs of points are not looked at, which would take half a second."""
    random = np.random.default_rng(2)
    n = 10_000
    radius = np.zeros(n)
    radius[:2] = 0.05
    mass = np.where(radius > 0.0, 1.0, 0.0)
    x, v = random.uniform(-1, 1, (n, 3)), random.normal(size=(n, 3))
    out = vv.Scene(vv.Particles(mass, x, v, radius=radius)).run(0.2, collisions="bounce")
    assert len(out.collisions) > 0
    assert ((out.collisions.first < 2) | (out.collisions.second < 2)).all()


def test_spheres_that_have_met_without_a_bounce_part() -> None:
    """Oblique and perfectly plastic: what is left slides along the surface, which is no meeting."""
    for seed in range(60):
        random = np.random.default_rng(seed)
        x = np.array([[0.0, 0, 0], 0.3 * random.normal(size=3) + [4.0, 0, 0]]) + random.normal(size=3)
        v = np.array([[0.0, 0, 0], [-1.0, 0, 0]]) + random.normal(size=3)
        given = {"mass": [1.0, 1.0], "position": x, "velocity": v, "radius": 0.5}
        out = scene_of(given).run(10.0, collisions="bounce", restitution=0.0)
        other = scene_of(given).run(10.0, collisions="bounce", restitution=0.0, method="verner98")
        assert len(out.collisions) == len(other.collisions)
        np.testing.assert_allclose(out.position, other.position, rtol=0, atol=1e-8)


@pytest.mark.parametrize("rule", RULES)
def test_what_slides_past_another_does_not_meet_it(rule: str) -> None:
    """In contact at the start, with velocities across the line of centers, which rounding makes an approach of."""
    for seed in range(100):
        random = np.random.default_rng(seed)
        line = random.normal(size=3)
        line /= np.linalg.norm(line)
        across = np.cross(line, random.normal(size=3))
        carried = random.normal(size=3)
        given = {"mass": [1.0, 2.0], "position": [[0.0, 0, 0], line], "velocity": [carried, carried + across]}
        out = scene_of(given | {"radius": 0.5}).run([0.0, 5.0], collisions=rule)
        assert len(out.collisions) == 0
        np.testing.assert_allclose(out.position[-1, 1], line + 5 * (carried + across), rtol=0, atol=1e-14 * 10)


@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
def test_a_graze_is_one_meeting_that_changes_nothing(restitution: float) -> None:
    given = {
        "mass": [1.0, 1.0],
        "position": [[0.0, 0, 0], [-1, 4, 0]],
        "velocity": [[0.0, 0, 0], [0, -1, 0]],
        "radius": 0.5,
    }
    out = scene_of(given).run(20.0, collisions="bounce", restitution=restitution)
    np.testing.assert_array_equal(out.position[-1], [[0.0, 0, 0], [-1, -16, 0]])
    assert out.collisions.speed.tolist() == [0.0]
    assert out.collisions.t.tolist() == [4.0]


def test_tiny_spheres_far_away_meet_head_on() -> None:
    for radius in (5e-3, 5e-151, 5e-161, 5e-290):
        given = {"mass": [1.0, 1.0], "position": [[0.0, 0, 0], [3, 0, 0]], "velocity": [[1.0, 0, 0], [0, 0, 0]]}
        out = scene_of(given | {"radius": radius}).run(10.0, collisions="bounce")
        np.testing.assert_allclose(out.collisions.t, [3.0 - 2 * radius], rtol=0, atol=1e-15)
        np.testing.assert_array_equal(out.velocity[-1, :, 0], [0.0, 1.0])
