"""Inverse square and inverse cube together: conics that turn, and spirals."""

import mpmath
import numpy as np
import pytest
from golden_cases import CASES
from nearness import close

import visviva as vv
from visviva.potentials import Coulomb, PowerLaw

mpmath.mp.dps = 30


@pytest.mark.parametrize(
    ("gamma", "kappa"), [(1.0, 0.1), (1.0, -0.7), (-1.0, 0.3), (1.0, 2.0), (1.0, 0.81), (-0.5, 3.0)]
)
@pytest.mark.parametrize("radial", [0.0, 0.3, -0.9])
def test_conics_that_turn_and_spirals(gamma: float, kappa: float, radial: float) -> None:
    """Against the path equation by series of 30 digits, and against the general orbit."""
    position, velocity = [1.0, 0.0, 0.0], [radial, 0.9, 0.0]
    orbit = vv.orbits.precessing_conic(1.0, gamma, kappa, position=position, velocity=velocity)
    l2 = mpmath.mpf(0.9) ** 2
    beta2 = 1 - mpmath.mpf(kappa) / l2
    beta, push = mpmath.sqrt(beta2), mpmath.mpf(gamma) / l2
    rate = -mpmath.mpf(radial) / mpmath.mpf(0.9)

    def exact(angle: float) -> float:
        sine = mpmath.sin(beta * angle) / beta
        return float(mpmath.re(1 / (1 + rate * sine + (push - beta2) * (1 - mpmath.cos(beta * angle)) / beta2)))

    for angle in (0.0, 0.1, -0.1, 0.5):
        close(orbit.radius(angle), exact(angle), 1e-14)
    field = [Coulomb(-gamma), PowerLaw(-kappa / 2, 2.0)]
    other = vv.orbits.range_of_motion(field, energy=orbit.energy, angular_momentum=orbit.angular_momentum)
    (held,) = [part for part in other if part.r_min <= 1 + 1e-7 and part.r_max >= 1 - 1e-7]
    close(orbit.r_min, held.r_min, 1e-13)
    if np.isfinite(held.r_max):
        close(orbit.r_max, held.r_max, 1e-13)
    assert np.isinf(orbit.r_max) == np.isinf(held.r_max)
    if np.isfinite(orbit.precession):
        general = vv.orbits.central_orbit(field, position=position, velocity=velocity)
        close(orbit.radial_period, general.radial_period, 1e-13)
        close(orbit.apsidal_angle, general.apsidal_angle, 1e-13)
        angle = np.linspace(-20.0, 20.0, 17)
        close(orbit.radius(angle), general.radius(angle), 1e-12)


def test_golden_precessing_ellipse_in_closed_form() -> None:
    case = CASES["G7.17-precessing-ellipse"]
    given, out = case["inputs"], case["outputs"]
    near = out["r_min"]
    orbit = vv.orbits.precessing_conic(
        given["m"], given["gamma"], given["kappa"], position=[near, 0, 0], velocity=[0, given["l"] / near, 0]
    )
    close(orbit.beta_squared, out["beta"] ** 2, 4e-16)
    close(orbit.eccentricity, given["e"], 4e-15)
    close(orbit.radial_period, out["radial_period"], 4e-15)
    close(2 * orbit.apsidal_angle, out["apsidal_angle_full"], 4e-16)
    close(orbit.precession, out["advance_per_radial_period"], 4e-15)
    fast = vv.orbits.precessing_conic(1.0, 1.0, 0.0, position=[1.0, 0, 0], velocity=[0, 2.0, 0])
    with pytest.raises(vv.InvalidInput, match="asymptotes"):
        fast.radius(3.0)
    with pytest.raises(vv.InvalidInput, match="velocity"):
        vv.orbits.precessing_conic(1.0, 1.0, 0.0, position=[1.0, 0, 0], velocity=[2.0, 0.0, 0])
