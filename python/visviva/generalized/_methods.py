"""Which method takes the steps of a system in generalized coordinates: names, and what they need."""

from __future__ import annotations

from visviva.errors import InvalidInput

__all__ = ["GAUSS", "method_name"]

#: Collocation methods, which take any Lagrangian and any Hamiltonian.
GAUSS = ("gauss16", "gauss8", "gauss4")


def method_name(method: object, separable: bool, dt: float | None, *, constrained: bool) -> str:
    """Check a method, by its name or itself, and give its name."""
    if isinstance(method, str) and method in GAUSS:
        return method
    from visviva.integrators import Method, methods

    known: dict[str, Method] = {each.name: each for each in methods()}
    if isinstance(method, Method):
        method = method.name
    if not isinstance(method, str) or method not in known:
        if isinstance(method, str):
            from visviva._keywords import did_you_mean

            hint = did_you_mean(method, [*GAUSS, *known])
        else:
            hint = ""
        raise InvalidInput(
            "method", f"expected gauss16, gauss8, gauss4 or a method of vv.methods(), got {method!r}{hint}"
        )
    kind = known[method]
    if kind.adaptive and dt is not None:
        raise InvalidInput("dt", f"{method} chooses its own steps; leave dt out")
    if not kind.adaptive and dt is None:
        raise InvalidInput("dt", f"expected a step, as {method} has a fixed one; pass dt")
    splits = not kind.adaptive and "a" not in kind.coefficients
    if splits and not separable:
        raise InvalidInput(
            "method",
            f"{method} needs accelerations that do not depend on velocities (H = p²/2 + V(q)); here they do. gauss16 "
            "is symplectic all the same; dop853 works too",
        )
    if splits and constrained:
        raise InvalidInput("method", f"{method} keeps no constraints; gauss16 and dop853 do")
    return method
