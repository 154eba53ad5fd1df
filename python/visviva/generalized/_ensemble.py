"""Many copies of a system in generalized coordinates: `GeneralizedEnsemble`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, overload

import numpy as np

from visviva._arrays import float_array
from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva._some_copies import one_or_some
from visviva._text import count
from visviva.errors import ConvergenceError, Interrupted, InvalidInput
from visviva.generalized._consistency import projected, wants_projection
from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory
from visviva.generalized._resolved import warn_if_unresolved, warn_of_coarse_times
from visviva.generalized._runs import RTOL
from visviva.generalized._source import _label
from visviva.generalized._starts import is_beyond_domain

if TYPE_CHECKING:
    from collections.abc import Sequence

    import sympy
    from numpy.typing import ArrayLike, NDArray

    from visviva._some_copies import One, Some
    from visviva.generalized._system import GeneralizedSystem
    from visviva.integrators import Method
    from visviva.typing import Executor, GeneralizedEvent, GeneralizedMethodName, Progress

__all__ = ["GeneralizedEnsemble"]


@known_keywords
class GeneralizedEnsemble(Shown):
    """Copies of a system with starts or parameters of their own. Made by ``ensemble`` of a system.

    Attributes
    ----------
    system : GeneralizedSystem
        Whose copies they are.

    Indexing with a number gives the system of one copy. A slice, a list or array of numbers, or a mask of shape (B,)
    gives the ensemble of these copies, which may be taken more than once.

    Examples
    --------
    >>> import visviva as vv
    >>> many = vv.systems.pendulum().ensemble(position=[[0.1], [0.2]])
    >>> len(many), many[1].position, len(many[[1, 0, 1]])
    (2, array([0.2]), 3)
    """

    __slots__ = ("_parameters", "_states", "system")

    system: GeneralizedSystem
    _states: NDArray[np.float64]
    _parameters: NDArray[np.float64]

    def __init__(
        self,
        system: GeneralizedSystem,
        position: ArrayLike | None = None,
        second: ArrayLike | None = None,
        parameters: Mapping[str, ArrayLike] | Mapping[sympy.Symbol, ArrayLike] | None = None,
        consistent: Literal["project"] | None = None,
    ) -> None:
        from visviva.generalized._system import GeneralizedSystem

        made_by(self, "ensemble(...) of a Lagrangian or a Hamiltonian", system=(system, GeneralizedSystem))
        n = len(system.coordinates)
        sizes: dict[str, tuple[int, str]] = {}
        halves = [
            None if value is None else float_array(name, value, ("B", n), sizes)
            for name, value in (("position", position), (system._second_name, second))
        ]
        own: dict[str, NDArray[np.float64]] = {}
        if parameters is not None and not isinstance(parameters, Mapping):
            raise InvalidInput("parameters", f"expected values by name, {{name: values}}, got {parameters!r}")
        for key, value in (parameters or {}).items():
            name = _label(key)
            if name not in system.parameters:
                raise InvalidInput("parameters", f"there is no parameter {name!r}; there are {list(system.parameters)}")
            own[name] = float_array(f"parameters[{name!r}]", value, ("B",), sizes)
        if "B" not in sizes:
            raise InvalidInput(
                "position", f"expected position, {system._second_name} or parameters of the copies, got none"
            )
        members = sizes["B"][0]
        if not members:
            raise InvalidInput(sizes["B"][1], "expected at least one copy, got none")
        if halves[0] is None:
            halves[0] = np.tile(system._start()[:n], (members, 1))
        if halves[1] is None:
            halves[1] = np.tile(system._second, (members, 1))
        self.system = system
        self._states = np.concatenate([half for half in halves if half is not None], axis=1)
        self._parameters = np.tile(system._values, (members, 1))
        for name, values in own.items():
            self._parameters[:, list(system.parameters).index(name)] = values
        if wants_projection(consistent) and system._constraints():
            for member, values in enumerate(self._parameters):
                try:
                    self._states[member] = projected(system, self._states[member], values)
                except (InvalidInput, ConvergenceError) as error:
                    raise _of_copy(member, error) from None

    def __repr__(self) -> str:
        return f"GeneralizedEnsemble({count(len(self), 'copy', 'copies')} of {self.system!r})"

    def _sheet(self) -> Sheet:
        parameters = ", ".join(self.system.parameters)
        return Sheet(
            f"{count(len(self), 'copy', 'copies')} of a system", [("of", repr(self.system)), ("parameters", parameters)]
        )

    def __len__(self) -> int:
        return len(self._states)

    @overload
    def __getitem__(self, member: One) -> GeneralizedSystem: ...
    @overload
    def __getitem__(self, member: Some) -> GeneralizedEnsemble: ...
    def __getitem__(self, member: One | Some) -> GeneralizedSystem | GeneralizedEnsemble:
        n, chosen = len(self.system.coordinates), one_or_some(member, len(self))
        states = self._states[chosen]
        own = dict(zip(self.system.parameters, self._parameters[chosen].T, strict=True))
        if isinstance(chosen, int):
            return self.system._at(states[:n], states[n:], own)
        return GeneralizedEnsemble(self.system, states[:, :n], states[:, n:], own)

    def _beyond_domain(self) -> list[int]:
        """Give copies with numbers for rates at the start, but none for the energy or a momentum: no status tells."""
        model, t0 = self.system._model, np.full(len(self), self.system.t0)
        few = np.flatnonzero(is_beyond_domain(self.system, model.columns(t0, self._states, self._parameters)))
        if not few.size:
            return []
        rates = model.rates(t0[few], self._states[few], self._parameters[few])
        found: list[int] = few[np.isfinite(rates).all(axis=1)].tolist()
        return found

    def run(
        self,
        t: ArrayLike,
        *,
        method: GeneralizedMethodName | Method = "auto",
        rtol: float = RTOL,
        atol: float | ArrayLike | Mapping[str, ArrayLike] | None = None,
        dt: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        events: Sequence[GeneralizedEvent] | GeneralizedEvent = (),
        threads: int | None = None,
        progress: Progress = False,
        executor: Executor | None = None,
    ) -> GeneralizedEnsembleTrajectory:
        """Run all copies; each has the bits that it has alone.

        Units: those of the system.

        Parameters
        ----------
        t, method, rtol, atol, dt, max_step, max_steps, events, progress
            As in `GeneralizedSystem.run`. With `visviva.events.function` copies run on one thread.
        threads : int, optional
            Threads; all cores if not given. They change no bit.
        executor : concurrent.futures.Executor or dask.distributed.Client, optional
            Who runs them: parts of the copies go out, results come home, with the bits of the run without one. Each
            worker uses `threads` threads, or one. Not beside `visviva.events.function`.

        Returns
        -------
        GeneralizedEnsembleTrajectory
            With arrays of shape (B, T, n).

        Raises
        ------
        InvalidInput
            For what cannot be run, before anything runs.
        Interrupted
            By Ctrl-C; by an executor its ``.trajectory`` has the copies before the first that is not home, or is None.

        Warns
        -----
        AccuracyWarning
            As `GeneralizedSystem.run`, of the copy that is off by most.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> lengths = np.array([0.5, 1.0, 2.0])
        >>> many = vv.systems.pendulum(position=[0.5]).ensemble(parameters={"l": lengths})
        >>> many.run(t=5.0).energy.shape
        (3, 2)
        """
        asked, _ = self.system._asked(t, method, rtol, dt, max_step, max_steps, events, atol)
        # What is off its constraints would be put on them without a word; other starts tell by their status.
        for member in range(len(self)) if self.system._constraints() else (0, *self._beyond_domain()):
            try:
                self[member]._check_start()
            except InvalidInput as error:
                raise _of_copy(member, error) from None
        result = None
        if executor is not None:
            from visviva.generalized._copies_apart import run_apart

            result = run_apart(self, asked, executor, threads, progress)
        if result is None:
            result = self.system._run(asked, self._states, self._parameters, threads, progress)
        out = GeneralizedEnsembleTrajectory(self, result, asked)
        lasts = out._states[:, -1], float(out.t[-1])
        warn_of_coarse_times(self.system, asked, (self._states, lasts[0]), self._parameters)
        if result["interrupted"]:
            raise Interrupted("the ensemble was interrupted", out)
        try:
            warn_if_unresolved(self.system, asked, self._states, lasts, self._parameters, threads)
        except Interrupted as interrupted:
            interrupted.trajectory = out
            raise
        return out


def _of_copy(member: int, error: InvalidInput | ConvergenceError) -> InvalidInput | ConvergenceError:
    """Give the error of one copy, with its number."""
    message = f"copy {member}: {error.message}"
    if isinstance(error, InvalidInput):
        return InvalidInput(error.argument, message)
    return ConvergenceError(message, error.time)
