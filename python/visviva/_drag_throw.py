"""A body thrown straight up against drag, in closed form; see `visviva.drag`.

The one idea: rise and fall need no step. The core has them without the differences in which weak drag would be lost.
"""

from __future__ import annotations

from dataclasses import dataclass

from visviva import _core
from visviva._arrays import positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

__all__ = ["Throw", "throw"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Throw(Record):
    """Heights, times and speeds of a body thrown straight up, as plain numbers.

    Units: those of the arguments of `throw`.

    Attributes
    ----------
    terminal_speed : float
        The speed that a long fall approaches.
    apex_time : float
        When it stands still.
    apex_height : float
        How high that is over the start.
    return_time : float
        When it is back at the start.
    return_speed : float
        How fast it is then.

    References
    ----------
    Corless et al., Adv. Comput. Math. 5 (1996) 329 (Lambert's function); Landau & Lifshitz, *Fluid Mechanics*, 2nd ed.,
    § 45.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.drag.throw(speed=12.0, g=9.80665, tau=1.75)
    >>> round(found.return_time, 9)
    2.054327667
    """

    terminal_speed: float
    apex_time: float
    apex_height: float
    return_time: float
    return_speed: float


@known_keywords
def throw(*, speed: float, g: float, tau: float | None = None, terminal_speed: float | None = None) -> Throw:
    """Rise and fall of a body thrown straight up, with linear or with quadratic drag.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    speed : float
        The speed at the start, upward.
    g : float
        The acceleration of gravity, downward, positive.
    tau : float, optional
        The time of linear drag, as of `visviva.LinearDrag`.
    terminal_speed : float, optional
        That of quadratic drag, √(m g/coefficient). One of the two has to be given.

    Returns
    -------
    Throw
        Correct to a few units in the last place, also where drag is weak and differences of what is told vanish.

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive, or not one of `tau` and `terminal_speed` is given.

    References
    ----------
    The return against linear drag by Lambert's function: Corless et al., Adv. Comput. Math. 5 (1996) 329.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.drag.throw(speed=12.0, g=9.80665, tau=1.75).return_time
    2.054327667233007
    """
    if (tau is None) == (terminal_speed is None):
        raise InvalidInput("tau", "expected one of tau (linear drag) and terminal_speed (quadratic drag)")
    values = _core.drag_throw(
        positive("speed", speed),
        positive("g", g),
        None if tau is None else positive("tau", tau),
        0.0 if terminal_speed is None else positive("terminal_speed", terminal_speed),
    )
    return Throw(*values)
