"""What impact parameters beyond the disc of a beam hide from it: the values that come from there, too.

The one idea: far out ψ ends at 0 and on the way there it takes every value up to its greatest, so one angle tells what
comes from beyond. It is looked for on a grid, of which every turn of ψ is divided until it is known. What of a quantity
a disc knows that ends at an angle is told by V = k/r of the same bodies, of which the angle at the edge is that one.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from visviva import _core
from visviva.potentials import Coulomb
from visviva.scattering._beam import Spectrum, described
from visviva.scattering._deflection import deflection_angle

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.scattering._beam import Beam

    _Reach: TypeAlias = tuple[NDArray[np.float64], tuple[float, float]]

__all__ = ["beyond", "less_what_is_beyond"]

#: Impact parameters of each factor of two beyond the disc, and how many such factors there are at most.
_IN_AN_OCTAVE, _OCTAVES = 96, 40
#: After an octave in which nothing is turned by more than this part of the greatest angle none is expected to be.
_NOTHING = 1e-6
#: Parts into which what is beside a turn of ψ is divided, and how often: to 1e-9 of the impact parameter.
_PARTS, _DIVISIONS = 8, 12
#: Of a rounded greatest angle, which is none of the edge.
_ROUNDED = 1e-9
#: Angles are known to so much, of what was added up to them.
_TOLERANCE = 1e-9
#: Energies of a spread that are looked at.
_ENERGIES = 9
#: A Gaussian ends at so many standard deviations.
_CUT = 6.0


def less_what_is_beyond(
    beam: Beam, axes: list[tuple[str, NDArray[np.float64]]], told: list[_Reach], hidden: dict[float, float]
) -> list[_Reach]:
    """What is reached of bins of quantities, and which values are covered, without what comes from beyond, too.

    `hidden` is that of `beyond`; `told` what the core says, of which nothing is added to.
    """
    for energy, angle in hidden.items():
        least = min(_energies(beam, energy)) * beam.masses[1] / (beam.masses[0] + beam.masses[1])
        like = replace(
            beam,
            potential=Coulomb(2.0 * least * beam.b_max * float(np.tan(0.5 * angle))),
            beam_energy=energy,
            importance=None,
        )
        asked: list[Any] = [[axis] for axis in axes]
        columns = _core.monte_carlo(
            beam=described(like), n_events=1, seed=0, first_event=0, tallies=asked, threads=1, progress=None
        )[4]
        for at, column in enumerate(columns):
            if column[4] is not None:
                told[at] = _both(told[at], column[4])
    return told


def _both(one: _Reach, other: _Reach) -> _Reach:
    """Of bins what two know: those that only one does are not averaged over a part."""
    (parts, (low, high)), (others, (from_, to)) = one, other
    low, high = max(low, from_), min(high, to)
    return np.where(others < 1.0, 0.0, parts), ((low, high) if low < high else (0.0, 0.0))


def beyond(beam: Beam) -> dict[float, float]:
    """The greatest |ψ|, at most π, of impact parameters beyond the disc, by the beam's energies.

    Energies at which it is that of the edge of the disc, as where ψ falls with the impact parameter, are left out.
    """
    if not beam.tables and beam.energy_spread is None:
        return {}  # of a Coulomb center
    lines = beam.beam_energy.energy if isinstance(beam.beam_energy, Spectrum) else (beam.beam_energy,)
    share = beam.masses[1] / (beam.masses[0] + beam.masses[1])
    found = {}
    for line in lines:
        greatest = max(_greatest(beam, energy * share) for energy in _energies(beam, line))
        if greatest > 0.0:
            found[float(line)] = greatest
    return found


def _energies(beam: Beam, energy: float) -> NDArray[np.float64]:
    """Energies of the projectiles about one, the least and the greatest among them."""
    spread = beam.energy_spread
    if spread is None:
        return np.array([energy])
    reach = (_CUT if spread.shape == "gaussian" else 1.0) * spread.width
    return np.linspace(energy - reach, energy + reach, _ENERGIES)


def _greatest(beam: Beam, energy: float) -> float:
    """The greatest |ψ| beyond the disc at an energy of relative motion; 0 where it is that of the edge."""

    def turned(b: NDArray[np.float64]) -> NDArray[np.float64]:
        psi = deflection_angle(beam.potential, energy=energy, impact_parameter=b, tolerance=_TOLERANCE)
        # What is captured is beside what circles as often as one likes.
        return np.where(np.isnan(psi), -np.inf, psi)

    grid = np.exp2(np.arange(_IN_AN_OCTAVE + 1) / _IN_AN_OCTAVE)
    b, psi = np.array([beam.b_max]), turned(np.array([beam.b_max]))
    edge = largest = abs(float(psi[0]))
    for _ in range(_OCTAVES):
        farther = b[-1] * grid[1:]
        if edge >= np.pi or not np.isfinite(farther).all():
            break
        b, psi = np.concatenate([b, farther]), np.concatenate([psi, turned(farther)])
        here = float(np.abs(psi[-_IN_AN_OCTAVE:]).max())
        largest = max(largest, here)
        if here <= _NOTHING * largest or largest >= np.pi:
            break
    largest = max(largest, _at_turns(turned, b, psi, largest))
    return min(largest * (1.0 + _ROUNDED), np.pi) if largest > edge else 0.0


def _at_turns(turned: Any, b: NDArray[np.float64], psi: NDArray[np.float64], largest: float) -> float:
    """The greatest |ψ| at turns of it between impact parameters (N,) at which it is known."""
    with np.errstate(invalid="ignore"):
        rises = np.sign(np.diff(psi))
    at = 1 + np.flatnonzero((rises[1:] != rises[:-1]) & (np.abs(psi[1:-1]) > _NOTHING * largest))
    rows, values, signs = b[at[:, None] + [-1, 0, 1]], psi[at], rises[at - 1]
    for _ in range(_DIVISIONS):
        if not len(rows) or largest >= np.pi:
            break
        parts = np.arange(1, _PARTS) / _PARTS
        left = rows[:, :1] + parts * (rows[:, 1:2] - rows[:, :1])
        right = rows[:, 1:2] + parts * (rows[:, 2:] - rows[:, 1:2])
        all_b = np.concatenate([rows[:, :1], left, rows[:, 1:2], right, rows[:, 2:]], axis=1)
        inner = turned(np.concatenate([left, right], axis=1).ravel()).reshape(len(rows), -1)
        all_psi = np.concatenate([inner[:, : _PARTS - 1], values[:, None], inner[:, _PARTS - 1 :]], axis=1)
        highest = 1 + np.argmax(signs[:, None] * all_psi, axis=1)
        values = np.take_along_axis(all_psi, highest[:, None] - 1, axis=1)[:, 0]
        rows = np.take_along_axis(all_b, highest[:, None] + [-1, 0, 1], axis=1)
        largest = max(largest, float(np.abs(values).max()))
    return largest


def __dir__() -> list[str]:
    return list(__all__)
