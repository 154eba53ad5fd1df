"""What an integrator keeps on a scene of one's own: its order, its way back, and the symplectic form."""

from __future__ import annotations

from math import log2
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import positive
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, InvalidInput
from visviva.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.integrators import Method
    from visviva.typing import MethodName

_ROUNDING = 1e-13
"""Beside the size of a scene: smaller changes are what steps round."""
_NEAR = 2.0**-11
"""The step of differences, of the size of a scene: fourth order errs by some 1e-11 there, rounding by less."""


def _check(scene: object) -> None:
    if not isinstance(scene, Scene):
        raise InvalidInput("scene", f"expected a Scene, got {type(scene).__name__}")
    if not len(scene.particles):
        raise InvalidInput("scene", "expected bodies, got a scene of none")


def _end(scene: Scene, t: float, method: MethodName | Method, dt: float) -> NDArray[np.float64]:
    """Positions, and quaternions of rigid bodies as large as the scene: they are what else a method goes on to."""
    out = scene.run(t=t, method=method, dt=dt)
    end = [out.position[-1].ravel()]
    if scene.rigid_bodies is not None:
        end.append(_size(scene) * out.orientation[-1].ravel())
    return np.concatenate(end)


def _size(scene: Scene) -> float:
    x = scene.particles.position
    return float(np.abs(x - x.mean(axis=0)).max(initial=0.0)) or float(np.abs(x).max(initial=0.0)) or 1.0


@known_keywords
def order(scene: Scene, t: float, *, method: MethodName | Method, dt: float) -> float:
    """The order with which a method's positions and orientations converge on a scene: by halving the step twice.

    Units: those of the scene; the order is without dimension.

    Parameters
    ----------
    scene : Scene
    t : float
        The end of the run.
    method : str or Method
        One with fixed steps.
    dt : float
        The longest step; one that the span is a multiple of.

    Returns
    -------
    float
        log₂ of how much less the second halving changes than the first: the order, as steps become short.

    Raises
    ------
    visviva.InvalidInput
        A method that chooses its steps.
    visviva.ConvergenceError
        If the second change is as small as rounding: take longer steps.

    Notes
    -----
    Richardson's argument; Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993),
    section II.4. Linear
    problems may show a higher order than a method has.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.3).scene
    >>> round(vv.audit.order(scene, 2.0, method="rk4", dt=0.02), 1)
    4.0
    """
    _check(scene)
    positive("dt", dt)
    x = [_end(scene, t, method, dt / 2**halvings) for halvings in range(3)]
    first, second = (float(np.abs(a - b).max(initial=0.0)) for a, b in ((x[0], x[1]), (x[1], x[2])))
    least = _ROUNDING * _size(scene)
    if second <= least:
        raise ConvergenceError(
            f"halving the step to {dt / 4:g} changes states by {second:.1e}, which is rounding; give a longer dt"
        )
    return log2(first / second)


@known_keywords
def reversal(
    scene: Scene,
    t: float,
    *,
    method: MethodName | Method = "auto",
    dt: float | None = None,
    rtol: float | None = None,
) -> float:
    """Distance from the start after a run to ``t``, a reversal of all velocities, and a run back.

    Units: those of the scene; what is told is relative to its size, without dimension.

    Parameters
    ----------
    scene : Scene
        Of forces that have a reverse.
    t : float
        Where it turns round.
    method : str or Method
    dt, rtol : float, optional
        As of `Scene.run`.

    Returns
    -------
    float
        The largest change of a coordinate, of the scene's size, or the largest angle by which a rigid body is turned
        after it, in radians: rounding, for a reversible method at steps that the span is a multiple of; else its error.

    Raises
    ------
    visviva.InvalidInput
        Drag, or a force that goes on with time.

    Notes
    -----
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), chapter V.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> vv.audit.reversal(scene, 4.0, method="leapfrog", dt=0.0625) < 1e-13
    True
    >>> vv.audit.reversal(scene, 4.0, method="rk4", dt=0.0625) > 1e-6
    True
    """
    _check(scene)
    end = scene.run(t=t, method=method, dt=dt, rtol=rtol).final
    back = end.reversed().run(t=2.0 * t - scene.t0, method=method, dt=dt, rtol=rtol).final
    moved = float(np.abs(back.particles.position - scene.particles.position).max(initial=0.0)) / _size(scene)
    if scene.rigid_bodies is None or back.rigid_bodies is None:
        return moved
    q, start = back.rigid_bodies.orientation, scene.rigid_bodies.orientation
    # A quaternion and its opposite are one orientation; half an angle lies between two that are next to each other.
    apart = np.minimum(np.linalg.norm(q - start, axis=1), np.linalg.norm(q + start, axis=1))
    return max(moved, float((4.0 * np.arcsin(0.5 * apart)).max()))


@known_keywords
def symplecticity(scene: Scene, t: float, *, method: MethodName | Method, dt: float) -> float:
    """How far the map from the start to ``t`` is from symplectic: the largest entry of MᵀJM − J.

    Parameters
    ----------
    scene : Scene
        Of few bodies that all have mass, and forces that look at places and times alone: momenta are masses times
        velocities. Of rigid bodies, which no torques may turn, it is the map of their centers.
    t : float
        The end of the run.
    method : str or Method
        One with fixed steps.
    dt : float
        The step.

    Returns
    -------
    float
        In units of the scene's size and largest speed, and of each body's mass. Differences of a scene that bends on
        the scale of its size see 1e-10 and more.

    Raises
    ------
    visviva.InvalidInput
        A body without mass, or a force that looks at velocities.

    Notes
    -----
    M is found by differences of fourth order, over an ensemble of 4 copies for each coordinate and velocity.
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), section VI.2.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.problems.kepler(e=0.3).scene
    >>> vv.audit.symplecticity(scene, 2.0, method="leapfrog", dt=0.125) < 1e-9
    True
    >>> vv.audit.symplecticity(scene, 2.0, method="rk4", dt=0.125) > 1e-5
    True
    """
    _check(scene)
    bodies = scene.particles
    if not bodies.mass.all():
        raise InvalidInput("mass", "expected bodies that all have mass: a momentum is a mass times a velocity")
    if not np.array_equal(
        scene.with_state(bodies.position, 0.0 * bodies.velocity).acceleration(), scene.acceleration()
    ):
        raise InvalidInput("forces", "expected forces that do not look at velocities, whose momenta are other ones")
    count = 3 * len(bodies)
    length = _size(scene)
    speed = float(np.abs(bodies.velocity).max(initial=0.0)) or length / abs(t - scene.t0)
    start = np.concatenate([bodies.position.ravel() / length, bodies.velocity.ravel() / speed])
    places = np.array([-2.0, -1.0, 1.0, 2.0]) * _NEAR
    moved = start + places[:, None, None] * np.eye(2 * count)
    x, v = (part.reshape(-1, len(bodies), 3) for part in np.split(moved.reshape(-1, 2 * count), 2, axis=1))
    out = scene.ensemble(position=x * length, velocity=v * speed).run(t=t, method=method, dt=dt)
    end = np.concatenate(
        [out.position[:, -1].reshape(-1, count) / length, out.velocity[:, -1].reshape(-1, count) / speed], axis=1
    ).reshape(4, 2 * count, 2 * count)
    # Rows are what is moved, columns where it went.
    matrix = ((end[0] - end[3]) - 8.0 * (end[1] - end[2])).T / (12.0 * _NEAR)
    weights = np.repeat(bodies.mass / bodies.mass.max(), 3)
    form = np.zeros((2 * count, 2 * count))
    form[:count, count:], form[count:, :count] = np.diag(weights), -np.diag(weights)
    return float(np.abs(matrix.T @ form @ matrix - form).max())
