"""Where forces at rest lead no further along a valley, judged by what is known at each place and nowhere else.

The one idea: what forces are made of at other starts may be so much more that all along a valley these seem to be
round-off. Newton's steps by what is known at the place itself go on to where the valley ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._newton import steps_to_zeros
from visviva.generalized._searches import SAME

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["SMALL_STEPS", "ends_of_valleys"]

#: Newton's steps along a valley that is curved. Every other one leads back to its ground, however small it is, so that
#: several small ones tell that it ends.
_STEPS = 60
SMALL_STEPS = 4


def ends_of_valleys(
    forces: Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]],
    places: NDArray[np.float64],
    looked_at: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Places (R, n) to which Newton's steps lead from places (S, n), without those from which they lead nowhere.

    `forces` gives forces (S, n) and minus their derivatives (S, n, n), which are no numbers where there are none;
    `looked_at` how large coordinates (n) are, which is as far as one step leads.
    """
    there = []
    # At kinks nothing is known: what is there, or comes there from right beside, ends.
    small, ends, before = np.zeros(len(places), dtype=int), np.ones(len(places), dtype=bool), places
    for _ in range(_STEPS):
        if not len(places):
            break
        found, stiffness = forces(places)
        unknown = ~np.isfinite(found).all(axis=1)
        there.append(before[unknown & ends])
        places, small, found, stiffness = (each[~unknown] for each in (places, small, found, stiffness))
        step = steps_to_zeros(found, stiffness) / looked_at
        # Kinks, and what nothing changes, are where they are.
        step[np.isnan(step).any(axis=1)] = 0.0
        length = np.abs(step).max(axis=1)
        small = np.where(length <= SAME, small + 1, 0)
        stays = (small >= SMALL_STEPS) | (length == 0.0)
        there.append(places[stays])
        before, small, step, length = places[~stays], small[~stays], step[~stays], length[~stays]
        ends = small > 0
        places = before + step / np.fmax(length, 1.0)[:, None] * looked_at
    return np.concatenate([*there, places[:0]])


def __dir__() -> list[str]:
    return list(__all__)
