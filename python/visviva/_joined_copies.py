"""Results of some of the copies of an ensemble each, as the result of all."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["joined_copies"]


def joined_copies(parts: list[dict[str, Any]], bounds: list[int], plan: dict[str, Any]) -> dict[str, Any]:
    """The result of all copies."""
    first = parts[0]
    result: dict[str, Any] = {"t": first["t"], "plan": plan, "error": None}
    result["status"] = np.concatenate([part["status"] for part in parts])
    for group in ("columns", "per_trajectory"):
        result[group] = _stacked([part[group] for part in parts])
    for table in ("events", "collisions"):
        if table in first:
            result[table] = _stacked([part[table] for part in parts])
            copies = [part[table]["member"] + start for part, start in zip(parts, bounds, strict=False)]
            result[table]["member"] = np.concatenate(copies)
    counts = ("steps", "rejected", "evaluations", "seconds")
    sums = {name: sum(part["stats"][name] for part in parts) for name in counts}
    result["stats"] = {**first["stats"], **sums}
    result |= _left(parts)
    if "dt_beyond" in first:
        result["dt_beyond"] = first["dt_beyond"]
    result["without_numbers"] = sorted(set.intersection(*(set(part["without_numbers"]) for part in parts)))
    # The worst of all; of equals the last, as the core has it.
    told = _told(parts, bounds, "energy_error")
    if told:
        result["energy_error"] = max(reversed(told), key=lambda error: error[1])
    told = _told(parts, bounds, "too_long")
    if told:
        result["too_long"] = min(told, key=lambda turn: turn[2])
    told = _told(parts, bounds, "unresolved")
    if told:
        result["unresolved"] = max(reversed(told), key=lambda step: step[2])
    return result


def _told(parts: list[dict[str, Any]], bounds: list[int], name: str) -> list[Any]:
    """What the parts have to tell, each of one copy, under the number that it has in the whole."""
    told = [(part[name], start) for part, start in zip(parts, bounds, strict=False) if name in part]
    return [(copy + start, *rest) for (copy, *rest), start in told]


def _stacked(parts: list[dict[str, Any]]) -> dict[str, Any]:
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _left(parts: list[dict[str, Any]]) -> dict[str, Any]:
    """The last states, and what was left behind for another run to go on with."""
    final = [dict(part["final"]) for part in parts]
    told = [part["continuation"] for part in parts if "continuation" in part]
    # Bodies of other symmetries may have taken another method.
    shared: Any = told[0] if told and all(each == told[0] for each in told) else None
    if shared is not None:
        shape = next(last["held"].shape[1:] for last in final if "held" in last)
        for last in final:
            # Copies none of which ended on a node left nothing, as those have that were stopped beside others.
            number = len(last["t"])
            last.setdefault("held", np.zeros((number, *shape)))
            last.setdefault("node", np.zeros(number, dtype=np.int64))
    common = [name for name in final[0] if all(name in last for last in final)]
    same = [name for name in common if len({last[name].shape[1:] for last in final}) == 1]
    kept = {name: np.concatenate([last[name] for last in final]) for name in same}
    return {"final": kept} | ({"continuation": shared} if shared is not None and "held" in kept else {})


def __dir__() -> list[str]:
    return list(__all__)
