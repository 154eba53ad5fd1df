"""The work of one force along a recorded run; see `visviva.audit`.

The one idea: the run's own scene with that force alone tells the power at every state, between two mergers that of the
bodies which are left, with the masses that they have then.
"""

from __future__ import annotations

import warnings
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core, _expression_table
from visviva._accuracy import callers_inside
from visviva._keywords import known_keywords
from visviva._mergers import eras, has_mergers
from visviva.errors import AccuracyWarning, InvalidInput
from visviva.forces import DrivenForce, ExpressedForce, Force
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.scene import Scene

__all__ = ["looks_at_time", "of_any_body", "work_along"]

# Of the work that is done, without regard to sign, so much may be missed without a word.
_TOLERATED = 0.03
# What moves by less than this beside what its forces make of it in a span, or by its square beside others, rests.
_HARDLY = 1e-5
_EPSILON = float(np.finfo(np.float64).eps)
# So many spans between times are looked at: what all forces do there is asked time by time.
_SPANS = 2000


def of_any_body(force: Force) -> Force:
    """The force on all bodies that on some of them it is, refusing what is no force or acts between bodies."""
    if not isinstance(force, Force):
        raise InvalidInput("force", f"expected a force, got {type(force).__name__}")
    # One that has to list bodies acts between them, and what it calls them only a scene knows.
    lists = any(parameter.kind == "indices" and parameter.default is None for parameter in force._parameters)
    of_any = replace(force, bodies=None) if isinstance(force, ExpressedForce) else force
    if lists or _core.acts_between(of_any._to_core()):
        raise InvalidInput("force", f"expected a force on each body for itself, but {force!r} acts between bodies")
    return of_any


def looks_at_time(force: Force) -> bool:
    """Whether a force is another one at another time."""
    return isinstance(force, DrivenForce) or (
        isinstance(force, ExpressedForce) and _expression_table.looks_at_time(force.nodes)
    )


@known_keywords
def work_along(trajectory: Trajectory, force: Force) -> NDArray[np.float64]:
    """The work of one force on each body along a recorded run, up to each of its times.

    Units: those of the scene.

    Parameters
    ----------
    trajectory : Trajectory
        With position and velocity at times as close as the motion needs.
    force : Force
        One that acts on each body for itself, of the scene or not; where it names bodies, those of the scene.

    Returns
    -------
    ndarray, shape (T, N)
        From 0 at the first time; 0 throughout for a body on which the force does not act. All forces together do the
        work by which the kinetic energy grows.

    Warns
    -----
    visviva.AccuracyWarning
        If times are so far apart that the motion between them is not known; of scenes with rigid bodies nobody looks.

    Raises
    ------
    visviva.InvalidInput
        For a force between bodies, or on one that the scene does not have, what is no trajectory, or a run that did not
        record velocities.

    Notes
    -----
    Power F·v between two times is that at three places of Gauss and Lobatto, the middle one on Hermite's cubic through
    both ends: the error falls with the fourth power of the times' distance. Where bodies merge, what is done from then
    on is done on the one that remains, with the mass of both; between the times around a merger the error falls with
    their distance alone.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> pull = vv.UniformField((0, 0, -10.0))
    >>> ball = vv.Scene(vv.Particles([2.0], [[0, 0, 0]], [[1.0, 0, 5.0]]), pull)
    >>> vv.audit.work_along(ball.run(t=np.linspace(0, 1, 5)), pull)[-1].tolist()
    [0.0]

    A force on some bodies does work on these:

    >>> lift = vv.ExpressionForce(force=lambda r, v, t: [0, 0, 3.0], bodies="b")
    >>> two = vv.Particles([1.0, 1.0], [[0, 0, 0], [1.0, 0, 0]], names=["a", "b"])
    >>> vv.audit.work_along(vv.Scene(two, lift).run(t=np.linspace(0, 2, 5)), lift)[-1].round(9).tolist()
    [0.0, 18.0]
    """
    of_any_body(force)
    if not isinstance(trajectory, Trajectory):
        raise InvalidInput(
            "trajectory",
            f"expected what `Scene.run` gives, got {type(trajectory).__name__}; of an ensemble's run give out[i]",
        )
    t, x, v = trajectory.t, trajectory.position, trajectory.velocity
    before, after = slice(None, -1), slice(1, None)
    h = np.diff(t)[:, None, None]
    middle_t = 0.5 * (t[before] + t[after])
    middle_x = 0.5 * (x[before] + x[after]) + 0.125 * h * (v[before] - v[after])
    # Between two rows of one time nothing is done, whatever the velocity.
    middle_v = 1.5 * (x[after] - x[before]) / np.where(h != 0.0, h, 1.0) - 0.25 * (v[before] + v[after])
    ends, middle = np.zeros_like(x), np.zeros_like(x[before])
    for rows, scene, there in eras(trajectory, _alone(trajectory, force)):
        # The span before the first time of an era is of the one before.
        between = slice(rows.start, min(rows.stop, len(middle)))
        chosen = slice(None) if there is None else there
        ends[rows, chosen] = _forces(scene, t[rows], x[rows][:, chosen], v[rows][:, chosen])
        middle[between, chosen] = _forces(
            scene, middle_t[between], middle_x[between][:, chosen], middle_v[between][:, chosen]
        )
    _warn_if_far_apart(trajectory, middle_v, middle)
    at_ends, at_middle = (np.einsum("tnc,tnc->tn", *each) for each in ((ends, v), (middle, middle_v)))
    work = np.zeros(x.shape[:2])
    np.cumsum(h[:, :, 0] / 6.0 * (at_ends[before] + 4.0 * at_middle + at_ends[after]), axis=0, out=work[after])
    return work


def _warn_if_far_apart(trajectory: Trajectory, middle_v: Any, middle: Any) -> None:
    """Warn where the cubics between the times are not the motion: their accelerations at the ends are not those there.

    A cubic whose acceleration is off by δ at its ends is off by hδ/8 in its velocity midway. What rests, or hardly
    moves beside others, is measured by what forces and others make of it, lest rounding be taken for a motion.
    """
    t, x, v = trajectory.t, trajectory.position, trajectory.velocity
    apart, every = np.diff(t), 1 + len(t) // _SPANS
    impulses = np.abs(apart)[:, None] * _norm(middle)
    speeds = np.maximum(_norm(middle_v), _norm(v)[1:])
    fastest = speeds.max(initial=0.0)
    done, missed = np.zeros(x.shape[1]), np.zeros(x.shape[1])
    for rows, scene, there in eras(trajectory):
        spans = np.arange(rows.start, rows.stop - 1, every)
        if len(spans) == 0 or scene.rigid_bodies:
            continue
        bodies = slice(None) if there is None else there
        both = np.stack([spans, spans + 1])
        places, moving = x[both][:, :, bodies], v[both][:, :, bodies]
        states = [each.reshape(-1, *places.shape[2:]) for each in (places, moving)]
        given, sizes = (each.reshape(places.shape) for each in _accelerations_of_all(scene, t[both.ravel()], *states))
        h = apart[spans][:, None, None]
        mean = (places[1] - places[0]) / np.where(h != 0.0, h, 1.0)
        first = h * given[0] - (6.0 * mean - 4.0 * moving[0] - 2.0 * moving[1])
        last = h * given[1] + (6.0 * mean - 2.0 * moving[0] - 4.0 * moving[1])
        off = np.maximum(_norm(first), _norm(last)) / 8.0
        # Each place is known to a rounding, and six times that over the time between two is in the cubic's rates.
        rounding = 2.0 * _EPSILON * (_norm(places).max(axis=0) / np.where(h != 0.0, np.abs(h), 1.0)[..., 0])
        off = np.maximum(off - rounding, 0.0)
        own = np.maximum(speeds[spans][:, bodies], _HARDLY * np.abs(h[..., 0]) * _norm(sizes).max(axis=0))
        done[bodies] += (impulses[spans][:, bodies] * np.maximum(own, _HARDLY**2 * fastest)).sum(axis=0)
        missed[bodies] += (impulses[spans][:, bodies] * off).sum(axis=0)
    share = missed / np.where(done > 0.0, done, 1.0)
    body = int(share.argmax())
    if share[body] > _TOLERATED:
        part = f"about {100.0 * share[body]:.0f} %" if share[body] < 1.0 else "more than all"
        warnings.warn(
            f"the times of the run are too far apart for its motion: {part} of the work done on body {body} is not "
            "known; record more, as the error falls with the fourth power of their number",
            AccuracyWarning,
            stacklevel=callers_inside(),
        )


def _alone(trajectory: Trajectory, force: Force) -> Scene:
    """The scene of a run under one force, which names its bodies."""
    run, bodies = trajectory.scene, trajectory.scene.particles
    alone = run._like(bodies, [force._resolved(bodies.names, len(bodies))], run.t0)
    if has_mergers(trajectory):
        # A force of the run itself passes; one of another scene may say nothing of bodies that merge.
        try:
            alone.plan(run.t0 + 1.0, collisions="merge")
        except InvalidInput as error:
            raise InvalidInput(
                "force",
                "expected one in proportion to mass or charge, or an acceleration, as bodies of the run merge, got "
                f"{force!r}: nothing says what a body feels that is put together of two",
            ) from error
    return alone


def _forces(scene: Scene, t: Any, x: Any, v: Any) -> NDArray[np.float64]:
    """Those on every body at every time, (T, N, 3), of all the forces that a scene has."""
    return scene.particles.mass[:, None] * _accelerations_of_all(scene, t, x, v)[0]


def _accelerations_of_all(scene: Scene, t: Any, x: Any, v: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What all forces of a scene make together, and the sum of the sizes of what each makes; (T, N, 3) both."""
    given, sizes = np.zeros(x.shape), np.zeros(x.shape)
    if len(t):
        for force in scene.forces:
            one = _accelerations(force, scene.particles.mass, t, x, v)
            given += one
            sizes += np.abs(one)
    return given, sizes


def _norm(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _accelerations(force: Force, mass: Any, t: Any, x: Any, v: Any) -> NDArray[np.float64]:
    """Those of every body at every time, (T, N, 3): all times as so many more bodies, if that is the same."""
    own = force._to_core()
    alike = not (looks_at_time(force) or _core.acts_between(own))
    if alike and (of_all := _of_all_times(force, own, len(t), len(mass))):
        masses, places, velocities = np.tile(mass, len(t)), x.reshape(-1, 3), v.reshape(-1, 3)
        # What is refused is refused below, where bodies have the numbers that they have in the run.
        with suppress(InvalidInput):
            return _core.acceleration(
                mass=masses, forces=[of_all], position=places, velocity=velocities, t0=float(t[0])
            ).reshape(x.shape)
    rows = [
        _core.acceleration(mass=mass, forces=[own], position=places, velocity=velocities, t0=now)
        for now, places, velocities in zip(t.tolist(), x, v, strict=True)
    ]
    return np.array(rows).reshape(x.shape)


def _of_all_times(force: Force, own: dict[str, Any], times: int, bodies: int) -> dict[str, Any] | None:
    """The force on the bodies of every time in turn; None if it is not one on so many bodies."""
    changed: dict[str, Any] = {}
    for parameter in force._parameters:
        given = own[parameter.name]
        if parameter.kind == "numbers" and len(given) > 1:  # one number is that of all bodies
            if len(given) != bodies:
                return None
            changed[parameter.name] = np.tile(given, times)
        elif parameter.kind == "indices" and len(given):
            if given.max() >= bodies:
                return None
            changed[parameter.name] = (given + bodies * np.arange(times)[:, None]).ravel()
    return own | changed
