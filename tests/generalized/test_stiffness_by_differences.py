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


def pulls(k: np.ndarray, at: Any = (0.0, 0.0), beside: Any = 0.0, cubic: Any = 0.0) -> Callable[[Any], Any]:
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
        # Half of what one force is rounded by is in the mean of both: more than what the other is known to.
        ({"beside": [1e3, 0.0]}, 1e-11),
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
    # The others stay there what they are: roundings, of places near zero.
    assert off[1, 1] < 3e-15
    assert off[0, 1] == off[1, 0] == 0.0


def test_one_that_is_bent_stops_no_other() -> None:
    """A force is twice as stiff beyond 1e-6, which ends its steps there; of a straight one they go on to 0.1."""

    def forces(q: Any) -> Any:
        bent = np.sign(q[:, :1]) * np.maximum(np.abs(q[:, :1]) - 1e-6, 0.0)
        return 1.0 - (q + bent * [1.0, 0.0]) - 1.0

    found, off = by_differences(forces, np.zeros(2), SIZE, NOTHING_KNOWN)
    assert (np.abs(found - np.eye(2)) <= off).all()
    # Noise of 1e-16/h: at 1e-6 and at 0.1, a few times that.
    assert 1e-11 < off[0, 0] < 1e-8
    assert off[1, 1] < 1e-14


def test_what_is_exact_is_known_to_roundings_of_the_places_at_which_it_was_found() -> None:
    """Eight of K = 1, and of its place as a part of the farthest difference, 2 · 2⁻⁴ of its size: here none is seen."""
    _, off = by_differences(pulls(np.eye(2), at=(1.0, -2.0)), np.array([1.0, -2.0]), np.ones(2), NOTHING_KNOWN)
    epsilon = np.finfo(float).eps
    # Of steps that are exact to a few roundings.
    known_to = [8.0 * epsilon * (1.0 + place / 0.125) for place in (1.0, 2.0)]
    assert np.diag(off) == pytest.approx(known_to, rel=1e-12, abs=0.0)


def test_a_place_whose_next_to_it_has_no_forces_tells_nothing() -> None:
    """Off its balance at 0 by 1e-3, no wall within a step of it, but one within as much again."""
    known = np.eye(2), np.full((2, 2), 1e-3)
    for side in (1.0, -1.0):
        place = np.array([side * 1e-3, 0.0])
        wall: Callable[[Any], Any] = lambda q, side=side: np.where(side * q > 1.5e-3, np.nan, -q)  # noqa: E731
        assert by_differences(wall, place, np.full(2, 1e-3), known) is known
        away = by_differences(pulls(np.eye(2)), place, np.full(2, 1e-3), known)
        assert away[1].max() < 1e-3


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


def test_what_has_no_mass_is_measured_in_its_own_unit_and_what_has_by_its_root() -> None:
    """K of 1 and 0.05; 2.2e-12 of the largest is the bound. A mass of 1/16 makes 16 times as much of the second."""
    none, k, one = np.zeros((1, 2, 2)), np.diag([1.0, 0.05]), np.diag([0.0, 1.0])
    for mass, least in ((0.0, 2.2e-12), (1.0 / 16.0, 1.4e-13)):
        for rounding, hidden in ((0.8 * least, False), (1.25 * least, True)):
            assert is_hidden(np.diag([1.0, mass]), (k, none), rounding * one) is hidden
