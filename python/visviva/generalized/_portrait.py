"""Phase portraits: lines of constant energy, evaluated on a grid in one call of the core."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["phase_portrait"]

#: Lines beside separatrices.
_LINES = 24
#: Places and momenta from which equilibria are looked for.
_STARTS = 25


def phase_portrait(
    system: Lagrangian | Hamiltonian,
    position: tuple[float, float],
    momentum: tuple[float, float],
    points: int,
    ax: Axes | None,
) -> Axes:
    """Draw the portrait of a system of one degree of freedom."""
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.plot import axes_or_new

    if len(system.coordinates) != 1:
        names = list(system.coordinates)
        raise InvalidInput(
            "position", f"a portrait is that of one coordinate; there are {names}: see poincare, routhian"
        )
    if not system._structure["conserves_energy"]:
        raise InvalidInput(
            "position", "a portrait needs energy to be conserved: no time, no dissipation, no further forces"
        )
    ranges = [float_array(name, value, (2,)) for name, value in (("position", position), ("momentum", momentum))]
    for name, value in zip(("position", "momentum"), ranges, strict=True):
        if not value[0] < value[1]:
            raise InvalidInput(name, f"expected the smaller end first, got {tuple(value.tolist())}")
    other = system if isinstance(system, Hamiltonian) else system.hamiltonian()
    q, p = (np.linspace(value[0], value[1], points) for value in ranges)
    states = np.stack(np.meshgrid(q, p), axis=-1).reshape(-1, 2)
    model, values = other._model, other._values[None, :]
    energy = model.columns(np.full(len(states), system.t0), states, values)[:, 1].reshape(points, points)
    ax = axes_or_new(ax)
    finite = energy[np.isfinite(energy)]
    if finite.size:
        # As many points between two lines: they are dense where motion is slow.
        ax.contour(q, p, energy, levels=np.unique(np.quantile(finite, np.linspace(0.0, 1.0, _LINES))), linewidths=0.7)
    sides = [np.linspace(float(each[0]), float(each[1]), _STARTS) for each in ranges]
    for rest in other.equilibria(np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)):
        if rest.stable:
            place = (float(rest.position[0]), float(rest.momentum[0]))
            if ranges[0][0] <= place[0] <= ranges[0][1] and ranges[1][0] <= place[1] <= ranges[1][1]:
                ax.plot(*place, "o", color="black", markersize=4)
            continue
        # Lines through one that is outside may come by.
        through = other.at(position=rest.position, momentum=rest.momentum).energy
        if finite.size and finite.min() < through < finite.max():
            ax.contour(q, p, energy, levels=[through], colors="black", linewidths=1.4)
    ax.set_xlabel(system.coordinates[0])
    ax.set_ylabel(f"momentum of {system.coordinates[0]}")
    return ax
