"""How well the invariants held: one row for each, against a stated scale.

Drift is measured from the scene's own initial state, on the rows that were recorded, and divided by a
scale that does not vanish when the invariant does: a total momentum of zero drifts relative to the
momenta that cancel in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords, one_of
from visviva._mergers import by_era
from visviva._text import count
from visviva._turning import spin_scale
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce
from visviva.invariants import conserved, internal_motion, invariants_of, kept_by_forces, reference_point, summed

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.scene import Scene
    from visviva.trajectory import Trajectory

__all__ = ["Conservation", "Drift"]

#: The drifts of a report, in the order of its table, as its attributes have them.
ROWS = ("energy", "momentum", "angular_momentum", "center_of_mass")
_EPSILON = float(np.finfo(float).eps)


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Drift(Record):
    """How far one quantity moved from its initial value.

    Attributes
    ----------
    name : str
    scale : float
        What `max`, `end` and `rms` are divided by, in the user's units.
    max, end, rms : float
        Largest, last and root-mean-square distance from the initial value, over `scale`. Infinite, or NaN where it is
        not known, of what is beyond float64.
    slope : float
        Least-squares growth of that distance per unit of time, over `scale`: near zero where the
        error is bounded.
    conserved : bool
        Whether the scene's forces, and the collisions of the run, conserve it at all.

    Examples
    --------
    >>> import visviva as vv
    >>> drift = vv.problems.figure_eight().scene.run(t=[1.0, 2.0], rtol=1e-12).conservation().energy
    >>> drift.name, drift.conserved, drift.max < 1e-10
    ('energy', True, True)
    """

    name: str
    scale: float
    max: float
    end: float
    rms: float
    slope: float
    conserved: bool


@known_keywords
@dataclass(frozen=True, slots=True)
class Conservation(Shown):
    """Drift of each invariant of a trajectory; prints as a table.

    Units: drifts are relative to their scales, without dimension, and so is the virial; each `Drift.scale` is in those
    of the scene.

    Attributes
    ----------
    energy, momentum, angular_momentum, center_of_mass : Drift
        Scales: |E₀| (kinetic + |potential| if the energy cancels to round-off), Σ m|v|,
        Σ m|r||v| (and the spins of rigid bodies), and the size of the system. The center of mass is
        compared with uniform motion.
    virial : float
        ⟨2T + Σ r·F⟩ / ⟨2T⟩ over the time recorded, T being the internal kinetic energy: tends to zero
        in a bound system. NaN if positions or velocities were not recorded, with rigid
        bodies, and beside forces that look at velocities or times.
    about : str
        The reference point of the angular momentum.
    massless : int
        Bodies that carry nothing of all this: their motion is not judged by it.
    collisions : int
        Collisions of the run. Energy is not conserved by those that take some, nor by mergers, in which angular
        momentum becomes spin that no body has here.
    without_potential : int
        Forces given to `ExpressionForce` as ``force=`` or ``acceleration=``, whose work is in no potential energy, even
        where they have one: given as ``potential=`` it is conserved together with the kinetic energy.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2 (König's theorem, angular momentum) and §
    3.4 (virial).

    By the name of its row, as it is printed, a drift is there, too: ``kept["center of mass"]``.

    Examples
    --------
    >>> import visviva as vv
    >>> kept = vv.problems.figure_eight().scene.run(t=[1.0, 2.0], rtol=1e-12).conservation()
    >>> kept.energy.max < 1e-10, kept["momentum"].conserved, kept.about
    (True, True, 'origin')
    """

    energy: Drift
    momentum: Drift
    angular_momentum: Drift
    center_of_mass: Drift
    virial: float
    about: str
    massless: int
    collisions: int
    without_potential: int = 0

    @property
    def rows(self) -> tuple[Drift, ...]:
        """The drifts, in the order of the table.

        Examples
        --------
        >>> import visviva as vv
        >>> kept = vv.problems.figure_eight().scene.run(t=[1.0, 2.0], rtol=1e-12).conservation()
        >>> [row.name for row in kept.rows]
        ['energy', 'momentum', 'angular momentum', 'center of mass']
        """
        return self.energy, self.momentum, self.angular_momentum, self.center_of_mass

    def __getitem__(self, name: str) -> Drift:
        drift: Drift = getattr(self, row_of(name))
        return drift

    @property
    def _what_acts(self) -> str:
        return "these forces and collisions" if self.collisions else "these forces"

    def __repr__(self) -> str:
        largest = ", ".join(f"{row.name} {row.max:.1e}" for row in self.rows if row.conserved)
        return f"Conservation({largest or 'nothing is conserved'})"

    def _sheet(self) -> Sheet:
        rows = [
            (row.name, *(f"{v:.1e}" for v in (row.max, row.end, row.rms)), f"{row.scale:.6g}")
            if row.conserved
            else (f"{row.name} (not conserved by {self._what_acts})", "", "", "", "")
            for row in self.rows
        ]
        below = "; ".join([f"virial {self.virial:.1e}", *self._hints])
        return Sheet("Conservation", rows, ("", "max", "end", "rms", "relative to"), below)

    def __str__(self) -> str:
        lines = [f"{'':<34}{'max':>10}{'end':>10}{'rms':>10}{'relative to':>14}"]
        for row in self.rows:
            name = row.name if row is not self.angular_momentum else f"{row.name} ({self.about})"
            values = "".join(f"{value:>10.1e}" for value in (row.max, row.end, row.rms))
            note = "" if row.conserved else f"  not conserved by {self._what_acts}"
            lines.append(f"{name:<34}{values}{row.scale:>14.6g}{note}")
        lines.append(f"{'virial ⟨2T + Σ r·F⟩ / ⟨2T⟩':<34}{self.virial:>10.1e}")
        if self.massless:
            lines.append(f"{count(self.massless, 'massless body', 'massless bodies')} not judged: no share in any row")
        return "\n".join([*lines, *self._hints])

    @property
    def _hints(self) -> list[str]:
        if not self.without_potential:
            return []
        forces = count(self.without_potential, "force is", "forces are")
        return [
            f"{forces} given by components, whose work is in no energy; where there is a potential energy, "
            "ExpressionForce(potential=…) keeps account of it"
        ]


def row_of(name: str) -> str:
    """The attribute of a row by its name, as the table or the attribute has it.

    Raises
    ------
    visviva.InvalidInput
        For any other, with the nearest.
    """
    return one_of("name", name.replace(" ", "_") if isinstance(name, str) else name, ROWS)


def has_rows(trajectory: Trajectory) -> bool:
    """Whether there is a row of what was recorded, which a copy that failed before its first has not."""
    return any(not np.isnan(trajectory._column(name)).all() for name in trajectory.recorded[:1])


# What is beyond float64 is infinite, or NaN where its drift is not known.
@np.errstate(over="ignore", invalid="ignore")
def conservation_of(trajectory: Trajectory, about: ArrayLike | str | None) -> Conservation:
    """The table of a trajectory."""
    scene = trajectory.scene
    start = invariants_of(scene, about)
    if not has_rows(trajectory):
        raise InvalidInput("record", "there is no row from which to compute drifts")
    point = reference_point(about)
    mass, position, velocity = scene.particles.mass, scene.particles.position, scene.particles.velocity
    origin = start.center_of_mass if point is None else point
    speeds = _lengths(velocity - (start.center_of_mass_velocity if point is None else 0.0))
    distances = _lengths(position - origin)
    spread = float(_lengths(position - start.center_of_mass).max())
    conserved = kept_by_forces(scene, origin)
    closed, steady = conserved["momentum"], conserved["spin" if point is None else "angular_momentum"]
    collisions = trajectory.collisions if "collisions" in trajectory._result else None
    merged = collisions is not None and bool((collisions.survivor >= 0).any())
    lost = merged or (collisions is not None and bool(collisions.energy_lost.any()))

    t = trajectory.t
    canceled = start.kinetic_energy + abs(start.potential_energy)
    energy_scale = abs(start.energy) if abs(start.energy) > 64 * _EPSILON * canceled else canceled
    about_origin = point is not None and not point.any()
    if about_origin:
        angular = trajectory.angular_momentum
    else:
        angular = trajectory.angular_momentum_about("center_of_mass" if point is None else point)
    # Where the momentum is beyond float64, how the center moves is not known.
    moving = np.where(np.isfinite(start.center_of_mass_velocity), start.center_of_mass_velocity, np.nan)
    uniform = start.center_of_mass + np.multiply.outer(t - scene.t0, moving)
    return Conservation(
        energy=_drift(
            "energy", t, trajectory.energy - start.energy, energy_scale, conserved=conserved["energy"] and not lost
        ),
        momentum=_drift(
            "momentum",
            t,
            trajectory.momentum - start.momentum,
            summed(mass * _lengths(velocity)),
            conserved=closed,
        ),
        angular_momentum=_drift(
            "angular momentum",
            t,
            angular - start.angular_momentum,
            summed(mass * distances * speeds) + spin_scale(scene),
            conserved=steady and not merged,
        ),
        center_of_mass=_drift("center of mass", t, trajectory.center_of_mass - uniform, spread, conserved=closed),
        virial=_virial(trajectory, closed) if scene.rigid_bodies is None else np.nan,
        about="center of mass" if point is None else "origin" if about_origin else "given point",
        massless=int(np.count_nonzero(mass == 0.0)),
        collisions=0 if collisions is None else len(collisions),
        without_potential=sum(isinstance(each, ExpressedForce) and each.gives != "potential" for each in scene.forces),
    )


def _lengths(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths of vectors (…, 3), by way of a power of two with which no square overflows or vanishes."""
    _, power = np.frexp(np.abs(vectors).max(initial=0.0, where=np.isfinite(vectors)))
    lengths: NDArray[np.float64] = np.ldexp(np.linalg.norm(np.ldexp(vectors, -power), axis=-1), power)
    return lengths


def _drift(name: str, t: NDArray[np.float64], change: NDArray[np.float64], scale: float, *, conserved: bool) -> Drift:
    sizes = np.abs(change) if change.ndim == 1 else _lengths(change)
    reached = ~np.isnan(sizes)
    if not reached.any() or not np.isfinite(scale):
        return Drift(name, scale, max=np.nan, end=np.nan, rms=np.nan, slope=np.nan, conserved=conserved)
    divisor = scale if scale > 0.0 else 1.0
    sizes, times = sizes[reached] / divisor, t[reached]
    centered = times - times.mean()
    spread = float(centered @ centered)
    return Drift(
        name=name,
        scale=divisor,
        max=float(sizes.max()),
        end=float(sizes[-1]),
        rms=float(_lengths(sizes) / np.sqrt(len(sizes))),
        slope=float(centered @ sizes) / spread if spread > 0.0 else 0.0,
        conserved=conserved,
    )


def _virial(trajectory: Trajectory, closed: bool) -> float:
    t = trajectory.t
    # Over no time there is no mean.
    if not {"position", "velocity"} <= set(trajectory.recorded) or len(t) < 2 or t[0] == t[-1]:
        return float("nan")

    def told(scene: Scene, position: NDArray[np.float64], velocity: NDArray[np.float64] | None) -> Any:
        return conserved(scene, position, velocity, np.zeros(3), ["kinetic_energy", "virial"])

    sums = by_era(trajectory, told)
    kinetic = by_era(trajectory, internal_motion)["kinetic_energy"] if closed else sums["kinetic_energy"]
    weights = np.abs(np.diff(t))

    def mean(values: NDArray[np.float64]) -> float:
        return summed(weights * (values[1:] + values[:-1]) / 2.0) / summed(weights)

    twice = mean(2.0 * kinetic)
    return (twice + mean(sums["virial"])) / twice if twice > 0.0 else float("nan")


def __dir__() -> list[str]:
    return list(__all__)
