"""Elements of scenes and runs: about what, over time, of copies, and where an orbit degenerates.

Bounds: a state and its elements to some roundings of numbers of size 1; anomalies after ten periods, to the rounding
of the phase.
"""

import numpy as np
import pytest

import visviva as vv


def test_what_a_center_of_mass_is() -> None:
    """Where `Particles.center_of_mass` has it: of the bodies before, or of those that were given."""
    binary = vv.Particles.from_elements(1.0, 0.3, G=2.0, semi_major_axis=0.1, eccentricity=0.3, true_anomaly=1.0)
    orbit = {"pericenter": [1.0, 2.0], "eccentricity": 0.2, "true_anomaly": [0.0, 0.5], "inclination": 0.3}
    for about in ("jacobi", "center_of_mass"):
        bodies = vv.Particles.from_elements(binary, [0.5, 0.25], G=2.0, about=about, **orbit)
        for new, mass in ((2, 0.5), (3, 0.25)):
            before = bodies[:new] if about == "jacobi" else binary
            place, rate = before.center_of_mass()
            mu = 2.0 * (before.mass.sum() + mass)
            r, v = vv.orbits.state(
                mu,
                **{name: value[new - 2] if isinstance(value, list) else value for name, value in orbit.items()},
            )
            assert np.allclose(bodies.position[new] - place, r, rtol=0, atol=1e-15)
            assert np.allclose(bodies.velocity[new] - rate, v, rtol=0, atol=4e-15)
        # And the way back, about the center of mass of all others.
        scene = vv.Scene(bodies, vv.Gravity(2.0))
        place, rate = bodies[[0, 1, 3]].center_of_mass()
        found = scene.elements(2, about="center_of_mass")
        expected = vv.orbits.elements(2.0 * 2.05, bodies.position[2] - place, bodies.velocity[2] - rate)
        assert np.isclose(found.semi_major_axis, expected.semi_major_axis, rtol=1e-13, atol=0)
        assert np.isclose(found.mean_anomaly, expected.mean_anomaly, rtol=1e-12, atol=0)


def test_two_bodies_have_one_conic() -> None:
    """About each other, about the rest, and by Jacobi's rule: the same ellipse, only turned round."""
    scene = vv.problems.kepler(e=0.6, mass_ratio=0.4).scene.rotated(np.eye(3)[[1, 2, 0]])
    found = [
        scene.elements(body, about=about)
        for body, about in ((1, 0), (0, 1), (1, "jacobi"), (1, "center_of_mass"), (0, "center_of_mass"))
    ]
    for one in found:
        assert np.isclose(one.eccentricity, 0.6, rtol=1e-15, atol=0)
        assert np.isclose(one.semi_major_axis, 1.0, rtol=1e-15, atol=0)
        assert one.mu == found[0].mu


def test_elements_over_time_are_constant_for_two_bodies_and_of_an_ensemble() -> None:
    scene = vv.problems.kepler(e=0.5, mass_ratio=1e-3).scene
    times = np.linspace(0.0, 20.0, 7)
    out = scene.run(t=times)
    alone = out.elements(1, about=0)
    assert alone.eccentricity.shape == (7,)
    assert np.allclose(alone.eccentricity, 0.5, rtol=1e-14, atol=0)
    assert np.allclose(alone.angular_momentum, alone.angular_momentum[0], rtol=0, atol=1e-14)
    turns = times / (2.0 * np.pi)
    assert np.allclose(alone.mean_anomaly, 2.0 * np.pi * (turns - np.round(turns)), rtol=0, atol=1e-12)
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 1.1])[:, None, None])
    many = copies.run(t=times)
    found = many.elements(about=0)
    assert found.semi_major_axis.shape == (2, 7, 1)
    assert found.angular_momentum.shape == (2, 7, 1, 3)
    for copy in range(2):
        assert np.array_equal(found.node[copy], many[copy].elements(about=0).node)
        assert np.array_equal(many.body(1).elements().eccentricity[copy], many[copy].body(1).elements().eccentricity)


def test_copies_with_a_constant_of_their_own() -> None:
    scene = vv.problems.kepler(e=0.5).scene
    out = scene.ensemble(parameters={"Gravity": {"G": [1.0, 1.5, 0.8]}}).run(t=[0.0, 1.0, 2.0])
    found = out.elements(1, about=0)
    for copy in range(3):
        alone = out[copy].elements(1, about=0)
        assert np.array_equal(found.eccentricity[copy], alone.eccentricity)
        assert np.array_equal(found.mu[copy], alone.mu)
        # Of the copy with G = 1.5 it is 0, of the others of size 1/2: the rounding is that of 1.
        assert np.allclose(alone.eccentricity, alone.eccentricity[0], rtol=0, atol=4e-15)
    assert len({float(e) for e in found.eccentricity[:, 0]}) == 3


def test_rows_that_a_copy_does_not_have_are_nan() -> None:
    scene = vv.problems.kepler(e=0.5).scene
    still = np.stack([scene.particles.velocity, np.zeros((2, 3))])
    out = scene.ensemble(velocity=still).run(t=[0.0, 0.1, 5.0], method="dop853")
    assert out.status[1] != vv.Status.OK
    found = out.elements(about=0)
    assert np.isfinite(found.eccentricity[0]).all()
    assert np.array_equal(np.isnan(found.eccentricity[..., 0]), np.isnan(out.position[:, :, 0, 0]))


def test_what_is_defined_where_an_orbit_degenerates() -> None:
    """Circle, plane, parabola and free fall, as `visviva.orbits.Elements` says."""

    def of(position: list[float], velocity: list[float]) -> vv.orbits.Elements:
        particles = vv.Particles([1.0, 0.0], [[0, 0, 0], position], [[0, 0, 0], velocity])
        return vv.Scene(particles, vv.Gravity(1.0)).elements(1)

    circle = of([0.0, 1.0, 0.0], [-1.0, 0.0, 0.0])
    assert (circle.eccentricity, circle.node, circle.true_anomaly, circle.mean_anomaly) == (0.0, 0.0, 0.0, 0.0)
    assert circle.argument_of_pericenter == np.pi / 2
    assert circle.longitude_of_pericenter == circle.mean_longitude == np.pi / 2
    parabola = of([0.5, 0.0, 0.0], [0.0, 2.0, 0.0])
    assert (parabola.eccentricity, parabola.pericenter) == (1.0, 0.5)
    assert np.isinf(parabola.semi_major_axis)
    assert np.isinf(parabola.period)
    fall = of([0.0, 0.0, 2.0], [0.0, 0.0, 0.0])
    assert (fall.eccentricity, fall.pericenter, fall.semi_major_axis) == (1.0, 0.0, 1.0)
    named = {name for name in vv.orbits.Elements.__slots__ if np.isnan(getattr(fall, name)).any()}
    angles = {"inclination", "node", "argument_of_pericenter", "hodograph_center", "turning_angle"}
    assert named == angles  # turning: as of every bound orbit


def test_two_gravities_are_one_of_their_sum() -> None:
    bodies = vv.Particles.from_elements(1.0, 0.5, G=3.0, semi_major_axis=2.0, eccentricity=0.1)
    found = vv.Scene(bodies, vv.Gravity(1.0), vv.Gravity(2.0)).elements(1)
    assert np.isclose(found.semi_major_axis, 2.0, rtol=1e-14, atol=0)
    assert found.mu == 4.5


def test_in_a_turning_frame_orbits_are_those_of_an_inertial_one() -> None:
    """The same ellipse, seen turning: its size and shape stay, its node turns back; of copies with their own frames."""
    start = vv.Particles.from_elements(1.0, 1e-3, G=1.0, semi_major_axis=1.0, eccentricity=0.3, inclination=0.4)
    times, rates = np.linspace(0.0, 3.0, 4), np.array([0.5, 0.0, -1.3])
    frames = [vv.RotatingFrame([0, 0, rate], center=[0.2, 0.1, 0.0]) for rate in rates]
    scenes = []
    for frame in frames:
        seen = start.velocity - np.cross(frame.omega, start.position - np.array(frame.center))
        scenes.append(vv.Scene(start._changed(velocity=seen), vv.Gravity(1.0), frame))
    still = vv.Scene(start, vv.Gravity(1.0)).elements(1)
    copies = scenes[0].ensemble(
        velocity=[scene.particles.velocity for scene in scenes],
        parameters={"RotatingFrame": {"omega": [frame.omega for frame in frames]}},
    )
    many = copies.run(t=times, rtol=1e-12).elements(1)
    for copy, (scene, rate) in enumerate(zip(scenes, rates, strict=True)):
        now = scene.elements(1)
        alone = scene.run(t=times, rtol=1e-12).elements(1)
        for found in (now, alone):
            np.testing.assert_allclose(found.semi_major_axis, still.semi_major_axis, rtol=1e-10)
            np.testing.assert_allclose(found.eccentricity, 0.3, rtol=1e-10)
            np.testing.assert_allclose(found.inclination, 0.4, rtol=1e-10)
        turned = alone.node - still.node + rate * times
        np.testing.assert_allclose(np.exp(1j * turned), 1.0, rtol=0, atol=1e-9)
        np.testing.assert_allclose(many.eccentricity[copy], alone.eccentricity, rtol=1e-12)
    with pytest.raises(vv.InvalidInput, match="one RotatingFrame"):
        vv.Scene(start, vv.Gravity(1.0), *frames).elements(1)


@pytest.mark.parametrize("speed", [0.5, 1e-3, 2.0**0.5, 3.0])
def test_on_a_straight_line_the_anomalies_have_one_sign(speed: float) -> None:
    """Outbound is after the pericenter, which lies in the center; what stands still at the apsis is there."""
    for sign in (1.0, -1.0):
        for along in ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]):
            place, velocity = np.array(along), sign * speed * np.array(along)
            found = vv.orbits.elements(1.0, place, velocity)
            assert found.true_anomaly == sign * np.pi
            assert np.sign(found.time_since_pericenter) == sign
    assert vv.orbits.elements(1.0, [1.0, 0, 0], [0.0, 0, 0]).true_anomaly == np.pi


def test_elements_are_not_changed_with_what_they_were_made_of() -> None:
    mu, position, velocity = np.array([1.0, 2.0]), np.array([[1.0, 0, 0]] * 2), np.array([[0, 1.0, 0], [0, 1.2, 0]])
    found = vv.orbits.elements(mu, position, velocity)
    mu[0], position[0], velocity[0] = 9.0, 9.0, 9.0
    np.testing.assert_array_equal(found.mu, [1.0, 2.0])
    # A circle of radius 1.
    np.testing.assert_allclose(found.semi_latus_rectum[0], 1.0, rtol=1e-15, atol=0)
