"""Use an installed visviva the way a stranger would; print one digest of every bit of the results.

Run from a folder that has nothing to do with the repository. The digest must not depend on ``VISVIVA_SIMD`` or
``VISVIVA_THREADS``: `.ci/run` compares.
"""

import hashlib
import pathlib
import sys
import tempfile

import numpy as np

import visviva as vv


def digest() -> str:
    bits = hashlib.sha256()
    planets = vv.problems.outer_solar_system().scene
    for method, arguments in (("dop853", {"rtol": 1e-12}), ("kahan_li8", {"dt": 100.0}), ("leapfrog", {"dt": 10.0})):
        out = planets.run(t=np.linspace(0.0, 2e4, 11), method=method, **arguments)
        assert out.conservation().energy.max < 1e-4
        bits.update(out.position.tobytes())
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "run.npz"
        out.save(path)
        assert np.array_equal(vv.load(path).position, out.position)
    rng = np.random.default_rng(1)
    cluster = vv.Scene(vv.Particles(rng.random(300), rng.normal(size=(300, 3))), vv.Gravity(1.0, softening=0.1))
    bits.update(cluster.run(t=0.05, method="leapfrog", dt=0.01).position.tobytes())
    eight = vv.problems.figure_eight().scene
    starts = eight.particles.position + 1e-3 * rng.normal(size=(19, 3, 3))
    bits.update(eight.ensemble(position=starts).run(t=2.0).position.tobytes())
    tally = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(k=1.0), beam_energy=1.0, masses=(1.0, 50.0), b_max=5.0, n_events=200_000, seed=1
    )["cm_angle"]
    bits.update(np.ascontiguousarray(tally.counts, dtype=np.int64).tobytes())
    return bits.hexdigest()


if __name__ == "__main__":
    assert "site-packages" in str(vv.__file__), f"this is not the installed package: {vv.__file__}"
    print(digest())
    sys.exit(0)
