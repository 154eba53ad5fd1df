"""Forces on rigid bodies whose numbers differ from copy to copy of an ensemble.

The one idea: as of forces on points (`_own_forces.py`), those of a copy are the scene's with its own values in their
place, made by their class, which checks them. Only numbers may differ, with a dimension or parameters of a formula:
which bodies are meant, along whose axes and by what function is the same in all copies, as lanes of the core share it.
"""

from __future__ import annotations

from itertools import repeat
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._body_force import BodyForce
from visviva._keywords import did_you_mean
from visviva._scene_parts import bodies_and_particles
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from visviva import _core
    from visviva.scene import Scene

__all__ = ["described_loads", "load_of_copies", "place_of_load", "refuse_shared"]


def place_of_load(scene: Scene, which: Any) -> int | None:
    """The place of a force on rigid bodies that is given itself, or by the name of its class; None if it is no such."""
    loads = scene.body_forces
    if isinstance(which, BodyForce):
        # The scene keeps indices where bodies were named.
        try:
            which = which._resolved(*bodies_and_particles(scene.particles, scene.rigid_bodies))
        except InvalidInput as error:
            raise InvalidInput("parameters", f"{which!r}: {error}") from error
        found = [place for place, load in enumerate(loads) if load == which]
        advice = "make one of them, with the sum of their values"
    elif isinstance(which, str):
        found = [place for place, load in enumerate(loads) if type(load).__name__ == which]
        if not found:
            return None
        advice = "give the one itself that is meant"
    else:
        return None
    if len(found) != 1:
        shown = ", ".join(map(repr, loads)) or "none"
        why = "it has none like that" if not found else f"it has several like that: {advice}"
        raise InvalidInput(
            "parameters", f"expected a force on rigid bodies of the scene ({shown}), got {which!r}; {why}"
        )
    return found[0]


def refuse_shared(load: BodyForce, named: Mapping[Any, Any]) -> None:
    """Refuse names of what is the same in all copies, and of what the force has none of.

    Raises
    ------
    InvalidInput
        Naming it.
    """
    known, kind = load._values(), type(load).__name__
    differing = load._differing()
    own = tuple(name for name, value in differing.items() if value is not None)
    has = f"numbers of {kind} ({', '.join(own) or 'which has none that may differ'})"
    for name in named:
        if name in own:
            continue
        why = did_you_mean(str(name), own)
        if name in differing:
            why = ": it is None in the scene, and is so in all copies; run a scene for each"
        elif name in known or (name == "address" and "function" in known):
            why = ": bodies, axes and functions are the same in all copies; run a scene for each"
        raise InvalidInput("parameters", f"expected {has}, got {name!r}{why}")


def load_of_copies(load: BodyForce, values: Mapping[str, Any] | None, count: int) -> Iterable[BodyForce]:
    """One force of the scene as each copy has it.

    Raises
    ------
    InvalidInput
        What its class refuses, with the number of the copy.
    """
    if values is None:
        return repeat(load, count)
    rows = {name: given.tolist() if isinstance(given, np.ndarray) else given for name, given in values.items()}
    return [_with_values(load, {name: given[copy] for name, given in rows.items()}, copy) for copy in range(count)]


def _with_values(load: BodyForce, own: dict[str, Any], copy: int) -> BodyForce:
    try:
        return load._of_copy(own)
    except InvalidInput as error:
        raise InvalidInput("parameters", f"{type(load).__name__} of copy {copy}: {error}") from error


def described_loads(copies: Sequence[tuple[BodyForce, ...]]) -> tuple[list[dict[str, Any]], _core._OwnForces | None]:
    """What the core and a file are told: the forces of the first copy, and what each has if they differ."""
    sets: list[tuple[BodyForce, ...]] = []
    known: dict[tuple[Any, ...], int] = {}
    numbers: dict[int, int] = {}
    # Most copies share theirs, or none does: each is compared once, in what they may differ.
    for which, loads in {id(own): own for own in copies}.items():
        key = tuple(value for load in loads for value in load._differing().values())
        numbers[which] = known.setdefault(key, len(sets))
        if numbers[which] == len(sets):
            sets.append(loads)
    told = [[load._core_arguments() for load in loads] for loads in sets]
    of_copy = [numbers[id(own)] for own in copies]
    return told[of_copy[0]], (told, of_copy) if len(told) > 1 else None


def __dir__() -> list[str]:
    return list(__all__)
