"""Forces of one's own in scenes, as expressions: `ExpressionForce`.

The one idea: what is written here is only a table of nodes; the core derives, compiles and runs it, for eight bodies at
once, beside any other force.
"""

from __future__ import annotations

import inspect
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from visviva import _core, _expression_table
from visviva._keywords import check_call, known_keywords, takes
from visviva._parameter import NOT_NONE
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce
from visviva.generalized._nodes import Nodes, not_compiled
from visviva.generalized._source import calls, placed_arguments, refuse_other_arguments
from visviva.generalized._symbolic import Symbols, sympy, time

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from visviva.typing import Formula, ParameterValues, SymbolicExpression

    _Components = Sequence[SymbolicExpression] | Callable[..., Sequence[SymbolicExpression]]
    _Argument = Literal["potential", "force", "acceleration"]

__all__ = ["ExpressionForce", "check_units", "formula_of", "parameter_names"]

_PLACES = ("x", "y", "z")
_VELOCITIES = ("vx", "vy", "vz")
_STATE = ("position", "velocity", "t")
#: Second arguments that are velocities even with a default.
_OF_VELOCITY = ("v", "velocity", "_", "_v", "_velocity")
_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@known_keywords
def ExpressionForce(  # noqa: N802  (it stands among classes of forces, and makes one)
    *,
    potential: Formula | None = None,
    force: _Components | None = None,
    acceleration: _Components | None = None,
    parameters: ParameterValues | None = None,
    bodies: int | str | Sequence[int | str] | NDArray[np.int64] | None = None,
) -> ExpressedForce:
    """A force on every body of a scene, or on some, from an expression, at the speed of the forces that visviva has.

    Parameters
    ----------
    potential : sympy.Expr or callable, optional
        The potential energy V of a body, of its place and the time. The force is −∇V, derived exactly.
    force : sequence of three expressions, or callable that gives three, optional
        The components of the force on a body, of its place, its velocity and the time. Its work is in no energy that is
        told: where it has a potential, give that.
    acceleration : sequence of three expressions, or callable that gives three, optional
        Those of the force for each unit of mass, which acts on massless bodies, too.
    parameters : mapping of symbol or str to float, optional
        The values of what else stands in the expressions. Copies of an ensemble may have their own, by these names.
    bodies : int or str, or array_like of them, shape (M,), optional
        The bodies on which it acts, by index or name; all if not given, or None, as the force's own `bodies` is then.
        With ``collisions="merge"`` an acceleration acts on those of them that remain.

    Returns
    -------
    ExpressedForce
        Frozen, hashable, picklable; a part of a scene like any other force.

    Raises
    ------
    visviva.InvalidInput
        If not one of `potential`, `force` and `acceleration` is given; for a symbol without a value; for a potential
        that depends on velocities; for what the core does not know, with what it knows.

    Notes
    -----
    Expressions of SymPy are of the symbols ``x``, ``y``, ``z``, ``vx``, ``vy``, ``vz``, ``t``, whatever they assume.
    Functions are called once with ``(position, velocity, t, **parameters)``, with expressions in the place of numbers:
    arithmetic and NumPy's functions, and no branches. A potential may leave out what it has nothing to do with:
    ``(position, t, **parameters)``, where the second is called ``t`` or ``time``, and ``(position, **parameters)``.
    Other arguments with a default keep it, ``lambda r, k=2.0: k * r[0] ** 2``, unless `parameters` has a value of that
    name; copies of an ensemble differ in what `parameters` has.
    All numbers are in the units of the scene; ``t`` is its own time.
    A wall, a bump or a pulse may be narrower than a step: methods that choose their steps look for those of ``exp`` and
    what is written with it (``tanh``, ``cosh``), for what falls as the square or more steeply, and for tents and boxes
    that are made of absolute values, and shorten steps there. Equal steps (`dt`) end the run before such a one, by a
    `ConvergenceError`: take a shorter `dt`.
    Far from zero times are numbers that lie apart, 2.4e-7 near 1.7e9, and what changes fast from one to the next is not
    known better (an `AccuracyWarning` says so): count time from the start of the run. Places and velocities are those
    of the scene, too: air about a body that moves is not at rest in them.
    A potential without time in it is conserved together with the kinetic energy. ``auto`` takes ``taylor`` where a
    series tells all of a formula: of polynomials, sines and cosines, also of the time. Other functions of the time have
    no series.

    References
    ----------
    A. Griewank & A. Walther, *Evaluating Derivatives* (2008), for the derivatives.

    Examples
    --------
    A quartic trap beside gravity:

    >>> import numpy as np, visviva as vv
    >>> trap = vv.ExpressionForce(potential=lambda r, k: k * (r[0] ** 2 + r[1] ** 2) ** 2, parameters={"k": 0.25})
    >>> scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), trap, vv.UniformField([0.0, 0.0, -1.0]))
    >>> out = scene.run(t=2.0, rtol=1e-12)
    >>> print(f"{out.position[-1, 0, 2]:.6f}", bool(np.ptp(out.energy) < 1e-11))
    -2.000000 True

    A drag on the planet alone, however massless it is:

    >>> thin = vv.ExpressionForce(acceleration=lambda r, v, t: [-0.01 * each for each in v], bodies="planet")
    >>> bodies = vv.Particles([1.0, 0.0], [[0, 0, 0], [1.0, 0, 0]], [[0, 0, 0], [0, 1.0, 0]], names=["star", "planet"])
    >>> out = vv.Scene(bodies, vv.Gravity(G=1.0), thin).run(t=10.0)
    >>> print(f"{np.linalg.norm(out.position[-1, 1]):.3f}")
    0.806
    """
    given: dict[_Argument, Any] = {"potential": potential, "force": force, "acceleration": acceleration}
    named = [name for name, value in given.items() if value is not None]
    if len(named) != 1:
        came = " and ".join(named) or "none of them"
        raise InvalidInput("potential", f"expected one of potential, force and acceleration, got {came}")
    names, values = _expression_table.checked_parameters(parameters, (*_PLACES, *_VELOCITIES, "t"))
    nodes = Nodes()
    if bodies is not None and np.size(bodies) == 0:
        raise InvalidInput("bodies", NOT_NONE)
    argument = named[0]
    components = given[argument]
    roots = (_of_state(components, names),) if argument == "potential" else _components(argument, components, names)
    found = [_node(argument, root, nodes, names) for root in roots]
    table = _expression_table.table(nodes, found, names)
    expressed = ExpressedForce(argument, table, values, *_AXES, bodies=bodies)
    # Which compiles it: whatever is wrong with it is refused here. What bodies are called only a scene knows.
    _core.acts_between(replace(expressed, bodies=None)._to_core())
    return expressed


def _of_state(potential: Any, names: tuple[str, ...]) -> Any:
    """Give a potential that takes the place alone, or place and time, as a function of the state."""
    if not callable(potential) or hasattr(potential, "free_symbols"):
        return potential
    function = not_compiled(potential)
    placed = [each for each in placed_arguments(function) if each.name not in names]
    second = placed[1].name if len(placed) > 1 else ""
    if placed and (placed[0].name, second) == ("x", "y"):
        return potential  # which is refused by name
    # A potential has nothing to do with velocities: what has a default is no place for one, whatever comes after it.
    keeps = second not in _OF_VELOCITY and len(placed) > 1 and placed[1].default is not inspect.Parameter.empty
    if second in ("t", "time") and takes(function, _STATE[::2], names):
        step = 2
    elif not keeps and takes(function, _STATE, names):
        return potential
    elif takes(function, _STATE[:1], names):
        _refuse_time_elsewhere(function, names)
        step = len(_STATE)
    else:
        return potential

    def of_state(*state: Any, **own: Any) -> Any:
        return function(*state[::step], **own)

    # What errors in it are told to come from.
    of_state.__qualname__ = getattr(function, "__qualname__", type(function).__qualname__)
    return of_state


def _refuse_time_elsewhere(function: Callable[..., Any], names: tuple[str, ...]) -> None:
    """Refuse a time that a function of the place has a default for: it would stand still."""
    for name in ("t", "time"):
        if name in inspect.signature(function).parameters and name not in names:
            raise InvalidInput(
                "potential",
                f"expected the time in the second or the third place, f(r, {name}) or f(r, v, {name}), and names of "
                f"parameters after it, got {name} elsewhere",
            )


def _components(argument: str, given: Any, names: tuple[str, ...]) -> tuple[Any, ...]:
    """Give three expressions: those of a sequence, or functions that give one component each."""
    if callable(given):
        refuse_other_arguments(argument, given, "velocity", names)
        check_call(argument, given, _STATE, names)
        return tuple(_one_of(argument, not_compiled(given), c) for c in range(3))
    if isinstance(given, str) or not hasattr(given, "__len__") or len(given) != 3:
        raise InvalidInput(argument, f"expected three components, or a function that gives them, got {given!r}")
    return tuple(given)


def _one_of(argument: str, function: Callable[..., Any], which: int) -> Callable[..., Any]:
    # Without a name of its own among the arguments: those of parameters may be any.
    return lambda *state, **own: _component(argument, function(*state, **own), which)


def _component(argument: str, components: Any, which: int) -> Any:
    try:
        three = tuple(components)
    except TypeError:
        three = ()
    if len(three) != 3:
        raise InvalidInput(argument, f"expected three components of the function, got {components!r}")
    return three[which]


def _node(argument: str, expression: Any, nodes: Nodes, names: tuple[str, ...]) -> int:
    """Give the node of one expression, of SymPy or a function."""
    if not hasattr(expression, "free_symbols"):
        return calls(nodes, _PLACES, names, "velocity")(argument, expression)
    sp = sympy(argument)
    # Symbols go by their names: what is assumed of them makes others of them.
    found = {symbol.name: symbol for symbol in expression.free_symbols}
    plain = {found[name]: sp.Symbol(name) for name in (*_PLACES, *_VELOCITIES, "t", *names) if name in found}
    known = [[sp.Symbol(name) for name in group] for group in (_PLACES, _VELOCITIES, names)]
    plain.pop(time._sympy_(), None)
    return Symbols(nodes, *known).node(argument, expression.xreplace(plain))


def check_units(force: ExpressedForce) -> None:
    """Refuse units of the expressions in which a force or a speed of 1 is none in those of the scene.

    Raises
    ------
    InvalidInput
        With the unit of force, mass · length / time², as it would be.
    """
    length, mass, time = np.float64(force.length), np.float64(force.mass), np.float64(force.time)
    with np.errstate(all="ignore"):
        # As the core has it: what overflows on the way is lost there, too.
        unit = mass * length / (time * time)
        others = np.array([unit, 1.0 / unit, length / time, time / length, 1.0 / length, 1.0 / time])
    if not (np.isfinite(others).all() and (others >= np.finfo(np.float64).tiny).all()):
        raise InvalidInput(
            "length",
            "expected units of length, mass and time in which forces, mass · length / time², and speeds of the "
            f"expressions stay within float64, but 1.0 of a force becomes {float(unit)!r}; choose them nearer to the "
            "scene",
        )


def parameter_names(force: ExpressedForce) -> tuple[str, ...]:
    """Give the names of a force's parameters, in the order of its ``values``."""
    return _expression_table.parameter_names(force.nodes)


def formula_of(force: ExpressedForce) -> str:
    """Write a force as its expressions, the values of their parameters, and the axes and units that are its own."""
    values = _expression_table.parameter_values(force.nodes, force.values.tolist())
    written = _expression_table.formulas(force.nodes, (*_PLACES, *_VELOCITIES), tuple(values))
    usual: dict[str, Any] = dict(zip(("first", "second", "third"), _AXES, strict=True))
    usual |= {"origin": (0.0, 0.0, 0.0), "length": 1.0, "mass": 1.0, "time": 1.0}
    own = {name: getattr(force, name) for name in usual if getattr(force, name) != usual[name]}
    if force.bodies is not None:
        own["bodies"] = np.asarray(force.bodies).tolist()
    expressions = f"({', '.join(written)})" if len(written) > 1 else written[0]
    further = [f"{name}={value!r}" for name, value in (values | own).items()]
    return f"ExpressedForce({', '.join([f'{force.gives}={expressions}', *further])})"


def __dir__() -> list[str]:
    return list(__all__)
