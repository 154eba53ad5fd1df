"""What Lagrangians and Hamiltonians share: a model of the core, a state to start from, and runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, whole_number
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, FrozenAttribute, Interrupted, InvalidInput
from visviva.generalized._flow import Flow
from visviva.generalized._methods import method_name
from visviva.generalized._source import Source, _label
from visviva.generalized._symbolic import sympy, trees

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._ensemble import GeneralizedEnsemble
    from visviva.generalized._nodes import Node
    from visviva.generalized._plan import GeneralizedPlan
    from visviva.generalized._trajectory import GeneralizedTrajectory
    from visviva.typing import Progress

__all__ = ["GeneralizedSystem"]


@known_keywords
class GeneralizedSystem(Flow):
    """A mechanical system in generalized coordinates, and a state of it: base of `Lagrangian` and `Hamiltonian`.

    Attributes
    ----------
    coordinates : tuple of str
        Names.
    parameters : dict of str to float
        Values; `at` changes them without deriving anything again.
    position : ndarray, shape (n,)
        Coordinates at the start.
    t0 : float
        The time there.
    """

    __slots__ = ("_model", "_second", "_source", "_values", "coordinates", "parameters", "position", "t0")

    coordinates: tuple[str, ...]
    parameters: dict[str, float]
    position: NDArray[np.float64] | None
    t0: float
    _source: Source
    _model: _core.GeneralizedModel
    _values: NDArray[np.float64]
    _second: NDArray[np.float64]

    #: What the second half of a state is called.
    _second_name = "velocity"

    def _prepare(
        self,
        source: Source,
        values: list[Any],
        state: tuple[ArrayLike | None, ArrayLike | None, float],
        model: _core.GeneralizedModel | None = None,
    ) -> None:
        position, second, t0 = state
        n = len(source.names)
        set_ = object.__setattr__
        set_(self, "_source", source)
        set_(self, "coordinates", source.names)
        numbers = [
            number(f"parameters[{name!r}]", value) for name, value in zip(source.parameters, values, strict=True)
        ]
        set_(self, "parameters", dict(zip(source.parameters, numbers, strict=True)))
        set_(self, "_values", np.array(numbers, dtype=float))
        set_(self, "position", None if position is None else _frozen(float_array("position", position, (n,))))
        set_(self, "_second", _frozen(np.zeros(n) if second is None else float_array(self._second_name, second, (n,))))
        set_(self, "t0", number("t0", t0))
        set_(self, "_model", _core.GeneralizedModel(source.description) if model is None else model)

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenAttribute(name, f"a {type(self).__name__} is frozen; at({name}=…) makes another one")

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.position, self._second, self.t0)
        return _restored, (type(self), self._source, self._values.tolist(), state)

    def __repr__(self) -> str:
        names = ", ".join(self.coordinates)
        return f"{type(self).__name__}({names}; {len(self.parameters)} parameters)"

    # --- What it is ---------------------------------------------------------------------------------------------

    @property
    def _structure(self) -> dict[str, Any]:
        return self._model.structure()

    @property
    def cyclic(self) -> list[str]:
        """Coordinates that nothing depends on: their momenta are conserved."""
        return [self.coordinates[index] for index in self._structure["cyclic"]]

    @property
    def autonomous(self) -> bool:
        """Whether nothing depends on the time."""
        return bool(self._structure["autonomous"])

    @property
    def conserved(self) -> list[str]:
        """What the graph tells to be conserved: ``energy`` (Jacobi's integral, or H), momenta of cyclic coordinates."""
        energy = ["energy"] if self._structure["conserves_energy"] else []
        return [*energy, *(f"momentum of {name}" for name in self.cyclic)]

    def _shown(self, name: str) -> list[Any]:
        """Expressions of the core as SymPy's."""
        return self._trees(*self._model.expressions(name))

    def _trees(self, nodes: Sequence[Node], roots: Sequence[int]) -> list[Any]:
        sp = sympy()
        if self._source.symbols is None:
            letter = "v" if self._source.kind == "lagrangian" else "p"
            first = [sp.Symbol(name) for name in self.coordinates]
            second = [sp.Symbol(f"{letter}_{name}") for name in self.coordinates]
            parameters: Any = [sp.Symbol(name) for name in self.parameters]
        else:
            first, second, parameters = map(list, self._source.symbols)
        return trees(nodes, roots, [*first, *second], parameters)

    # --- States -------------------------------------------------------------------------------------------------

    def _at(
        self,
        position: ArrayLike | None,
        second: ArrayLike | None,
        parameters: Mapping[Any, float] | None = None,
        t0: float | None = None,
    ) -> Self:
        other = object.__new__(type(self))
        state = (
            self.position if position is None else position,
            self._second if second is None else second,
            self.t0 if t0 is None else t0,
        )
        other._prepare(self._source, self._with_parameters(parameters), state, self._model)
        return other

    def _with_parameters(self, changed: Mapping[Any, Any] | None) -> list[Any]:
        values: dict[str, Any] = dict(self.parameters)
        if changed is not None and not hasattr(changed, "items"):
            kind = type(changed).__name__
            raise InvalidInput("parameters", f"expected values by parameter, as {{'l': 2.0}}, got {kind}")
        for key, value in (changed or {}).items():
            name = _label(key)
            if name not in values:
                raise InvalidInput("parameters", f"there is no parameter {name!r}; there are {list(values)}")
            values[name] = value
        return list(values.values())

    def _start(self) -> NDArray[np.float64]:
        if self.position is None:
            raise InvalidInput(
                "position", f"expected the coordinates {list(self.coordinates)} at the start; pass position=[…]"
            )
        return np.concatenate([self.position, self._second])

    def evaluate(self, *expressions: Any, trajectory: GeneralizedTrajectory | None = None) -> NDArray[np.float64]:
        """Values of further expressions, at the start or along a trajectory.

        Parameters
        ----------
        *expressions : sympy.Expr or callable
            Of the same kind as the function of the system.
        trajectory : GeneralizedTrajectory, optional
            Where; the start if not given.

        Returns
        -------
        ndarray, shape (k,) or (T, k)

        Raises
        ------
        InvalidInput
            For an expression that the core does not know.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pendulum = vv.systems.pendulum(position=[0.5])
        >>> pendulum.evaluate(lambda q, v, t, l, **others: l * np.sin(q[0])).round(6)
        array([0.479426])
        """
        nodes, roots = self._source.nodes("expressions", expressions)
        if trajectory is None:
            t, states = np.array([self.t0]), self._start()[None, :]
        else:
            t, states = trajectory.t, trajectory._states
        found = self._model.evaluate(nodes, roots, t, states, self._values[None, :])
        return found[0] if trajectory is None else found

    # --- Runs ---------------------------------------------------------------------------------------------------

    def _asked(
        self, t: ArrayLike, method: str, rtol: float, dt: float | None, max_step: float | None
    ) -> tuple[dict[str, Any], NDArray[np.float64]]:
        outputs = self._outputs(t)
        rtol = number("rtol", rtol)
        if not 1e-15 <= rtol <= 1e-2:
            raise InvalidInput("rtol", f"expected a tolerance between 1e-15 and 1e-2, got {rtol:g}")
        for name, value in (("dt", dt), ("max_step", max_step)):
            if value is not None and number(name, value) <= 0.0:
                raise InvalidInput(name, f"expected a positive number, got {value!r}; the direction is that of t")
        asked = {
            "method": method_name(method, self._structure["separable"], dt, constrained=bool(self._constraints())),
            "span": (self.t0, float(outputs[-1])),
            "rtol": rtol,
            "dt": None if dt is None else number("dt", dt),
            "max_step": None if max_step is None else number("max_step", max_step),
            "max_steps": 100_000_000,
            "outputs": outputs,
            "section": None,
        }
        return asked, outputs

    def _outputs(self, t: ArrayLike) -> NDArray[np.float64]:
        """Give the times that are read: all that are asked for, or of an end the start and it."""
        if np.ndim(t) == 0:
            end = number("t", t)
            return np.array([self.t0] if end == self.t0 else [self.t0, end])
        outputs = float_array("t", t, None)
        if outputs.ndim > 1 or not outputs.size:
            raise InvalidInput(
                "t", f"expected the end, or output times in one row, got an array of shape {outputs.shape}"
            )
        steps = np.diff(outputs, prepend=self.t0) * (1.0 if outputs[-1] >= self.t0 else -1.0)
        if (steps < 0.0).any() or (steps[1:] <= 0.0).any():
            raise InvalidInput("t", f"expected times in order from t0 = {self.t0:g} on, each once")
        return outputs

    def _constraints(self) -> int:
        description = self._source.description
        return len(description["holonomic"]) + len(description["nonholonomic"])

    def _check_start(self) -> None:
        """Refuse a start from which the equations have no meaning."""

    def run(
        self,
        t: ArrayLike,
        *,
        method: str = "gauss16",
        rtol: float = 1e-12,
        dt: float | None = None,
        max_step: float | None = None,
        progress: Progress = False,
    ) -> GeneralizedTrajectory:
        """Run from the start.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end, or output times in order; they change no step.
        method : str
            ``gauss16`` (also ``gauss8``, ``gauss4``): implicit, symplectic for any Lagrangian and Hamiltonian; where
            energy is conserved its step is chosen at the start and then held. Or a method of `visviva.methods`:
            adaptive ones (``dop853``), ones with a fixed step (``rk4``), and symplectic ones where accelerations do not
            depend on velocities.
        rtol : float
            Relative tolerance of a step.
        dt : float, optional
            The step of every step.
        max_step : float, optional
            The longest step.
        progress : bool or callable
            As in `Scene.run`.

        Returns
        -------
        GeneralizedTrajectory

        Raises
        ------
        InvalidInput
            For what cannot be run, before anything runs.
        ConvergenceError
            At a singularity; ``.trajectory`` holds what was computed.
        Interrupted
            By Ctrl-C; ``.trajectory`` holds what was computed.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.systems.pendulum(position=[3.0]).run(t=np.linspace(0.0, 10.0, 101))
        >>> out["theta"].shape, bool(abs(out.energy - out.energy[0]).max() < 1e-13)
        ((101,), True)
        """
        from visviva.generalized._trajectory import GeneralizedTrajectory

        start = self._start()
        asked, outputs = self._asked(t, method, rtol, dt, max_step)
        self._check_start()
        result = self._run(asked, start[None, :], self._values[None, :], 1, progress)
        out = GeneralizedTrajectory(self, result, asked)
        if result["interrupted"]:
            raise Interrupted("the run was interrupted", out)
        failure = result["failures"][0]
        if failure is not None:
            raise ConvergenceError(failure, result["reached"][0], out)
        assert len(out.t) == len(outputs)
        return out

    def _run(
        self,
        asked: dict[str, Any],
        states: NDArray[np.float64],
        parameters: NDArray[np.float64],
        threads: int | None,
        progress: Progress,
    ) -> dict[str, Any]:
        threads = None if threads is None else whole_number("threads", threads)
        if progress is False:
            return self._model.run(asked, states, parameters, threads, None)
        from visviva._progress import callback

        with callback(progress) as report:
            return self._model.run(asked, states, parameters, threads, report)

    def plan(
        self,
        t: ArrayLike,
        *,
        method: str = "gauss16",
        rtol: float = 1e-12,
        dt: float | None = None,
        max_step: float | None = None,
    ) -> GeneralizedPlan:
        """What `run` would do, and why.

        Parameters
        ----------
        t, method, rtol, dt, max_step
            As in `run`.

        Raises
        ------
        InvalidInput
            For what `run` refuses.

        Examples
        --------
        >>> import visviva as vv
        >>> print(vv.systems.spherical_pendulum().plan(t=10.0).conserved)
        ('energy', 'momentum of phi')
        """
        from visviva.generalized._plan import GeneralizedPlan

        asked, _ = self._asked(t, method, rtol, dt, max_step)
        return GeneralizedPlan._of(self, asked)

    def _ensemble(
        self, position: ArrayLike | None, second: ArrayLike | None, parameters: Mapping[Any, ArrayLike] | None
    ) -> GeneralizedEnsemble:
        from visviva.generalized._ensemble import GeneralizedEnsemble

        return GeneralizedEnsemble(self, position, second, parameters)


def _restored(cls: type[GeneralizedSystem], source: Source, values: list[float], state: Any) -> GeneralizedSystem:
    system = object.__new__(cls)
    system._prepare(source, values, state)
    return system


def _frozen(array: NDArray[np.float64]) -> NDArray[np.float64]:
    own = array.copy()
    own.flags.writeable = False
    return own
