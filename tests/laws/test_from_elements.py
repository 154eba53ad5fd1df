"""Bodies from their elements: against fifty digits, and there and back.

Bounds: angles and places to some roundings, 1e-14 to 1e-15; elements back from states to ten times what e near 1
amplifies of them.
"""

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


@pytest.mark.parametrize("e", [1 - 1e-9, 1 - 1e-14, 1.0, 1 + 1e-12])
@pytest.mark.parametrize("below", [1e-2, 1e-4, 3e-6])
def test_far_out_on_a_narrow_orbit(e: float, below: float) -> None:
    """Beside ν = π the velocity across is what e + cos ν leaves: its own digits, and with them the pericenter."""
    nu = np.pi - below
    with mp.workdps(50):
        r, v = exact_state(1.0, 0.7, e, (0.0, 0.0, 0.0), mp.mpf(nu))
    bodies = vv.Particles.from_elements(1.0, 0.0, G=1.0, pericenter=0.7, eccentricity=e, true_anomaly=nu)
    assert off(bodies.position[1], r) < 2e-15
    assert off(bodies.velocity[1], v) < 2e-15
    across = mp.mpf(float(bodies.velocity[1, 1]))
    assert abs(across / v[1] - 1) < 2e-15
    # L² = μ p: r × v loses to rounding what the place along and the speed along are more than what they make.
    found = vv.Scene(bodies, vv.Gravity(1.0)).elements(1).pericenter
    assert found == pytest.approx(0.7, rel=1e-11)


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
    """Elements are about what bodies were put about; of one body about the others' center of mass, too."""
    masses = masses[:1] if about == "center_of_mass" else masses
    binary = vv.Particles.from_elements(1.0, 0.3, G=1.0, semi_major_axis=0.1)
    particles = vv.Particles.from_elements(
        binary, masses, G=1.0, about=about, pericenter=[1.0, 2.0, 5.0][: len(masses)], eccentricity=e, true_anomaly=nu
    )
    found = vv.Scene(particles, vv.Gravity(1.0)).elements(range(2, 2 + len(masses)), about=about)
    assert np.allclose(found.pericenter, [1.0, 2.0, 5.0][: len(masses)], rtol=2e-14, atol=0)
    assert np.allclose(found.eccentricity, e, rtol=0, atol=5e-14)
    inside = [1.3, 1.3 + masses[0], 1.3 + sum(masses[:2])] if about == "jacobi" else [1.3 if about else 1.0] * 3
    assert np.allclose(found.mu, np.array(inside[: len(masses)]) + masses, rtol=1e-15, atol=0)


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
    assert np.isclose(found.longitude_of_ascending_node, 1.1, rtol=1e-14, atol=0)
    assert np.isclose(found.longitude_of_pericenter, 1.8, rtol=1e-14, atol=0)
    assert np.isclose(found.mean_longitude, 2.3, rtol=1e-14, atol=0)


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


def test_numbers_and_arrays_broadcast() -> None:
    particles = vv.Particles.from_elements(
        1.0, 0.0, G=1.0, semi_major_axis=np.arange(1.0, 5.0), eccentricity=0.1, true_anomaly=[0.0, 1.0, 2.0, 3.0]
    )
    assert len(particles) == 5
    one = vv.Particles.from_elements(1.0, 0.0, G=1.0, semi_major_axis=3.0, eccentricity=0.1, true_anomaly=2.0)
    assert np.array_equal(particles.position[3], one.position[1])
    assert np.array_equal(particles.velocity[3], one.velocity[1])
