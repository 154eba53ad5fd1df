"""Parts of an ensemble put together are the whole: every number and every line of a table under its own copy."""

from typing import Any

import numpy as np
import pytest

from visviva._joined_copies import joined_copies


def part(copies: int, **more: Any) -> dict[str, Any]:
    final = {"t": np.full(copies, 2.0), "position": np.full((copies, 2, 3), 1.0 + copies)} | more.pop("final", {})
    return {
        "t": np.array([2.0]),
        "status": np.zeros(copies, np.int8),
        "columns": {},
        "per_trajectory": {},
        "stats": {"steps": copies, "rejected": 0, "evaluations": 4 * copies, "seconds": 0.5},
        "final": final,
        "without_numbers": more.pop("without_numbers", []),
        **more,
    }


def joined(*parts: dict[str, Any]) -> dict[str, Any]:
    bounds = np.cumsum([0, *(len(each["status"]) for each in parts)]).tolist()
    return joined_copies(list(parts), bounds, {"plan": "of all"})


def held(copies: int, *shape: int, node: int = 7) -> dict[str, Any]:
    return {"held": np.full((copies, *shape), 5.0), "node": np.full(copies, node)}


RK4, LEAPFROG = {"method": "rk4", "dt": 0.1}, {"method": "leapfrog", "dt": 0.1}


def test_copies_that_left_nothing_are_held_by_nothing_beside_others() -> None:
    """Those of a part that was stopped between two nodes: zeros of the shape that the others have, and node 0."""
    found = joined(
        part(2, final=held(2, 3, 4), continuation=RK4), part(1), part(1, final=held(1, 3, 4), continuation=RK4)
    )
    assert found["continuation"] == RK4
    assert found["final"]["held"].shape == (4, 3, 4)
    assert found["final"]["held"].max(axis=(1, 2)).tolist() == [5.0, 5.0, 0.0, 5.0]
    assert found["final"]["node"].tolist() == [7, 7, 0, 7]
    assert found["final"]["node"].dtype == np.int64
    assert found["final"]["position"][:, 0, 0].tolist() == [3.0, 3.0, 2.0, 2.0]


@pytest.mark.parametrize(
    "parts",
    [
        # Another method goes on in another way.
        (part(2, final=held(2, 3), continuation=RK4), part(1, final=held(1, 3), continuation=LEAPFROG)),
        # What is held of bodies has other shapes.
        (part(2, final=held(2, 3), continuation=RK4), part(1, final=held(1, 4), continuation=RK4)),
        # None left anything.
        (part(2), part(1)),
    ],
)
def test_parts_that_cannot_go_on_as_one_leave_nothing(parts: tuple[dict[str, Any], ...]) -> None:
    found = joined(*parts)
    assert "continuation" not in found
    assert found["final"]["t"].tolist() == [2.0, 2.0, 2.0]


def test_parts_stay_what_they_were() -> None:
    stopped = part(1)
    joined(part(1, final=held(1, 3), continuation=RK4), stopped)
    assert sorted(stopped["final"]) == ["position", "t"]


def test_what_only_some_parts_tell_of_their_ends_is_left_out() -> None:
    found = joined(part(2, final={"begun_position": np.zeros((2, 2, 3))}), part(1))
    assert sorted(found["final"]) == ["position", "t"]


def test_the_worst_is_told_and_of_equals_the_one_that_the_core_would_tell() -> None:
    """Of errors and doubts the last of the largest, of turns the first of the shortest: under numbers of the whole."""
    parts = [
        part(2, energy_error=(1, 0.5, 0.1, 4), too_long=(0, 9.0, 1.5), unresolved=(1, 0.1, 0.25)),
        part(3, energy_error=(2, 0.5, 0.2, 4), too_long=(1, 8.0, 1.5), unresolved=(0, 0.1, 0.5)),
        part(1, energy_error=(0, 0.25, 0.3, 4), too_long=(0, 7.0, 2.5), unresolved=(0, 0.1, 0.5)),
    ]
    found = joined(*parts)
    assert found["energy_error"] == (4, 0.5, 0.2, 4)
    assert found["too_long"] == (0, 9.0, 1.5)
    assert found["unresolved"] == (5, 0.1, 0.5)
    assert {"energy_error", "too_long", "unresolved"}.isdisjoint(joined(part(1), part(2)))


def test_functions_are_without_numbers_if_they_are_so_in_every_part() -> None:
    assert joined(part(1, without_numbers=[0, 2]), part(1, without_numbers=[2, 0]))["without_numbers"] == [0, 2]
    assert joined(part(1, without_numbers=[0, 2]), part(1, without_numbers=[1, 2]))["without_numbers"] == [2]


def test_counts_are_those_of_all() -> None:
    assert joined(part(2), part(3))["stats"] == {"steps": 5, "rejected": 0, "evaluations": 20, "seconds": 1.0}
