"""What motions tell: the impulse of a force, the ratio of two masses, and how rigid a body stays."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array, positive
from visviva._keywords import known_keywords
from visviva._quadrature import time_integral
from visviva.errors import InvalidInput
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray


@known_keywords
def impulse(
    force: Callable[[NDArray[np.float64]], ArrayLike], span: ArrayLike, *, rtol: float = 1e-12
) -> NDArray[np.float64]:
    """The impulse ∫ F dt of a force that is given in time, by which it changes the momentum.

    Units: the units of the force times those of the time; `rtol` is without dimension.

    Parameters
    ----------
    force : callable
        Of times, shape (K,); gives forces, shape (K, 3).
    span : array_like, shape (2,)
        From when to when.
    rtol : float
        Allowed error, of ∫ |F| dt.

    Returns
    -------
    ndarray, shape (3,)

    Raises
    ------
    visviva.ConvergenceError
        If the integral does not settle: a force that jumps or is infinite.

    Notes
    -----
    Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.1. Gauss–Legendre with 8 times in each of 512
    pieces of the span, and in ever more where it has not settled. A blow that is shorter than a two-thousandth of the
    span may fall between all of these times, and count for nothing: give a span around it.

    Examples
    --------
    Half a sine of height F and duration T gives 2 F T/π.

    >>> import numpy as np, visviva as vv
    >>> push = lambda t: np.stack([np.sin(np.pi * t / 0.5), 0 * t, 0 * t], axis=-1)
    >>> (vv.audit.impulse(push, (0.0, 0.5)) * np.pi).round(12).tolist()
    [1.0, 0.0, 0.0]
    """
    if not callable(force):
        raise InvalidInput("force", f"expected a function of the time, got {type(force).__name__}")
    start, end = float_array("span", span, (2,))
    rtol = positive("rtol", rtol)

    return time_integral(force, start, end, rtol)


@known_keywords
def mass_ratio(first: ArrayLike, second: ArrayLike) -> float:
    """The mass of a second body over that of the first, from what they do to each other.

    Units: any, the same of both; the ratio is without dimension.

    Parameters
    ----------
    first, second : array_like, shape (3,) or (T, 3)
        Accelerations of the two at one time, or at several, by nothing but each other.

    Returns
    -------
    float
        m₂/m₁ = −a₁/a₂, that of all times which leaves the least squares.

    Raises
    ------
    visviva.InvalidInput
        If the second body is not accelerated, or not against the first.

    Notes
    -----
    Mach's definition of mass; Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.1.

    Examples
    --------
    >>> import visviva as vv
    >>> a = vv.Scene(vv.Particles([2.0, 6.0], [[0, 0, 0], [1.0, 2.0, 0]]), vv.Gravity(1.0)).acceleration()
    >>> round(vv.audit.mass_ratio(*a), 12)
    3.0
    """
    a, b = (np.atleast_2d(float_array(name, value, None)) for name, value in (("first", first), ("second", second)))
    for name, value in (("first", a), ("second", b)):
        if value.ndim != 2 or value.shape != (len(a), 3):
            raise InvalidInput(name, f"expected shape (3,) or (T, 3), as many of both, got {value.shape}")
    size = float(max(np.abs(a).max(initial=0.0), np.abs(b).max(initial=0.0)))
    a, b = (value / size if size > 0.0 else value for value in (a, b))  # squares must not overflow
    against = -float((a * b).sum())
    if not against > 0.0:
        raise InvalidInput(
            "second", "expected accelerations against those of the first body, as action and reaction give"
        )
    return against / float((b * b).sum())


@known_keywords
def rigidity(trajectory: Trajectory, pairs: Sequence[tuple[int, int]] | None = None) -> NDArray[np.float64]:
    """By how much the distances of bodies change along a recorded run: by nothing in a rigid body.

    Units: what is told is relative, without dimension.

    Parameters
    ----------
    trajectory : Trajectory
        With positions.
    pairs : sequence of pairs of int, optional
        Which bodies; all pairs by default.

    Returns
    -------
    ndarray, shape (T, number of pairs)
        Distance over that in the first row, less one.

    Raises
    ------
    visviva.InvalidInput
        A pair of one body, or of bodies in one place at the start.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 4.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> turning = vv.problems.lagrange_triangle()
    >>> out = turning.scene.run(t=np.linspace(0.0, turning.t_end, 9), method="dop853", rtol=1e-12)
    >>> bool(np.abs(vv.audit.rigidity(out)).max() < 1e-9)
    True
    """
    if not isinstance(trajectory, Trajectory):
        raise InvalidInput("trajectory", f"expected what `Scene.run` gives, got {type(trajectory).__name__}")
    x = trajectory.position
    count = x.shape[1]
    chosen = list(combinations(range(count), 2)) if pairs is None else [tuple(pair) for pair in pairs]
    for pair in chosen:
        if len(pair) != 2 or pair[0] == pair[1] or not all(0 <= body < count for body in pair):
            raise InvalidInput("pairs", f"expected two of the bodies 0 to {count - 1}, got {pair}")
    i, j = np.array(chosen, dtype=int).reshape(-1, 2).T
    apart = np.linalg.norm(x[:, i] - x[:, j], axis=2)
    if not apart[0].all():
        raise InvalidInput("pairs", f"bodies {chosen[int(np.argmin(apart[0]))]} are in one place at the start")
    changes: NDArray[np.float64] = apart / apart[0] - 1.0
    return changes
