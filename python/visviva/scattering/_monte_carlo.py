"""The scattering Monte Carlo: what is asked for, checked, and counted by the core."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from visviva._arrays import float_array, number, positive
from visviva._keywords import known_keywords
from visviva._parameter import checked_potential
from visviva.errors import InvalidInput
from visviva.scattering._beam import Beam, Spectrum, Spread, as_spread, described
from visviva.scattering._beyond import beyond, less_what_is_beyond
from visviva.scattering._bins import asked_for
from visviva.scattering._channels import Channel, as_channels
from visviva.scattering._importance import LargeAngles, Strata, strata_of
from visviva.scattering._joint_tally import JointTally
from visviva.scattering._result import MonteCarlo
from visviva.scattering._spread import counted, event_range
from visviva.scattering._tally import Tally

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential
    from visviva.scattering._bins import Axes, Bins
    from visviva.typing import Executor, Progress, TallyName

    Tallies: TypeAlias = (
        Mapping[TallyName, ArrayLike | Bins]
        | Mapping[tuple[TallyName, TallyName], tuple[ArrayLike | Bins, ArrayLike | Bins]]
        | Mapping[TallyName | tuple[TallyName, TallyName], ArrayLike | Bins | tuple[ArrayLike | Bins, ArrayLike | Bins]]
    )

__all__ = ["monte_carlo"]

#: What events are told of beside what is tallied.
_OF_EVENTS_ALONE = ("beam_energy", "incidence", "deflection")


@known_keywords
def monte_carlo(
    potential: Potential,
    *,
    beam_energy: float | Spectrum,
    masses: tuple[float, float],
    b_max: float,
    n_events: int,
    seed: int,
    tally: TallyName | Iterable[TallyName | tuple[TallyName, TallyName]] | Tallies = "cm_angle",
    bins: ArrayLike | Bins | Mapping[TallyName, ArrayLike | Bins] = 180,
    threads: int | None = None,
    first_event: int = 0,
    progress: Progress = False,
    executor: Executor | None = None,
    energy_spread: float | Spread | None = None,
    divergence: float | Spread | None = None,
    spot: float | None = None,
    importance: Strata | LargeAngles | None = None,
    channels: Channel | Iterable[Channel] | None = None,
) -> MonteCarlo:
    """Scatter a beam off one center and count every event.

    The impact parameter is uniform over a disc: b² uniform in [0, b_max²). Event i takes its random numbers from
    Philox 4x32-10 with ``seed`` as the key and i as the counter, so the counts do not depend on threads, processor or
    partition, and results of separate ranges of events add up to that of the whole. Each number of an event is for one
    thing: 0 for the impact parameter, 1 for the line of a `Spectrum`, 2 and 3 for the spread of the energy, 4 for the
    direction, 5 for the azimuth of the plane of scattering, 6 for the channel; so nothing that is asked for beside
    changes the others.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any of `visviva.potentials` that goes to 0 far out. The angles of V = k/r are exact; of any other a table is
        built, refined to 1e-9 of the angles and certified against direct quadrature to 4e-6 in sin²(ψ/2) (the run is
        refused otherwise): its hash is in ``result.beam.tables``. Where the deflection passes through π, or through a
        rainbow, every branch is counted; captured events are counted apart, as ``result["cm_angle"].captured``.
    beam_energy : float or Spectrum
        Energy of the projectile in the laboratory; the target is at rest. Several energies: a `Spectrum`; which of them
        an event has is its draw number 1.
    masses : tuple of float
        Projectile and target.
    b_max : float
        Radius of the disc, the cut without which the total cross section is infinite for most potentials. The smallest
        deflection of a Coulomb target, ``result.smallest_angle``, is 2 atan(|k| / (2 E b_max)),
        E = beam_energy · m₂/(m₁ + m₂): bins below it are not reached, see `Tally.reachable`.
    n_events : int
        At least 1.
    seed : int
        0 to 2⁶⁴ − 1.
    tally : str, iterable of str, or mapping
        What to count: ``"cm_angle"`` (size of the deflection in the center-of-mass frame), ``"lab_angle"``,
        ``"recoil_angle"``, ``"energy"``, ``"recoil_energy"``, ``"impact_parameter"``; one name, several, or
        ``{name: edges}``, where a whole number in place of edges is a number of equal bins, and `Bins` are bins by
        name: ``Bins.logarithmic(60, 1e-3)``, ``Bins.solid_angle(50)``. Angles are in radians.
        A pair of names in place of a name counts both together: ``[("lab_angle", "energy")]``, or
        ``{("lab_angle", "energy"): (edges, edges)}``, a `JointTally`.
    bins : int, Bins, array_like or mapping
        Of each tally that is given by its name only: a number of equal bins over all values, up to 65536; `Bins`;
        edges; or ``{name: any of these}``, with 180 equal bins of a quantity that is not among them. Values below the
        first and above the last edge are counted too, as ``underflow`` and ``overflow``. Edges have shape (B + 1,).
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.
    first_event : int
        Index of the first event.
    progress : bool or callable
        True for a bar, or ``f(done, total)``.
    executor : concurrent.futures.Executor or dask.distributed.Client, optional
        Who counts: ranges of events go out, counts come home, with the bits of the run without one. Tables are built
        by each worker and compared by their hashes. Each worker uses ``threads`` threads, or one.
    energy_spread : float or Spread, optional
        Of the projectiles' energies about `beam_energy`, or about each energy of a `Spectrum`; a number is the standard
        deviation of a Gaussian, which ends at 6 of them. Angles are interpolated between tables of 3 to 17 energies,
        tried against direct quadrature to 4e-6 in sin²(ψ/2); where the deflection is not that smooth in the energy
        (orbiting, capture) the angle of each event is found by direct quadrature, to 1e-12 of what is added up to it,
        in some microseconds in place of some ten nanoseconds, and ``result.beam.tables`` is empty.
    divergence : float or Spread, optional
        Of the directions about the axis, in radians: a number is the standard deviation of a Gaussian in each of two
        planes. ``lab_angle`` and ``recoil_angle`` are then measured from the axis; ``cm_angle`` stays that of the
        collision.
    spot : float, optional
        Standard deviation, in each of two dimensions, of the places at which projectiles come, about the center and cut
        at ``b_max``; by default the disc is filled evenly (of another radius: that is ``b_max``). There is no cross
        section of a beam that does not fill the disc evenly.
    importance : Strata or LargeAngles, optional
        Where events are wanted: rings of impact parameters with parts of the events of their own (`Strata`), or a part
        of them for all that is deflected by more than some angle (`LargeAngles`). Draw number 0 is mapped to b² ring by
        ring. Counts are whole numbers as ever, kept ring by ring; ``values()``, ``variances()`` and cross sections
        weight them, so that their means are those of the run without. Not beside `spot`.
    channels : Channel or iterable of Channel, optional
        Reactions with a Q and a probability each; what they leave of 1 is elastic. In the order given they divide draw
        number 6 from 0 up: a channel more at the end changes no event of those before. ``energy`` and ``lab_angle`` are
        then of what the projectile becomes, ``recoil_energy`` and ``recoil_angle`` of the other. Cross sections are
        those of all channels together.

    Returns
    -------
    MonteCarlo
        ``result["cm_angle"].counts``, ``.edges``, ``.values()``, ``.variances()``, ``.cross_section()``.

    Raises
    ------
    InvalidInput
        For any argument out of range, by name; edges outside the range of their quantity too; for a channel that is
        closed at any energy of the beam, with its threshold.
    Interrupted
        After Ctrl-C, or if ``progress`` raises `KeyboardInterrupt`. Its ``.result`` holds the events counted until
        then, from ``first_event`` without a gap (None if there are none yet): with a run of the rest, from
        ``.result.next_event`` on, it adds up to the whole, bit for bit.

    References
    ----------
    J. K. Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011).

    Examples
    --------
    >>> import visviva as vv
    >>> beam = dict(beam_energy=1.0, masses=(1.0, 4.0), b_max=2.0, seed=1)
    >>> whole = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=1000, **beam)
    >>> part = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=600, **beam)
    >>> rest = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=400, first_event=600, **beam)
    >>> bool(((part + rest)["cm_angle"].counts == whole["cm_angle"].counts).all())
    True
    """
    checked_potential("potential", potential)
    asked = asked_for(tally, bins)
    for name in (name for axes in asked for name, _ in axes):
        if name in _OF_EVENTS_ALONE:
            raise InvalidInput(
                "tally",
                f"{name!r} is a column of scattering_events and is not counted here; with the same arguments and "
                f"n_events take numpy.histogram(scattering_events(…)[{name!r}], edges)",
            )
    beam = _beam(potential, beam_energy, masses, b_max, energy_spread, divergence, spot, importance, channels)
    return _run(beam, asked, n_events, seed, first_event, threads, progress, executor)


def _beam(
    potential: Potential,
    beam_energy: object,
    masses: object,
    b_max: object,
    energy_spread: object,
    divergence: object,
    spot: object,
    importance: object,
    channels: Channel | Iterable[Channel] | None,
) -> Beam:
    beam = Beam(
        potential,
        _energy(beam_energy),
        _pair(masses),
        number("b_max", b_max),
        np.nan,
        energy_spread=as_spread("energy_spread", energy_spread),
        divergence=as_spread("divergence", divergence),
        spot=None if spot is None else positive("spot", spot),
        channels=as_channels(channels),
    )
    return replace(beam, importance=strata_of(importance, beam))


def next_events(
    result: MonteCarlo, n_events: int, threads: int | None, progress: Progress, executor: Any
) -> MonteCarlo:
    """The next events of a result."""
    asked: list[Axes] = []
    for tally in result.tallies:
        if isinstance(tally, Tally):
            asked.append([(tally.name, tally.edges)])
        else:
            asked.append(list(zip(tally.name, tally.edges, strict=True)))
    first = result.next_event
    return _run(result.beam, asked, n_events, result.events[0][0], first, threads, progress, executor)


def _energy(given: object) -> float | Spectrum:
    if isinstance(given, list | tuple | np.ndarray) and np.ndim(given) > 0:
        raise InvalidInput(
            "beam_energy", f"expected one number, or a Spectrum(energy, weight) of several, got {given!r}"
        )
    return given if isinstance(given, Spectrum) else number("beam_energy", given)


def _pair(masses: object) -> tuple[float, float]:
    pair = float_array("masses", masses, (2,))
    return (float(pair[0]), float(pair[1]))


def _run(
    beam: Beam,
    asked: list[Axes],
    n_events: object,
    seed: object,
    first_event: object,
    threads: object,
    progress: Progress,
    executor: Any,
) -> MonteCarlo:
    request = {"beam": described(beam), "tallies": asked}

    def made(came: tuple[Any, ...], events: tuple[tuple[int, int, int], ...]) -> MonteCarlo:
        _, _, smallest, tables, columns = came
        found = replace(beam, smallest_angle=smallest, tables=tuple(table[0] for table in tables))
        singles = [column for column in columns if column[4] is not None]
        hidden = beyond(found)
        if len(hidden) == 1 and not isinstance(beam.beam_energy, Spectrum):
            found = replace(found, smallest_angle=max(smallest, *hidden.values()))
        axes = [(names[0], edges[0]) for names, edges, *_ in singles]
        told = iter(less_what_is_beyond(found, axes, [column[4] for column in singles], hidden))
        return MonteCarlo(
            found,
            events,
            tuple(_tally(column, found, events, None if column[4] is None else next(told)) for column in columns),
        )

    return counted("monte_carlo", request, event_range(first_event, n_events, seed), threads, progress, executor, made)


def _tally(
    column: tuple[Any, ...],
    beam: Beam,
    events: tuple[tuple[int, int, int], ...],
    single: tuple[NDArray[np.float64], tuple[float, float]] | None,
) -> Tally | JointTally:
    names, edges, flow, captured, _, by_stratum = column
    if single is None:
        return JointTally(tuple(names), tuple(edges), flow, captured, beam, events, by_stratum)
    reachable, covered = single
    under, over = int(flow[0]), int(flow[-1])
    counts = flow[1:-1].copy()
    return Tally(names[0], edges[0], counts, under, over, reachable, covered, beam, events, captured, by_stratum)
