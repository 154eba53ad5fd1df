"""Where forces vanish to a higher order, and are but round-off long before.

The one idea: a zero of F of third order is a simple one of F″, which is found to all digits though F tells but a third
of them. Of several coordinates no such derivative is at hand: of places that forces cannot tell apart, one is given.
"""

from __future__ import annotations

from math import factorial
from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._calculus import Calculus
from visviva.generalized._higher_orders import Energy
from visviva.generalized._matrices import matrices, matrices_along

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._matrices import Sizes

__all__ = ["at_rest", "is_simple", "left_open", "open_about", "round_off", "settled", "told_apart", "units"]

_EPSILON = float(np.finfo(float).eps)
#: Roundings of what forces are the sums of.
_ROUNDINGS = 64.0
#: Derivatives of a force that are looked at.
_ORDERS = 8
#: At least so many, but no further ones of an expression that has grown larger than this.
_FEWEST = 4
_MOST_NODES = 400
#: Newton's steps on one of them, of which the first is shorter than this part of the places that are looked at.
_STEPS = 4
_NEAR = 1e-2
#: Distances within which forces may be round-off, as parts of the places that are looked at.
_WITHIN = 2.0 ** -np.arange(48.0, 6.0, -1.0)
#: Of these every so many are looked at along a curve, and Newton's steps that lead to it.
_EVERY = 3
_STEPS_TO_THE_GROUND = 3
#: Stiffnesses that are this part of those so far beside them may be of a higher order; singular values, of others.
_SOFT = 1e-4
_BESIDE = 1e-3
_LEVEL = 1e-6
#: One soft direction among others so many times as stiff, and what part its stiffness may change by along it.
_MUCH_STIFFER = 1e6
_STEADY = 0.1
#: Places that are told apart less than this many times what forces leave of them are one.
_ONE = 4.0


def settled(
    system: Lagrangian,
    told: NDArray[np.float64],
    nearly: NDArray[np.float64],
    size: NDArray[np.float64],
    sizes: Sizes,
) -> NDArray[np.float64]:
    """Places as well as forces tell them: those that steps have told (T, n), and which of (S, n) are equilibria."""
    size = np.where(size > 0.0, size, 1.0)
    energy = at_rest(system, sizes)
    if len(nearly):
        nearly = nearly[round_off(energy, nearly, size).all(axis=1)]
    if told.shape[1] == 1:
        soft = _soft(system, told, size)
        places = np.concatenate([told[soft], nearly])
        if len(places):
            better = _by_derivatives(system, places, size, sizes)
            places = np.where(round_off(energy, better, size), better, places)
        return np.concatenate([told[~soft], places])
    found = told_apart(energy, [*told, *nearly], size, lambda place: units(system, place))
    return np.array(found).reshape(-1, told.shape[1])


def at_rest(system: Lagrangian, sizes: Sizes) -> Energy:
    """Give the potential of the forces at rest."""

    def slopes(places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        forces, stiffness = matrices_along(system, places)
        return -forces, stiffness

    return Energy(slopes, sizes.forces)


def units(system: Lagrangian, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give units of coordinates in which masses are alike."""
    roots = np.sqrt(np.abs(np.diag(matrices(system, place).mass)))
    # At a pole an angle has no mass.
    known = (roots >= np.finfo(float).tiny) & np.isfinite(roots)
    unit: NDArray[np.float64] = 1.0 / np.where(known, roots, 1.0)
    return unit


def _soft(system: Lagrangian, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether places (S, 1) are so much softer than what is beside them that the force may vanish to a higher order."""
    stiffness, left, right = (
        np.abs(matrices_along(system, places + part * size)[1]).reshape(-1) for part in (0.0, _BESIDE, -_BESIDE)
    )
    soft: NDArray[np.bool_] = stiffness <= _SOFT * np.fmax(left, right)
    return soft


def round_off(energy: Energy, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether slopes at places are nothing but round-off (S, n), that of places beside their sizes, too."""
    first, rounding = _slopes_and_rounding(energy, places, size)
    small: NDArray[np.bool_] = np.abs(first) <= rounding
    return small


def _slopes_and_rounding(
    energy: Energy, places: NDArray[np.float64], size: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    first, second = energy.slopes(places)
    made_of = np.einsum("sij,sj->si", np.abs(second), np.fmax(np.abs(places), size)) + energy.sizes(places)
    return first, _ROUNDINGS * _EPSILON * made_of


def left_open(
    energy: Energy,
    place: NDArray[np.float64],
    size: NDArray[np.float64],
    unit: NDArray[np.float64],
    *,
    curved: bool = False,
) -> NDArray[np.float64] | None:
    """How far a place (n) may be moved along a nearly level direction until slopes are seen; nothing without one.

    ``curved``, along the ground of a valley, too, if they are seen on it farther off: else it is one of equilibria.
    `unit` has units of coordinates in which second derivatives are compared.
    """
    second = energy.slopes(place[None])[1][0]
    scaled = second * unit * unit[:, None]
    if not np.isfinite(scaled).all():
        return None
    values, vectors = np.linalg.svd(scaled)[1:]
    if values[-1] > _LEVEL * values[0]:
        return None
    softest = vectors[-1] * unit
    softest *= size[np.abs(softest).argmax()] / np.abs(softest).max()
    unseen = np.ones(len(_WITHIN), dtype=bool)
    for sign in (1.0, -1.0):
        unseen &= round_off(energy, place + sign * _WITHIN[:, None] * softest, size).all(axis=1)
    # As far as all distances below are unseen, too: places are not joined over a hill.
    reached = _WITHIN[np.logical_and.accumulate(unseen)]
    left: NDArray[np.float64] = reached.max(initial=0.0) * softest
    if not curved or len(reached) == len(_WITHIN):
        return left
    along = _along_the_ground(energy, place, size, (softest, (vectors[:-1] * unit).T))
    if values[-1] > _ROUNDINGS * _EPSILON * values[0]:
        # It is no curve: forces of so much are seen so far away, whatever the way there is.
        direction = np.abs(vectors[-1] * unit)
        _, rounding = _slopes_and_rounding(energy, place[None], size)
        told = direction * (direction @ rounding[0]) / values[-1]
        along = np.fmax(along, np.fmin(told, _WITHIN[-1] * size) / _ONE)
    return np.where(along > np.abs(left), np.copysign(along, softest), left)


def open_about(
    energy: Energy, place: NDArray[np.float64], size: NDArray[np.float64], unit: NDArray[np.float64], coordinates: int
) -> NDArray[np.float64]:
    """How far each of the first coordinates of an equilibrium may be from it until slopes are seen, as `left_open`."""
    found = left_open(energy, place, size, unit, curved=True)
    return np.zeros(coordinates) if found is None else np.abs(found[:coordinates])


def _along_the_ground(
    energy: Energy,
    place: NDArray[np.float64],
    size: NDArray[np.float64],
    directions: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """How far each coordinate (n) goes on the ground of a valley until slopes are seen; 0 if they never are.

    From places along a direction (n) others (n, n − 1) lead to the ground.
    """
    softest, others = directions
    parts = np.append(_WITHIN[::_EVERY], _WITHIN[-1])
    places = place + np.concatenate([parts, -parts])[:, None] * softest
    with np.errstate(all="ignore"):
        for _ in range(_STEPS_TO_THE_GROUND):
            slopes, second = energy.slopes(places)
            across = others.T @ np.where(np.isfinite(second), second, 0.0) @ others
            places = places - np.einsum("ai,sij,bj,sb->sa", others, np.linalg.pinv(across), others, slopes)
        unseen = round_off(energy, places, size).all(axis=1).reshape(2, -1).all(axis=0)
        reached = int(np.logical_and.accumulate(unseen).sum())
        moved = np.abs(places - place).reshape(2, len(parts), -1).max(axis=0)
    ends = 0 < reached < len(parts)
    return moved[reached - 1] if ends else np.zeros(len(place))


def is_simple(energy: Energy, places: NDArray[np.float64], units: NDArray[np.float64]) -> bool:
    """Whether a soft direction is as stiff at all places (S, n): it is not level, but slow beside others."""
    scaled = energy.slopes(places)[1] * units * units[:, None]
    if not np.isfinite(scaled).all():
        return False
    values = np.linalg.svd(scaled, compute_uv=False)
    soft = values[:, -1]
    alone = bool((values[:, -2] * _MUCH_STIFFER > values[:, 0]).all())
    return alone and bool((np.abs(soft - soft[0]) <= _STEADY * soft[0]).all() and soft[0] > 0.0)


def told_apart(
    energy: Energy,
    places: Iterable[NDArray[np.float64]],
    size: NDArray[np.float64],
    unit: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> list[NDArray[np.float64]]:
    """Give one of places that slopes cannot tell apart, with zeros where these may be."""
    found: list[NDArray[np.float64]] = []
    within: list[NDArray[np.float64]] = []
    least = _ROUNDINGS * _EPSILON * size
    for place in places:
        apart = np.abs(np.array(found).reshape(-1, len(place)) - place)
        if (apart <= np.array(within).reshape(apart.shape)).all(axis=1).any():
            continue
        left = left_open(energy, place, size, unit(place), curved=True)
        if left is None:
            found.append(place)
            within.append(least)
            continue
        left = least + _ONE * np.abs(left)
        near = (apart <= left).all(axis=1)
        snapped = np.where(np.abs(place) <= left, 0.0, place)
        zeros = (snapped != place).any() and not any((each == snapped).all() for each in found)
        if zeros and round_off(energy, snapped[None], size).all():
            # Told for those near it, at which Newton's method may have come to an end beside it.
            kept = np.flatnonzero(~near)
            found, within = [*(found[k] for k in kept), snapped], [*(within[k] for k in kept), left]
        elif not near.any():
            found.append(place)
            within.append(left)
    return found


def _by_derivatives(
    system: Lagrangian, places: NDArray[np.float64], size: NDArray[np.float64], sizes: Sizes
) -> NDArray[np.float64]:
    """Places (S, 1) at the zero of that derivative of the force which tells it best."""
    c = Calculus(system)
    (terms,) = sizes.expressions(c)
    force = terms[0]
    for term in terms[1:]:
        force = force + term
    chain = [force]
    while len(chain) <= _ORDERS and (len(chain) < _FEWEST or len(c._nodes.all) <= _MOST_NODES):
        chain.append(c.with_derivatives([chain[-1]])[0][1])
    orders = len(chain) - 1

    def values(of: NDArray[np.float64]) -> NDArray[np.float64]:
        states = np.concatenate([of, np.zeros_like(of)], axis=1)
        return c.values(chain, np.full(len(of), system.t0), states, system._values)

    with np.errstate(all="ignore"):
        found = values(places)
        # What each is the sum of, if it is one of powers.
        made_of = [
            sum(np.abs(found[:, j + k] * places[:, 0] ** k) / factorial(k) for k in range(orders + 1 - j))
            for j in range(orders)
        ]
        left = np.abs(np.stack(made_of, axis=1) / found[:, 1:]) + np.abs(places)
        steps = np.abs(found[:, :-1] / found[:, 1:])
        left = np.where(np.isfinite(left) & (steps <= _NEAR * size), left, np.inf)
        # The highest of those that tell as much: a power has all of its digits in each of them.
        good = np.isfinite(left) & (left <= _ONE * left.min(axis=1, keepdims=True))
        best = np.where(good, np.arange(orders), 0).max(axis=1)
        for _ in range(_STEPS):
            rows = np.arange(len(places))
            step = found[rows, best] / found[rows, best + 1]
            places = places - np.where(np.isfinite(step), step, 0.0)[:, None]
            found = values(places)
    return places


def __dir__() -> list[str]:
    return list(__all__)
