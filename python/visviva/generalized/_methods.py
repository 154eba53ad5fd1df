"""Which method takes the steps of a system in generalized coordinates: names, and what they need."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from visviva import _core
from visviva._keywords import did_you_mean
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from visviva.generalized._states import States

__all__ = [
    "ACROSS_KINKS",
    "CONSTRAINED",
    "DISCRETE",
    "EXACT",
    "GAUSS",
    "check_atol",
    "check_rtol",
    "discrete_name",
    "method_name",
]

#: What knows a motion at any time, without steps, what is found of equations that it is for, and what they have to be.
EXACT = {
    "matrix_exponential": ("linear", "linear equations with constant coefficients"),
    "elliptic_functions": ("pendulum", "the equation of a pendulum, θ″ = −a sin θ + b cos θ"),
}

#: Collocation methods, which take any Lagrangian and any Hamiltonian.
GAUSS = ("gauss16", "gauss8", "gauss4")

#: What finds by its error where an absolute value turns, within a step, and makes that step small.
ACROSS_KINKS = "dop853"

#: Methods that make the action of a discrete path stationary: of Lagrangians.
DISCRETE = (
    "variational_midpoint",
    "variational_trapezoidal",
    "variational_lobatto4",
    "variational_lobatto6",
    "variational_lobatto8",
)

#: RATTLE and its compositions: of Lagrangians with holonomic constraints.
CONSTRAINED = ("rattle", "rattle4", "rattle6", "rattle8")


def discrete_name(method: object) -> str:
    """Check a variational integrator's name, and give it."""
    if isinstance(method, str) and method in DISCRETE:
        return method
    hint = did_you_mean(method, list(DISCRETE)) if isinstance(method, str) else ""
    raise InvalidInput("method", f"expected one of {', '.join(DISCRETE)}, got {method!r}{hint}")


def check_atol(method: str) -> None:
    """Refuse an absolute tolerance beside a method that estimates no error in a step."""
    from visviva.integrators import methods

    if method in ("taylor", *GAUSS):
        raise InvalidInput(
            "atol", f"{method} chooses its steps by how smooth the motion is, for rtol alone; leave atol out"
        )
    if not any(each.name == method and each.adaptive for each in methods()):
        raise InvalidInput("atol", f"{method} estimates no error that atol could bound; leave it out")


def check_rtol(rtol: float, usual: float, dt: float | None) -> None:
    """Refuse a relative tolerance beside equal steps, which it would not change."""
    if dt is not None and rtol != usual:
        raise InvalidInput(
            "rtol", f"expected none beside dt = {dt:g}, which is the length of every step; leave one of them out"
        )


def _check_max_step(method: str, dt: float | None, max_step: float | None) -> None:
    """Refuse a longest step of what chooses none."""
    if max_step is None:
        return
    if method in EXACT:
        raise InvalidInput("max_step", f"{method} takes no steps; leave max_step out")
    if dt is not None:
        raise InvalidInput("max_step", f"expected none beside dt = {dt:g}, which is the length of every step")


def method_name(method: object, system: States, dt: float | None, max_step: float | None = None) -> str:
    """Check a method, by its name or itself, and what is said of its steps, and give its name."""
    name = _name(method, system, dt, max_step)
    _check_max_step(name, dt, max_step)
    return name


def _name(method: object, system: States, dt: float | None, max_step: float | None) -> str:
    if isinstance(method, str) and method == "auto":
        found = system._structure
        if dt is None and max_step is None:
            for name, (what, _) in EXACT.items():
                if found[what]:
                    return name
        return ACROSS_KINKS if found["kinks"] and dt is None else "gauss16"
    if isinstance(method, str) and method in GAUSS:
        if dt is None and system._structure["kinks"]:
            raise InvalidInput(
                "method",
                f"{method} would choose steps that pass over where an absolute value turns, as if it did not; "
                f"{ACROSS_KINKS} makes its steps small there, or give a step dt of your own",
            )
        return method
    if isinstance(method, str) and method in EXACT:
        _check_exact(method, system, dt)
        return method
    if isinstance(method, str) and method in (*DISCRETE, *CONSTRAINED):
        _check_discrete(method, system, dt)
        return method
    from visviva._methods_elsewhere import refuse_of_others
    from visviva.integrators import Method, methods

    known: dict[str, Method] = {each.name: each for each in methods()}
    if isinstance(method, Method):
        method = method.name
    if isinstance(method, str) and method not in known:
        refuse_of_others("method", method, stiff="'gauss16' is implicit")
    if not isinstance(method, str) or method not in known:
        own = ("auto", *GAUSS, *EXACT, *DISCRETE, *CONSTRAINED)
        hint = did_you_mean(method, [*own, *known]) if isinstance(method, str) else ""
        raise InvalidInput(
            "method", f"expected one of {', '.join(own)} or a method of vv.methods(), got {method!r}{hint}"
        )
    kind = known[method]
    if kind.adaptive and dt is not None:
        raise InvalidInput("dt", f"{method} chooses its own steps; leave dt out")
    if not kind.adaptive and dt is None:
        raise InvalidInput("dt", f"expected a step, as {method} has a fixed one; pass dt")
    _check_splitting(method, system)
    return method


@cache
def _asked_of_energies() -> dict[str, str | None]:
    """What methods ask of the energies of a system, by their names."""
    return {row["name"]: row["asks"] for row in _core.methods()}


def _check_splitting(method: str, system: States) -> None:
    """Refuse kicks and drifts where they make no method."""
    asks = _asked_of_energies()[method]
    if asks is None:
        return
    found = system._structure
    if not found["separable"]:
        raise InvalidInput(
            "method",
            f"{method} needs accelerations that do not depend on velocities, or H = T(p) + V(q); here they do. gauss16 "
            "is symplectic all the same; dop853 works too",
        )
    if not found[asks]:
        form = "H = T(p) + V(q) with T quadratic in p" if asks == "nystrom" else "H = p²/2 + V(q), or a Lagrangian"
        raise InvalidInput("method", f"{method} needs {form}; here yoshida4, kahan_li8 and gauss16 are symplectic")
    if system._constraints():
        raise InvalidInput("method", f"{method} keeps no constraints; gauss16 and dop853 do")


def _check_exact(method: str, system: States, dt: float | None) -> None:
    what, equations = EXACT[method]
    if not system._structure[what]:
        raise InvalidInput("method", f"{method} needs {equations}, and here there are others; gauss16 takes any")
    if dt is not None:
        raise InvalidInput("dt", f"{method} takes no steps; leave dt out")


def _check_discrete(method: str, system: States, dt: float | None) -> None:
    """Refuse a discrete action of what has none."""
    if system._source.kind != "lagrangian":
        raise InvalidInput(
            "method",
            f"{method} is of Lagrangians; gauss16 is symplectic for any Hamiltonian, and lagrangian() makes a "
            "Lagrangian of one that has it",
        )
    if system._source.description["nonholonomic"]:
        raise InvalidInput("method", f"{method} keeps no nonholonomic constraints; gauss16 and dop853 do")
    if method in DISCRETE and system._constraints():
        raise InvalidInput("method", f"{method} keeps no constraints; rattle, gauss16 and dop853 do")
    if method in CONSTRAINED and not system._constraints():
        raise InvalidInput("method", f"{method} is for constraints; without any take variational_trapezoidal")
    if dt is None:
        raise InvalidInput("dt", f"expected a step, as {method} has a fixed one; pass dt")
