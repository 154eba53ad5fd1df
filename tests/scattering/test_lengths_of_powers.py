"""Potentials of no length of their own, in units in which everything happens far from one: only ratios matter."""

import numpy as np
import pytest

import visviva as vv

S, V = vv.scattering, vv.potentials
LENGTHS = [1e-30, 1e-25, 1e-20, 1e20, 1e25, 1e30]


@pytest.mark.parametrize("power", [2.5, 3.0, 5.0, 6.0])
@pytest.mark.parametrize("length", LENGTHS)
def test_an_attraction_by_a_power_of_the_distance(length: float, power: float) -> None:
    """All was captured, by a cross section of nothing."""
    here, near = V.PowerLaw(-(length**power), power), V.PowerLaw(-1.0, power)
    found = S.deflect(here, energy=1.0, impact_parameter=np.array([2.0, 3.0, 10.0]) * length)
    wanted = S.deflect(near, energy=1.0, impact_parameter=[2.0, 3.0, 10.0])
    assert found.status.tolist() == wanted.status.tolist()
    # The strength, its power and b are rounded, each by ε: of these angles about ten times as much.
    np.testing.assert_allclose(found.angle, wanted.angle, rtol=1e-13, atol=0.0)
    area = S.capture_cross_section(here, energy=1.0) / length**2
    assert float(area) == pytest.approx(float(S.capture_cross_section(near, energy=1.0)), rel=1e-12, abs=0.0)
    assert len(S.orbiting(here, energy=1.0)) == 1


@pytest.mark.parametrize("length", LENGTHS)
def test_langevins_cross_section(length: float) -> None:
    """Of -C/r⁴: 2π √(C/E)."""
    area = S.capture_cross_section(V.PowerLaw(-(length**4), 4.0), energy=1.0)
    assert float(area) / length**2 == pytest.approx(2.0 * np.pi, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("length", LENGTHS)
def test_closed_shells(length: float) -> None:
    """Buckingham's has an inverse length, by which it is known."""
    found = S.deflect(V.Buckingham(1000.0, 3.0 / length, 10.0 * length**6), energy=1.0, impact_parameter=length)
    wanted = S.deflect(V.Buckingham(1000.0, 3.0, 10.0), energy=1.0, impact_parameter=1.0)
    assert found.status == wanted.status
    assert float(found.angle) == pytest.approx(float(wanted.angle), rel=1e-12, abs=0.0)
