"""The compiled core. Everything here is checked again by Rust; users call the Python package."""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import NDArray

# Sets of forces, and which of them each copy has.
_OwnForces: TypeAlias = tuple[list[list[dict[str, Any]]], list[int]]

class _Scene(TypedDict):
    """One or more copies of a scene: an axis over the copies leads every array."""

    mass: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    radius: NDArray[np.float64] | None
    rigid: _Rigid | None
    forces: list[dict[str, Any]]
    own_forces: _OwnForces | None
    t0: float
    continuation: _Continuation | None

class _Rigid(TypedDict):
    """The rigid bodies of each copy, the last of its bodies, along principal axes; and what acts on them."""

    moments: NDArray[np.float64]
    axes: NDArray[np.float64]
    center: NDArray[np.float64]
    pivoted: list[bool]
    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    loads: list[dict[str, Any]]
    own_loads: tuple[list[list[dict[str, Any]]], list[int]] | None

class _Continuation(TypedDict):
    """How a run with fixed steps came to a scene: what it began with, and what it held at a node, block by block."""

    form: int
    method: str
    dt: float
    t0: float
    node: int
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    held: NDArray[np.float64]

class _Request(_Scene):
    """A scene and what is asked of it."""

    times: NDArray[np.float64]
    end_only: bool
    method: str
    dt: float | None
    time_transformation: str | None
    rtol: float
    rtol_given: bool
    atol: tuple[list[float] | None, list[float] | None] | None
    max_step: float | None
    max_steps: int | None
    record: list[str]
    events: list[dict[str, Any]]
    collisions: str | None
    restitution: float | None

class _Problem(TypedDict):
    """An initial value problem; events with their direction and the number of the zero that ends the run."""

    method: str
    span: tuple[float, float]
    y0: NDArray[np.float64]
    rtol: list[float] | None
    atol: list[float] | None
    first_step: float | None
    max_step: float | None
    dt: float | None
    t_eval: NDArray[np.float64] | None
    dense_output: bool
    events: list[tuple[Callable[..., Any], float, int | None]]
    args: list[Any]
    vectorized: bool
    compiled: tuple[int, int | None] | None

class _Solved(TypedDict):
    """Its solution: states in rows."""

    t: NDArray[np.float64]
    y: NDArray[np.float64]
    extension: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]] | None
    zeros: list[tuple[NDArray[np.float64], NDArray[np.float64]]]
    nfev: int
    status: int
    message: str
    interrupted: bool
    cause: BaseException | None

def eigenmodes(
    mass: NDArray[np.float64], damping: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None: ...
def solve_ivp(fun: object, asked: _Problem) -> _Solved: ...
def interpolate(extension: tuple[NDArray[np.float64], ...], t: NDArray[np.float64]) -> NDArray[np.float64]: ...
def run(
    asked: _Request, *, threads: int | None, progress: Callable[[int, int], object] | None, ensemble: bool
) -> dict[str, Any]: ...
def plan(asked: _Request) -> dict[str, Any]: ...

@final
class Planned:
    def told(self) -> dict[str, Any]: ...

def conserved(
    *,
    mass: NDArray[np.float64],
    forces: list[dict[str, Any]],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64] | None,
    about: NDArray[np.float64],
    columns: list[str],
    turning: tuple[_Rigid, NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> dict[str, NDArray[np.float64]]: ...
def columns() -> list[tuple[str, str, int, bool]]: ...
def conserves(
    *,
    mass: NDArray[np.float64],
    forces: list[dict[str, Any]],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    about: NDArray[np.float64],
) -> dict[str, bool]: ...
def acceleration(
    *,
    mass: NDArray[np.float64],
    forces: list[dict[str, Any]],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    t0: float,
) -> NDArray[np.float64]: ...
def neighbors(
    asked: _Request, toward: NDArray[np.float64], sizes: NDArray[np.float64], *, threads: int | None
) -> tuple[NDArray[np.float64], NDArray[np.int8]]: ...
def differences(
    asked: _Request, toward: NDArray[np.float64], sizes: NDArray[np.float64], *, threads: int | None
) -> tuple[NDArray[np.float64], NDArray[np.int8]]: ...
def methods(rigid: bool = False) -> list[dict[str, Any]]: ...
def potentials() -> list[dict[str, Any]]: ...
def forces() -> list[dict[str, Any]]: ...
def check_load(description: dict[str, Any]) -> None: ...
def acts_between(description: dict[str, Any]) -> bool: ...
def force_of_remaining(description: dict[str, Any], hosts: NDArray[np.int64]) -> dict[str, Any] | None: ...
def dimensions(description: dict[str, Any]) -> list[tuple[float, float, float]]: ...
def fitted(
    sample: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    between: tuple[float, float],
    tolerance: float,
    drag: bool,
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]: ...
def tabulated_drag(
    reynolds: NDArray[np.float64], law: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]: ...
def screening_length(name: str, first: float, second: float) -> float: ...
def check_potential(description: dict[str, Any]) -> tuple[tuple[float, float] | None, bool]: ...
def potential(
    description: dict[str, Any], r: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
def monte_carlo(
    *,
    beam: dict[str, Any],
    n_events: int,
    seed: int,
    first_event: int,
    tallies: list[list[tuple[str, int | tuple[str, int, float | None, float | None] | NDArray[np.float64]]]],
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[
    int,
    bool,
    float,
    list[tuple[int, int, float, float]],
    list[
        tuple[
            list[str],
            list[NDArray[np.float64]],
            NDArray[np.uint64],
            int,
            tuple[NDArray[np.float64], tuple[float, float]] | None,
            NDArray[np.uint64] | None,
        ]
    ],
]: ...
def check_foil(foil: dict[str, Any]) -> None: ...
def foil_run(
    *,
    foil: dict[str, Any],
    run: dict[str, Any],
    n_events: int,
    seed: int,
    first_event: int,
    tallies: list[tuple[str, int | tuple[str, int, float | None, float | None] | NDArray[np.float64]]],
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[
    int,
    bool,
    tuple[float, float],
    tuple[float, float, int],
    NDArray[np.uint64],
    list[tuple[str, NDArray[np.float64], NDArray[np.uint64]]],
]: ...
def foil_history(
    *, foil: dict[str, Any], run: dict[str, Any], seed: int, event: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.uint64], tuple[str, float, float, float, float]]: ...
def foil_stopping(
    *, foil: dict[str, Any], ion: tuple[float, float], energy: NDArray[np.float64], lowest: float | None
) -> NDArray[np.float64]: ...
def scattering_structure(
    description: dict[str, Any], energy: float
) -> tuple[list[tuple[float, float]], list[tuple[float, float, float]]]: ...
def scattering_orbits(
    description: dict[str, Any], energy: NDArray[np.float64]
) -> list[list[tuple[float, float, bool]]]: ...
def scattering_branches(
    description: dict[str, Any], energy: float, angle: NDArray[np.float64]
) -> tuple[list[int], list[NDArray[np.float64]]]: ...
def differential_cross_section(
    description: dict[str, Any], energy: float, angle: NDArray[np.float64], frame: str, mass_ratio: float
) -> NDArray[np.float64]: ...
def scattering_range(description: dict[str, Any]) -> float: ...
def beyond_angle(description: dict[str, Any], energy: float, angle: NDArray[np.float64]) -> NDArray[np.float64]: ...
def transport_cross_sections(
    description: dict[str, Any], energy: NDArray[np.float64], order: int, threads: int | None
) -> NDArray[np.float64]: ...
def collision_integrals(
    description: dict[str, Any],
    temperature: NDArray[np.float64],
    orders: tuple[int, int],
    diameter: float,
    threads: int | None,
) -> NDArray[np.float64]: ...
def monte_carlo_expected(
    *,
    beam: dict[str, Any],
    tallies: list[list[tuple[str, int | tuple[str, int, float | None, float | None] | NDArray[np.float64]]]],
) -> list[NDArray[np.float64]]: ...
def strata_weights(edges: list[float], fractions: list[float]) -> list[float]: ...
def strata_edges(strata: int, smallest: float, b_max: float) -> list[float]: ...
def scattering_events(
    *,
    beam: dict[str, Any],
    n_events: int,
    seed: int,
    first_event: int,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[tuple[NDArray[np.uint64], NDArray[np.uint64]], NDArray[np.float64]]: ...
def deflections(
    description: dict[str, Any],
    energy: NDArray[np.float64],
    impact_parameter: NDArray[np.float64],
    tolerance: float,
    everything: bool,
    threads: int | None,
) -> tuple[list[NDArray[np.float64]], list[NDArray[np.int64]]]: ...
def scattering_function(
    name: str, half_distance: float, mass_ratio: float, values: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def kinematics(
    name: str,
    angle: NDArray[np.float64],
    mass_ratio: NDArray[np.float64],
    q_value: NDArray[np.float64],
    beam_energy: NDArray[np.float64],
    products: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> NDArray[np.float64]: ...
def special_energy(
    name: str,
    mass_ratio: NDArray[np.float64],
    q_value: NDArray[np.float64],
    products: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> NDArray[np.float64]: ...
def moderation(mass_ratio: NDArray[np.float64]) -> NDArray[np.float64]: ...

# An argument of each of two bodies, flat.
_Pairs: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64]]

def collided(
    rule: tuple[str, NDArray[np.float64]], geometry: tuple[str, NDArray[np.float64]], mass: _Pairs, velocity: _Pairs
) -> NDArray[np.float64]: ...
def line_of_centers(
    velocity: _Pairs, impact: NDArray[np.float64], distance: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def contact_time(position: _Pairs, velocity: _Pairs, distance: NDArray[np.float64]) -> NDArray[np.float64]: ...
def reduced_mass(mass: _Pairs) -> NDArray[np.float64]: ...
def relative_split(name: str, mass: _Pairs, vectors: _Pairs) -> NDArray[np.float64]: ...
def rutherford_half_distance(k: float, energy: float) -> float: ...
def solid_angles(edges: NDArray[np.float64]) -> NDArray[np.float64]: ...
def info() -> dict[str, Any]: ...
def nearest(word: str, names: list[str]) -> str | None: ...
def orbit_elements(
    mu: NDArray[np.float64], position: NDArray[np.float64], velocity: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]: ...
def orbit_state(
    name: str,
    mu: NDArray[np.float64],
    pericenter: NDArray[np.float64],
    eccentricity: NDArray[np.float64],
    inclination: NDArray[np.float64],
    node: NDArray[np.float64],
    argument_of_pericenter: NDArray[np.float64],
    anomaly: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def orbit_state_again(elements: list[NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def orbit_propagate(
    mu: NDArray[np.float64], position: NDArray[np.float64], velocity: NDArray[np.float64], t: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def orbit_anomaly(
    name: str, anomaly: NDArray[np.float64], eccentricity: NDArray[np.float64], repulsive: bool
) -> NDArray[np.float64]: ...
def central_effective(
    potentials: list[dict[str, Any]],
    r: NDArray[np.float64],
    angular_momentum: NDArray[np.float64],
    mass: NDArray[np.float64],
    path: bool,
) -> NDArray[np.float64]: ...
def central_circles(
    potentials: list[dict[str, Any]], radius: NDArray[np.float64], mass: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]: ...
def central_circular_radii(potentials: list[dict[str, Any]], angular_momentum: float, mass: float) -> list[float]: ...
def central_ranges(
    potentials: list[dict[str, Any]], energy: float, angular_momentum: float, mass: float
) -> list[tuple[float, float, str]]: ...
def central_motion(
    potentials: list[dict[str, Any]],
    energy: NDArray[np.float64],
    angular_momentum: NDArray[np.float64],
    mass: NDArray[np.float64],
    near: NDArray[np.float64],
) -> tuple[dict[str, NDArray[np.float64]], list[str]]: ...
def central_passage(
    potentials: list[dict[str, Any]],
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    energy: NDArray[np.float64],
    angular_momentum: NDArray[np.float64],
    mass: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def central_inverse_cube(
    strengths: tuple[float, float],
    state: tuple[float, Sequence[float], Sequence[float]],
    angles: NDArray[np.float64],
) -> tuple[dict[str, float], NDArray[np.float64]]: ...
def central_state(
    potentials: list[dict[str, Any]], state: tuple[float, Sequence[float], Sequence[float]]
) -> tuple[dict[str, Any], str]: ...
def central_places(
    potentials: list[dict[str, Any]],
    state: tuple[float, Sequence[float], Sequence[float]],
    values: NDArray[np.float64],
    angles: bool,
) -> NDArray[np.float64]: ...
def orbit_period(mu: NDArray[np.float64], semi_major_axis: NDArray[np.float64]) -> NDArray[np.float64]: ...
def orbit_semi_major_axis(mu: NDArray[np.float64], period: NDArray[np.float64]) -> NDArray[np.float64]: ...
def orbit_free_fall_time(
    mu: NDArray[np.float64], start: NDArray[np.float64], end: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def conic_from_state(
    mass: NDArray[np.float64],
    strength: NDArray[np.float64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> dict[str, NDArray[np.float64]]: ...
def conic_from_constants(
    mass: NDArray[np.float64],
    strength: NDArray[np.float64],
    angular_momentum: NDArray[np.float64],
    energy: NDArray[np.float64],
) -> dict[str, NDArray[np.float64]]: ...
def drag_throw(speed: float, g: float, tau: float | None, terminal_speed: float) -> list[float]: ...
def drag_reynolds_number(density: float, radius: float, speed: float, viscosity: float) -> float: ...
def drag_quadratic(density: float, radius: float, drag_coefficient: float, viscosity: float, speed: float) -> float: ...
def drag_stokes(mass: float, radius: float, viscosity: float, density: float, speed: float) -> float: ...
def drag_crossover_speed(density: float, radius: float, viscosity: float, drag_coefficient: float) -> float: ...
def rotation_form(name: str, values: NDArray[np.float64]) -> NDArray[np.float64]: ...
def rotation_product(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]: ...
def rotated(quaternion: NDArray[np.float64], vector: NDArray[np.float64], back: bool) -> NDArray[np.float64]: ...
def rotation_euler(convention: str, values: NDArray[np.float64], to_angles: bool) -> NDArray[np.float64]: ...
def rotation_rates(
    convention: str, angles: NDArray[np.float64], values: NDArray[np.float64], in_body: bool, to_rates: bool
) -> NDArray[np.float64]: ...
def rigid_velocity(values: NDArray[np.float64]) -> NDArray[np.float64]: ...
def rigid_screw(values: NDArray[np.float64]) -> NDArray[np.float64]: ...
def free_rotation(
    moments: NDArray[np.float64],
    angular_velocity: NDArray[np.float64],
    orientation: NDArray[np.float64],
    t: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
def polhode(moments: NDArray[np.float64], angular_velocity: NDArray[np.float64]) -> dict[str, Any]: ...

# Mass (or volume), center and tensor about it.
_Body: TypeAlias = tuple[float, NDArray[np.float64], NDArray[np.float64]]

def particles_tensor(mass: NDArray[np.float64], position: NDArray[np.float64]) -> NDArray[np.float64]: ...
def bodies_together(mass: NDArray[np.float64], center: NDArray[np.float64], tensor: NDArray[np.float64]) -> _Body: ...
def tensor_about(tensor: NDArray[np.float64], mass: float, offset: NDArray[np.float64]) -> NDArray[np.float64]: ...
def tensor_rotated(tensor: NDArray[np.float64], quaternion: NDArray[np.float64]) -> NDArray[np.float64]: ...
def principal_axes(tensor: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def solid_tensor(kind: str, mass: float, lengths: list[float]) -> NDArray[np.float64]: ...
def mesh_enclosed(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> _Body: ...

# A, C, mass, g and R.
_Top: TypeAlias = tuple[float, float, float, float, float]

def top_sleeping_threshold(top: _Top) -> float: ...
def top_least_spin(top: _Top, theta: float) -> float: ...
def top_steady_precession(top: _Top, theta: float, spin: float) -> tuple[list[float], list[float]]: ...
def top_nutation(top: _Top, theta: float, theta_dot: float, phi_dot: float, psi_dot: float) -> dict[str, Any]: ...
def top_motion(
    top: _Top,
    angles: tuple[float, float, float],
    rates: tuple[float, float, float],
    t: NDArray[np.float64],
) -> NDArray[np.float64]: ...

# Operation, the places of its arguments among the nodes before it, and a value.
_Node: TypeAlias = tuple[str, list[int], float]

@final
class GeneralizedModel:
    def __new__(cls, described: dict[str, Any]) -> GeneralizedModel: ...
    def structure(self) -> dict[str, Any]: ...
    def expressions(self, name: str) -> tuple[list[_Node], list[int]]: ...
    def poisson(self, nodes: list[_Node], roots: tuple[int, int]) -> tuple[list[_Node], list[int]]: ...
    def derivatives(self, nodes: list[_Node], roots: list[int]) -> tuple[list[_Node], list[int]]: ...
    def evaluate(
        self,
        nodes: list[_Node],
        roots: list[int],
        t: NDArray[np.float64],
        states: NDArray[np.float64],
        parameters: NDArray[np.float64],
    ) -> NDArray[np.float64]: ...
    def columns(
        self, t: NDArray[np.float64], states: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]: ...
    def rates(
        self, t: NDArray[np.float64], states: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]: ...
    def projected(
        self, t: float, state: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> tuple[list[float], list[float], NDArray[np.float64]]: ...
    def equilibria(
        self, t: float, starts: NDArray[np.float64], parameters: NDArray[np.float64], descending: bool
    ) -> list[tuple[list[float], bool] | None]: ...
    def matrices(
        self, t: float, states: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def oscillation(
        self, t: float, state: NDArray[np.float64], parameters: NDArray[np.float64], turn: float | None
    ) -> tuple[float, float, float, float]: ...
    def legendre(self) -> tuple[list[_Node], list[int]]: ...
    def by_degree(self) -> tuple[list[_Node], list[int]]: ...
    def routhian(self, cyclic: list[int]) -> tuple[list[_Node], list[int]]: ...
    def variational(self) -> GeneralizedModel: ...
    def segments(
        self,
        method: str,
        t: NDArray[np.float64],
        places: NDArray[np.float64],
        parameters: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]: ...
    def run(
        self,
        asked: dict[str, Any],
        states: NDArray[np.float64],
        parameters: NDArray[np.float64],
        threads: int | None,
        progress: Callable[[int, int], object] | None,
    ) -> dict[str, Any]: ...
