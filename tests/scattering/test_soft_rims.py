"""Tables that end softly: V falls to zero at the rim with its slope, to less than a rounding of V elsewhere.

V = k x^n of twelve points, x = R - r: the quartics of the table through its neighbors are that, but for their last
digits, of which those of x² tell most so near to the rim. Against mpmath, as `test_repelling_rims` has it.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import visviva as vv

RADIUS = 3.0
_R = np.linspace(0.5, RADIUS, 12)
TABLES = {n: vv.potentials.Tabulated(_R, k * (RADIUS - _R) ** n) for n, k in ((2, 1.0), (3, 5.0))}


def exact(n: int, energy: float, b: float) -> float:
    """The angle, with K = 0 found in the depth and the angle within swept over √ of what is left of it."""
    with mp.workdps(60):
        b = mp.mpf(b)
        square, cube = mp.mpf(float(TABLES[n].curvature(RADIUS))) / 2, {2: 0, 3: 5}[n]

        def rest(x: mp.mpf) -> mp.mpf:
            return 1 - (b / (RADIUS - x)) ** 2 - (square + cube * x) * x**2 / mp.mpf(energy)

        low, high = mp.mpf(0), RADIUS - b
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if rest(middle) > 0 else (low, middle)

        def turn(t: mp.mpf) -> mp.mpf:
            x = low * (1 - t * t)
            return 2 * low * t * b / (RADIUS - x) ** 2 / mp.sqrt(rest(x))

        return float(2 * mp.acos(b / RADIUS) - 2 * mp.quad(turn, [0, 0.5, 1], method="gauss-legendre"))


@pytest.mark.parametrize("depth", [1e-4, 1e-5, 2e-6, 1e-6, 1e-7, 3e-9])
@pytest.mark.parametrize("energy", [1e-14, 1e-11, 1e-9, 1e-7, 1e-3, 0.3])
@pytest.mark.parametrize("n", TABLES)
def test_the_angle_is_as_certain_as_it_says(n: int, energy: float, depth: float) -> None:
    found = vv.scattering.deflect(TABLES[n], energy=energy, impact_parameter=RADIUS - depth)
    expected = exact(n, energy, RADIUS - depth)
    off = abs(float(found.angle) - expected)
    # Or what a last digit of b makes of it.
    assert off <= max(float(found.error), np.finfo(float).eps * RADIUS / depth * expected)
    # Of the depth a rounding of r₀ leaves 4e-16/depth; that is told with a factor of some hundreds at most.
    assert float(found.error) <= max(1e-4, 3e-13 / depth) * expected


@pytest.mark.parametrize("power", [2.0, 2.5, 4.0])
def test_the_cross_section_at_a_soft_rim_has_no_end(power: float) -> None:
    """ψ ~ (R − b)^(n − 1/2) for V ~ (R − r)^n: b/(sin ψ |dψ/db|) grows beyond all bounds for n > 1."""
    soft = vv.potentials.SoftSphere(3.0, 1.0, power)
    for frame in ("cm", "lab"):
        keywords = {} if frame == "cm" else {"frame": "lab", "mass_ratio": 0.5}
        found = vv.scattering.cross_section(soft, energy=1.3, angle=[0.0, 1e-12, 1e-6], **keywords)
        assert found[0] == np.inf
        assert found[1] > found[2] > 0.0
    # All that touch the sphere are deflected by more than nothing.
    assert vv.scattering.total_cross_section(soft, energy=1.3) == pytest.approx(np.pi, rel=1e-12, abs=0)
