"""What turns just within the end of a table that still repels there: a hard sphere but for a thin layer.

With the depth x below the rim V = F x + c x²/2, and K = 1 − b²/r² − V/E is integrated over x = x₀ (1 − t²) by mpmath.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import visviva as vv

s = vv.scattering
_LINE = np.linspace(0.0, 1.0, 50)
_BENT = np.linspace(0.0, 2.0, 200)
#: The table, and its radius, force and bend.
TABLES = {
    "line": (vv.potentials.Tabulated(_LINE, 1.0 - _LINE), 1.0, 1.0, 0.0),
    "bent": (vv.potentials.Tabulated(_BENT, 2.0 * (2.0 - _BENT) + 1.5 * (2.0 - _BENT) ** 2), 2.0, 2.0, 3.0),
}
#: Energies, and impact parameters as parts of the radius: thin layers of fast and of slow ones, and thicker ones.
PAIRS = [
    (1e-12, 0.999),
    (1e-9, 0.0),
    (1e-7, 0.3),
    (1e-4, 1.0 - 1e-11),
    (1e-3, 1.0 - 1e-6),
    (1e-2, 1.0 - 1e-5),
    (1.0, 1.0 - 1e-6),
    (1.0, 1.0 - 1e-5),
    (100.0, 1.0 - 1e-9),
]


def exact(name: str, energy: float, b: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """The angle, and the delay as a path."""
    radius, force, bend = (mp.mpf(x) for x in TABLES[name][1:])

    def rest(x: mp.mpf) -> mp.mpf:
        return 1 - (b / (radius - x)) ** 2 - (force * x + bend * x * x / 2) / energy

    across = 1 - (b / radius) ** 2
    depth = mp.findroot(rest, across / (force / energy + 2 * b**2 / radius**3))

    def time(t: mp.mpf) -> mp.mpf:
        return 2 * depth * t / mp.sqrt(rest(depth * (1 - t * t)))

    def turn(t: mp.mpf) -> mp.mpf:
        return b / (radius - depth * (1 - t * t)) ** 2 * time(t)

    swept, spent = (2 * mp.quad(f, [0, 1], method="gauss-legendre") for f in (turn, time))
    return 2 * mp.acos(b / radius) - swept, spent - 2 * radius * mp.sqrt(across)


@pytest.mark.parametrize(("energy", "part"), PAIRS)
@pytest.mark.parametrize("name", TABLES)
def test_it_is_a_hard_sphere_but_for_the_layer(name: str, energy: float, part: float) -> None:
    table, radius, *_ = TABLES[name]
    b = part * radius
    found = s.deflect(table, energy=energy, impact_parameter=b)
    with mp.workdps(40):
        step = mp.mpf(10) ** -12 * (radius - mp.mpf(b))
        (angle, delay), (before, _), (after, _) = (exact(name, energy, mp.mpf(b) + k * step) for k in (0, -1, 1))
        slope = (after - before) / (2 * step)
    # A part of 1e-6 of the radius below the rim a turning point has ten digits as a distance; of the layer squares are
    # left out.
    assert float(found.angle) == pytest.approx(float(angle), rel=3e-11, abs=0.0)
    assert abs(float(found.angle) - float(angle)) <= 20.0 * float(found.error)
    assert float(found.path_delay) == pytest.approx(float(delay), rel=3e-10, abs=0.0)
    # Of fast ones a ten-thousandth of both terms is left.
    assert float(found.derivative) == pytest.approx(float(slope), rel=1e-9, abs=0.0)
    assert float(found.closest_approach) < radius
    assert int(found.turning_points) == 1


def test_counts_and_cross_sections_have_it() -> None:
    """Slow ones see a sphere: π R², equal counts in equal parts of the solid angle."""
    table, radius, *_ = TABLES["line"]
    assert s.transport_cross_section(table, energy=1e-10) == pytest.approx(np.pi * radius**2, rel=1e-9, abs=0.0)
    run = s.monte_carlo(
        table,
        beam_energy=1e-10,
        masses=(1.0, 3.0),
        b_max=radius,
        n_events=40000,
        seed=5,
        tally="cm_angle",
        bins=np.arccos(np.linspace(1.0, -1.0, 11)),
    )
    # 4000 ± 60 each, five times that.
    np.testing.assert_allclose(run["cm_angle"].counts, 4000.0, rtol=0.0, atol=300.0)
