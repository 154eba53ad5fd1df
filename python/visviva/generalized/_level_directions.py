"""Whether what small motions leave level stays, as the energy at rest tells: a minimum of any order does.

The one idea: where no motion has less energy than rest, the energy decides whatever turns motions aside (J.-L. Lagrange
& P. G. L. Dirichlet). Where other directions are held by gyroscopic terms alone, those that are level are slow beside
them, and move with the mass that is left when the others follow where no force is on them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._higher_orders import curvatures, rises
from visviva.generalized._multiple_zeros import round_off
from visviva.generalized._stability import has_energy_of_rest, is_stable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._higher_orders import Curvatures, Energy

__all__ = ["falls_farther_off", "stays"]

#: Directions between those in which an energy is level, how far along them it is looked at, in sizes of places, and
#: Newton's steps from there to the ground of a valley.
_DIRECTIONS = 8
_FAR_ALONG = (0.01, -0.01, 0.1, -0.1)
_STEPS_TO_THE_GROUND = 8
#: There slopes along it are so many times those across.
_ON_THE_GROUND = 10.0

_Matrices = tuple["NDArray[np.float64]", "NDArray[np.float64]", "NDArray[np.float64]", "NDArray[np.float64]"]


def stays(
    matrices: _Matrices,
    energy: Energy,
    place: NDArray[np.float64],
    size: NDArray[np.float64],
    *,
    hidden: bool = False,
) -> bool | None:
    """Whether motions stay near a place, by M, C, K and the rounding of K, and the energy at rest where K is level.

    It is looked at as far as places of a size (n) are. A drift along places that are all equilibria does not count.
    Where the energy falls, and nothing shows that gyroscopic terms hold, they are not taken to. Nothing is told where K
    may be other than level in what rounding has `hidden`, and the energy is not seen to fall.
    """
    if not is_stable(*matrices):
        return False
    mass, damping, stiffness, rounding = matrices
    about = curvatures(np.where(np.abs(stiffness) > rounding, stiffness, 0.0), rounding)
    if about is None or about.values.all():
        return True
    held = has_energy_of_rest(mass, damping) and about.values.min() == 0.0
    sign = 1.0 if held else _sign_of_slow_masses(mass, damping, stiffness, about)
    beside = rises(energy, place, about, rounding)
    if beside.any() if sign == 0.0 else (sign * beside < 0.0).any():
        return False
    # Nothing that is seen is not yet nothing that is there.
    if sign != 0.0 and 0.0 in beside and falls_farther_off(energy, place, about, size, sign):
        return False
    return None if hidden else True


def _sign_of_slow_masses(
    mass: NDArray[np.float64], damping: NDArray[np.float64], stiffness: NDArray[np.float64], about: Curvatures
) -> float:
    """Give the sign of the masses of level directions beside the others, 0 if they have different ones or none."""
    level = about.values == 0.0
    along, others = about.vectors[:, level], about.vectors[:, ~level]
    slow = along.T @ mass @ along
    if others.shape[1]:
        aside = np.linalg.solve(others.T @ stiffness @ others, others.T @ damping @ along)
        slow = slow - along.T @ damping @ others @ aside
    found = curvatures(slow, np.zeros_like(slow))
    signs = set() if found is None else set(np.sign(found.values).tolist())
    return signs.pop() if len(signs) == 1 else 0.0


def falls_farther_off(
    energy: Energy, place: NDArray[np.float64], about: Curvatures, size: NDArray[np.float64], upwards: float
) -> bool:
    """Whether an energy falls along the ground of a valley, some way in a level direction; if upwards is −1, rises."""
    level = about.values == 0.0
    along, others = about.vectors[:, level], about.vectors[:, ~level]
    mixed = np.random.default_rng(0).normal(size=(along.shape[1], _DIRECTIONS))
    ways = along @ np.concatenate([np.eye(along.shape[1]), mixed], axis=1)
    ways = ways * (1.0 / np.abs(ways / size[:, None]).max(axis=0))
    ahead = np.concatenate([part * ways.T for part in _FAR_ALONG])
    places = place + ahead
    with np.errstate(all="ignore"):
        for _ in range(_STEPS_TO_THE_GROUND):
            slopes, second = energy.slopes(places)
            across = np.linalg.pinv(others.T @ np.where(np.isfinite(second), second, 0.0) @ others)
            places = places - np.einsum("ai,sij,bj,sb->sa", others, across, others, slopes)
        slopes, _ = energy.slopes(places)
        rise = upwards * (slopes * ahead).sum(axis=1)
        left = np.abs(slopes @ others).max(axis=1, initial=0.0) * np.abs(ahead @ about.vectors).max(axis=1)
        falls = (rise < -_ON_THE_GROUND * left) & ~round_off(energy, places, size).all(axis=1)
        return bool(falls.any())


def __dir__() -> list[str]:
    return list(__all__)
