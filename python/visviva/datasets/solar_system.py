"""The Sun and the eight planets at the epoch of JPL's ephemeris DE405.

Digits: E. M. Standish and J. G. Williams, *Orbital Ephemerides of the Sun, Moon, and Planets*, ch. 8 of the
*Explanatory Supplement to the Astronomical Almanac*, tables 8.2 (states that DE405 was integrated from) and 8.4
(masses); the states are those of the header of the ephemeris, E. M. Standish, JPL IOM 312.F-98-048 (1998). The
obliquity of the ecliptic of J2000, 84381.448″, is that of IAU 1976, as DE405 and JPL Horizons use it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva._keywords import known_keywords, one_of
from visviva.datasets._bodies import Bodies, columns

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["SolarSystem", "solar_system"]

# Sun over planet, and the heliocentric state in the equator of J2000, in au and au/day. DE405 gives no planet's moons a
# place of their own: the mass is that of the planet with them, and the place that of their center of mass.
_PLANETS = {
    "Mercury": (
        6023600.0,
        (0.3572602064472754, -0.09154904243051842, -0.08598103998694038),
        (0.003367845662193786, 0.02488934284224929, 0.01294407158679597),
    ),
    "Venus": (
        408523.71,
        (0.6082494331856041, -0.3491324431959006, -0.1955443457854069),
        (0.01095242010990884, 0.01561250673986247, 0.006328876451746666),
    ),
    "Earth": (
        328900.5614,
        (0.1160149091391665, -0.9266055536403853, -0.4018062776069881),
        (0.01681162005220229, 0.001743131687982032, 0.0007559737671361461),
    ),
    "Mars": (
        3098708.0,
        (-0.1146885824390927, -1.328366530833488, -0.6061551894193808),
        (0.01448200480794475, 0.0002372854923607114, -0.0002837498361023970),
    ),
    "Jupiter": (
        1047.3486,
        (-5.384209406992146, -0.8312476561610838, -0.2250947570335499),
        (0.001092363291218498, -0.006523294191192267, -0.002823012267219439),
    ),
    "Saturn": (
        3497.898,
        (7.889889933822818, 4.595710726926013, 1.558431516725090),
        (-0.003217203491093664, 0.004330632233555692, 0.001926417463799453),
    ),
    "Uranus": (
        22902.98,
        (-18.26990081497826, -1.162711580219047, -0.2503695407425549),
        (0.0002215401656274106, -0.003767653558246162, -0.001653243804922394),
    ),
    "Neptune": (
        19412.24,
        (-16.05954509192446, -23.94294829087950, -9.400422780354008),
        (0.002643122791576562, -0.001503492080758795, -0.0006812710048723478),
    ),
}
# Gauss's constant, squared: it defines the astronomical unit of DE405, 149597870.691 km.
_G = 0.01720209895**2
# Cosine and sine of the obliquity.
_COSINE, _SINE = 0.91748206206918181, 0.39777715593191371


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class SolarSystem(Bodies):
    """The Sun and the planets; lengths in astronomical units, times in days, masses of the Sun.

    Attributes
    ----------
    names : tuple of str
        Sun, Mercury, Venus, Earth, …, Neptune.
    mass : ndarray, shape (9,)
    position, velocity : ndarray, shape (9, 3)
        From the Sun.
    G : float
    epoch : str
        When the bodies were there.
    source : str
        Where the numbers were published.
    particles : Particles
        The bodies, with their names.
    scene : Scene
        The bodies under their gravity, the Sun at rest at the origin.

    References
    ----------
    Standish & Williams, *Orbital Ephemerides of the Sun, Moon, and Planets*, Explanatory Supplement to the Astronomical
    Almanac, ch. 8; Standish, JPL IOM 312.F-98-048 (1998).

    Examples
    --------
    >>> import visviva as vv
    >>> planets = vv.datasets.solar_system()
    >>> planets.scene.particles.names[:3]
    ('Sun', 'Mercury', 'Venus')
    """


@known_keywords
def solar_system(frame: Literal["ecliptic", "equatorial"] = "ecliptic") -> SolarSystem:
    """The Sun and the eight planets on 28 June 1969, 0 h TDB (JD 2440400.5), from JPL's ephemeris DE405.

    The heliocentric states from which DE405 was integrated, to all 16 digits that were published. The ephemeris itself
    is good to about 0.001″ for the inner planets and 0.1″ for the outer ones. A run of these bodies with `Gravity`
    alone leaves out what DE405 has beside them: relativity (43″ a century in the perihelion of Mercury, 8.6″ of Venus,
    3.8″ of the Earth), the Moon's pull apart from the Earth's, Pluto and the asteroids.

    Parameters
    ----------
    frame : {"ecliptic", "equatorial"}, optional
        Whose plane z is the pole of, both of J2000 with x towards the equinox.

    Returns
    -------
    SolarSystem
        A planet stands for itself with its moons: their mass, at their center of mass; "Earth" is the Earth and the
        Moon.

    Raises
    ------
    visviva.InvalidInput
        For another frame.

    References
    ----------
    Standish & Williams, *Orbital Ephemerides of the Sun, Moon, and Planets*, Explanatory Supplement to the Astronomical
    Almanac, ch. 8, tables 8.2 and 8.4; Standish, JPL IOM 312.F-98-048 (1998).

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.datasets.solar_system().scene
    >>> out = scene.run(t=[0.0, 365.25], method="dop853", rtol=1e-12)
    >>> out["Earth"].elements(about="Sun").semi_major_axis.round(2).tolist()
    [1.0, 1.0]
    """
    one_of("frame", frame, ("ecliptic", "equatorial"))
    planets = tuple(zip(*_PLANETS.values(), strict=True))
    still = (0.0, 0.0, 0.0)
    mass, position, velocity = columns(
        [1.0, *(1.0 / ratio for ratio in planets[0])],
        *(_seen([still, *states], frame == "ecliptic") for states in planets[1:]),
    )
    return SolarSystem(
        ("Sun", *_PLANETS),
        mass,
        position,
        velocity,
        _G,
        "JD 2440400.5 TDB",
        "JPL DE405: Standish & Williams, Explanatory Supplement to the Astronomical Almanac, tables 8.2 and 8.4",
    )


def _seen(equatorial: object, ecliptic: bool) -> NDArray[np.float64]:
    vectors = np.array(equatorial, dtype=float)
    if not ecliptic:
        return vectors
    x, y, z = vectors.T
    return np.stack([x, y * _COSINE + z * _SINE, z * _COSINE - y * _SINE], axis=1)


def __dir__() -> list[str]:
    return list(__all__)
