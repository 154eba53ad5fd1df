"""Bodies that hold together: their center of mass falls as one body would, whatever they do to each other.

Bounds: sums of pulls and products of a few numbers, 1e-14 of them; torques have arms of 10.
"""

import numpy as np
import pytest

import visviva as vv

# Springs have no Taylor series.
METHODS = [method for method in vv.methods() if method.coefficients]
FIELD = np.array([0.5, -1.0, -9.75])


def cluster(count: int, *forces: vv.forces.Force) -> vv.Scene:
    """Thrown, turning, and held by springs between neighbors, some of them damped."""
    rng = np.random.default_rng(count)
    position = np.cumsum(rng.uniform(0.5, 1.0, (count, 3)), axis=0)
    velocity = np.cross([0.5, -0.25, 1.0], position) + np.array([3.0, 1.0, 4.0])
    bodies = vv.Particles(rng.uniform(0.5, 2.0, count), position, velocity)
    ends = np.arange(count - 1)
    return vv.Scene(bodies, vv.Spring(ends, ends + 1, k=20.0, length=0.75), *forces, t0=0.5)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
@pytest.mark.parametrize("count", [2, 9])
def test_the_center_of_mass_is_a_projectile(method: vv.Method, count: int) -> None:
    """v₀t + gt²/2 to round-off, for every method: what all fall with is no part of the integration."""
    damper = () if method.symplectic or method.name in ("boris", "boris4", "stormer13") else (vv.Damper(0, 1, c=0.5),)
    scene = cluster(count, vv.UniformField(FIELD), *damper)
    start = scene.invariants()
    step = {"rtol": 1e-10} if method.adaptive else {"dt": 1 / 256}
    times = scene.t0 + np.linspace(0.0, 1.0, 5)
    out = scene.run(t=times, method=method, **step)  # type: ignore[arg-type]
    t = (times - scene.t0)[:, None]
    center = np.einsum("n,tnc->tc", scene.particles.mass, out.position) / start.total_mass
    falls = start.center_of_mass + start.center_of_mass_velocity * t + 0.5 * FIELD * t**2
    # Worst: 2.7e-15.
    assert np.abs(center - falls).max() < 8e-15
    # And the angular momentum about it goes on as if nothing pulled.
    spins = [scene.with_state(x, v).invariants().spin for x, v in zip(out.position, out.velocity, strict=True)]
    # A quadratic invariant: kicks along the springs keep it; else it is as good as the tolerance, or as the order.
    kept = method.symplectic or method.name.startswith("boris")
    error = 4e-15 if kept else 1e-9 if method.adaptive else {1: 0.2, 2: 5e-4, 4: 1e-9}.get(method.order, 1e-11)
    assert np.abs(spins - start.spin).max() < error * np.abs(start.spin).max()


def test_forces_within_do_not_move_the_center_and_those_outside_move_it_alone() -> None:
    """Σ F of all is Σ F of what acts from outside, and so is the torque."""
    inside = cluster(5)
    outside = cluster(5, vv.UniformField(FIELD), vv.Harmonic(2.0, [1.0, 0.0, -3.0]))
    mass = inside.particles.mass[:, None]
    internal, total = mass * inside.acceleration(), mass * outside.acceleration()
    pulls = mass * FIELD - 2.0 * (inside.particles.position - [1.0, 0.0, -3.0])
    np.testing.assert_allclose(internal.sum(axis=0), 0.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(total.sum(axis=0), pulls.sum(axis=0), rtol=1e-14)
    np.testing.assert_allclose(inside.invariants().torque, 0.0, rtol=0, atol=4e-14)
    torque = np.cross(inside.particles.position, pulls).sum(axis=0)
    np.testing.assert_allclose(outside.invariants().torque, torque, rtol=1e-14)


@pytest.mark.parametrize("speed", [0.5, 20.0])
def test_a_throw_goes_farthest_at_half_a_right_angle(speed: float) -> None:
    """Range v² sin 2α/g, the same for α and its complement; apex v² sin² α/2g in the middle: found by events."""
    g = 9.80665
    ground = vv.events.plane([0, 0, 0], [0, 0, 1.0], body=0)
    ranges = {}
    for degrees in (15, 30, 44, 45, 46, 60, 75):
        angle = np.deg2rad(degrees)
        ball = vv.Particles([0.25], np.zeros((1, 3)), [[speed * np.cos(angle), 0.0, speed * np.sin(angle)]])
        scene = vv.Scene(ball, vv.UniformField([0.0, 0.0, -g]))
        flight = 2.0 * speed * np.sin(angle) / g
        found = scene.run(t=1.5 * flight, events=[ground]).events
        (landed,) = np.flatnonzero(found.t > 0.5 * flight)
        assert found.t[landed] == pytest.approx(flight, rel=1e-14, abs=0)
        ranges[degrees] = found.position[landed, 0, 0]
        assert ranges[degrees] == pytest.approx(speed**2 * np.sin(2 * angle) / g, rel=1e-14, abs=0)
        apex = scene.run(t=flight / 2).position[-1, 0]
        expected = [ranges[degrees] / 2, 0.0, (speed * np.sin(angle)) ** 2 / (2 * g)]
        np.testing.assert_allclose(apex, expected, rtol=1e-14)
    assert ranges[30] == pytest.approx(ranges[60], rel=1e-14, abs=0)
    assert max(ranges, key=ranges.__getitem__) == 45
