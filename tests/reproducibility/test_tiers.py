"""Forces of every potential, and gravity between any number of bodies, have the same bits on every SIMD tier.

In a row, in tiles, and system by system. The portable tier has a kernel for any number of bodies where the others have
one for each, and none for the plane (`Vector8::APART`).
"""

import os
import subprocess
import sys

import pytest

from visviva import _core

POTENTIALS = """
import hashlib
import numpy as np
import visviva as vv
from visviva import potentials as p

r = np.geomspace(0.01, 60.0, 90)
every = [
    p.Coulomb(1.3), p.PowerLaw(1.3, 2.5), p.PowerLaw(1.3, 7.0), p.Yukawa(1.3, 0.7), p.LennardJones(1.3, 0.7),
    p.Mie(1.3, 0.7, 8.5, 5.0), p.Mie(1.3, 0.7, 14.0, 7.0), p.Morse(1.3, 0.7, 2.0), p.Buckingham(1.3, 0.7, 2.0),
    p.Plummer(1.3, 0.7), p.SoftSphere(1.3, 4.0, 2.5), p.Tabulated(r, 1.0 / r),
    p.Custom(lambda r: np.exp(-r) / r, 0.01, 60.0, tolerance=1e-9),
    *(p.ScreenedCoulomb(1.3, 0.7, name) for name in ("zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi")),
]
random = np.random.default_rng(1)
for potential in every:
    bits = hashlib.sha256()
    for count in (2, 7, 21):
        bodies = vv.Particles(random.uniform(1, 2, count), random.uniform(-5, 5, (count, 3)))
        scene = vv.Scene(bodies, vv.PairPotential(potential), vv.CentralField(potential, [9.0, 1.0, 2.0]))
        bits.update(scene.acceleration().tobytes())
        moved = bodies.position + random.uniform(-1e-3, 1e-3, (9, count, 3))
        bits.update(scene.ensemble(position=moved).run(t=1e-3, method="leapfrog", dt=5e-4).position.tobytes())
        places = np.linalg.norm(bodies.position, axis=1)
        bits.update(potential.force(places).tobytes())
    print(type(potential).__name__, bits.hexdigest())
"""


GRAVITY = """
import hashlib
import itertools
import numpy as np
import visviva as vv

random = np.random.default_rng(2)
away = [[9.0, 1.0, 0.0], [-8.0, 2.0, 0.0]]
beside = {
    "nothing": lambda count: [],
    "drag": lambda count: [vv.LinearDrag(0.01)],
    "quadratic drag": lambda count: [vv.QuadraticDrag(0.02)],
    "field": lambda count: [vv.UniformMagneticField((0.0, 0.0, 0.3))],
    "rotating": lambda count: [vv.RotatingFrame((0.0, 0.0, 0.2))],
    "charges": lambda count: [vv.Coulomb(np.linspace(0.1, 0.4, count), 1.0, softening=softening)],
}
for count, planar, softening in itertools.product((1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 20), (True, False), (0.0, 0.1)):
    place, speed = random.normal(size=(2, count + 2, 3)) * [[[3.0]], [[0.3]]]
    place[count:] = away
    if planar:
        place[:, 2] = speed[:, 2] = 0.0
    mass = np.append(random.uniform(0.5, 1.0, count), [0.0, 0.0])
    for name, forces in beside.items():
        for bodies in (count, count + 2) if name == "nothing" else (count,):
            particles = vv.Particles(mass[:bodies], place[:bodies], speed[:bodies])
            scene = vv.Scene(particles, vv.Gravity(1.0, softening=softening), *forces(count))
            bits = hashlib.sha256(scene.run(t=[0.05, 0.1], method="rk4", dt=0.01).position.tobytes())
            moved = scene.particles.position * np.linspace(1.0, 1.1, 9)[:, None, None]
            bits.update(scene.ensemble(position=moved).run(t=0.1, method="rk4", dt=0.01).velocity.tobytes())
            if name == "nothing":
                bits.update(scene.run(t=0.3, method="stormer13", dt=0.01).position.tobytes())
            print(bodies, planar, softening, name, bits.hexdigest())
"""


@pytest.mark.skipif(len(_core.info()["simd_available"]) < 2, reason="one tier only")
@pytest.mark.parametrize("script", [POTENTIALS, GRAVITY], ids=["potentials", "gravity"])
def test_every_tier_has_the_same_bits(script: str) -> None:
    found = {}
    for tier in _core.info()["simd_available"]:
        done = subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "VISVIVA_SIMD": tier},
            capture_output=True,
            text=True,
            check=True,
        )
        found[tier] = done.stdout.splitlines()
    first, *others = found.values()
    for other in others:
        assert other == first
