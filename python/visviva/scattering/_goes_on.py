"""What results of events have in common that go on and are kept in files: those of `monte_carlo` and of `Foil`."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, Self

from visviva._files import write
from visviva._keywords import known_keywords
from visviva._paths import path_text
from visviva.errors import Interrupted, InvalidInput

if TYPE_CHECKING:
    from os import PathLike

    from visviva.typing import Executor, Progress

__all__ = ["GoesOn"]


@known_keywords
class GoesOn:
    """Base of results that the next events may be added to, and that a file can hold."""

    events: tuple[tuple[int, int, int], ...]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            # What is unpickled has no tallies yet.
            tallies = () if name.startswith("_") else vars(self).get("tallies", ())
            there = next((repr(tally.name) for tally in tallies if name == tally.name or hasattr(tally, name)), "")
            own = f"; it is result[{there}]" if there == repr(name) else f"; each tally has one: result[{there}].{name}"
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}{own if there else ''}", name=name, obj=self
            )

    @property
    def next_event(self) -> int:
        """The ``first_event`` of a run that goes on after this one.

        Raises
        ------
        InvalidInput
            If the events are of several seeds.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run.next_event
        1000
        """
        if len({seed for seed, _, _ in self.events}) > 1:
            raise InvalidInput("next_event", "expected events of one seed, got several; see .events")
        return self.events[-1][2]

    def resume(
        self, n_events: int, *, threads: int | None = None, progress: Progress = False, executor: Executor | None = None
    ) -> Self:
        """Go on with the next ``n_events``: the same bits as one run of them all.

        Parameters
        ----------
        n_events : int
            How many more, from `next_event` on.
        threads, progress, executor
            As of `monte_carlo`.

        Returns
        -------
        MonteCarlo or FoilResult
            Of all events.

        Raises
        ------
        InvalidInput
            As `next_event` and the run.
        Interrupted
            As the run: its ``.result`` begins with this one.

        Examples
        --------
        >>> import visviva as vv
        >>> beam = dict(beam_energy=1.0, masses=(1.0, 4.0), b_max=2.0, seed=1)
        >>> part = vv.scattering.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), n_events=600, **beam)
        >>> part.resume(400) == vv.scattering.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), n_events=1000, **beam)
        True
        """
        own: Any = self
        try:
            whole: Self = own + self._again(n_events, threads, progress, executor)
        except Interrupted as stopped:
            stopped.result = own if stopped.result is None else own + stopped.result
            raise
        return whole

    def save(self, path: str | PathLike[str]) -> None:
        """Write the result to a ``.npz`` file; `load` reads it, and so does `visviva.load`.

        Parameters
        ----------
        path : path-like
            Written exactly as given; the file appears whole or not at all.

        Raises
        ------
        visviva.InvalidInput
            For what is no path.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile, visviva as vv
        >>> run = vv.scattering.Foil("gold", 0.1).run("alpha", beam_energy=5e6, n_events=100, seed=1)
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "counts.npz"
        >>> run.save(path)
        >>> vv.load(path) == run
        True
        """
        path_text("path", path)  # before anything is gathered
        write(path, *self._kept())

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a file that `save` wrote.

        Parameters
        ----------
        path : path-like
            The file, exactly as named.

        Returns
        -------
        MonteCarlo or FoilResult
            With the counts, the bins and the potential or the foil that were saved.

        Raises
        ------
        InvalidInput
            If the file is none that `save` wrote, is damaged, or was written by a later version.
        FileNotFoundError
            If there is no such file.

        Examples
        --------
        >>> import pathlib, tempfile, visviva as vv
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "counts.npz"
        >>> result = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> result.save(path)
        >>> vv.scattering.MonteCarlo.load(path) == result
        True
        """
        from visviva.io import load

        found = load(path)
        if not isinstance(found, cls):
            raise InvalidInput(
                "path", f"expected a {cls.__name__}, but {str(path)!r} holds a {type(found).__name__}; see visviva.load"
            )
        return found

    @abstractmethod
    def _again(self, n_events: int, threads: int | None, progress: Progress, executor: Executor | None) -> Self:
        """The next events."""

    @abstractmethod
    def _kept(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Header and arrays of a file."""
