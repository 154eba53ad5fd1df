"""Types to annotate with: the names that `run` and `solve_ivp` take, and what they report to.

`MethodName`, `SolverName` (of `solve_ivp`) and `ColumnName` are written by ``tools/write_names.py`` from what the core
has; a test compares. `TransformationName` is what a time transformation watches. `EventDirection` is which zeros are
events. `EventColumnName`, `GeneralizedEventColumnName`, `SectionColumnName`, `CollisionColumnName`, `ElementName` and
`ScatteringColumnName` are columns of tables. `GeneralizedMethodName`, `DiscreteMethodName` and `GeneralizedColumnName`
are those of systems in generalized coordinates; `TallyName` and `FoilTallyName` what Monte Carlo runs count,
`MaterialName`, `IonName` and `ScreeningName` what foils are made of, and `EulerConvention` names the turns of
`visviva.rigid`. `SymbolicExpression`, `Formula`, `ParameterValues`, `GeneralizedEvent` and `GeneralizedPath` are what
goes into systems in generalized coordinates. A `CompiledFunction` (`NumbaFunction` is one) is at an address, an
`Executor` runs parts elsewhere, `RunSettings` is what advice gives, and `IonHistory` the way of one ion.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Literal, Protocol, SupportsFloat, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

from visviva._keywords import unknown_name

if TYPE_CHECKING:
    from ctypes import _CFunctionType

    import sympy
    from numpy.typing import ArrayLike
    from scipy import LowLevelCallable

    from visviva.events import Event
    from visviva.generalized import Expression, GeneralizedTrajectory

__all__ = [
    "CollisionColumnName",
    "CollisionRule",
    "ColumnName",
    "CompiledFunction",
    "DiscreteMethodName",
    "ElementName",
    "EulerConvention",
    "EventColumnName",
    "EventDirection",
    "EventFunction",
    "Executor",
    "FoilTallyName",
    "Formula",
    "GeneralizedColumnName",
    "GeneralizedEvent",
    "GeneralizedEventColumnName",
    "GeneralizedMethodName",
    "GeneralizedPath",
    "IonHistory",
    "IonName",
    "MaterialName",
    "MethodName",
    "NumbaFunction",
    "ParameterValues",
    "Progress",
    "Report",
    "RunSettings",
    "ScatteringColumnName",
    "ScreeningName",
    "SectionColumnName",
    "SolverName",
    "SymbolicExpression",
    "TallyName",
    "TransformationName",
]

EventFunction: TypeAlias = (
    Callable[[float, NDArray[np.float64], NDArray[np.float64]], SupportsFloat]
    | Callable[
        [float, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], SupportsFloat
    ]
)
"""A function whose zeros are events: of time, positions (N, 3) and velocities (N, 3), and beside rigid bodies of their
orientations (R, 4) and angular velocities (R, 3), too."""

SymbolicExpression: TypeAlias = "sympy.Expr | Expression | float"
"""An expression of SymPy, one that a function of plain Python made, or a number."""

Formula: TypeAlias = "sympy.Expr | Expression | float | Callable[..., SymbolicExpression]"
"""An expression, or a function of plain Python that gives one: ``f(q, v, t, **parameters)``."""

ParameterValues: TypeAlias = "Mapping[str, float] | Mapping[sympy.Symbol, float] | Mapping[sympy.Symbol | str, float]"
"""Values of parameters, by their symbols or names."""

GeneralizedEvent: TypeAlias = "Event | str | sympy.Expr | Callable[..., object]"
"""What is looked for in generalized coordinates: an event, the name of a coordinate, or what passes zero."""

GeneralizedPath: TypeAlias = "GeneralizedTrajectory | tuple[ArrayLike, ArrayLike]"
"""A path in generalized coordinates: a run, or times and places."""


class NumbaFunction(Protocol):
    """What ``@numba.cfunc`` makes: a function at an address.

    Examples
    --------
    >>> import visviva as vv
    >>> def address_of(function: vv.typing.NumbaFunction) -> int:
    ...     return function.address
    """

    native_name: str

    @property
    def address(self) -> int:
        """Where it is."""


CompiledFunction: TypeAlias = "int | NumbaFunction | _CFunctionType | LowLevelCallable"
"""A compiled function: its address, or what numba, ctypes or SciPy make of one."""


class Executor(Protocol):
    """Who runs parts of a piece of work elsewhere, as ``concurrent.futures.Executor`` and a client of Dask do.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> import visviva as vv
    >>> copies = vv.problems.figure_eight().scene.ensemble(mass=[[1.0, 1.0, 1.0], [1.0, 1.0, 1.1]])
    >>> def run_by(executor: vv.typing.Executor) -> vv.EnsembleTrajectory:
    ...     first = executor.submit(len, copies)
    ...     return copies.run(t=1.0, executor=executor)
    >>> with ThreadPoolExecutor() as pool:
    ...     print(run_by(pool))
    EnsembleTrajectory(2 copies, 2 times, 0 failed)
    """

    @property
    def submit(self) -> Callable[..., object]:
        """Take a function and its arguments, and give a future."""


CollisionRule: TypeAlias = Literal["merge", "bounce", "stop"]
"""What spheres do that touch."""

Report: TypeAlias = Callable[[int, int], object]
"""A function ``f(done, total)`` that is told how far a piece of work has come."""

Progress: TypeAlias = bool | Report
"""Whether a run shows how far it has come: True for a bar, False for nothing, or a function that is told."""

TransformationName: TypeAlias = Literal["potential_energy", "distance"]
"""What a time transformation watches: the steps are shorter where it is large."""

EventDirection: TypeAlias = Literal[-1, 0, 1]
"""Which zeros are events: those passed downwards in time, all, or those passed upwards."""

EventColumnName: TypeAlias = Literal["which", "t", "position", "velocity", "member"]
"""Columns of `visviva.events.EventTable`."""

GeneralizedEventColumnName: TypeAlias = EventColumnName | Literal["momentum"]
"""Columns of `visviva.generalized.GeneralizedEventTable`."""

SectionColumnName: TypeAlias = Literal["t", "position", "momentum"]
"""Columns of `visviva.generalized.PoincareSection`."""

CollisionColumnName: TypeAlias = Literal[
    "t", "first", "second", "speed", "position", "energy_lost", "survivor", "member"
]
"""Columns of `visviva.collisions.CollisionTable`."""

ElementName: TypeAlias = Literal[
    "mu", "angular_momentum", "energy", "laplace_runge_lenz", "hodograph_center", "hodograph_radius", "eccentricity",
    "semi_major_axis", "semi_minor_axis", "semi_latus_rectum", "pericenter", "apocenter", "inclination", "node",
    "argument_of_pericenter", "true_anomaly", "eccentric_anomaly", "mean_anomaly", "time_since_pericenter", "period",
    "areal_rate", "turning_angle", "longitude_of_ascending_node", "longitude_of_pericenter", "mean_longitude",
]  # fmt: skip
"""Elements of `visviva.orbits.Elements`."""

GeneralizedColumnName: TypeAlias = Literal["position", "velocity", "momentum", "energy", "reactions"]
"""What a run in generalized coordinates knows at its times."""

TallyName: TypeAlias = Literal["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
"""What `visviva.scattering.monte_carlo` counts of an event."""

ScatteringColumnName: TypeAlias = (
    TallyName | Literal["event", "component", "channel", "weight", "beam_energy", "incidence", "deflection"]
)
"""Columns of `visviva.scattering.scattering_events`."""

FoilTallyName: TypeAlias = Literal[
    "lab_angle",
    "transmitted_angle",
    "reflected_angle",
    "transmitted_energy",
    "reflected_energy",
    "stopped_depth",
    "cm_angle",
]
"""What `visviva.scattering.Foil` counts of an ion."""

EulerConvention: TypeAlias = Literal[
    "xyx", "xyz", "xzx", "xzy", "yxy", "yxz", "yzx", "yzy", "zxy", "zxz", "zyx", "zyz",
    "XYX", "XYZ", "XZX", "XZY", "YXY", "YXZ", "YZX", "YZY", "ZXY", "ZXZ", "ZYX", "ZYZ",
]  # fmt: skip
"""Axes of three turns, in order: capitals for axes that move with the body, small letters for axes that stay."""

MaterialName: TypeAlias = Literal[
    "beryllium", "carbon", "aluminum", "silicon", "titanium", "iron", "nickel", "copper", "germanium", "silver",
    "tantalum", "tungsten", "platinum", "gold", "lead", "water", "silicon_dioxide", "mylar",
]  # fmt: skip
"""Materials of foils that are known by name."""

IonName: TypeAlias = Literal["proton", "deuteron", "triton", "helion", "alpha"]
"""Ions that are known by name."""

ScreeningName: TypeAlias = Literal["zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi"]
"""Screening functions of `visviva.potentials.ScreenedCoulomb`."""

DiscreteMethodName: TypeAlias = Literal[
    "variational_midpoint",
    "variational_trapezoidal",
    "variational_lobatto4",
    "variational_lobatto6",
    "variational_lobatto8",
]
"""Methods that make the action of a discrete path stationary."""

# written by tools/write_names.py: begin
MethodName: TypeAlias = Literal[
    "auto",
    "blanes_moan_rkn4",
    "blanes_moan_rkn6_11",
    "blanes_moan_rkn6_14",
    "blanes_moan_s10",
    "blanes_moan_s6",
    "bogacki_shampine32",
    "boris",
    "boris4",
    "dop853",
    "dormand_prince54",
    "euler",
    "heun",
    "kahan_li6",
    "kahan_li8",
    "leapfrog",
    "leapfrog_dkd",
    "mclachlan4",
    "midpoint",
    "moser_veselov10",
    "moser_veselov2",
    "moser_veselov4",
    "moser_veselov6",
    "moser_veselov8",
    "pefrl4",
    "rattle",
    "rk4",
    "ruth3",
    "sofroniou_spaletta10",
    "sofroniou_spaletta6",
    "sofroniou_spaletta8",
    "stormer13",
    "symplectic_euler",
    "taylor",
    "tsitouras54",
    "verner98",
    "yoshida4",
    "yoshida6",
    "yoshida8",
]
"""Methods of scenes; which takes a scene, its plan says."""
SolverName: TypeAlias = Literal[
    "DOP853",
    "RK23",
    "RK45",
    "bogacki_shampine32",
    "dop853",
    "dormand_prince54",
    "euler",
    "heun",
    "midpoint",
    "rk4",
    "tsitouras54",
    "verner98",
]
"""Methods of `visviva.solve_ivp`: SciPy's names and those here."""
ColumnName: TypeAlias = Literal[
    "angular_momentum",
    "angular_velocity",
    "center_of_mass",
    "energy",
    "kinetic_energy",
    "momentum",
    "orientation",
    "position",
    "potential_energy",
    "velocity",
    "virial",
]
"""What the run of a scene can record at its times."""
# written by tools/write_names.py: end

GeneralizedMethodName: TypeAlias = (
    MethodName
    | DiscreteMethodName
    | Literal["gauss4", "gauss8", "gauss16", "matrix_exponential", "elliptic_functions"]
    | Literal["rattle", "rattle4", "rattle6", "rattle8"]
)
"""Methods of systems in generalized coordinates; which of them takes a system, its plan says."""


class IonHistory(TypedDict):
    """The way of one ion through a foil: what `visviva.scattering.Foil.history` gives, with shapes and units.

    Examples
    --------
    >>> import visviva as vv
    >>> way: vv.typing.IonHistory = vv.scattering.Foil("gold", 0.4).history("alpha", beam_energy=7.687e6, seed=1)
    >>> way["fate"], way["energy"].ndim
    ('transmitted', 2)
    """

    depth: NDArray[np.float64]
    path: NDArray[np.float64]
    element: NDArray[np.uint64]
    impact_parameter: NDArray[np.float64]
    cm_angle: NDArray[np.float64]
    energy: NDArray[np.float64]
    direction: NDArray[np.float64]
    fate: str
    final_angle: float
    final_energy: float
    final_depth: float
    weight: float


class RunSettings(TypedDict, total=False):
    """What `Advice.how` holds: the keywords with which ``run(t, **advice.how)`` follows the advice.

    Attributes
    ----------
    method : str
        One of `visviva.methods`.
    dt, rtol : float
        The step, in the units of the scene, or the relative tolerance, without dimension.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.figure_eight().scene
    >>> settings: vv.typing.RunSettings = {"method": "leapfrog", "dt": 0.01}
    >>> scene.run(t=1.0, **settings).stats.steps
    100
    """

    method: MethodName
    dt: float
    rtol: float


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
