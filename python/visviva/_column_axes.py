"""What the numbers of recorded columns are of: bodies, components, and the letters of these."""

from __future__ import annotations

from visviva import _core
from visviva._exported import AXES
from visviva._keywords import one_of
from visviva.errors import InvalidInput

__all__ = ["COLUMN_AXES", "components_of"]

# The axes of a column after time: what it is over, and the numbers of each.
COLUMN_AXES: dict[str, tuple[str, ...]] = {
    "position": ("body", "component"),
    "velocity": ("body", "component"),
    "orientation": ("rigid_body", "quaternion"),
    "angular_velocity": ("rigid_body", "component"),
}
COLUMN_AXES |= {name: ("component",) if width == 3 else () for name, _, width, _ in _core.columns()}


def components_of(name: str, component: object) -> tuple[list[str], list[int]]:
    """The letters of the numbers that a column has at a time, and which of them are chosen: all if none is named.

    Raises
    ------
    visviva.InvalidInput
        For a component that is none of them, or of a column that is one number.
    """
    over = COLUMN_AXES[name]
    letters = [str(each) for each in AXES[over[-1]]] if over else []
    if component is None:
        return letters, list(range(len(letters)))
    if not letters:
        raise InvalidInput("component", f"{name} is one number and has no components, got {component!r}")
    return letters, [letters.index(one_of("component", component, letters))]
