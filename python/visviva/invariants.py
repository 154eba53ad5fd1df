"""Momentum, angular momentum, energy, center of mass: all of them at once, with König's split.

The sums are the core's compensated ones. The internal kinetic energy and the spin are formed from
velocities relative to the center of mass, not as differences of large totals.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._html import Shown
from visviva._keywords import known_keywords
from visviva._mergers import hosts, remaining
from visviva._text import short_repr, table
from visviva._turning import kept_by_bodies
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.scene import Scene

__all__ = ["Invariants"]

_COLUMNS = ["kinetic_energy", "potential_energy", "energy", "momentum", "angular_momentum", "center_of_mass", "virial"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class Invariants(Shown):
    """The conserved quantities of a state.

    Units: those of the scene.

    Attributes
    ----------
    total_mass : float
    center_of_mass, center_of_mass_velocity, momentum : ndarray, shape (3,)
    angular_momentum : ndarray, shape (3,)
        About the reference point.
    spin : ndarray, shape (3,)
        Angular momentum about the center of mass; angular_momentum = spin + (R − a) × P.
    torque : ndarray, shape (3,)
        Torque about the reference point: the rate of change of `angular_momentum` about a fixed
        point, of `spin` about the center of mass; NaN, as the virial is, beside rigid bodies that torques turn.
    kinetic_energy, potential_energy, energy : float
    center_of_mass_kinetic_energy, internal_kinetic_energy : float
        König's split of the kinetic energy: P²/2M and the rest.
    virial : float
        Σ r·F; NaN beside forces that look at velocities or times (drag, magnetic fields, drives).

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2 (König's theorem, angular momentum) and §
    3.4 (virial).

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.problems.kepler(e=0.5).scene.invariants()
    >>> round(found.energy, 12), found.momentum.round(12).tolist()
    (-0.125, [0.0, 0.0, 0.0])
    """

    total_mass: float
    center_of_mass: NDArray[np.float64]
    center_of_mass_velocity: NDArray[np.float64]
    momentum: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    spin: NDArray[np.float64]
    torque: NDArray[np.float64]
    kinetic_energy: float
    potential_energy: float
    energy: float
    center_of_mass_kinetic_energy: float
    internal_kinetic_energy: float
    virial: float

    def __repr__(self) -> str:
        return short_repr(self)

    def __str__(self) -> str:
        return table(self)


def conserved(
    scene: Scene,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64] | None,
    about: NDArray[np.float64],
    columns: list[str],
    turning: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> dict[str, NDArray[np.float64]]:
    """The core's conserved quantities of many states: position (T, N, 3), results (T,) or (T, 3).

    Orientations (T, K, 4) and angular velocities (T, K, 3) of rigid bodies are the scene's own if not given.
    """
    rigid, own = scene._keywords["rigid"], None
    if rigid is not None:
        if "virial" in columns and not scene._turns_freely:
            raise InvalidInput("virial", "it is not known of rigid bodies that torques turn")
        if turning is None:
            turning = (rigid["orientation"], rigid["angular_velocity"])
        turns, spins = (np.broadcast_to(each, (len(position), *each.shape[1:])) for each in turning)
        own = (rigid, turns, spins)
    return _core.conserved(
        mass=scene.particles.mass,
        forces=scene._keywords["forces"],
        position=position,
        velocity=velocity,
        about=about,
        columns=columns,
        turning=own,
    )


def kept_by_forces(scene: Scene, about: NDArray[np.float64]) -> dict[str, bool]:
    """What the forces leave constant: energy, momentum, angular momentum about a point at rest, and spin."""
    p = scene.particles
    flags = _core.conserves(
        mass=p.mass, forces=scene._keywords["forces"], position=p.position, velocity=p.velocity, about=about
    )
    rigid = scene._keywords["rigid"]
    return flags if rigid is None else kept_by_bodies(rigid, flags)


def reference_point(about: ArrayLike | str | None) -> NDArray[np.float64] | None:
    """The fixed point asked for; None stands for the center of mass."""
    if about is None:
        return np.zeros(3)
    if isinstance(about, str):
        if about != "center_of_mass":
            raise InvalidInput("about", f"expected three coordinates or 'center_of_mass', got {about!r}")
        return None
    return float_array("about", about, (3,))


def internal_motion(
    scene: Scene,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    turning: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> dict[str, NDArray[np.float64]]:
    """Kinetic energy and angular momentum of many states in their center-of-mass frames."""
    total = fsum(scene.particles.mass)
    moments = conserved(scene, position, velocity, np.zeros(3), ["momentum", "center_of_mass"])
    with np.errstate(over="ignore", invalid="ignore"):
        relative_position = position - moments["center_of_mass"][:, None]
        relative_velocity = velocity - (moments["momentum"] / total)[:, None]
    wanted = ["kinetic_energy", "angular_momentum"]
    return conserved(scene, relative_position, relative_velocity, np.zeros(3), wanted, turning)


# What is beyond float64 is infinite, and NaN where it is not known.
@np.errstate(over="ignore", invalid="ignore")
def invariants_of(scene: Scene, about: ArrayLike | str | None) -> Invariants:
    """Everything at the state of a scene."""
    p = scene.particles
    parts = hosts(p) if scene.rigid_bodies is None else None
    if parts is not None:
        # What is a part of another has no energy of its own.
        scene = remaining(scene, parts)
        p = scene.particles
    total = fsum(p.mass)
    if not total > 0.0:
        raise InvalidInput("mass", "the total mass is zero, so there is nothing to conserve; give one body a mass")
    point = reference_point(about)
    position, velocity = p.position[None], p.velocity[None]
    known = _COLUMNS if scene._turns_freely else [name for name in _COLUMNS if name != "virial"]
    sums: dict[str, Any] = conserved(scene, position, velocity, np.zeros(3) if point is None else point, known)
    internal = internal_motion(scene, position, velocity)
    spin = internal["angular_momentum"][0]
    momentum, center = sums["momentum"][0], sums["center_of_mass"][0]
    arms = p.position - (center if point is None else point)
    # Of bodies that torques turn, pulls at their points and from their shapes are not told.
    pulls = scene.acceleration() if scene._turns_freely else np.full(arms.shape, np.nan)
    torques = np.cross(arms, p.mass[:, None] * pulls)
    return Invariants(
        total_mass=total,
        center_of_mass=center,
        center_of_mass_velocity=momentum / total,
        momentum=momentum,
        angular_momentum=spin if point is None else sums["angular_momentum"][0],
        spin=spin,
        torque=np.array([summed(column) if np.isfinite(column).all() else np.nan for column in torques.T]),
        kinetic_energy=float(sums["kinetic_energy"][0]),
        potential_energy=float(sums["potential_energy"][0]),
        energy=float(sums["energy"][0]),
        # Its square may overflow where the energy does not.
        center_of_mass_kinetic_energy=summed(momentum * (momentum / total)) / 2.0,
        internal_kinetic_energy=float(internal["kinetic_energy"][0]),
        virial=float(sums["virial"][0]) if "virial" in sums else np.nan,
    )


def summed(values: ArrayLike) -> float:
    """The sum of numbers, rounded once; infinite or NaN where they or it are."""
    try:
        return fsum(np.ravel(values))
    except (OverflowError, ValueError):  # beyond float64, and of infinities of both signs
        with np.errstate(over="ignore", invalid="ignore"):
            return float(np.sum(values))


def __dir__() -> list[str]:
    return list(__all__)
