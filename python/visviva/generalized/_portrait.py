"""Pictures of systems of one degree of freedom: lines of constant energy, and the potential in which they move.

The one idea: each is the energy on a grid, of places and momenta or of places at rest, in one call of the core.
Source: H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 3.3; L. D. Landau & E. M. Lifshitz,
*Mechanics*, 3rd ed., § 11.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["plot_effective_potential", "plot_phase_portrait"]

#: Lines beside separatrices.
_LINES = 24
#: Places and momenta from which equilibria are looked for.
_STARTS = 25
#: What is higher above the least than so many times what three quarters of the potential are is a wall.
_WALL = 6.0


def plot_phase_portrait(
    system: Lagrangian | Hamiltonian,
    position: tuple[float, float],
    momentum: tuple[float, float],
    points: int,
    ax: Axes | None,
) -> Axes:
    """As `GeneralizedSystem.plot_phase_portrait`."""
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.plot import axes_or_new

    _check_one_coordinate(system, "a portrait", "see poincare, routhian")
    ranges = [_ends("position", position), _ends("momentum", momentum)]
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
            # Of one color, lines of negative energies would be dashed by themselves.
            ax.contour(q, p, energy, levels=[through], colors="black", linewidths=1.4, linestyles="solid")
    ax.set_xlabel(system.coordinates[0])
    ax.set_ylabel(f"momentum of {system.coordinates[0]}")
    return ax


def plot_effective_potential(
    system: Lagrangian | Hamiltonian, position: tuple[float, float], points: int, ax: Axes | None
) -> Axes:
    """As `GeneralizedSystem.plot_effective_potential`."""
    from visviva._style import VERMILION, legend_within
    from visviva.generalized._lagrangian import Lagrangian
    from visviva.plot import axes_or_new

    _check_one_coordinate(system, "an effective potential", "routhian() takes away cyclic ones of a Lagrangian")
    low, high = _ends("position", position)
    try:
        other = system if isinstance(system, Lagrangian) else system.lagrangian()
    except InvalidInput as error:
        raise InvalidInput(
            "position", "expected a Hamiltonian that is quadratic in the momentum; plot_phase_portrait draws any"
        ) from error
    q = np.linspace(low, high, points)
    at_rest = np.column_stack([q, np.zeros(points)])
    potential = other._model.columns(np.full(points, other.t0), at_rest, other._values[None, :])[:, 1]
    known = potential[np.isfinite(potential)]
    if not known.size:
        raise InvalidInput(
            "position", f"expected places where there is a potential, and none is a number in {position}"
        )
    energy = float(system.energy)
    ax = axes_or_new(ax)
    ax.plot(q, np.where(np.isfinite(potential), potential, np.nan), linewidth=1.2, label="potential")
    ax.axhline(energy, linewidth=0.8, linestyle="-", color=VERMILION, label="energy of the start")
    turns = _crossings(q, potential - energy)
    ax.plot(turns, np.full(len(turns), energy), "o", markersize=4, color=VERMILION)
    least, most = min(float(known.min()), energy), max(float(np.quantile(known, 0.75)), energy)
    if float(known.max()) - least > _WALL * (most - least) > 0.0:
        # Of walls, which have no top, as much as lets one see what is between them.
        ax.set_ylim(least - 0.1 * (most - least), most + 0.5 * (most - least))
    ax.set(xlabel=system.coordinates[0], ylabel="energy at rest", title="effective potential")
    legend_within(ax)
    return ax


def _check_one_coordinate(system: Lagrangian | Hamiltonian, what: str, cure: str) -> None:
    if len(system.coordinates) != 1:
        names = list(system.coordinates)
        raise InvalidInput("position", f"{what} is that of one coordinate; there are {names}: {cure}")
    if not system._structure["conserves_energy"]:
        raise InvalidInput(
            "position", f"{what} needs energy to be conserved: no time, no dissipation, no further forces"
        )


def _ends(name: str, given: tuple[float, float]) -> NDArray[np.float64]:
    ends = float_array(name, given, (2,))
    if not ends[0] < ends[1]:
        raise InvalidInput(name, f"expected the smaller end first, got {tuple(ends.tolist())}")
    return ends


def _crossings(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where a line through points passes zero."""
    first = np.flatnonzero((y[:-1] < 0.0) != (y[1:] < 0.0))
    with np.errstate(invalid="ignore"):
        places = x[first] - y[first] * (x[first + 1] - x[first]) / (y[first + 1] - y[first])
    found: NDArray[np.float64] = places[np.isfinite(places)]
    return found
