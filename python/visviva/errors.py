"""The exceptions of visviva: what was asked, what came, and what to do.

Every class derives from `Error` and from the built-in exception that a program would catch anyway, carries its facts
as attributes, and pickles with them. The core raises these same classes.
"""

from typing import Any

__all__ = [
    "CloseEncounter",
    "ConvergenceError",
    "Error",
    "InternalError",
    "Interrupted",
    "InvalidInput",
    "UnknownKeyword",
]


class Error(Exception):
    """Base of every exception that visviva raises on purpose."""


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


class ConvergenceError(Error, RuntimeError):
    """An iteration or the step-size control gave up.

    Parameters
    ----------
    message : str
        What gave up and why.
    time : float, optional
        The time it had reached, in the units of the scene.
    trajectory : Trajectory, optional
        What was computed until then.
    """

    def __init__(self, message: str, time: float | None = None, trajectory: Any = None) -> None:
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
        The two bodies, by index; equal when one body meets a fixed centre.
    distance : float
        Their distance, in the units of the scene.
    trajectory : Trajectory, optional
        What was computed until then.
    """

    def __init__(self, time: float, bodies: tuple[int, int], distance: float, trajectory: Any = None) -> None:
        super().__init__(time, bodies, distance, trajectory)
        self.time = time
        self.bodies = bodies
        self.distance = distance
        self.trajectory = trajectory

    def __str__(self) -> str:
        i, j = self.bodies
        who = (
            f"body {i} is {self.distance:g} from a fixed centre"
            if i == j
            else f"bodies {i} and {j} are {self.distance:g} apart"
        )
        return (
            f"the step size fell to zero at t = {self.time}: {who}; "
            "soften the force, or use a fixed step that passes over the encounter"
        )


class Interrupted(Error, KeyboardInterrupt):
    """Ctrl-C stopped the run.

    Like `KeyboardInterrupt` it should end a program, but as an `Error` it is also an `Exception`.

    Parameters
    ----------
    message : str, optional
        What was stopped.
    trajectory : Trajectory, optional
        What was computed until then.
    result : MonteCarlo, optional
        The events that a Monte Carlo counted until then.
    """

    def __init__(self, message: str = "interrupted", trajectory: Any = None, result: Any = None) -> None:
        super().__init__(message, trajectory, result)
        self.message = message
        self.trajectory = trajectory
        self.result = result

    def __str__(self) -> str:
        if self.result is not None:
            return f"{self.message}; .result holds what was counted"
        return self.message if self.trajectory is None else f"{self.message}; .trajectory holds what was computed"


class InternalError(Error, RuntimeError):
    """A broken promise of visviva itself; please report it with the scene that shows it.

    Parameters
    ----------
    message : str
        What broke.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message

    def __str__(self) -> str:
        return f"{self.message}; this is a defect of visviva, please report it with what you ran"
