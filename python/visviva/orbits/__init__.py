"""Orbits: Kepler's in closed form, and those in any central potential.

The one idea: everything about the motion under r̈ = −μ r/|r|³ is known without a step. Ellipses, parabolas, hyperbolas,
repulsion (μ < 0) and radial motion are one set of formulas; the work is done by the core in double-double where digits
would be lost. Arguments may be numbers or arrays, and broadcast against each other; the vector axis is the last.

Those in another potential V(r), or in a sum of them, are found from `radial_motion` to `central_orbit`: turning points
without a gap, periods and angles by quadrature, places at any time by inverting it.

Units are yours: with lengths in L and times in T, μ = G(m₁ + m₂) is in L³/T². Angles are in radians; x is the
reference direction and z the pole. Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.7–3.9;
Danby, *Fundamentals of Celestial Mechanics* (1988) ch. 6.
"""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.orbits._central import (
    CircularOrbits,
    RadialRange,
    circular_orbit,
    circular_orbits,
    effective_potential,
    path_equation,
    range_of_motion,
)
from visviva.orbits._central_orbit import CentralOrbit, central_orbit
from visviva.orbits._conics import Conic, conic, conic_from_constants, free_fall_time, period, semi_major_axis
from visviva.orbits._elements import Elements, elements
from visviva.orbits._ellipse import eccentric_from_mean, eccentric_from_true, mean_from_eccentric, true_from_eccentric
from visviva.orbits._hyperbola import (
    hyperbolic_from_mean,
    hyperbolic_from_true,
    mean_from_hyperbolic,
    true_from_hyperbolic,
)
from visviva.orbits._inverse_cube import PrecessingConic, precessing_conic
from visviva.orbits._parabola import mean_from_parabolic, parabolic_from_mean, parabolic_from_true, true_from_parabolic
from visviva.orbits._radial import (
    RadialMotion,
    apsidal_angle,
    precession,
    radial_motion,
    radial_period,
    swept_angle,
    time_of_flight,
)
from visviva.orbits._states import propagate, state

__all__ = [
    "CentralOrbit",
    "CircularOrbits",
    "Conic",
    "Elements",
    "PrecessingConic",
    "RadialMotion",
    "RadialRange",
    "apsidal_angle",
    "central_orbit",
    "circular_orbit",
    "circular_orbits",
    "conic",
    "conic_from_constants",
    "eccentric_from_mean",
    "eccentric_from_true",
    "effective_potential",
    "elements",
    "free_fall_time",
    "hyperbolic_from_mean",
    "hyperbolic_from_true",
    "mean_from_eccentric",
    "mean_from_hyperbolic",
    "mean_from_parabolic",
    "parabolic_from_mean",
    "parabolic_from_true",
    "path_equation",
    "period",
    "precessing_conic",
    "precession",
    "propagate",
    "radial_motion",
    "radial_period",
    "range_of_motion",
    "semi_major_axis",
    "state",
    "swept_angle",
    "time_of_flight",
    "true_from_eccentric",
    "true_from_hyperbolic",
    "true_from_parabolic",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
