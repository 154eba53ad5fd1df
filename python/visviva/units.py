"""Units as plain numbers: the constants of mechanics in the systems that people use, each with its source.

The core knows no units: a scene is in the caller's own, one consistent system. These are the numbers that such a system
needs, for example the G of `Gravity` and the c of relativity; nothing here converts anything. `Scene.rescaled` takes
the ratios: ``scene.rescaled(time=vv.units.AU_DAY_SOLAR_MASS.time / vv.units.AU_YEAR_SOLAR_MASS.time)``.

Sources: IAU 2012 resolution B2 (astronomical unit), IAU 2015 resolutions B2 (parsec) and B3 (nominal values of the Sun
and the planets), IAU 1976 (Gauss's constant); CODATA 2022 (Mohr, Newell, Taylor & Tiesinga, Rev. Mod. Phys. 97 (2025)
025002), of which the digits in brackets are the standard uncertainty of the last ones; the SI of 2019 (exact e, h, k,
c).

Examples
--------
>>> import visviva as vv
>>> round((2.0 * vv.units.GM_EARTH / vv.units.EARTH_EQUATORIAL_RADIUS) ** 0.5)  # to escape from the Earth, in m/s
11180
>>> round(vv.units.GM_EARTH / vv.units.GM_SUN, 12)  # the mass of the Earth in those of the Sun
3.003489e-06
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from visviva._html import Shown
from visviva._keywords import known_keywords, unknown_name
from visviva._text import table

__all__ = [
    "ANGSTROM_ELECTRONVOLT_DALTON",
    "ASTRONOMICAL_UNIT",
    "ATOMIC",
    "ATOMIC_MASS_CONSTANT",
    "AU_DAY_SOLAR_MASS",
    "AU_YEAR_SOLAR_MASS",
    "BOHR_RADIUS",
    "BOLTZMANN_CONSTANT",
    "CGS",
    "DAY",
    "EARTH_EQUATORIAL_RADIUS",
    "ELECTRON_MASS",
    "ELEMENTARY_CHARGE",
    "GAUSSIAN_GRAVITATIONAL_CONSTANT",
    "GM_EARTH",
    "GM_JUPITER",
    "GM_SUN",
    "GRAVITATIONAL_CONSTANT",
    "HARTREE",
    "JULIAN_YEAR",
    "JUPITER_EQUATORIAL_RADIUS",
    "KILOMETER_KILOGRAM_SECOND",
    "N_BODY",
    "PARSEC",
    "PARSEC_MEGAYEAR_SOLAR_MASS",
    "PLANCK_CONSTANT",
    "PROTON_MASS",
    "SI",
    "SOLAR_MASS",
    "SOLAR_RADIUS",
    "SPEED_OF_LIGHT",
    "VACUUM_PERMITTIVITY",
    "Units",
]

# Each with its unit and its source, which the reference shows; a test looks for them.
SPEED_OF_LIGHT = 299792458.0
"""In m/s, exact. Source: SI of 2019."""
DAY = 86400.0
"""In s, exact. Source: IAU 1976, which defines it so."""
JULIAN_YEAR = 365.25 * DAY
"""In s, exact: 365.25 days. Source: IAU 1976."""
ASTRONOMICAL_UNIT = 149597870700.0
"""In m, exact. Source: IAU 2012 B2."""
PARSEC = 3.0856775814913673e16
"""In m: 648000/π astronomical units. Source: IAU 2015 B2."""
GM_SUN = 1.3271244e20
"""In m³/s², nominal and so exact. Source: IAU 2015 B3."""
GM_EARTH = 3.986004e14
"""In m³/s², nominal and so exact. Source: IAU 2015 B3."""
GM_JUPITER = 1.2668653e17
"""In m³/s², nominal and so exact. Source: IAU 2015 B3."""
SOLAR_RADIUS = 6.957e8
"""In m, nominal and so exact. Source: IAU 2015 B3."""
EARTH_EQUATORIAL_RADIUS = 6.3781e6
"""In m, nominal and so exact. Source: IAU 2015 B3."""
JUPITER_EQUATORIAL_RADIUS = 7.1492e7
"""In m, nominal and so exact. Source: IAU 2015 B3."""
GRAVITATIONAL_CONSTANT = 6.67430e-11
"""In m³/(kg s²), 6.67430(15)e-11. Source: CODATA 2022, the same as of 2018."""
ELEMENTARY_CHARGE = 1.602176634e-19
"""In C, exact; an electronvolt is as many J. Source: SI of 2019."""
PLANCK_CONSTANT = 6.62607015e-34
"""In J s, exact. Source: SI of 2019."""
BOLTZMANN_CONSTANT = 1.380649e-23
"""In J/K, exact. Source: SI of 2019."""
VACUUM_PERMITTIVITY = 8.8541878188e-12
"""In F/m, 8.8541878188(14)e-12. Source: CODATA 2022."""
ATOMIC_MASS_CONSTANT = 1.66053906892e-27
"""In kg, 1.66053906892(52)e-27: a dalton. Source: CODATA 2022."""
ELECTRON_MASS = 9.1093837139e-31
"""In kg, 9.1093837139(28)e-31. Source: CODATA 2022."""
PROTON_MASS = 1.67262192595e-27
"""In kg, 1.67262192595(52)e-27. Source: CODATA 2022."""
BOHR_RADIUS = 5.29177210544e-11
"""In m, 5.29177210544(82)e-11. Source: CODATA 2022."""
HARTREE = 4.3597447222060e-18
"""In J, 4.3597447222060(48)e-18. Source: CODATA 2022."""
SOLAR_MASS = GM_SUN / GRAVITATIONAL_CONSTANT
"""In kg, as good as G: five digits. Source: IAU 2015 B3 and CODATA 2022, `GM_SUN` / `GRAVITATIONAL_CONSTANT`."""
GAUSSIAN_GRAVITATIONAL_CONSTANT = 0.01720209895
"""In au^1.5/(day √(solar mass)): the k whose square was the G of JPL's DE405. Source: IAU 1976."""

# e²/4πε₀ in J m.
_COULOMB = ELEMENTARY_CHARGE**2 / (4.0 * 3.141592653589793 * VACUUM_PERMITTIVITY)


@known_keywords
@dataclass(frozen=True, slots=True, kw_only=True)
class Units(Shown):
    """A system of units: what its units are in SI, and constants in it.

    Attributes
    ----------
    name : str
        What the units are.
    length, mass, time : float
        One of each in meters, kilograms and seconds. Of units that have no size of their own (`N_BODY`) 1.
    G : float
        The gravitational constant.
    c : float
        The speed of light.
    coulomb : float
        e²/4πε₀, energy times length: the potential energy of two elementary charges at the distance 1.
    source : str
        Where the numbers come from.

    References
    ----------
    IAU 2012 resolution B2, IAU 2015 resolutions B2 and B3; CODATA 2022: Mohr, Newell, Taylor & Tiesinga, Rev. Mod.
    Phys. 97 (2025) 025002.

    Examples
    --------
    >>> import visviva as vv
    >>> units = vv.units.AU_DAY_SOLAR_MASS
    >>> units.G
    0.00029591220819207774
    >>> round(2 * 3.141592653589793 * (1.0 / units.G) ** 0.5, 3)  # the year of a massless planet at 1 au
    365.257
    """

    name: str
    length: float
    mass: float
    time: float
    G: float
    c: float
    coulomb: float
    source: str

    def __str__(self) -> str:
        return f"{self.name} ({self.source})\n{table(self, leave_out=('name', 'source'))}"


def _system(name: str, length: float, mass: float, time: float, source: str, gm: float | None = None) -> Units:
    """A system of units of these sizes; `gm` is G times its mass in SI, where that is known better than either."""
    meter, kilogram, second = Fraction(length), Fraction(mass), Fraction(time)
    attraction = Fraction(GRAVITATIONAL_CONSTANT) * kilogram if gm is None else Fraction(gm)
    return Units(
        name=name,
        length=length,
        mass=mass,
        time=time,
        # Each rounded once.
        G=float(attraction * second**2 / meter**3),
        c=float(Fraction(SPEED_OF_LIGHT) * second / meter),
        coulomb=float(Fraction(_COULOMB) * second**2 / (kilogram * meter**3)),
        source=source,
    )


_CODATA = "CODATA 2022"
SI = _system("meter, kilogram, second", 1.0, 1.0, 1.0, _CODATA)
"""Meter, kilogram, second. Source: CODATA 2022."""
CGS = _system("centimeter, gram, second", 1e-2, 1e-3, 1.0, _CODATA)
"""Centimeter, gram, second. Source: CODATA 2022."""
KILOMETER_KILOGRAM_SECOND = _system("kilometer, kilogram, second", 1e3, 1.0, 1.0, _CODATA)
"""Kilometer, kilogram, second. Source: CODATA 2022."""
# The mass is the Sun's nominal one, so G has all its digits: a mass is given as its GM over GM_SUN.
AU_DAY_SOLAR_MASS = _system(
    "astronomical unit, day, solar mass",
    ASTRONOMICAL_UNIT,
    SOLAR_MASS,
    DAY,
    "IAU 2012 B2, IAU 2015 B3",
    GM_SUN,
)
"""Astronomical unit, day, mass of the Sun. Source: IAU 2012 B2, IAU 2015 B3."""
AU_YEAR_SOLAR_MASS = _system(
    "astronomical unit, Julian year, solar mass",
    ASTRONOMICAL_UNIT,
    SOLAR_MASS,
    JULIAN_YEAR,
    "IAU 2012 B2, IAU 2015 B3",
    GM_SUN,
)
"""Astronomical unit, Julian year, mass of the Sun. Source: IAU 2012 B2, IAU 2015 B3."""
PARSEC_MEGAYEAR_SOLAR_MASS = _system(
    "parsec, million Julian years, solar mass", PARSEC, SOLAR_MASS, 1e6 * JULIAN_YEAR, "IAU 2015 B2 and B3", GM_SUN
)
"""Parsec, million Julian years, mass of the Sun. Source: IAU 2015 B2 and B3."""
# ħ/E_h, in which k = 1 but for the uncertainty of its parts.
ATOMIC = _system(
    "Bohr radius, electron mass, ħ/hartree",
    BOHR_RADIUS,
    ELECTRON_MASS,
    PLANCK_CONSTANT / (2.0 * 3.141592653589793 * HARTREE),
    _CODATA,
)
"""Hartree's units: Bohr radius, electron mass, ħ/hartree. Source: CODATA 2022."""
ANGSTROM_ELECTRONVOLT_DALTON = _system(
    "ångström, dalton, and the time in which the energy is an electronvolt, 10.18 fs",
    1e-10,
    ATOMIC_MASS_CONSTANT,
    1e-10 * (ATOMIC_MASS_CONSTANT / ELEMENTARY_CHARGE) ** 0.5,
    _CODATA,
)
"""Ångström, dalton, and the time in which the energy is an electronvolt. Source: CODATA 2022."""
# No light and no charge: what they are depends on the cluster.
N_BODY = Units(
    name="N-body units: G = 1, total mass 1, total energy −1/4",
    length=1.0,
    mass=1.0,
    time=1.0,
    G=1.0,
    c=float("inf"),
    coulomb=0.0,
    source="Heggie & Mathieu, in The Use of Supercomputers in Stellar Dynamics (1986) 233",
)
"""Units in which G = 1, the total mass is 1 and the energy −1/4. Source: Heggie & Mathieu (1986)."""


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
