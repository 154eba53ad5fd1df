"""Forces of every potential have the same bits on every SIMD tier: in a row, in tiles, and system by system."""

import os
import subprocess
import sys

import pytest

from visviva import _core

SCRIPT = """
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


@pytest.mark.skipif(len(_core.info()["simd_available"]) < 2, reason="one tier only")
def test_every_tier_has_the_same_bits() -> None:
    found = {}
    for tier in _core.info()["simd_available"]:
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env={**os.environ, "VISVIVA_SIMD": tier},
            capture_output=True,
            text=True,
            check=True,
        )
        found[tier] = done.stdout.splitlines()
    first, *others = found.values()
    for other in others:
        assert other == first
