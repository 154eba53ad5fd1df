"""One result: the same bits on every SIMD tier, for any threads, alone or in an ensemble, whatever is output.

Each tier runs in a process of its own (the tier is chosen once per process) and prints a digest of every case.
Within a case all variants must give the same bits; the digests must then agree between tiers.

Run directly it prints the row; ``--digests [quick]`` prints the digests of the tier in force, for the row and for
``tests/reproducibility/test_same_bits.py``.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

THREADS = (1, 2, 3)


def scenes(quick: bool) -> dict[str, tuple[vv.Scene, float, float]]:
    """Scenes of every shape the kernels know, each with an end and a step."""
    random = np.random.default_rng(77)

    def cloud(count: int, massless: int = 0) -> vv.Particles:
        mass = random.uniform(0.5, 1.5, count) / count
        mass[count - massless :] = 0.0
        return vv.Particles(mass, random.normal(size=(count, 3)), 0.3 * random.normal(size=(count, 3)))

    lennard_jones = vv.CentralField(vv.potentials.LennardJones(epsilon=1.0, sigma=0.5))
    yukawa = vv.CentralField(vv.potentials.Yukawa(k=-2.0, length=1.5), center=[0.1, 0.0, -0.2])
    far = vv.Particles([1.0, 2.0], [[1.5, 0.0, 0.1], [0.0, 2.0, -0.3]], [[0.0, 0.6, 0.1], [-0.5, 0.1, 0.0]])
    found = {
        "figure_eight": (vv.problems.figure_eight().scene, 6.0, 0.01),
        "pleiades, planar": (vv.problems.pleiades().scene, 0.5, 0.002),
        "solar": (vv.problems.outer_solar_system().scene, 4000.0, 10.0),
        "five and three massless": (vv.Scene(cloud(8, 3), vv.Gravity(1.0, softening=0.1)), 1.0, 0.02),
        "37 bodies": (vv.Scene(cloud(37), vv.Gravity(1.0, softening=0.05)), 0.5, 0.02),
        "Yukawa center": (vv.Scene(far, yukawa), 3.0, 0.01),
        "Lennard-Jones center in a uniform field": (
            vv.Scene(far, lennard_jones, vv.UniformField([0.0, 0.0, -0.1])),
            2.0,
            0.01,
        ),
    }
    if not quick:
        found["700 bodies on threads"] = (vv.Scene(cloud(700), vv.Gravity(1.0, softening=0.05)), 0.06, 0.02)
    return found


def closed_forms() -> dict[str, vv.Scene]:
    """Scenes that ``method="auto"`` solves without stepping."""
    one = vv.Particles([2.0], [[1.0, 0.2, -0.3]], [[0.1, 1.1, 0.4]])
    return {
        "free": vv.Scene(one),
        "uniform": vv.Scene(one, vv.UniformField([0.0, 0.3, -9.81])),
        "Kepler e = 0.9": vv.problems.kepler(e=0.9).scene,
        "repulsive center": vv.Scene(one, vv.CentralField(vv.potentials.Coulomb(k=3.0))),
    }


def bits(out: vv.Trajectory | vv.EnsembleTrajectory, copy: int | None = None) -> bytes:
    """Position and velocity of the last recorded time."""
    arrays = [out.position, out.velocity] if copy is None else [out.position[copy], out.velocity[copy]]
    return b"".join(np.ascontiguousarray(array[-1]).tobytes() for array in arrays)


def variants(scene: vv.Scene, end: float, **how: object) -> Iterator[tuple[str, bytes]]:
    """The end state of the scene, computed in every way that must not matter."""
    for threads in THREADS:
        yield f"alone, {threads} threads", bits(scene.run(t=end, threads=threads, **how))  # type: ignore[arg-type]
    between = np.append(np.linspace(0.0, end, 24)[:-1] + end * 1e-3, end)
    yield "with outputs", bits(scene.run(t=between, threads=1, **how))  # type: ignore[arg-type]
    columns = ("position", "velocity", "energy", "angular_momentum")
    yield "with other columns", bits(scene.run(t=[0.0, end], record=columns, threads=1, **how))  # type: ignore[arg-type]
    # The scene is one of eleven different copies, in two different lanes; eleven does not fill two groups of eight.
    for place in (0, 9):
        states: NDArray[np.float64] = np.repeat(scene.particles.position[None], 11, axis=0)
        states *= 1.0 + 1e-3 * np.arange(11)[:, None, None]
        states[place] = scene.particles.position
        for threads in THREADS:
            ensemble = scene.ensemble(position=states).run(t=end, threads=threads, **how)  # type: ignore[arg-type]
            yield f"copy {place} of 11, {threads} threads", bits(ensemble, place)


def takes(scene: vv.Scene, method: vv.Method) -> bool:
    """Whether the method has what it needs of the forces: a Taylor series is not of all of them."""
    try:
        scene.plan(t=1.0, method=method, dt=None if method.adaptive else 0.125)
    except vv.InvalidInput:
        return False
    return True


def digests(quick: bool) -> dict[str, str]:
    """A digest per scene and method; raises if two ways disagree on this tier."""
    found = {}
    # Quick, every method has about as many evaluations: without fused multiply-add they take long.
    cases = [
        (
            f"{name}, {method.name}",
            scene,
            end * (min(1.0, 3 / method.stages) if quick else 1.0),
            {"method": method.name} | ({} if method.adaptive else {"dt": step}),
        )
        for name, (scene, end, step) in scenes(quick).items()
        for method in vv.methods()
        if takes(scene, method)
    ]
    cases += [(f"{name}, closed form", scene, 2.5, {}) for name, scene in closed_forms().items()]
    for name, scene, end, how in cases:
        (first, expected), *rest = variants(scene, end, **how)
        different = [way for way, result in rest if result != expected]
        if different:
            raise AssertionError(f"{name}: {', '.join(different)} differ from {first} on {_core.info()['simd']}")
        found[name] = hashlib.sha256(expected).hexdigest()
    return found


def digests_of_tier(tier: str, *, quick: bool) -> dict[str, str]:
    """`digests` in a fresh process with that tier."""
    command = [sys.executable, str(Path(__file__).resolve()), "--digests", *(["quick"] if quick else [])]
    done = subprocess.run(
        command, env={**os.environ, "VISVIVA_SIMD": tier}, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise AssertionError(done.stderr.strip().splitlines()[-1])
    found = json.loads(done.stdout)
    assert found.pop("simd") == tier
    return found


def main() -> None:
    from _harness import TIERS, Row, report

    def rows() -> Iterator[Row]:
        by_tier = {tier: digests_of_tier(tier, quick=False) for tier in TIERS}
        first = by_tier[TIERS[0]]
        different = sorted(name for name in first if len({found[name] for found in by_tier.values()}) > 1)
        what = f"{len(first)} cases × 11 ways × tiers {', '.join(TIERS)}"
        yield Row(what, f"{len(different)} differ {different or ''}", "", "", "one result", not different)

    report(
        "Same bits",
        rows(),
        f"Threads {THREADS}, alone and as two places of an ensemble of eleven, with and without outputs and other "
        "columns; every method, closed forms, and gravity of every size of kernel.",
    )


if __name__ == "__main__":
    if "--digests" in sys.argv:
        print(json.dumps({"simd": _core.info()["simd"], **digests("quick" in sys.argv)}))
    else:
        main()
