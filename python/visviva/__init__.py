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

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Where each public name lives. `__all__` below repeats the names because type checkers read it.
_HOME = {
    "AccuracyWarning": "errors",
    "Advice": "advice",
    "AppliedTorque": "rigid_forces",
    "AttachedSpring": "rigid_springs",
    "BodyMotion": "body",
    "BodyTurning": "body_turning",
    "CentralField": "forces",
    "CloseEncounter": "errors",
    "CompiledTorque": "rigid_forces",
    "Conservation": "conservation",
    "ConvergenceError": "errors",
    "Cost": "plan",
    "Coulomb": "forces",
    "Damper": "forces",
    "Drag": "forces",
    "Drift": "conservation",
    "DriftOfCopies": "ensemble_conservation",
    "DrivenForce": "forces",
    "EnsembleConservation": "ensemble_conservation",
    "EnsembleScene": "ensemble",
    "EnsembleTrajectory": "ensemble_trajectory",
    "Error": "errors",
    "ExpressedForce": "forces",
    "ExpressionForce": "expression_force",
    "ExpressionTorque": "expression_torque",
    "FrozenAttribute": "errors",
    "Gravity": "forces",
    "Hamiltonian": "generalized",
    "Harmonic": "forces",
    "InternalError": "errors",
    "Interrupted": "errors",
    "InvalidInput": "errors",
    "Invariants": "invariants",
    "Lagrangian": "generalized",
    "LinearDrag": "forces",
    "Megno": "megno",
    "Method": "integrators",
    "MissingPackage": "errors",
    "Oblate": "forces",
    "OdeResult": "initial_value",
    "OdeSolution": "initial_value",
    "Option": "advice",
    "PairPotential": "forces",
    "Particles": "particles",
    "Plan": "plan",
    "Point": "comparison",
    "PostNewtonian": "forces",
    "QuadraticDrag": "forces",
    "RigidBodies": "rigid_bodies",
    "RigidBody": "rigid_body",
    "RotatingFrame": "forces",
    "RotationalDrag": "rigid_forces",
    "SampledDrag": "forces",
    "Scene": "scene",
    "Spring": "forces",
    "Stats": "stats",
    "Status": "status",
    "Trajectory": "trajectory",
    "UniformElectricField": "forces",
    "UniformField": "forces",
    "UniformMagneticField": "forces",
    "UnknownKeyword": "errors",
    "WorkPrecision": "comparison",
    "WrongArguments": "errors",
    "coordinate": "generalized",
    "load": "io",
    "methods": "integrators",
    "plot_style": "_style",
    "resume": "saved_runs",
    "solve_ivp": "initial_value",
    "time": "generalized",
    "work_precision": "comparison",
}
_ROOMS = (
    "audit",
    "collisions",
    "datasets",
    "drag",
    "errors",
    "events",
    "forces",
    "generalized",
    "orbits",
    "potentials",
    "problems",
    "rigid",
    "scattering",
    "stress",
    "systems",
    "typing",
    "units",
)

__all__ = [
    "AccuracyWarning",
    "Advice",
    "AppliedTorque",
    "AttachedSpring",
    "BodyMotion",
    "BodyTurning",
    "CentralField",
    "CloseEncounter",
    "CompiledTorque",
    "Conservation",
    "ConvergenceError",
    "Cost",
    "Coulomb",
    "Damper",
    "Drag",
    "Drift",
    "DriftOfCopies",
    "DrivenForce",
    "EnsembleConservation",
    "EnsembleScene",
    "EnsembleTrajectory",
    "Error",
    "ExpressedForce",
    "ExpressionForce",
    "ExpressionTorque",
    "FrozenAttribute",
    "Gravity",
    "Hamiltonian",
    "Harmonic",
    "InternalError",
    "Interrupted",
    "InvalidInput",
    "Invariants",
    "Lagrangian",
    "LinearDrag",
    "Megno",
    "Method",
    "MissingPackage",
    "Oblate",
    "OdeResult",
    "OdeSolution",
    "Option",
    "PairPotential",
    "Particles",
    "Plan",
    "Point",
    "PostNewtonian",
    "QuadraticDrag",
    "RigidBodies",
    "RigidBody",
    "RotatingFrame",
    "RotationalDrag",
    "SampledDrag",
    "Scene",
    "Spring",
    "Stats",
    "Status",
    "Trajectory",
    "UniformElectricField",
    "UniformField",
    "UniformMagneticField",
    "UnknownKeyword",
    "WorkPrecision",
    "WrongArguments",
    "audit",
    "collisions",
    "coordinate",
    "datasets",
    "drag",
    "errors",
    "events",
    "forces",
    "generalized",
    "load",
    "methods",
    "orbits",
    "plot_style",
    "potentials",
    "problems",
    "resume",
    "rigid",
    "scattering",
    "solve_ivp",
    "stress",
    "systems",
    "time",
    "typing",
    "units",
    "work_precision",
]

if TYPE_CHECKING:
    from visviva import (
        audit,
        collisions,
        datasets,
        drag,
        errors,
        events,
        forces,
        generalized,
        orbits,
        potentials,
        problems,
        rigid,
        scattering,
        stress,
        systems,
        typing,
        units,
    )
    from visviva._style import plot_style
    from visviva.advice import Advice, Option
    from visviva.body import BodyMotion
    from visviva.body_turning import BodyTurning
    from visviva.comparison import Point, WorkPrecision, work_precision
    from visviva.conservation import Conservation, Drift
    from visviva.ensemble import EnsembleScene
    from visviva.ensemble_conservation import DriftOfCopies, EnsembleConservation
    from visviva.ensemble_trajectory import EnsembleTrajectory
    from visviva.errors import (
        AccuracyWarning,
        CloseEncounter,
        ConvergenceError,
        Error,
        FrozenAttribute,
        InternalError,
        Interrupted,
        InvalidInput,
        MissingPackage,
        UnknownKeyword,
        WrongArguments,
    )
    from visviva.expression_force import ExpressionForce
    from visviva.expression_torque import ExpressionTorque
    from visviva.forces import (
        CentralField,
        Coulomb,
        Damper,
        Drag,
        DrivenForce,
        ExpressedForce,
        Gravity,
        Harmonic,
        LinearDrag,
        Oblate,
        PairPotential,
        PostNewtonian,
        QuadraticDrag,
        RotatingFrame,
        SampledDrag,
        Spring,
        UniformElectricField,
        UniformField,
        UniformMagneticField,
    )
    from visviva.generalized import Hamiltonian, Lagrangian, coordinate, time
    from visviva.initial_value import OdeResult, OdeSolution, solve_ivp
    from visviva.integrators import Method, methods
    from visviva.invariants import Invariants
    from visviva.io import load
    from visviva.megno import Megno
    from visviva.particles import Particles
    from visviva.plan import Cost, Plan
    from visviva.rigid_bodies import RigidBodies
    from visviva.rigid_body import RigidBody
    from visviva.rigid_forces import AppliedTorque, CompiledTorque, RotationalDrag
    from visviva.rigid_springs import AttachedSpring
    from visviva.saved_runs import resume
    from visviva.scene import Scene
    from visviva.stats import Stats
    from visviva.status import Status
    from visviva.trajectory import Trajectory

else:  # a type checker that saw this function would let every misspelt name pass

    def __getattr__(name: str) -> Any:
        from importlib import import_module

        if name in _ROOMS:
            value: Any = import_module(f"visviva.{name}")
        elif name in _HOME:
            value = getattr(import_module(f"visviva.{_HOME[name]}"), name)
        else:
            raise AttributeError(f"module 'visviva' has no attribute {name!r}{_nearest(name)}")
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def _nearest(name: str) -> str:
    """The end of the message: where the name is, or the nearest one."""
    if name.startswith("_"):
        return ""
    from importlib import import_module

    from visviva._keywords import did_you_mean
    from visviva._names_elsewhere import ANSWERS, answer

    if told := answer(name, ANSWERS):
        return f"; {told}"
    full = {room: import_module(f"visviva.{room}").__all__ for room in _ROOMS}
    for room, names in full.items():
        if name in names:
            return f"; it is visviva.{room}.{name}"
    return did_you_mean(name, __all__)
