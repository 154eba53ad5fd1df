"""How well the invariants held in each copy of an ensemble.

The one idea: what `Trajectory.conservation` tells of one copy, number by number, under a leading axis B; the table
shows the copy that did worst.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, overload

import numpy as np

from visviva._endings import interrupted_and_failed
from visviva._html import Record, Sheet, Shown, as_text
from visviva._keywords import known_keywords
from visviva._some_copies import each_of, one_or_some
from visviva._text import count
from visviva.conservation import ROWS, Conservation, Drift, conservation_of, has_rows, row_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva._some_copies import One, Some
    from visviva.ensemble_trajectory import EnsembleTrajectory

__all__ = ["DriftOfCopies", "EnsembleConservation"]

_NUMBERS = tuple(each.name for each in fields(Drift) if each.name != "name")


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DriftOfCopies(Record):
    """How far one quantity moved from its initial value, in each copy: the numbers of `Drift`, one by one.

    Attributes
    ----------
    name : str
    scale : ndarray, shape (B,)
        What `max`, `end` and `rms` are divided by, in the user's units.
    max, end, rms : ndarray, shape (B,)
        Largest, last and root-mean-square distance from the initial value, over `scale`; NaN of a copy that failed
        before its first row.
    slope : ndarray, shape (B,)
        Least-squares growth of that distance per unit of time, over `scale`.
    conserved : ndarray of bool, shape (B,)
        Whether the forces of the copy, and its collisions, conserve it at all.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.figure_eight().scene
    >>> drift = scene.ensemble(mass=[[1.0, 1.0, 1.0], [1.0, 1.0, 1.1]]).run(t=[1.0, 2.0]).conservation().energy
    >>> drift.name, drift.conserved.tolist(), bool(drift.max.max() < 1e-10)
    ('energy', [True, True], True)
    """

    name: str
    scale: NDArray[np.float64]
    max: NDArray[np.float64]
    end: NDArray[np.float64]
    rms: NDArray[np.float64]
    slope: NDArray[np.float64]
    conserved: NDArray[np.bool_]

    @property
    def worst(self) -> int | None:
        """The copy whose largest drift is the largest, of those that conserve it; None if none does.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> out = scene.ensemble(velocity=[scene.particles.velocity, 0.5 * scene.particles.velocity])
        >>> out.run(t=[0.0, 6.0], method="leapfrog", dt=0.01).conservation().energy.worst
        1
        """
        largest = np.where(self.conserved & np.isfinite(self.max), self.max, -1.0)
        copy = int(largest.argmax())
        return copy if largest[copy] >= 0.0 else None


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EnsembleConservation(Shown):
    """Drift of each invariant in each copy of an ensemble; prints as a table of the copy with the largest.

    Units: drifts are relative to their scales, without dimension, and so is the virial; scales are in those of the
    scene.

    Attributes
    ----------
    energy, momentum, angular_momentum, center_of_mass : DriftOfCopies
        As of `Conservation`, each number an array of shape (B,).
    virial : ndarray, shape (B,)
        That of `Conservation`, of each copy.
    about : str
        The reference point of the angular momentum.
    status : ndarray of int8, shape (B,)
        How each copy ended, values of `Status`. The drifts of one that failed or was interrupted are those up to there.

    Notes
    -----
    Indexed like a run: ``kept[i]`` is the `Conservation` of copy i (all NaN where that failed before its first row), a
    slice, a list or array of numbers, or a mask (B,) that of some copies, and ``kept["energy"]`` a row by the name that
    is printed; ``kept[i]["energy"].max`` and ``kept["energy"].max[i]`` are one number.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2 (König's theorem, angular momentum) and §
    3.4 (virial).

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.figure_eight().scene
    >>> kept = scene.ensemble(mass=[[1.0, 1.0, 1.0], [1.0, 1.0, 1.1]]).run(t=[1.0, 2.0]).conservation()
    >>> kept.energy.max.shape, bool(kept.momentum.conserved.all()), kept.about
    ((2,), True, 'origin')
    >>> bool(kept["energy"].max[1] == kept[1]["energy"].max), len(kept[1:])
    (True, 1)
    """

    energy: DriftOfCopies
    momentum: DriftOfCopies
    angular_momentum: DriftOfCopies
    center_of_mass: DriftOfCopies
    virial: NDArray[np.float64]
    about: str
    status: NDArray[np.int8]
    _copies: tuple[Conservation, ...] = field(repr=False)

    def __len__(self) -> int:
        return len(self._copies)

    def __iter__(self) -> Iterator[Conservation]:
        return iter(self._copies)

    @overload
    def __getitem__(self, index: One) -> Conservation: ...
    @overload
    def __getitem__(self, index: Some) -> EnsembleConservation: ...
    @overload
    def __getitem__(self, index: str) -> DriftOfCopies: ...
    def __getitem__(self, index: One | Some | str) -> Conservation | EnsembleConservation | DriftOfCopies:
        if isinstance(index, str):
            drift: DriftOfCopies = getattr(self, row_of(index))
            return drift
        chosen = one_or_some(index, len(self))
        if isinstance(chosen, int):
            return self._copies[chosen]
        copies = each_of(self._copies, chosen)
        status = self.status[chosen]
        status.setflags(write=False)
        return _of_copies(copies, status)

    @property
    def rows(self) -> tuple[DriftOfCopies, ...]:
        """The drifts, in the order of the table.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.figure_eight().scene
        >>> kept = scene.ensemble(mass=[[1.0, 1.0, 1.0], [1.0, 1.0, 1.1]]).run(t=[1.0, 2.0]).conservation()
        >>> [row.name for row in kept.rows]
        ['energy', 'momentum', 'angular momentum', 'center of mass']
        """
        return self.energy, self.momentum, self.angular_momentum, self.center_of_mass

    def __repr__(self) -> str:
        worst = ((row.name, row.max, row.worst) for row in self.rows)
        told = ", ".join(f"{name} {drifts[copy]:.1e} (copy {copy})" for name, drifts, copy in worst if copy is not None)
        return f"EnsembleConservation({count(len(self.virial), 'copy', 'copies')}; {told or 'nothing is conserved'})"

    def __str__(self) -> str:
        return as_text(self._sheet())

    def _sheet(self) -> Sheet:
        rows: list[tuple[str, ...]] = []
        for row in self.rows:
            copy = row.worst
            if copy is None:
                rows.append((f"{row.name} (conserved in no copy)", "", "", "", "", ""))
                continue
            numbers = (f"{each[copy]:.1e}" for each in (row.max, row.end, row.rms))
            rows.append((row.name, *numbers, f"{row.scale[copy]:.6g}", str(copy)))
        header = ("", "max", "end", "rms", "relative to", "copy")
        interrupted, failed = interrupted_and_failed(self.status)
        short = (failed, "failed"), (interrupted, "was interrupted" if interrupted == 1 else "were interrupted")
        ended = " and ".join(f"{number} {how}" for number, how in short if number)
        upto = f", of which {ended}, told up to there" if ended else ""
        title = f"Conservation in {count(len(self.virial), 'copy', 'copies')}{upto}: the largest drifts"
        hints = dict.fromkeys(hint for each in self._copies for hint in each._hints)
        hints.update(dict.fromkeys(told for row in self.rows if (told := _beyond_numbers(row))))
        return Sheet(title, rows, header, "\n".join(hints))


def _beyond_numbers(row: DriftOfCopies) -> str:
    """What is to be said of copies whose drift is no number, as beyond float64; nothing if there are none."""
    copies = np.flatnonzero(row.conserved & ~np.isfinite(row.max))
    if not len(copies):
        return ""
    which = f"copy {copies[0]}" if len(copies) == 1 else f"{len(copies)} copies, {copies[0]} the first,"
    return f"The {row.name} of {which} is no number, and not among these."


def conservation_of_copies(out: EnsembleTrajectory, about: ArrayLike | str | None) -> EnsembleConservation:
    """The table of an ensemble: that of each copy that has a row, NaN of one that has none."""
    found = [conservation_of(copy, about) if has_rows(copy) else None for copy in out]
    # Where no copy has a row, that of the first is refused.
    known = next((each for each in found if each is not None), None) or conservation_of(out[0], about)
    none = np.nan
    energy, momentum, angular, center = (
        Drift(row.name, scale=none, max=none, end=none, rms=none, slope=none, conserved=False) for row in known.rows
    )
    untold = replace(
        known,
        energy=energy,
        momentum=momentum,
        angular_momentum=angular,
        center_of_mass=center,
        virial=none,
        collisions=0,
    )
    return _of_copies(tuple(untold if each is None else each for each in found), out.status)


def _of_copies(found: tuple[Conservation, ...], status: NDArray[np.int8]) -> EnsembleConservation:
    drifts = {name: _together([getattr(each, name) for each in found]) for name in ROWS}
    virial = np.array([each.virial for each in found])
    virial.setflags(write=False)
    return EnsembleConservation(**drifts, virial=virial, about=found[0].about, status=status, _copies=found)


def _together(rows: Sequence[Drift]) -> DriftOfCopies:
    """One quantity of all copies."""
    arrays = {each: np.array([getattr(row, each) for row in rows]) for each in _NUMBERS}
    for array in arrays.values():
        array.setflags(write=False)
    return DriftOfCopies(rows[0].name, **arrays)


def __dir__() -> list[str]:
    return list(__all__)
