"""Mergers under forces: what they keep, what they take, and motions through them that are known in closed form.

Bounds: runs err by 1e-13 a step, relative to places and velocities of size 1 to 10, in some tens of steps; sums over
bodies, and what follows without steps, by some roundings of numbers of that size.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from merging import CHARGE, FORCES, HOW, TIMES, contact

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray

SLOWED = [name for name in FORCES if name.startswith("an acceleration")]
#: Forces whose energy the table has as a whole: not that of relativity, which is complete to the first order only.
CONSERVATIVE = [name for name in FORCES if not any(word in name for word in (*SLOWED, "dampers", "relativ"))]
CENTRAL = ["spring between them", "springs", "dampers", "charges", "equal charges"]


@pytest.mark.parametrize("name", [name for name in FORCES if name not in (*SLOWED, "charges in a magnetic field")])
def test_momentum_changes_by_the_fields_alone(name: str) -> None:
    """Through all mergers: forces between bodies keep it, an electric field gives Q E t with the charge of all."""
    out, _, _ = contact(name)
    pulled = np.multiply.outer(TIMES, [0.1, 0.2, 0.3]) * sum(CHARGE) if "electric" in name else np.zeros((10, 3))
    np.testing.assert_allclose(out.momentum - out.momentum[0], pulled, rtol=0, atol=2e-14)


def test_the_canonical_momentum_in_a_magnetic_field() -> None:
    """P − Σ q r × B is constant, and a merger changes it by charges that go to the center of mass."""
    out, met, left = contact("charges in a magnetic field")

    def kept(momentum: NDArray[Any], charge: Any, position: NDArray[Any]) -> NDArray[Any]:
        return momentum - np.cross(np.einsum("i,...ij->...j", charge, position), [0.1, 0.2, 0.3])

    later, merged = out.t > met.t0, [0.5, 0.0, 0.25, 0.125]
    before = kept(out.momentum[~later], CHARGE, out.position[~later])
    after = kept(out.momentum[later], merged, out.position[later])
    np.testing.assert_allclose(before, before[[0] * len(before)], rtol=0, atol=2e-14)
    np.testing.assert_allclose(after, after[[0] * len(after)], rtol=0, atol=2e-14)
    moved = np.multiply(CHARGE, 1.0) @ met.particles.position - np.delete(merged, 1) @ left.particles.position
    np.testing.assert_allclose(after[0] - before[0], np.cross(moved, [0.1, 0.2, 0.3]), rtol=0, atol=2e-14)
    assert np.abs(after[0] - before[0]).max() > 1e-3


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_a_merger_takes_the_energy_that_it_says(name: str) -> None:
    """Constant before and after, and less by ½ μ v² of the two and by the potential energy that is no longer there."""
    out, met, left = contact(name)
    lost, relative = out.collisions.energy_lost[0], met.particles.velocity[1] - met.particles.velocity[0]
    assert lost == pytest.approx(5.0 * 1.0 / 6.0 / 2.0 * relative @ relative, rel=1e-12, abs=0)
    here, there = met.invariants(), left.invariants()
    assert here.kinetic_energy - there.kinetic_energy == pytest.approx(lost, rel=1e-12, abs=0)
    expected = here.energy - lost - (here.potential_energy - there.potential_energy)
    second = out.collisions.t[1] if len(out.collisions) > 1 else math.inf
    later = (out.t > met.t0) & (out.t < second)
    size = here.kinetic_energy - here.potential_energy
    np.testing.assert_allclose(out.energy[out.t < met.t0], here.energy, rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(out.energy[later], expected, rtol=0, atol=1e-12 * size)
    assert later.any()


@pytest.mark.parametrize("name", CENTRAL)
def test_angular_momentum_is_less_by_that_of_the_two(name: str) -> None:
    """Forces along the line between two bodies keep it; of a merger they keep none about their center of mass."""
    out, met, _ = contact(name)
    before, after = out.t < met.t0, out.t > met.t0
    if len(out.collisions) > 1:
        after &= out.t < out.collisions.t[1]
    two = met.particles[[0, 1]]
    apart, relative = two.position[1] - two.position[0], two.velocity[1] - two.velocity[0]
    kept = out.angular_momentum[0]
    np.testing.assert_allclose(out.angular_momentum[before], kept[None].repeat(before.sum(), 0), rtol=0, atol=1e-12)
    kept = kept - 5.0 / 6.0 * np.cross(apart, relative)
    np.testing.assert_allclose(out.angular_momentum[after], kept[None].repeat(after.sum(), 0), rtol=0, atol=2e-12)
    assert before.any()
    assert after.any()


def through(bodies: vv.Particles, *forces: vv.forces.Force) -> tuple[vv.Trajectory, float, NDArray[np.bool_]]:
    """A run to t = 3 in which bodies 0 and 1 merge, when they do, and which rows are later."""
    out = vv.Scene(bodies, *forces).run(np.linspace(0.0, 3.0, 31), **HOW)
    assert out.collisions.survivor.tolist() == [0]
    first = float(out.collisions.t[0])
    return out, first, out.t > first


def test_two_charges_in_an_electric_field() -> None:
    """Parabolas until they touch, and that of the sum of charges on the sum of masses from then on."""
    mass, charge, E = np.array([3.0, 1.0]), np.array([1.0, -0.5]), np.array([0.2, -0.1, 0.3])
    place, velocity = np.array([[0.0, 0, 0], [3.0, 0.1, 0]]), np.array([[0.5, 0, 0], [-1.0, 0, 0.1]])
    bodies = vv.Particles(mass, place, velocity, radius=0.25)
    out, first, later = through(bodies, vv.UniformElectricField(E, charge))
    each = place + velocity * first + np.multiply.outer(charge / mass, E) * first**2 / 2
    assert np.linalg.norm(each[1] - each[0]) == pytest.approx(0.5, rel=1e-12, abs=0)
    t = out.t[later, None]
    center, drift, pull = mass @ place / 4.0, mass @ velocity / 4.0, 0.5 * E / 4.0
    np.testing.assert_allclose(out.position[later, 0], center + drift * t + pull * t**2 / 2, rtol=0, atol=1e-12)
    np.testing.assert_allclose(out.velocity[later, 0], drift + pull * t, rtol=0, atol=1e-12)


def test_two_charges_in_a_magnetic_field() -> None:
    """With one q/m the relative motion is the cyclotron motion that that of the center of mass is, before and after."""
    mass, place = np.array([3.0, 1.0]), np.array([[0.0, 0, 0], [2.0, -0.5, 0]])
    velocity, turning = np.array([[0.5, 0.2, 0.1], [-1.0, 0, 0]]), 0.5 * 1.2
    bodies = vv.Particles(mass, place, velocity, radius=0.25)
    out, first, later = through(bodies, vv.UniformMagneticField([0.0, 0.0, 1.2], 0.5 * mass))

    def cyclotron(r: NDArray[Any], v: NDArray[Any], t: Any) -> NDArray[Any]:
        # v′ = ω v × ẑ: clockwise about a field along z.
        sine, cosine = np.sin(turning * t) / turning, (1.0 - np.cos(turning * t)) / turning
        x, y = r[0] + v[0] * sine + v[1] * cosine, r[1] + v[1] * sine - v[0] * cosine
        return np.stack([x, y, r[2] + v[2] * t], axis=-1)

    apart = cyclotron(place[1] - place[0], velocity[1] - velocity[0], first)
    assert np.linalg.norm(apart) == pytest.approx(0.5, rel=1e-12, abs=0)
    expected = cyclotron(mass @ place / 4.0, mass @ velocity / 4.0, out.t[later])
    np.testing.assert_allclose(out.position[later, 0], expected, rtol=0, atol=1e-12)


def test_a_spring_on_what_is_absorbed_pulls_what_absorbs_it() -> None:
    """Body 2 swings with body 1 on a spring of no length, and from the merger on, slower, with what the two became."""
    mass = np.array([3.0, 1.0, 2.0])
    place = np.array([[0.5, 0, 0], [2.0, 0, 0], [2.0, 3.0, 0.5]])
    velocity = np.array([[1.5, 0.3, 0], [0, 0, 0], [0, 0.3, 0]])
    bodies = vv.Particles(mass, place, velocity, radius=[0.4, 0.4, 0.1])
    out, first, later = through(bodies, vv.Spring(1, 2, k=0.5))

    def swing(one: Any, other: Any, rates: Any, masses: Any, t: Any) -> tuple[NDArray[Any], NDArray[Any]]:
        """Places of two after a time, and their velocities: (…, 2, 3)."""
        total, rate = sum(masses), math.sqrt(0.5 * sum(masses) / math.prod(masses))
        t = np.asarray(t)[..., None]
        r, v = other - one, rates[1] - rates[0]
        sine, cosine = np.sin(rate * t), np.cos(rate * t)
        apart, speed = r * cosine + v / rate * sine, v * cosine - r * rate * sine
        drift = (masses[0] * rates[0] + masses[1] * rates[1]) / total
        center = (masses[0] * one + masses[1] * other) / total + drift * t
        shares = (-masses[1] / total, masses[0] / total)
        return (
            np.stack([center + share * apart for share in shares], axis=-2),
            np.stack([drift + share * speed for share in shares], axis=-2),
        )

    on_spring, rates = swing(place[1], place[2], velocity[1:], mass[1:], first)
    free = place[0] + velocity[0] * first
    assert np.linalg.norm(free - on_spring[0]) == pytest.approx(0.8, rel=1e-12, abs=0)
    joined, drift = (3.0 * free + on_spring[0]) / 4.0, (3.0 * velocity[0] + rates[0]) / 4.0
    expected, speeds = swing(joined, on_spring[1], (drift, rates[1]), (4.0, 2.0), out.t[later] - first)
    np.testing.assert_allclose(out.position[later][:, [0, 2]], expected, rtol=0, atol=3e-12)
    np.testing.assert_allclose(out.velocity[later][:, [0, 2]], speeds, rtol=0, atol=3e-12)


def test_a_damper_on_what_is_absorbed_slows_what_absorbs_it() -> None:
    """On a line: relative velocities fall as exp(−c t/μ), with the μ of body 1 and then of what it is a part of."""
    mass, c = np.array([3.0, 1.0, 2.0]), 0.7
    place, velocity = np.array([0.0, 2.0, 9.0]), np.array([1.0, 0.0, 0.5])
    bodies = vv.Particles(mass, *(np.multiply.outer(of, [1.0, 0, 0]) for of in (place, velocity)), radius=0.25)
    out, first, later = through(bodies, vv.Damper(1, 2, c=c))

    def damped(x: Any, v: Any, masses: Any, t: Any) -> tuple[Any, Any]:
        rate, total = c * sum(masses) / math.prod(masses), sum(masses)
        drift, center = (masses @ v) / total, (masses @ x) / total
        gone = -np.expm1(-rate * np.asarray(t)[..., None])
        shares = np.array([-masses[1], masses[0]]) / total
        apart = x[1] - x[0] + (v[1] - v[0]) / rate * gone
        return center + drift * np.asarray(t)[..., None] + shares * apart, drift + shares * (v[1] - v[0]) * (1 - gone)

    at, rates = damped(place[1:], velocity[1:], mass[1:], first)
    assert at[0] - (place[0] + velocity[0] * first) == pytest.approx(0.5, rel=1e-12, abs=0)
    joined = (3.0 * (place[0] + velocity[0] * first) + at[0]) / 4.0
    drift = (3.0 * velocity[0] + rates[0]) / 4.0
    expected, speeds = damped(
        np.array([joined, at[1]]), np.array([drift, rates[1]]), np.array([4.0, 2.0]), out.t[later] - first
    )
    np.testing.assert_allclose(out.position[later][:, [0, 2], 0], expected, rtol=0, atol=2e-12)
    np.testing.assert_allclose(out.velocity[later][:, [0, 2], 0], speeds, rtol=0, atol=2e-12)


@pytest.mark.parametrize("dragged", [[0], [1], [0, 1], None], ids=["survivor", "absorbed", "both", "LinearDrag"])
def test_drag_of_the_survivor_goes_on_and_that_of_the_absorbed_ends(dragged: list[int] | None) -> None:
    """Velocities fall as exp(−t/τ) of those that are dragged: of both, through the merger, that of their center."""
    tau, mass = 2.0, np.array([3.0, 1.0])
    place, velocity = np.array([[0.0, 0, 0], [2.0, 0.1, 0]]), np.array([[0.5, 0, 0.2], [-1.0, 0, 0]])
    drag: vv.forces.Force = vv.LinearDrag(tau)
    if dragged is not None:
        drag = vv.ExpressionForce(acceleration=lambda r, v, t: [-v[0] / 2, -v[1] / 2, -v[2] / 2], bodies=dragged)
    slowed = np.array([dragged is None or body in dragged for body in (0, 1)])
    out, first, later = through(vv.Particles(mass, place, velocity, radius=0.25), drag)

    def coasts(r: Any, v: Any, how: Any, t: Any) -> tuple[Any, Any]:
        left = np.where(how, np.exp(-t / tau), 1.0)
        return r + v * np.where(how, tau * -np.expm1(-t / tau), t), v * left

    r, v = coasts(place, velocity, slowed[:, None], first)
    assert np.linalg.norm(r[1] - r[0]) == pytest.approx(0.5, rel=1e-12, abs=0)
    expected, speeds = coasts(mass @ r / 4.0, mass @ v / 4.0, slowed[0], out.t[later, None] - first)
    np.testing.assert_allclose(out.position[later, 0], expected, rtol=0, atol=1e-12)
    np.testing.assert_allclose(out.velocity[later, 0], speeds, rtol=0, atol=1e-12)
