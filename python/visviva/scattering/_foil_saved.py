"""Files of ions and foils: what `FoilResult.save` writes and `visviva.load` reads.

A file of version 1 holds ``header`` and arrays. The header has the foil, what came to it, which events these are, and
the names of the tallies; arrays are ``sums`` (4, 3), and of each tally, by its number, ``0/edges`` and ``0/sums``.
Every later version of visviva must load it: `tests/reference` keeps one.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

import visviva
from visviva._arrays import number, positive
from visviva._stored import FOIL, Damaged, check_all, check_keys, check_version
from visviva.potentials import potential_from_core
from visviva.scattering._foil import Foil
from visviva.scattering._foil_material import Ion, Material
from visviva.scattering._foil_result import Bombardment, FoilResult
from visviva.scattering._foil_tally import FoilTally
from visviva.scattering._of_events import checked_events

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["VERSION", "counts_for_file", "run_from_file"]

VERSION = 1

_NUMBER = (int, float)
_HEADER: dict[str, type | tuple[type, ...]] = {
    "foil": dict,
    "material": dict,
    "ion": dict,
    "bombardment": dict,
    "events": list,
    "units": list,
    "tallies": list,
    "collisions_across": _NUMBER,
    "table_error": _NUMBER,
}
_MATERIAL: dict[str, type | tuple[type, ...]] = {
    "density": _NUMBER,
    "atomic_number": list,
    "mass": list,
    "fraction": list,
    "mean_excitation_energy": (list, type(None)),
}
_FOIL: dict[str, type | tuple[type, ...]] = {
    "thickness": _NUMBER,
    "potential": (str, list),
    "stopping": (str, list),
    "minimum_angle": _NUMBER,
}
_BOMBARDMENT: dict[str, type | tuple[type, ...]] = {
    "beam_energy": _NUMBER,
    "lowest_energy": _NUMBER,
    "incidence": _NUMBER,
    "collisions": str,
    "forced_angle": (int, float, type(None)),
}
# Which fates a tally counts: transmitted, reflected, stopped.
_COUNTED = {
    "transmitted_angle": [0],
    "transmitted_energy": [0],
    "reflected_angle": [1],
    "reflected_energy": [1],
    "lab_angle": [0, 1],
    "stopped_depth": [2],
    "cm_angle": [0, 1, 2],
}


def counts_for_file(result: FoilResult) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header and arrays of a file that holds these counts."""
    hit = result.bombardment
    foil, potential = hit.foil, hit.foil.potential
    header = {
        "format": FOIL,
        "version": VERSION,
        "written_by": visviva.__version__,
        "foil": {name: getattr(foil, name) for name in _FOIL}
        | {"potential": potential if isinstance(potential, str) else [one._to_core() for one in potential]},
        "material": {name: getattr(foil.material, name) for name in _MATERIAL},
        "ion": {"atomic_number": hit.ion.atomic_number, "mass": hit.ion.mass},
        "bombardment": {name: getattr(hit, name) for name in _BOMBARDMENT},
        "events": result.events,
        "units": result.units,
        "tallies": list(result),
        "collisions_across": result.collisions_across,
        "table_error": result.table_error,
    }
    arrays: dict[str, NDArray[Any]] = {"sums": result.sums}
    for index, tally in enumerate(result.tallies):
        arrays |= {f"{index}/edges": tally.edges, f"{index}/sums": tally.sums}
    return header, arrays


def run_from_file(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> FoilResult:
    """The result of a file, of which everything is checked.

    Raises
    ------
    Damaged
        If something is missing or not as it should be.
    visviva.InvalidInput
        For a foil, an ion or a beam that could not be.
    """
    check_version(header, VERSION)
    check_keys("header", header, _HEADER)
    check_keys("account of the foil", header["foil"], _FOIL)
    check_keys("account of the material", header["material"], _MATERIAL)
    check_keys("account of the ion", header["ion"], {"atomic_number": _NUMBER, "mass": _NUMBER})
    check_keys("account of what came to the foil", header["bombardment"], _BOMBARDMENT)
    told = dict(header["foil"])
    if isinstance(told["potential"], list):
        told["potential"] = [potential_from_core(each) for each in told["potential"]]
    if isinstance(told["stopping"], list):
        told["stopping"] = tuple(told["stopping"])
    material = Material(**{name: header["material"][name] for name in _MATERIAL})
    foil = Foil(material, **{name: told[name] for name in _FOIL})
    hit = foil._hit(Ion(**header["ion"]), **{name: header["bombardment"][name] for name in _BOMBARDMENT})
    for name in ("beam_energy", "lowest_energy", "forced_angle"):
        if (value := getattr(hit, name)) is not None:
            positive(name, value)
    return _whole(hit, header, arrays)


def _whole(hit: Bombardment, header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> FoilResult:
    """The result, of which all counts add up to its events."""
    names, events = header["tallies"], checked_events(header["events"])
    shapes: dict[str, tuple[str, tuple[str | int, ...]]] = {"sums": ("u8", (4, 3))}
    for index in range(len(names)):
        shapes[f"{index}/edges"] = ("f8", (f"edges of {index}",))
        shapes[f"{index}/sums"] = ("u8", (f"bins of {index}", 3))
    check_all(shapes, arrays, {})
    if unknown := sorted(arrays.keys() - shapes.keys()):
        raise Damaged(f"the file has arrays that this version does not know: {', '.join(unknown)}")
    if not names or len(set(names)) < len(names) or not set(names) <= _COUNTED.keys():
        raise Damaged(f"the file has tallies that this version does not know, or none: {names}")
    units = (positive("units", header["units"][0]), positive("units", header["units"][1]))
    sums, came = arrays["sums"], sum(end - first for _, first, end in events)
    if len(header["units"]) != 2 or (hit.forced_angle is None and units != (1.0, 1.0)):
        raise Damaged(f"the file has units of weights that cannot be: {header['units']}")
    if (total := sum(sums[:, 0].tolist())) != came:
        raise Damaged(f"the counts of the file are those of {total} events, not of {came}")
    tallies = []
    for index, name in enumerate(names):
        edges, each = arrays[f"{index}/edges"], arrays[f"{index}/sums"]
        if len(edges) < 2 or len(each) != len(edges) + 1 or not all(one < other for one, other in pairwise(edges)):
            raise Damaged(f"the edges and counts of {name!r} in the file do not fit")
        if not np.array_equal(each.sum(0), sums[_COUNTED[name]].sum(0)):
            raise Damaged(f"the counts of {name!r} in the file are not those of its ions")
        tallies.append(FoilTally(name, edges, each, units, came))
    across, error = (number(name, header[name]) for name in ("collisions_across", "table_error"))
    return FoilResult(hit, events, sums, units, tuple(tallies), across, error)
