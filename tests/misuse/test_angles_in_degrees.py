"""An angle beyond π and up to a whole turn of degrees is told to be one; another that is out of range is not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

S = vv.scattering
COULOMB = vv.potentials.Coulomb(k=1.0)
FOIL = S.Foil("gold", 0.1)

TAKE_ANGLES: dict[str, Callable[[float], object]] = {
    "cross_section": lambda angle: S.cross_section(COULOMB, energy=1.0, angle=angle),
    "cross_section of recoils": lambda angle: S.cross_section(COULOMB, energy=1.0, angle=angle, frame="recoil"),
    "total_cross_section": lambda angle: S.total_cross_section(COULOMB, energy=1.0, theta_min=angle),
    "impact_parameter": lambda angle: S.impact_parameter(COULOMB, energy=1.0, angle=angle),
    "rutherford_cross_section": lambda angle: S.rutherford_cross_section(COULOMB, energy=1.0, angle=angle),
    "rutherford_impact_parameter": lambda angle: S.rutherford_impact_parameter(COULOMB, energy=1.0, angle=angle),
    "lab_angle": lambda angle: S.lab_angle(angle, mass_ratio=0.5),
    "recoil_angle": S.recoil_angle,
    "opening_angle": lambda angle: S.opening_angle(angle, mass_ratio=0.5),
    "lab_jacobian": lambda angle: S.lab_jacobian(angle, mass_ratio=0.5),
    "recoil_jacobian": S.recoil_jacobian,
    "cm_angle": lambda angle: S.cm_angle(angle, mass_ratio=0.5),
    "cm_angle_from_recoil": S.cm_angle_from_recoil,
    "energy_kept": lambda angle: S.energy_kept(angle, mass_ratio=0.5),
    "energy_transfer": lambda angle: S.energy_transfer(angle, mass_ratio=0.5),
    "kinematic_factor": lambda angle: S.kinematic_factor(angle, mass_ratio=0.5),
    "minimum_angle of a foil": lambda angle: S.Foil("gold", 0.1, minimum_angle=angle),
    "incidence on a foil": lambda angle: FOIL.run("alpha", beam_energy=1e6, n_events=1, seed=1, incidence=angle),
    "incidence of one ion": lambda angle: FOIL.history("alpha", beam_energy=1e6, seed=1, incidence=angle),
    "forced_angle": lambda angle: FOIL.run(
        "alpha", beam_energy=1e6, n_events=1, seed=1, collisions="single", forced_angle=angle
    ),
}


@pytest.mark.parametrize("angle", [45.0, 180.0, 360.0])
@pytest.mark.parametrize("name", TAKE_ANGLES)
def test_degrees_are_told(name: str, angle: float) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"got {angle}; angles are in radians: pass numpy\.radians\(…\) of deg"):
        TAKE_ANGLES[name](angle)


@pytest.mark.parametrize("angle", [-0.5, 1e3])
@pytest.mark.parametrize("name", TAKE_ANGLES)
def test_what_no_degrees_are_is_refused_as_before(name: str, angle: float) -> None:
    with pytest.raises(vv.InvalidInput, match="expected") as caught:
        TAKE_ANGLES[name](angle)
    assert "radians" not in str(caught.value)


def test_of_several_angles_any_may_show_it() -> None:
    with pytest.raises(vv.InvalidInput, match=r"got 10\.0; angles are in radians"):
        S.cross_section(COULOMB, energy=1.0, angle=np.array([1.0, 10.0, 90.0]))
    with pytest.raises(vv.InvalidInput, match=r"got -90\.0; angles are in radians"):
        S.cross_section(COULOMB, energy=1.0, angle=np.array([-90.0, 90.0]))
