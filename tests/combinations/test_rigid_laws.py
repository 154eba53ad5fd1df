"""Scenes in which bodies turn, drawn as those of points are, and asked what holds without a reference."""

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

sys.path.insert(0, str(Path(__file__).parent))
from drawing import FORCES
from kept_rigid import KEPT_RIGID
from recipe import Refused
from rigid_laws import RIGID_LAWS
from rigid_recipe import RigidRecipe, rigid_recipes
from running import close_workers

# Of each law: some 100 take a minute together.
EXAMPLES = max(60, (settings.default.max_examples if settings.default is not None else 0) // 5)


@pytest.fixture(scope="module", autouse=True)
def workers() -> Iterator[None]:
    yield
    close_workers()


@pytest.mark.parametrize("name", RIGID_LAWS)
@given(recipe=rigid_recipes(sorted(FORCES)))
@settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck))
def test_law(name: str, recipe: RigidRecipe) -> None:
    # A refusal by name, before anything ran, is judged by a law of its own.
    with contextlib.suppress(Refused):
        RIGID_LAWS[name](recipe)


@pytest.mark.parametrize(("name", "recipe"), KEPT_RIGID, ids=[f"{name}-{i}" for i, (name, _) in enumerate(KEPT_RIGID)])
def test_what_failed_on_the_way(name: str, recipe: RigidRecipe) -> None:
    with contextlib.suppress(Refused):
        RIGID_LAWS[name](recipe)
