"""Which events a result is of, so that results add up without a gap and nothing is counted twice."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from visviva._stored import Damaged
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterable

    from visviva.scattering._beam import Beam

__all__ = ["Counted", "OfEvents", "checked_events"]


class Counted:
    """What is of events, and adds up where the rest is the same."""

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

    def __radd__(self, other: int) -> Self:
        """Begin a `sum`."""
        return self if type(other) is int and other == 0 else NotImplemented

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # a pickle does not keep that arrays are read-only

    def __post_init__(self) -> None:
        pass

    def _joined_events(
        self, other: Counted, names: Iterable[str], mine: object, theirs: object
    ) -> tuple[tuple[int, int, int], ...]:
        """Refuse what was scattered by something else, as these names of it tell, and events that are in both."""
        for name in names:
            one, another = getattr(mine, name), getattr(theirs, name)
            if one != another:
                raise InvalidInput("other", f"expected the same {name}, {one!r}, got {another!r}")
        return joined_ranges((*self.events, *other.events))


class OfEvents(Counted):
    """What a result and each of its tallies know: the beam and which of its events."""

    beam: Beam

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

    def _merged_events(self, other: OfEvents) -> tuple[tuple[int, int, int], ...]:
        """Refuse another beam and events that are in both."""
        names = ("potential", "beam_energy", "masses", "b_max", "energy_spread", "divergence", "spot", "importance")
        return self._joined_events(other, (*names, "channels", "tables"), self.beam, other.beam)


def checked_events(told: list[Any]) -> tuple[tuple[int, int, int], ...]:
    """The events of a file.

    Raises
    ------
    Damaged
        If they are none, or not sorted.
    """
    events = tuple((seed, first, end) for seed, first, end in told)
    numbers = [number for each in events for number in each]
    if not events or not all(type(number) is int for number in numbers):
        raise Damaged("the file has counts of no events")
    if not all(0 <= seed < 2**64 and 0 <= first < end <= 2**63 for seed, first, end in events):
        raise Damaged("the file has counts of events that there are not")
    if events != joined_ranges(events):
        raise Damaged("the file has events that are not sorted")
    return events


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
