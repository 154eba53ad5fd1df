"""Other descriptions of a system: Hamiltonians of Lagrangians and back, Routh's function, the flow's derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import ConvergenceError, Interrupted, InvalidInput
from visviva.generalized._source import Source, _label
from visviva.generalized._symbolic import free_name, sympy, time
from visviva.generalized._whole import whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem
    from visviva.integrators import Method
    from visviva.typing import GeneralizedMethodName

__all__ = ["flow_jacobian", "legendre", "lyapunov_exponents", "refuse_kinks", "routhian"]

#: The most steps of a run.
MOST_STEPS = 100_000_000
#: Where the least growth of neighbors is below this part of the most, it has lost as many of its digits.
_DROWNED = 1e-5


def legendre(system: GeneralizedSystem) -> GeneralizedSystem:
    """Give the Hamiltonian of a Lagrangian, or the Lagrangian of a Hamiltonian, at the same state."""
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

    source = system._source
    to_hamiltonian = source.kind == "lagrangian"
    try:
        nodes, roots = system._model.legendre()
    except InvalidInput as error:
        if "quadratic" not in error.message:
            raise
        raise InvalidInput(error.argument, f"{error.message}; legendre_transform() evaluates it by numbers") from None
    symbols = source.symbols
    if symbols is not None:
        sp, taken = sympy(), {*source.names, *source.parameters}
        if to_hamiltonian:
            second = tuple(sp.Symbol(free_name(f"p_{name}", taken)) for name in source.names)
        elif any(isinstance(each, sp.Symbol) for each in symbols[0]):
            second = tuple(sp.Symbol(free_name(f"v_{name}", taken)) for name in source.names)
        else:
            second = tuple(each.diff(time._sympy_()) for each in symbols[0])
        symbols = (symbols[0], second, symbols[2])
    description = source.description | {
        "kind": "hamiltonian" if to_hamiltonian else "lagrangian",
        "nodes": nodes,
        "function": roots[0],
        "forces": roots[1:],
    }
    made = Source(description["kind"], source.names, symbols, source.parameters, description)
    other: GeneralizedSystem = object.__new__(Hamiltonian if to_hamiltonian else Lagrangian)
    second_half = None
    if system.position is not None:
        columns = system._model.columns(np.array([system.t0]), system._start()[None, :], system._values[None, :])
        second_half = columns[0, : len(source.names)]
    other._prepare(made, list(system.parameters.values()), (system.position, second_half, system.t0))
    return other


def routhian(system: GeneralizedSystem, momenta: Mapping[Any, float | None] | None) -> GeneralizedSystem:
    """Give Routh's function without cyclic coordinates, their momenta as parameters ``p_<name>``."""
    from visviva.generalized._lagrangian import Lagrangian

    source, n = system._source, len(system.coordinates)
    if source.description["forces"] or source.description["dissipation"] is not None or system._constraints():
        raise InvalidInput("L", "Routh's function is that of a Lagrangian without further forces and constraints")
    if momenta is not None and not isinstance(momenta, Mapping):
        raise InvalidInput("momenta", f"expected values by name, {{coordinate: momentum}}, got {momenta!r}")
    given = dict.fromkeys(system.cyclic) if momenta is None else {_label(k): v for k, v in momenta.items()}
    for name in given:
        if name not in system.coordinates:
            raise InvalidInput("momenta", f"there is no coordinate {name!r}; there are {list(system.coordinates)}")
        if name not in system.cyclic:
            raise InvalidInput("momenta", f"{name!r} is not cyclic; cyclic are {system.cyclic or 'none'}")
    if not given:
        raise InvalidInput("momenta", "no coordinate is cyclic, and there is nothing to reduce")
    places = [system.coordinates.index(name) for name in given]
    kept = [index for index in range(n) if index not in places]
    if not kept:
        raise InvalidInput("momenta", "all coordinates are cyclic: nothing would be left to run")
    nodes, roots = system._model.routhian(places)
    at_start = None
    if any(value is None for value in given.values()):
        columns = system._model.columns(np.array([system.t0]), system._start()[None, :], system._values[None, :])
        at_start = columns[0]
    values = [
        at_start[place] if value is None and at_start is not None else value
        for place, value in zip(places, given.values(), strict=True)
    ]
    names = tuple(system.coordinates[index] for index in kept)
    further = tuple(f"p_{name}" for name in given)
    symbols = source.symbols
    if symbols is not None:
        sp = sympy()
        first, second, parameters = symbols
        symbols = (
            tuple(first[i] for i in kept),
            tuple(second[i] for i in kept),
            (*parameters, *(sp.Symbol(name) for name in further)),
        )
    description = source.description | {
        "coordinates": len(kept),
        "parameters": len(source.parameters) + len(further),
        "nodes": nodes,
        "function": roots[0],
    }
    made = Source("lagrangian", names, symbols, (*source.parameters, *further), description)
    other: Lagrangian = object.__new__(Lagrangian)
    position = None if system.position is None else system.position[kept]
    other._prepare(made, [*system.parameters.values(), *values], (position, system._second[kept], system.t0))
    return other


def flow_jacobian(
    system: GeneralizedSystem,
    t: float,
    *,
    rtol: float = 1e-12,
    method: GeneralizedMethodName | Method = "gauss16",
    most_steps: int = MOST_STEPS,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the state at ``t``, and its derivatives with respect to the state at the start."""
    n = 2 * len(system.coordinates)
    refuse_kinks(system)
    system._check_start()
    asked, _ = system._asked(t, method, rtol, None, None)
    asked["max_steps"] = most_steps
    start = np.concatenate([system._start(), np.eye(n).ravel()])
    model = system._model.variational()
    result = model.run(asked, start[None, :], system._values[None, :], 1, None)
    whole(result, "flow")
    last = result["y"][-1]
    return last[:n], last[n:].reshape(n, n)


def refuse_kinks(system: GeneralizedSystem) -> None:
    if system._structure["kinks"]:
        raise InvalidInput(
            "system",
            "expected a function without absolute values: where one turns the derivatives of a motion jump, which "
            "variational equations do not tell; compare runs from neighboring starts",
        )


def lyapunov_exponents(system: GeneralizedSystem, t: float, *, interval: float, rtol: float) -> NDArray[np.float64]:
    """Give all exponents, by the variational equations and orthonormal frames."""
    n = 2 * len(system.coordinates)
    refuse_kinks(system)
    system._check_start()
    model = system._model.variational()
    parts = max(1, round(abs(t - system.t0) / interval))
    times = np.linspace(system.t0, t, parts + 1)
    state, frame, sums = system._start(), np.eye(n), np.zeros(n)
    # Parts that are still to come, the next one last.
    pending = [(float(begin), float(end)) for begin, end in pairwise(times)][::-1]
    shortest = 1e-6 * abs(t - system.t0) / parts
    while pending:
        begin, end = pending.pop()
        asked = {
            "method": "gauss16",
            "span": (begin, end),
            "rtol": rtol,
            "atol": None,
            "dt": None,
            "max_step": None,
            "max_steps": MOST_STEPS,
            "outputs": np.array([end]),
            "events": [],
        }
        both = np.concatenate([state, frame.ravel()])
        result = model.run(asked, both[None, :], system._values[None, :], 1, None)
        if result["interrupted"]:
            raise Interrupted("the exponents were interrupted")
        failed, stretch = result["failures"][0], np.zeros(n)
        if failed is None and np.isfinite(result["y"][-1]).all():
            last = result["y"][-1]
            turned, sizes = np.linalg.qr(last[n:].reshape(n, n))
            stretch = np.abs(np.diag(sizes))
        # What grows most drowns what grows least, or leaves the range of numbers: the frame is made orthonormal again
        # before that.
        if stretch.min() <= _DROWNED * stretch.max():
            if abs(end - begin) <= shortest:
                raise ConvergenceError(
                    failed or "what neighbors do differs too much in the shortest time to be told apart", begin
                )
            middle = begin + 0.5 * (end - begin)
            pending += [(middle, end), (begin, middle)]
            continue
        state, frame = last[:n], turned
        sums += np.log(stretch)
    return np.sort(sums / (t - system.t0))[::-1]
