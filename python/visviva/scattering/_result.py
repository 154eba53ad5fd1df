"""The result of a scattering Monte Carlo: its tallies by name, which add up, go on, and are kept in files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import add
from typing import TYPE_CHECKING, Any, overload

from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.scattering._beam import Beam, Spectrum
from visviva.scattering._counts import theory_is_known
from visviva.scattering._goes_on import GoesOn
from visviva.scattering._joint_tally import JointTally
from visviva.scattering._of_events import OfEvents
from visviva.scattering._saved import counts_for_file
from visviva.scattering._tally import Tally

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure

    from visviva.potentials import Potential
    from visviva.typing import Executor, Progress, TallyName

__all__ = ["MonteCarlo"]


@known_keywords
@dataclass(frozen=True, eq=False)
class MonteCarlo(GoesOn, OfEvents, Shown, Mapping["TallyName | tuple[TallyName, TallyName]", Tally | JointTally]):  # noqa: PLW1641 — as its tallies
    """The tallies of a run by name. Results of the same beam add up, bit for bit, if no event is in both.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

    Attributes
    ----------
    beam : Beam
        What was scattered by what: ``potential``, ``beam_energy``, ``masses``, ``b_max`` and ``smallest_angle``, which
        are attributes of the result too.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    tallies : tuple of Tally or JointTally
        In the order asked for; one of two quantities has the tuple of their names as its name.

    References
    ----------
    J. K. Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011), for the random numbers.

    Examples
    --------
    >>> import visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
    ...     n_events=1000, seed=1, bins=4)
    >>> list(run), run.n_events, int(run["cm_angle"].counts.sum())
    (['cm_angle'], 1000, 1000)
    """

    beam: Beam
    events: tuple[tuple[int, int, int], ...]
    tallies: tuple[Tally | JointTally, ...]

    @property
    def potential(self) -> Potential:
        """V(r).

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run.potential
        HardSphere(radius=1.0)
        """
        return self.beam.potential

    @property
    def beam_energy(self) -> float | Spectrum:
        """Energy of the projectile in the laboratory, in the units of the potential's energies.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run.beam_energy
        1.0
        """
        return self.beam.beam_energy

    @property
    def masses(self) -> tuple[float, float]:
        """Projectile and target, in the same units, whichever those are.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run.masses
        (1.0, 4.0)
        """
        return self.beam.masses

    @property
    def smallest_angle(self) -> float:
        """The deflection at the edge of the disc, in the center-of-mass frame, in radians: see `Beam`.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> round(run.smallest_angle, 9)
        1.117198631
        """
        return self.beam.smallest_angle

    @overload
    def __getitem__(self, name: TallyName) -> Tally: ...
    @overload
    def __getitem__(self, name: tuple[TallyName, TallyName]) -> JointTally: ...
    def __getitem__(self, name: TallyName | tuple[TallyName, TallyName]) -> Tally | JointTally:
        for tally in self.tallies:
            if tally.name == name:
                return tally
        known = ", ".join(str(tally.name) for tally in self.tallies)
        raise KeyError(f"no tally {name!r}; this run has {known}")

    def __iter__(self) -> Iterator[TallyName | tuple[TallyName, TallyName]]:
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
        return replace(self, events=events, tallies=tuple(map(add, self.tallies, other.tallies)))

    def _sheet(self) -> Sheet:
        rows = [
            (str(tally.name), f"{tally.counts.size}", f"{int(tally.counts.sum())}", f"{tally.captured}")
            for tally in self.tallies
        ]
        return Sheet(f"{self.n_events} events on {self.potential!r}", rows, ("", "bins", "counted", "captured"))

    def __repr__(self) -> str:
        sizes = ", ".join(f"{tally.name} ({tally.counts.size} bins)" for tally in self.tallies)
        energy = self.beam_energy
        what = f"{len(energy.energy)} beam energies" if isinstance(energy, Spectrum) else f"beam energy {energy:g}"
        return (
            f"<MonteCarlo: {self.n_events} events on {self.potential!r}, {what}, "
            f"masses {self.masses}, b_max {self.b_max:g}: {sizes}>"
        )

    def plot(self) -> Figure:
        """Draw every tally, each beside what is expected of it where that is known: see `Tally.plot`.

        Returns
        -------
        matplotlib.figure.Figure
            With a panel for each tally, three in a row, and where something is expected one below of what is left; the
            caller's, pyplot's state is not touched.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> result = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1,
        ...     tally=["cm_angle", "recoil_energy"])
        >>> [axes.get_xlabel() for axes in result.plot().axes]
        ['', 'angle in the center-of-mass frame [degrees]', '', 'recoil energy']
        """
        from visviva._residuals import new_panels

        known = [isinstance(tally, Tally) and theory_is_known(tally) for tally in self.tallies]
        figure, panels = new_panels(known, (5.5, 5.0 if any(known) else 4.0))
        for (upper, lower), tally in zip(panels, self.tallies, strict=True):
            if isinstance(tally, Tally):
                tally.plot(ax=upper, residuals=lower)
            else:
                tally.plot(ax=upper)
        return figure

    def _again(self, n_events: int, threads: int | None, progress: Progress, executor: Executor | None) -> MonteCarlo:
        from visviva.scattering._monte_carlo import next_events

        return next_events(self, n_events, threads, progress, executor)

    def _kept(self) -> tuple[dict[str, Any], dict[str, Any]]:
        return counts_for_file(self.beam, self.events, self.tallies)
