"""Forty scenes whose results are recorded to the bit; see ``test_recorded_bits.py``.

Each scene stands by itself and is described by what is in it, so that a deliberate change (a defect put right, a better
method) touches the one line that it must. Only the public interface is used. Nothing here calls the platform's
``sin`` or ``exp`` to make a scene: the numbers come from Python's Mersenne Twister and elementary arithmetic.

What may change when a known defect is put right says so in `MAY_CHANGE`; everything else may not.
"""

from __future__ import annotations

import hashlib
import random
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

Arrays = dict[str, NDArray[Any]]
SCENES: dict[str, Callable[[], Arrays]] = {}
MAY_CHANGE: dict[str, str] = {}

MOVES = "the drift of a closed group is always taken out, and this one moves or is not centered on the origin"
TOGETHER = "what all bodies share of a field is taken out as the center of mass is"
MASSLESS = "massive bodies are integrated once and massless ones follow their steps, independent of their neighbors"


def scene(name: str, may_change: str = "") -> Callable[[Callable[[], Arrays]], Callable[[], Arrays]]:
    """Registers a scene: a function that runs it and returns the arrays to be recorded."""

    def register(function: Callable[[], Arrays]) -> Callable[[], Arrays]:
        assert name not in SCENES
        SCENES[name] = function
        if may_change:
            MAY_CHANGE[name] = may_change
        return function

    return register


def numbers(seed: int, shape: tuple[int, ...], low: float, high: float) -> NDArray[np.float64]:
    draw = random.Random(seed)
    return np.array([low + (high - low) * draw.random() for _ in range(int(np.prod(shape)))]).reshape(shape)


def centered(count: int, seed: int, massless: int = 0, speed: float = 0.3) -> vv.Particles:
    """Pairs of equal bodies mirrored at the origin, one after the other, and massless bodies.

    However the pairs are summed in order, the center of mass and the momentum are zero without a rounding.
    """
    half = count // 2
    mass, place = numbers(seed, (half,), 0.5, 1.5) / count, numbers(seed + 1, (half, 3), -1.0, 1.0)
    move = numbers(seed + 2, (half, 3), -speed, speed)
    x, v = (np.stack([one, -one], axis=1).reshape(-1, 3) for one in (place, move))
    x = np.concatenate([x, numbers(seed + 3, (massless, 3), -2.0, 2.0)])
    v = np.concatenate([v, numbers(seed + 4, (massless, 3), -speed, speed)])
    return vv.Particles(np.concatenate([np.repeat(mass, 2), np.zeros(massless)]), x, v)


def anywhere(count: int, seed: int) -> vv.Particles:
    mass = numbers(seed, (count,), 0.5, 1.5) / count
    return vv.Particles(mass, numbers(seed + 1, (count, 3), -1.0, 1.5), numbers(seed + 2, (count, 3), -0.3, 0.4))


def states(out: vv.Trajectory | vv.EnsembleTrajectory) -> Arrays:
    return {"position": out.position, "velocity": out.velocity}


def columns(out: vv.Trajectory | vv.EnsembleTrajectory, *names: str) -> Arrays:
    return {name: getattr(out, name) for name in names}


SOFT = vv.Gravity(1.0, softening=0.2)
YUKAWA = vv.CentralField(vv.potentials.Yukawa(k=-2.0, length=1.5), center=[0.1, 0.0, -0.2])
LENNARD_JONES = vv.CentralField(vv.potentials.LennardJones(epsilon=1.0, sigma=0.5))
APART = vv.Particles([1.0, 2.0], [[1.5, 0.0, 0.1], [0.0, 2.0, -0.3]], [[0.0, 0.6, 0.1], [-0.5, 0.1, 0.0]])
ONE = vv.Particles([2.0], [[1.0, 0.2, -0.3]], [[0.1, 1.1, 0.4]])
BETWEEN = [0.0, 0.1, 0.137, 0.5, 0.503, 0.77]  # on nodes of a step of 0.01 and between them


# Gravity, every method.


for name in ("rk4", "leapfrog", "yoshida4", "kahan_li8", "stormer13"):

    @scene(f"{name}: six softened bodies, outputs on and between nodes")
    def _(method: str = name) -> Arrays:
        return states(vv.Scene(centered(6, 1), SOFT).run(t=BETWEEN, method=method, dt=0.01))


@scene("dop853: six softened bodies, dense output")
def _() -> Arrays:
    return states(vv.Scene(centered(6, 1), SOFT).run(t=BETWEEN, method="dop853", rtol=1e-11))


# Gravity, every size of kernel.


@scene("kahan_li8: figure eight backwards in the plane")
def _() -> Arrays:
    return states(vv.problems.figure_eight().scene.run(t=[-0.5, -1.0, -2.003], method="kahan_li8", dt=0.01))


@scene("stormer13: figure eight, relative to its first body")
def _() -> Arrays:
    return states(vv.problems.figure_eight().scene.run(t=[1.0, 2.003, 6.3], method="stormer13", dt=0.01))


@scene("stormer13: two bodies backwards")
def _() -> Arrays:
    return states(vv.problems.kepler(e=0.25).scene.run(t=[-1.0, -3.0], method="stormer13", dt=0.01))


@scene("dop853: Pleiades in the plane", MOVES)
def _() -> Arrays:
    return states(vv.problems.pleiades().scene.run(t=[0.5, 1.0, 3.0], method="dop853", rtol=1e-12))


@scene("leapfrog: outer Solar System", MOVES)
def _() -> Arrays:
    return states(vv.problems.outer_solar_system().scene.run(t=[995.0, 20000.0], method="leapfrog", dt=10.0))


@scene("stormer13: outer Solar System", MOVES)
def _() -> Arrays:
    return states(vv.problems.outer_solar_system().scene.run(t=[995.0, 20000.0], method="stormer13", dt=10.0))


@scene("dop853: ten bodies")
def _() -> Arrays:
    return states(vv.Scene(centered(10, 7), SOFT).run(t=[0.3, 2.0], method="dop853", rtol=1e-10))


@scene("leapfrog: 38 bodies")
def _() -> Arrays:
    return states(vv.Scene(centered(38, 11), SOFT).run(t=[0.105, 0.5], method="leapfrog", dt=0.01))


@scene("rk4: 64 bodies")
def _() -> Arrays:
    return states(vv.Scene(centered(64, 12), SOFT).run(t=0.5, method="rk4", dt=0.01))


@scene("kahan_li8: 200 bodies")
def _() -> Arrays:
    return states(vv.Scene(centered(200, 13), SOFT).run(t=0.1, method="kahan_li8", dt=0.02))


@scene("dop853: 200 bodies, three threads")
def _() -> Arrays:
    return states(vv.Scene(centered(200, 13), SOFT).run(t=[0.1, 0.25], method="dop853", rtol=1e-9, threads=3))


@scene("yoshida4: 33 bodies that move as a whole", MOVES)
def _() -> Arrays:
    return states(vv.Scene(anywhere(33, 14), SOFT).run(t=0.5, method="yoshida4", dt=0.01))


# Massless bodies.


@scene("leapfrog: four bodies and 70 massless")
def _() -> Arrays:
    return states(vv.Scene(centered(4, 21, massless=70), SOFT).run(t=[0.5, 1.0], method="leapfrog", dt=0.01))


@scene("stormer13: two bodies and five massless")
def _() -> Arrays:
    return states(vv.Scene(centered(2, 22, massless=5), SOFT).run(t=[0.5, 1.0], method="stormer13", dt=0.01))


@scene("dop853: four bodies and 70 massless", MASSLESS)
def _() -> Arrays:
    return states(vv.Scene(centered(4, 21, massless=70), SOFT).run(t=[0.5, 1.0], method="dop853", rtol=1e-10))


@scene("closed form: one massive body and nine massless")
def _() -> Arrays:
    orbiting = centered(0, 24, massless=9, speed=1.0)
    mass = np.concatenate([[3.0], orbiting.mass])
    x, v = (np.concatenate([np.zeros((1, 3)), array]) for array in (orbiting.position, orbiting.velocity))
    return states(vv.Scene(vv.Particles(mass, x, v), vv.Gravity(0.5)).run(t=[-1.0, -7.0]))


# Fields.


@scene("dop853: Yukawa center")
def _() -> Arrays:
    return states(vv.Scene(APART, YUKAWA).run(t=[0.4, 3.0], method="dop853", rtol=1e-11))


@scene("kahan_li8: Lennard-Jones center in a uniform field")
def _() -> Arrays:
    fields = vv.Scene(APART, LENNARD_JONES, vv.UniformField([0.0, 0.0, -0.1]))
    return states(fields.run(t=[0.4, 2.0], method="kahan_li8", dt=0.01))


@scene("rk4: twenty bodies in two central fields, started at t = 3")
def _() -> Arrays:
    fields = vv.Scene(centered(20, 31, speed=0.5), YUKAWA, vv.CentralField(vv.potentials.Coulomb(k=0.5)), t0=3.0)
    return states(fields.run(t=[3.25, 3.996], method="rk4", dt=0.01))


@scene("leapfrog: gravity and a uniform field", TOGETHER)
def _() -> Arrays:
    return states(
        vv.Scene(centered(6, 1), SOFT, vv.UniformField([0.0, 0.5, -1.0])).run(t=1.0, method="leapfrog", dt=0.01)
    )


@scene("dop853: gravity and a uniform field", TOGETHER)
def _() -> Arrays:
    return states(
        vv.Scene(centered(6, 1), SOFT, vv.UniformField([0.0, 0.5, -1.0])).run(t=1.0, method="dop853", rtol=1e-10)
    )


@scene("kahan_li8: gravity and a Yukawa center")
def _() -> Arrays:
    return states(vv.Scene(centered(6, 1), SOFT, YUKAWA).run(t=[0.5, 1.0], method="kahan_li8", dt=0.01))


# Closed forms.


@scene("closed forms: free, in a uniform field, a repelling center, an ellipse of e = 0.9")
def _() -> Arrays:
    t = [0.5, 2.5, 1e3]
    found = {
        "free": vv.Scene(ONE).run(t=t),
        "uniform": vv.Scene(ONE, vv.UniformField([0.0, 0.3, -9.81])).run(t=t),
        "repelling": vv.Scene(ONE, vv.CentralField(vv.potentials.Coulomb(k=3.0))).run(t=t),
        "ellipse": vv.problems.kepler(e=0.9).scene.run(t=t),
    }
    return {f"{name}.{column}": array for name, out in found.items() for column, array in states(out).items()}


# Ensembles.


def _eights(count: int) -> NDArray[np.float64]:
    start = vv.problems.figure_eight().scene.particles.position
    stretched: NDArray[np.float64] = start * (1.0 + numbers(41, (count, 1, 1), -1e-3, 1e-3))
    return stretched


@scene("dop853: eleven figure eights, two threads")
def _() -> Arrays:
    out = vv.problems.figure_eight().scene.ensemble(position=_eights(11))
    out = out.run(t=[1.0, 6.0], method="dop853", rtol=1e-10, threads=2)
    return states(out)


@scene("stormer13: eleven figure eights")
def _() -> Arrays:
    copies = vv.problems.figure_eight().scene.ensemble(position=_eights(11))
    return states(copies.run(t=[1.0, 6.003], method="stormer13", dt=0.01))


@scene("kahan_li8: nine members of six bodies with own masses")
def _() -> Arrays:
    start = vv.Scene(centered(6, 1), SOFT)
    mass = start.particles.mass * (1.0 + np.arange(9)[:, None] / 16.0)
    return states(start.ensemble(mass=mass).run(t=[0.5, 1.0], method="kahan_li8", dt=0.01))


@scene("dop853: five members of ten bodies with own masses, one thread", "members ran with another member's masses")
def _() -> Arrays:
    start = vv.Scene(centered(10, 7), SOFT)
    mass = start.particles.mass * (1.0 + np.arange(5)[:, None] / 16.0)
    return states(start.ensemble(mass=mass).run(t=1.0, method="dop853", rtol=1e-10, threads=1))


@scene("leapfrog: three members in a Yukawa field, seen at single outputs")
def _() -> Arrays:
    x = APART.position * (1.0 + np.arange(3)[:, None, None] / 32.0)
    return states(vv.Scene(APART, YUKAWA).ensemble(position=x).run(t=[0.3], method="leapfrog", dt=0.02))


# Offsets, units, columns.


@scene("kahan_li8: six bodies at an offset of 1e6, far out in units of 2^100")
def _() -> Arrays:
    bodies = centered(6, 1)
    far = vv.Particles(bodies.mass, bodies.position + np.array([1e6, -2e6, 0.0]), bodies.velocity + 1e3)
    scaled = vv.Scene(far, SOFT).rescaled(length=2.0**100, mass=2.0**-60, time=2.0**40)
    return states(scaled.run(t=2.0**40, method="kahan_li8", dt=2.0**33))


@scene("columns: energy, momenta and center of mass of six bodies and of 66")
def _() -> Arrays:
    names = ("energy", "momentum", "angular_momentum", "center_of_mass")
    few = vv.Scene(centered(6, 1), SOFT).run(t=BETWEEN, method="kahan_li8", dt=0.01, record=names)
    many = vv.Scene(centered(66, 15), SOFT).run(t=[0.1, 0.2], method="leapfrog", dt=0.01, record=names)
    return {f"{label}.{n}": a for label, out in (("6", few), ("66", many)) for n, a in columns(out, *names).items()}


@scene("columns: energy of 66 bodies at an offset of 1e9", "pair sums of many bodies took rounded positions")
def _() -> Arrays:
    bodies = centered(66, 15)
    far = vv.Scene(vv.Particles(bodies.mass, bodies.position + 1e9, bodies.velocity), SOFT)
    return columns(far.run(t=[0.1, 0.2], method="leapfrog", dt=0.01, record=("energy",)), "energy")


@scene("accelerations of 3, 40 and 200 bodies under all forces")
def _() -> Arrays:
    forces = (SOFT, YUKAWA, vv.UniformField([0.1, 0.2, -0.3]))
    return {str(n): vv.Scene(anywhere(n, 50 + n), *forces).acceleration() for n in (3, 40, 200)}


# Monte Carlo, orbits, potentials.


@scene("Monte Carlo: two seeds, first events, tallies of angles and energies")
def _() -> Arrays:
    found: Arrays = {}
    for seed, first in ((7, 0), (2**40 + 1, 10**12)):
        out = vv.scattering.monte_carlo(
            vv.potentials.Coulomb(k=1.5),
            beam_energy=2.0,
            masses=(1.0, 4.0),
            b_max=3.0,
            n_events=100_003,
            seed=seed,
            first_event=first,
            tally=("cm_angle", "lab_angle", "recoil_angle", "energy"),
            bins=64,
        )
        for name in ("cm_angle", "lab_angle", "recoil_angle", "energy"):
            found[f"{seed}.{name}"] = out[name].counts
    return found


@scene("orbits: propagation and elements of bound and unbound states; potentials")
def _() -> Arrays:
    x, v = numbers(61, (64, 3), -2.0, 2.0), numbers(62, (64, 3), -1.2, 1.2)
    position, velocity = vv.orbits.propagate(1.0, x, v, 3.75)
    found = vv.orbits.elements(1.0, x, v)
    r = numbers(63, (65,), 0.2, 6.0)
    wells = (vv.potentials.Yukawa(-1.5, 2.0), vv.potentials.LennardJones(1.0, 1.1), vv.potentials.Coulomb(2.0))
    values = {f"V.{well.name}": np.stack([well.value(r), well.force(r), well.curvature(r)]) for well in wells}
    return {
        "position": position,
        "velocity": velocity,
        "eccentricity": np.asarray(found.eccentricity),
        "inclination": np.asarray(found.inclination),
        "true_anomaly": np.asarray(found.true_anomaly),
        **values,
    }


def digests(name: str) -> dict[str, str]:
    """The first half of the SHA-256 of each array of a scene, as little-endian bytes in C order."""
    with warnings.catch_warnings():
        # Bits are recorded whether or not the step resolves the motion: bodies that meet a center try more of them.
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        arrays = SCENES[name]()
    return {
        column: hashlib.sha256(np.ascontiguousarray(array, array.dtype.newbyteorder("<")).tobytes()).hexdigest()[:32]
        for column, array in arrays.items()
    }
