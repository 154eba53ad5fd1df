"""The Sun and the five outer planets, as two often-used test problems give them.

Digits: E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration* (2nd ed., Springer 2006),
section I.2.4; J. H. Applegate, M. R. Douglas, Y. Gürsel, G. J. Sussman, J. Wisdom, *The outer solar
system for 200 million years*, Astron. J. 92 (1986) 176. Both count the inner planets into the Sun.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from visviva._keywords import known_keywords, one_of
from visviva.datasets._bodies import Bodies, columns

__all__ = ["OuterSolarSystem", "outer_solar_system"]

_NAMES = ("Sun", "Jupiter", "Saturn", "Uranus", "Neptune", "Pluto")

_HLW = (
    (1.00000597682, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    (0.000954786104043, (-3.5023653, -3.8169847, -1.5507963), (0.00565429, -0.00412490, -0.00190589)),
    (0.000285583733151, (9.0755314, -3.0458353, -1.6483708), (0.00168318, 0.00483525, 0.00192462)),
    (0.0000437273164546, (8.3101420, -16.2901086, -7.2521278), (0.00354178, 0.00137102, 0.00055029)),
    (0.0000517759138449, (11.4707666, -25.7294829, -10.8169456), (0.00288930, 0.00114527, 0.00039677)),
    (1 / 1.3e8, (-15.5387357, -25.2225594, -3.1902382), (0.00276725, -0.00170702, -0.00136504)),
)

_APPLEGATE = (
    (
        1.00000597682,
        (-4.06428567034226e-3, -6.08813756435987e-3, -1.66162304225834e-6),
        (6.69048890636161e-6, -6.33922479583593e-6, -3.13202145590767e-9),
    ),
    (
        1 / 1047.355,
        (3.40546614227466, 3.62978190075864, 3.42386261766577e-2),
        (-5.59797969310664e-3, 5.51815399480116e-3, -2.66711392865591e-6),
    ),
    (
        1 / 3501.6,
        (6.60801554403466, 6.38084674585064, -0.136145963724542),
        (-4.17354020307064e-3, 3.99723751748116e-3, 1.67206320571441e-5),
    ),
    (
        1 / 22869,
        (11.1636331405597, 16.0373479057256, 0.361783279369958),
        (-3.25884806151064e-3, 2.06438412905916e-3, -2.17699042180559e-5),
    ),
    (
        1 / 19314,
        (-30.1777243405203, 1.91155314998064, -0.153887595621042),
        (-2.17471785045538e-4, -3.11361111025884e-3, 3.58344705491441e-5),
    ),
    (
        7.4074074e-9,
        (-21.3858977531573, 32.0719104739886, 2.49245689556096),
        (-1.76936577252484e-3, -2.06720938381724e-3, 6.58091931493844e-4),
    ),
)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class OuterSolarSystem(Bodies):
    """Bodies of the outer Solar System; lengths in astronomical units, times in days, masses of the Sun.

    Attributes
    ----------
    names : tuple of str
    mass : ndarray, shape (6,)
    position, velocity : ndarray, shape (6, 3)
    G : float
    epoch : str
        When the bodies were there.
    source : str
        Where the numbers were published.
    particles : Particles
        The bodies, with their names.
    scene : Scene
        The bodies under their gravity, as the arrays have them.

    References
    ----------
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), section I.2.4; Applegate et al., Astron.
    J. 92 (1986) 176.

    Examples
    --------
    >>> import visviva as vv
    >>> data = vv.datasets.outer_solar_system()
    >>> data.names[:3], data.position.shape
    (('Sun', 'Jupiter', 'Saturn'), (6, 3))
    """


@known_keywords
def outer_solar_system(
    variant: Literal["hairer_lubich_wanner", "applegate"] = "hairer_lubich_wanner",
) -> OuterSolarSystem:
    """The Sun with the inner planets, Jupiter, Saturn, Uranus, Neptune and Pluto.

    Parameters
    ----------
    variant : {"hairer_lubich_wanner", "applegate"}, optional
        Whose numbers. The Sun of Hairer, Lubich and Wanner starts at rest at the origin, so the
        system drifts; Applegate's is near its center-of-mass frame, with a massive Pluto here.

    Returns
    -------
    OuterSolarSystem
        Of six bodies, positions of shape (6, 3), in astronomical units, days and masses of the Sun.

    Raises
    ------
    visviva.InvalidInput
        For another name.

    References
    ----------
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), section I.2.4; Applegate et al., Astron.
    J. 92 (1986) 176.

    Examples
    --------
    >>> import visviva as vv
    >>> data = vv.datasets.outer_solar_system()
    >>> data.names[1], data.position[1]
    ('Jupiter', array([-3.5023653, -3.8169847, -1.5507963]))
    """
    if one_of("variant", variant, ("hairer_lubich_wanner", "applegate")) == "hairer_lubich_wanner":
        return _make(
            _HLW,
            2.95912208286e-4,
            "1994-09-05 00:00",
            "Hairer, Lubich & Wanner, Geometric Numerical Integration, 2nd ed. (2006), I.2.4",
        )
    return _make(
        _APPLEGATE,
        0.01720209895**2,
        "JD 2430000.5",
        "Applegate, Douglas, Gürsel, Sussman & Wisdom, Astron. J. 92 (1986) 176",
    )


def _make(
    rows: tuple[tuple[float, tuple[float, ...], tuple[float, ...]], ...], G: float, epoch: str, source: str
) -> OuterSolarSystem:
    mass, position, velocity = columns(*zip(*rows, strict=True))
    return OuterSolarSystem(_NAMES, mass, position, velocity, G, epoch, source)


def __dir__() -> list[str]:
    return list(__all__)
