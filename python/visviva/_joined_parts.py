"""The parts of one run, one after the other, as the run in one piece."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["joined_result"]


def joined_result(parts: list[dict[str, Any]], asked: list[int]) -> dict[str, Any]:
    """The result of the whole, of so many output times of each part; the last state is that of the last part."""
    first, last = parts[0], parts[-1]
    rows = [slice(0, number) for number in asked[: len(parts)]]
    result: dict[str, Any] = {"status": last["status"], "final": dict(last["final"])}
    result["t"] = np.concatenate([part["t"][kept] for part, kept in zip(parts, rows, strict=True)])
    result["columns"] = {
        name: np.concatenate([part["columns"][name][:, kept] for part, kept in zip(parts, rows, strict=True)], axis=1)
        for name in first["columns"]
    }
    for table in ("events", "collisions"):
        if table in first:
            result[table] = {name: np.concatenate([part[table][name] for part in parts]) for name in first[table]}
    counts = first["per_trajectory"]
    result["per_trajectory"] = {name: sum(part["per_trajectory"][name] for part in parts) for name in counts}
    sums = {name: sum(part["stats"][name] for part in parts) for name in (*counts, "seconds") if name in last["stats"]}
    result["stats"] = {**last["stats"], **sums}
    # What another run goes on with is told from where the first part began: if all went on with the one before.
    chain = all(part.get("continuation", {}).get("goes_on") for part in parts[1:])
    if chain and "continuation" in last:
        goes_on = first.get("continuation", last["continuation"])["goes_on"]
        result["continuation"] = {**last["continuation"], "goes_on": goes_on}
    else:
        for name in ("held", "node", "begun_position", "begun_velocity"):
            result["final"].pop(name, None)
    for name in ("energy_error", "dt_beyond", "too_long", "unresolved"):
        values = [part[name] for part in parts if name in part]
        if values:
            result[name] = values[-1]
    return result
