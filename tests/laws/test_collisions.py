"""Spheres that touch: where, and what becomes of them.

Bounds: impulses, and what they keep, are sums of a few products of numbers of size 1: 1e-14 of them, volumes and
masses that are added 1e-15; oblique ones lose a digit to the direction between the centers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from colliding import crowd, each_method, head_on, how, spheres

import visviva as vv

EPSILON = float(np.finfo(float).eps)


@each_method
@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
@pytest.mark.parametrize("masses", [(1.0, 1.0), (1.0, 3.0), (0.0, 2.0), (0.0, 0.0)])
def test_head_on(method: str, restitution: float, masses: tuple[float, float]) -> None:
    out = head_on(*masses).run([0.0, 1.0, 1.625, 2.0], collisions="bounce", restitution=restitution, **how(method))
    table = out.collisions
    # A sum of a hundred steps, each rounded.
    assert table.t == pytest.approx([1.625], rel=1e-14, abs=0)
    assert table.speed == pytest.approx([2.0], rel=1e-14, abs=0)
    assert np.allclose(table.position, [[0.125, 0.0, 0.0]], rtol=0.0, atol=1e-14)
    m1, m2 = masses if any(masses) else (1.0, 1.0)
    mean, part = (m1 - m2) / (m1 + m2), 2.0 * restitution / (m1 + m2)
    after = np.array([mean - part * m2, mean + part * m1])
    assert np.allclose(out.velocity[-1, :, 0], after, rtol=0.0, atol=1e-14)
    assert np.allclose(out.position[-1, :, 0], [-0.375, 0.375] + after * 0.375, rtol=0.0, atol=1e-13)
    reduced = m1 * m2 / (m1 + m2) if any(masses) else 0.0
    assert table.energy_lost == pytest.approx([2.0 * reduced * (1.0 - restitution**2)], rel=1e-13, abs=0)
    # The row at the time of contact is of before.
    assert np.allclose(out.velocity[1:3, :, 0], [1.0, -1.0], rtol=0.0, atol=1e-14)
    assert out.status is vv.Status.OK


@each_method
def test_oblique_impulses_are_along_the_line_of_centers(method: str) -> None:
    x = np.array([[-1.0, 0.1, 0.2], [1.5, -0.2, 0.1]])
    v = np.array([[1.0, 0.2, -0.1], [-0.5, 0.3, 0.2]])
    mass, radius = np.array([1.0, 2.5]), 0.4
    out = spheres(mass, x, v, radius).run([0.0, 3.0], collisions="bounce", restitution=0.75, **how(method))
    d, u = x[1] - x[0], v[1] - v[0]
    b, c = d @ u, d @ d - 0.64
    t = (-b - np.sqrt(b * b - (u @ u) * c)) / (u @ u)
    assert out.collisions.t == pytest.approx([t], rel=1e-14, abs=0)
    normal = (d + t * u) / 0.8
    impulse = 1.75 * mass.prod() / mass.sum() * (normal @ u) * normal
    assert np.allclose(out.velocity[-1], v + np.array([impulse, -impulse]) / mass[:, None], rtol=0.0, atol=1e-14)
    assert np.allclose(out.momentum[1], out.momentum[0], rtol=0.0, atol=1e-14)
    assert np.allclose(out.angular_momentum[1], out.angular_momentum[0], rtol=0.0, atol=1e-14)
    lost = out.kinetic_energy[0] - out.kinetic_energy[1]
    assert out.collisions.energy_lost[0] == pytest.approx(lost, rel=1e-14, abs=0)


@pytest.mark.parametrize("speed", [1.0, 1e3, 1e6, 1e9])
@pytest.mark.parametrize("offset", [0.0, 0.15, 0.2 * (1.0 - 1e-10), 0.2 * (1.0 - 1e-12)])
@pytest.mark.parametrize("options", [{}, {"method": "leapfrog", "dt": 1.0}, {"method": "rk4", "dt": 7.0}])
def test_no_approach_is_too_short_for_a_step(speed: float, offset: float, options: dict[str, Any]) -> None:
    # Up to 10^11 radii in a step; grazing by a part of 10^12 of the radius.
    scene = spheres([1, 2], [[-3, offset, 0], [3, 0, 0]], [[speed, 0, 0], [-speed, 0, 0]], 0.1)
    out = scene.run(100.0, collisions="stop", **options)
    exact = (6.0 - np.sqrt((0.2 - offset) * (0.2 + offset))) / (2.0 * speed)
    assert out.status is vv.Status.STOPPED
    # Near grazing the time of contact is known as the root of the rounding of the distance, an ulp of 6, is.
    chord = np.sqrt((0.2 - offset) * (0.2 + offset))
    assert out.collisions.t[0] == pytest.approx(exact, rel=4 * EPSILON + 8 * EPSILON / chord, abs=0)
    assert out.final.t0 == out.collisions.t[0]


def test_what_passes_by_is_no_contact() -> None:
    for speed in (1.0, 1e6):
        scene = spheres([1, 2], [[-3, 0.2 * (1 + 1e-12), 0], [3, 0, 0]], [[speed, 0, 0], [-speed, 0, 0]], 0.1)
        for options in ({}, {"method": "leapfrog", "dt": 1.0}):
            out = scene.run(100.0, collisions="stop", **options)
            assert len(out.collisions) == 0
            assert out.status is vv.Status.OK


@each_method
def test_newtons_cradle(method: str) -> None:
    x = np.zeros((5, 3))
    x[:, 0] = np.arange(5)
    x[0, 0] = -1.0
    v = np.zeros((5, 3))
    v[0, 0] = 1.0
    out = spheres(np.ones(5), x, v, 0.5).run(2.0, collisions="bounce", **how(method))
    assert out.collisions.first.tolist() == [0, 1, 2, 3]
    assert np.allclose(out.collisions.t, 1.0, rtol=0.0, atol=1e-14)
    assert np.allclose(out.velocity[-1, :, 0], [0, 0, 0, 0, 1], rtol=0.0, atol=1e-14)


def dropped(height: float = 1.0) -> vv.Scene:
    """A ball above a plate that nothing moves, in a field that acts on the ball alone, whose acceleration is 2."""
    field = vv.UniformElectricField((0.0, 0.0, -2.0), charge=[0.0, 1.0])
    return spheres([1e30, 1.0], [[0, 0, 0], [0, 0, 1.25 + height]], np.zeros((2, 3)), [1.0, 0.25], field)


@each_method
def test_a_ball_bounces_to_its_end(method: str) -> None:
    part = 0.8
    options = {**how(method)}
    out = dropped().run(4.0, collisions="bounce", restitution=part, **options)
    flights = np.arange(len(out.collisions))
    exact = 1.0 + 2.0 * part * (1.0 - part**flights) / (1.0 - part)
    assert len(flights) == 3
    # Tolerances of 1e-9 hold the motion to that at least; fixed steps are exact for a parabola.
    assert np.allclose(out.collisions.t, exact, rtol=0.0, atol=1e-12)
    with pytest.raises(vv.ConvergenceError, match="came to rest") as caught:
        dropped().run(20.0, collisions="bounce", restitution=part, **options)
    run = caught.value.trajectory
    assert run.status is vv.Status.RESTING
    assert len(run.collisions) > 60
    # The last flights are too low to be told from contact, which is 1e-12 of the radii: the root of that in time.
    assert caught.value.time == pytest.approx((1.0 + part) / (1.0 - part), abs=1e-5)
    assert caught.value.time == run.final.t0


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_what_rests_at_the_start_is_told_at_once(restitution: float) -> None:
    with pytest.raises(vv.ConvergenceError, match="bodies 0 and 1 came to rest"):
        dropped(0.0).run(5.0, collisions="bounce", restitution=restitution)


def test_elastic_bounces_go_on() -> None:
    out = dropped().run(400.0, collisions="bounce")
    # 200 flights, each to the round-off of the time; the energy of the ball is 2.
    assert np.allclose(out.collisions.t, 1.0 + 2.0 * np.arange(200), rtol=0.0, atol=1e-11)


def test_many_bounces_conserve() -> None:
    scene = crowd(20, 1)
    out = scene.run([0.0, 700.0], collisions="bounce", method="kahan_li8", dt=0.1)
    table = out.collisions
    assert len(table) > 9_000
    # Rounding of 10^4 impulses of about 1, and of their places.
    assert abs(out.energy[1] / out.energy[0] - 1.0) < 1e-10
    assert np.abs(out.angular_momentum[1] - out.angular_momentum[0]).max() < 1e-9
    last = out.position[-1]
    apart = np.linalg.norm(last[:, None] - last, axis=-1) + np.eye(20)
    assert apart.min() > 0.7 * (1.0 - 1e-9), "no sphere is inside another"
    assert (np.diff(table.t) >= 0.0).all()
    assert not table.energy_lost.any()
    assert (table.survivor == -1).all()


@pytest.mark.parametrize("options", [{"rtol": 1e-13}, {"method": "kahan_li8", "dt": 0.02}])
def test_elastic_bounces_are_retraced(options: dict[str, Any]) -> None:
    scene = crowd(9, 5)
    there = scene.run(2.0, collisions="bounce", **options)
    back = there.final.run(0.0, collisions="bounce", **options)
    assert len(there.collisions) == len(back.collisions) > 5
    # Ten bounces of convex bodies, each of which multiplies rounding by a few.
    assert np.abs(back.final.particles.position - scene.particles.position).max() < 1e-10
    assert np.allclose(back.collisions.t[::-1], there.collisions.t, rtol=0.0, atol=1e-10)


@each_method
def test_a_merger_keeps_what_it_must(method: str) -> None:
    scene = crowd(12, 3)
    p = scene.particles
    free = vv.Scene(p)
    out = free.run([0.0, 0.5, 1.0], collisions="merge", **how(method))
    after = out.final.particles
    assert len(out.collisions) > 0
    assert after.mass.sum() == pytest.approx(p.mass.sum(), rel=1e-15, abs=0)
    assert (after.radius**3).sum() == pytest.approx((p.radius**3).sum(), rel=1e-14, abs=0)
    assert np.allclose(out.momentum, out.momentum[0], rtol=0.0, atol=1e-13)
    drift = out.center_of_mass[0] + np.multiply.outer(out.t, out.momentum[0] / p.mass.sum())
    assert np.allclose(out.center_of_mass, drift, rtol=0.0, atol=1e-14)
    lost = out.kinetic_energy[0] - out.kinetic_energy[-1]
    assert out.collisions.energy_lost.sum() == pytest.approx(lost, rel=1e-14, abs=0)
    for line in range(len(out.collisions)):
        first, second, left = (int(getattr(out.collisions, name)[line]) for name in ("first", "second", "survivor"))
        gone = first + second - left
        assert after.mass[gone] == 0.0
        assert after.radius[gone] == 0.0
    gone = after.mass == 0.0
    there = {tuple(row) for row in np.hstack([after.position, after.velocity])[~gone].tolist()}
    assert all(tuple(row) in there for row in np.hstack([after.position, after.velocity])[gone].tolist())


def test_the_more_massive_survives_and_of_equals_the_first() -> None:
    for masses, left in (((1.0, 3.0), 1), ((3.0, 1.0), 0), ((2.0, 2.0), 0), ((0.0, 1.0), 1), ((0.0, 0.0), 0)):
        out = head_on(*masses).run(2.0, collisions="merge")
        assert out.collisions.survivor.tolist() == [left]
        assert out.final.particles.mass[left] == sum(masses)
        assert out.final.particles.radius[left] == pytest.approx((0.5**3 + 0.25**3) ** (1 / 3), rel=1e-15, abs=0)


def test_a_merged_body_that_reaches_others_takes_them() -> None:
    # 0 and 1 meet at t = 1 at x = 0; the merged radius of 0.63 reaches the one that rests at y = 1.1.
    scene = spheres(
        [1, 1, 1], [[-1.5, 0, 0], [1.5, 0, 0], [0, 1.1, 0]], [[1, 0, 0], [-1, 0, 0], [0, 0, 0]], [0.5, 0.5, 0.5]
    )
    out = scene.run(2.0, collisions="merge")
    assert np.allclose(out.collisions.t, 1.0, rtol=0.0, atol=1e-14)
    assert len(out.collisions) == 2
    assert out.final.particles.mass.tolist() == [3.0, 0.0, 0.0]
    assert np.allclose(out.position[-1], [0.0, 1.1 / 3.0, 0.0], rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("options", [{"rtol": 1e-12}, {"method": "leapfrog", "dt": 1e-3}])
def test_what_falls_onto_a_star_is_taken_in(options: dict[str, Any]) -> None:
    start = np.array([1.0, 1.5, 2.0])
    x = np.zeros((4, 3))
    x[1:] = start[:, None] * np.array([[1, 0, 0], [0, 1, 0], [0, 0, -1]])
    radius = np.array([0.3, 0.0, 0.0, 0.0])
    scene = spheres([1.0, 0, 0, 0], x, np.zeros((4, 3)), radius, vv.Gravity(G=1.0))
    out = scene.run(5.0, collisions="merge", **options)
    part = radius[0] / start
    exact = start**1.5 / np.sqrt(2.0) * (np.arccos(np.sqrt(part)) + np.sqrt(part * (1.0 - part)))
    # The order-2 steps are off by (1e-3)² times the acceleration near the star, 10.
    assert np.allclose(out.collisions.t, exact, rtol=0.0, atol=1e-10 if "rtol" in options else 1e-5)
    assert out.final.particles.mass.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert out.final.particles.radius[0] == 0.3
    assert not out.position[-1].any()


def test_planetesimals_become_one_and_columns_know_it() -> None:
    random = np.random.default_rng(7)
    x = np.array([[i % 3, (i // 3) % 3, i // 9] for i in range(15)], dtype=float)
    scene = spheres(random.uniform(0.5, 1.5, 15), x, 0.1 * random.normal(size=(15, 3)), 0.2, vv.Gravity(G=1.0))
    times = np.linspace(0.0, 3.0, 7)
    out = scene.run(times, collisions="merge")
    recorded = scene.run(times, collisions="merge", record=["energy", "momentum", "angular_momentum", "virial"])
    assert len(out.collisions) > 5
    assert out.collisions.t.tolist() == recorded.collisions.t.tolist()
    for column in ("energy", "momentum", "virial", "angular_momentum"):
        # Derived from the rounded states, and at the record from those with their compensation.
        assert np.allclose(getattr(out, column), getattr(recorded, column), rtol=1e-12, atol=1e-12), column
    assert np.allclose(out.momentum, out.momentum[0], rtol=0.0, atol=1e-12)
    assert out.angular_momentum_about("center_of_mass").shape == (7, 3)
    table = out.conservation()
    assert table.momentum.max < 1e-13
    assert table.center_of_mass.max < 1e-12
    assert out.final.particles.mass.sum() == pytest.approx(scene.particles.mass.sum(), rel=1e-14, abs=0)
    gone = np.flatnonzero(out.final.particles.mass == 0.0)
    with pytest.raises(vv.InvalidInput, match="become a part of another"):
        out.elements(about=int(gone[0]))


def test_elements_of_copies_in_some_of_which_the_center_has_merged() -> None:
    """All copies were refused for the one."""
    places, velocity = [[0.0, 0, 0], [3, 0, 0], [6.0, 0.1, 0]], np.array([[1.0, 0, 0], [-0.5, 0, 0], [-1, 0, 0]])
    scene = spheres([1.0, 2.0, 3.0], places, velocity, 0.3, vv.Gravity(0.05))
    out = scene.ensemble(velocity=[velocity, -velocity]).run([0.0, 1.0, 5.0], collisions="merge")
    assert set(out.collisions.member) == {0}
    found, alone = out.elements(about=0), out[1].elements(about=0)
    for name in ("semi_major_axis", "mu", "eccentricity"):
        values = getattr(found, name)
        np.testing.assert_array_equal(values[1], getattr(alone, name))
        assert np.isfinite(values[0, :2]).all()
        assert np.isnan(values[0, 2]).all()
    both = scene.ensemble(velocity=[velocity, velocity]).run([0.0, 1.0, 5.0], collisions="merge")
    with pytest.raises(vv.InvalidInput, match="become a part of another"):
        both.elements(about=0)


@pytest.mark.parametrize("mass", [0.0, 1e-30])
def test_a_light_ball_between_two_that_come_together_bounces_infinitely_often(mass: float) -> None:
    """A run past the end hung. Each bounce adds twice the speed of a wall: after n of them the gap is as 1/n."""
    places = [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.1, 0.0, 0.0]]
    speeds = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    scene = spheres([1.0, 1.0, mass], places, speeds, [0.3, 0.3, 0.2])
    out = scene.run(1.49, collisions="bounce")
    assert out.status is vv.Status.OK
    assert abs(out.velocity[-1, 2, 0]) == pytest.approx(2.0 * len(out.collisions), rel=1e-12, abs=0.0)
    with pytest.raises(vv.ConvergenceError, match="infinitely often") as caught:
        scene.run(2.0, collisions="bounce")
    run = caught.value.trajectory
    assert run.status is vv.Status.RESTING
    assert run.final.t0 == pytest.approx(1.5, abs=1e-3)
    # One such copy does not stop the others.
    copies = scene.ensemble(position=[places, [*places[:2], [0.1, 3.0, 0.0]]])
    many = copies.run(2.0, collisions="bounce")
    assert many.status.tolist() == [int(vv.Status.RESTING), int(vv.Status.OK)]


def test_a_ball_with_a_mass_turns_the_walls_back() -> None:
    """Galperin: with masses M and m, π √(M/m) bounces off one wall and one block; here off two."""
    places, speeds = [[-2.0, 0, 0], [2.0, 0, 0], [0.1, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0], [0.0, 0, 0]]
    scene = spheres([1.0, 1.0, 1e-6], places, speeds, [0.3, 0.3, 0.2])
    out = scene.run(4.0, collisions="bounce", record=("position", "velocity", "energy"))
    assert out.status is vv.Status.OK
    assert np.allclose(out.velocity[-1, :2, 0], [-1.0, 1.0], rtol=0.0, atol=1e-2)
    assert out.energy[-1] == pytest.approx(out.energy[0], rel=1e-9, abs=0.0)


@pytest.mark.parametrize("digits", [1, 2, 3, 4])
def test_bounces_count_the_digits_of_pi(digits: int) -> None:
    """G. Galperin, Regul. Chaotic Dyn. 8 (2003) 375, eq. (1): a wall, a ball, and one of 100^n times its mass."""
    wall, ball, heavy = 1e16, 1.0, 100.0**digits
    places, speeds = [[0, 0, 0], [2, 0, 0], [4, 0, 0]], [[0, 0, 0], [0, 0, 0], [-1, 0, 0]]
    out = spheres([wall, ball, heavy], places, speeds, 0.5).run(50.0, collisions="bounce")
    assert len(out.collisions) == int(np.pi * 10**digits)
    # The heavy one comes back; what the wall and the ball have of its energy is 2/M of it at most.
    assert out.velocity[-1, 2, 0] == pytest.approx(1.0, rel=4.0 / heavy, abs=0.0)


def test_elastic_balls_on_a_heavy_one_rest() -> None:
    """They part by less than their roundings, by turns: neither is thrown to and fro."""
    places = [[0, 0, 0], [0, 1.5, 0], [1.5, 0, 0]]
    scene = spheres([1.0, 1e-6, 1e-6], places, np.zeros((3, 3)), [1.0, 0.5, 0.5], vv.Gravity(G=1.0))
    with pytest.raises(vv.ConvergenceError, match="rest") as caught:
        scene.run(5.0, collisions="bounce")
    assert len(caught.value.trajectory.collisions) < 10_000


def test_a_fast_ball_between_slow_walls_bounces_on() -> None:
    """Thousands of bounces, each harder and sooner, tell of no end while the walls are far apart: they meet at 1.5."""
    places, speeds = [[-2.0, 0, 0], [2.0, 0, 0], [0.1, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0], [1e5, 0, 0]]
    scene = spheres([1.0, 1.0, 0.0], places, speeds, [0.3, 0.3, 0.2])
    out = scene.run(0.2, collisions="bounce")
    assert out.status is vv.Status.OK
    # Each bounce adds twice the speed of a wall, 1.
    assert len(out.collisions) > 4096
    assert abs(out.velocity[-1, 2, 0]) == pytest.approx(1e5 + 2.0 * len(out.collisions), rel=1e-12, abs=0.0)
