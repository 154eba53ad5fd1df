"""Motions of a scene through two places: throws, Lambert's problem, bodies that pull at each other, and refusals."""

import numpy as np
import pytest

import visviva as vv

SUN = vv.CentralField(vv.potentials.PowerLaw(k=-1.0, n=1.0))


def test_a_throw() -> None:
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 1.0]], [[0.0, 0.0, 0.0]]), vv.UniformField((0.0, 0.0, -9.81)))
    found = scene.boundary_value(2.0, [10.0, -4.0, 0.0])
    # r = v t − g t²/2, of numbers of about ten, rounded a few times.
    expected = [[5.0, -2.0, -0.5 + 9.81]]
    np.testing.assert_allclose(found.particles.velocity, expected, rtol=0.0, atol=1e-11)
    np.testing.assert_array_equal(found.particles.position, scene.particles.position)
    assert found.forces == scene.forces


@pytest.mark.parametrize("eccentricity", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("turn", [0.5, 2.0, 2.9, 4.0])
def test_lamberts_problem(eccentricity: float, turn: float) -> None:
    planet = vv.Particles.from_elements(
        central=1.0, G=1.0, mass=[0.0], semi_major_axis=[1.25], eccentricity=[eccentricity], inclination=[0.25]
    )
    known = vv.Scene(vv.Particles([1.0], planet.position[1:], planet.velocity[1:]), SUN)
    end = turn * 1.25**1.5
    goal = known.run(end).position[-1, 0]
    off = known.with_state(velocity=known.particles.velocity * 1.05 + [[0.0, 0.0, 0.01]])
    found = off.boundary_value(end, goal)
    # The nearest motion is the known one, back to the tolerance times how velocities change places.
    np.testing.assert_allclose(found.particles.velocity, known.particles.velocity, rtol=0.0, atol=1e-9)


def test_one_of_several_bodies_by_name() -> None:
    bodies = vv.Particles(
        [1.0, 1e-3, 0.0],
        [[0.0, 0.0, 0.0], [5.2, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.44, 0.0], [0.0, 1.2, 0.05]],
        names=["Sun", "Jupiter", "probe"],
    )
    scene = vv.Scene(bodies, vv.Gravity(G=1.0))
    goal = scene.run(8.0, rtol=1e-13).position[-1, 2] + [0.25, -0.25, 0.125]
    found = scene.boundary_value(8.0, goal, body="probe")
    np.testing.assert_array_equal(found.particles.velocity[:2], bodies.velocity[:2])
    arrived = found.run(8.0, method="dop853", rtol=1e-13).position[-1]
    # Another method than that of the search; planets go where they did.
    np.testing.assert_allclose(arrived[2], goal, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(arrived[:2], scene.run(8.0, rtol=1e-13).position[-1, :2], rtol=0.0, atol=1e-10)


def test_all_bodies() -> None:
    scene = vv.problems.pythagorean().scene
    wanted = scene.particles.velocity + np.array([[0.1, 0.0, 0.05], [0.0, -0.1, 0.0], [0.05, 0.05, -0.05]])
    # Before two of them meet closely, from where on there are several ways.
    goal = scene.with_state(velocity=wanted).run(1.0, rtol=1e-13).position[-1]
    found = scene.boundary_value(1.0, goal)
    np.testing.assert_allclose(found.particles.velocity, wanted, rtol=0.0, atol=1e-8)


def test_a_charge_in_a_magnetic_field_backward() -> None:
    scene = vv.Scene(
        vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.5]]),
        vv.UniformMagneticField((0.0, 0.0, 1.0), charge=[2.0]),
    )
    goal = scene.run(-1.0).position[-1, 0]
    found = scene.with_state(velocity=[[0.0, 0.0, 0.0]]).boundary_value(-1.0, goal)
    np.testing.assert_allclose(found.particles.velocity, scene.particles.velocity, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8"])
def test_equal_steps_arrive_by_their_own_motion(method: str) -> None:
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]), SUN)
    found = scene.boundary_value(2.0, [-0.5, 1.0, 0.25], method=method, dt=0.01)
    arrived = found.run(2.0, method=method, dt=0.01).position[-1, 0]
    np.testing.assert_allclose(arrived, [-0.5, 1.0, 0.25], rtol=0.0, atol=1e-9)


def test_what_has_no_answer_is_told() -> None:
    # After half a period all motions of an oscillator meet opposite to where they began.
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0]]), vv.Harmonic(k=1.0))
    with pytest.raises(vv.ConvergenceError, match="conjugate"):
        scene.boundary_value(np.pi, [0.5, 0.5, 0.0])


def test_what_is_refused() -> None:
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]), SUN)
    with pytest.raises(vv.InvalidInput, match="t: expected another time than the start"):
        scene.boundary_value(0.0, [1.0, 1.0, 0.0])
    with pytest.raises(vv.InvalidInput, match="position"):
        scene.boundary_value(1.0, [1.0, 1.0])
    with pytest.raises(vv.InvalidInput, match="body"):
        scene.boundary_value(1.0, [1.0, 1.0, 0.0], body=3)
    with pytest.raises(vv.InvalidInput, match="got 'Mars'"):
        scene.boundary_value(1.0, [1.0, 1.0, 0.0], body="Mars")
    with pytest.raises(vv.InvalidInput, match="rigid bodies"):
        vv.Scene(vv.RigidBody(mass=1.0, moments=[1.0, 2.0, 2.5])).boundary_value(1.0, [1.0, 1.0, 0.0])
    with pytest.raises(vv.InvalidInput, match="each body once"):
        scene.boundary_value(1.0, [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]], body=[0, 0])
