"""Whether runs in equal steps have resolved anything, as far as an energy that is conserved tells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._accuracy import judge_energies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["warn_if_unresolved"]


def warn_if_unresolved(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    starts: NDArray[np.float64],
    lasts: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> None:
    """Warn of runs from states (B, 2n) to others at a time whose energies differ by much of what they are sums of."""
    if asked["dt"] is None or not system._structure["conserves_energy"]:
        return
    copies, n = len(starts), len(system.coordinates)
    ends = [_energies(system, starts, system.t0, values, n), _energies(system, *lasts, values, n)]
    energies, sizes = (np.stack(columns, axis=1) for columns in zip(*ends, strict=True))
    judge_energies(asked["dt"], energies, sizes, ensemble=copies > 1)


def _energies(
    system: GeneralizedSystem, states: NDArray[np.float64], t: float, values: NDArray[np.float64], n: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Energies (B,), and those of the kinetic and potential energies that they are sums of."""
    with np.errstate(all="ignore"):
        columns = system._model.columns(np.full(len(states), t), np.ascontiguousarray(states), values)
        # ½ p·v, of a quadratic kinetic energy.
        kinetic = 0.5 * np.abs((columns[:, :n] * states[:, n:]).sum(axis=1))
        return columns[:, n], kinetic + np.abs(columns[:, n] - kinetic)
