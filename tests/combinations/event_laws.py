"""Laws of events: they change no bit of a run, each found one is a zero, and a terminal one only cuts.

That threads, tiers and other members change no bit of the table either is asked by `bit_laws`, of recipes with events.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import FIRST_EVENTS
from law_book import EPSILON, law
from recipe import COLUMNS, Case, Recipe, Refused
from running import differences, ends_in_a_closed_form, events, execute, outcome
from solutions import loses_energy

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray


def _watched(recipe: Recipe) -> Recipe:
    """The recipe, with events if it has none."""
    # The energy of many bodies takes its time (see `recipes`).
    kinds = FIRST_EVENTS if recipe.bodies <= 8 else [name for name in FIRST_EVENTS if name != "energy"]
    some = tuple((kinds[(recipe.seed + i) % len(kinds)], recipe.seed % 97 + i) for i in range(2))
    return recipe if recipe.events else replace(recipe, events=some)


def _with(case: Case, **changes: Any) -> dict[str, Any]:
    """How the case is run, its events with other directions or ends."""
    return {**case.how, "events": tuple(replace(event, **changes) for event in case.how["events"])}


def _ran(case: Case, how: dict[str, Any]) -> Any:
    result, ended = execute(case.start, case.t, how)
    if result is None:
        raise Refused(ended)
    return result


@law
def events_change_no_bit_of_the_run(recipe: Recipe) -> None:
    case = _watched(recipe).case()
    plain = {name: value for name, value in case.how.items() if name != "events"}
    without = _ran(case, plain)
    if (np.atleast_1d(without.stats.evaluations if case.alone else without.per_trajectory["evaluations"]) == 0).any():
        raise Refused("closed forms, which are not used to look for events")
    if ends_in_a_closed_form(without, case.how):
        raise Refused("a closed form after a merger, which is not used to look for events")
    watched = _ran(case, _with(case, terminal=0))
    together = "also integrated together" in str(watched.plan)
    too_many = np.atleast_1d(watched.status) == vv.Status.TOO_MANY_STEPS
    if (too_many & (together | (np.atleast_1d(without.status) == 0))).any():
        raise Refused("what is integrated together takes more steps than are allowed")
    found, expected = (outcome(case.start, case.t, how) for how in (_with(case, terminal=0), plain))
    if str(found["ended"]).startswith("refused"):
        raise Refused(found["ended"])
    # What it costs is another matter: bodies that are looked at together are integrated together, besides.
    told = ("t", "status", "ended", *COLUMNS)
    # What is integrated together for the events may fail a little earlier, and the last state is of a time of all.
    if not (together and expected.get("ended")):
        told = (*told, "final t0", "final position", "final velocity")
    other = differences(found, expected, of=tuple(name for name in told if name in expected))
    assert not other, f"with events other {', '.join(other)}"


def _size(vectors: NDArray[np.float64]) -> float:
    return float(np.abs(vectors).max(initial=0.0))


def _value(event: vv.events.Event, scene: vv.Scene, span: float) -> tuple[float, float]:
    """The event's function of a state, and below what it is zero to round-off.

    Coordinates are rounded once, and by what bodies move in a rounding of the step, which the run's span bounds: about
    an origin that goes with most of them, so a body that rests moves there as fast as they do.
    """
    told = dict(event.parameters)
    x, v = scene.particles.position, scene.particles.velocity
    moved = span * _size(v)
    if event.kind == "energy":
        bodies, a = scene.particles, scene.acceleration()
        near = EPSILON * (_size(x) + moved)
        mass, invariants = bodies.mass, scene.invariants()
        kinetic = 0.5 * float((mass[:, None] * v * v).sum())
        scale = kinetic + abs(invariants.energy - kinetic) + abs(told["value"])
        work = float((mass * np.linalg.norm(a, axis=1)).sum()) * near
        boost = float(mass.sum()) * _size(v) * EPSILON * (_size(v) + span * _size(a))
        return invariants.energy - told["value"], 64 * (EPSILON * scale + 3 * (work + boost))
    if event.kind == "expression":
        # What the roundings of all numbers make of it: by its slopes, or at once where it turns between two numbers.
        function, near = told["expression"], EPSILON * (_size(x) + moved)
        value = float(function(scene.t0, x, v))
        boost = EPSILON * (_size(v) + span * _size(scene.acceleration()))
        changes, digits_off = 0.0, [k * EPSILON for k in (-3, -2, -1, 1, 2, 3)]
        for array, digits in ((x, near), (v, boost)):
            for at in np.ndindex(array.shape):
                by_number = []
                for nudge in (2.0**-20, *digits_off):
                    beside = array.copy()
                    beside[at] += nudge * (digits / EPSILON)
                    state = (beside, v) if array is x else (x, beside)
                    by_number.append(abs((float(function(scene.t0, *state)) - value) / nudge) * EPSILON)
                changes += max(by_number)
        return value, 64 * (changes + EPSILON)
    if event.kind == "plane":
        normal = np.array(told["normal"])
        body, point = told["body"], np.array(told["point"])
        near = EPSILON * (_size(x[body]) + _size(point) + moved)
        return float((x[body] - point) @ normal), 64 * near * _size(normal)
    if event.kind == "distance":
        i, j = told["first"], told["second"]
        near = EPSILON * (_size(x[[i, j]]) + told["distance"] + moved)
        return float(np.linalg.norm(x[i] - x[j])) - told["distance"], 64 * near
    body, about = told["body"], told["about"]
    named = isinstance(about, int)
    r, u = (x[body] - x[about], v[body] - v[about]) if named else (x[body] - np.array(about), v[body])
    places = x[[body, about]] if named else np.stack([x[body], np.array(about)])
    speeds = v[[body, about]] if named else v[[body]]
    a = scene.acceleration()
    near = EPSILON * (_size(places) + moved)
    boost = EPSILON * (_size(speeds) + span * _size(a))
    return float(r @ u), 64 * 3 * (near * _size(u) + boost * _size(r))


@law
def a_located_event_is_a_zero_at_its_state(recipe: Recipe) -> None:
    backward = recipe.backward and not loses_energy(recipe)
    case = _watched(replace(recipe, tame=True, backward=backward)).case()
    result = _ran(case, case.how)
    table, scenes = result.events, case.members()
    span, collide = abs(case.t[-1] - scenes[0].t0), "collisions" in case.how
    for which, t, x, v, member in zip(*(getattr(table, name) for name in table.__slots__[:5]), strict=True):
        known = np.isfinite(x).all(axis=1)
        start, event = scenes[member], case.how["events"][which]
        assert min(start.t0, case.t[-1]) <= t <= max(start.t0, case.t[-1]), f"an event at {t}, beyond the run"
        # Those that are integrated apart from what is looked at are where they started: no event here looks at them.
        bodies = start.particles
        place, velocity = np.where(known[:, None], [x, v], [bodies.position, bodies.velocity])
        if event.kind == "energy" and not known[start.particles.mass > 0.0].all():
            raise AssertionError("an energy of bodies that are not told")
        jumps = collide and event.kind in ("apsis", "energy", "expression")
        if jumps and t in (result if case.alone else result[int(member)]).collisions.t:
            continue  # where what jumps from one sign to the other is an event, and no zero
        value, allowed = _value(event, start.with_state(place, velocity, float(t)), span)
        assert abs(value) <= allowed, f"{event.kind}: {value:.1e} at the located state, {allowed:.1e} allowed"


@law
def a_terminal_event_only_cuts(recipe: Recipe) -> None:
    """Up to its end the run and the table are those without an end, and the end is the event."""
    recipe = _watched(recipe)
    # Spheres that end a run are another end.
    others = "" if recipe.collisions == "stop" else recipe.collisions
    recipe = replace(recipe, terminal=recipe.terminal or 1, collisions=others)
    case = recipe.case()
    stopped, whole = _ran(case, case.how), _ran(case, _with(case, terminal=0))
    sign = -1.0 if recipe.backward else 1.0
    pairs = [(stopped, whole)] if case.alone else [(stopped[i], whole[i]) for i in range(len(case.members()))]
    for scene, (cut, full) in zip(case.members(), pairs, strict=True):
        table = cut.events
        count = int((table.which == 0).sum())
        if cut.status != vv.Status.STOPPED:
            assert cut.status == full.status
            assert cut.status or count < recipe.terminal, "the run went on"
            # Bodies apart from those of the event may have failed before it, which ends the whole; the looks end there.
            if count < recipe.terminal:
                assert not differences(events(cut, case.how), events(full, case.how)), "another table without an end"
            else:
                assert np.array_equal(table.t, full.events.t[: len(table)]), "another table before the end"
            continue
        assert count == recipe.terminal, f"{count} zeros, the end was to be that of number {recipe.terminal}"
        # One that is looked for twice is there twice.
        assert table.t[-1] == cut.final.t0
        assert 0 in table.which[table.t == table.t[-1]]
        for name in ("which", "t", "position", "velocity"):
            first = getattr(full.events, name)[: len(table)]
            assert np.array_equal(getattr(table, name), first, equal_nan=True), f"other {name} before the end"
        # Bodies that do not depend on each other have their own steps, and for the event those of all.
        explained = str(scene.plan(t=list(case.t), **case.how))
        together = "also integrated together" not in explained
        # A body that is known from the others is put together anew, to an ulp.
        rounding = 4.0 * EPSILON if "steps of the first massive body" in explained else 0.0
        end = cut.final.particles
        known = np.isfinite(table.position[-1]).all(axis=1)
        for name in ("position", "velocity"):
            last, found = getattr(end, name)[known], getattr(table, name)[-1][known]
            same = np.abs(last - found).max(initial=0.0) <= rounding * np.abs(found).max(initial=0.0)
            assert same or not together, f"{name} of final is not that of the event"
        rows = sum(sign * t <= sign * table.t[-1] for t in full.t)
        assert not case.alone or len(cut.t) == rows, f"{len(cut.t)} rows up to the end, of {rows}"
        for name in cut.recorded:
            before, after = np.split(getattr(cut, name), [rows])
            same = before.tobytes() == np.ascontiguousarray(getattr(full, name)[:rows]).tobytes()
            assert same, f"other {name} before the end"
            assert np.isnan(after).all(), f"{name} beyond the end"


@law
def a_stopped_run_ends_where_the_whole_run_passes(recipe: Recipe) -> None:
    """`final` is the state that the run without an end has at that time, to round-off."""
    others = "" if recipe.collisions == "stop" else recipe.collisions
    recipe = _watched(replace(recipe, tame=True, members=0, collisions=others))
    recipe = replace(recipe, terminal=recipe.terminal or 1)
    case = recipe.case()
    stopped = _ran(case, case.how)
    if stopped.status != vv.Status.STOPPED:
        raise Refused("no end on the way")
    start, end = case.members()[0], stopped.final
    read = replace(case, t=tuple(dict.fromkeys([end.t0, case.t[-1]])))
    whole = _ran(read, _with(case, terminal=0) | {"record": ("position", "velocity")})
    x, v = end.particles.position, end.particles.velocity
    try:
        a = end.acceleration()
    except vv.InvalidInput as error:
        raise Refused("the end is where a force is not known") from error
    # The time of the event is rounded once, and the step on which it lies is read twice.
    span = abs(end.t0 - start.t0)
    late = EPSILON * (abs(start.t0) + 2 * span)
    # What is integrated apart from the bodies of the event is brought to its time by steps of its own.
    together = bool(start.particles.mass.all()) and any(
        name.startswith(("Gravity", "PairPotential")) for name, _ in recipe.forces
    )
    err = 0.0 if together else 100 * 10.0**-recipe.decades
    for name, size, rate in (("position", _size(x), _size(v)), ("velocity", _size(v), _size(a))):
        apart = _size(getattr(whole, name)[0] - getattr(end.particles, name))
        # A step may be as long as the run: what is summed for a state between its ends is as large as the way.
        allowed = 64 * (EPSILON * (size + rate * span) + late * rate) + err * (size + rate * span)
        assert apart <= allowed, f"{name} of final is {apart:.1e} off, {allowed:.1e} allowed"
