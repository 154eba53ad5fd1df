"""Which events a result is of, so that results add up without a gap and nothing is counted twice."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from visviva.scattering._beam import Beam

__all__ = ["OfEvents", "is_zero", "joined_ranges"]


class OfEvents:
    """What a result and each of its tallies know: the beam and which of its events."""

    beam: Beam
    events: tuple[tuple[int, int, int], ...]

    @property
    def n_events(self) -> int:
        """Events in all.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run["cm_angle"].n_events
        1000
        """
        return sum(end - first for _, first, end in self.events)

    @property
    def b_max(self) -> float:
        """Radius of the disc of impact parameters, in the units of the potential's lengths.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run["cm_angle"].b_max
        1.0
        """
        return self.beam.b_max

    def __radd__(self, other: int) -> Self:
        """Begin a `sum`."""
        return self if is_zero(other) else NotImplemented

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # a pickle does not keep that arrays are read-only

    def __post_init__(self) -> None:
        pass

    def _merged_events(self, other: OfEvents) -> tuple[tuple[int, int, int], ...]:
        """Refuse another beam and events that are in both."""
        names = ("potential", "beam_energy", "masses", "b_max", "energy_spread", "divergence", "spot", "importance")
        for name in (*names, "channels", "tables"):
            mine, theirs = getattr(self.beam, name), getattr(other.beam, name)
            if mine != theirs:
                raise InvalidInput("other", f"expected the same {name}, {mine!r}, got {theirs!r}")
        return joined_ranges((*self.events, *other.events))


def is_zero(value: object) -> bool:
    """Whether it is the 0 with which `sum` begins."""
    return type(value) is int and value == 0


def joined_ranges(ranges: tuple[tuple[int, int, int], ...]) -> tuple[tuple[int, int, int], ...]:
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
