"""The laws of Kepler's problem over random orbits, through `vv.orbits`, and what it refuses.

Tolerances are in units of ε = 2⁻⁵², with the conditioning they are multiplied by beside them; each is up to twice what
the worst of 5000 examples showed.
"""

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import visviva as vv

EPSILON = float(np.finfo(float).eps)
Vector = NDArray[np.float64]


def vectors(size: float) -> st.SearchStrategy[Vector]:
    part = st.floats(-size, size, allow_subnormal=False)
    return st.tuples(part, part, part).map(np.array)


@st.composite
def orbits(draw: st.DrawFn) -> tuple[float, Vector, Vector]:
    mu = draw(st.floats(-2.0, 2.0))
    r, v = draw(vectors(2.0)), draw(vectors(1.5))
    assume(abs(mu) > 1e-2 and np.linalg.norm(r) > 1e-2 and np.linalg.norm(np.cross(r, v)) > 1e-2)
    return mu, r, v


@st.composite
def ellipses(draw: st.DrawFn) -> tuple[float, Vector, Vector]:
    angle = st.floats(-3.0, 3.0)
    mu = draw(st.floats(0.5, 2.0))
    r, v = vv.orbits.state(
        mu,
        pericenter=draw(st.floats(0.1, 2.0)),
        eccentricity=draw(st.floats(0.0, 0.95)),
        inclination=draw(st.floats(0.0, np.pi)),
        node=draw(angle),
        argument_of_pericenter=draw(angle),
        true_anomaly=draw(angle),
    )
    return mu, r, v


def size(vector: Vector) -> float:
    return float(np.linalg.norm(vector))


@given(orbit=orbits())
@settings(max_examples=300)
def test_elements_give_the_state_back(orbit: tuple[float, Vector, Vector]) -> None:
    mu, r, v = orbit
    elements = vv.orbits.elements(mu, r, v)
    # The angles are rounded to ε/2 of up to π each, but near an asymptote the place feels ν by r/p.
    growth = 1.0 + size(r) / elements.semi_latus_rectum * max(1.0, elements.eccentricity)
    r1, v1 = elements.state()
    assert size(r1 - r) <= 20 * EPSILON * growth * size(r)
    assert size(v1 - v) <= 20 * EPSILON * growth * (size(v) + elements.hodograph_radius * (1 + elements.eccentricity))


@given(
    mu=st.floats(0.5, 2.0),
    q=st.floats(0.1, 2.0),
    e=st.floats(0.0, 0.9) | st.floats(1.1, 4.0),
    mean=st.floats(-3.0, 3.0),
    repulsive=st.booleans(),
)
def test_a_mean_anomaly_is_the_time_since_the_pericenter(
    mu: float, q: float, e: float, mean: float, repulsive: bool
) -> None:
    mu = -mu if repulsive and e > 1.0 else mu
    r, v = vv.orbits.state(mu, pericenter=q, eccentricity=e, mean_anomaly=mean)
    a = q / (1.0 + e if mu < 0.0 else abs(1.0 - e))
    start = vv.orbits.state(mu, pericenter=q, eccentricity=e)
    r1, v1 = vv.orbits.propagate(mu, *start, mean * np.sqrt(a**3 / abs(mu)))
    # The start is rounded: its period is known to ε/|1 − e|, its pericenter passage carries that for |M| ≤ 3.
    assert size(r1 - r) <= 40 * EPSILON / abs(1.0 - e) * (1.0 + e) * size(r)
    assert size(v1 - v) <= 40 * EPSILON / abs(1.0 - e) * (1.0 + e) * np.sqrt(abs(mu) / q) * (1.0 + e)
    if e < 1.0:
        eccentric = vv.orbits.eccentric_from_mean(mean, e)
    else:
        eccentric = vv.orbits.hyperbolic_from_mean(mean, e, repulsive=mu < 0.0)
    for r2, v2 in (
        vv.orbits.state(mu, pericenter=q, eccentricity=e, eccentric_anomaly=eccentric),
        vv.orbits.state(mu, pericenter=q, eccentricity=[e], eccentric_anomaly=[eccentric]),
    ):
        assert np.array_equal(r2.reshape(3), r)
        assert np.array_equal(v2.reshape(3), v)


def test_the_mean_anomaly_of_a_parabola_is_barkers() -> None:
    # D + D³/3 = 4/3 at D = 1, a right angle from the pericenter, where r = 2q.
    r, v = vv.orbits.state(2.0, pericenter=0.5, eccentricity=1.0, mean_anomaly=4 / 3)
    assert np.allclose(r, [0.0, 1.0, 0.0], rtol=0, atol=4 * EPSILON)
    assert np.allclose(v, [-np.sqrt(2.0), np.sqrt(2.0), 0.0], rtol=4 * EPSILON, atol=0)


@given(orbit=orbits(), t=st.floats(-1e3, 1e3))
@settings(max_examples=300)
def test_energy_angular_momentum_and_lenz_vector_stay(orbit: tuple[float, Vector, Vector], t: float) -> None:
    mu, r, v = orbit
    r1, v1 = vv.orbits.propagate(mu, r, v, t)
    before, after = vv.orbits.elements(mu, r, v), vv.orbits.elements(mu, r1, v1)
    kinetic = max(size(v) ** 2 + abs(mu) / size(r), size(v1) ** 2 + abs(mu) / size(r1))
    assert abs(after.energy - before.energy) <= 6 * EPSILON * kinetic
    reach = max(size(r) * size(v), size(r1) * size(v1))
    assert size(after.angular_momentum - before.angular_momentum) <= 6 * EPSILON * reach
    terms = abs(mu) + max(size(r) * size(v) ** 2, size(r1) * size(v1) ** 2)
    assert size(after.laplace_runge_lenz - before.laplace_runge_lenz) <= 10 * EPSILON * terms


@given(orbit=ellipses(), t=st.floats(-20.0, 20.0))
@settings(max_examples=300)
def test_first_law_the_path_is_a_conic_with_the_center_in_a_focus(
    orbit: tuple[float, Vector, Vector], t: float
) -> None:
    """The sum of the distances from the two foci is 2a."""
    mu, r, v = orbit
    elements = vv.orbits.elements(mu, r, v)
    r1, _ = vv.orbits.propagate(mu, r, v, t)
    other = -2.0 * elements.semi_major_axis * elements.laplace_runge_lenz / mu
    assert abs(size(r1) + size(r1 - other) - 2 * elements.semi_major_axis) <= 12 * EPSILON * elements.semi_major_axis


@given(orbit=ellipses(), start=st.floats(0.0, 1.0))
@settings(max_examples=300)
def test_second_law_equal_areas_in_equal_times(orbit: tuple[float, Vector, Vector], start: float) -> None:
    """The sector from t₁ to t₂ from the geometry of the ellipse: ab/2 ΔE less the triangles about the empty focus."""
    mu, r, v = orbit
    elements = vv.orbits.elements(mu, r, v)
    assume(elements.eccentricity > 1e-3)
    times = elements.period * (start + np.array([0.0, 0.1]))
    places, rates = vv.orbits.propagate(mu, r, v, times)
    found = vv.orbits.elements(mu, places, rates)
    anomaly = found.eccentric_anomaly
    turned = (anomaly[1] - anomaly[0]) % (2 * np.pi)
    a, b, e = elements.semi_major_axis, elements.semi_minor_axis, elements.eccentricity
    area = 0.5 * a * b * (turned - e * (np.sin(anomaly[1]) - np.sin(anomaly[0])))
    # E feels the state's rounding by 1/e from a circle and 1/(1 − e) from a parabola.
    assert abs(area - elements.areal_rate * 0.1 * elements.period) <= 20 * EPSILON * a * b / (1 - e) / e


@given(orbit=ellipses(), factor=st.floats(0.1, 10.0))
@settings(max_examples=300)
def test_third_law(orbit: tuple[float, Vector, Vector], factor: float) -> None:
    mu, r, v = orbit
    elements = vv.orbits.elements(mu, r, v)
    assert abs(elements.period**2 * mu / elements.semi_major_axis**3 / (4 * np.pi**2) - 1) <= 6 * EPSILON
    assert abs(vv.orbits.period(mu, elements.semi_major_axis) / elements.period - 1) <= 4 * EPSILON
    # Similar orbits: lengths × f and times × f^(3/2).
    larger = vv.orbits.elements(mu, factor * r, v / np.sqrt(factor))
    # The rounding of v and r feeds the energy by (1 + e)/(1 − e).
    growth = 1 / (1 - elements.eccentricity)
    assert abs(larger.period / elements.period / factor**1.5 - 1) <= 10 * EPSILON * growth


@given(orbit=orbits(), t=st.floats(-50.0, 50.0))
@settings(max_examples=300)
def test_velocities_lie_on_the_hodograph(orbit: tuple[float, Vector, Vector], t: float) -> None:
    mu, r, v = orbit
    elements = vv.orbits.elements(mu, r, v)
    _, v1 = vv.orbits.propagate(mu, r, v, t)
    off = abs(size(v1 - elements.hodograph_center) - elements.hodograph_radius)
    assert off <= 6 * EPSILON * (elements.hodograph_radius + size(elements.hodograph_center))


@given(
    orbit=orbits(),
    masses=st.tuples(st.floats(0.0, 3.0), st.floats(0.1, 3.0)),
    center=vectors(10.0),
    drift=vectors(1.0),
    t0=st.floats(-4.0, 4.0),
    t=st.floats(-20.0, 20.0),
)
@settings(max_examples=200)
def test_a_scene_of_two_bodies_is_the_relative_orbit(
    orbit: tuple[float, Vector, Vector],
    masses: tuple[float, float],
    center: Vector,
    drift: Vector,
    t0: float,
    t: float,
) -> None:
    _, r, v = orbit
    m = np.array(masses)
    total = float(m.sum())
    positions, velocities = np.array([center, center + r]), np.array([drift, drift + v])
    out = vv.Scene(vv.Particles(m, positions, velocities), vv.Gravity(1.0), t0=t0).run(t=[t0, t])
    assert np.array_equal(out.position[0], positions)
    assert np.array_equal(out.velocity[0], velocities)
    relative, rate = vv.orbits.propagate(total, positions[1] - positions[0], velocities[1] - velocities[0], t - t0)
    # Each body is rounded at its own distance from the origin, one ulp of the two of them together.
    reach, speed = np.abs(out.position[1]).max() + size(relative), np.abs(out.velocity[1]).max() + size(rate)
    assert size(out.position[1, 1] - out.position[1, 0] - relative) <= 3 * EPSILON * reach
    assert size(out.velocity[1, 1] - out.velocity[1, 0] - rate) <= 3 * EPSILON * speed
    mean = m @ out.position[1] / total
    expected = m @ positions / total + (t - t0) * (m @ velocities / total)
    scale = np.abs(out.position).max() + abs(t - t0) * np.abs(velocities).max()
    assert size(mean - expected) <= 8 * EPSILON * scale


@given(mu=st.floats(0.1, 3.0), r=vectors(2.0), v=vectors(1.5), t=st.floats(-20.0, 20.0))
@settings(max_examples=100)
def test_a_fixed_center_is_the_same_to_the_bit(mu: float, r: Vector, v: Vector, t: float) -> None:
    assume(size(r) > 1e-2)
    field = vv.CentralField(vv.potentials.Coulomb(-mu))
    out = vv.Scene(vv.Particles([1.0], [r], [v]), field).run(t=t)
    position, velocity = vv.orbits.propagate(mu, r, v, t)
    assert np.array_equal(out.position[-1, 0], position)
    assert np.array_equal(out.velocity[-1, 0], velocity)


@given(
    e=st.floats(0.0, 0.99),
    h=st.floats(1.01, 20.0),
    x=st.floats(-3.0, 3.0, allow_subnormal=False),
    repulsive=st.booleans(),
)
@settings(max_examples=300)
def test_anomalies_return(e: float, h: float, x: float, repulsive: bool) -> None:
    o = vv.orbits
    assert abs(o.mean_from_eccentric(o.eccentric_from_mean(x, e), e) - x) <= 6 * EPSILON * max(abs(x), 1e-300) / (1 - e)
    assert abs(o.eccentric_from_true(o.true_from_eccentric(x, e), e) - x) <= 8 * EPSILON * 3 / (1 - e)
    back = o.hyperbolic_from_mean(o.mean_from_hyperbolic(x, h, repulsive=repulsive), h, repulsive=repulsive)
    assert abs(back - x) <= 4 * EPSILON * abs(x)
    # dH/dν reaches cosh²(3/2) √((h+1)/(h−1)).
    nu = o.true_from_hyperbolic(x, h, repulsive=repulsive)
    assert abs(o.hyperbolic_from_true(nu, h, repulsive=repulsive) - x) <= 12 * EPSILON * np.sqrt((h + 1) / (h - 1)) * 6
    d = o.parabolic_from_mean(x)
    assert abs(o.mean_from_parabolic(d) - x) <= 6 * EPSILON * abs(x)
    assert abs(o.parabolic_from_true(o.true_from_parabolic(d)) - d) <= 6 * EPSILON * (1 + d * d)


def test_arrays_are_their_entries() -> None:
    mu, r, v = 1.5, np.array([[1.0, 0, 0.2], [0, 2.0, 0]]), np.array([[[0, 1.0, 0]], [[0.3, 0, 1.5]], [[-1.0, 0, 0]]])
    found = vv.orbits.elements(mu, r, v)
    assert found.energy.shape == (3, 2)
    assert found.hodograph_center.shape == (3, 2, 3)
    times = np.array([[0.0, 1.0, -2.0, 7.0]])
    position, velocity = vv.orbits.propagate(mu, r, v, times)
    assert position.shape == velocity.shape == (1, 4, 3, 2, 3)
    for i in range(3):
        for j in range(2):
            one = vv.orbits.elements(mu, r[j], v[i, 0])
            assert isinstance(one.energy, float)
            assert one.energy == found.energy[i, j]
            assert np.array_equal(one.laplace_runge_lenz, found.laplace_runge_lenz[i, j])
            alone = vv.orbits.propagate(mu, r[j], v[i, 0], times)
            assert np.array_equal(alone[0], position[..., i, j, :])
            assert np.array_equal(alone[1], velocity[..., i, j, :])
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.node, found.node, equal_nan=True)
    with pytest.raises(AttributeError):
        found.energy = 0.0  # type: ignore[misc]


def test_radial_and_far_away_motion() -> None:
    radial = vv.orbits.elements(1.0, [2.0, 0, 0], [0, 0, 0])
    assert (radial.eccentricity, radial.pericenter, radial.apocenter, radial.semi_major_axis) == (1.0, 0.0, 2.0, 1.0)
    assert np.isnan(radial.inclination)
    with pytest.raises(vv.InvalidInput, match="inclination"):
        radial.state()
    # The anomalies of a hyperbola run into their asymptote, not past it.
    assert vv.orbits.true_from_hyperbolic(1e5, 2.0) == vv.orbits.true_from_hyperbolic(80.0, 2.0)
    # D³/3 = M, far away.
    assert abs(vv.orbits.parabolic_from_mean(1e210) / np.cbrt(3e210) - 1) < 1e-15
    # Units in which squares would leave the range.
    assert abs(vv.orbits.period(1e250, 1e-100) / (2e-275 * np.pi) - 1) < 1e-15
    assert abs(vv.orbits.free_fall_time(1e250, 1e-100) / (np.sqrt(0.125) * 1e-275 * np.pi) - 1) < 1e-15


STATE: dict[str, Any] = {"mu": 1.0, "position": [1.0, 0, 0], "velocity": [0, 1.0, 0]}
ELEMENTS: dict[str, Any] = {"mu": 1.0, "pericenter": 1.0, "eccentricity": 0.5}
CONIC: dict[str, Any] = {"mass": 1.0, "strength": 1.0, "position": [1.0, 0, 0], "velocity": [0, 1.0, 0]}
CONSTANTS: dict[str, Any] = {"mass": 1.0, "strength": 1.0, "angular_momentum": 1.0, "energy": -0.3}
REFUSED: list[tuple[str, dict[str, Any], dict[str, Any]]] = [
    ("elements", STATE, {"mu": 0.0}),
    ("elements", STATE, {"mu": np.nan}),
    ("elements", STATE, {"position": [0.0, 0, 0]}),
    ("elements", STATE, {"position": [1.0, 0]}),
    ("elements", STATE, {"velocity": [np.inf, 0, 0]}),
    ("elements", STATE, {"velocity": np.zeros((2, 1))}),
    ("propagate", STATE | {"t": 1.0}, {"t": np.inf}),
    ("propagate", STATE | {"t": 1.0}, {"t": "now"}),
    ("propagate", STATE | {"t": 1.0}, {"mu": None}),
    ("propagate", STATE | {"t": 1.0}, {"position": [0.0, 0, 0]}),
    ("state", ELEMENTS, {"mu": 0.0}),
    ("state", ELEMENTS, {"pericenter": 0.0}),
    ("state", ELEMENTS, {"eccentricity": -0.1}),
    ("state", ELEMENTS | {"mu": -1.0, "eccentricity": 1.5}, {"eccentricity": 1.0}),
    ("state", ELEMENTS, {"inclination": np.nan}),
    ("state", ELEMENTS, {"inclination": 3.2}),
    ("state", ELEMENTS, {"mean_anomaly": np.nan}),
    ("state", ELEMENTS, {"mean_anomaly": 1e300}),
    ("state", ELEMENTS, {"node": np.inf}),
    ("state", ELEMENTS, {"argument_of_pericenter": [[np.nan]]}),
    ("state", ELEMENTS | {"eccentricity": 2.0}, {"true_anomaly": 2.1}),
    ("state", ELEMENTS | {"eccentricity": [0.1, 0.2]}, {"true_anomaly": [1.0, 2.0, 3.0]}),
    ("conic", CONIC, {"mass": 0.0}),
    ("conic", CONIC, {"strength": 0.0}),
    ("conic", CONIC, {"position": [0.0, 0, 0]}),
    ("conic_from_constants", CONSTANTS, {"mass": -1.0}),
    ("conic_from_constants", CONSTANTS, {"strength": 0.0}),
    ("conic_from_constants", CONSTANTS, {"angular_momentum": -1.0}),
    ("conic_from_constants", CONSTANTS, {"energy": -0.6}),
    ("conic_from_constants", CONSTANTS | {"strength": -1.0, "energy": 0.3}, {"energy": 0.0}),
    ("period", {"mu": 1.0, "semi_major_axis": 1.0}, {"mu": -1.0}),
    ("period", {"mu": 1.0, "semi_major_axis": 1.0}, {"semi_major_axis": 0.0}),
    ("free_fall_time", {"mu": 1.0, "start": 1.0, "end": 0.0}, {"mu": 0.0}),
    ("free_fall_time", {"mu": 1.0, "start": 1.0, "end": 0.0}, {"start": 0.0}),
    ("free_fall_time", {"mu": 1.0, "start": 1.0, "end": 0.0}, {"end": 1.5}),
    ("eccentric_from_mean", {"mean": 1.0, "eccentricity": 0.5}, {"mean": np.nan}),
    ("eccentric_from_mean", {"mean": 1.0, "eccentricity": 0.5}, {"eccentricity": 1.0}),
    ("hyperbolic_from_mean", {"mean": 1.0, "eccentricity": 1.5}, {"eccentricity": 1.0}),
    ("hyperbolic_from_mean", {"mean": 1.0, "eccentricity": 1.5}, {"repulsive": 1}),
    ("hyperbolic_from_true", {"true_anomaly": 1.0, "eccentricity": 1.5}, {"true_anomaly": 2.5}),
    ("parabolic_from_true", {"true_anomaly": 1.0}, {"true_anomaly": 3.2}),
]


@pytest.mark.parametrize(("function", "good", "bad"), REFUSED)
def test_refusals_name_the_argument(function: str, good: dict[str, Any], bad: dict[str, Any]) -> None:
    getattr(vv.orbits, function)(**good)
    with pytest.raises(vv.InvalidInput) as caught:
        getattr(vv.orbits, function)(**good | bad)
    assert caught.value.argument == next(iter(bad))
