"""What the run of an ensemble in generalized coordinates gives: `GeneralizedEnsembleTrajectory`.

The one idea: arrays of all copies over the same times, of which ``out[i]`` is the trajectory of one. What a copy does
not have, after it failed or an event ended it, is NaN.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from visviva._endings import endings
from visviva._exported import Columns, Exported
from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva._some_copies import one_or_some
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.generalized._columns import StateColumns, exported
from visviva.generalized._rows import result_of_copies, rows_of_copies
from visviva.generalized._saved import Saved
from visviva.generalized._stats import GeneralizedStats
from visviva.generalized._trajectory import STATUS, GeneralizedTrajectory
from visviva.status import Status
from visviva.typing import GeneralizedColumnName

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva._some_copies import One, Some
    from visviva.generalized._ensemble import GeneralizedEnsemble
    from visviva.generalized._events import GeneralizedEventTable
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["GeneralizedEnsembleTrajectory"]


@known_keywords
class GeneralizedEnsembleTrajectory(Exported[GeneralizedColumnName], StateColumns, Saved, Shown):
    """The motions of an ensemble.

    Units: those of the system, which are those of its parameters; angles in radians.

    Attributes
    ----------
    ensemble : GeneralizedEnsemble
    t : ndarray, shape (T,)
    position, velocity, momentum : ndarray, shape (B, T, n)
        NaN from where a copy failed, or an event ended it.
    energy : ndarray, shape (B, T)
    status : ndarray of Status, shape (B,)
    steps, evaluations : ndarray of int, shape (B,)

    ``out[i]`` is the trajectory of one copy, ``out[name]`` a coordinate of all of them, shape (B, T). A slice, a list
    or array of numbers, or a mask (B,) gives the run of these copies: they are numbered anew, also in events, and
    totals are theirs.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0)
    >>> out.position.shape, out[1].position.shape, out["theta"].shape
    ((2, 2, 1), (2, 1), (2, 2))
    >>> out[[1, 0]].position.shape, len(out[out.energy[:, 0] > -9.7])
    ((2, 2, 1), 1)
    """

    __slots__ = ("_asked", "_columns", "_result", "_states", "ensemble", "evaluations", "status", "steps", "t")

    def __init__(self, ensemble: GeneralizedEnsemble, result: dict[str, Any], asked: dict[str, Any]) -> None:
        from visviva.generalized._ensemble import GeneralizedEnsemble

        made_by(
            self,
            "the run of an ensemble of a Lagrangian or a Hamiltonian",
            ensemble=(ensemble, GeneralizedEnsemble),
            result=(result, dict),
            asked=(asked, dict),
        )
        self.ensemble = ensemble
        self.t: NDArray[np.float64] = asked["outputs"]
        self._result = result
        self._asked = asked
        self.status = np.array([STATUS[ending] for ending in result["endings"]])
        self.steps = np.array(result["steps"])
        self.evaluations = np.array(result["evaluations"])
        self._states = rows_of_copies(result, len(self.t))
        for array in (self._states, self.t, self.status, self.steps, self.evaluations):
            array.flags.writeable = False
        self._columns: NDArray[np.float64] | None = None

    def __repr__(self) -> str:
        copies = count(len(self), "copy", "copies")
        return f"GeneralizedEnsembleTrajectory({copies}, {count(len(self.t), 'time')}, {endings(self.status)})"

    def _sheet(self) -> Sheet:
        span = f", {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else ""
        ended, numbers = np.unique([Status(each).name for each in self.status], return_counts=True)
        rows = [
            ("of", repr(self.ensemble.system)),
            ("times", f"{len(self.t)}{span}"),
            ("steps", f"{self.steps.sum()}; {self.evaluations.sum()} evaluations"),
            ("ended", ", ".join(f"{number} {name}" for name, number in zip(ended, numbers, strict=True))),
        ]
        return Sheet(f"Motions of {count(len(self), 'copy', 'copies')} in generalized coordinates", rows)

    def __len__(self) -> int:
        return len(self.status)

    @overload
    def __getitem__(self, member: str) -> NDArray[np.float64]: ...
    @overload
    def __getitem__(self, member: One) -> GeneralizedTrajectory: ...
    @overload
    def __getitem__(self, member: Some) -> GeneralizedEnsembleTrajectory: ...
    def __getitem__(
        self, member: One | Some | str
    ) -> GeneralizedTrajectory | GeneralizedEnsembleTrajectory | NDArray[np.float64]:
        if isinstance(member, str):
            coordinates = self.ensemble.system.coordinates
            if member not in coordinates:
                raise self._no_coordinate(member)
            return self.position[..., coordinates.index(member)]
        chosen = one_or_some(member, len(self))
        if isinstance(chosen, int):
            return GeneralizedTrajectory(self.ensemble[chosen], self._result, self._asked, chosen)
        part = result_of_copies(self._result, np.arange(len(self))[chosen])
        return GeneralizedEnsembleTrajectory(self.ensemble[chosen], part, self._asked)

    def _elsewhere(self, name: str) -> str:
        one = hasattr(GeneralizedTrajectory, name) or name == "method"
        return f"; each copy has one: out[i].{name}" if one else super()._elsewhere(name)

    @property
    def _whose(self) -> GeneralizedSystem:
        return self.ensemble.system

    def _column(self, first: int, last: int | None) -> NDArray[np.float64]:
        if self._columns is None:
            members, times, numbers = self._states.shape
            parameters = np.repeat(self.ensemble._parameters, times, axis=0)
            model = self.ensemble.system._model
            flat = model.columns(np.tile(self.t, members), self._states.reshape(-1, numbers), parameters)
            self._columns = flat.reshape(members, times, -1)
            self._columns.flags.writeable = False
        return self._columns[..., first:last]

    _row_axes = ("copy", "time")

    def _exported(self, columns: str | Sequence[str] | None) -> Columns:
        made = exported(self, columns, self._row_axes, self.ensemble.system.coordinates)
        status = (("copy",), self.status.astype(np.int8))
        axes = {**made.axes, "copy": np.arange(len(self))}
        return Columns(axes, {**made.of, "status": status}, {"method": self._asked["method"]})

    @property
    def stats(self) -> GeneralizedStats:
        """What the run cost, all copies together.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0)
        >>> out.stats.steps - int(out.steps.sum())
        0
        """
        result = self._result
        longest = max(result["longest_step"])
        return GeneralizedStats(sum(result["steps"]), sum(result["evaluations"]), longest, self._asked["method"])

    def conservation(self) -> dict[str, NDArray[np.float64]]:
        """The largest change of what is conserved in each copy: what `GeneralizedTrajectory.conservation` tells of one.

        Units: changes are relative, without dimension.

        Returns
        -------
        dict of str to ndarray, shape (B,)
            NaN of a copy that ended before its first row.

        Examples
        --------
        >>> import visviva as vv
        >>> changes = vv.systems.pendulum().ensemble(position=[[0.1], [3.0]]).run(t=10.0).conservation()
        >>> list(changes), changes["energy"].shape, bool(changes["energy"].max() < 1e-13)
        (['energy'], (2,), True)
        """
        each = [self[copy].conservation() for copy in range(len(self))]
        conserved = self.ensemble.system.conserved
        return {name: np.array([changes.get(name, np.nan) for changes in each]) for name in conserved}

    @property
    def events(self) -> GeneralizedEventTable:
        """The events that were found, copy after copy, each column of shape (K, …); ``out[i].events`` are those of one.

        Raises
        ------
        InvalidInput
            If none were looked for.

        Examples
        --------
        >>> import visviva as vv
        >>> many = vv.systems.pendulum().ensemble(position=[[0.1], [3.0]])
        >>> many.run(t=4.0, events=["theta"]).events.member
        array([0, 0, 0, 0, 1, 1])
        """
        from visviva.generalized._events import found_events

        system, looked_for = self.ensemble.system, self._asked["looked_for"]
        return found_events(system, self._result, looked_for, self.ensemble._parameters)

    @property
    def final(self) -> GeneralizedEnsemble:
        """The copies at the last time, ready to run on.

        Raises
        ------
        InvalidInput
            If copies failed, were stopped or interrupted, so that they do not share a time; ``out[i].final`` works for
            each.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(t=1.0)
        >>> len(out.final), out.final.system.t0
        (2, 1.0)
        """
        if self.status.any():
            which = np.flatnonzero(self.status)[:8].tolist()
            why = f"copies {which} failed, were stopped or interrupted, so the copies do not share a time"
            raise InvalidInput("final", f"{why}; use out[i].final")
        lasts = [self[member]._last for member in range(len(self))]
        states, n = np.array([state for _, state in lasts]), len(self.ensemble.system.coordinates)
        # The start that other copies of it would have is that of the first, as in scenes: where it was is long past.
        system = self.ensemble.system._at(states[0, :n], states[0, n:], t0=lasts[0][0])
        own = dict(zip(system.parameters, self.ensemble._parameters.T, strict=True))
        return type(self.ensemble)(system, states[:, :n], states[:, n:], own)

    def plot(
        self,
        column: Literal["position", "velocity", "momentum", "energy"] = "position",
        *,
        coordinate: str | None = None,
        kind: Literal["lines", "bands"] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """Draw a column of all copies against time, a panel for each coordinate.

        The energy is drawn as its relative change in each copy; the picture says where that is no more than rounding.

        Parameters
        ----------
        column : {"position", "velocity", "momentum", "energy"}
            Which one.
        coordinate : str, optional
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
        InvalidInput
            For a column or a coordinate that is not there, axes for several panels, a run without times, or if
            matplotlib is not installed.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> many = vv.systems.pendulum().ensemble(position=np.linspace(0.1, 3.0, 100)[:, None])
        >>> figure = many.run(t=np.linspace(0.0, 10.0, 201)).plot()
        >>> figure.axes[0].get_title("left"), figure.axes[0].get_ylabel()
        ('100 copies', 'theta')
        """
        from visviva._ensemble_plot import plot_generalized

        return plot_generalized(self, column, coordinate, kind, ax)
