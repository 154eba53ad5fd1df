"""The stiffness at rest by differences of forces, against forces whose stiffness is known: no more is told than is so.

Every K that is found is within what it is told to be off, of forces that are smooth, rounded or curved; and so far as
rounding leaves it, that is little.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from visviva.generalized._stiffness_at_rest import by_differences, is_hidden

if TYPE_CHECKING:
    from collections.abc import Callable

SIZE = np.array([1.0, 3.0])
NOTHING_KNOWN = np.zeros((2, 2)), np.full((2, 2), np.inf)
SYMMETRIC = np.array([[0.7, 0.1], [0.1, -0.3]])
ROTATING = np.array([[0.7, 0.1], [-0.1, 0.3]])


def pulls(k: np.ndarray, at: Any = (0.0, 0.0), beside: float = 0.0, cubic: float = 0.0) -> Callable[[Any], Any]:
    """−K (q − at) − c (q − at)³, rounded beside a force that cancels."""

    def forces(places: Any) -> Any:
        q = places - np.asarray(at)
        return beside - (q @ k.T + cubic * q**3) - beside

    return forces


@pytest.mark.parametrize(
    ("how", "known_to"),
    [
        # Eight roundings of places near zero, more by the place over the step of others and of what is beside; of a
        # curved force, whose difference is 1e6 h², at steps of 1e-12. Twice what they are at most.
        ({}, 3e-15),
        ({"at": (1.0, -2.0)}, 3e-14),
        ({"beside": 1.0}, 1e-14),
        ({"cubic": 1e6}, 3e-15),
        # Noise of 1e-16/h and 1e6 h² are both some 1e-9 at h = 5e-8: of six steps twice as much as they differ.
        ({"beside": 1.0, "cubic": 1e6}, 3e-8),
    ],
)
@pytest.mark.parametrize("k", [SYMMETRIC, ROTATING], ids=["potential", "rotating"])
def test_a_stiffness_is_within_what_it_is_told_to_be_off(k: np.ndarray, how: dict[str, Any], known_to: float) -> None:
    rng = np.random.default_rng(0)
    for scale in rng.uniform(0.5, 1.0, 50):
        found, off = by_differences(pulls(scale * k, **how), np.array(how.get("at", (0.0, 0.0))), SIZE, NOTHING_KNOWN)
        assert (np.abs(found - scale * k) <= off).all()
        assert off.max() < known_to
        # What has a potential is symmetric to the last bit, and what has none is not made to be.
        assert (found == found.T).all() == (k is SYMMETRIC)


def test_what_a_place_is_off_is_of_the_stiffness_too() -> None:
    """K = 1 + 3 q² is 1 in balance; 1e-3 beside it, where it is 1 + 3e-6, it may be 1, or 1 + 12e-6 as far again."""
    place = np.array([1e-3, 0.0])
    found, off = by_differences(pulls(np.eye(2), cubic=1.0), place, SIZE, NOTHING_KNOWN)
    # Forces of 1e-3 (1 + 1e-6) over K (1 + 3e-6) come to 1 − 2e-6 of the way.
    assert found[0, 0] == pytest.approx(1.0 + 3e-6, rel=1e-12, abs=0.0)
    assert off[0, 0] == pytest.approx(3e-6 + 9e-6, rel=1e-5, abs=0.0)


def test_what_is_known_better_stays_on_both_sides_of_the_diagonal() -> None:
    off = np.array([[np.inf, 1e-30], [np.inf, 1e-30]])
    found, left = by_differences(pulls(SYMMETRIC), np.zeros(2), SIZE, (SYMMETRIC + 1e-17, off))
    assert found[0, 0] == pytest.approx(SYMMETRIC[0, 0], rel=1e-14, abs=0.0)  # some roundings
    assert (found[:, 1] == (SYMMETRIC + 1e-17)[:, 1]).all()
    assert found[1, 0] == (SYMMETRIC + 1e-17)[1, 0]
    assert (left[:, 1] == 1e-30).all()
    assert left[1, 0] == np.inf


def test_differences_that_contradict_what_is_known_are_not_taken() -> None:
    known = np.eye(2), np.full((2, 2), 1e-3)
    found, off = by_differences(pulls(2.0 * np.eye(2)), np.zeros(2), SIZE, known)
    assert np.diag(found).tolist() == [1.0, 1.0]
    assert np.diag(off).tolist() == [1e-3, 1e-3]


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_where_forces_or_distances_are_none_what_is_known_stays(value: float) -> None:
    known = SYMMETRIC, np.full((2, 2), 1e-3)
    away: Callable[[Any], Any] = lambda q: np.where(q == 0.0, 0.0, value)  # noqa: E731
    assert by_differences(away, np.zeros(2), SIZE, known) is known
    # Beside 1 a step of 1e-20 is none.
    assert by_differences(pulls(np.eye(2)), np.ones(2), np.full(2, 1e-20), known) is known


@pytest.mark.parametrize("unit", [1e-8, 1.0, 1e8])
def test_rounding_hides_what_is_level_by_its_share_of_the_stiffness_in_any_unit(unit: float) -> None:
    """Ten thousand roundings of the largest K, here or some way off, with coordinates of any unit."""
    by = np.array([[1.0, unit], [unit, unit * unit]])  # of the second coordinate another unit
    mass, none = np.eye(2) * by, np.zeros((1, 2, 2))
    k = np.diag([1.0, 0.5]) * by
    for rounding, hidden in ((1e-11, True), (1e-13, False)):
        everywhere = rounding * np.ones((2, 2)) * by
        assert is_hidden(mass, (k, none), everywhere) is hidden
        assert is_hidden(mass, (k, none), everywhere * [[1.0, 0.0], [0.0, 0.0]]) is hidden
        # In balance a place may be level itself: then what is some way off tells the size.
        assert is_hidden(mass, (0.0 * k, k[None]), everywhere) is hidden
        assert is_hidden(mass, (0.0 * k, none), everywhere) is True
