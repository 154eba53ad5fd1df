"""The table of the events that a run met: columns side by side, an event a line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar

import numpy as np

from visviva._arrays import whole_number
from visviva._attributes_elsewhere import OF_TABLES, no_attribute
from visviva._exported import ByColumns, Columns, chosen_columns, labels
from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from visviva.events import Event
    from visviva.typing import EventColumnName

__all__ = ["EventTable", "Lines"]

Name = TypeVar("Name", bound=str)

# What a table has beside its columns.
_ABOUT = ("definitions", "coordinates", "names")


@known_keywords
class Lines(ByColumns[Name], Shown):
    """Base of tables of events: columns, a line for each event, and what was looked for."""

    __slots__ = ()

    which: NDArray[np.int64]
    t: NDArray[np.float64]
    position: NDArray[np.float64]
    member: NDArray[np.int64]
    definitions: tuple[Event, ...]

    _row_axes = ("event",)

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_TABLES)

    @classmethod
    def _made(cls, found: dict[str, NDArray[Any]], **about: tuple[Any, ...]) -> Self:
        for array in found.values():
            array.setflags(write=False)
        table: Any = cls
        made: Self = table(**found, **about)
        return made

    @classmethod
    def _names(cls) -> list[str]:
        table: Any = cls
        return [name for name in table.__slots__ if name not in _ABOUT]

    def __len__(self) -> int:
        return len(self.t)

    def _sheet(self) -> Sheet:
        def row(at: int) -> tuple[str, ...]:
            which = int(self.which[at])
            kind = self.definitions[which].kind if which < len(self.definitions) else ""
            return (str(at), f"{self.t[at]:.6g}", f"{which} {kind}".rstrip(), str(self.member[at]))

        rows, note = first_rows(len(self), row)
        return Sheet(f"Events: {len(self)}", rows, ("", "t", "event", "copy"), note)

    def __getitem__(self, chosen: slice | ArrayLike) -> Self:
        if not isinstance(chosen, slice) and np.ndim(chosen) == 0:
            raise InvalidInput("index", f"expected a slice or an array, got {chosen!r}; use its columns, table.t[i]")
        try:
            picked: Any = chosen
            rows = np.arange(len(self))[picked]
        except (IndexError, TypeError, ValueError) as error:
            raise InvalidInput(
                "index", f"expected a slice, a mask or numbers of lines, got {chosen!r}: {error}"
            ) from None
        about = {name: getattr(self, name) for name in _ABOUT if hasattr(self, name)}
        return self._made({name: getattr(self, name)[rows] for name in self._names()}, **about)

    def __iter__(self) -> NoReturn:
        raise TypeError(f"an {type(self).__name__} is read by its columns: {', '.join(self._names())}")

    def of(self, which: int) -> Self:
        """The lines of one event.

        Parameters
        ----------
        which : int
            The event, as counted in ``events=``.

        Returns
        -------
        EventTable or GeneralizedEventTable
            As this one, each column of shape (K, …).

        Raises
        ------
        visviva.InvalidInput
            For what is no whole number.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> len(scene.run(t=20.0, events=[vv.events.apsis(1, 0, direction=1)]).events.of(0))
        3
        """
        return self[self.which == whole_number("which", which)]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class EventTable(Lines["EventColumnName"]):
    """The events of a run, in the order of the motion; of an ensemble, copy after copy.

    Units: those of the run.

    Attributes
    ----------
    which : ndarray of int64, shape (K,)
        Index in the ``events`` that were asked for.
    t : ndarray, shape (K,)
    position, velocity : ndarray, shape (K, N, 3)
        The state there. Bodies that are integrated apart from those that the event looks at are NaN: non-interacting
        ones, and massless ones beside an adaptive method.
    member : ndarray of int64, shape (K,)
        The copy of an ensemble; 0 of a single run.
    definitions : tuple of Event
        What was looked for, by `which`. Of a function its name alone, as of what is saved.
    names : tuple of str
        Those of the bodies, or none.

    Indexing with a slice or an array gives a smaller table; `of` that of one event. Tables are equal if all their
    columns are, NaN where NaN is, and what was looked for.

    References
    ----------
    Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.6 (event location).

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> table = scene.run(t=20.0, events=[vv.events.apsis(1, 0), vv.events.distance(0, 1, below=0.8)]).events
    >>> table.which.tolist(), table.of(1).t.shape, table.position.shape
    ([0, 1, 0, 0, 1, 0, 0, 1, 0], (3,), (9, 2, 3))
    """

    which: NDArray[np.int64]
    t: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    member: NDArray[np.int64]
    definitions: tuple[Event, ...]
    names: tuple[str, ...] = ()

    def plot(
        self, component: Literal["x", "y", "z"] | None = None, *, body: str | int | None = None, ax: Axes | None = None
    ) -> Axes:
        """Draw a body's place against its velocity at the events: of those of a plane, a Poincaré section of the run.

        Units: those of the run.

        Parameters
        ----------
        component : {"x", "y", "z"}, optional
            Which; by default that in which the places extend most.
        body : str or int, optional
            Of which body, by name or index; the only one if not given.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes
            A color for each copy of an ensemble, else for each event that was looked for; `of` gives those of one.

        Raises
        ------
        visviva.InvalidInput
            If there is no event, it is not said of which of several bodies, an argument is not one of these, or
            matplotlib is not installed.

        References
        ----------
        M. Hénon & C. Heiles, Astron. J. 69 (1964) 73.

        Examples
        --------
        A rosette about a cluster, where it passes x = 0 on its way to larger x:

        >>> import visviva as vv
        >>> star = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0]])
        >>> scene = vv.Scene(star, vv.CentralField(vv.potentials.Plummer(-1.0, 0.5)))
        >>> passes = vv.events.plane([0.0, 0.0, 0.0], normal=[1.0, 0.0, 0.0], direction=1)
        >>> scene.run(t=200.0, events=[passes]).events.plot("y").get_ylabel()
        'velocity, y'
        """
        from visviva._phase import plot_section

        return plot_section(self, component, body, ax)

    def _exported(self, columns: EventColumnName | Sequence[EventColumnName] | None) -> Columns:
        known = self._names()
        of = {
            name: (("event", *["body", "component"][: 2 * (getattr(self, name).ndim == 3)]), getattr(self, name))
            for name in chosen_columns(columns, known, known)
        }
        return Columns({"event": np.arange(len(self)), "body": labels(self.names, self.position.shape[1])}, of)

    def __repr__(self) -> str:
        return f"EventTable({len(self)} events, {self.position.shape[1]} bodies)"


def __dir__() -> list[str]:
    return list(__all__)
