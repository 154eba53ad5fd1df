"""How far energies of scenes with rigid bodies are off after fixed steps, as the core itself tells of particles."""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import TOLERATED, steps_may_be_taken_again
from visviva._rigid_steps import COLUMNS, after_a_step, unresolved
from visviva._some_copies import of_copies
from visviva._turning import kept_by_bodies
from visviva.errors import Error
from visviva.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["look"]

_FEW_PAIRS = 500
"""A sum over so few pairs is nothing beside a run."""

_MANY_EVALUATIONS = 2_000
"""A sum over pairs takes less than a hundredth of so many evaluations of the forces."""

_ALONE = 10_000
"""Evaluations beside which a look takes a few hundredths, where copies are looked at one by one, …"""

_FEW_ALONE = 16
"""… or so few copies."""

_LEAST = 1e-290
"""Smaller energies may be products with masses that are not normal numbers, and have no digits to be off by."""

_NOTHING = 1e-9
"""Of what the forces give in a step: energies of a start that tell nothing of how large those of the motion are."""

_ENERGIES = ["energy", "kinetic_energy", "potential_energy"]


def look(result: dict[str, Any], asked: _core._Request, threads: int | None) -> None:
    """Tell in the result of a run of copies of a scene how far the worst of their energies is off at the end.

    Where it costs next to nothing beside the run, and the forces conserve energy. Where they do not, of steps.
    """
    if asked["rigid"] is None or asked["dt"] is None or not result["stats"]["steps"]:
        return
    bodies = asked["mass"].shape[1]
    of_all = (asked["mass"], asked["rigid"]["moments"], asked["rigid"]["axes"])
    alike = asked["own_forces"] is None and asked["rigid"]["own_loads"] is None
    together = alike and all(bool((each == each[0]).all()) for each in of_all)
    few = bodies * (bodies - 1) // 2 <= _FEW_PAIRS
    each_apart = not together and len(asked["mass"]) > _FEW_ALONE
    fewest = _ALONE if each_apart else 0 if few else _MANY_EVALUATIONS
    finished = result["status"] == Status.OK
    counts = result["per_trajectory"]
    enough = counts["evaluations"] >= fewest
    again = steps_may_be_taken_again(counts["steps"], bodies + bodies * (bodies - 1) // 2)
    if each_apart:
        again &= enough  # What their own forces conserve is asked of each, too.
    if not (finished & (enough | again)).any():
        return
    try:
        told = _tells(asked)
    except Error:
        return  # A run that is done is not lost for what cannot be told of it.
    looked_at = finished & told & enough
    copies = np.flatnonzero(looked_at)
    groups = ([copies] if together else np.split(copies, len(copies))) if len(copies) else []
    changes, sizes, starts = np.zeros((3, len(looked_at)))
    for group in groups:
        # As the core does, which tells nothing where it has no energy.
        with suppress(Error):
            changes[group], sizes[group], starts[group] = _changes(result, asked, group)
    worst, error = _worst(changes, sizes, starts, asked)
    order = _orders()[result["stats"]["method"]]
    if error > 0.0:
        result["energy_error"] = (worst, error, abs(asked["dt"]), order)
    doubt = unresolved(result, asked, np.flatnonzero(finished & ~told & again), order, threads)
    if doubt is not None:
        result["unresolved"] = doubt


@cache
def _orders() -> dict[str, int]:
    """Of all methods: of those that turn bodies and, where nothing turns them, of those that move them."""
    return {method["name"]: method["order"] for method in (*_core.methods(), *_core.methods(rigid=True))}


def _worst(
    changes: NDArray[np.float64], sizes: NDArray[np.float64], starts: NDArray[np.float64], asked: _core._Request
) -> tuple[int, float]:
    """The copy that is off by most of its size, and by how much."""
    known = np.isfinite(sizes) & (sizes >= _LEAST) & ~np.isnan(changes)
    with np.errstate(over="ignore"):
        errors = np.divide(changes, sizes, out=np.zeros_like(changes), where=known)
    for copy in np.argsort(-errors):
        # The worst is that of which nothing more is to be learned.
        if errors[copy] > TOLERATED:
            gained = _gained_in_a_step(asked, copy)
            if starts[copy] <= _NOTHING * gained:
                errors[copy] = changes[copy] / (sizes[copy] + gained)
                continue
        break
    worst = int(np.argmax(errors))
    return worst, float(errors[worst])


def _forces(asked: _core._Request, copy: int) -> list[dict[str, Any]]:
    own = asked["own_forces"]
    return asked["forces"] if own is None else own[0][own[1][copy]]


def _tells(asked: _core._Request) -> NDArray[np.bool_]:
    """Of each copy whether its energy is conserved."""
    rigid: Any = asked["rigid"]
    same = (None, [0] * len(asked["mass"]))
    # By what acts on points and on rigid bodies: copies are asked once for those that have the same.
    acting = np.array([(own or same)[1] for own in (asked["own_forces"], rigid["own_loads"])])
    _, firsts, sets = np.unique(acting, axis=1, return_index=True, return_inverse=True)
    return np.array([_conserves(asked, int(copy)) for copy in firsts])[sets.ravel()]


def _conserves(asked: _core._Request, copy: int) -> bool:
    kept = _core.conserves(
        mass=asked["mass"][copy],
        forces=_forces(asked, copy),
        position=asked["position"][copy],
        velocity=asked["velocity"][copy],
        about=np.zeros(3),
    )
    return kept_by_bodies(_rigid(asked, copy), kept)["energy"]


def _rigid(asked: _core._Request, copy: int) -> _core._Rigid:
    of_one: Any = of_copies(asked, slice(copy, copy + 1))["rigid"]
    rigid: _core._Rigid = of_one
    return rigid


def _changes(
    result: dict[str, Any], asked: _core._Request, copies: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """How far energies of copies with the same forces and bodies went, kinetic + |potential|, and that at the start."""
    first = (asked["position"], asked["velocity"], *_turning(asked))
    states = [np.concatenate([a[copies], b[copies]]) for a, b in zip(first, _last(result), strict=True)]
    told = _energies(asked, copies[0], states)
    energy, kinetic, potential = (told[name].reshape(2, -1) for name in _ENERGIES)
    with np.errstate(all="ignore"):
        change = np.abs(energy[1] - energy[0])
        change[np.isfinite(energy[0]) & ~np.isfinite(kinetic[1])] = np.inf
        # Bodies in one place that attract each other have no energy to be told.
        change[np.isfinite(kinetic[1]) & np.isneginf(potential[1])] = np.nan
        # What is beyond all numbers at the end is no measure.
        ends = np.where(np.isfinite(potential[1]), np.abs(potential[1]), 0.0)
        start = kinetic[0] + np.abs(potential[0])
        return change, np.maximum(start, kinetic[0] + ends), start


def _turning(asked: _core._Request) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rigid: Any = asked["rigid"]
    return rigid["orientation"], rigid["angular_velocity"]


def _last(result: dict[str, Any]) -> list[NDArray[np.float64]]:
    return [result["final"][name] for name in COLUMNS]


def _energies(asked: _core._Request, copy: int, states: list[NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """Of states along the first axis, of bodies with the masses and forces of that copy."""
    position, velocity, *turning = states
    return _core.conserved(
        mass=asked["mass"][copy],
        forces=_forces(asked, copy),
        position=position,
        velocity=velocity,
        about=np.zeros(3),
        columns=_ENERGIES,
        turning=(_rigid(asked, copy), turning[0], turning[1]),
    )


def _gained_in_a_step(asked: _core._Request, copy: int) -> float:
    """The kinetic energy after a step from the start of a copy.

    Of a motion that begins at rest, where potential energies vanish, and comes back there, nothing else tells how large
    its energies are.
    """
    request = of_copies(asked, slice(copy, copy + 1))
    start = [request["position"], request["velocity"], *_turning(request)]
    with suppress(Error):
        after = after_a_step(request, start, asked["t0"], asked["dt"] or 0.0, 1)
        kinetic = float(_energies(asked, copy, after)["kinetic_energy"][0])
        return kinetic if np.isfinite(kinetic) else 0.0
    return 0.0
