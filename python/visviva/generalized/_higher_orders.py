"""What an energy does beside a place where it is level to second order: it grows, falls, or stays.

The one idea: away from the place along a level direction all other coordinates go where no force is on them (R. Thom's
splitting lemma); what is left of the slope, at the nearest distance at which it is more than round-off, tells whether
the energy rises there. At a minimum it rises in all directions (J.-L. Lagrange & P. G. L. Dirichlet).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["Curvatures", "Energy", "curvatures", "rises"]

_EPSILON = float(np.finfo(float).eps)
#: Roundings of an entry beside what it was told to be uncertain by, and of eigenvalues.
_ROUNDINGS = 8.0
#: Of a coordinate without a known curvature the size is so many times what others may be off by beside it.
_UNKNOWN = 1e3
#: Entries of a symmetric matrix differ by no more than this part of what they are divided by.
_SYMMETRIC = 1e-12
#: Distances that are looked at: all powers of four that numbers and their cubes have.
_DISTANCES = 2.0 ** np.arange(-160.0, 42.0, 2.0)
#: Random directions, each and its opposite, where more than one is level.
_DIRECTIONS = 16
#: Steps to where no force is on the others.
_STEPS = 6
#: Beside the place others move by less than this part of the distance.
_BESIDE = 0.5
#: Roundings of a slope, and how many times that it must be to be seen.
_SEEN = 4.0


class Energy(NamedTuple):
    """An energy as its derivatives.

    Attributes
    ----------
    slopes : callable
        First derivatives (S, n) and second ones (S, n, n) at places (S, n).
    sizes : callable
        What the first are the sums of (S, n); 0 may stand for a single term.
    """

    slopes: Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
    sizes: Callable[[NDArray[np.float64]], NDArray[np.float64]]


class Curvatures:
    """Eigenvalues of a symmetric matrix whose rows and columns are divided by the roots of its diagonal.

    Attributes
    ----------
    values : ndarray, shape (n,)
        Those of level directions are 0.
    vectors : ndarray, shape (n, n)
        Columns, in the coordinates of the matrix.
    """

    def __init__(self, values: NDArray[np.float64], vectors: NDArray[np.float64], sizes: NDArray[np.float64]) -> None:
        self.values, self.vectors, self.sizes = values, vectors, sizes


def curvatures(matrix: NDArray[np.float64], rounding: NDArray[np.float64]) -> Curvatures | None:
    """Of a matrix whose entries are known to a rounding; nothing if it is not symmetric."""
    sizes = np.sqrt(np.abs(np.diag(matrix)))
    rows = np.abs(matrix).max(axis=1)
    # Nothing on the diagonal: as large as makes what is beside it 1.
    known = np.where(sizes > 0.0, sizes, 1.0)
    beside = (np.abs(matrix) / known).max(axis=1)
    # Of a row that is not known at all what it may be off by is little beside the others.
    unknown = (np.where(sizes > 0.0, rounding / known, np.sqrt(rounding))).max(axis=1, initial=0.0)
    sizes = np.where(sizes > 0.0, sizes, np.where(rows > 0.0, beside, np.fmax(1.0, _UNKNOWN * unknown)))
    scaled = matrix / sizes / sizes[:, None]
    if np.abs(scaled - scaled.T).max() > _SYMMETRIC * max(1.0, np.abs(scaled).max()):
        return None
    values, vectors = np.linalg.eigh((scaled + scaled.T) / 2.0)
    off = np.abs(rounding / sizes / sizes[:, None]).sum(axis=1).max()
    off += _ROUNDINGS * len(matrix) * _EPSILON * np.abs(values).max()
    return Curvatures(np.where(np.abs(values) > off, values, 0.0), vectors / sizes[:, None], sizes)


def rises(
    energy: Energy,
    place: NDArray[np.float64],
    about: Curvatures,
    rounding: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Whether an energy rises (1), falls (−1) or stays (0) along each of many level directions.

    `rounding` is by how much second derivatives at the place may be off.
    """
    level = about.values == 0.0
    along, others = about.vectors[:, level], about.vectors[:, ~level]
    dimension = along.shape[1]
    directions = np.eye(dimension)
    if dimension > 1:
        random = np.random.default_rng(20261127).normal(size=(_DIRECTIONS * dimension, dimension))
        directions = np.concatenate([directions, random / np.linalg.norm(random, axis=1)[:, None]])
    rays = np.concatenate([directions, -directions]) @ along.T
    # Places in the order of rays, then distances.
    ahead = (_DISTANCES[None, :, None] * rays[:, None, :]).reshape(-1, len(place))
    bent = energy.slopes(place[None])[1]
    back = np.zeros((len(place), len(place)))

    def eased(places: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far from places the others go until no force is on them."""
        aside = np.zeros_like(places)
        for _ in range(_STEPS if back.any() else 0):
            aside = aside - energy.slopes(places + aside)[0] @ back.T
        return aside

    with np.errstate(all="ignore"):
        if others.shape[1]:
            back = others @ np.linalg.inv(others.T @ np.where(np.isfinite(bent[0]), bent[0], 0.0) @ others) @ others.T
        # The place itself may be beside the ground of a valley by what it is known to.
        own = eased(place[None])[0]
        place = np.where(np.isfinite(own).all(), place + own, place)
        at_rest, _ = energy.slopes(place[None])
        aside = eased(place + ahead)
        there = place + ahead + aside
        found, bent = energy.slopes(there)
        bent = np.where(np.isfinite(bent), np.abs(bent), 0.0)
        made_of = np.einsum("sij,sj->si", bent, np.abs(there)) + energy.sizes(there) + np.abs(found)
        unknown = _ROUNDINGS * _EPSILON * made_of + np.abs(at_rest) + np.abs(ahead + aside) @ rounding.T
        directed = np.repeat(rays, len(_DISTANCES), axis=0)
        rise = (found * directed).sum(axis=1)
        seen = np.abs(rise) > _SEEN * (unknown * np.abs(directed)).sum(axis=1)
        # What rounding of slopes makes others go is nothing.
        noise = _ROUNDINGS * _EPSILON * (made_of @ np.abs(back).T)
        far = (np.abs(aside) * about.sizes - noise * about.sizes).sum(axis=1) > _BESIDE * (
            np.abs(ahead * about.sizes).sum(axis=1)
        )
        beside = np.isfinite(rise) & ~far
    shape = (len(rays), len(_DISTANCES))
    return _nearest(np.where(seen, np.sign(rise), 0.0).reshape(shape), beside.reshape(shape))


def _nearest(signs: NDArray[np.float64], beside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Give the sign of each row that is seen first, twice in a row, as long as all before is beside the place."""
    near = np.logical_and.accumulate(beside, axis=1)
    twice = near[:, 1:] & (signs[:, :-1] == signs[:, 1:]) & (signs[:, 1:] != 0.0)
    first = twice.argmax(axis=1)
    rows = np.arange(len(signs))
    return np.where(twice.any(axis=1), signs[rows, first], 0.0)


def __dir__() -> list[str]:
    return list(__all__)
