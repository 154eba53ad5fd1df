"""What a scattering Monte Carlo gives: integer histograms of a beam's events, which add up without a gap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from visviva import _core
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from visviva.potentials import Coulomb

__all__ = ["Beam", "CrossSection", "MonteCarlo", "Tally"]

_ANGLES = ("cm_angle", "lab_angle", "recoil_angle")


class CrossSection(NamedTuple):
    """A cross section by bin and its standard error; NaN in a bin that the beam does not reach."""

    value: NDArray[np.float64]
    """Area per steradian for angles, else area per unit of the quantity."""
    error: NDArray[np.float64]
    """One standard deviation of the count, as an area likewise."""


@known_keywords
@dataclass(frozen=True)
class Beam:
    """A parallel beam on a disc around one centre: what results must have in common to be added.

    Attributes
    ----------
    potential : Coulomb
        V = k/r.
    beam_energy : float
        Of the projectile in the laboratory.
    masses : tuple of float
        Projectile and target.
    b_max : float
        Radius of the disc of impact parameters.
    smallest_angle : float
        The deflection at the edge of the disc, in the centre-of-mass frame: no event is scattered by less.
    """

    potential: Coulomb
    beam_energy: float
    masses: tuple[float, float]
    b_max: float
    smallest_angle: float


class _OfEvents:
    """What a result and each of its tallies know: the beam and which of its events."""

    beam: Beam
    events: tuple[tuple[int, int, int], ...]

    @property
    def n_events(self) -> int:
        """Events in all."""
        return sum(end - first for _, first, end in self.events)

    @property
    def b_max(self) -> float:
        """Radius of the disc of impact parameters."""
        return self.beam.b_max

    def _merged_events(self, other: _OfEvents) -> tuple[tuple[int, int, int], ...]:
        """Refuse another beam and events that are in both."""
        for name in ("potential", "beam_energy", "masses", "b_max"):
            mine, theirs = getattr(self.beam, name), getattr(other.beam, name)
            if mine != theirs:
                raise InvalidInput("other", f"expected the same {name}, {mine!r}, got {theirs!r}")
        return _merged((*self.events, *other.events))


@known_keywords
@dataclass(frozen=True, eq=False)
class Tally(_OfEvents):  # noqa: PLW1641 — it holds arrays, which have no hash
    """A histogram of one quantity. Bin i holds ``edges[i] ≤ x < edges[i+1]``; the last one also its end.

    Tallies of the same quantity, beam and edges add up if no event is in both, and are equal if all of it is.

    Attributes
    ----------
    name : str
        The quantity.
    edges : ndarray, shape (B + 1,)
        Strictly increasing.
    counts : ndarray of uint64, shape (B,)
        Events per bin.
    underflow, overflow : int
        Events below the first and above the last edge.
    reachable : ndarray, shape (B,)
        For each bin the part of it (of its solid angle for angles, else of its width) whose impact parameters all
        lie on the disc: 1 for a bin that is reached whole, 0 for one that is not, between for one that the edge of
        the disc cuts.
    covered : tuple of float
        The values (low, high) whose impact parameters all lie on the disc.
    beam : Beam
        What was scattered by what.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    n_events : int
        Events in all: the sum of ``counts``, ``underflow`` and ``overflow``.
    b_max : float
        Radius of the disc of impact parameters.
    """

    name: str
    edges: NDArray[np.float64]
    counts: NDArray[np.uint64]
    underflow: int
    overflow: int
    reachable: NDArray[np.float64]
    covered: tuple[float, float]
    beam: Beam
    events: tuple[tuple[int, int, int], ...]

    def __post_init__(self) -> None:
        for array in (self.edges, self.counts, self.reachable):
            array.setflags(write=False)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # a pickle does not keep that arrays are read-only

    def values(self) -> NDArray[np.float64]:
        """Counts as float64, exact up to 2⁵³."""
        return self.counts.astype(np.float64)

    def variances(self) -> NDArray[np.float64]:
        """Variances of the counts, n·(1 − n/N), binomial: the number N of events is fixed."""
        counts = self.values()
        return counts * (1.0 - counts / self.n_events)

    def cross_section(self) -> CrossSection:
        """Differential cross section averaged over each bin, as far as the bin is reachable.

        The disc ends at ``b_max``, so what lies beyond is missing near the forward direction. A bin that is cut there
        is averaged over its reachable part, which `reachable` tells; a bin that is not reached is NaN. Of a heavy
        projectile (m₁ > m₂) two impact parameters lead to one laboratory angle: below ``covered[0]`` one of them is
        beyond the disc, and bins that begin there are NaN, the cut one too.

        Returns
        -------
        CrossSection
            (value, error): counts / n_events · π b_max², per steradian for angles, else per unit of the quantity.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> result = vv.scattering.monte_carlo(
        ...     vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 1e9), b_max=2.0, n_events=100_000, seed=1,
        ...     tally={"cm_angle": np.radians([0, 20, 90, 180])})
        >>> tally = result["cm_angle"]
        >>> np.degrees(tally.covered).round(3)
        array([ 28.072, 180.   ])
        >>> tally.reachable.round(3)
        array([0.   , 0.939, 1.   ])
        >>> value, error = tally.cross_section()
        >>> bool(np.isnan(value[0])), bool(abs(value[2] * 2 * np.pi - np.pi / 4) < 4 * error[2] * 2 * np.pi)
        (True, True)
        """
        width = _core.solid_angles(self.edges) if self.name in _ANGLES else np.diff(self.edges)
        two_branches = self.name == "lab_angle" and self.beam.masses[0] > self.beam.masses[1]
        known = self.reachable == 1.0 if two_branches else self.reachable > 0.0
        scale = np.full(width.shape, np.nan)
        scale[known] = np.pi * self.b_max**2 / (self.n_events * (width * self.reachable)[known])
        return CrossSection(self.values() * scale, np.sqrt(self.variances()) * scale)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Tally):
            return NotImplemented
        numbers = ("name", "underflow", "overflow", "beam", "events")
        return all(getattr(self, name) == getattr(other, name) for name in numbers) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in ("edges", "counts")
        )

    def __add__(self, other: Tally) -> Tally:
        if not isinstance(other, Tally):
            return NotImplemented
        if self.name != other.name or not np.array_equal(self.edges, other.edges):
            raise InvalidInput("other", f"expected a tally of {self.name} with the same edges, got one of {other.name}")
        return replace(
            self,
            counts=self.counts + other.counts,
            underflow=self.underflow + other.underflow,
            overflow=self.overflow + other.overflow,
            events=self._merged_events(other),
        )

    def __radd__(self, other: int) -> Tally:
        """Begin a `sum`."""
        return self if _is_zero(other) else NotImplemented


@known_keywords
@dataclass(frozen=True, eq=False)
class MonteCarlo(_OfEvents, Mapping[str, Tally]):  # noqa: PLW1641 — as its tallies
    """The tallies of a run by name. Results of the same beam add up, bit for bit, if no event is in both.

    Attributes
    ----------
    beam : Beam
        What was scattered by what: ``potential``, ``beam_energy``, ``masses``, ``b_max`` and ``smallest_angle``, which
        are attributes of the result too.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    tallies : tuple of Tally
        In the order asked for.
    """

    beam: Beam
    events: tuple[tuple[int, int, int], ...]
    tallies: tuple[Tally, ...]

    @property
    def potential(self) -> Coulomb:
        """V = k/r."""
        return self.beam.potential

    @property
    def beam_energy(self) -> float:
        """Energy of the projectile in the laboratory."""
        return self.beam.beam_energy

    @property
    def masses(self) -> tuple[float, float]:
        """Projectile and target."""
        return self.beam.masses

    @property
    def smallest_angle(self) -> float:
        """The deflection at the edge of the disc, in the centre-of-mass frame: no event is scattered by less."""
        return self.beam.smallest_angle

    @property
    def next_event(self) -> int:
        """The ``first_event`` of a run that goes on after this one.

        Raises
        ------
        InvalidInput
            If the events are of several seeds.
        """
        if len({seed for seed, _, _ in self.events}) > 1:
            raise InvalidInput("next_event", "expected events of one seed, got several; see .events")
        return self.events[-1][2]

    def __getitem__(self, name: str) -> Tally:
        for tally in self.tallies:
            if tally.name == name:
                return tally
        known = ", ".join(tally.name for tally in self.tallies)
        raise KeyError(f"no tally {name!r}; this run has {known}")

    def __iter__(self) -> Iterator[str]:
        return (tally.name for tally in self.tallies)

    def __len__(self) -> int:
        return len(self.tallies)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MonteCarlo):
            return NotImplemented
        return (self.beam, self.events, self.tallies) == (other.beam, other.events, other.tallies)

    def __add__(self, other: MonteCarlo) -> MonteCarlo:
        if not isinstance(other, MonteCarlo):
            return NotImplemented
        events = self._merged_events(other)
        if list(self) != list(other):
            raise InvalidInput("other", f"expected the tallies {list(self)}, got {list(other)}")
        return replace(self, events=events, tallies=tuple(self[name] + other[name] for name in self))

    def __radd__(self, other: int) -> MonteCarlo:
        """Begin a `sum`."""
        return self if _is_zero(other) else NotImplemented

    def __repr__(self) -> str:
        k, sizes = self.potential.k, ", ".join(f"{tally.name} ({len(tally.counts)} bins)" for tally in self.tallies)
        return (
            f"<MonteCarlo: {self.n_events} events on k = {k:g}, beam energy {self.beam_energy:g}, "
            f"masses {self.masses}, b_max {self.b_max:g}: {sizes}>"
        )


def _is_zero(value: object) -> bool:
    return type(value) is int and value == 0


def _merged(ranges: tuple[tuple[int, int, int], ...]) -> tuple[tuple[int, int, int], ...]:
    """Sort and join ranges of events; an event that is in two would count twice."""
    joined: list[tuple[int, int, int]] = []
    for seed, first, end in sorted(ranges):
        if joined and joined[-1][0] == seed and first <= joined[-1][2]:
            before = joined.pop()
            if first < before[2]:
                raise InvalidInput(
                    "other", f"expected events that are not counted yet, but event {first} of seed {seed} is in both"
                )
            joined.append((seed, before[1], end))
        else:
            joined.append((seed, first, end))
    return tuple(joined)
