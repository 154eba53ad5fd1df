"""Elements give back the state they were found of, also where e is 1 to all digits, and say what they cannot.

Bounds: states to some EPSILON of numbers of size 1, with the angles of the plane among what is rounded.
"""

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv

EPSILON = 2.0**-52


def size(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def off(mu: NDArray[np.float64], r: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give errors of place and velocity in ε of their lengths, beside how the velocity feels the rounding of E."""
    found = vv.orbits.elements(mu, r, v)
    r_again, v_again = found.state()
    # dv/dE = −μ r̂/r² · dt/dE with dt/dE = r √(a/μ). Far out a hyperbola goes by its mean anomaly, and loses nothing.
    with np.errstate(invalid="ignore"):
        felt = np.abs(found.eccentric_anomaly) * np.sqrt(np.abs(mu) * found.semi_major_axis) / size(r)
    felt = np.where(found.energy < 0.0, felt, 0.0)
    return np.array([size(r_again - r) / size(r), size(v_again - v) / (size(v) + felt)]) / EPSILON


@pytest.mark.parametrize("speed", [1e-3, 1e-5, 1e-7, 1e-8, 1e-12, 1e-100])
def test_from_the_apocenter_of_a_long_ellipse(speed: float) -> None:
    r, v = np.array([1.0, 0.0, 0.0]), np.array([0.0, speed, 0.0])
    r_again, v_again = vv.orbits.elements(1.0, r, v).state()
    assert size(r_again - r) <= 2 * EPSILON
    # 4: what the angles of the plane round away, of a velocity however small.
    assert size(v_again - v) <= 4 * EPSILON * speed


@pytest.mark.parametrize("velocity", [[-0.3, 1e-9, 0.0], [3.0, 1e-8, 0.0], [3.0, 1e-9, 0.0], [1.0, 1e-12, 0.0]])
@pytest.mark.parametrize("mu", [1.0, -1.0])
def test_almost_radial(velocity: list[float], mu: float) -> None:
    assert off(np.array(mu), np.array([1.0, 0.0, 0.0]), np.array(velocity)).max() <= 8


def test_random_states_of_every_kind() -> None:
    """Angular momenta down to 1e-12 of r v, energies down to 1e-16 of μ/r; 8 is twice the worst of 200 000."""
    rng = np.random.default_rng(7)
    n = 20_000

    def directions() -> NDArray[np.float64]:
        vectors = rng.normal(size=(n, 3))
        return np.asarray(vectors / size(vectors)[:, None])

    mu = rng.choice([1.0, -1.0], n) * 10 ** rng.uniform(-3, 3, n)
    out, distance = directions(), 10 ** rng.uniform(-3, 3, n)
    round_ = np.cross(out, directions())
    round_ /= size(round_)[:, None]
    escape = np.sqrt(2 * np.abs(mu) / distance)
    near = 1 + rng.normal(size=n) * 10 ** rng.uniform(-16, -1, n)
    speed = escape * np.where(rng.random(n) < 0.3, near, 10 ** rng.uniform(-2, 2, n))
    part = np.where(rng.random(n) < 0.5, rng.uniform(-1, 1, n), 10 ** rng.uniform(-12, 0, n))
    outward = np.sqrt(1 - part**2) * rng.choice([1, -1], n)
    v = speed[:, None] * (round_ * part[:, None] + out * outward[:, None])
    assert off(mu, out * distance[:, None], v).max() <= 8


def test_far_out_on_a_hyperbola() -> None:
    """cosh H has lost a hundred ulps there; what the mean anomaly tells has not."""
    r, v = np.array([[1e25, 3e24, 0.0], [-4e30, 2e30, 1e30]]), np.array([[2.0, 0.5, 0.1], [3.0, -1.0, 1.0]])
    assert off(np.ones(2), r, v).max() <= 8


def test_parabolas() -> None:
    """Energies of exactly 0, from near the pericenter to far away."""
    r = np.array([[2.0, 0.0, 0.0], [0.5, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0**41]])
    v = np.array([[0.0, 1.0, 0.0], [0.0, 2.0, 0.0], [-0.8, 0.6, 0.0], [0.0, 2.0**-20 * 0.6, 2.0**-20 * 0.8]])
    exact = vv.orbits.elements(1.0, r, v).energy == 0.0
    assert exact[:2].all()
    assert off(np.ones(4), r, v).max() <= 8


def test_a_replaced_element_counts() -> None:
    """What says the same thing twice does not overrule what was changed."""
    found = vv.orbits.elements(1.0, [1.0, 0.2, 0.0], [0.1, 0.9, 0.3])
    for e, nu in ((None, 0.7), (0.4, None), (0.4, 0.7)):
        changed = {"eccentricity": e, "true_anomaly": nu}
        changed = {name: np.float64(value) for name, value in changed.items() if value is not None}
        other = dataclasses.replace(found, **changed)
        wanted = vv.orbits.state(
            1.0,
            pericenter=other.pericenter,
            eccentricity=other.eccentricity,
            inclination=other.inclination,
            node=other.node,
            argument_of_pericenter=other.argument_of_pericenter,
            true_anomaly=other.true_anomaly,
        )
        assert np.array_equal(other.state(), wanted)
    alone = {
        name: np.float64(np.nan) for name in ("semi_major_axis", "semi_minor_axis", "eccentric_anomaly", "mean_anomaly")
    }
    again, velocity = dataclasses.replace(found, **alone).state()
    assert size(again - [1.0, 0.2, 0.0]) <= 8 * EPSILON
    assert size(velocity - [0.1, 0.9, 0.3]) <= 8 * EPSILON


@pytest.mark.parametrize("a", [1e14, 1e17, 1e25])
def test_a_replaced_size_counts_also_near_e_1(a: float) -> None:
    """There q/a and b/a are as good as nothing, whatever they are: their ratio is not."""
    speed = np.sqrt(2.0 - 1.0 / a)  # 2.5e-15 of itself below √2 for a = 1e14
    found = vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, speed, 0.0])
    assert size(found.state()[1]) == pytest.approx(speed, rel=1e-15, abs=0)
    nearer = dataclasses.replace(found, pericenter=2.0 * found.pericenter)
    # √(μ (1 + e)/q).
    assert size(nearer.state()[1]) == pytest.approx(np.sqrt((1.0 + found.eccentricity) / 2.0), rel=1e-15, abs=0)
    wider = dataclasses.replace(found, semi_minor_axis=3.0 * found.semi_minor_axis)
    assert size(wider.state()[1]) == pytest.approx(speed, rel=1e-15, abs=0)
