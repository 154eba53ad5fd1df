"""The exceptions of visviva: what was asked, what came, and what to do.

Every class carries its facts as attributes, pickles with them, and derives from the built-in exception that a program
would catch anyway. All but `Interrupted` and the one warning derive from `Error` too: Ctrl-C is no error, and
``except Exception`` must not swallow it. The core raises these same classes.
"""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from typing import TYPE_CHECKING, Any, Never, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from visviva.ensemble_trajectory import EnsembleTrajectory
    from visviva.generalized import GeneralizedEnsembleTrajectory, GeneralizedTrajectory, PoincareSection
    from visviva.initial_value import OdeResult
    from visviva.scattering import FoilResult, MonteCarlo
    from visviva.trajectory import Trajectory

    SoFar: TypeAlias = (
        Trajectory | EnsembleTrajectory | GeneralizedTrajectory | GeneralizedEnsembleTrajectory | OdeResult | None
    )
    Counted: TypeAlias = MonteCarlo | FoilResult | PoincareSection | NDArray[np.float64] | None

__all__ = [
    "AccuracyWarning",
    "CloseEncounter",
    "ConvergenceError",
    "Error",
    "FrozenAttribute",
    "InternalError",
    "Interrupted",
    "InvalidInput",
    "MissingPackage",
    "UnknownKeyword",
    "WrongArguments",
]


class Error(Exception):
    """Base of every exception that visviva raises on purpose, but for `Interrupted`.

    Examples
    --------
    >>> import visviva as vv
    >>> try:
    ...     vv.problems.kepler(e=1.5)
    ... except vv.Error as error:
    ...     print(type(error).__name__)
    InvalidInput
    """


class InvalidInput(Error, ValueError):
    """An argument was refused before anything ran.

    Parameters
    ----------
    argument : str
        The name of the argument.
    message : str
        What was expected, what came, and what to do.

    Examples
    --------
    >>> import visviva.errors
    >>> try:
    ...     raise visviva.errors.InvalidInput("dt", "expected a positive number, got 0.0")
    ... except ValueError as error:
    ...     print(error.argument, "|", error)
    dt | dt: expected a positive number, got 0.0
    """

    def __init__(self, argument: str, message: str) -> None:
        super().__init__(argument, message)
        self.argument = argument
        self.message = message

    def __str__(self) -> str:
        return f"{self.argument}: {self.message}"


class UnknownKeyword(InvalidInput, TypeError):
    """A keyword that the function does not take; also the `TypeError` that Python itself would raise.

    Parameters
    ----------
    argument : str
        The keyword that came.
    message : str
        What the function takes, and the nearest name.

    Examples
    --------
    >>> import visviva as vv
    >>> try:
    ...     vv.Gravity(g=1.0)
    ... except vv.InvalidInput as error:
    ...     print(error)
    g: expected a keyword of Gravity (G, softening), got 'g'; did you mean 'G'?
    """


class WrongArguments(InvalidInput, TypeError):
    """Arguments that are missing, too many, or given twice; also the `TypeError` that Python itself would raise.

    Parameters
    ----------
    argument : str
        The argument that is missing or came twice; of too many the name of what was called.
    message : str
        What is taken, and in which order.

    Examples
    --------
    >>> import visviva as vv
    >>> try:
    ...     vv.potentials.Yukawa(1.0)
    ... except TypeError as error:
    ...     print(error)
    length: expected with every call of Yukawa (k, length), got none
    """


class FrozenAttribute(InvalidInput, FrozenInstanceError):
    """An attribute of something frozen was set or deleted; also the `AttributeError` that Python itself would raise.

    Parameters
    ----------
    argument : str
        The attribute.
    message : str
        How to get a changed one.

    Examples
    --------
    >>> import visviva as vv
    >>> gravity = vv.Gravity(G=1.0)
    >>> try:
    ...     gravity.softening = 0.1
    ... except vv.InvalidInput as error:
    ...     print(error)
    softening: a Gravity is frozen; make a changed one with dataclasses.replace(gravity, softening=…)
    """


class MissingPackage(InvalidInput, ImportError):
    """A package that only a part of visviva uses is not installed; also the `ImportError` that Python would raise.

    Parameters
    ----------
    argument : str
        What was called or given that needs it.
    message : str
        Which package, and how to get it.

    Examples
    --------
    >>> import visviva as vv
    >>> try:
    ...     raise vv.MissingPackage("to_pandas", "the package pandas is not installed: pip install 'visviva[pandas]'")
    ... except ImportError as error:
    ...     print(error)
    to_pandas: the package pandas is not installed: pip install 'visviva[pandas]'
    """


class ConvergenceError(Error, RuntimeError):
    """An iteration or the step-size control gave up, or `max_steps` were taken before the end.

    Parameters
    ----------
    message : str
        What gave up and why.
    time : float, optional
        The time it had reached, in the units of the scene.
    trajectory : Trajectory, optional
        What was computed until then.

    Examples
    --------
    >>> import visviva as vv
    >>> issubclass(vv.ConvergenceError, vv.Error), issubclass(vv.ConvergenceError, RuntimeError)
    (True, True)
    """

    def __init__(self, message: str, time: float | None = None, trajectory: SoFar = None) -> None:
        super().__init__(message, time, trajectory)
        self.message = message
        self.time = time
        self.trajectory = trajectory

    def __str__(self) -> str:
        return self.message if self.time is None else f"{self.message} (at t = {self.time})"


class CloseEncounter(Error, RuntimeError):
    """Two bodies came so close that the step fell to zero.

    Parameters
    ----------
    time : float
        The time of the encounter, in the units of the scene.
    bodies : (int, int)
        The two bodies, by index; equal when one body meets a fixed center.
    distance : float
        Their distance, in the units of the scene.
    trajectory : Trajectory, optional
        What was computed until then.

    Examples
    --------
    >>> import visviva as vv
    >>> together = vv.Particles([1.0, 1.0], [[-1, 0, 0], [1, 0, 0]])
    >>> try:
    ...     vv.Scene(together, vv.Gravity(1.0)).run(t=5.0, method="dop853")
    ... except vv.CloseEncounter as error:
    ...     print(error.trajectory.t[-1] < 5.0)
    True
    """

    def __init__(self, time: float, bodies: tuple[int, int], distance: float, trajectory: SoFar = None) -> None:
        super().__init__(time, bodies, distance, trajectory)
        self.time = time
        self.bodies = bodies
        self.distance = distance
        self.trajectory = trajectory

    def __str__(self) -> str:
        i, j = self.bodies
        names = getattr(getattr(self.trajectory, "_start", None), "_names", ())
        one, both = (names[i], f"{names[i]} and {names[j]}") if names else (f"body {i}", f"bodies {i} and {j}")
        who = f"{one} is {self.distance:g} from a fixed center" if i == j else f"{both} are {self.distance:g} apart"
        return f"the step size fell to zero at t = {self.time}: {who}; soften the force, or end the run before it"


class Interrupted(KeyboardInterrupt):
    """Ctrl-C stopped the run.

    A `KeyboardInterrupt` and nothing else: neither ``except Exception`` nor ``except visviva.Error`` catches it.

    Units: of what it holds, as of a run that was not interrupted.

    Parameters
    ----------
    message : str, optional
        What was stopped.
    trajectory : Trajectory, optional
        What was computed until then.
    result : MonteCarlo, FoilResult, PoincareSection or ndarray, shape (2n,), optional
        The events that a Monte Carlo counted until then, the points of a section, or the Lyapunov exponents of the
        motion up to then.

    Examples
    --------
    >>> import visviva as vv
    >>> issubclass(vv.Interrupted, KeyboardInterrupt), issubclass(vv.Interrupted, Exception)
    (True, False)
    """

    def __init__(self, message: str = "interrupted", trajectory: SoFar = None, result: Counted = None) -> None:
        super().__init__(message, trajectory, result)
        self.message = message
        self.trajectory = trajectory
        self.result = result

    def __str__(self) -> str:
        if self.result is not None:
            return f"{self.message}; .result holds what was found"
        return self.message if self.trajectory is None else f"{self.message}; .trajectory holds what was computed"


class AccuracyWarning(UserWarning):
    """A run came to its end, but resolved nothing: the energy at the end is not that of the start.

    The two are compared wherever that costs next to nothing beside the run: they may differ by a hundredth of kinetic +
    |potential|, and by 1e4 `rtol` after steps that follow it, which close passages multiply. What energies do not
    know of is looked at, too: orbits, and charges that `boris` turns, with fewer than six steps to a turn; and of
    Runge-Kutta methods the first step and one from the end, against two of half the length, as under drag and of
    massless bodies. The message names the figure and a step that would do. So are told a step longer than the run,
    a function among the events that gave NaN throughout, and a foil that is thinner than atoms are apart or than the
    way between two collisions.

    Examples
    --------
    >>> import warnings, visviva as vv
    >>> planets = vv.problems.outer_solar_system().scene
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     out = planets.run(t=1e5, method="leapfrog", dt=1e3)
    >>> caught[0].category is vv.AccuracyWarning
    True
    """


class InternalError(Error, RuntimeError):
    """A broken promise of visviva itself; please report it with the scene that shows it.

    Parameters
    ----------
    message : str
        What broke.

    Examples
    --------
    >>> import visviva as vv
    >>> issubclass(vv.InternalError, vv.Error)
    True
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message

    def __str__(self) -> str:
        return f"{self.message}; this is a defect of visviva, please report it with what you ran"


def _ended_early(error: dict[str, Any], trajectory: Any) -> BaseException:
    """What a run that ended early raises, with what was computed; `error` is as the core tells it."""
    if error["kind"] == "close_encounter":
        first, second = error["bodies"]
        return CloseEncounter(error["time"], (first, second), error["distance"], trajectory)
    if error["kind"] == "interrupted":
        return Interrupted(error["message"], trajectory)
    return ConvergenceError(error["message"], error["time"], trajectory)


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:

    def __getattr__(name: str) -> Never:
        if name.startswith("_"):
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from visviva._keywords import unknown_name  # which imports the errors itself

        unknown_name(__name__, __all__)(name)
