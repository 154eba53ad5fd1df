"""What a foil gives: how many ions came through, came back or stopped, and the histograms of them, which add up."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from visviva._accuracy import callers_inside
from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords, one_of
from visviva._made_by import made_by
from visviva.errors import AccuracyWarning, InvalidInput
from visviva.scattering._foil_tally import FoilTally, Fraction, summed
from visviva.scattering._goes_on import GoesOn
from visviva.scattering._of_events import Counted
from visviva.scattering._spread import counted, event_range
from visviva.scattering._weights import read_only

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.scattering._bins import Axes
    from visviva.scattering._foil import Foil
    from visviva.scattering._foil_material import Ion
    from visviva.typing import Executor, FoilTallyName, Progress

__all__ = ["USUAL_TALLIES", "Bombardment", "FoilResult"]

#: What is counted if nobody asks for anything else.
USUAL_TALLIES: tuple[FoilTallyName, ...] = (
    "transmitted_angle",
    "transmitted_energy",
    "reflected_angle",
    "reflected_energy",
    "stopped_depth",
)
#: So that no sum of weights in units is beyond 64 bits.
MOST_IONS = 2**39
_FATES = ("transmitted", "reflected", "stopped", "missed")


@known_keywords
@dataclass(frozen=True, repr=False)
class Bombardment(Record):
    """A foil and what comes to it: what results must have in common to be added.

    Attributes
    ----------
    foil : Foil
        With its material, potential and stopping.
    ion : Ion
        What flies.
    beam_energy, lowest_energy : float
        In eV.
    incidence : float
        Angle between the beam and the normal.
    collisions : str
        ``"multiple"`` or ``"single"``.
    forced_angle : float or None
        Least center-of-mass angle of the collision that every ion was made to have.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
    >>> out.bombardment.ion, out.bombardment.collisions
    (Ion(atomic_number=2.0, mass=4.001506179127), 'multiple')
    """

    foil: Foil
    ion: Ion
    beam_energy: float
    lowest_energy: float
    incidence: float
    collisions: str
    forced_angle: float | None

    def _to_core(self) -> dict[str, Any]:
        return {
            "ion": (self.ion.atomic_number, self.ion.mass),
            "beam_energy": self.beam_energy,
            "lowest_energy": self.lowest_energy,
            "incidence": self.incidence,
            "single": self.collisions == "single",
            "forced_angle": self.forced_angle,
        }

    def _run(
        self,
        asked: list[Axes],
        n_events: object,
        seed: object,
        first_event: object,
        threads: object,
        progress: Progress,
        executor: Any,
    ) -> FoilResult:
        request = {
            "foil": self.foil._described(self.ion),
            "run": self._to_core(),
            "tallies": [axis for (axis,) in asked],
        }
        events = event_range(first_event, n_events, seed, MOST_IONS)
        result = counted("foil_run", request, events, threads, progress, executor, self._made, "ions")
        self._warn_if_thin(result.collisions_across)
        return result

    def _warn_if_thin(self, collisions_across: float) -> None:
        """Warn of a foil that is thinner than atoms are apart, or than the way between two collisions.

        The one collision of a run of single ones is that of a thin foil; beside a forced one no others are needed.
        """
        if self.collisions == "single":
            return
        apart = self.foil.material.number_density ** (-1.0 / 3.0)
        thickness = self.foil.thickness * 1e4
        if thickness < apart:
            message = (
                f"thickness = {self.foil.thickness:g} µm is {thickness:.2g} Å, less than the {apart:.2g} Å that atoms "
                'are apart: that is no foil of amorphous matter; for its limit per atom pass collisions="single" and '
                "a forced_angle"
            )
        elif collisions_across < 1.0 and self.forced_angle is None:
            message = (
                f"an ion has {collisions_across:.2g} collisions on a straight way through {self.foil.thickness:g} µm: "
                f"most are turned by nothing, as those that turn by less than minimum_angle = "
                f"{self.foil.minimum_angle:g} are left out; try a smaller one, a thicker foil, or a forced_angle"
            )
        else:
            return
        warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())

    def _made(self, came: tuple[Any, ...], events: tuple[tuple[int, int, int], ...]) -> FoilResult:
        done, _, units, told, sums, columns = came
        tallies = tuple(
            FoilTally(cast("FoilTallyName", name), edges, each, units, done) for name, edges, each in columns
        )
        return FoilResult(self, events, sums, units, tallies, told[0], told[1])


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class FoilResult(GoesOn, Counted, Shown, Mapping["FoilTallyName", FoilTally]):  # noqa: PLW1641 — as its tallies
    """The tallies of a run by name. Results of the same bombardment add up, bit for bit, if no event is in both.

    Attributes
    ----------
    bombardment : Bombardment
        The foil and what came to it.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    sums : ndarray of uint64, shape (4, 3)
        Transmitted, reflected, stopped, and missed ones (without the collision that was to be forced): events, weights
        and squares, the last two in `units`.
    units : tuple of float
        Of weights and of squares, without dimension; 1 where nothing is forced.
    tallies : tuple of FoilTally
        In the order asked for.
    collisions_across : float
        How many collisions a straight way through takes on the average, at the beam's energy.
    table_error : float
        The largest error of sin²(ψ/2) of the tables, of all places that were tried.

    References
    ----------
    F. James, *Statistical Methods in Experimental Physics*, 2nd ed. (2006), ch. 4 (binomial and multinomial counts).

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
    >>> out.transmitted + out.reflected + out.stopped
    1000
    """

    bombardment: Bombardment
    events: tuple[tuple[int, int, int], ...]
    sums: NDArray[np.uint64]
    units: tuple[float, float]
    tallies: tuple[FoilTally, ...]
    collisions_across: float
    table_error: float

    def __post_init__(self) -> None:
        made_by(self, "a run of a Foil", sums=(self.sums, np.ndarray))
        read_only(self.sums)

    @property
    def transmitted(self) -> int:
        """Events that came through."""
        return int(self.sums[0, 0])

    @property
    def reflected(self) -> int:
        """Events that came back."""
        return int(self.sums[1, 0])

    @property
    def stopped(self) -> int:
        """Events that ended in the foil."""
        return int(self.sums[2, 0])

    @property
    def missed(self) -> int:
        """Events whose way ended before the collision that was to be forced; 0 where nothing is forced.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> out.missed
        0
        """
        return int(self.sums[3, 0])

    def fraction(self, fate: Literal["transmitted", "reflected", "stopped"]) -> Fraction[float]:
        """What part of the ions was transmitted, reflected or stopped, without dimension, with its standard error.

        Parameters
        ----------
        fate : {"transmitted", "reflected", "stopped"}

        Returns
        -------
        Fraction
            Of numbers: the part and its standard error, from 0 to 1.

        Raises
        ------
        InvalidInput
            For another word than these three.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=5.486e6, n_events=100, seed=1)
        >>> out.fraction("transmitted")
        Fraction(value=1.0, error=0.0)
        """
        one_of("fate", fate, _FATES[:3])
        weight, variance = summed(self.sums[_FATES.index(fate)], self.units, self.n_events)
        return Fraction(float(weight) / self.n_events, float(np.sqrt(variance)) / self.n_events)

    def __getitem__(self, name: FoilTallyName) -> FoilTally:
        for tally in self.tallies:
            if tally.name == name:
                return tally
        raise KeyError(f"no tally {name!r}; this run has {', '.join(self)}")

    def __iter__(self) -> Iterator[FoilTallyName]:
        return (tally.name for tally in self.tallies)

    def __len__(self) -> int:
        return len(self.tallies)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FoilResult):
            return NotImplemented
        names = ("bombardment", "events", "units", "tallies")
        same = all(getattr(self, name) == getattr(other, name) for name in names)
        return same and np.array_equal(self.sums, other.sums)

    def __add__(self, other: FoilResult) -> FoilResult:
        if not isinstance(other, FoilResult):
            return NotImplemented
        names = (field.name for field in fields(self.bombardment))
        events = self._joined_events(other, names, self.bombardment, other.bombardment)
        if list(self) != list(other):
            raise InvalidInput("other", f"expected the tallies {list(self)}, got {list(other)}")
        tallies = tuple(self[name]._joined(other[name]) for name in self)
        return replace(self, events=events, sums=self.sums + other.sums, tallies=tallies)

    def _sheet(self) -> Sheet:
        fates = [(name, f"{number}", "", "") for name, number in zip(_FATES, self.sums[:, 0].tolist(), strict=True)]
        rows = [
            (
                str(tally.name),
                f"{int(tally.counts.sum())}",
                f"{tally.counts.size}",
                f"{tally.edges[0]:.6g} to {tally.edges[-1]:.6g}",
            )
            for tally in self.tallies
        ]
        caption = f"{self.n_events} ions on {self.bombardment.foil!r}, {self.bombardment.beam_energy:g} eV"
        return Sheet(caption, [*fates[: 3 + bool(self.missed)], *rows], ("", "events", "bins", "range"))

    def __repr__(self) -> str:
        parts = ", ".join(
            f"{count} {name}" for name, count in zip(_FATES, self.sums[:, 0].tolist(), strict=True) if count
        )
        return f"<FoilResult: {self.n_events} events, {parts}>"

    def plot(self) -> Figure:
        """Draw every tally that has counted something: see `FoilTally.plot`.

        Returns
        -------
        matplotlib.figure.Figure
            Three panels in a row.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> figure = out.plot()
        >>> figure.axes[0].get_ylabel()
        'part of the ions per bin'
        """
        from visviva._residuals import new_panels

        drawn = [tally for tally in self.tallies if tally.counts.any()] or self.tallies
        figure, panels = new_panels([False] * len(drawn), (4.5, 3.6))
        for (axes, _), tally in zip(panels, drawn, strict=True):
            tally.plot(ax=axes)
        return figure

    def _again(self, n_events: int, threads: int | None, progress: Progress, executor: Executor | None) -> FoilResult:
        asked: list[Axes] = [[(tally.name, tally.edges)] for tally in self.tallies]
        seed, first = self.events[0][0], self.next_event
        return self.bombardment._run(asked, n_events, seed, first, threads, progress, executor)

    def _kept(self) -> tuple[dict[str, Any], dict[str, Any]]:
        from visviva.scattering._foil_saved import counts_for_file

        return counts_for_file(self)
