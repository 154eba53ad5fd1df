"""Bodies from their elements: against fifty digits, there and back, and every contradiction refused by name."""

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import visviva as vv

ANGLES = st.floats(-3.0, 3.0)


def anomaly_of_time(mean: Any, e: Any) -> Any:
    """E, H or D of a mean anomaly, to all digits: Newton's iteration from beyond the root, bracketed by growth."""
    if e == 1:
        return mp.findroot(lambda d: d + d**3 / 3 - mean, mp.sign(mean) * (mp.cbrt(3 * abs(mean)) + mp.mpf("0.1")))
    if e < 1:
        return mp.findroot(lambda x: x - e * mp.sin(x) - mean, (mean - e - 1, mean + e + 1), solver="anderson")
    size = mp.asinh(abs(mean) / e) + 1
    high = 2 * size + mp.sqrt(6 * abs(mean)) + 1
    return mp.sign(mean) * mp.findroot(
        lambda x: e * mp.sinh(x) - x - abs(mean), (mp.mpf(0), high), solver="anderson", maxsteps=400
    )


def exact_state(mu: float, q: float, e: float, angles: tuple[float, float, float], nu: Any) -> tuple[Any, Any]:
    """Position and velocity of a true anomaly by the textbook's formulas."""
    mu, q, e = (mp.mpf(x) for x in (mu, q, e))
    i, node, w = (mp.mpf(x) for x in angles)
    p = q * (1 + e)
    r = p / (1 + e * mp.cos(nu))
    rate = mp.sqrt(mu / p)
    flat = ((r * mp.cos(nu), r * mp.sin(nu)), (-rate * mp.sin(nu), rate * (e + mp.cos(nu))))

    def turned(x: Any, y: Any) -> Any:
        x, y = x * mp.cos(w) - y * mp.sin(w), x * mp.sin(w) + y * mp.cos(w)
        return [
            x * mp.cos(node) - y * mp.cos(i) * mp.sin(node),
            x * mp.sin(node) + y * mp.cos(i) * mp.cos(node),
            y * mp.sin(i),
        ]

    return tuple(turned(*part) for part in flat)


def true_of(eccentric: Any, e: Any) -> Any:
    if e == 1:
        return 2 * mp.atan(eccentric)
    if e < 1:
        return 2 * mp.atan2(mp.sqrt(1 + e) * mp.sin(eccentric / 2), mp.sqrt(1 - e) * mp.cos(eccentric / 2))
    return 2 * mp.atan(mp.sqrt((e + 1) / (e - 1)) * mp.tanh(eccentric / 2))


def off(found: np.ndarray[Any, Any], expected: Any) -> float:
    """The distance over the size."""
    difference = mp.sqrt(sum((mp.mpf(float(a)) - b) ** 2 for a, b in zip(found, expected, strict=True)))
    return float(difference / mp.sqrt(sum(b**2 for b in expected)))


@pytest.mark.parametrize("e", [0.0, 1e-9, 0.3, 0.97, 1.0, 1.0 + 1e-9, 1.7, 40.0])
@pytest.mark.parametrize("place", ["true", "eccentric", "mean", "time"])
def test_against_fifty_digits(e: float, place: str) -> None:
    """A few ulps of |r| and |v|, times how much the state depends on the angle that was given."""
    angles, q, mass, G = (0.7, 1.1, -2.0), 2.5, 0.25, 0.3
    mu = G * (1.5 + mass)
    for value in (-1.3, -1e-3, 0.0, 0.4, 1.4):
        keywords: dict[str, Any] = {}
        with mp.workdps(50):
            exact_e, exact = mp.mpf(e), mp.mpf(value)
            if place == "true":
                keywords["true_anomaly"], nu = value, exact
            elif place == "eccentric":
                keywords["eccentric_anomaly"], nu = value, true_of(exact, exact_e)
            else:
                mean = exact
                if place == "mean":
                    keywords["mean_anomaly"] = value
                else:
                    rate = (
                        mp.sqrt(mp.mpf(mu) / (2 * mp.mpf(q) ** 3))
                        if e == 1
                        else mp.sqrt(mp.mpf(mu) * (abs(1 - exact_e) / mp.mpf(q)) ** 3)
                    )
                    keywords |= {"time_of_pericenter": 7.0 - value, "t0": 7.0}
                    mean = rate * (mp.mpf(7.0) - mp.mpf(7.0 - value))
                nu = mp.mpf(0) if mean == 0 else true_of(anomaly_of_time(mean, exact_e), exact_e)
            r, v = exact_state(mu, q, e, angles, nu)
        bodies = vv.Particles.from_elements(
            1.5,
            mass,
            G=G,
            pericenter=q,
            eccentricity=e,
            inclination=angles[0],
            longitude_of_ascending_node=angles[1],
            argument_of_pericenter=angles[2],
            **keywords,
        )
        # Ten roundings of the size at most: of the sines, of the plane, and of place and speed in it.
        assert off(bodies.position[1], r) < 2e-15, (e, place, value)
        assert off(bodies.velocity[1], v) < 2e-15, (e, place, value)


SIZES = ("semi_major_axis", "pericenter", "semi_latus_rectum", "period")


@given(
    e=st.one_of(st.floats(0.0, 0.99), st.just(1.0), st.floats(1.01, 30.0)),
    size=st.sampled_from(SIZES),
    value=st.floats(1e-3, 1e3),
    inclination=st.floats(0.05, 3.0),
    node=ANGLES,
    argument=ANGLES,
    mean=ANGLES,
    mass=st.sampled_from([0.0, 1e-9, 0.5, 3.0]),
)
def test_there_and_back(
    e: float, size: str, value: float, inclination: float, node: float, argument: float, mean: float, mass: float
) -> None:
    """Each element comes back to a few ulps times its conditioning: angles of the ellipse by 1/e."""
    if (size == "period" and e >= 1.0) or (size == "semi_major_axis" and e == 1.0):
        size = "pericenter"
    particles = vv.Particles.from_elements(
        2.0,
        mass,
        G=0.5,
        eccentricity=e,
        inclination=inclination,
        longitude_of_ascending_node=node,
        argument_of_pericenter=argument,
        mean_anomaly=mean,
        **{size: value},
    )
    found = vv.Scene(particles, vv.Gravity(0.5)).elements(1, about=0)
    # How far from the pericenter, in its distances: what a rounding there does to what is near it.
    far = float(np.linalg.norm(particles.position[1]) / found.pericenter)
    loose = 1e-14 * (1.0 + far) ** 2
    assert abs(float(found.eccentricity) - e) < loose * max(1.0, e)
    assert abs(float(getattr(found, size)) / value - 1.0) < loose * (1.0 + e) / max(abs(1.0 - e), 1e-2) * 10
    # 1/sin i: the node of an orbit near the plane.
    assert abs(float(found.inclination) - inclination) < loose
    assert abs(np.sin(0.5 * (float(found.node) - node))) < loose / np.sin(inclination)
    if e > 0.05:
        for name, expected in (("argument_of_pericenter", argument),):
            assert abs(np.sin(0.5 * (float(getattr(found, name)) - expected))) < loose / e / np.sin(inclination)
        if e < 0.99:
            assert abs(np.sin(0.5 * (float(found.mean_anomaly) - mean))) < loose / e


@given(
    e=st.one_of(st.floats(0.0, 0.9), st.just(1.0), st.floats(1.1, 5.0)),
    nu=st.floats(-1.5, 1.5),
    masses=st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3),
    about=st.sampled_from(["jacobi", "center_of_mass", 0]),
)
def test_the_way_back_is_about_the_same(e: float, nu: float, masses: list[float], about: str | int) -> None:
    """Elements are about what bodies were put about; of one body about the others' centre of mass, too."""
    masses = masses[:1] if about == "center_of_mass" else masses
    binary = vv.Particles.from_elements(1.0, 0.3, G=1.0, semi_major_axis=0.1)
    particles = vv.Particles.from_elements(
        binary, masses, G=1.0, about=about, pericenter=[1.0, 2.0, 5.0][: len(masses)], eccentricity=e, true_anomaly=nu
    )
    found = vv.Scene(particles, vv.Gravity(1.0)).elements(range(2, 2 + len(masses)), about=about)
    assert np.allclose(found.pericenter, [1.0, 2.0, 5.0][: len(masses)], rtol=1e-12)
    assert np.allclose(found.eccentricity, e, atol=1e-12)
    inside = [1.3, 1.3 + masses[0], 1.3 + sum(masses[:2])] if about == "jacobi" else [1.3 if about else 1.0] * 3
    assert np.allclose(found.mu, np.array(inside[: len(masses)]) + masses, rtol=1e-15)


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
        # And the way back, about the centre of mass of all others.
        scene = vv.Scene(bodies, vv.Gravity(2.0))
        place, rate = bodies[[0, 1, 3]].center_of_mass()
        found = scene.elements(2, about="center_of_mass")
        expected = vv.orbits.elements(2.0 * 2.05, bodies.position[2] - place, bodies.velocity[2] - rate)
        assert np.isclose(found.semi_major_axis, expected.semi_major_axis, rtol=1e-13)
        assert np.isclose(found.mean_anomaly, expected.mean_anomaly, rtol=1e-12)


def test_longitudes_are_sums_of_angles() -> None:
    angles = {"inclination": 0.4, "longitude_of_ascending_node": 1.1}
    one = vv.Particles.from_elements(
        1.0, 0.1, G=1.0, semi_major_axis=1.0, eccentricity=0.3, argument_of_pericenter=0.7, mean_anomaly=0.5, **angles
    )
    for named in (
        {"longitude_of_pericenter": 1.8, "mean_longitude": 2.3},
        {"argument_of_pericenter": 0.7, "mean_longitude": 2.3},
        {"longitude_of_pericenter": 1.8, "mean_anomaly": 0.5},
    ):
        other = vv.Particles.from_elements(1.0, 0.1, G=1.0, semi_major_axis=1.0, eccentricity=0.3, **named, **angles)
        assert np.allclose(one.position, other.position, rtol=0, atol=1e-15)
    found = vv.Scene(one, vv.Gravity(1.0)).elements(1)
    assert np.isclose(found.longitude_of_ascending_node, 1.1, rtol=1e-14)
    assert np.isclose(found.longitude_of_pericenter, 1.8, rtol=1e-14)
    assert np.isclose(found.mean_longitude, 2.3, rtol=1e-14)


def test_a_moon_of_a_planet() -> None:
    """Each about the body that was named, which may itself have come in the same call."""
    particles = vv.Particles.from_elements(
        1.0,
        [1e-3, 1e-8],
        G=1.0,
        about=["Sun", "Jupiter"],
        semi_major_axis=[5.2, 0.01],
        eccentricity=[0.05, 0.2],
        mean_anomaly=1.0,
        names=["Sun", "Jupiter", "Io"],
    )
    scene = vv.Scene(particles, vv.Gravity(1.0))
    moon = scene.elements("Io", about="Jupiter")
    # The planet's place and velocity are rounded at its distance, 520 times that of the moon.
    assert abs(float(moon.semi_major_axis) - 0.01) < 0.01 * 520 * 1e-15
    assert abs(float(moon.eccentricity) - 0.2) < 520 * 1e-15
    assert float(moon.mu) == 1e-3 + 1e-8


def test_two_bodies_have_one_conic() -> None:
    """About each other, about the rest, and by Jacobi's rule: the same ellipse, only turned round."""
    scene = vv.problems.kepler(e=0.6, mass_ratio=0.4).scene.rotated(np.eye(3)[[1, 2, 0]])
    found = [
        scene.elements(body, about=about)
        for body, about in ((1, 0), (0, 1), (1, "jacobi"), (1, "center_of_mass"), (0, "center_of_mass"))
    ]
    for one in found:
        assert np.isclose(one.eccentricity, 0.6, rtol=1e-15)
        assert np.isclose(one.semi_major_axis, 1.0, rtol=1e-15)
        assert one.mu == found[0].mu


def test_elements_over_time_are_constant_for_two_bodies_and_of_an_ensemble() -> None:
    scene = vv.problems.kepler(e=0.5, mass_ratio=1e-3).scene
    times = np.linspace(0.0, 20.0, 7)
    out = scene.run(t=times)
    alone = out.elements(1, about=0)
    assert alone.eccentricity.shape == (7,)
    assert np.allclose(alone.eccentricity, 0.5, rtol=1e-13)
    assert np.allclose(alone.angular_momentum, alone.angular_momentum[0], rtol=0, atol=1e-14)
    turns = times / (2.0 * np.pi)
    assert np.allclose(alone.mean_anomaly, 2.0 * np.pi * (turns - np.round(turns)), atol=1e-12)
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 1.1])[:, None, None])
    many = copies.run(t=times)
    found = many.elements(about=0)
    assert found.semi_major_axis.shape == (2, 7, 1)
    assert found.angular_momentum.shape == (2, 7, 1, 3)
    for copy in range(2):
        assert np.array_equal(found.node[copy], many[copy].elements(about=0).node)
        assert np.array_equal(many.body(1).elements().eccentricity[copy], many[copy].body(1).elements().eccentricity)


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


def test_numbers_and_arrays_broadcast() -> None:
    particles = vv.Particles.from_elements(
        1.0, 0.0, G=1.0, semi_major_axis=np.arange(1.0, 5.0), eccentricity=0.1, true_anomaly=[0.0, 1.0, 2.0, 3.0]
    )
    assert len(particles) == 5
    one = vv.Particles.from_elements(1.0, 0.0, G=1.0, semi_major_axis=3.0, eccentricity=0.1, true_anomaly=2.0)
    assert np.array_equal(particles.position[3], one.position[1])
    assert np.array_equal(particles.velocity[3], one.velocity[1])


ORBIT: dict[str, Any] = {"G": 1.0, "semi_major_axis": 1.0}


@pytest.mark.parametrize(
    ("changes", "argument", "words"),
    [
        ({"semi_major_axis": None}, "semi_major_axis", "expected the size"),
        ({"pericenter": 0.5}, "pericenter", "semi_major_axis and pericenter"),
        ({"period": 0.5}, "period", "semi_major_axis and period"),
        ({"semi_major_axis": -1.0, "eccentricity": 2.0}, "semi_major_axis", "also for a hyperbola"),
        ({"semi_major_axis": 0.0}, "semi_major_axis", "positive"),
        ({"semi_major_axis": np.inf}, "semi_major_axis", "finite"),
        ({"eccentricity": -0.1}, "eccentricity", "e ≥ 0"),
        ({"eccentricity": 1.0}, "semi_major_axis", "no parabola"),
        ({"semi_major_axis": None, "period": 1.0, "eccentricity": 1.5}, "period", "ellipses"),
        ({"inclination": -0.1}, "inclination", "from 0 to π"),
        ({"inclination": 90.0}, "inclination", "radians"),
        ({"true_anomaly": 0.0, "mean_anomaly": 0.0}, "mean_anomaly", "true_anomaly and mean_anomaly"),
        ({"argument_of_pericenter": 0.0, "longitude_of_pericenter": 0.0}, "longitude_of_pericenter", "and"),
        ({"eccentricity": 2.0, "true_anomaly": 3.0}, "true_anomaly", "asymptotes"),
        ({"G": 0.0}, "mass", "attracts"),
        ({"G": -1.0}, "eccentricity", "repel"),
        ({"mass": -1.0}, "mass", "at least 0"),
        ({"central": 0.0, "mass": 0.0}, "mass", "attracts"),
        ({"central": -1.0}, "mass", "at least 0"),
        ({"central": "Sun"}, "central", "real number"),
        ({"about": 1}, "about", "there before body 1"),
        ({"about": 2}, "about", "from 0 to 1"),
        ({"about": "Sun"}, "about", "no names"),
        ({"about": [0, 0]}, "about", "one for each of 1"),
        ({"names": ["Sun"]}, "names", "expected 2 names"),
        ({"names": ["Sun", "jacobi"]}, "names", "another name"),
        ({"names": 3}, "names", "sequence"),
        ({"eccentricity": [[0.1]]}, "semi_major_axis", "one axis"),
        ({"eccentricity": [0.1, 0.2], "inclination": [0.0, 0.1, 0.2]}, "inclination", "broadcast"),
        ({"t0": np.nan}, "t0", "finite"),
        ({"node": 0.1}, "node", "longitude_of_ascending_node"),
        ({"eccentricty": 0.1}, "eccentricty", "did you mean 'eccentricity'"),
    ],
)
def test_what_makes_no_orbit_is_refused_by_name(changes: dict[str, Any], argument: str, words: str) -> None:
    given: dict[str, Any] = {"central": 1.0, "mass": 0.1, **ORBIT} | changes
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.Particles.from_elements(**given)
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    ("bodies", "about", "argument", "words"),
    [
        (None, 3, "about", "from 0 to 2"),
        (None, "Sun", "about", "no names"),
        ([0, 1], 0, "bodies", "other bodies than body 0"),
        (0, "jacobi", "bodies", "after the first"),
        (2, 1, "about", "at the very place"),
        (1, 2, "about", "at the very place"),
        ([1.5], 0, "bodies", "whole number"),
    ],
)
def test_elements_that_there_are_not_are_refused_by_name(bodies: Any, about: Any, argument: str, words: str) -> None:
    particles = vv.Particles([1.0, 1.0, 0.0], [[0, 0, 0], [1, 0, 0], [1, 0, 0]])
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.Scene(particles, vv.Gravity(1.0)).elements(bodies, about=about)
    assert caught.value.argument == argument


def test_elements_need_masses_and_a_constant() -> None:
    two = vv.Particles([0.0, 0.0, 1.0], [[0, 0, 0], [1, 0, 0], [5, 0, 0]])
    scene = vv.Scene(two)
    with pytest.raises(vv.InvalidInput, match="no Gravity") as caught:
        scene.elements()
    assert caught.value.argument == "G"
    with pytest.raises(vv.InvalidInput, match="neither body 1 nor body 0"):
        scene.elements(1, G=1.0)
    with pytest.raises(vv.InvalidInput, match="bodies with mass"):
        scene.elements(2, about="jacobi", G=1.0)
    with pytest.raises(vv.InvalidInput, match="bodies with mass"):
        scene.elements(2, about="center_of_mass", G=1.0)
    assert scene.elements(1, about=2, G=2.0).mu == 2.0
