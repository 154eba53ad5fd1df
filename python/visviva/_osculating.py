"""Osculating elements of the bodies of a scene: what each orbits, and by which μ; the conics are `visviva.orbits`.

The one idea: the orbit of a body is that of the relative motion of two: itself, and what it is about, which has a
place and a mass. μ = G (mass there + its own mass), so that two bodies have the elements of their true conic whichever
of them the other is about.
Source: Murray & Dermott, *Solar System Dynamics* (1999) §2.8.
"""

from __future__ import annotations

from math import fsum
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._about_centers import relative_to_center
from visviva._arrays import number
from visviva._exported import labels
from visviva._names import CENTER_OF_MASS, JACOBI, body_index, body_indices, body_label
from visviva.errors import InvalidInput
from visviva.forces import Gravity, RotatingFrame
from visviva.orbits import Elements, elements
from visviva.orbits._elements import labeled

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from visviva.forces import Force
    from visviva.runnable import Runnable

__all__ = ["elements_of", "gravitational_constant"]


def gravitational_constant(forces: tuple[Force, ...], given: float | None) -> float:
    """The G that is given, or that of the scene's gravity."""
    if given is not None:
        return number("G", given)
    found = [force.G for force in forces if isinstance(force, Gravity)]
    if not found:
        raise InvalidInput("G", "expected the gravitational constant, since the scene has no Gravity; give G=…")
    return fsum(found)


def elements_of(
    start: Runnable[Any],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    bodies: str | int | Sequence[str | int] | None,
    about: str | int,
    G: float | None,
    merged: tuple[NDArray[np.bool_], NDArray[np.float64]] | None = None,
    rows: Mapping[str, NDArray[Any]] | None = None,
) -> Elements:
    """The elements of states (…, N, 3) that began with `start`: of an ensemble (B, T, N, 3).

    `rows` is what stands along the axes before that of the bodies.
    Where bodies have `merged`: which are parts of others, and what the masses are, (…, N).
    """
    from visviva.ensemble import EnsembleScene
    from visviva.scene import Scene

    names, count, mass = start._names, position.shape[-2], start._keywords["mass"]
    constant: Any
    if isinstance(start, EnsembleScene):
        # Copies may have a G of their own.
        mass = mass[:, None, :]
        constant = _of_copies(start.forces, lambda forces: gravitational_constant(forces, G))[:, None, None]
        turning = _of_copies(start.forces, _turning)[:, None, None]
    else:
        assert isinstance(start, Scene)
        mass, constant, turning = mass[0], gravitational_constant(start.forces, G), _turning(start.forces)
    if turning.any():
        # An orbit is that in an inertial frame, along the axes of the instant; its center is the same for all bodies.
        velocity = velocity + np.cross(turning, position)
    gone = np.zeros(mass.shape, dtype=bool)
    if merged is not None:
        gone, mass = merged
    parent = (
        about
        if isinstance(about, str) and about in (CENTER_OF_MASS, JACOBI)
        else body_index("about", about, names, count)
    )
    if bodies is None:
        without = 0 if parent == JACOBI else parent
        chosen = [body for body in range(count) if body != without]
    else:
        chosen = body_indices("bodies", bodies, names, count)
        _check_chosen(chosen, parent, names)
    if isinstance(parent, int):
        away = gone[..., parent]
        if away.any(axis=1).all() if isinstance(start, EnsembleScene) else away.any():
            raise InvalidInput(
                "about", f"expected a body by itself, but {body_label(parent, names)} has become a part of another"
            )
        # In a copy nothing is about it from then on.
        gone = gone | gone[..., parent, None]
    columns = np.array(chosen, dtype=np.intp)
    with np.errstate(over="ignore", invalid="ignore"):  # _check says it by name
        r, v, attracting = _relative(position, velocity, mass, columns, parent)
    lost = ~np.isfinite(r) & np.isfinite(position[..., columns, :])
    part = gone[..., columns]
    if part.any():
        r, v = np.where(part[..., None], np.nan, r), np.where(part[..., None], np.nan, v)
    with np.errstate(over="ignore"):
        mu = np.where(part, 1.0, constant * (attracting + mass[..., columns]))
    _check(r, lost, mu, attracting, chosen, parent, names)
    found, along = _conics(np.broadcast_to(mu, r.shape[:-1]), r, v), dict(rows or {})
    if isinstance(bodies, str | int | np.integer):
        # Of one body alone, without the axis over bodies.
        found = {name: values[(slice(None),) * (r.ndim - 2) + (0,)] for name, values in found.items()}
    else:
        along["body"] = labels(names, count)[chosen]
    return labeled(found, along)


def _of_copies(forces: tuple[tuple[Force, ...], ...], value: Callable[[tuple[Force, ...]], Any]) -> NDArray[np.float64]:
    """What is asked of the forces of each copy: once of those that copies share."""
    found: dict[int, Any] = {}
    for own in forces:
        if id(own) not in found:
            found[id(own)] = value(own)
    return np.array([found[id(own)] for own in forces])


def _turning(forces: tuple[Force, ...]) -> NDArray[np.float64]:
    """The angular velocity of the frame in which velocities are."""
    found = [np.array(force.omega) for force in forces if isinstance(force, RotatingFrame)]
    if len(found) > 1:
        raise InvalidInput("about", f"expected one RotatingFrame, in which velocities are, got {len(found)}")
    return found[0] if found else np.zeros(3)


def _check_chosen(chosen: list[int], parent: str | int, names: tuple[str, ...]) -> None:
    for body in chosen:
        if body == parent:
            raise InvalidInput("bodies", f"expected other bodies than {body_label(body, names)}, which they are about")
        if parent == JACOBI and body == 0:
            raise InvalidInput("bodies", f"expected bodies after the first, {body_label(0, names)}, which orbits none")


def _check(
    r: NDArray[np.float64],
    lost: NDArray[np.bool_],
    mu: NDArray[np.float64],
    attracting: NDArray[np.float64],
    chosen: list[int],
    parent: str | int,
    names: tuple[str, ...],
) -> None:
    """Refuse by name the first body that has no conic, for the first reason that it has."""
    massless = ~(attracting > 0.0) if isinstance(parent, str) else np.zeros(attracting.shape, dtype=bool)
    coincident = (r == 0.0).all(axis=-1)
    reasons: tuple[Any, ...] = (massless, mu == 0.0, ~np.isfinite(mu), lost.any(axis=-1), coincident)
    wrong = [np.broadcast_to(each.any(axis=tuple(range(each.ndim - 1))), len(chosen)) for each in reasons]
    refused = np.logical_or.reduce(wrong)
    if not refused.any():
        return
    column = int(np.argmax(refused))
    has_no_mass, attracts_not, is_beyond, is_lost, _ = (each[column] for each in wrong)
    who = body_label(chosen[column], names)
    whom = {CENTER_OF_MASS: "the center of mass of the others", JACOBI: "the center of mass of those before it"}.get(
        str(parent)
    ) or body_label(int(parent), names)
    if has_no_mass:
        raise InvalidInput("about", f"expected bodies with mass, but {whom} has none for {who}")
    if attracts_not:
        raise InvalidInput(
            "about", f"expected an orbit, but neither {who} nor {whom} attracts: G times their mass is 0"
        )
    if is_beyond:
        raise InvalidInput("G", "expected units in which G times the masses is within the range of float64")
    if is_lost:
        raise InvalidInput("about", f"expected a distance of {who} from {whom} within the range of float64")
    row = tuple(np.argwhere(coincident[..., column])[0].tolist())
    raise InvalidInput("about", f"expected an orbit, but {who} is at the very place of {whom} in row {row}")


def _relative(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    mass: NDArray[np.float64],
    chosen: NDArray[np.intp],
    parent: str | int,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Places and velocities (…, K, 3) from what each body is about, and the mass there, (…, K) or (…, 1)."""
    if isinstance(parent, int):
        around = slice(parent, parent + 1)
        r, v = (values[..., chosen, :] - values[..., around, :] for values in (position, velocity))
        return r, v, mass[..., around]
    return relative_to_center(position, velocity, mass, chosen, before=parent == JACOBI)


def _conics(mu: NDArray[np.float64], r: NDArray[np.float64], v: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """The elements of every state; NaN where the state is: of a copy that has failed, of a part of another body."""
    known = np.isfinite(r).all(axis=-1) & np.isfinite(v).all(axis=-1)
    everywhere = bool(known.all())
    found = elements(mu, r, v) if everywhere else elements(mu[known], r[known], v[known])
    spread: dict[str, Any] = {}
    for name in Elements.__slots__:
        values = getattr(found, name)
        if not everywhere:
            values, present = np.full((*mu.shape, *values.shape[1:]), np.nan), values
            values[known] = present
        spread[name] = values
    spread["mu"] = np.where(known, mu, np.nan)
    return spread
