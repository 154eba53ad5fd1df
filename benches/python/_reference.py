"""Reference states of gravitating bodies beyond double precision.

By heyoka's Taylor series in x87 extended precision (64-bit significand, ε = 1.1e-19) with a tolerance at that
ε: about three digits beyond the inputs. It shares no code with what it judges. `tests` of this module are the
benchmarks themselves: they assert it against the quadruple-precision states in `visviva.problems`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import heyoka
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    import visviva as vv


def equations(scene: vv.Scene) -> list[tuple[heyoka.expression, heyoka.expression]]:
    """heyoka's equations of motion of a scene with nothing but unsoftened gravity."""
    (gravity,) = scene.forces
    assert gravity.softening == 0.0
    return heyoka.model.nbody(len(scene.particles), masses=scene.particles.mass, Gconst=gravity.G)


def flat(position: NDArray[np.float64], velocity: NDArray[np.float64]) -> NDArray[np.float64]:
    """States in heyoka's order: x, y, z, v_x, v_y, v_z of each body; leading axes stay."""
    both = np.concatenate([position, velocity], axis=-1)
    return both.reshape(*both.shape[:-2], -1)


class Reference:
    """Positions of copies of a scene at a time; compiled once, used for every copy."""

    def __init__(self, scene: vv.Scene) -> None:
        self.scene = scene
        start = flat(scene.particles.position, scene.particles.velocity).astype(np.longdouble)
        assert np.finfo(np.longdouble).eps < 2e-19, "this machine has no extended precision"
        self.integrator = heyoka.taylor_adaptive(
            equations(scene), start, time=np.longdouble(scene.t0), tol=np.longdouble(1e-19), fp_type=np.longdouble
        )

    def positions(
        self, t: float, position: NDArray[np.float64] | None = None, velocity: NDArray[np.float64] | None = None
    ) -> NDArray[np.longdouble]:
        """Positions (N, 3) at ``t`` from the scene's state, or from the one given."""
        bodies = self.scene.particles
        start = flat(
            bodies.position if position is None else position, bodies.velocity if velocity is None else velocity
        )
        self.integrator.time = np.longdouble(self.scene.t0)
        self.integrator.state[:] = start.astype(np.longdouble)
        outcome = self.integrator.propagate_until(np.longdouble(t))[0]
        assert outcome == heyoka.taylor_outcome.time_limit, outcome
        return self.integrator.state.reshape(-1, 6)[:, :3].copy()


def error(position: NDArray[np.float64], reference: NDArray[np.longdouble]) -> float:
    """Largest distance of a body from where it should be."""
    return float(np.sqrt(((position - reference) ** 2).sum(axis=-1)).max())
