"""Short trials: what a run would cost, before it is run, and how far a method is off.

The one idea: the first stretch of the very run is done, as long as a few milliseconds, and scaled to the whole. No
function of the user's is called, nothing is recorded, nothing is warned of.
"""

from __future__ import annotations

import math
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva import _core
from visviva._some_copies import of_copies
from visviva.errors import Interrupted
from visviva.integrators import methods
from visviva.plan import Cost

if TYPE_CHECKING:
    from visviva.plan import Plan

__all__ = ["cost", "run_stretch"]

# A trial is long enough to tell how fast it goes after this time and so many steps, or after the longest time.
_SECONDS, _STEPS, _LONGEST = 4e-3, 50, 5e-2
# Of fewer steps along a path nothing follows for more of it.
_FEWEST = 4
# The most steps of a first stretch, beyond which nothing is told, and how many times those of the last the next takes.
_MOST_STEPS, _FASTER = 10_000, 64
# Copies of an ensemble that are tried, and pairs in a step beyond which none is tried: it would take too long.
_COPIES = 32
_PAIRS = 10**8
# The longest step of a run in which forces may change within any, as a part of it.
_LONGEST_STEP = 1.0 / 128.0
# The columns by their numbers for each copy and time, for N bodies.
_NUMBERS = {name: axes for name, _, axes, _ in _core.columns()}


def cost(asked: _core._Request, plan: Plan) -> Cost | None:
    """What a run of what is asked would cost; None where a trial would take long, fails or tells nothing."""
    copies, bodies = asked["mass"].shape
    rows = len(asked["times"]) + (1 if asked["end_only"] else 0)
    numbers = sum(3 * bodies if name in ("position", "velocity") else _NUMBERS.get(name, 3) for name in asked["record"])
    memory = 8 * copies * rows * numbers
    tried = of_copies(asked, slice(0, _COPIES))
    tried |= {"events": [], "record": [], "end_only": True, "max_steps": None}
    rigid = asked["rigid"]
    if asked["events"] and not plan.closed_form and rigid is None:
        tried["method"] = plan.method  # without events `auto` might know a closed form
    few = len(tried["mass"])
    scale = copies / max(1, few)
    if plan.closed_form:
        result, seconds = run_stretch(tried, 1.0)
        return None if result["error"] else Cost(0, 0, memory, seconds * scale * max(1, rows - 1), exact=True)
    chosen = rigid is not None and asked["method"] == "auto" and asked["dt"] is None
    if chosen and not any(method.adaptive for method in methods() if method.name == plan.method):
        return None  # parts of the run, of which a stretch has as many: its steps tell nothing of the whole
    if plan.evaluations_per_step * plan.pairs_per_evaluation > _PAIRS or not bodies or not copies:
        return None
    span = abs(float(asked["times"][-1]) - asked["t0"])
    step = None if asked["time_transformation"] else asked["dt"]
    fraction = min(1.0, abs(step) / span if step is not None and span > 0.0 else 1.0 / 4096.0)
    tried["max_steps"] = _MOST_STEPS
    # What may change within any step is looked at so often in a run, not in a stretch of it.
    longest = asked["max_step"] if asked["max_step"] is not None or asked["dt"] is not None else _LONGEST_STEP * span
    while True:
        tried["max_step"] = asked["max_step"] if fraction == 1.0 else longest
        result, seconds = run_stretch(tried, fraction)
        stats = result["stats"]
        # What comes next may be another motion, as of an orbit that decays: of that nothing is told.
        tried["max_steps"] = _MOST_STEPS + _FASTER * stats["steps"]
        if result["error"] or result["status"].any():
            return None
        # Massless bodies may have steps of their own, of which a stretch has at least one.
        paths = few * max(1, plan.passive + min(plan.active, 1))
        few_steps = stats["steps"] < _STEPS * paths
        if fraction == 1.0 or seconds > (_LONGEST if few_steps else _SECONDS):
            break
        fraction = min(1.0, 4.0 * fraction)
    if stats["steps"] == 0 and asked["events"] and rigid is not None:
        return None  # without its events the motion has a closed form: a trial has no steps, and the run has
    if fraction < 1.0 and (stats["steps"] == 0 or (step is None and stats["steps"] < _FEWEST * paths)):
        return None
    seconds = min(seconds, run_stretch(tried, fraction)[1])  # the first may have been held up
    ratio, exact = scale / fraction, scale / fraction == 1.0
    steps = round(stats["steps"] * ratio)
    if step is not None and step != 0.0:
        # The way to the end from the last node is none. Bodies that do not know of each other take them one by one.
        nodes, seen = (math.floor(part * span / abs(step) * (1.0 + 1e-12)) for part in (1.0, fraction))
        parts = round(stats["steps"] / (few * seen)) if seen else 1
        steps, exact = copies * nodes * parts, True
        ratio = steps / stats["steps"] if stats["steps"] else scale
    return Cost(steps, round(stats["evaluations"] * ratio), memory, seconds * ratio, exact=exact)


def run_stretch(asked: _core._Request, fraction: float, times: int = 1) -> tuple[dict[str, Any], float]:
    """Run the first `fraction` of what is asked, with so many outputs; give the result and the seconds it took.

    On a busy machine much of the time that passes is not the run's; on several threads it takes more than passes.
    """
    t0, end = asked["t0"], float(asked["times"][-1])
    last = end if fraction == 1.0 else t0 + fraction * (end - t0)
    outputs = np.array([last]) if times == 1 else np.linspace(t0, last, times + 1)[1:]
    begun, used = perf_counter(), process_time()
    result = _core.run(
        cast("_core._Request", dict(asked) | {"times": outputs, "end_only": times == 1}),
        threads=None,
        progress=None,
        ensemble=len(asked["mass"]) > 1,
    )
    error = result["error"]
    if error is not None and error["kind"] == "interrupted":
        raise Interrupted("a trial of the run was interrupted")
    return result, min(perf_counter() - begun, process_time() - used)
