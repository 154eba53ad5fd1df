"""The events of a scattering Monte Carlo one by one, as arrays or in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from visviva import _core
from visviva._arrays import whole_number
from visviva._keywords import did_you_mean, known_keywords
from visviva._packages import needed
from visviva._parameter import checked_potential
from visviva._paths import path_text
from visviva._progress import callback
from visviva.errors import Interrupted
from visviva.scattering._beam import Spectrum, Spread, described
from visviva.scattering._monte_carlo import _beam
from visviva.scattering._spread import event_range

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

    from numpy.typing import NDArray

    from visviva.potentials import Potential
    from visviva.scattering._channels import Channel
    from visviva.scattering._importance import LargeAngles, Strata
    from visviva.typing import Progress, Report, ScatteringColumnName

__all__ = ["scattering_events"]


@known_keywords
def scattering_events(
    potential: Potential,
    *,
    beam_energy: float | Spectrum,
    masses: tuple[float, float],
    b_max: float,
    n_events: int,
    seed: int,
    first_event: int = 0,
    threads: int | None = None,
    progress: Progress = False,
    energy_spread: float | Spread | None = None,
    divergence: float | Spread | None = None,
    spot: float | None = None,
    importance: Strata | LargeAngles | None = None,
    channels: Channel | Iterable[Channel] | None = None,
    to: str | PathLike[str] | None = None,
) -> dict[ScatteringColumnName, NDArray[np.float64] | NDArray[np.uint64]]:
    """The very events that `monte_carlo` counts, one by one.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

    Parameters
    ----------
    potential, beam_energy, masses, b_max, seed, threads, progress
        As of `monte_carlo`.
    energy_spread, divergence, spot, importance, channels
        As of `monte_carlo`.
    n_events, first_event : int
        Which events.
    to : path-like, optional
        A Parquet file to write, exactly as named, in place of arrays: one row for each event, in memory that does not
        grow with their number. It needs pyarrow.

    Returns
    -------
    dict of ndarray, shape (n_events,)
        Of each event ``"event"`` (its index), ``"component"`` (which of the spectrum's energies), ``"beam_energy"`` and
        ``"incidence"`` (of the projectile before: energy, and angle from the axis), ``"deflection"`` (ψ, signed and not
        folded), and the quantities that `monte_carlo` can count; NaN of a captured one, except
        ``"impact_parameter"``. With `channels` also ``"channel"``: 0 is elastic, others count from 1 in the order
        given. With `importance` also ``"weight"``: how many events of the run without one stands for.
        Empty with `to`: the columns are those of the file.

    Raises
    ------
    InvalidInput
        As `monte_carlo`; naming ``to`` if pyarrow is not installed, or for what is no path.
    Interrupted
        After Ctrl-C. The file holds the events written until then, from ``first_event`` without a gap; the message
        says how many.
    KeyError
        By what is returned, for a column that it has not, with those that it has.

    References
    ----------
    J. K. Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011), for the random numbers.

    Examples
    --------
    >>> import visviva as vv
    >>> events = vv.scattering.scattering_events(
    ...     vv.potentials.LennardJones(1.0, 1.0), beam_energy=2.0, masses=(1.0, 1.0), b_max=3.0, n_events=3, seed=1)
    >>> events["event"].tolist(), bool((events["energy"] + events["recoil_energy"]).round(12).max() == 2.0)
    ([0, 1, 2], True)
    """
    checked_potential("potential", potential)
    beam = _beam(potential, beam_energy, masses, b_max, energy_spread, divergence, spot, importance, channels)
    first, count, key = event_range(first_event, n_events, seed)
    several = None if threads is None else whole_number("threads", threads, 1, 1024)
    request: dict[str, Any] = {"beam": described(beam), "seed": key, "threads": several}
    with callback(progress, "events") as report:
        if to is None:
            return _columns(request, first, count, report)
        _stream(request, first, count, report, path_text("to", to))
    return _Columns()


class _Columns(dict["ScatteringColumnName", "NDArray[Any]"]):
    """Columns by name, which says what there is where one is not."""

    __slots__ = ()

    def __missing__(self, name: object) -> NoReturn:
        there = f"there are {', '.join(self)}" if self else "all are in the file that was written"
        raise KeyError(f"there is no column {name!r}; {there}{did_you_mean(str(name), self)}")


_QUANTITIES: tuple[ScatteringColumnName, ...] = (
    *("weight", "beam_energy", "incidence", "deflection"),
    *("cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"),
)
# Events written at a time: 24 MB, and a table is built again for each.
_GROUP = 1 << 18


def _columns(
    request: dict[str, Any], first: int, count: int, report: Report | None
) -> dict[ScatteringColumnName, NDArray[Any]]:
    (component, channel), values = _core.scattering_events(
        **request, n_events=count, first_event=first, progress=report
    )
    columns = dict(zip(_QUANTITIES, np.ascontiguousarray(values.T), strict=True))
    if request["beam"]["importance"] is None:
        del columns["weight"]
    which: dict[ScatteringColumnName, NDArray[Any]] = {
        "event": np.arange(first, first + count, dtype=np.uint64),
        "component": component,
    }
    if request["beam"]["channels"]:
        which["channel"] = channel
    return _Columns({**which, **columns})


def _stream(request: dict[str, Any], first: int, count: int, report: Report | None, path: str) -> None:
    """Write events to a Parquet file, a row group at a time."""
    pyarrow, parquet = (needed(module, "to", "parquet") for module in ("pyarrow", "pyarrow.parquet"))
    done = 0

    def told(part: int, _: int) -> None:
        if report is not None:
            report(done + part, count)

    # The first group is made before the file: whatever is refused leaves no file behind.
    group = _columns(request, first, min(_GROUP, count), told)
    table = pyarrow.table(group)
    with parquet.ParquetWriter(path, table.schema) as writer:
        while True:
            writer.write_table(table)
            done += table.num_rows
            if done == count:
                return
            try:
                table = pyarrow.table(_columns(request, first + done, min(_GROUP, count - done), told))
            except KeyboardInterrupt as stopped:
                raise Interrupted(f"interrupted after {done} of {count} events, which {path!r} holds") from stopped
