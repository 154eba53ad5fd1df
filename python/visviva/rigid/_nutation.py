"""How the axis of a heavy top goes round and how it nods: what `HeavyTop` finds of both.

The one idea: momenta and energy stay what they are, so the motion of the axis is that of one angle between two turning
points, and a few numbers tell all of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from visviva._html import Record, brief_tuple
from visviva._keywords import known_keywords

__all__ = ["Nutation", "SteadyPrecession"]


@known_keywords
class SteadyPrecession(NamedTuple):
    """The two rates at which a top precesses steadily; the fast one may be infinite.

    Units: radians per time.

    Attributes
    ----------
    slow, fast : float
        Rates about the vertical, signed as the spin is. The slow one is M g R/(C ω) for a fast top.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.

    Examples
    --------
    >>> import visviva as vv
    >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    >>> rates = top.steady_precession(0.3, 50.0)
    >>> round(rates.slow, 9), round(rates.fast, 9)
    (0.416578701, 10.050937315)
    """

    slow: float
    fast: float

    def __repr__(self) -> str:
        return brief_tuple(self)


@known_keywords
@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Nutation(Record):
    """How the axis of a top nods; what `HeavyTop.nutation` returns.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    theta_min, theta_max : float
        Between which angles from the vertical.
    period : float
        From one to the other and back; infinite if that takes for ever.
    kind : str
        ``"loop"``, ``"cusp"`` or ``"wave"``, by whether the precession turns round on the way, stops at the top of it,
        or neither; ``"plane"`` of a pendulum that neither spins nor goes round; ``"steady"`` if the angle does not
        change.
    roots : tuple of float
        The three roots u = cos θ of u̇² = 0, ascending.
    turning : float
        The height u = p_φ/p_ψ at which the precession turns round; not always one that is reached, and infinite or NaN
        without spin.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.

    Examples
    --------
    >>> import visviva as vv
    >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    >>> found = top.nutation(0.3, psi_dot=50.0)
    >>> found.kind, round(found.theta_max, 9)
    ('cusp', 0.326733715)
    """

    theta_min: float
    theta_max: float
    period: float
    kind: Literal["loop", "cusp", "wave", "plane", "steady"]
    roots: tuple[float, float, float]
    turning: float
