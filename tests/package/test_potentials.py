"""The potentials of the registry: F = −dV/dr, and the stub says what is there.

Bounds: closed forms of two or three operations, one rounding each.
"""

import pickle
import subprocess
import sys
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest

import visviva as vv
from visviva import _core, potentials

# Something to try each parameter with; every potential of the registry is tried.
VALUES = (1.3, 0.7, 2.1, 0.4)
JUMPING = ("hard_sphere", "square_well")
PLACES = np.linspace(0.25, 6.0, 600)
OTHERS = {
    "tabulated": (PLACES, 1.3 * np.exp(-0.7 * PLACES) / PLACES),
    "piecewise_polynomial": potentials.Custom(lambda r: 1.3 * np.exp(-0.7 * r) / r, 0.25, 6.0).parameters,
    "expressed": potentials.Custom(lambda r, k: k * np.exp(-0.7 * r) / r, parameters={"k": 1.3}).parameters,
    "soft_sphere": (1.3, 9.0, 2.5),
    "screened_coulomb": (1.3, 0.7, "zbl"),
}
SCREENINGS = ("moliere", "kr_c", "lenz_jensen", "thomas_fermi")
ALL = [
    potentials.potential_by_name(e["name"], OTHERS.get(e["name"], VALUES[: len(e["parameters"])]))
    for e in _core.potentials()
] + [potentials.ScreenedCoulomb(1.3, 0.7, screening) for screening in SCREENINGS]
SMOOTH = [potential for potential in ALL if potential.name not in JUMPING]


@pytest.mark.parametrize("potential", SMOOTH, ids=repr)
def test_force_and_curvature_are_derivatives(potential: potentials.Potential) -> None:
    r = np.geomspace(0.5, 4.9, 23)
    h = 1e-3 * r
    v = [potential.value(r + k * h) for k in (-2, -1, 0, 1, 2)]
    slope = (v[0] - 8 * v[1] + 8 * v[3] - v[4]) / (12 * h)
    second = (-v[0] + 16 * v[1] - 30 * v[2] + 16 * v[3] - v[4]) / (12 * h * h)
    # Truncation: h⁴/30 of the fifth derivative, (1e-3)⁴/30 · r⁵V⁽⁵⁾/V ≤ 3e-14 · 4e5 for r⁻¹²; the second
    # difference has that and the rounding 1e-16/(1e-3)² · 4.
    scale = np.abs(v[2]) / r + np.abs(potential.force(r))
    assert np.all(np.abs(potential.force(r) + slope) <= 2e-8 * scale)
    assert np.all(np.abs(potential.curvature(r) - second) <= 2e-7 * (np.abs(potential.curvature(r)) + scale / r))


@pytest.mark.parametrize("potential", ALL, ids=repr)
def test_values_of_any_shape(potential: potentials.Potential) -> None:
    r = np.linspace(1.0, 2.0, 6).reshape(2, 3)
    assert potential.value(r).shape == (2, 3)
    assert potential.value(1.5).shape == ()
    assert potential.value(r.T)[2, 1] == potential.value(r)[1, 2]
    with pytest.raises(vv.InvalidInput) as caught:
        potential.value([1.0, np.nan])
    assert caught.value.argument == "r"


@pytest.mark.parametrize("potential", ALL, ids=repr)
def test_frozen_hashable_picklable_documented(potential: potentials.Potential) -> None:
    again = pickle.loads(pickle.dumps(potential))
    assert again == potential
    assert hash(again) == hash(potential)
    assert all(map(np.array_equal, again.parameters, potential.parameters))
    name = type(potential).__dataclass_fields__  # type: ignore[attr-defined]
    with pytest.raises(FrozenInstanceError):
        setattr(potential, next(iter(name)), 1.0)
    document = type(potential).__doc__ or ""
    assert "V(r) = " in document
    assert all(f"\n{field} : " in document for field in name)


def test_closed_forms() -> None:
    r = np.array([0.5, 1.0, 4.0])
    assert np.array_equal(potentials.Coulomb(2.0).value(r), 2.0 / r)
    assert potentials.Yukawa(2.0, 0.5).value(r) == pytest.approx(2.0 * np.exp(-r / 0.5) / r, rel=4e-16, abs=0)
    well = potentials.LennardJones(epsilon=3.0, sigma=1.5)
    bottom = 2.0 ** (1 / 6) * 1.5
    # At the minimum V = −ε, to the rounding of (σ/r)⁶ = 1/2; the force vanishes against 24 ε/σ.
    assert float(well.value(bottom)) == pytest.approx(-3.0, rel=4e-15, abs=0)
    assert abs(float(well.force(bottom))) < 48 * 4e-15
    assert float(well.curvature(bottom)) == pytest.approx(72 * 3.0 / bottom**2, rel=1e-14, abs=0)


def test_the_stubs_are_what_the_registry_says() -> None:
    tool = Path(__file__).parents[2] / "tools" / "write_stubs.py"
    done = subprocess.run([sys.executable, tool, "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="coulomb"):
        potentials.potential_by_name("columb", [1.0])


@pytest.mark.parametrize("r", [-1.0, [1.0, -0.5], np.nan])
def test_a_distance_is_not_negative(r: object) -> None:
    """r³ of a Lennard-Jones potential has an answer for −1, exp(−r) of Yukawa's another."""
    for potential in (potentials.Coulomb(1.0), potentials.Yukawa(1.0, 1.0), potentials.LennardJones(1.0, 1.0)):
        for asked in (potential.value, potential.force, potential.curvature):
            with pytest.raises(vv.InvalidInput) as caught:
                asked(r)
            assert caught.value.argument == "r"
