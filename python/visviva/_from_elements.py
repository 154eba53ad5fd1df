"""Bodies from their orbital elements about others; the conics are `visviva.orbits`.

The one idea: elements give the motion relative to what a body is about, with μ = G (mass there + its own); it is put
there, and may itself be gone about by the next. Every way to give a size, a pericenter's direction or a place on the
orbit is made into one: the pericenter distance, its argument, and an anomaly or the time since the pericenter.
Source: Murray & Dermott, *Solar System Dynamics* (1999) §2.3–2.8, §9.7 (Jacobi coordinates).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import number, radius_array
from visviva._names import CENTER_OF_MASS, JACOBI, body_index, body_label, checked_names
from visviva.errors import InvalidInput
from visviva.orbits import semi_major_axis as of_period
from visviva.orbits import state
from visviva.orbits._arguments import broadcast

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.particles import Particles

__all__ = ["from_elements"]

_SIZES = ("semi_major_axis", "pericenter", "semi_latus_rectum", "period")
_DIRECTIONS = ("argument_of_pericenter", "longitude_of_pericenter")
_PLACES = ("true_anomaly", "eccentric_anomaly", "mean_anomaly", "mean_longitude", "time_of_pericenter")


@dataclass(frozen=True, slots=True)
class _Bodies:
    """The bodies that are there already."""

    mass: list[float]
    position: list[NDArray[np.float64]]
    velocity: list[NDArray[np.float64]]
    names: tuple[str, ...]
    radius: list[float]


def from_elements(
    make: Callable[..., Particles],
    central: Particles | float,
    G: float,
    about: Any,
    t0: float,
    names: Any,
    given: dict[str, Any],
) -> Particles:
    """`Particles.from_elements`; `given` has the mass and the elements by name, None for what was not given."""
    placed = _there(make, central)
    size = _one_of(given, _SIZES)
    if size is None:
        raise InvalidInput("semi_major_axis", f"expected the size of the orbits: one of {', '.join(_SIZES)}")
    direction = _one_of(given, _DIRECTIONS) or "argument_of_pericenter"
    place = _one_of(given, _PLACES) or "true_anomaly"
    named = ("mass", size, "eccentricity", "inclination", "longitude_of_ascending_node", direction, place)
    shape, flat, _ = broadcast({name: 0.0 if given[name] is None else given[name] for name in named}, {})
    if len(shape) > 1:
        raise InvalidInput(size, f"expected numbers or arrays of one axis, over the bodies, got shape {shape}")
    of = dict(zip(named, flat, strict=True))
    if (of["mass"] < 0.0).any():
        raise InvalidInput("mass", f"expected masses of at least 0, got {of['mass'].min()}; 0 marks a test particle")
    count = len(of["mass"])
    all_names = _all_names(placed, central, names, count)
    parents = _parents(about, len(placed.mass), count, all_names)
    inside = _attracting(placed, of["mass"], parents)
    with np.errstate(over="ignore"):
        mu = number("G", G) * (inside + of["mass"])
    _check_mu(mu, all_names[-count:], len(placed.mass))
    r, v = _relative(mu, of, size, direction, place, number("t0", t0))
    mass, position, velocity = _put(placed, of["mass"], parents, r, v)
    own = radius_array(given["radius"], (count,), {"N": (count, size)})
    return make(mass, position, velocity, all_names or None, [*placed.radius, *own.tolist()])


def _there(make: Callable[..., Particles], central: Any) -> _Bodies:
    from visviva.particles import Particles

    if not isinstance(central, Particles):
        central = make([number("central", central)], np.zeros((1, 3)))
    if not len(central):
        raise InvalidInput("central", "expected at least one body to orbit, got none")
    return _Bodies(
        central.mass.tolist(), list(central.position), list(central.velocity), central.names, central.radius.tolist()
    )


def _one_of(given: dict[str, Any], names: tuple[str, ...]) -> str | None:
    """Which of several ways to give the same was taken."""
    came = [name for name in names if given[name] is not None]
    if len(came) > 1:
        raise InvalidInput(came[1], f"expected one of {', '.join(names)}, got {' and '.join(came)}")
    return came[0] if came else None


def _all_names(there: _Bodies, central: Any, names: Any, count: int) -> tuple[str, ...]:
    """Of the bodies that are there and of the new ones; none if none are given."""
    if isinstance(names, str):
        names = [names]
    is_number = not hasattr(central, "names")
    if names is None:
        if there.names:
            cure = f"names=[f'particle {{i}}' for i in range({count})]"
            new = f"expected {count} names, of each new body, as those that are there have some"
            raise InvalidInput("names", f"{new}; give your own, or {cure}")
        return ()
    before = len(there.mass)
    expected = before + count if is_number else count
    own = tuple(names) if hasattr(names, "__iter__") else names
    if isinstance(own, tuple) and len(own) != expected:
        whose = "the central body and each that orbits it" if is_number else "each new body"
        raise InvalidInput("names", f"expected {expected} names, of {whose}, got {len(own)}")
    if is_number:
        return checked_names(own, expected)
    if not there.names:
        raise InvalidInput("names", "expected none, as the bodies that are there have none; give those names, too")
    return checked_names((*there.names, *checked_names(own, count)), before + count)


def _parents(about: Any, before: int, count: int, names: tuple[str, ...]) -> list[int | str]:
    """What each new body is about: the index of a body before it, or one of the two words."""
    entries = list(about) if isinstance(about, list | tuple | np.ndarray) else [about] * count
    if len(entries) != count:
        raise InvalidInput("about", f"expected one body to orbit, or one for each of {count}, got {len(entries)}")
    parents: list[int | str] = []
    for new, entry in enumerate(entries, before):
        if isinstance(entry, str) and entry in (CENTER_OF_MASS, JACOBI):
            parents.append(entry)
            continue
        parent = body_index("about", entry, names, before + count)
        if parent >= new:
            who, whom = body_label(new, names), body_label(parent, names)
            raise InvalidInput("about", f"expected a body that is there before {who}, got {whom}; give it earlier")
        parents.append(parent)
    return parents


def _attracting(there: _Bodies, mass: NDArray[np.float64], parents: list[int | str]) -> NDArray[np.float64]:
    """The mass of what each new body is about."""
    given = fsum(there.mass)
    all_masses = there.mass + mass.tolist()
    before = len(there.mass)
    inside = np.empty(len(mass))
    total = given
    for new, parent in enumerate(parents):
        inside[new] = given if parent == CENTER_OF_MASS else total if parent == JACOBI else all_masses[int(parent)]
        total += all_masses[before + new]
    return inside


def _check_mu(mu: NDArray[np.float64], names: tuple[str, ...], before: int) -> None:
    for new, value in enumerate(mu.tolist()):
        who = names[new] if names else f"body {before + new}"
        if value == 0.0:
            raise InvalidInput(
                "mass", f"expected something that attracts: G times the masses of {who} and what it is about is 0"
            )
        if not np.isfinite(value):
            raise InvalidInput("mass", "expected units in which G times the masses is within the range of float64")


def _relative(
    mu: NDArray[np.float64], of: dict[str, NDArray[np.float64]], size: str, direction: str, place: str, t0: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The states relative to what the bodies are about."""
    node, argument = of["longitude_of_ascending_node"], of[direction]
    longitude = node + argument
    if direction == "longitude_of_pericenter":
        argument, longitude = argument - node, argument
    where = {place: of[place]}
    if place == "mean_longitude":
        where = {"mean_anomaly": of[place] - longitude}
    elif place == "time_of_pericenter":
        where = {"true_anomaly": np.zeros(len(mu))}
    r, v = state(
        mu,
        pericenter=_pericenter(mu, of, size),
        eccentricity=of["eccentricity"],
        inclination=of["inclination"],
        node=node,
        argument_of_pericenter=argument,
        **where,
    )
    if place == "time_of_pericenter":
        for body, since in enumerate((t0 - of[place]).tolist()):
            one = slice(body, body + 1)
            moved, rate = _core.orbit_propagate(mu[one], r[one], v[one], np.array([since]))
            r[body], v[body] = moved.reshape(3), rate.reshape(3)
        if not (np.isfinite(r).all() and np.isfinite(v).all()):
            raise InvalidInput(place, "expected a time at which the body is within the range of float64")
    return r, v


def _pericenter(mu: NDArray[np.float64], of: dict[str, NDArray[np.float64]], size: str) -> NDArray[np.float64]:
    """The least distance q = a|1 − e| = p/(1 + e); of repulsion a(e + 1) and p/(e − 1)."""
    given, e = of[size], of["eccentricity"]
    for name, values, good, expected in (
        ("eccentricity", e, e >= 0.0, "e ≥ 0"),
        ("eccentricity", e, (mu > 0.0) | (e > 1.0), "e > 1, as they repel each other"),
        (size, given, given > 0.0, "a positive number, also for a hyperbola"),
    ):
        if not good.all():
            raise InvalidInput(name, f"expected {expected}, got {values[~good][0]}")
    if size == "pericenter":
        return given
    if size == "semi_latus_rectum":
        return given / np.where(mu > 0.0, 1.0 + e, e - 1.0)
    if size == "period":
        closed = (mu > 0.0) & (e < 1.0)
        if not closed.all():
            raise InvalidInput("period", f"expected ellipses, e < 1, got e = {e[~closed][0]}: give pericenter instead")
        given = of_period(mu, given)
    if (e == 1.0).any():
        raise InvalidInput(size, "expected no parabola, e = 1, which has no semi-major axis: give pericenter instead")
    return given * np.where(mu > 0.0, np.abs(1.0 - e), e + 1.0)


def _put(
    there: _Bodies, mass: NDArray[np.float64], parents: list[int | str], r: NDArray[np.float64], v: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Each relative state on that of what it is about."""
    position, velocity = list(there.position), list(there.velocity)
    center, rate, total = (np.array(part) for part in _center(there))
    given = center, rate
    for body, parent in enumerate(parents):
        if parent == CENTER_OF_MASS:
            base = given
        elif parent == JACOBI:
            base = center, rate
        else:
            base = position[int(parent)], velocity[int(parent)]
        position.append(base[0] + r[body])
        velocity.append(base[1] + v[body])
        if mass[body] > 0.0:
            total = total + mass[body]
            share = mass[body] / total
            center = center + share * (position[-1] - center)
            rate = rate + share * (velocity[-1] - rate)
    return np.concatenate([there.mass, mass]), np.array(position), np.array(velocity)


def _center(there: _Bodies) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Place and velocity of the center of mass of the bodies that are there, and their mass; their mean if none has."""
    from visviva.particles import weighted_mean

    total = fsum(there.mass)
    weights = np.array(there.mass) if total > 0.0 else np.ones(len(there.mass))
    position, velocity = np.array(there.position), np.array(there.velocity)
    return weighted_mean(position, weights), weighted_mean(velocity, weights), total
