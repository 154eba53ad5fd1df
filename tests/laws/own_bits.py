"""Copies of an ensemble have the bits that each has alone."""

from typing import Any

import numpy as np

import visviva as vv


def copies_have_their_own_bits(scene: vv.Scene, t: float, method: Any) -> None:
    """By steps of that method and by an adaptive one, of eleven copies with places and masses of their own."""
    random, bodies = np.random.default_rng(20), scene.particles
    starts = bodies.position + 0.01 * random.normal(size=(11, *bodies.position.shape))
    masses = bodies.mass * random.uniform(0.9, 1.1, size=(11, len(bodies.mass)))
    for how in ({"method": method, "dt": 0.01}, {"method": "dop853", "rtol": 1e-10}):
        together = scene.ensemble(position=starts, mass=masses).run(t=t, **how)
        for copy in (0, 7, 10):
            one = vv.Scene(vv.Particles(masses[copy], starts[copy], bodies.velocity), *scene.forces)
            assert np.array_equal(one.run(t=t, **how).position, together.position[copy])
