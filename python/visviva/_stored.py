"""Read a saved run from a file, and refuse at once whatever is not as `visviva.io` wrote it.

The one idea: every member and every key that a result looks at is checked here, name, type and shape, so that a file
that loads is whole. Anything that goes wrong on the way, in whatever library, is for `visviva.io` to name.
"""

from __future__ import annotations

import json
import math
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.lib import format as npy

from visviva.status import Status

if TYPE_CHECKING:
    from typing import IO

    from numpy.typing import NDArray

__all__ = [
    "COUNTS",
    "FOIL",
    "FORMAT",
    "GENERALIZED",
    "GROUPS",
    "VERSION",
    "Damaged",
    "check_all",
    "check_contents",
    "check_keys",
    "check_version",
    "read_file",
]

FORMAT = "visviva run"
#: Of runs in generalized coordinates, which have a module of their own: `visviva.generalized._saved`.
GENERALIZED = "visviva generalized run"
#: Of counts, which `visviva.scattering._saved` and `visviva.scattering._foil_saved` know.
COUNTS, FOIL = "visviva scattering", "visviva foil"
VERSION = 1
GROUPS = ("columns", "final", "per_trajectory")

# Axes after those over copies (B) and times (T).
_COLUMNS = {
    "position": ("N", 3),
    "velocity": ("N", 3),
    "energy": (),
    "momentum": (3,),
    "angular_momentum": (3,),
    "center_of_mass": (3,),
    "orientation": ("R", 4),
    "angular_velocity": ("R", 3),
}
_ARRAYS: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "mass": ("f8", ("B", "N")),
    "position": ("f8", ("B", "N", 3)),
    "velocity": ("f8", ("B", "N", 3)),
    "t": ("f8", ("T",)),
    "status": ("i1", ("B",)),
    "final/t": ("f8", ("B",)),
    "final/position": ("f8", ("B", "N", 3)),
    "final/velocity": ("f8", ("B", "N", 3)),
    "per_trajectory/steps": ("i8", ("B",)),
    "per_trajectory/rejected": ("i8", ("B",)),
    "per_trajectory/evaluations": ("i8", ("B",)),
}
# Of a run with events, all of them (K lines).
_EVENTS: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "events/which": ("i8", ("K",)),
    "events/t": ("f8", ("K",)),
    "events/position": ("f8", ("K", "N", 3)),
    "events/velocity": ("f8", ("K", "N", 3)),
    "events/member": ("i8", ("K",)),
}
# Of spheres, and of a run with collisions (C lines).
_RADIUS: dict[str, tuple[str, tuple[str | int, ...]]] = {"radius": ("f8", ("B", "N"))}
_COLLISIONS: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "collisions/t": ("f8", ("C",)),
    "collisions/first": ("i8", ("C",)),
    "collisions/second": ("i8", ("C",)),
    "collisions/speed": ("f8", ("C",)),
    "collisions/position": ("f8", ("C", 3)),
    "collisions/energy_lost": ("f8", ("C",)),
    "collisions/survivor": ("i8", ("C",)),
    "collisions/member": ("i8", ("C",)),
    "final/mass": ("f8", ("B", "N")),
}
# Of rigid bodies (R of them); points that are held are those of all copies, moments or tensors unless they are `own_…`.
_RIGID: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "rigid/orientation": ("f8", ("B", "R", 4)),
    "rigid/angular_velocity": ("f8", ("B", "R", 3)),
    "final/orientation": ("f8", ("B", "R", 4)),
    "final/angular_velocity": ("f8", ("B", "R", 3)),
}
_RIGID_OWN: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "rigid/moments": ("f8", ("R", 3)),
    "rigid/inertia": ("f8", ("R", 3, 3)),
    "rigid/pivot": ("f8", ("R", 3)),
    "rigid/own_moments": ("f8", ("B", "R", 3)),
    "rigid/own_inertia": ("f8", ("B", "R", 3, 3)),
}
# Of a run that left something behind for another, and of one that went on with what another left: K blocks, S places.
_HELD: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "final/held": ("f8", ("B", "blocks", "places", 3)),
    "final/node": ("i8", ("B",)),
}
_START: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "final/start_held": ("f8", ("B", "start blocks", "start places", 3)),
    "final/start_position": ("f8", ("B", "N", 3)),
    "final/start_velocity": ("f8", ("B", "N", 3)),
}
_START_TURNED: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "final/start_orientation": ("f8", ("B", "start R", 4)),
    "final/start_angular_velocity": ("f8", ("B", "start R", 3)),
}
_SHARED: dict[str, type | tuple[type, ...]] = {"form": int, "method": str, "dt": (int, float), "t0": (int, float)}
# The keys that files of version 1 have always had; those of a later version are not asked for.
_HEADER: dict[str, type | tuple[type, ...]] = {
    "ensemble": bool,
    "t0": (int, float),
    "forces": list,
    "stats": dict,
    "plan": dict,
}
_STATS: dict[str, type | tuple[type, ...]] = {
    "steps": int,
    "rejected": int,
    "evaluations": int,
    "seconds": (int, float),
    "threads": int,
    "simd": str,
    "method": str,
}
_PLAN: dict[str, type | tuple[type, ...]] = {
    "method": str,
    "solution": str,
    "particles": int,
    "active": int,
    "passive": int,
    "rows": list,
    "skipped": list,
    "evaluations_per_step": int,
    "pairs_per_evaluation": int,
    "lanes": str,
    "threads": int,
    "text": str,
}


class Damaged(Exception):
    """What is wrong with a file, in words for its reader."""

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message


def read_file(stream: IO[bytes]) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The header and the arrays of a file that visviva wrote, of whatever format.

    Raises
    ------
    Damaged
        If there is no header that names a format.
    Exception
        Whatever zipfile, zlib, NumPy and json raise for a file that is not theirs.
    """
    with zipfile.ZipFile(stream) as archive:
        arrays = {_stem(info): _array(archive, info) for info in archive.infolist()}
    if "header" not in arrays:
        raise Damaged("expected a run that visviva saved, but the file has no header")
    header = json.loads(arrays.pop("header").tobytes(), parse_constant=_no_number)
    if not isinstance(header, dict) or not isinstance(header.get("format"), str):
        raise Damaged("expected a run that visviva saved, but the header does not say so")
    return header, arrays


def check_version(header: dict[str, Any], newest: int) -> None:
    """Refuse a file of a later version of its format.

    Raises
    ------
    Damaged
        Saying which version can be read.
    """
    check_keys("header", header, {"version": int})
    if header["version"] > newest:
        raise Damaged(
            f"the file has format version {header['version']}, this visviva reads up to {newest}; use a newer visviva"
        )


def check_contents(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> None:
    """Make sure that all is there that a result of a scene needs.

    Raises
    ------
    Damaged
        If something is missing or not as it should be.
    """
    if header["format"] != FORMAT:
        raise Damaged(f"expected a {FORMAT!r}, but the file holds a {header['format']!r}")
    check_version(header, VERSION)
    _check_header(header)
    _check_arrays(arrays, header)


def _no_number(word: str) -> float:
    raise Damaged(f"expected finite numbers in the header, got {word}")


def _stem(info: zipfile.ZipInfo) -> str:
    return info.filename.removesuffix(".npy")


def _array(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    # The size is compared before memory for it is asked for: a damaged shape may be of any size.
    with archive.open(info) as member:
        version = npy.read_magic(member)
        read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read(member)
        if dtype.hasobject or math.prod(shape) * dtype.itemsize != info.file_size - member.tell():
            raise Damaged(f"expected the array {_stem(info)!r} to fill its place in the file, which it does not")
    # DEFLATE makes nothing smaller than by 1032.
    if info.file_size > 1032 * info.compress_size:
        raise Damaged(f"the array {_stem(info)!r} is larger than its place in the file can hold")
    with archive.open(info) as member:
        array: NDArray[Any] = npy.read_array(member, allow_pickle=False)
    return array


def check_keys(where: str, found: dict[str, Any], expected: dict[str, type | tuple[type, ...]]) -> None:
    """Refuse what lacks a key, or has another kind of value for it.

    Raises
    ------
    Damaged
        Naming the key.
    """
    for name, kind in expected.items():
        if name not in found:
            raise Damaged(f"the {where} of the file lacks {name!r}")
        value = found[name]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise Damaged(f"the {where} of the file has {type(value).__name__} for {name!r}")


def _check_header(header: dict[str, Any]) -> None:
    check_keys("header", header, _HEADER)
    if not all(isinstance(force, dict) and isinstance(force.get("kind"), str) for force in header["forces"]):
        raise Damaged("the header of the file has a force without a kind")
    if "events" in header:
        check_keys("header", header, {"events": list})
        if not all(isinstance(event, dict) and isinstance(event.get("kind"), str) for event in header["events"]):
            raise Damaged("the header of the file has an event without a kind")
    if "names" in header:
        check_keys("header", header, {"names": list})
    check_keys("account of what the run cost", header["stats"], _STATS)
    check_keys("plan", header["plan"], _PLAN)
    for name, own in (("continuation", {"goes_on": bool}), ("start_continuation", {"node": int})):
        if name in header:
            check_keys("header", header, {name: dict})
            check_keys("header", header[name], {**_SHARED, **own})
    if header.get("continuation", {}).get("goes_on") and "start_continuation" not in header:
        raise Damaged("the file has a run that continues another one, but not the state it continues from")
    for name, length in (("rows", 3), ("skipped", 2)):
        for row in header["plan"][name]:
            if not (isinstance(row, list) and len(row) == length and all(isinstance(word, str) for word in row)):
                raise Damaged(f"the plan of the file has a line in {name!r} that is not {length} texts")


def _check_arrays(arrays: dict[str, NDArray[Any]], header: dict[str, Any]) -> None:
    lengths: dict[str, int] = {}
    check_all(_ARRAYS, arrays, lengths)
    if "continuation" in header:
        check_all(_HELD, arrays, lengths)
        if (arrays["final/node"] < 0).any():
            raise Damaged("the file has a node before the first")
    if "start_continuation" in header:
        check_all(_START, arrays, lengths)
        if _START_TURNED.keys() & arrays.keys():
            check_all(_START_TURNED, arrays, lengths)
        if header["start_continuation"]["node"] < 0:
            raise Damaged("the file has a node before the first")
    if any(name.startswith("events/") for name in arrays):
        check_all(_EVENTS, arrays, lengths)
        # Files of before definitions were kept have none.
        looked_for = len(header["events"]) if "events" in header else np.inf
        copies = arrays["events/member"]
        if ((copies < 0) | (copies >= lengths["B"])).any():
            raise Damaged("the file has an event of a copy that there is not")
        which = arrays["events/which"]
        if ((which < 0) | (which >= looked_for)).any():
            raise Damaged("the file has an event that was not looked for")
    if "rigid" in header:
        check_keys("header", header, {"rigid": dict})
        check_keys("account of rigid bodies", header["rigid"], {"forces": list, "names": list})
        own = header["rigid"].get("own_forces")
        if own is not None and len(own[1]) != lengths["B"]:
            raise Damaged(f"the file has forces on rigid bodies of {len(own[1])} copies, of {lengths['B']}")
        if own is not None and any(list(map(_kind, each)) != list(map(_kind, own[0][0])) for each in own[0]):
            raise Damaged("the file has copies on whose rigid bodies other kinds of forces act")
        check_all(_RIGID, arrays, lengths)
        check_all({name: _RIGID_OWN[name] for name in _RIGID_OWN if name in arrays}, arrays, lengths)
    if "radius" in arrays:
        check_all(_RADIUS, arrays, lengths)
    if any(name.startswith("collisions/") for name in arrays):
        _check_collisions(arrays, lengths)
    for name, array in arrays.items():
        group, _, member = name.partition("/")
        if group == "columns" and member:
            axes = ("B", "T", *_COLUMNS.get(member, array.shape[2:]))
            _check_array(name, array, "f8", axes, lengths)
        elif name not in _ARRAYS | _EVENTS | _RADIUS | _COLLISIONS | (_RIGID | _RIGID_OWN if "rigid" in header else {}):
            # Another version may keep more of each copy.
            if group not in GROUPS or not member:
                raise Damaged(f"the file has an array {name!r} that this version does not know")
            _check_array(name, array, array.dtype.str, ("B", *array.shape[1:]), lengths)
    if not header["ensemble"] and lengths["B"] != 1:
        raise Damaged(f"the file has {lengths['B']} copies of what is no ensemble")
    known = {int(status) for status in Status}
    if not known.issuperset(arrays["status"].tolist()):
        raise Damaged("the file has a status that this version does not know")


def _kind(force: dict[str, Any]) -> Any:
    return force["kind"]


def _check_collisions(arrays: dict[str, NDArray[Any]], lengths: dict[str, int]) -> None:
    check_all(_COLLISIONS, arrays, lengths)
    copies, first, second = (arrays[f"collisions/{name}"] for name in ("member", "first", "second"))
    survivor = arrays["collisions/survivor"]
    if ((copies < 0) | (copies >= lengths["B"])).any():
        raise Damaged("the file has a collision of a copy that there is not")
    if ((first < 0) | (second <= first) | (second >= lengths["N"])).any():
        raise Damaged("the file has a collision of bodies that there are not")
    if ((survivor != -1) & (survivor != first) & (survivor != second)).any():
        raise Damaged("the file has a merger of which another body is left")


def check_all(
    expected: dict[str, tuple[str, tuple[str | int, ...]]], arrays: dict[str, NDArray[Any]], lengths: dict[str, int]
) -> None:
    """Refuse what lacks an array, or has one of another type or shape; `lengths` are those of the axes by name.

    Raises
    ------
    Damaged
        Naming the array.
    """
    for name, (dtype, axes) in expected.items():
        if name not in arrays:
            raise Damaged(f"the file lacks the array {name!r}")
        _check_array(name, arrays[name], dtype, axes, lengths)


def _check_array(
    name: str, array: NDArray[Any], dtype: str, axes: tuple[str | int, ...], lengths: dict[str, int]
) -> None:
    shape = tuple(
        lengths.setdefault(axis, came) if isinstance(axis, str) else axis
        for axis, came in zip(axes, array.shape, strict=False)
    )
    if array.dtype != np.dtype(dtype) or array.ndim != len(axes) or array.shape != shape:
        raise Damaged(f"the array {name!r} of the file has shape {array.shape} of {array.dtype}, which does not fit")
