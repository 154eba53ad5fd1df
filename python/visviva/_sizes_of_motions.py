"""How large motions are, by which small differences of them are measured.

The one idea: a difference is small beside the length over which the forces on a body change, and where bodies do not
act on each other nothing tells that but the motion itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva.particles import Particles

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.ensemble import EnsembleScene
    from visviva.scene import Scene

__all__ = ["looked_at", "sizes_of_motions"]

#: Instants by which the motion is measured.
_LOOKS = 64
#: Velocities that change by less than this part of themselves are those of a free body: it is measured by its start.
_NO_CHANGE = 1e-12
#: At so many of them accelerations are.
_ACCELERATIONS = 8


def looked_at(run: Callable[..., Any], begin: float, instants: NDArray[np.float64], **how: Any) -> Any:
    """Run a scene or copies, and look at some of these instants, in the order of the motion, and at the last."""
    return run([begin, *instants[:: len(instants) // _LOOKS + 1], instants[-1]], **how)


def sizes_of_motions(copies: EnsembleScene, motion: Any) -> NDArray[np.float64]:
    """Over which length a motion bends, and how fast it is, of each copy (B, 2); zeros where bodies act on each other.

    Of what bends, v²/a, as the radius of a circle; of what does not, how far it goes about its middle.
    """
    found = np.zeros((len(copies), 2))
    if any(_core.acts_between(force._to_core()) for force in copies.forces[0]):
        return found
    shape = (len(copies), len(motion.t), -1, 3)
    position, velocity = motion.position.reshape(shape), motion.velocity.reshape(shape)
    for copy, scene in enumerate(copies):
        rows = np.flatnonzero(np.isfinite(position[copy]).all(axis=(1, 2)))
        x, v, t = position[copy][rows], velocity[copy][rows], motion.t[rows]
        extent, speed = (float(np.sqrt(np.square(each - each.mean(axis=(0, 1))).sum(axis=2).mean())) for each in (x, v))
        if speed <= _NO_CHANGE * float(np.abs(v).max()):
            continue
        some = np.unique(np.linspace(0, len(rows) - 1, _ACCELERATIONS).astype(int))
        bent = np.sqrt(np.mean([np.square(_acceleration(scene, x[k], v[k], t[k])).sum(axis=1).mean() for k in some]))
        found[copy] = min(extent, speed * speed / bent if bent > 0.0 else np.inf), speed
    return found


def _acceleration(
    scene: Scene, position: NDArray[np.float64], velocity: NDArray[np.float64], t: np.float64
) -> NDArray[np.float64]:
    bodies = scene.particles
    there = Particles(bodies.mass, position, velocity, bodies.names, bodies.radius)
    return scene._like(there, scene.forces, float(t)).acceleration()
