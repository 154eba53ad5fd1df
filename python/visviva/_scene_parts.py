"""What `Scene` is given, in any order: bodies and forces told apart, and what is neither refused by name."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, TypeAlias, cast

from visviva import forces as force_classes
from visviva._body_force import BodyForce
from visviva._keywords import JOINING
from visviva._text import article
from visviva.errors import InvalidInput
from visviva.forces import Force
from visviva.particles import Particles
from visviva.rigid_bodies import RigidBodies

if TYPE_CHECKING:
    from collections.abc import Sequence

    _Known: TypeAlias = tuple[tuple[str, ...], int]

__all__ = ["Part", "bodies_and_particles", "sorted_parts"]

# Made once: a union of types takes longer to make than to ask.
Part: TypeAlias = Particles | RigidBodies | Force | BodyForce
_SEVERAL = (list, tuple)


def sorted_parts(
    parts: Sequence[Part | Sequence[Part]],
    particles: Particles | None,
    forces: Force | BodyForce | Sequence[Force | BodyForce],
) -> tuple[tuple[Part, ...], list[Particles], list[RigidBodies]]:
    """All parts, the one `Particles` among them if there are some, and the rigid bodies.

    Raises
    ------
    visviva.InvalidInput
        If there is more than one `Particles`, or no body at all, or a part is neither bodies nor a force.
    """
    by_name = () if particles is None else (particles,)
    all_parts = tuple(chain.from_iterable(_flat(part) for part in (*parts, *by_name, forces)))
    found = [part for part in all_parts if isinstance(part, Particles)]
    rigid = [part for part in all_parts if isinstance(part, RigidBodies)]
    named = sum(len(_flat(part)) for part in (*parts, *by_name))  # what follows came as forces=
    for place, part in enumerate(all_parts):
        if not isinstance(part, Part):
            came = f"the class {part.__name__}" if isinstance(part, type) else article(type(part).__name__)
            known = ", ".join(name for name in force_classes.__all__ if name != "Force")
            argument, wanted = ("parts", "Particles, RigidBodies and ") if place < named else ("forces", "")
            raise InvalidInput(argument, f"expected {wanted}forces ({known}), got {came}{_cure(part)}")
    if len(found) > 1 or not (found or rigid):
        advice = JOINING if found else "the forces need bodies to act on"
        raise InvalidInput("parts", f"expected exactly one Particles, got {len(found)}; {advice}")
    return cast("tuple[Part, ...]", all_parts), found, rigid


def bodies_and_particles(points: Particles, rigid: RigidBodies | None) -> tuple[_Known, _Known]:
    """Names and number of the rigid bodies among the points of a scene, the last of them, and of its particles."""
    free = len(points) - (len(rigid) if rigid else 0)
    return (points.names[free:], len(points) - free), (points.names[:free], free)


def _cure(part: object) -> str:
    """What to write for what is no part of a scene, if that is known."""
    if isinstance(part, type):
        return f"; make one of it: {part.__name__}(…)" if issubclass(part, Part) else ""
    return (
        "; a force by a formula is ExpressionForce(force=…), or potential=… where it has one" if callable(part) else ""
    )


def _flat(part: object) -> Sequence[object]:
    return part if isinstance(part, _SEVERAL) else (part,)
