"""Laws of bits and of what is said: they hold for every scene, method and request, and need no reference."""

from __future__ import annotations

import pickle
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from law_book import law
from recipe import Case, Recipe, Refused
from running import TIERS, Bits, collisions, differences, ends_in_a_closed_form, events, execute, outcome, worker

import visviva as vv


def _ran(case: Case) -> Bits:
    found = outcome(case.start, case.t, case.how)
    if str(found["ended"]).startswith("refused"):
        raise Refused(found["ended"])
    return found


def _gone(found: Bits) -> bool:
    """Whether a run of a scene ended where its numbers ceased to be."""
    return found.get("status", b"")[-1:] in {bytes([vv.Status.STEP_FAILURE]), bytes([vv.Status.OUTSIDE_DOMAIN])}


def _same(first: Bits, second: Bits, what: str, *, of: tuple[str, ...] | None = None) -> None:
    different = differences(first, second, of=of)
    if different:
        notes = [f"{n}: {first.get(n)!r} against {second.get(n)!r}" for n in different if n in ("ended", "steps")]
        raise AssertionError(f"{what}: other {', '.join(different)} {'; '.join(notes)}")


@law
def refusals_are_made_by_the_plan_and_by_the_run(recipe: Recipe) -> None:
    """`plan` refuses what `run` refuses, naming the same argument; a method named in the refusal works."""
    case = recipe.case()
    _, ended = execute(case.start, case.t, case.how)
    try:
        case.start.plan(t=list(case.t), **case.how)
        planned = ""
    except vv.InvalidInput as error:
        planned = f"refused {error.argument}"
    assert planned == (ended if ended.startswith("refused") else ""), f"plan: {planned!r}, run: {ended!r}"


@law
def the_plan_says_what_ran(recipe: Recipe) -> None:
    case = recipe.case()
    result, ended = execute(case.start, case.t, case.how)
    if result is None:
        raise Refused(ended)
    plan, stats = case.start.plan(t=list(case.t), **case.how), result.stats
    assert plan.method == result.plan.method == stats.method, (plan.method, result.plan.method, stats.method)
    assert plan.solution == result.plan.solution
    count = len(case.members()[0].particles)
    assert plan.particles == plan.active + plan.passive == count
    if recipe.method != "auto":
        assert plan.method == recipe.method
        assert not plan.closed_form
    if plan.closed_form:
        assert (stats.steps, stats.rejected, stats.evaluations) == (0, 0, 0), stats
    elif not ended and not (recipe.members and (result.status != 0).any()):
        # An end before the first node takes no step: the state there comes from a shadow of one.
        assert stats.evaluations > 0, stats
        # The cost told is the cost of a step: what starts a run and reads it between steps comes on top.
        assert stats.evaluations >= plan.evaluations_per_step * stats.steps, stats
    assert set(result.recorded) == set(recipe.columns)


def _beyond_numbers(recipe: Recipe, place: int, name: str) -> bool:
    """Whether a column is told of states so large that it is beyond `float64`, though they are not."""
    if name in ("position", "velocity"):
        return False
    case = replace(recipe, columns=("position", "velocity")).case()
    result, _ = execute(case.start, case.t, case.how)
    one, scene = (result if case.alone else result[place]), case.members()[place]
    mass, x, v = (np.longdouble(values) for values in (scene.particles.mass[:, None], one.position, one.velocity))
    terms = {
        "energy": (mass * v * v,),
        "momentum": (mass * v,),
        "angular_momentum": (mass * np.abs(x).max() * v,),
        "center_of_mass": (mass * x,),
    }
    return any(np.abs(term).max(initial=0.0) > 2.0**1023 / len(mass) for term in terms[name])


@law
def what_is_ok_is_finite(recipe: Recipe) -> None:
    """A status of OK means numbers; a failed member is NaN from where it failed, and only there."""
    case = recipe.case()
    result, ended = execute(case.start, case.t, case.how)
    if result is None:
        raise Refused(ended)
    status = np.atleast_1d(np.asarray(result.status))
    for name in result.recorded:
        column = getattr(result, name)
        rows = column[None] if case.alone else column
        for place, (member, values) in enumerate(zip(status, rows, strict=True)):
            if member == 0 and not np.isfinite(values).all():
                assert _beyond_numbers(recipe, place, name), f"status OK, but {name} is not finite"
    if not ended and case.alone:
        assert np.isfinite(result.final.particles.position).all()
        assert len(result.t) == len(case.t) or result.status == vv.Status.STOPPED


@law
def a_member_is_as_if_alone(recipe: Recipe) -> None:
    if not recipe.members:
        recipe = replace(recipe, members=3)
    case = recipe.case()
    _ran(case)
    result, _ = execute(case.start, case.t, case.how)
    scenes = case.members()
    # The first, the last, and those about them: places in lanes and in the last group.
    chosen = sorted({0, 1, len(scenes) // 2, len(scenes) - 2, len(scenes) - 1} & set(range(len(scenes))))
    for index in chosen:
        alone, _ = execute(scenes[index], case.t, case.how)
        if alone is None:
            raise AssertionError(f"member {index} runs in an ensemble, alone it is refused")
        assert result.status[index] == alone.status, (
            f"member {index} of {len(scenes)}: {result.status[index]}, {alone.status!r}"
        )
        for name in alone.recorded:
            rows = len(alone.t)
            mine, own = getattr(result, name)[index], getattr(alone, name)
            same = mine[:rows].tobytes() == np.ascontiguousarray(own).tobytes()
            assert same, f"member {index} of {len(scenes)}: other {name} than alone"
            assert np.isnan(mine[rows:]).all()
        cost = {name: int(values[index]) for name, values in result.per_trajectory.items()}
        other = differences(events(result[index], case.how), events(alone, case.how))
        other += differences(collisions(result[index], case.how), collisions(alone, case.how))
        assert not other, f"member {index} of {len(scenes)}: other {', '.join(other)} than alone"
        own_cost = {name: getattr(alone.stats, name) for name in cost if hasattr(alone.stats, name)}
        assert own_cost == {name: cost[name] for name in own_cost}, f"member {index}: {cost}, alone {own_cost}"


@law
def threads_change_no_bit(recipe: Recipe) -> None:
    case = recipe.case()
    one = _ran(replace(case, how={**case.how, "threads": 1}))
    for threads in (2, 3):
        _same(one, outcome(case.start, case.t, {**case.how, "threads": threads}), f"1 against {threads} threads")


@law
def tiers_change_no_bit(recipe: Recipe) -> None:
    case = recipe.case()
    here = _ran(case)
    for tier in TIERS:
        _same(here, worker(tier).outcome(case.start, case.t, case.how), f"tier {tier}")


@law
def recorded_columns_change_no_bit(recipe: Recipe) -> None:
    case = recipe.case()
    some = _ran(case)
    every = outcome(case.start, case.t, {**case.how, "record": recipe.every_column})
    # Where numbers cease to be, the last state is that of a row that has all of it.
    of = (name for name in some if not (_gone(some) and name.startswith("final")))
    _same(some, every, "with every column", of=tuple(of))


@law
def other_outputs_change_no_bit(recipe: Recipe) -> None:
    """The end, and each time that is read, whatever else is read."""
    case = recipe.case()
    full = _ran(case)
    # An output between nodes may leave the distances at which a force is known where no step does: it has no row.
    if recipe.ragged and vv.Status.OUTSIDE_DOMAIN in full.get("status", b""):
        return
    end = outcome(case.start, case.t[-1:], case.how)
    # Where numbers cease to be, the last state is that of the last output that has some.
    kept = ("events", "collisions") if _gone(full) else ("final", "events", "collisions")
    of = ("ended", "status", *(name for name in full if name.startswith(kept)))
    _same(full, end, "the end alone", of=tuple(name for name in of if name in full))
    result, ended = execute(case.start, case.t, case.how)
    if ended or np.any(result.status):
        return
    for every in (2, 3):
        times = sorted({*case.t[::every], case.t[-1]}, reverse=recipe.backward)
        few, _ = execute(case.start, tuple(times), case.how)
        where = [case.t.index(time) for time in times]
        for name in few.recorded:
            all_rows, few_rows = getattr(result, name), getattr(few, name)
            rows = all_rows[where] if case.alone else all_rows[:, where]
            assert rows.tobytes() == few_rows.tobytes(), f"other {name} when every {every}. output is read"


@law
def saved_and_loaded_nothing_changes(recipe: Recipe) -> None:
    """What is loaded is what was saved, and runs on to the same bits."""
    case = recipe.case()
    result, ended = execute(case.start, case.t, case.how)
    if result is None or not len(np.atleast_1d(result.t)):
        raise Refused(ended)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.npz"
        result.save(path)
        loaded = vv.load(path)
    for name in result.recorded:
        assert getattr(loaded, name).tobytes() == getattr(result, name).tobytes(), f"{name} is not what was saved"
    assert not differences(events(loaded, case.how), events(result, case.how)), "events are not what was saved"
    assert not differences(collisions(loaded, case.how), collisions(result, case.how)), "other collisions"
    if case.how.get("events"):
        definitions = loaded.events.definitions
        assert definitions == result.events.definitions
        # Of an expression a result has what was made of it.
        pairs = zip(definitions, case.how["events"], strict=True)
        assert all(kept == given for kept, given in pairs if given.kind != "expression")
    assert str(loaded.plan) == str(result.plan)
    assert loaded.stats == result.stats
    if ended or np.any(result.status):
        return
    on = tuple(2.0 * t - case.members()[0].t0 for t in case.t[-1:])
    if not np.isfinite(on).all():
        return
    _same(outcome(result.final, on, case.how), outcome(loaded.final, on, case.how), "run on after loading")


def _legs(start: Any, t: tuple[float, ...], cuts: list[float], how: dict[str, Any], member: int | None) -> list[Any]:
    """The run in legs that end at the cuts, the last at the end; a failure ends them."""
    legs: list[Any] = []
    sign = -1.0 if t[0] > t[-1] else 1.0
    for index, cut in enumerate([*cuts, t[-1]]):
        before = cuts[index - 1] if index else None
        # Every other leg reads its own beginning, too.
        times = [
            time
            for time in t
            if (time - cut) * sign <= 0.0
            and (before is None or (time - before) * sign > 0.0 or (index % 2 == 0 and time == before))
        ]
        if not times:
            continue
        result, ended = execute(start, tuple(times), {**how, "threads": 1 + index % 2})
        if member is not None and isinstance(start, vv.EnsembleScene):
            result = result[member]
            ended = ended or ("" if result.status == 0 else result.status.name)
        legs.append(result)
        if ended:
            break
        start = result.final
        if index % 2:
            start = pickle.loads(pickle.dumps(start))
    return legs


@law
def a_run_goes_on_with_the_bits_of_the_whole(recipe: Recipe) -> None:
    """From a node, with the same method and step: in any number of legs, an ensemble or a member of one alone.

    Without events that end the run: each leg counts its zeros anew.
    """
    # The steps after a collision begin there: the nodes are others.
    case = replace(recipe, terminal=0, collisions="").case()
    step = case.how.get("dt")
    if step is None or "time_transformation" in case.how:
        raise Refused("no fixed step")
    scene, sign = case.members()[0], -1.0 if recipe.backward else 1.0
    rng = np.random.default_rng(recipe.seed + 3)
    # The end of a ragged recipe is no node.
    nodes = sorted({int(node) for node in rng.integers(1, recipe.steps + 1, 1 + recipe.seed % 3)})
    ends = (scene.t0 + sign * step * node for node in nodes)
    cuts = [end for end in ends if abs(end - scene.t0) <= abs(case.t[-1] - scene.t0)]
    if not cuts:
        raise Refused("no node before the end")
    t = tuple(sorted({*case.t, *cuts}, reverse=recipe.backward))
    whole, ended = execute(case.start, t, case.how)
    if whole is None:
        raise Refused(ended)
    failed = not case.alone and bool(whole.status.any())
    members: list[int | None] = [None]
    if not case.alone:
        count = len(whole)
        members = [*sorted({0, count // 2, count - 1}), *([] if failed else [None])]
    for member in members:
        one = whole if member is None else whole[member]
        legs = _legs(case.start, t, cuts, case.how, member)
        for name in whole.recorded:
            axis = 1 if member is None and not case.alone else 0
            read = np.concatenate([leg.t for leg in legs])
            rows = np.concatenate([getattr(leg, name) for leg in legs], axis=axis)
            expected = np.take(getattr(one, name), np.searchsorted(sign * one.t, sign * read), axis=axis)
            assert rows.tobytes() == expected.tobytes(), f"member {member}, cut at {nodes}: other {name}"
        if not ended and not failed:
            assert set(one.t) <= set(np.concatenate([leg.t for leg in legs])), f"cut at {nodes}: not all was run"
            for leg in legs[1:]:
                assert any(row[0] == "start" for row in leg.plan.rows), f"cut at {nodes}: a new scene"
    if not ended and not failed and recipe.seed % 4 == 0:
        end = legs[0].final
        rest = t[t.index(cuts[0]) :]
        here = outcome(end, rest, case.how)
        for tier in TIERS:
            _same(here, worker(tier).outcome(end, rest, case.how), f"from node {nodes[0]} on tier {tier}")


@law
def final_is_the_last_state(recipe: Recipe) -> None:
    case = recipe.case()
    result, ended = execute(case.start, case.t, {**case.how, "record": ("position", "velocity")})
    if result is None:
        raise Refused(ended)
    if ended or np.any(result.status):
        return
    end = result.final
    if case.alone:
        assert end.t0 == case.t[-1]
        last = end.particles.position, end.particles.velocity
        rows = result.position[-1], result.velocity[-1]
    else:
        assert end.scene.t0 == case.t[-1]
        last, rows = (end.position, end.velocity), (result.position[:, -1], result.velocity[:, -1])
    for name, kept, row in zip(("position", "velocity"), last, rows, strict=True):
        assert np.array_equal(kept, row), f"{name} of final is not the last row"


@law
def progress_ends_at_its_total(recipe: Recipe) -> None:
    case = recipe.case()
    calls: list[tuple[int, int]] = []
    result, ended = execute(
        case.start, case.t, {**case.how, "progress": lambda done, total: calls.append((done, total))}
    )
    if result is None:
        raise Refused(ended)
    assert all(0 <= done <= total for done, total in calls), f"progress {calls[-3:]}"
    if calls and not ended and not np.any(result.status):
        assert calls[-1][0] == calls[-1][1], f"progress ends at {calls[-1]}"


@law
def no_step_is_longer_than_max_step(recipe: Recipe) -> None:
    case = recipe.case()
    if case.how.get("dt") is not None:
        raise Refused("fixed steps")
    scene = case.members()[0]
    span = abs(case.t[-1] - scene.t0)
    longest = span / (1 + recipe.seed % 40)
    result, ended = execute(case.start, case.t, {**case.how, "max_step": longest})
    if result is None:
        raise Refused(ended)
    if ended or result.plan.closed_form or np.any(result.status) or ends_in_a_closed_form(result, case.how):
        return
    if case.alone:
        steps = np.array([result.stats.steps])
    else:
        # Members that have a closed form take none.
        steps = result.per_trajectory["steps"][result.per_trajectory["evaluations"] > 0]
    # A last step may be a rounding longer than the rest of the way.
    assert min(steps) >= int(span / longest * (1.0 - 1e-12)), (
        f"{min(steps)} steps of at most 1/{span / longest} of the way"
    )
