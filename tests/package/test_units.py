"""Units: the numbers of their sources, and those that follow from them."""

from fractions import Fraction
from math import isclose, pi

import pytest

import visviva as vv
from visviva import units


def test_the_si_constants_are_those_of_codata() -> None:
    """SciPy has a table of its own; the digits that are exact or quoted are the same."""
    constants = pytest.importorskip("scipy.constants")
    if constants.physical_constants["electron mass"][0] == 9.1093837015e-31:
        pytest.skip("a SciPy with the adjustment of 2018")
    for name, value in {
        "Newtonian constant of gravitation": units.GRAVITATIONAL_CONSTANT,
        "speed of light in vacuum": units.SPEED_OF_LIGHT,
        "elementary charge": units.ELEMENTARY_CHARGE,
        "Planck constant": units.PLANCK_CONSTANT,
        "Boltzmann constant": units.BOLTZMANN_CONSTANT,
        "vacuum electric permittivity": units.VACUUM_PERMITTIVITY,
        "atomic mass constant": units.ATOMIC_MASS_CONSTANT,
        "electron mass": units.ELECTRON_MASS,
        "proton mass": units.PROTON_MASS,
        "Bohr radius": units.BOHR_RADIUS,
        "Hartree energy": units.HARTREE,
    }.items():
        assert constants.physical_constants[name][0] == value, name
    assert constants.au == units.ASTRONOMICAL_UNIT
    assert isclose(constants.parsec, units.PARSEC, rel_tol=1e-15)
    assert constants.Julian_year == units.JULIAN_YEAR


def test_the_parsec_is_what_sees_the_astronomical_unit_under_a_second_of_arc() -> None:
    assert isclose(units.PARSEC, 648000.0 / pi * units.ASTRONOMICAL_UNIT, rel_tol=3e-16)


def test_the_gravitational_constants() -> None:
    """Of solar masses from the Sun's nominal GM alone, in which G and the kilogram have no part."""
    au = Fraction(149597870700)
    assert float(Fraction(132712440) * 10**12 * 86400**2 / au**3) == units.AU_DAY_SOLAR_MASS.G
    # Gauss's constant, an au 9 m shorter and a Sun 3e-10 heavier agree with it as far as these do.
    assert isclose(units.AU_DAY_SOLAR_MASS.G, units.GAUSSIAN_GRAVITATIONAL_CONSTANT**2, rel_tol=5e-10)
    assert isclose(units.AU_YEAR_SOLAR_MASS.G, units.AU_DAY_SOLAR_MASS.G * 365.25**2, rel_tol=1e-15)
    assert isclose(units.AU_YEAR_SOLAR_MASS.G, 4.0 * pi**2, rel_tol=4e-5)  # the Julian year is not the Gaussian
    # As astronomers quote it: 4.30092e-3 pc (km/s)² per solar mass.
    megayear = 1e6 * units.JULIAN_YEAR
    speed = units.PARSEC / megayear / 1e3
    assert isclose(units.PARSEC_MEGAYEAR_SOLAR_MASS.G * speed**2, 4.30092e-3, rel_tol=1e-6)
    assert units.SI.G == 6.67430e-11
    assert isclose(units.CGS.G, 6.67430e-8, rel_tol=1e-15)
    assert isclose(units.KILOMETER_KILOGRAM_SECOND.G, 6.67430e-20, rel_tol=1e-15)
    assert units.N_BODY.G == 1.0


def test_light_and_charges() -> None:
    assert units.SI.c == 299792458.0
    assert isclose(units.AU_DAY_SOLAR_MASS.c, 173.1446326742403, rel_tol=1e-15)  # 1/c: 499.004783836 s per au
    assert isclose(units.ASTRONOMICAL_UNIT / units.SPEED_OF_LIGHT, 499.004783836, rel_tol=1e-12)
    # In atomic units e²/4πε₀ = 1 and c = 1/α, within what the constants were adjusted to.
    assert isclose(units.ATOMIC.coulomb, 1.0, rel_tol=1e-9)
    assert isclose(units.ATOMIC.c, 137.035999177, rel_tol=1e-9)
    # 14.3996454… eV Å: the product 1.43996454 MeV fm of nuclear physics.
    assert isclose(units.ANGSTROM_ELECTRONVOLT_DALTON.coulomb, 14.3996454, rel_tol=1e-8)
    assert isclose(units.ANGSTROM_ELECTRONVOLT_DALTON.time, 1.018051e-14, rel_tol=1e-6)


def test_a_scene_goes_from_one_system_to_another_by_their_ratios() -> None:
    day, year = units.AU_DAY_SOLAR_MASS, units.AU_YEAR_SOLAR_MASS
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Gravity(day.G))
    changed = scene.rescaled(time=day.time / year.time)
    assert isclose(changed.forces[0].G, year.G, rel_tol=1e-15)  # type: ignore[attr-defined]


def test_they_are_frozen_and_print_themselves() -> None:
    with pytest.raises(vv.FrozenAttribute):
        units.SI.G = 1.0  # type: ignore[misc]
    text = str(units.AU_DAY_SOLAR_MASS)
    assert "IAU 2015 B3" in text
    assert "0.000295912208" in text
    assert units.SI == units.SI
    assert len({units.SI, units.CGS, units.SI}) == 2
