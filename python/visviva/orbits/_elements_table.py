"""How elements of orbits are told: a row for each element, however many orbits and times there are.

The one idea: of a few orbits every value is shown, of one or two bodies over time the first and the last, of more the
range.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Sheet
from visviva._text import count
from visviva.orbits._rows import ANGLES

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from numpy.typing import NDArray

    from visviva.orbits._elements import Elements

__all__ = ["elements_table", "in_a_line", "is_few"]

#: Bodies that have a column each.
_BODIES = 2
#: Orbits at one time of which every number is shown.
_FEW = 9
_LENGTH, _TIME, _NONE = "length", "time", "1"
_UNITS = {
    "mu": "length³/time²",
    "angular_momentum": "length²/time",
    "energy": "length²/time²",
    "laplace_runge_lenz": "length³/time²",
    "hodograph_center": "length/time",
    "hodograph_radius": "length/time",
    "time_since_pericenter": _TIME,
    "period": _TIME,
    "areal_rate": "length²/time",
    "eccentricity": _NONE,
} | dict.fromkeys(("semi_major_axis", "semi_minor_axis", "semi_latus_rectum", "pericenter", "apocenter"), _LENGTH)


def in_a_line(found: Elements) -> str:
    """How many orbits, what they are of, and between which ends the elements are that are asked for first."""
    along = _along(found)
    of = count(int(np.size(found.mu)), "orbit")
    if "time" in along:
        bodies = count(len(along["body"]), "body", "bodies") if "body" in along else "1 body"
        copies = f"{count(len(along['copy']), 'copy', 'copies')}, " if "copy" in along else ""
        of = f"{copies}{bodies}, {_times(along)}"
    ends = [f"{name} {_range(getattr(found, name))}" for name in ("semi_major_axis", "eccentricity")]
    return f"Elements({'; '.join([of, *ends])})"


def is_few(found: Elements) -> bool:
    """Whether there are so few orbits, at one time, that each value is shown."""
    times = len(_along(found).get("time", (0,)))
    return times == 1 and 0 < np.size(found.mu) <= _FEW


def elements_table(found: Elements) -> Sheet:
    """A row for each element, its values and its unit."""
    along, size = _along(found), int(np.size(found.mu))
    values = {name: np.asarray(getattr(found, name)) for name in type(found).__slots__}
    vectors = [name for name, value in values.items() if value.ndim > np.ndim(found.mu)]
    times = len(along["time"]) if "time" in along and "copy" not in along else 1
    bodies = [str(body) for body in along["body"]] if "body" in along else [""]
    few = is_few(found)
    lengths = not few and size != times
    if lengths:
        values |= {name: np.linalg.norm(values[name], axis=-1) for name in vectors}
    header: tuple[str, ...]
    if few:
        names = bodies if len(bodies) == size else [f"orbit {at}" for at in range(size)]
        header = ("value",) if size == 1 else tuple(names)
        caption = f"Elements of {count(size, 'orbit')}"
        cells = {name: tuple(_one(each, ".9g") for each in value.reshape(size, -1)) for name, value in values.items()}
    elif times > 1 and size <= _BODIES * times:
        header = tuple(f"{body}, {end}" if body else end for body in bodies for end in ("first", "last"))
        caption = f"Elements at {_times(along)}"
        cells = {name: _first_and_last(value, times, len(bodies)) for name, value in values.items()}
    else:
        header = ("least", "greatest")
        over = [count(len(each), *_NOUNS.get(axis, (axis,))) for axis, each in along.items() if axis != "time"]
        over += [_times(along)] if "time" in along else []
        caption = f"Elements of {', '.join(over) or count(size, 'orbit')}"
        cells = {name: _ends(value) for name, value in values.items()}
    ellipses = bool((np.asarray(found.eccentricity) < 1.0).all())
    rows = [(name, *cells[name], _unit(name, ellipses)) for name in values]
    note = "units are those of what was given" + ("; of vectors the lengths" if lengths else "")
    return Sheet(caption, rows, ("", *header, "unit"), note)


_NOUNS = {"copy": ("copy", "copies"), "body": ("body", "bodies")}


def _along(found: Elements) -> Mapping[str, NDArray[Any]]:
    known: Mapping[str, NDArray[Any]] = getattr(found, "_axes", {})
    return known


def _times(along: Mapping[str, NDArray[Any]]) -> str:
    t = along["time"]
    return count(len(t), "time") + (f", {t[0]:g} to {t[-1]:g}" if len(t) else "")


def _first_and_last(values: NDArray[np.float64], times: int, bodies: int) -> tuple[str, ...]:
    each = values.reshape(times, bodies, -1)
    return tuple(_one(each[at, body]) for body in range(bodies) for at in (0, -1))


def _one(numbers: NDArray[np.float64], digits: str = ".6g") -> str:
    texts = [format(number + 0.0, digits) for number in numbers]  # no -0
    return texts[0] if len(texts) == 1 else f"[{' '.join(texts)}]"


def _ends(values: NDArray[np.float64]) -> tuple[str, str]:
    known = values[~np.isnan(values)]
    return (_one(known.min()[None]), _one(known.max()[None])) if known.size else ("nan", "nan")


def _range(values: NDArray[np.float64]) -> str:
    return " to ".join(dict.fromkeys(_ends(np.asarray(values))))


def _unit(name: str, ellipses: bool) -> str:
    # Anomalies of parabolas and hyperbolas are no angles.
    angle = name in ANGLES or (ellipses and name.endswith("anomaly"))
    return "rad" if angle else _UNITS.get(name, _NONE)


def __dir__() -> list[str]:
    return list(__all__)
