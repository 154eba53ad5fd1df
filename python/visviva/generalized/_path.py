"""Paths q(t) between times at which they are known, as polynomials from each time to the next.

The one idea: what is known of a path decides its polynomials, and everything else asks a path for q and q̇ at any time.
A run tells places, velocities and accelerations, which determine polynomials of degree five; places alone are joined by
those through the nearest of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, whole_number
from visviva.errors import InvalidInput
from visviva.generalized._methods import ACROSS_KINKS
from visviva.generalized._trajectory import GeneralizedTrajectory

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["Path", "as_path"]

#: Polynomials of higher degree through many places swing between them: of this one they make at the ends up to 20 times
#: what the places are off (Lebesgue's constant, some 2^(d+1)/(e d ln d)), of degree 15 up to 600 times.
_HIGHEST_DEGREE = 9
#: What polynomials of degree five between rows of a run may be off, as a part of how far it is from the origin there:
#: the tolerance of the motion that they are compared with. This part of the farthest counts at least, of which that is
#: the last digit. For it the time between two rows is cut in so many parts at most, which divides an error of sixth
#: order by 16⁶ = 1.7e7; more would trust an error of rows that far apart too much. So these are cut again in each
#: further round: four make 65536 parts of what was one. Up to so many rows, whose coefficients are some megabytes for
#: each coordinate.
_FOLLOWED = 1e-13
_NEAREST = 1e-3
_MOST_PARTS = 16
_ROUNDS = 4
_MOST_ROWS = 50_000
#: Rows are too far apart where polynomials miss accelerations, times the square of the time between them, by this part
#: of how far the piece goes: a path that meets places, velocities and accelerations at both ends is off by a 24th of
#: that, 4e-5. Or by more than rounding of where it is: differences of places are multiplied by up to 180 in them, and a
#: run may be held to 1e-12 in each of many steps.
_TOO_FAR = 1e-3
_ROUNDED = 1e-9
#: Places between rows where that is looked at: near both ends and in the middle, none of them a small fraction of the
#: rest, at which what repeats between rows could be met by chance.
_LOOKED_AT = np.array([0.07, 0.33, 0.5, 0.67, 0.93])


@dataclass(frozen=True, slots=True)
class Path:
    """A path in pieces: q = Σ cₖ uᵏ with u = (t − tᵢ)/(tᵢ₊₁ − tᵢ)."""

    t: NDArray[np.float64]
    #: Shape (T − 1, degree + 1, n).
    coefficients: NDArray[np.float64]
    #: The same path by what is known of it in polynomials of two degrees less: how well it is determined.
    coarser: Path | None
    #: Of a run the same motion by further rows between those that are too far apart to tell it, ascending in time.
    finer: Path | None = None

    def at(self, pieces: NDArray[np.intp], u: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Give q and q̇, shapes (K, M, n), at fractions u, shape (K, M), of some pieces, shape (K,)."""
        c = self.coefficients[pieces]
        q = np.zeros((*u.shape, c.shape[2]))
        slope = np.zeros_like(q)
        for k in range(c.shape[1] - 1, -1, -1):
            slope = slope * u[..., None] + q
            q = q * u[..., None] + c[:, k, None, :]
        return q, slope / np.diff(self.t)[pieces][:, None, None]


def as_path(system: Lagrangian, path: Any, degree: int, *, ascending: bool = False) -> Path:
    """Give the path that a user means: a run of a Lagrangian, or times and places.

    A run backward in time is a path backward in time, whose integrals are from its first time to its last, unless
    ``ascending`` asks for the same path from its earliest time on; with as many more places between those of the run
    as its polynomials need to follow the equations of motion.
    """
    n = len(system.coordinates)
    if isinstance(path, GeneralizedTrajectory):
        return _path_of_run(path, n, ascending)
    if not isinstance(path, (tuple, list)) or len(path) != 2:
        raise InvalidInput(
            "path", f"expected a trajectory of a Lagrangian, or times and places as (t, q), got {type(path).__name__}"
        )
    t = _times(float_array("path[0]", path[0], (None,)))
    given = np.asarray(path[1])
    shape = (len(t),) if n == 1 and given.ndim == 1 else (len(t), n)
    places = float_array("path[1]", path[1], shape).reshape(len(t), n)
    return interpolated(t, places, whole_number("degree", degree, low=1, high=_HIGHEST_DEGREE))


def _times(t: NDArray[np.float64]) -> NDArray[np.float64]:
    if len(t) < 2:
        raise InvalidInput("path", f"expected at least two times, got {len(t)}")
    if not (np.diff(t) > 0.0).all():
        raise InvalidInput("path", "expected ascending times, each once")
    return t


def interpolated(t: NDArray[np.float64], places: NDArray[np.float64], degree: int) -> Path:
    """Give the path whose pieces are polynomials through the nearest degree + 1 places."""
    count, degree = len(t), min(degree, len(t) - 1)
    first = np.clip(np.arange(count - 1) - (degree - 1) // 2, 0, count - 1 - degree)
    chosen = first[:, None] + np.arange(degree + 1)
    # About the piece's first place, so that a large place costs the differences no digits.
    u = (t[chosen] - t[:-1, None]) / np.diff(t)[:, None]
    differences = places[chosen] - places[:-1, None, :]
    coefficients = np.linalg.solve(u[:, :, None] ** np.arange(degree + 1), differences)
    coefficients[:, 0] = places[:-1]
    coarser = None if degree == 1 else interpolated(t, places, max(1, degree - 2))
    return Path(t, coefficients, coarser)


def _path_of_run(out: GeneralizedTrajectory, n: int, ascending: bool) -> Path:
    system = out.system
    if system._source.kind != "lagrangian":
        raise InvalidInput("path", "expected a run of a Lagrangian; hamiltonian.lagrangian() makes one to run")
    if len(system.coordinates) != n:
        raise InvalidInput("path", f"expected a path of {n} coordinates, got one of {len(system.coordinates)}")
    back = slice(None, None, -1 if len(out.t) > 1 and out.t[0] > out.t[-1] else 1)
    _times(out.t[back])
    order = back if ascending else slice(None)
    t, states = out.t[order], out._states[order]
    if ascending:
        return _followed(system, t, states, np.arange(len(t) - 1))
    path = _through(system, t, states)
    far = _too_far_apart(system, path)
    if not len(far):
        return path
    far = far if t[0] < t[-1] else len(t) - 2 - far
    return replace(path, finer=_followed(system, out.t[back], out._states[back], far))


def _too_far_apart(system: GeneralizedSystem, path: Path) -> NDArray[np.intp]:
    """Pieces of a path between rows of a run that its polynomials do not follow the equations of motion along."""
    pieces, c = np.arange(len(path.t) - 1), path.coefficients
    q, v = path.at(pieces, np.broadcast_to(_LOOKED_AT, (len(pieces), len(_LOOKED_AT))))
    h = np.diff(path.t)[:, None]
    times = path.t[:-1, None] + _LOOKED_AT * h
    states = np.concatenate([q, v], axis=2).reshape(times.size, -1)
    with np.errstate(all="ignore"):
        rates = system._model.rates(times.ravel(), np.ascontiguousarray(states), system._values[None, :])
    orders = np.arange(2, c.shape[1])
    bent = np.einsum("kjn,pj->kpn", c[:, 2:] * (orders * (orders - 1))[:, None], _LOOKED_AT[:, None] ** (orders - 2))
    missed = np.abs(h[:, :, None] ** 2 * rates.reshape(q.shape) - bent).max(axis=1)
    follows = missed <= _TOO_FAR * np.abs(c[:, 1:]).sum(axis=1) + _ROUNDED * np.abs(c[:, 0])
    return np.flatnonzero(~follows.all(axis=1))


def _followed(
    system: GeneralizedSystem, t: NDArray[np.float64], states: NDArray[np.float64], looked_at: NDArray[np.intp]
) -> Path:
    """Give the path through the rows of a run, and in some pieces where the equations of motion lead on from each."""
    n = states.shape[1] // 2
    size = np.abs(states[:, :n]).max(axis=0)
    size[size == 0.0] = 1.0
    path = _through(system, t, states)
    for _ in range(_ROUNDS):
        middles = path.at(looked_at, np.full((len(looked_at), 1), 0.5))[0][:, 0]
        times, more, parts = [t], [states], np.ones(len(t) - 1, dtype=int)
        for piece, told in zip(looked_at.tolist(), middles, strict=True):
            begin, width = t[piece], t[piece + 1] - t[piece]
            ahead = _led_on(system, states[piece], begin, np.array([begin + 0.5 * width, t[piece + 1]]))
            if ahead is None:
                continue
            off = float((np.abs(ahead[0, :n] - told) / size).max())
            apart = np.abs(ahead[1] - states[piece + 1])
            missed = float(((apart[:n] + width * apart[n:]) / size).max())
            # Between rows that the equations of motion do not lead to from each other no path is better than they are.
            least = max(missed, _FOLLOWED * max(_NEAREST, float((np.abs(told) / size).max())))
            # The error of polynomials of degree five between rows.
            wanted = min(_MOST_PARTS, int(np.ceil((off / least) ** (1.0 / 6.0))))
            between = begin + np.arange(1, wanted) / max(1, wanted) * width
            if wanted > 1 and (found := _led_on(system, states[piece], begin, between)) is not None:
                parts[piece] = wanted
                times.append(between)
                more.append(found)
        if len(times) == 1 or parts.sum() > _MOST_ROWS:
            break
        every = np.concatenate(times)
        order = np.argsort(every, kind="stable")
        t, states = every[order], np.concatenate(more)[order]
        path, looked_at = _through(system, t, states), np.flatnonzero(np.repeat(parts, parts) > 1)
    return path


def _led_on(
    system: GeneralizedSystem, state: NDArray[np.float64], begin: float, times: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Give states (T, 2n) at times after one, if the equations of motion lead there."""
    method = ACROSS_KINKS if system._structure["kinks"] else "gauss16"
    asked, _ = system._asked(float(times[-1]), method, 1e-13, None, None)
    asked |= {"span": (begin, float(times[-1])), "outputs": times}
    result = system._model.run(asked, state[None, :], system._values[None, :], 1, None)
    if result["interrupted"]:
        raise KeyboardInterrupt
    found: NDArray[np.float64] = result["y"]
    return found if result["failures"][0] is None and len(found) == len(times) else None


def _through(system: GeneralizedSystem, t: NDArray[np.float64], states: NDArray[np.float64]) -> Path:
    """Give the path through states (T, 2n), whose accelerations the equations of motion tell."""
    n = states.shape[1] // 2
    q, v = states[:, :n], states[:, n:]
    a = system._model.rates(np.ascontiguousarray(t), np.ascontiguousarray(states), system._values[None, :])
    h = np.diff(t)[:, None]
    dq, v0, v1 = np.diff(q, axis=0), h * v[:-1], h * v[1:]
    a0, a1 = h**2 * a[:-1] / 2, h**2 * a[1:] / 2
    cubic = [q[:-1], v0, 3 * dq - 2 * v0 - v1, v0 + v1 - 2 * dq]
    quintic = [
        q[:-1],
        v0,
        a0,
        10 * dq - 6 * v0 - 4 * v1 - 3 * a0 + a1,
        -15 * dq + 8 * v0 + 7 * v1 + 3 * a0 - 2 * a1,
        6 * dq - 3 * (v0 + v1) - a0 + a1,
    ]
    return Path(t, np.stack(quintic, axis=1), Path(t, np.stack(cubic, axis=1), None))
