"""Classical mechanics at native speed.

A scene is described with frozen parts, run by a Rust core, and comes back as NumPy arrays::

    import numpy as np, visviva as vv

    scene = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0))
    print(scene.plan(t=100.0))                      # what will run, what is skipped, and why
    out = scene.run(t=np.linspace(0.0, 100.0, 1001), rtol=1e-12)
    print(out.conservation())                       # how well the invariants held

The names below are imported when they are first used, so that ``import visviva`` costs little more
than NumPy itself.
"""

import sys
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Where each public name lives. `__all__` below repeats the names because type checkers read it.
_HOME = {
    "CentralField": "forces",
    "CloseEncounter": "errors",
    "Conservation": "conservation",
    "ConvergenceError": "errors",
    "EnsembleScene": "ensemble",
    "EnsembleTrajectory": "ensemble",
    "Error": "errors",
    "Gravity": "forces",
    "InternalError": "errors",
    "Interrupted": "errors",
    "InvalidInput": "errors",
    "Invariants": "invariants",
    "Method": "integrators",
    "OdeResult": "initial_value",
    "OdeSolution": "initial_value",
    "Particles": "particles",
    "Plan": "plan",
    "Scene": "scene",
    "Status": "trajectory",
    "Trajectory": "trajectory",
    "UniformField": "forces",
    "UnknownKeyword": "errors",
    "load": "io",
    "methods": "integrators",
    "solve_ivp": "initial_value",
}
_ROOMS = ("datasets", "errors", "forces", "orbits", "potentials", "problems", "scattering")

__all__ = [
    "CentralField",
    "CloseEncounter",
    "Conservation",
    "ConvergenceError",
    "EnsembleScene",
    "EnsembleTrajectory",
    "Error",
    "Gravity",
    "InternalError",
    "Interrupted",
    "InvalidInput",
    "Invariants",
    "Method",
    "OdeResult",
    "OdeSolution",
    "Particles",
    "Plan",
    "Scene",
    "Status",
    "Trajectory",
    "UniformField",
    "UnknownKeyword",
    "datasets",
    "errors",
    "forces",
    "load",
    "methods",
    "orbits",
    "potentials",
    "problems",
    "scattering",
    "solve_ivp",
]

if TYPE_CHECKING:
    from visviva import datasets, errors, forces, orbits, potentials, problems, scattering
    from visviva.conservation import Conservation
    from visviva.ensemble import EnsembleScene, EnsembleTrajectory
    from visviva.errors import (
        CloseEncounter,
        ConvergenceError,
        Error,
        InternalError,
        Interrupted,
        InvalidInput,
        UnknownKeyword,
    )
    from visviva.forces import CentralField, Gravity, UniformField
    from visviva.initial_value import OdeResult, OdeSolution, solve_ivp
    from visviva.integrators import Method, methods
    from visviva.invariants import Invariants
    from visviva.io import load
    from visviva.particles import Particles
    from visviva.plan import Plan
    from visviva.scene import Scene
    from visviva.trajectory import Status, Trajectory


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _ROOMS:
        value: Any = import_module(f"visviva.{name}")
    elif name in _HOME:
        value = getattr(import_module(f"visviva.{_HOME[name]}"), name)
    else:
        # With these two, Python's own message suggests the nearest name.
        raise AttributeError(f"module 'visviva' has no attribute {name!r}", name=name, obj=sys.modules[__name__])
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
