"""Where searches for equilibria begin, and which of the places that they reach are one.

The one idea: everything is judged by the sizes of the starts that lead to it: those of one size are looked at together,
and those of another by themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._equilibria import Equilibrium
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = [
    "SAME",
    "angles",
    "by_sizes",
    "distinguishing_coordinates",
    "is_free",
    "place_at_start",
    "starts_of_a_search",
    "turned",
    "where_something_acts",
    "within",
]

#: Places that differ by less than this part of their sizes are one.
SAME = 1e-8
#: Starts of a search for equilibria, and of one of many coordinates.
_MOST_STARTS = 2000
_MOST_OF_MANY = 256
_ALONG_AN_AXIS = 400
#: Starts of which one is this many times as large as another are looked at by themselves: its rounding is no measure of
#: what that one finds.
_ALIKE = 1e3
#: Forces are looked at this far aside, and are none where they have no digits left.
_ASIDE = 1e-3 * np.pi
_UNDERFLOWN = float(np.finfo(float).tiny / np.finfo(float).eps)
#: A place is known to this part of the size of the starts.
_LOST = 1e-14
#: Coordinates within a turn.
_A_TURN = np.pi + 1e-6
#: What differs by less than this part after turns is the same: a thousand of them leave thirteen digits of a place.
_REPEATS = 1e-9
#: Turns after which an angle is the same; of a length a slope may be nothing in one of them.
_TURNS = (0.0, 1.0, 1e3)
#: How far off equilibria are told of coordinates that are no angles, in units of where the system starts.
_AS_FAR = 4.0


def place_at_start(system: Lagrangian | Hamiltonian) -> NDArray[np.float64]:
    """Give where a system starts (n,), zeros if nobody has told."""
    n = len(system.coordinates)
    return np.zeros(n) if system.position is None else system._start()[:n]


def turned(start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give places (3n, n): for each coordinate one, where it is within a turn, and then those some turns of it on."""
    # A turn is nothing beside a length that is large.
    within = np.where(np.eye(len(start), dtype=bool), np.remainder(start, 2.0 * np.pi), start)
    return np.vstack([within + 2.0 * np.pi * turns * np.eye(len(start)) for turns in _TURNS])


def angles(forces: NDArray[np.float64], slopes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which coordinates (n) are angles: forces and their slopes at the places of `turned` are the same after turns."""
    rows = np.concatenate([forces, 2.0 * np.pi * slopes.reshape(len(slopes), -1)], axis=1)
    before, *after = np.split(rows, len(_TURNS))
    with np.errstate(all="ignore"):
        change = np.abs(np.stack(after) - before).max(axis=(0, 2))
        same: NDArray[np.bool_] = change <= _REPEATS * np.abs(before).max(axis=1)
    return same


def within(start: NDArray[np.float64], is_angle: NDArray[np.bool_]) -> NDArray[np.float64]:
    """How far off each coordinate may be (n,): angles a turn, others about as far as the system starts, too."""
    return np.where(is_angle, _A_TURN, np.fmax(_A_TURN, _AS_FAR * np.abs(start)))


def starts_of_a_search(n: int) -> NDArray[np.float64]:
    """Give places (S, n) over a turn where the search for equilibria starts: a grid, or of many coordinates fewer.

    Beside the grid more of them along each axis, on which those of symmetric systems are, as close to each other as two
    of Lagrange's points on either side of a planet.
    """
    side = max(2, int(_MOST_STARTS ** (1.0 / n)))
    if 2**n <= _MOST_OF_MANY:
        aside = 1e-3 * np.arange(1, n + 1)
        along = np.tile(aside, (n, _ALONG_AN_AXIS, 1))
        for axis in range(n):
            along[axis, :, axis] += np.linspace(-np.pi, np.pi, _ALONG_AN_AXIS)
        line = np.linspace(-np.pi, np.pi, min(side, 25))
        # Not on the symmetry lines themselves, where Newton's method may be caught.
        grid = np.meshgrid(*[line + by for by in aside], indexing="ij")
        return np.concatenate([np.stack([axis.ravel() for axis in grid], axis=1), *along])
    # Evenly spread without a grid: multiples of powers of the root of x^(n+1) = x + 1 (M. Roberts).
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (n + 1))
    spread = (0.5 + np.arange(1, _MOST_OF_MANY + 1)[:, None] * root ** -np.arange(1.0, n + 1.0)) % 1.0
    places = np.pi * (2.0 * spread - 1.0)
    # Every other one next to the middle or the ends of each coordinate, where symmetric systems stay.
    aside = 1e-3 * np.arange(1, n + 1)
    places[::2] = np.pi * np.rint(places[::2] / np.pi) + aside
    # What hangs straight down and what stands straight up are looked for whatever the spread hits.
    return np.concatenate([places, [aside, np.pi - aside]])


def distinguishing_coordinates(system: Lagrangian | Hamiltonian) -> NDArray[np.bool_]:
    """Which coordinates (n) tell places apart: all but those that nothing depends on."""
    distinguishing = np.ones(len(system.coordinates), dtype=bool)
    distinguishing[system._structure["cyclic"]] = False
    return distinguishing


def where_something_acts(
    forces: Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]],
    places: NDArray[np.float64],
    coordinates: int,
) -> NDArray[np.bool_]:
    """Whether forces have slopes at places (S, m), or are on both sides of the first numbers of these.

    Where a potential underflows all is in balance, and no place is an equilibrium more than another.
    """
    # Along an axis there is none where lines of equilibria cross that are parallel to the axes.
    between = np.pad(np.cos(np.arange(1.0, coordinates + 1.0)), (0, places.shape[1] - coordinates))
    steps = _ASIDE * np.vstack([np.eye(coordinates, places.shape[1]), between])
    sides = ([_largest(forces(places + sign * step))[0] for sign in (1.0, -1.0)] for step in steps)
    beside = [np.minimum(*both) for both in sides]
    acts: NDArray[np.bool_] = np.maximum(_largest(forces(places))[1], np.max(beside, axis=0)) > _UNDERFLOWN
    return acts


def is_free(forces: tuple[NDArray[np.float64], NDArray[np.float64]]) -> bool:
    """Whether there is no force (S, n), of those with their slopes (S, n, n), so that equilibria are everywhere."""
    return not bool((_largest(forces)[0] > 0.0).any())


def _largest(
    forces: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    found, slopes = (np.where(np.isfinite(each), np.abs(each), 0.0) for each in forces)
    return found.max(axis=1), slopes.max(axis=(1, 2))


def by_sizes(
    system: Lagrangian | Hamiltonian,
    starts: NDArray[np.float64],
    sizes: NDArray[np.float64],
    search: Callable[[NDArray[np.float64]], list[Equilibrium]],
) -> list[Equilibrium]:
    """What a search finds from starts (S, m) of sizes (S), those of about one size together: of several the nearest."""
    distinguishing = distinguishing_coordinates(system)
    found: list[Equilibrium] = []
    refused: InvalidInput | None = None
    left = np.argsort(sizes, kind="stable")
    while len(left):
        # Where nothing is far from zero the next size is that of the group.
        first = sizes[left][sizes[left] > 0.0]
        together = sizes[left] <= _ALIKE * (first[0] if len(first) else 0.0)
        group, left = left[together], left[~together]
        try:
            reached = search(starts[group])
        except InvalidInput as refusal:
            refused = refused or refusal
            continue
        size = float(sizes[group].max())
        found += [each for each in reached if not any(_agree(each, other, size, distinguishing) for other in found)]
    if refused is not None and not found:
        raise refused
    return sorted(found, key=lambda each: (*each.position, *each.momentum))


def _agree(one: Equilibrium, other: Equilibrium, size: float, distinguishing: NDArray[np.bool_]) -> bool:
    """Whether two equilibria are in one place, of which a search from starts of a size has found the first."""
    apart = np.abs(one.position - other.position)[distinguishing].max(initial=0.0)
    most = max(np.abs(one.position).max(initial=0.0), np.abs(other.position).max(initial=0.0))
    momenta = np.abs(one.momentum - other.momentum).max(initial=0.0)
    largest = max(np.abs(one.momentum).max(initial=0.0), np.abs(other.momentum).max(initial=0.0))
    return bool(apart <= SAME * most + _LOST * size and momenta <= SAME * largest)
