"""Which law is asked of which force and which method: what is registered and asked by none fails here, by name.

The table is made of the registries. What a law cannot ask of a force is left out by what the force declares, with the
reason in physics; never by its name.
"""

import contextlib
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from drawing import FORCES, METHODS, force
from recipe import Recipe, Refused
from running import close_workers
from stated_laws import LAWS
from work_laws import FAMILIES, closed_form_case

from visviva.invariants import kept_by_forces


def refusal(law: str, recipe: Recipe) -> str:
    """Why a law had nothing to judge, or nothing. That it holds is asked elsewhere (`test_laws`)."""
    try:
        LAWS[law](recipe)
    except Refused as refused:
        return str(refused) or "refused"
    except AssertionError:
        pass
    return ""


SEEDS = range(12)


def declares(name: str, what: str, *, acting: bool = False) -> bool:
    """Whether one of those forces leaves that constant, of bodies that all have mass. A damper may damp nothing: those
    that do nothing count, or not."""
    bodies = vv.Particles(np.ones(4), np.random.default_rng(1).normal(size=(4, 3)), np.eye(4)[:, :3])
    scenes = [vv.Scene(bodies, force(name, seed, 4, tame=True)) for seed in SEEDS]
    if acting:
        scenes = [scene for scene in scenes if accelerates(scene) and scene.acceleration().any()]
    return any(kept_by_forces(scene, np.zeros(3))[what] for scene in scenes)


def takes_massless(name: str) -> bool:
    """Whether one of those forces acts on bodies the last of which has no mass, and on the others without it."""
    bodies = Recipe(bodies=4, massless=1, forces=()).case().members()[0].particles
    fewer = vv.Particles(bodies.mass[:3], bodies.position[:3], bodies.velocity[:3])
    drawn = [force(name, seed, 4, tame=True) for seed in SEEDS]
    return any(accelerates(vv.Scene(bodies, one)) and accelerates(vv.Scene(fewer, one)) for one in drawn)


def transforms(name: str) -> bool:
    """Whether the plan of one of those forces takes a time transformation."""
    bodies = Recipe(bodies=4, forces=()).case().members()[0].particles
    for seed in SEEDS:
        with contextlib.suppress(vv.InvalidInput):
            scene = vv.Scene(bodies, force(name, seed, 4, tame=True))
            scene.plan(t=1.0, method="leapfrog", dt=0.125, time_transformation="distance")
            return True
    return False


def accelerates(scene: vv.Scene) -> bool:
    with contextlib.suppress(vv.InvalidInput):
        return bool(np.isfinite(scene.acceleration()).all())
    return False


# Of each law: what a force must declare to be asked, and why the others are not.
SPARED: dict[str, tuple[Callable[[str], bool], str]] = {
    "action_is_reaction": (
        lambda name: declares(name, "momentum", acting=True),
        "what moves each body for itself has its reaction outside of the scene",
    ),
    "forces_follow_from_the_energy": (
        lambda name: declares(name, "energy"),
        "what takes or brings energy is the gradient of none",
    ),
    "work_along_a_path_is_the_potential_energy_lost": (
        lambda name: declares(name, "energy"),
        "what takes or brings energy is the gradient of none",
    ),
    "what_is_reversed_retraces_its_path": (
        lambda name: not FORCES[name]._one_way,
        "drag and drives tell the future from the past",
    ),
    "backward_in_time_is_forward_reversed": (
        lambda name: not FORCES[name]._one_way,
        "drag and drives tell the future from the past",
    ),
    "steps_in_another_time_lead_to_the_same_motion": (
        transforms,
        "there is no distance that another time could go by, or a velocity is looked at between kicks and drifts",
    ),
    "massless_bodies_do_not_touch_the_massive": (
        takes_massless,
        "what acts by its force, and not by an acceleration, moves nothing without mass",
    ),
}


@pytest.fixture(scope="module", autouse=True)
def workers() -> Any:
    yield
    close_workers()


@pytest.mark.parametrize("name", FORCES)
def test_every_force_is_asked_by_every_law_that_its_physics_allows(name: str) -> None:
    unasked = {}
    for law in LAWS:
        reasons = set()
        massless = 1 if law.startswith("massless") else 0
        for seed in SEEDS:
            method = ("dop853", "rk4", "leapfrog", "boris")[seed % 4]
            recipe = Recipe(method=method, bodies=4, massless=massless, forces=((name, seed),), seed=seed, steps=4)
            reason = refusal(law, replace(recipe, terminal=1) if "stopped" in law else recipe)
            if not reason:
                break
            reasons.add(reason)
        else:
            unasked[law] = reasons
    spared = {law for law, (asked, _) in SPARED.items() if not asked(name)}
    assert unasked.keys() == spared, {law: unasked.get(law) for law in unasked.keys() ^ spared}


@pytest.mark.parametrize("name", METHODS)
def test_every_method_is_asked_by_every_law(name: str) -> None:
    adaptive = METHODS[name].adaptive
    # Fixed steps have no longest step, others no node to stop at.
    spared = {"a_run_goes_on_with_the_bits_of_the_whole"} if adaptive else {"no_step_is_longer_than_max_step"}
    found = {}
    for law in LAWS:
        recipe = Recipe(method=name, bodies=4, massless=1, seed=5)
        # The end of a run that stops must be on the way: some of these are.
        tries = [replace(recipe, seed=seed, massless=0, steps=4) for seed in range(12)] if "stopped" in law else []
        found[law] = any(not refusal(law, each) for each in (recipe, *tries))
    assert {law for law, judged in found.items() if not judged} == spared


@pytest.mark.parametrize("name", FORCES)
def test_every_force_is_judged_with_every_method_that_takes_it(name: str) -> None:
    """And is refused by the others for its velocities alone, which a step of kicks and drifts has not at that time."""
    bodies = Recipe(bodies=3, forces=()).case().members()[0].particles
    resting = vv.Particles(bodies.mass, bodies.position)
    drawn = [force(name, seed, 3, tame=True) for seed in SEEDS]
    pushed = 0.0
    for one in drawn:
        moving, still = vv.Scene(bodies, one), vv.Scene(resting, one)
        if accelerates(moving):
            pushed = max(pushed, float(np.abs(moving.acceleration() - still.acceleration()).max()))
    for method in METHODS:
        reasons = set()
        for seed in SEEDS:
            recipe = Recipe(method=method, bodies=3, forces=((name, seed),), seed=seed)
            # Where a derivative jumps no fixed step has its order, but it has its frames.
            reasons |= {refusal(law, recipe) for law in ("two_methods_agree", "a_scene_moves_alike_in_another_frame")}
            if "" in reasons:
                break
        else:
            # Taylor series are of forces that have one.
            assert pushed > 0.0 or method == "taylor", f"{method} refuses {name}, which sees no velocity: {reasons}"
            assert "refused method" in reasons


def test_every_closed_form_is_met() -> None:
    folder = Path(__file__).parents[2] / "rust" / "core" / "src" / "closed_forms"
    sources = [source.read_text() for source in folder.glob("*.rs")]
    registered = {name for text in sources for name in re.findall(r'^    name: "(.+)",$', text, re.M)}
    met = set()
    for seed in range(4 * len(FAMILIES)):
        case = closed_form_case(Recipe(seed=seed))
        met.add(str(case.start.plan(t=case.t[-1]).solution).removeprefix("closed form: "))
    assert met - {"integration"} == registered


def test_every_reason_spares_some_force_and_not_all() -> None:
    """What spares none need not be there, what spares all leaves a law that asks nothing."""
    for law, (asked, reason) in SPARED.items():
        assert {asked(name) for name in FORCES} == {True, False}, (law, reason)
