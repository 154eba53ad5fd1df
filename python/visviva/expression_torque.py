"""Torques of one's own on the rigid bodies of a scene, as formulas: `ExpressionTorque`.

The one idea: as of `ExpressionForce`, what is written down here is only a table of nodes; the core compiles and runs
it, for eight bodies at once, beside any other load.
"""

from __future__ import annotations

from dataclasses import dataclass
from inspect import Parameter
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, cast

import numpy as np

from visviva import _core, _expression_table
from visviva._arrays import float_array, positive
from visviva._body_force import BodyForce, body_of, set_frozen
from visviva._compiled import is_compiled
from visviva._declared import unit_change
from visviva._keywords import check_call, did_you_mean, known_keywords
from visviva._moves import orthogonal
from visviva.errors import InvalidInput
from visviva.generalized._nodes import Expression, Nodes, call_with_expressions, expression_array, recorded
from visviva.generalized._source import placed_arguments, refuse_missing_values
from visviva.rigid._orientation import quaternion_from_matrix, quaternion_product

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from visviva.typing import ParameterValues, SymbolicExpression

__all__ = ["ExpressionTorque"]

#: What a function takes by its place.
_PLACES = ("t", "orientation", "angular_velocity")
_TIME = ("t", "time", "_t", "_time", "_")
_VARIABLES = ("qx", "qy", "qz", "qw", "wx", "wy", "wz")
#: The first of the variables that is one of the angular velocity.
_SPIN = 4
_UNTURNED = (0.0, 0.0, 0.0, 1.0)


@known_keywords
@dataclass(frozen=True, slots=True, init=False, repr=False)
class ExpressionTorque(BodyForce):
    """A torque by a formula of the time, the orientation and the angular velocity, at the speed of those of visviva.

    Units: those of the scene; a torque is mass · length² / time², angular velocities are in radians per time.

    Parameters
    ----------
    function : callable
        ``f(t, orientation, angular_velocity, **parameters)``, which gives three components. It is called once, with
        expressions in the place of numbers: the quaternion (x, y, z, w) from the body to space, and the angular
        velocity along the body's axes. What it has written down is kept as a table of numbers, which is taken, too.
    body : int or str, optional
        The rigid body; all of them, each by itself, if not given.
    frame : {"space", "body"}, optional
        Along whose axes the components are; about the center of mass, or the fixed point of a body that has one.
    parameters : mapping of str to float, optional
        The values of what the function takes by name. Copies of an ensemble may have their own, by these names.
    axes : array_like, shape (4,), optional
        The quaternion from the axes of space that the function knows to those of the scene, as `rotated` leaves it.
    length, mass, time : float, optional
        The units in the function, in those of the scene, as `rescaled` leaves them.

    Raises
    ------
    visviva.InvalidInput
        For what is no function of these, or gives no three expressions; for what the core does not know, with what it
        knows; for a parameter without a finite value; for another frame.

    See Also
    --------
    CompiledTorque : The same by a compiled function, which is neither pickled nor saved.
    ExpressionForce : Forces on the centers of bodies.

    Notes
    -----
    Functions are made of arithmetic and NumPy's functions, and no branches. A formula without the angular velocity goes
    with every method that turns bodies but ``taylor``, one with it also with no splitting. The energy that is told is
    without its work. Methods that choose their steps look for pulses, walls and bumps that are narrower than a step, as
    they do beside an `ExpressionForce`; equal steps (`dt`) may pass over one.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.5 (Euler's equations).

    Examples
    --------
    A motor against drag, and the speed that it comes to:

    >>> import numpy as np, visviva as vv
    >>> motor = vv.ExpressionTorque(
    ...     lambda t, q, w, power, drag: (0.0, 0.0, power - drag * w[2]),
    ...     frame="body",
    ...     parameters={"power": 0.5, "drag": 0.1},
    ... )
    >>> motor
    ExpressionTorque((0, 0, power - drag*wz), body=None, frame='body', power=0.5, drag=0.1)
    >>> wheel = vv.Scene(vv.RigidBody(1.0, [0.5, 0.5, 1.0]), motor)
    >>> print(f"{wheel.run(t=200.0).angular_velocity[-1, 0, 2]:.6f}")
    5.000000
    """

    kind: ClassVar[str] = "expression_torque"
    _dimensions = {}  # noqa: RUF012 — a ClassVar of the base

    function: tuple[float, ...]
    body: int | str | None
    frame: Literal["space", "body"]
    parameters: tuple[tuple[str, float], ...]
    axes: tuple[float, float, float, float]
    length: float
    mass: float
    time: float

    def __init__(
        self,
        function: Callable[..., Sequence[SymbolicExpression]] | Sequence[float],
        body: int | str | None = None,
        *,
        frame: Literal["space", "body"] = "space",
        parameters: ParameterValues | tuple[tuple[str, float], ...] | None = None,
        axes: ArrayLike = _UNTURNED,
        length: float = 1.0,
        mass: float = 1.0,
        time: float = 1.0,
    ) -> None:
        if not isinstance(frame, str) or frame not in ("space", "body"):
            hint = did_you_mean(str(frame), ("space", "body"))
            raise InvalidInput("frame", f"expected 'space' or 'body', got {frame!r}{hint}")
        given: Any = parameters
        if isinstance(given, tuple | list) and all(isinstance(each, tuple | list) and len(each) == 2 for each in given):
            given = {str(name): value for name, value in given}  # as they are kept, and as files have them
        names, values = _expression_table.checked_parameters(given, _PLACES)
        is_kept = is_compiled(function) or not callable(function)
        table = _kept(function) if is_kept else _recorded(cast("Callable[..., Any]", function), names)
        x, y, z, w = float_array("axes", axes, (4,)).tolist()
        units = {"length": length, "mass": mass, "time": time}
        set_frozen(
            self,
            function=table,
            body=body_of("body", body),
            frame=frame,
            parameters=tuple(zip(names, values, strict=True)),
            axes=(x, y, z, w),
            **{name: positive(name, unit, "unit") for name, unit in units.items()},
        )
        # Which compiles it: whatever is wrong with it is refused here. What bodies are called only a scene knows, and
        # what parameters there are only a table that is one.
        any_values = [("", 0.0)] * max(len(names), _expression_table.most_parameters(table))
        _core.check_load(self._described(None) | {"parameters": any_values})
        if set(known := _expression_table.parameter_names(table)) != set(names):
            raise InvalidInput("parameters", f"expected values of {list(known)}, got {dict(self.parameters)}")
        object.__setattr__(self, "parameters", tuple((name, dict(self.parameters)[name]) for name in known))

    def __repr__(self) -> str:
        written = _expression_table.formulas(self.function, _VARIABLES, tuple(dict(self.parameters)))
        own = {"body": self.body, "frame": self.frame} | dict(self.parameters)
        usual: dict[str, Any] = {"axes": _UNTURNED, "length": 1.0, "mass": 1.0, "time": 1.0}
        own |= {name: getattr(self, name) for name in usual if getattr(self, name) != usual[name]}
        further = ", ".join(f"{name}={value!r}" for name, value in own.items())
        return f"ExpressionTorque(({', '.join(written)}), {further})"

    def _described(self, body: int | str | None) -> dict[str, Any]:
        units = {name: getattr(self, name) for name in ("length", "mass", "time")}
        own = {"function": np.array(self.function), "parameters": list(self.parameters), "axes": list(self.axes)}
        return {"kind": self.kind, "body": body, "frame": self.frame} | own | units

    def _core_arguments(self) -> dict[str, Any]:
        """What the core takes: the table, and the values of its parameters with their names, which files keep."""
        return self._described(BodyForce._core_arguments(self)["body"])

    def _differing(self) -> dict[str, Any]:
        return dict(self.parameters)

    def _of_copy(self, own: Mapping[str, Any]) -> Self:
        return self._with(parameters=dict(self.parameters) | dict(own))

    def rotated(self, rotation: ArrayLike) -> Self:
        """The torque turned with space: the formula of the bodies as they were, whatever its axes.

        Units: the matrix is without dimension.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix; of determinant −1 a reflection.

        Returns
        -------
        ExpressionTorque

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> half = vv.ExpressionTorque(lambda t, q, w: (t, 0, 0)).rotated(np.diag([-1.0, -1.0, 1.0]))
        >>> half.axes
        (0.0, 0.0, 1.0, 0.0)
        """
        matrix = orthogonal(rotation)
        # A mirror image of a torque, which is an axial vector, is turned as what remains without the inversion.
        turn = quaternion_from_matrix(np.sign(np.linalg.det(matrix)) * matrix)
        return self._with(axes=quaternion_product(turn, self.axes))

    def reversed(self) -> Self:
        """The torque under which bodies with their motion turned round retrace their path.

        A formula of orientations alone is itself that.

        Returns
        -------
        ExpressionTorque

        Raises
        ------
        visviva.InvalidInput
            For a formula of the time or of the angular velocity.

        Examples
        --------
        >>> import visviva as vv
        >>> compass = vv.ExpressionTorque(lambda t, q, w: (0, 0, -2 * q[2] * q[3]))
        >>> compass.reversed() == compass
        True
        """
        table = self.function
        if _expression_table.looks_at_time(table) or _expression_table.looks_at_velocities(table, _SPIN):
            raise InvalidInput(
                "forces", "ExpressionTorque cannot be reversed: what velocities and time do in it is not known"
            )
        return self

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """The torque in units of which ``length``, ``mass`` and ``time`` make one old unit; the formula keeps its own.

        Parameters
        ----------
        length, mass, time : float
            What one old unit is in new ones; positive.

        Returns
        -------
        ExpressionTorque

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a torque or a time of the formula would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.ExpressionTorque(lambda t, q, w: (0, 0, t)).rescaled(length=100.0).length
        100.0
        """
        named = (("length", length), ("mass", mass), ("time", time))
        scales = {unit: positive(unit, scale, "number of new units per old one") for unit, scale in named}
        return self._with(
            **{
                unit: unit_change(unit, (1, 0, 0), (scale, 1.0, 1.0))(getattr(self, unit))
                for unit, scale in scales.items()
            }
        )


def _kept(table: Any) -> tuple[float, ...]:
    """A table of a formula that was written down before."""
    try:
        numbers = np.asarray(table, dtype=float)
    except (TypeError, ValueError):
        numbers = np.zeros(0)
    if numbers.ndim != 1 or numbers.size <= 3:
        raise InvalidInput(
            "function",
            f"expected a function f(t, orientation, angular_velocity, **parameters), got {type(table).__name__}; a "
            "constant torque is vv.AppliedTorque(torque), one by an address vv.CompiledTorque(function)",
        )
    return tuple(numbers.tolist())


def _recorded(function: Callable[..., Any], names: tuple[str, ...]) -> tuple[float, ...]:
    """The table of what a function does with expressions."""
    _refuse_other_places(function)
    refuse_missing_values("function", function, names)
    check_call("function", function, _PLACES, names)
    nodes = Nodes()

    def expressions(operation: str, numbers: range) -> list[Expression]:
        return [Expression(nodes, nodes.add(operation, (), float(number))) for number in numbers]

    orientation = expression_array(expressions("variable", range(_SPIN)))
    spin = expression_array(expressions("variable", range(_SPIN, len(_VARIABLES))))
    values = dict(zip(names, expressions("parameter", range(len(names))), strict=True))
    (t,) = expressions("time", range(1))
    found = call_with_expressions(nodes, "function", function, (t, orientation, spin), values)
    try:
        three = tuple(found)
    except TypeError:
        three = ()
    if len(three) != 3:
        raise InvalidInput("function", f"expected three components of the function, got {found!r}")
    roots = [recorded(nodes, component, "function") for component in three]
    return tuple(map(float, _expression_table.table(nodes, roots, names)))


def _refuse_other_places(function: Callable[..., Any]) -> None:
    """Refuse what would be taken for something else: another order, or a default in the first three places."""
    placed = placed_arguments(function)[:3]
    order = "f(t, orientation, angular_velocity, **parameters)"
    if any(each.name in ("t", "time") for each in placed[1:]) and placed[0].name not in _TIME:
        came = ", ".join(each.name for each in placed)
        raise InvalidInput("function", f"expected a function {order}, in this order, got f({came}, …)")
    for each in placed:
        if each.default is not Parameter.empty:
            raise InvalidInput(
                "function", f"expected a function {order}, and parameters after these three, got {each} among them"
            )


def __dir__() -> list[str]:
    return list(__all__)
