"""What comes back of many copies in one run: arrays with a leading axis B.

A copy that fails has a status and NaN from there on; the others do not notice.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from visviva._continuation import continuation_after, with_continuation
from visviva._endings import endings
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva._some_copies import lines_of, one_or_some, rows_of
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.recorded import Recorded
from visviva.status import Status
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from visviva._exported import Columns
    from visviva._html import Sheet
    from visviva._some_copies import One, Some
    from visviva.body import BodyMotion
    from visviva.ensemble import EnsembleScene
    from visviva.ensemble_conservation import EnsembleConservation
    from visviva.scene import Scene
    from visviva.typing import ColumnName

__all__ = ["EnsembleTrajectory"]


@known_keywords
class EnsembleTrajectory(Recorded):
    """The motions of the copies. Made by `EnsembleScene.run` and `load`.

    Units: those of the scene.

    Attributes
    ----------
    ensemble : EnsembleScene
    t : ndarray, shape (T,)
    position, velocity : ndarray, shape (B, T, N, 3)
    energy : ndarray, shape (B, T)
    momentum, angular_momentum, center_of_mass : ndarray, shape (B, T, 3)
    status : ndarray of int8, shape (B,)
        Values of `Status`; rows after a failure or a terminal event are NaN.
    stats : Stats
        Totals over the copies; `per_trajectory` has them one by one.

    Every array is read-only; ``out.position.copy()`` is yours. Indexing with a number gives the `Trajectory` of one
    copy, with the name of a body its motion in all copies. A slice, a list or array of numbers, or a mask (B,) gives
    the run of these copies: they are numbered anew, also in events and collisions, and totals are theirs.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> out = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]).run(t=1.0)
    >>> out.position.shape, out[1].position.shape
    ((2, 2, 2, 3), (2, 2, 3))
    >>> out[[1, 0]].energy[0, 1] == out.energy[1, 1], len(out[out.status == vv.Status.OK])
    (np.True_, 2)
    """

    __slots__ = ("_lines", "ensemble")

    _row_axes = ("copy", "time")
    ensemble: EnsembleScene
    _lines: dict[str, tuple[NDArray[np.intp], NDArray[np.intp]]]

    def __init__(self, ensemble: EnsembleScene, result: dict[str, Any]) -> None:
        from visviva.ensemble import EnsembleScene

        made_by(
            self, "the run of an ensemble, or visviva.load", ensemble=(ensemble, EnsembleScene), result=(result, dict)
        )
        super().__init__(result)
        object.__setattr__(self, "ensemble", ensemble)
        object.__setattr__(self, "_lines", {})

    def __len__(self) -> int:
        return len(self.ensemble)

    @overload
    def __getitem__(self, index: One) -> Trajectory: ...
    @overload
    def __getitem__(self, index: Some) -> EnsembleTrajectory: ...
    @overload
    def __getitem__(self, index: str) -> BodyMotion: ...
    def __getitem__(self, index: One | Some | str) -> Trajectory | EnsembleTrajectory | BodyMotion:
        if isinstance(index, str):
            return self.body(index)
        chosen = one_or_some(index, len(self))
        rows = rows_of(chosen)
        result = dict(self._result)
        for group in ("columns", "final", "per_trajectory"):
            result[group] = {name: values[rows] for name, values in self._result[group].items()}
        result["status"] = self.status[rows]
        for table in ("events", "collisions"):
            if table in self._result:
                result[table] = self._rows_of_copies(table, rows)
        own = ((name, each) for name, each in result["per_trajectory"].items() if name in result["stats"])
        # The sum of one number would take longer than all the rest.
        totals = {name: each.item() if len(each) == 1 else int(each.sum()) for name, each in own}
        result["stats"] = {**result["stats"], **totals}
        if isinstance(chosen, int):
            return Trajectory(self.ensemble[chosen], result)
        return EnsembleTrajectory(self.ensemble[chosen], result)

    def _rows_of_copies(self, table: str, rows: slice | NDArray[np.intp]) -> dict[str, NDArray[Any]]:
        """The lines of some copies in a table, where they are numbered anew."""
        found = self._result[table]
        if table not in self._lines:
            # All lines by copies, as they come in each, and where those of each begin: sought once, not for each copy.
            order = np.argsort(found["member"], kind="stable")
            self._lines[table] = order, np.searchsorted(found["member"][order], np.arange(len(self) + 1))
        order, begin = self._lines[table]
        if isinstance(rows, slice) and rows.step in (None, 1):
            first, last, _ = rows.indices(len(self))
            chosen = order[begin[first] : begin[max(first, last)]]
            return {name: array[chosen] for name, array in found.items()} | {"member": found["member"][chosen] - first}
        copies, lengths = np.arange(len(self))[rows], np.diff(begin)
        chosen = order[lines_of(lengths, copies)]
        number = np.repeat(np.arange(len(copies), dtype=np.int64), lengths[copies])
        return {name: array[chosen] for name, array in found.items()} | {"member": number}

    def _elsewhere(self, name: str) -> str:
        return f"; each copy has one: out[i].{name}" if hasattr(Trajectory, name) else super()._elsewhere(name)

    def __iter__(self) -> Iterator[Trajectory]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        copies = count(len(self), "copy", "copies")
        return f"EnsembleTrajectory({copies}, {count(len(self.t), 'time')}, {endings(self.status)})"

    def _sheet(self) -> Sheet:
        kinds = np.unique(self.status, return_counts=True)
        ended = ", ".join(f"{number} {Status(int(kind)).name}" for kind, number in zip(*kinds, strict=True))
        return self._run_sheet(f"Motions of {count(len(self), 'copy', 'copies')}", ended)

    @property
    def _start(self) -> EnsembleScene:
        return self.ensemble

    @property
    def _scene(self) -> Scene:
        return self.ensemble.scene

    def _found(self, name: str) -> NDArray[np.float64]:
        recorded: NDArray[np.float64] | None = self._result["columns"].get(name)
        # A copy's own property computes it, or says what to record.
        return np.stack([getattr(trajectory, name) for trajectory in self]) if recorded is None else recorded

    def _exported(self, columns: str | Sequence[str] | None) -> Columns:
        made = super()._exported(columns)
        return replace(made, of={**made.of, "status": (("copy",), self.status)})

    @property
    def status(self) -> NDArray[np.int8]:
        """How each copy ended, values of `Status`, shape (B,), without dimension.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> velocity = scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]
        >>> out = scene.ensemble(velocity=velocity).run(t=1.0)
        >>> out.status.tolist()
        [0, 0]
        """
        status: NDArray[np.int8] = self._result["status"]
        status.setflags(write=False)
        return status

    @property
    def per_trajectory(self) -> dict[str, NDArray[np.int64]]:
        """What each copy cost: ``steps``, ``evaluations``, …, each of shape (B,), numbers without dimension.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> velocity = scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]
        >>> out = scene.ensemble(velocity=velocity).run(t=1.0)
        >>> out.per_trajectory["steps"].shape
        (2,)
        """
        counts: dict[str, NDArray[np.int64]] = self._result["per_trajectory"]
        for each in counts.values():
            each.setflags(write=False)
        return dict(counts)

    @property
    def final(self) -> EnsembleScene:
        """The copies at the last time, ready to run on, with the bits of one long run as `Trajectory.final`.

        Raises
        ------
        visviva.InvalidInput
            If copies failed, were stopped or interrupted, so that they do not share a time; ``out[i].final`` works for
            each.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> velocity = scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]
        >>> out = scene.ensemble(velocity=velocity).run(t=1.0)
        >>> len(out.final), out.final.scene.t0
        (2, 1.0)
        """
        if self.status.any():
            which = np.flatnonzero(self.status)[:8].tolist()
            why = f"copies {which} failed, were stopped or interrupted, so the copies do not share a time"
            raise InvalidInput("final", f"{why}; use out[i].final")
        last = self._result["final"]
        own: dict[str, Any] = {name: last[name] for name in ("orientation", "angular_velocity") if name in last}
        first = {name: array[0] for name, array in own.items()}
        # Bodies of the scene may be rods that do not turn as those of the first copy, which has its own.
        shared = self.ensemble[0] if self.ensemble._inertia else self.ensemble.scene
        shared = shared.with_state(last["position"][0], last["velocity"][0], float(last["t"][0]), **first)
        mass, radius = last.get("mass", self.ensemble.mass), last.get("radius", self.ensemble.radius)
        state = {"position": last["position"], "velocity": last["velocity"]}
        own |= self.ensemble._inertia
        copies = self.ensemble._like(shared, **state, mass=mass, radius=radius, **own)
        return with_continuation(copies, continuation_after(self.ensemble._keywords, self._result))

    def conservation(self, about: ArrayLike | str | None = None) -> EnsembleConservation:
        """How well the invariants held in each copy: what `Trajectory.conservation` tells of one, of all.

        Units: those of the scene.

        Parameters
        ----------
        about : array_like, shape (3,), or "center_of_mass", optional
            Reference point of the angular momentum; the origin by default.

        Returns
        -------
        EnsembleConservation
            Drifts of each quantity, each number of shape (B,); it prints as a table of the worst.

        Raises
        ------
        visviva.InvalidInput
            If a quantity was neither recorded nor can be computed; the message says what to record.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> out = scene.ensemble(velocity=[scene.particles.velocity, 0.9 * scene.particles.velocity]).run(t=1.0)
        >>> bool((out.conservation().energy.max < 1e-13).all())
        True
        """
        from visviva.ensemble_conservation import conservation_of_copies

        return conservation_of_copies(self, about)

    def plot(
        self,
        column: ColumnName = "position",
        *,
        body: str | int | None = None,
        component: Literal["x", "y", "z", "w"] | None = None,
        kind: Literal["lines", "bands"] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """Draw a column of all copies against time, a panel for each component.

        The energy is drawn as its relative change in each copy; the picture says where that is no more than rounding.

        Parameters
        ----------
        column : str
            Which one: any that was recorded, or that follows from those.
        body : str or int, optional
            Of which body, where the column has one for each; the only one if not given.
        component : {"x", "y", "z", "w"}, optional
            One panel; all if not given.
        kind : {"lines", "bands"}, optional
            Every copy as a thin line, or bands that hold half and nine tenths of the copies about the median; by
            default lines of up to 60 copies and of energies that are noise, which are points, and else bands.
        ax : matplotlib.axes.Axes, optional
            Where, if there is one panel; a new figure if not given.

        Returns
        -------
        matplotlib.figure.Figure
            A new one, or that of `ax`. Copies that ended before are counted in the title, and not in bands after it.

        Raises
        ------
        visviva.InvalidInput
            If the column was not recorded and does not follow from those, it is not said of which of several bodies,
            matplotlib is not installed, or an argument is not one of these.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> slower = scene.particles.velocity * np.linspace(0.9, 1.0, 9)[:, None, None]
        >>> out = scene.ensemble(velocity=slower).run(t=np.linspace(0.0, 10.0, 101))
        >>> len(out.plot("position", body=1).axes), out.plot("energy").axes[0].get_ylabel()
        (3, '(E − E₀) / |E₀|')
        """
        from visviva._ensemble_plot import plot_ensemble

        return plot_ensemble(self, column, body, component, kind, ax)


def __dir__() -> list[str]:
    return list(__all__)
