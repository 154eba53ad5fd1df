"""Files of counts: what `MonteCarlo.save` writes and `visviva.load` reads.

A file holds ``header`` and arrays. The header has the beam, the events and what each tally is; arrays are those of the
tallies, by their numbers: ``0/edges``, ``0/counts`` and ``0/reachable``, of two quantities ``0/edges0``, ``0/edges1``
and ``0/flow``, and with `importance` ``0/by_stratum``. Versions load what earlier ones wrote.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._stored import COUNTS, check_all, check_version
from visviva.potentials import potential_from_core
from visviva.scattering._beam import Beam, Spectrum, Spread
from visviva.scattering._channels import Channel
from visviva.scattering._importance import Strata
from visviva.scattering._joint_tally import JointTally
from visviva.scattering._of_events import checked_events
from visviva.scattering._tally import Tally

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.scattering._result import MonteCarlo
    from visviva.typing import TallyName

__all__ = ["counts_for_file", "run_from_file"]

# Version 2 knows beams that differ in energy, direction and place, version 3 strata, version 4 channels, version 5
# their excitation functions.
_VERSION = 5


def counts_for_file(
    beam: Beam, events: tuple[tuple[int, int, int], ...], tallies: tuple[Tally | JointTally, ...]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header and arrays of a file that holds these counts."""
    energy = beam.beam_energy
    lines = energy if isinstance(energy, Spectrum) else None
    header = {
        "format": COUNTS,
        "version": _VERSION,
        "potential": beam.potential._to_core(),
        "beam_energy": None if lines else energy,
        "spectrum": [lines.energy, lines.weight] if lines else None,
        "masses": beam.masses,
        "b_max": beam.b_max,
        "energy_spread": beam.energy_spread and [beam.energy_spread.shape, beam.energy_spread.width],
        "divergence": beam.divergence and [beam.divergence.shape, beam.divergence.width],
        "spot": beam.spot,
        "importance": beam.importance and [beam.importance.edges, beam.importance.fractions],
        "channels": [
            [channel.q_value, channel.probability, channel.products, channel.excitation_function]
            for channel in beam.channels
        ],
        "smallest_angle": beam.smallest_angle,
        "tables": beam.tables,
        "events": events,
        "tallies": [_told(tally) for tally in tallies],
    }
    arrays: dict[str, Any] = {}
    for index, tally in enumerate(tallies):
        if isinstance(tally, Tally):
            arrays |= {f"{index}/{name}": getattr(tally, name) for name in ("edges", "counts", "reachable")}
        else:
            arrays[f"{index}/flow"] = tally.flow
            arrays |= {f"{index}/edges{axis}": edges for axis, edges in enumerate(tally.edges)}
        if tally.by_stratum is not None:
            arrays[f"{index}/by_stratum"] = tally.by_stratum
    return header, arrays


def _told(tally: Tally | JointTally) -> dict[str, Any]:
    if isinstance(tally, JointTally):
        return {"name": tally.name, "captured": tally.captured}
    return {name: getattr(tally, name) for name in ("name", "underflow", "overflow", "covered", "captured")}


def _arrays(tallies: list[dict[str, Any]], stratified: bool) -> dict[str, tuple[str, tuple[str | int, ...]]]:
    """Which arrays such a file has, with their types and axes."""
    shapes: dict[str, tuple[str, tuple[str | int, ...]]] = {}
    for index, told in enumerate(tallies):
        one = isinstance(told["name"], str)
        own = {"edges": "edges", "counts": "bins", "reachable": "bins"} if one else {"edges0": "0", "edges1": "1"}
        for name, axis in own.items():
            shapes[f"{index}/{name}"] = ("u8" if name == "counts" else "f8", (f"{axis} of {index}",))
        if not one:
            shapes[f"{index}/flow"] = ("u8", (f"rows of {index}", f"columns of {index}"))
        if stratified:
            shapes[f"{index}/by_stratum"] = ("u8", ("strata", f"slots of {index}"))
    return shapes


def _spread(told: list[Any] | None) -> Spread | None:
    if told is None:
        return None
    return {"gaussian": Spread.gaussian, "uniform": Spread.uniform}[told[0]](told[1])


def run_from_file(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> MonteCarlo:
    """The result of such a file; counts that do not add up to its events are refused.

    Raises
    ------
    Exception
        Of whatever kind, if something is missing or does not fit: `visviva.load` puts it in words.
    """
    from visviva.scattering._result import MonteCarlo

    check_version(header, _VERSION)
    lines, strata = header["spectrum"], header.get("importance")
    beam = Beam(
        potential_from_core(header["potential"]),
        header["beam_energy"] if lines is None else Spectrum(*lines),
        (header["masses"][0], header["masses"][1]),
        header["b_max"],
        header["smallest_angle"],
        tuple(header["tables"]),
        _spread(header.get("energy_spread")),
        _spread(header.get("divergence")),
        header.get("spot"),
        None if strata is None else Strata(*strata),
        tuple(Channel(*told) for told in header.get("channels", [])),
    )
    events = checked_events(header["events"])
    tallies: list[Tally | JointTally] = []
    tally: Tally | JointTally
    check_all(_arrays(header["tallies"], strata is not None), arrays, {})
    for index, told in enumerate(header["tallies"]):
        by_stratum = None if strata is None else arrays[f"{index}/by_stratum"]
        if isinstance(told["name"], str):
            edges, counts, reachable = (arrays[f"{index}/{name}"] for name in ("edges", "counts", "reachable"))
            covered = (told["covered"][0], told["covered"][1])
            flows = (told["underflow"], told["overflow"])
            captured = told["captured"]
            tally = Tally(
                cast("TallyName", told["name"]),
                edges,
                counts,
                *flows,
                reachable,
                covered,
                beam,
                events,
                captured,
                by_stratum,
            )
            slots = np.concatenate([[flows[0]], counts, [flows[1], captured]])
            if len(edges) != len(counts) + 1:
                raise ValueError("its edges and counts do not fit")
        else:
            several = tuple(arrays[f"{index}/edges{axis}"] for axis in range(len(told["name"])))
            flow = arrays[f"{index}/flow"]
            tally = JointTally(tuple(told["name"]), several, flow, told["captured"], beam, events, by_stratum)
            slots = np.append(flow, told["captured"])
            if flow.shape != tuple(len(edges) + 1 for edges in several):
                raise ValueError("its edges and counts do not fit")
        if by_stratum is not None and (by_stratum.sum(0) != slots).any():
            raise ValueError("its counts and those of its strata do not fit")
        if (total := sum(slots.tolist())) != tally.n_events:
            raise ValueError(f"its counts are those of {total} events, not of {tally.n_events}")
        tallies.append(tally)
    return MonteCarlo(beam, events, tuple(tallies))
