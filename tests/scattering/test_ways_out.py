"""Refusals that come at once, and name the way out that works."""

import re
import time

import numpy as np
import pytest
import sympy as sp

import visviva as vv

S, P = vv.scattering, vv.potentials
R = sp.Symbol("r", positive=True)


def test_a_table_that_begins_too_far_out_is_refused_before_slow_collisions_are_followed() -> None:
    r = np.geomspace(0.8, 8.0, 200)
    cut = P.Tabulated(r, 4.0 * (r**-12.0 - r**-6.0) * (1.0 - r / 8.0) ** 3)
    begun = time.perf_counter()
    with pytest.raises(vv.InvalidInput, match=r"begins before the turning point, but at r = 0\.8") as refused:
        S.collision_integral(cut, temperature=3.0, diameter=1.0)
    assert refused.value.argument == "potential"
    # Measured 5 ms; it took nine seconds.
    assert time.perf_counter() - begun < 2.0


def test_what_changes_too_fast_far_out_has_a_tolerance_with_which_it_is_told() -> None:
    """Friedel's oscillations do not end where they are faint."""
    friedel = P.Custom(sp.cos(6 * R) / R**3 + R**-12)
    with pytest.raises(vv.InvalidInput, match=r"larger tolerance=") as refused:
        S.deflect(friedel, energy=3.0, impact_parameter=0.9)
    [told] = re.findall(r"tolerance=([0-9.e-]+)", str(refused.value))
    found = S.deflect(friedel, energy=3.0, impact_parameter=0.9, tolerance=float(told))
    finer = S.deflect(friedel, energy=3.0, impact_parameter=0.9, tolerance=1e-6)
    # Either is off by its tolerance of what is added up to it, some π.
    assert float(found.angle) == pytest.approx(float(finer.angle), abs=10.0 * (float(told) + 1e-6), rel=0.0)


@pytest.mark.parametrize("switch", [sp.Piecewise((1 - R, R < 1), (0, True)), sp.Max(1 - R, 0), sp.Heaviside(1 - R)])
def test_a_formula_that_switches_names_what_potentials_may_have(switch: sp.Expr) -> None:
    with pytest.raises(vv.InvalidInput, match=r"the smaller of r and a, \(r \+ a - Abs\(r - a\)\)/2") as refused:
        P.Custom(switch)
    assert refused.value.argument == "function"
    assert "step" not in str(refused.value)
    assert "out.final" not in str(refused.value)


def test_the_smaller_of_two_distances_is_a_potential() -> None:
    """(1 - min(r, 1))² is a soft sphere."""
    kinked = P.Custom((1 - (R + 1 - sp.Abs(R - 1)) / 2) ** 2)
    soft = P.SoftSphere(1.0, 1.0, 2.0)
    b = np.array([0.1, 0.5, 0.9])
    angles = S.deflection_angle(kinked, energy=2.0, impact_parameter=b, tolerance=1e-9)
    # As is asked for, of what is added up to an angle, some π.
    assert angles == pytest.approx(S.deflection_angle(soft, energy=2.0, impact_parameter=b), abs=1e-8, rel=0.0)
