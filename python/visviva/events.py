"""Events: what is looked for on the way of a run; the table of what was found is in `_event_table.py`.

`distance`, `plane`, `apsis`, `energy` and what an `expression` says of time, positions and velocities are compiled; any
other function may be given as it is, or by `function` with a direction and an end, and is asked in Python. Events are
located on the solution between the steps and change no bit of a run; one that is ``terminal`` ends it.

`coordinate` is of runs in generalized coordinates, which take `expression`, `energy` and `function`, too.

A zero counts where a function changes its sign. One at the start does not. Where a function comes near zero within a
step and turns, it is followed down: two zeros in one step are found. What a collision makes jump from one sign to the
other is an event at its time, with the state after it: energies, apsides, functions and expressions.

The state at a terminal event is on the far side of the zero, by a rounding. A run that goes on from there is away from
it and does not find it again; one whose velocity was turned round, to bounce, comes back through it at once, and finds
it as a zero the other way. So give an event its direction if runs go on from it (`plane` has an example).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number, positive
from visviva._event import Event, make_event
from visviva._event_arguments import body_of, check_two, point_of
from visviva._event_functions import check_event_function
from visviva._event_table import EventTable
from visviva._keywords import known_keywords, unknown_name
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    import sympy
    from numpy.typing import ArrayLike

    from visviva.typing import EventDirection, EventFunction, SymbolicExpression

__all__ = ["Event", "EventTable", "apsis", "coordinate", "distance", "energy", "expression", "function", "plane"]


@known_keywords
def distance(
    first: int | str, second: int | str, *, below: float, direction: EventDirection = -1, terminal: bool | int = False
) -> Event:
    """Two bodies come nearer to each other than a distance.

    Units: those of the run.

    Parameters
    ----------
    first, second : int or str
        Indices of the bodies, or their names.
    below : float
        The distance, above 0.
    direction : {1, -1, 0}, optional
        -1 where they come nearer, 1 where they part again, 0 for both.
    terminal : bool or int, optional
        Whether the run ends there, or with the zero of which number. What is run on from there with another velocity
        should have a `direction`: see `visviva.events`.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For a distance that is not positive, one body twice, or a direction or an end that is none of these. Whether
        the scene has the bodies is looked at when it is run.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> len(scene.run(t=20.0, events=[vv.events.distance(0, 1, below=0.8)]).events)
    3
    """
    length = positive("below", below)
    i, j = body_of("first", first), body_of("second", second)
    check_two("second", i, j)
    return make_event("distance", direction, terminal, first=i, second=j, distance=length)


@known_keywords
def plane(
    point: ArrayLike,
    normal: ArrayLike,
    *,
    body: int | str = 0,
    direction: EventDirection = 0,
    terminal: bool | int = False,
) -> Event:
    """A body passes a plane.

    Units: those of the run.

    Parameters
    ----------
    point, normal : array_like, shape (3,)
        A point of the plane, and its normal, of any length.
    body : int or str, optional
        Index of the body, or its name.
    direction : {1, -1, 0}, optional
        1 where the body passes the way of the normal in time, -1 against it, 0 for both.
    terminal : bool or int, optional
        As of `distance`.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For three numbers that are none, a normal of length 0, what is no body, or a direction or an end that is none
        of these. Whether the scene has the body is looked at when it is run.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> out = scene.run(t=20.0, events=[vv.events.plane([0, 0, 0], [0, 1, 0], body=1, direction=-1)])
    >>> bool(abs(out.events.position[:, 1, 1]).max() < 1e-12)
    True

    A ball that bounces, by a run for each flight: the way up, at the start of a flight, is no event.

    >>> floor = vv.events.plane([0, 0, 0], [0, 0, 1], direction=-1, terminal=True)
    >>> ball = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 5.0]]), vv.UniformField([0.0, 0.0, -10.0]))
    >>> hit = ball.run(t=10.0, events=[floor]).final
    >>> again = hit.with_state(velocity=-0.5 * hit.particles.velocity).run(t=10.0, events=[floor]).final
    >>> round(hit.t0, 9), round(again.t0, 9)
    (1.0, 2.0)
    """
    through, perpendicular = point_of("point", point), point_of("normal", normal)
    if not any(perpendicular):
        raise InvalidInput("normal", "expected a vector other than 0, got 0.0 in every component")
    return make_event("plane", direction, terminal, point=through, normal=perpendicular, body=body_of("body", body))


@known_keywords
def apsis(
    body: int | str, about: int | str | ArrayLike, *, direction: EventDirection = 0, terminal: bool | int = False
) -> Event:
    """The distance of a body from another one, or from a point at rest, is least or greatest: r·v = 0.

    A circle has no apsides, but rounding and the errors of steps take r·v from one sign to the other all the time. A
    zero after which it seems to come no further from zero than that (for an adaptive method, four times its tolerance:
    of orbits with an eccentricity below 4 `rtol`, of series below rtol/128) is not told. Where rounding alone makes an
    ellipse of the circle, two to a turn may be.

    Units: those of the run.

    Parameters
    ----------
    body : int or str
        Index of the body, or its name.
    about : int, str or array_like, shape (3,)
        Index or name of the other body, or the point.
    direction : {1, -1, 0}, optional
        1 for pericenters, -1 for apocenters, 0 for both, in runs forwards and backwards.
    terminal : bool or int, optional
        As of `distance`.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For one body twice, a point that is not three numbers, or a direction or an end that is none of these. Whether
        the scene has the bodies is looked at when it is run.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> len(scene.run(t=20.0, events=[vv.events.apsis(1, 0)]).events)
    6
    """
    whose = body_of("body", body)
    if np.ndim(about) == 0:
        focus: Any = body_of("about", about)
        check_two("about", whose, focus)
    else:
        focus = point_of("about", about)
    return make_event("apsis", direction, terminal, body=whose, about=focus)


@known_keywords
def coordinate(
    name: str | sympy.Expr, value: float = 0.0, *, direction: EventDirection = 0, terminal: bool | int = False
) -> Event:
    """A generalized coordinate passes a value.

    Units: those of the coordinate; angles in radians.

    Parameters
    ----------
    name : str or sympy.Function
        The coordinate, or its name. An angle is counted on beyond 2π.
    value : float, optional
        The value.
    direction, terminal : optional
        As of `plane` and `distance`: 1 where the coordinate rises in time.

    Returns
    -------
    Event
        For ``events=`` of a run in generalized coordinates. The table of what is found has a row for each: times of
        shape (K,).

    Raises
    ------
    visviva.InvalidInput
        For what is no name of a coordinate, a value that is no number, or a direction or an end that is none of these.
        Whether the system has the coordinate is looked at when it is run.

    Examples
    --------
    >>> import visviva as vv
    >>> swing = vv.systems.pendulum(position=[0.1])
    >>> swing.run(t=10.0, events=[vv.events.coordinate("theta", direction=1)]).events.t.round(3)
    array([1.505, 3.513, 5.52 , 7.527, 9.535])
    """
    if not isinstance(name, str) and not hasattr(name, "free_symbols"):
        raise InvalidInput("name", f"expected the name of a coordinate, got {type(name).__name__}")
    from visviva.generalized._source import _label

    return make_event("coordinate", direction, terminal, coordinate=_label(name), value=number("value", value))


@known_keywords
def expression(
    expression: sympy.Expr | Callable[..., SymbolicExpression],
    *,
    direction: EventDirection = 0,
    terminal: bool | int = False,
) -> Event:
    """An expression passes zero: of a scene's bodies, or of generalized coordinates.

    Units: those of the run.

    Parameters
    ----------
    expression : sympy.Expr or callable
        In a scene a function ``f(t, position, velocity)`` that is called once, with expressions in the place of
        numbers, in arrays of shape (N, 3); rows go by the names of bodies, too, ``position["Jupiter"]``. In generalized
        coordinates a function ``f(q, v, t, **parameters)``, as that of the system, of coordinates and velocities (of a
        Hamiltonian momenta), or an expression of SymPy.
    direction, terminal : optional
        As of `plane` and `distance`: 1 where the expression rises in time.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For what is neither an expression nor a function, or a direction or an end that is none of these; when it is
        run, for what the core does not know.

    Notes
    -----
    It may do arithmetic and take NumPy's functions, and must not branch: what must is for `function`, which costs ten
    times as much or more, on one thread. A result keeps what was compiled, so it can be looked for again.

    Examples
    --------
    A planet passes before its star, or behind it, seen along the y-axis:

    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> def transit(t, position, velocity):
    ...     return position[1, 0] - position[0, 0]
    >>> out = scene.run(t=20.0, events=[vv.events.expression(transit, direction=1)])
    >>> len(out.events), bool((out.events.position[:, 1, 1] < 0.0).all())
    (3, True)

    A pendulum turns over, and is as high as its support:

    >>> level = vv.events.expression(lambda q, v, t, l, **others: -l * np.cos(q[0]), direction=1, terminal=3)
    >>> out = vv.systems.pendulum(position=[0.1], velocity=[7.0]).run(t=10.0, events=[level])
    >>> len(out.events), bool(abs(np.cos(out.events.position)).max() < 1e-14), out.status.name
    (3, True, 'STOPPED')
    """
    if not callable(expression) and not hasattr(expression, "free_symbols"):
        came = f"f(t, position, velocity) or f(q, v, t), got {type(expression).__name__}"
        raise InvalidInput("expression", f"expected an expression of SymPy or a function {came}")
    return make_event("expression", direction, terminal, expression=expression)


@known_keywords
def energy(value: float, *, direction: EventDirection = 0, terminal: bool | int = False) -> Event:
    """The energy of all bodies passes a value: of use where a force takes or gives energy.

    Where all forces keep the energy, what changes of it are errors of the steps, told from node to node.

    In generalized coordinates it is that of the run: Jacobi's integral, or H.

    Units: those of the run.

    Parameters
    ----------
    value : float
        The energy.
    direction, terminal : optional
        As of `plane` and `distance`: 1 where the energy rises in time.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For a value that is no number, or a direction or an end that is none of these.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.events.energy(-0.5).parameters
    (('value', -0.5),)
    """
    return make_event("energy", direction, terminal, value=number("value", value))


@known_keywords
def function(call: EventFunction, *, direction: EventDirection = 0, terminal: bool | int = False) -> Event:
    """Your own function passes zero.

    It is called as ``call(t, position, velocity)``, with arrays of shape (N, 3), on the thread of the run, some ten
    times a step. What it raises ends the run. Its direction and end may be its attributes, too, as SciPy has them; the
    direction is that in time, also in a run backwards, where SciPy's is that along the run.

    Beside rigid bodies one that takes five arguments is called as ``call(t, position, velocity, orientation,
    angular_velocity)``, the last two of shapes (R, 4) and (R, 3), as results have them.

    In generalized coordinates it is called with coordinates and velocities (of a Hamiltonian momenta) of shape (n,). An
    `expression` is better where it is one: it is compiled, and no zero is missed there between two looks.

    Units: those of the run.

    Parameters
    ----------
    call : callable
        ``call(t, position, velocity)``, or with orientations and angular velocities after them, which gives a number;
        an event is where that passes zero.
    direction, terminal : optional
        As of `plane` and `distance`.

    Returns
    -------
    Event
        For ``events=`` of a run.

    Raises
    ------
    visviva.InvalidInput
        For what cannot be called with these, or a direction or an end that is none of these; by a run, for a function
        that takes orientations where there are no rigid bodies.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> def height(t, position, velocity):
    ...     return position[1, 1] - position[0, 1]
    >>> len(scene.run(t=20.0, events=[height]).events)
    6

    When a book that was thrown up is upside down:

    >>> book = vv.RigidBody(1.0, inertia=np.diag([1.0, 2.0, 2.5]), angular_velocity=[0.01, 2.0, 0.0])
    >>> def upright(t, position, velocity, orientation, angular_velocity):
    ...     return vv.rigid.rotate(orientation[0], [0.0, 1.0, 0.0])[1]
    >>> len(vv.Scene(book).run(t=40.0, events=[upright]).events)
    3
    """
    if not callable(call):
        raise InvalidInput("call", f"expected a function f(t, position, velocity), got {type(call).__name__}")
    check_event_function(call)
    return make_event("function", direction, terminal, function=call)


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
