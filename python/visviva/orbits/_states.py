"""States on orbits: from given elements, and moved along an orbit by given times.

The one idea: places and velocities are closed forms of an anomaly, and of the time in universal variables, so nothing
is stepped.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva import _core
from visviva._arrays import float_array
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.orbits._arguments import broadcast

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def state(
    mu: ArrayLike,
    *,
    pericenter: ArrayLike,
    eccentricity: ArrayLike,
    inclination: ArrayLike = 0.0,
    node: ArrayLike = 0.0,
    argument_of_pericenter: ArrayLike = 0.0,
    true_anomaly: ArrayLike | None = None,
    eccentric_anomaly: ArrayLike | None = None,
    mean_anomaly: ArrayLike | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Find the states of orbits with given elements.

    Units: μ is in length³ / time², in the caller's units of both; angles in radians.

    Parameters
    ----------
    mu : array_like
        Strength of the acceleration −μ r/|r|³; negative for repulsion, not 0.
    pericenter : array_like
        Least distance, above 0: a|1 − e| (repulsion: a(e + 1)).
    eccentricity : array_like
        e ≥ 0; for repulsion e > 1.
    inclination : array_like, optional
        From 0 to π.
    node, argument_of_pericenter : array_like, optional
        Angles as in :class:`Elements`.
    true_anomaly, eccentric_anomaly, mean_anomaly : array_like, optional
        Where the body is, by one of the three at most, as in :class:`Elements`: the first inside the asymptotes of a
        hyperbola, the second E, H or D = tan(ν/2). By default at the pericenter.

    Returns
    -------
    position, velocity : ndarray, shape (…, 3)
        With the axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.9; Murray & Dermott, *Solar System Dynamics*
    (1999), § 2.8.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> position, velocity = vv.orbits.state(1.0, pericenter=1.0, eccentricity=0.44)
    >>> position.tolist(), round(float(velocity[1]), 12)
    ([1.0, 0.0, 0.0], 1.2)
    >>> position, _ = vv.orbits.state(1.0, pericenter=1.0, eccentricity=0.44, mean_anomaly=np.pi)
    >>> round(float(position[0]), 12)
    -2.571428571429
    """
    anomalies = {
        "true_anomaly": true_anomaly,
        "eccentric_anomaly": eccentric_anomaly,
        "mean_anomaly": mean_anomaly,
    }
    chosen = [name for name, value in anomalies.items() if value is not None] or ["true_anomaly"]
    if len(chosen) > 1:
        raise InvalidInput(chosen[1], f"expected one anomaly, got {' and '.join(chosen)}; leave out all but one")
    where = anomalies[chosen[0]]
    given = {
        "mu": mu,
        "pericenter": pericenter,
        "eccentricity": eccentricity,
        "inclination": inclination,
        "node": node,
        "argument_of_pericenter": argument_of_pericenter,
        chosen[0]: 0.0 if where is None else where,
    }
    shape, flat, _ = broadcast(given, {})
    position, velocity = _core.orbit_state(chosen[0], *flat)
    return position.reshape((*shape, 3)), velocity.reshape((*shape, 3))


@known_keywords
def propagate(
    mu: ArrayLike, position: ArrayLike, velocity: ArrayLike, t: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Move states along their orbits by given times, in closed form.

    Units: μ is in length³ / time², in the caller's units of both.

    Parameters
    ----------
    mu : array_like, shape (…)
        Strength of the acceleration −μ r/|r|³: G(m₁ + m₂), negative for repulsion, 0 for a straight line.
    position, velocity : array_like, shape (…, 3)
        State relative to the center at time 0.
    t : array_like
        Times since then, of any shape and sign; every orbit is asked for all of them.

    Returns
    -------
    position, velocity : ndarray, shape (…, 3)
        The axes of ``t``, then the leading axes of the orbits, then 3. At ``t = 0`` they are the given bits. A body
        that falls straight into the center comes back on its way; at the instant of the collision both are 0.

    Raises
    ------
    InvalidInput
        For a wrong shape, NaN or infinity, or a position at the center.

    Notes
    -----
    Measured against 100 to 420 digits, the given numbers being taken as exact, up to 10⁹ periods: of 32 000 random
    orbits of every kind all but 15 are within 6 half-ulps of |r| and |v| (median 1), and within 10 where the motion is
    not radial or nearly so (25). Just after the epoch, where |v| passes through zero, its error is in half-ulps of the
    velocity at the epoch instead. Method: universal variables (Stiefel & Scheifele, *Linear and Regular Celestial
    Mechanics* (1971)) counted from an apsis.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> position, _ = vv.orbits.propagate(1.0, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], np.pi / 2)
    >>> position.round(15).tolist()
    [0.0, 1.0, 0.0]
    """
    shape, (mu_,), (position_, velocity_) = broadcast({"mu": mu}, {"position": position, "velocity": velocity})
    times = float_array("t", t, None)
    found = _core.orbit_propagate(mu_, position_, velocity_, times.ravel())
    moved, rate = (part.reshape((*times.shape, *shape, 3)) for part in found)
    return moved, rate
