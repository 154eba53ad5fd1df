"""Features where they meet: laws without a reference, over scenes drawn from everything that is registered.

The short profile, a few thousand scenes. The long one: ``python -m tests.combinations.search --scenes 100000``, or
``pytest tests/combinations --hypothesis-profile=search``. What failed on the way is kept in ``kept.py``.
"""

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

sys.path.insert(0, str(Path(__file__).parent))
from drawing import EVENTS, FORCES, POTENTIALS, force
from kept import KEPT
from recipe import Recipe, Refused, recipes
from running import close_workers, execute
from stated_laws import LAWS

# Of each law; the search profile asks for more. 300 of each take about a minute and a half of one core.
EXAMPLES = max(300, settings.default.max_examples if settings.default is not None else 0)


@pytest.fixture(scope="module", autouse=True)
def workers() -> Iterator[None]:
    yield
    close_workers()


def judged(name: str, recipe: Recipe) -> None:
    # A refusal by name, before anything ran, is judged by a law of its own.
    with contextlib.suppress(Refused):
        LAWS[name](recipe)


@pytest.mark.parametrize("name", LAWS)
@given(recipe=recipes())
@settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck))
def test_law(name: str, recipe: Recipe) -> None:
    judged(name, recipe)


@pytest.mark.parametrize(("name", "recipe"), KEPT, ids=[f"{name}-{i}" for i, (name, _) in enumerate(KEPT)])
def test_what_failed_on_the_way(name: str, recipe: Recipe) -> None:
    judged(name, recipe)


@pytest.mark.parametrize("tame", [True, False])
@pytest.mark.parametrize("name", FORCES)
def test_every_registered_force_is_drawn(name: str, tame: bool) -> None:
    """A force whose parameters are of a kind that cannot be drawn fails here, by name."""
    drawn = [force(name, seed, 9, tame=tame) for seed in range(20)]
    assert len(set(map(repr, drawn))) > 10
    assert {type(one).__name__ for one in drawn} == {name}


def test_every_registered_potential_is_drawn() -> None:
    drawn = [force(name, seed, 9, tame=True) for name in FORCES for seed in range(40 * len(POTENTIALS))]
    used = {type(one.potential).__name__ for one in drawn if hasattr(one, "potential")}
    assert used == set(POTENTIALS)


def test_every_event_is_drawn_and_found() -> None:
    found = dict.fromkeys(EVENTS, 0)
    for seed in range(60):
        forces = (("Gravity", seed), ("LinearDrag", seed))  # which takes energy
        events = tuple((name, seed) for name in EVENTS)
        case = Recipe(bodies=3, forces=forces, seed=seed, events=events, steps=4).case()
        result, _ = execute(case.start, case.t, case.how)
        for name, event in zip(EVENTS, case.how["events"], strict=True):
            assert event.kind == name
            found[name] += len(result.events.of(EVENTS.index(name)))
    assert all(found.values()), found
