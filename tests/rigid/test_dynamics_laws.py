"""Laws of rigid bodies in scenes that nobody chose: conservation, frames, units, members, whatever is combined.

Bounds: roundings of the numbers, of size up to 11, of runs that symmetries carry into each other; twenty times what
was seen.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import visviva as vv

SEEDS = st.integers(0, 10**6)
EXAMPLES = 12


def unit(rng: np.random.Generator, *shape: int) -> np.ndarray:
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def moments(rng: np.random.Generator) -> np.ndarray:
    """Of a body: sums of three positive numbers, two by two; now and then two or three of them agree."""
    a, b, c = rng.uniform(0.02, 0.1, 3)
    kind = rng.integers(0, 5)
    if kind == 0:
        a = b
    if kind == 1:
        a = b = c
    return np.array([b + c, c + a, a + b])


def scene(seed: int, *, lossy: bool = False) -> vv.Scene:
    """Bodies far enough from each other that nothing is wild, with forces of every kind that keep the energy."""
    rng = np.random.default_rng(seed)
    count, particles = int(rng.integers(1, 4)), int(rng.integers(0, 3))
    places = 4.0 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0]])[: count + particles]
    places += rng.uniform(-0.5, 0.5, places.shape)
    turn = unit(rng, count)
    pivot = np.full((count, 3), np.nan)
    if rng.random() < 0.4:
        pivot[0] = rng.uniform(-0.3, 0.3, 3)
    bodies = vv.RigidBodies(
        rng.uniform(0.5, 2.0, count),
        inertia=[vv.rigid.rotate_tensor(np.diag(moments(rng)), unit(rng)) for _ in range(count)],
        position=places[:count],
        velocity=np.where(np.isnan(pivot), rng.normal(scale=0.3, size=(count, 3)), 0.0),
        orientation=turn,
        angular_velocity=rng.normal(scale=2.0, size=(count, 3)),
        pivot=pivot,
    )
    parts: list[Any] = [bodies]
    if particles:
        mass = rng.uniform(0.5, 1.0, particles) * rng.integers(0, 2, particles)
        parts.append(vv.Particles(mass, places[count:], rng.normal(scale=0.3, size=(particles, 3))))
        parts += [
            vv.AttachedSpring(0, rng.uniform(-0.3, 0.3, 3), 1.5, 0.5, particle=i) for i in np.flatnonzero(mass)[:1]
        ]
    if rng.random() < 0.7:
        parts.append(vv.Gravity(G=1.0))
    if rng.random() < 0.5:
        parts.append(vv.UniformField(rng.normal(size=3)))
    if count > 1:
        points = rng.uniform(-0.3, 0.3, (2, 3))
        parts.append(vv.AttachedSpring(0, points[0], 2.0, 0.4, to=1, to_point=points[1]))
    if rng.random() < 0.4:
        parts.append(vv.AttachedSpring(count - 1, rng.uniform(-0.2, 0.2, 3), 3.0, anchor=rng.normal(size=3) + 6.0))
    if lossy:
        parts += [vv.RotationalDrag(0.02), vv.AppliedTorque([0.01, 0.02, 0.0], body=0, frame="body")]
    return vv.Scene(*parts)


HOW = {"method": "kahan_li8", "dt": 0.01}


@settings(max_examples=EXAMPLES, deadline=None)
@given(SEEDS)
def test_what_should_be_kept_is_kept(seed: int) -> None:
    made = scene(seed)
    if made._turns_freely:
        return
    out = made.run(t=[0.0, 0.25, 0.5], **HOW)
    table = out.conservation()
    assert table.energy.conserved
    for drift in table.rows:
        if drift.conserved:
            # Rounding of fifty steps, and the error of the method where bodies pull hard.
            assert drift.max <= 1e-11, table
    assert np.abs(np.linalg.norm(out.orientation, axis=-1) - 1.0).max() <= 4 * np.finfo(float).eps


@settings(max_examples=EXAMPLES, deadline=None)
@given(SEEDS)
def test_units_of_powers_of_two_change_no_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = scene(seed, lossy=True)
    length, mass, time = (2.0 ** int(k) for k in rng.integers(-40, 40, 3))
    out = made.run(t=0.3, method="rk4", dt=0.01)
    other = made.rescaled(length=length, mass=mass, time=time).run(t=0.3 * time, method="rk4", dt=0.01 * time)
    assert (other.orientation == out.orientation).all()
    assert (other.position == length * out.position).all()
    assert (other.angular_velocity == out.angular_velocity / time).all()


@settings(max_examples=EXAMPLES, deadline=None)
@given(SEEDS)
def test_frames_do_not_matter(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = scene(seed)
    if made._turns_freely:
        return
    turn = vv.rigid.matrix(unit(rng))
    out, turned = made.run(t=0.3, **HOW), made.rotated(turn).run(t=0.3, **HOW)
    np.testing.assert_allclose(turned.position[-1], out.position[-1] @ turn.T, rtol=0, atol=5e-14)
    np.testing.assert_allclose(turned.angular_velocity[-1], out.angular_velocity[-1], rtol=0, atol=2e-13)
    moved = made.shifted(position=rng.normal(size=3)).run(t=0.3, **HOW)
    np.testing.assert_allclose(moved.orientation[-1], out.orientation[-1], rtol=0, atol=1e-14)
    back = out.final.reversed().run(t=0.6, **HOW)
    np.testing.assert_allclose(back.position[-1], made.particles.position, rtol=0, atol=5e-14)


@settings(max_examples=EXAMPLES, deadline=None)
@given(SEEDS)
def test_members_are_as_if_alone(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = scene(seed, lossy=True)
    copies = int(rng.integers(2, 20))
    spins = made.rigid_bodies.angular_velocity * rng.uniform(0.5, 1.5, (copies, 1, 1))
    ensemble = made.ensemble(angular_velocity=spins, orientation=unit(rng, copies, len(made.rigid_bodies)))
    how = {"t": [0.1, 0.215], "method": "rk4", "dt": 0.01}
    out = ensemble.run(**how, threads=int(rng.integers(1, 4)))
    for member in {0, copies // 2, copies - 1}:
        alone = ensemble[member].run(**how)
        for column in ("position", "velocity", "orientation", "angular_velocity"):
            assert np.array_equal(getattr(alone, column), getattr(out[member], column)), column


@settings(max_examples=EXAMPLES, deadline=None)
@given(SEEDS)
def test_runge_kutta_and_splitting_agree(seed: int) -> None:
    made = scene(seed)
    if made._turns_freely:
        return
    one, other = made.run(t=0.2, **HOW), made.run(t=0.2, method="rk4", dt=0.001)
    # h⁴ of rates up to some ten a second.
    np.testing.assert_allclose(one.orientation, other.orientation, rtol=0, atol=1e-7)
    np.testing.assert_allclose(one.position, other.position, rtol=0, atol=1e-7)


@pytest.mark.parametrize(
    ("given", "spin"),
    [
        ([1.0, 1.0 + 1 / 26, 1 / 26], [0.3, 0.2, 2.0]),
        ([1.0, 1.0 + 1e-6, 1e-6], [0.3, 0.2, 0.9]),
        ([1.0, 1.0 + 1e-15, 1.5], [0.3, 0.2, 0.9]),
        ([1.0, 2.0, 3.0], [1e-8, 1.0, 1e-8]),
        ([1.0, 2.0, 3.0], [1e-100, 1.0, 1e-100]),
        ([1.0, 1.0, 0.0], [0.3, 0.2, 0.0]),
        ([2.0, 2.0, 2.0], [0.3, 0.2, 0.5]),
    ],
)
@pytest.mark.parametrize("scale", [1e-100, 1.0, 1e100])
@pytest.mark.parametrize("method", ["leapfrog", "moser_veselov10"])
def test_steps_of_bodies_that_are_hard(given: list[float], spin: list[float], scale: float, method: str) -> None:
    """Rods, bodies symmetric but for rounding, near the separatrix, of any spin: as the elliptic functions have it."""
    rate = scale * np.array(spin)
    body = vv.RigidBody(1.0, given, angular_velocity=rate, pivot=[0, 0, 0])
    out = vv.Scene(body).run(t=30.0 / scale, method=method, dt=0.05 / scale)
    exact = vv.rigid.free_rotation(given, rate, 30.0 / scale)
    off = np.abs(out.orientation[-1, 0] - exact.orientation).max()
    # 600 steps, each right to some 1e-17; near the separatrix they part as e^t does, by e^21 at most.
    unstable = given == [1.0, 2.0, 3.0]
    # The spin of a rod about itself is what the momentum has along it, to some units in the last place of the whole.
    thin = 4 * np.finfo(float).eps * max(given) / min(given) if min(given) > 0.0 else 0.0
    assert off <= (1e-9 if unstable else 2e-13 + thin), off
    # In units of 1e±100, too: pytest's own absolute tolerance of 1e-12 would pass whatever is that small.
    assert out.energy[-1] == pytest.approx(out.energy[0], rel=1e-14, abs=0.0)
